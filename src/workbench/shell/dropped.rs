//! Files and folders that are dropped on the window: each goes where it belongs, told by what it
//! holds rather than by its name alone.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::{Context, Id, LayerId, Order, Stroke, StrokeKind};

use crate::bench::command::{FileCommand, Purpose, ShowCommand};
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::kit::foot;
use crate::kit::theme::Palette;
use crate::shell::window::Workbench;
use selvedge_foundation::files::{PICTURE_ENDINGS, read_text};

/// What can be dropped, for people.
const WHAT: &str = "a scene, a drape scene, a recording, a path file, a design, a folder of \
                    textiles or of logs, a picture, measurements";
/// Endings of pictures that are not decoded; the pane says so.
const OTHER_PICTURES: [&str; 2] = ["webp", "gif"];
/// A text that is longer is none of ours, bytes.
const MAX_TEXT: u64 = 4 << 20;

/// What a path is for; `None`: nobody here knows.
fn purpose_of(path: &Path) -> Option<Purpose> {
    if path.is_dir() {
        return purpose_of_folder(path);
    }
    let ending = path.extension().unwrap_or_default();
    let ending = ending.to_string_lossy().to_lowercase();
    match ending.as_str() {
        "toml" if is_of(path, ".drape.toml") => Some(Purpose::OpenDrape),
        "toml" => purpose_of_keys(path),
        "csv" if has_columns(&header(path), &["z_mm", "opening_mm"]) => Some(Purpose::OpenHands),
        "csv" if is_path(path) => Some(Purpose::OpenRecording),
        "md" | "pdf" | "json" | "zip" | "" => None,
        ending if PICTURE_ENDINGS.contains(&ending) || OTHER_PICTURES.contains(&ending) => {
            Some(Purpose::OpenPicture(Pane::Picture))
        }
        _ => Some(Purpose::ImportFiles),
    }
}

fn purpose_of_folder(folder: &Path) -> Option<Purpose> {
    if folder.join("recording.toml").is_file() {
        return Some(Purpose::OpenRecording);
    }
    let paths = fs::read_dir(folder).ok()?;
    let paths: Vec<PathBuf> = paths.flatten().map(|entry| entry.path()).collect();
    if paths.iter().any(|path| path.join("textile.toml").is_file()) {
        return Some(Purpose::AddLibrary);
    }
    // A session is a table with its sidecar.
    let is_session = |path: &PathBuf| {
        path.extension().is_some_and(|ending| ending == "csv")
            && path.with_extension("json").is_file()
    };
    paths.iter().any(is_session).then_some(Purpose::OpenLogs)
}

/// A scene has a size, a design an experiment.
fn purpose_of_keys(path: &Path) -> Option<Purpose> {
    let text = short_text(path)?;
    let has = |key: &str| {
        let mut lines = text.lines();
        lines.any(|line| {
            line.strip_prefix(key)
                .is_some_and(|rest| rest.trim_start().starts_with('='))
        })
    };
    if has("size_mm") {
        Some(Purpose::OpenScene)
    } else {
        has("experiment").then_some(Purpose::OpenDesign)
    }
}

/// Whether a path's name ends so.
fn is_of(path: &Path, ending: &str) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.to_lowercase().ends_with(ending)
}

/// Whether a table is a path of the display.
fn is_path(path: &Path) -> bool {
    let header = header(path);
    has_columns(&header, &["x_mm", "y_mm"]) && !header.iter().any(|name| name.starts_with('z'))
}

fn has_columns(header: &[String], names: &[&str]) -> bool {
    names
        .iter()
        .all(|name| header.iter().any(|own| own == name))
}

/// The names of a table's columns.
fn header(path: &Path) -> Vec<String> {
    let text = short_text(path).unwrap_or_default();
    let mut rows = text.lines().filter(|line| !line.starts_with('#'));
    let header = rows.next().unwrap_or_default().split(',');
    header.map(str::to_owned).collect()
}

