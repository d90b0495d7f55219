//! Faults of the emulator in this process: what is chosen, and what runs.
//!
//! Transient: every emulator that is connected otherwise begins without any.

use crate::bench::query;
use selvedge_device::{FaultWords, Target};

/// What the user chose, and what the emulator that is connected was started with.
#[derive(Debug, Default)]
pub(crate) struct FaultBench {
    /// What is typed, for the next start.
    pub chosen: FaultWords,
    /// What goes wrong now; `None` where no emulator of this program is connected.
    pub running: Option<FaultWords>,
}

/// Faults that are worth a try together: a name, and options with their texts.
pub(crate) const PRESETS: [(&str, &[(&str, &str)]); 6] = [
    ("None", &[]),
    (
        "Adapter with a timer",
        &[("latency", "ftdi"), ("hiccup", "0.1%:50ms")],
    ),
    (
        "Bad cable",
        &[("drop", "0.01%"), ("flip", "0.01%"), ("lose-usb", "0.1%")],
    ),
    (
        "Clock off its pace",
        &[("clock-ppm", "100"), ("tick-jitter", "2ms")],
    ),
    (
        "Device that stalls",
        &[
            ("stall-reading-at", "5s,20s"),
            ("stall-writing-at", "10s"),
            ("reboot-at", "30s"),
        ],
    ),
    ("Wired wrongly", &[("dead", "3"), ("swap", "5,6")]),
];

/// The emulator with these faults.
///
/// # Errors
/// One line: which of them cannot be read, or cannot be had by an array of so many channels.
pub(crate) fn target(words: &FaultWords, n_channels: usize) -> Result<Target, String> {
    let faults = words
        .faults()
        .map_err(|(option, why)| format!("{}: {why}", option.label))?;
    faults
        .check(n_channels)
        .map_err(|why| query::capitalised(&why))?;
    if faults.is_none() {
        return Ok(Target::Emulator);
    }
    Ok(Target::FaultyEmulator(Box::new(faults)))
}

#[cfg(test)]
mod tests {
    use eframe::egui;

    use super::*;
    use crate::bench::command::device::DeviceCommand;
    use crate::bench::{Bench, Drive};

    #[test]
    fn every_preset_is_read_whole_and_none_is_none() {
        for (name, pairs) in PRESETS {
            let words = FaultWords::of(pairs);
            assert_eq!(words.n_faults(), pairs.len(), "{name}");
            let target = target(&words, 24).unwrap();
            assert_eq!(target == Target::Emulator, pairs.is_empty(), "{name}");
        }
    }

    #[test]
    fn faults_last_until_something_else_is_connected() {
        let ctx = egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        assert_eq!(bench.transient.faults.running, None);
        let words = FaultWords::of(&[("seed", "7"), ("drop", "0.1%")]);
        bench.dispatch(DeviceCommand::StartFaults(words.clone()).into());
        assert_eq!(bench.transient.faults.running.as_ref(), Some(&words));
        let name = bench.transient.target.as_deref();
        assert_eq!(name, Some("Emulator with faults"));
        bench.dispatch(DeviceCommand::ConnectEmulator.into());
        assert_eq!(bench.transient.faults.running, Some(FaultWords::default()));
        bench.dispatch(DeviceCommand::Disconnect.into());
        assert_eq!(bench.transient.faults.running, None);
    }

    #[test]
    fn what_cannot_be_had_is_a_notice_and_nothing_is_started() {
        let ctx = egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        for (option, text, told) in [
            ("dead", "24", "Channel 24: this array has channels 0 to 23"),
            ("drop", "often", "Drop: \"often\" is no share"),
        ] {
            let words = FaultWords::of(&[(option, text)]);
            bench.dispatch(DeviceCommand::StartFaults(words).into());
            let shown = bench.transient.notices.shown();
            let last = &shown.last().unwrap().text;
            assert!(last.starts_with(told), "{last}");
            assert_eq!(bench.transient.faults.running, None);
        }
    }
}
