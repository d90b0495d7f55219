//! Bad input of every kind: exit code 2 and one line that says what, where and how to mend it.

use crate::program::{Lab, PATH, SCENE};

/// What is replaced in the good scene, by what, the line of the error and what it says.
#[rustfmt::skip]
const SCENES: [(&str, &str, usize, &str); 20] = [
    ("name = \"Two\"\n", "", 1, "missing field `name`"),
    ("size_mm = [140.0, 80.0]", "size = [140.0, 80.0]", 3, "unknown field `size`"),
    ("size_mm = [140.0, 80.0]", "size_mm = [140.0, nan]", 3, "size_mm is [140, NaN]"),
    ("size_mm = [140.0, 80.0]", "size_mm = \"14 cm\"", 3, "invalid type"),
    ("library = \"textiles\"", "library = \"cloth\"", 2, "there is no library in cloth"),
    ("id = \"fine\"", "id = \"coarse\"", 6, "no textile \"coarse\" in textiles; it has fine, flat"),
    ("id = \"fine\"", "id = \"../fine\"", 6, "is no textile's id"),
    ("origin_mm = [10.0, 10.0]", "origin_mm = [10.0]", 7, "invalid length 1"),
    ("origin_mm = [10.0, 10.0]", "origin_mm = [10.0, inf]", 7, "origin_mm is [10, inf]"),
    ("size_mm = [60.0, 60.0]\nrot", "size_mm = [60.0, -1]\nrot", 8, "size_mm is [60, -1]"),
    ("rotation_deg = 0.0", "rotation_deg = nan", 9, "rotation_deg is NaN"),
    ("gain_db = 0.0\nlabel", "gain_db = inf\nlabel", 10, "gain_db is inf"),
    ("gain_db = 0.0\nlabel", "gain_db = nan\nlabel", 10, "gain_db is NaN"),
    ("exeter-24", "exeter-25", 19, "unknown geometry \"exeter-25\""),
    ("geometry = \"exeter-24\"", "contactors_mm = []", 19, "0 contactors"),
    ("log-gaussian", "gauss", 22, "unknown filters \"gauss\""),
    ("octaves = 2.0", "octaves = -2.0", 23, "octaves is -2"),
    ("compression = 0.0", "compression = 1.01", 27, "compression is 1.01"),
    ("[tuning]\ngain_db = 0.0", "[tuning]\ngain_db = inf", 26, "gain_db is inf"),
    ("[tuning]", "[tuning", 25, ""),
];

#[rustfmt::skip]
const PATHS: [(&str, usize, &str); 10] = [
    ("t_s,x_mm,y_mm\n", 1, "the path has no rows"),
    ("t_s,x_cm,y_cm\n0,1,1\n", 1, "unknown column \"x_cm\""),
    ("t_s,x_mm,y_mm\n0,1,1\n0,1,1\n", 3, "t_s is 0 after 0"),
    ("t_s,x_mm,y_mm\n1,1,1\n0.5,1,1\n", 3, "t_s is 0.5 after 1"),
    ("t_s,x_mm,y_mm\n0,NaN,1\n", 2, "x_mm is \"NaN\""),
    ("t_s,x_mm,y_mm\n0,1,inf\n", 2, "y_mm is \"inf\""),
    ("t_s,x_mm,y_mm\n0,1\n", 2, "2 cells where the header has 3"),
    ("t_s,x_mm,y_mm\n0,1;5,2\n", 2, "x_mm is \"1;5\""),
    ("t_s,x_mm,y_mm,vx_mm_per_s\n0,1,1,1\n", 1, "one velocity column without the other"),
    ("t_s,x_mm,y_mm\n0,1,1\n1e12,1,1\n", 3, "t_s is 1000000000000 s after the first row"),
];

