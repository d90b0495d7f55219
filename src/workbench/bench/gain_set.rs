//! Everything of a scene that gains turn, at once: the tuning and what each textile gets.
//!
//! It is what a slot keeps, what is felt while a slot is held, and what a proposal would make of
//! the scene.

use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_render::scene::{Scene, SlotLetter, TuningSlot};
use selvedge_textile::tactile::{Band, Tuning};

/// Gains of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GainSet {
    /// Master, bands, compression.
    pub(crate) tuning: Tuning,
    /// What the scene gives each textile, in its order, dB.
    pub(crate) gains_db: Vec<f64>,
}

impl GainSet {
    /// Those in force; `default` is the tuning of a scene that states none.
    pub(crate) fn of(scene: &Scene, default: Tuning) -> Self {
        Self {
            tuning: scene.tuning.unwrap_or(default),
            gains_db: scene.textiles.iter().map(|cloth| cloth.gain_db).collect(),
        }
    }

    /// Those that a slot keeps; `None` while it is empty.
    pub(crate) fn of_slot(scene: &Scene, letter: SlotLetter) -> Option<Self> {
        let slot = slot(scene, letter)?;
        let own = scene.textiles.iter();
        let own = own.map(|cloth| {
            cloth
                .slot_gains_db
                .get(&letter)
                .copied()
                .unwrap_or(cloth.gain_db)
        });
        Some(Self {
            tuning: slot.tuning,
            gains_db: own.collect(),
        })
    }

    /// Puts them into force in a scene.
    pub(crate) fn put_into(&self, scene: &mut Scene) {
        scene.tuning = Some(self.tuning);
        for (cloth, gain_db) in scene.textiles.iter_mut().zip(&self.gains_db) {
            cloth.gain_db = *gain_db;
        }
    }

    /// Keeps them in a slot of a scene, whose name and note stay.
    pub(crate) fn keep_in(&self, scene: &mut Scene, letter: SlotLetter) {
        let tuning = self.tuning;
        match scene.slots.iter_mut().find(|slot| slot.letter == letter) {
            Some(slot) => slot.tuning = tuning,
            None => scene.slots.push(TuningSlot {
                letter,
                name: String::new(),
                note: String::new(),
                tuning,
            }),
        }
        scene.slots.sort_by_key(|slot| slot.letter);
        for (cloth, gain_db) in scene.textiles.iter_mut().zip(&self.gains_db) {
            cloth.slot_gains_db.insert(letter, *gain_db);
        }
    }

    /// What differs in `after`, in words: `master −2.0 → −1.0 dB`; `names` are the textiles'.
    pub(crate) fn differences(&self, after: &Self, names: &[String]) -> Vec<String> {
        let of = |set: &Self| {
            let Tuning {
                gain_db,
                gain_40_db,
                gain_320_db,
                compression,
                ..
            } = set.tuning;
            [gain_db, gain_40_db, gain_320_db, 100.0 * compression]
        };
        let what = [
            ("master", 1, "dB"),
            ("40 Hz", 1, "dB"),
            ("320 Hz", 1, "dB"),
            ("compression", 0, "%"),
        ];
        let from_to = |(name, decimals, unit): (&str, usize, &'static str), from: f64, to: f64| {
            let is_same = (from - to).abs() < 1e-9 || from.total_cmp(&to).is_eq();
            let words = || {
                let to = with_unit(to, decimals, unit);
                format!("{name} {} → {to}", fixed(from, decimals))
            };
            (!is_same).then(words)
        };
        let whole = what.into_iter().zip(of(self)).zip(of(after));
        let whole = whole.filter_map(|((what, from), to)| from_to(what, from, to));
        let own = names.iter().zip(&self.gains_db).zip(&after.gains_db);
        let own = own.filter_map(|((name, from), to)| from_to((name, 1, "dB"), *from, *to));
        whole.chain(own).collect()
    }
}

/// A slot of a scene, if something is kept in it.
pub(crate) fn slot(scene: &Scene, letter: SlotLetter) -> Option<&TuningSlot> {
    scene.slots.iter().find(|slot| slot.letter == letter)
}

/// Gain of a band alone in a tuning, dB.
pub(crate) fn band_gain_mut(tuning: &mut Tuning, band: Band) -> &mut f64 {
    match band {
        Band::Low => &mut tuning.gain_40_db,
        Band::High => &mut tuning.gain_320_db,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::command::edit::Edit;
    use crate::bench::editing::apply;
    use selvedge_foundation::geometry::Point;

    fn scene() -> Scene {
        let mut scene = Scene {
            size_mm: [260.0; 2],
            ..Scene::default()
        };
        for id in ["silk", "jute"] {
            let edit = Edit::AddCloth(id.to_owned(), Point::new(60.0, 60.0));
            apply(&edit, &mut scene, Tuning::default());
        }
        scene
    }

    fn edit(scene: &mut Scene, edits: impl IntoIterator<Item = Edit>) {
        for edit in edits {
            let tuning = scene.tuning.unwrap_or_default();
            apply(&edit, scene, tuning);
        }
    }

    #[test]
    fn a_slot_brings_back_what_was_kept_in_it_whatever_became_of_the_textiles() {
        let mut scene = scene();
        let kept = [Edit::MasterGain(-3.0), Edit::TextileGain(1, 4.0)];
        edit(&mut scene, kept);
        edit(&mut scene, [Edit::KeepSlot(SlotLetter::C)]);
        edit(
            &mut scene,
            [Edit::MasterGain(2.0), Edit::TextileGain(1, 0.0)],
        );
        // The first textile goes on top, so the second is the first now; a third comes.
        let third = Edit::AddCloth("wool".to_owned(), Point::new(60.0, 60.0));
        edit(
            &mut scene,
            [Edit::RaiseCloth(0), third, Edit::TextileGain(2, 1.5)],
        );
        let slot = GainSet::of_slot(&scene, SlotLetter::C).unwrap();
        assert_eq!(slot.tuning.gain_db, -3.0);
        assert_eq!(
            slot.gains_db,
            [4.0, 0.0, 1.5],
            "a textile that is new keeps its gain"
        );
        edit(&mut scene, [Edit::Gains(slot.clone())]);
        assert_eq!(GainSet::of(&scene, Tuning::default()), slot);
        edit(&mut scene, [Edit::EmptySlot(SlotLetter::C)]);
        assert_eq!(GainSet::of_slot(&scene, SlotLetter::C), None);
        assert!(
            scene
                .textiles
                .iter()
                .all(|cloth| cloth.slot_gains_db.is_empty())
        );
    }

    #[test]
    fn differences_name_what_was_turned_from_where_to_where() {
        let before = scene();
        let mut after = before.clone();
        edit(
            &mut after,
            [
                Edit::MasterGain(-1.0),
                Edit::Compression(0.25),
                Edit::TextileGain(0, 2.0),
            ],
        );
        let [before, after] = [before, after].map(|scene| GainSet::of(&scene, Tuning::default()));
        let names = ["1 silk".to_owned(), "2 jute".to_owned()];
        let words = before.differences(&after, &names);
        let expected = [
            "master 0.0 → −1.0 dB",
            "compression 0 → 25 %",
            "1 silk 0.0 → 2.0 dB",
        ];
        assert_eq!(words, expected);
        assert!(after.differences(&after, &names).is_empty());
    }
}
