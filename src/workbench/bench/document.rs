//! The document: the scene, undoable and saved.
//!
//! Layout (what is shown how) and transient state (notices, fields being typed in, the device) are
//! not here and are never undone. Knows nothing of windows.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::bench::command::edit::{Edit, Target};
use crate::bench::editing;
use crate::bench::gain_set::GainSet;
use crate::bench::history::{History, Moment, StepList};
use crate::bench::pane::Pane;
use crate::bench::recovery::Unsaved;
use selvedge_render::scene::{Arrangement, PlacedTextile, Scene, SceneError};
use selvedge_textile::is_of_the_program;
use selvedge_textile::tactile::Tuning;

/// A scene that is being edited.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Document {
    path: Option<PathBuf>,
    scene: Scene,
    saved: Scene,
    default_tuning: Tuning,
    history: History<Scene, Target>,
    /// How its window stands: what is seen of it, not what is felt, and so no step.
    #[serde(default)]
    arrangement: Option<Arrangement>,
    #[serde(default)]
    saved_arrangement: Option<Arrangement>,
}

impl Document {
    /// A scene as it was opened; without a path it is one that the program ships.
    pub(crate) fn new(mut scene: Scene, path: Option<PathBuf>, default_tuning: Tuning) -> Self {
        let arrangement = scene.arrangement.take();
        Self {
            saved_arrangement: arrangement.clone(),
            arrangement,
            saved: scene.clone(),
            scene,
            path,
            default_tuning,
            history: History::default(),
        }
    }

    /// The scene.
    pub(crate) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where it was opened or saved.
    pub(crate) fn path(&self) -> Option<&PathBuf> {
        self.path.as_ref()
    }

    /// Whether it differs from its file.
    pub(crate) fn is_edited(&self) -> bool {
        self.scene != self.saved || self.arrangement != self.saved_arrangement
    }

    /// How its window stands; `None` leaves that to the window.
    pub(crate) fn arrangement(&self) -> Option<&Arrangement> {
        self.arrangement.as_ref()
    }

    /// Keeps how its window stands, or no longer.
    pub(crate) fn arrange(&mut self, arrangement: Option<Arrangement>) {
        self.arrangement = arrangement;
    }

    /// What no file holds of it, with every step.
    pub(crate) fn unsaved(&self) -> Option<Unsaved> {
        if !self.is_edited() {
            return None;
        }
        let file = self.path.as_ref();
        let file = file.map_or_else(String::new, |path| format!(" ({})", path.display()));
        let steps = self.steps();
        let n_steps = match steps.n_done {
            0 => "how its window stands".to_owned(),
            1 => "1 step".to_owned(),
            n => format!("{n} steps"),
        };
        let last = steps
            .undo()
            .map_or_else(String::new, |last| format!(", the last: {last}"));
        let name = format!("Scene “{}”{file}", self.scene.name);
        let what = format!("{n_steps}{last}");
        let whole = |history| Self {
            history,
            ..self.without_steps()
        };
        Some(Unsaved::with_steps(name, &what, &self.history, whole))
    }

    fn without_steps(&self) -> Self {
        Self {
            path: self.path.clone(),
            saved: self.saved.clone(),
            arrangement: self.arrangement.clone(),
            saved_arrangement: self.saved_arrangement.clone(),
            ..Self::new(self.scene.clone(), None, self.default_tuning)
        }
    }

    /// The tuning of a scene that states none.
    pub(crate) fn default_tuning(&self) -> Tuning {
        self.default_tuning
    }

    /// The tuning in force.
    pub(crate) fn tuning(&self) -> Tuning {
        self.scene.tuning.unwrap_or(self.default_tuning)
    }

    /// Makes a change. One that makes no sense is refused and nothing happens.
    pub(crate) fn edit(&mut self, edit: &Edit, now: Moment) -> Result<(), SceneError> {
        let mut scene = self.scene.clone();
        editing::apply(edit, &mut scene, self.tuning());
        if scene == self.scene {
            return Ok(());
        }
        scene.check()?;
        let target = edit.target();
        self.history.begin(&self.scene, target, target.label(), now);
        if !target.joins() {
            self.history.settle();
        }
        self.scene = scene;
        Ok(())
    }

    /// The steps that led to the scene as it is.
    pub(crate) fn steps(&self) -> StepList {
        self.history.steps(&self.scene)
    }

