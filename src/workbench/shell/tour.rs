//! The first tour: five steps in a line below the header, each over once it was done. It covers
//! nothing, and is shown by itself to somebody who starts the program for the first time.

use eframe::egui::{Align, Frame, Label, Layout, Margin, Panel, RichText, Ui};

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::keys::hint;
use crate::bench::pane::Pane;
use crate::bench::view::Source;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{button, quiet};
use crate::shell::state::{Begun, Cover, Shell, Tour};

/// A contactor that moves less than this does nothing yet, µm.
const FELT_UM: f64 = 0.1;

/// A step of the tour.
struct Step {
    /// The pane that it speaks of: brought into sight and framed.
    pane: Pane,
    /// What to do there; what stands in braces is the key of an act.
    words: &'static str,
    /// Whether it was done since it began.
    is_done: fn(&Tour, &Bench, &Shell) -> bool,
}

const STEPS: [Step; 5] = [
    Step {
        pane: Pane::Workspace,
        words: "Move the pointer over a cloth. The 24 green dots are the contactors under a \
                fingertip; they feel where they are and how fast they move.",
        is_done: |_, bench, _| {
            let is_felt =
                |dot: &crate::bench::view::Dot| dot.amplitude_um.into_iter().any(|um| um > FELT_UM);
            bench.live.play.source == Source::Pointer && bench.live.dots.iter().any(is_felt)
        },
    },
    Step {
        pane: Pane::Heatmaps,
        words: "Every contactor vibrates at 40 Hz (amber, deep) and at 320 Hz (cyan, fine). Click \
                one in Contactors: every view follows it, and Why tells where its amplitude comes \
                from.",
        is_done: |tour, bench, _| bench.selection.contactor != tour.begun.contactor,
    },
    Step {
        pane: Pane::Tuning,
        words: "Drag 40 Hz, 320 Hz or Compression in Tuning and feel the cloth again. {undo} \
                takes it back.",
        is_done: |tour, bench, _| bench.document.steps().n_done > tour.begun.n_done,
    },
    Step {
        pane: Pane::Bridge,
        words: "No finger feels anything before you arm. Press Arm: an emulator stands in for the \
                device. Then Esc: it switches everything off, whatever is open.",
        is_done: |tour, bench, _| tour.was_armed && bench.live.is_stopped,
    },
    Step {
        pane: Pane::Library,
        words: "{palette} finds every act, textile and recording, {keys} lists the keys, and \
                {about} explains the pane in use. Try {palette}.",
        is_done: |_, _, shell| matches!(shell.cover, Some(Cover::Palette(_))),
    },
];

impl Tour {
    /// The pane that is spoken of.
    pub(crate) fn pane(self) -> Pane {
        STEPS[self.step].pane
    }
}

/// Begins the tour at its first step.
pub(crate) fn begin(bench: &mut Bench, shell: &mut Shell) {
    shell.uncover();
    enter(0, bench, shell);
}

/// Goes on when the step was done; the tour waits while a session is held.
pub(crate) fn follow(bench: &mut Bench, shell: &mut Shell) {
    let Some(mut tour) = shell.tour.filter(|_| !bench.has_session()) else {
        return;
    };
    tour.was_armed |= bench.live.is_armed();
    shell.tour = Some(tour);
    if (STEPS[tour.step].is_done)(&tour, bench, shell) {
        enter(tour.step + 1, bench, shell);
    }
}

/// Enters a step, or ends the tour after the last.
fn enter(step: usize, bench: &mut Bench, shell: &mut Shell) {
    shell.tour = STEPS.get(step).map(|_| Tour {
        step,
        begun: Begun {
            contactor: bench.selection.contactor,
            n_done: bench.document.steps().n_done,
        },
        was_armed: false,
    });
    let reveal = shell
        .tour
        .map(|tour| ShowCommand::Reveal(tour.pane()).into());
    bench.commands.extend(reveal);
    bench.ctx.request_repaint();
}

