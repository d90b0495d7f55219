//! A session as who holds it sees it: how far it is, the device, what to lay on the table, notes.
//! Never what is right.

pub(crate) mod begin;
pub(crate) mod session;

use eframe::egui::{DragValue, ProgressBar, RichText, Role, Ui, WidgetInfo};

use crate::bench::Bench;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::{button, section};
use crate::tools::experiment::noise::NoiseView;
use crate::tools::experiment::participant;
use crate::tools::experiment::played_noise::NOISE_DB;
use crate::tools::experiment::state::{Experiment, ParticipantsWindow};
use selvedge_engine::SoundState;
use selvedge_foundation::quantity;

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

/// The masking noise that the design asks for: played here, and as a file.
fn show_noise(ui: &mut Ui, noise: &NoiseView, experiment: &mut Experiment, bench: &Bench) {
    section(ui, "Masking noise");
    show_player(ui, experiment, bench);
    match noise {
        NoiseView::Writing(share) => {
            ui.add(ProgressBar::new(*share).desired_height(4.0));
            note(ui, "The noise is being written", Tone::Quiet);
        }
        NoiseView::At(path) => {
            let words = "As a file, to be repeated by any player:";
            note(ui, words, Tone::Quiet);
            note(ui, path, Tone::Quiet);
        }
        NoiseView::Missing => {
            let has_folder = experiment.form.kept_folder().is_some();
            let refusal = (!has_folder).then_some("Say in which folder first");
            let tip = "For any player: pink noise, 30 Hz to 6 kHz, ten minutes that repeat without \
                       a seam";
            if button(ui, "Write the noise", tip, refusal) {
                experiment.write_noise(bench);
                ui.ctx().request_repaint();
            }
        }
    }
}

/// Play, stop and how loud; whether it is heard.
fn show_player(ui: &mut Ui, experiment: &mut Experiment, bench: &Bench) {
    let (is_begun, state) = (experiment.played.is_begun(), experiment.played.state());
    ui.horizontal(|ui| {
        let (words, tip) = if is_begun {
            ("Stop the noise", "It fades within 50 ms")
        } else {
            let tip = "On what this computer plays sound on: the participant's earphones";
            ("Play the noise", tip)
        };
        let refusal = bench.is_stepped().then_some("Nothing is played here");
        if button(ui, words, tip, refusal) {
            if is_begun {
                experiment.played.stop();
            } else {
                experiment.play_noise(bench);
            }
            ui.ctx().request_repaint();
        }
        let [least, most] = NOISE_DB;
        let value = DragValue::new(&mut experiment.played.level_db)
            .range(least..=most)
            .speed(0.2)
            .custom_formatter(|level_db, _| quantity::fixed(level_db, 0))
            .suffix(" dB");
        let response = ui.add(value);
        response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, "Level of the noise"));
        response.on_hover_text("Rms re full scale; the system's own volume comes after it");
    });
    let words = match state {
        Some(SoundState::Absent(why)) => {
            let words = format!("Nothing is heard: {why}. It is tried again every 2 s.");
            return note(ui, &words, Tone::Wrong);
        }
        Some(SoundState::Playing { by, .. }) => {
            format!("Played by {by}, on through all trials; the note of every row says so.")
        }
        Some(SoundState::Opening) => "On its way".to_owned(),
        None => "The design asks for it: so loud that the device is not heard, found by ear with \
                 the device armed and no finger on it."
            .to_owned(),
    };
    note(ui, &words, Tone::Quiet);
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