#[rustfmt::skip]
const MANIFESTS: [(&str, &str, usize, &str); 8] = [
    ("fibre = \"none\"", "fiber = \"none\"", 3, "unknown field `fiber`"),
    ("fibre = \"none\"\n", "", 1, "missing field `fibre`"),
    ("\"other\"", "\"felted\"", 2, "unknown variant `felted`"),
    ("gain_db = 0.0", "gain_db = nan", 4, "gain_db is NaN"),
    ("kind = \"profiles\"", "kind = \"photo\"", 6, "unknown kind of source \"photo\""),
    ("warp_forward = \"warp.csv\"", "", 6, "no warp profile"),
    ("\"warp.csv\"", "\"../warp.csv\"", 7, "warp_forward is \"../warp.csv\""),
    ("name = \"Sample\"", "name = \"Sample", 1, ""),
];

/// Refused with the file and line, the complaint and a mend.
fn check(lab: &Lab, args: &[&str], place: &str, what: &str) {
    let line = lab.refuse(args);
    assert!(line.starts_with(&format!("{place}: ")), "{place}: {line}");
    assert!(line.contains(what), "{what}: {line}");
    assert!(line.contains("; "), "no mend: {line}");
}

const RENDER: [&str; 4] = ["render", "a.scene.toml", "--path", "a.csv"];

#[test]
fn wrong_scenes_are_refused_with_file_line_and_mend() {
    let lab = Lab::with_scene();
    for (from, to, line, what) in SCENES {
        assert!(SCENE.contains(from), "{from}");
        lab.write("a.scene.toml", SCENE.replacen(from, to, 1));
        check(&lab, &RENDER, &format!("a.scene.toml:{line}"), what);
    }
}

#[test]
fn wrong_paths_are_refused_with_file_line_and_mend() {
    let lab = Lab::with_scene();
    for (text, line, what) in PATHS {
        lab.write("a.csv", text);
        check(&lab, &RENDER, &format!("a.csv:{line}"), what);
    }
    lab.write("a.csv", b"t_s,x_mm,y_mm\n0,\xff,1\n");
    check(&lab, &RENDER, "a.csv:2", "not UTF-8");
}

#[test]
fn wrong_manifests_are_refused_with_file_line_and_mend() {
    let lab = Lab::with_scene();
    let good = lab.read("textiles/fine/textile.toml");
    for (from, to, line, what) in MANIFESTS {
        assert!(good.contains(from), "{from}");
        lab.write("textiles/fine/textile.toml", good.replacen(from, to, 1));
        check(
            &lab,
            &RENDER,
            &format!("textiles/fine/textile.toml:{line}"),
            what,
        );
    }
}

#[test]
fn wrong_profiles_are_refused_with_the_file() {
    let lab = Lab::with_scene();
    let rows = |n: usize, step_mm: f64| {
        let row = |i: usize| format!("{},{}\n", i as f64 * step_mm, i % 7);
        format!("x_mm,height_um\n{}", (0..n).map(row).collect::<String>())
    };
    let with_row =
        |row: &str| rows(2000, 1.0 / 230.0).replacen("0,0\n", &format!("0,0\n{row}\n"), 1);
    for (text, what) in [
        (rows(0, 0.1), ""),
        (rows(1, 0.1), ""),
        (
            rows(999, 1.0 / 230.0),
            "999 samples where one window takes 1000",
        ),
        (rows(2000, 0.6), "step"),
        (rows(100_000, 0.0001), "step"),
        (with_row("0.001,NaN"), "height_um is \"NaN\""),
        (with_row("0.001,inf"), "height_um is \"inf\""),
        (with_row("0.0001,1"), ""),
        (
            rows(2000, 1.0 / 230.0).replacen("0,0\n", "0,3.5e38\n", 1),
            "row 1 of 2000: the height is 3.5e38 µm; check its unit",
        ),
        (
            rows(2000, 1.0 / 230.0).replace("height_um", "height_mm"),
            "unknown column \"height_mm\"",
        ),
    ] {
        lab.write("textiles/fine/warp.csv", &text);
        let line = lab.refuse(&RENDER);
        assert!(line.starts_with("textiles/fine/warp.csv"), "{what}: {line}");
        assert!(line.contains(what) && line.contains("; "), "{what}: {line}");
    }
    lab.write("textiles/fine/warp.csv", rows(1000, 1.0 / 230.0));
    lab.print(&RENDER);
}

