//! A device, its clock and both directions of its link, with everything that is to go wrong.

use super::clock::DeviceClock;
use super::faults::{Direction, Faults, Injection, InjectionKind, OneOff, OneOffKind};
use super::faulty_channel::{BOOT_BANNER, FaultyChannel};
use crate::actuator_model::ContactorModel;
use crate::device::{
    AppliedFrame, CoreCounters, DeviceCore, DeviceModel, DeviceSink, Load, Moment, Sense,
};
use crate::message::fault_bit;

const HOT_CDEG: i16 = 8500;
const OVER_CURRENT_MA: u16 = 900;
const SAGGING_PER_MILLE: u16 = 600;

/// The way out of the device, borrowing all but the device itself.
macro_rules! link_sink {
    ($wired:expr, $sink:expr) => {
        LinkSink {
            link: &mut $wired.to_host,
            now_us: $wired.now_us,
            sink: $sink,
            #[cfg(test)]
            tap: &mut $wired.tap,
        }
    };
}

/// Takes what a [`WiredDevice`] emits: what its device does, and what was done to both.
pub(crate) trait WireSink: DeviceSink {
    /// A fault was injected into the device or its link.
    fn injected(&mut self, _moment: &Moment, _injection: &Injection) {}
}

impl WireSink for Vec<u8> {}

/// An emulated device as a host finds it at the end of a cable, in told true time.
#[derive(Clone, Debug)]
pub struct WiredDevice {
    model: DeviceModel,
    core: DeviceCore,
    clock: DeviceClock,
    /// True time of the last boot.
    boot_us: u64,
    now_us: u64,
    to_device: FaultyChannel,
    to_host: FaultyChannel,
    /// Begins and ends of what happens at told times, latest first.
    schedule: Vec<(u64, bool, OneOff)>,
    /// How many causes keep the cable out, and the device from running.
    n_unplugged: u32,
    n_booting: u32,
    stalled_reading_until_us: u64,
    earlier: Vec<CoreCounters>,
    #[cfg(test)]
    pub(super) tap: super::tests::Tap,
}

impl WiredDevice {
    /// Boots a device whose link and nature have these faults.
    pub fn new(model: DeviceModel, faults: &Faults) -> Self {
        let mut model = model;
        model.lies.extend(&faults.lies);
        model.wiring.dead.extend(&faults.wiring.dead);
        model.wiring.swapped.extend(&faults.wiring.swapped);
        if let Some(max_ma) = faults.over_current_ma {
            model.over_current_ma = Some(max_ma);
            // What trips must be measured.
            let usual = || ContactorModel::default().load();
            model.load.get_or_insert_with(usual);
        }
        let mut schedule: Vec<(u64, bool, OneOff)> = faults
            .once
            .iter()
            .flat_map(|&once| {
                let ends_us = once.at_us.saturating_add(once.for_us);
                [(once.at_us, true, once), (ends_us, false, once)]
            })
            .collect();
        // Taken from the end. Of what falls together, ends come first.
        schedule.sort_by_key(|&(at_us, begins, _)| std::cmp::Reverse((at_us, begins)));
        let mut wired = Self {
            core: DeviceCore::new(model.clone()),
            model,
            clock: DeviceClock::new(faults.clock_ppm, faults.tick_jitter_us, faults.seed),
            boot_us: 0,
            now_us: 0,
            to_device: FaultyChannel::new(faults.to_device, Direction::ToDevice, faults.seed),
            to_host: FaultyChannel::new(faults.to_host, Direction::ToHost, faults.seed),
            schedule,
            n_unplugged: 0,
            n_booting: 0,
            stalled_reading_until_us: 0,
            earlier: Vec::new(),
            #[cfg(test)]
            tap: super::tests::Tap::default(),
        };
        wired.to_host.say(0, BOOT_BANNER);
        wired
    }

    /// Takes bytes that the host wrote at `now_us`; they arrive when the link lets them, at the
    /// earliest in the next [`advance`](Self::advance). Without a cable they are lost.
    pub(crate) fn host_wrote(&mut self, now_us: u64, bytes: &[u8]) {
        if self.is_plugged() && !bytes.is_empty() {
            self.to_device.send(now_us.max(self.now_us), bytes);
        }
    }

