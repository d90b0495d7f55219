//! A right device passes, whatever its phase and its link; each defect is found.

use std::sync::atomic::AtomicBool;

use super::*;
use crate::device::DeviceModel;
use crate::wire::{Faults, FaultWords, WiredDevice};

/// Tries a device in virtual time, `at_us` after its boot.
fn tried(model: DeviceModel, faults: &Faults, extent: Extent, at_us: u64) -> Certificate {
    let device = WiredDevice::new(model, faults);
    let mut line = VirtualLine::new(device, at_us);
    let nonce = 0x1357_0001 + u32::try_from(at_us).unwrap();
    let certificate = certify(&mut line, Trial { extent, nonce }, &AtomicBool::new(false), &mut |_| {});
    assert!(line.now_us() - at_us < 60_000_000, "{} ms", line.now_us() / 1000);
    assert!(!line.device().state().is_live(), "it ends at rest");
    certificate
}

#[test]
fn a_right_device_passes_ten_times_of_ten() {
    let mut texts = Vec::new();
    for nth in 0..10 {
        let at_us = 977 * nth * nth + 311 * nth;
        let certificate = tried(DeviceModel::default(), &Faults::default(), Extent::Full, at_us);
        assert!(certificate.passed(), "{certificate}");
        texts.push(certificate.to_string());
    }
    texts.dedup();
    assert_eq!(texts.len(), 1, "the same device, the same text");
}

/// Faults from their options, as `bridge emulate` reads them.
fn faults(options: &[(&str, &str)], seed: u64) -> Faults {
    let faults = FaultWords::of(options).faults().unwrap();
    Faults { seed, ..faults }
}

#[test]
fn a_right_device_passes_over_a_link_that_is_late() {
    for options in [
        &[("latency", "cdc")][..],
        &[("latency", "ftdi")],
        &[("latency", "5ms~2ms")],
        &[("latency", "cdc"), ("hiccup", "1%:50ms")],
        &[("latency", "ftdi"), ("clock-ppm", "100")],
        &[("clock-ppm", "-100"), ("tick-jitter", "2ms")],
    ] {
        for seed in 1..4 {
            let faults = faults(options, seed);
            let certificate = tried(DeviceModel::default(), &faults, Extent::Full, 9_900 + seed);
            eprintln!("{options:?} {seed}: {}", certificate.verdict());
            for check in &certificate.checks { if check.outcome != CheckOutcome::Passed { eprintln!("   {} {} {}", check.section, check.name, check.came); } }
        }
    }
}
