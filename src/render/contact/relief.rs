//! What a tip rests on: heights with gradients, between the points that were measured.
//!
//! Heights lie on lattices: one of an area, or one along the warp and one along the weft, whose
//! heights add up. Between points they are cubic (Catmull & Rom 1974) along both axes, so that
//! height and gradient are continuous everywhere, also at the ends: what repeats goes on at its
//! other side, all else by its mirror image.
//!
//! A sphere of radius r whose lowest point is at (u, w, z) touches where z reaches the dilation
//! `d(u, w) = max_{s² + q² ≤ r²} h(u + s, w + q) + √(r² − s² − q²) − r`. It is taken at the points
//! once, when preparing (`rolling.rs`), and interpolated as heights are: valleys narrower than the
//! sphere vanish.
#![expect(
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "numbers of samples: at most 64 million, and never negative once they are placed"
)]

use super::rolling::dilated;
use crate::RenderError;
use selvedge_foundation::numerics::{Grid, catmull_rom, to_whole};
use selvedge_textile::surface::{Direction, HeightMap, Profile, Surface};

/// A surface as a tip meets it, in the textile's frame: u along the warp, w along the weft.
#[derive(Debug, Clone, Default)]
pub struct Relief {
    /// Their heights add up; none are flat.
    lattices: Vec<Lattice>,
}

/// Height and gradient at a place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Spot {
    pub(super) height_mm: f64,
    /// Along u and w, mm a mm.
    pub(super) slope: [f64; 2],
}

#[derive(Debug, Clone)]
struct Lattice {
    heights_mm: Grid<f64>,
    step_mm: [f64; 2],
    /// Whether it goes on at its other side; else by its mirror image.
    is_periodic: bool,
}

impl Relief {
    /// The plane of height 0.
    pub fn flat() -> Self {
        Self::default()
    }

    /// The heights of a map, missing ones filled.
    pub fn of_map(map: &HeightMap) -> Self {
        Self {
            lattices: vec![Lattice {
                heights_mm: map.filled().heights_um().map(|um| 1e-3 * um),
                step_mm: map.step_mm(),
                is_periodic: map.is_periodic(),
            }],
        }
    }

    /// The forward profiles of warp and weft, about their means, added up: what is known of a
    /// surface that was felt along strokes. A weft that was not measured is the warp again, as
    /// it is for the array.
    pub fn of_surface(surface: &Surface) -> Self {
        let of = |(direction, is_weft): (Direction, bool)| {
            let profile = surface.profile(surface.taken_from(direction))?;
            Lattice::of_profile(profile, is_weft)
        };
        let axes = [
            (Direction::WarpForward, false),
            (Direction::WeftForward, true),
        ];
        Self {
            lattices: axes.into_iter().filter_map(of).collect(),
        }
    }

    /// Which reading of a surface it is, for people.
    pub fn reading(&self) -> &'static str {
        match self.lattices.as_slice() {
            [] => "a plane",
            [one] if one.n().into_iter().all(|n| n > 1) => "heights over an area",
            _ => "profiles along warp and weft, added up",
        }
    }

    /// What the lowest point of a sphere rests on: the dilation above.
    ///
    /// # Errors
    /// A radius that is no length, or that covers too many points.
    pub fn under_sphere(&self, radius_mm: f64) -> Result<Self, RenderError> {
        RenderError::within(("tip's radius", radius_mm, "mm"), [0.0, 100.0])?;
        let lattices = self.lattices.iter();
        let dilated: Result<_, _> = lattices.map(|one| one.dilated(radius_mm)).collect();
        Ok(Self { lattices: dilated? })
    }

    /// Height and gradient at a place, mm.
    pub(super) fn at(&self, [u_mm, w_mm]: [f64; 2]) -> Spot {
        let mut spot = Spot::default();
        for lattice in &self.lattices {
            lattice.add_at([u_mm, w_mm], &mut spot);
        }
        spot
    }

    /// Height at a place, mm.
    pub fn height_mm(&self, place_mm: [f64; 2]) -> f64 {
        self.at(place_mm).height_mm
    }
}

