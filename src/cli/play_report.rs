//! What `selvedge play` prints at the end: how punctual it was, and what was lost.

use std::fmt;
use std::time::Duration;

use selvedge_device::{BridgeCounters, Spread, Timings};
use selvedge_engine::{InputLosses, InputRate};
use selvedge_foundation::quantity::{fixed, time_span};

/// Figures of one run.
#[derive(Debug)]
pub(super) struct PlayReport {
    /// The port.
    pub(super) target: String,
    /// From arming to the end.
    pub(super) duration: Duration,
    /// Frames sent.
    pub(super) n_frames: u64,
    /// Device ticks that found no frame of ours because we came too late.
    pub(super) n_missed: u64,
    /// Lines of the stream that were no position.
    pub(super) n_bad_lines: u64,
    /// How steadily positions came, and what was lost of them.
    pub(super) input: (InputRate, InputLosses),
    /// Counters of device and host.
    pub(super) counters: BridgeCounters,
    /// How long frames took.
    pub(super) timings: Timings,
}

impl fmt::Display for PlayReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = fixed(self.duration.as_secs_f64(), 2);
        writeln!(
            f,
            "{}: {} frames in {seconds} s",
            self.target, self.n_frames
        )?;
        writeln!(
            f,
            "due to FRAME      {}",
            spread(&self.timings.due_to_write)
        )?;
        if self.timings.stamp_to_write.n > 0 {
            writeln!(
                f,
                "input to FRAME    {}",
                spread(&self.timings.stamp_to_write)
            )?;
        }
        let device = &self.counters.device;
        writeln!(
            f,
            "ticks             missed {}, late {}, underruns {}",
            self.n_missed, device.late, device.underrun
        )?;
        let codes = &self.counters.codes;
        let limited = codes.limited[0] + codes.limited[1];
        writeln!(
            f,
            "amplitudes        limited {limited}, scaled down {}, not finite {}",
            codes.guarded, codes.non_finite
        )?;
        let (rate, losses) = &self.input;
        if rate.rate_hz > 0.0 {
            let [hz, ms] = [rate.rate_hz, rate.jitter_ms].map(|number| fixed(number, 1));
            writeln!(
                f,
                "positions         {hz} Hz, jitter {ms} ms, gaps {}, dropped {}",
                rate.dropouts,
                losses.overflowed + losses.lost_in_system
            )?;
        }
        if self.n_bad_lines > 0 {
            writeln!(f, "lines dropped     {}", self.n_bad_lines)?;
        }
        Ok(())
    }
}

fn spread(spread: &Spread) -> String {
    let [median, p99, max] =
        [spread.median, spread.p99, spread.max].map(|time| time_span(time.as_secs_f64()));
    format!("median {median}, p99 {p99}, largest {max}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_names_every_loss() {
        let report = PlayReport {
            target: "./array".to_owned(),
            duration: Duration::from_millis(2025),
            n_frames: 81,
            n_missed: 1,
            n_bad_lines: 2,
            input: (
                InputRate {
                    rate_hz: 199.96,
                    jitter_ms: 0.42,
                    dropouts: 3,
                },
                InputLosses {
                    lost_in_system: 4,
                    ..InputLosses::default()
                },
            ),
            counters: BridgeCounters::default(),
            timings: Timings::default(),
        };
        let text = report.to_string();
        assert!(text.starts_with("./array: 81 frames in 2.0"), "{text}");
        assert!(text.contains("missed 1, late 0, underruns 0"), "{text}");
        let positions = "positions         200.0 Hz, jitter 0.4 ms, gaps 3, dropped 4";
        assert!(text.contains(positions), "{text}");
        assert!(text.contains("lines dropped     2"), "{text}");
    }
}
