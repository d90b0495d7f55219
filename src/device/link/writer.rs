//! The writer's thread: STOP first, then control packets, then the newest frame; one packet a
//! write.

use std::io;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer};

use super::shared::{QueuedFrame, Shared, count};
use crate::framing::Packet;
use crate::port::Port;
use crate::session_log::{Passed, Tap};

/// How long a port may take for one packet.
const PATIENCE: Duration = Duration::from_millis(50);
/// How long the thread sleeps when nobody wakes it.
const NAP: Duration = Duration::from_millis(100);

/// What became of a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Written {
    Yes,
    TimedOut,
    /// The second time-out in a row, or the port is gone: the owner has been told.
    Gone,
}

/// What waits for the port, most urgent first.
pub(super) struct Outgoing {
    controls: Consumer<Packet>,
    frames: Consumer<QueuedFrame>,
}

impl Outgoing {
    pub(super) fn new(controls: Consumer<Packet>, frames: Consumer<QueuedFrame>) -> Self {
        Self { controls, frames }
    }
}

/// What the writing thread owns.
pub(super) struct Writer {
    shared: Arc<Shared>,
    outgoing: Outgoing,
    failed: Producer<String>,
    timed_out: bool,
    /// When the last frame was written, since the last STOP.
    last_frame: Option<Instant>,
    tap: Tap,
}

impl Writer {
    pub(super) fn new(
        shared: Arc<Shared>,
        outgoing: Outgoing,
        failed: Producer<String>,
        tap: Tap,
    ) -> Self {
        Self {
            shared,
            outgoing,
            failed,
            timed_out: false,
            last_frame: None,
            tap,
        }
    }

    pub(super) fn run(mut self, mut port: Box<dyn Port>) {
        loop {
            match self.step(port.as_mut(), None) {
                Some(Written::Gone) => return,
                Some(_) => {}
                None if self.shared.has_quit() => return,
                None => std::thread::park_timeout(NAP),
            }
        }
    }

    /// Writes the most urgent packet, at the time that it is told or now; `None` when there is
    /// none.
    pub(super) fn step(&mut self, port: &mut dyn Port, told: Option<Instant>) -> Option<Written> {
        if let Some((stop, asked)) = self.shared.take_stop() {
            self.discard();
            let written = self.write(port, &stop, told);
            match written {
                Written::Yes => self.shared.stops_written.store(asked, Ordering::Release),
                Written::TimedOut => self.shared.put_stop(&stop),
                Written::Gone => {}
            }
            return Some(written);
        }
        if let Ok(packet) = self.outgoing.controls.pop() {
            return Some(self.write(port, &packet, told));
        }
        let frame = self.newest_frame()?;
        let written = self.write(port, &frame.packet, told);
        if written == Written::Yes {
            self.record(&frame, told.unwrap_or_else(Instant::now));
        }
        Some(written)
    }

    /// Nothing queued before a STOP may follow it: an ARM would undo it.
    fn discard(&mut self) {
        self.last_frame = None;
        while self.outgoing.controls.pop().is_ok() {}
        if self.newest_frame().is_some() {
            count(&self.shared.frames_superseded);
        }
    }

    fn newest_frame(&mut self) -> Option<QueuedFrame> {
        let mut newest = self.outgoing.frames.pop().ok()?;
        while let Ok(newer) = self.outgoing.frames.pop() {
            count(&self.shared.frames_superseded);
            newest = newer;
        }
        Some(newest)
    }

    fn record(&mut self, frame: &QueuedFrame, written: Instant) {
        count(&self.shared.frames_sent);
        if let Some(last) = self.last_frame.replace(written) {
            let interval = written.saturating_duration_since(last);
            self.shared.frame_interval.record(interval);
        }
        if let Some(due) = frame.due {
            self.shared
                .due_to_write
                .record(written.saturating_duration_since(due));
        }
        if let Some(stamp) = frame.stamp {
            self.shared
                .stamp_to_write
                .record(written.saturating_duration_since(stamp));
        }
    }

    fn write(&mut self, port: &mut dyn Port, packet: &Packet, told: Option<Instant>) -> Written {
        let result = port.write(packet.as_bytes(), PATIENCE);
        let what = match result {
            Ok(()) => Passed::Sent(*packet),
            Err(_) => Passed::Unsent(*packet),
        };
        self.tap.put(told.unwrap_or_else(Instant::now), &what);
        let reason = match result {
            Ok(()) => {
                self.timed_out = false;
                return Written::Yes;
            }
            Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                count(&self.shared.write_timeouts);
                if !std::mem::replace(&mut self.timed_out, true) {
                    return Written::TimedOut;
                }
                String::from("the device stopped taking data: check that it runs")
            }
            Err(error) => format!("the device is gone ({error}): check the cable"),
        };
        // The ring has room for as many reasons as anyone will read.
        drop(self.failed.push(reason));
        (self.shared.waker)();
        Written::Gone
    }
}
