//! The other commands on good input, run as a user runs them.

use std::io::{BufRead as _, BufReader, Read as _};
use std::process::Stdio;

use crate::program::{Lab, Rows};

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
