//! Files for other programs, from the command line: what is in them, and what a full disk leaves.

use crate::program::{Lab, Rows};

const RENDER: [&str; 4] = ["render", "a.scene.toml", "--path", "a.csv"];

#[test]
fn one_run_writes_every_kind_of_file_with_the_same_amplitudes() {
    let lab = Lab::with_scene();
    let files = [
        "--out",
        "amplitudes.csv",
        "--wav",
        "w.wav",
        "--wav-format",
        "archive",
        "--hjif",
        "h.hjif",
        "--frames",
        "f.csv",
    ];
    assert_eq!(lab.print(&[&RENDER[..], &files].concat()), "");
    let amplitudes = Rows::read(&lab.path("amplitudes.csv"));
    let (low_um, high_um) = (amplitudes.numbers("a40_um"), amplitudes.numbers("a320_um"));
    let n_ticks = low_um.len() / 24;

    let wav = hound::WavReader::open(lab.path("w.wav")).unwrap();
    let spec = wav.spec();
    assert_eq!(
        (spec.channels, spec.sample_rate, spec.bits_per_sample),
        (24, 8000, 16)
    );
    assert_eq!(wav.duration() as usize, 200 * n_ticks);

    let haptics: serde_json::Value = serde_json::from_str(&lab.read("h.hjif")).unwrap();
    let channels = haptics["perceptions"][0]["channels"].as_array().unwrap();
    assert_eq!(channels.len(), 24);
    for (contactor, channel) in channels.iter().enumerate() {
        for (band, um) in [&low_um, &high_um].into_iter().enumerate() {
            let keyframes = &channel["bands"][band]["effects"][0]["keyframes"];
            assert_eq!(keyframes.as_array().unwrap().len(), n_ticks + 1);
            for tick in 0..n_ticks {
                let share = keyframes[tick]["amplitude_modulation"].as_f64().unwrap();
                let found_um = share * channel["gain"].as_f64().unwrap() * 50.0;
                let expected_um = um[24 * tick + contactor];
                assert!(
                    (found_um - expected_um).abs() < 1e-4,
                    "{tick} {contactor} {band}"
                );
            }
        }
    }
    check_codes(&lab.read("f.csv"), [&low_um, &high_um]);
}

/// Codes are the amplitudes of a table, as a share of 50 µm.
fn check_codes(text: &str, [low_um, high_um]: [&[f64]; 2]) {
    let n_ticks = low_um.len() / 24;
    assert!(text.starts_with("# program = selvedge"), "{text}");
    let table: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(table.len(), 1 + n_ticks, "a header and a row a tick");
    let last: Vec<f64> = table[n_ticks]
        .split(',')
        .map(|n| n.parse().unwrap())
        .collect();
    assert_eq!(last.len(), 2 + 48, "tick, time and two codes a contactor");
    for contactor in 0..24 {
        let row = 24 * (n_ticks - 1) + contactor;
        let [low, high] = [low_um[row], high_um[row]].map(|um| 65535.0 * um / 50.0);
        let is_guarded = low + high > 65535.0;
        let close = |code: f64, exact: f64| (code - exact).abs() <= 0.51;
        let codes = [last[2 + 2 * contactor], last[3 + 2 * contactor]];
        assert!(
            is_guarded || (close(codes[0], low) && close(codes[1], high)),
            "{codes:?} for {low} {high}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_one_line_and_leaves_nothing() {
    let lab = Lab::with_scene();
    for option in ["--wav", "--hjif", "--frames", "--out"] {
        let args = [&RENDER[..], &[option, "/dev/full"]].concat();
        let outcome = lab.run(&args);
        assert_eq!(outcome.code, 1, "{option}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
        assert!(outcome.err.contains("No space left"), "{}", outcome.err);
    }
}
