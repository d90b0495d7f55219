//! The desktop's own file dialogs, where there are any.
//!
//! A dialog runs on a thread of its own until the user has answered it, however long that takes.
//! Where no dialog appears, the answer says so and the window asks with a field of its own:
//! without a session bus at once, otherwise as soon as that is known. Nothing here opens or
//! writes the file that is chosen.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::time::{Duration, Instant};
use std::{env, thread};

use eframe::egui;

use crate::bench::clips::ending;
use crate::bench::command::Purpose;
use crate::shell::ask::AskWords;
use selvedge_foundation::files::PICTURE_ENDINGS;

/// Set to `field`, this variable of the environment turns the desktop's dialogs off.
const SWITCH: &str = "SELVEDGE_DIALOGS";
/// How the names of measurements end.
const MEASUREMENTS: [&str; 17] = [
    "txt", "csv", "dat", "asc", "prn", "x3p", "sur", "pro", "gwy", "gsf", "npy", "png", "tif",
    "tiff", "tmd", "frt", "hfm",
];
/// Nobody sees a dialog and puts it away in less time.
const GLANCE: Duration = Duration::from_millis(400);
/// Whoever asks again after this time does not see the dialog that was asked for first.
const UNSEEN: Duration = Duration::from_secs(2);

/// What became of a dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Answer {
    /// This path was chosen for this purpose.
    Path(Purpose, PathBuf),
    /// The user put the dialog away.
    Cancelled,
    /// There is no dialog: ask with a field.
    NoPortal(Purpose),
}

/// The desktop's dialogs; at most one is open. By default there are none, and the field asks for
/// everything.
#[derive(Debug, Default)]
pub(crate) struct Dialogs {
    has_desktop: bool,
    open: Option<Open>,
    /// An answer that is there before anybody was asked.
    ready: Option<Answer>,
}

/// A dialog that is open, or is to be.
#[derive(Debug)]
struct Open {
    purpose: Purpose,
    since: Instant,
    /// Whether a file of several was chosen already.
    is_begun: bool,
    /// Whether another window has had the focus since: somebody saw it.
    was_seen: bool,
    choice: Receiver<Option<PathBuf>>,
    ctx: egui::Context,
}

impl Dialogs {
    /// The dialogs of this desktop, as far as the environment tells.
    pub(crate) fn of_desktop() -> Self {
        let has_socket = |path: &Path| path.exists();
        Self {
            has_desktop: has_desktop(|name| env::var_os(name), has_socket),
            ..Self::default()
        }
    }

    /// Asks for a path, beginning at `start`; `ctx` is woken when there is an answer.
    pub(crate) fn ask(&mut self, purpose: Purpose, start: Option<&Path>, ctx: &egui::Context) {
        let unanswered = self.open.take();
        let is_again = unanswered.is_some();
        if let Some(open) = unanswered.filter(|open| open.since.elapsed() < UNSEEN) {
            // The key was pressed twice.
            self.open = Some(open);
            return;
        }
        if self.has_desktop && !is_again {
            self.open = Open::start(purpose, start, ctx);
        }
        if self.open.is_none() {
            self.ready = Some(Answer::NoPortal(purpose));
            ctx.request_repaint();
        }
    }

    /// The answer, once it is there. To be called every frame.
    pub(crate) fn poll(&mut self) -> Option<Answer> {
        if let Some(answer) = self.ready.take() {
            return Some(answer);
        }
        let open = self.open.as_mut()?;
        open.was_seen |= !open.ctx.input(|input| input.focused);
        let choice = match open.choice.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Ok(Some(path)) if open.purpose == Purpose::ImportFiles => {
                // More may follow: they are asked for in the next frame.
                open.is_begun = true;
                open.ctx.request_repaint();
                return Some(Answer::Path(open.purpose, path));
            }
            Ok(choice) => choice,
            Err(TryRecvError::Disconnected) if open.is_begun => {
                self.open = None;
                return None;
            }
            Err(TryRecvError::Disconnected) => None,
        };
        let answer = open.answer(choice);
        self.open = None;
        Some(answer)
    }
}

