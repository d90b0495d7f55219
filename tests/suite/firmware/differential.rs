//! The core in C against our own device: the same bytes at the same times, the same answers.

use selvedge_device::{Caps, DeviceModel, Packet, kind};

use super::reference::{CCore, Obedient as _, OurCore, hex};
use super::script::Script;
use super::{tools, vectors};
use crate::program::Lab;

/// The core in C, built and started in a folder of its own; `None`, and said so, where nothing
/// builds it.
fn started(what: &str, defines: &[&str]) -> Option<(Lab, CCore)> {
    tools::has("cc", what).then(|| {
        let lab = Lab::new();
        let program = lab.path("hbp_host");
        tools::build_host(&program, defines);
        (lab, CCore::start(&program))
    })
}

/// Plays the golden session to where frames are felt.
fn run_stream(core: &mut CCore) {
    let lines = vectors::read().session("stream");
    let end = lines.iter().position(|line| line.starts_with("state RUN"));
    for line in &lines[..end.unwrap()] {
        if line.starts_with("at ") || line.starts_with("in ") {
            core.obey(line);
        }
    }
}

/// Runs random scripts on both; the first difference fails with the lines that led to it.
fn compare(defines: &[&str], model: &DeviceModel, n_scripts: u64) {
    let Some((_lab, mut theirs)) = started("the core in C against our own device", defines) else {
        return;
    };
    let mut ours = OurCore::new(model.clone());
    let mut seen = std::collections::BTreeMap::new();
    for seed in 0..n_scripts {
        let lines = Script::lines(seed, model.n_channels(), 250);
        for (index, line) in lines.iter().enumerate() {
            let (c, rust) = (theirs.obey(line), ours.obey(line));
            let before = &lines[index.saturating_sub(12)..=index];
            assert_eq!(
                c,
                rust,
                "script {seed}, line {index} (C left, ours right):\n{}",
                before.join("\n")
            );
            if line != "codes" {
                let state = rust.split(' ').next().unwrap_or_default().to_owned();
                *seen.entry(state).or_insert(0) += 1;
            }
        }
    }
    for state in ["IDLE", "READY", "ARMED", "RUN", "HOLD", "RAMP", "FAULT"] {
        let n_answers = seen.get(state).copied().unwrap_or(0);
        assert!(
            n_answers > 100,
            "the scripts hardly reach {state}: {seen:?}"
        );
    }
}

#[test]
fn the_core_in_c_answers_as_our_device_does() {
    compare(&[], &DeviceModel::default(), 250);
}

#[test]
fn another_array_in_c_answers_as_our_device_does() {
    let defines = [
        "HBP_ROWS=10",
        "HBP_COLS=10",
        "HBP_PITCH_UM=1000",
        "HBP_QUEUE=2",
        "HBP_MAX_BODY=412",
        "HBP_SLEW_MAX=5000",
        "HBP_LIMIT_40=50000",
        "HBP_LIMIT_320=40000",
        "HBP_HV_MAX_DV=300",
        "HBP_IDENT=0",
    ];
    let model = DeviceModel {
        rows: 10,
        cols: 10,
        pitch_um: 1000,
        queue: 2,
        max_body: 412,
        slew_max: 5000,
        comp_limit: [50_000, 40_000],
        hv_max_dv: 300,
        modes: Caps::MODE_A,
        ..DeviceModel::default()
    };
    compare(&defines, &model, 80);
}

/// Every cut and every flipped bit of every golden packet: neither device takes one, and both count
/// the same.
#[test]
fn no_damaged_vector_is_taken_by_the_core_in_c() {
    let Some((_lab, mut theirs)) = started("damaged vectors against the core in C", &[]) else {
        return;
    };
    let mut ours = OurCore::new(DeviceModel::default());
    let mut n_damaged = 0;
    for packet in vectors::read().packets {
        let damaged = vectors::damaged(&packet.wire);
        n_damaged += damaged.len();
        for wire in damaged {
            let line = format!("in {}", hex(&wire));
            let answer = theirs.obey(&line);
            assert_eq!(answer, "IDLE 0 -", "{}: {line}", packet.name);
            assert_eq!(ours.obey(&line), answer, "{}", packet.name);
        }
    }
    assert!(n_damaged > 5000, "{n_damaged}");
    // A session shows the counters.
    let hello = [b"HBP1".as_slice(), &[7, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0]].concat();
    let hello = Packet::encode(kind::HELLO, 1, &hello).unwrap();
    for line in [format!("in {}", hex(hello.as_bytes())), "at 25000".into()] {
        assert_eq!(theirs.obey(&line), ours.obey(&line));
    }
}

/// One tick of samples is the sum of two sines in exact integers, both at phase 0 when it begins.
#[test]
fn the_samples_are_sines_to_the_last_bit() {
    let Some((_lab, mut core)) = started("the sample generator in C", &[]) else {
        return;
    };
    run_stream(&mut core);
    let numbers = |text: &str| -> Vec<f64> {
        let parse = |number: &str| number.parse().unwrap();
        text.split_whitespace().map(parse).collect()
    };
    let codes = numbers(&core.obey("codes"));
    assert!(codes.iter().any(|code| *code > 0.0), "the stream runs");
    let samples = numbers(&core.obey("samples 400"));
    assert_eq!(samples.len(), 400 * 24);
    for (index, sample) in samples.iter().enumerate() {
        let (time, channel) = (index / 24 % 200, index % 24);
        let sine = |periods: usize| {
            let turns = (periods * time % 200) as f64 / 200.0;
            // The core's table: peak 2047 · 16, rounded half away from zero.
            (32_752.0 * (std::f64::consts::TAU * turns).sin()).round()
        };
        let sum = codes[2 * channel] * sine(1) + codes[2 * channel + 1] * sine(8);
        let wanted = 2048.0 + (sum / f64::from(1 << 20) + 0.5).floor();
        assert_eq!(*sample, wanted, "sample {time}, channel {channel}");
    }
}

#[test]
fn a_lost_link_ramps_a_running_core_down_and_ends_a_resting_one() {
    let Some((_lab, mut core)) = started("a lost link on the core in C", &[]) else {
        return;
    };
    run_stream(&mut core);
    let state = |answer: &str| answer.split(' ').next().unwrap_or_default().to_owned();
    let now_us: u64 = 25_000;
    assert_eq!(state(&core.obey("lost")), "RAMP");
    let first = core.obey(&format!("at {}", now_us + 1000));
    assert_eq!(first, "RAMP 403650 -", "39 of 40 steps");
    let end = core.obey(&format!("at {}", now_us + 40_000));
    assert!(end.starts_with("IDLE 0 "), "{end}");
    assert_eq!(core.obey("at 500000"), "IDLE 0 -", "no session, no STATUS");
}
