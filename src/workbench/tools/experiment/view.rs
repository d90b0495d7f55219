//! What participant and experimenter see of a session: plain data, and pure functions of it.
//!
//! A participant's view holds numbers of places and the target's picture. No id, no level and no
//! position of what is right is in it, nor in the experimenter's.

use crate::bench::Bench;
use crate::bench::session::title_of;
use crate::bench::view::{BridgePhase, ClothPicture, EngineView};
use crate::tools::experiment::active_session::ActiveSession;
use crate::tools::experiment::draft::Draft;
use crate::tools::experiment::guide;
use crate::tools::experiment::in_turn::Intervals;
use crate::tools::experiment::now::{Now, Pause};
use crate::tools::experiment::presenting::ArrayNow;
use crate::tools::experiment::state::Experiment;
use selvedge_experiment::Trial;
use selvedge_experiment::design::{Design, Form, Source};
use selvedge_experiment::layout::Layout;
use selvedge_foundation::geometry::Point;

/// What the participant sees.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ParticipantView<'a> {
    /// No session is active; whether one is on its way.
    Nobody {
        /// One is being prepared.
        is_coming: bool,
    },
    /// Words to read, and when to go on.
    Words {
        /// In large letters.
        title: &'static str,
        /// Below.
        words: String,
        /// Seconds until one may go on; `None` where nobody goes on from here.
        left_s: Option<f64>,
    },
    /// A movement is practised.
    Movement {
        /// Where it is practised.
        ground: Ground,
        /// Whether on a circle; otherwise to and fro.
        is_circle: bool,
        /// Where the guide is.
        guide: Point,
        /// Seconds left.
        left_s: f64,
    },
    /// A trial.
    Trial(TrialView<'a>),
    /// A trial of which nothing is seen.
    Blank(Ground),
}

/// What lies before the participant.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ground {
    /// Width and height, mm.
    pub size_mm: [f64; 2],
    /// What lies there.
    pub slots: Vec<Slot>,
    /// How all of it looks: like the target. `None`: plain.
    pub picture: Option<ClothPicture>,
    /// Where the finger is.
    pub finger: Option<Point>,
    /// Whether the pointer feels there now.
    pub feels: bool,
}

/// One cloth of those that look alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slot {
    /// Its lower left corner, mm.
    pub origin_mm: Point,
    /// Its position, from 1; `None` for one without a number.
    pub number: Option<usize>,
    /// Whether the others are compared with it.
    pub(crate) is_target: bool,
}

/// A trial as the participant sees it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TrialView<'a> {
    /// What lies there.
    pub ground: Ground,
    /// What is asked.
    pub question: String,
    /// What was answered so far.
    pub draft: &'a Draft,
    /// Whether an answer is taken now.
    pub is_open: bool,
    /// What has to be presented before an answer is taken; `None` where nothing is missing.
    pub(crate) missing: Option<String>,
    /// The intervals, where what is felt comes one after the other.
    pub(crate) intervals: Option<Intervals>,
    /// Whether what was played may be played again.
    pub(crate) may_play: bool,
}

impl TrialView<'_> {
    /// What keeps the answer from being handed in; `None` where nothing does.
    pub(crate) fn refusal(&self) -> Option<String> {
        let unanswered = self.draft.answer().err().map(str::to_owned);
        self.missing.clone().or(unanswered)
    }

    /// Whether choosing is all: the answer is handed in with it.
    pub(crate) fn ends_at_once(&self) -> bool {
        let is_choice = matches!(self.draft, Draft::Choose { sure, .. } if sure.n_grades == 0);
        is_choice && self.intervals.is_some()
    }

    /// Whether cloth is felt, one after the other at the same place.
    pub(crate) fn is_felt_in_turn(&self) -> bool {
        self.intervals.is_some() && !self.ground.slots.is_empty()
    }
}

/// Where a session is in its course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Course {
    /// The participant reads.
    Instructions,
    /// A movement is practised.
    Familiarisation,
    /// A trial.
    Trial,
    /// A break.
    Break,
    /// It rests.
    Paused,
    /// All is answered.
    Finished,
}