    /// Lets true time pass up to `now_us` (going back is ignored). What arrives at the host goes to
    /// `sink` as packets, which may be cut anywhere.
    pub(crate) fn advance(&mut self, now_us: u64, sink: &mut impl WireSink) {
        let end_us = now_us.max(self.now_us);
        while let Some(at_us) = self.next_deadline_us().filter(|at_us| *at_us <= end_us) {
            self.now_us = at_us.max(self.now_us);
            self.step(sink);
        }
        self.now_us = end_us;
        self.advance_core(sink);
    }

    /// When [`advance`](Self::advance) has something to do next, µs of true time; `None` while only
    /// bytes can change anything.
    pub(crate) fn next_deadline_us(&self) -> Option<u64> {
        let scheduled = self.schedule.last().map(|&(at_us, ..)| at_us);
        let links = earlier(self.to_device.next_due_us(), self.to_host.next_due_us());
        earlier(earlier(scheduled, self.core_deadline_us()), links)
    }

    /// Whether the cable is in.
    pub(crate) fn is_plugged(&self) -> bool {
        self.n_unplugged == 0
    }

    /// Whether the device takes bytes from its port at all at `now_us`.
    pub(crate) fn is_reading(&self, now_us: u64) -> bool {
        now_us >= self.stalled_reading_until_us
    }

    /// The device at the end of the cable.
    pub fn core(&self) -> &DeviceCore {
        &self.core
    }

    /// The same, to change what it senses or to break it.
    #[cfg(test)]
    pub(crate) fn core_mut(&mut self) -> &mut DeviceCore {
        &mut self.core
    }

    /// Lets the device measure the current of amplifiers with this load, after a reboot too.
    pub(crate) fn set_load(&mut self, load: Load) {
        self.model.load = Some(load);
        self.core.set_load(load);
    }

    /// Event counts of every boot, the present one last.
    pub fn counters_of_boots(&self) -> Vec<CoreCounters> {
        let mut counters = self.earlier.clone();
        counters.push(self.core.counters());
        counters
    }

    fn device_us(&self) -> u64 {
        self.clock
            .device_us(self.now_us.saturating_sub(self.boot_us))
    }

    fn core_deadline_us(&self) -> Option<u64> {
        let deadline_us = self.core.next_deadline_us()?;
        Some(self.boot_us + self.clock.true_us(deadline_us))
    }

    /// Everything that is due now.
    fn step(&mut self, sink: &mut impl WireSink) {
        while let Some(&(at_us, begins, once)) = self.schedule.last()
            && at_us <= self.now_us
        {
            self.schedule.pop();
            self.advance_core(sink);
            if begins {
                self.begin(once, sink);
            } else {
                self.end(once, sink);
            }
        }
        self.advance_core(sink);
        self.deliver(sink);
        let taken = [&mut self.to_device, &mut self.to_host].map(FaultyChannel::take_injections);
        for injection in taken.into_iter().flatten() {
            sink.injected(&self.core.moment(), &injection);
        }
    }

    fn advance_core(&mut self, sink: &mut impl WireSink) {
        let device_us = self.device_us();
        let mut out = link_sink!(self, sink);
        self.core.advance(device_us, &mut out);
    }

    /// Both directions' bytes that have arrived.
    fn deliver(&mut self, sink: &mut impl WireSink) {
        self.to_device.make_due(self.now_us);
        self.to_host.make_due(self.now_us);
        if !self.is_plugged() {
            #[cfg(test)]
            self.tap.cleared(&self.to_device);
            self.to_device.clear();
            self.to_host.clear();
            return;
        }
        let device_us = self.device_us();
        while let Some(bytes) = self.to_device.take(self.now_us) {
            if self.n_booting > 0 {
                #[cfg(test)]
                self.tap.discarded(&bytes);
                continue;
            }
            #[cfg(test)]
            self.tap.delivered(device_us, &bytes);
            let mut out = link_sink!(self, sink);
            self.core.receive(device_us, &bytes, &mut out);
        }
        while let Some(bytes) = self.to_host.take(self.now_us) {
            sink.packet(&bytes);
        }
    }

