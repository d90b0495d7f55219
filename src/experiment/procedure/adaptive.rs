//! Trials whose value depends on the answers before: staircases in turn, or QUEST+.

use super::listed::adapted_task;
use crate::ExperimentError;
use crate::design::{
    Adaptation, Design, Needs, QuestPlusTrack, Seeks, StaircaseTrack, Stopping, Track,
};
use crate::trial::{Adapted, Answer, AnswerError, Trial};
use selvedge_foundation::numerics::{Random, to_whole};
use selvedge_statistics::Computed;
use selvedge_statistics::adaptive::{
    Interleaved, Procedure as _, QuestGrid, QuestPlus, Staircase, Stop,
};
use selvedge_statistics::psychometric::Guess;

/// A series that nothing has ended after so many trials is ended: at a limit of the values no
/// reversal may ever come.
const MOST_TRIALS: u32 = 1000;

/// Values found from answers.
#[derive(Debug, Clone)]
pub(super) struct Adaptive {
    design: Design,
    adaptation: Adaptation,
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
    /// Whose turn it is and its value.
    fn next(&self, adaptation: &Adaptation) -> Option<Adapted> {
        let (track, value) = match self {
            Self::Staircases(staircases) => staircases.stimulus()?,
            Self::QuestPlus(quest) => (0, adaptation.value(quest.stimulus()?)),
        };
        Some(Adapted { track, value })
    }

    fn answer(&mut self, adaptation: &Adaptation, value: f64, is_more: bool) -> Computed<()> {
        match self {
            Self::Staircases(staircases) => staircases.answer(value, is_more),
            Self::QuestPlus(quest) => quest.answer(adaptation.stimulus(value), is_more),
        }
    }
}

impl Adaptive {
    /// The series of a session with trials of practice at the strongest value that a series begins
    /// with. `None` where values are known before.
    ///
    /// # Errors
    /// The design's numbers make no series.
    pub(super) fn of(
        design: &Design,
        adaptation: &Adaptation,
        random: &Random,
    ) -> Result<Option<Self>, ExperimentError> {
        let made = match &adaptation.track {
            Track::Staircase(track) => {
                staircases(adaptation, track, random).map(Series::Staircases)
            }
            Track::QuestPlus(track) => {
                let quest = quest_plus(adaptation, track);
                quest.map(|quest| Series::QuestPlus(Box::new(quest)))
            }
            Track::Constant { .. } => return Ok(None),
        };
        let series = made.map_err(|error| {
            let what = format!("the values make no series: {}", error.reason);
            ExperimentError::value(what, "mend [adaptation] in the design")
        })?;
        let mut adaptive = Self {
            practice: practice(design, adaptation, random),
            adaptation: adaptation.clone(),
            design: design.clone(),
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
        let stated = match self.adaptation.stopping.trials {
            0 => MOST_TRIALS as usize,
            n if self.adaptation.stopping.needs == Needs::All => n.max(MOST_TRIALS as usize),
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
        let composition = &self.design.composition;
        let verdict = composition.verdict(&trial.task, answer)?;
        if let (Some(adapted), false) = (trial.task.adapted, trial.is_practice) {
            let is_more = composition.says_more(&trial.task, answer);
            let taken = self.series.answer(&self.adaptation, adapted.value, is_more);
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
        let adapted = self.series.next(&self.adaptation)?;
        let mut random = self.random.branch(&format!("trial {number}"));
        let position = random.index(self.design.composition.presentation.n);
        Some(Trial {
            block: 0,
            number,
            is_practice: false,
            task: adapted_task(&self.design, adapted, position),
        })
    }
}

fn practice(design: &Design, adaptation: &Adaptation, random: &Random) -> Vec<Trial> {
    let value = match &adaptation.track {
        Track::Staircase(track) => track.starts.iter().copied().fold(f64::MIN, f64::max),
        _ => adaptation.range[1],
    };
    let mut positions = random.branch("practice").branch("positions");
    let mut trial = |number| {
        let position = positions.index(design.composition.presentation.n);
        Trial {
            block: 0,
            number,
            is_practice: true,
            task: adapted_task(design, Adapted { track: 0, value }, position),
        }
    };
    (0..design.course.practice_trials).map(&mut trial).collect()
}

fn staircases(
    adaptation: &Adaptation,
    track: &StaircaseTrack,
    random: &Random,
) -> Computed<Interleaved<Staircase>> {
    let one = |&start: &f64| {
        let stop = stop(
            &adaptation.stopping,
            Stop::Reversals,
            adaptation.stopping.reversals,
        );
        Staircase::new(track.plan(start, adaptation.range, stop))
    };
    let made: Computed<Vec<Staircase>> = track.starts.iter().map(one).collect();
    Interleaved::new(made?, random.branch("tracks").seed())
}

/// The series of a session that goes by QUEST+, before its first answer.
///
/// # Errors
/// The design's numbers make no series.
pub(crate) fn quest_plus(adaptation: &Adaptation, track: &QuestPlusTrack) -> Computed<QuestPlus> {
    let [low, high] = adaptation.range.map(|value| adaptation.stimulus(value));
    let n_steps: u32 = to_whole((high - low) / track.grid + 1e-6);
    let grid: Vec<f64> = (0..=n_steps)
        .map(|n| low + f64::from(n) * track.grid)
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "2 to 8 alternatives")]
    let guess = match adaptation.seeks {
        Seeks::Difference => Guess::Share(1.0 / adaptation.alternatives as f64),
        Seeks::Equality => Guess::EqualToLapse,
    };
    let grid = QuestGrid {
        family: adaptation.family(),
        guess,
        stimuli: grid.clone(),
        thresholds: grid,
        widths: track.widths.clone(),
        lapses: track.lapses.clone(),
    };
    let sd = adaptation.stopping.posterior_sd;
    let mut conditions = Vec::new();
    conditions.extend((sd > 0.0).then_some(Stop::PosteriorSd(sd)));
    QuestPlus::new(grid, ended(&adaptation.stopping, conditions))
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
