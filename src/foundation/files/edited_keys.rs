//! A TOML text that is edited key by key: what nobody touches stays as it was written, comments and
//! order too.

use std::path::Path;

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

use super::keys::{KeyValue, keys_from_str};
use super::{FileError, line_at};

/// Texts in a list beyond which each has a line of its own.
const IN_A_LINE: usize = 3;

/// Where a key of a text stands: its table, empty for the file itself and `outer.inner` for a table
/// within a table; which of several tables of that name, from 0; its name.
pub type KeyPlace<'a> = (&'a str, usize, &'a str);

/// Keys and values with everything around them.
#[derive(Debug, Clone)]
pub struct EditedKeys(DocumentMut);

impl EditedKeys {
    /// Of a text. `path` only names it in errors.
    ///
    /// # Errors
    /// It is no TOML, or too long.
    pub fn parse(text: &str, path: &Path) -> Result<Self, FileError> {
        // Says what is wrong as every reader of keys does.
        keys_from_str::<super::Keys>(text, path)?;
        let parsed = text.parse::<DocumentMut>();
        parsed.map(Self).map_err(|error| {
            let line = line_at(text.as_bytes(), error.span().map_or(0, |span| span.start));
            FileError::content(
                path,
                line,
                error.message().replace('\n', ", "),
                "correct it",
            )
        })
    }

    /// The text.
    pub fn text(&self) -> String {
        self.0.to_string()
    }

    /// How many tables of this name there are.
    pub fn n_tables(&self, table: &str) -> usize {
        match self.item(table) {
            Some(Item::ArrayOfTables(all)) => all.len(),
            Some(Item::Value(Value::Array(all))) => all.len(),
            Some(Item::Table(_) | Item::Value(Value::InlineTable(_))) => 1,
            _ => 0,
        }
    }

    /// What a key states; `None` if it is not stated.
    pub fn value(&self, (table, nth, key): KeyPlace<'_>) -> Option<KeyValue> {
        let within: &dyn TableLike = match self.item(table)? {
            Item::ArrayOfTables(all) => all.get(nth)?,
            Item::Value(Value::Array(all)) => all.get(nth)?.as_inline_table()?,
            item => item.as_table_like()?,
        };
        let text = format!("value = {}", within.get(key)?.as_value()?);
        let mut keys: super::Keys = keys_from_str(&text, Path::new("")).ok()?;
        keys.remove("value")
    }

    /// States a key in a table, which is added if it is not there; `None` takes the key away.
    pub fn set(&mut self, (table, nth, key): KeyPlace<'_>, value: Option<&KeyValue>) {
        let Some(value) = value else {
            if let Some(within) = self.table(table, nth, false) {
                within.remove(key);
            }
            return;
        };
        let Some(within) = self.table(table, nth, true) else {
            return;
        };
        let mut value = edited(value);
        if let Some(old) = within.get(key).and_then(Item::as_value) {
            *value.decor_mut() = old.decor().clone();
        }
        match within.get_mut(key) {
            Some(item) => *item = Item::Value(value),
            None => {
                within.insert(key, Item::Value(value));
            }
        }
    }

    /// Adds a table to those of this name, after them.
    pub fn push(&mut self, table: &str, keys: &[(&str, KeyValue)]) {
        let Some(all) = self.tables(table) else {
            return;
        };
        let mut added = Table::new();
        for (key, value) in keys {
            added.insert(key, Item::Value(edited(value)));
        }
        all.push(added);
    }

    /// Takes a table away: the `nth` where there are several of that name.
    pub fn remove(&mut self, table: &str, nth: usize) {
        if let Some(Item::ArrayOfTables(_) | Item::Value(Value::Array(_))) = self.item(table)
            && let Some(all) = self.tables(table)
        {
            if nth < all.len() {
                all.remove(nth);
            }
            if !all.is_empty() {
                return;
            }
        }
        let (outer, own) = table.rsplit_once('.').unwrap_or(("", table));
        if let Some(within) = self.table(outer, 0, false) {
            within.remove(own);
        }
    }

    fn item(&self, table: &str) -> Option<&Item> {
        let mut item = self.0.as_item();
        for name in table.split('.').filter(|name| !name.is_empty()) {
            item = item.get(name)?;
        }
        Some(item)
    }

    /// A table to edit; one that is not there is made where that is asked.
    fn table(&mut self, table: &str, nth: usize, makes: bool) -> Option<&mut dyn TableLike> {
        if nth > 0 || matches!(self.item(table), Some(Item::ArrayOfTables(_))) {
            let all = self.tables(table)?;
            return all.get_mut(nth).map(|one| one as &mut dyn TableLike);
        }
        let mut within = self.0.as_table_mut() as &mut dyn TableLike;
        for name in table.split('.').filter(|name| !name.is_empty()) {
            if makes && within.get(name).is_none() {
                within.insert(name, Item::Table(Table::new()));
            }
            within = within.get_mut(name)?.as_table_like_mut()?;
        }
        Some(within)
    }

