//! A host that says anything, and knows what must come back.
//!
//! Whatever is said stands between two PINGs: their PONGs tell between which device times it was
//! heard, however late the link is. Every packet that comes is watched; nothing is judged by the
//! host's clock, which only tells when to give up, and when to try again.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};

use super::line::Line;
use super::predict::{Between, clamped};
use super::say::{Say, Want, kind_name, packet};
use super::watch::Watch;
use crate::framing::{Decoder, LARGEST_BODY};
use crate::message::{
    ARM_KEY, Ack, Caps, ChannelMask, Config, MAGIC, Message as _, NEXT_TICK, Pong, Status, TICK_US,
    kind,
};

/// How long an answer may take, µs of the host's time.
const REPLY_US: u64 = 1_000_000;
/// How often the wish to end is looked at, µs.
const GLANCE_US: u64 = 20_000;
/// More packets than this in one check are a flood.
const FLOOD: usize = 20_000;
/// A time of the link that differs by more from the usual tells of a host or link that was late.
const LATE_US: u64 = 4000;
/// Nothing waits longer, µs.
const LONGEST_WAIT_US: u64 = 2_000_000;
/// Ticks beyond this are years after boot, and about to wrap.
const LAST_TICK: u64 = 0xf000_0000;
/// PONGs by which the link is known.
const N_PONGS: usize = 15;
const TICK: u64 = TICK_US as u64;

/// Why a check ends before it is passed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The device is wrong.
    Wrong(String),
    /// The host or the link was too late to tell; to be tried again.
    Late,
    /// It cannot be tried on this device.
    Untested(String),
    /// The link is gone, or time is up, or somebody said stop: nothing more can be tried.
    Over(String),
}

/// What a check gives.
pub(super) type Verdict = Result<(), Trouble>;

/// Wrong, unless.
pub(super) fn ensure(is_right: bool, what: impl FnOnce() -> String) -> Verdict {
    if is_right {
        Ok(())
    } else {
        Err(Trouble::Wrong(what()))
    }
}

/// Counters that must have risen since the check began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Due {
    pub(super) late: u16,
    pub(super) dup: u16,
    pub(super) bad: u16,
    pub(super) clipped: u16,
}

/// Something that the device said.
#[derive(Clone, Debug)]
enum Heard {
    Status(Status),
    Pong(Pong),
    Reply(u8, Vec<u8>),
}

/// The client. What it sent last is a STOP when it goes, whatever happened.
pub(super) struct Client<'a> {
    line: &'a mut dyn Line,
    stop: &'a AtomicBool,
    end_us: u64,
    decoder: Decoder,
    /// What a device's decoder makes of the bytes that were written.
    mirror: Decoder,
    heard: Vec<Heard>,
    /// What was heard and read.
    read: usize,
    pub(super) watch: Watch,
    pub(super) caps: Caps,
    caps_payload: Vec<u8>,
    pub(super) session: u32,
    pub(super) seq: u16,
    token: u32,
    pub(super) due: Due,
    base: Option<Status>,
    /// Device time minus host time at writing, of the last PONGs, µs.
    offsets_us: VecDeque<i64>,
    is_late: bool,
    is_open: bool,
}

impl<'a> Client<'a> {
    /// A client that gives up at `end_us` of the line's time.
    pub(super) fn new(
        line: &'a mut dyn Line,
        nonce: u32,
        end_us: u64,
        stop: &'a AtomicBool,
    ) -> Self {
        Self {
            line,
            stop,
            end_us,
            decoder: Decoder::new(LARGEST_BODY),
            mirror: Decoder::new(LARGEST_BODY),
            heard: Vec::new(),
            read: 0,
            watch: Watch::default(),
            caps: Caps::default(),
            caps_payload: Vec::new(),
            session: nonce | 1,
            seq: 1,
            token: nonce,
            due: Due::default(),
            base: None,
            offsets_us: VecDeque::new(),
            is_late: false,
            is_open: false,
        }
    }

    // ---- what can be said ----

