//! `selvedge friction`, run as a user runs it.

use selvedge_foundation::files::GrayImage;

use crate::program::Lab;

/// A cloth of threads 0.6 mm apart, 60 mm x 12 mm at 10 px/mm.
fn cloth() -> Vec<u8> {
    let turn = std::f64::consts::TAU;
    let values = (0..600 * 120_u32).map(|i| {
        let [x, y] = [f64::from(i % 600), f64::from(i / 600)];
        0.5 + 0.2 * (turn * x / 6.0).cos() + 0.15 * (turn * y / 7.0).cos()
    });
    let picture = GrayImage::of_shares([600, 120], values);
    picture.to_png("cloth.png".as_ref()).unwrap()
}

#[test]
fn a_picture_becomes_a_trace_of_friction_and_says_how_sure_it_is() {
    let lab = Lab::new();
    lab.write("cloth.png", cloth());
    let generate = |more: &[&str]| {
        let args = ["friction", "generate", "cloth.png", "--px-per-mm", "10"];
        lab.run(&[&args, more].concat())
    };
    let ran = generate(&["--out", "f.csv", "--spectrogram", "s.png"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("mean friction 0."), "{}", ran.err);
    let table = lab.read("f.csv");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("x_mm,mu"));
    let mu: Vec<f64> = lines
        .map(|l| l.split_once(',').unwrap().1.parse().unwrap())
        .collect();
    assert_eq!(mu.len(), 768);
    assert!(mu.iter().all(|mu| (0.05..1.5).contains(mu)), "{mu:?}");
    assert!(lab.path("s.png").exists());
    // The same again, and beside itself.
    for more in [
        &["--out", "again.csv"] as &[&str],
        &["--towards", "cloth.png", "--out", "again.csv"],
    ] {
        assert_eq!(generate(more).code, 0);
        let again = lab.read("again.csv");
        let other: Vec<f64> = again
            .lines()
            .skip(1)
            .map(|l| l.split_once(',').unwrap().1.parse().unwrap())
            .collect();
        let far = mu
            .iter()
            .zip(&other)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(far < 1e-4, "{far}");
    }
}

#[test]
fn what_is_no_picture_or_shows_too_little_is_refused_in_one_line() {
    let lab = Lab::new();
    lab.write("cloth.png", cloth());
    lab.write("empty.png", Vec::new());
    lab.write("words.png", b"no picture");
    let cases: [(&[&str], &str); 6] = [
        (
            &["cloth.png", "--px-per-mm", "20"],
            "at least 40 mm x 10 mm",
        ),
        (&["cloth.png", "--px-per-mm", "0"], "give a number above 0"),
        (
            &["cloth.png", "--px-per-mm", "NaN"],
            "give a number above 0",
        ),
        (&["empty.png", "--px-per-mm", "10"], "empty.png"),
        (&["words.png", "--px-per-mm", "10"], "words.png"),
        (&["none.png", "--px-per-mm", "10"], "none.png"),
    ];
    for (args, said) in cases {
        let ran = lab.run(&[&["friction", "generate"], args].concat());
        assert_eq!(ran.code, 2, "{args:?}: {}", ran.err);
        assert!(ran.err.contains(said), "{args:?}: {}", ran.err);
    }
}

#[test]
fn a_short_training_is_kept_told_and_put_into_a_table() {
    let lab = Lab::new();
    let train = [
        "friction", "train", "--out", "runs", "--split", "C", "--cloths", "1", "--rounds", "1",
    ];
    let ran = lab.run(&train);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let name = "ours-C-1-cloths-1-rounds-1";
    assert!(
        ran.err.contains(&format!("{name}: round 1 of 1")),
        "{}",
        ran.err
    );
    let rounds = lab.read(&format!("runs/{name}.rounds.csv"));
    assert_eq!(rounds.lines().count(), 2, "{rounds}");
    let again = lab.run(&train);
    assert!(
        again.err.contains(&format!("{name} is finished")),
        "{}",
        again.err
    );
    let evaluate = [
        "friction",
        "evaluate",
        "--out",
        "runs",
        "--splits",
        "C",
        "--only-finished",
        "--own",
    ];
    let told = lab.print(&evaluate);
    assert!(told.starts_with("C: unseen places"), "{told}");
    // A shorter lesson is no row of the table.
    assert!(told.contains("not run: ours, seeds 1 2 3:"), "{told}");
    assert_eq!(lab.read("runs/table.csv").lines().count(), 1);
    assert!(
        told.contains(&format!("besides: {name}: spectrum ")),
        "{told}"
    );
    // What the folder lacks is taken from the runs that are shipped, and the best is named.
    let of_shipped = ["friction", "evaluate", "--out", "runs", "--splits", "A"];
    let told = lab.print(&[&of_shipped[..], &["--only-finished"]].concat());
    assert!(told.contains("\nridge "), "{told}");
    assert!(
        told.contains("\nbest spectrum: shipped networks, 3.92 dB"),
        "{told}"
    );
    assert!(
        told.contains("\nbest level: class spectrum (is told the family), 6.55 %"),
        "{told}"
    );
    assert!(lab.read("runs/table.csv").lines().count() > 9);
    // A row a family.
    assert_eq!(lab.read("runs/families.csv").lines().count(), 9);
    let kept = lab.read("runs/runs.csv");
    let row = kept.lines().nth(1).unwrap();
    assert!(row.starts_with(&format!("{name},ours,C,1,16,1,")), "{row}");
    let cpu_s = row.split(',').rev().nth(1).unwrap();
    assert!(cpu_s.parse::<f64>().unwrap() > 0.0, "{row}");
    let [traces, latents] = ["traces", "latents"].map(|name| lab.read(&format!("runs/{name}.svg")));
    assert!(traces.contains("nonwoven: felt") && traces.contains("dB off"));
    assert!(latents.contains("% of the variance"));
}

