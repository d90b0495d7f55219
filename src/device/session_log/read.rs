//! Reads a log line by line, in the memory of one line: what its writer knew, packets to the byte.
//!
//! A last line that was cut is dropped, in the middle of a file too, where its writer was killed
//! and another went on. Whatever else is no line of a log is refused with its number.

use std::collections::{BTreeMap, VecDeque};
use std::io::{self, BufRead, Read as _};

use super::bodies::bytes_of;
use super::events::{COLUMNS, CUT, event};
use super::line::{LONGEST_S, PacketTimes};
use super::packets::{HashedFrame, MAX_AGAIN, PacketCode};
use super::tap::Body;

/// A longer line is none of a log, bytes.
const MAX_LINE: u64 = 16 * 1024;
/// Links whose lines may take turns.
const MAX_LINKS: usize = 16;

/// What a line tells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Seen {
    /// This packet was written.
    Sent(Body),
    /// This FRAME was written, but is not in the log.
    Hashed(HashedFrame),
    /// This packet was not written whole.
    Unsent(Body),
    /// This packet arrived.
    Received(Body),
    /// These bytes were written, which are no packet.
    SentBytes(Vec<u8>),
    /// A text arrived that was no packet.
    ReceivedBytes,
    /// Something else: the event's name and its detail.
    Note(String, String),
}

/// A line, or one of the packets that it stands for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    /// The number of its link.
    pub(crate) link: u32,
    /// The host's clock, s since the log was opened.
    pub(crate) host_s: f64,
    /// The host's date and time; empty for packets.
    pub(crate) utc: String,
    /// Its number in the file, from 1.
    pub(crate) number: u64,
    pub(crate) seen: Seen,
}

/// A line that is none, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Unreadable {
    /// From 1; 0 for the file as a whole.
    pub(crate) number: u64,
    pub(crate) reason: String,
}

/// What is known of one link.
#[derive(Debug, Default)]
struct LinkState {
    code: PacketCode,
    times: PacketTimes,
    /// When its last FRAME was written.
    last_frame_s: f64,
}

/// Reads a log.
#[derive(Debug)]
pub(crate) struct LogReader<R> {
    input: R,
    number: u64,
    link: u32,
    links: BTreeMap<u32, LinkState>,
    /// Packets of the line that was read last.
    waiting: VecDeque<Line>,
}

impl<R: BufRead> LogReader<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            input,
            number: 0,
            link: 0,
            links: BTreeMap::new(),
            waiting: VecDeque::new(),
        }
    }

    /// The next line; `None` at the end.
    pub(crate) fn next(&mut self) -> Result<Option<Line>, Unreadable> {
        loop {
            if let Some(line) = self.waiting.pop_front() {
                return Ok(Some(line));
            }
            let Some(text) = self.text()? else {
                return Ok(None);
            };
            self.read(&text)?;
        }
    }

    /// The text of the next line without its end; `None` at the end of what is whole.
    fn text(&mut self) -> Result<Option<String>, Unreadable> {
        let mut bytes = Vec::new();
        let mut bounded = self.input.by_ref().take(MAX_LINE);
        let read = bounded.read_until(b'\n', &mut bytes);
        self.number += 1;
        read.map_err(|error| self.unreadable(&format!("cannot be read: {error}; check the path")))?;
        let is_first = self.number == 1;
        if bytes.is_empty() && is_first {
            self.number = 0;
            return Err(self.unreadable("is empty; name a file that --session-log wrote"));
        }
        let is_whole = bytes.pop_if(|last| *last == b'\n').is_some();
        let header = COLUMNS.join(",");
        if is_first
            && (!header.as_bytes().starts_with(&bytes) || is_whole && bytes.len() < header.len())
        {
            let what = "is no session log, its first line is another; \
                        name a file that --session-log wrote";
            return Err(self.unreadable(what));
        }
        if !is_whole {
            let is_long = bytes.len() as u64 == MAX_LINE;
            return if is_long {
                Err(self.unreadable("the line has no end; restore the file"))
            } else {
                Ok(None)
            };
        }
        let text = String::from_utf8(bytes);
        text.map(Some)
            .map_err(|_error| self.unreadable("this is not UTF-8 text; restore the file"))
    }

    /// Makes lines of the text of one.
    fn read(&mut self, text: &str) -> Result<(), Unreadable> {
        // Logs that were put one behind the other.
        if text == COLUMNS.join(",") || text.ends_with(CUT) {
            return Ok(());
        }
        let wrong = "this is no line of a session log; restore or delete it";
        let line = parts(text).ok_or_else(|| self.unreadable(wrong))?;
        self.add(&line).ok_or_else(|| {
            let what = format!(
                "a {:?} that cannot be; restore or delete the line",
                line.event
            );
            self.unreadable(&what)
        })
    }

    fn add(&mut self, parts: &Parts<'_>) -> Option<()> {
        let Parts { event, detail, .. } = parts;
        if [event::LINK, event::OF_LINK].contains(event) {
            let number = detail.strip_prefix("n=")?.split(' ').next()?;
            self.link = number.parse().ok()?;
            if *event == event::LINK {
                self.links.insert(self.link, LinkState::default());
            }
            if self.links.len() > MAX_LINKS {
                self.links.pop_first();
            }
        }
        let state = self.links.entry(self.link).or_default();
        let host_s = parts.time.read(&mut state.times)?;
        let seen = match *event {
            event::FRAME | event::LONG_FRAME => {
                state.last_frame_s = host_s;
                Seen::Sent(state.code.read_frame(event, detail)?)
            }
            event::FRAME_HASH => {
                state.last_frame_s = host_s;
                Seen::Hashed(state.code.read_hash(detail)?)
            }
            event::FRAME_AGAIN => return self.add_again(parts, host_s),
            event::STATUS | event::LONG_STATUS => {
                Seen::Received(state.code.read_status(parts.tick, detail)?)
            }
            event::IN => Seen::Received(state.code.read_plain(event, detail)?),
            event::OUT => Seen::Sent(state.code.read_plain(event, detail)?),
            event::OUT_BYTES => Seen::SentBytes(bytes_of(detail)?),
            event::IN_BYTES => bytes_of(detail).map(|_| Seen::ReceivedBytes)?,
            event::UNSENT => Seen::Unsent(state.code.read_plain(event, detail)?),
            _ => Seen::Note((*event).to_owned(), detail.clone()),
        };
        self.push(parts, host_s, seen);
        Some(())
    }

    /// Frames that are told by their number: they are spread over the time that they took.
    fn add_again(&mut self, parts: &Parts<'_>, to_s: f64) -> Option<()> {
        let n: u16 = parts.detail.parse().ok()?;
        if n > MAX_AGAIN {
            return None;
        }
        let state = self.links.get_mut(&self.link)?;
        let from_s = std::mem::replace(&mut state.last_frame_s, to_s);
        for at in 1..=n {
            let share = f64::from(at) / f64::from(n);
            let host_s = from_s + share * (to_s - from_s);
            let seen = match self.links.get_mut(&self.link)?.code.next_frame() {
                Ok(body) => Seen::Sent(body?),
                Err(hashed) => Seen::Hashed(hashed),
            };
            self.push(parts, host_s, seen);
        }
        Some(())
    }

    fn push(&mut self, parts: &Parts<'_>, host_s: f64, seen: Seen) {
        self.waiting.push_back(Line {
            link: self.link,
            host_s,
            utc: parts.utc.to_owned(),
            number: self.number,
            seen,
        });
    }

    fn unreadable(&self, reason: &str) -> Unreadable {
        Unreadable {
            number: self.number,
            reason: reason.to_owned(),
        }
    }
}

