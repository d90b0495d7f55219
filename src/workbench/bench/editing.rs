//! What an edit makes of a scene: pure, and the only place that knows.

use crate::bench::command::edit::Edit;
use crate::bench::free_places::free_places;
use crate::bench::gain_set::{GainSet, band_gain_mut};
use selvedge_foundation::geometry::{Displacement, Point, Rotation};
use selvedge_render::scene::{PlacedTextile, Scene};
use selvedge_textile::tactile::{Band, Tuning};

/// Side of a textile that is placed anew, where the workspace has room for it, mm.
const NEW_SIDE_MM: f64 = 100.0;
/// The least extent of a textile, mm.
pub(crate) const LEAST_SIDE_MM: f64 = 2.0;

/// Makes the edit in `scene`, whose tuning is `tuning` as long as it states none. An edit of a
/// textile that is not there changes nothing.
pub(crate) fn apply(edit: &Edit, scene: &mut Scene, mut tuning: Tuning) {
    let before = tuning;
    match edit {
        Edit::MasterGain(db) => tuning.gain_db = *db,
        Edit::BandGain(band, db) => *band_gain_mut(&mut tuning, *band) = *db,
        Edit::Compression(share) => tuning.compression = *share,
        Edit::Filters(filters) => scene.filters = *filters,
        Edit::AddCloth(id, middle) => {
            let added = new_cloth(scene, id, *middle, new_size_mm(scene.size_mm));
            scene.textiles.push(added);
        }
        Edit::AddCloths(ids) => {
            let (side_mm, middles) = free_places(scene, ids.len());
            for (id, middle) in ids.iter().zip(middles) {
                let added = new_cloth(scene, id, middle, [side_mm; 2]);
                scene.textiles.push(added);
            }
        }
        Edit::RemoveCloth(index) => {
            if *index < scene.textiles.len() {
                scene.textiles.remove(*index);
            }
        }
        Edit::RaiseCloth(index) => {
            if *index < scene.textiles.len() {
                let raised = scene.textiles.remove(*index);
                scene.textiles.push(raised);
            }
        }
        Edit::Recording(reference) => {
            let before = scene.recordings.len();
            scene
                .recordings
                .retain(|known| known.path != reference.path);
            if scene.recordings.len() == before {
                scene.recordings.push(reference.clone());
            }
        }
        Edit::Gains(gains) => {
            tuning = gains.tuning;
            gains.put_into(scene);
        }
        Edit::KeepSlot(_) | Edit::EmptySlot(_) | Edit::SlotWords(..) => {
            change_slot(edit, scene, tuning);
        }
        Edit::TextileGain(index, _)
        | Edit::TargetLevel(index, ..)
        | Edit::MoveCloth(index, _)
        | Edit::TurnCloth(index, _)
        | Edit::ResizeCloth(index, _)
        | Edit::Label(index, _) => {
            if let Some(cloth) = scene.textiles.get_mut(*index) {
                change_cloth(edit, cloth);
            }
        }
    }
    if tuning != before {
        scene.tuning = Some(tuning);
    }
}

fn change_slot(edit: &Edit, scene: &mut Scene, tuning: Tuning) {
    match edit {
        Edit::KeepSlot(letter) => GainSet::of(scene, tuning).keep_in(scene, *letter),
        Edit::EmptySlot(letter) => {
            scene.slots.retain(|slot| slot.letter != *letter);
            for cloth in &mut scene.textiles {
                cloth.slot_gains_db.remove(letter);
            }
        }
        Edit::SlotWords(letter, [name, note]) => {
            if let Some(slot) = scene.slots.iter_mut().find(|slot| slot.letter == *letter) {
                slot.name.clone_from(name);
                slot.note.clone_from(note);
            }
        }
        _ => {}
    }
}

fn change_cloth(edit: &Edit, cloth: &mut PlacedTextile) {
    match edit {
        Edit::TextileGain(_, db) => cloth.gain_db = *db,
        Edit::TargetLevel(_, Band::Low, db_sl) => cloth.target_40_db_sl = *db_sl,
        Edit::TargetLevel(_, Band::High, db_sl) => cloth.target_320_db_sl = *db_sl,
        Edit::MoveCloth(_, origin) => {
            let by = *origin - cloth.origin_mm;
            cloth.origin_mm = *origin;
            cloth.within_mm = cloth
                .within_mm
                .map(|corners| corners.map(|corner| corner + by));
        }
        Edit::TurnCloth(_, angle_deg) => turn(cloth, *angle_deg),
        Edit::ResizeCloth(_, size_mm) => {
            cloth.size_mm = size_mm.map(|side_mm| side_mm.max(LEAST_SIDE_MM));
        }
        Edit::Label(_, label) => cloth.label.clone_from(label),
        _ => {}
    }
}

/// Turns a textile about its middle.
fn turn(cloth: &mut PlacedTextile, angle_deg: f64) {
    let middle = middle(cloth);
    cloth.rotation_deg = angle_deg;
    let half = half_diagonal(cloth.size_mm);
    cloth.origin_mm = middle - Rotation::from_degrees(angle_deg).turn(half);
}

/// The middle of a textile in the workspace.
pub(crate) fn middle(cloth: &PlacedTextile) -> Point {
    let [width_mm, height_mm] = cloth.size_mm;
    let half = Point::new(width_mm / 2.0, height_mm / 2.0);
    cloth.workspace_from_textile().point(half)
}

