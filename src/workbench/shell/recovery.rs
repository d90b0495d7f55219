//! Nothing is lost: what the document and the tools have that no file holds is kept against a
//! crash, offered at the next start, and named when the window closes.

use eframe::egui::{Context, Event};

use crate::bench::Bench;
use crate::bench::command::Left;
use crate::bench::document::Document;
use crate::bench::opening::Origin;
use crate::bench::recovery::{Part, Unsaved};
use crate::bench::tool::Tool;
use crate::shell::window::Workbench;

/// The owner of the document's part.
const SCENE: &str = "Scene";

impl Workbench {
    /// Everything that would be lost with the window.
    pub(crate) fn unsaved(&self) -> Vec<Part> {
        let part = |owner: &str, unsaved: Unsaved| Part {
            owner: owner.to_owned(),
            unsaved,
        };
        let scene = self.bench.document.unsaved();
        let scene = scene.map(|unsaved| part(SCENE, unsaved));
        let tools = self.tools.iter();
        let drafts = tools.filter_map(|tool| Some(part(owner_of(tool)?, tool.unsaved()?)));
        scene.into_iter().chain(drafts).collect()
    }

    /// Keeps unsaved work against a crash when something has changed. Once a frame.
    pub(crate) fn follow_unsaved(&mut self, ctx: &Context) {
        let now_s = self.bench.clock.now_s();
        let is_act = |event: &Event| !matches!(event, Event::PointerMoved(_) | Event::PointerGone);
        if ctx.input(|input| input.events.iter().any(is_act)) {
            self.bench.files.recovery.touch(now_s);
        }
        if let Some(wait_s) = self.keep_unsaved_at(now_s) {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(wait_s.max(0.05)));
        }
        if let Some(line) = self.bench.files.recovery.failure() {
            self.bench.notices.give(line);
        }
    }

    /// The same at a time, s; says after how many seconds to come again.
    fn keep_unsaved_at(&mut self, now_s: f64) -> Option<f64> {
        let wait_s = self.bench.files.recovery.due_in_s(now_s)?;
        if wait_s > 0.0 {
            return Some(wait_s);
        }
        self.keep_unsaved(now_s);
        self.bench.files.recovery.due_in_s(now_s)
    }

    fn keep_unsaved(&mut self, now_s: f64) {
        if self.bench.files.restoring.is_some() {
            // Until it is there it is on disk where it was found.
            return;
        }
        let parts = self.unsaved();
        let bench = &mut self.bench;
        bench.files.recovery.write(parts, now_s, &bench.executor);
    }

    /// The same, before anything that may go wrong: an import, a device that is armed, a question.
    pub(crate) fn keep_unsaved_now(&mut self) {
        let now_s = self.bench.clock.now_s();
        self.keep_unsaved(now_s);
    }

    /// Does with the offer what the user wants.
    pub(crate) fn answer_offer(&mut self, what: Left) {
        match what {
            Left::Restored => {
                for part in self.bench.files.recovery.restore() {
                    self.restore(&part);
                }
            }
            Left::Discarded => {
                if let Err(error) = self.bench.files.recovery.discard() {
                    self.bench.notices.give(error.to_string());
                }
            }
            Left::PutOff => self.bench.files.recovery.put_off(),
        }
    }

    fn restore(&mut self, part: &Part) {
        let unsaved = &part.unsaved;
        let bench = &mut self.bench;
        let mut tools = self.tools.iter_mut();
        let restored = if part.owner == SCENE {
            bench.restore_scene(unsaved)
        } else {
            let owner = tools.find(|tool| owner_of(&**tool) == Some(part.owner.as_str()));
            owner.map_or(Ok(()), |tool| tool.restore(unsaved, bench))
        };
        if let Err(line) = restored {
            let name = &unsaved.name;
            bench
                .notices
                .give(format!("{name} could not be restored: {line}"));
            bench.files.recovery.put_off();
        }
        let now_s = bench.clock.now_s();
        bench.files.recovery.touch(now_s);
    }
}

/// A tool by its first pane.
fn owner_of(tool: &dyn Tool) -> Option<&'static str> {
    tool.panes().first().map(|pane| pane.title())
}

