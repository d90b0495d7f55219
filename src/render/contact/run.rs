//! A stylus that is led over a surface, step by step: what a command writes and a window shows.

use super::controller::{HapticLoop, LoopTick, period_s};
use super::crossover::Crossover;
use super::device::{Along, Pull, SimulatedDevice, StylusDevice as _};
use super::limits::WallCase;
use super::patch::Contact;
use super::row::StylusRow;
use super::setup::StylusSetup;
use super::stepper::{Motion, Stepper};
use crate::RenderError;

/// What a run may gain, as a multiple of all that was put in, before it is called unstable.
const MAX_GAIN: f64 = 10.0;
/// An energy that nobody feels, J.
const NOTHING_J: f64 = 1e-9;

/// Where a run begins, at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StylusStart {
    /// So far above the surface, mm.
    Above(f64),
    /// Where the hand's force rests on the surface.
    Resting,
}

/// A stylus on its way over a surface. Making one allocates; a step does not.
#[derive(Debug, Clone)]
pub struct StylusRun {
    contact: Contact,
    device: SimulatedDevice,
    /// The loop, and the force that it is about to hold.
    sampled: Option<(HapticLoop, LoopTick)>,
    method: Stepper,
    rate_hz: f64,
    crossover: Crossover,
    n_steps: u64,
    row: StylusRow,
    start_j: f64,
    /// What leading it along the surface put in since the start: its sum, and that of its sizes.
    driven_j: [f64; 2],
    advice: String,
}

impl StylusRun {
    /// A run from a place on the surface, mm.
    ///
    /// # Errors
    /// A setting that is none, each with how to mend it.
    pub fn new(
        setup: StylusSetup,
        place_mm: [f64; 2],
        start: StylusStart,
    ) -> Result<Self, RenderError> {
        if let StylusStart::Above(above_mm) = start {
            RenderError::within(("height of the start", above_mm, "mm"), [-1e3, 1e3])?;
        }
        let case = setup.case();
        let setup = setup.checked()?;
        let case = WallCase {
            method: setup.method,
            ..case
        };
        let StylusSetup {
            mut contact,
            device: spec,
            hand,
            method,
            rate_hz,
            sampling,
        } = setup;
        let period_s = period_s(rate_hz)?;
        let device = SimulatedDevice::new(spec, hand, (method, period_s), [0.0; 3])?;
        contact.forget();
        let sampled = sampling.map(|sampling| {
            let rate = (rate_hz, sampling);
            HapticLoop::new(contact.clone(), rate, spec.mass_kg, hand.press_n)
        });
        let mut run = Self {
            sampled: sampled.transpose()?.map(|one| (one, LoopTick::default())),
            crossover: Crossover::new(spec.bandwidth_hz, rate_hz),
            advice: case.advice(),
            n_steps: 0,
            row: StylusRow::default(),
            start_j: 0.0,
            driven_j: [0.0; 2],
            contact,
            device,
            method,
            rate_hz,
        };
        if !run.begin(place_mm, start) {
            return Err(run.why_not(place_mm));
        }
        Ok(run)
    }

    /// Begins anew from a place on the surface, mm, as if nothing had been before; whether it is
    /// there. Allocates nothing.
    pub fn begin(&mut self, place_mm: [f64; 2], start: StylusStart) -> bool {
        self.contact.forget();
        for instant in 0..3 {
            self.contact.look(instant, place_mm, [0.0; 2]);
        }
        let z_mm = match start {
            StylusStart::Above(above_mm) => 1e3 * self.contact.rest_m(0, 0.0) + above_mm,
            StylusStart::Resting => 1e3 * self.contact.rest_m(0, self.device.hand.press_n),
        };
        self.device.put_at([place_mm[0], place_mm[1], z_mm]);
        self.contact.go_on(1e-3 * z_mm);
        if let Some((sampled, tick)) = &mut self.sampled {
            sampled.begin(&self.contact);
            *tick = LoopTick::default();
        }
        let spec = &self.device.spec;
        self.crossover = Crossover::new(spec.bandwidth_hz, self.rate_hz);
        (self.n_steps, self.driven_j) = (0, [0.0; 2]);
        let is_there = is_place(place_mm) && z_mm.is_finite() && self.sense().is_ok();
        self.start_j = self.row.energy_j;
        is_there
    }

