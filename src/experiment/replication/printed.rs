//! What the papers print, and whether their printed numbers follow from each other.
//!
//! A printed number stands for all that round to it. What follows from printed numbers is computed
//! at both ends of what they stand for; another printed number follows if it can be reached within
//! its own rounding.

use crate::analysis::{Cell, Section, Table, cells, or_undefined};
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::variance::partial_eta_squared;
use selvedge_statistics::{Computed, Outcome, Summary, TwoSamples, f_upper, one_sample_t};

/// A printed share, %.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub(super) quantity: &'static str,
    pub(super) percent: f64,
    /// Its standard error over subjects.
    pub(super) se: Option<f64>,
}

impl Share {
    const fn of(quantity: &'static str, percent: f64, se: Option<f64>) -> Self {
        Self {
            quantity,
            percent,
            se,
        }
    }
}

const FIRST: &str = "target ranked first, %";
const PRACTISED: &str = "target ranked first, practised users, %";

/// Experiment 1 of Philpott & Summers 2012: virtual alternatives, a real target.
pub(super) const REAL: Share = Share::of(FIRST, 41.3, Some(1.6));
/// Experiment 2: virtual alternatives, a virtual target.
pub(super) const VIRTUAL: Share = Share::of(FIRST, 64.1, Some(5.5));
/// Practised users in experiment 1.
pub(super) const REAL_PRACTISED: Share = Share::of(PRACTISED, 50.0, None);
/// Practised users in experiment 2.
pub(super) const VIRTUAL_PRACTISED: Share = Share::of(PRACTISED, 91.0, None);
/// One of four.
pub(super) const CHANCE: Share = Share::of("target ranked first by chance, %", 25.0, None);
/// Correlations of dimension 1 with A40 and of dimension 2 with A320 in experiment 2.
pub(super) const CORRELATIONS: [f64; 2] = [0.93, 0.55];
/// Subjects, and trials of each.
const RANKING: (usize, u64) = (8, 80);

/// What Cai et al. 2021 print of the share called real, %: the recorded signal, the generated one.
pub(super) const CALLED_REAL: [f64; 2] = [47.92, 52.08];
/// Their F of the signal for materials that the network had seen and had not, by the group of the
/// design, with 1 and 11 degrees of freedom, with partial eta squared and p as printed.
pub(super) const SIGNALS: [(&str, &str, f64, f64, f64); 2] = [
    ("seen", "materials seen", 0.044, 0.003, 0.838),
    ("unseen", "materials not seen", 0.508, 0.004, 0.491),
];
/// F of the material, with 7 and 77.
const MATERIAL_F: f64 = 0.584;
/// Subjects, and trials of each with either signal.
const JUDGING: (u64, u64) = (12, 16);

/// A number that follows from printed ones.
struct Follows {
    paper: &'static str,
    from: String,
    what: &'static str,
    computed: Computed<[f64; 2]>,
    /// As printed, and half of its last digit.
    printed: Option<(f64, f64)>,
    decimals: usize,
}

impl Follows {
    fn of(
        paper: &'static str,
        from: &str,
        what: &'static str,
        computed: Computed<[f64; 2]>,
        printed: Option<(f64, f64)>,
        decimals: usize,
    ) -> Self {
        Self {
            paper,
            from: from.to_owned(),
            what,
            computed,
            printed,
            decimals,
        }
    }
}

/// Printed numbers checked against each other.
pub(super) fn section() -> Section {
    let title = "Printed values, and whether they follow from each other";
    let mut section = Section::new("printed", title);
    section.note(
        "From printed numbers, at both ends of what rounds to them. A number that cannot be \
         reached so does not follow from them.",
    );
    let columns = "paper; from; what: follows; low: computed, from; high: to; printed; verdict";
    let mut table = Table::new("check", "Printed values recomputed", columns);
    for one in all() {
        table.push(row(&one));
    }
    section.table(table);
    section.note(
        "47.92 % and 52.08 % of 12 × 16 trials are 92 and 100 of 192, together exactly all: as if \
         one of two had to be called real, though single trials are described too. Coded so, the \
         material has no main effect at all, 0/0.",
    );
    section.note("A p above 0.05 of twelve subjects is no proof that signals feel alike.");
    section
}

