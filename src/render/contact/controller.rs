//! The controller of a real device: sampled places in, held forces out.
//!
//! At every tick it reads the encoders, takes velocities as backward differences, looks up the
//! contact, and gives a force that is held until the next (zero-order hold), some ticks late if
//! asked. What a device and a wall do with that is [`super::limits`]' subject.

use super::device::StylusDevice;
use super::passivity::Passivity;
use super::patch::Contact;
use super::stepper::Motion;
use crate::RenderError;

/// Most ticks that a force may be late.
const MAX_DELAY: usize = 32;

/// How a force is sampled and held.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sampling {
    /// Ticks between reading a place and giving its force.
    pub delay_ticks: usize,
    /// Whether the passivity controller may change forces; it observes in any case.
    pub is_kept_passive: bool,
}

/// What one tick found and gives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LoopTick {
    /// The tip's place as it was read, mm; its height where it rests if the device gives none.
    pub place_mm: [f64; 3],
    /// How deep the deepest contact is, µm.
    pub depth_um: f64,
    /// Force along the normal, N.
    pub normal_n: f64,
    /// Friction along the surface, N.
    pub tangential_n: f64,
    /// What is held until the next tick, N.
    pub force_n: [f64; 3],
}

/// The loop between a surface and a device.
#[derive(Debug, Clone)]
pub struct HapticLoop {
    contact: Contact,
    period_s: f64,
    /// With what force a hand presses a device that gives none along z, N.
    press_n: f64,
    /// Ticks whose forces are still to be given, in a ring.
    late: Vec<LoopTick>,
    next: usize,
    before_mm: Option<[f64; 3]>,
    passivity: Passivity,
}

impl HapticLoop {
    /// A loop at a rate, Hz, for a device of a mass. A hand is taken to press with `press_n` if the
    /// device gives no force along z.
    ///
    /// # Errors
    /// A rate outside 1 Hz–1 MHz, a delay of more than 32 ticks.
    pub fn new(
        contact: Contact,
        (rate_hz, sampling): (f64, Sampling),
        mass_kg: f64,
        press_n: f64,
    ) -> Result<Self, RenderError> {
        let period_s = period_s(rate_hz)?;
        if sampling.delay_ticks > MAX_DELAY {
            return Err(RenderError::stylus(
                format!("a force that is {} ticks late", sampling.delay_ticks),
                format!("give a delay of at most {MAX_DELAY} ticks"),
            ));
        }
        Ok(Self {
            contact,
            period_s,
            press_n,
            late: vec![LoopTick::default(); sampling.delay_ticks],
            next: 0,
            before_mm: None,
            passivity: Passivity::new(mass_kg, period_s, sampling.is_kept_passive),
        })
    }

    /// Begins anew where a contact is, with the controller that it has.
    pub(super) fn begin(&mut self, contact: &Contact) {
        self.contact.go_where(contact);
        self.late.fill(LoopTick::default());
        (self.next, self.before_mm) = (0, None);
        self.passivity.forget();
    }

    /// The energy that was observed.
    pub fn passivity(&self) -> &Passivity {
        &self.passivity
    }

    /// One tick of a device: reads it, and holds the force. Neither allocates nor locks; what
    /// the device does is its own.
    ///
    /// # Errors
    /// Those of the device.
    pub fn tick(&mut self, device: &mut dyn StylusDevice) -> Result<LoopTick, RenderError> {
        let tick = self.sense(device)?;
        device.hold_n(tick.force_n)?;
        Ok(tick)
    }

    /// Reads a device and finds what is to be held.
    pub(super) fn sense(&mut self, device: &mut dyn StylusDevice) -> Result<LoopTick, RenderError> {
        let mut place_mm = device.read_mm()?;
        let spec = *device.spec();
        let before_mm = self.before_mm.unwrap_or(place_mm);
        let velocity =
            [0, 1, 2].map(|axis| 1e-3 * (place_mm[axis] - before_mm[axis]) / self.period_s);
        let ([x_mm, y_mm, _], [vx, vy, vz]) = (place_mm, velocity);
        self.contact.look(2, [x_mm, y_mm], [vx, vy]);
        let mut at = Motion {
            z_m: 1e-3 * place_mm[2],
            v_m_per_s: vz,
        };
        if !spec.axes[2] {
            at.z_m = self.contact.rest_m(2, self.press_n);
            place_mm[2] = 1e3 * at.z_m;
            at.v_m_per_s = 0.0;
        }
        self.before_mm = Some(place_mm);
        self.contact.go_on(at.z_m);
        let load = self.contact.load(0, at);
        let hold = self
            .contact
            .hold((load.normal_n, x_mm), [vx, vy], self.period_s);
        let friction_n = self.contact.rub(&hold, [vx, vy], self.period_s);
        let wanted = LoopTick {
            place_mm,
            depth_um: 1e6 * load.depth_m,
            normal_n: load.normal_n,
            tangential_n: friction_n[0].hypot(friction_n[1]),
            force_n: [
                load.along_n[0] + friction_n[0],
                load.along_n[1] + friction_n[1],
                load.up_n,
            ],
        };
        let mut given = self.delayed(wanted);
        let asked_n = spec.given_n(given.force_n);
        given.force_n = self.passivity.pass(place_mm, asked_n, self.period_s);
        given.normal_n += given.force_n[2] - asked_n[2];
        given.place_mm = place_mm;
        given.depth_um = wanted.depth_um;
        Ok(given)
    }

    fn delayed(&mut self, wanted: LoopTick) -> LoopTick {
        let n = self.late.len();
        let Some(slot) = self.late.get_mut(self.next) else {
            return wanted;
        };
        self.next = (self.next + 1) % n;
        std::mem::replace(slot, wanted)
    }
}

/// The period of a rate.
pub(super) fn period_s(rate_hz: f64) -> Result<f64, RenderError> {
    RenderError::within(("rate", rate_hz, "Hz"), [1.0, 1e6])?;
    Ok(1.0 / rate_hz)
}
