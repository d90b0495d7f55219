//! Tables of areal spectra: too many points to tabulate when a scene is prepared, so that a node
//! of a point is made when a tick first needs it.
//!
//! Memory is set aside when preparing: a row of nodes for every point, or for as many as fit.
//! When all rows are taken, the row that was taken first is given to the point that needs one. A
//! node made is the number that preparing would have stored, whenever it is made, so amplitudes
//! depend on nothing but scene and pose; what a first touch costs is bounded by the two nodes that
//! a look-up reads, and is counted.

use std::sync::Arc;

use super::Grid;
use super::build::{NodeGains, normal};
use super::segments::Spot;
use crate::render::plan::{Contacts, Counters, PointGrid, ScenePlan};
use crate::surface::LocalSpectra;

/// No row holds this point's nodes; or a row holds no point's.
const NONE: u32 = u32::MAX;
/// Fewest points whose rows there must be room for.
const LEAST_ROWS: usize = 1024;

/// A power at a node as it is kept, `[40 Hz, 320 Hz]` in units of the textile's: with its sign
/// turned, so that memory as the system hands it out, all zeros, says "not made", and silence is
/// −0.
type Kept = [f32; 2];

/// Whether a node is made.
#[inline]
fn is_made(kept: Kept) -> bool {
    kept[0].to_bits() != 0
}

/// A node and the next, if both are made.
#[inline]
fn made_at(kept: &[Kept], at: usize) -> Option<[Kept; 2]> {
    let nodes = *kept.get(at..)?.first_chunk::<2>()?;
    (is_made(nodes[0]) & is_made(nodes[1])).then_some(nodes)
}

/// Powers a share of the way from a node to the next.
#[inline]
fn between([before, after]: [Kept; 2], share: f32) -> [f32; 2] {
    [0, 1].map(|band: usize| -(before[band] + (after[band] - before[band]) * share))
}

/// What contactors that share a speed along an axis of an areal surface hear.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heard {
    /// Which spectra of the pool.
    pub(super) spectra: usize,
    pub(super) points: PointGrid,
    pub(super) spot: Spot,
}

/// Powers of areal spectra at the nodes that were touched.
#[derive(Debug, Clone)]
pub(super) struct TouchedTables {
    gains: Arc<NodeGains>,
    /// By place in the pool; `None` for spectra along one profile.
    areas: Vec<Option<Area>>,
    /// By place in the pool, the first of an area's points among those of all areas.
    firsts: Vec<usize>,
    n_nodes: usize,
    /// There is a row for every point: its own, for ever.
    is_whole: bool,
    /// Row by row the nodes of a point.
    kept: Vec<Kept>,
    /// The row of every point of every area, unless it is whole.
    row_of: Vec<u32>,
    /// The point of every row.
    point_of: Vec<u32>,
    /// The row to be taken next.
    next: usize,
}

/// The spectra of one direction over an area.
#[derive(Debug, Clone)]
struct Area {
    spectra: Arc<LocalSpectra>,
    /// One over the unit of its powers, 1/µm²; 0 if all are silent.
    per_unit: f64,
}

/// How many points of a plan are areal.
fn n_areal_points(plan: &ScenePlan) -> usize {
    let areal = plan.pool.iter().filter(|spectra| spectra.is_areal());
    areal.map(|spectra| spectra.n_points()).sum()
}

/// Bytes that the rows of a plan's areal points take, within `room`; `None` if too few fit.
pub(super) fn touched_bytes(plan: &ScenePlan, grid: &Grid, room: usize) -> Option<usize> {
    let n_points = n_areal_points(plan);
    let row = grid.segments.nodes().len() * size_of::<Kept>();
    let n_rows = n_points.min(room / row.max(1));
    (n_rows >= n_points.min(LEAST_ROWS)).then(|| n_rows * row)
}

