//! The core in C against our own device: the same bytes at the same times, the same answers.

use std::collections::BTreeMap;

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

/// How often our device was in each state when it answered.
type Seen = BTreeMap<String, usize>;

/// Runs random scripts on both up to the first difference, which it tells with the lines that led
/// to it.
pub(crate) fn first_difference(
    theirs: &mut CCore,
    model: &DeviceModel,
    n_scripts: u64,
) -> Result<Seen, String> {
    let mut ours = OurCore::new(model.clone());
    let mut seen = Seen::new();
    for seed in 0..n_scripts {
        let lines = Script::lines(seed, model.n_channels(), 250);
        for (index, line) in lines.iter().enumerate() {
            let (c, rust) = (theirs.obey(line), ours.obey(line));
            if c != rust {
                let before = lines[index.saturating_sub(12)..=index].join("\n");
                return Err(format!(
                    "script {seed}, line {index}:\n{before}\nin C: {c}\nours: {rust}"
                ));
            }
            if line != "codes" {
                let state = rust.split(' ').next().unwrap_or_default().to_owned();
                *seen.entry(state).or_insert(0) += 1;
            }
        }
    }
    Ok(seen)
}

fn compare(defines: &[&str], model: &DeviceModel, n_scripts: u64) {
    let Some((_lab, mut theirs)) = started("the core in C against our own device", defines) else {
        return;
    };
    let seen = match first_difference(&mut theirs, model, n_scripts) {
        Ok(seen) => seen,
        Err(difference) => panic!("{difference}"),
    };
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
    let codes = numbers(&core.obey("codes"));
    assert!(codes.iter().any(|code| *code > 0.0), "the stream runs");
    // A little more than a tick, within the time of hold.
    let mut samples = Vec::new();
    for ms in 26..=60 {
        samples.extend(numbers(&core.obey("samples 8")));
        core.obey(&format!("at {ms}000"));
    }
    assert_eq!(samples.len(), 280 * 24);
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

/// The main loop died and the sample interrupt goes on: hold, ramp and lease are dead with the
/// loop, so the samples themselves fall silent.
#[test]
fn samples_fall_silent_when_no_steps_run_and_sound_again_when_they_do() {
    let Some((_lab, mut core)) = started("samples without steps in C", &[]) else {
        return;
    };
    run_stream(&mut core);
    let is_silent = |samples: &str| numbers(samples).iter().all(|sample| *sample == 2048.0);
    let samples = numbers(&core.obey("samples 400"));
    let last = samples.iter().rposition(|sample| *sample != 2048.0);
    assert_eq!(
        last.unwrap() / 24,
        159,
        "20 ms of samples after the last step"
    );

    // Making up for lost steps is not yet running: the rules are applied, nothing sounds.
    for ms in 26..=40 {
        let answer = core.obey(&format!("at {ms}000"));
        assert!(
            answer.starts_with("RUN 0 "),
            "STATUS says what is felt: {answer}"
        );
    }
    assert!(is_silent(&core.obey("samples 8")));
    assert_eq!(core.obey("at 41000"), "RUN 414000 -", "in time again");
    assert!(!is_silent(&core.obey("samples 8")));

    // Silent again, and the rules say no output when the steps come back: no sound either.
    core.obey("samples 400");
    for ms in 42..=140 {
        core.obey(&format!("at {ms}000"));
        assert!(is_silent(&core.obey("samples 8")) || ms < 103, "at {ms} ms");
    }
    assert_eq!(
        core.obey("at 141000"),
        "READY 0 -",
        "hold and ramp are over"
    );
}

/// A loop that runs late by less than that is made up for and not heard.
#[test]
fn samples_go_on_through_a_loop_that_is_late() {
    let Some((_lab, mut core)) = started("late steps in C", &[]) else {
        return;
    };
    run_stream(&mut core);
    core.obey("samples 152");
    core.obey("at 44000");
    let samples = numbers(&core.obey("samples 8"));
    assert!(samples.iter().any(|sample| *sample != 2048.0), "19 ms late");
}

fn numbers(text: &str) -> Vec<f64> {
    let parse = |number: &str| number.parse().unwrap();
    text.split_whitespace().map(parse).collect()
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