/// Extent of a textile that is placed anew: 100 mm, or half of a workspace that is too small.
pub(crate) fn new_size_mm(workspace_mm: [f64; 2]) -> [f64; 2] {
    let side_mm = NEW_SIDE_MM.min(workspace_mm[0].min(workspace_mm[1]) / 2.0);
    [side_mm.max(LEAST_SIDE_MM); 2]
}

fn new_cloth(scene: &Scene, id: &str, middle: Point, size_mm: [f64; 2]) -> PlacedTextile {
    let origin = middle - half_diagonal(size_mm);
    PlacedTextile {
        id: id.to_owned(),
        origin_mm: Point::new(whole(origin.x_mm), whole(origin.y_mm)),
        size_mm,
        label: free_label(scene),
        ..PlacedTextile::default()
    }
}

fn half_diagonal([width_mm, height_mm]: [f64; 2]) -> Displacement {
    Displacement {
        x_mm: width_mm / 2.0,
        y_mm: height_mm / 2.0,
    }
}

/// The nearest whole millimetre: what is dropped by hand need not be finer.
fn whole(place_mm: f64) -> f64 {
    place_mm.round()
}

/// The least number that no textile of the scene is called.
fn free_label(scene: &Scene) -> String {
    let is_free = |label: &String| scene.textiles.iter().all(|cloth| cloth.label != *label);
    (1..=scene.textiles.len() + 1)
        .map(|number| number.to_string())
        .find(is_free)
        .unwrap_or_default()
}

/// Where the textile at `index` of `before` stands in `after`: by its id and label, the same one of
/// several that are alike.
pub(crate) fn place_after(before: &Scene, after: &Scene, index: usize) -> Option<usize> {
    let sought = before.textiles.get(index)?;
    let is_alike = |cloth: &&PlacedTextile| cloth.id == sought.id && cloth.label == sought.label;
    let nth = before.textiles[..index].iter().filter(is_alike).count();
    let alike = after.textiles.iter().enumerate();
    let found = alike
        .filter(|(_, cloth)| is_alike(cloth))
        .nth(nth)
        .map(|(place, _)| place);
    // A new label does not make it another textile.
    found.or_else(|| {
        let same_place = after.textiles.get(index);
        same_place
            .filter(|cloth| cloth.id == sought.id && before.textiles.len() == after.textiles.len())
            .map(|_| index)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let mut scene = Scene {
            size_mm: [260.0; 2],
            ..Scene::default()
        };
        for id in ["silk", "jute", "silk"] {
            let edit = Edit::AddCloth(id.to_owned(), Point::new(60.4, 80.0));
            apply(&edit, &mut scene, Tuning::default());
        }
        scene
    }

    #[test]
    fn a_new_textile_lies_where_it_was_dropped_under_a_free_number() {
        let mut scene = scene();
        assert_eq!(scene.textiles[0].origin_mm, Point::new(10.0, 30.0));
        apply(&Edit::RemoveCloth(1), &mut scene, Tuning::default());
        let again = Edit::AddCloth("wool".to_owned(), Point::new(130.0, 130.0));
        apply(&again, &mut scene, Tuning::default());
        let labels: Vec<&str> = scene.textiles.iter().map(|t| t.label.as_str()).collect();
        assert_eq!(labels, ["1", "3", "2"]);
        assert_eq!(new_size_mm([80.0, 500.0]), [40.0, 40.0]);
    }

    #[test]
    fn a_turned_textile_keeps_its_middle() {
        let mut scene = scene();
        let before = middle(&scene.textiles[1]);
        for angle_deg in [30.0, 90.0, -745.5] {
            apply(
                &Edit::TurnCloth(1, angle_deg),
                &mut scene,
                Tuning::default(),
            );
            let off = middle(&scene.textiles[1]) - before;
            assert!(off.length_mm() < 1e-9, "{angle_deg}°: {off:?}");
        }
    }

    #[test]
    fn textiles_are_found_again_after_others_went() {
        let before = scene();
        let mut after = before.clone();
        apply(&Edit::RemoveCloth(0), &mut after, Tuning::default());
        assert_eq!(place_after(&before, &after, 0), None);
        assert_eq!(place_after(&before, &after, 1), Some(0));
        assert_eq!(place_after(&before, &after, 2), Some(1));
        apply(&Edit::RaiseCloth(0), &mut after, Tuning::default());
        assert_eq!(place_after(&before, &after, 1), Some(1));
        apply(
            &Edit::Label(1, "x".to_owned()),
            &mut after,
            Tuning::default(),
        );
        assert_eq!(place_after(&before, &after, 9), None);
        let renamed = after.clone();
        apply(
            &Edit::Label(0, "y".to_owned()),
            &mut after,
            Tuning::default(),
        );
        assert_eq!(place_after(&renamed, &after, 0), Some(0));
    }

    #[test]
    fn edits_of_textiles_that_are_not_there_change_nothing() {
        let mut scene = scene();
        let before = scene.clone();
        let edits = [
            Edit::RemoveCloth(7),
            Edit::RaiseCloth(7),
            Edit::MoveCloth(7, Point::default()),
            Edit::TextileGain(7, 3.0),
        ];
        for edit in edits {
            apply(&edit, &mut scene, Tuning::default());
            assert_eq!(scene, before, "{edit:?}");
        }
    }
}