/// A command line, and what the line must name.
#[rustfmt::skip]
const MISSING: [(&str, &str); 19] = [
    ("render none.toml --path a.csv", "none.toml"),
    ("render a.scene.toml --path none.csv", "none.csv"),
    ("none.scene.toml", "none.scene.toml"),
    ("figure a.scene.toml --path none.csv --out f", "none.csv"),
    ("figure a.scene.toml --out f", "a.scene.toml names no recording"),
    ("figure a.scene.toml --path a.csv --out f --contactor 24", "no contactor 24"),
    ("screenshot none.toml --out a.png", "none.toml"),
    ("textile list --library none", "none"),
    ("textile show none", "no textile \"none\""),
    ("textile make weave none.toml --out x", "none.toml"),
    ("render a.scene.toml --path a.csv --out none/a.csv", "none/a.csv"),
    ("render a.scene.toml --path a.csv --wav none/a.wav", "none/a.wav"),
    ("render a.scene.toml --path a.csv --out textiles", "textiles is a folder"),
    ("render a.scene.toml --path a.csv --hjif none/a.hjif", "none/a.hjif"),
    ("render a.scene.toml --path a.csv --frames none/f.csv", "none/f.csv"),
    ("play a.scene.toml --input evdev:/dev/none --port /dev/null", "/dev/none"),
    ("play a.scene.toml --path a.csv --audio none", "audio"),
    ("play a.scene.toml --listen 0.0.0.0:7240 --port /dev/null", "127.0.0.1:PORT"),
    ("play a.scene.toml --input mouse --port /dev/null", "evdev:/dev/input/eventN"),
];

#[test]
fn missing_files_are_named() {
    let lab = Lab::with_scene();
    for (args, name) in MISSING {
        let line = lab.refuse(&args.split(' ').collect::<Vec<_>>());
        assert!(line.contains(name) && line.contains("; "), "{args}: {line}");
    }
    std::fs::remove_file(lab.path("textiles/fine/warp.csv")).unwrap();
    let line = lab.refuse(&RENDER);
    assert!(
        line.contains("textiles/fine/warp.csv") && line.contains("; "),
        "{line}"
    );
}

#[test]
fn wrong_ports_are_refused_before_anything_moves() {
    let lab = Lab::with_scene();
    let play = ["play", "a.scene.toml", "--path", "a.csv", "--port"];
    for (port, what) in [
        ("/dev/none", "there is no port /dev/none"),
        ("a.csv", "a.csv is no serial port"),
        (".", ". is no serial port"),
    ] {
        for args in [
            [&play[..], &[port]].concat(),
            vec!["bridge", "test", "--port", port],
            vec!["bridge", "certify", "--out", "new", "--port", port],
        ] {
            let line = lab.refuse(&args);
            assert!(
                line.contains(what) && line.contains("bridge list"),
                "{args:?}: {line}"
            );
        }
    }
    #[cfg(unix)]
    {
        let line = lab.refuse(&[&play[..], &["/dev/null"]].concat());
        assert!(
            line.starts_with("/dev/null: ") && line.contains("not a serial port"),
            "{line}"
        );
        let line = lab.refuse(&["bridge", "emulate", "--link", "a.csv"]);
        assert!(
            line.starts_with("a.csv: ") && line.contains("choose another --link"),
            "{line}"
        );
        assert_eq!(lab.read("a.csv"), PATH, "what was there is still there");
        let line = lab.refuse(&["bridge", "emulate", "--link", "b", "--quality", "5000"]);
        assert!(
            line.contains("quality factor of 5000") && line.contains("0.1 to 1000"),
            "{line}"
        );
    }
}

