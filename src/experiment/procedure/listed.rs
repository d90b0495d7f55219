//! Trials that are known before the first answer.

use crate::ExperimentError;
use crate::design::{
    Adaptation, Composition, Design, Form, Order, Right, Sequence, Sets, Subject, Track,
    TunedParameter,
};
use crate::schedule::{RankingSchedule, Triad, balanced_sets, rounds, square_rounds, triads};
use crate::trial::{Adapted, Task, Trial};
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
    let Composition {
        order, adaptation, ..
    } = &design.composition;
    let n = design.stimuli.len();
    let blocks = match order.sets {
        Sets::Each => each(design, subject, random),
        Sets::Pairs | Sets::Opposed => pairs(design, subject, random),
        Sets::Triads => {
            let block = |nth| odd_ones(n, subject.nth + nth, &repeat(random, nth));
            (0..order.repeats).map(block).collect()
        }
        Sets::Targets if design.composition.presentation.n == 2 => matches(n, order, random),
        Sets::Targets => ranking(n, order, random)?,
        Sets::Balanced => {
            let sets = balanced_sets(
                (n, design.composition.presentation.n),
                order.repeats,
                random,
            );
            vec![sets.into_iter().map(of_items).collect()]
        }
        Sets::All => (0..order.repeats)
            .map(|nth| {
                let mut items: Vec<usize> = (0..n).collect();
                repeat(random, nth).branch("positions").shuffle(&mut items);
                vec![of_items(items)]
            })
            .collect(),
        Sets::Adapted => adaptation
            .as_ref()
            .map_or_else(Vec::new, |adaptation| constant(design, adaptation, random)),
    };
    Ok(blocks)
}

/// The generator of one of several repeats; the first is that of a session without repeats.
fn repeat(random: &Random, nth: usize) -> Random {
    match nth {
        0 => random.clone(),
        nth => random.branch(&format!("repeat {nth}")),
    }
}

fn of_items(items: Vec<usize>) -> Task {
    Task {
        items,
        ..Task::default()
    }
}

fn ranking(n: usize, order: &Order, random: &Random) -> Result<Vec<Vec<Task>>, ExperimentError> {
    let mut blocks: Vec<Vec<Task>> = Vec::new();
    for nth in 0..order.repeats {
        let first = blocks.len();
        for trial in RankingSchedule::of(n, &repeat(random, nth))?.trials {
            blocks.resize_with(blocks.len().max(first + trial.block + 1), Vec::new);
            let is_target = |item: &usize| *item == trial.target;
            blocks[first + trial.block].push(Task {
                reference: Some(trial.target),
                right: trial.alternatives.iter().position(is_target),
                ..of_items(trial.alternatives.to_vec())
            });
        }
    }
    Ok(blocks)
}

fn odd_ones(n: usize, nth_subject: usize, random: &Random) -> Vec<Task> {
    let task = |triad: Triad| Task {
        right: Some(triad.position),
        ..of_items(triad.items().to_vec())
    };
    triads(n, nth_subject, random)
        .into_iter()
        .map(task)
        .collect()
}

/// Orders of 0…n−1, block by block.
fn orders(n: usize, order: &Order, subject: &Subject, random: &Random) -> Vec<Vec<usize>> {
    let mut chance = random.branch("order");
    match order.sequence {
        Sequence::Random => rounds(n, order.repeats, &mut chance),
        square => {
            let first_row = subject.nth * order.repeats;
            square_rounds(
                n,
                first_row..first_row + order.repeats,
                square == Sequence::Williams,
            )
        }
    }
}

/// Every stimulus once a block, with what it is compared with and where parameters begin.
fn each(design: &Design, subject: &Subject, random: &Random) -> Vec<Vec<Task>> {
    let composition = &design.composition;
    let parameters = composition.parameters();
    let mut starts = random.branch("starts");
    let n = design.stimuli.len();
    // Without parameters nothing is drawn.
    let turned: Vec<usize> = (0..n)
        .map(|_| starts.index(1 << parameters.len()))
        .collect();
    let condition = composition.right_condition();
    let rounds = orders(n, &composition.order, subject, random);
    let block = |(nth, round): (usize, Vec<usize>)| {
        let task = |item: usize| Task {
            reference: composition.presentation.standard,
            right: condition.map(|real| usize::from(design.stimuli[item].condition != real)),
            starts: begun(parameters, nth ^ turned[item], &mut starts),
            ..of_items(vec![item])
        };
        round.into_iter().map(task).collect()
    };
    rounds.into_iter().enumerate().map(block).collect()
}

