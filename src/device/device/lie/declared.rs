//! What a line of the table of lies holds, and how its value is written.

use super::rules::Rule;

/// One line of the table of lies.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Declared {
    /// What it is called: `caps.rows`, `no-ramp`.
    pub(super) name: &'static str,
    pub(super) takes: Takes,
    /// Values to try it with, in each direction; none where it takes none.
    pub(super) examples: &'static [&'static str],
    /// The rule, and what the device does instead.
    pub(super) help: &'static str,
    pub(super) act: Act,
}

/// The value of a lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Takes {
    Nothing,
    /// A whole number up to the largest, from 1.
    UpTo(i64),
    /// What a field of so many bytes holds, or a difference to what is true.
    Field(usize),
}

/// What a lie changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Act {
    /// Bytes of a message's payload, little-endian.
    Field { kind: u8, at: usize, width: usize },
    /// A message's payload ends after so many bytes.
    Cut(u8),
    /// So many bytes follow a message's payload.
    Extra(u8),
    /// A rule of the device.
    Rule(Rule),
}

impl Declared {
    /// How it is written.
    pub(super) fn form(&self) -> String {
        match self.takes {
            Takes::Nothing => self.name.to_owned(),
            Takes::UpTo(most) => format!("{}=1…{most}", self.name),
            Takes::Field(width) => format!("{}=0…{}, +N or -N", self.name, largest(width)),
        }
    }

    /// The value that a text says, and whether it is added to what is true.
    pub(super) fn value(&self, text: Option<&str>) -> Option<(i64, bool)> {
        let (text, most) = match (self.takes, text) {
            (Takes::Nothing, None) => return Some((0, false)),
            (Takes::Nothing, Some(_)) | (_, None) => return None,
            (Takes::UpTo(most), Some(text)) => {
                let value = text.parse().ok().filter(|value| (1..=most).contains(value));
                return value.map(|value| (value, false));
            }
            (Takes::Field(width), Some(text)) => (text, largest(width)),
        };
        let value: i64 = text.parse().ok()?;
        let is_added = text.starts_with(['+', '-']);
        (-most..=most).contains(&value).then_some((value, is_added))
    }
}

/// The largest number of a field of so many bytes.
fn largest(width: usize) -> i64 {
    (1 << (8 * width)) - 1
}