/// The columns of a line.
struct Parts<'a> {
    utc: &'a str,
    time: Time<'a>,
    tick: Option<u32>,
    event: &'a str,
    detail: String,
}

/// When it was, by the host's clock.
enum Time<'a> {
    /// Of an entry, s.
    OfEntry(f64),
    /// Of a packet, s.
    OfPacket(f64),
    /// Of a packet, since the one before.
    Step(&'a str),
}

impl<'a> Time<'a> {
    fn of(text: &'a str, is_packet: bool) -> Option<Self> {
        if text.starts_with(['+', '-']) {
            return is_packet.then_some(Self::Step(text));
        }
        let s = text.parse().ok().filter(|s| (0.0..LONGEST_S).contains(s))?;
        Some(if is_packet {
            Self::OfPacket(s)
        } else {
            Self::OfEntry(s)
        })
    }

    /// The time, s, after the packets of the same link before.
    fn read(&self, times: &mut PacketTimes) -> Option<f64> {
        match *self {
            Self::OfEntry(s) => Some(s),
            Self::OfPacket(s) => {
                times.take_whole(s);
                Some(s)
            }
            Self::Step(text) => times.read_step(text),
        }
    }
}

fn parts(text: &str) -> Option<Parts<'_>> {
    let mut columns = text.splitn(COLUMNS.len(), ',');
    let mut next = || columns.next();
    let (utc, time) = (next()?, next()?);
    let (tick, device_us, event, detail) = (next()?, next()?, next()?, next()?);
    let is_number = |text: &str| text.is_empty() || text.parse::<u64>().is_ok();
    let is_name =
        |name: &str| !name.is_empty() && name.bytes().all(|b| b.is_ascii_lowercase() || b == b'-');
    if !(is_number(tick) && is_number(device_us) && is_name(event)) {
        return None;
    }
    Some(Parts {
        utc,
        time: Time::of(time, utc.is_empty())?,
        tick: tick.parse().ok(),
        event,
        detail: detail_of(detail)?,
    })
}

/// A detail without its quotes.
fn detail_of(detail: &str) -> Option<String> {
    let Some(quoted) = detail.strip_prefix('"') else {
        return (!detail.contains(['"', ','])).then(|| detail.to_owned());
    };
    let inner = quoted.strip_suffix('"')?;
    let is_closed = inner.replace("\"\"", "").contains('"');
    (!is_closed).then(|| inner.replace("\"\"", "\""))
}

impl From<io::Error> for Unreadable {
    fn from(error: io::Error) -> Self {
        Self {
            number: 0,
            reason: format!("cannot be read: {error}; check the path"),
        }
    }
}