    /// Any packet; valid and without an answer unless said otherwise.
    pub(super) fn say(&mut self, kind: u8, payload: &[u8]) -> Say {
        let seq = self.seq;
        self.seq = self.seq.wrapping_add(1);
        Say {
            kind,
            seq,
            bytes: packet(kind, 0, seq, payload),
            want: Want::Nothing,
        }
    }

    /// Bytes that are no packet.
    pub(super) fn noise(bytes: &[u8]) -> Say {
        Say {
            kind: 0,
            seq: 0,
            bytes: bytes.to_vec(),
            want: Want::NoPacket,
        }
    }

    /// The payload of a HELLO.
    pub(super) fn hello_payload(
        session: u32,
        versions: [u8; 2],
        flags: u16,
        lease: u16,
    ) -> Vec<u8> {
        let mut payload = MAGIC.to_vec();
        payload.extend(session.to_le_bytes());
        payload.extend(versions);
        payload.extend(flags.to_le_bytes());
        payload.extend(lease.to_le_bytes());
        payload.extend([0; 2]);
        payload
    }

    /// A HELLO that opens a new session which wants STATUS.
    pub(super) fn hello(&mut self) -> Say {
        self.hello_with([1, 1], 1, 0, 1)
    }

    /// A HELLO of a new session: versions offered, flags, lease in ms; CAPS of version `chosen`.
    pub(super) fn hello_with(
        &mut self,
        versions: [u8; 2],
        flags: u16,
        lease_ms: u16,
        chosen: u8,
    ) -> Say {
        self.session = self.session.wrapping_add(2);
        let payload = Self::hello_payload(self.session, versions, flags, lease_ms);
        let want = Want::Caps(chosen, self.session);
        self.say(kind::HELLO, &payload).wants(want)
    }

    /// The settings of most checks: hold 60 ms, ramp 40 ms, everything else as CAPS allow.
    pub(super) fn usual(&self) -> Config {
        Config {
            mode: 0,
            flags: 0,
            hold_ms: 60,
            ramp_ms: 40,
            slew: 0,
            hv_dv: self.caps.hv_max_dv,
            comp_limit: self.caps.comp_limit,
            mask: ChannelMask::first(self.n_ch()),
        }
    }

    pub(super) fn config_payload(&self, wish: &Config) -> Vec<u8> {
        let mut payload = vec![wish.mode, wish.flags];
        let [low, high] = wish.comp_limit;
        for field in [
            wish.hold_ms,
            wish.ramp_ms,
            wish.slew,
            wish.hv_dv,
            low,
            high,
            0,
        ] {
            payload.extend(field.to_le_bytes());
        }
        for word in 0..self.n_ch().div_ceil(32).max(1) {
            let bits = (0..32).filter(|bit| wish.mask.contains(32 * word + bit));
            let word: u32 = bits.map(|bit| 1 << bit).sum();
            payload.extend(word.to_le_bytes());
        }
        payload
    }

    /// A CONFIG, answered by the CFG that follows from CAPS.
    pub(super) fn config(&mut self, wish: &Config) -> Say {
        let payload = self.config_payload(wish);
        let held = clamped(&self.caps, wish);
        self.say(kind::CONFIG, &payload).wants(Want::Cfg(held))
    }

    /// The payload of an ARM of this session.
    pub(super) fn arm_payload(session: u32) -> Vec<u8> {
        let key = session ^ ARM_KEY;
        [session.to_le_bytes(), key.to_le_bytes()].concat()
    }

    /// ARM, accepted.
    pub(super) fn arm(&mut self) -> Say {
        let payload = Self::arm_payload(self.session);
        self.say(kind::ARM, &payload).wants(Want::Ack(0))
    }

    /// FRAME, accepted.
    pub(super) fn frame(&mut self, tick: u32, codes: &[[u16; 2]]) -> Say {
        let mut payload = tick.to_le_bytes().to_vec();
        for code in codes.iter().flatten() {
            payload.extend(code.to_le_bytes());
        }
        self.say(kind::FRAME, &payload)
    }

    /// FRAME for the next tick, accepted.
    pub(super) fn frame_next(&mut self, codes: &[[u16; 2]]) -> Say {
        self.frame(NEXT_TICK, codes)
    }

