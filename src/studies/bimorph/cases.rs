//! What is stepped, how finely, and what a held sine gives in closed form.

use std::f64::consts::PI;

use crate::Effort;
use selvedge_device::{ContactorModel, SAMPLES_PER_S, Skin};
use selvedge_foundation::numerics::Complex;
use selvedge_foundation::numerics::ode::{Propagator, StepMethod};
use selvedge_foundation::quantity::time_span;

/// A step of the contactor.
pub(crate) type ContactorStep = Propagator<5, 2>;

/// The frequencies of the device, Hz.
pub(crate) const CARRIERS_HZ: [f64; 2] = [40.0, 320.0];
/// Length of the DAC's sample, s.
pub(crate) const SAMPLE_S: f64 = 1.0 / SAMPLES_PER_S as f64;

/// A contactor with a load.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) model: ContactorModel,
}

impl Case {
    /// From the usual contactor to the hardest: sharp, against stiff skin that damps nothing.
    pub(super) fn all(effort: Effort) -> Vec<Self> {
        let loads = [
            Skin::LIGHT,
            Skin::FREE,
            Skin::FIRM,
            Skin::bonded(1e4, 0.0),
            Skin::bonded(1e5, 0.0),
        ];
        let skip = effort.pick(3, 0);
        let is_chosen = |nth: usize| nth == 0 || nth > skip;
        let mut cases = Vec::new();
        for quality in [40.0, ContactorModel::MAX_QUALITY] {
            let chosen = loads.iter().enumerate().filter(|(nth, _)| is_chosen(*nth));
            cases.extend(chosen.map(|(_, skin)| Self {
                name: format!("skin {skin}, Q {quality}"),
                model: ContactorModel {
                    quality,
                    skin: *skin,
                    ..ContactorModel::default()
                },
            }));
        }
        cases
    }
}

/// Some equal steps while an input is held.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// How long an input is held, s.
    pub(super) hold_s: f64,
    /// Steps meanwhile.
    pub(super) per_hold: u32,
}

impl Step {
    /// From 1 µs to 1 ms.
    pub(super) fn all(effort: Effort) -> Vec<Self> {
        let within = effort.pick(&[125, 16, 1][..], &[125, 64, 32, 16, 8, 4, 2, 1][..]);
        let above = effort.pick(&[8.0][..], &[2.0, 4.0, 8.0][..]);
        let parts = within.iter().map(|per_hold| Self {
            hold_s: SAMPLE_S,
            per_hold: *per_hold,
        });
        let several = above.iter().map(|samples| Self {
            hold_s: samples * SAMPLE_S,
            per_hold: 1,
        });
        parts.chain(several).collect()
    }

    pub(super) fn step_s(&self) -> f64 {
        self.hold_s / f64::from(self.per_hold)
    }

    /// A case with what is asked of the step: an input that is held longer is another drive.
    pub(super) fn of_case(&self, name: &str) -> String {
        if self.hold_s > SAMPLE_S {
            format!("{name}, held for {}", time_span(self.hold_s))
        } else {
            name.to_owned()
        }
    }

    pub(super) fn label(&self) -> String {
        format!("steps of {}", time_span(self.step_s()))
    }
}

/// A step of `step_s` by a method; `None` where it has no finite solution.
pub(crate) fn propagator(
    model: &ContactorModel,
    method: StepMethod,
    step_s: f64,
) -> Option<ContactorStep> {
    model.system().propagator::<7>(method, step_s)
}

/// Images that are summed on either side: their sum falls with the fourth power and is far below
/// rounding here.
const IMAGES: i32 = 4000;

/// Displacement of the pin over the drive, µm/V, at the instants at which the drive is sampled and
/// then held for `hold_s`: `Σ_m H(f_m) · hold(f_m)` over the line and its images
/// `f_m = f + m/hold_s`, with `hold(f) = e^{−iπf·hold_s} sin(πf·hold_s)/(πf·hold_s)`.
pub(crate) fn held_response(model: &ContactorModel, frequency_hz: f64, hold_s: f64) -> Complex {
    let image = |m: i32| {
        let image_hz = frequency_hz + f64::from(m) / hold_s;
        let half_turn = PI * image_hz * hold_s;
        let hold = if half_turn.abs() < 1e-12 {
            Complex::from(1.0)
        } else {
            Complex::from_polar(1.0, -half_turn) * (half_turn.sin() / half_turn)
        };
        model.response_um_per_v(image_hz) * hold
    };
    // Small ones first, so that rounding stays small too.
    let pairs = (1..=IMAGES).rev().map(|m| image(m) + image(-m));
    pairs.sum::<Complex>() + image(0)
}
