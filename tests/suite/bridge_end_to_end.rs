//! `selvedge play` against `selvedge bridge emulate` over a real terminal: two programs, two logs.
//!
//! What is compared is counters, device ticks and codes; never wall time, so that a busy machine
//! changes nothing.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use crate::bridge_device::{Device, signal};
use crate::program::{Lab, Outcome, Rows};

const PLAY: [&str; 10] = [
    "play",
    "a.scene.toml",
    "--path",
    "a.csv",
    "--port",
    "array",
    "--log",
    "host.csv",
    "--session-log",
    "link.csv",
];

/// Codes of a frame as the design defines them, worked out here anew: full scale 50 µm, limit
/// 50 µm, both components scaled by the same factor when they add up to more than full scale.
fn codes(a40_um: f32, a320_um: f32, gain: f64) -> [f64; 2] {
    let clean = |a: f32| {
        if a.is_finite() && a > 0.0 {
            f64::from(a)
        } else {
            0.0
        }
    };
    let mut a = [a40_um, a320_um].map(|a| (clean(a) * gain).min(50.0));
    let sum = a[0] / 50.0 + a[1] / 50.0;
    if sum > 1.0 {
        a = a.map(|a| a / sum);
    }
    let mut codes = a.map(|a| (65535.0 * a / 50.0 + 0.5).floor());
    if codes[0] + codes[1] > 65535.0 {
        codes[1] -= 1.0;
    }
    codes
}

/// Codes of every contactor, `[A40, A320]`.
type Codes = Vec<[f64; 2]>;

/// The device's frames in the order in which it applied them: seq, tick, codes.
fn applied(device: &Rows) -> Vec<(u64, u64, Codes)> {
    let events = device.text("event");
    let (seqs, ticks) = (device.text("seq"), device.text("tick"));
    let column = |name: &str, i: usize| device.text(&format!("{name}_{i}"));
    let columns: Vec<_> = (0..24)
        .map(|i| (column("a40", i), column("a320", i)))
        .collect();
    let code = |cell: &str| cell.parse::<f64>().unwrap();
    let codes = |row: usize| {
        columns
            .iter()
            .map(|c| [code(c.0[row]), code(c.1[row])])
            .collect()
    };
    (0..device.len())
        .filter(|&row| events[row] == "frame")
        .map(|row| {
            (
                seqs[row].parse().unwrap(),
                ticks[row].parse().unwrap(),
                codes(row),
            )
        })
        .collect()
}

/// The codes that the host's log asks for, by seq: apply tick and codes from amplitudes and gain.
fn asked(host: &Rows) -> BTreeMap<u64, (u64, Codes)> {
    let (seqs, ticks) = (host.text("seq"), host.text("apply_tick"));
    let gains = host.numbers("gain");
    let of = |name: &str| -> Vec<Vec<f32>> {
        let column = |i| host.text(&format!("{name}_{i}"));
        let numbers = |i| column(i).iter().map(|cell| cell.parse().unwrap()).collect();
        (0..24).map(numbers).collect()
    };
    let (low, high) = (of("a40_um"), of("a320_um"));
    let frame = |row: usize| {
        let wanted = (0..24)
            .map(|i| codes(low[i][row], high[i][row], gains[row]))
            .collect();
        (
            seqs[row].parse().unwrap(),
            (ticks[row].parse().unwrap(), wanted),
        )
    };
    (0..host.len()).map(frame).collect()
}

/// Every frame that the device applied is one that the host logged, at its tick and in its order.
fn check_frames(host: &Rows, device: &Rows) -> usize {
    let (asked, applied) = (asked(host), applied(device));
    let mut last_tick = 0;
    for (seq, tick, codes) in &applied {
        let (apply_tick, wanted) = asked
            .get(seq)
            .unwrap_or_else(|| panic!("frame {seq} is logged"));
        assert_eq!(codes, wanted, "codes of frame {seq}");
        // A busy machine may deliver a frame late: the device then applies it at its next tick.
        assert!(
            tick >= apply_tick,
            "frame {seq} at {tick} instead of {apply_tick}"
        );
        assert!(*tick > last_tick, "in apply-tick order");
        last_tick = *tick;
    }
    let logged: Vec<String> = host
        .text("code40_7")
        .iter()
        .map(|&c| c.to_owned())
        .collect();
    let wanted = asked.values().map(|(_, codes)| codes[7][0].to_string());
    assert_eq!(
        logged,
        wanted.collect::<Vec<_>>(),
        "the host logs the codes that it sent"
    );
    applied.len()
}