    /// STOP.
    pub(super) fn stop(&mut self, how: u8) -> Say {
        self.say(kind::STOP, &[0, how]).wants(Want::Ack(0))
    }

    /// PING.
    pub(super) fn ping(&mut self) -> Say {
        self.token = self
            .token
            .wrapping_mul(0x0019_660d)
            .wrapping_add(0x3c6e_f35f);
        let token = self.token;
        self.say(kind::PING, &token.to_le_bytes())
            .wants(Want::Pong(token))
    }

    /// HELLO, CONFIG and ARM.
    pub(super) fn arming(&mut self, wish: &Config) -> Vec<Say> {
        vec![self.hello(), self.config(wish), self.arm()]
    }

    pub(super) fn n_ch(&self) -> usize {
        usize::from(self.caps.n_ch)
    }

    /// Faint codes, below 1 % of full scale, another pattern for every `kind`.
    pub(super) fn faint(&self, kind: u16) -> Vec<[u16; 2]> {
        let most = [0, 1].map(|band| self.caps.comp_limit[band].min(self.caps.slew_max));
        let code = |channel: u16| {
            let low = 60 + (17 * channel + 31 * kind) % 200;
            let high = 40 + (29 * channel + 7 * kind) % 150;
            [low.min(most[0]), high.min(most[1])]
        };
        (0..self.caps.n_ch).map(code).collect()
    }

    // ---- saying and hearing ----

    /// Says these between two PINGs and compares the answers. Gives when they were heard.
    pub(super) fn tell(&mut self, says: &[Say]) -> Result<Between, Trouble> {
        self.tell_after(&[], says)
    }

    /// The same where these were written before, and their answers are still to come.
    pub(super) fn tell_after(&mut self, written: &[Say], says: &[Say]) -> Result<Between, Trouble> {
        let first = self.read;
        let (before, after) = (self.ping(), self.ping());
        let sent_us = self.line.now_us();
        for say in std::iter::once(&before).chain(says).chain([&after]) {
            self.write(say)?;
        }
        let Want::Pong(last) = after.want else {
            return Err(Trouble::Late);
        };
        self.hear_until(
            "no PONG comes to a PING",
            |heard| matches!(heard, Heard::Pong(pong) if pong.token == last),
        )?;
        // Whether it was late is known whatever else is wrong.
        let between = [&before, &after].map(|ping| self.pong_since(first, ping));
        if let [Some(from_us), Some(to_us)] = between {
            self.learn(Between { from_us, to_us }, sent_us);
        }
        let asked = written.iter().chain([&before]).chain(says).chain([&after]);
        self.compare(first, &asked.collect::<Vec<_>>())?;
        self.watch.settle();
        match between {
            [Some(from_us), Some(to_us)] if from_us.max(to_us) / TICK > LAST_TICK => {
                let what = "its clock is about to wrap: start the device anew";
                Err(Trouble::Wrong(what.to_owned()))
            }
            [Some(from_us), Some(to_us)] => Ok(Between { from_us, to_us }),
            _ => Err(Trouble::Late),
        }
    }

    /// When the PONG of a PING was said, if it came since, µs of the device.
    fn pong_since(&self, first: usize, ping: &Say) -> Option<u64> {
        let news = self.heard.get(first..self.read)?;
        news.iter().find_map(|heard| match (heard, ping.want) {
            (Heard::Pong(pong), Want::Pong(token)) if pong.token == token => Some(time_us(pong)),
            _ => None,
        })
    }

    /// Says a PING that is half said already, and waits for its PONG.
    pub(super) fn tell_raw(&mut self, end: &Say) -> Verdict {
        let first = self.read;
        self.write(end)?;
        let Want::Pong(last) = end.want else {
            return Ok(());
        };
        self.hear_until(
            "no PONG comes to a PING in pieces",
            |heard| matches!(heard, Heard::Pong(pong) if pong.token == last),
        )?;
        self.compare(first, &[end])
    }

