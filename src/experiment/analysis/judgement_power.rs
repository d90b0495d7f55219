//! What a judgement that finds nothing does say: equivalence, and what would have been found.

use super::draw::scatter;
use super::included_trials::Experiment;
use super::judgement_cells::differences_of_conditions;
use super::model::{Drawn, Section, Table, cells, or_undefined};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::{Computed, Equivalence, Summary, Undefined, mean, power_of_t};

/// Bounds within which a difference of percentages counts as none, points.
const BOUNDS_PERCENT: f64 = 10.0;
const ALPHA: f64 = 0.05;
/// The power that a study is usually asked for.
const POWER: f64 = 0.8;

/// Equivalence of what was answered to guessing and of conditions to each other, and the power of
/// the t test of right answers.
pub(super) fn section(experiment: &Experiment<'_>, percents: &[f64]) -> Section {
    let mut section = experiment.section("power", "equivalence and power");
    section.note(format!(
        "No difference found is not equivalence: two one-sided tests ask whether the share of \
         right answers lies within 50 ± {BOUNDS_PERCENT} %, and whether conditions differ by less \
         than {BOUNDS_PERCENT} points in how often they were called real. The interval of level \
         90 % lies inside the bounds exactly when p < 0.05."
    ));
    section.table(equivalence(experiment, percents));
    let subjects = experiment.subjects.iter();
    let n_trials: Vec<f64> = subjects.map(|subject| subject.n_right().1 as f64).collect();
    let curve = Curve::of(percents, &n_trials);
    section.note(curve.describe(percents.len()));
    section.table(curve.table());
    section.figures.extend(curve.drawn(experiment));
    section
}

fn equivalence(experiment: &Experiment<'_>, percents: &[f64]) -> Table {
    let columns = "what: of what; n; mean_percent: mean, %; low_percent: bounds from; \
        high_percent: to; t_low: t against the lower; t_high: against the upper; df; p; \
        ci_low_percent: 90 % CI from; ci_high_percent: to; power: power if it lay midway";
    let title = "Equivalence (two one-sided tests)";
    let mut table = Table::new("equivalence", title, columns);
    let mut enter = |what: &str, values: &[f64], middle: f64| {
        let bounds = [middle - BOUNDS_PERCENT, middle + BOUNDS_PERCENT];
        let found = Summary::of(values).and_then(|s| Equivalence::of(&s, bounds, ALPHA));
        let found = found.map(|found| {
            let ends = [found.interval.low, found.interval.high];
            cells![
                found.mean,
                bounds,
                found.t,
                found.df,
                found.p,
                ends,
                found.power
            ]
        });
        table.push(cells![what, values.len(), or_undefined(found, 10)]);
    };
    enter("right, %", percents, 50.0);
    for (what, differences) in differences_of_conditions(experiment) {
        enter(&what, &differences, 0.0);
    }
    table
}

/// The power of the two-sided t test of right answers against 50 %, by the true share.
struct Curve {
    /// 50 … 100 %.
    shares: Vec<f64>,
    /// With the spread of subjects as it is.
    as_seen: Vec<Computed>,
    /// If subjects were alike, and only the chance of each trial spread them.
    alike: Vec<Computed>,
    n_trials: Computed,
}

impl Curve {
    fn of(percents: &[f64], n_trials: &[f64]) -> Self {
        let shares: Vec<f64> = (50..=100).map(f64::from).collect();
        let (n, df) = (percents.len() as f64, percents.len() as f64 - 1.0);
        let sd = Summary::of(percents).map(|summary| summary.sd);
        let mean_trials = mean(n_trials);
        let power = |share: f64, sd: f64| {
            let errors = (share - 50.0) / (sd / n.sqrt());
            power_of_t(errors.clamp(0.0, 40.0), df, ALPHA)
        };
        let as_seen = |share: &f64| match &sd {
            Ok(sd) if *sd > 0.0 => power(*share, *sd),
            Ok(_) => Err(Undefined::because("subjects do not vary")),
            Err(why) => Err(why.clone()),
        };
        let alike = |share: &f64| {
            let n_trials = mean_trials.clone()?;
            // At 100 % nothing spreads: half a trial is kept.
            let p = (share / 100.0).min(1.0 - 0.5 / n_trials);
            power(*share, 100.0 * (p * (1.0 - p) / n_trials).sqrt())
        };
        Self {
            as_seen: shares.iter().map(as_seen).collect(),
            alike: shares.iter().map(alike).collect(),
            n_trials: mean_trials,
            shares,
        }
    }

    /// The smallest true share that is found often enough.
    fn found_from(&self, powers: &[Computed]) -> Option<f64> {
        let is_enough = |power: &Computed| power.as_ref().is_ok_and(|power| *power >= POWER);
        powers.iter().position(is_enough).map(|at| self.shares[at])
    }

    fn describe(&self, n_subjects: usize) -> String {
        let share = |powers: &[Computed]| match self.found_from(powers) {
            Some(share) => format!("{share} %"),
            None => "no share".to_owned(),
        };
        let n_trials = match &self.n_trials {
            Ok(n) => fixed(*n, 0),
            Err(_) => "no".to_owned(),
        };
        format!(
            "With {n_subjects} subjects of {n_trials} trials the t test against 50 % finds {} or \
             more right with a probability of 80 %, subjects spread as they are; {} if only the \
             chance of each trial spread them.",
            share(&self.as_seen),
            share(&self.alike)
        )
    }

    fn table(&self) -> Table {
        let columns = "true_percent: true share right, %; power_as_seen: power, spread as seen; \
            power_alike: power, subjects alike";
        let title = "Power of the two-sided t test against 50 % at 0.05";
        let mut table = Table::new("power", title, columns);
        for ((share, seen), alike) in self.shares.iter().zip(&self.as_seen).zip(&self.alike) {
            table.push(cells![*share, seen, alike]);
        }
        table
    }

    fn drawn(&self, experiment: &Experiment<'_>) -> Option<Drawn> {
        let line = |name: &str, powers: &[Computed], style: Style| {
            let all = self.shares.iter().zip(powers);
            let points = all.filter_map(|(share, power)| Some([*share, *power.as_ref().ok()?]));
            Series::of(name, style, points)
        };
        let mut lines = vec![
            line("subjects spread as seen", &self.as_seen, Style::Line),
            line("subjects alike", &self.alike, Style::Dashed),
        ];
        lines.retain(|line| !line.points.is_empty());
        let axes = [
            Axis::linear("true share right, %").within([50.0, 100.0]),
            Axis::linear("power at 0.05").within([0.0, 1.0]),
        ];
        let title = experiment.titled("power against guessing");
        (!lines.is_empty()).then(|| scatter("power-curve", &title, axes, lines))
    }
}
