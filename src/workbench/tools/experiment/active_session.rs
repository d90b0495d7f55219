//! The session that is active: what happens now, what was answered so far, and the row that is
//! on its way to the disk. A trial ends when its row is there, not before.

use std::path::PathBuf;
use std::time::{Instant, SystemTime};

use crate::bench::background::{Executor, Task, finished};
use crate::tools::experiment::draft::{Draft, Mark};
use crate::tools::experiment::materials::Materials;
use crate::tools::experiment::now::{Began, Now, Pause};
use crate::tools::experiment::presenting::Presented;
use selvedge_engine::RecordedSample;
use selvedge_experiment::design::{Design, Source, Subject};
use selvedge_experiment::layout::{self, Layout};
use selvedge_experiment::session::{Circumstances, Session};
use selvedge_experiment::{Answer, Apparatus, Outcome, Presentation, Timing, Trial};
use selvedge_foundation::progress::Progress;
use selvedge_render::scene::ExplorationPath;
use selvedge_textile::tactile::Tuning;

/// A row that is not on disk yet.
#[derive(Debug, Clone)]
struct Pending {
    outcome: Outcome,
    timing: Timing,
    tuning: Tuning,
    note: String,
    path: Option<ExplorationPath>,
    samples: Vec<RecordedSample>,
}

/// What comes back from the disk.
#[derive(Debug)]
struct Written {
    session: Session,
    /// What became of the trial, or why its row is not there.
    row: Result<(Outcome, Presentation), String>,
}

/// The session that is active.
#[derive(Debug)]
pub(crate) struct ActiveSession {
    /// Away while a row is written.
    session: Option<Session>,
    writing: Option<Task<Written>>,
    pending: Option<Pending>,
    /// The design.
    pub design: Design,
    /// Who takes part.
    pub subject: Subject,
    /// The log.
    pub log: PathBuf,
    /// The device, as logs call it.
    pub device: String,
    /// What is presented.
    pub materials: Materials,
    /// What happens now.
    pub now: Now,
    /// What lies where.
    pub layout: Layout,
    /// What was answered so far.
    pub draft: Draft,
    /// Trials answered and trials there are at most.
    pub progress: (usize, usize),
    /// What the experimenter notes on this trial.
    pub note: String,
    /// Whether the session rests.
    pub pause: Pause,
    /// Why the last row could not be written, and how to mend it.
    pub failure: Option<String>,
    /// The step of a sequence that is played.
    pub sequence_step: Option<u16>,
    /// When the session was opened.
    opened: Instant,
    /// When the present step began; of a trial, its presentation.
    pub began: Began,
    /// What is known of the presentation of the trial that waits.
    pub(crate) presented: Presented,
    /// Whether nobody is to feel anything.
    pub(crate) is_pilot: bool,
}

impl ActiveSession {
    /// A session that was just opened.
    pub(crate) fn new(
        session: Session,
        materials: Materials,
        device: String,
        began: Began,
    ) -> Self {
        let mut active = Self {
            design: session.design().clone(),
            subject: session.subject().clone(),
            log: session.log().to_owned(),
            is_pilot: session.is_pilot(),
            session: Some(session),
            writing: None,
            pending: None,
            device,
            materials,
            now: Now::Finished,
            layout: Layout::empty(),
            draft: Draft::default(),
            progress: (0, 0),
            note: String::new(),
            pause: Pause::default(),
            failure: None,
            sequence_step: None,
            opened: began.at,
            began,
            presented: Presented::default(),
        };
        for stimulus in &active.design.stimuli {
            if let Source::Textile { id, .. } = &stimulus.source {
                active.materials.library_view.want(id);
            }
        }
        active.look(began);
        active
    }

    /// Sees what happens now.
    pub(crate) fn look(&mut self, began: Began) {
        let Some(session) = &self.session else {
            return;
        };
        self.progress = session.progress();
        self.now = Now::of(&session.step());
        self.began = began;
        self.sequence_step = None;
        self.await_presentation();
        (self.layout, self.draft) = match &self.now {
            _ if self.pause == Pause::On => (Layout::empty(), Draft::Nothing),
            Now::Trial(trial) => (
                Layout::of(&self.design, &trial.task),
                Draft::of(&self.design, trial),
            ),
            Now::Familiarisation(_) => (self.practised(), Draft::Nothing),
            _ => (Layout::empty(), Draft::Nothing),
        };
    }

