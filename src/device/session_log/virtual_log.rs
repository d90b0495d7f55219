//! A log in virtual time, for tests: what a simulated host and its link would write down.

use std::time::Instant;

use super::line::{Epoch, header};
use super::note::{Entry, Note};
use super::recorder::Recorder;
use super::tap::{Body, Passed, Passing};
use super::{HASHED, event};
use crate::framing::Packet;

/// The text of a log while it grows.
#[derive(Debug)]
pub(crate) struct VirtualLog {
    recorder: Recorder,
    pub(crate) text: String,
}

impl VirtualLog {
    /// A log that is opened at `start`.
    pub(crate) fn new(start: Instant, keeps_frames: bool) -> Self {
        let epoch = Epoch {
            utc: std::time::UNIX_EPOCH,
            monotonic: start,
        };
        let mut log = Self {
            recorder: Recorder::new(epoch, keeps_frames),
            text: header(),
        };
        let frames = if keeps_frames { "" } else { HASHED };
        let text = format!("n=1 target=\"simulation\" program=test{frames}");
        log.entry(Entry {
            at: start,
            tick: None,
            device_us: None,
            note: Note::Said(event::LINK, text),
        });
        log
    }

    pub(crate) fn entry(&mut self, entry: Entry) {
        self.recorder.entry(entry, &mut self.text);
    }

    pub(crate) fn sent(&mut self, at: Instant, packet: &Packet) {
        self.pass(at, &Passed::Sent(*packet));
    }

    pub(crate) fn received(&mut self, at: Instant, body: &Body) {
        self.pass(at, &Passed::Received(*body));
    }

    fn pass(&mut self, at: Instant, what: &Passed) {
        self.recorder
            .passing(&Passing { at, what: *what }, &mut self.text);
        self.recorder.settle(at, &mut self.text);
    }

    /// The whole text.
    pub(crate) fn finish(&mut self) -> String {
        self.recorder.end_run(&mut self.text);
        self.text.clone()
    }
}