/// Plays to the end on a device of its own. A machine so busy that the program sleeps for a tenth
/// of a second lets the device disarm itself, as it should: then it is tried again.
fn play_to_the_end(lab: &Lab, args: &[&str]) -> (Outcome, Rows, Rows) {
    undisturbed(|| {
        let device = Device::start(lab, &[]);
        let outcome = lab.run(args);
        let rows = (Rows::read(&lab.path("host.csv")), device.end(lab));
        is_undisturbed(&outcome).then_some((outcome, rows.0, rows.1))
    })
}

fn is_undisturbed(outcome: &Outcome) -> bool {
    let words = ["no frame reached it in time", "the host fell silent"];
    !words.iter().any(|words| outcome.err.contains(words))
}

pub(crate) fn undisturbed<T>(attempt: impl Fn() -> Option<T>) -> T {
    let found = (0..5).find_map(|_| attempt());
    found.expect("five attempts disturbed by a machine that is too busy")
}

/// The device ends at rest: the last that its log says.
fn check_rest(device: &Rows) {
    let last = device.len() - 1;
    assert_eq!(
        (device.text("state")[last], device.text("amp_sum")[last]),
        ("READY", "0"),
        "the device's last word"
    );
}

#[test]
fn every_frame_that_the_device_applies_has_the_codes_of_the_logged_amplitudes() {
    let lab = Lab::with_scene();
    // Loud enough that limits and the sum guard bite, also while the soft start still rises.
    lab.add_textile("flat", |x_mm| {
        300.0 * (x_mm * 2.4).sin() + 90.0 * (x_mm * 20.0).sin()
    });
    lab.write(
        "a.csv",
        "t_s,x_mm,y_mm,angle_deg\n0,15,40,0\n0.7,85,42,10\n1.5,15,30,40\n",
    );
    let (played, host, device) = play_to_the_end(&lab, &PLAY);
    assert_eq!(played.code, 0, "{played:?}");
    assert!(played.out.contains("61 frames"), "{}", played.out);
    assert!(
        played.out.contains("due to FRAME      median"),
        "{}",
        played.out
    );
    let link = std::fs::read_to_string(lab.path("link.csv")).unwrap();
    for event in ["hello", "caps", "cfg", "armed", "stop", "stopped"] {
        assert!(link.contains(&format!(",{event},")), "{event}: {link}");
    }
    let replayed = lab.run(&["bridge", "replay", "link.csv", "--out", "felt.csv"]);
    assert_eq!(replayed.code, 0, "{replayed:?}");
    assert!(replayed.out.contains("agrees in"), "{}", replayed.out);
    assert!(
        link.contains("scene_sha256=") && link.contains("path_sha256="),
        "{link}"
    );
    let felt = Rows::read(&lab.path("felt.csv")).numbers("peak_um_0");
    // A link without frames behind one with them, and a line that was cut.
    let hashed = link.replacen("program=", "frames=hashes program=", 1);
    let cut = &link[..link.len() - 30];
    lab.write("both.csv", format!("{link}{hashed}{cut}"));
    let both = lab.run(&["bridge", "replay", "both.csv", "--out", "both-felt.csv"]);
    // A run that the machine disturbed stands in the log too.
    let n_links = link.matches("program=").count();
    assert_eq!(both.out.matches("agrees in").count(), 3 * n_links);
    for (name, content) in [("nonsense.csv", "a,b\n1,2\n"), ("empty.csv", "")] {
        lab.write(name, content);
        assert!(lab.refuse(&["bridge", "replay", name]).contains(name));
    }
    assert!(felt.iter().copied().fold(0.0, f64::max) > 5.0, "{felt:?}");
    let n_applied = check_frames(&host, &device);
    assert_eq!(host.len(), 61, "one frame a tick of the path");
    assert!(n_applied >= 40, "{n_applied} of 61 frames applied");
    let gains = host.numbers("gain");
    // A busy machine misses a tick now and then; the gain rises by one step a tick all the same.
    let step = |gain: f64| (gain * 20.0).round() / 20.0;
    assert!(gains.iter().all(|gain| step(*gain) == *gain), "{gains:?}");
    assert!(gains.windows(2).all(|pair| pair[0] <= pair[1]), "{gains:?}");
    assert_eq!((gains[0], gains[30]), (0.05, 1.0), "over 20 ticks");
    assert!(gains[9] >= 0.5 && gains[1] < 1.0, "step by step: {gains:?}");
    let sums = (0..host.len()).map(|row| {
        let code = |name: &str| host.numbers(name)[row];
        code("code40_0") + code("code320_0")
    });
    assert!(sums.fold(0.0, f64::max) >= 65534.0, "the limits were met");
    check_rest(&device);
}

