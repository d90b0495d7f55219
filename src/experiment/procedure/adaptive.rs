//! Trials whose level depends on the answers before: staircases in turn, or QUEST+.

use crate::ExperimentError;
use crate::design::{Levels, Needs, QuestPlusTrack, StaircaseTrack, Stopping, Track};
use crate::trial::{Answer, AnswerError, Task, Trial};
use selvedge_foundation::numerics::Random;
use selvedge_statistics::Computed;
use selvedge_statistics::adaptive::{
    Interleaved, Procedure as _, QuestGrid, QuestPlus, Staircase, Stop,
};
use selvedge_statistics::psychometric::Guess;

/// A series that nothing has ended after so many trials is ended: at a limit of the levels no
/// reversal may ever come.
const MOST_TRIALS: u32 = 1000;

/// Levels found from answers.
#[derive(Debug, Clone)]
pub(super) struct Adaptive {
    levels: Levels,
    random: Random,
    practice: Vec<Trial>,
    n_answered: usize,
    series: Series,
    now: Option<Trial>,
}

#[derive(Debug, Clone)]
enum Series {
    Staircases(Interleaved<Staircase>),
    /// Over differences from the reference where there is one.
    QuestPlus(Box<QuestPlus>),
}

impl Series {
    /// Whose turn it is and its level, dB re 1 µm.
    fn level(&self, levels: &Levels) -> Option<(usize, f64)> {
        match self {
            Self::Staircases(staircases) => staircases.stimulus(),
            Self::QuestPlus(quest) => Some((0, levels.level_db(quest.stimulus()?))),
        }
    }

    fn answer(&mut self, levels: &Levels, level_db: f64, is_right: bool) -> Computed<()> {
        match self {
            Self::Staircases(staircases) => staircases.answer(level_db, is_right),
            Self::QuestPlus(quest) => quest.answer(levels.stimulus(level_db), is_right),
        }
    }
}

impl Adaptive {
    /// The series of a session with trials of practice at the strongest level that a series begins
    /// with. `None` where levels are known before.
    ///
    /// # Errors
    /// The design's numbers make no series.
    pub(super) fn of(
        levels: &Levels,
        n_practice: usize,
        random: &Random,
    ) -> Result<Option<Self>, ExperimentError> {
        let made = match &levels.track {
            Track::Staircase(track) => staircases(levels, track, random).map(Series::Staircases),
            Track::QuestPlus(track) => {
                quest_plus(levels, track).map(|quest| Series::QuestPlus(Box::new(quest)))
            }
            Track::Constant { .. } => return Ok(None),
        };
        let series = made.map_err(|error| {
            let what = format!("the levels make no series: {}", error.reason);
            ExperimentError::value(what, "mend [levels] in the design")
        })?;
        let mut adaptive = Self {
            practice: practice(levels, n_practice, random),
            levels: levels.clone(),
            random: random.branch("positions"),
            n_answered: 0,
            series,
            now: None,
        };
        adaptive.now = adaptive.next();
        Ok(Some(adaptive))
    }

    pub(super) fn trial(&self) -> Option<&Trial> {
        self.now.as_ref()
    }

    pub(super) fn n_answered(&self) -> usize {
        self.n_answered
    }

    /// How many there will be at most.
    pub(super) fn n_trials(&self) -> usize {
        let stated = match self.levels.stopping.trials {
            0 => MOST_TRIALS as usize,
            n if self.levels.stopping.needs == Needs::All => n.max(MOST_TRIALS as usize),
            n => n,
        };
        let n_series = match &self.series {
            Series::Staircases(staircases) => staircases.procedures().len(),
            Series::QuestPlus(_) => 1,
        };
        self.practice.len() + n_series * stated
    }