impl Open {
    /// Opens a dialog on a thread of its own; `None` when there can be no thread.
    fn start(purpose: Purpose, start: Option<&Path>, ctx: &egui::Context) -> Option<Self> {
        let dialog = dialog(purpose, start);
        let (sender, choice) = sync_channel(1);
        let waker = ctx.clone();
        let ask = move || {
            let chosen: Vec<Option<PathBuf>> = if is_save(purpose) {
                vec![dialog.save_file().map(|path| with_ending(purpose, path))]
            } else if purpose == Purpose::ImportFiles {
                let files = dialog.pick_files();
                files.map_or_else(|| vec![None], |files| files.into_iter().map(Some).collect())
            } else if is_folder(purpose) {
                vec![dialog.pick_folder()]
            } else {
                vec![dialog.pick_file()]
            };
            for path in chosen {
                waker.request_repaint();
                // Nobody waits any more when the field was shown instead.
                if sender.send(path).is_err() {
                    return;
                }
            }
            drop(sender);
            waker.request_repaint();
        };
        let job = thread::Builder::new().name("selvedge-dialog".to_owned());
        job.spawn(ask).ok()?;
        Some(Self {
            purpose,
            since: Instant::now(),
            is_begun: false,
            was_seen: false,
            choice,
            ctx: ctx.clone(),
        })
    }

    /// What a choice means: none is a refusal only if somebody saw the dialog.
    fn answer(&self, choice: Option<PathBuf>) -> Answer {
        match choice {
            Some(path) => Answer::Path(self.purpose, path),
            None if self.was_seen && self.since.elapsed() >= GLANCE => Answer::Cancelled,
            None => Answer::NoPortal(self.purpose),
        }
    }
}

/// Whether there may be dialogs: not without a session bus, which the portal is reached by.
fn has_desktop(
    variable: impl Fn(&str) -> Option<OsString>,
    exists: impl Fn(&Path) -> bool,
) -> bool {
    if variable(SWITCH).is_some_and(|word| word == "field") {
        return false;
    }
    if cfg!(any(target_os = "macos", target_os = "windows")) {
        return true;
    }
    let is_named = variable("DBUS_SESSION_BUS_ADDRESS").is_some_and(|name| !name.is_empty());
    let folder = variable("XDG_RUNTIME_DIR").map(PathBuf::from);
    is_named || folder.is_some_and(|folder| folder.is_absolute() && exists(&folder.join("bus")))
}

fn is_save(purpose: Purpose) -> bool {
    matches!(
        purpose,
        Purpose::SaveScene
            | Purpose::SaveRecording
            | Purpose::SaveDesign
            | Purpose::Export(_)
            | Purpose::Clip(_)
    )
}

/// A dialog for folders that begins at the nearest one that is there.
fn in_folder(dialog: rfd::FileDialog, start: Option<&Path>) -> rfd::FileDialog {
    let start = start.and_then(|path| std::path::absolute(path).ok());
    let mut folders = start.iter().flat_map(|path| path.ancestors());
    match folders.find(|folder| folder.is_dir()) {
        Some(folder) => dialog.set_directory(folder),
        None => dialog,
    }
}

fn is_folder(purpose: Purpose) -> bool {
    matches!(
        purpose,
        Purpose::OpenLogs | Purpose::WriteReport | Purpose::AddLibrary
    )
}

