//! Rows and sentences of what the routes came to.

use super::cloths::Kin;
use super::felt::Felt;
use super::taking::Taking;
use super::ways::{Subject, Way};
use crate::{Bench, Effort, Row, Timing};
use selvedge_foundation::numerics::{median, quantile};
use selvedge_statistics::rank_correlation;

/// Cloths whose levels differ by less than this are hardly told apart, dB.
const HARDLY_DB: f64 = 1.5;
/// Median level errors that are promised of what is kept by evidence, by what is known of the
/// light, dB.
const PROMISED_DB: [(&str, f64); 2] = [("light known", 5.0), ("light unknown", 7.0)];

/// A picture of a cloth, what is felt of it in truth and by every route, and what that took.
pub(super) struct Tried {
    pub(super) name: String,
    kin: Kin,
    taking: Taking,
    /// Whether it was taken in the plainest way, as every cloth is once.
    pub(super) is_plain: bool,
    pub(super) truth: Felt,
    by_way: Vec<(Way, Result<Felt, String>, Option<Timing>)>,
    /// Of warp and weft by band: the ends of what is believed less the truth, dB.
    band_db: Option<[[f64; 2]; 4]>,
}

impl Tried {
    /// Tries every route on a picture of a cloth; those without one where it is the plainest.
    pub(super) fn of(
        subject: &Subject<'_>,
        [is_plain, is_timed]: [bool; 2],
        bench: &Bench<'_>,
    ) -> Self {
        let ways = Way::ALL.into_iter();
        let by_way = ways.filter(|way| is_plain || way.is_picture()).map(|way| {
            let felt = subject.felt_by(way);
            let cost = (is_timed && felt.is_ok()).then(|| {
                bench.time_repeated(1, 1, || {
                    if way.is_picture() {
                        subject.relief(way).is_ok()
                    } else {
                        subject.felt_by(way).is_ok()
                    }
                })
            });
            (way, felt, cost)
        });
        Self {
            name: subject.known.cloth.name.clone(),
            kin: subject.known.cloth.kin,
            taking: subject.taking,
            is_plain,
            truth: subject.known.truth.clone(),
            by_way: by_way.collect(),
            band_db: subject.band_db(),
        }
    }

    pub(super) fn felt_by(&self, way: Way) -> Option<&Felt> {
        let found = self.by_way.iter().find(|(other, _, _)| *other == way)?;
        found.1.as_ref().ok()
    }

    /// The sets of pictures that it is one of, in words.
    fn sets(&self) -> Vec<String> {
        let mut sets = Vec::from_iter(self.is_plain.then(|| "the plainest".to_owned()));
        let kin = match self.kin {
            Kin::Tuned => "tuned on",
            Kin::Fresh => "fresh",
            // Doubles would crowd the ranks of others.
            Kin::Double => return sets,
        };
        let [light, rest @ ..] = self.taking.words();
        let of_kin = format!("{light}, {kin}");
        sets.extend(["all".to_owned(), light, of_kin].into_iter().chain(rest));
        sets
    }
}

/// Rows of all pictures and of sets of them, and what a reader should know.
pub(super) fn report(results: &[Tried], effort: Effort) -> (Vec<Row>, Vec<String>) {
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for tried in results {
        let setting = tried.taking.words().join(", ");
        for (way, felt, cost) in &tried.by_way {
            rows.push(row(tried, (*way, &setting), felt, *cost));
        }
    }
    let plain: Vec<&Tried> = results.iter().filter(|tried| tried.is_plain).collect();
    for way in Way::ALL.into_iter().filter(|way| !way.is_picture()) {
        let summary = Summary::of(&plain, way);
        notes.push(summary.note(&way.name()));
        rows.push(summary.row(way, ""));
    }
    let mut sets: Vec<String> = Vec::new();
    for set in results.iter().flat_map(Tried::sets) {
        if !sets.contains(&set) {
            sets.push(set);
        }
    }
    for way in Way::ALL.into_iter().filter(|way| way.is_picture()) {
        for set in &sets {
            let is_of_set = |tried: &&Tried| tried.sets().contains(set);
            let of_set: Vec<&Tried> = results.iter().filter(is_of_set).collect();
            let summary = Summary::of(&of_set, way);
            let mut row = summary.row(way, set);
            if way == Way::Believed {
                notes.push(summary.note(&format!("{} ({set})", way.name())));
                let promised = PROMISED_DB.iter().find(|(of, _)| of == set);
                let promised = promised.filter(|_| effort == Effort::Full);
                row.promised = promised.map(|(_, db)| *db);
            }
            rows.push(row);
        }
    }
    notes.push(claim(&plain));
    (rows, notes)
}

