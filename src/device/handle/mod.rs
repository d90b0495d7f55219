//! What an engine holds of a device: a session with two threads behind it.
//!
//! [`Bridge::poll`] runs the session, so that everything happens on the owner's thread except
//! waiting for the port. An owner that hangs sends no frames and no pings: the device then goes
//! silent by itself, as it should.

mod array;
mod notes;
mod pulse;
mod target;

use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::actuator_model::{ActuatorWatch, ContactorModel, actuator_watch};
use super::codes::ArrayProfile;
use super::host::{BridgeCounters, BridgeEvent, BridgeState, HostSession, SentFrame, Sequence};
use super::link::{Hearing, Incoming, Link, QueuedFrame, StopHandle, Timings, Waker};
use super::message::StopHow;
use super::session_log::Note;
use notes::Notes;
pub(crate) use notes::host_counters;
use pulse::Pulse;
pub use target::Target;

/// One device and the session with it.
#[derive(Debug)]
pub struct Bridge {
    target: String,
    is_emulator: bool,
    session: HostSession,
    link: Option<Link>,
    actuators: Option<ActuatorWatch>,
    notes: Notes,
    /// A channel that is driven alone, on its way to its amplitude.
    pulse: Option<Pulse>,
}

impl Bridge {
    /// Starts to open `target` for a display of `n_contactors` contactors and returns at once; news
    /// come from [`poll`](Self::poll).
    ///
    /// `waker` is called from the link's threads whenever there may be news; it must not block.
    pub fn open(
        target: Target,
        profile: ArrayProfile,
        n_contactors: usize,
        waker: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        Self::begin(target, (profile, n_contactors), None, Arc::new(waker))
    }

    /// The same in the time that [`tell`](Self::tell) says, from `start` on and without threads: an
    /// emulated device then does the same every time. A port keeps real time all the same.
    pub fn open_stepped(
        target: Target,
        profile: ArrayProfile,
        n_contactors: usize,
        start: Instant,
        waker: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let display = (profile, n_contactors);
        Self::begin(target, display, Some(start), Arc::new(waker))
    }

    fn begin(
        target: Target,
        (profile, n_contactors): (ArrayProfile, usize),
        start: Option<Instant>,
        waker: Waker,
    ) -> Self {
        let sequence = Sequence::default();
        let name = target.name();
        let shape = profile.clone();
        let is_emulator = target.is_emulator();
        let actuators =
            is_emulator.then(|| actuator_watch(ContactorModel::default(), shape.n_contactors()));
        let (feed, actuators) = actuators.unzip();
        let hearing = Hearing::Messages {
            n_channels: n_contactors,
        };
        let mut session = HostSession::new(nonce(), profile, n_contactors, sequence.clone());
        let link = if let Some(start) = start.filter(|_| is_emulator) {
            let device = target.boot(&shape, feed);
            Ok(Link::stepped(device, hearing, sequence, start))
        } else {
            let opener = Box::new(move || target.open(&shape, feed));
            Link::open(opener, hearing, sequence, waker)
        };
        let link = match link {
            Ok(link) => Some(link),
            Err(error) => {
                session.link_gone(Instant::now(), error.to_string());
                None
            }
        };
        Self {
            target: name,
            is_emulator,
            session,
            link,
            actuators,
            notes: Notes::default(),
            pulse: None,
        }
    }

    /// Tells one that was opened so what time it is.
    pub fn tell(&mut self, now: Instant) {
        if let Some(link) = &mut self.link {
            link.tell(now);
        }
    }

    fn now(&self) -> Instant {
        self.link.as_ref().map_or_else(Instant::now, Link::now)
    }

    /// Runs the session and gives the next piece of news. Call until `None`, after each wake and at
    /// least every 100 ms.
    pub fn poll(&mut self) -> Option<BridgeEvent> {
        loop {
            let event = self.next();
            self.heed(event.as_ref());
            match event {
                Some(event) if !self.is_news(&event, self.now()) => {}
                event => return event,
            }
        }
    }

    fn next(&mut self) -> Option<BridgeEvent> {
        if let Some(event) = self.session.next_event() {
            return Some(event);
        }
        if let Some(link) = &mut self.link {
            link.settle();
        }
        let now = self.now();
        if let Some(how) = self.link.as_ref().and_then(Link::take_stop_by_handle) {
            self.session.note(now, Note::StopBySwitch(how));
            self.session.stop(now, how);
        }
        while let Some(incoming) = self.link.as_mut().and_then(Link::next) {
            match incoming {
                Incoming::Opened => self.session.opened(now),
                Incoming::Message { message, received } => {
                    self.session.on_message(received, &message);
                }
                // Only a link without a session is asked for them.
                Incoming::Bytes(_) => {}
                Incoming::Gone(reason) => self.session.link_gone(now, reason),
            }
            if let Some(event) = self.session.next_event() {
                self.flush();
                return Some(event);
            }
        }
        if let Some(link) = &self.link {
            self.session.heard(now, link.heard());
        }
        self.session.on_time(now);
        self.raise(now);
        self.flush();
        if !self.session.state().is_open() {
            self.release();
        }
        self.session.next_event()
    }

