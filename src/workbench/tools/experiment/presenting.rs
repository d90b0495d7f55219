//! What a trial needs before it begins, what became of its ticks, and whether an answer may be
//! taken.
//!
//! A presentation that stops counting is voided: its row says why, and it is presented again.

use crate::bench::Bench;
use crate::bench::view::BridgePhase;
use crate::tools::experiment::active_session::ActiveSession;
use crate::tools::experiment::in_turn::LEAD_STEPS;
use crate::tools::experiment::now::{Began, Now};
use crate::tools::experiment::played_noise::HeardNoise;
use selvedge_engine::{RecordedTick, Recording};
use selvedge_experiment::layout::Layout;
use selvedge_experiment::{Answer, Outcome, Presentation, PresentedTick, Proof, Standing, Watch};
use selvedge_render::stylus::StylusState;

/// Presentations of one trial that may be voided before the experimenter is asked.
const MOST_VOID: u32 = 3;

/// How far a trial's presentation is.
#[derive(Debug)]
pub(crate) enum Presenting {
    /// There is no trial.
    Nothing,
    /// It has not begun.
    Waiting {
        /// The experimenter said that the cloth lies there.
        is_laid: bool,
    },
    /// The array presents it.
    Watched(Watch),
    /// Cloth on the table alone.
    Confirmed,
}

/// How it stands with the recording of a trial.
#[derive(Debug)]
pub(crate) enum TrialRecording {
    /// There is none.
    Nothing,
    /// The engine records; so many of its ticks were looked at.
    Running(Recording, usize),
    /// It came to its end.
    Ended(Recording),
}

/// What is known of the presentation of the trial that waits.
#[derive(Debug)]
pub(crate) struct Presented {
    /// How far it is.
    pub(crate) presenting: Presenting,
    /// The engine's recording of it.
    pub(crate) recording: TrialRecording,
    /// Why the array presents it no more.
    pub(crate) ended_by: Option<&'static str>,
    /// How often this trial was voided.
    pub(crate) n_void: u32,
    /// Why the last presentation did not count, and what follows.
    pub(crate) trouble: Option<String>,
    /// How long the last trial took, s.
    pub(crate) last_response_s: Option<f64>,
    /// What was heard of a masking noise since it began.
    pub(crate) heard: HeardNoise,
}

impl Default for Presented {
    fn default() -> Self {
        Self {
            presenting: Presenting::Nothing,
            recording: TrialRecording::Nothing,
            ended_by: None,
            n_void: 0,
            trouble: None,
            last_response_s: None,
            heard: HeardNoise::default(),
        }
    }
}

/// The array as presentations need to know it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ArrayNow {
    /// By what a presentation on it is proved.
    pub(crate) proof: Proof,
    /// Why it presents nothing now; `None` where it does.
    pub(crate) why_not: Option<&'static str>,
    /// What the stylus does that is felt through it, if one is.
    pub(crate) stylus: Option<StylusState>,
    /// Whether a cloth that hangs is felt through it.
    pub(crate) is_cloth: bool,
}

impl ArrayNow {
    pub(crate) fn of(bench: &Bench) -> Self {
        let live = &bench.live;
        let bridge = live.bridge.as_ref();
        let why_not = match bridge {
            _ if live.is_stopped => Some("everything was switched off"),
            None => Some("no array is connected"),
            Some(bridge) if bridge.phase != BridgePhase::Armed => Some("the array is not armed"),
            Some(bridge) if bridge.gain.is_none_or(|gain| gain < 1.0) => {
                Some("the array is not armed at full strength")
            }
            Some(_) => None,
        };
        Self {
            proof: if bench.is_emulated() {
                Proof::Emulator
            } else {
                Proof::Array
            },
            why_not,
            stylus: live.stylus,
            is_cloth: live.is_cloth,
        }
    }

    /// Why no stylus feels anything now; `None` where one does, or rests.
    fn why_no_stylus(self) -> Option<&'static str> {
        match self.stylus {
            None => Some("the stylus is not felt"),
            Some(StylusState::BrokenOff) => {
                Some("the stylus broke off: its motion grew without end")
            }
            Some(StylusState::Led | StylusState::AtRest | StylusState::Away) => None,
        }
    }
}

/// What is to be done about a presentation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Due {
    /// Nothing.
    Nothing,
    /// It begins.
    Begin,
    /// It does not count any more.
    Void,
}