fn row(one: &Follows) -> Vec<Cell> {
    let computed = one.computed.as_ref().map(|ends| cells![*ends]);
    let printed = one.printed.map_or_else(
        || Cell::none("not printed"),
        |(value, _)| fixed(value, one.decimals).into(),
    );
    cells![
        one.paper,
        &one.from,
        one.what,
        or_undefined(computed, 2),
        printed,
        verdict(one)
    ]
}

fn verdict(one: &Follows) -> &'static str {
    match (&one.computed, one.printed) {
        (Ok([low, high]), Some((value, half))) => {
            if value + half >= *low && value - half <= *high {
                "follows"
            } else {
                "does not follow"
            }
        }
        (Ok(_), None) => "for the reader",
        (Err(_), _) => "not computable",
    }
}

fn all() -> Vec<Follows> {
    let mut all = ranking();
    all.extend(judging());
    all
}

const RANKING_PAPER: &str = "Philpott & Summers 2012";
const JUDGING_PAPER: &str = "Cai et al. 2021";

fn ranking() -> Vec<Follows> {
    let t = |share: Share, of: fn(&Outcome) -> f64| {
        at_ends(share, |s| Ok(of(&one_sample_t(s, CHANCE.percent)?)))
    };
    let described = |share: Share| {
        let se = share.se.unwrap_or(0.0);
        format!("{} ± {} %, n = 8", fixed(share.percent, 1), fixed(se, 1))
    };
    let one = |from: &str, what, computed, decimals| {
        Follows::of(RANKING_PAPER, from, what, computed, None, decimals)
    };
    let mut all = Vec::new();
    for share in [REAL, VIRTUAL] {
        let from = described(share);
        let value = |o: &Outcome| o.statistic.value;
        all.push(one(&from, "t(7) against 25 %", t(share, value), 2));
        all.push(one(&from, "its p", t(share, |o| o.p), 6));
        all.push(one(&from, "correct trials of 640", Ok(counts(share)), 0));
    }
    let both = format!("{}; {}", described(VIRTUAL), described(REAL));
    let p = Some((0.0012, 0.000_05));
    let student = "p of experiment 2 against 1, Student's t(14)";
    let found = between(|o| o.student.p);
    all.push(Follows::of(RANKING_PAPER, &both, student, found, p, 4));
    let found = between(|o| o.welch.p);
    all.push(Follows::of(
        RANKING_PAPER,
        &both,
        "the same, Welch's t(8.2)",
        found,
        p,
        4,
    ));
    all
}

fn judging() -> Vec<Follows> {
    let one = |from: &str, what, computed, printed, decimals| {
        Follows::of(JUDGING_PAPER, from, what, computed, printed, decimals)
    };
    let f_ends = |f: f64, of: &dyn Fn(f64) -> Computed| {
        let [a, b] = [of(f - 0.0005)?, of(f + 0.0005)?];
        Ok([a.min(b), a.max(b)])
    };
    let mut all = Vec::new();
    for (_, materials, f, eta_squared, p) in SIGNALS {
        let from = format!("F(1, 11) = {}, {materials}", fixed(f, 3));
        let eta = f_ends(f, &|f| partial_eta_squared(f, 1.0, 11.0));
        all.push(one(
            &from,
            "partial η²",
            eta,
            Some((eta_squared, 0.0005)),
            3,
        ));
        let tail = f_ends(f, &|f| f_upper(f, 1.0, 11.0));
        all.push(one(&from, "its p", tail, Some((p, 0.0005)), 3));
    }
    let from = format!("F(7, 77) = {}", fixed(MATERIAL_F, 3));
    let eta = f_ends(MATERIAL_F, &|f| partial_eta_squared(f, 7.0, 77.0));
    all.push(one(&from, "partial η²", eta, Some((0.050, 0.0005)), 3));
    let (subjects, trials) = JUDGING;
    for percent in CALLED_REAL {
        let from = format!("{} % of 12 × 16", fixed(percent, 2));
        let n = (subjects * trials) as f64;
        let ends = [percent - 0.005, percent + 0.005].map(|percent| percent / 100.0 * n);
        all.push(one(&from, "trials called real", Ok(ends), None, 0));
    }
    all
}

