//! What the engine was told of gains, so that it is told only what changed.
//!
//! The gains that are felt are the document's with what is muted left out.

use crate::bench::gain_set::GainSet;
use crate::bench::mute_solo::MuteSolo;
use selvedge_engine::Command;
use selvedge_render::RenderScene;
use selvedge_render::scene::Scene;
use selvedge_textile::tactile::Tuning;

/// Gains in force.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct AppliedGains {
    tuning: Tuning,
    cloth_gains_db: Vec<f64>,
    contactor_mask: Vec<bool>,
}

impl AppliedGains {
    /// What is to be felt of gains with `n_contactors`.
    pub(crate) fn of(gains: &GainSet, mute_solo: &MuteSolo, n_contactors: usize) -> Self {
        let own = gains.gains_db.iter().enumerate();
        Self {
            tuning: mute_solo.tuning(gains.tuning),
            cloth_gains_db: own
                .map(|(index, gain_db)| mute_solo.cloth_gain_db(index, *gain_db))
                .collect(),
            contactor_mask: mute_solo.contactor_mask(n_contactors),
        }
    }

    /// What is in force once the engine has a scene that was made by [`Self::in_scene`]: it brings
    /// gains, and contactors stay as they were.
    pub(crate) fn after_scene(&self, scene: &Scene) -> Self {
        Self {
            tuning: scene.tuning.unwrap_or(self.tuning),
            cloth_gains_db: scene.textiles.iter().map(|cloth| cloth.gain_db).collect(),
            contactor_mask: self.contactor_mask.clone(),
        }
    }

    /// The scene as the engine ought to prepare it: with these gains.
    pub(crate) fn in_scene(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.tuning = Some(self.tuning);
        for (cloth, gain_db) in scene.textiles.iter_mut().zip(&self.cloth_gains_db) {
            cloth.gain_db = *gain_db;
        }
        scene
    }

    /// Puts these gains into a scene as rendering sees it.
    pub(crate) fn put_into(&self, scene: &mut RenderScene) {
        scene.tuning = self.tuning;
        for (textile, gain_db) in scene.textiles.iter_mut().zip(&self.cloth_gains_db) {
            textile.scene_gain_db = *gain_db;
        }
    }

    /// Which contactors of the first display are felt; those beyond its end are.
    pub(crate) fn contactor_mask(&self) -> &[bool] {
        &self.contactor_mask
    }

    /// What the engine must be told when it knows `self` and `new` is to be felt; both are of the
    /// same textiles.
    pub(crate) fn changes(&self, new: &Self) -> Vec<Command> {
        let mut commands = Vec::new();
        let gains = self.cloth_gains_db.iter().zip(&new.cloth_gains_db);
        let changed = gains.enumerate().filter_map(|(textile, (old, &gain_db))| {
            old.total_cmp(&gain_db)
                .is_ne()
                .then_some((textile, gain_db))
        });
        let textiles_db: Vec<_> = changed.collect();
        if self.tuning != new.tuning || !textiles_db.is_empty() {
            // One command, so that no tick comes between the two.
            commands.push(Command::SetGains {
                tuning: new.tuning,
                textiles_db,
            });
        }
        if self.contactor_mask != new.contactor_mask {
            commands.push(Command::SetContactorMask(new.contactor_mask.clone()));
        }
        commands
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::command::edit::Edit;
    use crate::bench::editing;
    use crate::bench::part::Part;
    use selvedge_foundation::geometry::Point;
    use selvedge_textile::tactile::Band;

    #[test]
    fn the_engine_is_told_what_changed_and_nothing_else() {
        let mut scene = Scene {
            size_mm: [100.0; 2],
            ..Scene::default()
        };
        for id in ["silk", "jute"] {
            let edit = Edit::AddCloth(id.to_owned(), Point::new(50.0, 50.0));
            editing::apply(&edit, &mut scene, Tuning::default());
        }
        let felt = |scene: &Scene, mute_solo: &MuteSolo| {
            AppliedGains::of(&GainSet::of(scene, Tuning::default()), mute_solo, 24)
        };
        let mut mute_solo = MuteSolo::default();
        let before = felt(&scene, &mute_solo);
        assert!(before.changes(&felt(&scene, &mute_solo)).is_empty());
        mute_solo.toggle_mute(Part::Cloth(1));
        mute_solo.toggle_solo(Part::Band(Band::Low));
        mute_solo.toggle_mute(Part::Contactor(0));
        let after = felt(&scene, &mute_solo);
        let words: Vec<String> = before
            .changes(&after)
            .iter()
            .map(|command| format!("{command:?}"))
            .map(|words| {
                words
                    .split(['(', ' '])
                    .next()
                    .unwrap_or_default()
                    .to_owned()
            })
            .collect();
        assert_eq!(words, ["SetGains", "SetContactorMask"]);
        let prepared = after.in_scene(&scene);
        assert_eq!(prepared.textiles[1].gain_db, f64::NEG_INFINITY);
        assert_eq!(prepared.textiles[0].gain_db, 0.0);
        assert_eq!(after.after_scene(&prepared), after, "nothing more to tell");
    }
}