impl ActiveSession {
    /// The trial that waits is to be presented, once what it needs is there.
    pub(crate) fn await_presentation(&mut self) {
        let is_trial = self.trial().is_some();
        self.presented.recording = TrialRecording::Nothing;
        self.presented.presenting = if is_trial {
            Presenting::Waiting { is_laid: false }
        } else {
            Presenting::Nothing
        };
    }

    /// The experimenter says that the cloth lies where it belongs.
    pub(crate) fn lay(&mut self) {
        if let Presenting::Waiting { is_laid } = &mut self.presented.presenting {
            *is_laid = true;
        }
    }

    /// Whether the trial has not begun.
    pub(crate) fn is_waiting(&self) -> bool {
        matches!(self.presented.presenting, Presenting::Waiting { .. })
    }

    /// Whether the experimenter has to say that the cloth lies there.
    pub(crate) fn awaits_cloth(&self) -> bool {
        let is_laid = match self.presented.presenting {
            Presenting::Waiting { is_laid } => is_laid,
            _ => true,
        };
        !is_laid
            && self
                .trial()
                .is_some_and(|trial| !Layout::on_the_table(&self.design, &trial.task).is_empty())
    }

    /// Whether the array presents something in this design.
    fn needs_array(&self) -> bool {
        selvedge_experiment::by_hand::needs_array(&self.design)
    }

