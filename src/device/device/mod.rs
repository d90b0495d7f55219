//! A device of HBP v1 as a pure state machine: bytes and device time in, bytes and output codes
//! out.
//!
//! This is the reference for firmware and the heart of both emulators. It has no clock, no port and
//! no thread: callers say what time it is. All of its rules that keep a finger safe (lease, hold
//! and ramp, arming, STOP, faults) run on a 1 ms clock, so silence comes at a fixed age of the last
//! frame whatever the phase of the tick. Contactor physics is not here.

mod clock;
mod lie;
mod lying;
mod miswiring;
mod model;
mod output;
mod queue;
mod reception;
mod requests;
mod sense;
mod session;
mod sink;
mod trouble;

use super::framing::{Decoder, Packet};
use super::message::{Config, DeviceState, Fault, LogText, Message, Status, fault_bit};
use crate::fields::wrapped_u32;
pub use lie::FirmwareLie;
use lie::{LieMemory, Rule};
pub use miswiring::Miswiring;
pub use model::DeviceModel;
use output::{OutputStage, TICK};
use queue::FrameQueue;
pub use sense::{Load, Sense};
pub use sink::{AppliedFrame, DeviceSink, Moment};

const MS_US: u64 = 1000;
const FAULT_PERIOD_US: u64 = 100_000;

/// Event counts since boot; on the wire they wrap at 65536.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoreCounters {
    /// Ticks without a frame while armed, after the first accepted one.
    pub underrun: u16,
    /// Frames for a tick that had begun.
    pub late: u16,
    /// Frames with the seq of the one before.
    pub dup: u16,
    /// Texts that were no valid packet.
    pub bad: u16,
    /// Values above their limit plus channels over full drive.
    pub clipped: u16,
}

/// A host's visit.
#[derive(Clone, Debug)]
struct Session {
    id: u32,
    wants_status: bool,
    wants_log: bool,
    lease_us: u64,
    last_valid_us: u64,
    last_seq: Option<u16>,
    configured: bool,
}

/// The emulated device.
#[derive(Clone, Debug)]
pub struct DeviceCore {
    model: DeviceModel,
    decoder: Decoder,
    now_us: u64,
    state: DeviceState,
    reported: DeviceState,
    session: Option<Session>,
    config: Config,
    output: OutputStage,
    queue: FrameQueue,
    scratch: Vec<[u16; 2]>,
    counters: CoreCounters,
    /// When the last FRAME was accepted; none since ARM or HELLO is `None`.
    last_frame_us: Option<u64>,
    /// A ramp that nothing can turn back, and the state at its end: STOP or an expired lease.
    descent: Option<DeviceState>,
    faults: u16,
    fault_causes: u16,
    fault: Fault,
    sense: Sense,
    next_fault_us: u64,
    next_seq: u16,
    lie_memory: LieMemory,
}

impl DeviceCore {
    /// A device that has just booted: IDLE, no high voltage, all counters 0.
    pub fn new(model: DeviceModel) -> Self {
        let n_channels = model.n_channels();
        let nothing = Config {
            mode: 0,
            flags: 0,
            hold_ms: 0,
            ramp_ms: 0,
            slew: 0,
            hv_dv: 0,
            comp_limit: [0; 2],
            mask: super::message::ChannelMask::default(),
        };
        let (max_body, queue) = lie::room(&model.lies, model.max_body, model.queue);
        Self {
            decoder: Decoder::new(max_body),
            now_us: 0,
            state: lie::boot_state(&model.lies),
            reported: DeviceState::Idle,
            session: None,
            config: nothing,
            output: OutputStage::new(n_channels),
            queue: FrameQueue::new(queue, n_channels),
            scratch: vec![[0; 2]; n_channels],
            counters: CoreCounters::default(),
            last_frame_us: None,
            descent: None,
            faults: 0,
            fault_causes: 0,
            fault: Fault {
                faults: 0,
                channel: u16::MAX,
                value: 0,
                tick: 0,
            },
            sense: Sense::default(),
            next_fault_us: 0,
            next_seq: 0,
            lie_memory: LieMemory::default(),
            model,
        }
    }

