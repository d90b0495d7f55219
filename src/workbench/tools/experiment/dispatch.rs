//! Sessions of experiments: what is wanted of them, and what the engine does for them.

use std::time::SystemTime;

use eframe::egui;

use crate::bench::command::ShowCommand;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::session::SessionInSight;
use crate::bench::task::taken;
use crate::bench::view::Source;
use crate::bench::{Bench, FRAME};
use crate::tools::experiment::Begun;
use crate::tools::experiment::command::ExperimentCommand;
use crate::tools::experiment::draft::Mark;
use crate::tools::experiment::form::Chosen;
use crate::tools::experiment::held::Held;
use crate::tools::experiment::now::{Began, Now, Pause};
use selvedge_engine::{InputSource, Recording};

/// How often a time that is shown in seconds is drawn anew.
const SECOND: std::time::Duration = std::time::Duration::from_secs(1);

impl Bench {
    pub(crate) fn dispatch_experiment(&mut self, ctx: &egui::Context, command: ExperimentCommand) {
        match command {
            ExperimentCommand::Choose(name) => {
                self.transient.experiment.form.choose(Chosen::Shipped(name));
            }
            ExperimentCommand::Open(path) => {
                self.transient.experiment.form.choose(Chosen::File(path));
            }
            ExperimentCommand::List => self.list_sessions(ctx, true),
            ExperimentCommand::Begin => self.begin_session(ctx),
            ExperimentCommand::Resume(log) => self.resume_session(ctx, log),
            ExperimentCommand::Pass => self.pass_step(ctx),
            ExperimentCommand::Mark(mark) => self.mark_answer(ctx, &mark),
            ExperimentCommand::Answer => self.hand_in(ctx),
            ExperimentCommand::Play => self.play_again(),
            ExperimentCommand::Abort => self.end_trial(ctx, None),
            ExperimentCommand::Retry => {
                if let Some(held) = &mut self.transient.experiment.held {
                    held.retry();
                }
                self.write_row(ctx);
            }
            ExperimentCommand::Pause(is_wanted) => self.pause_session(ctx, is_wanted),
            ExperimentCommand::End => self.end_session(ctx),
            ExperimentCommand::Noise => self.write_noise(ctx),
            ExperimentCommand::Blank(is_blank) => self.transient.experiment.is_blank = is_blank,
            ExperimentCommand::Window(act) => self.transient.experiment.window.act(act),
        }
    }

    fn began(&self, ctx: &egui::Context) -> Began {
        Began {
            utc: SystemTime::now(),
            at: self.stamp(),
            shown_s: ctx.input(|input| input.time),
        }
    }

    /// Holds a session that was just opened.
    fn hold(&mut self, ctx: &egui::Context, begun: Begun) {
        let device = self.device_name();
        let held = Held::new(begun.session, begun.materials, device, self.began(ctx));
        self.session = Some(SessionInSight {
            pseudonym: held.subject.pseudonym.clone(),
            log: held.log.clone(),
        });
        self.transient.experiment.held = Some(Box::new(held));
        let source = self.transient.live.play.source;
        if matches!(source, Source::Stroke | Source::Recording) {
            self.send(selvedge_engine::Command::SetSource(InputSource::Pointer));
        }
        if self.transient.live.play.is_recording {
            self.send(selvedge_engine::Command::StopRecording);
        }
        self.send(selvedge_engine::Command::SetAngle(0.0));
        self.send(selvedge_engine::Command::SetContactorMask(Vec::new()));
        let perspective = Perspective::Experiment;
        self.commands
            .push(ShowCommand::Perspective(perspective).into());
        let is_apart = self.transient.experiment.window.is_open;
        if !is_apart && !self.shows(Pane::Participant) {
            self.commands
                .push(ShowCommand::Pane(Pane::Participant).into());
        }
        self.present(ctx);
    }