    /// How it is at this instant.
    pub fn row(&self) -> &StylusRow {
        &self.row
    }

    /// The stepper that it takes.
    pub fn method(&self) -> Stepper {
        self.method
    }

    /// Steps, or ticks of the controller, a second.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// The energy that the passivity observer counted, J; `None` of a force that acts at all
    /// times.
    pub fn observed_j(&self) -> Option<f64> {
        let (sampled, _) = self.sampled.as_ref()?;
        Some(sampled.passivity().energy_j())
    }

    /// Energy at the start and all that leading it along the surface put in or took since, J.
    pub fn put_in_j(&self) -> f64 {
        self.start_j.abs() + self.driven_j[1]
    }

    /// Energy that came from nowhere so far, J: what is there, less what was there at the start and
    /// what leading it along the surface put in.
    pub fn gained_j(&self) -> f64 {
        self.row.energy_j - self.start_j - self.driven_j[0]
    }

    /// Steps on, while the hand leads the stylus to a place along the surface, mm.
    ///
    /// # Errors
    /// A place that is none; motion that grows without bound, with the stable limit.
    pub fn step(&mut self, target_mm: [f64; 2]) -> Result<&StylusRow, RenderError> {
        if self.advance(target_mm) {
            Ok(&self.row)
        } else {
            Err(self.why_not(target_mm))
        }
    }

    /// The same for a thread that must not allocate: whether that could be done.
    pub fn advance(&mut self, target_mm: [f64; 2]) -> bool {
        if !is_place(target_mm) {
            return false;
        }
        self.lead_to(target_mm);
        let before = self.device.upright;
        if let Some((_, tick)) = &self.sampled {
            if self.device.hold_n(tick.force_n).is_err() {
                return false;
            }
            let Along {
                place_mm,
                velocity_m_per_s,
            } = self.device.along;
            self.contact.look(2, place_mm, velocity_m_per_s);
        } else {
            self.step_free();
        }
        let after_m = self.device.upright.z_m;
        let mean_n =
            (self.sampled.is_none() && self.device.spec.axes[2]).then(|| self.mean_n(before));
        // A tip that the surface cannot push aside is lifted by whoever leads it.
        if self.device.hand.leads.is_none()
            || !(self.device.spec.axes[0] || self.device.spec.axes[1])
        {
            self.drive(self.contact.lifting_j([before.z_m, after_m], mean_n));
        }
        self.contact.go_on(after_m);
        self.n_steps += 1;
        self.sense().is_ok() && self.is_bounded()
    }

    /// The contact's mean force along z over a step that began so: what moved the mass, N.
    fn mean_n(&self, before: Motion) -> f64 {
        let after = self.device.upright;
        let gained = self.device.spec.mass_kg * (after.v_m_per_s - before.v_m_per_s);
        let damped = self.device.spec.damping_n_s_per_m * (after.z_m - before.z_m);
        (gained + damped) / self.device.period_s + self.device.hand.press_n
    }

    /// The hand moves on, and puts into its spring what that takes.
    fn lead_to(&mut self, target_mm: [f64; 2]) {
        let stiffness = self
            .device
            .hand
            .leads
            .map_or(0.0, |[stiffness, _]| stiffness);
        let before_j = self.spring_j(stiffness);
        self.device.target_mm = target_mm;
        self.drive(self.spring_j(stiffness) - before_j);
    }

    /// Energy of the leading hand's spring, J.
    fn spring_j(&self, stiffness: f64) -> f64 {
        let place_mm = self.device.along.place_mm;
        let away_m = [0, 1].map(|i| 1e-3 * (self.device.target_mm[i] - place_mm[i]));
        0.5 * stiffness * (away_m[0] * away_m[0] + away_m[1] * away_m[1])
    }

    fn drive(&mut self, work_j: f64) {
        self.driven_j[0] += work_j;
        self.driven_j[1] += work_j.abs();
    }

