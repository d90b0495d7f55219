//! `selvedge textile import` and `convert`, run as a user runs them.

use crate::program::Lab;

/// A matrix of 220 × 200 heights: a ripple along u, one point missing.
fn matrix() -> String {
    let row = |w: usize| {
        let height = |u: usize| 5.0 * (u as f64 * 0.3).sin() + 0.01 * w as f64;
        let cells: Vec<String> = (0..220)
            .map(|u| match (u, w) {
                (3, 4) => "nan".to_owned(),
                _ => format!("{:.6}", height(u)),
            })
            .collect();
        format!("{}\n", cells.join("\t"))
    };
    (0..200).map(row).collect()
}

const SCALE: [&str; 4] = ["--height-unit", "um", "--step-mm", "0.05"];

#[test]
fn a_height_map_becomes_a_textile_that_says_where_it_came_from() {
    let lab = Lab::new();
    lab.write("map.txt", matrix());
    let import = ["textile", "import", "map.txt", "--out", "library/mine"];
    let line = lab.refuse(&import);
    assert!(
        line.contains("the unit of the heights is not stated"),
        "{line}"
    );
    let outcome = lab.run(&[&import[..], &SCALE, &["--at", "5,4", "--name", "Ripple"]].concat());
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(
        outcome
            .err
            .contains("1 of 44000 points are missing: filled"),
        "{outcome:?}"
    );
    let manifest = lab.read("library/mine/textile.toml");
    for part in [
        "name = \"Ripple\"",
        "kind = \"heightmap\"",
        "file = \"map.txt\"",
        "sha256 = ",
        "place_mm = [5.0, 4.0]",
        "n_missing = 1",
        "weft_reverse = \"weft_reverse.csv\"",
    ] {
        assert!(manifest.contains(part), "{part} in {manifest}");
    }
    let shown = lab.print(&["textile", "show", "mine", "--library", "library"]);
    assert!(shown.contains("points        7, 7, 6, 6"), "{shown}");
    // The same without the profiles: they are made when they are needed.
    let bare: Vec<&str> = manifest
        .lines()
        .filter(|line| !line.contains(".csv\""))
        .collect();
    lab.write("library/bare/textile.toml", bare.join("\n"));
    lab.write("library/bare/appearance.png", "");
    lab.write("library/bare/map.txt", matrix());
    let of = |id: &str| lab.print(&["textile", "show", id, "--library", "library"]);
    assert_eq!(of("bare").replace("bare", "mine"), of("mine"));
    lab.write("library/bare/map.txt", matrix().replace("nan", "1"));
    let line = lab.refuse(&["textile", "show", "bare", "--library", "library"]);
    assert!(
        line.contains("not the file whose sha256 the manifest states"),
        "{line}"
    );
}

#[test]
fn a_map_shorter_than_a_window_is_felt_only_as_a_repeat() {
    let lab = Lab::new();
    lab.write("map.txt", matrix());
    let args = [
        "textile",
        "import",
        "map.txt",
        "--out",
        "small",
        "--height-unit",
        "um",
    ];
    let short = [&args[..], &["--step-mm", "0.01"]].concat();
    let line = lab.refuse(&short);
    assert!(
        line.contains("2.20 mm × 2.00 mm") && line.contains("--periodic"),
        "{line}"
    );
    assert_eq!(lab.run(&[&short[..], &["--periodic"]].concat()).code, 0);
    let rows = lab.read("small/warp_forward.csv").lines().count() - 1;
    assert_eq!(rows, 10 * 220, "20 mm or more, in whole repeats");
    let line = lab.refuse(&[&short[..], &["--periodic", "--at", "9,1"]].concat());
    assert!(
        line.contains("not on the map; give one from 0, 0 to 2.20, 2.00 mm"),
        "{line}"
    );
}

#[test]
fn heights_are_converted_between_formats_and_holes_are_not_painted_over() {
    let lab = Lab::new();
    lab.write("map.txt", matrix());
    lab.print(
        &[
            &["textile", "convert", "map.txt", "--out", "a.x3p"][..],
            &SCALE,
        ]
        .concat(),
    );
    let line = lab.refuse(&["textile", "convert", "a.x3p", "--out", "a.png"]);
    assert!(
        line.contains("1 points are missing") && line.contains("--fill"),
        "{line}"
    );
    for out in ["a.gsf", "a.npy", "b.x3p"] {
        lab.print(&["textile", "convert", "a.x3p", "--out", out]);
    }
    let filled = lab.run(&["textile", "convert", "a.x3p", "--fill", "--out", "a.png"]);
    assert!(
        filled.err.contains("1 missing points were filled"),
        "{filled:?}"
    );
    let made = lab.print(&["textile", "convert", "a.png", "--out", "c.x3p"]);
    assert_eq!(made, "c.x3p: 220 × 200 points\n");
    let bytes = |name: &str| std::fs::read(lab.path(name)).unwrap();
    assert_eq!(bytes("a.gsf").len() % 4, 0);
    assert_eq!(&bytes("a.x3p")[..4], b"PK\x03\x04");
    let line = lab.refuse(&["textile", "convert", "a.x3p", "--out", "a.bmp"]);
    assert!(line.contains(".x3p, .gsf, .npy, .png or .tif"), "{line}");
}