/// The active session as the experimenter sees it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SessionView {
    /// The design's title.
    pub title: String,
    /// Who takes part, and which session it is.
    pub subject: String,
    /// The file of rows.
    pub log: String,
    /// Where it is.
    pub course: Course,
    /// `practice 2`, `trial 12, block 1`, or empty.
    pub place: String,
    /// Trials answered and trials there are at most.
    pub progress: (usize, usize),
    /// How long the step has lasted, s.
    pub(crate) lasted_s: f64,
    /// How long a movement or break lasts at least, s.
    pub left_s: f64,
    /// How long the last trial took, s.
    pub(crate) last_response_s: Option<f64>,
    /// What was answered so far.
    pub answered: String,
    /// What must lie on the table: position and cloth.
    pub table: Vec<(Option<usize>, String)>,
    /// The device.
    pub link: Link,
    /// Whether a pause is wanted or on.
    pub pause: Pause,
    /// Whether a row is on its way to the disk.
    pub(crate) is_writing: bool,
    /// Why the last row could not be written.
    pub failure: Option<String>,
    /// What the trial waits for before it begins.
    pub(crate) waits_for: Option<&'static str>,
    /// Whether that is the cloth on the table.
    pub(crate) awaits_cloth: bool,
    /// Why the last presentation did not count.
    pub(crate) trouble: Option<String>,
}

/// The device as the experimenter sees it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Link {
    /// What it is called.
    pub name: String,
    /// Where the connection stands.
    pub state: &'static str,
    /// Whether high voltage is on.
    pub is_armed: bool,
    /// Whether everything was switched off.
    pub is_stopped: bool,
    /// The largest amplitudes that it may be given, µm.
    pub limit_um: [f64; 2],
}

impl Link {
    /// The device that is connected, if one is.
    pub(crate) fn of(bench: &Bench) -> Self {
        let live = &bench.live;
        let (bridge, name) = (live.bridge.as_ref(), bench.device.target.as_deref());
        Self {
            name: name.unwrap_or("No device").to_owned(),
            state: bridge.map_or("not connected", |bridge| bridge.state),
            is_armed: bridge.is_some_and(|bridge| bridge.phase == BridgePhase::Armed),
            is_stopped: live.is_stopped,
            limit_um: bench.engine.profile().limit_um,
        }
    }
}

impl Experiment {
    /// What the participant sees.
    pub(crate) fn participant(&self, live: &EngineView, now_s: f64) -> ParticipantView<'_> {
        match &self.session {
            None => ParticipantView::Nobody {
                is_coming: self.beginning.is_some(),
            },
            Some(session) => match session.participant(live.centre, now_s) {
                ParticipantView::Trial(trial) if self.is_blank => {
                    ParticipantView::Blank(trial.ground)
                }
                view => view,
            },
        }
    }
}

