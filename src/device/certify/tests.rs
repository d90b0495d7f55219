//! A right device passes, whatever its phase and its link; each defect is found.

use std::sync::atomic::AtomicBool;

use super::*;
use crate::device::{DeviceModel, FirmwareLie};
use crate::wire::{Faults, FaultWords, WiredDevice};

/// Tries a device in virtual time, `at_us` after its boot.
fn tried(model: DeviceModel, faults: &Faults, extent: Extent, at_us: u64) -> Certificate {
    let device = WiredDevice::new(model, faults);
    let mut line = VirtualLine::new(device, at_us);
    let nonce = 0x1357_0001 + u32::try_from(at_us).unwrap();
    let certificate = certify(&mut line, Trial { extent, nonce }, &AtomicBool::new(false), &mut |_| {});
    assert!(line.now_us() - at_us < 60_000_000, "{} ms", line.now_us() / 1000);
    let is_at_rest = !line.device().state().is_live();
    assert!(is_at_rest || !certificate.passed(), "it ends at rest");
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
        for seed in 1..9 {
            let faults = faults(options, seed);
            let certificate = tried(DeviceModel::default(), &faults, Extent::Full, 9_900 + seed);
            assert!(certificate.passed(), "{options:?}, seed {seed}:\n{certificate}");
        }
    }
}

/// Lies that nobody at the other end of the cable can tell from a right device, and why.
const UNSEEN: &[(&str, &str)] = &[];

#[test]
fn a_device_with_one_lie_does_not_pass() {
    let mut unseen = Vec::new();
    for lie in FirmwareLie::examples() {
        let faults = Faults { lies: vec![lie], ..Faults::default() };
        let certificate = tried(DeviceModel::default(), &faults, Extent::Full, 12_345);
        if certificate.passed() {
            unseen.push(format!("{lie}: {}", lie.help()));
        } else {
            let first = certificate.first_trouble().unwrap_or_default();
            eprintln!("{lie}: {first}");
        }
    }
    for lie in &unseen { eprintln!("UNSEEN {lie}"); }
    assert!(unseen.is_empty(), "{}", unseen.join("\n"));
}
