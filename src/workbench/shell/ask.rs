//! The field that asks for a path where the desktop has no dialog: what to open, where to save.
//!
//! Tab completes what is typed; the scenes that were opened last are a click away.

use std::path::PathBuf;

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::{TextEditOutput, TextEditState};
use eframe::egui::{
    self, Align, EventFilter, FocusDirection, Id, Key, Layout, Margin, Modifiers, Rect, RichText,
    ScrollArea, TextEdit, Ui, vec2,
};

use crate::bench::background::{Executor, Task, finished};
use crate::bench::command::{Command, Commands, FileCommand, Purpose};
use crate::bench::pane::Pane;
use crate::kit::theme;
use crate::kit::theme::{ROW, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::card::{DROP as CARD_DROP, MARGIN as CARD_MARGIN};
use crate::kit::widgets::text::{button, choice, quiet, section};
use crate::shell::completion::complete;
use selvedge_engine::ClipKind;

/// What is said when a path is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AskWords {
    /// What is asked.
    pub title: &'static str,
    /// What the button does.
    pub(crate) verb: &'static str,
    /// How an answer looks.
    pub hint: &'static str,
    /// What to do when there is no answer yet.
    pub missing: &'static str,
    /// What a file is called that has no name yet.
    pub name: &'static str,
    /// How the names of such files end.
    pub ending: &'static str,
}

