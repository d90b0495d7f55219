//! `selvedge play --samples` against `selvedge bridge emulate --modes a,b` over a real terminal.
//!
//! What is compared is the device's counts, by its own clock; never wall time.
#![cfg(unix)]

use std::process::Stdio;

use crate::bridge_device::{Device, rest_without_its_host, wait_for_log};
use crate::bridge_end_to_end::undisturbed;
use crate::program::{Lab, Outcome, Rows};

const PLAY: [&str; 11] = [
    "play",
    "a.scene.toml",
    "--path",
    "a.csv",
    "--port",
    "array",
    "--samples",
    "--log",
    "host.csv",
    "--session-log",
    "link.csv",
];
const ABLE: [&str; 4] = ["--modes", "a,b,ident", "--max-body", "1024"];
const PER_TICK: u64 = 200;

/// What the device counted of samples, tick by tick.
fn counted(device: &Rows, what: &str) -> Vec<u64> {
    let value = |event: &str| {
        let mut words = event.strip_prefix("samples ")?.split(' ');
        let word = words.find_map(|word| word.strip_prefix(what)?.strip_prefix('='));
        Some(word.unwrap().parse().unwrap())
    };
    device.text("event").into_iter().filter_map(value).collect()
}

fn sum(device: &Rows, what: &str) -> u64 {
    counted(device, what).iter().sum()
}

/// Plays to the end on a device of its own until no sample was late or missing, and no tick left
/// out: a busy machine may need another attempt.
fn without_a_gap(lab: &Lab) -> (Outcome, Rows, Rows) {
    undisturbed(|| {
        let device = Device::start(lab, &ABLE);
        let outcome = lab.run(&PLAY);
        let host = Rows::read(&lab.path("host.csv"));
        let device = device.end(lab);
        let is_whole = outcome.out.contains("missed 0, late 0, underruns 0")
            && sum(&device, "received") == PER_TICK * u64::try_from(host.len()).unwrap();
        is_whole.then_some((outcome, host, device))
    })
}

#[test]
fn two_seconds_of_samples_arrive_whole_and_none_is_missing_by_the_devices_clock() {
    let lab = Lab::with_scene();
    lab.write("a.csv", "t_s,x_mm,y_mm\n0,15,40\n1,85,42\n2,15,30\n");
    let (played, host, device) = without_a_gap(&lab);
    assert_eq!(played.code, 0, "{played:?}");
    let n_ticks = u64::try_from(host.len()).unwrap();
    assert!(
        (79..=81).contains(&n_ticks),
        "{n_ticks} ticks of a path of 2 s"
    );
    // A body of 1024 bytes holds 21 samples of 24 channels: ten packets a tick.
    let said = format!(
        "8000 Hz in {} packets of at most 21, ring 75 ms here and 100 ms in the device",
        10 * n_ticks
    );
    assert!(played.out.contains(&said), "{}", played.out);
    assert_eq!(sum(&device, "packets"), 10 * n_ticks);
    for what in ["late", "missing", "clipped"] {
        assert_eq!(sum(&device, what), 0, "{what}");
    }
    assert!(!device.text("event").contains(&"frame"), "no amplitudes");

    // What sounds keeps within what was asked for, and comes near it.
    let loudest = |rows: &Rows, of: fn(&Rows, usize) -> f64| {
        (0..rows.len()).map(|row| of(rows, row)).fold(0.0, f64::max)
    };
    let asked = loudest(&host, |rows, row| {
        rows.numbers("code40_7")[row] + rows.numbers("code320_7")[row]
    });
    let peaks = device.text("a40_7");
    let peaks = peaks.iter().filter_map(|cell| cell.parse::<f64>().ok());
    let sounded = peaks.fold(0.0, f64::max);
    assert!(
        sounded <= asked && sounded > 0.8 * asked,
        "{sounded} of {asked}"
    );

    let link = lab.read("link.csv");
    for words in [
        ",cfg,\"mode=1 ",
        ",samples,\"rate_hz=8000 per_packet=21 ring_ms=75 device_ring_ms=100\"",
        ",delays,\"source=ring\"",
        ",stopped,",
    ] {
        assert!(link.contains(words), "{words}: {link}");
    }
    let last = device.len() - 1;
    let end = (device.text("state")[last], device.text("amp_sum")[last]);
    assert_eq!(end, ("READY", "0"), "the device's last word");
}

#[test]
fn when_the_host_is_killed_samples_end_within_100_ms_of_the_last_ones() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &ABLE);
    let host = lab
        .command(&[&PLAY[..], &["--loop"]].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_log(&lab, |log| log.matches(",samples packets=").count() >= 40);
    rest_without_its_host(&lab, device, host);
}

#[test]
fn a_device_without_mode_b_is_refused_in_one_line_and_never_armed() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &[]);
    let outcome = lab.run(&PLAY);
    assert_eq!(outcome.code, 2, "{outcome:?}");
    let line = outcome.one_line();
    assert!(line.starts_with("array: "), "{line}");
    assert!(
        line.contains("no mode B") && line.contains("without --samples"),
        "{line}"
    );
    let device = device.end(&lab);
    assert!(!device.text("state").contains(&"ARMED"));
}