    /// The panes of which each shows what lies between the scene as it is and as it was after so
    /// many steps.
    pub(crate) fn panes_of(&self, n_done: usize) -> Option<&'static [Pane]> {
        let there = self.history.state_after(n_done, &self.scene)?;
        let lies = |scene: &Scene| -> Vec<PlacedTextile> {
            let untuned = |cloth: &PlacedTextile| PlacedTextile {
                label: cloth.label.clone(),
                ..cloth.untuned()
            };
            scene.textiles.iter().map(untuned).collect()
        };
        let is_moved = lies(there) != lies(&self.scene);
        Some(if is_moved {
            &[Pane::Workspace]
        } else {
            &[Pane::Tuning, Pane::Levels]
        })
    }

    /// What gains a step turned, in words, and what going to where it was done would turn.
    pub(crate) fn turned_by(&self, n_done: usize) -> [String; 2] {
        let after = |n_done| {
            let there = self.history.state_after(n_done, &self.scene);
            there.unwrap_or(&self.scene)
        };
        let gains = |scene| GainSet::of(scene, self.default_tuning);
        let (there, now) = (after(n_done), gains(&self.scene));
        let names: Vec<String> = (there.textiles.iter())
            .map(|cloth| format!("{} {}", cloth.label, cloth.id).trim().to_owned())
            .collect();
        let turned = |from: &GainSet| from.differences(&gains(there), &names).join(", ");
        let before = n_done.checked_sub(1).map(|before| gains(after(before)));
        [
            before.as_ref().map_or_else(String::new, turned),
            turned(&now),
        ]
    }

    /// Takes steps back or brings them again until so many are done.
    pub(crate) fn step_to(&mut self, n_done: usize) {
        self.history.step_to(n_done, &mut self.scene);
    }

    /// Takes the last step back for good: it turned out to be impossible.
    pub(crate) fn take_back(&mut self) {
        let n_done = self.steps().n_done;
        self.step_to(n_done.saturating_sub(1));
        self.history.forget_undone();
    }

    /// Writes the scene to `path`, which is its place from now on.
    pub(crate) fn save_as(
        &mut self,
        path: &Path,
        contents: BTreeMap<String, String>,
    ) -> Result<(), SceneError> {
        let mut scene = self.scene.clone();
        scene.contents = contents;
        scene.arrangement.clone_from(&self.arrangement);
        if let Some(old) = self
            .path
            .as_deref()
            .filter(|old| old.parent() != path.parent())
        {
            // A library named relative to the old place would not be found from the new one.
            scene.library = scene.library_folder(old).map(|folder| {
                if is_of_the_program(&folder) {
                    return folder;
                }
                std::path::absolute(&folder).unwrap_or(folder)
            });
            for reference in &mut scene.recordings {
                reference.path = reference.place(Some(old));
            }
        }
        scene.write(path)?;
        self.scene.contents.clone_from(&scene.contents);
        self.scene.library.clone_from(&scene.library);
        self.scene.recordings.clone_from(&scene.recordings);
        self.saved = self.scene.clone();
        self.saved_arrangement.clone_from(&self.arrangement);
        self.path = Some(path.to_owned());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::bench::background::Executor;
    use crate::bench::recovery::{Part, Recovery};
    use selvedge_scratch::ScratchFolder;
    use selvedge_textile::tactile::Band;

    fn document() -> Document {
        let textile = PlacedTextile {
            id: "silk".to_owned(),
            size_mm: [10.0; 2],
            ..empty()
        };
        let scene = Scene {
            name: "Test".to_owned(),
            size_mm: [100.0; 2],
            textiles: vec![textile],
            displays: vec![selvedge_render::scene::Display::default()],
            ..Scene::default()
        };
        Document::new(
            scene,
            None,
            Tuning {
                gain_db: -3.0,
                ..Tuning::default()
            },
        )
    }

    fn empty() -> PlacedTextile {
        PlacedTextile {
            size_mm: [1.0; 2],
            ..PlacedTextile::default()
        }
    }

    fn at(press: u64) -> Moment {
        Moment {
            press,
            is_down: true,
            t_s: press as f64,
        }
    }

    #[test]
    fn an_edit_starts_from_the_librarys_tuning_and_undo_goes_back_to_none() {
        let mut document = document();
        document.edit(&Edit::Compression(0.5), at(1)).unwrap();
        let tuning = document.tuning();
        assert_eq!((tuning.gain_db, tuning.compression), (-3.0, 0.5));
        assert!(document.is_edited(), "a changed tuning is an edit");
        assert_eq!(document.steps().undo(), Some("compression"));
        document.step_to(0);
        assert_eq!(document.scene().tuning, None);
        assert!(!document.is_edited(), "undone");
    }

    #[test]
    fn a_change_that_makes_no_sense_changes_nothing() {
        let mut document = document();
        for edit in [Edit::MasterGain(f64::NAN), Edit::Compression(1.5)] {
            assert!(document.edit(&edit, at(1)).is_err(), "{edit:?}");
        }
        document.edit(&Edit::TextileGain(7, 3.0), at(2)).unwrap();
        assert!(!document.is_edited(), "nothing changed");
        assert_eq!(document.steps().undo(), None);
    }

    #[test]
    fn a_step_says_what_it_turned_and_what_going_there_would_turn() {
        let mut document = document();
        document.edit(&Edit::MasterGain(-1.0), at(1)).unwrap();
        document.edit(&Edit::Compression(0.25), at(2)).unwrap();
        let both = |own: &str, from_now: &str| [own.to_owned(), from_now.to_owned()];
        let back = "master −1.0 → −3.0 dB, compression 25 → 0 %";
        assert_eq!(document.turned_by(0), both("", back));
        let first = both("master −3.0 → −1.0 dB", "compression 25 → 0 %");
        assert_eq!(document.turned_by(1), first);
        assert_eq!(document.turned_by(2), both("compression 0 → 25 %", ""));
        document.step_to(0);
        assert_eq!(document.turned_by(1)[0], "master −3.0 → −1.0 dB");
        assert_eq!(document.turned_by(0), both("", ""));
    }

    #[test]
    fn saving_is_no_step_of_undo() {
        let folder = ScratchFolder::made("document");
        let path = folder.join("a.scene.toml");
        let mut document = document();
        document.edit(&Edit::TextileGain(0, 2.5), at(1)).unwrap();
        document.save_as(&path, BTreeMap::new()).unwrap();
        assert!(!document.is_edited(), "saved");
        assert_eq!(Scene::read(&path).unwrap(), *document.scene());
        document.step_to(0);
        assert!(document.is_edited(), "undone after saving");
    }

    #[test]
    fn unsaved_work_of_many_textiles_and_steps_is_read_back_without_the_oldest() {
        let root = ScratchFolder::made("many");
        for (n_textiles, is_whole) in [(16, true), (74, false), (600, false)] {
            let mut scene = document().scene().clone();
            scene.textiles = (0..n_textiles)
                .map(|i| PlacedTextile {
                    id: format!("textile-with-a-long-name-{i}"),
                    label: "a label that says \"what\" it is".to_owned(),
                    ..scene.textiles[0].clone()
                })
                .collect();
            let mut document = Document::new(scene, None, Tuning::default());
            for step in 1..=200_u32 {
                let edit = Edit::TextileGain(0, -f64::from(step));
                document.edit(&edit, at(u64::from(step))).unwrap();
            }
            let part = Part {
                owner: "Scene".to_owned(),
                unsaved: document.unsaved().unwrap(),
            };
            let mut recovery = Recovery::in_folder(root.to_path_buf());
            recovery.write(vec![part], 0.0, &Executor::InLine);
            assert_eq!(recovery.failure(), None, "{n_textiles}");
            drop(recovery);
            let mut recovery = Recovery::in_folder(root.to_path_buf());
            let parts = recovery.restore();
            recovery.end(Vec::new()).unwrap();
            let mut read: Document = parts[0].unsaved.read().unwrap();
            assert_eq!(read.scene(), document.scene());
            let n_steps = read.steps().n_done;
            assert_eq!(n_steps == 200, is_whole, "{n_textiles}: {n_steps}");
            assert!(n_steps > 5, "{n_textiles}: {n_steps}");
            read.step_to(n_steps - 1);
            assert_eq!(read.scene().textiles[0].gain_db, -199.0);
        }
    }

    #[test]
    fn a_library_of_the_program_keeps_its_name_wherever_the_scene_is_saved() {
        let folder = ScratchFolder::made("moved");
        for (named, is_kept) in [("seventy-four", true), ("textiles", false)] {
            let scene = Scene {
                library: Some(named.into()),
                ..document().scene().clone()
            };
            let from = Path::new("/somewhere/a.scene.toml").to_owned();
            let mut document = Document::new(scene, Some(from), Tuning::default());
            let path = folder.join("b.scene.toml");
            document.save_as(&path, BTreeMap::new()).unwrap();
            let library = document.scene().library.clone().unwrap();
            assert_eq!(
                library == Path::new(named),
                is_kept,
                "{}",
                library.display()
            );
        }
    }

    proptest! {
        #[test]
        fn undo_takes_everything_back_and_redo_brings_it_again(
            edits in prop::collection::vec((0_u8..5, -30.0_f64..30.0, 0_u64..6), 0..30)
        ) {
            let mut document = document();
            let first = document.scene().clone();
            for (kind, value, press) in edits {
                let edit = match kind {
                    0 => Edit::MasterGain(value),
                    1 => Edit::BandGain(Band::Low, value),
                    2 => Edit::BandGain(Band::High, value),
                    3 => Edit::Compression((value + 30.0) / 60.0),
                    _ => Edit::TextileGain(0, value),
                };
                document.edit(&edit, at(press)).unwrap();
            }
            let last = document.scene().clone();
            let n_done = document.steps().n_done;
            document.step_to(0);
            prop_assert_eq!(document.scene(), &first);
            document.step_to(n_done);
            prop_assert_eq!(document.scene(), &last);
        }
    }
}
