//! The two threads of a link: one opens the port and reads, one writes; nobody else ever waits for
//! a port.
//!
//! Towards the owner, messages travel in a bounded ring (when it is full the newest is dropped
//! and counted: STATUS repeats itself, requests are repeated). Towards the port there are three
//! ways, in this order: the STOP slot, a ring of control packets, then a ring of frames of which
//! only the newest is written. A STOP empties the others, so that nothing queued earlier can follow
//! it. What the messages mean is the session's business.

mod reader;
mod shared;
mod stepped;
mod timings;
mod writer;

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::Builder;
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, RingBuffer};

use super::BridgeError;
use super::framing::Packet;
use super::host::{BridgeCounters, Heard, Sequence};
use super::message::{Message as _, Stop, StopHow};
use super::port::Port;
use super::session_log::{TapEnd, tap};
use reader::Reader;
pub(super) use shared::{Ends, Hearing, Incoming, Opener, QueuedFrame, Waker};
use shared::{Running, Shared, count};
pub(crate) use stepped::Living;
use stepped::Stepped;
pub use timings::{Distribution, DistributionBar, Spread, Timings};
use writer::{Outgoing, Writer};

const INCOMING: usize = 256;
const FRAMES: usize = 4;
/// Longest wait for the STOP of a program that fails.
const LAST_WORD: Duration = Duration::from_millis(250);

/// The owner's end of a link.
pub(super) struct Link {
    shared: Arc<Shared>,
    incoming: Consumer<Incoming>,
    failures: Consumer<String>,
    controls: Producer<Packet>,
    frames: Producer<QueuedFrame>,
    /// For a log: what is really written, and what really arrives.
    taps: Option<[TapEnd; 2]>,
    /// The device and what threads do elsewhere, where the owner says what time it is.
    stepped: Option<Box<Stepped>>,
}

impl fmt::Debug for Link {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Link").finish_non_exhaustive()
    }
}

impl Link {
    /// Starts the reader, which opens the port and then starts the writer. Never waits.
    pub(super) fn open(
        opener: Opener,
        hearing: Hearing,
        sequence: Sequence,
        waker: Waker,
    ) -> Result<Self, BridgeError> {
        let (link, reader, writer) = Self::unopened(hearing, sequence, waker);
        let running = Running::new(&link.shared);
        Builder::new()
            .name(String::from("bridge-reader"))
            .spawn(move || {
                let _running = running;
                reader.run(opener, writer);
            })
            .map_err(BridgeError::Thread)?;
        Ok(link)
    }

    /// A link without threads to a device that lives in the time that [`tell`](Self::tell) says,
    /// from `start` on.
    pub(super) fn stepped(
        device: (Box<dyn Port>, Living),
        hearing: Hearing,
        sequence: Sequence,
        start: Instant,
    ) -> Self {
        let (mut link, mut reader, writer) = Self::unopened(hearing, sequence, Arc::new(|| {}));
        reader.send(Incoming::Opened);
        link.stepped = Some(Box::new(Stepped::new((reader, writer), device, start)));
        link
    }

    fn unopened(hearing: Hearing, sequence: Sequence, waker: Waker) -> (Self, Reader, Writer) {
        let shared = Arc::new(Shared::new(sequence, waker));
        let [n_controls, n_passing] = hearing.places();
        let (to_owner, incoming) = RingBuffer::new(INCOMING);
        let (failed, failures) = RingBuffer::new(FRAMES);
        let (controls, controls_out) = RingBuffer::new(n_controls);
        let (frames, frames_out) = RingBuffer::new(FRAMES);
        let outgoing = Outgoing::new(controls_out, frames_out);
        let [(sent, sent_end), (received, received_end)] = [tap(n_passing), tap(n_passing)];
        let writer = Writer::new(Arc::clone(&shared), outgoing, failed, sent);
        let reader = Reader::new(Arc::clone(&shared), to_owner, hearing, received);
        let link = Self {
            shared,
            incoming,
            failures,
            controls,
            frames,
            taps: Some([sent_end, received_end]),
            stepped: None,
        };
        (link, reader, writer)
    }

    /// What time it is: what it was told last, or that of the system.
    pub(super) fn now(&self) -> Instant {
        let stepped = self.stepped.as_ref();
        stepped.map_or_else(Instant::now, |stepped| stepped.now)
    }

    /// Tells a link without threads what time it is.
    pub(super) fn tell(&mut self, now: Instant) {
        if let Some(stepped) = &mut self.stepped {
            stepped.now = now.max(stepped.now);
        }
    }

    /// Does what threads would have done until now, where there are none.
    pub(super) fn settle(&mut self) {
        if let Some(stepped) = &mut self.stepped {
            stepped.settle();
        }
    }