    /// Compares what came since `first` with what must come.
    fn compare(&mut self, first: usize, asked: &[&Say]) -> Verdict {
        let news: Vec<Heard> = self.heard.get(first..self.read).unwrap_or(&[]).to_vec();
        let mut answers = news
            .iter()
            .filter(|heard| !matches!(heard, Heard::Status(_)));
        for say in asked {
            let name = kind_name(say.kind);
            if matches!(say.want, Want::Nothing | Want::Bad | Want::NoPacket) {
                self.due.bad = self
                    .due
                    .bad
                    .wrapping_add(u16::from(matches!(say.want, Want::Bad)));
                continue;
            }
            let answer = answers.next();
            if let (Want::Pong(token), Some(Heard::Pong(pong))) = (say.want, answer)
                && pong.token == token
            {
                continue;
            }
            let is_right = match answer {
                Some(Heard::Reply(kind, payload)) => self.is_answer(say, *kind, payload),
                _ => false,
            };
            if let (true, Want::Cfg(held)) = (is_right, say.want) {
                self.watch.config = held;
            }
            ensure(is_right, || {
                let came = answer.map_or_else(|| String::from("nothing"), Heard::describe);
                format!(
                    "{name} was answered by {came}, not by {}",
                    self.describe(say)
                )
            })?;
        }
        let surplus = answers.next().map(Heard::describe);
        ensure(surplus.is_none(), || {
            format!("{} came unasked", surplus.unwrap_or_default())
        })
    }

    fn is_answer(&self, say: &Say, kind: u8, payload: &[u8]) -> bool {
        match say.want {
            Want::Ack(code) => {
                let [low, high] = say.seq.to_le_bytes();
                kind == kind::ACK && payload.get(..4) == Some(&[say.kind, code, low, high])
            }
            Want::Caps(version, session) => {
                let mut expected = self.caps_payload.clone();
                if let Some(head) = expected.get_mut(4..9) {
                    head[..4].copy_from_slice(&session.to_le_bytes());
                    head[4] = version;
                }
                kind == kind::CAPS && payload == expected
            }
            Want::Cfg(held) => {
                let is_reserved_zero = payload.get(14..16) == Some(&[0, 0]);
                let cfg = Config::decode(payload, self.n_ch());
                kind == kind::CFG && is_reserved_zero && cfg == Some(held)
            }
            Want::Nothing | Want::Bad | Want::NoPacket | Want::Pong(_) => false,
        }
    }

    fn describe(&self, say: &Say) -> String {
        match say.want {
            Want::Ack(code) => format!("ACK {code} of that packet"),
            Want::Caps(version, _) => format!("CAPS of version {version} as at first"),
            Want::Cfg(held) => format!("CFG with {}", describe_config(&held)),
            Want::Pong(_) => String::from("its PONG"),
            Want::Nothing | Want::Bad | Want::NoPacket => String::from("nothing"),
        }
    }

    /// Keeps how late the link is, and whether it was later than usual.
    fn learn(&mut self, between: Between, sent_us: u64) {
        let offset_us = between.from_us.cast_signed() - sent_us.cast_signed();
        if let Some(usual_us) = self.offset_us() {
            self.is_late |= usual_us.abs_diff(offset_us) > LATE_US;
        }
        self.is_late |= between.to_us.saturating_sub(between.from_us) > LATE_US;
        self.offsets_us.push_back(offset_us);
        if self.offsets_us.len() > N_PONGS {
            self.offsets_us.pop_front();
        }
    }

    fn offset_us(&self) -> Option<i64> {
        let mut sorted: Vec<i64> = self.offsets_us.iter().copied().collect();
        sorted.sort_unstable();
        sorted.get(sorted.len() / 2).copied()
    }

    /// Waits until what is said then is heard about `phase_us` into a tick; gives that tick.
    pub(super) fn aim(&mut self, phase_us: u64) -> Result<u32, Trouble> {
        let offset_us = self.offset_us().unwrap_or(0);
        let soon_us = self.line.now_us().saturating_add_signed(offset_us) + 300;
        let mut tick = soon_us / TICK;
        if soon_us % TICK > phase_us {
            tick += 1;
        }
        let at_us = (tick * TICK + phase_us).saturating_add_signed(-offset_us);
        self.pass_until(at_us)?;
        Ok(tick32(tick))
    }

