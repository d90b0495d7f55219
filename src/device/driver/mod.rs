//! The one way to drive a device: pacing, patience, signals, panics and STOP, whoever makes the
//! frames.
//!
//! [`Pacer`] says when to tick, for owners with a loop of their own. [`Driver`] is the loop for all
//! others: it waits for the device, arms it, asks a [`FrameSource`] at every tick, and whatever
//! ends the session, sends STOP first and waits for its acknowledgement.
//!
//! [`DirectLine`] has the same threads, STOP and record without a session, for the checks that must
//! say what no host says.
//!
//! It knows nothing of paths, textiles or terminals.

mod direct;
mod pacer;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::BridgeError;
use super::codes::ArrayProfile;
use super::handle::{Bridge, Target};
use super::host::{BridgeEvent, BridgeState, DisarmedBy};
use super::link::StopHandle;
use super::message::{StopHow, TICK_US, fault_bit};
pub use direct::DirectLine;
pub use pacer::Pacer;
use selvedge_foundation::panics::OnPanic;

/// The time between two ticks of a device.
const TICK: Duration = Duration::from_micros(TICK_US as u64);
/// A wait is never longer, so that a signal is soon heeded.
const NAP: Duration = Duration::from_millis(20);
/// From opening a port to a device that may be armed; the session itself gives up HELLO after 5 s.
const CONNECT_PATIENCE: Duration = Duration::from_secs(10);
/// ARM and STOP are sent again every 250 ms, eight times; then the session itself gives up.
const REPLY_PATIENCE: Duration = Duration::from_secs(4);
/// For the threads of a link to end, once STOP is acknowledged.
const GOODBYE: Duration = Duration::from_secs(1);

/// Where frames come from.
pub trait FrameSource {
    /// Why it fails.
    type Error: From<BridgeError>;

    /// Hears what happens, ticks left out.
    ///
    /// # Errors
    /// The session is to end for a reason of its own.
    fn event(&mut self, event: &BridgeEvent) -> Result<(), Self::Error>;

    /// A tick of an armed device is due: to be answered with one frame ([`Bridge::send`]), or, as
    /// long as none was sent, with one channel driven alone. `Break`: there is no more.
    ///
    /// # Errors
    /// The session is to end for a reason of its own.
    fn tick(&mut self, bridge: &mut Bridge) -> Result<ControlFlow<()>, Self::Error>;
}

/// What ended a session in which nothing was wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// There were no more frames.
    BySource,
    /// It was asked to.
    ByRequest,
}

/// A device and the loop that drives it.
#[derive(Debug)]
pub struct Driver {
    bridge: Bridge,
    pacer: Pacer,
    /// When the device was armed, and what had been missed by then.
    armed: Option<(Instant, u64)>,
    /// Whether the end was asked for.
    is_ending: bool,
    _on_panic: Option<OnPanic>,
}

impl Driver {
    /// Starts to open a device for a display of `n_contactors` contactors, on the thread that will
    /// run it. A panic of any thread stops the device before it is reported.
    pub fn open(target: Target, profile: ArrayProfile, n_contactors: usize) -> Self {
        let waiting = thread::current();
        let bridge = Bridge::open(target, profile, n_contactors, move || waiting.unpark());
        let handle = bridge.stop_handle();
        Self {
            bridge,
            pacer: Pacer::waiting(),
            armed: None,
            is_ending: false,
            _on_panic: handle.map(stop_on_panic),
        }
    }

    /// The device.
    pub fn bridge(&self) -> &Bridge {
        &self.bridge
    }

    /// The device; for what is said before the session begins.
    pub fn bridge_mut(&mut self) -> &mut Bridge {
        &mut self.bridge
    }

    /// How long ago the device was armed; zero before.
    pub fn elapsed(&self) -> Duration {
        self.armed
            .map_or(Duration::ZERO, |(armed, _)| armed.elapsed())
    }

    /// Ticks of the armed device that found no frame because it was too late for one.
    pub fn missed(&self) -> u64 {
        self.armed
            .map_or(0, |(_, before)| self.pacer.missed() - before)
    }

    /// One session: waits for the device, arms it, and asks `source` at every tick until it has no
    /// more or `stop` is set. Whatever ends it, STOP is sent first and its acknowledgement awaited.
    ///
    /// # Errors
    /// What went wrong first, in one line with the device's name: the source's own reason, a
    /// device that cannot be opened, is refused, lost, faulty or disarms itself, or a STOP that
    /// is not acknowledged.
    pub fn run<S: FrameSource>(
        &mut self,
        source: &mut S,
        stop: &AtomicBool,
    ) -> Result<Ended, S::Error> {
        let ended = self.play(source, stop);
        let rested = self.rest(source);
        let ended = ended?;
        rested?;
        Ok(ended)
    }

    /// Ends the link's threads, so that the port is free again.
    pub fn close(self) {
        self.bridge.close(GOODBYE);
    }