    /// Why what the design asks about is not presented now. A pilot needs no array.
    fn why_not(&self, array: ArrayNow) -> Option<&'static str> {
        let is_led = self.design.composition.presentation.stylus.is_some();
        let no_stylus = if is_led { array.why_no_stylus() } else { None };
        let no_cloth = (self.hanging_textile().is_some() && !array.is_cloth)
            .then_some("the cloth that hangs is not felt");
        array
            .why_not
            .filter(|_| !self.is_pilot)
            .or(no_stylus)
            .or(no_cloth)
    }

    /// What the trial waits for, in words.
    pub(crate) fn waits_for(&self, array: ArrayNow) -> Option<&'static str> {
        if !self.is_waiting() {
            return None;
        }
        if self.awaits_cloth() {
            return Some("Lay the cloth, then say so: the trial begins");
        }
        self.why_not(array).filter(|_| self.needs_array())
    }

    /// What is to be done about the presentation now.
    pub(crate) fn due(&mut self, array: ArrayNow) -> Due {
        if self.trial().is_none() || self.is_writing() {
            return Due::Nothing;
        }
        if self.is_waiting() {
            let is_ready = self.waits_for(array).is_none();
            return if is_ready { Due::Begin } else { Due::Nothing };
        }
        let Presenting::Watched(watch) = &self.presented.presenting else {
            return Due::Nothing;
        };
        self.presented.ended_by = self.why_not(array);
        // Ticks that the engine still holds say better what came first.
        let is_over = self.presented.ended_by.is_some();
        if is_over || matches!(watch.standing(), Standing::Void(_)) {
            Due::Void
        } else {
            Due::Nothing
        }
    }

    /// The presentation begins now; the engine records it.
    pub(crate) fn begin_presentation(
        &mut self,
        began: Began,
        (array, recording): (ArrayNow, Recording),
    ) {
        let Now::Trial(trial) = &self.now else {
            return;
        };
        self.presented.presenting = if self.needs_array() {
            let proof = if self.is_pilot {
                Proof::Screen
            } else {
                array.proof
            };
            Presenting::Watched(Watch::of(&self.design, &trial.task, proof))
        } else {
            Presenting::Confirmed
        };
        self.presented.recording = TrialRecording::Running(recording, 0);
        self.presented.heard.begin();
        self.began = began;
    }

    /// What is missing before an answer may be taken; `None` where nothing is.
    pub(crate) fn missing(&self) -> Option<String> {
        match &self.presented.presenting {
            Presenting::Nothing | Presenting::Waiting { .. } => Some(String::new()),
            Presenting::Confirmed => None,
            Presenting::Watched(watch) => match watch.standing() {
                Standing::Valid => None,
                Standing::Incomplete(what) | Standing::Void(what) => Some(what),
            },
        }
    }

    /// Whether the engine still records.
    pub(crate) fn is_recording(&self) -> bool {
        matches!(self.presented.recording, TrialRecording::Running(..))
    }

    /// Takes what the engine has recorded, and looks at it. Once a frame.
    pub(crate) fn collect_recording(&mut self) {
        let recording = std::mem::replace(&mut self.presented.recording, TrialRecording::Nothing);
        self.presented.recording = match recording {
            TrialRecording::Running(mut recording, n_seen) => {
                recording.collect();
                let n_ticks = recording.ticks().len();
                let n_values = 2 * recording.n_contactors() as u64;
                if let Presenting::Watched(watch) = &mut self.presented.presenting {
                    for (nth, tick) in recording.ticks().iter().enumerate().skip(n_seen) {
                        let is_felt = tick.sent.is_some() || self.is_pilot;
                        let given_um = recording.amplitudes_um(nth);
                        watch.tick(
                            &presented((tick, given_um), (is_felt, n_values)),
                            LEAD_STEPS,
                        );
                    }
                }
                if recording.has_ended() {
                    TrialRecording::Ended(recording)
                } else {
                    TrialRecording::Running(recording, n_ticks)
                }
            }
            other => other,
        };
    }

    /// The recording of the trial that ended, if there is one: it is looked at no more.
    pub(crate) fn take_recording(&mut self) -> Option<Recording> {
        match std::mem::replace(&mut self.presented.recording, TrialRecording::Nothing) {
            TrialRecording::Ended(recording) => Some(recording),
            other => {
                self.presented.recording = other;
                None
            }
        }
    }

    /// What its row says of the presentation, which began `began_ns` after the opening, and what
    /// becomes of an answer: one to what does not count is none.
    pub(crate) fn judge(&mut self, outcome: Outcome, began_ns: u64) -> (Outcome, Presentation) {
        if let (Some(why), Presenting::Watched(watch)) = (
            self.presented.ended_by.take(),
            &mut self.presented.presenting,
        ) {
            watch.end(why);
        }
        let mut presentation = match &self.presented.presenting {
            Presenting::Watched(watch) => watch.presentation(began_ns),
            Presenting::Confirmed => Presentation::confirmed(Proof::RealCloth),
            Presenting::Nothing | Presenting::Waiting { .. } => Presentation::default(),
        };
        let is_void = match &self.presented.presenting {
            Presenting::Watched(watch) => matches!(watch.standing(), Standing::Void(_)),
            _ => false,
        };
        let is_answer = matches!(outcome, Outcome::Answered(_));
        if !is_void && !is_answer {
            // Given up before it was complete: nobody's fault.
            presentation.void.clear();
        }
        if presentation.void.is_empty() {
            return (outcome, presentation);
        }
        self.presented.n_void += 1;
        (Outcome::Aborted, presentation)
    }

    /// After a row: what the experimenter is told of the last presentation. Whether it has to be
    /// stopped for.
    pub(crate) fn tell(&mut self, outcome: &Outcome, presentation: &Presentation) -> bool {
        if matches!(outcome, Outcome::Answered(_)) {
            self.presented.n_void = 0;
        }
        let n_void = self.presented.n_void;
        let is_too_often = !presentation.void.is_empty() && n_void >= MOST_VOID;
        self.presented.trouble = (!presentation.void.is_empty()).then(|| {
            let follows = if is_too_often {
                format!("{n_void} times: mend that, then end the pause")
            } else {
                "it is presented again".to_owned()
            };
            format!(
                "The last presentation does not count: {}; {follows}",
                presentation.void
            )
        });
        if is_too_often {
            self.presented.n_void = 0;
        }
        is_too_often
    }

    /// Whether an answer that is complete may be taken.
    pub(crate) fn may_take(&self, answer: Option<&Answer>) -> bool {
        answer.is_none() || self.missing().is_none()
    }
}

/// A tick as proofs look at it; that of a pilot counts as felt.
fn presented(
    (tick, given_um): (&RecordedTick, &[[f32; 2]]),
    (is_felt, n_values): (bool, u64),
) -> PresentedTick {
    let strongest_um = given_um.iter().flatten().copied().fold(0.0, f32::max);
    PresentedTick {
        is_sent: is_felt,
        n_missed: tick.tally.n_missed,
        n_limited: tick.tally.n_limited,
        n_values,
        position: tick.pose.position,
        speed_mm_per_s: tick.pose.velocity.speed_mm_per_s(),
        strongest_um: f64::from(strongest_um),
        sequence_step: tick.sequence_step,
    }
}