impl Lattice {
    fn of_profile(profile: &Profile, is_weft: bool) -> Option<Self> {
        let heights = profile.heights_um();
        let mean = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
        let about_mean = heights.iter().map(|um| 1e-3 * (um - mean)).collect();
        let width = if is_weft { 1 } else { heights.len() };
        Some(Self {
            heights_mm: Grid::from_rows(width, about_mean)?,
            step_mm: [profile.step_mm(); 2],
            is_periodic: false,
        })
    }

    fn n(&self) -> [usize; 2] {
        [self.heights_mm.width(), self.heights_mm.height()]
    }

    fn add_at(&self, place_mm: [f64; 2], spot: &mut Spot) {
        let [n_u, n_w] = self.n();
        let along = Taps::of(place_mm[0] / self.step_mm[0], n_u, self.is_periodic);
        let across = Taps::of(place_mm[1] / self.step_mm[1], n_w, self.is_periodic);
        let (mut height, mut du, mut dw) = (0.0, 0.0, 0.0);
        for tap in 0..across.n {
            let row = self.heights_mm.row(across.index[tap]);
            let (mut value, mut slope) = (0.0, 0.0);
            for i in 0..along.n {
                let sample = row[along.index[i]];
                value += along.weight[i] * sample;
                slope += along.slope[i] * sample;
            }
            height += across.weight[tap] * value;
            du += across.weight[tap] * slope;
            dw += across.slope[tap] * value;
        }
        spot.height_mm += height;
        spot.slope[0] += du / self.step_mm[0];
        spot.slope[1] += dw / self.step_mm[1];
    }

    /// What the lowest point of a sphere rests on at every point.
    fn dilated(&self, radius_mm: f64) -> Result<Self, RenderError> {
        let at = |index: [isize; 2]| {
            let [u, w] = [0, 1].map(|axis| placed(index[axis], self.n()[axis], self.is_periodic));
            self.heights_mm.row(w)[u]
        };
        Ok(Self {
            heights_mm: dilated(&self.heights_mm, self.step_mm, radius_mm, at)?,
            ..*self
        })
    }
}

/// The samples that a place between them is made of, along one axis.
struct Taps {
    n: usize,
    index: [usize; 4],
    weight: [f64; 4],
    /// Derivative of the weights by the place in samples.
    slope: [f64; 4],
}

impl Taps {
    fn of(place: f64, n: usize, is_periodic: bool) -> Self {
        if n == 1 {
            return Self {
                n: 1,
                index: [0; 4],
                weight: [1.0, 0.0, 0.0, 0.0],
                slope: [0.0; 4],
            };
        }
        // Farther than anybody strokes, and no place at all, are some place too.
        let place = place.clamp(-1e12, 1e12);
        let below = place.floor();
        let t = place - below;
        let t2 = t * t;
        let first = to_whole::<isize>(below) - 1;
        let inside = first >= 0 && first as usize + 3 < n;
        let at = |tap: isize| {
            if inside {
                (first + tap) as usize
            } else {
                placed(first + tap, n, is_periodic)
            }
        };
        Self {
            n: 4,
            index: [at(0), at(1), at(2), at(3)],
            weight: catmull_rom(t),
            slope: [
                0.5 * (4.0 * t - 3.0 * t2 - 1.0),
                0.5 * (9.0 * t2 - 10.0 * t),
                0.5 * (8.0 * t - 9.0 * t2 + 1.0),
                0.5 * (3.0 * t2 - 2.0 * t),
            ],
        }
    }
}

