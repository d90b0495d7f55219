//! Local maxima of the autocorrelation, ranked by the regions that they dominate.
//!
//! A maximum dominates the circle up to the nearest higher one (Liu, Collins and Tsin 2004). That
//! ranks a faint but lonely maximum above the ripples on the flank of a high one, without a
//! threshold of height.

use super::autocorrelation::Autocorrelation;
use super::basis::{Place, length, whole};
use selvedge_foundation::numerics::QuadraticPeak;

/// A local maximum of the autocorrelation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Maximum {
    /// The shift, px, between samples by a quadratic surface.
    pub place: Place,
    /// The correlation there.
    pub height: f64,
    /// Distance to the nearest higher maximum, px; infinite at no shift.
    pub dominance_px: f64,
}

/// The local maxima with positive correlation, highest first; no shift at all is the first.
#[derive(Debug, Clone)]
pub struct Maxima {
    all: Vec<Maximum>,
    buckets: Buckets,
}

impl Maxima {
    /// Finds them.
    pub fn of(rho: &Autocorrelation) -> Self {
        let [reach_x, reach_y] = rho.reach().map(usize::cast_signed);
        let mut all = Vec::new();
        for dy in 0..reach_y {
            for dx in 1 - reach_x..reach_x {
                let is_half = dy > 0 || dx > 0;
                if let (true, Some((place, height))) = (is_half, maximum_at(rho, dx, dy)) {
                    for place in [place, place.map(|x| -x)] {
                        all.push(Maximum {
                            place,
                            height,
                            dominance_px: f64::INFINITY,
                        });
                    }
                }
            }
        }
        all.push(Maximum {
            place: [0.0; 2],
            height: 1.0,
            dominance_px: f64::INFINITY,
        });
        let order = |a: &Maximum, b: &Maximum| {
            let is_origin = |m: &Maximum| length(m.place) > 0.0;
            let by_height = b.height.total_cmp(&a.height);
            let by_place = length(a.place).total_cmp(&length(b.place));
            let by_half = b.place[1]
                .total_cmp(&a.place[1])
                .then(b.place[0].total_cmp(&a.place[0]));
            is_origin(a)
                .cmp(&is_origin(b))
                .then(by_height)
                .then(by_place)
                .then(by_half)
        };
        all.sort_by(order);
        let mut buckets = Buckets::new(rho.reach());
        for (i, maximum) in all.iter_mut().enumerate() {
            maximum.dominance_px = buckets
                .nearest(maximum.place, f64::INFINITY)
                .map_or(f64::INFINITY, |(_, d)| d);
            buckets.insert(maximum.place, i);
        }
        Self { all, buckets }
    }

    /// All of them, highest first.
    pub(crate) fn all(&self) -> &[Maximum] {
        &self.all
    }

    /// One of d and −d each, without the origin, ranked by dominance.
    pub(crate) fn ranked(&self) -> Vec<Maximum> {
        let mut half: Vec<Maximum> = self
            .all
            .iter()
            .filter(|m| is_half(m.place))
            .copied()
            .collect();
        half.sort_by(|a, b| b.dominance_px.total_cmp(&a.dominance_px));
        half
    }

    /// The maximum nearest to a place, and its distance, if within `most` px.
    pub(crate) fn nearest(&self, place: Place, max: f64) -> Option<(&Maximum, f64)> {
        let (i, distance) = self.buckets.nearest(place, max)?;
        Some((self.all.get(i)?, distance))
    }
}

/// Whether a shift is the one of d and −d that stands for both.
pub(super) fn is_half([x, y]: Place) -> bool {
    y > 0.0 || (y >= 0.0 && x > 0.0)
}

/// The place and height of a local maximum at a whole shift. Of a plateau, its first sample.
fn maximum_at(rho: &Autocorrelation, dx: isize, dy: isize) -> Option<(Place, f64)> {
    let middle = rho.at(dx, dy).filter(|&height| height > 0.0)?;
    let mut around = [[0.0; 3]; 3];
    for (j, row) in (-1_isize..).zip(&mut around) {
        for (i, value) in (-1_isize..).zip(row) {
            *value = rho.at(dx + i, dy + j)?;
            let is_before = j < 0 || (j == 0 && i < 0);
            if *value > middle || (is_before && *value >= middle) {
                return None;
            }
        }
    }
    let peak = QuadraticPeak::of(&around);
    let place = [dx as f64 + peak.offset[0], dy as f64 + peak.offset[1]];
    Some((place, peak.height.min(1.0)))
}

