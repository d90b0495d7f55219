//! Scales from rankings: how like each target the others are, free of who else was there
//! (Plackett & Luce, and Bradley & Terry of the same rankings in pairs), and how rankings by chance
//! would look.

use super::answers::Rankings;
use super::included_trials::Experiment;
use super::model::{Cell, Section, Table, cells, or_undefined};
use super::pairs::over_subjects;
use super::tables::tests;
use selvedge_foundation::numerics::{in_pieces, n_threads};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::ranking::{BradleyTerry, PlackettLuce, Preferences, Prior, Scale};
use selvedge_statistics::{Bootstrap, Computed, Outcome, Undefined};

/// Strength of the prior that keeps worths finite where a target was always ranked first.
const STRENGTH: f64 = 0.5;

/// One target's rankings of every subject, the nearest first.
type Subjects = Vec<Vec<Vec<usize>>>;

/// What is found of one target.
struct Target {
    n_rankings: usize,
    plackett_luce: Model,
    bradley_terry: Model,
    against_chance: Computed<Outcome>,
}

/// A scale, and the errors over subjects of its values counted from the target.
struct Model {
    scale: Computed<Scale>,
    errors: Computed<Vec<f64>>,
}

/// Likeness to every target by Plackett and Luce's model.
///
/// # Errors
/// It was cancelled.
pub(super) fn section(
    experiment: &Experiment<'_>,
    all: &[Rankings<'_>],
    progress: &mut Progress<'_>,
) -> Result<Section, Cancelled> {
    let mut section = experiment.section("scale", "likeness by Plackett and Luce");
    section.note(format!(
        "Log-worth of each alternative for each target, counted from the target: 0 is taken \
         for the target as often as itself. Gamma prior of strength {STRENGTH}, as if every \
         textile had been chosen so many times more, keeps worths finite. Errors by curvature take \
         rankings for independent; errors over subjects are by leaving out each in turn."
    ));
    section.note(
        "Beside it Bradley and Terry's logits of the same rankings taken apart into pairs, with \
         the same prior. **Pairs of one ranking are not independent**: their error by curvature is \
         too small, the one over subjects is not.",
    );
    let names = experiment.ids();
    let targets = targets(names.len(), all, progress)?;
    let mut table = Table::new("likeness", "Likeness to each target", LIKENESS);
    let mut against: Vec<(String, Computed<Outcome>)> = Vec::new();
    for (target, (name, found)) in names.iter().zip(targets).enumerate() {
        for (alternative, other) in names.iter().enumerate().filter(|(a, _)| *a != target) {
            table.push(cells![
                name,
                other,
                found.n_rankings,
                found.plackett_luce.cells(alternative, target, true),
                found.bradley_terry.cells(alternative, target, false),
            ]);
        }
        against.push((format!("target {name}"), found.against_chance));
    }
    section.table(table);
    let title = "Worths against rankings by chance, without a prior";
    section.table(tests("against-chance", title, &against));
    Ok(section)
}

const LIKENESS: &str = "target; alternative; rankings; log_worth: log-worth; se: SE; ci_low: 95 % \
    CI from; ci_high: to; se_subjects: SE over subjects; subjects_ci_low: 95 % CI from; \
    subjects_ci_high: to; bradley_terry: Bradley & Terry, logits; bradley_terry_se: SE, pairs \
    independent; bradley_terry_se_subjects: SE over subjects";

impl Model {
    /// One model of rankings: of all subjects, and of draws of them.
    fn of(
        subjects: &Subjects,
        target: usize,
        fit: impl Fn(&[&[usize]]) -> Computed<Scale>,
    ) -> Self {
        let of_drawn = |drawn: &[usize]| {
            let rankings = drawn.iter().flat_map(|at| &subjects[*at]);
            let rankings: Vec<&[usize]> = rankings.map(Vec::as_slice).collect();
            fit(&rankings)
        };
        let everyone: Vec<usize> = (0..subjects.len()).collect();
        let from_target = |drawn: &[usize]| {
            let values = of_drawn(drawn)?.values;
            Ok(values.iter().map(|value| value - values[target]).collect())
        };
        Self {
            scale: of_drawn(&everyone),
            errors: Bootstrap::jackknife_errors(subjects.len(), from_target),
        }
    }

    fn cells(&self, alternative: usize, target: usize, with_ends: bool) -> Vec<Cell> {
        let scale = self.scale.as_ref().map_err(Clone::clone);
        let lead = scale.and_then(|scale| scale.difference(alternative, target));
        let found = lead.map(|lead| {
            let mut over = over_subjects(lead.value, &self.errors, alternative);
            if with_ends {
                return cells![lead.value, lead.se, lead.interval(0.95), over];
            }
            over.truncate(1);
            cells![lead.value, lead.se, over]
        });
        or_undefined(found, if with_ends { 7 } else { 3 })
    }
}

/// Every target, on several threads.
fn targets(
    n_items: usize,
    all: &[Rankings<'_>],
    progress: &mut Progress<'_>,
) -> Result<Vec<Target>, Cancelled> {
    let mut found: Vec<Option<Target>> = (0..n_items).map(|_| None).collect();
    let n_together = 2 * n_threads();
    for (nth, some) in found.chunks_mut(n_together).enumerate() {
        let first = nth * n_together;
        progress.step(first as f64 / n_items as f64, "likeness to targets")?;
        in_pieces(
            some,
            1,
            n_threads(),
            || (),
            |(), number, piece| {
                piece[0] = Some(of_target(n_items, first + number, all));
            },
        );
    }
    Ok(found.into_iter().flatten().collect())
}

fn of_target(n_items: usize, target: usize, all: &[Rankings<'_>]) -> Target {
    let rankings = |one: &Rankings<'_>| {
        let own = one.trials.iter().filter(|trial| trial.target == target);
        own.map(selvedge_statistics::ranking::RankTrial::best_first)
            .collect()
    };
    let subjects: Subjects = all.iter().map(rankings).collect();
    let together: Vec<&[usize]> = subjects.iter().flatten().map(Vec::as_slice).collect();
    let prior = Prior::Gamma(STRENGTH);
    Target {
        n_rankings: together.len(),
        plackett_luce: Model::of(&subjects, target, |rankings| {
            Ok(PlackettLuce::fit(n_items, rankings, prior)?.scale)
        }),
        bradley_terry: Model::of(&subjects, target, |rankings| {
            if rankings.is_empty() {
                return Err(Undefined::because("no rankings"));
            }
            let pairs = Preferences::of_rankings(n_items, rankings)?;
            Ok(BradleyTerry::fit(&pairs, prior)?.scale)
        }),
        against_chance: PlackettLuce::fit(n_items, &together, Prior::None)
            .and_then(|fit| fit.against_chance()),
    }
}
