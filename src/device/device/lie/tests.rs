//! The table of lies as text.

use std::collections::BTreeSet;

use super::declared::{Act, Takes};
use super::fields::FIELDS;
use super::firmware::{FirmwareLie, declared};

#[test]
fn every_lie_has_a_name_of_its_own_a_rule_and_examples_that_are_read() {
    let mut names = BTreeSet::new();
    for lie in declared() {
        assert!(names.insert(lie.name), "{} stands twice", lie.name);
        let is_named = |letter: char| letter.is_ascii_lowercase() || "-.0".contains(letter);
        assert!(lie.name.chars().all(is_named), "{}", lie.name);
        assert!(lie.help.starts_with("2."), "{} names no rule", lie.name);
        assert_eq!(
            lie.takes == Takes::Nothing,
            lie.examples.is_empty(),
            "{}",
            lie.name
        );
        for example in lie.examples {
            let text = format!("{}={example}", lie.name);
            let read = FirmwareLie::read(&text).map(|lie| lie.to_string());
            assert_eq!(read.as_deref(), Ok(text.as_str()));
        }
        assert!(FirmwareLie::examples().any(|example| example.name() == lie.name));
        assert!(FirmwareLie::listing().contains(&lie.form()));
    }
}

#[test]
fn every_field_of_a_message_that_a_device_sends_has_a_lie() {
    use crate::message::kind;
    for (kind, length) in [
        (kind::CFG, 20),
        (kind::ACK, 4),
        (kind::STATUS, 36),
        (kind::FAULT, 12),
        (kind::PONG, 14),
    ] {
        let mut covered: Vec<usize> = FIELDS
            .iter()
            .filter_map(|lie| match lie.act {
                Act::Field {
                    kind: of,
                    at,
                    width,
                } if of == kind => Some(at..at + width),
                _ => None,
            })
            .flatten()
            .collect();
        covered.sort_unstable();
        assert_eq!(covered, (0..length).collect::<Vec<_>>(), "type {kind:02x}");
    }
}

#[test]
fn what_is_no_lie_is_refused_in_one_line_that_says_what_there_is() {
    for (text, words) in [
        ("caps.colour=3", "caps.rows"),
        ("caps.rows", "caps.rows=0…255"),
        ("caps.rows=256", "0…255"),
        ("caps.rows=many", "+N or -N"),
        ("hue=3", "no-ramp"),
        ("weather.rows=1", "caps."),
        ("no-ramp=3", "write no-ramp"),
        ("hold-longer", "hold-longer=1…"),
        ("hold-longer=0", "hold-longer=1…"),
        ("no-ramp@soon", "tick"),
        ("", "no-ramp"),
    ] {
        let line = FirmwareLie::read(text).unwrap_err();
        assert!(
            line.contains(words) && !line.contains('\n'),
            "{text}: {line}"
        );
    }
    let later = FirmwareLie::read("status.tick=-1@80").unwrap();
    assert_eq!(later.to_string(), "status.tick=-1@80");
    assert!(later.help().contains("STATUS"));
}
