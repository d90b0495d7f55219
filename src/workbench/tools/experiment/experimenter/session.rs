//! The session that is active.

use eframe::egui::{ProgressBar, RichText, Ui};

use crate::bench::Bench;
use crate::bench::command::Commands;
use crate::bench::command::device::DeviceCommand;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Need, Tone, note, row_of, text};
use crate::kit::widgets::text::{button, mark, quiet_pair, section};
use crate::tools::experiment::now::Pause;
use crate::tools::experiment::presenting::ArrayNow;
use crate::tools::experiment::state::{Asked, Experiment};
use crate::tools::experiment::view::{Course, Link, SessionView};
use selvedge_foundation::quantity;

pub(crate) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    let bench = &context.bench;
    let (device, now_s) = (
        (Link::of(bench), ArrayNow::of(bench)),
        ui.input(|input| input.time),
    );
    let session = experiment.session.as_ref();
    let Some(view) = session.map(|session| session.view(device, now_s)) else {
        return;
    };
    let palette = Palette::in_ui(ui);
    ui.label(
        RichText::new(&view.title)
            .font(theme::title())
            .color(palette.text),
    );
    note(ui, &view.subject, Tone::Quiet);
    show_progress(ui, &view);
    if let Some(line) = &view.failure {
        show_failure(ui, line, experiment, context.bench);
    }
    show_presentation(ui, &view, experiment);
    show_table(ui, &view);
    show_step(ui, &view, experiment, context.bench);
    if let Some(session) = &mut experiment.session {
        row_of(ui, 44.0, ("note", ""), |ui, label| {
            let about = ("on this trial", f32::INFINITY, Need::Optional);
            text(ui, label, &mut session.note, about);
        });
    }
    show_link(ui, &view.link, context.commands);
    show_end(ui, &view, experiment, context.bench);
}

fn show_progress(ui: &mut Ui, view: &SessionView) {
    let (done, all) = view.progress;
    #[expect(clippy::cast_precision_loss, reason = "some hundred trials")]
    let share = done as f32 / all.max(1) as f32;
    ui.add_space(STEP);
    ui.add(ProgressBar::new(share).desired_height(4.0));
    quiet_pair(ui, "answered", &format!("{done} of {all}"), "trials");
    let step = match view.course {
        Course::Instructions => "instructions",
        Course::Familiarisation => "familiarisation",
        Course::Trial => &view.place,
        Course::Break => "break",
        Course::Paused => "paused",
        Course::Finished => "finished",
    };
    let state = if view.is_writing { "writing" } else { "" };
    quiet_pair(ui, "now", step, state);
    quiet_pair(
        ui,
        "for",
        &crate::tools::experiment::participant::clock(view.lasted_s),
        "min:s",
    );
    if view.left_s > 0.0 {
        quiet_pair(
            ui,
            "left",
            &crate::tools::experiment::participant::clock(view.left_s),
            "min:s",
        );
    }
    if let Some(last_s) = view.last_response_s {
        quiet_pair(ui, "last answer after", &quantity::fixed(last_s, 1), "s");
    }
    if view.course == Course::Trial {
        let answered = if view.answered.is_empty() {
            "–"
        } else {
            &view.answered
        };
        quiet_pair(ui, "answered so far", answered, "");
    }
}

fn show_failure(ui: &mut Ui, line: &str, experiment: &mut Experiment, bench: &Bench) {
    ui.add_space(STEP);
    note(ui, &format!("Not on disk yet: {line}"), Tone::Wrong);
    let tip = "The answer is kept until it is on disk";
    if button(ui, "Write it again", tip, None) {
        experiment.retry(bench);
        ui.ctx().request_repaint();
    }
}

/// What the trial waits for, and why the last presentation did not count.
fn show_presentation(ui: &mut Ui, view: &SessionView, experiment: &mut Experiment) {
    if let Some(line) = &view.trouble {
        note(ui, line, Tone::Wrong);
    }
    let Some(waits_for) = view.waits_for else {
        return;
    };
    note(
        ui,
        &format!("The trial has not begun: {waits_for}"),
        Tone::Wrong,
    );
    let tip = "The trial begins, and its time with it";
    if view.awaits_cloth
        && button(ui, "The cloth lies there", tip, None)
        && let Some(session) = &mut experiment.session
    {
        session.lay();
        ui.ctx().request_repaint();
    }
}

