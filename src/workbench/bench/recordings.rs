//! What can be done with recordings: made, chosen, named, deleted and had back, set against each
//! other.
//!
//! A recording that is deleted is moved aside; nothing here ever writes over one.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::bench::Bench;
use crate::bench::background::{Executor, finished};
use crate::bench::command::edit::Edit;
use crate::bench::command::{FileCommand, Purpose, RecordingCommand, ShowCommand};
use crate::bench::notices::Until;
use crate::bench::pane::Pane;
use crate::bench::recording::file::read;
use crate::bench::recording::list::Then;
use crate::bench::recording::running::{Running, Standing};
use crate::bench::recording::{About, Place, Recording};
use selvedge_foundation::files::FileError;
use selvedge_render::scene::{ExplorationPath, RecordingReference};

/// Where deleted ones wait, in the folder of recordings.
const DELETED: &str = "deleted";
/// How long the end of a recording is waited for, from look to look.
const LOOK: Duration = Duration::from_millis(20);
/// How often is looked: two seconds.
const N_LOOKS: u32 = 100;

impl Bench {
    /// Begins or ends a recording.
    pub(crate) fn toggle_recording(&mut self) {
        if self.live.play.is_recording {
            return self.send(selvedge_engine::Command::StopRecording);
        }
        if self.live.is_cloth {
            // What is recorded is felt on the scene.
            self.feel_cloth(None);
        }
        let about = self.new_page();
        match self.engine.record() {
            Ok(recording) => {
                let recordings = &mut self.exploration.recordings;
                let root = recordings.root.clone();
                let next = Running::start(&self.executor, recording, about, root);
                recordings.running = Some(next);
            }
            Err(error) => self.notices.give(error.to_string()),
        }
    }

    /// Takes what threads have to say of recordings. Once a frame.
    pub(crate) fn poll_recordings(&mut self) {
        self.poll_running();
        let recordings = &mut self.exploration.recordings;
        if let Some((task, then)) = recordings.loading.take() {
            let mut task = Some(task);
            match finished(&mut task) {
                Some(Ok(recording)) => self.take_up(recording, then),
                Some(Err(line)) => self.notices.give(line),
                None => self.exploration.recordings.loading = task.map(|task| (task, then)),
            }
        }
        let recordings = &mut self.exploration.recordings;
        match finished(&mut recordings.comparing) {
            Some(Ok(two)) => {
                recordings.compared = Some(two);
                self.commands
                    .push(ShowCommand::Reveal(Pane::Compare).into());
            }
            Some(Err(line)) => self.notices.give(line),
            None => {}
        }
        let (scene, path) = (self.document.scene(), self.document.path());
        let recordings = &mut self.exploration.recordings;
        recordings.follow(scene, path.map(PathBuf::as_path), &self.executor);
    }

    fn poll_running(&mut self) {
        let recordings = &mut self.exploration.recordings;
        let Some(running) = &mut recordings.running else {
            return;
        };
        if let Some(line) = running.failure() {
            self.notices.give(line);
        }
        let Standing::Over(kept) = running.poll() else {
            return;
        };
        recordings.running = None;
        recordings.relist();
        if let Some(recording) = kept {
            if recording.folder.is_none() {
                recordings.in_memory.push((*recording).clone());
            }
            self.exploration.at_hand = Some(*recording);
        }
    }

    /// Ends the recording that is being made and waits for its file: the window closes.
    pub(crate) fn end_recording(&mut self) {
        self.send(selvedge_engine::Command::StopRecording);
        for _ in 0..N_LOOKS {
            // This hands the thread the end of it.
            self.engine.snapshot();
            let running = self.exploration.recordings.running.as_mut();
            if running.is_none_or(|running| matches!(running.poll(), Standing::Over(_))) {
                return;
            }
            std::thread::sleep(LOOK);
        }
    }

    fn take_up(&mut self, recording: Recording, then: Then) {
        self.exploration.at_hand = Some(recording);
        match then {
            Then::Replay => self.replay(),
            Then::Export => {
                let ask = FileCommand::Ask(Purpose::SaveRecording);
                self.commands.push(ask.into());
            }
        }
    }

    /// Opens a path file: it is replayed next, and listed.
    pub(crate) fn open_recording(&mut self, path: PathBuf) {
        let opened = &mut self.exploration.recordings.opened;
        if !opened.contains(&path) {
            opened.push(path.clone());
        }
        self.load(&Place::PathFile(path), Then::Replay);
    }