#[test]
fn a_textile_keeps_friction_from_a_picture_and_how_far_it_may_be_off() {
    let lab = Lab::new();
    lab.write("cloth.png", cloth());
    let rows: Vec<String> = (0..400)
        .map(|i| format!("{},{}", f64::from(i) / 10.0, i % 7))
        .collect();
    lab.write(
        "mine/a.csv",
        format!("x_mm,height_um\n{}\n", rows.join("\n")),
    );
    let manifest = [
        "# mine",
        "name = \"Mine\"",
        "construction = \"woven\"",
        "fibre = \"wool\"",
        "[source]",
        "kind = \"profiles\"",
        "warp_forward = \"a.csv\"",
        "",
    ];
    let manifest = manifest.join("\n");
    lab.write("mine/textile.toml", &manifest);
    let args = [
        "friction",
        "generate",
        "cloth.png",
        "--px-per-mm",
        "10",
        "--textile",
        "mine",
    ];
    let ran = lab.run(&args);
    assert_eq!((ran.code, ran.out.as_str()), (0, ""), "{}", ran.err);
    let kept = lab.read("mine/textile.toml");
    assert!(
        kept.starts_with("# mine\n") && kept.contains("[uncertainty]"),
        "{kept}"
    );
    assert!(lab.read("mine/friction.csv").starts_with("x_mm,mu\n0,"));
    let shown = lab.run(&["textile", "show", "mine", "--library", "."]);
    assert!(
        shown.out.contains("friction      MIU 0.") && shown.out.contains(" ± 0."),
        "{}",
        shown.out
    );
    // Friction that was measured is not covered up.
    let measured = manifest.replace("kind", "friction = \"a.csv\"\nkind");
    lab.write("mine/textile.toml", &measured);
    let refused = lab.run(&args);
    assert_eq!(refused.code, 2);
    assert!(
        refused.err.contains("friction of its own"),
        "{}",
        refused.err
    );
    assert_eq!(lab.read("mine/textile.toml"), measured);
}

#[test]
fn fabrics_of_ones_own_are_compared_and_one_unlike_all_others_is_told_of() {
    let lab = Lab::new();
    let mut means = vec!["name,mu".to_owned()];
    for nth in 0..6 {
        lab.write(&format!("mine/cloth{nth}.png"), cloth());
        let mu = if nth == 2 {
            0.9
        } else {
            0.3 + 0.01 * f64::from(nth)
        };
        means.push(format!("cloth{nth},{mu}"));
    }
    let args = [
        "friction",
        "evaluate",
        "--out",
        "out",
        "--data",
        "mine",
        "--px-per-mm",
        "10",
    ];
    let refused = lab.run(&args);
    assert_eq!(refused.code, 2);
    assert!(
        refused
            .err
            .contains("cloth0.png: no friction; put cloth0.csv"),
        "{}",
        refused.err
    );
    lab.write("mine/friction.csv", means.join("\n"));
    let ran = lab.run(&args);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("cloth2: its friction is"), "{}", ran.err);
    assert_eq!(ran.out.lines().count(), 6, "{}", ran.out);
    assert!(
        ran.out.contains("ridge") && ran.out.contains("shipped networks"),
        "{}",
        ran.out
    );
    assert_eq!(lab.read("out/fabrics.csv").lines().count(), 6);
}
