//! One link of a log: its packets, in order, to the emulator, and the device's answers beside the
//! emulator's.

use super::judge::{Disagreement, EDGE_US, GUESS_US, Pair, Scope, compare_config, state_name};
use super::placing::{Placed, Placer, Written};
use super::report::ReplayedLink;
use super::twin::{ReplayedTick, Twin};
use crate::actuator_model::ContactorModel;
use crate::framing::{Packet, Received};
use crate::message::{
    Ack, Caps, Config, DeviceMessage, DeviceState, Ident, Message as _, Status, TICK_US, frame,
    kind,
};
use crate::session_log::{Body, Seen, event};

const TICK: u64 = TICK_US as u64;
/// A clock that jumps by more ticks is not followed.
const MAX_JUMP: i32 = 40;
/// Ticks that are not judged after a packet that may have arrived or not: until then its effect is
/// over, or confirmed.
const DOUBTFUL_TICKS: u32 = 8;
/// The same after packets that the log lost.
const BLIND_TICKS: u32 = 80;
/// By how much the time of a FRAME may be off that is known by its age, µs.
const AGE_US: u64 = 600;
/// How long a STOP or CLEAR whose time is a guess may show, µs.
const RAMP_US: u64 = 150_000;

/// A link being replayed.
pub(super) struct LinkReplay {
    number: u32,
    contactors: ContactorModel,
    caps: Option<Caps>,
    twin: Option<Twin>,
    placer: Placer,
    last: Option<Pair>,
    /// CFG and ACKs of the device, to be compared.
    told_config: Option<Config>,
    told_acks: Vec<Ack>,
    /// Until which tick nothing, and until which time nothing near an edge, is judged.
    doubtful_until: u32,
    guessed_until_us: u64,
    report: ReplayedLink,
}

impl LinkReplay {
    /// A link whose first line says this.
    pub(super) fn new(number: u32, heading: &str, utc: &str, contactors: ContactorModel) -> Self {
        Self {
            number,
            contactors,
            caps: None,
            twin: None,
            placer: Placer::default(),
            last: None,
            told_config: None,
            told_acks: Vec::new(),
            doubtful_until: 0,
            guessed_until_us: 0,
            report: ReplayedLink {
                heading: heading.to_owned(),
                utc: utc.to_owned(),
                is_hashed: heading.contains(super::HASHED),
                ..ReplayedLink::default()
            },
        }
    }

    /// Takes what a line tells; gives ticks that are over.
    pub(super) fn take(&mut self, seen: Seen, host_s: f64) -> Vec<ReplayedTick> {
        match seen {
            Seen::Sent(body) | Seen::Unsent(body) => {
                self.wrote(Written::Body(Box::new(body)), host_s);
            }
            Seen::SentBytes(bytes) => self.wrote(Written::Bytes(bytes), host_s),
            Seen::ReceivedBytes => self.report.counts.bad += 1,
            Seen::Hashed(hashed) => self.wrote(Written::Hashed(hashed), host_s),
            Seen::Received(body) => return self.received(&body, host_s),
            Seen::Note(name, detail) => self.noted(&name, &detail),
        }
        Vec::new()
    }

    /// Nothing follows: the last ticks, and what was found.
    pub(super) fn finish(mut self) -> (Vec<ReplayedTick>, ReplayedLink) {
        let ticks = self.twin.as_mut().map(Twin::finish).unwrap_or_default();
        self.count_largest(&ticks);
        self.report.counts.doubtful += self.placer.n_waiting();
        (ticks, self.report)
    }

    fn wrote(&mut self, written: Written, host_s: f64) {
        self.report.counts.frames += u64::from(written.is(kind::FRAME));
        self.report.counts.lost += self.placer.wrote(written, host_s);
    }

    fn noted(&mut self, name: &str, detail: &str) {
        let number = || detail.parse().unwrap_or(0);
        match name {
            event::ABOUT => self.report.about.push(detail.to_owned()),
            event::BAD => self.report.counts.bad += number(),
            event::PACKETS_LOST => {
                self.report.counts.unrecorded += number();
                self.doubt(BLIND_TICKS);
            }
            _ => {}
        }
    }

    /// From now on so many ticks are not judged.
    fn doubt(&mut self, n_ticks: u32) {
        let now = self.last.map_or(0, |pair| pair.device.tick);
        self.doubtful_until = now.saturating_add(n_ticks);
    }

    fn n_channels(&self) -> usize {
        self.caps.map_or(0, |caps| usize::from(caps.n_ch))
    }

