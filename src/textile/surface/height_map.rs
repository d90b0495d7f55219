//! A height map: heights over a rectangle of textile, some of which may be missing.
//!
//! Columns run along u (the warp), rows along w (the weft); row 0 is at the lowest w. What is
//! missing stays marked as missing when it is filled for analysis.

use super::error::MAX_HEIGHT_UM;
use super::tracks::Tracks;
use super::{Direction, Probe, Profile, ProfileSet, SurfaceError};
use selvedge_foundation::numerics::{Grid, Random, to_index};

/// Most points of a map: 64 million, half a gigabyte of heights.
pub(crate) const MAX_POINTS: usize = 64_000_000;

/// Heights in µm over a grid with even steps; a missing height is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    heights_um: Grid<f64>,
    step_mm: [f64; 2],
    is_periodic: bool,
}

impl HeightMap {
    /// A map of heights in µm, `step_mm` apart along u and w. Infinite heights count as missing.
    ///
    /// # Errors
    /// A step outside 0.0005–0.5 mm; a height beyond ten thousand kilometres; no height at all.
    pub fn new(mut heights_um: Grid<f64>, step_mm: [f64; 2]) -> Result<Self, SurfaceError> {
        for step_mm in step_mm {
            if !(0.0005..=0.5).contains(&step_mm) {
                return Err(SurfaceError::Step { step_mm });
            }
        }
        for height in heights_um.values_mut() {
            if !height.is_finite() {
                *height = f64::NAN;
            }
        }
        let is_too_high = |height: &f64| height.abs() > MAX_HEIGHT_UM;
        if let Some(index) = heights_um.values().iter().position(is_too_high) {
            return Err(SurfaceError::TooHigh {
                row: index / heights_um.width() + 1,
                n_rows: heights_um.height(),
                height_um: heights_um.values()[index],
            });
        }
        if heights_um.values().iter().all(|height| height.is_nan()) {
            return Err(SurfaceError::AllMissing);
        }
        Ok(Self {
            heights_um,
            step_mm,
            is_periodic: false,
        })
    }

    /// The same map as one repeat of a surface without end.
    #[must_use]
    pub fn periodic(self) -> Self {
        Self {
            is_periodic: true,
            ..self
        }
    }

    /// Whether it is one repeat of a surface without end.
    pub fn is_periodic(&self) -> bool {
        self.is_periodic
    }

    /// Heights, µm, columns along u and rows along w; NaN where missing.
    pub fn heights_um(&self) -> &Grid<f64> {
        &self.heights_um
    }

    /// Steps along u and w, mm.
    pub fn step_mm(&self) -> [f64; 2] {
        self.step_mm
    }

    /// Extent along u and w, mm: points times step.
    pub fn size_mm(&self) -> [f64; 2] {
        let n = [self.heights_um.width(), self.heights_um.height()];
        [0, 1].map(|axis| n[axis] as f64 * self.step_mm[axis])
    }

    /// Points without a height.
    pub fn n_missing(&self) -> usize {
        let values = self.heights_um.values().iter();
        values.filter(|height| height.is_nan()).count()
    }

    /// Mean height of the points that have one, µm.
    pub fn mean_um(&self) -> f64 {
        let (n, sum) = self
            .present()
            .fold((0.0, 0.0), |(n, sum), z| (n + 1.0, sum + z));
        sum / n
    }

    /// Sq: root mean square deviation from the mean, of the points that have a height, µm
    /// (ISO 25178-2, without levelling or filtering).
    pub fn sq_um(&self) -> f64 {
        self.deviation(|d| d * d).sqrt()
    }

    /// Sa: mean absolute deviation from the mean, of the points that have a height, µm.
    pub fn sa_um(&self) -> f64 {
        self.deviation(f64::abs)
    }