fn short_text(path: &Path) -> Option<String> {
    let about = fs::metadata(path).ok()?;
    let is_short = about.is_file() && about.len() <= MAX_TEXT;
    is_short.then(|| read_text(path).ok()).flatten()
}

impl Workbench {
    /// Takes what was dropped on the window; while something hangs over it, says what can be.
    pub(crate) fn take_dropped(&mut self, ctx: &Context) {
        let is_over = ctx.input(|input| !input.raw.hovered_files.is_empty());
        if is_over {
            foot::tell(ctx, format!("Drop {WHAT}"));
            let layer = LayerId::new(Order::Foreground, Id::unique("dropped"));
            let edge = Stroke::new(2.0, Palette::of(ctx.theme()).selection);
            let whole = ctx.content_rect();
            ctx.layer_painter(layer)
                .rect_stroke(whole, 0, edge, StrokeKind::Inside);
        }
        let paths: Vec<PathBuf> = ctx.input_mut(|input| {
            let files = std::mem::take(&mut input.raw.dropped_files);
            files.iter().map(|file| file.path().to_owned()).collect()
        });
        self.take_paths(paths);
    }

    /// Takes what was dropped together: pictures are of one cloth, turned.
    fn take_paths(&mut self, paths: Vec<PathBuf>) {
        let mut is_open = false;
        for path in paths {
            let is_picture = purpose_of(&path) == Some(Purpose::OpenPicture(Pane::Picture));
            if is_picture && is_open && self.shell.shows(Pane::Picture) {
                self.dispatch(FileCommand::Use(Purpose::AddTurned, path).into());
            } else {
                self.take_path(path);
                is_open |= is_picture;
            }
        }
    }

    /// Takes a path where it belongs, and shows that.
    fn take_path(&mut self, path: PathBuf) {
        let purpose = match purpose_of(&path) {
            // A picture may be a map of heights, and measurements have any ending: the pane that
            // is looked at decides.
            None | Some(Purpose::OpenPicture(_))
                if path.is_file() && self.shell.shows(Pane::Import) =>
            {
                Some(Purpose::ImportFiles)
            }
            #[cfg(feature = "friction")]
            Some(Purpose::OpenPicture(_)) if self.shell.shows(Pane::Friction) => {
                Some(Purpose::OpenPicture(Pane::Friction))
            }
            purpose => purpose,
        };
        let Some(purpose) = purpose else {
            let words = format!("{}: nothing to open; drop {WHAT}", path.display());
            return self.bench.notices.give(words);
        };
        let there = match purpose {
            Purpose::OpenPicture(pane) => Some((Perspective::Cloth, pane)),
            Purpose::ImportFiles => Some((Perspective::Cloth, Pane::Import)),
            Purpose::OpenDrape | Purpose::OpenHands => Some((Perspective::Cloth, Pane::Drape)),
            Purpose::OpenDesign => Some((Perspective::Experiment, Pane::Builder)),
            Purpose::OpenLogs => Some((Perspective::Experiment, Pane::Analysis)),
            _ => None,
        };
        if let Some((perspective, pane)) = there.filter(|(_, pane)| !self.shell.shows(*pane)) {
            self.dispatch(ShowCommand::Perspective(perspective).into());
            self.dispatch(ShowCommand::Reveal(pane).into());
        }
        self.dispatch(FileCommand::Use(purpose, path).into());
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::bench::source_file::SourceFile;
    use crate::shell::headless::Headless;
    use crate::tools::picture::Picture;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_path_is_known_by_what_it_holds() {
        let root = ScratchFolder::made("dropped");
        let made = |name: &str, text: &str| {
            let path = root.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, text).unwrap();
            path
        };
        let scene = made("a.toml", "name = \"a\"\nsize_mm = [2.0, 2.0]\n");
        let design = made("b.toml", "study = \"s\"\nexperiment = \"e\"\n");
        let other = made("c.toml", "name = \"size_mm\"\n");
        let path = made("d.csv", "# a path\ntick,x_mm,y_mm,angle_deg\n0,1,1,0\n");
        let measured = made("e.csv", "x,z\n0,1\n");
        let text = made("f.md", "# words");
        made("library/silk/textile.toml", "");
        made("recording/recording.toml", "");
        made("logs/s_e_p01_1.csv", "");
        made("logs/s_e_p01_1.json", "{}");
        made("nothing/x.csv", "");
        for (path, expected) in [
            (scene, Some(Purpose::OpenScene)),
            (design, Some(Purpose::OpenDesign)),
            (other, None),
            (path, Some(Purpose::OpenRecording)),
            (measured, Some(Purpose::ImportFiles)),
            (made("g.PNG", ""), Some(Purpose::OpenPicture(Pane::Picture))),
            (text, None),
            (root.join("library"), Some(Purpose::AddLibrary)),
            (root.join("recording"), Some(Purpose::OpenRecording)),
            (root.join("logs"), Some(Purpose::OpenLogs)),
            (root.join("nothing"), None),
            (root.join("not there"), None),
        ] {
            assert_eq!(purpose_of(&path), expected, "{}", path.display());
        }
    }

