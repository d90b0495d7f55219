//! What makes a scene's values wrong, and how to mend them.
//!
//! One list of rules for files and for values that arrive live. Knows where a value stands in a
//! file by table and key, but reads no file.

use std::collections::{BTreeMap, BTreeSet};

use super::geometry::MAX_CONTACTORS;
use super::{Display, Geometry, PlacedTextile, Scene};
use selvedge_foundation::files::{Flaw, Place};
use selvedge_foundation::geometry::{Displacement, Point};
use selvedge_textile::elsewhere;
use selvedge_textile::tactile::{Filters, Tuning};

/// How to mend a gain whose error does not say.
const FINITE: &str = "give a finite number";
/// Most textiles that a scene may hold.
const MAX_TEXTILES: usize = 10_000;
/// Most displays that a scene may hold: one a finger.
const MAX_DISPLAYS: usize = 10;

/// The first thing that is wrong with a scene.
pub(super) fn scene_flaw(scene: &Scene) -> Option<Flaw> {
    sizes_flaw(("", 0, "size_mm"), scene.size_mm)
        .or_else(|| count_flaw(("textile", MAX_TEXTILES, "id"), scene.textiles.len()))
        .or_else(|| first(&scene.textiles, textile_flaw))
        .or_else(|| no_display_flaw(&scene.displays))
        .or_else(|| count_flaw(("display", MAX_DISPLAYS, "geometry"), scene.displays.len()))
        .or_else(|| first(&scene.displays, display_flaw))
        .or_else(|| filters_flaw(&scene.filters))
        .or_else(|| {
            scene
                .tuning
                .as_ref()
                .and_then(|tuning| tuning_flaw(("tuning", 0), tuning))
        })
        .or_else(|| slots_flaw(scene))
}

fn slots_flaw(scene: &Scene) -> Option<Flaw> {
    let mut seen = BTreeSet::new();
    scene.slots.iter().enumerate().find_map(|(nth, slot)| {
        let twice = !seen.insert(slot.letter);
        let what = || format!("slot {} stands twice", slot.letter.name());
        let mend = "keep one, or give the other a letter from A to H of its own";
        let doubled = twice.then(|| Flaw::new(("slot", nth, "letter"), what(), mend));
        doubled.or_else(|| tuning_flaw(("slot", nth), &slot.tuning))
    })
}

fn first<T>(entries: &[T], flaw: fn(usize, &T) -> Option<Flaw>) -> Option<Flaw> {
    entries
        .iter()
        .enumerate()
        .find_map(|(index, entry)| flaw(index, entry))
}

fn count_flaw(first_too_many: Place, count: usize) -> Option<Flaw> {
    let (table, at_most, _) = first_too_many;
    let what = || format!("{count} [[{table}]] tables");
    (count > at_most).then(|| Flaw::new(first_too_many, what(), format!("place at most {at_most}")))
}

fn no_display_flaw(displays: &[Display]) -> Option<Flaw> {
    displays.is_empty().then(|| {
        Flaw::new(
            ("display", 0, ""),
            "the scene has no display",
            "add a [[display]]",
        )
    })
}

fn textile_flaw(index: usize, textile: &PlacedTextile) -> Option<Flaw> {
    let at = |key| ("textile", index, key);
    let origin: [f64; 2] = textile.origin_mm.into();
    id_flaw(at("id"), &textile.id)
        .or_else(|| finite_flaw(at("origin_mm"), &origin))
        .or_else(|| sizes_flaw(at("size_mm"), textile.size_mm))
        .or_else(|| finite_flaw(at("rotation_deg"), &[textile.rotation_deg]))
        .or_else(|| gain_flaw(at("gain_db"), textile.gain_db))
        .or_else(|| gain_flaw(at("gain_40_db"), textile.gain_40_db))
        .or_else(|| gain_flaw(at("gain_320_db"), textile.gain_320_db))
        .or_else(|| within_flaw(at("within_mm"), textile.within_mm?))
        .or_else(|| {
            let mut gains = textile.slot_gains_db.values();
            gains.find_map(|gain_db| gain_flaw(at("slot_gains_db"), *gain_db))
        })
        .or_else(|| finite_flaw(at("target_40_db_sl"), textile.target_40_db_sl.as_slice()))
        .or_else(|| finite_flaw(at("target_320_db_sl"), textile.target_320_db_sl.as_slice()))
}

