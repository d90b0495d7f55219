//! The commands on good input, run as a user runs them.

use std::io::{BufRead as _, BufReader, Read as _};
use std::process::Stdio;

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
fn a_library_is_listed_shown_and_measured() {
    let lab = Lab::with_scene();
    let library = ["--library", "textiles"];
    let list = lab.print(&[&["textile", "list"], &library[..]].concat());
    assert_eq!(
        list.lines()
            .map(|l| l.split_whitespace().next().unwrap())
            .collect::<Vec<_>>(),
        ["fine", "flat"]
    );
    let shown = lab.print(&[&["textile", "show", "fine"], &library[..]].concat());
    assert!(
        shown.contains("fall-back     no weft_forward: warp_forward is felt there"),
        "{shown}"
    );
    let levels = lab.print(&[&["textile", "levels"], &library[..]].concat());
    let levels = Rows::parse(&levels);
    assert_eq!(
        levels.header(),
        "textile,a40_um,a320_um,level_db,cv40,cv320,anisotropy40_db,anisotropy320_db,\
         tuned_a40_um,tuned_a320_um,low40_db,high40_db,low320_db,high320_db"
    );
    assert!(
        (levels.numbers("a320_um")[0] - 4.0).abs() < 0.04,
        "3.2 cycles/mm at 100 mm/s"
    );
    assert_eq!(
        levels.text("level_db")[1],
        "",
        "a flat textile has no level"
    );
    let spectra = lab.print(&[&["textile", "spectra", "fine"], &library[..]].concat());
    let spectra = Rows::parse(&spectra);
    assert_eq!(
        spectra.header(),
        "direction,point,wavenumber_per_mm,power_um2"
    );
    assert_eq!(spectra.len(), 4 * 16 * 500);
    let power: f64 = spectra.numbers("power_um2")[..500].iter().sum();
    assert!(
        (power - 8.0).abs() < 0.08,
        "half the square of the amplitude: {power}"
    );
}

#[test]
fn the_shipped_library_has_sixteen_textiles_and_its_scenes_open() {
    let lab = Lab::new();
    assert_eq!(lab.print(&["textile", "list"]).lines().count(), 16);
    lab.write("a.csv", "t_s,x_mm,y_mm\n0,70,70\n0.1,80,75\n");
    for scene in [
        "four-alternatives",
        "all-sixteen",
        "five-brownian",
        "wall-harwin",
    ] {
        let text = format!(
            "{}/assets/scenes/{scene}.scene.toml",
            env!("CARGO_MANIFEST_DIR")
        );
        let rows = Rows::parse(&lab.print(&["render", &text, "--path", "a.csv"]));
        assert!(
            rows.numbers("a320_um").iter().any(|&um| um > 0.1),
            "{scene} can be felt"
        );
    }
}

