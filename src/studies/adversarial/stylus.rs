//! A stylus led over two waves: a step that is marked stable gives no energy, whatever the wall,
//! the relief and the pace.

use std::f64::consts::TAU;

use super::field::{BROKEN, Field, Range, Spaced, numbers, target};
use crate::ReportError;
use crate::stylus::relief_of;
use selvedge_foundation::numerics::Grid;
use selvedge_render::contact::{
    Contact, ContactLaw, DeviceSpec, Friction, Standing, Stepper, StylusRun, StylusSetup,
    StylusStart, Tip,
};

/// What may come from nowhere, as part of what was there and was put in.
const MOST_GAINED: f64 = 1e-10;
/// Steps of a case.
const N_STEPS: u32 = 300;
/// Points of the relief, which repeats.
const N_POINTS: usize = 1000;

/// The wall; how it is stepped; how long the longer of two waves is and how high; how much shorter
/// and lower the other is; how fast the stylus is led.
const RANGES: [Range; 8] = [
    ("stiffness_n_per_m", [10.0, 1e9], Spaced::Log),
    ("damping_ratio", [0.0, 2.0], Spaced::Even),
    ("rate_hz", [250.0, 4e4], Spaced::Log),
    ("wavelength_mm", [0.51, 20.0], Spaced::Log),
    ("height_um", [0.1, 300.0], Spaced::Log),
    ("n_shorter", [1.0, 40.0], Spaced::Even),
    ("range_db", [0.0, 60.0], Spaced::Even),
    ("speed_mm_per_s", [0.1, 1000.0], Spaced::Log),
];

/// Where a stepper may give energy.
pub(super) const FIELD: Field = Field {
    file: "stylus.csv",
    stored: include_str!("stylus.csv"),
    ranges: &RANGES,
    lead: None,
    targets: &[
        target("trapezoid", 1, |case| share(case, Stepper::Trapezoid)),
        target("implicit-euler", 1, |case| {
            share(case, Stepper::ImplicitEuler)
        }),
        target("exact", 4, |case| share(case, Stepper::Exact)),
    ],
};

fn share(case: &[f64], method: Stepper) -> Result<f64, ReportError> {
    let [
        stiffness,
        damping,
        rate_hz,
        wavelength_mm,
        height_um,
        n_shorter,
        range_db,
        speed_mm_per_s,
    ] = numbers(case)?;
    let law = ContactLaw {
        stiffness_n_per_m: stiffness,
        damping_n_s_per_m: 2.0 * damping * (stiffness * DeviceSpec::default().mass_kg).sqrt(),
        ..ContactLaw::default()
    };
    let lower = 10.0_f64.powf(-range_db / 20.0);
    let height = |column: usize, _| {
        let turn = TAU * column as f64 / N_POINTS as f64;
        height_um * (turn.sin() + lower * (n_shorter.round() * turn).cos())
    };
    let relief = relief_of(
        Grid::from_fn(N_POINTS, 1, height),
        wavelength_mm / N_POINTS as f64,
    )?;
    let contact = Contact::new(&relief, Tip::stylus(0.0), law, Friction::none())?;
    let setup = StylusSetup::of(contact, method, rate_hz);
    if setup.case().standing() != Standing::Stable {
        return Ok(0.0);
    }
    let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting)?;
    let mut most = 0.0_f64;
    for nth in 1..=N_STEPS {
        if !run.advance([speed_mm_per_s * f64::from(nth) / rate_hz, 0.0]) {
            return Ok(BROKEN);
        }
        let gained = run.gained_j() / run.put_in_j();
        if gained.is_nan() {
            return Ok(BROKEN);
        }
        most = most.max(gained / MOST_GAINED);
    }
    Ok(most)
}
