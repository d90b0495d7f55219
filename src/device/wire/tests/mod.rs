//! Failing links and devices in virtual time.

mod ledger;
mod lies;
mod mutated;
mod once;
mod ports;
mod silence;
mod soak;

use super::faulty_channel::FaultyChannel;
use super::*;
use crate::device::{AppliedFrame, DeviceModel, Moment};
use crate::host::{BridgeState, DisarmedBy};
use crate::message::DeviceState;

/// What went in and out of a device in its order, if somebody wants to know.
#[derive(Clone, Debug, Default)]
pub(super) struct Tap {
    pub(super) is_open: bool,
    pub(super) entries: Vec<Tapped>,
}

/// One step of a device's life.
#[derive(Clone, Debug)]
pub(super) enum Tapped {
    /// Bytes arrived at this device time.
    Delivered(u64, Vec<u8>),
    /// Bytes arrived while nobody was there to read them, or were under way in a pulled cable.
    Lost(Vec<u8>),
    /// The device wrote a packet.
    Emitted(Vec<u8>),
    /// A frame took effect at this tick.
    Applied(u32),
    /// The state changed.
    Changed(DeviceState),
    /// The device went down.
    Booted,
    /// The cable was pulled.
    HungUp,
}

impl Tap {
    fn put(&mut self, entry: Tapped) {
        if self.is_open {
            self.entries.push(entry);
        }
    }

    pub(super) fn delivered(&mut self, device_us: u64, bytes: &[u8]) {
        self.put(Tapped::Delivered(device_us, bytes.to_vec()));
    }

    pub(super) fn discarded(&mut self, bytes: &[u8]) {
        self.put(Tapped::Lost(bytes.to_vec()));
    }

    pub(super) fn cleared(&mut self, link: &FaultyChannel) {
        for bytes in link.waiting() {
            self.put(Tapped::Lost(bytes.to_vec()));
        }
    }

    pub(super) fn emitted(&mut self, bytes: &[u8]) {
        self.put(Tapped::Emitted(bytes.to_vec()));
    }

    pub(super) fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.put(Tapped::Applied(frame.moment.tick));
    }

    pub(super) fn changed(&mut self, moment: &Moment) {
        self.put(Tapped::Changed(moment.state));
    }

    pub(super) fn booted(&mut self) {
        self.put(Tapped::Booted);
    }

    pub(super) fn hung_up(&mut self) {
        self.put(Tapped::HungUp);
    }
}

/// Both directions treated alike.
fn both(link: LinkFaults) -> Faults {
    Faults {
        seed: 5,
        to_device: link,
        to_host: link,
        ..Faults::default()
    }
}
