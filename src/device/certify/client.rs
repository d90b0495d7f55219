//! A host that says anything, and knows what must come back.
//!
//! Whatever is said stands between two PINGs: their PONGs tell between which device times it was
//! heard, however late the link is. Every packet that comes is watched; nothing is judged by the
//! host's clock, which only tells when to give up, and when to try again.

use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicBool, Ordering};

use super::answers::{Heard, compare};
use super::line::Line;
use super::link_times::LinkTimes;
use super::predict::Between;
use super::say::{Say, Want};
use super::speech::Speech;
use super::tally::Tally;
use super::verdict::{Trouble, Verdict, ensure};
use super::watch::Watch;
use crate::framing::{Decoder, LARGEST_BODY};
use crate::message::{Message as _, Pong, Status, TICK_US, kind};

/// How long an answer may take, µs of the host's time.
const REPLY_US: u64 = 1_000_000;
/// How often the wish to end is looked at, µs.
const GLANCE_US: u64 = 20_000;
/// More packets than this in one check are a flood.
const FLOOD: usize = 20_000;
/// Ticks beyond this are years after boot, and about to wrap.
const LAST_TICK: u64 = 0xf000_0000;
const TICK: u64 = TICK_US as u64;

/// The client. What it sent last is a STOP when it goes, whatever happened.
pub(super) struct Client<'a> {
    pub(super) line: &'a mut dyn Line,
    stop: &'a AtomicBool,
    end_us: u64,
    decoder: Decoder,
    pub(super) heard: Vec<Heard>,
    /// How much of it was read.
    read: usize,
    pub(super) caps_payload: Vec<u8>,
    pub(super) speech: Speech,
    pub(super) tally: Tally,
    pub(super) watch: Watch,
    pub(super) times: LinkTimes,
    /// Something was said since the last acknowledged STOP.
    pub(super) is_open: bool,
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
            heard: Vec::new(),
            read: 0,
            caps_payload: Vec::new(),
            speech: Speech::new(nonce),
            tally: Tally::new(),
            watch: Watch::default(),
            times: LinkTimes::default(),
            is_open: false,
        }
    }

    /// Says these between two PINGs and compares the answers. Gives when they were heard.
    pub(super) fn tell(&mut self, says: &[Say]) -> Result<Between, Trouble> {
        self.tell_after(&[], says)
    }

    /// The same with what is made for it.
    pub(super) fn tell_with<S: AsRef<[Say]>>(
        &mut self,
        says: impl FnOnce(&mut Self) -> S,
    ) -> Result<Between, Trouble> {
        let says = says(self);
        self.tell(says.as_ref())
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
            self.times.learn(Between { from_us, to_us }, sent_us);
        }
        let asked = written.iter().chain([&before]).chain(says).chain([&after]);
        self.judge(first, &asked.collect::<Vec<_>>())?;
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
        self.judge(first, &[end])
    }

    /// Compares what came since `first` with what must come.
    fn judge(&mut self, first: usize, asked: &[&Say]) -> Verdict {
        let news = self.heard.get(first..self.read).unwrap_or(&[]);
        let n_ch = self.speech.n_ch();
        if let Some(held) = compare(news, asked, &self.caps_payload, n_ch)? {
            self.watch.config = held;
        }
        Ok(())
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

    pub(super) fn write(&mut self, say: &Say) -> Verdict {
        if say.kind == kind::HELLO {
            self.watch.pause();
        }
        self.tally.written(say);
        self.is_open = true;
        self.line.write(&say.bytes).map_err(|error| gone(&error))
    }

    /// Hears what comes until then, at most for a glance; fails when it is time to end.
    pub(super) fn pump(&mut self, until_us: u64) -> Verdict {
        let now_us = self.line.now_us();
        if self.stop.load(Ordering::Acquire) {
            return Err(Trouble::Over(String::from("it was stopped")));
        }
        if now_us >= self.end_us {
            return Err(Trouble::Over(String::from("time is up")));
        }
        self.listen(until_us.min(now_us + GLANCE_US))?;
        ensure!(self.heard.len() < FLOOD, "more than {FLOOD} packets came")
    }

    /// Hears what comes until then, whoever wants to end.
    pub(super) fn listen(&mut self, until_us: u64) -> Verdict {
        let mut bytes = Vec::new();
        self.line
            .read(until_us, &mut bytes)
            .map_err(|error| gone(&error))?;
        self.times.woke(self.line.now_us(), until_us);
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
        Ok(())
    }

    fn hear(&mut self, kind: u8, payload: &[u8]) {
        let heard = match kind {
            kind::STATUS => Status::decode(payload).map(Heard::Status),
            kind::PONG => Pong::decode(payload).map(Heard::Pong),
            _ => None,
        };
        let now_us = self.line.now_us();
        match &heard {
            Some(Heard::Status(status)) => {
                self.times.came(u64::from(status.tick) * TICK, now_us);
                self.watch.status(status, &self.speech.caps);
            }
            Some(Heard::Pong(pong)) => {
                self.times.came(time_us(pong), now_us);
                self.watch.pong(pong);
            }
            _ => {}
        }
        let reply = || Heard::Reply(kind, payload.to_vec());
        self.heard.push(heard.unwrap_or_else(reply));
    }

    pub(super) fn forget(&mut self) {
        self.heard.clear();
        self.read = 0;
    }

    /// A fresh session, and the counters from which a check counts.
    pub(super) fn begin_check(&mut self) -> Verdict {
        self.forget();
        self.times.is_late = false;
        self.tally.begin(None);
        self.watch.may_ident = false;
        self.watch.take_wrong();
        let hello = self.hello();
        self.tell(&[hello])?;
        let base = self.status()?;
        self.tally.begin(Some(base));
        Ok(())
    }

    /// Whether the counters rose by what was due; a session that ended is opened again to ask.
    pub(super) fn end_check(&mut self) -> Verdict {
        let hello = self.hello();
        self.tell(&[hello])?;
        let now = self.status()?;
        self.tally.compare(&now)?;
        self.watch
            .take_wrong()
            .map_or(Ok(()), |what| Err(Trouble::Wrong(what)))
    }

    /// The present device time as the link is known, ms.
    pub(super) fn device_ms(&self) -> u64 {
        let us = self
            .line
            .now_us()
            .saturating_add_signed(self.times.offset_us());
        us / 1000
    }
}

/// Everything that can be said can be said by the client.
impl Deref for Client<'_> {
    type Target = Speech;

    fn deref(&self) -> &Speech {
        &self.speech
    }
}

impl DerefMut for Client<'_> {
    fn deref_mut(&mut self) -> &mut Speech {
        &mut self.speech
    }
}

impl Drop for Client<'_> {
    fn drop(&mut self) {
        if self.is_open {
            self.line.stop();
        }
    }
}

fn gone(error: &std::io::Error) -> Trouble {
    Trouble::Over(format!("the link is gone: {error}"))
}

/// Device time of a PONG, µs since boot, from its tick.
fn time_us(pong: &Pong) -> u64 {
    u64::from(pong.tick) * TICK + u64::from(pong.phase_us)
}