/// Parameters begin in the upper or the lower third of their range, each as often for every
/// stimulus: `turn` counts 00, 01, 10, 11 where two are turned, all four after four rounds.
fn begun(parameters: &[TunedParameter], turn: usize, random: &mut Random) -> Vec<f64> {
    let parameters = parameters.iter().enumerate();
    let begin = |(at, parameter): (usize, &TunedParameter)| {
        let is_high = (turn >> at) & 1 == 1;
        start(parameter, is_high, random)
    };
    parameters.map(begin).collect()
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

/// Every pair once a block, on the sides in turn, which first by chance.
fn pairs(design: &Design, subject: &Subject, random: &Random) -> Vec<Vec<Task>> {
    let composition = &design.composition;
    let pairs = match composition.order.sets {
        Sets::Opposed => opposed(design),
        _ => all_pairs(
            design.stimuli.len(),
            composition.response.form == Form::SameDifferent,
        ),
    };
    let mut positions = random.branch("positions");
    let turned: Vec<usize> = pairs.iter().map(|_| positions.index(2)).collect();
    let mut catches = random.branch("catch");
    let rounds = orders(pairs.len(), &composition.order, subject, random);
    let block = |(nth, round): (usize, Vec<usize>)| {
        let task = |pair: usize| {
            let at = (nth + turned[pair]) % 2;
            let [first, second] = pairs[pair];
            let items = if at == 0 {
                [first, second]
            } else {
                [second, first]
            };
            Task {
                right: right_of(composition, items, at),
                // The cloth is that of the one that is right, which is of the pair's material.
                reference: (composition.is_beside_cloth().then_some(first))
                    .or(composition.presentation.standard),
                ..of_items(items.to_vec())
            }
        };
        let mut tasks: Vec<Task> = round.into_iter().map(task).collect();
        for _ in 0..composition.order.catch_trials {
            let item = catches.index(design.stimuli.len());
            let catch = Task {
                is_catch: true,
                right: right_of(composition, [item; 2], 0),
                reference: composition.presentation.standard,
                ..of_items(vec![item; 2])
            };
            tasks.insert(catches.index(tasks.len() + 1), catch);
        }
        tasks
    };
    rounds.into_iter().enumerate().map(block).collect()
}

/// Which of two positions, or words, is right; `first_at` is where the pair's first stands.
fn right_of(composition: &Composition, items: [usize; 2], first_at: usize) -> Option<usize> {
    match (&composition.response.form, &composition.response.right) {
        (Form::SameDifferent, _) => Some(usize::from(items[0] != items[1])),
        (Form::Choice, Some(Right::Condition(_))) => Some(first_at),
        (Form::Choice, Some(Right::Later)) => Some(usize::from(items[1] > items[0])),
        _ => None,
    }
}

/// Every two stimuli; as many pairs of the same one where they are to be told from different ones.
fn all_pairs(n: usize, with_same: bool) -> Vec<[usize; 2]> {
    let of = |a: usize| (a + 1..n).map(move |b| [a, b]);
    let mut pairs: Vec<[usize; 2]> = (0..n).flat_map(of).collect();
    if with_same {
        let n_different = pairs.len();
        pairs.extend((0..n_different).map(|nth| [nth % n; 2]));
    }
    pairs
}

/// Each stimulus of another condition with every one of the right condition and its material:
/// [right, other].
fn opposed(design: &Design) -> Vec<[usize; 2]> {
    let stimuli = &design.stimuli;
    let condition = design.composition.right_condition();
    let is_right = |item: &usize| Some(stimuli[*item].condition.as_str()) == condition;
    let (right, others): (Vec<usize>, Vec<usize>) = (0..stimuli.len()).partition(is_right);
    let of = |other: usize| {
        let is_its = move |one: &usize| stimuli[*one].material == stimuli[other].material;
        let right = right.clone().into_iter().filter(is_its);
        right.map(move |one| [one, other])
    };
    others.into_iter().flat_map(of).collect()
}

/// Every two stimuli with a target that is one of them: of four rounds each of the two is the
/// target on each side once.
fn matches(n: usize, order: &Order, random: &Random) -> Vec<Vec<Task>> {
    let pairs = all_pairs(n, false);
    let mut positions = random.branch("positions");
    let turned: Vec<usize> = pairs.iter().map(|_| positions.index(4)).collect();
    let rounds = rounds(pairs.len(), order.repeats, &mut random.branch("order"));
    let block = |(nth, round): (usize, Vec<usize>)| {
        let task = |pair: usize| {
            let turn = (nth + turned[pair]) % 4;
            let [first, second] = pairs[pair];
            let items = if turn < 2 {
                [first, second]
            } else {
                [second, first]
            };
            Task {
                reference: Some(items[turn % 2]),
                right: Some(turn % 2),
                ..of_items(items.to_vec())
            }
        };
        round.into_iter().map(task).collect()
    };
    rounds.into_iter().enumerate().map(block).collect()
}

/// Every value once a block; the adapted one stands at each position as often, or once more.
fn constant(design: &Design, adaptation: &Adaptation, random: &Random) -> Vec<Vec<Task>> {
    let Track::Constant { values, repeats } = &adaptation.track else {
        return Vec::new();
    };
    let n_places = design.composition.presentation.n;
    let n = values.len();
    let mut signals: Vec<usize> = (0..n * repeats).map(|nth| nth % n_places).collect();
    random.branch("positions").shuffle(&mut signals);
    let mut signals = signals.into_iter();
    let rounds = rounds(n, *repeats, &mut random.branch("order"));
    let block = |round: Vec<usize>| {
        let task = |at: usize| {
            let adapted = Adapted {
                track: 0,
                value: values[at],
            };
            adapted_task(design, adapted, signals.next().unwrap_or(0))
        };
        round.into_iter().map(task).collect()
    };
    rounds.into_iter().map(block).collect()
}

/// A trial in which the stimulus at this position has this value.
pub(super) fn adapted_task(design: &Design, adapted: Adapted, position: usize) -> Task {
    let n = design.composition.presentation.n;
    Task {
        right: (n > 1).then_some(position),
        adapted: Some(adapted),
        // Of a vibration there is no stimulus: its level is all.
        ..of_items(vec![0; if design.stimuli.is_empty() { 0 } else { n }])
    }
}