    fn received(&mut self, body: &Body, host_s: f64) -> Vec<ReplayedTick> {
        let packet = Received {
            kind: body.kind,
            seq: body.seq,
            payload: body.payload(),
        };
        match DeviceMessage::decode(&packet, self.n_channels()) {
            Ok(DeviceMessage::Caps(caps)) => return self.caps(caps),
            Ok(DeviceMessage::Cfg(config)) => self.cfg(config),
            Ok(DeviceMessage::Ack(ack)) => {
                self.placer.acknowledged(ack);
                self.told_acks.push(ack);
            }
            Ok(DeviceMessage::Pong(pong)) => {
                let at_us = Self::unwrapped(pong.tick, pong.dev_us);
                let token = pong.token.to_le_bytes();
                let is_it =
                    |body: &Body| body.kind == kind::PING && body.payload().starts_with(&token);
                self.placer.answered(is_it, at_us);
            }
            Ok(DeviceMessage::Status(status)) => return self.status(&status, host_s),
            Ok(DeviceMessage::Fault(fault)) => self.fault(fault.faults),
            Ok(DeviceMessage::Log(_)) | Err(_) => {}
        }
        Vec::new()
    }

    /// CAPS of a session: another device from here on, unless it says the same.
    fn caps(&mut self, caps: Caps) -> Vec<ReplayedTick> {
        let session = caps.session.to_le_bytes();
        let is_it =
            |body: &Body| body.kind == kind::HELLO && body.payload().get(4..8) == Some(&session);
        self.placer.answered(is_it, None);
        let known = self.caps.unwrap_or_default();
        let same = Caps {
            session: caps.session,
            // A device that was offered no version of its own ends its session with version 0.
            version: caps.version.min(known.version),
            ..known
        };
        if self.twin.is_some() && same == caps {
            return Vec::new();
        }
        self.caps = Some(caps);
        self.last = None;
        let has_frames = !self.report.is_hashed;
        let ticks = self.twin.as_mut().map(Twin::finish).unwrap_or_default();
        self.twin = None;
        match Twin::new(self.number, &caps, &self.contactors, has_frames) {
            Ok(twin) => self.twin = Some(twin),
            Err(reason) => self.report.broken = Some(reason),
        }
        ticks
    }

    /// A device may grant less than was asked for, as it is built: the emulator is asked for what
    /// was granted, and must grant that.
    fn cfg(&mut self, config: Config) {
        let n_channels = self.n_channels();
        if let Some(Written::Body(asked)) =
            self.placer.answered(|body| body.kind == kind::CONFIG, None)
            && let Some(packet) = config.request(asked.seq, n_channels)
            && let Some(body) = Body::of_wire(packet.as_bytes())
        {
            **asked = body;
            self.told_config = Some(config);
        }
    }

    /// What the device says is broken is taken as told.
    fn fault(&mut self, bits: u16) {
        if let Some(twin) = &mut self.twin
            && twin.state() != DeviceState::Fault
        {
            twin.break_down(bits);
        }
    }

    /// A clock of the device with its wraps undone by the tick; `None` when they do not fit.
    fn unwrapped(tick: u32, dev_us: u32) -> Option<u64> {
        let begins_us = u64::from(tick) * TICK;
        let phase_us = dev_us.wrapping_sub(crate::fields::wrapped_u32(begins_us));
        (u64::from(phase_us) < TICK).then(|| begins_us + u64::from(phase_us))
    }

    fn status(&mut self, status: &Status, host_s: f64) -> Vec<ReplayedTick> {
        self.report.counts.statuses += 1;
        let step = self
            .last
            .map(|last| status.tick.wrapping_sub(last.device.tick).cast_signed());
        if step.is_some_and(|step| step <= 0) {
            self.report.counts.repeated += 1;
            return Vec::new();
        }
        if self.twin.is_none() {
            return Vec::new();
        }
        let device_us = Self::unwrapped(status.tick, status.dev_us);
        if device_us.is_none() {
            let (told, own) = (status.dev_us, u64::from(status.tick) * TICK);
            let found = Disagreement::new("dev_us", &told, &own);
            self.report.disagree(status.tick, found);
        }
        if step.is_some_and(|step| step > MAX_JUMP) {
            let last = self.last.map_or(0, |last| last.device.tick);
            let found = Disagreement::new("tick", &status.tick, &last.wrapping_add(1));
            self.report.disagree(status.tick, found);
            self.report.broken = Some(String::from("the device's clock jumps"));
            return self
                .twin
                .take()
                .map_or(Vec::new(), |mut twin| twin.finish());
        }
        let device_us = device_us.unwrap_or_else(|| u64::from(status.tick) * TICK);
        self.play(status, device_us, host_s);
        self.compare(status);
        let ticks = self.twin.as_mut().map(Twin::take_ticks).unwrap_or_default();
        self.count_largest(&ticks);
        ticks
    }

    /// Everything that the device had before this STATUS.
    fn play(&mut self, status: &Status, device_us: u64, host_s: f64) {
        let placement = self.placer.status(status, device_us, host_s);
        self.report.counts.lost += placement.n_lost;
        self.report.counts.doubtful += placement.n_doubtful;
        if placement.n_doubtful > 0 {
            self.doubtful_until = status.tick.saturating_add(DOUBTFUL_TICKS);
        }
        for placed in &placement.packets {
            if placed.is_guess || is_at_edge(placed) {
                self.guessed_until_us = self.guessed_until_us.max(shows_until_us(placed));
            }
            if let Some(twin) = &mut self.twin {
                twin.receive(placed.device_us, &wire_of(&placed.written));
            }
        }
        if let Some(twin) = &mut self.twin {
            twin.advance(device_us);
        }
        if status.state == DeviceState::Fault.code() {
            self.fault(status.faults);
        }
    }

