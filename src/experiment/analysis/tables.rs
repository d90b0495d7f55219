//! Tables that several analyses make: of tests, of summaries, of one value for every pair.

use super::model::{Cell, Section, Table, cells, or_undefined};
use super::options::Options;
use selvedge_statistics::detection::GroupDPrime;
use selvedge_statistics::{
    Bootstrap, Computed, Freedom, Named, Outcome, Resampling, Sides, Summary, mean,
};

/// Said wherever a group has a d′ of its own.
pub(super) const D_PRIME_NOTE: &str = "d′ over subjects follows from the mean of their shares, \
    less what subjects who differ bend it by (its sd is how much they do): the mean of subjects' \
    own d′ is biased where trials are few. Its interval is over subjects, by Student's t.";

impl Section {
    /// Adds means over subjects, a row of their d′, and intervals of the means by drawing subjects
    /// again.
    pub(super) fn over_subjects<S: AsRef<str>>(
        &mut self,
        means: &[(S, Vec<f64>)],
        d_prime: Option<Vec<Cell>>,
        options: &Options,
    ) {
        let mut table = summaries("group", "Over subjects", means);
        table.rows.extend(d_prime);
        self.table(table);
        self.table(resampled(means, options.resampling()));
    }
}

/// A row of d′ over so many subjects.
pub(super) fn group_d_prime(n: usize, found: Computed<GroupDPrime>) -> Vec<Cell> {
    let found = found.map(|d| cells![[d.mean, d.spread, d.se, d.interval.low, d.interval.high]]);
    cells!["d′", n, or_undefined(found, 5)]
}

/// Columns of [`tests`].
const TESTS: &str = "what: of what; test; n; n_second: n of the second; statistic; value; df; \
    df_error: df error; p; sides; effect: effect size; effect_value: value; effect_low: 95 % CI \
    from; effect_high: to; estimate; estimate_value: value; ci_low: CI from; ci_high: to; \
    ci_level: level; remarks";

/// A table of tests, one a row: what was tested, and what came of it.
pub(super) fn tests<S: AsRef<str>>(
    key: &str,
    title: &str,
    all: &[(S, Computed<Outcome>)],
) -> Table {
    let mut table = Table::new(key, title, TESTS);
    for (what, outcome) in all {
        let found = or_undefined(outcome.as_ref().map(cells_of), table.columns.len() - 1);
        table.push(cells![what.as_ref(), found]);
    }
    table
}

fn cells_of(outcome: &Outcome) -> Vec<Cell> {
    let n = match *outcome.n {
        [first, second] => cells![first, second],
        ref groups => cells![
            groups.iter().sum::<usize>(),
            Cell::none("not of two groups")
        ],
    };
    let df = match outcome.df {
        Freedom::None => [(); 2].map(|()| Cell::none("the test has none")),
        Freedom::One(df) => [df.into(), Cell::none("the test has one number alone")],
        Freedom::Two(df, error) => [df.into(), error.into()],
    };
    let sides = match outcome.sides {
        Sides::Two => "two",
        Sides::Greater => "greater",
        Sides::Less => "less",
    };
    let named = |value: &Computed<Named>| {
        let cells = |named: &Named| cells![named.symbol, named.value];
        or_undefined(value.as_ref().map(cells), 2)
    };
    let effect = outcome.effect_interval();
    let mut remarks: Vec<&str> = outcome.notes.iter().map(String::as_str).collect();
    remarks.extend(effect.as_ref().ok().map(|(_, how)| *how));
    cells![
        outcome.test,
        n,
        outcome.statistic.symbol,
        outcome.statistic.value,
        df,
        outcome.p,
        sides,
        named(&outcome.effect),
        effect
            .as_ref()
            .map(|(interval, _)| *interval)
            .map_err(Clone::clone),
        named(&outcome.estimate),
        &outcome.interval,
        outcome.interval.as_ref().map(|interval| interval.level),
        remarks.join("; "),
    ]
}

/// Columns of [`summary_cells`].
pub(super) const SUMMARY: &str = "n; mean; sd; se: SE; ci_low: 95 % CI from; ci_high: to";

/// n, mean, sd, SE and the interval of the mean by Student's t.
pub(super) fn summary_cells(values: &[f64]) -> Vec<Cell> {
    let summary = Summary::of(values);
    let mean = summary
        .as_ref()
        .map_or_else(|_| mean(values), |s| Ok(s.mean));
    let spread = summary.map(|s| cells![s.sd, s.se, s.interval(0.95)]);
    cells![values.len(), mean, or_undefined(spread, 4)]
}

/// A table of means, one quantity a row.
pub(super) fn summaries<S: AsRef<str>>(key: &str, title: &str, all: &[(S, Vec<f64>)]) -> Table {
    let columns = format!("what: of what; {SUMMARY}");
    let mut table = Table::new(key, title, &columns);
    for (what, values) in all {
        table.push(cells![what.as_ref(), summary_cells(values)]);
    }
    table
}

/// Intervals of means by drawing subjects again, one quantity a row.
fn resampled<S: AsRef<str>>(all: &[(S, Vec<f64>)], how: Resampling) -> Table {
    let columns = "what: of what; n; mean; se: SE; percentile_low: 95 % percentiles from; \
        percentile_high: to; bca_low: bias-corrected and accelerated from; bca_high: to; resamples";
    let title = "Means, their intervals by drawing subjects again";
    let mut table = Table::new("bootstrap", title, columns);
    for (what, values) in all {
        let of = |drawn: &[usize]| mean(&drawn.iter().map(|i| values[*i]).collect::<Vec<f64>>());
        let found = Bootstrap::of(values.len(), of, how);
        let found = found.map(|f| cells![f.estimate, f.se, Ok(f.percentile), f.bca, f.n_used]);
        table.push(cells![
            what.as_ref(),
            values.len(),
            or_undefined(found, table.columns.len() - 2)
        ]);
    }
    table
}

/// A square table with names down and across.
pub(super) fn matrix(
    key: &str,
    title: &str,
    names: &[String],
    cells: impl IntoIterator<Item = Cell>,
) -> Table {
    let mut table = Table::new(key, title, "item: ").with_columns(names.iter().map(String::as_str));
    let mut cells = cells.into_iter();
    for name in names {
        let row: Vec<Cell> = cells.by_ref().take(names.len()).collect();
        table.push(cells![name, row]);
    }
    table
}