impl Bench {
    fn restore_scene(&mut self, unsaved: &Unsaved) -> Result<(), String> {
        let document: Document = unsaved.read()?;
        let text = document
            .scene()
            .to_toml()
            .map_err(|error| error.to_string())?;
        let path = document.path().cloned();
        self.files.restoring = Some(document);
        self.open(Origin::Restored(text, path));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use crate::bench::command::lab::Beginning;
    use crate::bench::command::{Command, Edit, FileCommand, Purpose};
    use crate::bench::pane::Pane;
    use crate::bench::recovery::Recovery;
    use crate::shell::headless::Headless;
    use crate::tools::import::Import;
    use crate::tools::lab::Lab;
    use crate::tools::picture::Picture;
    use crate::tools::picture::draft::Part as PicturePart;
    use selvedge_foundation::files::Rgb8Image;
    use selvedge_scratch::ScratchFolder;
    use selvedge_textile::Place;

    fn window(root: &Path) -> Headless {
        let mut window = Headless::shipped();
        window.workbench.bench.files.recovery = Recovery::in_folder(root.to_owned());
        window.pass(2);
        window
    }

    fn gain_db(window: &Headless) -> f64 {
        window.workbench.tuning().gain_db
    }

    fn offered(root: &Path) -> Option<Vec<Part>> {
        let recovery = Recovery::in_folder(root.to_owned());
        recovery.offer().map(|offer| offer.parts().to_vec())
    }

    #[test]
    fn an_edit_that_a_crash_took_is_offered_and_restored_with_its_steps() {
        let root = ScratchFolder::made("offer");
        let mut first = window(&root);
        first.dispatch(Edit::MasterGain(-3.0));
        first.dispatch(Edit::RemoveCloth(0));
        first.workbench.bench.files.recovery.touch(0.0);
        first.pass_ticks(40 * 10);
        drop(first);
        let mut second = window(&root);
        let offer = second.workbench.bench.files.recovery.offer().unwrap();
        let scene = &offer.parts()[0].unsaved;
        assert!(
            scene.what.starts_with("2 steps, the last: "),
            "{}",
            scene.what
        );
        second.dispatch(FileCommand::Left(Left::Restored));
        second.pass(2);
        assert_eq!(gain_db(&second), -3.0);
        assert!(second.workbench.is_edited(), "no file was written over");
        second.dispatch(Command::Undo);
        assert_eq!(
            second.workbench.scene().textiles.len(),
            4,
            "steps came along"
        );
        assert!(second.workbench.bench.files.recovery.offer().is_none());
    }

    #[test]
    fn a_recipe_that_was_changed_survives_a_crash() {
        let root = ScratchFolder::made("recipe");
        let place = Place {
            table: "source",
            key: "hurst",
        };
        let mut first = window(&root);
        first.dispatch(Beginning::Example("brownian"));
        first.pass(4);
        assert_eq!(first.workbench.unsaved(), [], "it only began");
        let lab = first.workbench.tools.get_mut::<Lab>().unwrap();
        lab.set(
            place,
            Some(0.3.into()),
            crate::bench::history::Moment::default(),
        );
        first.workbench.keep_unsaved_now();
        drop(first);
        let mut second = window(&root);
        second.dispatch(FileCommand::Left(Left::Restored));
        let lab = second.workbench.tools.get::<Lab>().unwrap();
        let steps = lab.steps.as_ref().unwrap();
        assert_eq!(steps.recipe.draft.number(place), Some(0.3));
        assert_eq!(steps.list().undo(), Some("Hurst exponent"));
    }

    #[test]
    fn work_on_an_import_and_on_a_picture_survives_a_crash() {
        let (root, files) = (ScratchFolder::made("drafts"), ScratchFolder::made("files"));
        let (table, picture) = (files.join("strip.csv"), files.join("cloth.png"));
        let rows = (0..200).map(|n| format!("{},{}\n", 0.1 * f64::from(n), n % 7));
        fs::write(&table, rows.collect::<String>()).unwrap();
        let grey = |nth: usize| if nth % 8 < 4 { 40 } else { 210 };
        let image = Rgb8Image {
            width: 64,
            height: 64,
            pixels: (0..64 * 64).map(|n| [grey(n % 64 + n / 64); 3]).collect(),
        };
        fs::write(&picture, image.to_png(&picture).unwrap()).unwrap();
        let mut first = window(&root);
        first.dispatch(FileCommand::Use(Purpose::ImportFiles, table));
        first.dispatch(FileCommand::Use(
            Purpose::OpenPicture(Pane::Picture),
            picture,
        ));
        first.pass(6);
        let import = first.workbench.tools.get_mut::<Import>().unwrap();
        import.draft.looked.sections[1] = Some([1.0, 2.5]);
        import.draft.words.figures = vec![("thickness_mm".to_owned(), "0.4".to_owned())];
        let picture = first.workbench.tools.get_mut::<Picture>().unwrap();
        picture.draft.part = PicturePart::Corners([[0.0, 1.5]; 4]);
        picture.draft.scale = "600".to_owned();
        let before = first.workbench.unsaved();
        assert_eq!(before.len(), 2, "{before:?}");
        first.workbench.keep_unsaved_now();
        assert_eq!(first.workbench.bench.files.recovery.failure(), None);
        drop(first);
        let mut second = window(&root);
        second.dispatch(FileCommand::Left(Left::Restored));
        second.pass(6);
        assert_eq!(second.workbench.unsaved(), before);
    }

    #[test]
    fn closing_names_everything_that_would_be_lost_once() {
        let root = ScratchFolder::made("closing");
        let mut window = window(&root);
        window.dispatch(Edit::MasterGain(-3.0));
        window.dispatch(Beginning::Example("brownian"));
        window.pass(4);
        let place = Place {
            table: "source",
            key: "hurst",
        };
        let lab = window.workbench.tools.get_mut::<Lab>().unwrap();
        lab.set(
            place,
            Some(0.3.into()),
            crate::bench::history::Moment::default(),
        );
        let asked = |window: &Headless| {
            let question = window.workbench.shell.question.as_ref().unwrap();
            let parts = question.parts.iter();
            parts.map(|part| part.owner.clone()).collect::<Vec<_>>()
        };
        window.dispatch(FileCommand::Close);
        assert_eq!(asked(&window), ["Scene", "Textile lab"]);
        window.dispatch(Command::Dismiss);
        window.dispatch(FileCommand::New);
        assert_eq!(asked(&window), ["Scene"], "a draft outlives a scene");
        window.dispatch(Command::Dismiss);
        let scene = root.join("a.scene.toml");
        window.dispatch(FileCommand::Use(Purpose::SaveScene, scene));
        window.dispatch(FileCommand::Close);
        window.dispatch(FileCommand::SaveAll);
        assert!(
            window.workbench.shell.may_close,
            "the draft stays for the next start"
        );
        assert!(window.workbench.bench.files.recovery.keeps);
    }

    /// An hour in which something changes every second, cut off at 50 moments.
    #[test]
    fn at_whatever_moment_it_is_killed_nothing_older_than_ten_seconds_is_lost() {
        let root = ScratchFolder::made("hour");
        let mut window = window(&root);
        let mut random = 7_u64;
        let mut next = || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            random >> 33
        };
        let mut cuts: Vec<u64> = (0..50).map(|_| next() % 3600).collect();
        cuts.sort_unstable();
        let mut changes_s = Vec::new();
        for now_s in 1..3600_u64 {
            // Work in bouts: a change a second for a while, then none for a while.
            if (now_s / 37) % 2 == 0 {
                let gain_db = -(now_s as f64) * 1e-3;
                window.dispatch(Edit::MasterGain(gain_db));
                window.workbench.bench.engine.advance_ticks(1);
                window.workbench.bench.files.recovery.touch(now_s as f64);
                changes_s.push(now_s);
            }
            window.workbench.keep_unsaved_at(now_s as f64);
            assert_eq!(window.workbench.bench.files.recovery.failure(), None);
            if !cuts.contains(&now_s) || now_s < 10 {
                continue;
            }
            let copy = ScratchFolder::made("cut");
            let folder = fs::read_dir(&*root).unwrap().next().unwrap().unwrap();
            let left = copy.join("left");
            fs::create_dir(&left).unwrap();
            fs::copy(folder.path().join("work.json"), left.join("work.json")).unwrap();
            let parts = offered(&copy).unwrap();
            let document: Document = parts[0].unsaved.read().unwrap();
            let kept_s = -document.tuning().gain_db * 1e3;
            let oldest_lost_s = changes_s.iter().find(|&&s| s as f64 > kept_s + 0.5);
            if let Some(&lost_s) = oldest_lost_s {
                assert!(now_s - lost_s < 10, "at {now_s} s: kept to {kept_s} s");
            }
        }
    }
}
