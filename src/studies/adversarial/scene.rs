//! Amplitudes: a case in numbers, the scene that it stands for, and how near a method of rendering
//! comes to its bound there.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::field::{Field, Range, Spaced, numbers, target};
use crate::{ReportError, textiles};
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_render::RenderScene;
use selvedge_render::array::{
    Accuracy, ArrayRenderer, ContactInspector, ContactorReading, ErrorBound, Method, unfiltered_um,
};
use selvedge_render::scene::Pose;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, HeightMap, Profile, Surface};
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ, MAX_SPEED_MM_PER_S};

/// Length of a profile and side of a relief, mm.
const LENGTH_MM: f64 = 12.0;
/// The middle of a textile either way, mm.
const MIDDLE_MM: f64 = 50.0;
/// Step of a relief, mm.
const RELIEF_STEP_MM: f64 = 0.06;
/// What the reference keeps of the formula, dB and as a share of the unfiltered amplitude.
const ROUNDING: (f64, f64) = (1e-11, 1e-15);

/// A surface, a filter, a place and a motion: a number for each of [`RANGES`].
struct Case([f64; RANGES.len()]);

/// The width of the filters; how fast the display goes, where it heads, where it is, how it is
/// turned and how fast it turns; how the textile lies; the bins of its two waves, and how much
/// weaker the second is; the step of the profile.
const RANGES: [Range; 12] = [
    ("octaves", [0.05, 4.0], Spaced::Log),
    ("speed_mm_per_s", [0.01, 4400.0], Spaced::Log),
    ("heading_deg", [0.0, 360.0], Spaced::Even),
    ("x_mm", [10.0, 90.0], Spaced::Even),
    ("y_mm", [10.0, 90.0], Spaced::Even),
    ("angle_deg", [0.0, 360.0], Spaced::Even),
    ("turn_rad_per_s", [-20.0, 20.0], Spaced::Even),
    ("tilt_deg", [0.0, 360.0], Spaced::Even),
    ("bin", [1.0, 400.0], Spaced::Log),
    ("second_bin", [1.0, 400.0], Spaced::Log),
    ("range_db", [0.0, 200.0], Spaced::Even),
    ("step_mm", [1.0 / 460.0, 0.05], Spaced::Log),
];
const SPEED: usize = 1;
const HEADING: usize = 2;
const TURN: usize = 6;
const TILT: usize = 7;

/// Where a method of rendering may break its bound.
pub(super) const FIELD: Field = Field {
    file: "amplitudes.csv",
    stored: include_str!("amplitudes.csv"),
    ranges: &RANGES,
    lead: Some(straight_over_a_crossing),
    targets: &[
        target("reference", 1, |case| share(case, Method::Reference, false)),
        target("banded", 1, |case| share(case, Method::Banded, false)),
        target("table", 1, |case| share(case, Method::Table, false)),
        target("areal banded", 6, |case| share(case, Method::Banded, true)),
        target("areal table", 6, |case| share(case, Method::Table, true)),
    ],
};

/// Moves straight along a thread, just where a bin crosses 1 kHz.
fn straight_over_a_crossing(case: &mut [f64], random: &mut Random) {
    let crossing = (MAX_SPEED_MM_PER_S / case[SPEED]).round().max(1.0);
    let off = 10.0_f64.powf(random.uniform_in(-16.0, -2.0)) * random.normal().signum();
    case[SPEED] = MAX_SPEED_MM_PER_S / crossing * (1.0 + off);
    for still in [HEADING, TURN, TILT] {
        case[still] = 0.0;
    }
}

fn share(case: &[f64], method: Method, is_areal: bool) -> Result<f64, ReportError> {
    Case(numbers(case)?).share(method, is_areal)
}

impl Case {
    /// The larger error of all contactors and bands as a share of the method's bound.
    fn share(&self, method: Method, is_areal: bool) -> Result<f64, ReportError> {
        let scene = self.scene(is_areal)?;
        let accuracy = Accuracy::default();
        let pose = self.pose();
        let amplitudes = |method: Method| -> Result<(Vec<[f64; 2]>, ErrorBound), ReportError> {
            let mut renderer = ArrayRenderer::prepare(&scene, method, &accuracy)?;
            let bound = renderer.bound();
            let felt = textiles::amplitudes_um(&mut renderer, std::slice::from_ref(&pose));
            Ok((felt.collect(), bound))
        };
        let (found, mut bound) = amplitudes(method)?;
        let exact = if method == Method::Reference {
            (bound.level_db, bound.floor) = ROUNDING;
            by_formula(&scene, &pose)
        } else {
            amplitudes(Method::Reference)?.0
        };
        let unfiltered_um = unfiltered_um(&scene.textiles[0].surface);
        let pairs = found.iter().flatten().zip(exact.iter().flatten());
        let shares = pairs.map(|(a, exact)| bound.share_of(unfiltered_um, [*a, *exact]));
        Ok(shares.fold(0.0, f64::max))
    }