    /// Waits until what is said then is heard about `phase_us` into this tick.
    pub(super) fn reach(&mut self, tick: u32, phase_us: u64) -> Verdict {
        let offset_us = self.offset_us().unwrap_or(0);
        let at_us = u64::from(tick) * TICK + phase_us;
        self.pass_until(at_us.saturating_add_signed(-offset_us))
    }

    /// Says these about `phase_us` into this tick, and nowhere else.
    pub(super) fn tell_at(
        &mut self,
        tick: u32,
        phase_us: u64,
        says: &[Say],
    ) -> Result<Between, Trouble> {
        self.reach(tick, phase_us)?;
        let between = self.tell(says)?;
        if between.is_in(tick) {
            Ok(between)
        } else {
            Err(Trouble::Late)
        }
    }

    /// Says these so that the tick is told: `says` is made for the tick in which they are heard.
    pub(super) fn tell_in_tick(
        &mut self,
        says: impl FnOnce(&mut Self, u32) -> Vec<Say>,
    ) -> Result<(u32, Between), Trouble> {
        let tick = self.aim(6000)?;
        let says = says(self, tick);
        let between = self.tell(&says)?;
        if between.is_in(tick) {
            Ok((tick, between))
        } else {
            Err(Trouble::Late)
        }
    }

    /// The next STATUS that comes.
    pub(super) fn status(&mut self) -> Result<Status, Trouble> {
        self.hear_until("no STATUS comes", |heard| matches!(heard, Heard::Status(_)))?;
        match self.heard.get(self.read.saturating_sub(1)) {
            Some(Heard::Status(status)) => Ok(*status),
            _ => Err(Trouble::Late),
        }
    }

    /// The next so many STATUS.
    pub(super) fn statuses(&mut self, n: usize) -> Result<Vec<Status>, Trouble> {
        (0..n).map(|_| self.status()).collect()
    }

    /// STATUS that came since the mark, with those of the tick.
    pub(super) fn statuses_since(&self, mark: usize) -> Vec<Status> {
        let news = self.heard.get(mark..self.read).unwrap_or(&[]).iter();
        news.filter_map(|heard| match heard {
            Heard::Status(status) => Some(*status),
            _ => None,
        })
        .collect()
    }

    /// A place in what was heard.
    pub(super) fn mark(&self) -> usize {
        self.read
    }

    /// Lets `us` of the host's time pass.
    pub(super) fn pass(&mut self, us: u64) -> Verdict {
        self.pass_until(self.line.now_us() + us)
    }

    fn pass_until(&mut self, until_us: u64) -> Verdict {
        if until_us > self.line.now_us() + LONGEST_WAIT_US {
            // Its clock jumps: nothing can be told by it.
            return Err(Trouble::Late);
        }
        while self.line.now_us() < until_us {
            self.pump(until_us)?;
        }
        self.is_late |= self.line.now_us() > until_us + LATE_US;
        Ok(())
    }

    /// Hears until something is `wanted`; what comes behind it is read next.
    fn hear_until(&mut self, missing: &str, wanted: impl Fn(&Heard) -> bool) -> Verdict {
        let until_us = self.line.now_us() + REPLY_US;
        let mut at = self.read;
        loop {
            let news = self.heard.get(at..).unwrap_or(&[]);
            if let Some(found) = news.iter().position(&wanted) {
                self.read = at + found + 1;
                return Ok(());
            }
            at = self.heard.len();
            if self.line.now_us() >= until_us {
                return Err(Trouble::Wrong(missing.to_owned()));
            }
            self.pump(until_us)?;
        }
    }

    /// Writes what has no answer, and counts it.
    pub(super) fn write_bad(&mut self, say: &Say) -> Verdict {
        self.due.bad = self
            .due
            .bad
            .wrapping_add(u16::from(matches!(say.want, Want::Bad)));
        self.write(say)
    }

    pub(super) fn write(&mut self, say: &Say) -> Verdict {
        if say.kind == kind::HELLO {
            self.watch.pause();
        }
        for &byte in &say.bytes {
            self.mirror.push(byte);
        }
        self.is_open = true;
        self.line.write(&say.bytes).map_err(|error| gone(&error))
    }

