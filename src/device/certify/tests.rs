//! A right device passes, whatever its phase and its link; each defect is found.

use std::sync::atomic::AtomicBool;

use super::*;
use crate::device::{DeviceModel, FirmwareLie};
use crate::wire::{FaultWords, Faults, WiredDevice};

/// Tries a device in virtual time, `at_us` after its boot.
fn tried(model: DeviceModel, faults: &Faults, extent: Extent, at_us: u64) -> Certificate {
    let device = WiredDevice::new(model, faults);
    let mut line = VirtualLine::new(device, at_us);
    let nonce = 0x1357_0001 + u32::try_from(at_us).unwrap();
    let certificate = Certificate::of(
        &mut line,
        Trial { extent, nonce },
        &AtomicBool::new(false),
        &mut |_| {},
    );
    assert!(
        line.now_us() - at_us < 60_000_000,
        "{} ms",
        line.now_us() / 1000
    );
    let is_at_rest = !line.device().core().state().is_live();
    assert!(is_at_rest || !certificate.passed(), "it ends at rest");
    certificate
}

#[test]
fn a_right_device_passes_ten_times_of_ten() {
    let mut texts = Vec::new();
    for nth in 0..10 {
        let at_us = 977 * nth * nth + 311 * nth;
        let certificate = tried(
            DeviceModel::default(),
            &Faults::default(),
            Extent::Full,
            at_us,
        );
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
        for seed in 1..17 {
            let faults = faults(options, seed);
            let certificate = tried(DeviceModel::default(), &faults, Extent::Full, 9_900 + seed);
            assert!(
                certificate.passed(),
                "{options:?}, seed {seed}:\n{certificate}"
            );
        }
    }
}

/// Lies that nobody at the other end of the cable can tell from a right device, and why. A name
/// that ends in a dot or a hyphen stands for all that begin so.
const UNSEEN: &[(&str, &str)] = &[
    ("caps.pitch-um", "a claim about the hardware"),
    ("caps.dac-bits", "a claim about the hardware"),
    (
        "caps.fs-mv",
        "a claim about the hardware; the host scales by it and the profile bounds it",
    ),
    ("caps.sample-hz", "a claim about the hardware"),
    ("caps.uid", "a claim that nothing contradicts"),
    ("caps.firmware", "a claim that nothing contradicts"),
    (
        "caps.name-length",
        "a shorter name with trailing bytes, which v1.x may append",
    ),
    ("caps.extra", "v1.x may append"),
    ("cfg.extra", "v1.x may append"),
    ("ack.extra", "v1.x may append"),
    ("status.extra", "v1.x may append"),
    ("pong.extra", "v1.x may append"),
    (
        "status.underrun",
        "counters run from boot, so that only differences are judged",
    ),
    (
        "status.late",
        "counters run from boot, so that only differences are judged",
    ),
    (
        "status.dup",
        "counters run from boot, so that only differences are judged",
    ),
    (
        "status.bad",
        "counters run from boot, so that only differences are judged",
    ),
    (
        "status.clipped",
        "counters run from boot, so that only differences are judged",
    ),
    ("status.i-ma", "a measurement that nothing predicts"),
    ("banner", "whatever comes before CAPS is ignored"),
    (
        "hv-higher",
        "1 V of 60 is within what a measurement may be off",
    ),
    (
        "armed-at-start",
        "it ends with the first HELLO, and no boot can be asked for",
    ),
    ("interpolates-unasked", "STATUS shows starts of ticks only"),
    (
        "ident-low-band",
        "amp_sum does not tell the band of an IDENT",
    ),
    ("hang-up-ignored", "a pulled cable has nobody at its end"),
    ("fault.", "no fault can be caused from outside"),
    ("fault-", "no fault can be caused from outside"),
    ("clear-", "no fault can be caused from outside"),
    ("config-in-fault", "no fault can be caused from outside"),
    ("arm-in-fault", "no fault can be caused from outside"),
    ("stop-leaves-fault", "no fault can be caused from outside"),
    ("hello-clears-fault", "no fault can be caused from outside"),
];

/// Whether a lie is on the list.
fn may_be_unseen(name: &str) -> bool {
    UNSEEN.iter().any(|(listed, _)| {
        let is_group = listed.ends_with(['.', '-']) && name.starts_with(listed);
        is_group || name == *listed
    })
}

/// A device whose limits leave room for wishes above them.
fn limited() -> DeviceModel {
    DeviceModel {
        slew_max: 5000,
        comp_limit: [50_000, 40_000],
        queue: 2,
        ..DeviceModel::default()
    }
}

