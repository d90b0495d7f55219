//! An experiment that is run in the window: one session, seen by participant and experimenter.
//!
//! ```text
//! form ─▶ materials, log ─▶ active session ─┬▶ participant's view: numbers of places alone
//!                               │  ▲        └▶ experimenter's view: progress and device
//!                 trial's scene ▼  └ marks, answers ─▶ row on disk ─▶ next trial
//!                            engine
//! ```
//!
//! # Invariants
//! - the document never learns of a session; when one ends, the user's scene is felt again
//! - the next trial begins only once the row of the last one is on disk
//! - what participants and experimenters see does not depend on what is right

pub(crate) mod active_session;
pub(crate) mod board;
pub(crate) mod builder;
pub(crate) mod draft;
pub(crate) mod experimenter;
pub(crate) mod form;
pub(crate) mod guide;
mod hanging;
pub(crate) mod held;
mod in_turn;
pub(crate) mod materials;
pub(crate) mod noise;
pub(crate) mod now;
pub(crate) mod participant;
pub(crate) mod played_noise;
pub(crate) mod presenting;
pub(crate) mod run_session;
pub(crate) mod sessions;
pub(crate) mod state;
#[cfg(test)]
mod tests;
pub(crate) mod view;
pub(crate) mod who;

pub(crate) use crate::tools::experiment::state::Experiment;

use std::path::PathBuf;

use eframe::egui::{CentralPanel, Context, Frame, Key, Ui, UiBuilder, ViewportClass, ViewportId};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands, FileCommand, Purpose};
use crate::bench::history::StepList;
use crate::bench::pane::Pane;
use crate::bench::recovery::Unsaved;
use crate::bench::settings::preferences::Preferences;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::own_window::own_window;
use crate::kit::pane::{frame_as_armed, scrolled};
use crate::kit::view_transform::{Pointed, PointerGround};
use crate::tools::experiment::builder::study_text::{Chosen, StudyText};
use crate::tools::experiment::state::ParticipantsWindow;
use crate::tools::experiment::view::ParticipantView;

/// The participant's window as it is opened, points.
const PARTICIPANTS_WINDOW: [f32; 2] = [1000.0, 860.0];
/// No smaller, points: what is answered with has room.
const MIN_WINDOW: [f32; 2] = [700.0, 600.0];

impl Experiment {
    fn show_participant(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        if self.window.is_open {
            return participant::show_apart(ui, &mut self.window);
        }
        let now_s = ui.input(|input| input.time);
        let mut acts = Vec::new();
        let view = self.participant(&context.bench.live, now_s);
        let shown = participant::show(ui, &view, &mut acts);
        show_hung(ui, shown.as_ref(), context);
        if shown.is_some() {
            *context.ground = shown;
        }
        self.take_acts(acts, context.bench);
    }

    /// The participant's view in a window of its own; where the pointer feels there, if there is
    /// such a place.
    fn show_window(
        &mut self,
        ctx: &Context,
        context: &mut PaneContext<'_>,
    ) -> Option<PointerGround> {
        let (mut window, mut acts) = (self.window, Vec::new());
        let live = &context.bench.live;
        let (view, is_armed) = (
            self.participant(live, ctx.input(|input| input.time)),
            live.is_armed(),
        );
        let builder = own_window("Selvedge – participant")
            .with_inner_size(PARTICIPANTS_WINDOW)
            .with_min_inner_size(MIN_WINDOW)
            .with_fullscreen(window.fills_screen);
        let id = ViewportId::from_hash_of("participant");
        let shown = ctx.show_viewport_immediate(id, builder, |ui, class| {
            let mut show = |ui: &mut Ui, context: &mut PaneContext<'_>| {
                let shown = participant::show(ui, &view, &mut acts);
                show_hung(ui, shown.as_ref(), context);
                shown
            };
            if class == ViewportClass::EmbeddedWindow {
                return show(ui, context);
            }
            take_window_keys(ui.ctx(), &mut window, context.commands);
            if is_armed {
                frame_as_armed(ui.ctx());
            }
            let panel = CentralPanel::default().frame(Frame::new());
            let shown = panel.show(ui, |ui| match &view {
                ParticipantView::Nobody { is_coming } => {
                    participant::show_before(ui, *is_coming);
                    None
                }
                _ => show(ui, context),
            });
            let window = Pointed::Participant;
            shown.inner.map(|ground| PointerGround { window, ..ground })
        });
        if self.window != window {
            self.window = window;
            ctx.request_repaint();
        }
        self.take_acts(acts, context.bench);
        shown
    }
}

