//! The command line itself: what is almost a command, one file named twice, streams, completions
//! and manual pages.

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
