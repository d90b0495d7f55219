//! Whether a link is noisy: broken bytes arrive where STATUS should.
//!
//! What arrives is counted second by second. Silence with bytes is no pulled cable.

use std::time::{Duration, Instant};

const SECOND: Duration = Duration::from_secs(1);
const TICKS_PER_S: u32 = 40;
/// Ticks of a second that may lack a good STATUS.
const MAX_LACKING: u32 = TICKS_PER_S / 10;
/// A link on which nothing came for so long is silent.
const QUIET: Duration = Duration::from_millis(250);

/// What the reader of a link has counted since it was opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Heard {
    /// Bytes.
    pub(crate) bytes: u64,
    /// Texts between zeros that were no message.
    pub(crate) bad: u64,
}

/// The present second of a link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Noise {
    began: Option<Instant>,
    at_start: Heard,
    now: Heard,
    /// When bytes came last.
    last_bytes: Option<Instant>,
    /// Broken texts by the last good STATUS.
    bad_at_status: u64,
    n_good: u32,
    n_noisy_seconds: u8,
}

impl Noise {
    /// A STATUS that can be read and advances.
    pub(super) fn good_status(&mut self) {
        self.n_good += 1;
        self.bad_at_status = self.now.bad;
    }

    /// What the reader has counted by now. True when two seconds running were noisy.
    pub(super) fn heard(&mut self, now: Instant, heard: Heard) -> bool {
        if heard.bytes > self.now.bytes {
            self.last_bytes = Some(now);
        }
        self.now = heard;
        let began = *self.began.get_or_insert(now);
        let lasted = now.saturating_duration_since(began);
        if lasted < SECOND {
            return false;
        }
        // Who was away cannot count.
        let is_whole = lasted < SECOND + SECOND / 4;
        let n_lacking = TICKS_PER_S.saturating_sub(self.n_good);
        let is_noisy = is_whole && n_lacking > MAX_LACKING && heard.bad > self.at_start.bad;
        self.n_noisy_seconds = if is_noisy {
            self.n_noisy_seconds.saturating_add(1)
        } else {
            0
        };
        self.began = Some(now);
        self.at_start = heard;
        self.n_good = 0;
        self.n_noisy_seconds >= 2
    }

    /// Whether anything came that was no message.
    pub(super) fn is_any(&self) -> bool {
        self.now.bad > 0
    }

    /// Why no STATUS came for so long.
    pub(super) fn silence_reason(&self, now: Instant, silent_for: Duration) -> String {
        let ms = silent_for.as_millis();
        let is_silent = self
            .last_bytes
            .is_none_or(|last| now.saturating_duration_since(last) > QUIET);
        if is_silent {
            format!("no STATUS for {ms} ms: check the cable and that the bridge is powered")
        } else if self.now.bad > self.bad_at_status {
            format!(
                "the link is noisy: for {ms} ms no STATUS among the bytes that arrive could be \
                 read; check the baud rate and what else uses the port"
            )
        } else {
            format!(
                "no STATUS that advances for {ms} ms, though bytes arrive: switch the device off \
                 and on"
            )
        }
    }
}

/// The line for a link on which too much breaks.
pub(super) const NOISY: &str = "the link is noisy: for two seconds more than a tenth of the STATUS \
    were broken; shorten or change the cable, and check the baud rate";

#[cfg(test)]
mod tests {
    use super::*;

    /// So many good STATUS and bad texts in each of some seconds; whether it ends noisy.
    fn ends_noisy(seconds: &[(u32, u64)]) -> bool {
        let (mut noise, start) = (Noise::default(), Instant::now());
        noise.heard(start, Heard::default());
        let (mut is_noisy, mut bad) = (false, 0);
        for (nth, (n_good, n_bad)) in (1..).zip(seconds) {
            for _ in 0..*n_good {
                noise.good_status();
            }
            bad += n_bad;
            let heard = Heard { bytes: 9000, bad };
            is_noisy |= noise.heard(start + SECOND * nth, heard);
        }
        is_noisy
    }

    #[test]
    fn two_seconds_running_with_broken_bytes_are_noisy() {
        assert!(ends_noisy(&[(40, 0), (35, 5), (35, 5)]));
        assert!(!ends_noisy(&[(35, 5), (40, 0), (35, 5)]), "not running");
        assert!(
            !ends_noisy(&[(36, 4), (36, 4), (36, 4)]),
            "a tenth is borne"
        );
        assert!(!ends_noisy(&[(30, 0), (30, 0)]), "slow, but nothing breaks");
    }

    #[test]
    fn nobody_is_told_to_check_a_cable_while_bytes_arrive() {
        let (mut noise, now) = (Noise::default(), Instant::now());
        let reason = |noise: &Noise| noise.silence_reason(now, Duration::from_millis(500));
        assert!(reason(&noise).contains("check the cable"));
        noise.heard(now, Heard { bytes: 40, bad: 0 });
        assert!(reason(&noise).contains("advances"));
        noise.heard(now, Heard { bytes: 90, bad: 2 });
        assert!(reason(&noise).contains("noisy"));
    }
}