    /// Hears what comes until then, at most for a glance; fails when it is time to end.
    fn pump(&mut self, until_us: u64) -> Verdict {
        let now_us = self.line.now_us();
        if self.stop.load(Ordering::Acquire) {
            return Err(Trouble::Over(String::from("it was stopped")));
        }
        if now_us >= self.end_us {
            return Err(Trouble::Over(String::from("time is up")));
        }
        let mut bytes = Vec::new();
        let until_us = until_us.min(now_us + GLANCE_US);
        self.line
            .read(until_us, &mut bytes)
            .map_err(|error| gone(&error))?;
        self.is_late |= self.line.now_us() > until_us + LATE_US;
        // The decoder moves out while a packet borrows from it.
        let mut decoder = std::mem::replace(&mut self.decoder, Decoder::new(0));
        for byte in bytes {
            if let Some(packet) = decoder.push(byte) {
                self.watch.packet(packet.kind, packet.seq);
                self.hear(packet.kind, packet.payload);
            }
            self.watch.byte(byte);
        }
        self.decoder = decoder;
        ensure(self.heard.len() < FLOOD, || {
            format!("more than {FLOOD} packets came")
        })
    }

    fn hear(&mut self, kind: u8, payload: &[u8]) {
        let heard = match kind {
            kind::STATUS => Status::decode(payload).map(Heard::Status),
            kind::PONG => Pong::decode(payload).map(Heard::Pong),
            _ => None,
        };
        match &heard {
            Some(Heard::Status(status)) => self.watch.status(status, &self.caps),
            Some(Heard::Pong(pong)) => self.watch.pong(pong),
            _ => {}
        }
        let reply = || Heard::Reply(kind, payload.to_vec());
        self.heard.push(heard.unwrap_or_else(reply));
    }

    // ---- sessions and counters ----

    /// HELLO until CAPS with our own session come; everything before is ignored.
    pub(super) fn open(&mut self, patience_us: u64) -> Result<(), Trouble> {
        let end_us = self.line.now_us() + patience_us;
        let hello = self.hello();
        self.write(&Self::noise(&[0]))?;
        while self.line.now_us() < end_us {
            self.write(&hello)?;
            let until_us = self.line.now_us() + 250_000;
            while self.line.now_us() < until_us {
                self.pump(until_us)?;
                if self.find_caps() {
                    // Late answers to repeated HELLOs are no concern of the checks.
                    self.pass(100_000)?;
                    self.forget();
                    self.watch = Watch::default();
                    self.watch.pause();
                    return Ok(());
                }
            }
        }
        let what = if self.heard.is_empty() {
            "nothing comes: check power, cable and port"
        } else {
            "bytes come, but no CAPS with the session of our HELLO"
        };
        Err(Trouble::Wrong(what.to_owned()))
    }

    /// Whether CAPS of this session came; they are kept.
    fn find_caps(&mut self) -> bool {
        let session = self.session.to_le_bytes();
        let found = self.heard.iter().find_map(|heard| match heard {
            Heard::Reply(kind::CAPS, payload) if payload.get(4..8) == Some(&session) => {
                Some(payload.clone())
            }
            _ => None,
        });
        let Some(payload) = found else { return false };
        self.caps = Caps::decode(&payload).unwrap_or_default();
        self.caps_payload = payload;
        true
    }

    /// The payload of CAPS as it came.
    pub(super) fn caps_payload(&self) -> &[u8] {
        &self.caps_payload
    }

    /// Lets the mirror judge oversize as the device does.
    pub(super) fn know_largest_body(&mut self) {
        self.mirror = Decoder::new(usize::from(self.caps.max_body));
    }

    fn forget(&mut self) {
        self.heard.clear();
        self.read = 0;
    }

    /// A fresh session, and the counters from which a check counts.
    pub(super) fn begin_check(&mut self) -> Verdict {
        self.forget();
        self.is_late = false;
        self.base = None;
        self.watch.may_ident = false;
        self.watch.take_wrong();
        let hello = self.hello();
        self.tell(&[hello])?;
        self.base = Some(self.status()?);
        self.due = Due {
            bad: self.mirror_bad().wrapping_neg(),
            ..Due::default()
        };
        Ok(())
    }

