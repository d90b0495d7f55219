//! The two views of a session; and what nobody may look at while one is held.

use std::mem;

use eframe::egui::{
    CentralPanel, Context, Frame, Key, Ui, ViewportBuilder, ViewportClass, ViewportId,
};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands};
use crate::kit::view_transform::{Pointed, PointerGround};
use crate::shell::desk::Desk;
use crate::shell::frame::frame_as_armed;
use crate::tools::experiment::command::{ExperimentCommand, WindowAct};
use crate::tools::experiment::experimenter::ExperimenterHands;
use crate::tools::experiment::view::{Link, ParticipantView};

/// The participant's window as it is opened, points.
const PARTICIPANTS_WINDOW: [f32; 2] = [1000.0, 860.0];
/// No smaller, points: what is answered with has room.
const LEAST_WINDOW: [f32; 2] = [700.0, 600.0];

impl Desk<'_> {
    pub(crate) fn show_participant(&mut self, ui: &mut Ui) {
        let now_s = ui.input(|input| input.time);
        let bench = &*self.context.bench;
        if bench.transient.experiment.window.is_open {
            return crate::tools::experiment::participant::show_apart(ui, self.context.commands);
        }
        let view = bench
            .transient
            .experiment
            .participant(&bench.transient.live, now_s);
        let shown = crate::tools::experiment::participant::show(ui, &view, self.context.commands);
        if shown.is_some() {
            *self.context.ground = shown;
        }
    }

    pub(crate) fn show_experimenter(&mut self, ui: &mut Ui) {
        let now_s = ui.input(|input| input.time);
        let transient = &mut self.context.bench.transient;
        let live = &transient.live;
        let link = Link::of(
            (live.bridge.as_ref(), transient.target.as_deref()),
            live.is_stopped,
            self.context.bench.engine.profile().limit_um,
        );
        let experiment = &mut transient.experiment;
        let screen = (experiment.window, experiment.is_blank);
        let noise = experiment.noise();
        let view = experiment.experimenter(link, now_s);
        // Taken out while it is typed in, since the trial is looked at meanwhile.
        let mut note = experiment
            .held
            .as_mut()
            .map(|held| mem::take(&mut held.note));
        let held = experiment.held.as_ref().filter(|_| experiment.is_blank);
        let typed = held.and_then(|held| held.typed(now_s));
        let mut hands = ExperimenterHands {
            note: note.as_mut(),
            form: &mut experiment.form,
            typed: typed.as_ref(),
        };
        crate::tools::experiment::experimenter::show(
            ui,
            (&view, noise.as_ref(), screen),
            &mut hands,
            self.context.commands,
        );
        if let Some((held, note)) = experiment.held.as_mut().zip(note) {
            held.note = note;
        }
    }
}

impl Bench {
    /// Shows the participant's view in a window of its own, while that is open; where the pointer
    /// feels there, if there is such a place.
    pub(crate) fn show_participants_window(
        &self,
        ctx: &Context,
        commands: &mut Commands,
    ) -> Option<PointerGround> {
        let window = self.transient.experiment.window;
        if !window.is_open {
            return None;
        }
        let live = &self.transient.live;
        let now_s = ctx.input(|input| input.time);
        let view = self.transient.experiment.participant(live, now_s);
        let builder = ViewportBuilder::default()
            .with_title("Selvedge – participant")
            .with_app_id("selvedge")
            .with_inner_size(PARTICIPANTS_WINDOW)
            .with_min_inner_size(LEAST_WINDOW)
            .with_fullscreen(window.fills_screen);
        let id = ViewportId::from_hash_of("participant");
        ctx.show_viewport_immediate(id, builder, |ui, class| {
            if class == ViewportClass::EmbeddedWindow {
                return crate::tools::experiment::participant::show(ui, &view, commands);
            }
            take_window_keys(ui.ctx(), window.fills_screen, commands);
            if live.is_armed() {
                frame_as_armed(ui.ctx());
            }
            let panel = CentralPanel::default().frame(Frame::new());
            let shown = panel.show(ui, |ui| match &view {
                ParticipantView::Nobody { is_coming } => {
                    crate::tools::experiment::participant::show_before(ui, *is_coming);
                    None
                }
                view => crate::tools::experiment::participant::show(ui, view, commands),
            });
            let window = Pointed::Participant;
            shown.inner.map(|ground| PointerGround { window, ..ground })
        })
    }
}

/// What the participant's window does besides showing its view: it closes, fills its screen by F11,
/// and Esc switches everything off as everywhere.
fn take_window_keys(ctx: &Context, fills_screen: bool, commands: &mut Commands) {
    let (is_closed, is_toggled, is_off) = ctx.input(|input| {
        (
            input.viewport().close_requested(),
            input.key_pressed(Key::F11),
            input.key_pressed(Key::Escape),
        )
    });
    let mut act = |act| commands.push(ExperimentCommand::Window(act).into());
    if is_closed {
        act(WindowAct::Close);
    } else if is_toggled {
        act(WindowAct::FillScreen(!fills_screen));
    }
    if is_off {
        commands.push(Command::AllOff);
    }
}
