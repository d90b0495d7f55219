//! The emulator's own contactors, run: DAC, 12 bits and all.
//!
//! They are read at their samples, where a line comes with the images that fold onto it.

use super::cases::{CARRIERS_HZ, SAMPLE_S, held_response, propagator};
use crate::chart::chart;
use crate::readable::{largest, whole};
use crate::{Bench, Findings, Row};
use selvedge_chart::{Axis, Chart, Ink, Series, Style};
use selvedge_device::{ActuatorModel, ContactorModel, Skin};
use selvedge_foundation::numerics::ode::StepMethod;

/// Contactors that run.
const N_CONTACTORS: usize = 24;
/// Codes of both carriers.
const CODES: [u16; 2] = [30_000, 20_000];
/// What displacements keep within.
const PROMISED: f64 = 1e-3;
/// Rails of the amplifiers, V.
const RAIL_V: f64 = 60.0;
/// Ticks a second.
const TICKS_PER_S: f64 = 40.0;

/// Rows of the displacement after the resonance has rung down.
pub(super) fn find(bench: &mut Bench<'_>, findings: &mut Findings) {
    let loads = [Skin::FREE, Skin::LIGHT, Skin::FIRM, Skin::bonded(1e5, 0.0)];
    let qualities = bench
        .effort
        .pick(&[40.0][..], &[40.0, ContactorModel::MAX_QUALITY][..]);
    for quality in qualities {
        for skin in loads {
            let model = ContactorModel {
                quality: *quality,
                skin,
                ..ContactorModel::default()
            };
            findings.rows.extend(run(&model, bench));
        }
    }
}

fn run(model: &ContactorModel, bench: &mut Bench<'_>) -> Option<Row> {
    let mut one = ActuatorModel::new(model, 1).ok()?;
    // The slowest swing falls by e in Q / (π f); 12 of those leave 6 millionths.
    let ringing_s = 12.0 * model.quality / (std::f64::consts::PI * model.bimorph.resonance_hz());
    for _ in 0..8 + whole((ringing_s * TICKS_PER_S).ceil()) {
        one.tick(&[CODES], RAIL_V);
    }
    let found = one.reading().contactors[0];
    let off = |truth: &dyn Fn(f64) -> f64| {
        let bands = CARRIERS_HZ.into_iter().enumerate();
        largest(bands.map(|(band, frequency_hz)| {
            let volts = model.full_scale_v * f64::from(CODES[band]) / 65_535.0;
            (found.amplitude_um[band] / (volts * truth(frequency_hz)) - 1.0).abs()
        }))
    };
    let error = off(&|hz| held_response(model, hz, SAMPLE_S).norm());
    let without_images =
        off(&|hz| model.response_um_per_v(hz).norm() * ContactorModel::hold_droop(hz));
    let mut array = ActuatorModel::new(model, N_CONTACTORS).ok()?;
    let codes = [CODES; N_CONTACTORS];
    let cost = bench.time(N_CONTACTORS, || array.tick(&codes, RAIL_V).n_ticks);
    let case = format!("skin {}, Q {}", model.skin, model.quality);
    let row = Row::of("emulator", "24 contactors", case)
        .error(error)
        .promised(PROMISED)
        .cost(cost.times(TICKS_PER_S))
        .with("step_s", format!("{SAMPLE_S:e}"))
        .with("quality", model.quality)
        .with("skin_n_per_m", model.skin.stiffness_n_per_m)
        .with("error_without_images", format!("{without_images:e}"));
    Some(row)
}

/// |H(f)| with several loads, and what the exact method makes of it.
pub(super) fn responses() -> Chart {
    let frequency = |nth: u32| 10.0 * 400.0_f64.powf(f64::from(nth) / 240.0);
    let (mut all, mut stepped) = (Vec::new(), Vec::new());
    for (name, skin) in Skin::NAMED {
        let model = ContactorModel {
            skin,
            ..ContactorModel::default()
        };
        let line = |hz: f64| [hz, model.response_um_per_v(hz).norm()];
        let points = (0..=240).map(frequency).map(line);
        all.push(Series::of(
            format!("{name}, closed form"),
            Style::Line,
            points,
        ));
        let exact = propagator(&model, StepMethod::ExactHold, SAMPLE_S);
        let dot = |hz: f64| {
            let found = exact?.response(std::f64::consts::TAU * hz * SAMPLE_S)?;
            // Both are held alike, so that the dot lies on the line where the method is right.
            let held = held_response(&model, hz, SAMPLE_S).norm();
            let relative = 1e6 * found[ContactorModel::PIN][0].norm() / held;
            Some([hz, relative * model.response_um_per_v(hz).norm()])
        };
        stepped.extend((0..=240).step_by(20).map(frequency).filter_map(dot));
    }
    all.push(Series {
        ink: Ink::Grey,
        ..Series::of("exact hold", Style::Dots, stepped)
    });
    chart(
        "Displacement of the pin for a volt, by load",
        Axis::log("frequency, Hz"),
        Axis::log("displacement, µm/V"),
        all,
        "A model of 25 × 1.5 × 0.6 mm from design-sheet values, Q 40.",
    )
}
