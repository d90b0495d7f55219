//! A session from its beginning to its end: what is wanted of it, and what the engine does for it.

use std::time::SystemTime;

use crate::bench::background::finished;
use crate::bench::command::ShowCommand;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::session::SessionInSight;
use crate::bench::view::Source;
use crate::bench::{Bench, FRAME};
use crate::tools::experiment::active_session::ActiveSession;
use crate::tools::experiment::draft::Act;
use crate::tools::experiment::draft::Mark;
use crate::tools::experiment::now::{Began, Now, Pause};
use crate::tools::experiment::presenting::{ArrayNow, Due};
use crate::tools::experiment::sessions::device_name;
use crate::tools::experiment::state::{Begun, Experiment};
use selvedge_engine::{Command, InputSource};
use selvedge_experiment::Answer;
use selvedge_experiment::layout::Layout;

/// How often a time that is shown in seconds is drawn anew.
const SECOND: std::time::Duration = std::time::Duration::from_secs(1);

fn began(bench: &Bench) -> Began {
    Began {
        utc: SystemTime::now(),
        at: bench.clock.stamp(),
        shown_s: bench.ctx.input(|input| input.time),
    }
}

/// What participant and experimenter want of a session.
impl Experiment {
    /// Does what was done in the participant's view.
    pub(crate) fn take_acts(&mut self, acts: Vec<Act>, bench: &mut Bench) {
        for act in acts {
            match act {
                Act::Pass => self.pass(bench),
                Act::Mark(mark) => self.mark(&mark, bench),
                Act::Answer => self.hand_in(bench),
                Act::Play => self.play_again(bench),
            }
            bench.ctx.request_repaint();
        }
    }

    /// Goes on from instructions, a movement or a break.
    pub(crate) fn pass(&mut self, bench: &mut Bench) {
        let began = began(bench);
        if self.session.as_mut().is_some_and(|one| one.pass(began)) {
            self.present(bench);
        }
    }

    /// Takes a part of an answer.
    pub(crate) fn mark(&mut self, mark: &Mark, bench: &mut Bench) {
        let Some(session) = &mut self.session else {
            return;
        };
        if let Some(tuning) = session.mark(mark, bench.clock.stamp()) {
            bench.send(Command::SetTuning(tuning));
        }
        let is_trial = session.trial().is_some();
        if is_trial && session.draft.is_handed_in_at_once(&session.design) {
            if session.missing().is_some() {
                // Who chooses before all was played chooses again.
                session.forget_draft();
            }
            self.hand_in(bench);
        }
    }

    /// Hands the answer in, if it is complete.
    pub(crate) fn hand_in(&mut self, bench: &mut Bench) {
        let session = self.session.as_ref();
        if let Some(Ok(answer)) = session.map(|session| session.draft.answer()) {
            self.end_trial(Some(answer), bench);
        }
    }

    /// Ends the trial that waits: answered, or given up, so that it comes again.
    pub(crate) fn end_trial(&mut self, answer: Option<Answer>, bench: &mut Bench) {
        let Some(session) = &mut self.session else {
            return;
        };
        if !session.end_trial(answer, bench.clock.stamp()) {
            return;
        }
        if session.is_recording() {
            bench.send(Command::StopRecording);
        }
        let after = session.after_sequence().into_iter().collect();
        bench.send(Command::PlaySequence(after));
        self.write_row(bench);
    }

    /// Plays the vibration of this trial again, where that is allowed.
    pub(crate) fn play_again(&self, bench: &mut Bench) {
        let session = self.session.as_ref();
        if let Some(session) = session.filter(|one| one.may_play_again() && one.is_open()) {
            bench.send(Command::PlaySequence(session.sequence()));
        }
    }

    /// Tries to write again what could not be written.
    pub(crate) fn retry(&mut self, bench: &Bench) {
        if let Some(session) = &mut self.session {
            session.failure = None;
        }
        self.write_row(bench);
    }

    /// Pauses before the next trial, or goes on.
    pub(crate) fn pause(&mut self, is_wanted: bool, bench: &mut Bench) {
        let Some(session) = &mut self.session else {
            return;
        };
        if is_wanted {
            session.pause();
        } else {
            let was_on = std::mem::take(&mut session.pause) == Pause::On;
            if !was_on {
                return;
            }
        }
        if session.pause != Pause::Wanted && session.is_open() {
            session.look(began(bench));
            self.present(bench);
        }
    }

    /// Takes back that the session was begun, as long as it has no trial.
    pub(crate) fn undo_beginning(&mut self, bench: &mut Bench) {
        let can_undo = |one: &mut Box<ActiveSession>| one.is_open();
        let Some(mut session) = self.session.take_if(can_undo) else {
            return;
        };
        if session.is_recording() {
            bench.send(Command::StopRecording);
        }
        if let Err(line) = session.undo() {
            self.form.failure = Some(line);
        }
        drop(session);
        self.leave_session(bench);
    }

    /// Ends the session. What is answered is on disk; the user's scene is felt again.
    pub(crate) fn end(&mut self, bench: &mut Bench) {
        let can_end = |one: &mut Box<ActiveSession>| one.is_open() || one.failure.is_some();
        let Some(session) = self.session.take_if(can_end) else {
            return;
        };
        if session.is_recording() {
            bench.send(Command::StopRecording);
        }
        drop(session);
        self.leave_session(bench);
    }
}