fn row(
    tried: &Tried,
    (way, setting): (Way, &str),
    felt: &Result<Felt, String>,
    cost: Option<Timing>,
) -> Row {
    let setting = if way.is_picture() { setting } else { "" };
    let felt = match felt {
        Ok(felt) => felt,
        Err(reason) => return Row::of(way.name(), format!("{setting}: {reason}"), &tried.name),
    };
    let truth = &tried.truth;
    let apart_db = felt.apart_db(truth);
    let spectrum_percent = felt.spectrum_off_percent(truth);
    Row::of(way.name(), setting, &tried.name)
        .error(apart_db[0].abs().max(apart_db[1].abs()))
        .cost(cost)
        .number("true_a40_db", 3, truth.levels_db[0])
        .number("true_a320_db", 3, truth.levels_db[1])
        .number("a40_db", 3, felt.levels_db[0])
        .number("a320_db", 3, felt.levels_db[1])
        .number("a40_error_db", 3, apart_db[0])
        .number("a320_error_db", 3, apart_db[1])
        .number("true_smd_um", 3, truth.smd_um)
        .number("smd_error_percent", 3, felt.smd_off_percent(truth))
        .number("spectrum_error_percent", 3, spectrum_percent)
}

/// A route over many pictures.
#[derive(Debug, Clone, PartialEq)]
struct Summary {
    n: usize,
    n_pictures: usize,
    median_db: f64,
    /// Nine of ten are nearer.
    p90_db: f64,
    /// Of what is believed, the share of truths between its ends, %, and its mean width, dB; NaN
    /// of other routes.
    band: [f64; 2],
    median_spectrum_percent: f64,
    median_smd_percent: f64,
    /// Rank correlations of SMD, A40 and A320.
    ranks: [f64; 3],
    /// Distance of the fine cloth from its doubles: in truth, by the route, dB.
    pair_db: [f64; 2],
}

/// How far the levels of two cloths are apart, both bands together, dB.
fn distance_db(a: &Felt, b: &Felt) -> f64 {
    let [low, high] = a.apart_db(b);
    low.hypot(high)
}

/// Mean distance of the first cloth from its doubles, dB: in truth, and by a route.
fn doubles_db(results: &[&Tried], way: Way) -> [f64; 2] {
    let doubles = || results.iter().filter(|tried| tried.kin == Kin::Double);
    let mean = |distance: &dyn Fn(&Tried, &Tried) -> Option<f64>| {
        let first = results.first();
        let all = doubles().map(|double| distance(first?, double).filter(|db| db.is_finite()));
        let all: Option<Vec<f64>> = all.collect();
        all.map_or(f64::NAN, |all| all.iter().sum::<f64>() / all.len() as f64)
    };
    [
        mean(&|a, b| Some(distance_db(&a.truth, &b.truth))),
        mean(&|a, b| Some(distance_db(a.felt_by(way)?, b.felt_by(way)?))),
    ]
}

