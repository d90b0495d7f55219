//! The spatial spectra under a contactor, and which of their bins sound at its speed.

use selvedge_render::array::ContactTrace;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction, Surface};
use selvedge_textile::tactile::MAX_FREQUENCY_HZ;

use crate::bench::signals::rows::LEAST_HZ;

/// Ends of the densities that are shown, dB re 1 µm² per cycle/mm.
pub(crate) const DENSITIES_DB: [f64; 2] = [-60.0, 40.0];

/// The wavenumber of bin k = 1 … 500, cycles/mm.
pub(crate) fn wavenumber_per_mm(k: usize) -> f64 {
    BIN_SPACING_PER_MM * k as f64
}

/// The level of a density in µm² per cycle/mm, dB.
pub(crate) fn density_db(density_um2_mm: f64) -> f64 {
    10.0 * density_um2_mm.log10()
}

/// The spectra of all four directions at the points nearest to a contactor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpatialView {
    /// By [`Direction::index`].
    pub curves: [SpatialCurve; 4],
    /// What is felt along warp and weft.
    pub felt: [Option<Felt>; 2],
}

/// The spectrum of one direction at one point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpatialCurve {
    /// Which of the four.
    pub direction: Direction,
    /// The direction whose profile it comes from: itself, or its fall-back.
    pub taken_from: Direction,
    /// The point of its profile, 1 mm apart.
    pub point: usize,
    /// Power density of every bin, µm² per cycle/mm: its power over 0.23 cycles/mm, one-sided.
    pub(crate) density_um2_mm: Vec<f64>,
}

/// A direction that a contactor moves in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Felt {
    /// Which of the four.
    pub direction: Direction,
    /// How fast, mm/s.
    pub speed_mm_per_s: f64,
}

impl SpatialView {
    /// The spectra under a contactor on its textile's surface; `None` outside every textile.
    pub(crate) fn of(trace: &ContactTrace, surface: &Surface) -> Option<Self> {
        let touch = trace.touch.as_ref()?;
        let curves = Direction::ALL.map(|direction| {
            let spectra = surface.spectra(direction);
            let point = touch.points[direction.index()];
            let powers_um2 = if point < spectra.n_points() {
                spectra.powers_um2(point)
            } else {
                &[]
            };
            let density = |power_um2: &f64| power_um2 / BIN_SPACING_PER_MM;
            SpatialCurve {
                direction,
                taken_from: surface.taken_from(direction),
                point,
                density_um2_mm: powers_um2.iter().map(density).collect(),
            }
        });
        let felt = [0, 1].map(|axis: usize| {
            let direction = touch.directions[axis].as_ref()?.direction;
            let speed_mm_per_s = touch.velocity_mm_per_s[axis].abs();
            Some(Felt {
                direction,
                speed_mm_per_s,
            })
        });
        Some(Self { curves, felt })
    }

    /// What is felt in a direction.
    pub(crate) fn felt_in(&self, direction: Direction) -> Option<Felt> {
        let felt = self.felt.iter().flatten();
        felt.copied().find(|felt| felt.direction == direction)
    }

    /// The faster of the directions that are felt; of equals the warp.
    pub(crate) fn fastest(&self) -> Option<Felt> {
        let [warp, weft] = self.felt;
        match (warp, weft) {
            (Some(warp), Some(weft)) if weft.speed_mm_per_s > warp.speed_mm_per_s => Some(weft),
            (None, weft) => weft,
            (warp, _) => warp,
        }
    }
}

impl Felt {
    /// The wavenumber that sounds at a frequency, cycles/mm.
    pub(crate) fn wavenumber_per_mm(self, frequency_hz: f64) -> f64 {
        frequency_hz / self.speed_mm_per_s
    }

    /// Whether a wavenumber sounds between 10 Hz and 1 kHz.
    pub(crate) fn sounds(self, wavenumber_per_mm: f64) -> bool {
        let frequency_hz = wavenumber_per_mm * self.speed_mm_per_s;
        (LEAST_HZ..MAX_FREQUENCY_HZ).contains(&frequency_hz)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use selvedge_foundation::geometry::Velocity;
    use selvedge_render::array::ContactInspector;
    use selvedge_render::scene::Pose;
    use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
    use selvedge_textile::surface::{Profile, ProfileSet};
    use std::sync::Arc;

    /// A sine of 1 µm, 230·0.02/2π = 0.732 cycles/mm, along the warp of one textile.
    pub(crate) fn scene() -> RenderScene {
        let heights = (0..4600).map(|i| (f64::from(i) * 0.02).sin()).collect();
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(Profile::new(1.0 / 230.0, heights).unwrap());
        let surface = Surface::from_profiles(profiles, 0.0).unwrap();
        let textile = PlacedSurface {
            workspace_from_textile: selvedge_foundation::geometry::Frame::default(),
            size_mm: [50.0, 50.0],
            manifest_gain_db: 0.0,
            scene_gain_db: 0.0,
            scene_band_gains_db: [0.0; 2],
            within_mm: None,
            level: PlacedLevel::Silent,
            surface: Arc::new(surface),
        };
        let array = ContactorArray {
            offsets: vec![selvedge_foundation::geometry::Displacement::default()],
            rotation_deg: 0.0,
        };
        RenderScene {
            textiles: vec![textile],
            displays: vec![array],
            ..RenderScene::default()
        }
    }

    fn view_at(position: [f64; 2], velocity: [f64; 2]) -> Option<SpatialView> {
        let scene = scene();
        let pose = Pose {
            position: position.into(),
            velocity: Velocity::new(velocity[0], velocity[1]),
            ..Pose::default()
        };
        let trace = ContactInspector::new(&scene).trace(0, 0, &pose)?;
        SpatialView::of(&trace, &scene.textiles[0].surface)
    }

    #[test]
    fn all_four_spectra_are_those_of_the_nearest_points() {
        let view = view_at([3.2, 5.0], [-50.0, 0.0]).unwrap();
        let points: Vec<usize> = view.curves.iter().map(|curve| curve.point).collect();
        assert_eq!(points, [3, 3, 5, 5]);
        assert!(
            view.curves
                .iter()
                .all(|c| c.taken_from == Direction::WarpForward)
        );
        let surface = &scene().textiles[0].surface;
        let power = surface.spectra(Direction::WarpReverse).powers_um2(3)[2];
        assert_eq!(view.curves[1].density_um2_mm[2], power / 0.23);
    }

    #[test]
    fn what_sounds_depends_on_the_speed() {
        let view = view_at([3.2, 5.0], [-50.0, 20.0]).unwrap();
        let fast = view.fastest().unwrap();
        assert_eq!(fast.direction, Direction::WarpReverse);
        assert_eq!(fast.wavenumber_per_mm(40.0), 0.8);
        assert!(
            fast.sounds(0.2) && !fast.sounds(0.19) && !fast.sounds(20.0),
            "10 Hz to 1 kHz"
        );
        assert_eq!(view.felt_in(Direction::WarpForward), None);
        assert_eq!(
            view.felt_in(Direction::WeftForward)
                .map(|f| f.speed_mm_per_s),
            Some(20.0)
        );
        let still = view_at([3.2, 5.0], [0.0, f64::NAN]).unwrap();
        assert_eq!((still.felt, still.fastest()), ([None; 2], None));
    }

    #[test]
    fn outside_every_textile_there_is_nothing_to_see() {
        assert_eq!(view_at([-3.0, 5.0], [50.0, 0.0]), None);
        assert_eq!(view_at([f64::NAN, 5.0], [50.0, 0.0]), None);
    }
}