    /// What a movement is practised on: the design's first textile.
    fn practised(&self) -> Layout {
        let is_textile = |source: &Source| matches!(source, Source::Textile { .. });
        let mut stimuli = self.design.stimuli.iter();
        stimuli
            .position(|stimulus| is_textile(&stimulus.source))
            .map_or_else(Layout::empty, Layout::to_practise)
    }

    /// The trial that waits for an answer and is shown.
    pub(crate) fn trial(&self) -> Option<&Trial> {
        match &self.now {
            Now::Trial(trial) if self.pause != Pause::On => Some(trial),
            _ => None,
        }
    }

    /// Whether something can be felt now.
    pub(crate) fn is_felt(&self) -> bool {
        let is_practised = matches!(self.now, Now::Familiarisation(_)) && self.pause != Pause::On;
        (self.is_open() && self.trial().is_some() && !self.is_waiting()) || is_practised
    }

    /// Whether an answer is taken now: none is on its way.
    pub(crate) fn is_open(&self) -> bool {
        self.pending.is_none() && self.writing.is_none() && self.session.is_some()
    }

    /// Whether a row is on its way to the disk.
    pub(crate) fn is_writing(&self) -> bool {
        self.pending.is_some() || self.writing.is_some()
    }

    /// How long the present step has lasted, s.
    pub(crate) fn lasted_s(&self, now_s: f64) -> f64 {
        (now_s - self.began.shown_s).max(0.0)
    }

    /// How long a movement or break still lasts at least, s; 0 elsewhere.
    pub(crate) fn left_s(&self, now_s: f64) -> f64 {
        let least_s = match &self.now {
            Now::Familiarisation(movement) => movement.for_s,
            Now::Break { least_s, .. } => *least_s,
            _ => 0.0,
        };
        (least_s - self.lasted_s(now_s)).max(0.0)
    }

    /// Goes on from what is no trial. Whether anything changed.
    pub(crate) fn pass(&mut self, began: Began) -> bool {
        if matches!(self.now, Now::Trial(_) | Now::Finished) || !self.is_open() {
            return false;
        }
        if let Some(session) = &mut self.session {
            session.pass();
        }
        self.rest_or_look(began);
        true
    }

    /// Begins a pause if one is wanted, and sees what happens now.
    fn rest_or_look(&mut self, began: Began) {
        if self.pause == Pause::Wanted {
            self.pause = Pause::On;
        }
        self.look(began);
    }

    /// Pauses before the next trial, or at once where no trial is under way.
    pub(crate) fn pause(&mut self) {
        let is_trial = matches!(self.now, Now::Trial(_));
        self.pause = if is_trial { Pause::Wanted } else { Pause::On };
    }

    /// Takes a part of an answer. The tuning that follows, if it changes.
    pub(crate) fn mark(&mut self, mark: &Mark, at: Instant) -> Option<Tuning> {
        if !self.is_open() || self.trial().is_none() || self.is_waiting() {
            return None;
        }
        let at_ms = at.saturating_duration_since(self.began.at).as_secs_f64() * 1e3;
        self.draft.take(mark, at_ms);
        matches!(mark, Mark::Turn(..) | Mark::Set(..)).then(|| self.tuning())
    }

    /// Takes back what was answered of this trial so far.
    pub(crate) fn forget_draft(&mut self) {
        if let Now::Trial(trial) = &self.now {
            self.draft = Draft::of(&self.design, trial);
        }
    }

    /// The tuning in force now.
    pub(crate) fn tuning(&self) -> Tuning {
        let tuning = self.materials.tuning();
        match &self.draft {
            Draft::Adjust { values, .. } => self.tuned(tuning, values),
            _ => self.tuned(tuning, &[]),
        }
    }

    fn tuned(&self, tuning: Tuning, values: &[f64]) -> Tuning {
        self.trial().map_or(tuning, |trial| {
            layout::tuned(&self.design, &trial.task, tuning, values)
        })
    }

