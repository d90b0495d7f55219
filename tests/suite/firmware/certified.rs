//! The certificate of a device over the core in C, in virtual time: the core passes whatever its
//! phase, and each of its defects is found.

use std::collections::BTreeMap;
use std::io;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use selvedge_device::{Certificate, CheckOutcome, Extent, Line, Trial};

use super::reference::{CCore, Obedient as _, bytes, hex};
use super::{defects, tools};

/// The core in C at the end of a line; waiting takes none of our time.
struct CoreLine {
    core: CCore,
    now_us: u64,
    said: Vec<u8>,
}

impl CoreLine {
    /// The core with a defect (0: none), `at_us` after its boot.
    fn new(defect: usize, at_us: u64) -> Self {
        let mut line = Self {
            core: CCore::start(&tools::host_with_defect(defect)),
            now_us: 0,
            said: Vec::new(),
        };
        line.advance(at_us);
        line
    }

    /// To this moment, or to the first at which the core says something.
    fn advance(&mut self, to_us: u64) {
        let answer = self.core.obey(&format!("wait {to_us}"));
        let (time, _) = answer.split_once(' ').unwrap();
        self.now_us = time.parse().unwrap();
        self.take(&answer);
    }

    /// The bytes at the end of an answer.
    fn take(&mut self, answer: &str) {
        let (_, said) = answer.rsplit_once(' ').unwrap();
        self.said.extend(bytes(said));
    }
}

impl Line for CoreLine {
    fn now_us(&self) -> u64 {
        self.now_us
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let answer = self.core.obey(&format!("in {}", hex(bytes)));
        self.take(&answer);
        Ok(())
    }

    fn read(&mut self, until_us: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
        if self.said.is_empty() {
            self.advance(until_us.max(self.now_us));
        }
        bytes.append(&mut self.said);
        Ok(())
    }
}

fn certificate(defect: usize, at_us: u64) -> Certificate {
    let mut line = CoreLine::new(defect, at_us);
    let trial = Trial {
        extent: Extent::Full,
        nonce: 0x1234_0001 + u32::try_from(at_us).unwrap(),
    };
    let began_us = line.now_us();
    let certificate = Certificate::of(&mut line, trial, &AtomicBool::new(false), &mut |_| {});
    let took_us = line.now_us() - began_us;
    assert!(took_us <= 60_000_000, "{took_us} us for defect {defect}");
    certificate
}

#[test]
fn the_core_in_c_is_certified_ten_times_of_ten() {
    if !tools::has("cc", "the certificate of the core in C") {
        return;
    }
    for run in 0..10 {
        let certificate = certificate(0, 3_217 * run);
        assert!(certificate.passed(), "run {run}:\n{certificate}");
    }
}

#[test]
fn every_defect_of_the_core_in_c_fails_its_certificate() {
    if !tools::has("cc", "the certificates of defective cores in C") {
        return;
    }
    let names = defects::names();
    let passed = Mutex::new(BTreeMap::new());
    std::thread::scope(|scope| {
        for half in [0, 1] {
            let (names, passed) = (&names, &passed);
            scope.spawn(move || {
                for defect in (1..=names.len()).filter(|defect| defect % 2 == half) {
                    let certificate = certificate(defect, 12_345);
                    let failed = |outcome| outcome == CheckOutcome::Failed;
                    if !certificate.checks.iter().any(|check| failed(check.outcome)) {
                        let mut passed = passed.lock().unwrap_or_else(PoisonError::into_inner);
                        passed.insert(defect, names[defect - 1].clone());
                    }
                }
            });
        }
    });
    let passed = passed.into_inner().unwrap_or_else(PoisonError::into_inner);
    assert!(passed.is_empty(), "not found: {passed:?}");
}
