//! A session as who holds it sees it: how far it is, the device, what to lay on the table, notes.
//! Never what is right.

pub(crate) mod begin;
pub(crate) mod session;

use eframe::egui::{ProgressBar, RichText, Ui};

use crate::bench::command::Commands;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::{button, section};
use crate::tools::experiment::ParticipantsWindow;
use crate::tools::experiment::command::{ExperimentCommand, WindowAct};
use crate::tools::experiment::form::Form;
use crate::tools::experiment::noise::NoiseView;
use crate::tools::experiment::view::{ExperimenterView, TrialView};

/// What is typed in the pane.
pub(crate) struct ExperimenterHands<'a> {
    /// The form of the next session.
    pub form: &'a mut Form,
    /// The note on the trial under way.
    pub note: Option<&'a mut String>,
    /// The trial whose answer is typed here, while the participant sees nothing.
    pub typed: Option<&'a TrialView<'a>>,
}

/// Whether the participant's view is in a window of its own, and whether it is blank in trials.
pub(crate) type Screen = (ParticipantsWindow, bool);

/// Shows the pane.
pub(crate) fn show(
    ui: &mut Ui,
    (view, noise, (window, is_blank)): (&ExperimenterView, Option<&NoiseView>, Screen),
    hands: &mut ExperimenterHands<'_>,
    commands: &mut Commands,
) {
    ui.spacing_mut().item_spacing.y = STEP;
    show_window(ui, window, commands);
    show_blank(ui, is_blank, commands);
    if let Some(trial) = hands.typed {
        section(ui, "Answer, typed for the participant");
        crate::tools::experiment::participant::show_typed(ui, trial, commands);
    }
    match view {
        ExperimenterView::Nobody { share } => begin::show(ui, hands.form, *share, commands),
        ExperimenterView::Held(held) => {
            session::show(ui, held, hands.note.as_deref_mut(), commands);
        }
    }
    if let Some(noise) = noise {
        let has_folder = hands.form.kept_folder().is_some();
        show_noise(ui, noise, has_folder, commands);
    }
}

/// How it stands with the masking noise that the design asks for.
fn show_noise(ui: &mut Ui, noise: &NoiseView, has_folder: bool, commands: &mut Commands) {
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
            let refusal = (!has_folder).then_some("Say in which folder first");
            let tip = "Pink noise, 30 Hz to 6 kHz, ten minutes that repeat without a seam";
            if button(ui, "Write the noise", tip, refusal) {
                commands.push(ExperimentCommand::Noise.into());
            }
        }
    }
}

/// Whether the participant sees anything in trials.
fn show_blank(ui: &mut Ui, is_blank: bool, commands: &mut Commands) {
    let (words, tip) = if is_blank {
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
        commands.push(ExperimentCommand::Blank(!is_blank).into());
    }
}

/// Where the participant's view is.
fn show_window(ui: &mut Ui, window: ParticipantsWindow, commands: &mut Commands) {
    let mut act = |act| commands.push(ExperimentCommand::Window(act).into());
    if !window.is_open {
        let tip = "The participant's view alone, to be dragged to a screen of its own";
        if button(ui, "Participant's window", tip, None) {
            act(WindowAct::Open);
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
            act(WindowAct::FillScreen(!window.fills_screen));
        }
        let tip = "Show the participant's view in the workbench again; the session goes on";
        if button(ui, "Close it", tip, None) {
            act(WindowAct::Close);
        }
    });
}

/// What stands in the place of a pane that would tell too much.
pub(crate) fn show_veil(ui: &mut Ui) {
    let words = "Hidden while a session is held: what lies under the finger is not to be seen.";
    let ink = Palette::in_ui(ui).dim;
    ui.add_space(2.0 * STEP);
    ui.add(eframe::egui::Label::new(RichText::new(words).color(ink)).wrap());
}