    fn present(&self) -> impl Iterator<Item = f64> + '_ {
        let values = self.heights_um.values().iter().copied();
        values.filter(|height| !height.is_nan())
    }

    fn deviation(&self, measure: impl Fn(f64) -> f64) -> f64 {
        let mean = self.mean_um();
        let (n, sum) = self
            .present()
            .fold((0.0, 0.0), |(n, sum), z| (n + 1.0, sum + measure(z - mean)));
        sum / n
    }

    /// The map with heights that are so many times as large.
    #[must_use]
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self {
            heights_um: self.heights_um.map(|height| height * factor),
            ..*self
        }
    }

    /// The map with other heights.
    #[must_use]
    pub(super) fn with_heights(&self, heights_um: Grid<f64>) -> Self {
        Self {
            heights_um,
            ..*self
        }
    }

    /// The map with every missing point filled: along its row and along its column between the
    /// nearest points that are there (the nearest one beyond them), the mean of both; rows and
    /// columns that are wholly missing take what the other way gives, then the mean height.
    #[must_use]
    pub fn filled(&self) -> Self {
        if self.n_missing() == 0 {
            return self.clone();
        }
        let along_rows = filled_along_rows(&self.heights_um);
        let along_columns = filled_along_rows(&self.heights_um.transposed()).transposed();
        let mean = self.mean_um();
        let both = along_rows.values().iter().zip(along_columns.values());
        let either = both.map(|(&a, &b)| match (a.is_nan(), b.is_nan()) {
            (false, false) => 0.5 * (a + b),
            (false, true) => a,
            (true, false) => b,
            (true, true) => mean,
        });
        let mut heights_um = self.heights_um.clone();
        for (height, fill) in heights_um.values_mut().iter_mut().zip(either) {
            if height.is_nan() {
                *height = fill;
            }
        }
        Self {
            heights_um,
            ..*self
        }
    }

    /// Heights along a strip of textile, µm: a row for every track across it, columns along the
    /// stroke. `is_weft`: the stroke runs along w. A strip that leaves a periodic map goes on at
    /// its other side; one that leaves another map ends at its edge. Missing points are filled.
    pub fn strip(
        &self,
        is_weft: bool,
        middle_mm: f64,
        width_mm: f64,
        n_beyond: usize,
    ) -> Grid<f64> {
        Tracks::of(self, is_weft).strip(middle_mm, width_mm, n_beyond)
    }

    /// What the virtual tester records of four strokes over the map, along u at `middle_mm[1]` and
    /// along w at `middle_mm[0]`, by [`Direction::index`]. A periodic map is stroked over a whole
    /// number of repeats, 20 mm or more.
    ///
    /// # Errors
    /// A map that is no surface for a profile; shorter than one window and not periodic.
    pub fn strokes(
        &self,
        probe: &Probe,
        middle_mm: [f64; 2],
        random: &Random,
    ) -> Result<ProfileSet, (Direction, SurfaceError)> {
        let mut profiles = ProfileSet::default();
        for (is_weft, pair) in [false, true].into_iter().zip(Direction::BY_AXIS) {
            let step_mm = self.step_mm[usize::from(is_weft)];
            let across_mm = middle_mm[usize::from(!is_weft)];
            let lift = self.lift_um(probe, is_weft, across_mm);
            for direction in pair {
                let mut noise = random.branch(direction.key());
                let heights = probe.stroke(&lift, step_mm, direction.is_reverse(), &mut noise);
                let profile = Profile::new(step_mm, heights).map_err(|error| (direction, error))?;
                profiles[direction.index()] = Some(profile);
            }
        }
        Ok(profiles)
    }

    /// The height of the tester's wire along a stroke, µm, about its mean.
    fn lift_um(&self, probe: &Probe, is_weft: bool, across_mm: f64) -> Vec<f64> {
        let step_mm = self.step_mm[usize::from(is_weft)];
        let margin = probe.margin_samples(step_mm);
        let n = [self.heights_um.width(), self.heights_um.height()][usize::from(is_weft)];
        // What repeats is stroked for 20 mm, in whole repeats, so that its end fits its beginning.
        let n_repeats = if self.is_periodic {
            to_index((STROKE_MM / (n as f64 * step_mm)).ceil()).max(1)
        } else {
            1
        };
        let strip = self.strip(is_weft, across_mm, probe.width_mm, margin);
        let lift = probe.lift_um(&strip, step_mm);
        let mean = lift.iter().sum::<f64>() / lift.len().max(1) as f64;
        let one: Vec<f64> = lift.iter().map(|height| height - mean).collect();
        one.repeat(n_repeats)
    }
}

/// Length of a stroke over what repeats, mm.
const STROKE_MM: f64 = 20.0;

/// Every row filled between its nearest heights; rows without any stay missing.
fn filled_along_rows(grid: &Grid<f64>) -> Grid<f64> {
    let mut filled = grid.clone();
    for row in 0..grid.height() {
        fill_gaps(filled.row_mut(row));
    }
    filled
}

