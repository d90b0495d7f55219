//! Array profiles from the command line: identified channels, and what is played with them.
#![cfg(unix)]

use crate::bridge_device::Device;
use crate::bridge_end_to_end::undisturbed;
use crate::program::{Lab, Outcome};

const IDENTIFY: [&str; 8] = [
    "bridge",
    "identify",
    "--port",
    "array",
    "--out",
    "rig.toml",
    "--answers",
    "answers.txt",
];

/// Identifies the channels of a device of its own by the answers in the lab.
fn identify(lab: &Lab) -> Outcome {
    undisturbed(|| {
        let device = Device::start(lab, &[]);
        let outcome = lab.run(&IDENTIFY);
        device.end(lab);
        let is_disturbed = outcome.err.contains("no STATUS") || outcome.err.contains("did not");
        (!is_disturbed).then_some(outcome)
    })
}

#[test]
fn identified_channels_are_named_kept_and_played() {
    let lab = Lab::with_scene();
    // Channel 0 ↔ 1 are swapped, 5 is dead; 8 is asked twice, and 2 mistaken for 3 at first.
    let straight = (9..24).map(|channel| format!("{channel}\n"));
    let answers = format!(
        "# channel by channel\n1\n0\n3\n0,3\n4\nnone\n6\n7\nagain\n8\n{}2\n3\n",
        straight.collect::<String>()
    );
    lab.write("answers.txt", answers);
    let identified = identify(&lab);
    assert_eq!(identified.code, 0, "{identified:?}");
    assert!(
        identified.err.contains("[2, 3]"),
        "the contradiction: {}",
        identified.err
    );
    for line in [
        "contactors 0 and 1 are swapped",
        "nothing is felt of channel 5",
        "no channel drives contactor 5: switched off",
        "wiring of device 73656c76656467652d656d75 written to rig.toml",
    ] {
        assert!(identified.out.contains(line), "{line}: {}", identified.out);
    }
    let rig = std::fs::read_to_string(lab.path("rig.toml")).unwrap();
    assert!(rig.contains("channels = [1, 0, 2, 3, 4, 5, "), "{rig}");
    assert!(rig.contains("off = [5]"), "{rig}");

    let play = |array: &[&str]| {
        undisturbed(|| {
            let device = Device::start(&lab, &[]);
            let args = ["play", "a.scene.toml", "--path", "a.csv", "--port", "array"];
            let args: Vec<&str> = args.iter().chain(array).copied().collect();
            let outcome = lab.run(&args);
            let rows = device.end(&lab);
            let is_disturbed = outcome.err.contains("no frame reached it in time");
            (!is_disturbed).then_some((outcome, rows))
        })
    };
    let largest = |rows: &crate::program::Rows, channel: usize| {
        let frames = rows
            .text("event")
            .into_iter()
            .zip(rows.text(&format!("a320_{channel}")));
        let codes = frames.filter(|(event, _)| *event == "frame");
        codes
            .map(|(_, code)| code.parse::<u32>().unwrap())
            .max()
            .unwrap_or(0)
    };
    let (played, straight) = play(&[]);
    assert_eq!(played.code, 0, "{played:?}");
    let (played, wired) = play(&["--array", "rig.toml"]);
    assert_eq!(played.code, 0, "{played:?}");
    assert!(largest(&straight, 5) > 0);
    assert_eq!(largest(&wired, 5), 0, "contactor 5 is off");
    assert!(largest(&wired, 0) > 0 && largest(&wired, 1) > 0);
}

#[test]
fn answers_that_are_none_and_terminals_that_are_none_are_one_line() {
    let lab = Lab::with_scene();
    lab.write("answers.txt", "0\n1\nperhaps\n");
    let wrong = identify(&lab);
    assert_eq!(wrong.code, 2, "{wrong:?}");
    assert!(
        wrong
            .err
            .contains("answers.txt:3: \"perhaps\" is no answer"),
        "{}",
        wrong.err
    );
    lab.write("answers.txt", "0\n1\n");
    let short = identify(&lab);
    assert_eq!(short.code, 2, "{short:?}");
    assert!(
        short.err.contains("there is no answer for channel 2"),
        "{}",
        short.err
    );
    assert!(!lab.path("rig.toml").exists(), "nothing was written");

    let device = Device::start(&lab, &[]);
    let piped = lab.run(&IDENTIFY[..6]);
    device.end(&lab);
    assert_eq!(piped.code, 2, "{piped:?}");
    assert!(piped.err.contains("give --answers FILE"), "{}", piped.err);
}

#[test]
fn arrays_that_are_not_there_or_do_not_fit_are_refused_with_the_mend() {
    let lab = Lab::with_scene();
    let args = ["bridge", "test", "--port", "/dev/null", "--array", "7x7"];
    let unknown = lab.run(&args);
    assert_eq!(unknown.code, 2, "{unknown:?}");
    assert!(
        unknown.err.contains("exeter-24, 5x5, 10x10"),
        "{}",
        unknown.err
    );
    lab.write("bad.toml", "name = \"bad\"\nrows = 6\ncolour = 3\n");
    let broken = lab.run(&[
        "bridge",
        "test",
        "--port",
        "/dev/null",
        "--array",
        "bad.toml",
    ]);
    assert_eq!(broken.code, 2, "{broken:?}");
    assert!(broken.err.contains("bad.toml:3: "), "{}", broken.err);
    let device = Device::start(&lab, &[]);
    let args = [
        "play",
        "a.scene.toml",
        "--path",
        "a.csv",
        "--port",
        "array",
        "--array",
        "5x5",
    ];
    let other = lab.run(&args);
    device.end(&lab);
    assert_eq!(other.code, 2, "{other:?}");
    assert!(other.err.contains("25 contactors"), "{}", other.err);
}
