//! What a design comes to before it is used: trials, duration, how even it is, and how likely a
//! study finds an effect of a stated size.
//!
//! All of it is counted from the schedules that the subjects would get, and simulated from there.

use std::collections::BTreeMap;

use super::ExperimentError;
use super::design::{Design, Kind, Sets, Subject};
use super::procedure::Procedure;
use super::trial::Trial;
use selvedge_foundation::numerics::Random;
use selvedge_statistics::{Summary, one_sample_t};

/// Simulated studies that power is a share of.
const N_STUDIES: usize = 2000;
/// Studies find an effect whose p is below this.
const ALPHA: f64 = 0.05;
/// From an answer to the next trial, s.
const BETWEEN_S: f64 = 2.0;

/// What is to be looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreviewOptions {
    /// Subjects; the design's own number, or 8 where it leaves that open.
    pub n_subjects: Option<usize>,
    /// The effect: d′ of a trial where answers are right or wrong, else standard deviations over
    /// subjects.
    pub effect: f64,
    /// What chance begins with.
    pub seed: u64,
}

/// What a design comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    /// Subjects that were looked at.
    pub n_subjects: usize,
    /// Trials of a session that count, at most, and blocks.
    pub n_trials: usize,
    /// Trials of practice.
    pub n_practice: usize,
    /// Blocks.
    pub n_blocks: usize,
    /// How long a session takes, s: an answer as long as is assumed, breaks at their least.
    pub duration_s: f64,
    /// Played in a trial and the answer that is assumed, s.
    pub trial_s: [f64; 2],
    /// What is counted, evenest possible or not.
    pub balance: Vec<Balance>,
    /// How likely the study finds the effect.
    pub power: Power,
}

/// How often something comes, of all that could.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Balance {
    /// What is counted.
    pub what: &'static str,
    /// The fewest and the most times.
    pub times: [usize; 2],
    /// How many of these there are.
    pub n: usize,
}

impl Balance {
    /// Whether all come as often, or once more.
    pub fn is_even(&self) -> bool {
        self.times[1] <= self.times[0] + 1
    }
}

/// How likely a study finds an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Power {
    /// The share of simulated studies that find it.
    pub share: f64,
    /// Simulated studies.
    pub n_studies: usize,
    /// The effect, and how it is tested.
    pub described: String,
}

impl Preview {
    /// Of a design.
    ///
    /// # Errors
    /// The design has no schedule, or the effect is no number.
    pub fn of(design: &Design, options: &PreviewOptions) -> Result<Self, ExperimentError> {
        if !options.effect.is_finite() || options.effect < 0.0 {
            let what = format!("the effect is {}", options.effect);
            return Err(ExperimentError::value(
                what,
                "give a number from 0, such as 1",
            ));
        }
        let planned = Some(design.rules.subjects).filter(|n| *n > 0);
        let n_subjects = options.n_subjects.or(planned).unwrap_or(8).max(1);
        let sessions: Result<Vec<Vec<Trial>>, ExperimentError> =
            (0..n_subjects).map(|nth| trials_of(design, nth)).collect();
        let sessions = sessions?;
        let first = sessions.first().map_or(&[][..], Vec::as_slice);
        let counted = |trial: &&Trial| !trial.is_practice;
        // What is adapted is not known before the answers: the most that there may be.
        let subject = subject_of(0);
        let n_all = Procedure::of(design, &subject)?.n_trials();
        let n_practice = design.course.practice_trials.min(n_all);
        let n_trials = n_all - n_practice;
        let n_blocks = first
            .iter()
            .filter(counted)
            .map(|trial| trial.block + 1)
            .max();
        Ok(Self {
            n_subjects,
            n_trials,
            n_practice,
            n_blocks: n_blocks.unwrap_or(1),
            duration_s: duration_s(design, n_all, n_blocks.unwrap_or(1)),
            trial_s: design.composition.trial_s(),
            balance: balance(design, &sessions),
            power: power(design, (n_subjects, n_trials), options),
        })
    }

    /// What is not even, in words.
    pub fn deviations(&self) -> Vec<String> {
        let uneven = self.balance.iter().filter(|one| !one.is_even());
        let words = |one: &Balance| {
            let [fewest, most] = one.times;
            format!("{}: {fewest} to {most} times", one.what)
        };
        uneven.map(words).collect()
    }
}

fn subject_of(nth: usize) -> Subject {
    Subject {
        pseudonym: format!("p{:02}", nth + 1),
        nth,
        session: 1,
    }
}

