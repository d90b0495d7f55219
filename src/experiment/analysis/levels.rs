//! Thresholds and just noticeable differences: one model of subjects and group, fitted to all
//! trials.

use super::draw::{Bar, bars, scatter};
use super::included_trials::Experiment;
use super::levels_series::{answered, quest_plus_section, staircases_section};
use super::model::{Cell, Drawn, Section, Table, cells, or_undefined};
use super::options::Options;
use super::tables::{SUMMARY, summary_cells};
use crate::design::{Adaptation, Seeks, Track};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::numerics::{Random, in_pieces, n_threads};
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::Computed;
use selvedge_statistics::psychometric::{
    Block, Estimate, Evidence, Family, Fit, Goodness, Guess, Model, Population,
};

/// Points of a drawn curve.
const N_DRAWN: u32 = 100;
/// Simulated sets of answers that a subject's deviance is compared with.
const MOST_SETS: usize = 399;
/// A fit is poor where its deviance is as rare.
const ALPHA: f64 = 0.05;

impl Adaptation {
    /// Its share right halfway from guessing to certainty, lapses apart, %.
    fn percent_right(&self) -> f64 {
        50.0 * (1.0 + 1.0 / self.alternatives as f64)
    }

    /// The unit after a comma; nothing where there is none.
    fn unit(&self) -> String {
        let is_difference = self.reference.is_some() && self.seeks == Seeks::Difference;
        if is_difference {
            after_comma(self.parameter.unit_of_differences())
        } else {
            after_comma(self.parameter.unit())
        }
    }

    /// What is adapted, in a word.
    pub(super) fn noun(&self) -> &'static str {
        if self.is_vibration() {
            "level"
        } else {
            self.parameter.name()
        }
    }

    /// What is adapted, with its unit.
    pub(super) fn value_words(&self) -> String {
        self.with_own_unit(self.noun())
    }

    /// Some value of what is adapted, with its unit.
    pub(super) fn with_own_unit(&self, what: &str) -> String {
        format!("{what}{}", after_comma(self.parameter.unit()))
    }

    /// Some difference of what is adapted, or its threshold, with the unit.
    pub(super) fn with_unit(&self, what: &str) -> String {
        format!(
            "{what}{}",
            after_comma(self.parameter.unit_of_differences())
        )
    }

    /// Columns of a table whose numbers are of the parameter, as they are named for dB.
    pub(super) fn columns(&self, columns: &str) -> String {
        columns.replace("_db", self.parameter.suffix())
    }

    fn quantity(&self) -> String {
        let percent = readable_percent(self.percent_right());
        let unit = self.unit();
        match (self.seeks, self.reference) {
            (Seeks::Equality, _) => format!("point of equality{unit}"),
            (_, None) => format!("threshold ({percent} right){unit}"),
            (_, Some(_)) => format!("just noticeable difference ({percent} right){unit}"),
        }
    }

    /// What is expected of the function: a threshold's width is 12 dB, within a factor of 1.65 two
    /// times in three. Where d′ is proportional to the difference, a function of its logarithm is
    /// 3.25 wide; exponents of 0.8 to 1.2 are two in three.
    fn model(&self) -> Model {
        if self.seeks == Seeks::Equality {
            return Model {
                family: self.family(),
                guess: Guess::EqualToLapse,
                usual_width: 0.5 * (self.range[1] - self.range[0]),
                ln_width_sd: 1.0,
            };
        }
        let m = u32::try_from(self.alternatives).unwrap_or(2);
        let width = self.reference.map_or([12.0, 0.5], |_| [3.25, 0.1]);
        Model::alternatives(self.family(), m, width)
    }

    /// The standard deviation of thresholds in dB, of one on the function's scale.
    fn spread_db(&self, median_db: f64, spread: f64) -> f64 {
        let variance = spread * spread;
        match self.family() {
            Family::Gumbel | Family::Normal | Family::Logistic => spread,
            Family::Weibull => median_db * (0.5 * variance).exp() * variance.exp_m1().sqrt(),
        }
    }
}

/// A unit behind what it is of; nothing where there is none.
fn after_comma(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(", {unit}")
    }
}

/// A share, %, with the decimals that it needs.
pub(super) fn readable_percent(percent: f64) -> String {
    let decimals = usize::from((percent - percent.round()).abs() > 0.05);
    format!("{} %", fixed(percent, decimals))
}

