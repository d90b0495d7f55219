//! TOML: keyed values in a file, with errors that name the line.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

use super::{FileError, line_at};

/// Reads a TOML text into a value. `path` only names the file in errors. The error of a type that
/// says itself how to mend it reads `what; mend`.
pub fn keys_from_str<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, FileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    check_length(text, path)?;
    toml::from_str(text).map_err(|error| {
        let line = line_at(text.as_bytes(), error.span().map_or(0, |span| span.start));
        let what = error.message().replace('\n', ", ");
        if let Some((what, mend)) = what.split_once("; ") {
            return FileError::content(path, line, what, mend);
        }
        let mend = if what.contains("unknown field") {
            "remove the key or correct its name"
        } else if what.contains("missing field") {
            "add the key"
        } else {
            "correct this line"
        };
        FileError::content(path, line, what, mend)
    })
}

/// Most bytes of keys and values: read, they take many times the memory of their text.
const MAX_BYTES: usize = 4_000_000;

/// Refuses a text that is longer than keys and values may be.
fn check_length(text: &str, path: &Path) -> Result<(), FileError> {
    if text.len() <= MAX_BYTES {
        return Ok(());
    }
    let what = format!("this file is larger than {} MB", MAX_BYTES / 1_000_000);
    let mend = "give a file of keys and values, not a table or a picture";
    Err(FileError::whole(path, what, mend))
}

/// Reads what is understood of a TOML text whose keys all have defaults.
///
/// A key that is unknown is passed over; a value, or an entry of a table, that is not understood is
/// left out: the first line of one comes back too.
///
/// # Errors
/// This is not TOML at all.
pub fn known_keys_from_str<T: DeserializeOwned>(
    text: &str,
    path: &Path,
) -> Result<(T, Option<usize>), FileError> {
    let is_known = |key: &str, value: Value| {
        let alone = Table::from_iter([(key.to_owned(), value)]);
        T::deserialize(alone).is_ok()
    };
    let mut keys: Table = keys_from_str(text, path)?;
    let mut odd = Vec::new();
    keys.retain(|key, value| {
        if is_known(key, value.clone()) {
            return true;
        }
        odd.push(line_of_key(text, "", 0, key));
        let Value::Table(entries) = value else {
            return false;
        };
        entries.retain(|name, entry| {
            let alone = Table::from_iter([(name.to_owned(), entry.clone())]);
            is_known(key, Value::Table(alone))
        });
        is_known(key, value.clone())
    });
    let known = T::deserialize(keys);
    let known = known.map_err(|error| FileError::content(path, 1, error.to_string(), "mend it"))?;
    Ok((known, odd.into_iter().min()))
}

/// The line, from 1, where a text states `key` in its `nth` (from 0) table called `table`.
///
/// So a value that is well spelt but wrong can be pointed at. An empty `table` is the file itself;
/// `outer.inner` is a table within a table.
///
/// A key that is not stated has the line of its table, and a table that is not there line 1.
pub fn line_of_key(text: &str, table: &str, nth: usize, key: &str) -> usize {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let offset = DeTable::parse(text)
        .ok()
        .and_then(|root| offset_of_key(root.get_ref(), table, nth, key))
        .unwrap_or(0);
    line_at(text.as_bytes(), offset)
}

fn offset_of_key(root: &DeTable<'_>, table: &str, nth: usize, key: &str) -> Option<usize> {
    let stated = |within: &DeTable<'_>| {
        let found = within.iter().find(|(name, _)| name.get_ref() == key);
        found.map(|(name, _)| name.span().start)
    };
    if table.is_empty() {
        return stated(root);
    }
    if let Some((outer, inner)) = table.split_once('.') {
        let (_, value) = root.iter().find(|(name, _)| name.get_ref() == outer)?;
        let DeValue::Table(within) = value.get_ref() else {
            return None;
        };
        return offset_of_key(within, inner, nth, key);
    }
    let (name, value) = root.iter().find(|(name, _)| name.get_ref() == table)?;
    let entry = match value.get_ref() {
        DeValue::Array(entries) => entries.get(nth)?,
        _ => value,
    };
    let DeValue::Table(within) = entry.get_ref() else {
        return Some(name.span().start);
    };
    Some(stated(within).unwrap_or_else(|| entry.span().start))
}

/// A value as TOML text.
///
/// # Errors
/// It is no table of keys, or longer than [`keys_from_str`] would take it.
pub fn keys_to_string<T: Serialize>(value: &T, path: &Path) -> Result<String, FileError> {
    let text = toml::to_string(value)
        .map_err(|e| FileError::content(path, 1, e.to_string(), "this cannot be saved as TOML"))?;
    check_length(&text, path)?;
    Ok(text)
}

/// Keys and values as a file states them, of whatever kind.
pub type Keys = Table;

/// What a key states.
pub type KeyValue = Value;

/// The value of a key in a table; `""` is the file itself, `outer.inner` a table within a table.
/// `None` if it is not stated.
pub fn value_at<'a>(keys: &'a Keys, table: &str, key: &str) -> Option<&'a KeyValue> {
    if table.is_empty() {
        return keys.get(key);
    }
    let (outer, inner) = table.split_once('.').unwrap_or((table, ""));
    value_at(keys.get(outer)?.as_table()?, inner, key)
}

