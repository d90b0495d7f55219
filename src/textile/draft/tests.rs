//! Drafts and tables against the reader of manifests.

use super::*;
use crate::RECIPES;
use selvedge_foundation::files::KeyValue;

fn draft(kind: &str) -> Draft {
    Draft::of(&Manifest::example(kind).unwrap()).unwrap()
}

#[test]
fn every_example_reads_back_and_states_every_parameter_that_must_be_stated() {
    for &(kind, _) in RECIPES {
        let draft = draft(kind);
        assert_eq!(draft.kind(), kind);
        let manifest = draft.read().unwrap();
        assert_eq!(Draft::of(&manifest).unwrap(), draft, "{kind}");
        for parameter in groups(kind).iter().flat_map(|group| &group.parameters) {
            let may_be_out = matches!(
                parameter.kind,
                ParameterKind::Optional { .. } | ParameterKind::Template { is_optional: true }
            ) || !draft.has_table(parameter.place.table);
            let is_there = draft.value(parameter.place).is_some();
            assert!(is_there || may_be_out, "{kind} {:?}", parameter.place);
        }
    }
}

#[test]
fn the_bounds_of_the_tables_are_those_of_the_reader() {
    for &(kind, _) in RECIPES {
        let draft = draft(kind);
        for parameter in groups(kind).iter().flat_map(|group| &group.parameters) {
            let ParameterKind::Number { min, max, .. } = parameter.kind else {
                continue;
            };
            if !draft.has_table(parameter.place.table) {
                continue;
            }
            for (outside, words) in [(min - 1.0, "from"), (max + 1.0, "to")] {
                let mut wrong = draft.clone();
                let value = if parameter.place.key == "plies" {
                    KeyValue::Integer(if words == "from" { 0 } else { 9 })
                } else {
                    outside.into()
                };
                wrong.set(parameter.place, Some(value));
                let fault = wrong.read().unwrap_err();
                assert_eq!(fault.place, Some(parameter.place), "{kind}: {fault:?}");
                assert!(fault.message.contains(parameter.place.key), "{fault:?}");
                assert!(!fault.message.contains('\n'), "{fault:?}");
            }
        }
    }
}

#[test]
fn every_word_of_a_choice_is_one_that_the_reader_knows() {
    for &(kind, _) in RECIPES {
        for parameter in groups(kind).iter().flat_map(|group| &group.parameters) {
            let ParameterKind::Choice(words) = parameter.kind else {
                continue;
            };
            for word in words {
                let mut other = draft(kind);
                other.set(parameter.place, Some((*word).into()));
                // "literal" alone goes only with "product".
                if let Err(fault) = other.read() {
                    assert_eq!(*word, "literal", "{fault:?}");
                }
            }
            let mut wrong = draft(kind);
            wrong.set(parameter.place, Some("magic".into()));
            let fault = wrong.read().unwrap_err();
            assert_eq!(fault.place, Some(parameter.place), "{fault:?}");
        }
    }
}

#[test]
fn defaults_are_the_readers() {
    let weave = draft("weave");
    let default_of = |key| {
        let place = Place {
            table: "source",
            key,
        };
        let mut without = weave.clone();
        without.set(place, None);
        let manifest = without.read().ok()?;
        Draft::of(&manifest).ok()?.value(place).cloned()
    };
    assert_eq!(default_of("compaction"), Some(0.9.into()));
    assert_eq!(default_of("warp_per_cm"), None, "it is required");
    assert_eq!(default_of("representation"), Some("economical".into()));
}
