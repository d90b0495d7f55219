//! The form that a session begins with, and the sessions that can be resumed.

use eframe::egui::{ProgressBar, RichText, Ui, vec2};

use crate::bench::Bench;
use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::bench::session::title_of;
use crate::bench::tool::PaneContext;
use crate::kit::theme::{ROW, STEP};
use crate::kit::widgets::fields::{Need, Tone, choose, note, row_of, text};
use crate::kit::widgets::text::{button, choice, section};
use crate::tools::experiment::form::{Chosen, Form, Row};
use crate::tools::experiment::sessions::device_name;
use crate::tools::experiment::state::{Asked, Experiment};
use crate::tools::experiment::who::Who;
use selvedge_experiment::design::Design;
use selvedge_experiment::{HANDS, Preview, SEXES};

/// What stands where nothing was told.
const NOT_TOLD: &str = "not told";
/// As wide as there is room for.
const WIDE: f32 = f32::INFINITY;
/// Width of a row's name, points.
const NAME: f32 = 84.0;

pub(crate) fn show(ui: &mut Ui, experiment: &mut Experiment, context: &mut PaneContext<'_>) {
    if experiment.asked == Some(Asked::Begin) && experiment.beginning.is_none() {
        return show_asked(ui, experiment, context.bench);
    }
    let form = &mut experiment.form;
    section(ui, "New session");
    row_of(ui, NAME, ("design", ""), |ui, _| {
        show_designs(ui, form, context.commands);
    });
    if let Ok(design) = &form.design {
        note(ui, &about(design), Tone::Quiet);
    }
    if let Some(preview) = form.preview() {
        show_preview(ui, preview);
    }
    field(ui, "folder", &mut form.folder, ("/path/to/study", WIDE));
    field(ui, "session", &mut form.session, ("1", 64.0));
    show_who(ui, &mut form.who);
    let refusal = form.refusal();
    ui.add_space(STEP);
    if let Some(task) = &experiment.beginning {
        let bar = ProgressBar::new(task.share()).desired_height(4.0);
        ui.add(bar);
        note(ui, "The textiles are being prepared", Tone::Quiet);
    } else {
        show_begin(ui, experiment, context.bench);
    }
    if let Some(line) = &experiment.form.failure {
        note(ui, line, Tone::Wrong);
    } else if let Some(line) = refusal {
        note(ui, &line, Tone::Quiet);
    }
    show_found(ui, experiment, context.bench);
}

/// What will be written, before it is.
fn show_asked(ui: &mut Ui, experiment: &mut Experiment, bench: &Bench) {
    let Some(plan) = experiment.form.plan() else {
        experiment.asked = None;
        return;
    };
    section(ui, "Begin this session?");
    for line in plan.describe(&device_name(bench)) {
        note(ui, &line, Tone::Quiet);
    }
    if bench.device.faults.is_some() {
        let words = "The device is an emulator: its rows will say that nobody felt anything.";
        note(ui, words, Tone::Wrong);
    }
    ui.add_space(STEP);
    ui.horizontal_wrapped(|ui| {
        if button(
            ui,
            "Begin now",
            "Open the log, and show the first page",
            None,
        ) {
            experiment.begin_session(bench);
        }
        if button(ui, "Not yet", "Nothing is written", None) {
            experiment.asked = None;
        }
    });
}

/// The buttons that begin: a session, once it was said what will be written, and a pilot.
fn show_begin(ui: &mut Ui, experiment: &mut Experiment, bench: &Bench) {
    let refusal = experiment.form.refusal();
    ui.horizontal_wrapped(|ui| {
        let tip = "Show what will be written, then begin";
        if button(ui, "Begin the session…", tip, refusal.as_deref()) {
            experiment.asked = Some(Asked::Begin);
        }
        let tip = "Try what is asked on the screen alone: nobody feels it, and its log lies in the \
                   folder pilots";
        let refusal = experiment.form.pilot_refusal();
        if button(ui, "Pilot", tip, refusal.as_deref()) {
            experiment.begin_pilot(bench);
        }
    });
}

/// A field with its name.
fn field(ui: &mut Ui, name: &str, typed: &mut String, (hint, width): (&str, f32)) {
    row_of(ui, NAME, (name, ""), |ui, label| {
        text(ui, label, typed, (hint, width, Need::Optional));
    });
}

/// Who takes part: a pseudonym, and what else is told.
fn show_who(ui: &mut Ui, who: &mut Who) {
    section(ui, "Participant");
    field(ui, "pseudonym", &mut who.pseudonym, ("p01", WIDE));
    if who.is_known() {
        let words = "Took part before: what was told is filled in";
        note(ui, words, Tone::Quiet);
    }
    field(ui, "age, years", &mut who.age, ("not told", 84.0));
    one_of(ui, "sex", &mut who.sex, &SEXES);
    one_of(ui, "handedness", &mut who.handedness, &HANDS);
    field(
        ui,
        "experience",
        &mut who.experience,
        ("naive, practised", WIDE),
    );
    field(ui, "room", &mut who.room, ("one word", WIDE));
}