#[test]
fn right_devices_of_other_makes_pass() {
    let large = DeviceModel {
        rows: 10,
        cols: 10,
        max_body: 412,
        ..DeviceModel::default()
    };
    let plain = DeviceModel {
        modes: crate::message::Caps::MODE_A,
        queue: 1,
        ..limited()
    };
    for model in [limited(), large, plain] {
        let certificate = tried(model, &Faults::default(), Extent::Full, 4321);
        let troubles = certificate
            .checks
            .iter()
            .filter(|check| match check.outcome {
                CheckOutcome::Passed => false,
                // A queue of one holds nothing for later.
                CheckOutcome::NotTested => check.name != "clipped at reception",
                CheckOutcome::Failed => true,
            });
        assert_eq!(troubles.count(), 0, "{certificate}");
    }
}

#[test]
fn every_device_with_one_lie_is_found_but_those_that_nobody_can_tell() {
    let lies: Vec<FirmwareLie> = FirmwareLie::examples().collect();
    assert!(lies.len() > 200, "{} lies", lies.len());
    let mut unseen = Vec::new();
    for lie in lies {
        let faults = Faults {
            lies: vec![lie],
            ..Faults::default()
        };
        let is_found = [DeviceModel::default(), limited()]
            .into_iter()
            .any(|model| !tried(model, &faults, Extent::Full, 12_345).passed());
        if !is_found && !may_be_unseen(lie.name()) {
            unseen.push(format!("{lie}: {}", lie.help()));
        }
    }
    assert!(unseen.is_empty(), "not found:\n{}", unseen.join("\n"));
}

#[test]
fn the_quick_half_passes_a_right_device_and_finds_coarse_lies() {
    let (model, none) = (DeviceModel::default(), Faults::default());
    let certificate = tried(model.clone(), &none, Extent::Quick, 777);
    assert!(
        certificate.passed() && !certificate.is_full,
        "{certificate}"
    );
    for text in [
        "caps.rows=5",
        "cfg.hold-ms=65000",
        "status.amp-sum=+100000",
        "status.state=255",
        "pong.token=0",
        "no-ramp",
        "ignore-stop",
        "hold-longer=40",
        "stop-keeps-armed",
        "arm-ignored",
    ] {
        let lies = vec![FirmwareLie::read(text).unwrap()];
        let faults = Faults {
            lies,
            ..Faults::default()
        };
        let certificate = tried(model.clone(), &faults, Extent::Quick, 777);
        assert!(!certificate.passed(), "{text}");
    }
}

#[test]
fn what_is_stored_is_found_again_for_that_device_and_firmware_only() {
    let folder = selvedge_scratch::ScratchFolder::new("certificates");
    let store = CertificateFolder::new(&folder);
    let certificate = tried(DeviceModel::default(), &Faults::default(), Extent::Full, 55);
    let uid = crate::array::DeviceUid::parse(&certificate.uid).unwrap();
    assert!(!store.covers(uid, [1, 0, 0]), "no folder, no certificate");
    let markdown = store.write(&certificate).unwrap();
    assert!(
        std::fs::read_to_string(markdown)
            .unwrap()
            .contains("| PONG at every phase | passed |")
    );
    assert_eq!(store.find(uid, [1, 0, 0]), Some(certificate.clone()));
    assert!(store.covers(uid, [1, 0, 0]) && !store.covers(uid, [1, 0, 1]));
    let mut failed = certificate;
    failed.checks[3].outcome = CheckOutcome::NotTested;
    store.write(&failed).unwrap();
    assert!(
        !store.covers(uid, [1, 0, 0]),
        "what was not tested has not passed"
    );
}

#[test]
fn a_flag_ends_it_and_the_last_word_is_stop() {
    let device = WiredDevice::new(DeviceModel::default(), &Faults::default());
    let mut line = Counted {
        line: VirtualLine::new(device, 0),
        last: Vec::new(),
        left: 3000,
    };
    let stop = AtomicBool::new(false);
    let trial = Trial {
        extent: Extent::Full,
        nonce: 9,
    };
    let certificate = Certificate::of(&mut line, trial, &stop, &mut |section| {
        stop.store(section == "frames", std::sync::atomic::Ordering::Release);
    });
    assert!(!certificate.passed(), "{certificate}");
    assert_eq!(
        line.last.get(2),
        Some(&crate::message::kind::STOP),
        "{:?}",
        line.last
    );
    // A panic of the line itself ends it the same way.
    line.left = 200;
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        Certificate::of(&mut line, trial, &AtomicBool::new(false), &mut |_| {})
    }));
    assert!(caught.is_err(), "the line panics");
    assert_eq!(
        line.last.get(2),
        Some(&crate::message::kind::STOP),
        "{:?}",
        line.last
    );
}

/// Keeps what was written last, and panics after so many reads.
struct Counted {
    line: VirtualLine,
    last: Vec<u8>,
    left: u32,
}

impl Line for Counted {
    fn now_us(&self) -> u64 {
        self.line.now_us()
    }

    fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.last = bytes.to_vec();
        self.line.write(bytes)
    }

    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> std::io::Result<()> {
        self.left -= 1;
        assert!(self.left > 0, "a line that panics");
        self.line.read(until_us, bytes)
    }
}