pub(super) fn sections(
    experiment: &Experiment<'_>,
    levels: &Adaptation,
    options: &Options,
) -> Vec<Section> {
    let mut section = experiment.section("thresholds", "psychometric functions");
    let found = Found::of(experiment, levels, options);
    section.notes.extend(found.poor_fit());
    section.note(described(levels, options));
    section.table(found.group(levels));
    section.table(found.fits(levels));
    section
        .figures
        .extend(curves(experiment, levels, &found.fits));
    if !found.fits.is_empty() {
        let bar = |(name, fit): &(&str, Fit)| {
            let ends = [fit.own.low, fit.own.high];
            Bar::of(name, "", fit.curve.threshold, Some(ends))
        };
        let shown: Vec<Bar> = found.fits.iter().map(bar).collect();
        let title = experiment.titled("thresholds by subject, 95 % intervals");
        section.figure(bars(
            "bars",
            &title,
            &levels.quantity(),
            (&shown, None),
            &[],
        ));
    }
    let mut all = vec![section];
    match &levels.track {
        Track::Staircase(track) => all.push(staircases_section(experiment, levels, track)),
        Track::QuestPlus(track) => all.push(quest_plus_section(experiment, levels, track)),
        Track::Constant { .. } => {}
    }
    all
}

/// What was fitted, and how.
fn described(levels: &Adaptation, options: &Options) -> String {
    let of = if levels.is_vibration() {
        format!("{} at {} Hz", levels.quantity(), levels.band.carrier_hz())
    } else {
        format!("{} of {}", levels.quantity(), levels.parameter.name())
    };
    let level = match (levels.seeks, levels.alternatives) {
        (Seeks::Equality, _) => "where it is called more as often as less".to_owned(),
        (_, n) => {
            format!("{n} intervals, chance 1/{n}: halfway from guessing to what lapses leave")
        }
    };
    let x = match (levels.seeks, levels.reference) {
        (_, None) => "the value",
        (_, Some(_)) => "the difference from the reference",
    };
    format!(
        "{of}, {level}. The function is {} of {x}. One model holds subjects and group: thresholds, \
         widths and lapses of subjects are drawn from a population. A subject's own threshold is \
         the median of its posterior wherever others' lie; the pooled one takes it as one of the \
         population. Intervals are central ones of the posterior. The deviance's p is by {} \
         simulations.",
        levels.family().name(),
        options.n_permutations.min(MOST_SETS),
    )
}

/// The difference from 50 to 75 % of a cumulative Gaussian, of its width.
fn just_noticeable(width: &Estimate) -> Estimate {
    // z(75 %) over twice z(95 %).
    let share = 0.674_489_750_196_081_7 / (2.0 * 1.644_853_626_951_472_2);
    Estimate {
        value: share * width.value,
        se: share * width.se,
        interval: width.interval.map(|end| share * end),
    }
}