/// The dialog for a purpose, in the folder of `start` and, when it saves, with its name.
fn dialog(purpose: Purpose, start: Option<&Path>) -> rfd::FileDialog {
    let words = AskWords::of(purpose);
    let dialog = rfd::FileDialog::new().set_title(words.title);
    let dialog = match purpose {
        Purpose::OpenScene | Purpose::SaveScene => {
            dialog.add_filter("Scenes", &["scene.toml", "toml"])
        }
        Purpose::OpenRecording | Purpose::SaveRecording => {
            dialog.add_filter("Recordings", &["csv"])
        }
        Purpose::Export(_) => dialog
            .add_filter("Pictures", &["png"])
            .add_filter("Drawings", &["svg"])
            .add_filter("Tables", &["csv"]),
        Purpose::Clip(kind) => dialog.add_filter(words.title, &[ending(kind)]),
        Purpose::OpenDrape => dialog.add_filter("Hanging cloths", &["drape.toml", "toml"]),
        Purpose::OpenHands | Purpose::SaveHands => dialog.add_filter("Hands", &["csv"]),
        Purpose::ImportFiles => dialog.add_filter("Measurements", &MEASUREMENTS),
        Purpose::OpenPicture(_) | Purpose::AddTurned => {
            dialog.add_filter("Pictures", &PICTURE_ENDINGS)
        }
        Purpose::OpenDesign | Purpose::SaveDesign => dialog.add_filter("Designs", &["toml"]),
        Purpose::OpenLogs | Purpose::WriteReport | Purpose::AddLibrary => {
            return in_folder(dialog, start);
        }
    };
    let dialog = dialog.add_filter("All files", &["*"]);
    let start = start.and_then(|path| std::path::absolute(path).ok());
    let dialog = match start.as_deref().and_then(Path::parent) {
        Some(folder) => dialog.set_directory(folder),
        None => dialog,
    };
    if !is_save(purpose) {
        return dialog;
    }
    let name = start.as_deref().and_then(Path::file_name);
    dialog.set_file_name(name.map_or_else(
        || words.name.to_owned(),
        |name| name.to_string_lossy().into_owned(),
    ))
}