    fn begin(&mut self, once: OneOff, sink: &mut impl WireSink) {
        self.report(InjectionKind::Begins(once.kind), once, sink);
        let until_us = once.at_us.saturating_add(once.for_us);
        match once.kind {
            OneOffKind::StallReading => {
                self.to_device.stall(until_us);
                self.stalled_reading_until_us = self.stalled_reading_until_us.max(until_us);
            }
            OneOffKind::StallWriting => self.to_host.stall(until_us),
            OneOffKind::Unplug => {
                self.n_unplugged += 1;
                #[cfg(test)]
                self.tap.hung_up();
                let mut out = link_sink!(self, sink);
                self.core.hang_up(&mut out);
            }
            OneOffKind::Reboot | OneOffKind::Watchdog => self.go_down(sink),
            OneOffKind::OverTemperature | OneOffKind::OverCurrent | OneOffKind::HvSag => {
                let (bits, value, sense) = sensed(once.kind);
                self.core.set_sense(sense);
                let mut out = link_sink!(self, sink);
                self.core.raise_fault(bits, u16::MAX, value, &mut out);
            }
        }
    }

    fn end(&mut self, once: OneOff, sink: &mut impl WireSink) {
        match once.kind {
            OneOffKind::StallReading | OneOffKind::StallWriting => {}
            OneOffKind::Unplug => self.n_unplugged -= 1,
            OneOffKind::Reboot => self.come_up(),
            OneOffKind::Watchdog => {
                self.come_up();
                let bits = fault_bit::WATCHDOG;
                let mut out = link_sink!(self, sink);
                self.core.raise_fault(bits, u16::MAX, 0, &mut out);
                self.core.end_fault_cause(bits);
            }
            OneOffKind::OverTemperature | OneOffKind::OverCurrent | OneOffKind::HvSag => {
                self.core.set_sense(Sense::default());
                self.core.end_fault_cause(sensed(once.kind).0);
            }
        }
        self.report(InjectionKind::Ends(once.kind), once, sink);
    }

    /// Output is gone with the processor.
    fn go_down(&mut self, sink: &mut impl WireSink) {
        #[cfg(test)]
        self.tap.booted();
        self.n_booting += 1;
        self.earlier.push(self.core.counters());
        let was_live = self.core.state().is_live();
        self.core = DeviceCore::new(self.model.clone());
        self.boot_us = self.now_us;
        if was_live {
            sink.changed(&self.core.moment());
        }
    }

    fn come_up(&mut self) {
        self.n_booting -= 1;
        self.core = DeviceCore::new(self.model.clone());
        self.boot_us = self.now_us;
        self.to_host.say(self.now_us, BOOT_BANNER);
    }

    fn report(&self, kind: InjectionKind, once: OneOff, sink: &mut impl WireSink) {
        let amount = once.for_us;
        sink.injected(&self.core.moment(), &Injection { kind, amount });
    }
}

/// What a device reports and senses of a cause that it measures: fault bits, value, senses.
fn sensed(kind: OneOffKind) -> (u16, i32, Sense) {
    let mut sense = Sense::default();
    match kind {
        OneOffKind::OverTemperature => {
            sense.temp_cdeg = HOT_CDEG;
            (fault_bit::OVER_TEMPERATURE, HOT_CDEG.into(), sense)
        }
        OneOffKind::OverCurrent => {
            sense.i_ma = OVER_CURRENT_MA;
            (fault_bit::OVER_CURRENT, OVER_CURRENT_MA.into(), sense)
        }
        _ => {
            sense.hv_per_mille = SAGGING_PER_MILLE;
            (fault_bit::HIGH_VOLTAGE, SAGGING_PER_MILLE.into(), sense)
        }
    }
}

/// The earlier of two times that may not come.
fn earlier(a: Option<u64>, b: Option<u64>) -> Option<u64> {
    a.into_iter().chain(b).min()
}

/// What the device emits: bytes into the link, the rest on to whoever listens.
struct LinkSink<'a, S> {
    link: &'a mut FaultyChannel,
    now_us: u64,
    sink: &'a mut S,
    #[cfg(test)]
    tap: &'a mut super::tests::Tap,
}

impl<S: DeviceSink> DeviceSink for LinkSink<'_, S> {
    fn packet(&mut self, bytes: &[u8]) {
        #[cfg(test)]
        self.tap.emitted(bytes);
        self.link.send(self.now_us, bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        #[cfg(test)]
        self.tap.applied(frame);
        self.sink.applied(frame);
    }

    fn changed(&mut self, moment: &Moment) {
        #[cfg(test)]
        self.tap.changed(moment);
        self.sink.changed(moment);
    }

    fn stepped(&mut self, device: &DeviceCore) {
        self.sink.stepped(device);
    }
}