#[test]
fn what_is_played_is_what_is_rendered() {
    let lab = Lab::with_scene();
    // Live, `auto` counts on a minute and tabulates; of a path it knows how short it is.
    let by_table = ["--method", "table"];
    let (played, host, _) = play_to_the_end(&lab, &[&PLAY[..], &by_table].concat());
    assert_eq!(played.code, 0, "{played:?}");
    let render = ["render", "a.scene.toml", "--path", "a.csv"];
    let rendered = Rows::parse(&lab.print(&[&render[..], &by_table].concat()));
    let a320_um = rendered.text("a320_um");
    for contactor in 0..24 {
        let played: Vec<f32> = (host.text(&format!("a320_um_{contactor}")).iter())
            .map(|cell| cell.parse().unwrap())
            .collect();
        let wanted = a320_um.iter().skip(contactor).step_by(24);
        let wanted: Vec<f32> = wanted.map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(played, wanted, "contactor {contactor}");
    }
}

/// Plays in a loop; `then` is done when some frames were applied.
fn play_in_a_loop(lab: &Lab, device: Device, then: impl FnOnce(&Child, Device)) -> Outcome {
    let child = lab
        .command(&[&PLAY[..], &["--loop"]].concat())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for_frames(lab, 30);
    then(&child, device);
    Outcome::of(&child.wait_with_output().unwrap())
}

#[test]
fn a_loop_ends_at_rest_when_it_is_told_to() {
    let lab = Lab::with_scene();
    let (host, device) = undisturbed(|| {
        let (back, kept) = std::sync::mpsc::sync_channel(1);
        let outcome = play_in_a_loop(&lab, Device::start(&lab, &[]), |child, device| {
            signal("TERM", child);
            back.send(device).unwrap();
        });
        let device = kept.recv().unwrap().end(&lab);
        is_undisturbed(&outcome).then(|| {
            assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{outcome:?}");
            (Rows::read(&lab.path("host.csv")), device)
        })
    });
    check_frames(&host, &device);
    assert!(
        host.len() > 21,
        "{} frames of a path with 21 ticks",
        host.len()
    );
    check_rest(&device);
}

#[test]
fn a_device_of_another_shape_is_refused() {
    let lab = Lab::with_scene();
    let scene = lab.read("a.scene.toml").replace("exeter-24", "5x5");
    lab.write("a.scene.toml", scene);
    let device = Device::start(&lab, &[]);
    let outcome = lab.run(&PLAY);
    assert_eq!(outcome.code, 1, "{outcome:?}");
    let line = outcome.one_line();
    assert!(line.starts_with("array: ") && line.contains("24"), "{line}");
    let device = device.end(&lab);
    assert!(!device.text("event").contains(&"frame"), "nothing was sent");
}

#[test]
fn lines_on_standard_input_move_the_display_and_bad_ones_are_dropped() {
    let lab = Lab::with_scene();
    let line = |n: u8| {
        let (t_s, x_mm) = (f64::from(n) * 0.01, 15.0 + f64::from(n) * 0.4);
        format!("{t_s},{x_mm},40\n")
    };
    let stream: String = (0..100).map(line).collect();
    let lines = format!("t_s,x_mm,y_mm\nno line\n{stream}");
    let args = [
        "play",
        "a.scene.toml",
        "--path",
        "-",
        "--port",
        "array",
        "--log",
        "host.csv",
    ];
    let (outcome, device) = undisturbed(|| {
        let device = Device::start(&lab, &[]);
        let outcome = lab.run_on(&args, &lines);
        let device = device.end(&lab);
        is_undisturbed(&outcome).then_some((outcome, device))
    });
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(
        outcome.one_line().contains("was dropped; write x_mm,y_mm"),
        "{outcome:?}"
    );
    assert!(
        outcome.out.contains("lines dropped     1"),
        "{}",
        outcome.out
    );
    let host = Rows::read(&lab.path("host.csv"));
    check_frames(&host, &device);
    let x_mm = host.numbers("x_mm");
    assert!(
        (x_mm[x_mm.len() - 1] - 54.6).abs() < 1e-9,
        "the last line: {x_mm:?}"
    );
    assert!(
        host.numbers("a320_um_0").iter().any(|&um| um > 0.1),
        "moving, so it is felt"
    );
}

#[test]
fn a_connected_device_passes_its_test() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &[]);
    let outcome = lab.run(&["bridge", "test", "--port", "array"]);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(
        outcome.out.contains("0 failed, 0 not tested"),
        "{}",
        outcome.out
    );
    drop(device.end(&lab));
}

/// Waits until the device has applied this many frames, as its log says, or no more will come.
fn wait_for_frames(lab: &Lab, n_frames: usize) {
    let deadline = Instant::now() + Duration::from_secs(20);
    while Instant::now() < deadline {
        let log = std::fs::read_to_string(lab.path("device.csv")).unwrap_or_default();
        if log.lines().filter(|line| line.contains(",frame,")).count() >= n_frames {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}
