//! What contactors did in a tick: plain data, copied whole.

use crate::message::DeviceState;

/// One contactor in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ContactorReading {
    /// Peak displacement of the lines at 40 and 320 Hz, µm.
    pub amplitude_um: [f64; 2],
    /// Largest distance from rest at the samples, µm.
    pub peak_um: f64,
    /// Root mean square of the amplifier's current, mA.
    pub current_rms_ma: f64,
    /// Its largest current, mA: right after a step of the DAC.
    pub current_peak_ma: f64,
    /// Share of the samples that ended without skin on the pin, 0…1; no finger counts as on.
    pub lost_share: f64,
    /// Share of the samples in which rails or slope held the amplifier back, 0…1.
    pub saturated_share: f64,
}

/// An array in a tick.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorReading {
    /// Ticks read so far; 0 before the first.
    pub n_ticks: u64,
    /// The device's state at the end of the tick.
    pub state: DeviceState,
    /// The codes at the end of the tick, `[40 Hz, 320 Hz]` per contactor.
    pub codes: Vec<[u16; 2]>,
    /// Contactors in index order.
    pub contactors: Vec<ContactorReading>,
}

impl ActuatorReading {
    /// Nothing read yet.
    pub fn new(n_contactors: usize) -> Self {
        Self {
            n_ticks: 0,
            state: DeviceState::Idle,
            codes: vec![[0; 2]; n_contactors],
            contactors: vec![ContactorReading::default(); n_contactors],
        }
    }

    /// Current of the whole array, root mean squares added, mA.
    pub fn current_ma(&self) -> f64 {
        let currents = self.contactors.iter().map(|one| one.current_rms_ma);
        currents.sum()
    }

    /// Takes over another reading of as many contactors without allocating.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.clone_from(other);
    }
}