impl ActiveSession {
    /// The trial whose answer the experimenter types, while the participant sees nothing.
    pub(crate) fn typed(&self, now_s: f64) -> Option<TrialView<'_>> {
        match self.participant(None, now_s) {
            ParticipantView::Trial(trial) => Some(trial),
            _ => None,
        }
    }

    fn participant(&self, finger: Option<Point>, now_s: f64) -> ParticipantView<'_> {
        let words = |title, words: &str, left_s| ParticipantView::Words {
            title,
            words: words.to_owned(),
            left_s,
        };
        if self.failure.is_some() {
            return words("One moment, please", "The experimenter will help.", None);
        }
        if self.pause == Pause::On {
            return words("Pause", "It goes on soon.", None);
        }
        match &self.now {
            Now::Instructions(text) => words("Welcome", text, Some(0.0)),
            Now::Break { .. } => words_of_break(Some(self.left_s(now_s))),
            Now::Finished => words("That was all", "Thank you for taking part.", None),
            Now::Familiarisation(movement) => {
                let [width_mm, height_mm] = self.layout.size_mm;
                let middle = Point::new(width_mm / 2.0, height_mm / 2.0);
                ParticipantView::Movement {
                    ground: self.ground(None, finger),
                    is_circle: movement.movement == selvedge_experiment::design::Movement::Circular,
                    guide: guide::place(movement, middle, self.lasted_s(now_s)),
                    left_s: self.left_s(now_s),
                }
            }
            Now::Trial(_) if self.is_waiting() => words(
                "One moment, please",
                "The next one is being prepared.",
                None,
            ),
            Now::Trial(trial) => ParticipantView::Trial(TrialView {
                ground: self.ground(Some(trial), finger),
                question: question(&self.design),
                draft: &self.draft,
                is_open: self.is_open(),
                missing: self.missing(),
                intervals: self.intervals(),
                may_play: self.may_play_again(),
            }),
        }
    }

    fn ground(&self, trial: Option<&Trial>, finger: Option<Point>) -> Ground {
        let target = trial.and_then(|trial| target_of(&self.design, trial));
        // A vibration is felt wherever the finger is, a cloth where it hangs: nothing lies there.
        let is_played = !self.sequence().is_empty() && !self.layout.is_stacked();
        let is_elsewhere = is_played || self.hanging_textile().is_some();
        Ground {
            size_mm: self.layout.size_mm,
            slots: if is_elsewhere {
                Vec::new()
            } else {
                slots(&self.layout, trial)
            },
            picture: target.and_then(|id| self.materials.library_view.picture(id)),
            finger: finger.filter(|_| !is_elsewhere),
            feels: self.is_felt() && self.hanging_textile().is_none(),
        }
    }

    /// The session as the experimenter sees it.
    pub(crate) fn view(&self, (link, array): (Link, ArrayNow), now_s: f64) -> SessionView {
        let course = match &self.now {
            _ if self.pause == Pause::On => Course::Paused,
            Now::Instructions(_) => Course::Instructions,
            Now::Familiarisation(_) => Course::Familiarisation,
            Now::Trial(_) => Course::Trial,
            Now::Break { .. } => Course::Break,
            Now::Finished => Course::Finished,
        };
        let trial = self.trial();
        SessionView {
            title: title_of(&self.design),
            subject: format!(
                "{}, session {}",
                self.subject.pseudonym, self.subject.session
            ),
            log: self.log.display().to_string(),
            course,
            place: trial.map_or_else(String::new, place_of),
            progress: self.progress,
            lasted_s: self.lasted_s(now_s),
            left_s: self.left_s(now_s),
            last_response_s: self.presented.last_response_s,
            answered: self.draft.describe(),
            table: trial.map_or_else(Vec::new, |trial| {
                Layout::on_the_table(&self.design, &trial.task)
            }),
            link,
            pause: self.pause,
            is_writing: self.is_writing(),
            failure: self.failure.clone(),
            waits_for: self.waits_for(array),
            awaits_cloth: self.awaits_cloth(),
            trouble: self.presented.trouble.clone(),
        }
    }
}

/// What is read in a break.
pub(super) fn words_of_break(left_s: Option<f64>) -> ParticipantView<'static> {
    ParticipantView::Words {
        title: "A break",
        words: "Rest your finger. Go on when you are ready.".to_owned(),
        left_s,
    }
}

/// Instructions that are no longer than this stand above a trial, letters.
const SHORT: usize = 140;

/// What is asked, as far as the design says it more plainly than the task.
pub(super) fn question(design: &Design) -> String {
    let instructions = design.course.instructions.trim();
    let is_short = !instructions.is_empty() && instructions.chars().count() <= SHORT;
    let composition = &design.composition;
    match (composition.question.shown(), &composition.response.form) {
        // What it is adjusted to is the design's alone to say.
        (None, Form::Adjustment(_)) if is_short => instructions.to_owned(),
        _ => composition.question(),
    }
}

fn place_of(trial: &Trial) -> String {
    let number = trial.number + 1;
    if trial.is_practice {
        format!("practice {number}")
    } else {
        format!("trial {number}, block {}", trial.block + 1)
    }
}

/// What lies where, by positions alone.
pub(super) fn slots(layout: &Layout, trial: Option<&Trial>) -> Vec<Slot> {
    let is_compared = trial.is_some_and(|trial| trial.task.reference.is_some());
    let slot = |place: &selvedge_experiment::layout::Place| Slot {
        origin_mm: place.origin_mm,
        number: place.number,
        is_target: is_compared && place.number.is_none(),
    };
    if let ([first, ..], true) = (layout.places.as_slice(), layout.is_stacked()) {
        // One cloth is seen, whose numbers are those of the intervals.
        let origin_mm = first.origin_mm;
        return vec![Slot {
            origin_mm,
            number: None,
            is_target: false,
        }];
    }
    layout.places.iter().map(slot).collect()
}

/// The textile whose picture all alternatives have.
fn target_of<'a>(design: &'a Design, trial: &Trial) -> Option<&'a str> {
    match &design.stimuli.get(trial.task.reference?)?.source {
        Source::Textile { id, .. } => Some(id),
        _ => None,
    }
}
