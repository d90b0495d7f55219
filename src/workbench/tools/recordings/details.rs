//! What stands below the list: what the chosen recording is, and what can be done with it.

use eframe::egui::{TextEdit, Ui};

use crate::bench::command::{Commands, FileCommand, Purpose, RecordingCommand};
use crate::bench::recording::{Entry, Place};
use crate::bench::tool::PaneContext;
use crate::kit::theme::STEP;
use crate::kit::widgets::list;
use crate::kit::widgets::text::{button, named, paragraph, quiet};
use crate::tools::recordings::began;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Tuning;

/// Shows the chosen recording; `name` is what is typed in its field, `entries` are all.
pub(super) fn show(
    ui: &mut Ui,
    entry: &Entry,
    name: &mut String,
    entries: &[Entry],
    context: &mut PaneContext<'_>,
) {
    ui.separator();
    show_name(ui, entry, name, context.commands);
    let tuning = context.scene.tuning;
    for line in lines(entry, tuning) {
        paragraph(ui, quiet(line));
    }
    ui.add_space(STEP);
    let document = &context.bench.document;
    let scene_file = document.path().map(std::path::PathBuf::as_path);
    let references = &document.scene().recordings;
    let is_referred = references
        .iter()
        .any(|reference| Some(reference.place(scene_file).as_path()) == entry.place.path());
    show_acts(ui, entry, is_referred, context.commands);
    show_comparing(ui, entry, entries, context.commands);
}

fn show_name(ui: &mut Ui, entry: &Entry, name: &mut String, commands: &mut Commands) {
    let can_rename = matches!(entry.place, Place::Folder(_));
    let field = TextEdit::singleline(name).desired_width(f32::INFINITY);
    let response = ui.add_enabled(can_rename, field);
    named(&response, "Name of the recording");
    if response.lost_focus() && *name != entry.about.name {
        if name.trim().is_empty() {
            name.clone_from(&entry.about.name);
        } else {
            commands.push(RecordingCommand::Rename(entry.place.clone(), name.clone()).into());
        }
    }
}

/// What a recording is, line by line; `now` is the tuning in force.
fn lines(entry: &Entry, now: Tuning) -> Vec<String> {
    let about = &entry.about;
    let mut lines = Vec::new();
    match &entry.place {
        Place::Missing(path) => {
            return vec![format!("{}: nothing is there (any more)", path.display())];
        }
        Place::PathFile(path) => return vec![format!("Path file {}", path.display())],
        Place::Memory(_) => lines.push("Only in memory: export it before you close".to_owned()),
        Place::Busy(_) => lines.push("Another window records it now".to_owned()),
        Place::Folder(_) => {}
    }
    lines.push(format!("{} UTC, in {}", began(about), about.scene));
    if let Some([n_ticks, n_felt]) = about.ticks {
        lines.push(match n_felt {
            0 => "Only shown: no device was armed".to_owned(),
            _ if n_felt == n_ticks => "All of it was felt on an armed device".to_owned(),
            _ => {
                let percent = 100.0 * n_felt as f64 / n_ticks.max(1) as f64;
                let felt = quantity::with_unit(percent, 0, "%");
                format!("{felt} of it was felt, the rest only shown")
            }
        });
    }
    if let Some(tuning) = about.tuning {
        let gains = [tuning.gain_db, tuning.gain_40_db, tuning.gain_320_db];
        let [all, low, high] = gains.map(|db| quantity::fixed(db, 1));
        let same = if tuning == now {
            ", as now"
        } else {
            "; not the present one"
        };
        lines.push(format!("Tuning {all}, 40 Hz {low}, 320 Hz {high} dB{same}"));
    }
    lines
}

fn show_acts(ui: &mut Ui, entry: &Entry, is_referred: bool, commands: &mut Commands) {
    let place = || entry.place.clone();
    let missing = matches!(entry.place, Place::Missing(_)).then_some("Nothing is there");
    let busy = matches!(entry.place, Place::Busy(_)).then_some("End the recording first");
    let in_memory = matches!(entry.place, Place::Memory(_)).then_some("It is in no file");
    ui.horizontal_wrapped(|ui| {
        let tip = "Write its path as a table (CSV): time, place, velocity";
        if button(ui, "Export path…", tip, missing.or(busy)) {
            commands.push(RecordingCommand::Export(place()).into());
        }
        let (words, tip) = if is_referred {
            (
                "Leave scene",
                "The scene’s file names it no longer; the recording stays",
            )
        } else {
            (
                "Keep in scene",
                "The scene’s file names it, so that it is listed with the scene",
            )
        };
        if button(ui, words, tip, in_memory) {
            commands.push(RecordingCommand::Refer(place()).into());
        }
        let tip = match entry.place {
            Place::PathFile(_) => "Take it from the list; the file stays",
            _ => "Delete it; it can be brought back",
        };
        if button(ui, "Delete", tip, missing.or(busy).or(in_memory)) {
            commands.push(RecordingCommand::Delete(place()).into());
        }
        let tip = "Write what the device would play: waveform, frames, MPEG haptics: File menu";
        if button(ui, "Frames…", tip, missing.or(busy)) {
            let clip = Purpose::Clip(selvedge_engine::ClipKind::Frames);
            commands.push(FileCommand::Ask(clip).into());
        }
    });
}

/// The recordings that the chosen one can be set against.
fn show_comparing(ui: &mut Ui, entry: &Entry, entries: &[Entry], commands: &mut Commands) {
    let is_readable = |entry: &&Entry| {
        matches!(
            entry.place,
            Place::Folder(_) | Place::PathFile(_) | Place::Memory(_)
        )
    };
    if !is_readable(&entry) {
        return;
    }
    let others = entries.iter().filter(is_readable);
    let others: Vec<&Entry> = others.filter(|other| other.place != entry.place).collect();
    if others.is_empty() {
        return;
    }
    let width = ui.available_width();
    let label = "Compare with another recording";
    list(ui, ("compared", label), width, "Compare with…", |ui| {
        for other in others {
            if ui.selectable_label(false, &other.about.name).clicked() {
                let two = [entry.place.clone(), other.place.clone()];
                commands.push(RecordingCommand::Compare(Box::new(two)).into());
            }
        }
    });
}
