//! Tables of spectra with many points, over an area or along a long profile: a node of a point is
//! made when a tick first needs it of that very point.
//!
//! Memory is set aside when preparing: a row of nodes for every point, or for as many as fit. A
//! row's nodes stand in lines of the processor's cache, and lines of the same nodes stand together
//! row after row: a display reads points that lie near each other at one speed, so what it reads is
//! near each other too. When all rows are taken, the row that was taken first is given to the point
//! that needs one. A node made is the same number whenever it is made, so amplitudes depend on
//! nothing but scene and pose; what a first touch costs is bounded by the two nodes that a look-up
//! reads, and is counted.

use std::sync::Arc;

use super::grid::Grid;
use super::nodes::Making;
use super::rows::RowTable;
use super::segments::Spot;
use crate::plan::{Axis, Contacts, PointGrid, ScenePlan};
use selvedge_textile::surface::LocalSpectra;

/// Most bytes that the tables of a scene may take.
pub(crate) const MAX_TABLE_BYTES: usize = 256_000_000;
/// No row holds this point's nodes; or a row holds no point's.
const NONE: u32 = u32::MAX;
/// Fewest points whose rows there must be room for.
const MIN_ROWS: usize = 1024;

/// Nodes of a row that stand beside each other: a line of the processor's cache.
const LINE: usize = 8;
/// Steps from node to node in a line. The last node of a line is the first of the next as well, so
/// that the two that a look-up reads always stand in one line.
const STEPS: usize = LINE - 1;
/// Where lines begin, bytes.
const ALIGNMENT: usize = LINE * size_of::<Kept>();

/// A power at a node as it is kept, `[40 Hz, 320 Hz]` in units of the textile's: with its sign
/// turned, so that memory as the system hands it out, all zeros, says "not made", and silence is
/// −0.
type Kept = [f32; 2];

/// Whether a node is made.
#[inline]
fn is_made(kept: Kept) -> bool {
    kept[0].to_bits() != 0
}

/// A node of a line and the next, if there is such a line and both are made.
#[inline]
fn made_at(lines: &[[Kept; LINE]], line: usize, step: usize) -> Option<[Kept; 2]> {
    let line = lines.get(line)?;
    // Never beyond the line: the remainder spares the question.
    let nodes = [line[step % LINE], line[(step + 1) % LINE]];
    (is_made(nodes[0]) & is_made(nodes[1])).then_some(nodes)
}

/// Powers a share of the way from a node to the next, with their signs turned as they are kept.
#[inline]
fn between([before, after]: [Kept; 2], share: f32) -> Kept {
    [0, 1].map(|band: usize| before[band] + (after[band] - before[band]) * share)
}

/// What contactors that share a speed along an axis of such a surface hear.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heard {
    /// Which spectra of the pool.
    pub(super) spectra: usize,
    pub(super) points: PointGrid,
    pub(super) spot: Spot,
}

impl Heard {
    /// Whether the other is of the same area along its other side: a point's indices are the
    /// other's in turn.
    fn is_across(&self, other: &Self) -> bool {
        let [n_along, n_across] = self.points.n_points();
        n_across > 1 && other.points.n_points() == [n_across, n_along]
    }
}

/// Powers of spectra with many points at the nodes that were touched.
#[derive(Debug, Clone)]
pub(super) struct TouchedTables {
    /// By place in the pool; `None` for spectra with few points.
    areas: Vec<Option<Area>>,
    /// By place in the pool, the first of an area's points among those of all areas.
    firsts: Vec<usize>,
    n_rows: usize,
    n_lines: usize,
    /// There is a row for every point: its own, for ever.
    is_whole: bool,
    /// The lines of the first nodes, row by row, then those of the next.
    kept: Vec<Kept>,
    /// The row of every point of every area, unless it is whole.
    row_of: Vec<u32>,
    /// The point of every row.
    point_of: Vec<u32>,
    /// The row to be taken next.
    next: usize,
}

/// The spectra of one direction.
#[derive(Debug, Clone)]
struct Area {
    spectra: Arc<LocalSpectra>,
    unit_um2: f64,
}

/// Roughly how many bytes are set aside for the tables of a scene: all of those of spectra with few
/// points, and of the others as much of their own size as there is room for.
pub(crate) fn table_bytes(plan: &ScenePlan, grid: &Grid) -> usize {
    let n_nodes = grid.segments.nodes().len();
    let few = n_points(plan, RowTable::suits);
    let of_few = few
        .saturating_mul(n_nodes)
        .saturating_mul(size_of::<[f32; 2]>());
    let room = MAX_TABLE_BYTES.saturating_sub(of_few);
    let touched = touched_bytes(plan, grid, room).unwrap_or(MAX_TABLE_BYTES);
    of_few.saturating_add(touched)
}

