//! From files of the surface tester to a textile, a picture and a catalogue; and what is refused.

use std::f64::consts::TAU;

use crate::program::Lab;

/// An export of both ways with a decimal comma, by place; 24 mm.
fn export() -> String {
    let row = |i: u16| {
        let x_mm = f64::from(i) * 0.02;
        let z = 6.0 * (TAU * 2.4 * x_mm).sin() + 3.0 * (0.7 * x_mm * x_mm).sin() + 0.4 * x_mm;
        format!("{x_mm:.2};{z:.3};{:.3}\r\n", z + 0.5).replace('.', ",")
    };
    let rows: String = (0..1200).map(row).collect();
    format!("KES-FB4\r\n\r\nWeg mm;forward um;return um\r\n{rows}")
}

#[test]
fn an_export_becomes_a_textile_that_a_scene_can_use() {
    let lab = Lab::new();
    lab.write("twill.txt", export());
    let row = |i: u16| format!("{} 0.{}\n", f64::from(i) / 50.0, 20 + i % 3);
    let friction: String = (0..1000).map(row).collect();
    lab.write("mu.txt", friction);
    let line = "textile import-kes twill.txt --out cloths/twill --name Twill --fibre wool \
                --section 2,22 --official-band --friction mu.txt";
    let args: Vec<&str> = line.split_whitespace().collect();
    let outcome = lab.run(&args);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(
        outcome.err.contains("warp reverse: rows by their places"),
        "{}",
        outcome.err
    );
    for part in [
        "warp section  2.00 to 22.00 mm (as said)",
        "SMD ",
        "SMD ≤ 1 mm",
        "MIU ",
    ] {
        assert!(outcome.out.contains(part), "{part}: {}", outcome.out);
    }
    let shown = lab.print(&["textile", "show", "twill", "--library", "cloths"]);
    assert!(
        shown.contains("friction      MIU 0.2100") && shown.contains("16, 16"),
        "{shown}"
    );
    let picture = lab.read("cloths/twill/import.svg");
    assert!(
        picture.contains("warp reverse: SMD"),
        "the curves beside the textile"
    );
    let first = lab.read("cloths/twill/textile.toml");
    lab.run(&args);
    assert_eq!(
        lab.read("cloths/twill/textile.toml"),
        first,
        "the same bytes"
    );
    lab.print(&[
        "textile",
        "catalogue",
        "--library",
        "cloths",
        "--out",
        "sheets",
    ]);
    assert!(
        lab.read("sheets/index.md").contains("[twill](twill.svg)"),
        "the index"
    );
    let sheet = lab.read("sheets/twill.svg");
    assert!(
        sheet.contains("imported from twill.txt, mu.txt"),
        "where it comes from"
    );
}

#[test]
fn what_is_no_export_is_refused_in_one_line_and_leaves_nothing() {
    let lab = Lab::new();
    lab.write("good.txt", export());
    lab.write("empty.txt", "");
    lab.write("picture.txt", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR");
    lab.write("words.txt", "there is nothing\nto measure here\n");
    lab.write("volts.txt", export().replace("forward um", "forward V"));
    lab.write("twice.txt", export().replace("\r\n0,04;", "\r\n0,02;"));
    lab.write("bare.txt", "1.5\n2.5\n1.0\n".repeat(300));
    let import = |more: &[&str]| {
        let mut args = vec!["textile", "import-kes", "--out", "cloth", "--name", "A"];
        args.extend(more);
        lab.refuse(&args)
    };
    for (more, expected) in [
        (vec!["empty.txt"], "empty.txt: this file is empty; "),
        (vec!["picture.txt"], "picture.txt:1: this is not text; "),
        (vec!["words.txt"], "words.txt:1: no table of numbers; "),
        (
            vec!["volts.txt"],
            "volts.txt:4: heights in volts; say --um-per-volt UM",
        ),
        (vec!["twice.txt"], "twice.txt:6: x is 0.02 twice; "),
        (
            vec!["bare.txt"],
            "bare.txt:1: no column of distance; say --step-mm MM",
        ),
        (
            vec!["good.txt", "--section", "20,40"],
            "good.txt:1: the warp strokes cover 0.000",
        ),
        (
            vec!["good.txt", "--x-unit", "um"],
            "good.txt:4: the step is 0.00002 mm, not 0.0005",
        ),
        (
            vec!["good.txt", "--direction", "warp", "--direction", "weft"],
            "--direction is said 2",
        ),
        (vec!["missing.txt"], "cannot read missing.txt"),
    ] {
        let line = import(&more);
        assert!(line.starts_with(expected), "{line}, not {expected}");
        assert!(
            !lab.path("cloth").exists(),
            "{more:?} leaves nothing behind"
        );
    }
}

#[test]
fn a_unit_that_nobody_states_is_marked_as_assumed() {
    let lab = Lab::new();
    let import = [
        "textile",
        "import-kes",
        "a.txt",
        "--out",
        "library/a",
        "--name",
        "A",
    ];
    lab.write("a.txt", export().replace(" um", "").replace(" mm", ""));
    let outcome = lab.run(&import);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(
        outcome.err.contains("assumed: heights in µm"),
        "{outcome:?}"
    );
    let manifest = lab.read("library/a/textile.toml");
    let kept = "assumed = [\"heights in µm\", \"places in mm\"]";
    assert!(manifest.contains(kept), "{manifest}");
    let shown = lab.print(&["textile", "show", "a", "--library", "library"]);
    assert!(
        shown.contains("assumed       heights in µm, places in mm"),
        "{shown}"
    );
    lab.write("a.txt", export());
    let stated = lab.run(&import);
    assert!(!stated.err.contains("assumed"), "{stated:?}");
    assert!(
        !lab.read("library/a/textile.toml").contains("assumed"),
        "it is stated"
    );
}
