//! The study builder: a design as blocks, beside it what a participant will see, what it comes to,
//! and pilots.
//!
//! ```text
//! text of the design ─▶ keys ─▶ blocks ─▶ keys that were set ─▶ text (a step)
//!        └─▶ design ─▶ sample, trials, minutes, balance, power
//! ```

pub(crate) mod blocks;
pub(crate) mod fields;
pub(crate) mod looked;
pub(crate) mod numbers;
pub(crate) mod sample;
pub(crate) mod stimuli;
pub(crate) mod study_text;
#[cfg(test)]
mod tests;

use eframe::egui::{Rect, RichText, TextEdit, Ui, vec2};

use crate::bench::background::Task;
use crate::bench::command::{FileCommand, Purpose};
use crate::bench::session::title_of;
use crate::bench::tool::PaneContext;
use crate::kit::pane::{inside, scrolled_column};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, choose, note, row_of, text};
use crate::kit::widgets::fold::described_fold;
use crate::kit::widgets::text::{button, toggle};
use crate::tools::experiment::builder::blocks::{BLOCKS, Block, TRACKS, set_track, track, word};
use crate::tools::experiment::builder::fields::Editing;
use crate::tools::experiment::builder::sample::Step;
use crate::tools::experiment::builder::study_text::{Chosen, Target};
use crate::tools::experiment::form::Form;
use crate::tools::experiment::state::Experiment;
use selvedge_experiment::design::Design;

/// Height of the line of buttons, points.
const HEAD: f32 = 34.0;
/// Share of the width that blocks take, and no more than this, points.
const BLOCKS_WIDE: (f32, f32) = (0.5, 420.0);

/// What the builder shows of the design at hand.
#[derive(Debug, Default)]
pub(crate) struct Builder {
    /// Whether the text is shown in the place of blocks.
    is_text: bool,
    /// The block that is open.
    open: Option<&'static str>,
    list: stimuli::List,
    step: Step,
    /// Why the file could not be written.
    failure: Option<String>,
    /// A study of simulated observers under way.
    pub(super) simulating: Option<Task<Simulated>>,
    /// What became of the last, and the text that it was of.
    pub(super) simulated: Option<Simulated>,
}

/// A design's text, and what a study of simulated observers by it came to, a line each.
pub(crate) type Simulated = (String, Result<Vec<String>, String>);

impl Builder {
    /// Takes what became of writing the file.
    pub(super) fn saved(&mut self, outcome: Result<(), String>) {
        self.failure = outcome.err();
    }
}

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    let whole = ui.available_rect_before_wrap().shrink2(vec2(12.0, 4.0));
    let (head, below) = whole.split_top_bottom_at_y(whole.top() + HEAD);
    inside(ui, head, |ui| show_head(ui, experiment, context));
    let wide = (BLOCKS_WIDE.0 * below.width()).min(BLOCKS_WIDE.1);
    let (left, right) = below.split_left_right_at_x(below.left() + wide);
    inside(ui, left, |ui| {
        scrolled_column(ui, "blocks", |ui| show_design(ui, experiment, context));
    });
    let right = Rect::from_min_max(right.min + vec2(16.0, 0.0), right.max);
    inside(ui, right, |ui| {
        scrolled_column(ui, "sample", |ui| show_sample(ui, experiment, context));
    });
}

fn show_head(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    let held = experiment
        .session
        .is_some()
        .then_some("A session is being held");
    let (form, builder) = (&mut experiment.form, &mut experiment.builder);
    ui.horizontal(|ui| {
        show_designs(ui, form, context);
        if toggle(ui, "text", builder.is_text, "The design as its file has it") {
            builder.is_text = !builder.is_text;
        }
        let is_file = matches!(form.study.chosen(), Chosen::File(_));
        let same = (!form.study.is_changed()).then_some("Nothing was changed");
        if is_file && button(ui, "Save", "Write the design's file", held.or(same)) {
            let path = form.study.chosen().path().to_owned();
            builder.failure = form.study.save(&path).err();
        }
        if button(ui, "Save as…", "Write the design to another file", held) {
            context
                .commands
                .push(FileCommand::Ask(Purpose::SaveDesign).into());
        }
        let state = match (form.study.is_changed(), is_file) {
            (true, _) => "changed, not saved",
            (false, true) => "saved",
            (false, false) => "a design of the program",
        };
        ui.label(
            RichText::new(state)
                .font(theme::small())
                .color(Palette::in_ui(ui).dim),
        );
    });
}

/// The list of designs.
pub(crate) fn show_designs(ui: &mut Ui, form: &mut Form, context: &mut PaneContext<'_>) {
    let now = match form.study.design() {
        Ok(design) => title_of(design),
        Err(_) => form.study.chosen().path().display().to_string(),
    };
    let width = ui.available_width().min(280.0);
    let mut chosen = None;
    choose(
        ui,
        "Design",
        (&now, width, crate::kit::widgets::fields::Need::Optional),
        |ui| {
            for name in Design::shipped_names() {
                let title = Design::shipped(name).map_or_else(|| name.to_owned(), |d| title_of(&d));
                let is_now = *form.study.chosen() == Chosen::Shipped(name);
                if ui.selectable_label(is_now, title).clicked() {
                    chosen = Some(Chosen::Shipped(name));
                    ui.ctx().request_repaint();
                }
            }
            ui.separator();
            if ui.selectable_label(false, "Open a design…").clicked() {
                context
                    .commands
                    .push(FileCommand::Ask(Purpose::OpenDesign).into());
            }
        },
    );
    if let Some(chosen) = chosen {
        form.choose(chosen);
    }
}

