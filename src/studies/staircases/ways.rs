//! Ways to find a threshold (which stimuli, and what is made of the answers), and the simulated
//! observers whose thresholds they find.

use super::Run;
use selvedge_foundation::numerics::Random;
use selvedge_statistics::adaptive::{
    ConstantStimuli, Procedure, QuestGrid, QuestPlus, Rule, Stage, Staircase, StaircasePlan, Stop,
};
use selvedge_statistics::psychometric::{Family, Guess, Model, Psychometric};
use selvedge_statistics::{Computed, Undefined};

/// Width from 5 % to 95 % that every way assumes where it assumes one, dB.
pub(super) const ASSUMED_WIDTH_DB: f64 = 10.0;
/// Share right of a guess among three alternatives.
pub(super) const GUESS: f64 = 1.0 / 3.0;

/// An observer but for its threshold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observer {
    pub(super) name: &'static str,
    pub(super) lapse: f64,
    pub(super) width_db: f64,
}

impl Observer {
    /// Without and with lapses, as steep as assumed and half as steep.
    pub(super) fn all() -> [Self; 4] {
        let observer = |name, lapse, width_db| Self {
            name,
            lapse,
            width_db,
        };
        let shallow_db = 2.0 * ASSUMED_WIDTH_DB;
        [
            observer("no lapses, slope as assumed", 0.0, ASSUMED_WIDTH_DB),
            observer("2 % lapses, slope as assumed", 0.02, ASSUMED_WIDTH_DB),
            observer("no lapses, half as steep as assumed", 0.0, shallow_db),
            observer("2 % lapses, half as steep as assumed", 0.02, shallow_db),
        ]
    }

    /// Its function with this threshold.
    pub(super) fn curve(&self, threshold_db: f64) -> Psychometric {
        Psychometric {
            family: Family::Gumbel,
            threshold: threshold_db,
            width: self.width_db,
            guess: GUESS,
            lapse: self.lapse,
        }
    }
}

/// Which run of which seed.
type RunOf = (u64, usize);

/// A way to find a threshold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    pub(super) name: &'static str,
    /// A session of so many trials before its first, in decibels about where the threshold may be.
    pub(super) session: fn(RunOf, u32) -> Computed<Session>,
    /// Whether its reversals tell the threshold, and not a fit to all trials.
    is_by_reversals: bool,
}

const fn way(
    name: &'static str,
    session: fn(RunOf, u32) -> Computed<Session>,
    is_by_reversals: bool,
) -> Way {
    Way {
        name,
        session,
        is_by_reversals,
    }
}

/// Every way; the product's own staircases first.
pub(super) const WAYS: [Way; 7] = [
    way("1 up 2 down, reversals", two_down, true),
    way("1 up 2 down, fit", two_down, false),
    way("weighted 3 : 1, reversals", weighted, true),
    way("weighted 3 : 1, fit", weighted, false),
    way(
        "QUEST+",
        |_, n| quest(&[5.0, 7.0, 10.0, 14.0, 20.0, 28.0], n),
        false,
    ),
    way(
        "QUEST+, slope assumed",
        |_, n| quest(&[ASSUMED_WIDTH_DB], n),
        false,
    ),
    way("constant stimuli, fit", constant, false),
];

fn two_down(_: RunOf, n_trials: u32) -> Computed<Session> {
    staircase(Rule::one_up(2), [[4.0, 4.0], [2.0, 2.0]], n_trials)
}

fn weighted(_: RunOf, n_trials: u32) -> Computed<Session> {
    staircase(Rule::one_up(1), [[6.0, 2.0], [3.0, 1.0]], n_trials)
}

/// Steps up and down until two reversals, and from then on.
fn staircase(rule: Rule, steps: [[f64; 2]; 2], n_trials: u32) -> Computed<Session> {
    let stage = |[up, down]: [f64; 2], n_reversals| Stage {
        up,
        down,
        n_reversals,
    };
    let plan = StaircasePlan {
        stages: vec![stage(steps[0], 2), stage(steps[1], 0)],
        limits: [-60.0, 30.0],
        stop: Stop::Trials(n_trials),
        ..StaircasePlan::steady(rule, 20.0, [1.0, 1.0])
    };
    Staircase::new(plan).map(Session::Staircase)
}

fn quest(widths: &[f64], n_trials: u32) -> Computed<Session> {
    let quest = QuestPlus::new(grid(widths.to_vec()), Stop::Trials(n_trials))?;
    Ok(Session::Quest(Box::new(quest)))
}

fn constant((seed, run): RunOf, n_trials: u32) -> Computed<Session> {
    let stimuli = [-12.0, -6.0, 0.0, 6.0, 12.0];
    let n_rounds = n_trials.div_ceil(5) as usize;
    let run = u64::try_from(run).unwrap_or(u64::MAX);
    let constant = ConstantStimuli::new(&stimuli, n_rounds, seed.wrapping_add(run))?;
    Ok(Session::Constant(constant))
}

