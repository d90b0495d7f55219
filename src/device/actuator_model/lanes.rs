//! All contactors of an array, four abreast: one matrix, four columns of states.
//!
//! Nearly every sample is the plain exact step for all four. A contactor that slews, lifted off or
//! is about to takes the sample again by itself.

use std::array::from_fn;

use super::contactor::{Contact, N_STATES, U_AMP, V_BEAM, X_PIN};
use super::sample::{SAMPLE_S, Step, Steps};
use super::synth::{Phasors, Synth};
use super::{ActuatorReading, ContactorModel, ContactorReading, SAMPLES_PER_TICK};
use crate::BridgeError;
use crate::message::DeviceState;

/// Contactors stepped together.
const LANES: usize = 4;

/// What moves less than this in a tick without drive is at rest, µm: a tenth of a nanometre.
const REST_UM: f64 = 1e-4;

/// One number a lane.
type Lane = [f64; LANES];

/// Four contactors: states and what is summed up over a tick.
#[derive(Clone, Debug)]
struct Block {
    states: [Lane; N_STATES],
    contacts: [Contact; LANES],
    peak_m: Lane,
    /// `Σ x · [cos, sin]` of both carriers.
    lines: [[Lane; 2]; 2],
    squares: Lane,
    largest_a: Lane,
    lost: Lane,
    saturated: Lane,
}

const AT_REST: Block = Block {
    states: [[0.0; LANES]; N_STATES],
    contacts: [Contact::On; LANES],
    peak_m: [0.0; LANES],
    lines: [[[0.0; LANES]; 2]; 2],
    squares: [0.0; LANES],
    largest_a: [0.0; LANES],
    lost: [0.0; LANES],
    saturated: [0.0; LANES],
};

/// The contactors of an array and what drives them.
#[derive(Clone, Debug)]
pub struct ActuatorModel {
    model: ContactorModel,
    steps: Box<Steps>,
    synth: Box<Synth>,
    /// Blocked capacitance, and charge for a deflection.
    electric: (f64, f64),
    blocks: Vec<Block>,
    /// The sample of the tick that comes next.
    sample: usize,
    /// Whether nothing moves, so that nothing has to be computed until something is driven.
    is_at_rest: bool,
    reading: ActuatorReading,
}

impl ActuatorModel {
    /// `n_contactors` alike contactors at rest.
    pub fn new(model: &ContactorModel, n_contactors: usize) -> Result<Self, BridgeError> {
        Ok(Self {
            model: *model,
            steps: Box::new(Steps::new(model)?),
            synth: Box::new(Synth::new(model.full_scale_v)),
            electric: (model.held_capacitance_f(), model.bimorph.force_n_per_v()),
            blocks: vec![AT_REST; n_contactors.div_ceil(LANES)],
            sample: 0,
            is_at_rest: true,
            reading: ActuatorReading::new(n_contactors),
        })
    }

    /// Another model from here on; the contactors keep their states. One that is refused changes
    /// nothing.
    pub fn set_model(&mut self, model: &ContactorModel) -> Result<(), BridgeError> {
        if *model == self.model {
            return Ok(());
        }
        let fresh = Self::new(model, self.reading.contactors.len())?;
        (self.model, self.steps, self.synth) = (fresh.model, fresh.steps, fresh.synth);
        self.electric = fresh.electric;
        for block in &mut self.blocks {
            block.contacts = [Contact::On; LANES];
        }
        Ok(())
    }

    /// What is assumed of the contactors.
    pub fn model(&self) -> &ContactorModel {
        &self.model
    }

    /// Everything at rest, at the start of a tick.
    pub fn rest(&mut self) {
        self.blocks.fill(AT_REST);
        self.sample = 0;
        self.is_at_rest = true;
    }

    /// The last whole tick.
    pub fn reading(&self) -> &ActuatorReading {
        &self.reading
    }

    /// One tick of 25 ms with these output codes and rails of ±`rail_v`: what they did.
    pub fn tick(&mut self, codes: &[[u16; 2]], rail_v: f64) -> &ActuatorReading {
        self.run(codes, rail_v, SAMPLES_PER_TICK - self.sample);
        &self.reading
    }

    /// `n_samples` samples of 125 µs. At the end of a tick its [`reading`](Self::reading) is ready;
    /// true if that was so. Missing codes are 0.
    pub fn run(&mut self, codes: &[[u16; 2]], rail_v: f64, n_samples: usize) -> bool {
        let rail_v = if rail_v.is_finite() {
            rail_v.abs()
        } else {
            0.0
        };
        let mut is_ready = false;
        self.is_at_rest &= codes.iter().all(|codes| *codes == [0; 2]);
        for _ in 0..n_samples {
            if !self.is_at_rest {
                self.run_sample(codes, rail_v);
            }
            self.sample += 1;
            if self.sample == SAMPLES_PER_TICK {
                self.sample = 0;
                self.read(codes);
                is_ready = true;
            }
        }
        is_ready
    }

    fn run_sample(&mut self, codes: &[[u16; 2]], rail_v: f64) {
        let phasors = self.synth.phasors(self.sample);
        for (nth, block) in self.blocks.iter_mut().enumerate() {
            let at = |lane: usize| codes.get(LANES * nth + lane).copied().unwrap_or_default();
            let asked: Lane = from_fn(|lane| self.synth.volts(at(lane), phasors));
            block.sample(&self.steps, &asked, rail_v, self.electric);
            block.measure(phasors);
        }
    }

    /// Says in which state the device is; kept in the readings from then on.
    pub(crate) fn set_state(&mut self, state: DeviceState) {
        self.reading.state = state;
    }