    fn compare(&mut self, status: &Status) {
        let Some(twin) = &mut self.twin else { return };
        twin.was_told(status);
        let (config, acks) = (twin.take_config(), twin.take_acks());
        let n_channels = self.caps.map_or(0, |caps| usize::from(caps.n_ch));
        let mut found = Vec::new();
        if let (Some(told), Some(own)) = (self.told_config.take(), config) {
            found.extend(compare_config(&told, &own, n_channels));
        }
        let told_acks = std::mem::take(&mut self.told_acks);
        let is_doubtful = status.tick < self.doubtful_until;
        if !is_doubtful {
            found.extend(told_acks.iter().filter_map(|told| other_ack(*told, &acks)));
        }
        let Some(own) = twin.take_status() else {
            // An emulator without a session tells nothing: it is where the device should be.
            let own = twin.state();
            if own.code() != status.state && !is_doubtful {
                let told = state_name(status.state);
                found.push(Disagreement::new("state", &told, &own.name()));
            }
            return self.note(status.tick, found);
        };
        let now_us = u64::from(status.tick) * TICK;
        let scope = Scope {
            has_frames: !self.report.is_hashed,
            is_doubtful,
            is_guessed: now_us < self.guessed_until_us,
        };
        let pair = Pair {
            device: *status,
            emulator: Status {
                // A fault that was told now is from now on.
                state: match twin.state() {
                    DeviceState::Fault => DeviceState::Fault.code(),
                    _ => own.state,
                },
                ..own
            },
        };
        let reach_us = if scope.is_guessed { GUESS_US } else { EDGE_US };
        let around = || twin.moments(reach_us, reach_us);
        found.extend(pair.disagreements(self.last.as_ref(), scope, around));
        self.report.counts.judged += u64::from(!is_doubtful);
        if let Some(last) = self.last.replace(pair) {
            let bad = status.bad.wrapping_sub(last.device.bad);
            let dup = status.dup.wrapping_sub(last.device.dup);
            self.report.counts.on_the_way[0] += u64::from(bad);
            self.report.counts.on_the_way[1] += u64::from(dup);
        }
        self.note(status.tick, found);
    }

    fn note(&mut self, tick: u32, found: Vec<Disagreement>) {
        for one in found {
            self.report.disagree(tick, one);
        }
    }

    fn count_largest(&mut self, ticks: &[ReplayedTick]) {
        for tick in ticks {
            for (channel, peak_um) in tick.peak_um.iter().enumerate() {
                let largest = self.report.counts.largest.map_or(0.0, |largest| largest.0);
                if *peak_um > largest {
                    self.report.counts.largest = Some((*peak_um, channel, tick.tick));
                }
            }
        }
    }
}

/// Whether nobody can tell if a FRAME came before its own tick or was late: its age is known within
/// a ms.
fn is_at_edge(placed: &Placed) -> bool {
    let tick = (placed.device_us + TICK / 2) / TICK;
    let is_near = (tick * TICK).abs_diff(placed.device_us) < AGE_US;
    is_near && placed.written.apply_tick() == Some(crate::fields::wrapped_u32(tick))
}

/// Until when the device shows that a request came at another time than guessed, µs.
fn shows_until_us(placed: &Placed) -> u64 {
    let shows_us = match &placed.written {
        Written::Body(body) if body.kind == kind::IDENT => {
            let ident = Ident::decode(body.payload());
            RAMP_US + 1000 * ident.map_or(0, |ident| u64::from(ident.ms))
        }
        Written::Body(body) if [kind::STOP, kind::CLEAR, kind::HELLO].contains(&body.kind) => {
            RAMP_US
        }
        Written::Body(body) if body.kind == kind::FRAME => RAMP_US,
        _ => 0,
    };
    placed.device_us + shows_us
}

/// The answer of the emulator to the same packet, if it is another.
fn other_ack(told: Ack, own: &[Ack]) -> Option<Disagreement> {
    let is_same = |own: &&Ack| (own.kind, own.seq) == (told.kind, told.seq);
    let own = own.iter().find(is_same)?;
    (own.code != told.code)
        .then(|| Disagreement::new("ACK", &told.code.describe(), &own.code.describe()))
}

/// The bytes as they were written; a FRAME of which the log has a hash is silent, and of the same
/// length.
fn wire_of(written: &Written) -> Vec<u8> {
    let packet = match written {
        Written::Body(body) => Packet::encode(body.kind, body.seq, body.payload()),
        Written::Bytes(bytes) => return bytes.clone(),
        Written::Hashed(hashed) => {
            let codes = vec![[0; 2]; hashed.n_channels];
            frame::packet(hashed.seq, hashed.apply_tick, &codes)
        }
    };
    packet.map_or_else(Vec::new, |packet| packet.as_bytes().to_vec())
}