/// A path to save at with the usual ending, where none was typed and the longer name is free: the
/// desktop has asked only about the name that was typed.
fn with_ending(purpose: Purpose, path: PathBuf) -> PathBuf {
    let (None, Some(name)) = (path.extension(), path.file_name()) else {
        return path;
    };
    let mut name = name.to_owned();
    name.push(match purpose {
        Purpose::Clip(_) => AskWords::of(purpose).ending,
        Purpose::OpenScene | Purpose::SaveScene => ".scene.toml",
        Purpose::OpenRecording | Purpose::SaveRecording | Purpose::SaveHands => ".csv",
        Purpose::SaveDesign => ".toml",
        Purpose::Export(_) => ".png",
        Purpose::ImportFiles
        | Purpose::OpenPicture(_)
        | Purpose::AddTurned
        | Purpose::OpenDrape
        | Purpose::OpenHands
        | Purpose::AddLibrary
        | Purpose::OpenDesign
        | Purpose::OpenLogs
        | Purpose::WriteReport => return path,
    });
    let longer = path.with_file_name(name);
    if longer.exists() { path } else { longer }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(choice: Option<PathBuf>) -> Open {
        let (sender, receiver) = sync_channel(1);
        sender.send(choice).unwrap();
        Open {
            purpose: Purpose::OpenScene,
            since: Instant::now(),
            is_begun: false,
            was_seen: false,
            choice: receiver,
            ctx: egui::Context::default(),
        }
    }

    fn variables(name: &str, value: &str) -> impl Fn(&str) -> Option<OsString> {
        let (name, value) = (name.to_owned(), value.to_owned());
        move |asked| (asked == name).then(|| value.clone().into())
    }

    #[test]
    fn without_a_bus_the_field_asks_at_once() {
        let mut dialogs = Dialogs::default();
        dialogs.ask(Purpose::SaveScene, None, &egui::Context::default());
        assert_eq!(dialogs.poll(), Some(Answer::NoPortal(Purpose::SaveScene)));
        assert_eq!(dialogs.poll(), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_desktop_is_where_a_session_bus_is() {
        let no_file = |_: &Path| false;
        let bus = |path: &Path| path == Path::new("/run/user/1/bus");
        assert!(!has_desktop(|_| None, bus), "nothing is known");
        let named = variables("DBUS_SESSION_BUS_ADDRESS", "unix:path=/bus");
        assert!(has_desktop(named, no_file));
        assert!(!has_desktop(
            variables("DBUS_SESSION_BUS_ADDRESS", ""),
            no_file
        ));
        assert!(has_desktop(
            variables("XDG_RUNTIME_DIR", "/run/user/1"),
            bus
        ));
        assert!(!has_desktop(
            variables("XDG_RUNTIME_DIR", "/run/user/2"),
            bus
        ));
    }

    #[test]
    fn the_environment_turns_dialogs_off() {
        let both = |name: &str| match name {
            SWITCH => Some("field".into()),
            _ => Some("unix:path=/bus".into()),
        };
        assert!(!has_desktop(both, |_| true));
    }

    #[test]
    fn a_dialog_that_nobody_can_have_seen_was_not_cancelled() {
        let mut dialogs = Dialogs {
            open: Some(open(None)),
            ..Dialogs::default()
        };
        assert_eq!(dialogs.poll(), Some(Answer::NoPortal(Purpose::OpenScene)));
        let seen = Open {
            was_seen: true,
            since: Instant::now().checked_sub(GLANCE).unwrap(),
            ..open(None)
        };
        assert_eq!(seen.answer(None), Answer::Cancelled);
        let unseen = Open {
            was_seen: false,
            ..seen
        };
        assert_eq!(unseen.answer(None), Answer::NoPortal(Purpose::OpenScene));
    }

    #[test]
    fn a_choice_is_answered_once() {
        let path = PathBuf::from("/a.scene.toml");
        let mut dialogs = Dialogs {
            open: Some(open(Some(path.clone()))),
            ..Dialogs::default()
        };
        let answer = Answer::Path(Purpose::OpenScene, path);
        assert_eq!(dialogs.poll(), Some(answer));
        assert_eq!(dialogs.poll(), None);
    }

    #[test]
    fn several_files_are_answered_one_after_the_other() {
        let (sender, choice) = sync_channel(2);
        let paths = ["/a.txt", "/b.txt"].map(PathBuf::from);
        for path in &paths {
            sender.send(Some(path.clone())).unwrap();
        }
        drop(sender);
        let mut dialogs = Dialogs {
            open: Some(Open {
                purpose: Purpose::ImportFiles,
                choice,
                ..open(None)
            }),
            ..Dialogs::default()
        };
        for path in paths {
            let answer = Answer::Path(Purpose::ImportFiles, path);
            assert_eq!(dialogs.poll(), Some(answer));
        }
        assert_eq!(dialogs.poll(), None);
        assert!(dialogs.open.is_none(), "it is closed");
    }

    #[test]
    fn asking_twice_opens_one_dialog_and_asking_later_the_field() {
        let ctx = egui::Context::default();
        let (_sender, choice) = sync_channel(1);
        let mut dialogs = Dialogs {
            has_desktop: true,
            open: Some(Open {
                choice,
                ..open(None)
            }),
            ready: None,
        };
        dialogs.ask(Purpose::OpenScene, None, &ctx);
        assert_eq!(dialogs.poll(), None, "the first is still open");
        if let Some(open) = &mut dialogs.open {
            open.since = Instant::now().checked_sub(UNSEEN).unwrap();
        }
        dialogs.ask(Purpose::SaveScene, None, &ctx);
        assert_eq!(dialogs.poll(), Some(Answer::NoPortal(Purpose::SaveScene)));
        assert_eq!(dialogs.poll(), None, "the first is forgotten");
    }

    #[test]
    fn a_name_without_an_ending_gets_the_usual_one() {
        let ended = |purpose, path: &str| with_ending(purpose, PathBuf::from(path));
        let scene = Path::new("/nowhere/silk.scene.toml");
        assert_eq!(ended(Purpose::SaveScene, "/nowhere/silk"), scene);
        assert_eq!(
            ended(Purpose::SaveRecording, "/nowhere/a"),
            Path::new("/nowhere/a.csv")
        );
        assert_eq!(
            ended(Purpose::SaveScene, "/nowhere/a.toml"),
            Path::new("/nowhere/a.toml")
        );
    }
}