fn id_flaw(place: Place, id: &str) -> Option<Flaw> {
    let plain = elsewhere(id).map_or(id, |(_, id)| id);
    let is_name = !plain.is_empty() && !plain.starts_with('.');
    let is_plain = is_name && !plain.contains(['/', '\\', '\n', '\0']);
    (!is_plain).then(|| {
        let what = format!("{id:?} is no textile's id");
        Flaw::new(
            place,
            what,
            "give the name of a folder in the library, or LIBRARY:NAME",
        )
    })
}

fn display_flaw(index: usize, display: &Display) -> Option<Flaw> {
    let turned = finite_flaw(("display", index, "rotation_deg"), &[display.rotation_deg]);
    turned.or_else(|| match &display.geometry {
        Geometry::Array(_) => None,
        Geometry::Contactors(offsets) => {
            contactors_flaw(("display", index, "contactors_mm"), offsets)
        }
    })
}

fn contactors_flaw(place: Place, offsets: &[Displacement]) -> Option<Flaw> {
    if offsets.is_empty() || offsets.len() > MAX_CONTACTORS {
        let what = format!("{} contactors", offsets.len());
        return Some(Flaw::new(
            place,
            what,
            format!("give 1 to {MAX_CONTACTORS}"),
        ));
    }
    let mut taken = BTreeMap::new();
    for (index, &offset) in offsets.iter().enumerate() {
        let xy: [f64; 2] = offset.into();
        if let Some(flaw) = finite_flaw(place, &xy) {
            return Some(flaw);
        }
        // Adding zero makes −0 the same place as 0.
        if let Some(other) = taken.insert(xy.map(|v| (v + 0.0).to_bits()), index) {
            let what = format!("contactors {other} and {index} are at the same place");
            return Some(Flaw::new(
                place,
                what,
                "give every contactor a place of its own",
            ));
        }
    }
    None
}

fn filters_flaw(filters: &Filters) -> Option<Flaw> {
    match *filters {
        Filters::LogGaussian { octaves } if !(octaves > 0.0 && octaves.is_finite()) => {
            let what = format!("octaves is {octaves}");
            Some(Flaw::new(
                ("filters", 0, "octaves"),
                what,
                "give a finite number above 0",
            ))
        }
        _ => None,
    }
}

fn tuning_flaw((table, nth): (&'static str, usize), tuning: &Tuning) -> Option<Flaw> {
    let error = tuning.check().err()?;
    Some(Flaw::described(
        (table, nth, error.key()),
        &error.to_string(),
        FINITE,
    ))
}

fn gain_flaw(place: Place, gain_db: f64) -> Option<Flaw> {
    Tuning::check_gain(place.2, gain_db)
        .err()
        .map(|error| Flaw::described(place, &error.to_string(), FINITE))
}

fn sizes_flaw(place: Place, size_mm: [f64; 2]) -> Option<Flaw> {
    let is_size = size_mm.iter().all(|&mm| mm > 0.0 && mm.is_finite());
    (!is_size).then(|| {
        let what = format!("{} is {}", place.2, listed(&size_mm));
        Flaw::new(place, what, "give two finite numbers of mm above 0")
    })
}

fn within_flaw(place: Place, [from, to]: [Point; 2]) -> Option<Flaw> {
    let is_area = from.is_finite() && to.is_finite() && from.x_mm < to.x_mm && from.y_mm < to.y_mm;
    (!is_area).then(|| {
        let corners = [from, to].map(|corner| listed(&<[f64; 2]>::from(corner)));
        let what = format!("{} is [{}]", place.2, corners.join(", "));
        let mend = "give the lower left and the upper right corner, mm";
        Flaw::new(place, what, mend)
    })
}

fn finite_flaw(place: Place, numbers: &[f64]) -> Option<Flaw> {
    let is_finite = numbers.iter().all(|number| number.is_finite());
    (!is_finite).then(|| {
        Flaw::new(
            place,
            format!("{} is {}", place.2, listed(numbers)),
            "give a finite number",
        )
    })
}

fn listed(numbers: &[f64]) -> String {
    let digits: Vec<String> = numbers.iter().map(ToString::to_string).collect();
    if digits.len() == 1 {
        digits.concat()
    } else {
        format!("[{}]", digits.join(", "))
    }
}