impl AskWords {
    fn new(
        [title, verb]: [&'static str; 2],
        missing: &'static str,
        [hint, name, ending]: [&'static str; 3],
    ) -> Self {
        Self {
            title,
            verb,
            hint,
            missing,
            name,
            ending,
        }
    }

    /// The words for a purpose of the hanging cloth.
    fn of_drape(purpose: Purpose) -> Self {
        let hands = ["/path/to/FINGERS.csv", "fingers.csv", ".csv"];
        let missing = "Type the name of a file first";
        match purpose {
            Purpose::OpenHands => Self::new(["Open a path of hands", "Open"], missing, hands),
            Purpose::SaveHands => Self::new(["Save the path of hands", "Save"], missing, hands),
            _ => {
                let scene = ["/path/to/NAME.drape.toml", "denim.drape.toml", ".toml"];
                Self::new(["Open a drape scene", "Open"], missing, scene)
            }
        }
    }

    /// The words for a purpose.
    pub(crate) fn of(purpose: Purpose) -> Self {
        const SCENE: &str = "Type the path of a scene first";
        const FILE: &str = "Type the name of a file first";
        const FOLDER: &str = "Type the path of a folder first";
        const WHERE: &str = "Type where to export to first";
        let scene = ["/path/to/NAME.scene.toml", "untitled.scene.toml", ".toml"];
        let path = ["/path/to/NAME.csv", "recording.csv", ".csv"];
        let design = ["/path/to/DESIGN.toml", "design.toml", ".toml"];
        let picture = ["/path/to/NAME.png", "cloth.png", ""];
        let export = |title, file| Self::new([title, "Export"], WHERE, file);
        match purpose {
            Purpose::OpenScene => Self::new(["Open scene", "Open"], SCENE, scene),
            Purpose::SaveScene => Self::new(["Save scene as", "Save"], SCENE, scene),
            Purpose::OpenRecording => Self::new(["Open a path to replay", "Open"], FILE, path),
            Purpose::SaveRecording => {
                Self::new(["Export the path of the recording", "Export"], FILE, path)
            }
            Purpose::OpenDesign => Self::new(["Open a design", "Open"], FILE, design),
            Purpose::SaveDesign => Self::new(["Save the design", "Save"], FILE, design),
            Purpose::ImportFiles => {
                let file = ["/path/to/NAME.txt", "strokes.txt", ""];
                Self::new(["Add a file of measurements", "Add"], FILE, file)
            }
            Purpose::AddTurned => Self::new(["Add a turned picture", "Add"], FILE, picture),
            Purpose::OpenPicture(Pane::Picture) => {
                Self::new(["Cloth from a picture", "Open"], FILE, picture)
            }
            Purpose::OpenPicture(_) => {
                Self::new(["Friction from a picture", "Open"], FILE, picture)
            }
            Purpose::OpenDrape | Purpose::OpenHands | Purpose::SaveHands => Self::of_drape(purpose),
            Purpose::AddLibrary => {
                let folder = ["/path/to/textiles", "textiles", ""];
                Self::new(["Add a folder of textiles", "Add"], FOLDER, folder)
            }
            Purpose::OpenLogs => {
                let folder = ["/path/to/study", "study", ""];
                let title = "Analyse the sessions in a folder";
                Self::new([title, "Analyse"], FOLDER, folder)
            }
            Purpose::WriteReport => {
                let folder = ["/path/to/study/analysis", "analysis", ""];
                Self::new(["Write the report into a folder", "Write"], FOLDER, folder)
            }
            Purpose::Clip(ClipKind::Wav { .. }) => {
                let file = ["/path/to/NAME.wav", "recording.wav", ".wav"];
                export("Export the recording as a waveform", file)
            }
            Purpose::Clip(ClipKind::Hjif) => {
                let file = ["/path/to/NAME.hjif", "recording.hjif", ".hjif"];
                export("Export the recording as MPEG haptics", file)
            }
            Purpose::Clip(ClipKind::Frames) => {
                let file = ["/path/to/NAME.csv", "frames.csv", ".csv"];
                export("Export the recording as frames", file)
            }
            Purpose::Export(_) => {
                let file = ["/path/to/NAME.png", "export.png", ".png"];
                export("Export as PNG, SVG or CSV", file)
            }
        }
    }
}

/// What is asked, and what was typed so far.
#[derive(Debug)]
pub(crate) struct Ask {
    /// What the path is for.
    pub purpose: Purpose,
    /// The path as typed.
    pub path: String,
    /// Whether the field has had the focus once.
    pub(crate) was_focused: bool,
    completing: Option<Task<[String; 2]>>,
}

impl Ask {
    /// A question with the path that is known already.
    pub(crate) fn new(purpose: Purpose, known: Option<&PathBuf>) -> Self {
        let path = known
            .map(|path| path.display().to_string())
            .unwrap_or_default();
        Self {
            purpose,
            path,
            was_focused: false,
            completing: None,
        }
    }

    fn answer(&self) -> Option<Command> {
        let path = self.path.trim();
        let use_it = |path| FileCommand::Use(self.purpose, path).into();
        (!path.is_empty()).then(|| use_it(PathBuf::from(path)))
    }

    /// Takes the completion that has come, unless something else was typed meanwhile; says whether
    /// the path is another one now.
    fn take_completion(&mut self) -> bool {
        let Some(Ok([typed, path])) = finished(&mut self.completing) else {
            return false;
        };
        if typed != self.path || path == self.path {
            return false;
        }
        self.path = path;
        true
    }
}

/// Shows the question at the upper edge of `over`; `recent` are the scenes that were opened last.
pub(crate) fn show(
    ui: &Ui,
    over: Rect,
    ask: &mut Ask,
    recent: &[PathBuf],
    commands: &mut Commands,
) {
    let words = AskWords::of(ask.purpose);
    card(ui, over, 560.0, words.title, |ui, title| {
        let is_entered = show_field(ui, title, ask, words);
        ui.add_space(STEP);
        show_buttons(ui, ask, words, is_entered, commands);
        if ask.purpose == Purpose::OpenScene && !recent.is_empty() {
            // Below title, field and buttons.
            let room = over.height() - CARD_DROP - 2.0 * CARD_MARGIN - 136.0;
            show_recent(ui, room, recent, commands);
        }
    });
}

/// The field; says whether Enter was pressed in it.
fn show_field(ui: &mut Ui, title: &egui::Response, ask: &mut Ask, words: AskWords) -> bool {
    let id = ui.make_persistent_id("path");
    let was_completed = ask.take_completion();
    if ui.memory(|memory| memory.has_focus(id)) && is_tab(ui) {
        let threads = Executor::Threads(ui.ctx().clone());
        ask.completing = Some(complete(&ask.path, words.ending, &threads));
    }
    let field = TextEdit::singleline(&mut ask.path)
        .id(id)
        .desired_width(f32::INFINITY)
        .font(theme::number())
        .margin(Margin::symmetric(8, 6))
        .event_filter(EventFilter {
            tab: true,
            horizontal_arrows: true,
            ..EventFilter::default()
        })
        .hint_text(words.hint);
    let TextEditOutput {
        response, state, ..
    } = field.show(ui);
    let response = response.response.labelled_by(title.id);
    let end = ask.path.chars().count();
    if !ask.was_focused {
        response.request_focus();
        // Typing replaces the known path.
        select(ui, state, id, [0, end]);
        ask.was_focused = true;
    } else if was_completed {
        select(ui, state, id, [end, end]);
    }
    response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter))
}

