//! One contactor over one sample, exactly within each regime and to 31 ns between regimes.
//!
//! The exact step of a sample, its half, its quarter … its 4096th are made once for every regime.
//! An event (the skin lifts off, or is back) is then found by taking the largest step before it,
//! then half of that, and so on: a bisection that computes no exponential. A lift-off that begins
//! and ends within one sample is not seen.

use super::contactor::{Contact, Drive, N_INPUTS, N_STATES, U_AMP, V_BEAM, V_PIN, X_PIN};
use super::{ContactorModel, SAMPLES_PER_S};
use crate::BridgeError;
use selvedge_foundation::numerics::ode::{Propagator, StepMethod};
use selvedge_foundation::numerics::to_whole;

/// The smallest part of a sample is `2⁻¹²`.
const HALVINGS: usize = 12;
/// Smallest parts of a sample.
const PARTS: u32 = 1 << HALVINGS;
/// More changes of contact than this in a sample are chatter: the last one stays.
const MAX_CHANGES: u32 = 8;
/// Length of a sample, s.
pub(super) const SAMPLE_S: f64 = 1.0 / SAMPLES_PER_S as f64;

/// States of a contactor.
pub(super) type State = [f64; N_STATES];
/// An exact step.
pub(super) type Step = Propagator<N_STATES, N_INPUTS>;

/// How a contactor is driven during a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drives {
    /// What the amplifier is asked for, V, within its rails.
    pub(super) volts: f64,
    /// How long it slews first, in parts of a sample.
    slewing_parts: u32,
    /// The slope meanwhile, V/s.
    slope_v_per_s: f64,
}

impl Drives {
    /// Whether the amplifier reaches its steepest slope.
    pub(super) fn is_slewing(&self) -> bool {
        self.slewing_parts > 0
    }
}

/// The steps of every regime.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    /// `[contact][drive][halvings]`.
    tables: [[[Step; HALVINGS + 1]; 2]; 2],
    skin_n_per_m: f64,
    skin_n_s_per_m: f64,
    /// Force of the skin at rest, N; `None` where it is glued.
    preload_n: Option<f64>,
    time_constant_s: f64,
    steepest_v_per_s: f64,
    /// By how much the square of an amplifier's slope falls in a sample, 0…1.
    fallen: f64,
}

impl Steps {
    /// The steps of a model.
    pub(super) fn new(model: &ContactorModel) -> Result<Self, BridgeError> {
        model.check()?;
        let mut tables = [[[EMPTY; HALVINGS + 1]; 2]; 2];
        for contact in [Contact::On, Contact::Off] {
            for drive in [Drive::Follows, Drive::Slews] {
                let system = model.regime(contact, drive);
                let table = &mut tables[usize::from(contact == Contact::Off)]
                    [usize::from(drive == Drive::Slews)];
                for (halvings, step) in table.iter_mut().enumerate() {
                    let step_s = SAMPLE_S / f64::from(1_u32 << halvings);
                    *step = system
                        .propagator::<{ N_STATES + N_INPUTS }>(StepMethod::ExactHold, step_s)
                        .ok_or_else(|| {
                            BridgeError::Model("numbers too large to step; lower them".to_owned())
                        })?;
                }
            }
        }
        let skin = &model.skin;
        let is_there = skin.stiffness_n_per_m > 0.0 || skin.damping_n_s_per_m > 0.0;
        let preload_um = skin.preload_um.filter(|_| is_there);
        Ok(Self {
            tables,
            skin_n_per_m: skin.stiffness_n_per_m,
            skin_n_s_per_m: skin.damping_n_s_per_m,
            preload_n: preload_um.map(|um| 1e-6 * um * skin.stiffness_n_per_m),
            time_constant_s: model.amplifier.time_constant_s,
            steepest_v_per_s: model.steepest_v_per_s(),
            fallen: fallen(SAMPLE_S, model.amplifier.time_constant_s),
        })
    }

    /// The step of a whole sample with skin on the pin and the amplifier following: what nearly
    /// every sample is.
    pub(super) fn plain(&self) -> &Step {
        &self.tables[0][0][0]
    }

    /// How an amplifier at `from_v` goes towards `volts`. While the pole asks for more than the
    /// steepest slope it slews; that ends where both slopes are alike.
    pub(super) fn drives(&self, from_v: f64, volts: f64) -> Drives {
        let asked = volts - from_v;
        let too_far = asked.abs() - self.largest_gap_v();
        if too_far <= 0.0 {
            return Drives {
                volts,
                slewing_parts: 0,
                slope_v_per_s: 0.0,
            };
        }
        let parts = too_far / self.steepest_v_per_s / SAMPLE_S * f64::from(PARTS);
        Drives {
            volts,
            slewing_parts: to_whole(parts.ceil().clamp(0.0, f64::from(PARTS))),
            slope_v_per_s: self.steepest_v_per_s.copysign(asked),
        }
    }

