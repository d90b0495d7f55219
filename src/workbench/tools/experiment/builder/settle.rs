//! What follows from a choice that other keys hang on.

use crate::tools::experiment::builder::block_list::{ADAPTED, BLOCKS, QUEST, STAIRCASE};
use crate::tools::experiment::builder::blocks::{First, TRACKS, adapts, track};
use selvedge_foundation::files::{EditedKeys, KeyValue};

/// Takes away what has no meaning any more, and adds what cannot be left out: after a choice that
/// others hang on.
pub(crate) fn settle(keys: &mut EditedKeys) {
    if adapts(keys) && track(keys).is_none() {
        let up = First::Count(1).value();
        keys.set((STAIRCASE, 0, "up"), up.as_ref());
    }
    // What is asked decides on what hangs on it: twice, since some hang on those.
    for _ in 0..2 {
        for block in &BLOCKS {
            for field in block.fields {
                let place = (field.table, 0, field.key);
                let is_stated = keys.value(place).is_some();
                if !field.applies(keys) {
                    keys.set(place, None);
                } else if !is_stated && !field.first.is_nothing() {
                    keys.set(place, field.first.value().as_ref());
                }
            }
            for rows in block.rows {
                let applies = rows.applies(keys);
                while !applies && keys.n_tables(rows.table) > 0 {
                    keys.remove(rows.table, 0);
                }
                if applies && rows.is_needed && keys.n_tables(rows.table) == 0 {
                    keys.push(rows.table, &rows.firsts());
                }
            }
        }
    }
}

/// Lets a number follow the answers, found so, or no longer.
pub(crate) fn set_track(keys: &mut EditedKeys, chosen: Option<&'static str>) {
    for (table, _) in TRACKS {
        if chosen != Some(table) {
            keys.remove(table, 0);
        }
    }
    let Some(table) = chosen else {
        keys.remove(ADAPTED, 0);
        return settle(keys);
    };
    let firsts = BLOCKS.iter().flat_map(|block| block.fields);
    for field in firsts.filter(|field| field.table == table || field.table == ADAPTED) {
        if keys.value((field.table, 0, field.key)).is_none() && field.key != "band_hz" {
            keys.set((field.table, 0, field.key), field.first.value().as_ref());
        }
    }
    let range = keys.value((ADAPTED, 0, "range"));
    let numbers = |value: &KeyValue| -> Option<[f64; 2]> {
        let all = value.as_array()?.iter();
        let number = |one: &KeyValue| one.as_float().or_else(|| one.to_string().parse().ok());
        all.map(number)
            .collect::<Option<Vec<f64>>>()?
            .try_into()
            .ok()
    };
    if let Some([low, high]) = range.as_ref().and_then(numbers) {
        // Values lie in the range: a staircase begins where it is easy.
        let at = |share: f64| KeyValue::Float(low + share * (high - low));
        let (place, values) = match table {
            STAIRCASE => ((table, 0, "starts"), vec![at(1.0)]),
            _ => (
                (table, 0, "values"),
                [0.0, 0.25, 0.5, 0.75, 1.0].map(at).to_vec(),
            ),
        };
        if table != QUEST {
            keys.set(place, Some(&KeyValue::Array(values)));
        }
    }
    settle(keys);
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::tools::experiment::builder::blocks::Holds;
    use crate::tools::experiment::builder::stimuli::STIMULUS;
    use selvedge_experiment::design::Design;

    fn keys(name: &str) -> EditedKeys {
        let text = Design::shipped_text(name).unwrap();
        EditedKeys::parse(text, Path::new(name)).unwrap()
    }

    fn read(keys: &EditedKeys) -> Result<Design, String> {
        Design::from_toml(&keys.text(), Path::new("a.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn every_name_has_names_and_every_design_says_nothing_without_a_meaning() {
        let rows = BLOCKS.iter().flat_map(|block| block.rows);
        let fields = BLOCKS.iter().flat_map(|block| block.fields);
        for field in fields.chain(rows.flat_map(|rows| rows.fields)) {
            let has_names = !Design::names_of(field.table, field.key).is_empty();
            let is_name = matches!(field.holds, Holds::Name(_));
            assert_eq!(is_name, has_names, "{}.{}", field.table, field.key);
        }
        for name in Design::shipped_names() {
            let mut settled = keys(name);
            let before = read(&settled).unwrap();
            settle(&mut settled);
            let after = read(&settled).unwrap();
            assert_eq!(before.composition, after.composition, "{name}");
        }
    }

    #[test]
    fn every_key_of_rules_and_of_stimuli_stands_in_a_block() {
        let rules = BLOCKS.iter().flat_map(|block| block.fields);
        let stated: Vec<&str> = rules
            .chain(STIMULUS.fields)
            .map(|field| field.key)
            .collect();
        for table in ["rules", "stimulus"] {
            let mut keys = keys("real-or-generated");
            keys.set((table, 0, "unheard-of"), Some(&1.into()));
            // The reader names the keys that it knows.
            let line = read(&keys).unwrap_err();
            let known: Vec<&str> = line.split('`').skip(3).step_by(2).collect();
            assert!(known.len() > 3, "{line}");
            for key in known {
                assert!(stated.contains(&key), "{table}.{key}: {line}");
            }
        }
    }

    #[test]
    fn whatever_is_chosen_to_be_answered_by_is_a_design_again_or_says_why_not() {
        let mut n_good = 0;
        for name in Design::shipped_names() {
            for kind in Design::names_of("response", "kind") {
                let mut keys = keys(name);
                keys.set(("response", 0, "kind"), Some(&kind.into()));
                settle(&mut keys);
                match read(&keys) {
                    Ok(_) => n_good += 1,
                    Err(line) => {
                        assert!(line.contains("; ") && !line.contains("unknown"), "{line}");
                    }
                }
            }
        }
        assert!(n_good >= 20, "{n_good}");
    }

    #[test]
    fn a_number_that_follows_the_answers_is_added_and_taken_away() {
        let mut keys = keys("jnd-40");
        for (table, _) in TRACKS {
            set_track(&mut keys, Some(table));
            assert_eq!(track(&keys), Some(table));
            assert!(
                read(&keys).is_ok(),
                "{table}: {:?}\n{}",
                read(&keys),
                keys.text()
            );
        }
        set_track(&mut keys, None);
        assert!(!adapts(&keys) && !keys.text().contains("adaptation"));
    }
}
