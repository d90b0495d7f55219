//! What a textile gives at any velocity: over its points for maps, over directions and speeds for
//! curves.
//!
//! Along an axis a contactor feels the spectrum of one point. Where spectra were measured along one
//! profile, a textile at one velocity is therefore two short rows of squared amplitudes, one over
//! its warp points and one over its weft points, and `A²(u, w)` is the sum of an entry of each:
//! least, largest and mean square over all pairs of points are sums of those over either row. Areal
//! spectra are the same with two tables over all of the cloth, whose entries belong together. For
//! inspection, off the real-time path; computes as `reference` does, with the filters' gains found
//! once a speed instead of once a point.

use std::sync::Arc;

use super::trace::ContactInspector;
use crate::plan::{Axis, Component, PointGrid};
use selvedge_foundation::geometry::{Rotation, Velocity};
use selvedge_textile::surface::{Direction, LocalSpectra, Surface};
use selvedge_textile::tactile::{Filters, SpeedResponse};

/// One textile as it is heard through filters and gains, apart from where it lies: cheap to clone,
/// and free to go to another thread.
#[derive(Debug, Clone)]
pub struct TextileResponse {
    spectra: [Arc<LocalSpectra>; 4],
    points: [PointGrid; 4],
    textile_from_workspace: Rotation,
    filters: Filters,
    factors: [f64; 2],
}

/// The amplitudes of a textile at one velocity, over all its points.
#[derive(Debug, Clone)]
pub struct VelocityMap {
    rows: [Row; 2],
    factors: [f64; 2],
}

/// Squared amplitudes over the points of one axis, µm², before gains; one point of silence where
/// the axis is not felt.
#[derive(Debug, Clone)]
struct Row {
    grid: PointGrid,
    squared_um2: Vec<[f64; 2]>,
}

impl Row {
    fn silent() -> Self {
        Self {
            grid: PointGrid::new([1, 1]),
            squared_um2: vec![[0.0; 2]],
        }
    }

    /// Of the point that stands so many along and so many across, which repeat.
    fn at(&self, along: usize, across: usize) -> [f64; 2] {
        let [n_along, n_across] = self.grid.n_points();
        let number = self.grid.number([along % n_along, across % n_across]);
        self.squared_um2[number]
    }
}

/// `[A40, A320]` over the points of a textile at one velocity, µm peak, after gains.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointSpread {
    /// At the points nearest to the place that was asked for.
    pub at_place_um: Option<[f64; 2]>,
    /// Root mean square over all pairs of a warp point and a weft point.
    pub rms_um: [f64; 2],
    /// The smallest of all pairs.
    pub min_um: [f64; 2],
    /// The largest of all pairs.
    pub max_um: [f64; 2],
}

impl PointSpread {
    /// The same after gains: every amplitude times the factor of its band.
    #[must_use]
    pub fn scaled(&self, factors: [f64; 2]) -> Self {
        let scaled = |um: [f64; 2]| [0, 1].map(|b| um[b] * factors[b]);
        Self {
            at_place_um: self.at_place_um.map(scaled),
            rms_um: scaled(self.rms_um),
            min_um: scaled(self.min_um),
            max_um: scaled(self.max_um),
        }
    }
}

/// Squared amplitudes along one axis, µm², before gains.
#[derive(Debug, Clone, Default)]
struct Powers {
    at_place: [f64; 2],
    mean: [f64; 2],
    min: [f64; 2],
    max: [f64; 2],
    /// Of every point, where they vary across the axis.
    all: Option<Row>,
}

impl ContactInspector {
    /// One textile of the scene with its gains as they are now; `None` when there is no such one.
    pub fn response(&self, textile: usize) -> Option<TextileResponse> {
        let placed = self.plan.textiles.get(textile)?;
        Some(TextileResponse {
            spectra: placed
                .spectra
                .map(|place| Arc::clone(&self.plan.pool[place])),
            points: placed.points,
            textile_from_workspace: placed.ground.textile_from_workspace,
            filters: self.filters,
            factors: self.gains.factors(textile),
        })
    }
}

impl TextileResponse {
    /// A surface by itself, lying straight, without gains.
    pub fn of_surface(surface: &Surface, filters: &Filters) -> Self {
        let spectra = Direction::ALL.map(|direction| Arc::clone(surface.spectra(direction)));
        Self {
            points: spectra
                .each_ref()
                .map(|found| PointGrid::new(found.shape())),
            spectra,
            textile_from_workspace: Rotation::NONE,
            filters: *filters,
            factors: [1.0; 2],
        }
    }

