//! A session log played again: the recorded host's packets go to the emulator and the contactor
//! model at the times at which the device had them, which gives what the finger got, tick by tick;
//! and the device's own numbers are compared with the emulator's.
//!
//! ```text
//! log ─ lines in order of time ─┬─ packets of the host ─ when the device had them ─ twin
//!                               └─ packets of the device ─ judge ───────────────────┘
//! ```
//!
//! What a device measures (volts, current, temperature, its faults) is taken as told: an emulator
//! cannot know it. Neither can it know what broke on the way.

mod judge;
mod placing;
mod report;
mod session;
mod twin;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use crate::BridgeError;
use crate::actuator_model::ContactorModel;
pub(crate) use crate::session_log::HASHED;
use crate::session_log::{LogReader, Seen, event};
pub use report::ReplayedLink;
use session::LinkReplay;
pub use twin::ReplayedTick;

/// Lines are put into the order of time within this: counts of equal frames come late, s.
const REACH_S: f64 = 1.5;
/// What arrived is taken so much later than it was read: a packet that it answers was written
/// before, but may have been noted after, s.
const AFTER_S: f64 = 0.01;
/// Lines that wait at most.
const MAX_WAITING: usize = 20_000;

impl ReplayedLink {
    /// Replays every link of a log, one after the other; `each` is told of every tick. The
    /// contactors' full scale is that of the device.
    ///
    /// # Errors
    /// The file cannot be read or is no session log: one line with its place. What `each` says.
    pub fn of_log<E: From<BridgeError>>(
        path: &Path,
        contactors: &ContactorModel,
        each: impl FnMut(&ReplayedTick) -> Result<(), E>,
    ) -> Result<Vec<Self>, E> {
        let unreadable = |(line, reason): (u64, String)| BridgeError::LogContent {
            path: path.to_path_buf(),
            line,
            reason,
        };
        let cannot = |reason: &str| {
            let reason = format!("cannot be read: {reason}; check the path");
            E::from(unreadable((0, reason)))
        };
        if path.is_dir() {
            return Err(cannot("it is a folder"));
        }
        let file = File::open(path).map_err(|error| cannot(&error.to_string()))?;
        let mut desk = Desk::new(contactors, each);
        desk.read(BufReader::new(file), |place| E::from(unreadable(place)))?;
        if desk.links.is_empty() {
            let reason = "holds no link; name a file that --session-log wrote";
            return Err(E::from(unreadable((0, reason.to_owned()))));
        }
        Ok(desk.links)
    }
}

/// A line that waits for its turn.
struct Turn {
    link: u32,
    host_s: f64,
    seen: Seen,
}

/// All links of a log.
struct Desk<'a, F> {
    contactors: &'a ContactorModel,
    each: F,
    running: BTreeMap<u32, LinkReplay>,
    /// By time and order; times are not negative, so their bits are in their order.
    waiting: BTreeMap<(u64, u64), Turn>,
    n_lines: u64,
    links: Vec<ReplayedLink>,
}

impl<'a, E, F: FnMut(&ReplayedTick) -> Result<(), E>> Desk<'a, F> {
    fn new(contactors: &'a ContactorModel, each: F) -> Self {
        Self {
            contactors,
            each,
            running: BTreeMap::new(),
            waiting: BTreeMap::new(),
            n_lines: 0,
            links: Vec::new(),
        }
    }

    fn read(
        &mut self,
        input: impl BufRead,
        unreadable: impl Fn((u64, String)) -> E,
    ) -> Result<(), E> {
        let mut reader = LogReader::new(input);
        loop {
            let line = reader.next();
            let Some(line) = line.map_err(|error| unreadable((error.number, error.reason)))? else {
                break;
            };
            if let Seen::Note(name, detail) = &line.seen
                && name == event::LINK
            {
                self.begin(line.link, detail, &line.utc)?;
                continue;
            }
            let is_answer = matches!(line.seen, Seen::Received(_));
            let key_s = line.host_s + if is_answer { AFTER_S } else { 0.0 };
            self.n_lines += 1;
            let turn = Turn {
                link: line.link,
                host_s: line.host_s,
                seen: line.seen,
            };
            self.waiting.insert((key_s.to_bits(), self.n_lines), turn);
            while self.waiting.len() > MAX_WAITING || self.is_due(line.host_s) {
                self.take_first()?;
            }
        }
        self.end_all()
    }

    /// Whether nothing can come before the first that waits.
    fn is_due(&self, host_s: f64) -> bool {
        let first = self.waiting.first_key_value();
        first.is_some_and(|((bits, _), _)| host_s - f64::from_bits(*bits) > REACH_S)
    }

    fn take_first(&mut self) -> Result<(), E> {
        let Some((_, turn)) = self.waiting.pop_first() else {
            return Ok(());
        };
        let Some(link) = self.running.get_mut(&turn.link) else {
            return Ok(());
        };
        for tick in link.take(turn.seen, turn.host_s) {
            (self.each)(&tick)?;
        }
        Ok(())
    }

    /// A link begins, or goes on in another file.
    fn begin(&mut self, number: u32, heading: &str, utc: &str) -> Result<(), E> {
        let goes_on = heading.ends_with(crate::session_log::CONTINUED);
        if goes_on && self.running.contains_key(&number) {
            return Ok(());
        }
        // The first of a program: the clock of the lines begins anew.
        if number == 1 || self.running.contains_key(&number) {
            self.end_all()?;
        }
        let link = LinkReplay::new(number, heading, utc, *self.contactors);
        self.running.insert(number, link);
        Ok(())
    }

    fn end_all(&mut self) -> Result<(), E> {
        while !self.waiting.is_empty() {
            self.take_first()?;
        }
        for (_, link) in std::mem::take(&mut self.running) {
            let (ticks, report) = link.finish();
            for tick in ticks {
                (self.each)(&tick)?;
            }
            self.links.push(report);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
