//! What recipes of yarns state alike: which side is touched and how, and how irregular a textile is
//! whose recipe does not say.

use crate::recipe::{Group, Parameter, ParameterKind, Side, parameter, seed};
use crate::surface::Representation;

/// What is usual, woven or knitted.
pub(crate) mod usual {
    crate::recipe::defaults! {
        /// Standard deviation of crimp or loop size from place to place, share.
        tension_drift: f64 = 0.1;
        /// Over what length tension and bow change, mm.
        drift_mm: f64 = 4.0;
        /// Standard deviation of the places of yarns, share of their pitch.
        pitch_cv: f64 = 0.05;
        /// Size of the puckers, mm.
        pucker_mm: f64 = 2.0;
        /// Noise of the probe, µm rms.
        noise_um: f64 = 0.2;
    }
}

/// What decides how a textile is felt; `noise` is the probe's.
pub(crate) fn touch_group(noise: Vec<Parameter>) -> Group {
    let mut parameters = vec![
        parameter(
            "side",
            ("Side", "Which side of the cloth is touched"),
            ParameterKind::Choice(Side::WORDS),
        ),
        parameter(
            "representation",
            (
                "Felt",
                "Economical: along four strokes; areal: at every point of its relief",
            ),
            ParameterKind::Choice(Representation::WORDS),
        ),
        seed(),
    ];
    parameters.extend(noise);
    Group::new("Touch", parameters)
}