/// The sample that stands for a place among `n` and beyond.
fn placed(index: isize, n: usize, is_periodic: bool) -> usize {
    let n = n as isize;
    let inside = if is_periodic {
        index.rem_euclid(n)
    } else {
        let folded = index.rem_euclid(2 * n);
        folded.min(2 * n - 1 - folded)
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A map that repeats nowhere.
    fn map() -> HeightMap {
        let mut random = selvedge_foundation::numerics::Random::new(5);
        let grid = Grid::from_fn(30, 20, |_, _| 40.0 * random.normal());
        HeightMap::new(grid, [0.1, 0.2]).unwrap()
    }

    #[test]
    fn the_gradient_is_that_of_the_height_and_both_are_continuous() {
        let profile = Profile::new(0.1, (0..50).map(|i| f64::from(i * i % 17)).collect());
        let mut profiles = selvedge_textile::surface::ProfileSet::default();
        profiles[0] = profile.ok();
        let lattice = Lattice::of_profile(profiles[0].as_ref().unwrap(), false).unwrap();
        let along = Relief {
            lattices: vec![lattice],
        };
        for relief in [
            Relief::of_map(&map()),
            Relief::of_map(&map().periodic()),
            along,
        ] {
            for nth in -400_i32..800 {
                let place = [0.013 * f64::from(nth), 0.007 * f64::from(nth)];
                let spot = relief.at(place);
                for axis in 0..2 {
                    let near = |by_mm: f64| {
                        let mut place = place;
                        place[axis] += by_mm;
                        relief.at(place)
                    };
                    let (before, after) = (near(-1e-6), near(1e-6));
                    let slope = (after.height_mm - before.height_mm) / 2e-6;
                    assert!((slope - spot.slope[axis]).abs() < 1e-4, "{place:?}");
                    let jump = (after.slope[axis] - before.slope[axis]).abs();
                    assert!(jump < 1e-3, "{place:?}: {jump}");
                }
            }
        }
    }

    #[test]
    fn heights_at_points_are_the_measured_ones_and_go_on_as_is_said() {
        let (map, height) = (map(), |relief: &Relief, u, w| {
            1e3 * relief.height_mm([u, w])
        });
        let at = |column: usize, row: usize| map.heights_um().row(row)[column];
        let (mirrored, again) = (
            Relief::of_map(&map),
            Relief::of_map(&map.clone().periodic()),
        );
        assert!((height(&mirrored, 0.7, 0.6) - at(7, 3)).abs() < 1e-9);
        assert!((height(&mirrored, -0.8, 0.6) - at(7, 3)).abs() < 1e-9);
        assert!((height(&again, 0.7 - 3.0, 0.6 + 8.0) - at(7, 3)).abs() < 1e-9);
        assert_eq!(Relief::flat().height_mm([f64::MAX, 0.0]), 0.0);
    }

    #[test]
    fn a_sphere_rides_on_crests_and_bridges_narrow_valleys() {
        let wave = |column: usize, _| 20.0 * (TAU * column as f64 / 100.0).cos();
        let map = HeightMap::new(Grid::from_fn(100, 1, wave), [0.01, 0.01]).unwrap();
        let sharp = Relief::of_map(&map.periodic());
        let curvature = 0.02 * TAU * TAU;
        let under = |radius_mm| sharp.under_sphere(radius_mm).unwrap();
        for radius_mm in [0.2, 0.9 / curvature, 3.0] {
            let top = under(radius_mm).height_mm([0.0; 2]);
            assert!((top - 0.02).abs() < 1e-12, "{radius_mm}: {top}");
            let bottom = under(radius_mm).height_mm([0.5, 0.0]);
            let is_in = radius_mm * curvature < 1.0;
            assert_eq!(is_in, (bottom + 0.02).abs() < 1e-9, "{radius_mm}: {bottom}");
        }
        let large = 100.0;
        let hung = under(large).height_mm([0.5, 0.0]);
        assert!(
            (hung - 0.02 + 0.125 / large).abs() < 2e-5,
            "between two crests: {hung}"
        );
    }
}
