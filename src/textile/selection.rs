//! Which textiles stand for a large library: the most typical one of each kind.
//!
//! A kind is a construction; plain weaves, of which there are most, are told apart by fibre. Most
//! typical of its kind is the surface that is least far from all others of that kind, summed, in
//! the plane of the two levels (Ā40 and Ā320 in dB); of equals the first in the library's order.

use super::index::IndexEntry;
use super::knit::Structure;
use super::manifest::{Manifest, Source};
use super::weave::Interlacing;
use super::{Library, TextileError};
use selvedge_foundation::quantity::level_db;

/// Fibres from stems and leaves: stiff, uneven yarns.
const BAST_AND_LEAF: [&str; 4] = ["jute", "linen", "hemp", "sisal"];

/// The kind of a textile, in words; `None` for what is no cloth of yarns.
pub fn kind_of(manifest: &Manifest) -> Option<&'static str> {
    match &manifest.source {
        Source::Weave(weave) => Some(match &weave.interlacing {
            Interlacing::Named(name) => kind_of_weave(name, &manifest.fibre),
            Interlacing::Rows(_) => "other weave",
        }),
        Source::Knit(knit) => Some(match knit.structure {
            Structure::Jersey => "jersey",
            Structure::ReverseJersey => "reverse jersey",
            Structure::Rib11 => "rib 1×1",
            Structure::Rib22 => "rib 2×2",
            Structure::Interlock => "interlock",
            Structure::Pique => "piqué",
            Structure::Terry => "terry",
            Structure::Fleece | Structure::Plush => "brushed or cut pile",
        }),
        _ => None,
    }
}

fn kind_of_weave(interlacing: &str, fibre: &str) -> &'static str {
    match interlacing {
        "plain" if BAST_AND_LEAF.contains(&fibre) => "plain, bast or leaf fibre",
        "plain" if fibre == "silk" => "plain, silk",
        "plain" => "plain, other fibre",
        "twill-2-2" | "herringbone" => "twill alike on both sides",
        "twill-2-1" | "twill-3-1" | "twill-1-3" => "twill with a prevailing yarn",
        "satin-5" | "satin-8" | "sateen-5" => "satin",
        "basket-2-2" | "basket-3-3" | "warp-rib" | "weft-rib" => "basket or rib",
        "crepe" | "honeycomb" => "crêpe or honeycomb",
        _ => "other weave",
    }
}

/// The kinds of a library in the order in which they first come, each with its most typical
/// textile. Textiles without a kind or without a level are passed over.
///
/// # Errors
/// A library without measured levels, a manifest that is wrong.
pub fn most_typical(library: &Library) -> Result<Vec<(&'static str, String)>, TextileError> {
    let index = library.index().ok_or_else(|| TextileError::NoIndex {
        library: library.root(),
    })?;
    let mut kinds: Vec<(&'static str, Vec<&IndexEntry>)> = Vec::new();
    for entry in &index.textiles {
        let kind = kind_of(&library.manifest(&entry.id)?);
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

/// How far two textiles are from one another in the plane of levels, dB.
fn apart_db(one: &IndexEntry, other: &IndexEntry) -> f64 {
    let low = level_db(one.a40_um) - level_db(other.a40_um);
    let high = level_db(one.a320_um) - level_db(other.a320_um);
    low.hypot(high)
}
