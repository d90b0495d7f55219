//! The adversarial study: looks for the surface, filter, place and motion at which a method of
//! rendering comes nearest to the bound that it states, or breaks it.
//!
//! The search is a walk uphill from several random starts, bounded by a count of evaluations. The
//! worst that was ever found is kept in `worst.csv`, so that it is tried again with every report
//! and by a test; another seed looks elsewhere.

mod scene;

use std::path::Path;

use super::{Bench, Findings, ReportError, Row, Study};
use scene::{Case, RANGES};
use selvedge_foundation::files::Table;
use selvedge_foundation::numerics::Random;
use selvedge_render::array::Method;

/// The worst that was found so far, method by method.
const WORST: &str = include_str!("worst.csv");
/// Random starts, a part of all evaluations each.
const N_STARTS: usize = 4;

/// Error against bound, as large as a search can make it.
pub(crate) const STUDY: Study = Study {
    name: "adversarial",
    chapter: "amplitudes",
    question: "Does any surface, filter, place or motion break the bound that a method of \
               rendering states before its first tick?",
    reference: "The method reference on the same poses; for the reference itself the formula, \
                summed with compensation.",
    error: ("error as a share of its bound", ""),
    cost_of: "evaluation",
    run,
};

/// A method on a kind of surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Target {
    name: &'static str,
    method: Method,
    is_areal: bool,
}

const TARGETS: [Target; 5] = [
    target("reference", Method::Reference, false),
    target("banded", Method::Banded, false),
    target("table", Method::Table, false),
    target("areal banded", Method::Banded, true),
    target("areal table", Method::Table, true),
];

const fn target(name: &'static str, method: Method, is_areal: bool) -> Target {
    Target {
        name,
        method,
        is_areal,
    }
}

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let stored = stored()?;
    let n_all = bench.effort.pick(60, 2000);
    let mut rows = Vec::new();
    for (nth, target) in TARGETS.into_iter().enumerate() {
        bench.step(nth as f64 / TARGETS.len() as f64, target.name)?;
        let known = stored.iter().filter(|(name, _)| name == target.name);
        for (_, case) in known {
            rows.push(row(target, "stored", case, case.share(target)?));
        }
        let mut random = Random::new(bench.seed).branch(target.name);
        let n = if target.is_areal { n_all / 6 } else { n_all };
        let (case, share) = search(target, n, &mut random)?;
        rows.push(row(target, "found", &case, share).with("n_evaluations", n));
    }
    Ok(Findings::new(rows, Vec::new(), NOTES))
}

const NOTES: [&str; 3] = [
    "The bound: |a − a_ref| is at most a_ref·(10^(bound/20) − 1) and a share `floor` of what the \
     surface would give unfiltered, and in level at most the bound where a_ref is a thousandth of \
     that or more. Filters are narrower than 1.2 octaves in a good part of the cases.",
    "A row holds the case as it was found, so that it can be copied to \
     `src/studies/adversarial/worst.csv`, where it is tried again for ever.",
    "A search proves nothing: what it did not find may be there.",
];

fn row(target: Target, setting: &str, case: &Case, share: f64) -> Row {
    let row = Row::of(target.name, setting, "").error(share).promised(1.0);
    let columns = RANGES.into_iter().zip(case.0);
    columns.fold(row, |row, ((name, ..), number)| row.with(name, number))
}

/// The cases that are kept, with the names of what they were found for.
fn stored() -> Result<Vec<(String, Case)>, ReportError> {
    let names = RANGES.map(|(name, ..)| name);
    let columns = [&["method"], &names[..]].concat();
    let table = Table::read(
        WORST,
        Path::new("src/studies/adversarial/worst.csv"),
        &columns,
        &[],
    )?;
    let numbers = names.map(|name| table.required_numbers(name).unwrap_or_default());
    let methods = table.text("method").unwrap_or_default();
    let case = |nth: usize| Case(numbers.each_ref().map(|column| column[nth]));
    Ok(methods
        .iter()
        .enumerate()
        .map(|(nth, name)| ((*name).to_owned(), case(nth)))
        .collect())
}

/// The worst of so many cases: from random starts, each step a case beside the worst so far.
fn search(target: Target, n: usize, random: &mut Random) -> Result<(Case, f64), ReportError> {
    let mut worst = (Case::random(random), 0.0);
    for _ in 0..N_STARTS {
        let mut best = (Case::random(random), 0.0);
        for step in 0..n / N_STARTS {
            // First far and wide, then ever nearer.
            let reach = 0.5_f64.powf(8.0 * step as f64 / (n / N_STARTS) as f64);
            let case = best.0.beside(reach, random);
            let share = case.share(target)?;
            if share > best.1 {
                best = (case, share);
            }
        }
        if best.1 > worst.1 {
            worst = best;
        }
    }
    Ok(worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_stored_case_breaks_a_bound() {
        let stored = stored().unwrap();
        for target in TARGETS {
            let known: Vec<_> = stored
                .iter()
                .filter(|(name, _)| name == target.name)
                .collect();
            assert!(!known.is_empty(), "{}", target.name);
            for (_, case) in known {
                let share = case.share(target).unwrap();
                assert!(
                    share <= 1.0 && share > 0.0,
                    "{}: {share} of {case:?}",
                    target.name
                );
            }
        }
    }

    #[test]
    fn a_search_climbs_and_comes_to_the_same_from_the_same_seed() {
        let found = |n: usize| search(TARGETS[2], n, &mut Random::new(3)).unwrap();
        let (case, share) = found(40);
        assert_eq!(found(40), (case, share));
        assert!(share > 0.0 && share <= 1.0, "{share}");
    }

    #[test]
    fn a_share_above_one_is_a_broken_promise() {
        let broken = row(
            TARGETS[1],
            "found",
            &Case::random(&mut Random::new(1)),
            1.01,
        );
        assert_eq!(broken.is_kept(), Some(false));
    }
}
