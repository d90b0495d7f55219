//! Which textiles stand for a large library: the most typical one of each kind.
//!
//! A kind is a construction; plain weaves, of which there are most, are told apart by fibre. Most
//! typical of its kind is the surface that is least far from all others of that kind, summed, in
//! the plane of the two levels (Ā40 and Ā320 in dB); of equals the first in the library's order.

use super::Library;
use super::index::IndexEntry;
use crate::error::TextileError;
use crate::manifest::Manifest;
use selvedge_foundation::quantity::level_db;

/// The kind of a textile, in words; `None` for what is not made of yarns.
pub fn kind_of(manifest: &Manifest) -> Option<&'static str> {
    manifest.source.keys().textile_kind(&manifest.fibre)
}

impl Library {
    /// The kinds of a library in the order in which they first come, each with its most typical
    /// textile. Textiles without a kind or without a level are passed over.
    ///
    /// # Errors
    /// A library without measured levels, a manifest that is wrong.
    pub fn most_typical(&self) -> Result<Vec<(&'static str, String)>, TextileError> {
        let index = self.index().ok_or_else(|| TextileError::NoIndex {
            library: self.root(),
        })?;
        let mut kinds: Vec<(&'static str, Vec<&IndexEntry>)> = Vec::new();
        for entry in &index.textiles {
            let kind = kind_of(&self.manifest(&entry.id)?);
            let Some(kind) = kind.filter(|_| entry.level_db().is_some()) else {
                continue;
            };
            match kinds.iter_mut().find(|(known, _)| *known == kind) {
                Some((_, entries)) => entries.push(entry),
                None => kinds.push((kind, vec![entry])),
            }
        }
        let chosen = |(kind, entries): (&'static str, Vec<&IndexEntry>)| {
            let far = |one: &&IndexEntry| {
                entries
                    .iter()
                    .map(|other| apart_db(one, other))
                    .sum::<f64>()
            };
            let nearest = entries.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
            Some((kind, nearest.id.clone()))
        };
        Ok(kinds.into_iter().filter_map(chosen).collect())
    }
}

/// How far two textiles are from one another in the plane of levels, dB.
fn apart_db(one: &IndexEntry, other: &IndexEntry) -> f64 {
    let low = level_db(one.a40_um) - level_db(other.a40_um);
    let high = level_db(one.a320_um) - level_db(other.a320_um);
    low.hypot(high)
}