/// What the engine, the disk and the window do for it.
impl Experiment {
    /// Begins a session that was just opened.
    fn activate(&mut self, begun: Begun, bench: &mut Bench) {
        let device = device_name(bench);
        let session = ActiveSession::new(begun.session, begun.materials, device, began(bench));
        bench.session.active = Some(SessionInSight {
            pseudonym: session.subject.pseudonym.clone(),
            log: session.log.clone(),
            hung: None,
        });
        self.session = Some(Box::new(session));
        let play = bench.live.play;
        if matches!(play.source, Source::Stroke | Source::Recording) {
            bench.send(Command::SetSource(InputSource::Pointer));
        }
        if play.is_recording {
            bench.send(Command::StopRecording);
        }
        bench.send(Command::SetAngle(0.0));
        bench.feel_stylus(None);
        bench.send(Command::SetContactorMask(Vec::new()));
        let perspective = ShowCommand::Perspective(Perspective::Experiment);
        bench.commands.push(perspective.into());
        if !self.window.is_open {
            let reveal = ShowCommand::Reveal(Pane::Participant);
            bench.commands.push(reveal.into());
        }
        self.present(bench);
    }

    /// Lets what happens now be felt: of a trial that has not begun, nothing.
    fn present(&mut self, bench: &mut Bench) {
        let Some(session) = &mut self.session else {
            return;
        };
        if let Some(active) = &mut bench.session.active {
            active.hung = session.hung();
        }
        let tuning = session.tuning();
        let nothing = Layout::empty();
        let layout = if session.is_waiting() {
            &nothing
        } else {
            &session.layout
        };
        let prepared = session.materials.prepare(&session.design, layout, tuning);
        match prepared {
            Ok((prepared, stylus)) => {
                // It feels the scene that it is made for alone: until that comes all is silent.
                let words = session.design.composition.presentation.stylus;
                bench.feel_stylus(stylus.zip(words.map(|stylus| stylus.words())));
                let steps = if session.is_waiting() {
                    Vec::new()
                } else {
                    session.sequence()
                };
                // Whichever is silent comes first: no textile is felt before its turn.
                let is_sequence_first = !steps.is_empty();
                let sequence = Command::PlaySequence(steps);
                let scene = Command::UpdateScene(Box::new(prepared));
                let in_order = if is_sequence_first {
                    [sequence, scene]
                } else {
                    [scene, sequence]
                };
                for command in in_order {
                    bench.send(command);
                }
            }
            Err(error) => bench.notices.give(error.to_string()),
        }
        bench.ctx.request_repaint();
    }

    /// Begins a presentation once what it needs is there, and voids one that counts no more.
    fn follow_presentation(&mut self, bench: &mut Bench) {
        let array = ArrayNow::of(bench);
        let Some(session) = &mut self.session else {
            return;
        };
        match session.due(array) {
            Due::Nothing => {}
            Due::Begin => match bench.engine.record() {
                Ok(recording) => {
                    session.begin_presentation(began(bench), (array, recording));
                    self.present(bench);
                }
                Err(error) => {
                    session.presented.trouble = Some(error.to_string());
                    session.pause = Pause::On;
                }
            },
            Due::Void => self.end_trial(None, bench),
        }
    }

    fn leave_session(&mut self, bench: &mut Bench) {
        self.asked = None;
        bench.session.active = None;
        bench.send(Command::PlaySequence(Vec::new()));
        bench.feel_stylus(None);
        let n_contactors = bench.n_contactors();
        let mask = bench.selection.mute_solo.contactor_mask(n_contactors);
        bench.send(Command::SetContactorMask(mask));
        bench.past.history.clear();
        drop(std::mem::take(&mut bench.past.trail));
        bench.feel_document();
        self.list_sessions(bench, false);
    }

    fn write_row(&mut self, bench: &Bench) {
        let has_engine = bench.engine.is_running();
        if let Some(session) = &mut self.session
            && session.write(&bench.executor, has_engine)
        {
            bench.ctx.request_repaint();
        }
    }

    /// Takes what threads and the engine have for a session. Once a frame.
    pub(crate) fn poll(&mut self, bench: &mut Bench) {
        if let Some(session) = &mut self.session {
            session.sequence_step = bench.live.sequence_step;
            session.collect_recording();
        }
        match finished(&mut self.form.listing) {
            Some(Ok(listed)) => self.form.take_listed(listed),
            Some(Err(line)) => self.form.failure = Some(line),
            None => {}
        }
        self.follow_folder(bench);
        self.poll_noise(bench);
        match finished(&mut self.beginning) {
            Some(Ok(begun)) => self.activate(begun, bench),
            Some(Err(line)) => self.form.failure = Some(line),
            None => {}
        }
        self.follow_presentation(bench);
        self.write_row(bench);
        self.poll_row(bench);
        self.keep_time(bench);
    }

    fn poll_row(&mut self, bench: &mut Bench) {
        let Some(session) = &mut self.session else {
            return;
        };
        let library_view = &mut session.materials.library_view;
        let flaws = library_view.work(&bench.ctx, &bench.executor);
        match session.poll(began(bench)) {
            Ok(true) => self.present(bench),
            Ok(false) => {}
            Err(line) => {
                self.session = None;
                let line = format!("The session broke off ({line}): resume it by its log");
                bench.notices.give(line);
                self.leave_session(bench);
            }
        }
        for flaw in flaws {
            bench.notices.give(flaw);
        }
    }

    /// Has drawn anew what moves by itself: a guide, an interval, seconds.
    fn keep_time(&self, bench: &Bench) {
        let Some(session) = &self.session else {
            return;
        };
        let is_moving =
            session.sequence_step.is_some() || matches!(session.now, Now::Familiarisation(_));
        match (&session.now, session.is_writing()) {
            (Now::Finished, _) => {}
            (_, true) => bench.ctx.request_repaint_after(FRAME),
            _ if is_moving => bench.ctx.request_repaint_after(FRAME),
            _ => bench.ctx.request_repaint_after(SECOND),
        }
    }
}