    /// The force of the skin on the pin beyond which it has lifted off is 0: whether it pushes.
    pub(super) fn pushes(&self, state: &State) -> bool {
        self.preload_n.is_none_or(|preload_n| {
            preload_n + self.skin_n_per_m * state[X_PIN] + self.skin_n_s_per_m * state[V_PIN] > 0.0
        })
    }

    /// The same of several contactors: whether skin pushes on every one.
    pub(super) fn all_push<const L: usize>(&self, states: &[[f64; L]; N_STATES]) -> bool {
        self.preload_n.is_none()
            || (0..L).all(|lane| self.pushes(&states.map(|states| states[lane])))
    }

    /// The farthest that an amplifier is from its input where its pole asks for no more than its
    /// steepest slope, V.
    pub(super) fn largest_gap_v(&self) -> f64 {
        self.steepest_v_per_s * self.time_constant_s
    }

    /// Of an amplifier that follows: the first slope for each volt that it is off, 1/s, and the
    /// mean square of its slope for each squared, 1/s².
    pub(super) fn slopes_of_gap(&self) -> [f64; 2] {
        let rate = 1.0 / self.time_constant_s;
        [rate, 0.5 * rate * self.fallen / SAMPLE_S]
    }

    /// One sample of a contactor in whatever regimes it passes through.
    pub(super) fn advance(&self, state: &mut State, contact: &mut Contact, drives: Drives) {
        let slewing = drives.slewing_parts;
        let slope = [drives.slope_v_per_s, 1.0];
        self.glide(state, contact, (Drive::Slews, slope), slewing);
        let volts = [drives.volts, 1.0];
        self.glide(state, contact, (Drive::Follows, volts), PARTS - slewing);
    }

    /// The `1/n`th of a sample while the amplifier follows.
    #[cfg(test)]
    pub(super) fn advance_part(
        &self,
        state: &mut State,
        contact: &mut Contact,
        drives: Drives,
        n: usize,
    ) {
        let parts = PARTS / u32::try_from(n).unwrap_or(1);
        self.glide(state, contact, (Drive::Follows, [drives.volts, 1.0]), parts);
    }

    /// So many parts of a sample in one regime of the amplifier.
    fn glide(
        &self,
        state: &mut State,
        contact: &mut Contact,
        (drive, input): (Drive, [f64; N_INPUTS]),
        mut parts: u32,
    ) {
        let (mut largest, mut n_changes) = (PARTS, 0);
        while parts > 0 {
            let size = largest.min(1 << parts.ilog2());
            let halvings = HALVINGS - size.ilog2() as usize;
            let is_off = *contact == Contact::Off;
            let table = &self.tables[usize::from(is_off)][usize::from(drive == Drive::Slews)];
            let next = table[halvings].step(state, &input);
            let has_changed = self.pushes(&next) == is_off && n_changes < MAX_CHANGES;
            if has_changed && size > 1 {
                largest = size / 2;
                continue;
            }
            *state = next;
            parts -= size;
            if has_changed {
                *contact = if is_off { Contact::On } else { Contact::Off };
                n_changes += 1;
                largest = PARTS;
            }
        }
    }

    /// The current of a sample: `[mean of squares, largest]` in A² and A, of an amplifier that
    /// drives `capacitance_f` from `from` to `to`, and a beam that moves with `charge_c_per_m`.
    pub(super) fn current(
        &self,
        (from, to): (&State, &State),
        drives: &Drives,
        (capacitance_f, charge_c_per_m): (f64, f64),
    ) -> [f64; 2] {
        let slope = ((drives.volts - from[U_AMP]) / self.time_constant_s)
            .clamp(-self.steepest_v_per_s, self.steepest_v_per_s);
        let tau_s = self.time_constant_s;
        let slewing_s = SAMPLE_S * f64::from(drives.slewing_parts) / f64::from(PARTS);
        let falls = if drives.is_slewing() {
            fallen(SAMPLE_S - slewing_s, tau_s)
        } else {
            self.fallen
        };
        let slopes = slope * slope * (slewing_s + 0.5 * tau_s * falls) / SAMPLE_S;
        let mean_slope = (to[U_AMP] - from[U_AMP]) / SAMPLE_S;
        let moving = 0.5 * charge_c_per_m * (from[V_BEAM] + to[V_BEAM]);
        let mean_square = capacitance_f * capacitance_f * slopes
            + 2.0 * capacitance_f * mean_slope * moving
            + moving * moving;
        let first = capacitance_f * slope + charge_c_per_m * from[V_BEAM];
        [mean_square.max(0.0), first.abs()]
    }
}

/// `1 − e^{−2t/τ}`.
fn fallen(time_s: f64, time_constant_s: f64) -> f64 {
    -(-2.0 * time_s / time_constant_s).exp_m1()
}

const EMPTY: Step = Propagator {
    state: [[0.0; N_STATES]; N_STATES],
    input: [[0.0; N_INPUTS]; N_STATES],
};
