//! The command line itself: what is almost a command or a name, one file named twice, streams,
//! tables as JSON, silence, signals, completions and manual pages.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::program::Lab;

/// Words of a line that no word needs quotes in.
fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

#[test]
fn what_is_almost_a_command_is_told_at_every_level() {
    let lab = Lab::with_scene();
    for (line, meant) in [
        ("rendr", "did you mean render?"),
        ("rendr a.scene.toml --path a.csv", "did you mean render?"),
        ("help rendr", "did you mean render?"),
        ("help bridge tst", "did you mean test?"),
        ("textile shwo denim", "'show'"),
        ("render a.scene.toml --pth a.csv", "'--path'"),
        ("render a.scene.toml --path a.csv --method bandd", "banded"),
        ("textile show silk-crpe", "did you mean silk-crepe?"),
        ("textile spectra denin", "did you mean denim?"),
        ("probe --surface denin --drop 1", "did you mean denim?"),
        ("report --out r --only rendring", "did you mean rendering?"),
        (
            "experiment designs --show ranking-virtual-traget",
            "did you mean ranking-virtual-target?",
        ),
        (
            "experiment preview ranking-virtual-traget",
            "did you mean ranking-virtual-target?",
        ),
    ] {
        let said = lab.refuse(&words(line));
        assert!(said.contains(meant), "{line}: {said}");
    }
    let said = lab.refuse(&["nonsense", "more"]);
    assert!(said.contains("see \"selvedge --help\""), "{said}");
}

#[test]
fn a_command_is_explained_by_help_as_by_its_option() {
    let lab = Lab::new();
    for command in ["render", "textile make", "bridge test"] {
        let explained = lab.print(&words(&format!("help {command}")));
        assert_eq!(explained, lab.print(&words(&format!("{command} --help"))));
    }
    let render = lab.print(&["render", "--help"]);
    assert!(render.contains("Examples:\n  selvedge render "), "{render}");
}

#[test]
fn one_file_for_two_results_and_a_result_over_its_source_are_refused() {
    let lab = Lab::with_scene();
    let render =
        |more: &str| lab.refuse(&words(&format!("render a.scene.toml --path a.csv {more}")));
    let before = [lab.read("a.csv"), lab.read("a.scene.toml")];
    let said = render("--out b --wav ./b");
    assert!(said.starts_with("--out and --wav are both"), "{said}");
    for source in ["a.csv", "textiles/../a.csv", "a.scene.toml"] {
        let said = render(&format!("--out {source}"));
        assert!(said.contains("would overwrite"), "{said}");
    }
    for band in ["a.csv,h.csv", "h.csv,a.csv"] {
        let said = render(&format!("--band {band}"));
        assert!(said.starts_with("--band would overwrite a.csv"), "{said}");
    }
    let said = render("--band x,x");
    assert!(said.starts_with("--band and --band are both"), "{said}");
    lab.write("page.txt", lab.read("a.csv"));
    let said = lab.refuse(&words("figure a.scene.toml --path page.txt --out page"));
    assert!(said.contains("would overwrite page.txt"), "{said}");
    let said = render("--out - --stats -");
    assert!(said.contains("both standard output"), "{said}");
    assert_eq!([lab.read("a.csv"), lab.read("a.scene.toml")], before);
    assert!(!lab.path("b").exists(), "nothing is made");
}

#[test]
fn rates_that_cannot_hold_320_hz_and_pictures_that_are_no_png_are_refused() {
    let lab = Lab::with_scene();
    let line = "render a.scene.toml --path a.csv --wav w.wav --wav-rate";
    for rate in ["40", "639"] {
        let said = lab.refuse(&words(&format!("{line} {rate}")));
        assert!(said.contains("640 Hz or above"), "{said}");
    }
    lab.print(&words(&format!("{line} 640")));
    let said = lab.refuse(&["screenshot", "--out", "s.bmp"]);
    assert!(
        said.contains("call it .png") && !lab.path("s.bmp").exists(),
        "{said}"
    );
}

