//! The study of statistics: tails, quantiles, fits and posteriors against values computed elsewhere
//! to twenty digits (`tests/truth/statistics.py`), and a bootstrap against its closed form.

use std::hint::black_box;
use std::path::Path;

use super::readable::{largest, mean};
use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::files::Table;
use selvedge_foundation::numerics::{Random, to_index};
use selvedge_statistics::adaptive::{Procedure as _, QuestGrid, QuestPlus, Stop};
use selvedge_statistics::psychometric::{Block, Family, Guess, Model};
use selvedge_statistics::ranking::{BradleyTerry, PlackettLuce, Preferences, Prior};
use selvedge_statistics::{
    Bootstrap, Computed, Resampling, Sides, exact_binomial, f_upper, normal_lower, normal_quantile,
    t_quantile_upper,
};

const TRUTH: &str = include_str!("../../tests/truth/statistics.csv");
/// What a relative error may be of a number whose condition is 1.
const DIGITS: f64 = 1e-13;
/// What Newton's method stops at, logits.
const NEWTON: f64 = 1e-10;

/// Error against truth from outside, with the condition of each question.
pub(crate) const STUDY: Study = Study {
    name: "statistics",
    chapter: "evidence",
    question: "How many digits have tails, quantiles, fits and posteriors, far out and where data \
               decide next to nothing, and at what cost?",
    reference: "Values of mpmath with 25 digits or more and of NumPy's quadrature, stored with \
                the script that made them; of the bootstrap of a mean its closed form.",
    error: ("error", "of its scale"),
    cost_of: "number",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let truths = truths()?;
    let of = |what: &'static str| truths.iter().filter(move |truth| truth.what == what);
    let mut rows = Vec::new();
    for (what, number) in NUMBERS {
        bench.step(0.0, what)?;
        for truth in of(what) {
            let found = number(truth.arguments)?;
            let cost = bench.time(1, || number(black_box(truth.arguments)));
            rows.push(truth.row(found).cost(cost).promised(truth.rounding()));
        }
    }
    bench.step(0.3, "rankings")?;
    for (what, fit) in [
        ("Bradley-Terry", bradley_terry as Fit),
        ("Plackett-Luce", plackett_luce),
    ] {
        for of_case in truths.chunk_by(|a, b| (&a.what, &a.case) == (&b.what, &b.case)) {
            if of_case[0].what == what {
                rows.push(ranked(bench, of_case, fit)?);
            }
        }
    }
    rows.push(separated());
    bench.step(0.5, "posteriors")?;
    for truth in of("psychometric fit") {
        rows.push(fitted(bench, truth)?);
    }
    for truth in of("QUEST+ mean") {
        for step_db in [6.4, 3.2, 1.6, 0.8, 0.4] {
            rows.push(quest(bench, truth, step_db)?);
        }
    }
    bench.step(0.8, "bootstrap")?;
    let sizes = [100, 1_000, 10_000, 100_000];
    for n_resamples in &sizes[..bench.effort.pick(3, 4)] {
        rows.push(bootstrap(bench, *n_resamples)?);
    }
    Ok(Findings::new(rows, Vec::new(), NOTES))
}

const NOTES: [&str; 4] = [
    "Of numbers the error is relative; 10⁻¹³ is promised times their condition, by which any \
     rounding of what goes in is magnified, and a tenth of their degrees of freedom or trials, \
     with which the incomplete beta function loses digits. Of rankings it is the largest of any \
     item, as a share of the largest value; 10⁻¹⁰ is promised, at which Newton's method ends. Of \
     posteriors it is a share of the posterior's standard deviation.",
    "Where one item won every comparison there is no finite ability: the fit has to say so.",
    "The error of QUEST+ is that of its grid: of a coarse one that of the sum, of a fine one that \
     of its ends at ±20 dB, where this posterior has not quite vanished.",
    "The bootstrap of a mean has a standard error in closed form; with B resamples it is off by \
     1/√(2B) in the rms, four times which is promised.",
];

/// A number from up to three.
type Number = fn([f64; 3]) -> Computed;

const NUMBERS: [(&str, Number); 5] = [
    ("normal tail", |[z, ..]| Ok(normal_lower(z))),
    ("normal quantile", |[p, ..]| normal_quantile(p)),
    ("t quantile", |[tail, df, _]| t_quantile_upper(tail, df)),
    ("F tail", |[f, df_effect, df_error]| {
        f_upper(f, df_effect, df_error)
    }),
    ("binomial tail", |[k, n, p]| {
        let [k, n] = [k, n].map(|n| to_index(n) as u64);
        exact_binomial(k, n, p, Sides::Greater).map(|outcome| outcome.p)
    }),
];

/// A value that was computed elsewhere.
#[derive(Debug, Clone, PartialEq)]
struct Truth {
    what: String,
    case: String,
    arguments: [f64; 3],
    value: f64,
    condition: f64,
}

