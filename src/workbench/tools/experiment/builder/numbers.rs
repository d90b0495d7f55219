//! What a design comes to in numbers, and the pilots that try it.

use eframe::egui::{DragValue, Grid, ProgressBar, RichText, Ui};

use crate::bench::Bench;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::{button, section};
use crate::tools::experiment::builder::looked::{Looked, simulated};
use crate::tools::experiment::form::Form;
use crate::tools::experiment::state::Experiment;
use selvedge_experiment::Preview;
use selvedge_foundation::progress::Progress;

/// Shows them.
pub(crate) fn show(ui: &mut Ui, form: &mut Form, looked: &Looked) {
    section(ui, "What it comes to");
    for line in &looked.missing {
        note(ui, line, Tone::Wrong);
    }
    let preview = match &looked.preview {
        Ok(preview) => preview,
        Err(line) => return note(ui, line, Tone::Wrong),
    };
    note(ui, &in_words(preview), Tone::Quiet);
    ui.horizontal(|ui| {
        let power = &preview.power;
        ui.label(format!(
            "power {:.0} % for an effect of",
            100.0 * power.share
        ));
        let effect = DragValue::new(&mut form.effect)
            .range(0.0..=10.0)
            .speed(0.02);
        ui.add(effect.max_decimals(2))
            .on_hover_text(&power.described);
    });
    let palette = Palette::in_ui(ui);
    Grid::new("balance")
        .num_columns(2)
        .spacing([2.0 * STEP, 2.0])
        .show(ui, |ui| {
            for one in &preview.balance {
                let [fewest, most] = one.times;
                let times = if fewest == most {
                    format!("{fewest} times")
                } else {
                    format!("{fewest} to {most} times")
                };
                let ink = if one.is_even() {
                    palette.dim
                } else {
                    palette.text
                };
                ui.label(RichText::new(one.what).font(theme::small()).color(ink));
                ui.label(RichText::new(times).font(theme::small()).color(ink));
                ui.end_row();
            }
        });
    let uneven = preview.deviations();
    if !uneven.is_empty() {
        note(ui, &format!("Not even: {}", uneven.join("; ")), Tone::Wrong);
    }
}

/// Trials, minutes and subjects in a line.
pub(crate) fn in_words(preview: &Preview) -> String {
    let minutes = preview.duration_s / 60.0;
    let practice = match preview.n_practice {
        0 => String::new(),
        n => format!(" and {n} for practice"),
    };
    let blocks = match preview.n_blocks {
        1 => String::new(),
        n => format!(" in {n} blocks"),
    };
    format!(
        "{} trials{blocks}{practice}, about {minutes:.0} min, {} subjects planned",
        preview.n_trials, preview.n_subjects
    )
}

/// The pilots, and what simulated observers found.
pub(crate) fn show_pilots(ui: &mut Ui, experiment: &mut Experiment, bench: &mut Bench) {
    section(ui, "Pilots");
    let busy = experiment
        .session
        .is_some()
        .then_some("A session is being held");
    ui.horizontal_wrapped(|ui| {
        let tip = "Try what is asked on the screen alone: nobody feels it";
        let refusal = experiment.form.pilot_refusal();
        if button(ui, "Try it yourself", tip, busy.or(refusal.as_deref())) {
            experiment.begin_pilot(bench);
        }
        let design = experiment.form.study.design().err();
        let refusal = design.map(|fault| fault.line.clone());
        let refusal = refusal.as_deref();
        let tip = "Hold the whole study with simulated observers who differ, and analyse it";
        if button(ui, "Simulate the study", tip, refusal) {
            experiment.begin_simulation(bench);
        }
    });
    let failure = &experiment.form.failure;
    if let Some(line) = failure {
        note(ui, line, Tone::Wrong);
    }
    if let Some(task) = &experiment.builder.simulating {
        ui.add(ProgressBar::new(task.share()).desired_height(4.0));
        if button(ui, "Stop", "Give the simulated study up", None) {
            task.stop();
        }
    }
    if let Some((text, outcome)) = &experiment.builder.simulated {
        if text != experiment.form.study.text() {
            note(ui, "Of the design before its last change:", Tone::Wrong);
        }
        match outcome {
            Ok(lines) => lines.iter().for_each(|line| note(ui, line, Tone::Quiet)),
            Err(line) => note(ui, line, Tone::Wrong),
        }
    }
}

impl Experiment {
    /// Begins a study of simulated observers.
    pub(crate) fn begin_simulation(&mut self, bench: &Bench) {
        let Ok(design) = self.form.study.design().cloned() else {
            return;
        };
        if self.builder.simulating.is_some() {
            return;
        }
        let path = self.form.study.chosen().path().to_owned();
        let text = self.form.study.text().to_owned();
        let work = move |progress: &mut Progress<'_>| {
            let found = simulated(&design, &path, progress);
            Ok((text, found))
        };
        self.builder.simulated = None;
        self.builder.simulating = Some(bench.executor.start("selvedge-simulated", work));
        bench.ctx.request_repaint();
    }

    /// Takes what simulated observers found, and counts what the design comes to.
    pub(crate) fn poll_builder(&mut self, bench: &Bench) {
        if let Some(outcome) = crate::bench::background::finished(&mut self.builder.simulating) {
            let text = || self.form.study.text().to_owned();
            self.builder.simulated = Some(outcome.unwrap_or_else(|line| (text(), Err(line))));
        }
        self.form.look(bench);
    }
}
