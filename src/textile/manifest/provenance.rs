//! Where a textile comes from: the textiles that it was made from, and the program that made it.

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::Checker;

/// Most parents of a textile.
const MAX_PARENTS: usize = 16;
/// Most letters of the name of a program.
const MAX_LETTERS: usize = 100;

/// The table `[provenance]`. It holds no date: the same recipe makes the same bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The program that made it and its version, `selvedge 0.1.0` for one.
    pub made_by: String,
    /// The textiles that it was made from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parents: Vec<Parent>,
}

/// A textile that another one was made from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parent {
    /// Its id in its library.
    pub id: String,
    /// SHA-256 of its content: see [`crate::Textile::content_hash`].
    pub hash: String,
}

impl Provenance {
    /// Made by this program from these textiles.
    pub fn of(parents: Vec<Parent>) -> Self {
        Self {
            made_by: selvedge_foundation::PROGRAM.to_owned(),
            parents,
        }
    }

    /// Refuses what cannot be where a textile comes from.
    pub(super) fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let wrong =
            |key: &str, what: String, mend: &str| Err(checker.wrong("provenance", key, what, mend));
        let is_line = |text: &str| {
            !text.trim().is_empty()
                && text.chars().count() <= MAX_LETTERS
                && !text.chars().any(char::is_control)
        };
        if !is_line(&self.made_by) {
            let what = format!("made_by is {:?}", self.made_by);
            return wrong(
                "made_by",
                what,
                "name the program and its version in a line",
            );
        }
        let n_parents = self.parents.len();
        if n_parents > MAX_PARENTS {
            let what = format!("{n_parents} parents");
            return wrong("parents", what, &format!("name at most {MAX_PARENTS}"));
        }
        for Parent { id, hash } in &self.parents {
            if !is_line(id) || id.contains(['/', '\\']) {
                let what = format!("a parent's id is {id:?}");
                return wrong("parents", what, "name a textile of a library");
            }
            let is_digit = |c: char| matches!(c, '0'..='9' | 'a'..='f');
            if hash.len() != 64 || !hash.chars().all(is_digit) {
                let what = format!("the hash of parent \"{id}\" is \"{hash}\"");
                return wrong("parents", what, "write SHA-256 as 64 digits 0-9 a-f");
            }
        }
        Ok(())
    }
}
