//! `selvedge render` on good input, run as a user runs it.

use crate::program::{Lab, Rows};

const RENDER: [&str; 4] = ["render", "a.scene.toml", "--path", "a.csv"];

#[test]
fn a_sine_that_sounds_at_320_hz_has_its_amplitude_at_every_contactor() {
    let lab = Lab::with_scene();
    let out = lab.print(&[&RENDER[..], &["--method", "reference"]].concat());
    let rows = Rows::parse(&out);
    assert_eq!(
        rows.header(),
        "tick,t_s,display,contactor,x_mm,y_mm,textile,a40_um,a320_um"
    );
    assert_eq!(rows.len(), 21 * 24);
    let (ticks, a320_um) = (rows.numbers("tick"), rows.numbers("a320_um"));
    let (x_mm, textile) = (rows.numbers("x_mm"), rows.text("textile"));
    for row in 0..rows.len() {
        let contactor = row % 24;
        assert_eq!(ticks[row], (row / 24) as f64);
        assert_eq!(rows.text("contactor")[contactor], contactor.to_string());
        // 70 mm is where the flat textile begins.
        assert_eq!(
            textile[row],
            if x_mm[row] < 69.9 { "fine" } else { "flat" },
            "row {row}"
        );
        let expected_um = if row < 24 || textile[row] == "flat" {
            0.0
        } else {
            4.0
        };
        assert!(
            (a320_um[row] - expected_um).abs() < 0.04,
            "row {row}: {}",
            a320_um[row]
        );
    }
}

#[test]
fn every_method_writes_the_same_amplitudes_within_its_error() {
    let lab = Lab::with_scene();
    let render = |method: &str| {
        let out = lab.print(&[&RENDER[..], &["--method", method]].concat());
        Rows::parse(&out).numbers("a320_um")
    };
    let reference = render("reference");
    for method in ["banded", "table", "auto"] {
        for (a, a_ref) in render(method).iter().zip(&reference) {
            if *a_ref > 0.004 {
                assert!(
                    (20.0 * (a / a_ref).log10()).abs() <= 0.05,
                    "{method}: {a} for {a_ref}"
                );
            } else {
                assert!((a - a_ref).abs() <= 6e-6 * 4.0, "{method}: {a} for {a_ref}");
            }
        }
    }
}

#[test]
fn the_error_budget_decides_what_auto_renders_by() {
    let lab = Lab::with_scene();
    let swing = |s: u32| format!("{s},{},40\n", 20 + 40 * (s % 2));
    let minute: String = (0..=60).map(swing).collect();
    lab.write("minute.csv", format!("t_s,x_mm,y_mm\n{minute}"));
    let with = |path: &str, budget_db: &str| {
        let args = [
            "render",
            "a.scene.toml",
            "--path",
            path,
            "--budget-db",
            budget_db,
            "--stats",
            "s.json",
            "--out",
            "a40.csv",
        ];
        lab.print(&args);
        let stats = lab.read("s.json");
        let used = stats.split_once("\"method\": \"").unwrap().1;
        (
            used[..used.find('"').unwrap()].to_owned(),
            lab.read("a40.csv"),
        )
    };
    let reference = lab.print(&[&RENDER[..], &["--method", "reference"]].concat());
    assert_eq!(with("a.csv", "0"), ("reference".to_owned(), reference));
    assert_eq!(with("minute.csv", "0.0001").0, "banded");
    assert_eq!(with("minute.csv", "0.05").0, "table");
    let (method, amplitudes) = with("a.csv", "0.05");
    assert_eq!(method, "banded", "half a second is worth no table");
    assert_eq!(lab.print(&RENDER), amplitudes, "that is what it is without");
}

#[test]
fn of_a_textile_that_a_path_does_not_feel_nothing_but_the_manifest_is_read() {
    let lab = Lab::with_scene();
    lab.write("left.csv", "t_s,x_mm,y_mm\n0,20,40\n0.5,40,40\n");
    lab.write("right.csv", "t_s,x_mm,y_mm\n0,90,40\n0.5,95,40\n");
    let render = |path| {
        [
            "render",
            "a.scene.toml",
            "--path",
            path,
            "--stats",
            "s.json",
        ]
    };
    let amplitudes = |path| lab.print(&["render", "a.scene.toml", "--path", path]);
    let expected = amplitudes("left.csv");
    std::fs::remove_file(lab.path("textiles/flat/warp.csv")).unwrap();
    assert_eq!(amplitudes("left.csv"), expected);
    lab.print(&render("left.csv"));
    let unread = |stats: String| stats.split_whitespace().collect::<String>();
    let stats = unread(lab.read("s.json"));
    assert!(stats.contains("\"unread\":[\"flat\"]"), "{stats}");
    let line = lab.refuse(&render("right.csv"));
    assert!(line.contains("warp.csv"), "{line}");
    let muted =
        lab.read("a.scene.toml")
            .replacen("id = \"flat\"", "id = \"flat\"\ngain_db = -inf", 1);
    lab.write("a.scene.toml", muted);
    assert!(
        amplitudes("right.csv").contains(",flat,0,0\n"),
        "it is there and silent"
    );
    lab.write("textiles/flat/textile.toml", "nonsense");
    let line = lab.refuse(&render("left.csv"));
    assert!(line.contains("textile.toml"), "manifests are read: {line}");
}

#[test]
fn a_run_writes_the_same_bytes_to_a_file_and_nothing_beside_it() {
    let lab = Lab::with_scene();
    let printed = lab.print(&RENDER);
    assert_eq!(
        lab.print(&[&RENDER[..], &["--out", "a40.csv"]].concat()),
        ""
    );
    assert_eq!(lab.read("a40.csv"), printed);
    let names = std::fs::read_dir(lab.path("")).unwrap();
    let n_parts =
        names.filter(|e| e.as_ref().unwrap().path().extension().unwrap_or_default() == "part");
    assert_eq!(n_parts.count(), 0);
}

