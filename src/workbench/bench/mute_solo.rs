//! Mute and solo: what is left out for the moment, so that the rest can be felt by itself.
//!
//! Bands, textiles and contactors are three families; solo within one leaves the others alone. It
//! is neither saved nor undone, and no file ever holds it.

use crate::bench::editing;
use crate::bench::part::Part;
use selvedge_render::scene::Scene;
use selvedge_textile::tactile::{Band, Tuning};

/// What is muted and what is felt alone.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct MuteSolo {
    muted: Vec<Part>,
    solo: Vec<Part>,
}

impl MuteSolo {
    /// Mutes a part, or lets it be felt again.
    pub(crate) fn toggle_mute(&mut self, part: Part) {
        toggle(&mut self.muted, part);
    }

    /// Lets a part be felt alone with others that are, or no longer.
    pub(crate) fn toggle_solo(&mut self, part: Part) {
        toggle(&mut self.solo, part);
    }

    /// Whether it was muted.
    pub(crate) fn is_muted(&self, part: Part) -> bool {
        self.muted.contains(&part)
    }

    /// Whether it is felt alone.
    pub(crate) fn is_solo(&self, part: Part) -> bool {
        self.solo.contains(&part)
    }

    /// Whether anything is left out at all.
    pub(crate) fn is_any(&self) -> bool {
        !(self.muted.is_empty() && self.solo.is_empty())
    }

    /// Whether it is felt.
    pub(crate) fn is_felt(&self, part: Part) -> bool {
        let is_kin = |other: &Part| std::mem::discriminant(other) == std::mem::discriminant(&part);
        let has_solo = self.solo.iter().any(is_kin);
        !self.is_muted(part) && (!has_solo || self.is_solo(part))
    }

    /// The tuning with the bands silenced that are not felt.
    pub(crate) fn tuning(&self, mut tuning: Tuning) -> Tuning {
        for band in Band::ALL {
            if !self.is_felt(Part::Band(band)) {
                match band {
                    Band::Low => tuning.gain_40_db = f64::NEG_INFINITY,
                    Band::High => tuning.gain_320_db = f64::NEG_INFINITY,
                }
            }
        }
        tuning
    }

    /// The scene gain of a textile, silenced when it is not felt, dB.
    pub(crate) fn cloth_gain_db(&self, index: usize, gain_db: f64) -> f64 {
        if self.is_felt(Part::Cloth(index)) {
            gain_db
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Which of `n` contactors are felt; empty when all are.
    pub(crate) fn contactor_mask(&self, n: usize) -> Vec<bool> {
        let mask: Vec<bool> = (0..n).map(|i| self.is_felt(Part::Contactor(i))).collect();
        if mask.iter().all(|is_felt| *is_felt) {
            Vec::new()
        } else {
            mask
        }
    }

    /// Follows textiles that changed their places in the scene's list; those that went are
    /// forgotten.
    pub(crate) fn follow(&mut self, before: &Scene, after: &Scene) {
        let moved = |part: Part| match part {
            Part::Cloth(index) => editing::place_after(before, after, index).map(Part::Cloth),
            other => Some(other),
        };
        for parts in [&mut self.muted, &mut self.solo] {
            *parts = parts.iter().copied().filter_map(moved).collect();
        }
    }
}

fn toggle(parts: &mut Vec<Part>, part: Part) {
    match parts.iter().position(|other| *other == part) {
        Some(at) => drop(parts.remove(at)),
        None => parts.push(part),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::command::edit::Edit;
    use selvedge_foundation::geometry::Point;

    #[test]
    fn solo_silences_its_own_family_alone() {
        let mut mute_solo = MuteSolo::default();
        assert!(!mute_solo.is_any());
        mute_solo.toggle_solo(Part::Cloth(1));
        assert!(mute_solo.is_felt(Part::Cloth(1)) && !mute_solo.is_felt(Part::Cloth(0)));
        assert!(mute_solo.is_felt(Part::Band(Band::Low)), "another family");
        mute_solo.toggle_mute(Part::Cloth(1));
        assert!(!mute_solo.is_felt(Part::Cloth(1)), "mute goes before solo");
        mute_solo.toggle_mute(Part::Cloth(1));
        mute_solo.toggle_solo(Part::Cloth(1));
        assert_eq!(mute_solo, MuteSolo::default());
    }

    #[test]
    fn what_is_not_felt_has_no_gain_and_nothing_else_changes() {
        let mut mute_solo = MuteSolo::default();
        let tuning = Tuning {
            gain_db: -3.0,
            gain_40_db: 2.0,
            ..Tuning::default()
        };
        assert_eq!(mute_solo.tuning(tuning), tuning);
        assert!(mute_solo.contactor_mask(24).is_empty());
        mute_solo.toggle_solo(Part::Band(Band::High));
        mute_solo.toggle_mute(Part::Contactor(2));
        let silenced = mute_solo.tuning(tuning);
        assert_eq!(silenced.gain_40_db, f64::NEG_INFINITY);
        assert_eq!((silenced.gain_db, silenced.gain_320_db), (-3.0, 0.0));
        assert_eq!(mute_solo.contactor_mask(4), [true, true, false, true]);
        assert_eq!(mute_solo.cloth_gain_db(0, 1.5), 1.5);
    }

    #[test]
    fn a_muted_textile_stays_muted_when_another_goes() {
        let mut scene = Scene {
            size_mm: [100.0; 2],
            ..Scene::default()
        };
        for id in ["silk", "jute"] {
            let edit = Edit::AddCloth(id.to_owned(), Point::new(50.0, 50.0));
            editing::apply(&edit, &mut scene, Tuning::default());
        }
        let mut mute_solo = MuteSolo::default();
        mute_solo.toggle_mute(Part::Cloth(1));
        let before = scene.clone();
        editing::apply(&Edit::RemoveCloth(0), &mut scene, Tuning::default());
        mute_solo.follow(&before, &scene);
        assert!(mute_solo.is_muted(Part::Cloth(0)));
        let before = scene.clone();
        editing::apply(&Edit::RemoveCloth(0), &mut scene, Tuning::default());
        mute_solo.follow(&before, &scene);
        assert!(!mute_solo.is_any(), "it is gone");
    }
}