/// Side of a bucket, px.
const BUCKET_PX: f64 = 4.0;

/// Points by where they are, to find the nearest.
#[derive(Debug, Clone)]
struct Buckets {
    n: [isize; 2],
    origin: Place,
    points: Vec<Vec<(Place, usize)>>,
}

impl Buckets {
    fn new(reach: [usize; 2]) -> Self {
        let n = reach.map(|r| whole((2.0 * r as f64 / BUCKET_PX).ceil()) + 1);
        Self {
            n,
            origin: reach.map(|r| -(r as f64)),
            points: vec![Vec::new(); (n[0] * n[1]).cast_unsigned()],
        }
    }

    fn bucket(&self, place: Place) -> [isize; 2] {
        [0, 1].map(|i| {
            let at = whole(((place[i] - self.origin[i]) / BUCKET_PX).floor());
            at.clamp(0, self.n[i] - 1)
        })
    }

    fn insert(&mut self, place: Place, index: usize) {
        let [i, j] = self.bucket(place);
        self.points[(j * self.n[0] + i).cast_unsigned()].push((place, index));
    }

    /// The nearest point within `most`, and its distance; of equally near ones the first inserted.
    fn nearest(&self, place: Place, max: f64) -> Option<(usize, f64)> {
        let [ci, cj] = self.bucket(place);
        let mut best: Option<(usize, f64)> = None;
        let rings = self.n[0].max(self.n[1]);
        for ring in 0..rings {
            // Nothing in this ring is nearer than this.
            let min = (ring as f64 - 1.0) * BUCKET_PX;
            if min > best.map_or(max, |(_, d)| d) {
                break;
            }
            for j in (cj - ring).max(0)..=(cj + ring).min(self.n[1] - 1) {
                let is_edge = (j - cj).abs() == ring;
                let step = if is_edge || ring == 0 { 1 } else { 2 * ring };
                let columns = (ci - ring..=ci + ring).step_by(step.cast_unsigned());
                for i in columns.filter(|i| (0..self.n[0]).contains(i)) {
                    for &(point, index) in &self.points[(j * self.n[0] + i).cast_unsigned()] {
                        let distance = (point[0] - place[0]).hypot(point[1] - place[1]);
                        let is_nearer = best.is_none_or(|(_, d)| distance < d);
                        if is_nearer && distance <= max {
                            best = Some((index, distance));
                        }
                    }
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::{Grid, Random};

    #[test]
    fn the_nearest_point_is_found_wherever_it_lies() {
        let mut random = Random::new(8);
        let mut buckets = Buckets::new([50, 40]);
        let mut draw = || {
            [
                random.uniform_in(-50.0, 50.0),
                random.uniform_in(-40.0, 40.0),
            ]
        };
        let points: Vec<Place> = (0..60).map(|_| draw()).collect();
        for (i, &point) in points.iter().enumerate() {
            buckets.insert(point, i);
        }
        for _ in 0..200 {
            let at = draw();
            let distance = |p: &Place| (p[0] - at[0]).hypot(p[1] - at[1]);
            let nearest = points.iter().map(distance).fold(f64::INFINITY, f64::min);
            let (i, d) = buckets.nearest(at, f64::INFINITY).unwrap();
            assert!(
                (d - nearest).abs() < 1e-12 && (distance(&points[i]) - d).abs() < 1e-12,
                "{at:?}"
            );
            assert_eq!(buckets.nearest(at, nearest * 0.99), None);
        }
    }

    #[test]
    fn maxima_of_a_lattice_are_its_points_and_dominate_a_period() {
        let wave = |i: usize| {
            let (x, y) = ((i % 120) as f64, (i / 120) as f64);
            let turn = std::f64::consts::TAU;
            (turn * x / 11.5).cos() + (turn * y / 9.25).cos()
        };
        let picture = Grid::from_rows(120, (0..120 * 100).map(wave).collect()).unwrap();
        let maxima = Maxima::of(&Autocorrelation::of(&picture, 1));
        assert_eq!(maxima.all()[0].place, [0.0; 2]);
        let (found, distance) = maxima.nearest([11.5, 9.25], 1.0).unwrap();
        assert!(distance < 0.1 && found.height > 0.97, "{found:?}");
        let ranked = maxima.ranked();
        let min = ranked.last().unwrap().dominance_px;
        assert!(min > 9.0, "all maxima are lattice points: {min}");
        assert!(
            ranked.is_sorted_by(|a, b| a.dominance_px >= b.dominance_px),
            "ranked"
        );
    }
}