impl Truth {
    /// What rounding alone may come to. The incomplete beta function loses digits with its
    /// parameters: the degrees of freedom, or the number of trials.
    fn rounding(&self) -> f64 {
        let [_, b, c] = self.arguments;
        let parameters = b.max(0.0) + c.max(0.0);
        DIGITS * (self.condition.max(1.0) + 0.1 * parameters)
    }

    fn row(&self, found: f64) -> Row {
        self.of_scale((found - self.value).abs() / self.value.abs())
    }

    fn of_scale(&self, error: f64) -> Row {
        Row::of(&self.what, "", &self.case)
            .error(error)
            .with("condition", self.condition)
    }
}

fn truths() -> Result<Vec<Truth>, ReportError> {
    let columns = ["what", "case", "a", "b", "c", "value", "condition"];
    let table = Table::read(
        TRUTH,
        Path::new("tests/truth/statistics.csv"),
        &columns,
        &[],
    )?;
    let [what, case] = ["what", "case"].map(|name| table.text(name).unwrap_or_default());
    let arguments = ["a", "b", "c"].map(|name| table.text(name).unwrap_or_default());
    let [value, condition] = [
        table.required_numbers("value")?,
        table.required_numbers("condition")?,
    ];
    let truth = |nth: usize| Truth {
        what: what[nth].to_owned(),
        case: case[nth].to_owned(),
        arguments: arguments
            .each_ref()
            .map(|cells| cells[nth].parse().unwrap_or(f64::NAN)),
        value: value[nth],
        condition: condition[nth],
    };
    Ok((0..table.n_rows()).map(truth).collect())
}

/// Values of so many items by a rule of the case's name, and the steps that they took.
type Fit = fn(&str, usize) -> Computed<(Vec<f64>, usize)>;

/// A row of all items of a case.
fn ranked(bench: &Bench<'_>, truths: &[Truth], fit: Fit) -> Computed<Row> {
    let (case, n) = (&truths[0].case, truths.len());
    let (found, n_steps) = fit(case, n)?;
    let scale = largest(truths.iter().map(|truth| truth.value.abs()));
    let off = found
        .iter()
        .zip(truths)
        .map(|(found, truth)| (found - truth.value).abs());
    let row = truths[0].of_scale(largest(off) / scale);
    let cost = bench.time_repeated(5, 1, || fit(case, n));
    Ok(row
        .promised(NEWTON)
        .cost(cost)
        .with("newton_steps", n_steps))
}

fn bradley_terry(case: &str, n: usize) -> Computed<(Vec<f64>, usize)> {
    let wins = |i: usize, j: usize| -> u64 {
        match case {
            _ if i == j => 0,
            "8 items, even" => 3 + (7 * i as u64 + 5 * j as u64) % 11,
            "16 in a chain, 9 to 1" if j == i + 1 => 9,
            "16 in a chain, 9 to 1" => u64::from(i == j + 1),
            _ if i < j => 1_000_000,
            _ => 1,
        }
    };
    let wins: Vec<Vec<u64>> = (0..n)
        .map(|i| (0..n).map(|j| wins(i, j)).collect())
        .collect();
    let fit = BradleyTerry::fit(&Preferences::of_wins(&wins)?, Prior::None)?;
    Ok((fit.scale.values, fit.n_steps))
}

fn plackett_luce(case: &str, n: usize) -> Computed<(Vec<f64>, usize)> {
    let n_rankings = if case.contains("20") { 20 } else { 60 };
    let ranking = |r: usize| {
        let mut items: Vec<usize> = (0..n).collect();
        items.sort_by_key(|i| ((3 * i + 5 * r * r + i * r) % 13, *i));
        items
    };
    let rankings: Vec<Vec<usize>> = (0..n_rankings).map(ranking).collect();
    let fit = PlackettLuce::fit(n, &rankings, Prior::None)?;
    Ok((fit.scale.values, fit.n_steps))
}

/// One of four won everything: 0 where that is refused, 1 where numbers come back.
fn separated() -> Row {
    let wins: Vec<Vec<u64>> = vec![
        vec![0, 9, 9, 9],
        vec![0, 0, 5, 4],
        vec![0, 4, 0, 5],
        vec![0, 5, 4, 0],
    ];
    let fit = Preferences::of_wins(&wins).and_then(|all| BradleyTerry::fit(&all, Prior::None));
    let error = f64::from(u8::from(fit.is_ok()));
    let row = Row::of("Bradley-Terry", "", "one of 4 won all: no finite value").error(error);
    row.promised(0.0).with("condition", f64::INFINITY)
}