/// Shows the step below the header.
pub(crate) fn show(bench: &mut Bench, shell: &mut Shell, ui: &mut Ui) {
    let Some(tour) = shell.tour.filter(|_| !bench.has_session()) else {
        return;
    };
    let palette = Palette::in_ui(ui);
    let frame = Frame::new().fill(palette.raised);
    let frame = frame.inner_margin(Margin::symmetric(16, 6));
    let mut next = None;
    Panel::top("tour").frame(frame).show(ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let is_last = tour.step + 1 == STEPS.len();
            let (skip, on) = ("Skip the tour", if is_last { "Done" } else { "Next" });
            if button(ui, skip, "Help › Take the tour shows it again", None) {
                next = Some(STEPS.len());
            }
            if button(ui, on, "", None) {
                next = Some(tour.step + 1);
            }
            ui.label(quiet(format!("{} of {}", tour.step + 1, STEPS.len())));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let text = RichText::new(words(ui, tour.step)).color(palette.text);
                ui.add(Label::new(text).wrap());
            });
        });
    });
    if let Some(step) = next {
        enter(step, bench, shell);
    }
}

/// The words of a step with the keys that are in force.
fn words(ui: &Ui, step: usize) -> String {
    let keys = [
        ("{undo}", crate::bench::command::Command::Undo),
        ("{palette}", ShowCommand::Palette.into()),
        ("{keys}", ShowCommand::Help.into()),
        ("{about}", ShowCommand::About.into()),
    ];
    keys.into_iter()
        .fold(STEPS[step].words.to_owned(), |words, (place, command)| {
            words.replace(place, &hint(ui.ctx(), &command))
        })
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, Key, Modifiers, pos2};

    use super::*;
    use crate::bench::command::{Command, DeviceCommand};
    use crate::shell::headless::Headless;

    fn step(window: &Headless) -> Option<usize> {
        window.workbench.shell.tour.map(|tour| tour.step)
    }

    #[test]
    fn each_step_is_over_when_it_was_done_and_no_sooner() {
        let mut window = Headless::drawn();
        assert_eq!(step(&window), None, "nobody asked for it");
        window.dispatch(ShowCommand::Tour);
        window.pass(20);
        assert_eq!(step(&window), Some(0));
        let ground = window.workbench.bench.pointer.ground.unwrap();
        for i in 0..40_u8 {
            let x = ground.center().x + 3.0 * f32::from(i % 20);
            let at = pos2(x, ground.center().y - 0.2 * ground.height());
            window.events.push(Event::PointerMoved(at));
            window.pass(1);
        }
        assert_eq!(step(&window), Some(1), "the cloth was felt");
        window.dispatch(ShowCommand::SelectContactor(7));
        window.pass(2);
        assert_eq!(step(&window), Some(2));
        window.pass(5);
        let turn = crate::bench::command::edit::Edit::MasterGain(-3.0);
        window.dispatch(Command::Edit(turn));
        window.pass(2);
        assert_eq!(step(&window), Some(3));
        window.dispatch(DeviceCommand::ConnectEmulator);
        window.pass(40);
        window.dispatch(DeviceCommand::Arm);
        window.pass(40);
        assert!(window.workbench.bench.live.is_armed());
        assert_eq!(step(&window), Some(3), "armed, and not yet off");
        window.press(Modifiers::NONE, Key::Escape);
        window.pass(10);
        assert_eq!(step(&window), Some(4));
        window.press(Modifiers::COMMAND, Key::K);
        assert_eq!(step(&window), None);
    }

    #[test]
    fn every_step_shows_its_pane_and_names_keys_that_there_are() {
        let mut window = Headless::drawn();
        window.dispatch(ShowCommand::Tour);
        for (n, step) in STEPS.iter().enumerate() {
            let workbench = &mut window.workbench;
            enter(n, &mut workbench.bench, &mut workbench.shell);
            window.pass(2);
            assert!(window.workbench.shell.shows(step.pane));
        }
        let ctx = window.ctx.clone();
        ctx.run_ui(eframe::egui::RawInput::default(), |ui| {
            for n in 0..STEPS.len() {
                let words = words(ui, n);
                assert!(!words.contains('{') && !words.contains("  "), "{words}");
            }
        })
        .drop_without_applying_deltas();
    }
}