fn show_design(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    if experiment.session.is_some() {
        return note(
            ui,
            "A session is being held: its design stays as it is.",
            Tone::Quiet,
        );
    }
    let (form, builder) = (&mut experiment.form, &mut experiment.builder);
    if let Some(line) = &builder.failure {
        note(ui, line, Tone::Wrong);
    }
    let moment = context.bench.pointer.moment;
    let keys = form.study.keys().cloned();
    let (true, Ok(keys)) = (!builder.is_text, keys) else {
        if let Err(fault) = form.study.design() {
            note(ui, &fault.line, Tone::Wrong);
        }
        let mut typed = form.study.text().to_owned();
        let area = TextEdit::multiline(&mut typed)
            .code_editor()
            .font(theme::small_number())
            .desired_width(f32::INFINITY);
        if ui.add(area).changed() {
            form.study.write(typed, (Target::Text, "text"), moment);
        }
        return;
    };
    let mut editing = Editing {
        stimuli: stimuli::ids(&keys),
        keys,
        change: None,
    };
    let fault = form.study.design().err().cloned();
    if let Some(fault) = fault
        .as_ref()
        .filter(|fault| block_of(&fault.table).is_none())
    {
        note(ui, &fault.line, Tone::Wrong);
    }
    let mut open = builder.open;
    let mut block = |ui: &mut Ui,
                     (title, tables): (&'static str, &[&str]),
                     summary: &str,
                     content: &mut dyn FnMut(&mut Ui)| {
        let fault = fault
            .as_ref()
            .filter(|fault| tables.contains(&fault.table.as_str()));
        let is_open = open == Some(title);
        let clicked = described_fold(ui, (title, is_open), summary, |ui| {
            if let Some(fault) = fault {
                note(ui, &fault.line, Tone::Wrong);
            }
            content(ui);
        });
        if !is_open && fault.is_some() {
            note(ui, "This block is wrong: open it", Tone::Wrong);
        }
        if clicked.clicked() {
            open = (!is_open).then_some(title);
            builder.step = Step::of_block(title).unwrap_or(builder.step);
        }
    };
    for (nth, one) in BLOCKS.iter().enumerate() {
        if nth == 1 {
            let summary = format!("{}", editing.stimuli.len());
            block(ui, ("Stimuli", &["stimulus"]), &summary, &mut |ui| {
                stimuli::show(ui, &mut editing, &mut builder.list, context.bench);
            });
        }
        let summary = summary(&editing, one);
        block(ui, (one.title, one.tables), &summary, &mut |ui| {
            show_block(ui, &mut editing, one)
        });
    }
    builder.open = open;
    if let Some(change) = editing.change {
        form.study.write(editing.keys.text(), change, moment);
        ui.ctx().request_repaint();
    }
}

/// The block that a table belongs to.
fn block_of(table: &str) -> Option<&'static str> {
    let mut blocks = BLOCKS.iter();
    let found = blocks.find(|block| block.tables.contains(&table));
    let stimuli = (table == "stimulus").then_some("Stimuli");
    found.map(|block| block.title).or(stimuli)
}

fn summary(editing: &Editing, block: &Block) -> String {
    let keys = &editing.keys;
    match block.title {
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

fn show_block(ui: &mut Ui, editing: &mut Editing, block: &Block) {
    if block.title == "Adaptation" {
        show_track(ui, editing);
    }
    for field in block.fields {
        if field.applies(&editing.keys) {
            fields::field(ui, editing, (field, 0));
        }
    }
    if block.title == "Question" {
        show_question(ui, editing);
    }
    for rows in block.rows {
        if rows.applies(&editing.keys) {
            fields::rows(ui, editing, rows);
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
    row_of(ui, 104.0, ("words", ""), |ui, label| {
        let hint = ("what the composition asks by itself", 216.0);
        let need = crate::kit::widgets::fields::Need::Optional;
        if text(ui, label, &mut typed, (hint.0, hint.1, need)).changed() {
            let value = (!typed.trim().is_empty()).then(|| typed.into());
            editing.set(place, value, "question");
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

fn show_sample(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    let (form, builder) = (&mut experiment.form, &mut experiment.builder);
    let looked = form.looked.value().cloned();
    if let Ok(design) = form.study.design() {
        let trial = looked.as_ref().and_then(|looked| looked.trial.as_ref());
        // A trial of the text before would not fit this one.
        let is_fresh = form
            .looked
            .key()
            .is_some_and(|key| key.text == form.study.text());
        sample::show(ui, &mut builder.step, (design, trial.filter(|_| is_fresh)));
    }
    if let Some(looked) = looked {
        numbers::show(ui, form, &looked);
    }
    numbers::show_pilots(ui, experiment, context.bench);
}