/// The trials of a subject that are known before the first answer.
fn trials_of(design: &Design, nth: usize) -> Result<Vec<Trial>, ExperimentError> {
    let procedure = Procedure::of(design, &subject_of(nth))?;
    Ok(procedure.listed().to_vec())
}

fn duration_s(design: &Design, n_trials: usize, n_blocks: usize) -> f64 {
    let course = &design.course;
    let [played_s, answer_s] = design.composition.trial_s();
    let after = course.break_after_blocks;
    let n_breaks = (n_blocks.max(1) - 1).checked_div(after).unwrap_or(0);
    let movements_s: f64 = course.familiarisation.iter().map(|one| one.for_s).sum();
    n_trials as f64 * (played_s + answer_s + BETWEEN_S)
        + n_breaks as f64 * course.break_s
        + movements_s
}

/// The fewest and the most of all that could come.
fn counted(
    what: &'static str,
    all: impl Iterator<Item = (usize, usize)>,
    counts: &BTreeMap<(usize, usize), usize>,
) -> Option<Balance> {
    let times: Vec<usize> = all
        .map(|one| counts.get(&one).copied().unwrap_or(0))
        .collect();
    Some(Balance {
        what,
        times: [*times.iter().min()?, *times.iter().max()?],
        n: times.len(),
    })
}

/// How even schedules are: positions, pairs, what follows what, and where the right one stands.
fn balance(design: &Design, sessions: &[Vec<Trial>]) -> Vec<Balance> {
    let (n, n_places) = (design.stimuli.len(), design.composition.presentation.n);
    let mut found = Vec::new();
    let trials = || {
        let all = sessions.iter().flatten();
        all.filter(|trial| !trial.is_practice && !trial.task.is_catch)
    };
    if trials().next().is_none() {
        return found;
    }
    let every_two = || (0..n).flat_map(|b| (0..b).map(move |a| (a, b)));
    if n_places > 1 && n > 1 {
        let (mut at, mut met) = (BTreeMap::new(), BTreeMap::new());
        for trial in trials() {
            let items = &trial.task.items;
            for (position, &item) in items.iter().enumerate() {
                *at.entry((item, position)).or_insert(0) += 1;
                for &other in &items[..position] {
                    *met.entry((item.min(other), item.max(other))).or_insert(0) += 1;
                }
            }
        }
        let places = (0..n).flat_map(|item| (0..n_places).map(move |at| (item, at)));
        found.extend(counted("a stimulus at a position", places, &at));
        if design.composition.order.sets != Sets::Opposed {
            found.extend(counted(
                "two stimuli together in a trial",
                every_two(),
                &met,
            ));
        }
        found.extend(wrong_together(design, sessions));
    } else if n > 2 {
        let mut after = BTreeMap::new();
        for session in sessions {
            for pair in session
                .windows(2)
                .filter(|pair| pair[0].block == pair[1].block)
            {
                let [a, b] = [&pair[0].task, &pair[1].task].map(|task| task.item().unwrap_or(0));
                *after.entry((a, b)).or_insert(0) += 1;
            }
        }
        let all = (0..n).flat_map(|a| (0..n).filter(move |b| *b != a).map(move |b| (a, b)));
        found.extend(counted("a stimulus right after another", all, &after));
    }
    let mut right = BTreeMap::new();
    for position in trials().filter_map(|trial| trial.task.right) {
        *right.entry((position, 0)).or_insert(0) += 1;
    }
    if !right.is_empty() {
        let all = (0..design.composition.n_choices()).map(|at| (at, 0));
        found.extend(counted("the right answer at a position", all, &right));
    }
    found
}

