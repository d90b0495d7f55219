//! What time does to a session: requests are repeated or given up, a quiet host pings, a silent
//! device is lost.

use std::time::{Duration, Instant};

use super::HostSession;
use super::noise::{Heard, NOISY};
use super::pending::Verdict;
use super::report::{BridgeState, DisarmedBy};
use crate::message::{StopHow, kind};

/// A host that has nothing to send for this long sends a PING: below a quarter of the lease of 1 s.
const PING_EVERY: Duration = Duration::from_millis(200);
/// PINGs that measure the clock soon after connecting, and the pauses between them then and later.
const FIRST_PINGS: u64 = 8;
const FIRST_PAUSE: Duration = Duration::from_millis(40);
const PAUSE: Duration = Duration::from_secs(1);
/// STATUS missing for this long while armed means that the link is lost.
const SILENCE_ARMED: Duration = Duration::from_millis(500);
/// The same while nothing moves; longer, since nothing is at stake.
const SILENCE_IDLE: Duration = Duration::from_secs(2);
/// From the acknowledgement of STOP to rest: the longest ramp, and STATUS on its way.
const REST_PATIENCE: Duration = Duration::from_millis(500);
/// A caller that was away longer than this cannot blame the device for the silence.
const LONGEST_STEP: Duration = Duration::from_millis(100);

impl HostSession {
    /// Lets time pass: repeats, pings, and the patience with a silent device. Call at least every
    /// 100 ms.
    pub(crate) fn on_time(&mut self, now: Instant) {
        let step = self
            .presence
            .last_time
            .map_or(Duration::ZERO, |last| now.saturating_duration_since(last));
        self.presence.last_time = Some(now);
        self.ticks.present(now);
        if !self.state.is_open() || self.state == BridgeState::Opening {
            return;
        }
        self.check_request(now);
        self.check_stop(now);
        self.check_ident(now);
        self.check_silence(now, step.min(LONGEST_STEP));
        let quiet = self
            .outbox
            .last_sent
            .is_none_or(|sent| now.duration_since(sent) >= PING_EVERY);
        if self.state.is_open() && self.device.caps.is_some() && (quiet || self.wants_time(now)) {
            self.ping(now);
        }
    }

    /// Takes what the reader of the link has counted: one on which too much breaks ends output.
    pub(crate) fn heard(&mut self, now: Instant, heard: Heard) {
        let is_noisy = self.noise.heard(now, heard);
        if is_noisy && self.state.is_live() && self.state != BridgeState::Stopping {
            self.contradicted(now, (StopHow::Ramp, String::from(NOISY)));
        }
    }

    /// Whether the device's clock is to be asked for: often at first, then once a second.
    fn wants_time(&self, now: Instant) -> bool {
        let is_new = self.clock.fit_view().n_answers < FIRST_PINGS;
        // One that is under way would not be recognised any more.
        let pause = if is_new && self.pings.under_way.is_none() {
            FIRST_PAUSE
        } else {
            PAUSE
        };
        self.pings
            .last
            .is_none_or(|last| now.saturating_duration_since(last) >= pause)
    }

    fn check_request(&mut self, now: Instant) {
        let Some(mut request) = self.request else {
            return;
        };
        match request.verdict(now) {
            Verdict::Wait => return,
            Verdict::Repeat => {
                self.send_request(&mut request, now);
                self.request = Some(request);
                return;
            }
            Verdict::GiveUp => self.request = None,
        }
        match request.kind() {
            kind::HELLO => self.lose(now, String::from(
                "no answer within 5 s: check that the bridge is powered and that this is its port",
            )),
            kind::ARM => {
                self.stop(now, StopHow::Now);
                self.stopping.ends_output = false;
                self.disarmed(
                    now,
                    DisarmedBy::Device,
                    String::from("the device did not answer ARM"),
                );
            }
            kind::CONFIG => self.lose(now, String::from("the device did not answer CONFIG")),
            _ => {}
        }
    }

    fn check_stop(&mut self, now: Instant) {
        let Some(mut stopping) = self.stopping.pending else {
            return self.check_rest(now);
        };
        match stopping.verdict(now) {
            Verdict::Wait => {}
            Verdict::Repeat => {
                self.send_stop(&mut stopping, now);
                self.stopping.pending = Some(stopping);
            }
            Verdict::GiveUp => self.lose(now, String::from("the device did not acknowledge STOP")),
        }
    }

    /// A device that acknowledged STOP comes to rest within its ramp.
    fn check_rest(&mut self, now: Instant) {
        let obeyed = self
            .stopping
            .obeyed
            .filter(|_| self.state == BridgeState::Stopping);
        if obeyed.is_some_and(|at| now.saturating_duration_since(at) > REST_PATIENCE) {
            self.lose(
                now,
                String::from(
                    "the device acknowledged STOP and did not come to rest: switch its power off",
                ),
            );
        }
    }

    /// Silence is counted in steps of the caller's own presence: a program that was suspended
    /// starts afresh.
    fn check_silence(&mut self, now: Instant, step: Duration) {
        if self.device.caps.is_none() {
            return;
        }
        self.presence.silent_for += step;
        let patience = if self.state.is_live() {
            SILENCE_ARMED
        } else {
            SILENCE_IDLE
        };
        if self.presence.silent_for >= patience && self.state.is_open() {
            self.lose(now, self.noise.silence_reason(now, patience));
        }
    }
}