/// Points of all spectra of a plan of one kind.
fn n_points(plan: &ScenePlan, is_of_kind: impl Fn(&LocalSpectra) -> bool) -> usize {
    let spectra = plan.pool.iter().filter(|spectra| is_of_kind(spectra));
    spectra.map(|spectra| spectra.n_points()).sum()
}

/// Bytes that the rows of a plan's points take where there are many, within `room`; `None` if too
/// few fit.
pub(super) fn touched_bytes(plan: &ScenePlan, grid: &Grid, room: usize) -> Option<usize> {
    let n_points = n_points(plan, |spectra| !RowTable::suits(spectra));
    let row = row_bytes(grid.segments.nodes().len());
    let n_rows = n_points.min(room / row);
    (n_rows >= n_points.min(MIN_ROWS)).then(|| n_rows * row)
}

/// Lines of a row that has so many nodes.
fn n_lines(n_nodes: usize) -> usize {
    n_nodes.saturating_sub(1).div_ceil(STEPS).max(1)
}

/// Bytes of a row that has so many nodes.
fn row_bytes(n_nodes: usize) -> usize {
    n_lines(n_nodes) * ALIGNMENT
}

/// The lines of a memory: one that lies in two of the processor's costs twice.
fn lines_of(memory: &mut [Kept]) -> &mut [[Kept; LINE]] {
    let first = memory.as_ptr().align_offset(ALIGNMENT).min(memory.len());
    memory[first..].as_chunks_mut().0
}

impl TouchedTables {
    /// Nothing made yet, in `n_bytes` of memory. `units_um2` holds the unit of each of the pool's
    /// spectra.
    pub(super) fn new(plan: &ScenePlan, units_um2: &[f64], n_nodes: usize, n_bytes: usize) -> Self {
        let n_rows = n_bytes / row_bytes(n_nodes);
        let n_lines = n_lines(n_nodes);
        let area = |(spectra, unit_um2): (&Arc<LocalSpectra>, &f64)| {
            (!RowTable::suits(spectra)).then(|| Area {
                spectra: Arc::clone(spectra),
                unit_um2: *unit_um2,
            })
        };
        let mut n_points = 0;
        let first = |area: &Option<Area>| {
            let first = n_points;
            n_points += area.as_ref().map_or(0, |area| area.spectra.n_points());
            first
        };
        let areas: Vec<_> = plan.pool.iter().zip(units_um2).map(area).collect();
        let firsts = areas.iter().map(first).collect();
        let is_whole = n_rows >= n_points;
        let [n_places, n_owners] = if is_whole { [0, 0] } else { [n_points, n_rows] };
        Self {
            areas,
            firsts,
            n_rows,
            n_lines,
            is_whole,
            kept: vec![[0.0; 2]; (n_rows * n_lines + 1) * LINE],
            row_of: vec![NONE; n_places],
            point_of: vec![NONE; n_owners],
            next: 0,
        }
    }

    /// Bytes set aside.
    pub(super) fn n_bytes(&self) -> usize {
        let n_places = self.row_of.len() + self.point_of.len();
        size_of_val(&self.kept[..]) + n_places * size_of::<u32>()
    }

