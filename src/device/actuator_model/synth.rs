//! The sines that a device makes of drive codes, and its DAC.
//!
//! 200 samples a tick hold exactly one period of 40 Hz and eight of 320 Hz, so that both begin at
//! zero at every tick and the table never drifts.

use std::array::from_fn;
use std::f64::consts::TAU;

use super::SAMPLES_PER_TICK;
use crate::FULL_CODE;

/// Bits of the DAC.
const DAC_BITS: u32 = 12;
/// Counts of the DAC for full drive, either way.
const FULL_COUNTS: f64 = ((1 << (DAC_BITS - 1)) - 1) as f64;
/// Added and taken away again it leaves a whole number (1.5 · 2⁵²): `round` is a call of a library
/// where the processor is not known to have an instruction for it.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// Periods of each carrier in a tick.
const PERIODS: [usize; 2] = [1, 8];

/// `[cos, sin]` of both carriers at a sample: `sin` is what drives, both measure.
pub(super) type Phasors = [[f64; 2]; 2];

/// Carriers and DAC of an array.
#[derive(Clone, Debug)]
pub(super) struct Synth {
    carriers: [Phasors; SAMPLES_PER_TICK],
    volts_per_count: f64,
    counts_per_code: f64,
}

impl Synth {
    /// A device whose full drive is `full_scale_v` volts.
    pub(super) fn new(full_scale_v: f64) -> Self {
        let phasor = |turn: usize| {
            let angle = TAU * (turn % SAMPLES_PER_TICK) as f64 / SAMPLES_PER_TICK as f64;
            [angle.cos(), angle.sin()]
        };
        Self {
            carriers: from_fn(|n| PERIODS.map(|periods| phasor(periods * n))),
            volts_per_count: full_scale_v / FULL_COUNTS,
            counts_per_code: FULL_COUNTS / f64::from(FULL_CODE),
        }
    }

    /// Both carriers at a sample of a tick.
    pub(super) fn phasors(&self, sample: usize) -> &Phasors {
        &self.carriers[sample % SAMPLES_PER_TICK]
    }

    /// What the DAC puts out for codes at a sample, V: a whole number of counts.
    pub(super) fn volts(&self, codes: [u16; 2], phasors: &Phasors) -> f64 {
        let [low, high] = codes.map(f64::from);
        let drive = low * phasors[0][1] + high * phasors[1][1];
        let counts = self.counts_per_code * drive + WHOLE - WHOLE;
        self.volts_per_count * counts.clamp(-FULL_COUNTS, FULL_COUNTS)
    }

    /// Volts of one count.
    #[cfg(test)]
    pub(super) fn count_v(&self) -> f64 {
        self.volts_per_count
    }
}