impl Tool for Experiment {
    fn panes(&self) -> &'static [Pane] {
        &[
            Pane::Participant,
            Pane::Builder,
            Pane::Board,
            Pane::Experimenter,
        ]
    }

    fn begin(&mut self, bench: &mut Bench) {
        let preferences = &bench.settings.preferences;
        let (folder, design) = (&preferences.folders.sessions, &preferences.folders.design);
        self.form.take_up(folder.as_deref(), design.as_deref());
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.poll(bench);
        self.poll_builder(bench);
    }

    fn ui(&mut self, pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        match pane {
            Pane::Participant => self.show_participant(ui, context),
            Pane::Builder => builder::show(ui, self, context),
            Pane::Board => scrolled(ui, pane.title(), |ui| board::show(ui, self, context)),
            _ => scrolled(ui, pane.title(), |ui| experimenter::show(ui, self, context)),
        }
    }

    fn steps(&self, _bench: &Bench) -> Option<StepList> {
        Some(self.form.study.steps())
    }

    fn step_to(&mut self, n_done: usize, _bench: &mut Bench) {
        self.form.study.step_to(n_done);
    }

    fn unsaved(&self) -> Option<Unsaved> {
        self.form.study.unsaved()
    }

    fn restore(&mut self, unsaved: &Unsaved, _bench: &mut Bench) -> Result<(), String> {
        self.form.study = StudyText::restored(unsaved.read()?);
        Ok(())
    }

    fn windows(&mut self, ctx: &Context, context: &mut PaneContext<'_>) {
        if self.window.is_open {
            *context.ground = self.show_window(ctx, context);
        }
        context.bench.session.has_window = self.window.is_open;
    }

    fn command(&mut self, command: &Command, _bench: &mut Bench) {
        match command {
            Command::File(FileCommand::Use(Purpose::OpenDesign, path)) => {
                self.form.choose(Chosen::File(path.clone()));
            }
            Command::File(FileCommand::Use(Purpose::SaveDesign, path)) => {
                self.builder.saved(self.form.study.save(path));
            }
            _ => {}
        }
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        let is_ours = matches!(purpose, Purpose::OpenDesign | Purpose::SaveDesign);
        match self.form.study.chosen() {
            Chosen::File(path) if is_ours => Some(path.clone()),
            _ => None,
        }
    }

    fn keep_preferences(&self, preferences: &mut Preferences) {
        preferences.folders.sessions = self.form.kept_folder();
        preferences.folders.design = self.form.study.chosen().word();
    }
}

/// Shows the cloth that a session hangs, where the participant's view leaves room for what lies.
fn show_hung(ui: &mut Ui, shown: Option<&PointerGround>, context: &mut PaneContext<'_>) {
    let Some(shown) = shown else { return };
    let Some((at, mut tool)) = context.guest.take() else {
        return;
    };
    let mut ui = ui.new_child(UiBuilder::new().max_rect(shown.rect));
    tool.ui(Pane::Drape, &mut ui, context);
    *context.guest = Some((at, tool));
}

/// What the participant's window does besides showing its view: it closes, fills its screen by F11,
/// and Esc does what it does everywhere.
fn take_window_keys(ctx: &Context, window: &mut ParticipantsWindow, commands: &mut Commands) {
    let (is_closed, is_toggled, is_off) = ctx.input(|input| {
        (
            input.viewport().close_requested(),
            input.key_pressed(Key::F11),
            input.key_pressed(Key::Escape),
        )
    });
    if is_closed {
        *window = ParticipantsWindow::default();
    } else if is_toggled {
        window.fills_screen = !window.fills_screen;
    }
    if is_off {
        commands.push(Command::Escape);
    }
}
