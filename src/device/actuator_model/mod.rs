//! What contactors do with drive codes: DAC, amplifier, bimorph, pin and skin, stepped exactly.
//!
//! ```text
//! codes ─ sines ─ DAC (12 bit, held 125 µs) ─ amplifier (pole, slew, rails) ─ bimorph ─ pin ─ skin
//! ```
//!
//! Every number that comes out is an estimate from design-sheet values: no contactor was measured
//! for it, and the skin under a finger changes displacement several times over. So amplitudes are
//! told in drive volts elsewhere; here stands what they would move, with the load stated.
//!
//! # Invariants
//! - no clock, no thread, no port: callers say which codes hold for which samples
//! - nothing allocates after [`ActuatorModel::new`] but a change of the model
//! - whatever the codes, every number stays finite
//! - no hysteresis and no creep: bimorphs have 10–15 % of the former

mod bimorph;
mod contactor;
mod lanes;
mod reading;
mod sample;
mod skin;
mod synth;
mod watch;

pub use bimorph::Bimorph;
pub use contactor::{Amplifier, ContactorModel};
pub use lanes::ActuatorModel;
pub use reading::{ActuatorReading, ContactorReading};
pub use skin::Skin;
pub use watch::ActuatorWatch;
pub(crate) use watch::{ActuatorFeed, actuator_watch};

use crate::BridgeError;

/// Samples a second that the DAC is given.
pub const SAMPLES_PER_S: u32 = 8000;
/// Samples of a tick of 25 ms.
pub(crate) const SAMPLES_PER_TICK: usize = 200;

/// Refuses a model if one of its numbers is out of range: name, value, ends, unit.
fn within(model: &str, ranges: &[(&str, f64, [f64; 2], &str)]) -> Result<(), BridgeError> {
    let is_out = |(_, value, [min, max], _): &&(_, f64, [f64; 2], _)| !(min..=max).contains(&value);
    ranges
        .iter()
        .find(is_out)
        .map_or(Ok(()), |(name, value, [min, max], unit)| {
            let mend = format!("give {min} to {max}{unit}");
            let what = format!("a {model}'s {name} of {value}{unit}; {mend}");
            Err(BridgeError::Model(what))
        })
}

#[cfg(test)]
mod tests;
