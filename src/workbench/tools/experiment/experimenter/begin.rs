//! The form that a session begins with.

use eframe::egui::{ProgressBar, Ui};

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::pane::Pane;
use crate::bench::tool::PaneContext;
use crate::kit::theme::STEP;
use crate::kit::widgets::fields::{Need, Tone, choose, note, row_of, text};
use crate::kit::widgets::text::{button, section};
use crate::tools::experiment::builder::numbers::in_words;
use crate::tools::experiment::builder::show_designs;
use crate::tools::experiment::sessions::device_name;
use crate::tools::experiment::state::{Asked, Experiment};
use crate::tools::experiment::who::Who;
use selvedge_experiment::Participant;
use selvedge_experiment::design::Design;

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
        show_designs(ui, form, context);
    });
    if let Ok(design) = form.study.design() {
        note(ui, &about(design), Tone::Quiet);
    }
    if let Some(preview) = form.preview() {
        let percent = 100.0 * preview.power.share;
        let effect = form.effect;
        let words = in_words(preview);
        let words = format!("{words}; power {percent:.0} % for an effect of {effect}");
        note(ui, &words, Tone::Quiet);
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
    section(ui, "The study");
    ui.horizontal_wrapped(|ui| {
        let reveal = |pane| ShowCommand::Reveal(pane).into();
        if button(
            ui,
            "Study builder",
            "Change the design, or look what it comes to",
            None,
        ) {
            context.commands.push(reveal(Pane::Builder));
        }
        if button(
            ui,
            "Study board",
            "Who took part, how far, what is missing",
            None,
        ) {
            context.commands.push(reveal(Pane::Board));
        }
    });
}

/// What will be written, before it is.
fn show_asked(ui: &mut Ui, experiment: &mut Experiment, bench: &mut Bench) {
    let Some(plan) = experiment.form.plan() else {
        experiment.asked = None;
        return;
    };
    section(ui, "Begin this session?");
    for line in plan.describe(&device_name(bench)) {
        note(ui, &line, Tone::Quiet);
    }
    if bench.is_emulated() {
        let words = "The device is an emulator: its rows will say that nobody felt anything.";
        note(ui, words, Tone::Wrong);
    }
    if plan.design.composition.presentation.stylus.is_some() {
        let words = "Force is what a device of your own gives: none is driven from here. Without \
                     one, what is given by force alone is silent.";
        note(ui, words, Tone::Wrong);
    }
    let over = plan.design.over_limits(bench.engine.profile().limit_um);
    if !over.is_empty() {
        let words = "The array may not play all of it: trials with it would not count. Lower it in \
                     the design, or choose an array that may.";
        note(ui, words, Tone::Wrong);
        for line in &over {
            note(ui, line, Tone::Wrong);
        }
    }
    let refusal = (!over.is_empty()).then_some("The array may not play all of it");
    ui.add_space(STEP);
    ui.horizontal_wrapped(|ui| {
        let tip = "Open the log, and show the first page";
        if button(ui, "Begin now", tip, refusal) {
            experiment.begin_session(bench);
        }
        if button(ui, "Not yet", "Nothing is written", None) {
            experiment.asked = None;
        }
    });
}

/// The buttons that begin: a session, once it was said what will be written, and a pilot.
fn show_begin(ui: &mut Ui, experiment: &mut Experiment, bench: &mut Bench) {
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
    one_of(ui, "sex", &mut who.sex, &Participant::SEXES);
    one_of(ui, "handedness", &mut who.handedness, &Participant::HANDS);
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
