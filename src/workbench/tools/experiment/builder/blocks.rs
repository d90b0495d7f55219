//! What a block of a design is: keys with what they hold, and when they have a meaning.

use selvedge_foundation::files::{EditedKeys, KeyValue};

/// What a key holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holds {
    /// Words of one's own.
    Words,
    /// Several lines of them.
    Paragraph,
    /// A name that the file knows; whether it may be left out.
    Name(bool),
    /// A stimulus, or none.
    Stimulus,
    /// A number.
    Number,
    /// A whole number.
    Count,
    /// Yes or no.
    Flag,
    /// Words or numbers, with commas between.
    List,
}

/// What a key is at first, where it cannot be left out.
#[derive(Debug, Clone, Copy)]
pub(crate) enum First {
    /// It can.
    Nothing,
    Word(&'static str),
    Count(i64),
    Number(f64),
    Numbers(&'static [f64]),
}

impl First {
    /// The value.
    pub(crate) fn value(self) -> Option<KeyValue> {
        match self {
            Self::Nothing => None,
            Self::Word(word) => Some(word.into()),
            Self::Count(n) => Some(n.into()),
            Self::Number(number) => Some(number.into()),
            Self::Numbers(all) => Some(KeyValue::Array(
                all.iter().copied().map(KeyValue::from).collect(),
            )),
        }
    }
}

impl First {
    pub(super) fn is_nothing(self) -> bool {
        matches!(self, Self::Nothing)
    }
}

/// A key of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field {
    pub(crate) table: &'static str,
    pub(crate) key: &'static str,
    /// What people call it, and its unit or what stands for nothing.
    pub(crate) name: &'static str,
    pub(crate) hint: &'static str,
    pub(crate) holds: Holds,
    pub(super) first: First,
    /// Whether it has a meaning.
    applies: fn(&EditedKeys) -> bool,
}

impl Field {
    pub(super) const fn new(
        (table, key): (&'static str, &'static str),
        (name, hint): (&'static str, &'static str),
        holds: Holds,
    ) -> Self {
        Self {
            table,
            key,
            name,
            hint,
            holds,
            first: First::Nothing,
            applies: |_| true,
        }
    }

    pub(super) const fn when(self, applies: fn(&EditedKeys) -> bool) -> Self {
        Self { applies, ..self }
    }

    pub(super) const fn first(self, first: First) -> Self {
        Self { first, ..self }
    }

    /// Whether it has a meaning in this design.
    pub(crate) fn applies(&self, keys: &EditedKeys) -> bool {
        (self.applies)(keys)
    }
}

/// Tables of one name, each a row of a block.
#[derive(Debug)]
pub(crate) struct Rows {
    pub(crate) table: &'static str,
    /// What one of them is called.
    pub(crate) one: &'static str,
    pub(crate) fields: &'static [Field],
    pub(super) applies: fn(&EditedKeys) -> bool,
    /// Whether there has to be one.
    pub(super) is_needed: bool,
}

impl Rows {
    /// Whether they have a meaning in this design.
    pub(crate) fn applies(&self, keys: &EditedKeys) -> bool {
        (self.applies)(keys)
    }

    /// What a new one states.
    pub(crate) fn firsts(&self) -> Vec<(&'static str, KeyValue)> {
        let stated = |field: &Field| Some((field.key, field.first.value()?));
        self.fields.iter().filter_map(stated).collect()
    }
}

/// A part of a design.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) title: &'static str,
    /// Tables that it stands for, the first its own.
    pub(crate) tables: &'static [&'static str],
    pub(crate) fields: &'static [Field],
    pub(crate) rows: &'static [Rows],
}

impl Block {
    /// Whether anything of it has a meaning in this design.
    pub(crate) fn applies(&self, keys: &EditedKeys) -> bool {
        let has_fields = self.fields.iter().any(|field| field.applies(keys));
        // What adapts is chosen in a block of its own, and stimuli are no fields.
        has_fields || self.title == "Adaptation" || self.fields.is_empty()
    }
}

/// What a key says in words; empty where it says nothing.
pub(crate) fn word(keys: &EditedKeys, table: &str, key: &str) -> String {
    let value = keys.value((table, 0, key));
    value
        .as_ref()
        .and_then(KeyValue::as_str)
        .unwrap_or_default()
        .to_owned()
}

pub(super) fn asks(keys: &EditedKeys, kinds: &[&str]) -> bool {
    kinds.contains(&word(keys, "response", "kind").as_str())
}

pub(super) fn shows(keys: &EditedKeys, kinds: &[&str]) -> bool {
    kinds.contains(&word(keys, "presentation", "kind").as_str())
}

/// Whether a number follows the answers.
pub(crate) fn adapts(keys: &EditedKeys) -> bool {
    keys.n_tables("adaptation") > 0
}

/// The tables of which one says how the next value is found.
pub(crate) const TRACKS: [(&str, &str); 3] = [
    ("adaptation.staircase", "staircase"),
    ("adaptation.quest_plus", "QUEST+"),
    ("adaptation.constant", "constant stimuli"),
];

/// The one of a design.
pub(crate) fn track(keys: &EditedKeys) -> Option<&'static str> {
    let mut tracks = TRACKS.iter().map(|(table, _)| *table);
    tracks.find(|table| keys.n_tables(table) > 0)
}
