//! Distances of fabrics as Craven (1992) takes them: the d′ of odd-man-out choices, pair by pair.
//! Of three, that is the d′ of the triangle test.

use super::included_trials::Experiment;
use super::model::{Cell, Section, Table, cells, known, or_undefined};
use super::tables::matrix;
use selvedge_statistics::Computed;
use selvedge_statistics::detection::{Choice, Correction, Relation};
use selvedge_statistics::ranking::{OddOneOut, PairTally};

/// Distances of all pairs.
pub(super) struct Craven {
    /// Row by row; `None` on the diagonal and for pairs that were never asked.
    pub(super) distances: Vec<Option<f64>>,
    /// Pairs that were always told apart.
    pub(super) n_ceiling: usize,
    /// Pairs told apart no more often than by chance.
    pub(super) n_floor: usize,
}

fn choice(pair: &PairTally) -> Computed<Choice> {
    let (right, n) = (pair.n_correct() as u64, pair.n() as u64);
    Relation::Triangle.choice(right, n, Correction::LogLinear)
}

impl Craven {
    /// Of answers, subjects together.
    pub(super) fn of(found: &OddOneOut) -> Self {
        let n = found.n_items;
        let mut distances = vec![None; n * n];
        let mut n_floor = 0;
        for pair in &found.pairs {
            let distance = choice(pair).ok().map(|choice| choice.d_prime);
            n_floor += usize::from(distance.is_some_and(|d| d <= 0.0));
            let [i, j] = pair.items;
            distances[i * n + j] = distance;
            distances[j * n + i] = distance;
        }
        let is_ceiling = |pair: &&PairTally| pair.n_correct() == pair.n();
        Self {
            distances,
            n_ceiling: found.pairs.iter().filter(is_ceiling).count(),
            n_floor,
        }
    }
}

const PAIRS: &str = "one: fabric; other: and; triads; right; percent: %; distance: d′; se: SE; \
    ci_low: 95 % CI from; ci_high: to; correction; below_chance: below chance";

/// The distances as a matrix and pair by pair.
pub(super) fn section(
    experiment: &Experiment<'_>,
    found: &OddOneOut,
    craven: &Craven,
    names: &[String],
) -> Section {
    let mut section = experiment.section("craven", "Craven's distances");
    section.note(format!(
        "The distance of two fabrics is the d′ whose share of right odd-one-out choices is that of \
         their triads (Craven 1992; among three the triangle test), grades of difficulty left out. \
         Shares of 0 and 1 are corrected log-linearly, (right + ½)/(triads + 1): {} of {} pairs \
         were always told apart, and how far apart they come out hangs on that. Below chance, ⅓, \
         the distance is 0: {} pairs. Subjects are pooled, which makes d′ too small where they \
         differ.",
        craven.n_ceiling,
        found.pairs.len(),
        craven.n_floor
    ));
    let cells = craven.distances.iter();
    let cells = cells.map(|d| known(*d, "itself, or never asked"));
    section.table(matrix("distances", "Craven's distances, d′", names, cells));
    let mut table = Table::new("pairs", "Craven's distances, pair by pair", PAIRS);
    for pair in &found.pairs {
        table.push(row(pair, names));
    }
    section.table(table);
    section
}

fn row(pair: &PairTally, names: &[String]) -> Vec<Cell> {
    let [one, other] = pair.items.map(|item| &names[item]);
    let (right, n) = (pair.n_correct(), pair.n());
    let found = choice(pair).map(|choice| {
        let correction = choice.correction.map_or("none", Correction::name);
        let (d_prime, below_chance) = (choice.d_prime, choice.is_below_chance);
        cells![
            d_prime,
            choice.se,
            choice.interval,
            correction,
            below_chance
        ]
    });
    let percent = 100.0 * right as f64 / n as f64;
    cells![one, other, n, right, percent, or_undefined(found, 6)]
}