    fn pose(&self) -> Pose {
        let [
            _,
            speed_mm_per_s,
            heading_deg,
            x_mm,
            y_mm,
            angle_deg,
            turn,
            ..,
        ] = self.0;
        let (sin, cos) = heading_deg.to_radians().sin_cos();
        Pose {
            position: Point::new(x_mm, y_mm),
            velocity: Velocity::new(speed_mm_per_s * cos, speed_mm_per_s * sin),
            angle_deg,
            angular_rad_per_s: turn,
            ..Pose::default()
        }
    }

    fn scene(&self, is_areal: bool) -> Result<RenderScene, ReportError> {
        let surface = if is_areal {
            self.areal()?
        } else {
            self.profile()?
        };
        let mut scene = textiles::scene_with(&surface);
        scene.filters = Filters::LogGaussian { octaves: self.0[0] };
        // Turned about its middle, so that the display stays on it.
        let rotation = Rotation::from_degrees(self.0[TILT]);
        let turned = rotation.turn(Displacement::new(MIDDLE_MM, MIDDLE_MM));
        scene.textiles[0].workspace_from_textile = Frame {
            origin: Point::new(MIDDLE_MM - turned.x_mm, MIDDLE_MM - turned.y_mm),
            rotation,
        };
        Ok(scene)
    }

    /// Height of both waves, µm.
    fn height_um(&self, x_mm: f64) -> f64 {
        let [.., bin, second_bin, range_db, _] = self.0;
        let wave = |bin: f64| (TAU * BIN_SPACING_PER_MM * bin * x_mm).cos();
        10.0 * (wave(bin) + 10.0_f64.powf(-range_db / 20.0) * wave(second_bin))
    }

    fn profile(&self) -> Result<Arc<Surface>, ReportError> {
        let failed = textiles::wrong("an adversarial profile");
        let [.., step_mm] = self.0;
        let n = (0_u32..).map(|i| f64::from(i) * step_mm);
        let heights = n.take_while(|x_mm| *x_mm < LENGTH_MM);
        let heights = heights.map(|x_mm| self.height_um(x_mm)).collect();
        let profile = Profile::new(step_mm, heights).map_err(&failed)?;
        let surface = Surface::from_profiles([Some(profile), None, None, None], 0.0);
        Ok(Arc::new(surface.map_err(|(_, error)| failed(error))?))
    }

    fn areal(&self) -> Result<Arc<Surface>, ReportError> {
        let failed = textiles::wrong("an adversarial relief");
        let n = 200;
        let at = |i: usize| i as f64 * RELIEF_STEP_MM;
        let along: Vec<f64> = (0..n).map(|i| self.height_um(at(i))).collect();
        let mut heights_um = Grid::filled(n, n, 0.0);
        for (row, across) in along.iter().enumerate() {
            for (height, along) in heights_um.row_mut(row).iter_mut().zip(&along) {
                *height = along + across;
            }
        }
        let map = HeightMap::new(heights_um, [RELIEF_STEP_MM; 2]).map_err(&failed)?;
        let surface = Surface::areal(&map, 0.0);
        Ok(Arc::new(surface.map_err(|(_, error)| failed(error))?))
    }
}

/// The amplitudes of all contactors by the formula, sums with Neumaier's compensation.
fn by_formula(scene: &RenderScene, pose: &Pose) -> Vec<[f64; 2]> {
    let mut readings = Vec::new();
    ContactInspector::new(scene).readings_into(0, pose, &mut readings);
    let surface = &scene.textiles[0].surface;
    let of_band = |contactor: &ContactorReading, band: Band| -> f64 {
        let Some(reading) = contactor.reading else {
            return 0.0;
        };
        let (mut sum, mut lost) = (0.0_f64, 0.0_f64);
        for (direction, component) in reading.directions.iter().zip(reading.velocity_mm_per_s) {
            let Some(direction) = *direction else {
                continue;
            };
            let powers = surface
                .spectra(direction)
                .powers_um2(reading.points[direction.index()]);
            for (k, power_um2) in (1..).zip(powers) {
                let hz = component.abs() * BIN_SPACING_PER_MM * f64::from(k);
                if hz < MAX_FREQUENCY_HZ {
                    let term = power_um2 * scene.filters.power_gain(band, hz);
                    let total = sum + term;
                    let [large, small] = if sum >= term {
                        [sum, term]
                    } else {
                        [term, sum]
                    };
                    lost += (large - total) + small;
                    sum = total;
                }
            }
        }
        (2.0 * (sum + lost)).sqrt()
    };
    readings
        .iter()
        .map(|contactor| Band::ALL.map(|band| of_band(contactor, band)))
        .collect()
}