#[test]
fn a_waveform_has_a_channel_a_contactor_and_the_amplitudes_of_the_table() {
    let lab = Lab::with_scene();
    let args = [
        "--wav",
        "w.wav",
        "--wav-rate",
        "8000",
        "--out",
        "a.amplitudes.csv",
    ];
    lab.print(&[&RENDER[..], &args].concat());
    let mut wav = hound::WavReader::open(lab.path("w.wav")).unwrap();
    let spec = wav.spec();
    assert_eq!((spec.channels, spec.sample_rate), (24, 8000));
    let samples: Vec<f32> = wav.samples().map(Result::unwrap).collect();
    assert_eq!(samples.len(), 24 * 200 * 21, "21 ticks of 200 samples");
    let table = Rows::read(&lab.path("a.amplitudes.csv"));
    let (a40_um, a320_um) = (table.numbers("a40_um"), table.numbers("a320_um"));
    for (index, sample) in samples.iter().enumerate() {
        let (m, channel) = (index / 24, index % 24);
        let row = m / 200 * 24 + channel;
        let phase = std::f64::consts::TAU * (m % 200) as f64 / 8000.0;
        let um = a40_um[row] * (40.0 * phase).sin() + a320_um[row] * (320.0 * phase).sin();
        assert!(
            (f64::from(*sample) - um / 50.0).abs() < 1e-6,
            "sample {m}, channel {channel}"
        );
    }
}

#[test]
fn statistics_hold_every_method_on_this_path() {
    let lab = Lab::with_scene();
    assert_eq!(
        lab.print(&[&RENDER[..], &["--stats", "s.json"]].concat()),
        ""
    );
    let stats: serde_json::Value = serde_json::from_str(&lab.read("s.json")).unwrap();
    assert_eq!(stats["n_ticks"], 21);
    let methods = stats["methods"].as_array().unwrap();
    let names: Vec<&str> = methods
        .iter()
        .map(|m| m["method"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["auto", "reference", "banded", "table"]);
    for method in methods {
        assert_eq!(method["counters"]["ticks"], 21);
        for key in ["tick_median_ns", "tick_p99_ns"] {
            assert!(method[key].as_f64().unwrap() > 0.0, "{key}: {method}");
        }
        for key in [
            "bins_evaluated",
            "bins_below_floor",
            "contactors_inside",
            "contactors_outside",
        ] {
            assert!(
                method["counters"][key].as_u64().is_some(),
                "{key}: {method}"
            );
        }
        let error_db = method["level_error"]["max_db"].as_f64().unwrap();
        assert!(error_db <= 0.05, "{method}");
    }
}

#[test]
fn a_band_is_written_at_both_ends_and_shifts_only_what_has_one() {
    let lab = Lab::with_scene();
    let manifest = lab.read("textiles/fine/textile.toml");
    let known = "[uncertainty]\nlevels = [[40.0, 0.0, -6.0, 2.0], [320.0, 0.0, -1.0, 4.0], \
                 [320.0, 90.0, -9.0, 9.0]]\n";
    lab.write("textiles/fine/textile.toml", format!("{manifest}{known}"));
    let files = ["--out", "a.out.csv", "--band", "low.csv,high.csv"];
    lab.print(&[&RENDER[..], &files].concat());
    let read = |name: &str| Rows::read(&lab.path(name));
    let [felt, low, high] = ["a.out.csv", "low.csv", "high.csv"].map(read);
    let mut n_shifted = 0;
    for (column, ends_db) in [("a40_um", [-6.0, 2.0]), ("a320_um", [-1.0, 4.0])] {
        let [felt_um, low_um, high_um] = [&felt, &low, &high].map(|rows| rows.numbers(column));
        for (row, textile) in felt.text("textile").into_iter().enumerate() {
            let ratios = [low_um[row], high_um[row]].map(|um| 20.0 * (um / felt_um[row]).log10());
            if felt_um[row] > 0.0 {
                assert_eq!(textile, "fine", "the other is flat");
                let off = [0, 1].map(|end| (ratios[end] - ends_db[end]).abs());
                assert!(off.into_iter().all(|db| db < 1e-6), "row {row}: {ratios:?}");
                n_shifted += 1;
            } else {
                assert_eq!([low_um[row], high_um[row]], [0.0; 2]);
            }
        }
    }
    assert!(n_shifted > 100, "{n_shifted}");
    let table = lab.print(&["textile", "levels", "--library", "textiles"]);
    let levels = Rows::parse(&table);
    assert_eq!(levels.text("low40_db"), ["-6", ""], "{table}");
    assert_eq!(
        levels.text("high320_db"),
        ["6.5", ""],
        "the mean of warp and weft"
    );
    lab.print(&[
        "textile",
        "levels",
        "--library",
        "textiles",
        "--out",
        "levels.json",
    ]);
    let json: serde_json::Value = serde_json::from_str(&lab.read("levels.json")).unwrap();
    let of = |row: usize, key: &str| json[row][key].clone();
    assert_eq!([of(0, "low40_db"), of(0, "high320_db")], [-6.0, 6.5]);
    assert_eq!(
        of(0, "a40_um").as_f64().unwrap(),
        levels.numbers("a40_um")[0]
    );
    assert!(
        of(1, "low40_db").is_null() && of(1, "textile") == "flat",
        "{json}"
    );
    let line = lab.refuse(&[&RENDER[..], &["--band", "low.csv"]].concat());
    assert!(line.contains("LOW.csv,HIGH.csv"), "{line}");
}
