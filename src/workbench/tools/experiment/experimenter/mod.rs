//! A session as who holds it sees it: how far it is, the device, what to lay on the table, notes.
//! Never what is right.

pub(crate) mod begin;
pub(crate) mod session;

use eframe::egui::{ProgressBar, RichText, Ui};

use crate::bench::Bench;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::{button, section};
use crate::tools::experiment::noise::NoiseView;
use crate::tools::experiment::participant;
use crate::tools::experiment::state::{Experiment, ParticipantsWindow};

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    ui.horizontal_wrapped(|ui| {
        show_window(ui, &mut experiment.window);
        show_blank(ui, &mut experiment.is_blank);
    });
    show_typed(ui, experiment, context.bench);
    if experiment.session.is_some() {
        session::show(ui, experiment, context);
    } else {
        begin::show(ui, experiment, context);
    }
    if let Some(noise) = experiment.noise() {
        show_noise(ui, &noise, experiment, context.bench);
    }
}

/// The trial whose answer is typed here, while the participant sees nothing.
fn show_typed(ui: &mut Ui, experiment: &mut Experiment, bench: &mut Bench) {
    let now_s = ui.input(|input| input.time);
    let session = experiment.session.as_ref().filter(|_| experiment.is_blank);
    if let Some(trial) = session.and_then(|session| session.typed(now_s)) {
        let mut acts = Vec::new();
        section(ui, "Answer, typed for the participant");
        participant::show_typed(ui, &trial, &mut acts);
        experiment.take_acts(acts, bench);
    }
}

/// How it stands with the masking noise that the design asks for.
fn show_noise(ui: &mut Ui, noise: &NoiseView, experiment: &mut Experiment, bench: &Bench) {
    section(ui, "Masking noise");
    match noise {
        NoiseView::Writing(share) => {
            ui.add(ProgressBar::new(*share).desired_height(4.0));
            note(ui, "The noise is being written", Tone::Quiet);
        }
        NoiseView::At(path) => {
            let words = "The design asks for it; this program does not play it. Let any player \
                         repeat this file on the participant's earphones, so loud that the device \
                         is not heard:";
            note(ui, words, Tone::Quiet);
            note(ui, path, Tone::Wrong);
        }
        NoiseView::Missing => {
            let words = "The design asks for one; this program does not play it, but writes it as \
                         a sound file for any player.";
            note(ui, words, Tone::Quiet);
            let has_folder = experiment.form.kept_folder().is_some();
            let refusal = (!has_folder).then_some("Say in which folder first");
            let tip = "Pink noise, 30 Hz to 6 kHz, ten minutes that repeat without a seam";
            if button(ui, "Write the noise", tip, refusal) {
                experiment.write_noise(bench);
                ui.ctx().request_repaint();
            }
        }
    }
}

/// Whether the participant sees anything in trials.
fn show_blank(ui: &mut Ui, is_blank: &mut bool) {
    let (words, tip) = if *is_blank {
        (
            "Show the screen",
            "The participant sees trials again and answers there",
        )
    } else {
        (
            "Blank screen",
            "The participant sees nothing in trials and says what is answered; you type it here",
        )
    };
    if button(ui, words, tip, None) {
        *is_blank = !*is_blank;
        ui.ctx().request_repaint();
    }
}

/// Where the participant's view is.
fn show_window(ui: &mut Ui, window: &mut ParticipantsWindow) {
    if !window.is_open {
        let tip = "The participant's view alone, to be dragged to a screen of its own";
        if button(ui, "Participant's window", tip, None) {
            window.is_open = true;
            ui.ctx().request_repaint();
        }
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let name = RichText::new("Participant's window").font(theme::small());
        ui.label(name.color(Palette::in_ui(ui).dim));
        let (words, tip) = if window.fills_screen {
            ("Make it smaller", "F11 in that window does the same")
        } else {
            (
                "Fill its screen",
                "Drag it to the participant's screen first; F11 in that window does the same",
            )
        };
        if button(ui, words, tip, None) {
            window.fills_screen = !window.fills_screen;
            ui.ctx().request_repaint();
        }
        let tip = "Show the participant's view in the workbench again; the session goes on";
        if button(ui, "Close it", tip, None) {
            *window = ParticipantsWindow::default();
            ui.ctx().request_repaint();
        }
    });
}