    /// Whether the counters rose by what was due; a session that ended is opened again to ask.
    pub(super) fn end_check(&mut self) -> Verdict {
        let hello = self.hello();
        self.tell(&[hello])?;
        let now = self.status()?;
        self.count(&now)?;
        self.watch
            .take_wrong()
            .map_or(Ok(()), |what| Err(Trouble::Wrong(what)))
    }

    /// Compares the counters of a STATUS with what was due so far.
    pub(super) fn count(&self, now: &Status) -> Verdict {
        let Some(base) = &self.base else {
            return Ok(());
        };
        let due = Due {
            bad: self.due.bad.wrapping_add(self.mirror_bad()),
            ..self.due
        };
        let rows = [
            ("late", base.late, now.late, due.late),
            ("dup", base.dup, now.dup, due.dup),
            ("bad", base.bad, now.bad, due.bad),
            ("clipped", base.clipped, now.clipped, due.clipped),
        ];
        for (name, before, after, due) in rows {
            let risen = after.wrapping_sub(before);
            ensure(risen == due, || {
                format!("{name} rose by {risen}, not by {due}")
            })?;
        }
        Ok(())
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "counters wrap at 65536 on the wire"
    )]
    fn mirror_bad(&self) -> u16 {
        self.mirror.bad() as u16
    }

    /// Whether host or link were later than usual since the check began.
    pub(super) fn is_late(&self) -> bool {
        self.is_late
    }

    /// The same, and forgets it.
    pub(super) fn take_late(&mut self) -> bool {
        std::mem::take(&mut self.is_late)
    }

    /// The present device time as the link is known, ms.
    pub(super) fn device_ms(&self) -> u64 {
        let us = self
            .line
            .now_us()
            .saturating_add_signed(self.offset_us().unwrap_or(0));
        us / 1000
    }

    /// STOP, acknowledged: nothing is left to be stopped.
    pub(super) fn end(&mut self) -> Verdict {
        let stop = self.stop(0);
        self.tell(&[stop])?;
        self.is_open = false;
        Ok(())
    }
}

impl Drop for Client<'_> {
    fn drop(&mut self) {
        if self.is_open {
            let stop = packet(kind::STOP, 0, self.seq, &[0, 1]);
            // The device's own silence is what is left when the link takes nothing.
            drop(self.line.write(&stop));
        }
    }
}

impl Heard {
    fn describe(&self) -> String {
        match self {
            Self::Status(status) => format!("STATUS of tick {}", status.tick),
            Self::Pong(pong) => format!("PONG {:08x}", pong.token),
            Self::Reply(kind::ACK, payload) => match Ack::decode(payload) {
                Some(ack) => format!(
                    "ACK {} of {} {}",
                    ack.code.code(),
                    kind_name(ack.kind),
                    ack.seq
                ),
                None => String::from("a short ACK"),
            },
            Self::Reply(kind::CFG, payload) => match Config::decode(payload, 32) {
                Some(held) => format!("CFG with {}", describe_config(&held)),
                None => String::from("a short CFG"),
            },
            Self::Reply(kind::CAPS, _) => String::from("other CAPS"),
            Self::Reply(kind, _) => format!("type {kind:02X}"),
        }
    }
}

fn describe_config(held: &Config) -> String {
    let [low, high] = held.comp_limit;
    format!(
        "mode {} flags {} hold {} ramp {} slew {} hv {} limits {low} {high} mask {:08x}",
        held.mode,
        held.flags,
        held.hold_ms,
        held.ramp_ms,
        held.slew,
        held.hv_dv,
        (0..32)
            .filter(|bit| held.mask.contains(*bit))
            .map(|bit| 1u32 << bit)
            .sum::<u32>()
    )
}

fn gone(error: &std::io::Error) -> Trouble {
    Trouble::Over(format!("the link is gone: {error}"))
}

/// Device time of a PONG, µs since boot, from its tick.
fn time_us(pong: &Pong) -> u64 {
    u64::from(pong.tick) * TICK + u64::from(pong.phase_us)
}

fn tick32(tick: u64) -> u32 {
    crate::fields::wrapped_u32(tick)
}