/// How many correct trials a printed mean stands for.
fn counts(share: Share) -> [f64; 2] {
    let n = RANKING.0 as f64 * RANKING.1 as f64;
    [share.percent - 0.05, share.percent + 0.05].map(|percent| percent / 100.0 * n)
}

/// The samples that a printed mean and SE stand for, at their ends.
fn corners(share: Share) -> Vec<Summary> {
    let se = share.se.unwrap_or(0.0);
    let ends = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
    let corner = |(a, b): (f64, f64)| {
        Summary::of_mean_and_se(RANKING.0, share.percent + 0.05 * a, se + 0.05 * b).ok()
    };
    ends.into_iter().filter_map(corner).collect()
}

fn at_ends(share: Share, of: impl Fn(&Summary) -> Computed) -> Computed<[f64; 2]> {
    let values: Computed<Vec<f64>> = corners(share).iter().map(of).collect();
    Ok(ends_of(&values?))
}

fn between(of: impl Fn(&TwoSamples) -> f64) -> Computed<[f64; 2]> {
    let mut values = Vec::new();
    for a in corners(VIRTUAL) {
        for b in corners(REAL) {
            values.push(of(&TwoSamples::of(&a, &b)?));
        }
    }
    Ok(ends_of(&values))
}

fn ends_of(values: &[f64]) -> [f64; 2] {
    let values = values.iter().copied();
    [
        values.clone().fold(f64::INFINITY, f64::min),
        values.fold(f64::NEG_INFINITY, f64::max),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(what: &str) -> Vec<(Follows, &'static str)> {
        let own = all().into_iter().filter(|one| one.what.contains(what));
        own.map(|one| {
            let verdict = verdict(&one);
            (one, verdict)
        })
        .collect()
    }

    #[test]
    fn partial_eta_squared_of_both_signals_does_not_follow_and_that_of_the_material_does() {
        let verdicts: Vec<&str> = found("partial η²").iter().map(|one| one.1).collect();
        assert_eq!(
            verdicts,
            ["does not follow", "does not follow", "follows"],
            "0.0040 for 0.003, 0.0441 for 0.004, 0.0504"
        );
    }

    #[test]
    fn p_of_both_signals_follows() {
        let own = found("its p");
        let judged: Vec<&str> = own
            .iter()
            .filter(|one| one.0.paper == JUDGING_PAPER)
            .map(|one| one.1)
            .collect();
        assert_eq!(judged, ["follows", "follows"]);
    }

    #[test]
    fn the_difference_of_experiments_follows_by_student_and_not_by_welch() {
        let own = found("t(");
        let verdict_of = |name: &str| {
            let one = own.iter().find(|one| one.0.what.contains(name));
            one.map(|one| one.1)
        };
        assert_eq!(verdict_of("Student"), Some("follows"));
        assert_eq!(verdict_of("Welch"), Some("does not follow"));
    }

    #[test]
    fn t_against_chance_is_that_of_the_printed_means() {
        let own = found("t(7) against");
        let ends: Vec<[f64; 2]> = own
            .into_iter()
            .map(|one| one.0.computed.unwrap_or([f64::NAN; 2]))
            .collect();
        assert!(ends[0][0] < 10.19 && 10.19 < ends[0][1], "{ends:?}");
        assert!(ends[1][0] < 7.11 && 7.11 < ends[1][1], "{ends:?}");
    }

    #[test]
    fn shares_stand_for_whole_trials() {
        for (one, _) in found("trials called real") {
            let [low, high] = one.computed.unwrap_or([f64::NAN; 2]);
            assert_eq!(low.ceil(), high.floor(), "{}", one.from);
        }
    }
}
