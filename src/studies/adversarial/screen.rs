//! An electrovibration screen: whatever friction and settings are, the voltage stays within its
//! limits.

use super::field::{BROKEN, Field, Range, Spaced, numbers, target};
use crate::ReportError;
use selvedge_render::electrovibration::{Carrier, Electrovibration};

/// Settings on both sides of their limits, a coefficient of friction, and a moment up to a year on.
const RANGES: [Range; 4] = [
    ("amplification_v", [-10.0, 5000.0], Spaced::Even),
    ("carrier_hz", [0.1, 1e5], Spaced::Log),
    ("mu", [-0.5, 5.0], Spaced::Even),
    ("t_s", [1e-6, 3e7], Spaced::Log),
];

/// Where a voltage may leave its limits.
pub(super) const FIELD: Field = Field {
    file: "screen.csv",
    stored: include_str!("screen.csv"),
    ranges: &RANGES,
    lead: None,
    targets: &[
        target("square carrier", 1, |case| share(case, Carrier::Square)),
        target("sine carrier", 1, |case| share(case, Carrier::Sine)),
    ],
};

/// The voltage, from one peak to the other, as a share of what the screen may have: a sine goes as
/// far to the other side.
fn share(case: &[f64], carrier: Carrier) -> Result<f64, ReportError> {
    let [amplification_v, carrier_hz, mu, t_s] = numbers(case)?;
    let asked = Electrovibration {
        amplification_v,
        carrier_hz,
        carrier,
    };
    let driven = asked.driven(mu, t_s);
    let is_in_order = driven.v.abs() <= driven.peak_to_peak_v && driven.peak_to_peak_v >= 0.0;
    let sides = match carrier {
        Carrier::Square => 1.0,
        Carrier::Sine => 2.0,
    };
    Ok(if is_in_order {
        sides * driven.v.abs() / Electrovibration::MAX_V
    } else {
        BROKEN
    })
}