    /// What a log follows; `None` when one does.
    pub(super) fn take_taps(&mut self) -> Option<[TapEnd; 2]> {
        self.taps.take()
    }

    pub(super) fn next(&mut self) -> Option<Incoming> {
        self.incoming
            .pop()
            .ok()
            .or_else(|| self.failures.pop().ok().map(Incoming::Gone))
    }

    pub(super) fn send_stop(&self, packet: &Packet) {
        self.shared.put_stop(packet);
    }

    /// Whether there was room for it. A session may drop it then: every request is repeated.
    pub(super) fn send_control(&mut self, packet: &Packet) -> bool {
        let has_room = self.controls.push(*packet).is_ok();
        self.shared.unpark_writer();
        has_room
    }

    /// Without room the frame is dropped and counted: the writer is stuck, and the device is on its
    /// way to silence.
    pub(super) fn send_frame(&mut self, frame: &QueuedFrame) {
        if self.frames.push(*frame).is_err() {
            count(&self.shared.frames_superseded);
        }
        self.shared.unpark_writer();
    }

    /// A STOP that went out through a handle since the last call.
    pub(super) fn take_stop_by_handle(&self) -> Option<StopHow> {
        match self.shared.stop_by_handle.swap(0, Ordering::AcqRel) {
            0 => None,
            1 => Some(StopHow::Ramp),
            _ => Some(StopHow::Now),
        }
    }

    /// Whether it writes by itself what it is given.
    pub(super) fn has_threads(&self) -> bool {
        self.stepped.is_none()
    }

    pub(super) fn stop_handle(&self) -> StopHandle {
        StopHandle {
            shared: Arc::clone(&self.shared),
        }
    }

    pub(super) fn counters(&self) -> BridgeCounters {
        let get = |count: &AtomicU64| count.load(Ordering::Relaxed);
        BridgeCounters {
            frames_sent: get(&self.shared.frames_sent),
            frames_superseded: get(&self.shared.frames_superseded),
            bad_received: get(&self.shared.bad_received),
            events_dropped: get(&self.shared.events_dropped),
            write_timeouts: get(&self.shared.write_timeouts),
            ..BridgeCounters::default()
        }
    }

    /// What the reader has counted.
    pub(super) fn heard(&self) -> Heard {
        Heard {
            bytes: self.shared.bytes_received.load(Ordering::Relaxed),
            bad: self.shared.bad_received.load(Ordering::Relaxed),
        }
    }

    pub(super) fn timings(&self) -> Timings {
        Timings {
            due_to_write: self.shared.due_to_write.spread(),
            stamp_to_write: self.shared.stamp_to_write.spread(),
            round_trip: self.shared.round_trip.distribution(),
            frame_interval: self.shared.frame_interval.distribution(),
        }
    }

    /// A PING was answered after so long.
    pub(super) fn record_round_trip(&self, round_trip: Duration) {
        self.shared.round_trip.record(round_trip);
    }

    /// Lets the threads end once everything queued is written. Does not wait.
    pub(super) fn quit(&self) {
        self.shared.quit.store(true, Ordering::Release);
        self.shared.unpark_writer();
    }

    pub(super) fn is_running(&self) -> bool {
        self.shared.running.load(Ordering::Acquire) > 0
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.quit();
    }
}

/// Stops a device from any thread: Esc, a signal, a panic hook. Works even when the bridge's owner
/// hangs.
#[derive(Clone)]
pub struct StopHandle {
    shared: Arc<Shared>,
}

impl fmt::Debug for StopHandle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StopHandle").finish_non_exhaustive()
    }
}

impl StopHandle {
    /// Sends STOP ahead of everything queued. The bridge's own state follows at its next poll.
    pub fn stop(&self, how: StopHow) {
        let code = if how == StopHow::Ramp { 1 } else { 2 };
        self.shared.stop_by_handle.fetch_max(code, Ordering::AcqRel);
        if let Some(packet) = (Stop { reason: 1, how }).packet(self.shared.sequence.next()) {
            self.shared.put_stop(&packet);
        }
        (self.shared.waker)();
    }

    /// Zero now, and waits until that is written, for a moment at most: for the last moments of a
    /// program or of a thread. If the port takes nothing the device's own silence rule is left.
    pub fn last_word(&self) {
        self.stop(StopHow::Now);
        self.wait_written(LAST_WORD);
    }

    /// Waits until every STOP asked for so far is written, at most `patience`.
    pub fn wait_written(&self, patience: Duration) -> bool {
        let deadline = Instant::now() + patience;
        let asked = self.shared.stops_asked.load(Ordering::Acquire);
        loop {
            if self.shared.stops_written.load(Ordering::Acquire) >= asked {
                return true;
            }
            if Instant::now() >= deadline {
                return false;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

#[cfg(test)]
mod tests;