    /// Lets device time pass up to `now_us` (µs since boot; going back is ignored).
    pub fn advance(&mut self, now_us: u64, sink: &mut impl DeviceSink) {
        let end_us = now_us.max(self.now_us);
        let mut step_us = (self.now_us / MS_US + 1) * MS_US;
        while step_us <= end_us && self.is_awake() {
            self.now_us = step_us;
            self.step_ms(sink);
            if step_us.is_multiple_of(TICK) {
                self.step_tick(sink);
            }
            sink.stepped(self);
            step_us += MS_US;
        }
        self.now_us = end_us;
        self.output.phase_us = end_us % TICK;
    }

    /// Takes bytes that arrive at `now_us`.
    pub fn receive(&mut self, now_us: u64, bytes: &[u8], sink: &mut impl DeviceSink) {
        self.advance(now_us, sink);
        if self.breaks(Rule::Echo) {
            sink.packet(bytes);
        }
        let (lies, tick) = (&self.model.lies, self.tick());
        let breaks = |rule| lie::value(lies, tick, rule).is_some();
        let misheard = self.lie_memory.hearing.changed(breaks, bytes);
        // The decoder moves out while a packet borrows from it.
        let mut decoder = std::mem::replace(&mut self.decoder, Decoder::new(0));
        for &byte in misheard.as_deref().unwrap_or(bytes) {
            if let Some(packet) = decoder.push(byte)
                && !self.handle(packet, sink)
            {
                decoder.count_bad();
            }
            self.count_bad(decoder.bad());
            self.report_change(sink);
        }
        self.decoder = decoder;
    }

    /// When [`advance`](Self::advance) should be called next, in µs since boot; `None` while only
    /// bytes can change anything.
    pub(crate) fn next_deadline_us(&self) -> Option<u64> {
        if !self.is_awake() {
            return None;
        }
        let next_ms = (self.now_us / MS_US + 1) * MS_US;
        let next_tick = (self.now_us / TICK + 1) * TICK;
        let moving = !self.model.lies.is_empty()
            || self.descent.is_some()
            || self.output.ident.is_some()
            || (self.state.is_live() && !self.output.is_gain_full());
        if moving {
            return Some(next_ms);
        }
        let ramp_us = self
            .last_frame_us
            .filter(|_| self.state.is_live())
            .map(|last_us| {
                ((last_us + u64::from(self.config.hold_ms) * MS_US) / MS_US + 1) * MS_US
            });
        Some(ramp_us.map_or(next_tick, |ramp_us| next_tick.min(ramp_us.max(next_ms))))
    }

    /// Output codes at this moment, `[40 Hz, 320 Hz]` per channel, everything applied, wiring
    /// faults too.
    pub fn output(&self) -> Vec<[u16; 2]> {
        let mut codes = vec![[0; 2]; self.model.n_channels()];
        self.write_output(&mut codes);
        codes
    }

    /// Writes [`output`](Self::output) to codes that are there already.
    pub(crate) fn write_output(&self, codes: &mut [[u16; 2]]) {
        codes.fill([0; 2]);
        if self.is_driven() {
            self.output.write_to(codes);
            self.model.wiring.connect(codes);
        }
    }

    /// The voltage of the amplifiers' rails, V: 0 while high voltage is off.
    pub(crate) fn rail_v(&self) -> f64 {
        0.1 * f64::from(self.measured_hv_dv())
    }

    /// Where the device is.
    pub fn state(&self) -> DeviceState {
        self.state
    }

    /// Event counts since boot.
    pub fn counters(&self) -> CoreCounters {
        self.counters
    }

    /// Ticks since boot.
    pub fn tick(&self) -> u32 {
        wrapped_u32(self.now_us / TICK)
    }

    /// The device now, as a log sees it.
    pub fn moment(&self) -> Moment {
        Moment {
            dev_us: self.now_us,
            tick: self.tick(),
            state: self.state,
            age_ms: self.age_ms(),
            age_us: self.age_us(),
            gain: self.output.gain(),
            amp_sum: self.amp_sum(),
        }
    }

    /// Whether time alone can change anything.
    fn is_awake(&self) -> bool {
        self.session.is_some() || self.state.is_live() || !self.model.lies.is_empty()
    }