    fn play<S: FrameSource>(
        &mut self,
        source: &mut S,
        stop: &AtomicBool,
    ) -> Result<Ended, S::Error> {
        let mut deadline = Instant::now() + CONNECT_PATIENCE;
        let mut is_asked = false;
        while !stop.load(Ordering::Relaxed) {
            let due = self.turn(source)?;
            let state = self.bridge.state();
            match state {
                BridgeState::Faulted => {
                    let faults = self
                        .bridge
                        .session()
                        .status()
                        .map_or(0, |status| status.faults);
                    let what = format!(
                        "the device has a fault ({}) and cannot be armed: mend it, then clear it \
                         (CLEAR in the Bridge pane) or switch the device off and on",
                        fault_bit::names(faults)
                    );
                    return Err(self.failed(&what).into());
                }
                BridgeState::Ready if !is_asked => {
                    is_asked = self.bridge.arm();
                    deadline = Instant::now() + REPLY_PATIENCE;
                }
                state if self.armed.is_none() && Instant::now() >= deadline => {
                    let what = format!("the device cannot be armed: it is still {state}");
                    return Err(self.failed(&what).into());
                }
                _ => {}
            }
            if due.is_none() {
                self.wait();
            } else if state.takes_frames() && source.tick(&mut self.bridge)?.is_break() {
                return Ok(Ended::BySource);
            }
        }
        Ok(Ended::ByRequest)
    }

    /// STOP, and its acknowledgement by a device that is at rest.
    fn rest<S: FrameSource>(&mut self, source: &mut S) -> Result<(), S::Error> {
        self.is_ending = true;
        self.bridge.stop(StopHow::Ramp);
        let deadline = Instant::now() + REPLY_PATIENCE;
        let mut wrong = None;
        while self.bridge.session().is_ending() && Instant::now() < deadline {
            let error = self.turn(source).err();
            wrong = wrong.or(error);
            self.wait();
        }
        if self.bridge.session().is_ending() {
            if let Some(handle) = self.bridge.stop_handle() {
                handle.last_word();
            }
            let what = "did not acknowledge the last STOP; switch its power off";
            wrong = wrong.or_else(|| Some(self.failed(what).into()));
        }
        wrong.map_or(Ok(()), Err)
    }

    /// Takes all news, and says whether a tick is due. The first that is wrong ends the session.
    fn turn<S: FrameSource>(&mut self, source: &mut S) -> Result<Option<Instant>, S::Error> {
        let was_opening = self.bridge.state() == BridgeState::Opening;
        let (mut wrong, mut is_armed) = (None, false);
        let is_ending = self.is_ending;
        let mut hear = |event: BridgeEvent| {
            is_armed |= event == BridgeEvent::Armed;
            let heard = source.event(&event).err().map(Wrong::OfSource);
            let heard = heard.or_else(|| trouble(event, is_ending).map(Wrong::OfDevice));
            wrong = wrong.take().or(heard);
        };
        let due = self
            .pacer
            .turn(Some(&mut self.bridge), Instant::now(), &mut hear);
        if is_armed {
            self.armed = Some((Instant::now(), self.pacer.missed()));
        }
        match wrong {
            None => Ok(due),
            Some(Wrong::OfSource(error)) => Err(error),
            // A port that cannot even be opened is the wrong one.
            Some(Wrong::OfDevice(reason)) if was_opening => Err(BridgeError::Open {
                port: self.bridge.target().to_owned(),
                reason: self.without_target(&reason),
            }
            .into()),
            Some(Wrong::OfDevice(reason)) => Err(self.failed(&reason).into()),
        }
    }

    fn wait(&self) {
        let now = Instant::now();
        let until = self.pacer.deadline().unwrap_or(now + NAP);
        thread::park_timeout(until.saturating_duration_since(now).min(NAP));
    }

    fn failed(&self, reason: &str) -> BridgeError {
        BridgeError::Link {
            port: self.bridge.target().to_owned(),
            reason: self.without_target(reason),
        }
    }

    fn without_target(&self, reason: &str) -> String {
        let bare = reason.strip_prefix(self.bridge.target());
        let bare = bare.map(|rest| rest.trim_start_matches([':', ' ']));
        bare.unwrap_or(reason).to_owned()
    }
}

/// From now on a panic of any thread stops the device.
fn stop_on_panic(handle: StopHandle) -> OnPanic {
    OnPanic::new(move || handle.last_word())
}

/// Why a session ends.
enum Wrong<E> {
    OfSource(E),
    OfDevice(String),
}

/// What is wrong by a piece of news, if something is.
fn trouble(event: BridgeEvent, is_ending: bool) -> Option<String> {
    match event {
        BridgeEvent::Refused(reason) | BridgeEvent::Lost(reason) => Some(reason),
        BridgeEvent::Disarmed { by, reason } => {
            (by == DisarmedBy::Device || !is_ending).then_some(reason)
        }
        BridgeEvent::Fault(fault) => {
            let latched = fault.faults & !fault_bit::LEASE_LOST;
            let names = fault_bit::names(latched);
            (latched != 0).then(|| format!("the device reports a fault: {names}"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests;
