//! `selvedge doctor` on machines that lack something.

use std::fs;

use serde_json::Value;

use crate::program::{Lab, Outcome};

/// What is found on this machine with the settings of the lab.
fn findings(lab: &Lab) -> (i32, Value) {
    let mut command = lab.command(&["doctor", "--json"]);
    let output = command.env("XDG_CONFIG_HOME", lab.path("config")).output();
    let outcome = Outcome::of(&output.unwrap());
    let found = serde_json::from_str(&outcome.out);
    (
        outcome.code,
        found.unwrap_or_else(|_| panic!("{outcome:?}")),
    )
}

/// How it stands with something, and what is said of it.
fn finding(found: &Value, name: &str) -> (String, String) {
    let all = found["findings"].as_array().unwrap();
    let one = all.iter().find(|one| one["name"] == name);
    let one = one.unwrap_or_else(|| panic!("{name}: {found}"));
    let word = |key: &str| one[key].as_str().unwrap().to_owned();
    (word("state"), word("what"))
}

#[test]
fn a_broken_setting_is_named_with_its_line_and_left_where_it_is() {
    let lab = Lab::named("doctor");
    let (_, before) = findings(&lab);
    let (state, what) = finding(&before, "settings");
    assert_eq!(state, "ok", "there is none yet: {what}");
    assert!(!lab.path("config").exists(), "nothing is made");
    for name in ["library", "rendering", "emulator"] {
        let (state, what) = finding(&before, name);
        assert_eq!(state, "ok", "{name}: {what}");
    }
    if cfg!(target_os = "linux") {
        let (state, what) = finding(&before, "display");
        assert_eq!(state, "note", "{what}");
        assert!(what.contains("set DISPLAY or WAYLAND_DISPLAY"), "{what}");
    }

    let file = "config/selvedge/settings.toml";
    for (text, expected) in [
        (
            "theme = \"dark\"\nzoom_percent = \"large\"\n",
            "settings.toml:2: ",
        ),
        ("theme = \n", "settings.toml:1: "),
    ] {
        lab.write(file, text);
        let (code, found) = findings(&lab);
        let (state, what) = finding(&found, "settings");
        assert_eq!((code, state.as_str()), (1, "wrong"), "{what}");
        assert!(
            what.contains(expected) && what.contains("; mend it"),
            "{what}"
        );
        assert_eq!(found["is_usable"], false);
        assert_eq!(lab.read(file), text, "it is not set aside");
    }
    // Whoever runs it, a folder is no file that can be read.
    fs::remove_file(lab.path(file)).unwrap();
    fs::create_dir(lab.path(file)).unwrap();
    let (state, what) = finding(&findings(&lab).1, "settings");
    assert_eq!(state, "wrong", "{what}");
    assert!(what.contains("cannot read"), "{what}");
}
