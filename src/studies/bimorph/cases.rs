//! What is stepped, and how finely.

use super::SAMPLE_S;
use crate::Effort;
use selvedge_device::{ContactorModel, MAX_QUALITY, Skin};
use selvedge_foundation::quantity::time_span;

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
        for quality in [40.0, MAX_QUALITY] {
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