impl TouchedTables {
    /// Nothing made yet, in `n_bytes` of memory. `units_um2` holds the unit of each of the pool's
    /// spectra.
    pub(super) fn new(
        plan: &ScenePlan,
        units_um2: &[f64],
        gains: Arc<NodeGains>,
        n_bytes: usize,
    ) -> Self {
        let n_nodes = gains.n_nodes().max(1);
        let n_rows = n_bytes / (n_nodes * size_of::<Kept>());
        let area = |(spectra, unit_um2): (&Arc<LocalSpectra>, &f64)| {
            spectra.is_areal().then(|| Area {
                spectra: Arc::clone(spectra),
                per_unit: if *unit_um2 > 0.0 { 1.0 / unit_um2 } else { 0.0 },
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
            gains,
            areas,
            firsts,
            n_nodes,
            is_whole,
            kept: vec![[0.0; 2]; n_rows * n_nodes],
            row_of: vec![NONE; n_places],
            point_of: vec![NONE; n_owners],
            next: 0,
        }
    }

    /// Whether spectra of the pool are areal.
    #[inline]
    pub(super) fn has(&self, spectra: usize) -> bool {
        self.areas[spectra].is_some()
    }

    /// Bytes set aside.
    pub(super) fn n_bytes(&self) -> usize {
        let n_places = self.row_of.len() + self.point_of.len();
        size_of_val(&self.kept[..]) + n_places * size_of::<u32>() + self.gains.n_bytes()
    }

    /// Adds to every contactor on a textile its powers along the axes that are heard; contactors
    /// share their speeds.
    pub(super) fn add_all(
        &mut self,
        heard: [Option<Heard>; 2],
        contacts: &Contacts<'_>,
        powers: &mut [[f32; 2]],
        counters: &mut Counters,
    ) {
        // A local of its own, so that the loops need not ask anew where it lies.
        let mut kept = std::mem::take(&mut self.kept);
        match heard {
            [Some(warp), Some(weft)] => {
                let starts = [warp, weft].map(|heard| self.start_of(&heard));
                let row = if self.is_whole { self.n_nodes } else { 0 };
                contacts.for_each_placed(powers, |[u_mm, w_mm], power| {
                    // One surface: its grid is looked up once for both.
                    let [i, j] = warp.points.indices(u_mm, w_mm);
                    let points = [warp.points.number([i, j]), weft.points.number([j, i])];
                    let at = |axis: usize| made_at(&kept, starts[axis] + points[axis] * row);
                    let [a, b] = match (at(0), at(1)) {
                        (Some(a), Some(b)) if row > 0 => {
                            [between(a, warp.spot.share), between(b, weft.spot.share)]
                        }
                        _ => [
                            self.at_in(&mut kept, (warp.spectra, points[0]), warp.spot, counters),
                            self.at_in(&mut kept, (weft.spectra, points[1]), weft.spot, counters),
                        ],
                    };
                    (0..2).for_each(|band| power[band] += a[band] + b[band]);
                });
            }
            [Some(warp), None] => contacts.for_each_placed(powers, |[u_mm, w_mm], power| {
                let point = (warp.spectra, warp.points.nearest(u_mm, w_mm));
                let own = self.at_in(&mut kept, point, warp.spot, counters);
                (0..2).for_each(|band| power[band] += own[band]);
            }),
            [None, Some(weft)] => contacts.for_each_placed(powers, |[u_mm, w_mm], power| {
                let point = (weft.spectra, weft.points.nearest(w_mm, u_mm));
                let own = self.at_in(&mut kept, point, weft.spot, counters);
                (0..2).for_each(|band| power[band] += own[band]);
            }),
            [None, None] => {}
        }
        self.kept = kept;
    }

    /// Where the nodes of an area that are heard begin, when there is a row for every point.
    fn start_of(&self, heard: &Heard) -> usize {
        self.firsts[heard.spectra] * self.n_nodes + heard.spot.node
    }

    /// The powers of a point of some spectra at a speed; nodes that are missing are made, and
    /// counted.
    #[inline]
    pub(super) fn at(
        &mut self,
        point: (usize, usize),
        spot: Spot,
        counters: &mut Counters,
    ) -> [f32; 2] {
        let mut kept = std::mem::take(&mut self.kept);
        let powers = self.at_in(&mut kept, point, spot, counters);
        self.kept = kept;
        powers
    }

    #[inline]
    fn at_in(
        &mut self,
        kept: &mut [Kept],
        point: (usize, usize),
        spot: Spot,
        counters: &mut Counters,
    ) -> [f32; 2] {
        let place = self.firsts[point.0] + point.1;
        let row = if self.is_whole {
            place
        } else {
            self.row_of[place] as usize
        };
        let nodes = match made_at(kept, row * self.n_nodes + spot.node) {
            Some(nodes) => nodes,
            None => self.made(kept, point, spot.node, counters),
        };
        between(nodes, spot.share)
    }

    /// A node and the next of a point, made as far as they are missing.
    #[cold]
    #[inline(never)]
    fn made(
        &mut self,
        all: &mut [Kept],
        (spectra, point): (usize, usize),
        node: usize,
        counters: &mut Counters,
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
        [node, node + 1].map(|node| {
            let kept = &mut all[row * self.n_nodes + node];
            if !is_made(*kept) {
                let (sums, n_bins) = self.gains.sums(node, powers_um2);
                *kept = sums.map(|sum| -normal(2.0 * sum * area.per_unit));
                counters.nodes_made += 1;
                counters.bins_evaluated += 2 * n_bins as u64;
            }
            *kept
        })
    }

    /// The row of a point, taken from another if it has none.
    fn row(&mut self, all: &mut [Kept], point: usize) -> usize {
        if self.row_of[point] == NONE {
            let row = self.next;
            self.next = (row + 1) % self.point_of.len();
            let before = self.point_of[row];
            if before != NONE {
                self.row_of[before as usize] = NONE;
                all[row * self.n_nodes..][..self.n_nodes].fill([0.0; 2]);
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
    use crate::geometry::Frame;
    use crate::numerics::{Grid as Heights, Random};
    use crate::render::array::TableCache;
    use crate::render::{PlacedLevel, PlacedSurface, RenderScene};
    use crate::surface::{HeightMap, Surface};
    use crate::tactile::Filters;

    /// An areal scene, and what its tables are made with.
    fn prepared() -> (ScenePlan, Vec<f64>, Arc<NodeGains>, Grid) {
        let mut random = Random::new(8);
        let heights = (0..160 * 140).map(|_| random.normal()).collect();
        let map = HeightMap::new(Heights::from_rows(160, heights).unwrap(), [0.05; 2]).unwrap();
        let placed = PlacedSurface {
            workspace_from_textile: Frame::default(),
            size_mm: [50.0; 2],
            manifest_gain_db: 0.0,
            scene_gain_db: 0.0,
            level: PlacedLevel::Pending,
            surface: Arc::new(Surface::areal(&map, 0.0).unwrap()),
        };
        let scene = RenderScene {
            textiles: vec![placed],
            ..RenderScene::default()
        };
        let (plan, mut cache) = (ScenePlan::of(&scene), TableCache::default());
        let grid = cache.grid(&Filters::default(), 0.05);
        let gains = cache.node_gains(&Filters::default(), &grid);
        let (_, units_um2) = cache.tables(&plan, &Filters::default(), &grid);
        (plan, units_um2, gains, grid)
    }

    #[test]
    fn powers_are_the_same_bits_whether_made_now_before_or_again() {
        let (plan, units_um2, gains, grid) = prepared();
        let all = touched_bytes(&plan, &grid, usize::MAX).unwrap();
        let row = grid.segments.nodes().len() * size_of::<Kept>();
        assert_eq!(all, 2 * 4 * 3 * row, "8 × 7 mm less a window, both axes");
        let new = |n_bytes| TouchedTables::new(&plan, &units_um2, Arc::clone(&gains), n_bytes);
        let (mut whole, mut small) = (new(all), new(3 * row));
        let mut random = Random::new(9);
        let mut counters = Counters::default();
        let mut look_ups = Vec::new();
        for _ in 0..2000 {
            let speed = 0.01 * 2.0_f64.powf(random.uniform_in(0.0, 18.0));
            let at = (random.index(2), random.index(12), grid.segments.find(speed));
            look_ups.push((at, whole.at((at.0, at.1), at.2, &mut counters)));
        }
        let n_made = counters.nodes_made;
        for ((spectra, point, spot), expected) in &look_ups {
            let again = whole.at((*spectra, *point), *spot, &mut counters);
            assert_eq!(again.map(f32::to_bits), expected.map(f32::to_bits));
        }
        assert_eq!(counters.nodes_made, n_made, "what is made stays");
        for ((spectra, point, spot), expected) in look_ups.iter().rev() {
            let found = small.at((*spectra, *point), *spot, &mut counters);
            assert_eq!(found.map(f32::to_bits), expected.map(f32::to_bits));
        }
        assert!(counters.nodes_made > 3 * n_made / 2, "rows were given away");
        assert!(look_ups.iter().any(|(_, [low, _])| *low > 0.0));
    }

    #[test]
    fn a_node_is_what_preparing_would_have_stored() {
        let (plan, units_um2, gains, grid) = prepared();
        let n_bytes = touched_bytes(&plan, &grid, usize::MAX).unwrap();
        let mut touched = TouchedTables::new(&plan, &units_um2, gains, n_bytes);
        let given = [(&*plan.pool[0], units_um2[0])];
        let tables =
            super::super::build::tables_of(grid.segments.nodes(), &given, &Filters::default());
        let n_points = plan.pool[0].n_points();
        for node in (0..grid.segments.nodes().len() - 1).step_by(7) {
            let spot = Spot { node, share: 0.0 };
            for point in 0..n_points {
                let found = touched.at((0, point), spot, &mut Counters::default());
                let stored = tables[0][node * n_points + point];
                for (a, b) in found.into_iter().zip(stored) {
                    assert!((a - b).abs() <= 1.2e-7 * b, "{a} for {b} at node {node}");
                }
            }
        }
    }

    #[test]
    fn tables_of_any_area_fit_into_their_room_or_are_refused() {
        let (plan, _, _, grid) = prepared();
        let row = grid.segments.nodes().len() * size_of::<Kept>();
        assert_eq!(touched_bytes(&plan, &grid, 23 * row), None);
        assert_eq!(touched_bytes(&plan, &grid, 24 * row), Some(24 * row));
        assert_eq!(touched_bytes(&plan, &grid, 1000 * row), Some(24 * row));
    }
}