#[test]
fn a_recipe_makes_the_textile_that_it_was_printed_from() {
    let lab = Lab::new();
    let recipe = lab.print(&["textile", "show", "wool-twill", "--recipe"]);
    lab.write("r.toml", recipe);
    lab.print(&[
        "textile",
        "make",
        "weave",
        "r.toml",
        "--out",
        "textiles/mine",
    ]);
    let of = |args: &[&str]| lab.print(&[&["textile", "spectra"], args].concat());
    assert_eq!(of(&["mine", "--library", "textiles"]), of(&["wool-twill"]));
    let line = lab.refuse(&[
        "textile",
        "make",
        "knit",
        "r.toml",
        "--out",
        "textiles/other",
    ]);
    assert!(line.contains("kind \"weave\", not \"knit\"; use"), "{line}");
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let lab = Lab::with_scene();
    lab.write("long.csv", "t_s,x_mm,y_mm\n0,15,40\n500,65,40\n");
    let mut child = lab
        .command(&["render", "a.scene.toml", "--path", "long.csv"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut line)
        .unwrap();
    assert!(line.starts_with("tick,"), "{line}");
    let mut err = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut err)
        .unwrap();
    // A busy machine may need longer than the second after which progress is told.
    let is_progress =
        |line: &&str| line.starts_with("selvedge: rendering ") && line.contains(" %, ");
    let said: Vec<&str> = err.lines().filter(|line| !is_progress(line)).collect();
    assert_eq!((child.wait().unwrap().code(), said), (Some(0), vec![]));
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
    let line = lab.refuse(&[&RENDER[..], &["--band", "low.csv"]].concat());
    assert!(line.contains("LOW.csv,HIGH.csv"), "{line}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_nothing_behind() {
    let lab = Lab::with_scene();
    lab.write("long.csv", "t_s,x_mm,y_mm\n0,15,40\n900000,65,40\n");
    let args = [
        "render",
        "a.scene.toml",
        "--path",
        "long.csv",
        "--out",
        "o.csv",
    ];
    let child = lab.command(&args).stderr(Stdio::piped()).spawn().unwrap();
    let n_files = || std::fs::read_dir(lab.path("")).unwrap().count();
    // Scene, two paths and the library; then the file that is being written.
    while n_files() < 5 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    for _ in 0..2 {
        let kill = ["-INT".to_owned(), child.id().to_string()];
        std::process::Command::new("kill")
            .args(kill)
            .status()
            .unwrap();
    }
    let outcome = crate::program::Outcome::of(&child.wait_with_output().unwrap());
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(
        outcome
            .one_line()
            .starts_with("stopped before the work was done"),
        "{outcome:?}"
    );
    assert_eq!(n_files(), 4, "no part of a file is left");
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_display_the_workbench_says_what_works_without_one() {
    let lab = Lab::new();
    let line = lab.refuse(&[]);
    for word in [
        "no display",
        "screenshot",
        "render",
        "play",
        "textile",
        "bridge",
    ] {
        assert!(line.contains(word), "{word}: {line}");
    }
}

#[test]
fn the_guide_is_printed_page_by_page() {
    let lab = Lab::named("guide");
    let list = lab.print(&["help"]);
    for page in selvedge_workbench::guide_pages() {
        assert!(list.contains(page.name), "{list}");
        assert_eq!(lab.print(&["help", page.name]), page.text);
    }
}

#[test]
fn help_and_version_are_results() {
    let lab = Lab::new();
    assert!(
        lab.print(&["--help"])
            .contains("Usage: selvedge [OPTIONS] [SCENE]")
    );
    assert!(lab.print(&["--version"]).starts_with("selvedge "));
    for command in [
        "render",
        "play",
        "textile",
        "bridge",
        "report",
        "screenshot",
    ] {
        assert!(
            lab.print(&[command, "--help"])
                .contains(&format!("selvedge {command}"))
        );
    }
}

#[test]
fn ports_can_be_listed_anywhere() {
    let outcome = Lab::new().run(&["bridge", "list"]);
    assert_eq!(outcome.code, 0, "{outcome:?}");
}

#[test]
fn the_seventy_four_are_listed_without_building_one() {
    let lab = Lab::with_scene();
    let library = ["--library", "seventy-four"];
    let list = lab.print(&[&["textile", "list"], &library[..]].concat());
    assert_eq!(list.lines().count(), 74);
    let select = lab.print(&[&["textile", "select"], &library[..]].concat());
    let mut chosen: Vec<&str> = select.lines().filter_map(|l| l.split(' ').next()).collect();
    let shipped = lab.print(&["textile", "list"]);
    let mut main: Vec<&str> = shipped
        .lines()
        .filter_map(|l| l.split(' ').next())
        .collect();
    chosen.sort_unstable();
    main.sort_unstable();
    assert_eq!(chosen, main, "the most typical are the main library");
    let show = [&["textile", "show", "denim-back", "--recipe"], &library[..]].concat();
    assert!(
        lab.print(&show).contains("side = \"back\""),
        "the other side"
    );
}

#[test]
fn a_file_of_recipes_is_built_into_a_library() {
    let lab = Lab::with_scene();
    let recipes = "[[textile]]\nid = \"a\"\nname = \"A\"\nconstruction = \"woven\"\n\
        fibre = \"wool\"\nsource = { kind = \"weave\", seed = 1, interlacing = \"plain\", \
        warp_per_cm = 12, weft_per_cm = 12, warp = { width_um = 500, thickness_um = 150, \
        colour = \"#888888\" }, weft = { width_um = 500, thickness_um = 150, \
        colour = \"#999999\" } }\n[[textile]]\nid = \"b\"\nlike = \"a\"\n\
        source.interlacing = \"herringbone\"\n";
    lab.write("two.toml", recipes);
    let build = ["textile", "build", "--library", "two.toml", "--out", "two"];
    // On a busy machine these say how far they are, so stderr is not looked at.
    let said = lab.run(&[&build[..], &["--threads", "2"]].concat()).out;
    assert!(
        said.starts_with("two: 2 textiles in ") && said.contains("2 threads"),
        "{said}"
    );
    let levels = |library: &str| lab.run(&["textile", "levels", "--library", library]).out;
    assert_eq!(levels("two").lines().count(), 3);
    // Without a library.toml beside the recipes their mean level is the reference as well.
    assert_eq!(
        levels("two"),
        levels("two.toml"),
        "built before or on the spot"
    );
    let table = ["textile", "levels", "--library", "two", "--out", "l.csv"];
    let spans = lab.run(&table).out;
    assert!(spans.starts_with("2 surfaces; A40 spans "), "{spans}");
}
