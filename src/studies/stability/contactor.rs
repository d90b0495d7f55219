//! Contactors that are sharp, stiffly held, driven to the full, or no contactors at all.

use super::case::{Case, Verdict, cases, failed, refused, verdict};
use crate::bimorph::{CARRIERS_HZ, ContactorStep, SAMPLE_S, held_response, propagator};
use selvedge_device::{ActuatorModel, Bimorph, ContactorModel, Skin};
use selvedge_foundation::numerics::ode::StepMethod;

/// Drive codes of an array at its loudest.
const LOUDEST: [[u16; 2]; 24] = [[u16::MAX; 2]; 24];
/// A distance that no energy of this drive reaches, µm.
pub(super) const TOO_FAR_UM: f64 = 1e5;

/// Stiffness, sharpness and drive.
pub(super) fn cases() -> Vec<Case> {
    cases! { "contactor";
        "a bimorph with Q = 1000 against stiff skin" =>
            "exact method within 1e-9 of the closed form", sharp_and_stiff;
        "contact stiffness 0 … 1e9 N/m, steps 1 µs … 1 s" =>
            "finite, and nothing grows", every_stiffness;
        "full drive against skin of 1e9 N/m, pressed in 1 and 0 µm" =>
            "finite and bounded; off at times, not always, where nothing presses", lifts_off;
        "skin of NaN, −1, ∞ and 1e10 N/m" => "refused, with the range", no_skin;
        "a bimorph of 0 mm" => "refused, with the range", || {
            let bimorph = Bimorph {
                length_mm: 0.0,
                ..Bimorph::default()
            };
            refused(bimorph.check(), &["length", "give 1 to 200 mm"])
        };
        "a bimorph with Q = 2000" => "refused, with the range", || {
            refused(ActuatorModel::new(&loaded(Skin::LIGHT, 2000.0), 24), &["quality", "1000"])
        };
    }
}

pub(super) fn loaded(skin: Skin, quality: f64) -> ContactorModel {
    ContactorModel {
        quality,
        skin,
        ..ContactorModel::default()
    }
}

/// A held sine of 40 and 320 Hz at the samples, against its line and images through |H|: how far
/// it is off, and by how much a step lets what rings grow.
pub(super) fn held_off(model: &ContactorModel) -> Option<[f64; 2]> {
    let step = propagator(model, StepMethod::ExactHold, SAMPLE_S)?;
    let mut worst = 0.0_f64;
    for frequency_hz in CARRIERS_HZ {
        let angle = std::f64::consts::TAU * frequency_hz * SAMPLE_S;
        let found = step.response(angle)?;
        let closed = held_response(model, frequency_hz, SAMPLE_S);
        let off = (1e6 * found[ContactorModel::PIN][0] - closed).norm() / closed.norm();
        worst = worst.max(off);
    }
    Some([worst, step.growth()])
}

fn sharp_and_stiff() -> Verdict {
    let model = loaded(Skin::bonded(1e5, 0.0), ContactorModel::MAX_QUALITY);
    let [worst, _] = held_off(&model).ok_or_else(|| failed("no step, or a pole"))?;
    verdict(worst <= 1e-9, format!("{worst:.1e} off"))
}

fn every_stiffness() -> Verdict {
    let (mut worst, mut n_steps) = (0.0_f64, 0);
    for stiffness in [0.0, 1.0, 1e3, 1e6, 1e9] {
        for step_s in [1e-6, 1e-4, 1e-2, 1.0] {
            let model = loaded(Skin::bonded(stiffness, 0.0), ContactorModel::MAX_QUALITY);
            let step = propagator(&model, StepMethod::ExactHold, step_s);
            let Some(step) = step.filter(ContactorStep::is_finite) else {
                return Err(format!("no finite step of {step_s} s at {stiffness} N/m"));
            };
            worst = worst.max(step.growth() - 1.0);
            n_steps += 1;
        }
    }
    let came_back = format!("{n_steps} steps, growth at most 1 + {:.1e}", worst.max(0.0));
    verdict(worst < 1e-9, came_back)
}

/// Full drive against skin that is pressed in by so much: the farthest any pin goes, µm, and the
/// share of the time that skin is off.
pub(super) fn rattled(stiffness: f64, preload_um: f64) -> Result<[f64; 2], String> {
    let skin = Skin {
        preload_um: Some(preload_um),
        ..Skin::bonded(stiffness, 0.0)
    };
    let model = loaded(skin, ContactorModel::MAX_QUALITY);
    let mut plant = ActuatorModel::new(&model, LOUDEST.len()).map_err(failed)?;
    let (mut most_um, mut lost, mut n) = (0.0_f64, 0.0, 0.0);
    for _ in 0..20 {
        for one in &plant.tick(&LOUDEST, 60.0).contactors {
            if !(one.peak_um.is_finite() && one.current_rms_ma.is_finite()) {
                return Err(format!("not finite: {one:?}"));
            }
            most_um = most_um.max(one.peak_um);
            lost += one.lost_share;
            n += 1.0;
        }
    }
    Ok([most_um, lost / n])
}

/// Pressed in a little, and only just touched: without a preload the skin is off whenever the pin
/// moves away from it, and on when it comes back.
fn lifts_off() -> Verdict {
    let [[pressed_um, seldom], [most_um, often]] = [rattled(1e9, 1.0)?, rattled(1e9, 0.0)?];
    let most_um = most_um.max(pressed_um);
    let percent = [seldom, often].map(|share| format!("{:.0}", 100.0 * share));
    let came_back = format!(
        "at most {most_um:.0} µm; off for {} % of the time",
        percent.join(" and ")
    );
    verdict(
        0.0 < often && often < 1.0 && most_um < TOO_FAR_UM,
        came_back,
    )
}

fn no_skin() -> Verdict {
    let mut last = Err("none was tried".to_owned());
    for stiffness in [f64::NAN, -1.0, f64::INFINITY, 1e10] {
        let skin = Skin::bonded(stiffness, 0.0);
        last = Ok(refused(skin.check(), &["stiffness", "give 0 to"])?);
    }
    last
}