    /// Adds to every contactor on a textile its powers along the axes that are heard; contactors
    /// share their speeds.
    pub(super) fn add_all(
        &mut self,
        heard: [Option<Heard>; 2],
        contacts: &Contacts<'_>,
        powers: &mut [[f32; 2]],
        (gains, counters): Making<'_>,
    ) {
        // A local of its own, so that the loops need not ask anew where it lies.
        let mut memory = std::mem::take(&mut self.kept);
        let kept = lines_of(&mut memory);
        match heard {
            [Some(warp), Some(weft)] if warp.is_across(&weft) => {
                let starts = [warp, weft].map(|heard| {
                    let first = self.firsts[heard.spectra];
                    let line = self.line(0, heard.spot.node);
                    (first, line, heard.spot.node % STEPS)
                });
                let is_whole = self.is_whole;
                contacts.for_each_placed(powers, |[u_mm, w_mm], power| {
                    // One surface: its grid is looked up once for both.
                    let [i, j] = warp.points.indices(u_mm, w_mm);
                    let points = [warp.points.number([i, j]), weft.points.number([j, i])];
                    let at = |axis: usize| {
                        let (first, line, step) = starts[axis];
                        let place = first + points[axis];
                        let row = if is_whole {
                            place
                        } else {
                            self.row_of[place] as usize
                        };
                        // No row lies beyond every line.
                        made_at(kept, line + row, step)
                    };
                    let [a, b] = match (at(0), at(1)) {
                        (Some(a), Some(b)) => {
                            [between(a, warp.spot.share), between(b, weft.spot.share)]
                        }
                        _ => [
                            self.at_in(
                                kept,
                                (warp.spectra, points[0]),
                                warp.spot,
                                (gains, counters),
                            ),
                            self.at_in(
                                kept,
                                (weft.spectra, points[1]),
                                weft.spot,
                                (gains, counters),
                            ),
                        ],
                    };
                    (0..2).for_each(|band| power[band] -= a[band] + b[band]);
                });
            }
            alone => {
                for (axis, heard) in Axis::BOTH.into_iter().zip(alone) {
                    if let Some(heard) = heard {
                        let making = (&mut *gains, &mut *counters);
                        self.add_alone(kept, (axis, heard), (contacts, powers), making);
                    }
                }
            }
        }
        self.kept = memory;
    }