/// How often two are wrong alternatives together in one session, where there is a target.
fn wrong_together(design: &Design, sessions: &[Vec<Trial>]) -> Option<Balance> {
    let composition = &design.composition;
    let is_ranked = composition.order.sets == Sets::Targets && composition.presentation.n > 2;
    let first = sessions.first().filter(|_| is_ranked)?;
    let mut met = BTreeMap::new();
    for trial in first.iter().filter(|trial| !trial.is_practice) {
        let wrong = trial
            .task
            .items
            .iter()
            .filter(|item| Some(**item) != trial.task.reference);
        let wrong: Vec<usize> = wrong.copied().collect();
        for (at, &b) in wrong.iter().enumerate() {
            for &a in &wrong[..at] {
                *met.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
    }
    let n = design.stimuli.len();
    let all = (0..n).flat_map(|b| (0..b).map(move |a| (a, b)));
    counted("two wrong alternatives together, in a session", all, &met)
}

/// The share of right answers at a distance d′; `None` where nothing is right or wrong.
fn share_right(design: &Design, d_prime: f64) -> Option<(f64, f64)> {
    let composition = &design.composition;
    let share = match composition.relation() {
        Some(relation) => relation.share(d_prime).ok()?,
        // Yes and no without bias: half of d′ on either side of the criterion.
        None if composition.order.sets == Sets::Each
            && matches!(composition.kind(), Kind::Judgement | Kind::Choice) =>
        {
            selvedge_statistics::normal_lower(0.5 * d_prime)
        }
        None => return None,
    };
    let chance = 1.0 / composition.n_choices() as f64;
    Some((share, chance))
}

/// The share of studies in which the mean over subjects differs from nothing, or from guessing.
fn power(
    design: &Design,
    (n_subjects, n_trials): (usize, usize),
    options: &PreviewOptions,
) -> Power {
    let random = Random::new(options.seed).branch("power");
    let known = share_right(design, options.effect);
    let mut n_found = 0;
    for study in 0..N_STUDIES {
        let mut random = random.branch(&format!("study {study}"));
        let mut of_subject = |_| match known {
            Some((share, chance)) => {
                let right = (0..n_trials).filter(|_| random.uniform() < share).count();
                right as f64 / n_trials.max(1) as f64 - chance
            }
            None => options.effect + random.normal(),
        };
        let values: Vec<f64> = (0..n_subjects).map(&mut of_subject).collect();
        let test = Summary::of(&values).and_then(|summary| one_sample_t(&summary, 0.0));
        n_found += usize::from(test.is_ok_and(|test| test.p < ALPHA));
    }
    let described = match known {
        Some((share, chance)) => format!(
            "d′ of {} in every subject, {:.1} % right where guesses give {:.1} %; one-sample t \
             over subjects, p < {ALPHA}",
            options.effect,
            100.0 * share,
            100.0 * chance
        ),
        None => format!(
            "{} standard deviations over subjects; one-sample t of {n_subjects}, p < {ALPHA}",
            options.effect
        ),
    };
    Power {
        share: n_found as f64 / N_STUDIES as f64,
        n_studies: N_STUDIES,
        described,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn preview(name: &str, effect: f64) -> Preview {
        let design = Design::shipped(name).unwrap();
        let options = PreviewOptions {
            n_subjects: None,
            effect,
            seed: 1,
        };
        Preview::of(&design, &options).unwrap()
    }

    #[test]
    fn sixteen_textiles_are_ranked_evenly_and_ten_are_not() {
        let found = preview("ranking-virtual-target", 1.0);
        assert_eq!(
            (found.n_trials, found.n_practice, found.n_blocks),
            (80, 4, 5)
        );
        assert!(found.deviations().is_empty(), "{:?}", found.balance);
        // 84 of 52 s, four breaks of 120 s, a minute of movements.
        assert!((found.duration_s - (84.0 * 52.0 + 480.0 + 60.0)).abs() < 1e-9);
        let text = Design::shipped_text("ranking-virtual-target").unwrap();
        let from = text.find("    \"polyester-interlock\"").unwrap();
        let to = from + text[from..].find(']').unwrap();
        let ten = format!("{}{}", &text[..from], &text[to..]);
        let design = Design::from_toml(&ten, std::path::Path::new("ten.toml"));
        let design = design.unwrap();
        assert_eq!(design.stimuli.len(), 10);
        let options = PreviewOptions {
            n_subjects: Some(1),
            effect: 1.0,
            seed: 1,
        };
        let found = Preview::of(&design, &options).unwrap();
        let deviations = found.deviations().join("; ");
        assert!(
            deviations.contains("wrong alternatives together"),
            "{deviations}"
        );
    }

    #[test]
    fn without_an_effect_a_study_finds_one_as_often_as_it_may() {
        for name in ["odd-one-out", "rating"] {
            let share = preview(name, 0.0).power.share;
            assert!(share < 0.08, "{name}: {share}");
        }
        let few = preview("odd-one-out", 0.5).power.share;
        let many = preview("odd-one-out", 2.0).power.share;
        assert!(few < many && many > 0.8, "{few} {many}");
    }

    #[test]
    fn an_effect_that_is_no_number_is_refused() {
        let design = Design::shipped("rating").unwrap();
        for effect in [f64::NAN, -1.0] {
            let options = PreviewOptions {
                n_subjects: Some(3),
                effect,
                seed: 1,
            };
            assert!(Preview::of(&design, &options).is_err(), "{effect}");
        }
    }
}
