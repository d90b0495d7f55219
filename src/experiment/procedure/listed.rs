//! Trials that are known before the first answer.

use crate::ExperimentError;
use crate::design::{
    Adjusting, Design, Judging, JudgingProtocol, Levels, Method, Subject, Track, TunedParameter,
};
use crate::schedule::{RankingSchedule, rounds, triads};
use crate::trial::{Task, Trial};
use selvedge_foundation::numerics::Random;

/// Trials of a subject: practice, then those that count.
///
/// # Errors
/// The design has no schedule.
pub(super) fn trials(
    design: &Design,
    subject: &Subject,
    random: &Random,
) -> Result<Vec<Trial>, ExperimentError> {
    let asked = tasks(design, subject, &random.branch("practice"))?;
    let n_practice = design.course.practice_trials;
    let practice = asked.into_iter().flatten().take(n_practice).enumerate();
    let mut trials: Vec<Trial> = practice
        .map(|(number, task)| Trial {
            block: 0,
            number,
            is_practice: true,
            task,
        })
        .collect();
    let n_practised = trials.len();
    for (block, tasks) in tasks(design, subject, random)?.into_iter().enumerate() {
        for task in tasks {
            trials.push(Trial {
                block,
                number: trials.len() - n_practised,
                is_practice: false,
                task,
            });
        }
    }
    Ok(trials)
}

/// Tasks by block.
fn tasks(
    design: &Design,
    subject: &Subject,
    random: &Random,
) -> Result<Vec<Vec<Task>>, ExperimentError> {
    let n = design.stimuli.len();
    let blocks = match &design.method {
        Method::Ranking(_) => return ranking(n, random),
        Method::OddOneOut(_) => vec![odd_one_out(n, subject.nth, random)],
        Method::Adjustment(adjusting) => adjustment(n, adjusting, random),
        Method::Judgement(judging) => judgement(design, judging, random),
        Method::Levels(levels) => constant(levels, random),
        Method::Magnitude { repeats, .. } => {
            each(n, *repeats, random, |item| Task::Estimate { item })
        }
        Method::Rating(rating) => each(n, rating.repeats, random, |item| Task::Rate { item }),
    };
    Ok(blocks)
}

fn ranking(n: usize, random: &Random) -> Result<Vec<Vec<Task>>, ExperimentError> {
    let schedule = RankingSchedule::of(n, random)?;
    let mut blocks: Vec<Vec<Task>> = Vec::new();
    for trial in schedule.trials {
        blocks.resize_with(blocks.len().max(trial.block + 1), Vec::new);
        blocks[trial.block].push(Task::Rank {
            target: trial.target,
            alternatives: trial.alternatives,
        });
    }
    Ok(blocks)
}

fn odd_one_out(n: usize, nth_subject: usize, random: &Random) -> Vec<Task> {
    let task = |triad: crate::schedule::Triad| Task::OddOne {
        items: triad.items(),
        odd: triad.position,
    };
    triads(n, nth_subject, random)
        .into_iter()
        .map(task)
        .collect()
}

/// Every stimulus once a block.
fn each(n: usize, repeats: usize, random: &Random, task: impl Fn(usize) -> Task) -> Vec<Vec<Task>> {
    let rounds = rounds(n, repeats, &mut random.branch("order"));
    let block = |round: Vec<usize>| round.into_iter().map(&task).collect();
    rounds.into_iter().map(block).collect()
}

/// Parameters begin in the upper or the lower third of their range, each as often for every
/// stimulus, which of them first by chance.
fn adjustment(n: usize, adjusting: &Adjusting, random: &Random) -> Vec<Vec<Task>> {
    let mut starts = random.branch("starts");
    let n_parameters = adjusting.parameters.len();
    let turned: Vec<usize> = (0..n).map(|_| starts.index(1 << n_parameters)).collect();
    let rounds = rounds(n, adjusting.repeats, &mut random.branch("order"));
    let block = |(nth, round): (usize, Vec<usize>)| {
        let task = |item: usize| {
            // Counts 00, 01, 10, 11 where two are turned: all four after four rounds.
            let is_high = |parameter: usize| ((nth ^ turned[item]) >> parameter) & 1 == 1;
            let parameters = adjusting.parameters.iter().enumerate();
            let begin = |(at, parameter): (usize, &TunedParameter)| {
                start(parameter, is_high(at), &mut starts)
            };
            Task::Adjust {
                item,
                starts: parameters.map(begin).collect(),
            }
        };
        round.into_iter().map(task).collect()
    };
    rounds.into_iter().enumerate().map(block).collect()
}

/// A value in a third of a parameter's range, a whole number of steps from its lower end.
fn start(parameter: &TunedParameter, is_high: bool, random: &mut Random) -> f64 {
    let third = (parameter.to - parameter.from) / 3.0;
    let low = if is_high {
        parameter.to - third
    } else {
        parameter.from
    };
    let value = random.uniform_in(low, low + third);
    let steps = ((value - parameter.from) / parameter.step).round();
    (parameter.from + steps * parameter.step).clamp(parameter.from, parameter.to)
}

fn judgement(design: &Design, judging: &Judging, random: &Random) -> Vec<Vec<Task>> {
    let is_real = |item: usize| design.stimuli[item].condition == judging.real;
    let n = design.stimuli.len();
    if judging.protocol == JudgingProtocol::Single {
        let task = |item| Task::Judge {
            item,
            is_real: is_real(item),
        };
        return each(n, judging.repeats, random, task);
    }
    let pairs = pairs(design, judging);
    let mut positions = random.branch("positions");
    let turned: Vec<usize> = pairs.iter().map(|_| positions.index(2)).collect();
    let rounds = rounds(pairs.len(), judging.repeats, &mut random.branch("order"));
    let block = |(nth, round): (usize, Vec<usize>)| {
        let task = |pair: usize| {
            let real = (nth + turned[pair]) % 2;
            let [first, second] = pairs[pair];
            let items = if real == 0 {
                [first, second]
            } else {
                [second, first]
            };
            Task::JudgePair { items, real }
        };
        round.into_iter().map(task).collect()
    };
    rounds.into_iter().enumerate().map(block).collect()
}

/// Each generated stimulus with every real one of its material: [real, generated].
fn pairs(design: &Design, judging: &Judging) -> Vec<[usize; 2]> {
    let stimuli = &design.stimuli;
    let is_real = |item: &usize| stimuli[*item].condition == judging.real;
    let (real, generated): (Vec<usize>, Vec<usize>) = (0..stimuli.len()).partition(is_real);
    let of = |generated: usize| {
        let is_its = move |real: &usize| stimuli[*real].material == stimuli[generated].material;
        real.clone()
            .into_iter()
            .filter(is_its)
            .map(move |real| [real, generated])
    };
    generated.into_iter().flat_map(of).collect()
}

/// Every level once a block; the signal stands in each interval as often, or once more.
fn constant(levels: &Levels, random: &Random) -> Vec<Vec<Task>> {
    let Track::Constant { levels_db, repeats } = &levels.track else {
        return Vec::new();
    };
    let n = levels_db.len();
    let mut signals: Vec<usize> = (0..n * repeats).map(|nth| nth % levels.intervals).collect();
    random.branch("positions").shuffle(&mut signals);
    let mut signals = signals.into_iter();
    let rounds = rounds(n, *repeats, &mut random.branch("order"));
    let block = |round: Vec<usize>| {
        let task = |level: usize| Task::Interval {
            track: 0,
            level_db: levels_db[level],
            signal: signals.next().unwrap_or(0),
        };
        round.into_iter().map(task).collect()
    };
    rounds.into_iter().map(block).collect()
}