/// What the answers of all subjects say.
struct Found<'a> {
    /// Subjects in order: trials, levels, and what their answers say or why nothing.
    rows: Vec<(&'a str, [u32; 2], Computed<usize>)>,
    fits: Vec<(&'a str, Fit)>,
    goodness: Vec<Goodness>,
    population: Computed<Population>,
}

impl<'a> Found<'a> {
    fn of(experiment: &Experiment<'a>, levels: &Adaptation, options: &Options) -> Self {
        let model = levels.model();
        let (mut rows, mut names, mut evidence) = (Vec::new(), Vec::new(), Vec::new());
        for subject in &experiment.subjects {
            let trials = subject
                .trials()
                .filter_map(|record| answered(experiment.design, record));
            let of_levels =
                Block::of_trials(trials.map(|t| (levels.stimulus(t.value), t.is_right)));
            let n_trials = of_levels.iter().map(|b| b.n).sum();
            let n_levels = u32::try_from(of_levels.len()).unwrap_or(u32::MAX);
            let found = model.evidence(&of_levels).map(|one| {
                names.push(subject.name);
                evidence.push(one);
                names.len() - 1
            });
            rows.push((subject.name, [n_trials, n_levels], found));
        }
        let mut population = Population::of(&evidence, options.seed);
        let fits = match &mut population {
            Ok(population) => std::mem::take(&mut population.subjects),
            Err(_alone) => evidence.iter().map(Fit::alone).collect(),
        };
        let goodness = goodness(&evidence, &fits, options);
        Self {
            rows,
            fits: names.into_iter().zip(fits).collect(),
            goodness,
            population,
        }
    }

    /// The note that stands first where answers do not follow the function.
    fn poor_fit(&self) -> Option<String> {
        let together = Goodness::together(&self.goodness);
        let p = together.p();
        let n_poor = self.goodness.iter().filter(|one| one.p() < ALPHA).count();
        (!self.goodness.is_empty() && p < ALPHA).then(|| {
            format!(
                "**The answers do not follow the function:** their deviance of {} over all \
                 subjects has p = {}, and {n_poor} of {} subjects have one below 0.05. Thresholds \
                 are to be read with care.",
                fixed(together.deviance, 1),
                fixed(p, 4),
                self.goodness.len()
            )
        })
    }

    /// The estimate of the population first.
    fn group(&self, levels: &Adaptation) -> Table {
        let columns = format!("what: of what; {SUMMARY}");
        let mut table = Table::new("group", "Of the group", &columns);
        let own: Vec<f64> = self
            .fits
            .iter()
            .map(|(_, fit)| fit.curve.threshold)
            .collect();
        let n = self.fits.len();
        let what = format!("{}, median of the population", levels.quantity());
        let found = self.population.as_ref();
        let of = |one: &Estimate, sd: Cell| cells![one.value, sd, one.se, Ok(one.interval)];
        let threshold = found.map(|found| {
            let median_db = found.threshold.value;
            let sd_db = levels.spread_db(median_db, found.spread.value);
            of(&found.threshold, sd_db.into())
        });
        table.push(cells![what, n, or_undefined(threshold, 5)]);
        let what = format!("{}, mean of subjects' own", levels.quantity());
        table.push(cells![what, summary_cells(&own)]);
        let no_sd = || Cell::none("spread among subjects is not estimated by itself");
        let width = found.map(|found| of(&found.width, no_sd()));
        let is_of_logarithms = levels.family() == Family::Weibull;
        let width_unit = if is_of_logarithms { ", ln" } else { "" };
        let what = format!(
            "width from 5 to 95 %{width_unit}{}, median of the population",
            levels.unit()
        );
        table.push(cells![what, n, or_undefined(width, 5)]);
        if levels.seeks == Seeks::Equality {
            let jnd = found.map(|found| of(&just_noticeable(&found.width), no_sd()));
            let what = "just noticeable difference, from 50 to 75 %";
            table.push(cells![what, n, or_undefined(jnd, 5)]);
        }
        let lapse = found.map(|found| of(&found.lapse, no_sd()));
        table.push(cells![
            "lapse rate, mean of the population",
            n,
            or_undefined(lapse, 5)
        ]);
        table
    }

    fn fits(&self, levels: &Adaptation) -> Table {
        let title = format!("{}, by subject", levels.quantity());
        let mut table = Table::new("fits", &title, &levels.columns(FITS));
        for (name, counts, found) in &self.rows {
            let cells = |at: &usize| fit_cells(&self.fits[*at].1, &self.goodness[*at]);
            let found = or_undefined(found.as_ref().map(cells), table.columns.len() - 3);
            table.push(cells![*name, *counts, found]);
        }
        table
    }
}

/// How well each function fits, on several threads.
fn goodness(evidence: &[Evidence], fits: &[Fit], options: &Options) -> Vec<Goodness> {
    let n_sets = options.n_permutations.min(MOST_SETS);
    let mut all: Vec<Option<Goodness>> = vec![None; fits.len()];
    let each = |(): &mut (), at: usize, one: &mut [Option<Goodness>]| {
        let seed = Random::new(options.seed)
            .branch(&format!("subject {at}"))
            .seed();
        one[0] = Some(Goodness::of(&evidence[at], &fits[at], (n_sets, seed)));
    };
    in_pieces(&mut all, 1, n_threads(), || (), each);
    all.into_iter().flatten().collect()
}

const FITS: &str = "subject; trials; levels; threshold_db: own; ci_low_db: 95 % CI from; \
    ci_high_db: to; pooled_db: pooled; pooled_low_db: 95 % CI from; pooled_high_db: to; width: \
    width, 5 to 95 %; lapse: lapses; deviance; p_deviance: its p; remarks";

fn fit_cells(fit: &Fit, goodness: &Goodness) -> Vec<Cell> {
    cells![
        fit.curve.threshold,
        Ok(fit.own),
        fit.pooled.0,
        Ok(fit.pooled.1),
        [fit.curve.width, fit.curve.lapse],
        [goodness.deviance, goodness.p()],
        fit.notes.join("; "),
    ]
}

fn curves(experiment: &Experiment<'_>, levels: &Adaptation, fits: &[(&str, Fit)]) -> Option<Drawn> {
    let x = fits
        .iter()
        .flat_map(|(_, fit)| fit.blocks.iter().map(|b| b.x));
    let (low, high) = (
        x.clone().fold(f64::INFINITY, f64::min),
        x.fold(f64::NEG_INFINITY, f64::max),
    );
    if low >= high || !low.is_finite() {
        return None;
    }
    let at = |i: u32| low + (high - low) * f64::from(i) / f64::from(N_DRAWN);
    let curve = |(name, fit): &(&str, Fit)| {
        Series::of(
            *name,
            Style::Line,
            (0..=N_DRAWN).map(|i| [at(i), fit.curve.at(at(i))]),
        )
    };
    let mut all: Vec<Series> = fits.iter().map(curve).collect();
    if let [(_, fit)] = fits {
        let share = |b: &Block| [b.x, f64::from(b.n_right) / f64::from(b.n)];
        all.push(Series::of(
            "share right",
            Style::Dots,
            fit.blocks.iter().map(share),
        ));
    }
    let x = match levels.reference {
        Some(_) => levels.with_unit("difference"),
        None => levels.value_words(),
    };
    let axes = [
        Axis::linear(x),
        Axis::linear("share right").within([0.0, 1.0]),
    ];
    Some(scatter(
        "curves",
        &experiment.titled("psychometric functions"),
        axes,
        all,
    ))
}