    /// The same along one axis.
    fn add_alone(
        &mut self,
        kept: &mut [[Kept; LINE]],
        (axis, heard): (Axis, Heard),
        (contacts, powers): (&Contacts<'_>, &mut [[f32; 2]]),
        (gains, counters): Making<'_>,
    ) {
        contacts.for_each_placed(powers, |[u_mm, w_mm], power| {
            let point = match axis {
                Axis::Warp => heard.points.nearest(u_mm, w_mm),
                Axis::Weft => heard.points.nearest(w_mm, u_mm),
            };
            let making = (&mut *gains, &mut *counters);
            let own = self.at_in(kept, (heard.spectra, point), heard.spot, making);
            (0..2).for_each(|band| power[band] -= own[band]);
        });
    }

    /// The line in which a node of a row and the next stand. Those of other rows stand around it.
    #[inline]
    fn line(&self, row: usize, node: usize) -> usize {
        node / STEPS * self.n_rows + row
    }

    /// The powers of a point of some spectra at a speed; nodes that are missing are made, and
    /// counted.
    #[inline]
    pub(super) fn at(&mut self, point: (usize, usize), spot: Spot, making: Making<'_>) -> [f32; 2] {
        let mut memory = std::mem::take(&mut self.kept);
        let kept = self.at_in(lines_of(&mut memory), point, spot, making);
        self.kept = memory;
        kept.map(|power| -power)
    }

    /// The same with their signs turned.
    #[inline]
    fn at_in(
        &mut self,
        kept: &mut [[Kept; LINE]],
        point: (usize, usize),
        spot: Spot,
        making: Making<'_>,
    ) -> Kept {
        let place = self.firsts[point.0] + point.1;
        let row = if self.is_whole {
            place
        } else {
            self.row_of[place] as usize
        };
        let nodes = match made_at(kept, self.line(row, spot.node), spot.node % STEPS) {
            Some(nodes) => nodes,
            None => self.made(kept, point, spot.node, making),
        };
        between(nodes, spot.share)
    }

    /// A node and the next of a point, made as far as they are missing.
    #[cold]
    #[inline(never)]
    fn made(
        &mut self,
        all: &mut [[Kept; LINE]],
        (spectra, point): (usize, usize),
        node: usize,
        (gains, counters): Making<'_>,
    ) -> [Kept; 2] {
        let Some(area) = self.areas[spectra].clone() else {
            return [[-0.0; 2]; 2];
        };
        let place = self.firsts[spectra] + point;
        let row = if self.is_whole {
            place
        } else {
            self.row(all, place)
        };
        let powers_um2 = area.spectra.powers_um2(point);
        let line = &mut all[self.line(row, node)];
        [0, 1].map(|step| {
            let (node, kept) = (node + step, &mut line[node % STEPS + step]);
            if !is_made(*kept) {
                let ([powers], n_bins) = gains.powers(node, [powers_um2], area.unit_um2);
                *kept = powers.map(|power| -power);
                counters.nodes_made += 1;
                counters.bins_evaluated += 2 * n_bins as u64;
            }
            *kept
        })
    }

    /// The row of a point, taken from another if it has none.
    fn row(&mut self, all: &mut [[Kept; LINE]], point: usize) -> usize {
        if self.row_of[point] == NONE {
            let row = self.next;
            self.next = (row + 1) % self.point_of.len();
            let before = self.point_of[row];
            if before != NONE {
                self.row_of[before as usize] = NONE;
                for line in 0..self.n_lines {
                    all[line * self.n_rows + row] = [[0.0; 2]; LINE];
                }
            }
            self.row_of[point] = number(row);
            self.point_of[row] = number(point);
        }
        self.row_of[point] as usize
    }
}

/// A row or point as it is kept: there are fewer than 2³² − 1.
fn number(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(NONE - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::array::table::nodes::NodeGains;
    use crate::plan::Counters;
    use crate::{PlacedLevel, PlacedSurface, RenderScene};
    use selvedge_foundation::geometry::Frame;
    use selvedge_foundation::numerics::{Grid as Heights, Random};
    use selvedge_textile::surface::{HeightMap, Surface};
    use selvedge_textile::tactile::Filters;

    /// An areal scene, the units of its tables and their nodes.
    fn prepared() -> (ScenePlan, Vec<f64>, Grid) {
        let mut random = Random::new(8);
        let heights = (0..160 * 140).map(|_| random.normal()).collect();
        let map = HeightMap::new(Heights::from_rows(160, heights).unwrap(), [0.05; 2]).unwrap();
        let placed = PlacedSurface {
            workspace_from_textile: Frame::default(),
            size_mm: [50.0; 2],
            manifest_gain_db: 0.0,
            scene_gain_db: 0.0,
            scene_band_gains_db: [0.0; 2],
            within_mm: None,
            level: PlacedLevel::Pending,
            surface: Arc::new(Surface::areal(&map, 0.0).unwrap()),
        };
        let scene = RenderScene {
            textiles: vec![placed],
            ..RenderScene::default()
        };
        let plan = ScenePlan::of(&scene);
        let units_um2 = super::super::units_um2(&plan);
        (plan, units_um2, Grid::new(&Filters::default(), 0.05))
    }

    #[test]
    fn powers_are_the_same_bits_whether_made_now_before_or_again() {
        let (plan, units_um2, grid) = prepared();
        let all = touched_bytes(&plan, &grid, usize::MAX).unwrap();
        let n_nodes = grid.segments.nodes().len();
        let row = row_bytes(n_nodes);
        assert_eq!(all, 2 * 4 * 3 * row, "8 × 7 mm less a window, both axes");
        let gains = || NodeGains::new(&grid.segments, &Filters::default());
        let new = |n_bytes| TouchedTables::new(&plan, &units_um2, n_nodes, n_bytes);
        let (mut whole, mut small) = ((new(all), gains()), (new(3 * row), gains()));
        let mut random = Random::new(9);
        let mut counters = Counters::default();
        let at = |tables: &mut (TouchedTables, NodeGains), (s, point, spot), counters: &mut _| {
            let found = tables.0.at((s, point), spot, (&mut tables.1, counters));
            found.map(f32::to_bits)
        };
        let mut look_ups = Vec::new();
        for _ in 0..2000 {
            let speed = 0.01 * 2.0_f64.powf(random.uniform_in(0.0, 18.0));
            let place = (random.index(2), random.index(12), grid.segments.find(speed));
            look_ups.push((place, at(&mut whole, place, &mut counters)));
        }
        let n_made = counters.nodes_made;
        for (place, expected) in &look_ups {
            assert_eq!(at(&mut whole, *place, &mut counters), *expected);
        }
        assert_eq!(counters.nodes_made, n_made, "what is made stays");
        for (place, expected) in look_ups.iter().rev() {
            assert_eq!(at(&mut small, *place, &mut counters), *expected);
        }
        assert!(counters.nodes_made > 3 * n_made / 2, "rows were given away");
        assert!(look_ups.iter().any(|(_, [low, _])| *low > 0));
    }

    #[test]
    fn tables_of_any_area_fit_into_their_room_or_are_refused() {
        let (plan, _, grid) = prepared();
        let row = row_bytes(grid.segments.nodes().len());
        assert_eq!(touched_bytes(&plan, &grid, 23 * row), None);
        assert_eq!(touched_bytes(&plan, &grid, 24 * row), Some(24 * row));
        assert_eq!(touched_bytes(&plan, &grid, 1000 * row), Some(24 * row));
    }
}