    fn load(&mut self, place: &Place, then: Then) {
        let recordings = &mut self.exploration.recordings;
        match reading(place, &recordings.in_memory) {
            Ok(work) => {
                let task = self.executor.start("selvedge-recording", move |_| work());
                recordings.loading = Some((task, then));
                if matches!(self.executor, Executor::InLine) {
                    self.poll_recordings();
                }
            }
            Err(line) => self.notices.give(line),
        }
    }

    /// Does something with a recording of the list.
    pub(crate) fn dispatch_recording(&mut self, command: RecordingCommand) {
        match command {
            RecordingCommand::Choose(place) => self.load(&place, Then::Replay),
            RecordingCommand::Export(place) => self.load(&place, Then::Export),
            RecordingCommand::Rename(place, name) => self.rename_recording(&place, name.trim()),
            RecordingCommand::Delete(place) => self.delete_recording(&place),
            RecordingCommand::BringBack => self.bring_recording_back(),
            RecordingCommand::Refer(place) => {
                if let Some(path) = place.path() {
                    let reference = RecordingReference {
                        name: self.name_at(&place),
                        path: path.to_owned(),
                    };
                    self.commands.push(Edit::Recording(reference).into());
                }
            }
            RecordingCommand::Compare(two) => self.compare_recordings(&two),
            command => self.dispatch_within(command),
        }
    }

    fn name_at(&self, place: &Place) -> String {
        let entries = &mut self.exploration.recordings.entries().iter();
        let entry = entries.find(|entry| entry.place == *place);
        entry.map_or_else(String::new, |entry| entry.about.name.clone())
    }

    fn rename_recording(&mut self, place: &Place, name: &str) {
        let Place::Folder(folder) = place else {
            let words = "Only recordings in the list’s own folder can be renamed";
            return self.notices.give(words);
        };
        if name.is_empty() {
            return;
        }
        let renamed = About::read(folder).and_then(|mut about| {
            name.clone_into(&mut about.name);
            about.write(folder)
        });
        if let Err(error) = renamed {
            return self.notices.give(error.to_string());
        }
        let is_it = |one: &&mut Recording| one.folder.as_ref() == Some(folder);
        if let Some(at_hand) = self.exploration.at_hand.as_mut().filter(is_it) {
            *at_hand = at_hand.clone().renamed(name);
        }
        self.exploration.recordings.relist();
    }

    fn delete_recording(&mut self, place: &Place) {
        let name = self.name_at(place);
        let recordings = &mut self.exploration.recordings;
        match place {
            Place::Folder(folder) => {
                let moved = moved_aside(folder);
                match moved {
                    Ok(aside) => recordings.deleted.push((name, [folder.clone(), aside])),
                    Err(error) => return self.notices.give(error.to_string()),
                }
            }
            Place::PathFile(path) => recordings.opened.retain(|opened| opened != path),
            Place::Busy(_) => {
                let words = "It is being recorded: end it first";
                return self.notices.give_until(Until::Recorded, words);
            }
            Place::Missing(_) | Place::Memory(_) => return,
        }
        recordings.relist();
    }

    fn bring_recording_back(&mut self) {
        let recordings = &mut self.exploration.recordings;
        if let Some((_, [folder, aside])) = recordings.deleted.pop() {
            if let Err(error) = fs::rename(&aside, &folder) {
                let error = FileError::write(&folder)(error);
                return self.notices.give(error.to_string());
            }
            recordings.relist();
        }
    }

    fn compare_recordings(&mut self, two: &[Place; 2]) {
        let recordings = &mut self.exploration.recordings;
        let [one, other] = [0, 1].map(|side| reading(&two[side], &recordings.in_memory));
        match (one, other) {
            (Ok(one), Ok(other)) => {
                let work = move || Ok([one()?, other()?]);
                let task = self.executor.start("selvedge-recording", |_| work());
                recordings.comparing = Some(task);
            }
            (Err(line), _) | (_, Err(line)) => self.notices.give(line),
        }
    }
}

/// How a recording is read, or why it cannot be.
fn reading(
    place: &Place,
    in_memory: &[Recording],
) -> Result<Box<dyn FnOnce() -> Result<Recording, String> + Send>, String> {
    match place.clone() {
        Place::Folder(folder) => Ok(Box::new(move || read(&folder))),
        Place::PathFile(path) => Ok(Box::new(move || {
            let found = ExplorationPath::read(&path).map_err(|error| error.to_string())?;
            Ok(Recording::from_path(path, found))
        })),
        Place::Memory(nth) => match in_memory.get(nth).cloned() {
            Some(recording) => Ok(Box::new(move || Ok(recording))),
            None => Err("This recording is gone; record it again".to_owned()),
        },
        Place::Busy(_) => Err("It is being recorded: end it first".to_owned()),
        Place::Missing(path) => Err(format!(
            "{}: there is no such recording; put it back, or let the scene forget it",
            path.display()
        )),
    }
}

