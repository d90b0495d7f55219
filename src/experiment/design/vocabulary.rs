//! The names that keys of a design's file take, for who writes one by choosing.

use super::adaptation::{Needs, Seeks};
use super::composing::FormName;
use super::{Design, Medium, Movement, Sequence, Sets, Shown, Standard, Tunable};
use crate::named::Named;

impl Design {
    /// The names that a key of a table takes; none where it takes numbers or words of one's own.
    pub fn names_of(table: &str, key: &str) -> Vec<&'static str> {
        match (table, key) {
            ("", "medium") => names::<Medium>(),
            ("presentation", "kind") => names::<Shown>(),
            ("presentation", "reference") => names::<Standard>(),
            ("response", "kind") => names::<FormName>(),
            ("order", "sets") => names::<Sets>(),
            ("order", "sequence") => names::<Sequence>(),
            ("adaptation", "parameter") | ("response.parameter", "key") => names::<Tunable>(),
            ("adaptation", "seeks") => names::<Seeks>(),
            ("adaptation.stop", "needs") => names::<Needs>(),
            ("course.familiarisation", "movement") => names::<Movement>(),
            _ => Vec::new(),
        }
    }
}

fn names<T: Named>() -> Vec<&'static str> {
    T::named().into_iter().map(|(name, _)| name).collect()
}
