//! Surfaces made from options, templates learnt from files, and what is refused.

use crate::program::Lab;

/// A profile of 20 mm that repeats, as CSV.
fn profile(phase: f64) -> String {
    let row = |i: u32| {
        let x_mm = f64::from(i) / 230.0;
        let wave = (std::f64::consts::TAU * x_mm / 0.8 + phase).sin();
        let height_um = 7.0 * wave + (53.0 * x_mm + phase).cos();
        format!("{x_mm:.6},{height_um:.3}\n")
    };
    let rows: String = (0..4600).map(row).collect();
    format!("x_mm,height_um\n{rows}")
}

#[test]
fn the_manifest_of_a_made_surface_makes_the_same_bytes_again() {
    let lab = Lab::new();
    lab.write("w.csv", profile(0.3));
    let brownian: &[&str] = &["--hurst", "0.4", "--step-mm", "0.1", "--smd-um", "3"];
    for (kind, options) in [
        ("brownian", brownian),
        (
            "fourier",
            &["--template", "soft-twill", "--composition", "product"],
        ),
        ("restoration", &["--warp", "w.csv", "--composition", "max"]),
    ] {
        let (one, two) = (format!("one/{kind}"), format!("two/{kind}"));
        let make = ["textile", "make", kind];
        lab.print(&[&make[..], options, &["--out", &one]].concat());
        let recipe = format!("{one}/textile.toml");
        lab.print(&[&make[..], &[&recipe, "--out", &two]].concat());
        for name in ["textile.toml", "warp_forward.csv", "weft_reverse.csv"] {
            let read = |folder: &str| lab.read(&format!("{folder}/{name}"));
            assert_eq!(read(&one), read(&two), "{kind}/{name}");
        }
        let shown = lab.print(&["textile", "show", kind, "--library", "two"]);
        assert!(shown.contains("roughness SMD"), "{shown}");
    }
}

#[test]
fn a_template_is_learnt_from_profiles_and_drawn_from() {
    let lab = Lab::new();
    for (name, phase) in [("a.csv", 0.0), ("b.csv", 1.0), ("c.csv", 2.5)] {
        lab.write(name, profile(phase));
    }
    let learn = [
        "textile",
        "learn-fourier",
        "--name",
        "mine",
        "--out",
        "t.toml",
    ];
    let said = lab.print(&[&learn[..], &["a.csv", "b.csv", "c.csv"]].concat());
    assert_eq!(said, "t.toml: 50 harmonics of 3 profiles\n");
    lab.print(&[
        "textile",
        "make",
        "fourier",
        "--template",
        "t.toml",
        "--out",
        "lib/mine",
    ]);
    let line = lab.refuse(&[&learn[..], &["a.csv"]].concat());
    assert!(line.contains("profiles given: 1; "), "{line}");
}

#[test]
fn options_that_make_no_surface_are_refused_in_one_line() {
    let lab = Lab::new();
    lab.write("one.csv", "x_mm,height_um\n0,1\n");
    let brownian = ["textile", "make", "brownian", "--out", "x"];
    for (options, expected) in [
        (&["--hurst", "nan"][..], "hurst is NaN; "),
        (&["--hurst", "1"], "hurst is 1; "),
        (&["--hurst", "0.5", "--smd-um=-1"], "smd_um is -1; "),
        (
            &["--hurst", "0.5", "--shortest-mm", "1"],
            "shortest_mm with generator",
        ),
    ] {
        let line = lab.refuse(&[&brownian[..], options].concat());
        assert!(line.contains(expected), "{line}");
    }
    let line = lab.refuse(&[
        "textile",
        "make",
        "fourier",
        "--template",
        "felt",
        "--out",
        "x",
    ]);
    assert!(line.contains("the examples are fine-plain"), "{line}");
    let restore = [
        "textile",
        "make",
        "restoration",
        "--out",
        "x",
        "--warp",
        "one.csv",
    ];
    let line = lab.refuse(&restore);
    assert!(line.contains("one.csv: 1 samples"), "{line}");
}
