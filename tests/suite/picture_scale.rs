//! `selvedge picture` with the scale by counted threads, run as a user runs it.

use selvedge_foundation::files::GrayImage;

use crate::picture::cloth;
use crate::program::Lab;

/// A plain weave with a thread every 12 and every 10 px.
fn plain_weave() -> Vec<u8> {
    let turn = std::f64::consts::TAU;
    let values = (0..240 * 200_u32).map(|i| {
        let (x, y) = (f64::from(i % 240), f64::from(i / 240));
        let threads = (turn * x / 12.0).cos() + (turn * y / 10.0).cos();
        let repeat = (0.5 * turn * x / 12.0).cos() * (0.5 * turn * y / 10.0).cos();
        0.5 + 0.1 * threads + 0.05 * repeat
    });
    let picture = GrayImage::of_shares([240, 200], values);
    picture.to_png("plain.png".as_ref()).unwrap()
}

#[test]
fn threads_that_were_counted_are_the_scale_and_the_manifest_keeps_it() {
    let lab = Lab::new();
    lab.write("plain.png", plain_weave());
    let picture = ["picture", "plain.png", "--out", "made", "--threads-per-cm"];
    let textile = [
        "--relief-um",
        "100",
        "--light",
        "45,30",
        "--textile",
        "plain",
    ];
    let described = lab.print(&[&picture[..], &["20,24"], &textile].concat());
    // A crossing on 12 × 10 px, 480 of them on a square centimetre.
    assert!(described.contains(" px/mm by the threads"), "{described}");
    let json: serde_json::Value = serde_json::from_str(&lab.read("made/periodicity.json")).unwrap();
    assert_eq!(
        json["scale"]["threads_per_cm"],
        serde_json::json!([20.0, 24.0])
    );
    assert!(
        (json["px_per_mm"].as_f64().unwrap() - 24.0).abs() < 0.05,
        "{json}"
    );
    let manifest = lab.read("plain/textile.toml");
    assert!(
        manifest.contains("threads_per_cm = [20.0, 24.0]"),
        "{manifest}"
    );
    let again = lab.print(&["textile", "rebuild", "plain"]);
    assert_eq!(again, "plain: 7 files made again, 0 of them changed\n");
    assert_eq!(lab.read("plain/textile.toml"), manifest);
    for (counts, expected) in [
        ("20,44", "times as dense one way"),
        ("0", "give one or two numbers"),
    ] {
        let line = lab.refuse(&[&picture[..], &[counts]].concat());
        assert!(line.contains(expected), "{counts}: {line}");
    }
    let both = [&picture[..], &["20", "--dpi", "600"]].concat();
    assert_eq!(lab.run(&both).code, 2, "one scale is enough");
    // Neither a repeat without threads nor a picture without a repeat has any to count.
    lab.write("plain.png", cloth());
    let line = lab.refuse(&[&picture[..], &["20"]].concat());
    assert!(line.contains("plain.png: no grid of threads"), "{line}");
    let flat = GrayImage {
        width: 100,
        height: 100,
        values: vec![900; 10_000],
        white: u16::MAX,
        texts: Vec::new(),
    };
    lab.write("plain.png", flat.to_png("plain.png".as_ref()).unwrap());
    let line = lab.refuse(&[&picture[..], &["20"]].concat());
    assert!(
        line.contains("the picture is of one colour; no grid of threads"),
        "{line}"
    );
}
