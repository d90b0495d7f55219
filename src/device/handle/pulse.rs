//! A channel that is driven alone begins softly: eight steps over 400 ms, then what was asked for.
//!
//! Each step is told anew before the last is over, and none lasts longer than a device without
//! frames is driven, so that one whose host is gone falls silent as soon.

use std::time::{Duration, Instant};

/// Steps from silence to the amplitude asked for.
const STEPS: u8 = 8;
const STEP_MS: u16 = 50;
const STEP: Duration = Duration::from_millis(STEP_MS as u64);
/// A step lasts longer than until the next, so that the next one finds it still there.
const LASTS_MS: u16 = 100;

/// One channel on its way to its amplitude.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pulse {
    pub(super) channel: u16,
    amplitude_um: f32,
    /// How long it is still to be driven at its amplitude.
    left_ms: u16,
    step: u8,
    /// When the next step is due, once the device has taken this one.
    next: Option<Instant>,
}

impl Pulse {
    /// At its first step.
    pub(super) fn new(channel: u16, (amplitude_um, ms): (f32, u16)) -> Self {
        Self {
            channel,
            amplitude_um,
            left_ms: ms,
            step: 1,
            next: None,
        }
    }

    /// Amplitude in µm and time in ms of the present step.
    pub(super) fn how(&self) -> (f32, u16) {
        let amplitude_um = self.amplitude_um * f32::from(self.step) / f32::from(STEPS);
        (amplitude_um, LASTS_MS.min(self.left_ms))
    }

    /// The device has taken the present step. Whether that is news: it was the first.
    pub(super) fn taken(&mut self, now: Instant) -> bool {
        self.next = Some(now + STEP);
        self.step == 1
    }

    /// Whether nothing follows the present step.
    pub(super) fn is_last(&self) -> bool {
        self.step >= STEPS && self.left_ms <= LASTS_MS
    }

    /// Goes on to the next step, if it is due.
    pub(super) fn advance(&mut self, now: Instant) -> bool {
        let is_due = !self.is_last() && self.next.take_if(|next| *next <= now).is_some();
        if is_due && self.step < STEPS {
            self.step += 1;
        } else if is_due {
            self.left_ms = self.left_ms.saturating_sub(STEP_MS);
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_amplitude_rises_step_by_step_and_never_before_the_last_was_taken() {
        let mut now = Instant::now();
        let mut pulse = Pulse::new(3, (16.0, 600));
        let mut steps = vec![pulse.how()];
        while !pulse.is_last() {
            assert!(!pulse.advance(now + 10 * STEP), "not taken yet");
            assert_eq!(pulse.taken(now), steps.len() == 1);
            assert!(!pulse.advance(now + STEP / 2), "too early");
            now += STEP;
            assert!(pulse.advance(now));
            steps.push(pulse.how());
        }
        assert!(!pulse.taken(now) && !pulse.advance(now + STEP));
        let rising = [2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0].map(|um| (um, 100));
        // 500 ms in steps that are renewed, and 100 that end by themselves.
        assert_eq!(steps, [&rising[..], &[(16.0, 100); 11]].concat());
    }
}
