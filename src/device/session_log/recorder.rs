//! One link's part of a log: entries and packets in, lines out.
//!
//! Frames that are equal but for their numbers are counted; the count is written once the frames
//! end to be equal, and every half second, so that a log that ends anywhere ends late.

use std::time::{Duration, Instant};

use super::bodies::hex_of;
use super::events::event;
use super::line::{Epoch, PacketTimes, write_entry, write_packet};
use super::note::{Entry, Note};
use super::packets::{MAX_AGAIN, PacketCode, PacketWords};
use super::tap::{Body, Passed, Passing};
use crate::message::kind;

/// How long equal frames are counted before the number is written.
const LONGEST_RUN: Duration = Duration::from_millis(500);
/// The most headings that are written again at the head of another file.
const MAX_HEADINGS: usize = 16;

/// Ends the first heading of a link that began in an earlier file.
pub(crate) const CONTINUED: &str = " continued";

/// Frames equal to the one that was written last.
#[derive(Clone, Copy, Debug)]
struct Run {
    n: u16,
    began: Instant,
    last: Instant,
}

/// Turns what happens on a link into lines.
#[derive(Debug)]
pub(crate) struct Recorder {
    epoch: Epoch,
    keeps_frames: bool,
    code: PacketCode,
    times: PacketTimes,
    run: Option<Run>,
    /// What a reader must know before anything else: the link, what is played on what, CAPS, CFG.
    headings: Vec<Entry>,
}

impl Recorder {
    /// Of a link whose log counts its times from `epoch`; without frames only their hashes are
    /// kept.
    pub(super) fn new(epoch: Epoch, keeps_frames: bool) -> Self {
        Self {
            epoch,
            keeps_frames,
            code: PacketCode::default(),
            times: PacketTimes::default(),
            run: None,
            headings: Vec::new(),
        }
    }

    /// Adds the line of an entry.
    pub(super) fn entry(&mut self, entry: Entry, lines: &mut String) {
        write_entry(lines, &entry, self.epoch);
        if matches!(entry.note, Note::Said(event::LINK, _)) {
            self.code = PacketCode::default();
            self.times = PacketTimes::default();
            self.headings.clear();
        }
        let subject = subject_of(&entry.note);
        if subject.is_some() {
            self.headings
                .retain(|told| subject_of(&told.note) != subject);
            if self.headings.len() < MAX_HEADINGS {
                self.headings.push(entry);
            }
        }
    }

    /// Adds what stands at the head of a file in which the log goes on.
    pub(super) fn head(&mut self, lines: &mut String) {
        for mut heading in std::mem::take(&mut self.headings) {
            if let Note::Said(event::LINK, text) = &mut heading.note
                && !text.ends_with(CONTINUED)
            {
                text.push_str(CONTINUED);
            }
            self.entry(heading, lines);
        }
    }

    /// Adds what passed the port.
    pub(super) fn passing(&mut self, passing: &Passing, lines: &mut String) {
        let at = passing.at;
        let words = match &passing.what {
            Passed::Sent(packet) | Passed::Unsent(packet) => {
                let wire = packet.as_bytes();
                match (Body::of_whole(wire), &passing.what) {
                    (Some(body), Passed::Sent(_)) => return self.sent(at, &body, lines),
                    (Some(body), _) => PacketCode::unsent(&body),
                    (None, _) => {
                        self.end_run(lines);
                        bytes_words(event::OUT_BYTES, wire)
                    }
                }
            }
            Passed::Received(body) => self.code.received(body),
            Passed::Broken(text) => bytes_words(event::IN_BYTES, text.as_bytes()),
        };
        write_packet(lines, at, &words, (self.epoch, &mut self.times));
    }

    fn sent(&mut self, at: Instant, body: &Body, lines: &mut String) {
        let n = self.run.map_or(1, |run| run.n + 1);
        if body.kind == kind::FRAME && n <= MAX_AGAIN && self.code.is_again(body, n) {
            let began = self.run.map_or(at, |run| run.began);
            let run = Run { n, began, last: at };
            self.run = Some(run);
            if at.saturating_duration_since(began) >= LONGEST_RUN {
                self.end_run(lines);
            }
            return;
        }
        self.end_run(lines);
        let words = self.code.sent(body, self.keeps_frames);
        write_packet(lines, at, &words, (self.epoch, &mut self.times));
    }

    /// So many packets could not be taken: what comes next may be unlike what came before.
    pub(super) fn lost(&mut self, at: Instant, n: u64, lines: &mut String) {
        self.end_run(lines);
        let words = PacketWords::new(event::PACKETS_LOST, n.to_string());
        write_packet(lines, at, &words, (self.epoch, &mut self.times));
    }

    /// Writes how many frames were equal, if that waits for longer than it may.
    pub(super) fn settle(&mut self, now: Instant, lines: &mut String) {
        let waits = |run: Run| now.saturating_duration_since(run.began) >= LONGEST_RUN;
        if self.run.is_some_and(waits) {
            self.end_run(lines);
        }
    }

    /// Writes how many frames were equal.
    pub(super) fn end_run(&mut self, lines: &mut String) {
        if let Some(run) = self.run.take() {
            let words = self.code.again(run.n);
            write_packet(lines, run.last, &words, (self.epoch, &mut self.times));
        }
    }
}

/// What a heading is about; the last one of each is written again. `None` for other entries.
fn subject_of(note: &Note) -> Option<&str> {
    match note {
        Note::Caps(_) => Some(event::CAPS),
        Note::Effective(_) => Some(event::CFG),
        Note::Said(event::LINK, _) => Some(event::LINK),
        Note::Said(event::ABOUT, text) => text.split('=').next(),
        _ => None,
    }
}

fn bytes_words(event: &'static str, bytes: &[u8]) -> PacketWords {
    PacketWords::new(event, hex_of(bytes))
}