/// One of some words, or none.
fn one_of(ui: &mut Ui, name: &str, chosen: &mut String, words: &[&str]) {
    row_of(ui, NAME, (name, ""), |ui, _| {
        let now = if chosen.is_empty() {
            NOT_TOLD
        } else {
            chosen.as_str()
        };
        let now = now.to_owned();
        choose(ui, name, (&now, 132.0, Need::Optional), |ui| {
            ui.selectable_value(chosen, String::new(), NOT_TOLD);
            for word in words {
                ui.selectable_value(chosen, (*word).to_owned(), *word);
            }
        });
    });
}

fn show_designs(ui: &mut Ui, form: &mut Form, commands: &mut Commands) {
    let now = match (&form.design, &form.chosen) {
        (Ok(design), _) => title_of(design),
        (Err(_), Chosen::File(path)) => path.display().to_string(),
        (Err(_), Chosen::Shipped(name)) => (*name).to_owned(),
    };
    let width = ui.available_width();
    choose(ui, "Design", (&now, width, Need::Optional), |ui| {
        for name in Design::shipped_names() {
            let title = Design::shipped(name).map_or_else(|| name.to_owned(), |d| title_of(&d));
            let is_now = form.chosen == Chosen::Shipped(name);
            if ui.selectable_label(is_now, title).clicked() {
                form.choose(Chosen::Shipped(name));
                ui.ctx().request_repaint();
            }
        }
        ui.separator();
        if ui.selectable_label(false, "Open a design…").clicked() {
            commands.push(FileCommand::Ask(Purpose::OpenDesign).into());
        }
    });
}

/// How long a session takes, how likely the study finds an effect, and what is not even.
fn show_preview(ui: &mut Ui, preview: &Preview) {
    let minutes = preview.duration_s / 60.0;
    let percent = 100.0 * preview.power.share;
    let words = format!(
        "{} trials, about {minutes:.0} min; power {percent:.0} % of {} subjects for an effect of 1",
        preview.n_trials, preview.n_subjects
    );
    note(ui, &words, Tone::Quiet);
    let uneven = preview.deviations();
    if !uneven.is_empty() {
        let words = format!("Not even: {}", uneven.join("; "));
        note(ui, &words, Tone::Wrong);
    }
}

/// A design in a line: how many stimuli, where, how often.
fn about(design: &Design) -> String {
    let n = design.stimuli.len();
    let stimuli = match n {
        0 => String::new(),
        1 => "1 stimulus, ".to_owned(),
        n => format!("{n} stimuli, "),
    };
    let practice = match design.course.practice_trials {
        0 => String::new(),
        n => format!(", {n} for practice first"),
    };
    let library = design.library.as_ref();
    let library = library.map_or_else(String::new, |library| {
        format!(", library {}", library.display())
    });
    format!(
        "{stimuli}medium {}{practice}{library}; study {}",
        design.medium.name(),
        design.study
    )
}

fn show_found(ui: &mut Ui, experiment: &mut Experiment, bench: &Bench) {
    section(ui, "Sessions in the folder");
    let no_folder = experiment.form.folder.trim().is_empty();
    let refusal = no_folder.then_some("Say in which folder first");
    let tip = "Look which sessions the folder holds";
    if button(ui, "List again", tip, refusal) {
        experiment.list_sessions(bench, true);
        ui.ctx().request_repaint();
    }
    let form = &experiment.form;
    let mut resumed = None;
    for found in &form.found {
        if show_row(ui, found) {
            resumed = Some(found.log.clone());
        }
    }
    for line in &form.unread {
        note(ui, line, Tone::Wrong);
    }
    if form.found.is_empty() && form.unread.is_empty() {
        let words = "There is none yet. One that was interrupted is resumed from here.";
        note(ui, words, Tone::Quiet);
    }
    if let Some(log) = resumed {
        experiment.resume_session(log, bench);
        ui.ctx().request_repaint();
    }
}

/// A session of the folder; says whether it is to be resumed.
fn show_row(ui: &mut Ui, found: &Row) -> bool {
    let (done, all) = found.progress;
    let name = format!(
        "{}, session {}",
        found.subject.pseudonym, found.subject.session
    );
    let detail = format!("{done} of {all} · {}", found.title);
    if done >= all {
        ui.allocate_ui(vec2(ui.available_width(), ROW), |ui| {
            let words = format!("{name} · complete · {}", found.title);
            let text = RichText::new(words).color(crate::kit::theme::Palette::in_ui(ui).dim);
            ui.add(eframe::egui::Label::new(text).truncate());
        });
        return false;
    }
    let tip = format!("Resume {}", found.log.display());
    choice(ui, RichText::new(name), &detail, &tip)
}