    /// Which attempt at the trial that waits this is, from 1.
    #[cfg(test)]
    pub(crate) fn attempt(&self) -> u32 {
        self.session.as_ref().map_or(0, Session::attempt)
    }

    /// Takes back that the session was begun.
    ///
    /// # Errors
    /// A trial is on disk, or its files cannot be removed.
    pub(crate) fn undo(&mut self) -> Result<(), String> {
        let session = self.session.take();
        session.map_or(Ok(()), |session| {
            session.undo().map_err(|error| error.to_string())
        })
    }

    /// Ends the trial that waits: its row is on its way. Whether anything was ended.
    pub(crate) fn end_trial(&mut self, answer: Option<Answer>, at: Instant) -> bool {
        let is_begun = self.trial().is_some() && !self.is_waiting();
        if !self.is_open() || !is_begun || !self.may_take(answer.as_ref()) {
            return false;
        }
        let since_opening = |at: Instant| {
            let ns = at.saturating_duration_since(self.opened).as_nanos();
            u64::try_from(ns).unwrap_or(u64::MAX)
        };
        let timing = Timing::between(
            [self.began.utc, SystemTime::now()],
            [self.began.at, at].map(since_opening),
        );
        self.presented.last_response_s = Some(timing.response_ms() * 1e-3);
        self.pending = Some(Pending {
            outcome: answer.map_or(Outcome::Aborted, Outcome::Answered),
            timing,
            tuning: self.tuning(),
            note: self.presented.heard.noted(&self.note),
            path: None,
            samples: Vec::new(),
        });
        true
    }

    /// Begins to write what waits, once its recording is there. Whether it begins now.
    pub(crate) fn write(&mut self, executor: &Executor, has_engine: bool) -> bool {
        let is_due = self.pending.is_some() && self.writing.is_none() && self.failure.is_none();
        let is_complete = !self.is_recording() || !has_engine;
        if !(is_due && is_complete) {
            return false;
        }
        if let Some(recording) = self.take_recording()
            && let Some(pending) = &mut self.pending
        {
            // Where nobody moved there is no path, nor on a cloth that hangs.
            let lies = !self.design.composition.presentation.hangs;
            pending.path = lies.then(|| recording.to_path().ok()).flatten();
            recording.samples().clone_into(&mut pending.samples);
        }
        let (Some(pending), Some(mut session)) = (self.pending.clone(), self.session.take()) else {
            return false;
        };
        let (outcome, presentation) = self.judge(pending.outcome, pending.timing.start_ns());
        let apparatus = Apparatus {
            device: self.device.clone(),
            tuning: pending.tuning,
            stimulus_hash: self.trial().map_or_else(String::new, |trial| {
                self.materials.hashes.of_task(&self.design, &trial.task)
            }),
        };
        let work = move |_: &mut Progress<'_>| {
            let circumstances = Circumstances {
                timing: pending.timing,
                apparatus,
                presentation: presentation.clone(),
                note: &pending.note,
                path: pending.path.as_ref(),
                samples: &pending.samples,
            };
            let written = match &outcome {
                Outcome::Answered(answer) => session.answer(answer, &circumstances).map(|_| ()),
                Outcome::Aborted => session.abort(&circumstances),
            };
            Ok(Written {
                session,
                row: written
                    .map(|()| (outcome, presentation))
                    .map_err(|error| error.to_string()),
            })
        };
        self.writing = Some(executor.start("selvedge-session", work));
        true
    }

    /// Takes what came back from the disk: whether the next step begins.
    ///
    /// # Errors
    /// The thread broke off and the session with it: it must be resumed.
    pub(crate) fn poll(&mut self, began: Began) -> Result<bool, String> {
        let Some(outcome) = finished(&mut self.writing) else {
            return Ok(false);
        };
        let Written { session, row } = outcome?;
        self.session = Some(session);
        match row {
            Ok((outcome, presentation)) => {
                self.pending = None;
                self.note.clear();
                if self.tell(&outcome, &presentation) {
                    self.pause = Pause::Wanted;
                }
                self.rest_or_look(began);
                Ok(true)
            }
            Err(line) => {
                self.failure = Some(line);
                Ok(false)
            }
        }
    }
}