impl Summary {
    fn of(results: &[&Tried], way: Way) -> Self {
        let single = || results.iter().filter(|tried| tried.kin != Kin::Double);
        let pairs: Vec<[&Felt; 2]> = single()
            .filter_map(|tried| Some([&tried.truth, tried.felt_by(way)?]))
            .collect();
        let of_pairs = |f: &dyn Fn(&Felt, &Felt) -> f64| {
            let mut all: Vec<f64> = pairs.iter().map(|[truth, felt]| f(truth, felt)).collect();
            median(&mut all)
        };
        let ranks = |f: &dyn Fn(&Felt) -> f64| {
            let [truth, felt] = [0, 1]
                .map(|which| -> Vec<f64> { pairs.iter().map(|pair| f(pair[which])).collect() });
            rank_correlation(&truth, &felt).unwrap_or(f64::NAN)
        };
        let larger = |[low, high]: [f64; 2]| low.abs().max(high.abs());
        Self {
            n: pairs.len(),
            n_pictures: single().count(),
            median_db: of_pairs(&|truth, felt| larger(felt.apart_db(truth))),
            p90_db: {
                let off = |[truth, felt]: &[&Felt; 2]| larger(felt.apart_db(truth));
                quantile(&mut pairs.iter().map(off).collect::<Vec<f64>>(), 0.9)
            },
            band: match way {
                Way::Believed => band(single().copied()),
                _ => [f64::NAN; 2],
            },
            median_spectrum_percent: of_pairs(&|truth, felt| felt.spectrum_off_percent(truth)),
            median_smd_percent: of_pairs(&|truth, felt| felt.smd_off_percent(truth).abs()),
            ranks: [
                ranks(&|felt| felt.smd_um),
                ranks(&|felt| felt.levels_db[0]),
                ranks(&|felt| felt.levels_db[1]),
            ],
            pair_db: doubles_db(results, way),
        }
    }

    fn row(&self, way: Way, set: &str) -> Row {
        let case = format!("{} of {} pictures", self.n, self.n_pictures);
        Row::of(way.name(), set, case)
            .error(self.median_db.is_finite().then_some(self.median_db))
            .number("error_p90_db", 3, self.p90_db)
            .number("band_holds_percent", 3, self.band[0])
            .number("band_width_db", 3, self.band[1])
            .number("spectrum_error_percent", 3, self.median_spectrum_percent)
            .number("smd_error_percent", 3, self.median_smd_percent)
            .number("spearman_smd", 3, self.ranks[0])
            .number("spearman_a40", 3, self.ranks[1])
            .number("spearman_a320", 3, self.ranks[2])
            .number("true_doubles_db", 3, self.pair_db[0])
            .number("doubles_db", 3, self.pair_db[1])
    }

    fn note(&self, name: &str) -> String {
        let said = |x: f64, decimals: usize| {
            if x.is_finite() {
                selvedge_foundation::quantity::fixed(x, decimals)
            } else {
                "unknown".to_owned()
            }
        };
        let mut note = format!(
            "{name}: {} of {} pictures; level error {} dB in the median, nine of ten below {} dB; \
             median spectrum error {} %, rank correlation of SMD {}, of A40 {}, of A320 {}",
            self.n,
            self.n_pictures,
            said(self.median_db, 1),
            said(self.p90_db, 1),
            said(self.median_spectrum_percent, 0),
            said(self.ranks[0], 2),
            said(self.ranks[1], 2),
            said(self.ranks[2], 2),
        );
        let [doubles, truly] = [self.pair_db[1], self.pair_db[0]].map(|db| said(db, 1));
        if self.pair_db[1].is_finite() {
            let words =
                format!("; the fine cloth is {doubles} dB from its doubles, in truth {truly} dB");
            note.push_str(&words);
        }
        let [held, width] = [said(self.band[0], 0), said(self.band[1], 1)];
        if self.band[0].is_finite() {
            let words = format!(
                "; the band from 16 to 84 % is {width} dB wide and holds {held} % of truths"
            );
            note.push_str(&words);
        }
        note + "."
    }
}