/// Moves a recording's folder to where deleted ones wait.
fn moved_aside(folder: &Path) -> Result<PathBuf, FileError> {
    let root = folder.parent().unwrap_or(folder).join(DELETED);
    fs::create_dir_all(&root).map_err(FileError::write(&root))?;
    let name = folder.file_name().unwrap_or_default();
    let aside = root.join(name);
    fs::rename(folder, &aside).map_err(FileError::write(folder))?;
    Ok(aside)
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::bench::command::{Command, PlayCommand};
    use crate::bench::recording::Recordings;
    use crate::bench::recording::file::RecordingFile;
    use crate::bench::recording::file::count;
    use crate::bench::recording::list::list;
    use crate::bench::recording::tests::{explored, page};
    use crate::shell::headless::Headless;
    use selvedge_render::scene::Scene;
    use selvedge_scratch::ScratchFolder;

    /// A window whose recordings lie in a folder, exploring by itself.
    fn window(root: &Path) -> Headless {
        let mut window = Headless::shipped();
        let recordings = &mut window.workbench.bench.exploration.recordings;
        *recordings = Recordings::in_folder(root.to_owned());
        window.dispatch(PlayCommand::Toggle);
        window.pass(2);
        window
    }

    fn record(window: &mut Headless, n_ticks: u32) {
        window.dispatch(PlayCommand::ToggleRecording);
        window.pass_ticks(n_ticks);
        window.dispatch(PlayCommand::ToggleRecording);
        window.pass(3);
    }

    fn names(window: &Headless) -> Vec<String> {
        let entries = window.workbench.bench.exploration.recordings.entries();
        entries
            .iter()
            .map(|entry| entry.about.name.clone())
            .collect()
    }

    fn place(window: &Headless, name: &str) -> Place {
        let mut entries = window
            .workbench
            .bench
            .exploration
            .recordings
            .entries()
            .iter();
        let entry = entries.find(|entry| entry.about.name == name);
        entry.unwrap().place.clone()
    }

    fn at_hand(window: &Headless) -> &Recording {
        window.workbench.bench.exploration.at_hand.as_ref().unwrap()
    }

    #[test]
    fn starting_another_recording_replaces_none_and_all_are_there_at_the_next_start() {
        let root = ScratchFolder::made("list");
        let mut first = window(&root);
        record(&mut first, 40);
        record(&mut first, 60);
        let mut both = names(&first);
        both.sort();
        assert_eq!(both, ["Recording 1", "Recording 2"]);
        assert_eq!(at_hand(&first).path().n_ticks(), 60);
        drop(first);
        let mut second = window(&root);
        assert_eq!(names(&second).len(), 2);
        let one = place(&second, "Recording 1");
        second.dispatch(RecordingCommand::Choose(one));
        second.pass(2);
        assert_eq!(at_hand(&second).path().n_ticks(), 40);
        assert_eq!(
            second.workbench.replayed_tick(),
            Some(0),
            "it waits at its first tick"
        );
        second.dispatch(PlayCommand::Toggle);
        second.pass(2);
        record(&mut second, 20);
        assert!(names(&second).contains(&"Recording 3".to_owned()));
    }

    #[test]
    fn a_recording_is_on_disk_while_it_is_made() {
        let root = ScratchFolder::made("during");
        let mut window = window(&root);
        window.dispatch(PlayCommand::ToggleRecording);
        window.pass_ticks(60);
        let folders: Vec<_> = fs::read_dir(&*root).unwrap().flatten().collect();
        let [folder] = &folders[..] else {
            panic!("one folder")
        };
        let [n_ticks, _] = count(&folder.path()).unwrap().0;
        assert!(
            n_ticks >= 40,
            "{n_ticks} ticks: no more than half a second is missing"
        );
        let seen_by_another = list(Some(&root), &[]);
        assert!(matches!(seen_by_another[0].place, Place::Busy(_)));
    }

    #[test]
    fn a_recording_that_was_broken_off_is_listed_and_replayed() {
        let root = ScratchFolder::made("broken");
        let made = explored(30);
        let mut file =
            RecordingFile::create(&root, page("Half"), [0, made.n_contactors()]).unwrap();
        file.append(&made, 0).unwrap();
        drop(file);
        let mut window = window(&root);
        assert_eq!(names(&window), ["Half"]);
        let half = place(&window, "Half");
        window.dispatch(RecordingCommand::Choose(half));
        window.pass(2);
        assert_eq!(at_hand(&window).path().n_ticks(), 30);
    }

    #[test]
    fn a_recording_is_renamed_deleted_and_brought_back() {
        let root = ScratchFolder::made("acts");
        let mut window = window(&root);
        record(&mut window, 20);
        let one = place(&window, "Recording 1");
        window.dispatch(RecordingCommand::Rename(
            one.clone(),
            " Silk, slowly ".to_owned(),
        ));
        window.pass(2);
        assert_eq!(names(&window), ["Silk, slowly"]);
        assert_eq!(at_hand(&window).name(), "Silk, slowly");
        window.dispatch(RecordingCommand::Delete(one));
        window.pass(2);
        assert!(names(&window).is_empty());
        window.dispatch(RecordingCommand::BringBack);
        window.pass(2);
        assert_eq!(names(&window), ["Silk, slowly"]);
    }

    #[test]
    fn two_recordings_are_set_against_each_other_as_they_were() {
        let root = ScratchFolder::made("compare");
        let mut window = window(&root);
        record(&mut window, 40);
        record(&mut window, 60);
        let two = ["Recording 1", "Recording 2"].map(|name| place(&window, name));
        let same = [two[0].clone(), two[0].clone()];
        window.dispatch(RecordingCommand::Compare(Box::new(two)));
        window.pass(4);
        let found = window.workbench.comparison().unwrap();
        assert_eq!(found.n_ticks, 40, "as long as both last");
        assert!(found.in_all[1].largest.unwrap().difference_db.abs() > 0.1);
        window.dispatch(RecordingCommand::Compare(Box::new(same)));
        window.pass(4);
        let found = window.workbench.comparison().unwrap();
        assert_eq!(found.in_all[1].largest.unwrap().difference_db, 0.0);
    }

    #[test]
    fn a_scene_keeps_its_references_and_says_what_is_missing() {
        let root = ScratchFolder::made("refer");
        let mut window = window(&root.join("recordings"));
        record(&mut window, 20);
        let one = place(&window, "Recording 1");
        window.dispatch(RecordingCommand::Refer(one.clone()));
        assert_eq!(window.workbench.scene().recordings.len(), 1);
        window.dispatch(Command::Undo);
        assert!(
            window.workbench.scene().recordings.is_empty(),
            "it is a step"
        );
        window.dispatch(RecordingCommand::Refer(one));
        let gone = RecordingReference {
            name: "Gone".to_owned(),
            path: root.join("gone.csv"),
        };
        window.dispatch(Edit::Recording(gone.clone()));
        window.pass(2);
        assert_eq!(
            place(&window, "gone"),
            Place::Missing(root.join("gone.csv"))
        );
        let scene = root.join("a.scene.toml");
        window.dispatch(FileCommand::Use(Purpose::SaveScene, scene.clone()));
        let read = Scene::read(&scene).unwrap();
        assert_eq!(read.recordings, window.workbench.scene().recordings);
        assert_eq!(read.recordings[1], gone, "nothing is lost");
    }

    #[test]
    fn without_a_disk_recordings_stay_in_memory_and_none_is_replaced() {
        let root = ScratchFolder::made("full");
        let file = root.join("file");
        fs::write(&file, "").unwrap();
        let mut window = window(&file);
        record(&mut window, 20);
        record(&mut window, 30);
        assert_eq!(names(&window), ["Recording 2", "Recording 1"]);
        let told = window.workbench.notices().join("\n");
        assert!(told.contains("goes on in memory"), "{told}");
        let one = place(&window, "Recording 1");
        window.dispatch(RecordingCommand::Choose(one));
        window.pass(1);
        assert_eq!(at_hand(&window).path().n_ticks(), 20);
    }

    #[test]
    fn everything_off_is_no_reason_not_to_record_and_it_says_what_was_only_shown() {
        let root = ScratchFolder::made("shown");
        let mut window = window(&root);
        window.dispatch(Command::AllOff);
        window.pass(2);
        window.dispatch(PlayCommand::Toggle);
        record(&mut window, 20);
        let entries = window.workbench.bench.exploration.recordings.entries();
        let [n_ticks, n_felt] = entries[0].about.ticks.unwrap();
        assert!(n_ticks > 0 && n_felt == 0, "{n_felt} of {n_ticks}");
    }
}