    /// Whether both hear the same spectra, placed alike, through the same filters and gains.
    pub fn is_same(&self, other: &Self) -> bool {
        let bits = |response: &Self| response.factors.map(f64::to_bits);
        self.is_same_cloth(other) && bits(self) == bits(other)
    }

    /// The same but for the gains.
    pub fn is_same_cloth(&self, other: &Self) -> bool {
        let pairs = self.spectra.iter().zip(&other.spectra);
        pairs
            .into_iter()
            .all(|(own, other)| Arc::ptr_eq(own, other))
            && self.filters == other.filters
            && self.textile_from_workspace == other.textile_from_workspace
    }

    /// The same without its gains: amplitudes as the surface gives them.
    #[must_use]
    pub fn without_gains(mut self) -> Self {
        self.factors = [1.0; 2];
        self
    }

    /// The amplitude factors of its gains, by band.
    pub fn factors(&self) -> [f64; 2] {
        self.factors
    }

    /// A velocity of the workspace as the textile's own frame sees it: x along its warp, y along
    /// its weft.
    pub fn along(&self, workspace: Velocity) -> Velocity {
        self.textile_from_workspace.turn_velocity(workspace)
    }

    /// The points that a place along warp and weft, mm, reads: one for each direction.
    pub fn points_at(&self, place_mm: [f64; 2]) -> [usize; 4] {
        let point = |direction: Direction| {
            let d = direction.index();
            self.points[d].nearest(place_mm[d / 2], place_mm[1 - d / 2])
        };
        Direction::ALL.map(point)
    }

    /// The amplitudes over all points at a velocity in the textile's frame.
    pub fn map(&self, velocity: Velocity) -> VelocityMap {
        let row = |(direction, response)| self.row(direction, &response);
        VelocityMap {
            rows: Axis::BOTH.map(|axis| self.felt(axis, velocity).map_or_else(Row::silent, row)),
            factors: self.factors,
        }
    }

    /// The direction of a movement along an axis, and the filters at its speed; `None` where it is
    /// not felt.
    fn felt(&self, axis: Axis, velocity: Velocity) -> Option<(Direction, SpeedResponse)> {
        let components = [velocity.x_mm_per_s, velocity.y_mm_per_s];
        match Component::of(components[axis as usize]) {
            Component::Felt {
                speed_mm_per_s,
                is_reverse,
            } => {
                let response = SpeedResponse::at(speed_mm_per_s, &self.filters);
                Some((axis.direction(is_reverse), response))
            }
            Component::AtRest | Component::TooFast => None,
        }
    }

    fn row(&self, direction: Direction, response: &SpeedResponse) -> Row {
        let d = direction.index();
        Row {
            grid: self.points[d],
            squared_um2: squared_um2(&self.spectra[d], response).collect(),
        }
    }

    /// The amplitudes at a velocity in the textile's frame; `points` are those of a place, one for
    /// each direction.
    pub fn at(&self, velocity: Velocity, points: Option<[usize; 4]>) -> PointSpread {
        let [warp, weft] = Axis::BOTH.map(|axis| {
            let felt = self.felt(axis, velocity);
            felt.map_or_else(Powers::default, |(direction, response)| {
                self.powers(direction, &response, points)
            })
        });
        self.spread([&warp, &weft], points.is_some())
    }

    /// The amplitudes over the direction of movement at a speed: `4·n_a_quarter` directions,
    /// counter-clockwise, the first along the warp.
    pub fn by_direction(
        &self,
        speed_mm_per_s: f64,
        points: Option<[usize; 4]>,
        n_a_quarter: usize,
    ) -> Vec<PointSpread> {
        let n = n_a_quarter.max(1);
        // Components of all four quarters are those of the first, with their signs.
        let quarter: Vec<[Powers; 4]> = (0..=n)
            .map(|step| {
                let component = speed_mm_per_s * share_of_quarter(step, n);
                let response = SpeedResponse::at(component, &self.filters);
                Direction::ALL.map(|direction| self.powers(direction, &response, points))
            })
            .collect();
        let spread = |k: usize| {
            let (straight, across) = (&quarter[k % n], &quarter[n - k % n]);
            let [warp, weft] = match k / n {
                0 => [&straight[0], &across[2]],
                1 => [&across[1], &straight[2]],
                2 => [&straight[1], &across[3]],
                _ => [&across[0], &straight[3]],
            };
            self.spread([warp, weft], points.is_some())
        };
        (0..4 * n).map(spread).collect()
    }

