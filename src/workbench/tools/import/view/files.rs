//! The first step: which files, and what each of them holds.

use eframe::egui::{Align, Label, Layout, Ui, vec2};

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::kit::drop::nothing_yet;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{LINE, Need, choose, step_title};
use crate::kit::widgets::text::{button, line, quiet, small, toggle, toggles};
use crate::tools::import::Import;
use crate::tools::import::draft::DraftFile;
use crate::tools::import::work::Found;
use selvedge_textile::{KesPlace, Measurement, StrokeSide, TextileAxis};

/// What is said before anything was chosen.
const EMPTY: [&str; 3] = [
    "Strokes of a Kawabata surface tester (KES-FB4): one to four files of text in columns, out and \
     back, along warp and weft, roughness and friction.",
    "A height map or a profile of an instrument: X3P, SUR or PRO, GWY, GSF, NPY, TMD, FRT, grey \
     PNG or TIFF of 16 bits, or text.",
    "What a file is, its content says; what it does not say is asked for. Nothing is saved before \
     you have looked at it.",
];
/// What a file of the tester may hold.
const HOLDS: [(Option<KesPlace>, &str); 7] = {
    use StrokeSide::{Forward, Return};
    use TextileAxis::{Warp, Weft};

    const fn place(axis: TextileAxis, side: Option<StrokeSide>) -> KesPlace {
        KesPlace { axis, side }
    }
    [
        (None, "by its name"),
        (Some(place(Warp, None)), "warp"),
        (Some(place(Warp, Some(Forward))), "warp forward"),
        (Some(place(Warp, Some(Return))), "warp return"),
        (Some(place(Weft, None)), "weft"),
        (Some(place(Weft, Some(Forward))), "weft forward"),
        (Some(place(Weft, Some(Return))), "weft return"),
    ]
};

/// What to do when there is nothing yet.
pub(crate) fn show_empty(ui: &mut Ui, commands: &mut Commands) {
    let words = [
        "Import your own fabrics",
        "Drop measurements here, or choose files.",
        "Choose files…",
    ];
    if nothing_yet(ui, 280.0, words, EMPTY) {
        commands.push(FileCommand::Ask(Purpose::ImportFiles).into());
    }
}

/// Shows the step.
pub(crate) fn show(
    ui: &mut Ui,
    importing: &mut Import,
    found: Option<&Found>,
    commands: &mut Commands,
) {
    let n = importing.draft.described.files.len();
    let state = if n == 1 {
        "1 file".to_owned()
    } else {
        format!("{n} files")
    };
    step_title(ui, 1, "Files", &state);
    let is_strokes = found.is_some_and(|found| found.kind == Measurement::Strokes);
    let mut gone = None;
    for (nth, file) in importing.draft.described.files.iter_mut().enumerate() {
        if show_file(ui, nth, file, is_strokes) {
            gone = Some(nth);
        }
    }
    if let Some(nth) = gone {
        importing.draft.described.files.remove(nth);
    }
    show_kind(ui, &mut importing.draft.described.kind);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        if button(ui, "Add…", "Choose more files", None) {
            commands.push(FileCommand::Ask(Purpose::ImportFiles).into());
        }
        if button(ui, "Read again", "Read the files anew from the disk", None) {
            importing.read_again();
        }
        if button(
            ui,
            "Begin anew",
            "Let go of all files and of what was typed",
            None,
        ) {
            importing.cancel();
            *importing = Import::default();
        }
    });
}

/// A file; says whether it is to go.
fn show_file(ui: &mut Ui, nth: usize, file: &mut DraftFile, is_strokes: bool) -> bool {
    let palette = Palette::in_ui(ui);
    let mut is_gone = false;
    let line = Layout::right_to_left(Align::Center);
    ui.allocate_ui_with_layout(vec2(ui.available_width(), LINE), line, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.spacing_mut().interact_size.y = LINE - 2.0;
        let name = file.source.name();
        is_gone = toggle(ui, "×", false, &format!("Leave out {name}"));
        if is_strokes {
            show_place(ui, nth, file);
        } else if let Some(n_bytes) = file.source.n_bytes() {
            ui.label(quiet(size_words(n_bytes)));
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let path = file.source.path().display().to_string();
            let name = small(name, palette.text);
            ui.add(Label::new(name).truncate()).on_hover_text(path);
        });
    });
    is_gone
}

/// What a file of the tester holds.
fn show_place(ui: &mut Ui, nth: usize, file: &mut DraftFile) {
    let named = HOLDS.iter().find(|(place, _)| *place == file.place);
    let text = match named {
        _ if file.is_friction => "friction",
        Some((_, words)) => words,
        None => "by its name",
    };
    let name = format!("What file {} holds", nth + 1);
    choose(ui, &name, (text, 104.0, Need::Optional), |ui| {
        for (place, words) in HOLDS {
            let is_chosen = !file.is_friction && file.place == place;
            if ui.selectable_label(is_chosen, words).clicked() {
                (file.place, file.is_friction) = (place, false);
            }
        }
        if ui.selectable_label(file.is_friction, "friction").clicked() {
            (file.place, file.is_friction) = (None, true);
        }
    });
}

/// What the files are taken for.
fn show_kind(ui: &mut Ui, kind: &mut Option<Measurement>) {
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        let words = quiet("read as");
        ui.label(words);
        let choices = [
            (None, "by content", "What the files are, their content says"),
            (
                Some(Measurement::Strokes),
                "strokes",
                "Read as strokes of the surface tester",
            ),
            (
                Some(Measurement::Heights),
                "heights",
                "Read as a height map or a profile",
            ),
        ];
        toggles(ui, kind, &choices);
    });
}

/// A size for people.
fn size_words(n_bytes: usize) -> String {
    let (value, unit) = match n_bytes {
        0..1_000 => return format!("{n_bytes} B"),
        1_000..1_000_000 => (n_bytes as f64 / 1e3, "kB"),
        _ => (n_bytes as f64 / 1e6, "MB"),
    };
    selvedge_foundation::quantity::with_unit(value, 1, unit)
}
