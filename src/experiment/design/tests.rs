//! Designs: those that are shipped are read, and what is wrong is said with its line.

use std::path::Path;

use super::*;

/// The message of a text's first flaw.
fn described(text: &str) -> String {
    match Design::from_toml(text, Path::new("a.toml")) {
        Ok(design) => panic!("{} was taken", design.title),
        Err(error) => error.to_string(),
    }
}

const HEAD: &str = "study = \"s\"\nexperiment = \"e\"\nmedium = \"array\"\nseed = 1\n";

#[test]
fn every_shipped_design_is_read_and_has_a_title() {
    for name in Design::shipped_names() {
        let text = Design::shipped_text(name).unwrap_or_default();
        let design = match Design::from_toml(text, Path::new(name)) {
            Ok(design) => design,
            Err(error) => panic!("{name}: {error}"),
        };
        assert!(!design.title.is_empty(), "{name}");
        assert_eq!(design.hash.len(), 64, "{name}");
    }
}

#[test]
fn an_unknown_medium_is_refused_with_those_that_are_known() {
    let text = HEAD.replace("array", "stylus");
    let described = described(&format!("{text}[magnitude]\n"));
    assert!(described.contains("a.toml:3:"), "{described}");
    assert!(
        described.contains("\"array\" or \"real-cloth\""),
        "{described}"
    );
}

#[test]
fn a_design_asks_exactly_one_thing() {
    let none = described(HEAD);
    assert!(none.contains("nothing is asked"), "{none}");
    let two = described(&format!(
        "{HEAD}[magnitude]\n[ranking]\ntarget = \"virtual\"\n"
    ));
    assert!(two.contains("2 tables say what is asked"), "{two}");
}

#[test]
fn fifteen_textiles_cannot_be_ranked_in_fours() {
    let ids: Vec<String> = (0..15).map(|n| format!("\"t{n}\"")).collect();
    let text = format!(
        "{HEAD}textiles = [{}]\n[ranking]\ntarget = \"virtual\"\n",
        ids.join(", ")
    );
    let described = described(&text);
    assert!(
        described.contains("a.toml:7: 15 stimuli cannot be ranked"),
        "{described}"
    );
}

#[test]
fn two_stimuli_of_one_name_are_refused_at_the_second() {
    let stimuli = "[[stimulus]]\nid = \"a\"\n[[stimulus]]\nid = \"a\"\n";
    let described = described(&format!("{HEAD}{stimuli}[magnitude]\n"));
    assert!(
        described.contains("a.toml:8: two stimuli are called \"a\""),
        "{described}"
    );
}

#[test]
fn a_series_that_nothing_ends_is_refused() {
    let levels = "[levels]\nband_hz = 40\nrange_db = [0, 20]\n[levels.staircase]\nup = 1\n\
                  down = 2\nsteps_db = [2.0]\nstarts_db = [10.0]\n";
    let described = described(&format!("{HEAD}{levels}"));
    assert!(described.contains("nothing ends a series"), "{described}");
}

#[test]
fn a_misspelt_key_is_named_with_its_line() {
    let described = described(&format!("{HEAD}[magnitude]\nrepeat = 3\n"));
    assert!(
        described.contains("a.toml:6:") && described.contains("`repeat`"),
        "{described}"
    );
}