/// Whether Tab was pressed, which completes here; arrows up and down, and Shift+Tab, go elsewhere.
fn is_tab(ui: &Ui) -> bool {
    let (is_back, is_tab) = ui.input_mut(|input| {
        (
            input.consume_key(Modifiers::SHIFT, Key::Tab),
            input.consume_key(Modifiers::NONE, Key::Tab),
        )
    });
    if is_back {
        ui.memory_mut(|memory| memory.move_focus(FocusDirection::Previous));
    }
    is_tab
}

fn show_buttons(
    ui: &mut Ui,
    ask: &Ask,
    words: AskWords,
    is_entered: bool,
    commands: &mut Commands,
) {
    let size = vec2(ui.available_width(), ROW);
    let layout = Layout::right_to_left(Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        let answer = ask.answer();
        let missing = answer.is_none().then_some(words.missing);
        if (button(ui, words.verb, "", missing) || is_entered)
            && let Some(command) = answer
        {
            commands.push(command);
        }
        if button(ui, "Cancel", "", None) {
            commands.push(Command::Dismiss);
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let hint = "Tab completes the path";
            ui.label(quiet(hint));
        });
    });
}

/// The scenes that were opened last: a click opens one.
fn show_recent(ui: &mut Ui, room: f32, recent: &[PathBuf], commands: &mut Commands) {
    section(ui, "Recent scenes");
    let list = ScrollArea::vertical().max_height(room.max(3.0 * ROW));
    list.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for path in recent {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let folder = path.parent().unwrap_or(path).display().to_string();
            let tip = path.display().to_string();
            if choice(ui, RichText::new(name), &folder, &tip) {
                commands.push(FileCommand::Use(Purpose::OpenScene, path.clone()).into());
            }
        }
    });
}

/// Selects what is between two places of the text, counted in characters.
fn select(ui: &Ui, mut state: TextEditState, id: Id, [from, to]: [usize; 2]) {
    let range = CCursorRange::two(CCursor::new(from), CCursor::new(to));
    state.cursor.set_char_range(Some(range));
    state.store(ui.ctx(), id);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_path_is_no_answer() {
        let mut ask = Ask::new(Purpose::OpenScene, None);
        ask.path = "  ".to_owned();
        assert_eq!(ask.answer(), None);
        ask.path = " a.scene.toml ".to_owned();
        assert_eq!(
            ask.answer(),
            Some(FileCommand::Use(Purpose::OpenScene, PathBuf::from("a.scene.toml")).into())
        );
    }

    #[test]
    fn every_purpose_is_asked_for_in_words_of_its_own() {
        let purposes = [
            Purpose::OpenScene,
            Purpose::SaveScene,
            Purpose::OpenRecording,
            Purpose::SaveRecording,
        ];
        let titles = purposes.map(|purpose| AskWords::of(purpose).title);
        for (i, title) in titles.iter().enumerate() {
            assert!(!titles[i + 1..].contains(title), "{title}");
        }
        for words in purposes.map(AskWords::of) {
            assert!(words.name.ends_with(words.ending), "{words:?}");
            assert!(words.hint.ends_with(words.ending), "{words:?}");
        }
    }
}