/// The median threshold of a fit against quadrature.
fn fitted(bench: &Bench<'_>, truth: &Truth) -> Computed<Row> {
    let blocks = |all: &[(f64, u32, u32)]| -> Vec<Block> {
        all.iter()
            .map(|&(x, n, n_right)| Block { x, n, n_right })
            .collect()
    };
    let at = [-12.0, -6.0, 0.0, 6.0, 12.0];
    let right = |n: u32, right: [u32; 5]| -> Vec<(f64, u32, u32)> {
        at.into_iter()
            .zip(right)
            .map(|(x, right)| (x, n, right))
            .collect()
    };
    let blocks = match truth.case.as_str() {
        "5 × 20 answers" => blocks(&right(20, [7, 9, 13, 18, 20])),
        "5 × 400 answers" => blocks(&right(400, [140, 172, 262, 370, 392])),
        _ => blocks(&[(-6.0, 10, 0), (6.0, 10, 10)]),
    };
    let model = Model::alternatives(Family::Gumbel, 3, [10.0, 0.5]);
    let found_db = model.fit(&blocks)?.curve.threshold;
    let cost = bench.time_repeated(5, 1, || model.fit(&blocks));
    let [sd_db, ..] = truth.arguments;
    let row = truth
        .of_scale((found_db - truth.value).abs() / sd_db)
        .cost(cost);
    Ok(row.number("sd_db", 4, sd_db))
}

/// The posterior mean of the threshold on a grid of this step against quadrature.
fn quest(bench: &Bench<'_>, truth: &Truth, step_db: f64) -> Computed<Row> {
    let n = to_index((20.0 / step_db).floor());
    let thresholds = (0..=2 * n).map(|i| (i as f64 - n as f64) * step_db);
    let answers = [12_i32, 8, 4, 0, -4, 0, 4, 2, -2, 6, -6, 2, 0, 4, -4, 2].repeat(2);
    let grid = QuestGrid {
        family: Family::Gumbel,
        guess: Guess::Share(1.0 / 3.0),
        stimuli: vec![0.0],
        thresholds: thresholds.collect(),
        widths: vec![10.0],
        lapses: vec![0.02],
    };
    let fresh = QuestPlus::new(grid, Stop::Trials(1000))?;
    let posterior = || -> Computed {
        let mut quest = fresh.clone();
        for (n, x) in (0_i32..).zip(&answers) {
            let is_above = (3 * n + i32::div_euclid(*x, 4)).rem_euclid(4) != 0;
            let right = if *x > -4 { is_above } else { n % 3 == 0 };
            quest.answer(f64::from(*x), right)?;
        }
        Ok(quest.summary().threshold.mean)
    };
    let found_db = posterior()?;
    let cost = bench.time_repeated(5, answers.len(), posterior);
    let [sd_db, ..] = truth.arguments;
    let mut row = truth
        .of_scale((found_db - truth.value).abs() / sd_db)
        .cost(cost);
    row.setting = format!("grid of {step_db} dB");
    Ok(row.size(step_db).number("sd_db", 4, sd_db))
}

/// The standard error of a mean of twelve by so many resamples.
fn bootstrap(bench: &Bench<'_>, n_resamples: usize) -> Computed<Row> {
    let mut random = Random::new(bench.seed).branch("bootstrap");
    let values: Vec<f64> = (0..12).map(|_| random.normal()).collect();
    let statistic =
        |drawn: &[usize]| Ok(drawn.iter().map(|at| values[*at]).sum::<f64>() / drawn.len() as f64);
    let how = Resampling {
        n_resamples,
        seed: bench.seed,
        level: 0.95,
    };
    let found = Bootstrap::of(values.len(), statistic, how)?.se;
    let middle = mean(&values);
    let squares: f64 = values.iter().map(|x| (x - middle).powi(2)).sum();
    let truth = squares.sqrt() / values.len() as f64;
    let cost = bench.time_repeated(3, n_resamples, || {
        Bootstrap::of(values.len(), statistic, how)
    });
    let row = Row::of(
        "bootstrap of a mean",
        format!("{n_resamples} resamples"),
        "12 subjects",
    );
    let n = n_resamples as f64;
    Ok(row
        .size(n)
        .error((found / truth - 1.0).abs())
        .promised(4.0 / (2.0 * n).sqrt())
        .cost(cost))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn every_number_has_the_digits_that_its_condition_leaves() {
        let findings = quick(&STUDY, 1);
        let broken: Vec<&Row> = findings.broken().collect();
        assert!(broken.is_empty(), "{broken:?}");
        let of = |method: &str| {
            findings
                .rows
                .iter()
                .filter(|row| row.method == method)
                .count()
        };
        let methods = [
            "normal tail",
            "normal quantile",
            "t quantile",
            "F tail",
            "binomial tail",
        ];
        assert_eq!(methods.map(of), [7, 7, 6, 7, 6]);
        assert_eq!(
            ["Bradley-Terry", "Plackett-Luce", "psychometric fit"].map(of),
            [4, 2, 3]
        );
        let of_grid: Vec<f64> = (findings.rows.iter())
            .filter(|row| row.method == "QUEST+ mean")
            .filter_map(|row| row.error)
            .collect();
        assert!(of_grid[0] > 0.1 && of_grid[4] < 5e-3, "{of_grid:?}");
    }
}