/// States a key in a table, which is added if it is not there; `None` takes the key away.
pub fn set_value(keys: &mut Keys, table: &str, key: &str, value: Option<KeyValue>) {
    if table.is_empty() {
        match value {
            Some(value) => keys.insert(key.to_owned(), value),
            None => keys.remove(key),
        };
        return;
    }
    let (outer, inner) = table.split_once('.').unwrap_or((table, ""));
    let within = keys
        .entry(outer)
        .or_insert_with(|| KeyValue::Table(Keys::new()));
    if let KeyValue::Table(within) = within {
        set_value(within, inner, key, value);
    }
}

/// The text under `key`, taken out; `None` if it is not there or no text.
pub fn take_text(keys: &mut Keys, key: &str) -> Option<String> {
    match keys.remove(key)? {
        Value::String(text) => Some(text),
        other => {
            keys.insert(key.to_owned(), other);
            None
        }
    }
}

/// Lays keys over others: a table within is laid over the table of its name, anything else stands
/// in the place of what was there.
pub fn lay_over(under: &mut Keys, over: Keys) {
    for (key, value) in over {
        match (under.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) => lay_over(below, above),
            (_, value) => {
                under.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Deserialize, Serialize, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Thing {
        size_mm: f64,
    }

    #[test]
    fn an_unknown_key_is_named_with_its_line() {
        let error = keys_from_str::<Thing>("size_mm = 1.0\nsise = 2\n", Path::new("a.toml"));
        let error = error.unwrap_err().to_string();
        assert!(error.starts_with("a.toml:2: "), "{error}");
        assert!(error.contains("sise") && !error.contains('\n'), "{error}");
    }

    #[test]
    fn megabytes_of_comments_are_refused_before_they_are_read() {
        let text = "# nothing\n".repeat(500_000);
        let error = keys_from_str::<Thing>(&text, Path::new("a.toml")).unwrap_err();
        let expected = "a.toml: this file is larger than 4 MB; ";
        assert!(error.to_string().starts_with(expected), "{error}");
    }

    #[test]
    fn a_key_is_found_in_the_table_that_holds_it() {
        let text =
            "a = 1\n\n[[thing]]\nsize = 2\n\n[[thing]]\nid = \"b\"\nsize = 3\n[tuning]\nk = 4\n";
        assert_eq!(line_of_key(text, "", 0, "a"), 1);
        assert_eq!(line_of_key(text, "thing", 0, "size"), 4);
        assert_eq!(line_of_key(text, "thing", 1, "size"), 8);
        assert_eq!(line_of_key(text, "thing", 1, "colour"), 6);
        assert_eq!(line_of_key(text, "tuning", 0, "k"), 10);
        assert_eq!(line_of_key(text, "nothing", 0, "k"), 1);
        assert_eq!(line_of_key("= not TOML", "", 0, "k"), 1);
    }

    #[test]
    fn values_survive_writing_and_reading() {
        let thing = Thing { size_mm: 0.1 };
        let text = keys_to_string(&thing, Path::new("a.toml")).unwrap();
        assert_eq!(
            keys_from_str::<Thing>(&text, Path::new("a.toml")).unwrap(),
            thing
        );
    }

    #[test]
    fn a_value_is_found_set_and_taken_away_where_its_table_says() {
        let read = |text: &str| keys_from_str::<Keys>(text, Path::new("a.toml")).unwrap();
        let mut keys = read("a = 1\n[t.u]\nb = 2\n");
        assert_eq!(value_at(&keys, "t.u", "b"), Some(&KeyValue::Integer(2)));
        assert_eq!(value_at(&keys, "", "a"), Some(&KeyValue::Integer(1)));
        assert_eq!(value_at(&keys, "t.v", "b"), None);
        set_value(&mut keys, "t.u", "b", None);
        set_value(&mut keys, "v", "c", Some("d".into()));
        set_value(&mut keys, "", "a", Some(KeyValue::Integer(3)));
        assert_eq!(keys, read("a = 3\n[t.u]\n[v]\nc = \"d\"\n"));
    }

    #[test]
    fn tables_are_laid_over_one_another_key_by_key() {
        let read = |text: &str| keys_from_str::<Keys>(text, Path::new("a.toml")).unwrap();
        let mut keys = read("a = 1\nid = \"x\"\n[t]\nb = 2\nc = [3, 4]\n[t.u]\nd = 5\n");
        lay_over(&mut keys, read("e = 6\n[t]\nc = [7]\n[t.u]\nd = \"f\"\n"));
        let wanted = "a = 1\ne = 6\nid = \"x\"\n[t]\nb = 2\nc = [7]\n[t.u]\nd = \"f\"\n";
        assert_eq!(keys, read(wanted));
        assert_eq!(take_text(&mut keys, "id"), Some("x".to_owned()));
        assert_eq!(take_text(&mut keys, "a"), None);
        assert!(keys.contains_key("a"), "what is no text stays");
    }

    #[test]
    fn what_is_not_understood_costs_itself_whatever_stands_in_its_place() {
        #[derive(serde::Deserialize, Default, Debug, PartialEq)]
        #[serde(default)]
        struct Known {
            theme: String,
            zoom: f64,
            areas: std::collections::BTreeMap<String, f64>,
        }
        let text =
            "zoom = 2.0\n[theme]\ndark = 1\n[areas]\na = 1.0\nb = \"wide\"\n[sound]\nx = 1\n";
        let read: Result<(Known, _), _> = known_keys_from_str(text, Path::new("f.toml"));
        let (known, odd) = read.unwrap();
        assert_eq!((known.theme.as_str(), known.zoom, odd), ("", 2.0, Some(2)));
        assert_eq!(known.areas, [("a".to_owned(), 1.0)].into());
    }
}