/// A procedure, whichever it is.
#[derive(Debug, Clone)]
pub(super) enum Session {
    Staircase(Staircase),
    Quest(Box<QuestPlus>),
    Constant(ConstantStimuli),
}

impl Session {
    fn procedure(&mut self) -> &mut dyn Procedure {
        match self {
            Self::Staircase(staircase) => staircase,
            Self::Quest(quest) => quest.as_mut(),
            Self::Constant(constant) => constant,
        }
    }
}

impl Way {
    /// The threshold that a session came to, with the share right that it is the threshold of;
    /// `None` for F = ½.
    pub(super) fn threshold_db(self, session: &Session) -> Computed<(f64, Option<f64>)> {
        match session {
            Session::Staircase(staircase) if self.is_by_reversals => {
                let mean = staircase.reversal_mean(staircase.reversals().len())?;
                Ok((mean.threshold, Some(mean.target)))
            }
            Session::Staircase(staircase) => fitted(staircase),
            Session::Constant(constant) => fitted(constant),
            Session::Quest(quest) => Ok((quest.summary().threshold.mean, None)),
        }
    }

    /// The errors of one run after so many trials, dB.
    pub(super) fn errors_db(self, observer: &Observer, at: &[u32], run: RunOf) -> Run {
        let n_trials = at.iter().copied().max().unwrap_or(0);
        let mut random = random_of(run);
        let curve = observer.curve(random.uniform_in(-3.0, 3.0));
        let Ok(mut session) = (self.session)(run, n_trials) else {
            return vec![None; at.len()];
        };
        let mut errors = Vec::with_capacity(at.len());
        for &n_trials in at {
            let went = continued(session.procedure(), &curve, n_trials, &mut random);
            let error = went.and_then(|()| {
                let (found_db, target) = self.threshold_db(&session)?;
                let true_db = target.map_or(Ok(curve.threshold), |p| curve.stimulus_at(p))?;
                Ok(found_db - true_db)
            });
            errors.push(error.ok());
        }
        errors
    }

    /// One session of so many trials.
    pub(super) fn run(self, observer: &Observer, n: u32, run: RunOf) -> Computed<Session> {
        let mut session = (self.session)(run, n)?;
        answer(session.procedure(), observer, 0.0, (n as usize, run.0))?;
        Ok(session)
    }
}

fn random_of((seed, run): RunOf) -> Random {
    Random::new(seed).branch(&format!("observer of run {run}"))
}

/// Answers so many trials of an observer with this threshold.
pub(super) fn answer(
    procedure: &mut dyn Procedure,
    observer: &Observer,
    threshold_db: f64,
    (n_trials, seed): (usize, u64),
) -> Computed<()> {
    let n_trials = u32::try_from(n_trials).unwrap_or(u32::MAX);
    let curve = observer.curve(threshold_db);
    continued(procedure, &curve, n_trials, &mut random_of((seed, 0)))
}

fn continued(
    procedure: &mut dyn Procedure,
    curve: &Psychometric,
    n_trials: u32,
    random: &mut Random,
) -> Computed<()> {
    while procedure.trials().len() < n_trials as usize {
        let stimulus = procedure.stimulus();
        let stimulus = stimulus.ok_or_else(|| Undefined::because("over before its time"))?;
        procedure.answer(stimulus, random.uniform() < curve.at(stimulus))?;
    }
    Ok(())
}

fn fitted(procedure: &impl Procedure) -> Computed<(f64, Option<f64>)> {
    let fit =
        Model::alternatives(Family::Gumbel, 3, [ASSUMED_WIDTH_DB, 0.5]).fit(&procedure.blocks())?;
    Ok((fit.curve.threshold, None))
}

fn grid(widths: Vec<f64>) -> QuestGrid {
    QuestGrid {
        family: Family::Gumbel,
        guess: Guess::Share(GUESS),
        stimuli: (-15..=15).map(|i| 2.0 * f64::from(i)).collect(),
        thresholds: (-25..=25).map(|i| 0.8 * f64::from(i)).collect(),
        widths,
        lapses: vec![0.0, 0.02, 0.04],
    }
}

/// QUEST+ on a grid of 100 × 50 × 50 × 6.
pub(super) fn large_quest() -> Computed<QuestPlus> {
    let along = |n: u32, [from, to]: [f64; 2]| -> Vec<f64> {
        let step = (to - from) / f64::from(n - 1);
        (0..n).map(|i| from + step * f64::from(i)).collect()
    };
    let large = QuestGrid {
        stimuli: along(100, [-30.0, 30.0]),
        thresholds: along(50, [-20.0, 20.0]),
        lapses: along(6, [0.0, 0.05]),
        ..grid(along(50, [2.0, 30.0]))
    };
    QuestPlus::new(large, Stop::Trials(1000))
}