#[cfg(unix)]
#[test]
fn a_path_and_a_table_come_from_standard_input() {
    let lab = Lab::with_scene();
    let fed = |line: &str, text: &str| lab.run_on(&words(line), text);
    let path = lab.read("a.csv");
    let by_stream = fed("render a.scene.toml --path -", &path);
    assert_eq!(
        by_stream.out,
        lab.print(&words("render a.scene.toml --path a.csv"))
    );
    let wrong = fed("render a.scene.toml --path -", "t_s,x_mm\n0,1\n");
    assert_eq!(wrong.code, 2);
    assert!(wrong.one_line().starts_with("/dev/stdin:1: "), "{wrong:?}");
    let table = "0,1,2\n1,0,1.5\n2,1.5,0\n";
    lab.write("d.csv", table);
    let by_stream = fed("mds - --dims 1", table);
    assert_eq!(
        (by_stream.code, by_stream.out),
        (0, lab.run(&words("mds d.csv --dims 1")).out)
    );
    // What a scene names lies beside where the command was given.
    let scene = lab.read("a.scene.toml");
    let drawn = fed("figure - --path a.csv --out page", &scene);
    assert!(
        drawn.code == 0 && lab.path("page.svg").exists(),
        "{drawn:?}"
    );
    let hung = "name = \"a\"\nlibrary = \"nowhere\"\ntextile = \"denim\"\n";
    let placed = scene.replace("library = \"", "library = \"nowhere/");
    for (line, text) in [
        ("figure - --path a.csv --out page", &*placed),
        ("drape -", hung),
    ] {
        let said = fed(line, text);
        let is_here = said.err.contains("nowhere") && !said.err.contains("/dev/");
        assert!(said.code == 2 && is_here, "{line}: {said:?}");
    }
}

#[test]
fn shells_complete_commands_and_manuals_have_a_page_for_each() {
    let lab = Lab::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = lab.print(&["completions", shell]);
        let is_whole = ["selvedge", "wav-rate", "emulate"]
            .iter()
            .all(|word| script.contains(word));
        assert!(is_whole, "{shell}: {script}");
    }
    lab.refuse(&["completions", "cmd"]);
    let said = lab.run(&["man", "pages/man1"]);
    assert_eq!((said.code, &*said.out), (0, ""), "{said:?}");
    for page in [
        "selvedge",
        "selvedge-render",
        "selvedge-textile-make",
        "selvedge-help",
    ] {
        let text = lab.read(&format!("pages/man1/{page}.1"));
        assert!(
            text.contains(".SH NAME") && text.contains(".SH SYNOPSIS"),
            "{page}: {text}"
        );
    }
    let render = lab.read("pages/man1/selvedge-render.1");
    assert!(
        render.contains("Examples:") && render.contains("wav"),
        "{render}"
    );
    lab.write("file", "");
    assert!(
        lab.refuse(&["man", "file"])
            .contains("cannot make the folder")
    );
}

#[test]
fn a_quiet_command_says_nothing_but_what_is_wrong() {
    let lab = Lab::with_scene();
    let probe = "probe --surface flat --stroke 0,0:10,0 --seconds 0.1 --out";
    assert_ne!(lab.run(&words(&format!("{probe} a1.csv"))).err, "");
    for line in [
        format!("{probe} a2.csv --quiet"),
        format!("-q {probe} a3.csv"),
        format!("--quiet {probe} a4.csv"),
    ] {
        lab.print(&words(&line));
    }
    assert_eq!(lab.read("a1.csv"), lab.read("a4.csv"));
    lab.refuse(&words("--quiet textile show nothing-of-the-kind"));
}

#[test]
fn tables_are_told_as_json_too() {
    let lab = Lab::with_scene();
    let rows = |line: &str| -> Vec<serde_json::Value> {
        serde_json::from_str(&lab.print(&words(line))).unwrap()
    };
    let textiles = rows("textile list --json");
    assert_eq!(textiles.len(), 16);
    let plain = lab.print(&["textile", "list"]);
    for (row, line) in textiles.iter().zip(plain.lines()) {
        let id = row["id"].as_str().unwrap();
        assert!(
            line.starts_with(id) && line.ends_with(row["name"].as_str().unwrap()),
            "{line}"
        );
    }
    let shown = rows("textile show denim --json");
    let told = lab.print(&words("textile show denim"));
    assert_eq!(shown.len(), told.lines().count());
    for row in &shown {
        assert!(told.contains(row["value"].as_str().unwrap()), "{row}");
    }
    let designs = rows("experiment designs --json");
    assert_eq!(
        designs.len(),
        lab.print(&words("experiment designs")).lines().count()
    );
    assert!(
        designs
            .iter()
            .any(|row| row["name"] == "ranking-virtual-target")
    );
    let preview = rows("experiment preview ranking-virtual-target --json");
    let trials = preview.iter().find(|row| row["what"] == "trials").unwrap();
    assert!(trials["value"].as_f64().unwrap() > 0.0);
    let studies = rows("report --list --json");
    let is_it = |row: &serde_json::Value| row["study"] == "stability";
    assert!(studies.iter().any(is_it), "{studies:?}");
    for row in rows("bridge list --json --quiet") {
        assert!(row["kind"].is_string(), "{row}");
    }
    let simulate = "experiment simulate ranking-virtual-target --observers 1 --out logs";
    assert_eq!(lab.run(&words(simulate)).code, 0);
    let verified = rows("experiment verify logs --json");
    assert!(verified.contains(&serde_json::json!({"what": "broken", "value": 0.0})));
}