fn show_table(ui: &mut Ui, view: &SessionView) {
    if view.table.is_empty() {
        return;
    }
    section(ui, "On the table");
    for (position, cloth) in &view.table {
        let place = position.map_or_else(|| "to compare with".to_owned(), |at| at.to_string());
        quiet_pair(ui, &place, cloth, "");
    }
}

fn show_step(ui: &mut Ui, view: &SessionView, experiment: &mut Experiment, bench: &mut Bench) {
    section(ui, "Course");
    ui.horizontal_wrapped(|ui| {
        let is_trial = view.course == Course::Trial;
        let waits = "The row is being written";
        let writing = view.is_writing.then_some(waits);
        let other = if is_trial {
            Some("The trial waits for its answer")
        } else {
            None
        };
        let rests = matches!(view.course, Course::Paused | Course::Finished);
        let pass = other.or_else(|| rests.then_some("Nothing to go on from"));
        if button(ui, "Go on", "Go on for the participant, at once", pass) {
            experiment.pass(bench);
            ui.ctx().request_repaint();
        }
        let pause = match view.pause {
            Pause::None => ("Pause", "Before the next trial", true),
            Pause::Wanted => ("Do not pause", "The pause comes after this trial", false),
            Pause::On => ("End the pause", "Go on with the next trial", false),
        };
        let (words, tip, is_wanted) = pause;
        let finished = (view.course == Course::Finished).then_some("The session is over");
        if button(ui, words, tip, finished) {
            experiment.pause(is_wanted, bench);
            ui.ctx().request_repaint();
        }
        let tip = "Give this trial up: a row says so, and it comes again";
        let is_under_way = is_trial && view.waits_for.is_none();
        let abort = writing.or_else(|| (!is_under_way).then_some("No trial is under way"));
        if button(ui, "Abort the trial", tip, abort) {
            experiment.end_trial(None, bench);
            ui.ctx().request_repaint();
        }
    });
}

fn show_link(ui: &mut Ui, link: &Link, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    section(ui, "Device");
    ui.horizontal(|ui| {
        let lamp = if link.is_armed {
            palette.danger
        } else {
            palette.line
        };
        mark(ui, lamp, link.state);
        ui.label(&link.name);
        ui.label(RichText::new(link.state).color(palette.dim));
    });
    for (name, limit_um) in ["40 Hz at most", "320 Hz at most"]
        .into_iter()
        .zip(link.limit_um)
    {
        quiet_pair(ui, name, &quantity::fixed(limit_um, 1), "µm");
    }
    if link.is_stopped {
        note(ui, "Everything is off: nothing is felt", Tone::Wrong);
    }
    if link.is_armed {
        if button(ui, "Disarm", "Ramp the device to silence", None) {
            commands.push(DeviceCommand::Disarm.into());
        }
    } else {
        let refusal = (link.state == "not connected").then_some("Connect it in the Bridge pane");
        if link.is_stopped && refusal.is_some() {
            let tip = "End the silence of all off; no device is connected";
            if button(ui, "Go on without a device", tip, None) {
                commands.push(DeviceCommand::GoOn.into());
            }
        } else if button(ui, "Arm", "Turn the high voltage on", refusal) {
            commands.push(DeviceCommand::Arm.into());
        }
    }
}

fn show_end(ui: &mut Ui, view: &SessionView, experiment: &mut Experiment, bench: &mut Bench) {
    section(ui, "Session");
    note(ui, &view.log, Tone::Quiet);
    let is_stuck = view.failure.is_some();
    let waits = (view.is_writing && !is_stuck).then_some("The row is being written");
    let (done, all) = view.progress;
    if experiment.asked == Some(Asked::End) {
        let what = if done >= all {
            format!("All {all} trials are on disk: the log is closed.")
        } else {
            format!("{done} of {all} trials are on disk; the log stays open and can be resumed.")
        };
        note(ui, &what, Tone::Quiet);
        ui.horizontal_wrapped(|ui| {
            if button(ui, "Go on with it", "The session goes on", None) {
                experiment.asked = None;
            }
            if button(ui, "End it now", "The user's scene is felt again", waits) {
                experiment.end(bench);
            }
        });
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let tip = "Say how far it is, then end it; what is answered is on disk";
        if button(ui, "End the session…", tip, waits) {
            experiment.asked = Some(Asked::End);
        }
        let tip = "It was begun by mistake: its files go, and a line in undone-sessions.csv stays";
        if done == 0 && button(ui, "Take the beginning back", tip, waits) {
            experiment.undo_beginning(bench);
        }
    });
}