    /// Lets what happens now be felt.
    fn present(&mut self, ctx: &egui::Context) {
        let Some(held) = &mut self.transient.experiment.held else {
            return;
        };
        let tuning = held.tuning();
        match held.materials.prepare(&held.design, &held.layout, tuning) {
            Ok(prepared) => {
                let vibrations = held.vibrations();
                let is_trial = held.trial().is_some();
                if is_trial {
                    held.records();
                }
                self.send(selvedge_engine::Command::UpdateScene(Box::new(prepared)));
                self.send(selvedge_engine::Command::Vibrate(vibrations));
                if is_trial {
                    self.send(selvedge_engine::Command::StartRecording);
                }
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
        ctx.request_repaint();
    }

    fn pass_step(&mut self, ctx: &egui::Context) {
        let began = self.began(ctx);
        let Some(held) = &mut self.transient.experiment.held else {
            return;
        };
        if held.pass(began) {
            self.present(ctx);
        }
    }

    fn mark_answer(&mut self, ctx: &egui::Context, mark: &Mark) {
        let at = self.stamp();
        let Some(held) = &mut self.transient.experiment.held else {
            return;
        };
        let tuning = held.mark(mark, at);
        let is_complete =
            (held.trial()).is_some_and(|trial| held.draft.is_handed_in_at_once(&trial.task));
        if let Some(tuning) = tuning {
            self.send(selvedge_engine::Command::SetTuning(tuning));
        }
        if is_complete {
            self.hand_in(ctx);
        }
    }

    fn hand_in(&mut self, ctx: &egui::Context) {
        let held = self.transient.experiment.held.as_ref();
        if let Some(Ok(answer)) = held.map(|held| held.draft.answer()) {
            self.end_trial(ctx, Some(answer));
        }
    }

    /// Ends the trial that waits: answered, or given up.
    fn end_trial(&mut self, ctx: &egui::Context, answer: Option<selvedge_experiment::Answer>) {
        let at = self.stamp();
        let Some(held) = &mut self.transient.experiment.held else {
            return;
        };
        if !held.end_trial(answer, at) {
            return;
        }
        if held.is_recording() {
            self.send(selvedge_engine::Command::StopRecording);
        }
        self.send(selvedge_engine::Command::Vibrate(Vec::new()));
        self.write_row(ctx);
    }

    fn play_again(&mut self) {
        let held = self.transient.experiment.held.as_ref();
        let again = held.filter(|held| held.may_play_again() && held.is_open());
        if let Some(vibrations) = again.map(|held| held.vibrations()) {
            self.send(selvedge_engine::Command::Vibrate(vibrations));
        }
    }

    fn pause_session(&mut self, ctx: &egui::Context, is_wanted: bool) {
        let began = self.began(ctx);
        let Some(held) = &mut self.transient.experiment.held else {
            return;
        };
        if is_wanted {
            held.pause();
        } else {
            let was_on = std::mem::take(&mut held.pause) == Pause::On;
            if !was_on {
                return;
            }
        }
        if held.pause != Pause::Wanted && held.is_open() {
            held.look(began);
            self.present(ctx);
        }
    }

    /// Ends the session. What is answered is on disk; the user's scene is felt again.
    fn end_session(&mut self, ctx: &egui::Context) {
        let experiment = &mut self.transient.experiment;
        let can_end = |held: &mut Box<Held>| held.is_open() || held.failure.is_some();
        let Some(held) = experiment.held.take_if(can_end) else {
            return;
        };
        experiment.lets_recording_go = held.is_recording();
        if held.is_recording() {
            self.send(selvedge_engine::Command::StopRecording);
        }
        drop(held);
        self.leave_session(ctx);
    }

    fn leave_session(&mut self, ctx: &egui::Context) {
        self.session = None;
        self.send(selvedge_engine::Command::Vibrate(Vec::new()));
        let mask = self.transient.mute_solo.contactor_mask(self.n_contactors());
        self.send(selvedge_engine::Command::SetContactorMask(mask));
        self.transient.history.clear();
        self.transient.trail = crate::tools::workspace::trail::Trail::default();
        self.feel_document(ctx);
        self.list_sessions(ctx, false);
    }

    /// Takes a recording that has ended, if a session or what is left of one wants it.
    pub(crate) fn recording_of_trial(&mut self, recording: Recording) -> Option<Recording> {
        let experiment = &mut self.transient.experiment;
        if let Some(held) = experiment.held.as_mut().filter(|held| held.is_recording()) {
            held.take_recording(recording);
            return None;
        }
        if std::mem::take(&mut experiment.lets_recording_go) || experiment.is_held() {
            return None;
        }
        Some(recording)
    }

    fn write_row(&mut self, ctx: &egui::Context) {
        let has_engine = self.engine.is_running();
        let is_at_once = self.is_stepped;
        if let Some(held) = &mut self.transient.experiment.held {
            held.write((ctx, is_at_once), has_engine);
        }
    }

    /// Takes what threads and the engine have for a session.
    pub(crate) fn poll_experiment(&mut self, ctx: &egui::Context) {
        let form = &mut self.transient.experiment.form;
        match taken(&mut form.listing) {
            Some((Ok(listed), _)) => form.take_listed(listed),
            Some((Err(line), _)) => form.failure = Some(line),
            None => {}
        }
        self.follow_folder(ctx);
        self.poll_noise();
        match taken(&mut self.transient.experiment.beginning) {
            Some((Ok(begun), _)) => self.hold(ctx, begun),
            Some((Err(line), _)) => self.transient.experiment.form.failure = Some(line),
            None => {}
        }
        self.write_row(ctx);
        self.poll_row(ctx);
        self.keep_time(ctx);
    }

    fn poll_row(&mut self, ctx: &egui::Context) {
        let began = self.began(ctx);
        let Some(held) = &mut self.transient.experiment.held else {
            return;
        };
        let flaws = held.materials.library_view.work(ctx, self.is_stepped);
        match held.poll(began) {
            Ok(true) => self.present(ctx),
            Ok(false) => {}
            Err(line) => {
                self.transient.experiment.held = None;
                let words = format!("The session broke off ({line}): resume it by its log");
                self.transient.notices.give(words);
                self.leave_session(ctx);
            }
        }
        for flaw in flaws {
            self.transient.notices.give(flaw);
        }
    }

    /// Has drawn anew what moves by itself: a guide, an interval, seconds.
    fn keep_time(&self, ctx: &egui::Context) {
        let Some(held) = &self.transient.experiment.held else {
            return;
        };
        let is_moving = held.vibration.is_some() || matches!(held.now, Now::Familiarisation(_));
        match (&held.now, held.is_writing()) {
            (Now::Finished, _) => {}
            (_, true) => ctx.request_repaint_after(FRAME),
            _ if is_moving => ctx.request_repaint_after(FRAME),
            _ => ctx.request_repaint_after(SECOND),
        }
    }
}