    /// Sums of a tick become its reading.
    fn read(&mut self, codes: &[[u16; 2]]) {
        self.reading.n_ticks += 1;
        for (index, (out, code)) in self
            .reading
            .contactors
            .iter_mut()
            .zip(&mut self.reading.codes)
            .enumerate()
        {
            *out = self.blocks[index / LANES].reading(index % LANES);
            *code = codes.get(index).copied().unwrap_or_default();
        }
        let is_still = |one: &ContactorReading| one.peak_um < REST_UM;
        if codes.iter().all(|codes| *codes == [0; 2])
            && self.reading.contactors.iter().all(is_still)
        {
            self.rest();
        }
        for block in &mut self.blocks {
            *block = Block {
                states: block.states,
                contacts: block.contacts,
                ..AT_REST
            };
        }
    }

    /// Displacement of a contactor's pin from rest now, µm; 0 for one that is not there.
    #[cfg(test)]
    pub(crate) fn displacement_um(&self, contactor: usize) -> f64 {
        let block = self.blocks.get(contactor / LANES);
        block.map_or(0.0, |block| 1e6 * block.states[X_PIN][contactor % LANES])
    }
}

impl Block {
    /// One sample of the DAC asking for these volts: all abreast where that is the plain step for
    /// every one, else one by one.
    fn sample(&mut self, steps: &Steps, asked: &Lane, rail_v: f64, electric: (f64, f64)) {
        let volts = asked.map(|volts| volts.clamp(-rail_v, rail_v));
        let gaps: Lane = from_fn(|lane| volts[lane] - self.states[U_AMP][lane]);
        let next = abreast(steps.plain(), &self.states, &volts);
        let follow = gaps.iter().all(|gap| gap.abs() <= steps.largest_gap_v());
        let touch = self.contacts == [Contact::On; LANES];
        if follow && touch && steps.all_push(&next) {
            self.add_currents(steps, &gaps, &next, electric);
            self.states = next;
        } else {
            for (lane, volts) in volts.into_iter().enumerate() {
                self.sample_alone(steps, (lane, volts), electric);
            }
        }
        for ((saturated, asked), volts) in self.saturated.iter_mut().zip(asked).zip(volts) {
            *saturated += f64::from(u8::from(asked.abs() > volts.abs()));
        }
    }

    /// One sample of one contactor through whatever regimes it passes.
    fn sample_alone(&mut self, steps: &Steps, (lane, volts): (usize, f64), electric: (f64, f64)) {
        let from = self.states.map(|states| states[lane]);
        let drives = steps.drives(from[U_AMP], volts);
        let mut to = from;
        steps.advance(&mut to, &mut self.contacts[lane], drives);
        for (states, value) in self.states.iter_mut().zip(to) {
            states[lane] = value;
        }
        let [square, largest] = steps.current((&from, &to), &drives, electric);
        self.squares[lane] += square;
        self.largest_a[lane] = self.largest_a[lane].max(largest);
        self.lost[lane] += f64::from(u8::from(self.contacts[lane] == Contact::Off));
        self.saturated[lane] += f64::from(u8::from(drives.is_slewing()));
    }

    /// The currents of a plain sample, as [`Steps::current`] has them.
    fn add_currents(
        &mut self,
        steps: &Steps,
        gaps: &Lane,
        next: &[Lane; N_STATES],
        (capacitance_f, charge_c_per_m): (f64, f64),
    ) {
        let [per_gap, per_square] = steps.slopes_of_gap();
        for (lane, gap) in gaps.iter().enumerate() {
            let (speed, speed_then) = (self.states[V_BEAM][lane], next[V_BEAM][lane]);
            let risen = next[U_AMP][lane] - self.states[U_AMP][lane];
            let moving = 0.5 * charge_c_per_m * (speed + speed_then);
            let charging = capacitance_f * risen / SAMPLE_S;
            let square = capacitance_f * capacitance_f * per_square * gap * gap
                + 2.0 * charging * moving
                + moving * moving;
            let first = capacitance_f * per_gap * gap + charge_c_per_m * speed;
            self.squares[lane] += square.max(0.0);
            self.largest_a[lane] = self.largest_a[lane].max(first.abs());
        }
    }

    fn measure(&mut self, phasors: &Phasors) {
        let x = &self.states[X_PIN];
        for (peak, x) in self.peak_m.iter_mut().zip(x) {
            *peak = peak.max(x.abs());
        }
        for (sums, factors) in self.lines.iter_mut().zip(phasors) {
            for (sum, factor) in sums.iter_mut().zip(factors) {
                for (sum, x) in sum.iter_mut().zip(x) {
                    *sum += factor * x;
                }
            }
        }
    }

    fn reading(&self, lane: usize) -> ContactorReading {
        let n = SAMPLES_PER_TICK as f64;
        let line = |band: usize| {
            let [cos, sin] = [0, 1].map(|part| self.lines[band][part][lane]);
            2e6 / n * cos.hypot(sin)
        };
        ContactorReading {
            amplitude_um: [line(0), line(1)],
            peak_um: 1e6 * self.peak_m[lane],
            current_rms_ma: 1e3 * (self.squares[lane] / n).sqrt(),
            current_peak_ma: 1e3 * self.largest_a[lane],
            lost_share: self.lost[lane] / n,
            saturated_share: self.saturated[lane] / n,
        }
    }
}

/// The step of four contactors whose only input is their voltage.
fn abreast(step: &Step, states: &[Lane; N_STATES], volts: &Lane) -> [Lane; N_STATES] {
    from_fn(|row| {
        let [by_volts, _] = step.input[row];
        let mut sum = volts.map(|volts| by_volts * volts);
        for (factor, states) in step.state[row].iter().zip(states) {
            for (sum, state) in sum.iter_mut().zip(states) {
                *sum += factor * state;
            }
        }
        sum
    })
}
