//! `selvedge bridge certify` against `selvedge bridge emulate` over a real terminal, in real time.
//!
//! A busy machine may leave checks untested; nothing that a right device does may count as failed.
#![cfg(unix)]

use selvedge_device::{Certificate, CheckOutcome};

use crate::bridge_device::Device;
use crate::program::Lab;

const CERTIFY: [&str; 6] = ["bridge", "certify", "--port", "array", "--out", "reports"];
/// Tries on a machine that is busy with something else.
const N_TRIES: usize = 5;

/// The certificate in the lab's folder.
fn certificate(lab: &Lab) -> Certificate {
    let folder = std::fs::read_dir(lab.path("reports")).unwrap();
    let paths: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
    let json = paths
        .iter()
        .find(|path| path.extension().is_some_and(|end| end == "json"));
    let json = json.unwrap();
    assert!(json.with_extension("md").exists(), "{paths:?}");
    Certificate::from_json(&std::fs::read_to_string(json).unwrap(), json).unwrap()
}

fn failed(certificate: &Certificate) -> Vec<&str> {
    let checks = certificate.checks.iter();
    let failed = checks.filter(|check| check.outcome == CheckOutcome::Failed);
    failed.map(|check| check.name.as_str()).collect()
}

#[test]
fn a_right_device_is_certified_and_its_report_names_it() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &[]);
    let passed = |_: &usize| -> bool {
        let outcome = lab.run(&CERTIFY);
        let certificate = certificate(&lab);
        assert!(failed(&certificate).is_empty(), "{outcome:?}");
        assert_eq!(outcome.code == 0, certificate.passed(), "{outcome:?}");
        certificate.passed()
    };
    assert!(
        (0..N_TRIES).any(|nth| passed(&nth)),
        "not once of {N_TRIES}"
    );
    let certificate = certificate(&lab);
    assert!(certificate.is_full);
    assert!(
        lab.path(&format!("reports/{}.md", certificate.file_stem()))
            .exists()
    );
    drop(device.end(&lab));
}

#[test]
fn a_device_with_a_defect_is_not_certified() {
    for (lie, name) in [
        ("hold-longer=40", "at every phase"),
        ("stop-keeps-armed", "how 1 in RUN"),
        ("no-comp-limit", "comp_limit"),
    ] {
        let lab = Lab::with_scene();
        let device = Device::start(&lab, &["--firmware-lie", lie]);
        let outcome = lab.run(&CERTIFY);
        assert_eq!(outcome.code, 1, "{outcome:?}");
        assert!(
            failed(&certificate(&lab)).contains(&name),
            "{lie}: {outcome:?}"
        );
        drop(device.end(&lab));
    }
}

#[test]
fn a_device_that_does_not_answer_gets_a_report_too() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &["--firmware-lie", "caps.session=+1"]);
    let outcome = lab.run(&CERTIFY);
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert_eq!(failed(&certificate(&lab)), ["HELLO"]);
    drop(device.end(&lab));
}