    /// The tables of a name, as tables with a heading each.
    fn tables(&mut self, table: &str) -> Option<&mut ArrayOfTables> {
        let (outer, own) = table.rsplit_once('.').unwrap_or(("", table));
        let within = self.table(outer, 0, true)?;
        let item = within.entry(own).or_insert(Item::None);
        let taken = std::mem::take(item);
        *item = match taken.into_array_of_tables() {
            Ok(all) => Item::ArrayOfTables(all),
            Err(Item::None) => Item::ArrayOfTables(ArrayOfTables::new()),
            Err(other) => other,
        };
        item.as_array_of_tables_mut()
    }
}

/// A value as it is written: the texts of a longer list have a line each.
fn edited(value: &KeyValue) -> Value {
    let text = value.to_string();
    let mut value = text.parse::<Value>().unwrap_or_else(|_| Value::from(text));
    if let Value::Array(all) = &mut value
        && all.len() > IN_A_LINE
        && all.iter().all(Value::is_str)
    {
        for one in all.iter_mut() {
            one.decor_mut().set_prefix("\n    ");
        }
        all.set_trailing("\n");
        all.set_trailing_comma(true);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# A study.\nstudy = \"a\" # its name\nseed = 1\n\n# What is felt.\n\
                        [[stimulus]]\nid = \"x\"\n\n[[stimulus]]\nid = \"y\"\ngain_db = -6.0\n\n\
                        [response]\nkind = \"choice\" # one of them\n";

    fn parsed(text: &str) -> EditedKeys {
        EditedKeys::parse(text, Path::new("a.toml")).unwrap()
    }

    #[test]
    fn comments_and_order_survive_what_is_changed() {
        let mut keys = parsed(TEXT);
        assert_eq!(keys.text(), TEXT);
        keys.set(("", 0, "study"), Some(&"b".into()));
        keys.set(("stimulus", 1, "gain_db"), Some(&KeyValue::Float(3.0)));
        keys.set(("response", 0, "kind"), Some(&"rank".into()));
        let wanted = TEXT
            .replace("\"a\"", "\"b\"")
            .replace("-6.0", "3.0")
            .replace("\"choice\"", "\"rank\"");
        assert_eq!(keys.text(), wanted);
    }

    #[test]
    fn tables_and_keys_come_and_go() {
        let mut keys = parsed(TEXT);
        keys.push("stimulus", &[("id", "z".into())]);
        assert_eq!(keys.n_tables("stimulus"), 3);
        assert_eq!(keys.value(("stimulus", 2, "id")), Some("z".into()));
        keys.remove("stimulus", 0);
        assert_eq!(keys.value(("stimulus", 0, "id")), Some("y".into()));
        keys.set(("stimulus", 0, "gain_db"), None);
        assert_eq!(keys.value(("stimulus", 0, "gain_db")), None);
        keys.set(
            ("adaptation.stop", 0, "trials"),
            Some(&KeyValue::Integer(40)),
        );
        keys.push("response.scale", &[("key", "rough".into())]);
        let again = parsed(&keys.text());
        assert_eq!(
            again.value(("adaptation.stop", 0, "trials")),
            Some(KeyValue::Integer(40))
        );
        assert_eq!(
            again.value(("response.scale", 0, "key")),
            Some("rough".into())
        );
        keys.remove("adaptation.stop", 0);
        keys.remove("stimulus", 0);
        keys.remove("stimulus", 0);
        assert_eq!(
            (keys.n_tables("stimulus"), keys.n_tables("adaptation.stop")),
            (0, 0)
        );
        assert!(!keys.text().contains("stop") && !keys.text().contains("stimulus"));
    }

    #[test]
    fn inline_tables_are_read_and_edited_like_others() {
        let text = "scale = [{ key = \"a\" }, { key = \"b\" }]\nstop = { trials = 3 }\n";
        let mut keys = parsed(text);
        assert_eq!((keys.n_tables("scale"), keys.n_tables("stop")), (2, 1));
        assert_eq!(keys.value(("scale", 1, "key")), Some("b".into()));
        keys.set(("stop", 0, "trials"), Some(&KeyValue::Integer(4)));
        keys.push("scale", &[("key", "c".into())]);
        let again = parsed(&keys.text());
        assert_eq!(
            again.value(("stop", 0, "trials")),
            Some(KeyValue::Integer(4))
        );
        assert_eq!(again.value(("scale", 2, "key")), Some("c".into()));
    }

    #[test]
    fn what_is_no_toml_is_named_with_its_line() {
        let error = EditedKeys::parse("a = 1\nb = \n", Path::new("a.toml")).unwrap_err();
        assert!(error.to_string().starts_with("a.toml:2: "), "{error}");
    }

    #[test]
    fn longer_lists_of_texts_have_a_line_each() {
        let mut keys = parsed("");
        let list = ["a", "b", "c", "d"].map(KeyValue::from).to_vec();
        keys.set(("", 0, "textiles"), Some(&KeyValue::Array(list.clone())));
        let wanted = "textiles = [\n    \"a\",\n    \"b\",\n    \"c\",\n    \"d\",\n]\n";
        assert_eq!(keys.text(), wanted);
        assert_eq!(keys.value(("", 0, "textiles")), Some(KeyValue::Array(list)));
    }
}
