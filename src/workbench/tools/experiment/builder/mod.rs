//! The study builder: a design as blocks, beside it what a participant will see, what it comes to,
//! and pilots.
//!
//! ```text
//! text of the design ─▶ keys ─▶ blocks ─▶ keys that were set ─▶ text (a step)
//!        └─▶ design ─▶ sample, trials, minutes, balance, power
//! ```

pub(crate) mod block_list;
pub(crate) mod blocks;
pub(crate) mod fields;
pub(crate) mod looked;
pub(crate) mod numbers;
pub(crate) mod sample;
pub(crate) mod settle;
pub(crate) mod state;
pub(crate) mod stimuli;
pub(crate) mod study_text;
#[cfg(test)]
mod tests;
pub(crate) mod view;

use eframe::egui::{Rect, RichText, Ui, vec2};

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::session::title_of;
use crate::bench::tool::PaneContext;
use crate::kit::pane::{inside, scrolled_column};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Need, choose};
use crate::kit::widgets::text::{button, toggle};
use crate::tools::experiment::builder::study_text::Chosen;
use crate::tools::experiment::form::Form;
use crate::tools::experiment::state::Experiment;
use selvedge_experiment::design::Design;

/// Height of the line of buttons, points.
const HEAD: f32 = 34.0;
/// Share of the width that blocks take, and no more than this, points.
const BLOCKS_WIDE: (f32, f32) = (0.5, 420.0);

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    let whole = ui.available_rect_before_wrap().shrink2(vec2(12.0, 4.0));
    let (head, below) = whole.split_top_bottom_at_y(whole.top() + HEAD);
    inside(ui, head, |ui| show_head(ui, experiment, context));
    let wide = (BLOCKS_WIDE.0 * below.width()).min(BLOCKS_WIDE.1);
    let (left, right) = below.split_left_right_at_x(below.left() + wide);
    inside(ui, left, |ui| {
        scrolled_column(ui, "blocks", |ui| view::show(ui, experiment, context));
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
            (false, false) => "of the program",
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
        Err(_) => form.study.chosen().name(),
    };
    let width = ui.available_width().min(280.0);
    let mut chosen = None;
    choose(ui, "Design", (&now, width, Need::Optional), |ui| {
        for name in Design::shipped_names() {
            let title = Design::shipped(name).map_or_else(|| name.to_owned(), |d| title_of(&d));
            let is_now = *form.study.chosen() == Chosen::Shipped(name);
            if ui.selectable_label(is_now, title).clicked() {
                chosen = Some(Chosen::Shipped(name));
                ui.ctx().request_repaint();
            }
        }
        ui.separator();
        if ui.selectable_label(false, "A new design").clicked() {
            chosen = Some(Chosen::New);
        }
        if ui.selectable_label(false, "Open a design…").clicked() {
            context
                .commands
                .push(FileCommand::Ask(Purpose::OpenDesign).into());
        }
    });
    if let Some(chosen) = chosen {
        form.choose(chosen);
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
    numbers::show_pilots(ui, experiment, context.bench);
    if let Some(looked) = looked {
        numbers::show(ui, &mut experiment.form, &looked);
    }
}