    /// Asks for output; `Armed` or `Disarmed` follows. False when the device is not `Ready`.
    pub fn arm(&mut self) -> bool {
        let asked = self.session.arm(self.now());
        self.flush();
        asked
    }

    /// Ends output ahead of everything queued, in any state and any number of times.
    pub fn stop(&mut self, how: StopHow) {
        self.session.stop(self.now(), how);
        self.flush();
    }

    /// Asks a faulted device to clear its faults; it becomes `Ready` when their cause is gone.
    pub fn clear_faults(&mut self) {
        self.session.clear_faults(self.now());
        self.flush();
    }

    /// Sends a PING; `Pong` follows.
    #[cfg(test)]
    pub(crate) fn ping(&mut self) {
        self.session.ping(self.now());
        self.flush();
    }

    /// Sends one FRAME for the coming tick, limits and soft start applied; `None` unless armed.
    ///
    /// `amplitudes_um` are `[A40, A320]` in µm in contactor order. `stamp` is the time of the input
    /// that they follow from, for [`timings`](Self::timings). Neither allocates, locks nor waits.
    pub fn send(
        &mut self,
        amplitudes_um: &[[f32; 2]],
        stamp: Option<Instant>,
    ) -> Option<SentFrame> {
        let now = self.now();
        let link = self.link.as_mut()?;
        let (sent, packet) = self.session.frame(now, amplitudes_um)?;
        link.send_frame(&QueuedFrame {
            packet,
            due: sent.due,
            stamp,
        });
        link.settle();
        Some(sent)
    }

    /// Where the session stands.
    pub fn state(&self) -> BridgeState {
        self.session.state()
    }

    /// `emulator` or the port's path.
    pub fn target(&self) -> &str {
        &self.target
    }

    /// The session: what the device says of itself, and what was made of it.
    pub fn session(&self) -> &HostSession {
        &self.session
    }

    /// Everything that is counted on this link.
    pub fn counters(&self) -> BridgeCounters {
        let session = self.session.counters();
        let with_link = |link: &Link| BridgeCounters {
            device: session.device,
            codes: session.codes,
            frames_rejected: session.frames_rejected,
            stray_status: session.stray_status,
            ..link.counters()
        };
        self.link.as_ref().map_or(session, with_link)
    }

    /// A look at the contactors of the emulator in this process; there is one.
    pub fn take_actuators(&mut self) -> Option<ActuatorWatch> {
        self.actuators.take()
    }

    /// How long frames took to reach the port.
    pub fn timings(&self) -> Timings {
        self.link.as_ref().map(Link::timings).unwrap_or_default()
    }

    /// A way to stop the device from other threads; `None` when the link could not even be started,
    /// and when it lives on the owner's thread alone.
    pub fn stop_handle(&self) -> Option<StopHandle> {
        let link = self.link.as_ref().filter(|link| link.has_threads());
        link.map(Link::stop_handle)
    }

    /// Ends the link's threads and waits for that, at most `patience`. Dropping does the same
    /// without waiting; whether a device came to rest, the [`Driver`](crate::Driver) asks first.
    pub fn close(mut self, patience: Duration) {
        self.leave();
        let link = self.link.take();
        let deadline = Instant::now() + patience;
        while link.as_ref().is_some_and(Link::is_running) && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn flush(&mut self) {
        self.write_notes();
        let Some(link) = &mut self.link else { return };
        if let Some(packet) = self.session.take_stop() {
            link.send_stop(&packet);
        }
        while let Some(packet) = self.session.next_packet() {
            // A packet without room is sent again later, as every request is.
            let _has_room = link.send_control(&packet);
        }
        link.settle();
    }

    /// Leaves the device, with a STOP if it may be moving.
    fn leave(&mut self) {
        if self.state().is_live() {
            self.stop(StopHow::Ramp);
        }
        self.release();
    }

    /// Lets the threads write what is left and end.
    fn release(&mut self) {
        self.note_end();
        self.flush();
        if let Some(link) = &self.link {
            link.quit();
        }
    }
}

impl Drop for Bridge {
    fn drop(&mut self) {
        self.leave();
    }
}

/// A session number that no earlier session of this port is likely to have had.
fn nonce() -> u32 {
    let hash = RandomState::new().build_hasher().finish();
    let [a, b, c, d, ..] = hash.to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

#[cfg(test)]
pub(crate) mod tests;
