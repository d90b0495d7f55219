//! The blocks of a design, or its text.

use eframe::egui::{TextEdit, Ui};

use crate::bench::Bench;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::widgets::fields::{Need, Tone, note, row_of, text};
use crate::kit::widgets::fold::described_fold;
use crate::kit::widgets::text::toggle;
use crate::tools::experiment::builder::block_list::BLOCKS;
use crate::tools::experiment::builder::blocks::{Block, TRACKS, track, word};
use crate::tools::experiment::builder::fields::{Editing, FIELD, NAME, field, rows};
use crate::tools::experiment::builder::settle::set_track;
use crate::tools::experiment::builder::state::{Builder, List, Step};
use crate::tools::experiment::builder::stimuli;
use crate::tools::experiment::builder::study_text::{Fault, Target};
use crate::tools::experiment::form::Form;
use crate::tools::experiment::state::Experiment;
use selvedge_foundation::files::EditedKeys;

/// Shows the design at hand; nothing of it is changed while a session is held.
pub(super) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &PaneContext<'_>) {
    if experiment.session.is_some() {
        let words = "A session is being held: its design stays as it is.";
        return note(ui, words, Tone::Quiet);
    }
    let (form, builder) = (&mut experiment.form, &mut experiment.builder);
    if let Some(line) = &builder.failure {
        note(ui, line, Tone::Wrong);
    }
    match form.study.keys().cloned() {
        Ok(keys) if !builder.is_text => show_blocks(ui, (form, builder), keys, context.bench),
        _ => show_text(ui, form, context.bench),
    }
}

fn show_text(ui: &mut Ui, form: &mut Form, bench: &Bench) {
    if let Err(fault) = form.study.design() {
        note(ui, &fault.line, Tone::Wrong);
    }
    let mut typed = form.study.text().to_owned();
    let area = TextEdit::multiline(&mut typed)
        .code_editor()
        .font(theme::small_number())
        .desired_width(f32::INFINITY);
    if ui.add(area).changed() {
        let moment = bench.pointer.moment;
        form.study.write(typed, (Target::Text, "text"), moment);
    }
}

fn show_blocks(
    ui: &mut Ui,
    (form, builder): (&mut Form, &mut Builder),
    keys: EditedKeys,
    bench: &Bench,
) {
    let mut editing = Editing {
        stimuli: stimuli::ids(&keys),
        keys,
        change: None,
    };
    let keys_now = editing.keys.clone();
    let fault = form.study.design().err().cloned();
    let nowhere = |fault: &&Fault| block_of(&fault.table).is_none();
    if let Some(fault) = fault.as_ref().filter(nowhere) {
        note(ui, &fault.line, Tone::Wrong);
    }
    for block in BLOCKS.iter().filter(|block| block.applies(&keys_now)) {
        let own = |fault: &&Fault| block_of(&fault.table) == Some(block.title);
        let is_open = builder.open == Some(block.title);
        let summary = summary(&editing, block);
        let head = described_fold(ui, (block.title, is_open), &summary, |ui| {
            show_block(ui, &mut editing, (block, &mut builder.list), bench);
        });
        if let Some(fault) = fault.as_ref().filter(own) {
            note(ui, &fault.line, Tone::Wrong);
        }
        if head.clicked() {
            builder.open = (!is_open).then_some(block.title);
            builder.step = Step::of_block(block.title).unwrap_or(builder.step);
        }
    }
    if let Some(change) = editing.change {
        let moment = bench.pointer.moment;
        form.study.write(editing.keys.text(), change, moment);
        ui.ctx().request_repaint();
    }
}

/// The block that a table belongs to.
pub(super) fn block_of(table: &str) -> Option<&'static str> {
    let mut blocks = BLOCKS.iter();
    let found = blocks.find(|block| block.tables.contains(&table));
    found.map(|block| block.title)
}

fn summary(editing: &Editing, block: &Block) -> String {
    let keys = &editing.keys;
    match block.title {
        "Stimuli" => editing.stimuli.len().to_string(),
        "Study" => word(keys, "", "title"),
        "Presentation" => word(keys, "presentation", "kind"),
        "Question" => word(keys, "question", "text"),
        "Response" => word(keys, "response", "kind"),
        "Order" => word(keys, "order", "sets"),
        "Adaptation" => {
            let known = TRACKS.iter().find(|(table, _)| track(keys) == Some(table));
            known.map_or("none", |(_, name)| name).to_owned()
        }
        "Rules" => keys
            .value(("rules", 0, "subjects"))
            .map_or_else(String::new, |n| format!("{n} subjects")),
        _ => String::new(),
    }
}

fn show_block(
    ui: &mut Ui,
    editing: &mut Editing,
    (block, list): (&Block, &mut List),
    bench: &Bench,
) {
    match block.title {
        "Adaptation" => show_track(ui, editing),
        "Stimuli" => stimuli::show(ui, editing, list, bench),
        _ => {}
    }
    for one in block.fields {
        if one.applies(&editing.keys) {
            field(ui, editing, (one, 0));
        }
    }
    if block.title == "Question" {
        show_question(ui, editing);
    }
    for one in block.rows {
        if one.applies(&editing.keys) {
            rows(ui, editing, one);
        }
    }
}

/// The words of the question in the language that is shown.
fn show_question(ui: &mut Ui, editing: &mut Editing) {
    let language = word(&editing.keys, "question", "language");
    let place = match language.as_str() {
        "" => ("question", 0, "text"),
        language => ("question.texts", 0, language),
    };
    let value = editing.keys.value(place);
    let mut typed = value
        .and_then(|one| one.as_str().map(str::to_owned))
        .unwrap_or_default();
    row_of(ui, NAME, ("words", ""), |ui, label| {
        let hint = ("what the composition asks by itself", FIELD, Need::Optional);
        if text(ui, label, &mut typed, hint).changed() {
            let value = (!typed.trim().is_empty()).then(|| typed.into());
            editing.set(place, value.as_ref(), "question");
        }
    });
}

/// How the next value is found, if a number follows the answers.
fn show_track(ui: &mut Ui, editing: &mut Editing) {
    let now = track(&editing.keys);
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        if toggle(ui, "none", now.is_none(), "No number follows the answers") {
            chosen = Some(None);
        }
        for (table, name) in TRACKS {
            let tip = format!("Find the next value by {name}");
            if toggle(ui, name, now == Some(table), &tip) {
                chosen = Some(Some(table));
            }
        }
    });
    if let Some(chosen) = chosen.filter(|chosen| *chosen != now) {
        set_track(&mut editing.keys, chosen);
        editing.restructured("adaptation");
    }
}