    fn powers(
        &self,
        direction: Direction,
        response: &SpeedResponse,
        points: Option<[usize; 4]>,
    ) -> Powers {
        let row = self.row(direction, response);
        let mut powers = Powers {
            min: [f64::INFINITY; 2],
            ..Powers::default()
        };
        for squared in &row.squared_um2 {
            for (b, &squared) in squared.iter().enumerate() {
                powers.mean[b] += squared;
                powers.min[b] = powers.min[b].min(squared);
                powers.max[b] = powers.max[b].max(squared);
            }
        }
        let n_points = row.squared_um2.len() as f64;
        powers.mean = powers.mean.map(|sum| sum / n_points);
        let point = points.map(|points| points[direction.index()]);
        let at_place = point.and_then(|point| row.squared_um2.get(point));
        powers.at_place = at_place.copied().unwrap_or_default();
        powers.all = (row.grid.n_points()[1] > 1).then_some(row);
        powers
    }

    fn spread(&self, [warp, weft]: [&Powers; 2], has_place: bool) -> PointSpread {
        let together =
            |pick: fn(&Powers) -> [f64; 2]| amplitudes(pick(warp), pick(weft), self.factors);
        let [min_um, max_um] = self.ends_um([warp, weft]);
        PointSpread {
            at_place_um: has_place.then(|| together(|powers| powers.at_place)),
            rms_um: together(|powers| powers.mean),
            min_um,
            max_um,
        }
    }

    /// The smallest and the largest amplitudes of any place, µm.
    fn ends_um(&self, [warp, weft]: [&Powers; 2]) -> [[f64; 2]; 2] {
        let (Some(along_warp), Some(along_weft)) = (&warp.all, &weft.all) else {
            // Every warp point meets every weft point.
            return [(warp.min, weft.min), (warp.max, weft.max)]
                .map(|(warp, weft)| amplitudes(warp, weft, self.factors));
        };
        let [n_warp, n_weft] = along_warp.grid.n_points();
        let (mut min, mut max) = ([f64::INFINITY; 2], [0.0_f64; 2]);
        for w in 0..n_weft {
            for u in 0..n_warp {
                let (warp, weft) = (along_warp.at(u, w), along_weft.at(w, u));
                for b in 0..2 {
                    min[b] = min[b].min(warp[b] + weft[b]);
                    max[b] = max[b].max(warp[b] + weft[b]);
                }
            }
        }
        [min, max].map(|squared| amplitudes(squared, [0.0; 2], self.factors))
    }
}

/// The amplitudes of squared ones along either axis.
fn amplitudes(warp_um2: [f64; 2], weft_um2: [f64; 2], factors: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|b| (warp_um2[b] + weft_um2[b]).sqrt() * factors[b])
}

/// The component that a movement `step` of `n` steps of a quarter turn away from an axis has along
/// it: 1 at 0, exactly 0 at n.
fn share_of_quarter(step: usize, n: usize) -> f64 {
    if step == n {
        return 0.0;
    }
    (std::f64::consts::FRAC_PI_2 * step as f64 / n as f64).cos()
}

fn squared_um2(spectra: &LocalSpectra, response: &SpeedResponse) -> impl Iterator<Item = [f64; 2]> {
    (0..spectra.n_points()).map(|point| response.squared_amplitudes_um2(spectra.powers_um2(point)))
}

impl VelocityMap {
    /// Points along warp and weft after which the map repeats; 1 along an axis that is not felt.
    pub fn n_points(&self) -> [usize; 2] {
        let [warp, weft] = self.rows.each_ref().map(|row| row.grid.n_points());
        // Of an axis that is not felt, the other one tells how far it varies across.
        [warp[0].max(weft[1]), weft[0].max(warp[1])]
    }

    /// `[A40, A320]` at a pair of a warp point and a weft point, µm peak, after gains.
    ///
    /// # Panics
    /// When there are no such points.
    pub fn at_points_um(&self, points: [usize; 2]) -> [f64; 2] {
        let [u, w] = points;
        amplitudes(self.rows[0].at(u, w), self.rows[1].at(w, u), self.factors)
    }

    /// `[A40, A320]` at a place along warp and weft, mm, µm peak, after gains.
    pub fn amplitudes_um(&self, place_mm: [f64; 2]) -> [f64; 2] {
        let [u_mm, w_mm] = place_mm;
        let [warp, weft] = &self.rows;
        let warp_um2 = warp.squared_um2[warp.grid.nearest(u_mm, w_mm)];
        let weft_um2 = weft.squared_um2[weft.grid.nearest(w_mm, u_mm)];
        amplitudes(warp_um2, weft_um2, self.factors)
    }
}
