//! A held sine in closed form.

use std::f64::consts::PI;

use selvedge_device::ContactorModel;
use selvedge_foundation::numerics::Complex;

/// Images that are summed on either side: their sum falls with the fourth power and is far below
/// rounding here.
const IMAGES: i32 = 4000;

/// Displacement of the pin over the drive, µm/V, at the instants at which the drive is sampled and
/// then held for `hold_s`: `Σ_m H(f_m) · hold(f_m)` over the line and its images
/// `f_m = f + m/hold_s`, with `hold(f) = e^{−iπf·hold_s} sin(πf·hold_s)/(πf·hold_s)`.
pub(super) fn held_response(model: &ContactorModel, frequency_hz: f64, hold_s: f64) -> Complex {
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