#[cfg(unix)]
#[test]
fn scenes_and_heights_are_read_from_standard_input_and_waves_written_to_standard_output() {
    let lab = Lab::with_scene();
    let fed = |line: &str, text: &str| lab.run_on(&words(line), text);
    let by_file = lab.print(&words("render a.scene.toml --path a.csv"));
    let by_stream = fed("render - --path a.csv", &lab.read("a.scene.toml"));
    assert_eq!((by_stream.code, by_stream.out), (0, by_file));
    let wrong = fed("render - --path a.csv", "name = 1\n");
    assert!(wrong.one_line().starts_with("-:1: "), "{wrong:?}");

    lab.print(&words(
        "render a.scene.toml --path a.csv --wav w.wav --hjif h.hjif",
    ));
    for (kind, file) in [("wav", "w.wav"), ("hjif", "h.hjif")] {
        let line = format!("render a.scene.toml --path a.csv --{kind} -");
        let printed = lab.command(&words(&line)).output().unwrap();
        let written = std::fs::read(lab.path(file)).unwrap();
        assert!(
            printed.stdout == written,
            "{kind}: {} bytes",
            printed.stdout.len()
        );
    }
    let heights: String = (0..64)
        .map(|y| {
            let cells = (0..64).map(|x| format!("{}", (x * y) % 7));
            cells.collect::<Vec<_>>().join(" ") + "\n"
        })
        .collect();
    lab.write("heights.txt", &heights);
    let how = "--step-mm 0.1 --height-unit um --out";
    let by_file = lab.run(&words(&format!("textile convert heights.txt {how} a.gsf")));
    assert_eq!(by_file.code, 0, "{by_file:?}");
    let by_stream = fed(&format!("textile convert - {how} b.gsf"), &heights);
    assert_eq!(by_stream.code, 0, "{by_stream:?}");
    let read = |name: &str| std::fs::read(lab.path(name)).unwrap();
    assert!(read("a.gsf") == read("b.gsf"));
}

#[test]
fn files_that_belong_together_appear_together_or_not_at_all() {
    let lab = Lab::with_scene();
    // The last of three files has no place.
    lab.write("page.txt/taken", "");
    let said = lab.refuse(&words("figure a.scene.toml --path a.csv --out page"));
    assert!(said.contains("page.txt is a folder"), "{said}");
    assert!(!lab.path("page.svg").exists() && !lab.path("page.png").exists());
    lab.print(&words("figure a.scene.toml --path a.csv --out other"));
    for ending in ["svg", "png", "txt"] {
        assert!(lab.path(&format!("other.{ending}")).is_file(), "{ending}");
    }
    lab.write("man1/selvedge-textile.1/taken", "");
    assert!(lab.refuse(&["man", "man1"]).contains("is a folder"));
    assert!(!lab.path("man1/selvedge.1").exists());
}

/// A command that listens to no signal is ended by one as ever, but for what it had half written.
#[cfg(unix)]
#[test]
fn a_signal_leaves_no_half_of_a_file() {
    let lab = Lab::new();
    // Two metres of cloth: millions of rows.
    let row = |sample: u32| format!("{:.6},{}\n", f64::from(sample) / 230.0, sample % 7);
    let rows: String = (0..460_000).map(row).collect();
    lab.add_textile("long", |_| 0.0);
    lab.write("textiles/long/warp.csv", format!("x_mm,height_um\n{rows}"));
    let half_written = || {
        let names = std::fs::read_dir(lab.path("out")).unwrap();
        let paths = names.map(|entry| entry.unwrap().path());
        paths
            .filter(|path| path.extension().is_some_and(|end| end == "part"))
            .count()
    };
    lab.write("out/other.txt", "");
    let line = "textile spectra long --library textiles --out out/spectra.csv";
    for signal in ["HUP", "INT", "TERM"] {
        let mut command = lab.command(&words(line));
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let given_up = Instant::now() + Duration::from_mins(2);
        while half_written() == 0 {
            assert!(
                child.try_wait().unwrap().is_none(),
                "it ended before it wrote"
            );
            assert!(Instant::now() < given_up, "it writes nothing");
            std::thread::sleep(Duration::from_millis(2));
        }
        let kill = std::process::Command::new("kill")
            .args([&format!("-{signal}"), &child.id().to_string()])
            .status();
        assert!(kill.unwrap().success());
        let status = child.wait().unwrap();
        let by = std::os::unix::process::ExitStatusExt::signal(&status);
        assert!(by.is_some(), "{signal}: {status}");
        assert_eq!(half_written(), 0, "{signal}");
        assert!(!lab.path("out/spectra.csv").exists(), "{signal}");
    }
}