    /// Whether what the output stage holds goes out.
    fn is_driven(&self) -> bool {
        let ident_alone = self.output.ident.is_some() && self.breaks(Rule::IdentAnywhere);
        self.state.is_live() || ident_alone
    }

    fn age_us(&self) -> Option<u64> {
        self.last_frame_us
            .map(|last_us| self.now_us.saturating_sub(last_us))
    }

    fn age_ms(&self) -> u16 {
        let without = if self.breaks(Rule::AgeZero) {
            0
        } else {
            u16::MAX
        };
        self.age_us().map_or(without, |age_us| {
            u16::try_from(age_us / MS_US).unwrap_or(u16::MAX)
        })
    }

    fn amp_sum(&self) -> u32 {
        if !self.is_driven() {
            0
        } else if self.breaks(Rule::SumBeforeGain) {
            self.output.sum_before_gain()
        } else if self.breaks(Rule::SumOfTarget) {
            self.output.target_sum()
        } else {
            self.output.amp_sum()
        }
    }

    fn status(&self) -> Status {
        let leaving = self.descent == Some(DeviceState::Idle);
        let informative = if leaving { fault_bit::LEASE_LOST } else { 0 };
        Status {
            tick: self.tick(),
            dev_us: wrapped_u32(self.now_us),
            last_seq: self
                .session
                .as_ref()
                .and_then(|session| session.last_seq)
                .unwrap_or(0),
            state: self.state.code(),
            queued: self.queue.len(),
            underrun: self.counters.underrun,
            late: self.counters.late,
            dup: self.counters.dup,
            bad: self.counters.bad,
            clipped: self.counters.clipped,
            hv_dv: self.measured_hv_dv(),
            i_ma: self.measured_ma(),
            temp_cdeg: self.sense.temp_cdeg,
            faults: self.faults | informative,
            age_ms: self.age_ms(),
            amp_sum: self.amp_sum(),
        }
    }

    fn send_fault(&mut self, sink: &mut impl DeviceSink) {
        self.next_fault_us = self.now_us + FAULT_PERIOD_US;
        if self.session.is_some() || self.breaks(Rule::FaultOutsideSession) {
            let fault = Fault {
                faults: self.faults,
                ..self.fault
            };
            self.send(&fault, sink);
        }
    }

    fn send(&mut self, message: &impl Message, sink: &mut impl DeviceSink) {
        let packet = message.packet(self.next_seq);
        self.send_packet(packet.as_ref(), sink);
    }

    /// Tells people something, if the host wants to hear it.
    fn say(&mut self, text: &str, sink: &mut impl DeviceSink) {
        let wants_log = self.session.as_ref().map(|session| session.wants_log);
        if wants_log.is_some_and(|wants| wants || self.breaks(Rule::LogUnasked)) {
            let packet = LogText::packet(self.next_seq, text);
            self.send_packet(packet.as_ref(), sink);
        }
    }

    fn send_packet(&mut self, packet: Option<&Packet>, sink: &mut impl DeviceSink) {
        let Some(packet) = packet else { return };
        self.next_seq = self.next_seq.wrapping_add(1);
        let (lies, tick) = (&self.model.lies, self.tick());
        if lies.is_empty() {
            sink.packet(packet.as_bytes());
        } else {
            sink.packet(&self.lie_memory.packet(lies, tick, packet));
        }
    }

    /// Keeps the count of texts that were no packet.
    fn count_bad(&mut self, bad: u64) {
        let times = 1 + u64::from(self.breaks(Rule::BadTwice));
        let told = wrapped(bad * times);
        if told != self.counters.bad && self.breaks(Rule::BadRenewsLease) {
            self.renew_lease();
        }
        self.counters.bad = told;
    }

    fn report_change(&mut self, sink: &mut impl DeviceSink) {
        if self.state != self.reported {
            self.reported = self.state;
            sink.changed(&self.moment());
        }
    }
}

/// The low 16 bits, as counters travel.
#[expect(
    clippy::cast_possible_truncation,
    reason = "counters wrap at 65536 on the wire"
)]
fn wrapped(count: u64) -> u16 {
    count as u16
}

#[cfg(test)]
pub(super) mod tests;