    #[test]
    fn what_is_dropped_is_opened_and_what_nobody_knows_is_said() {
        let root = ScratchFolder::made("dropped-on");
        let mut window = Headless::shipped();
        window.pass(2);
        let scene = root.join("two.scene.toml");
        fs::write(&scene, "name = \"Two\"\nsize_mm = [99.0, 99.0]\n").unwrap();
        window.workbench.take_path(scene);
        for _ in 0..200 {
            window.pass(1);
            std::thread::sleep(std::time::Duration::from_millis(2));
            if window.workbench.bench.document.scene().name == "Two" {
                break;
            }
        }
        assert_eq!(window.workbench.bench.document.scene().name, "Two");
        let before = window.workbench.bench.notices.shown().len();
        window.workbench.take_path(root.join("readme.md"));
        let notices = window.workbench.bench.notices.shown();
        assert_eq!(notices.len(), before + 1);
        assert!(
            notices[before]
                .text
                .contains("readme.md: nothing to open; drop a scene")
        );
    }

    #[test]
    fn pictures_that_are_dropped_together_are_of_one_cloth() {
        let root = ScratchFolder::made("dropped-pictures");
        let mut window = Headless::shipped();
        window.pass(2);
        let pictures = ["a.png", "b.png"].map(|name| root.join(name));
        for path in &pictures {
            fs::write(path, "no picture").unwrap();
        }
        window.workbench.take_paths(pictures.to_vec());
        window.pass(2);
        let picture = window.workbench.tools.get::<Picture>().unwrap();
        let name = |file: &SourceFile| file.name();
        assert_eq!(picture.draft.source.as_ref().map(name).unwrap(), "a.png");
        let turned: Vec<String> = picture.draft.turned.iter().map(name).collect();
        assert_eq!(turned, ["b.png"]);
    }

    #[test]
    fn a_design_brings_the_window_to_where_it_is_worked_on() {
        let root = ScratchFolder::made("dropped-design");
        let mut window = Headless::shipped();
        window.pass(2);
        let design = root.join("mine.toml");
        fs::write(&design, include_str!("../../../assets/designs/jnd-40.toml")).unwrap();
        window.workbench.take_path(design);
        window.pass(3);
        let preferences = &window.workbench.bench.settings.preferences;
        assert_eq!(preferences.perspective, Perspective::Experiment);
        assert!(window.workbench.shell.shows(Pane::Builder));
        assert!(
            preferences
                .folders
                .design
                .as_deref()
                .is_some_and(|design| design.ends_with("mine.toml"))
        );
    }
}