#[test]
fn rates_and_channels_that_cannot_be_are_refused() {
    let lab = Lab::with_scene();
    let play = "play a.scene.toml --path a.csv";
    for baud in ["0", "fast", "9600", "1e6", "99999999999"] {
        for command in [
            format!("{play} --port /dev/none"),
            "bridge test --port /dev/none".to_owned(),
            "bridge identify --port /dev/none --out b.toml".to_owned(),
        ] {
            let args = format!("{command} --baud {baud}");
            let line = lab.refuse(&args.split(' ').collect::<Vec<_>>());
            let mend = "115200 to 12000000 baud";
            assert!(line.contains(baud) && line.contains(mend), "{args}: {line}");
        }
    }
    for (channels, what) in [
        ("0-23", "\"0\" is no channel"),
        ("1,2,2", "channel 2 stands there twice"),
        ("1,2", "2 channels are named for 24 contactors"),
    ] {
        let args = format!("{play} --audio card --channels {channels}");
        let line = lab.refuse(&args.split(' ').collect::<Vec<_>>());
        assert!(line.contains(what), "{args}: {line}");
    }
}

const USAGE: [&str; 21] = [
    "render",
    "render a.scene.toml",
    "render a.scene.toml --path a.csv --speed 3",
    "render a.scene.toml --path a.csv --method fast",
    "render a.scene.toml --path a.csv --wav-rate 8000",
    "play a.scene.toml --path - --loop --port /dev/none",
    "play a.scene.toml --path a.csv --port /dev/none --audio card",
    "play a.scene.toml --path a.csv --audio card --baud 115200",
    "play a.scene.toml --path a.csv --port /dev/none --channels 1-24",
    "play a.scene.toml --path a.csv --input evdev:/dev/none --port /dev/none",
    "input",
    "textile",
    "bridge",
    "bridge test",
    "bridge certify --port /dev/none",
    "bridge emulate",
    "screenshot",
    "screenshot --out a.png --width 1",
    "a.scene.toml b.scene.toml",
    "weave",
    "--colour",
];

#[test]
fn bad_usage_is_one_line_that_says_how_to_mend_it() {
    let lab = Lab::with_scene();
    for args in USAGE {
        let line = lab.refuse(&args.split(' ').collect::<Vec<_>>());
        assert!(line.contains("; "), "{args}: {line}");
    }
    let line = lab.refuse(&[
        "render",
        "a.scene.toml",
        "--path",
        "a.csv",
        "--method",
        "fast",
    ]);
    assert!(line.contains("reference, banded, table or auto"), "{line}");
    for command in [
        &RENDER[..],
        &["play", "a.scene.toml", "--path", "a.csv", "--port", "p"],
    ] {
        for budget_db in ["-1", "inf", "none"] {
            let line = lab.refuse(&[command, &["--budget-db", budget_db]].concat());
            assert!(line.contains("give a number of dB, 0 or above"), "{line}");
        }
    }
}

#[test]
fn a_gain_of_minus_infinity_is_silent_and_not_an_error() {
    let lab = Lab::with_scene();
    lab.write(
        "a.scene.toml",
        SCENE.replacen("gain_db = 0.0", "gain_db = -inf", 1),
    );
    let rows = crate::program::Rows::parse(&lab.print(&RENDER));
    assert!(
        rows.numbers("a320_um").iter().all(|&um| um == 0.0),
        "silent"
    );
    assert!(rows.text("textile").contains(&"fine"), "but there");
}

#[test]
fn an_empty_scene_is_silent() {
    let lab = Lab::with_scene();
    lab.write("a.scene.toml", "name = \"Nothing\"\nsize_mm = [10, 10]\n");
    let rows = crate::program::Rows::parse(&lab.print(&RENDER));
    assert_eq!(rows.len(), 21 * 24);
    assert!(rows.numbers("a40_um").iter().all(|&um| um == 0.0), "silent");
}