/// Fills gaps between heights by straight lines, and those at either end by the nearest height.
fn fill_gaps(heights: &mut [f64]) {
    let mut last: Option<usize> = None;
    for i in 0..heights.len() {
        if heights[i].is_nan() {
            continue;
        }
        let from = last.map_or(0, |last| last + 1);
        let (first, end) = (last.map_or(heights[i], |last| heights[last]), heights[i]);
        let n = (i + 1 - from) as f64;
        for (step, gap) in (1_u32..).zip(&mut heights[from..i]) {
            *gap = first + (end - first) * f64::from(step) / n;
        }
        last = Some(i);
    }
    if let Some(last) = last {
        let height = heights[last];
        heights[last + 1..].fill(height);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Levelling;
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// A map of 400 × 300 points, 0.05 mm apart.
    fn map(height_um: impl Fn(f64, f64) -> f64) -> HeightMap {
        let (step_mm, width, height) = (0.05, 400_u16, 300_u16);
        let mut values = Vec::new();
        for row in 0..height {
            for column in 0..width {
                values.push(height_um(
                    f64::from(column) * step_mm,
                    f64::from(row) * step_mm,
                ));
            }
        }
        let grid = Grid::from_rows(usize::from(width), values).unwrap();
        HeightMap::new(grid, [step_mm, step_mm]).unwrap()
    }

    #[test]
    fn roughness_figures_of_a_sinusoid_are_the_closed_forms() {
        let sine = map(|u, _| 10.0 + 3.0 * (TAU * u / 2.0).sin());
        assert!((sine.sq_um() - 3.0 / 2.0_f64.sqrt()).abs() < 1e-9);
        assert!((sine.sa_um() - 6.0 / PI).abs() < 1e-2);
        assert!((sine.mean_um() - 10.0).abs() < 1e-9);
        assert_eq!(sine.n_missing(), 0);
    }

    #[test]
    fn a_plane_is_levelled_to_nothing_also_with_holes() {
        let tilted = |u: f64, w: f64| {
            let is_hole = (u - 5.0).hypot(w - 4.0) < 2.0;
            if is_hole {
                f64::NAN
            } else {
                7.0 + 2.0 * u - 0.5 * w
            }
        };
        let level = map(tilted).levelled(Levelling::Plane);
        assert!(level.sq_um() < 1e-9 && level.mean_um().abs() < 1e-9);
        let filled = map(tilted).filled();
        assert_eq!(filled.n_missing(), 0);
        let exact = map(|u, w| 7.0 + 2.0 * u - 0.5 * w);
        let pairs = filled
            .heights_um()
            .values()
            .iter()
            .zip(exact.heights_um().values());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9));
        assert!(
            map(tilted).n_missing() > 4000,
            "the map itself keeps its holes"
        );
    }

    #[test]
    fn rows_and_corners_without_a_height_take_what_is_nearest() {
        let map = map(|u, w| {
            if w < 1.0 || u > 15.0 {
                f64::INFINITY
            } else {
                w
            }
        });
        assert!(map.n_missing() > 0, "infinite counts as missing");
        let filled = map.filled();
        assert_eq!(filled.n_missing(), 0);
        assert!((filled.heights_um().row(0)[0] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_map_without_a_height_or_with_a_wild_step_is_refused() {
        let nothing = Grid::filled(4, 4, f64::NAN);
        let refused = HeightMap::new(nothing, [0.1, 0.1]).unwrap_err();
        assert_eq!(refused, SurfaceError::AllMissing);
        let mut spiked = Grid::filled(4, 4, 0.0);
        spiked.row_mut(2)[1] = -1e20;
        let refused = HeightMap::new(spiked, [0.1, 0.1]).unwrap_err().to_string();
        assert!(
            refused.starts_with("row 3 of 4: the height is -1e20 µm"),
            "{refused}"
        );
        for step_mm in [0.0, -1.0, f64::NAN, 0.6] {
            assert!(HeightMap::new(Grid::filled(4, 4, 0.0), [0.1, step_mm]).is_err());
        }
    }

    #[test]
    fn strokes_read_the_ripple_that_they_cross_and_not_the_one_they_follow() {
        let ripple = map(|u, _| 3.0 * (TAU * u / 2.0).sin());
        let profiles = ripple
            .strokes(&Probe::ideal(), [10.0, 7.5], &Random::new(1))
            .unwrap();
        let smd = |direction: Direction| profiles[direction.index()].as_ref().unwrap().smd_um();
        let expected = 6.0 / PI;
        assert!((smd(Direction::WarpForward) / expected - 1.0).abs() < 0.02);
        assert!(smd(Direction::WeftForward) < 1e-9);
        let forward = profiles[0].as_ref().unwrap().heights_um().to_vec();
        let mut back = profiles[1].as_ref().unwrap().heights_um().to_vec();
        back.reverse();
        let same = forward.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(same, "without friction both ways read alike");
    }

    #[test]
    fn what_repeats_is_stroked_in_whole_repeats_of_20_mm_or_more() {
        let grid = |n: u16| {
            let row = |i: u16| (TAU * f64::from(i) / f64::from(n)).sin();
            let values: Vec<f64> = (0..n).flat_map(|_| (0..n).map(row)).collect();
            Grid::from_rows(usize::from(n), values).unwrap()
        };
        let tile = HeightMap::new(grid(30), [0.1, 0.1]).unwrap().periodic();
        let profiles = tile
            .strokes(&Probe::ideal(), [1.0, 1.0], &Random::new(1))
            .unwrap();
        let heights = profiles[0].as_ref().unwrap().heights_um();
        assert_eq!(heights.len(), 7 * 30, "3 mm seven times");
        let jump = (heights[0] - heights[30]).abs();
        assert!(jump < 1e-12, "no seam: {jump}");
    }
}