/// The share of truths, by axis and band, between the ends of what is believed, %, and the mean
/// width, dB.
fn band<'a>(cloths: impl Iterator<Item = &'a Tried>) -> [f64; 2] {
    let bands: Vec<[f64; 2]> = cloths.filter_map(|tried| tried.band_db).flatten().collect();
    let n = bands.len() as f64;
    let n_held = bands
        .iter()
        .filter(|[low, high]| *low <= 0.0 && *high >= 0.0)
        .count();
    let width: f64 = bands.iter().map(|[low, high]| high - low).sum();
    [100.0 * n_held as f64 / n, width / n]
}

/// Whether fine cloths that are alike become distinct, and by which route.
fn claim(results: &[&Tried]) -> String {
    let by_way = Way::ALL.map(|way| (way, Summary::of(results, way)));
    let distinct: Vec<String> = by_way
        .iter()
        .filter(|(_, summary)| summary.pair_db[1] - summary.pair_db[0] > HARDLY_DB)
        .map(|(way, _)| way.name())
        .collect();
    let which = if distinct.is_empty() {
        "none of the routes does so here".to_owned()
    } else {
        format!("falsely distinct they become by: {}", distinct.join(", "))
    };
    let best = by_way
        .iter()
        .filter(|(_, summary)| summary.n * 2 > summary.n_pictures)
        .min_by(|a, b| a.1.median_db.total_cmp(&b.1.median_db));
    let nearest = best.map_or_else(
        || "No route ends for more than half of the cloths.".to_owned(),
        |(way, summary)| {
            format!(
                "Nearest to the truth in levels is: {} ({:.1} dB in the median).",
                way.name(),
                summary.median_db
            )
        },
    );
    format!(
        "The claim, that restoring a profile makes very fine cloths distinct that are alike and \
         that a picture does not: {which} (more than {HARDLY_DB} dB farther apart than \
         in truth). {nearest}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn felt(low_db: f64) -> Felt {
        Felt {
            smd_um: 10.0_f64.powf(low_db / 20.0),
            levels_db: [low_db, low_db - 1.0],
            axis_levels_db: [[low_db, low_db - 1.0]; 2],
            spectrum_um: vec![low_db.abs() + 1.0, 1.0],
        }
    }

    /// Four cloths that one route has right and one upside down.
    fn made_up() -> Vec<Tried> {
        let tried = |low_db: f64| Tried {
            name: format!("cloth {low_db}"),
            kin: if low_db > 1.5 && low_db < 2.5 {
                Kin::Double
            } else {
                Kin::Tuned
            },
            taking: Taking::PLAIN,
            is_plain: true,
            truth: felt(low_db),
            by_way: vec![
                (Way::ALL[0], Ok(felt(low_db)), None),
                (Way::ALL[1], Ok(felt(20.0 - 3.0 * low_db)), None),
                (Way::ALL[2], Err("no lattice".to_owned()), None),
            ],
            band_db: None,
        };
        [1.0, 2.0, 5.0, 9.0].map(tried).into()
    }

    #[test]
    fn a_route_that_is_upside_down_shows_up_as_wrong() {
        let made_up = made_up();
        let (rows, notes) = report(&made_up, Effort::Full);
        let all: Vec<&Tried> = made_up.iter().collect();
        let [right, wrong] = [0, 1].map(|way| Summary::of(&all, Way::ALL[way]));
        assert!(
            right.median_db.abs() < 1e-9 && wrong.median_db > 5.0,
            "{wrong:?}"
        );
        assert!((right.ranks[1] - 1.0).abs() < 1e-9 && (wrong.ranks[1] + 1.0).abs() < 1e-9);
        assert!(
            (wrong.pair_db[1] / wrong.pair_db[0] - 3.0).abs() < 1e-9,
            "{wrong:?}"
        );
        assert!(notes.iter().any(|note| note.contains("KES, restored.")
            || note.contains("distinct they become by: KES, restored")));
        let lost = rows.iter().find(|row| row.setting.contains("no lattice"));
        assert!(lost.is_some_and(|row| row.error.is_none()));
    }
}