#[test]
fn one_import_makes_a_textile_for_every_place() {
    let lab = Lab::new();
    lab.write("map.txt", matrix());
    let import = ["textile", "import", "map.txt", "--out", "library/mine"];
    let places = ["--place", "5,4", "--place", "6,5", "--name", "Ripple"];
    let words = ["--fibre", "silk", "--figure", "weight_mg_per_cm2=7.5"];
    let all = [&import[..], &SCALE, &places, &words].concat();
    let outcome = lab.run(&all);
    assert_eq!(
        outcome.out,
        "library/mine-1: Ripple 1\nlibrary/mine-2: Ripple 2\n"
    );
    for (id, place) in [("mine-1", "[5.0, 4.0]"), ("mine-2", "[6.0, 5.0]")] {
        let manifest = lab.read(&format!("library/{id}/textile.toml"));
        for part in [
            &format!("place_mm = {place}"),
            "fibre = \"silk\"",
            "weight_mg_per_cm2 = 7.5",
        ] {
            assert!(manifest.contains(part), "{part} in {manifest}");
        }
    }
    let line = lab.refuse(&[&all[..], &["--place", "90,1"]].concat());
    assert!(
        line.contains("the place 90.00, 1.00 mm is not on the map"),
        "{line}"
    );
    assert!(
        !lab.path("library/mine-3").exists(),
        "nothing is left behind"
    );
    let line = lab.refuse(&[&all[..], &["--areal"]].concat());
    assert!(line.contains("--areal feels the whole map; "), "{line}");
    let areal = [&import[..4], &["library/whole", "--areal"], &SCALE].concat();
    assert_eq!(lab.run(&areal).code, 0);
    assert!(
        lab.read("library/whole/textile.toml")
            .contains("representation = \"areal\"")
    );
    assert!(
        lab.path("library/whole/map.txt").exists(),
        "it lies beside the manifest"
    );
}

/// Every file of a folder by its name.
fn all_files(lab: &Lab, folder: &str) -> std::collections::BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(lab.path(folder)).unwrap();
    let file = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read(&path).unwrap())
    };
    entries.map(file).collect()
}

#[test]
fn every_step_of_preparing_a_map_is_kept_and_runs_again_bit_for_bit() {
    let lab = Lab::new();
    let spiked = matrix().replacen("nan", "4000", 1);
    lab.write("map.txt", spiked);
    let import = ["textile", "import", "map.txt", "--out", "library/mine"];
    let steps = [
        "--crop",
        "0,2,9,10",
        "--despike",
        "9",
        "--level",
        "quadratic",
    ];
    let outcome = lab.run(&[&import[..], &SCALE, &steps].concat());
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(outcome.err.contains("180 × 160 points"), "{outcome:?}");
    assert!(outcome.err.contains("1 points are spikes"), "{outcome:?}");
    let manifest = lab.read("library/mine/textile.toml");
    for part in [
        "crop_mm = [0.0, 2.0, 9.0, 10.0]",
        "despike = 9.0",
        "level = \"quadratic\"",
        "n_missing = 1",
    ] {
        assert!(manifest.contains(part), "{part} in {manifest}");
    }
    let made = all_files(&lab, "library/mine");
    let again = ["textile", "rebuild", "library/mine"];
    let line = lab.refuse(&again);
    assert!(
        line.contains("map.txt, is not in the folder; say where it is"),
        "{line}"
    );
    let from = [&again[..], &["--file", "map.txt"]].concat();
    let line = lab.print(&from);
    assert_eq!(
        line,
        "library/mine: 6 files made again, 0 of them changed\n"
    );
    assert_eq!(all_files(&lab, "library/mine"), made);
    // Another step in the manifest is another textile.
    let plane = manifest.replace("level = \"quadratic\"", "level = \"plane\"");
    lab.write("library/mine/textile.toml", plane);
    assert!(
        lab.print(&from).contains("5 of them changed"),
        "another surface"
    );
    assert!(
        lab.read("library/mine/textile.toml").contains("\"plane\""),
        "kept"
    );
    for wrong in ["0,0,90,8", "4,4,1,1"] {
        let line = lab.refuse(&[&import[..], &SCALE, &["--crop", wrong]].concat());
        assert!(line.contains("is not on the map; give crop_mm"), "{line}");
    }
}

#[test]
fn a_map_with_more_than_half_its_points_missing_is_refused() {
    let lab = Lab::new();
    let rows: Vec<String> = matrix().lines().map(str::to_owned).collect();
    let empty = vec!["nan"; 220].join("\t");
    let half = |n: usize| {
        let lost = std::iter::repeat_n(empty.clone(), n);
        let there = rows[n..].iter().cloned();
        there.chain(lost).collect::<Vec<_>>().join("\n")
    };
    let import = ["textile", "import", "map.txt", "--out", "mine"];
    lab.write("map.txt", half(101));
    let line = lab.refuse(&[&import[..], &SCALE].concat());
    assert!(
        line.contains("22220 of 44000 points are missing, more than half"),
        "{line}"
    );
    lab.write("map.txt", half(99));
    assert_eq!(lab.run(&[&import[..], &SCALE].concat()).code, 0);
}
