//! The controls of the bar: record, play, step, rewind, loop; the source.

use eframe::egui::{Ui, vec2};

use crate::bench::command::{Command, Commands, PlayCommand, PlaySource};
use crate::bench::keys::hint;
use crate::kit::theme::STEP;
use crate::tools::timeline::icons::{Act, Icon, icon_button, segments};
use crate::tools::timeline::transport::TransportView;

/// Why there is nothing to step through.
const LIVE: &str = "The pointer cannot be stepped or rewound: choose By itself or Recording";

/// Shows the controls.
pub(crate) fn show(ui: &mut Ui, view: &TransportView<'_>, commands: &mut Commands) {
    ui.spacing_mut().item_spacing = vec2(STEP, 2.0 * STEP);
    ui.add_space(STEP);
    ui.horizontal(|ui| show_buttons(ui, view, commands));
    show_sources(ui, view, commands);
}

fn show_buttons(ui: &mut Ui, view: &TransportView<'_>, commands: &mut Commands) {
    let is_recording = view.recorded_ticks.is_some();
    let icon = Icon::Record {
        is_on: is_recording,
    };
    let (label, what) = if is_recording {
        ("End recording", "End the recording: it is in the list")
    } else {
        (
            "Record",
            "Record the exploration, whatever moves the display",
        )
    };
    let act = Act::new(icon, label, what, None);
    act.show(
        ui,
        PlayCommand::ToggleRecording,
        Some(is_recording),
        commands,
    );
    let act = play_act(view);
    act.show(ui, PlayCommand::Toggle, None, commands);
    let refusal = view.is_live().then_some(LIVE);
    let act = Act::new(Icon::Step, "Step", "Play one tick, then hold", refusal);
    act.show(ui, PlayCommand::Step, None, commands);
    let act = Act::new(Icon::Rewind, "Rewind", "Back to the first tick", refusal);
    act.show(ui, PlayCommand::Rewind, None, commands);
    let what = if view.does_loop {
        "Stop at the end instead of beginning again"
    } else {
        "Begin again at the end"
    };
    let refusal = refusal.map(|_| "The pointer has no end: choose By itself or Recording");
    let act = Act::new(Icon::Loop, "Loop", what, refusal);
    let toggled = PlayCommand::Loop(!view.does_loop);
    act.show(ui, toggled, Some(view.does_loop), commands);
}

fn play_act(view: &TransportView<'_>) -> Act {
    if view.is_running() {
        let what = "Hold: silent, the screen keeps what it showed";
        return Act::new(Icon::Pause, "Pause", what, None);
    }
    let what = match view.source {
        PlaySource::Pointer | PlaySource::Input => "Let the display explore by itself",
        PlaySource::Stroke => "Go on exploring",
        PlaySource::Recording => "Replay the recording",
    };
    Act::new(Icon::Play, "Play", what, None)
}

fn show_sources(ui: &mut Ui, view: &TransportView<'_>, commands: &mut Commands) {
    let none = view
        .take
        .is_none()
        .then_some("There is no recording at hand: record one, or choose one in the list");
    let replay = view.take.map(|take| format!("Replay {}", take.name()));
    let pointer = "The display follows the pointer".to_owned();
    let stroke = "The display explores by itself, in a circle".to_owned();
    let input = view.input.unwrap_or_default();
    let input = format!("The display follows {input}");
    let unchosen = view
        .input
        .is_none()
        .then_some("Choose a tablet or program in the Bridge pane");
    let parts = [
        ("Pointer", pointer, None),
        ("By itself", stroke, None),
        ("Recording", replay.unwrap_or_default(), none),
        ("Input", input, unchosen),
    ];
    let sources = [
        PlaySource::Pointer,
        PlaySource::Stroke,
        PlaySource::Recording,
        PlaySource::Input,
    ];
    let chosen = sources.iter().position(|source| *source == view.source);
    if let Some(index) = segments(ui, ui.available_width(), &parts, chosen.unwrap_or(0)) {
        commands.push(PlayCommand::Source(sources[index]).into());
    }
}

impl Act {
    fn new(
        icon: Icon,
        label: &'static str,
        what: &'static str,
        refusal: Option<&'static str>,
    ) -> Self {
        Self {
            icon,
            label,
            what,
            refusal,
        }
    }

    /// Shows it; gives the command when it is pressed.
    fn show(self, ui: &mut Ui, command: PlayCommand, is_on: Option<bool>, commands: &mut Commands) {
        let command: Command = command.into();
        let tip = tip(ui, self.what, &command);
        if icon_button(ui, self, &tip, is_on) {
            commands.push(command);
        }
    }
}

/// What it does, and its key if it has one.
fn tip(ui: &Ui, what: &str, command: &Command) -> String {
    let key = hint(ui.ctx(), command);
    if key.is_empty() {
        what.to_owned()
    } else {
        format!("{what} ({key})")
    }
}