    pub(super) fn answer(&mut self, answer: &Answer) -> Result<Option<bool>, AnswerError> {
        let Some(trial) = &self.now else {
            return Err(AnswerError::value("all is answered", "end the session"));
        };
        answer.check_choice(self.levels.intervals)?;
        let verdict = trial.task.verdict(answer)?;
        if let (Task::Interval { level_db, .. }, false) = (&trial.task, trial.is_practice) {
            let is_right = verdict == Some(true);
            let taken = self.series.answer(&self.levels, *level_db, is_right);
            taken.map_err(|error| AnswerError::value(error.reason, "end the session"))?;
        }
        self.n_answered += 1;
        self.now = self.next();
        Ok(verdict)
    }

    fn next(&self) -> Option<Trial> {
        if let Some(trial) = self.practice.get(self.n_answered) {
            return Some(trial.clone());
        }
        let number = self.n_answered - self.practice.len();
        let (track, level_db) = self.series.level(&self.levels)?;
        let mut random = self.random.branch(&format!("trial {number}"));
        Some(Trial {
            block: 0,
            number,
            is_practice: false,
            task: Task::Interval {
                track,
                level_db,
                signal: random.index(self.levels.intervals),
            },
        })
    }
}

fn practice(levels: &Levels, n: usize, random: &Random) -> Vec<Trial> {
    let level_db = match &levels.track {
        Track::Staircase(track) => track.starts_db.iter().copied().fold(f64::MIN, f64::max),
        _ => levels.range_db[1],
    };
    let mut signals = random.branch("practice").branch("positions");
    let trial = |number| Trial {
        block: 0,
        number,
        is_practice: true,
        task: Task::Interval {
            track: 0,
            level_db,
            signal: signals.index(levels.intervals),
        },
    };
    (0..n).map(trial).collect()
}

fn staircases(
    levels: &Levels,
    track: &StaircaseTrack,
    random: &Random,
) -> Computed<Interleaved<Staircase>> {
    let one = |&start_db: &f64| {
        let stop = stop(&levels.stopping, Stop::Reversals, levels.stopping.reversals);
        Staircase::new(track.plan(start_db, levels.range_db, stop))
    };
    let made: Computed<Vec<Staircase>> = track.starts_db.iter().map(one).collect();
    Interleaved::new(made?, random.branch("tracks").seed())
}

/// The series of a session that goes by QUEST+, before its first answer.
///
/// # Errors
/// The design's numbers make no series.
pub(crate) fn quest_plus(levels: &Levels, track: &QuestPlusTrack) -> Computed<QuestPlus> {
    let [low, high] = levels.range_db.map(|db| levels.stimulus(db));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a design has at most 500 steps"
    )]
    let n_steps = ((high - low) / track.grid_db + 1e-6) as u32;
    let grid: Vec<f64> = (0..=n_steps)
        .map(|n| low + f64::from(n) * track.grid_db)
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "2 to 8 intervals")]
    let guess = Guess::Share(1.0 / levels.intervals as f64);
    let grid = QuestGrid {
        family: levels.family(),
        guess,
        stimuli: grid.clone(),
        thresholds: grid,
        widths: track.widths.clone(),
        lapses: track.lapses.clone(),
    };
    let sd = levels.stopping.posterior_sd_db;
    let mut conditions = Vec::new();
    conditions.extend((sd > 0.0).then_some(Stop::PosteriorSd(sd)));
    QuestPlus::new(grid, ended(&levels.stopping, conditions))
}

fn stop(stopping: &Stopping, of: fn(u32) -> Stop, n: usize) -> Stop {
    let n = u32::try_from(n).unwrap_or(u32::MAX);
    ended(stopping, (n > 0).then(|| of(n)).into_iter().collect())
}

/// The stated conditions joined as the design says, and an end to what would never end.
fn ended(stopping: &Stopping, mut conditions: Vec<Stop>) -> Stop {
    let trials = u32::try_from(stopping.trials).unwrap_or(u32::MAX);
    conditions.extend((trials > 0).then_some(Stop::Trials(trials)));
    let stated = if stopping.needs == Needs::All {
        Stop::All(conditions)
    } else {
        Stop::Any(conditions)
    };
    Stop::Any(vec![stated, Stop::Trials(trials.max(MOST_TRIALS))])
}