    /// A step with a force that acts at all times.
    fn step_free(&mut self) {
        let step_s = self.device.period_s;
        let (from, along) = (self.device.upright, self.device.along);
        let load = self.contact.load(0, from);
        let hold = self.contact.hold(
            (load.normal_n, along.place_mm[0]),
            along.velocity_m_per_s,
            step_s,
        );
        let shown = |axis: usize| {
            if self.device.spec.axes[axis] {
                1.0
            } else {
                0.0
            }
        };
        let damping = self.device.spec.damping_n_s_per_m;
        let pull = Pull {
            force_n: [0, 1].map(|axis| shown(axis) * (load.along_n[axis] - hold.held_n[axis])),
            drag: damping + shown(0).max(shown(1)) * hold.drag,
            stiffness: [0, 1].map(|axis| shown(axis) * load.stiffness[axis]),
            friction_n: self.device.spec.friction_n,
        };
        let mass = (self.device.spec.mass_kg, &pull);
        let next = self
            .device
            .hand
            .led(along, mass, self.device.target_mm, step_s);
        self.device.along = next;
        self.contact.rub(&hold, next.velocity_m_per_s, step_s);
        self.contact.set_off(next.velocity_m_per_s);
        if self.method == Stepper::RungeKutta4 {
            let middle_mm = [0, 1].map(|axis| 0.5 * (along.place_mm[axis] + next.place_mm[axis]));
            self.contact.look(1, middle_mm, next.velocity_m_per_s);
        }
        self.contact.look(2, next.place_mm, next.velocity_m_per_s);
        if !self.device.spec.axes[2] {
            let z_m = self.contact.rest_m(2, self.device.hand.press_n);
            self.device.upright = Motion {
                z_m,
                v_m_per_s: 0.0,
            };
            return;
        }
        if self.device.sticks(load.up_n - self.device.hand.press_n) {
            return;
        }
        let column =
            self.contact
                .column(self.device.spec.mass_kg, damping, -self.device.hand.press_n);
        self.device.upright = column.step(self.method, from, step_s);
        self.device.rub();
    }

    /// Finds the forces of this instant.
    fn sense(&mut self) -> Result<(), RenderError> {
        let at = self.device.upright;
        let ([x_mm, y_mm], z_mm) = (self.device.along.place_mm, 1e3 * at.z_m);
        let load = self.contact.load(0, at);
        let mut row = StylusRow {
            t_s: self.n_steps as f64 / self.rate_hz,
            place_mm: [x_mm, y_mm, z_mm],
            depth_um: 1e6 * load.depth_m,
            force_n: load.normal_n,
            tangential_n: self.contact.friction_n(&load),
            ..StylusRow::default()
        };
        if let Some((sampled, tick)) = &mut self.sampled {
            *tick = sampled.sense(&mut self.device)?;
            row.place_mm[2] = if self.device.spec.axes[2] {
                z_mm
            } else {
                tick.place_mm[2]
            };
            (row.force_n, row.tangential_n) = (tick.normal_n, tick.tangential_n);
        }
        [_, row.vibration_n] = self.crossover.split_n(row.force_n);
        row.energy_j = self.energy_j(at);
        self.row = row;
        Ok(())
    }

    fn energy_j(&self, at: Motion) -> f64 {
        let along = &self.device.along;
        let mut of_motion = at.v_m_per_s * at.v_m_per_s;
        let mut of_hand_j = self.device.hand.press_n * at.z_m;
        if let Some([stiffness, _]) = self.device.hand.leads {
            let [vx, vy] = along.velocity_m_per_s;
            of_motion += vx * vx + vy * vy;
            of_hand_j += self.spring_j(stiffness);
        }
        let of_contact_j = self.contact.energy_j(0, at.z_m);
        0.5 * self.device.spec.mass_kg * of_motion + of_contact_j + of_hand_j
    }

    fn is_bounded(&self) -> bool {
        let gained_j = self.gained_j();
        let most_j = MAX_GAIN * (self.put_in_j() + NOTHING_J);
        gained_j.is_finite() && gained_j <= most_j
    }

    /// Why a step towards a place could not be made.
    fn why_not(&self, target_mm: [f64; 2]) -> RenderError {
        if is_place(target_mm) {
            let what = format!("the motion grows without end at {} s", self.row.t_s);
            return RenderError::stylus(what, self.advice.clone());
        }
        let what = format!("the path leads to {target_mm:?} mm");
        RenderError::stylus(what, "give finite places in mm")
    }
}

/// Whether there may be such a place along a surface, mm.
fn is_place(place_mm: [f64; 2]) -> bool {
    place_mm.iter().all(|mm| mm.abs() <= 1e9)
}
