//! The adversarial study: looks for the case at which a method comes nearest to the bound that it
//! states, or breaks it: rendering, the stylus, the hanging cloth, the electrovibration screen.
//!
//! The search is a walk uphill from several random starts, bounded by a count of evaluations. The
//! worst that was ever found is kept in a table a field, so that it is tried again with every
//! report and by a test; another seed looks elsewhere.

mod cloth;
mod field;
mod scene;
mod screen;
mod stylus;

use super::{Bench, Findings, ReportError, Study};
use field::Field;
use selvedge_foundation::numerics::Random;

/// Error against bound, as large as a search can make it.
pub(crate) const STUDY: Study = Study {
    name: "adversarial",
    chapter: "amplitudes",
    question: "Does any surface, motion, stiffness or step break the bound that a method states \
               before its first tick?",
    reference: "Of amplitudes the method reference on the same poses, and for the reference itself \
                the formula, summed with compensation; of a stylus and a cloth the energy that was \
                there and put in; of a screen the voltage that it may have.",
    error: ("error as a share of its bound", ""),
    cost_of: "evaluation",
    run,
};

const FIELDS: [Field; 4] = [scene::FIELD, stylus::FIELD, cloth::FIELD, screen::FIELD];

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let n_all = bench.effort.pick(60, 2000);
    let mut rows = Vec::new();
    for (nth, field) in FIELDS.iter().enumerate() {
        let stored = field.stored()?;
        for target in field.targets {
            bench.step(nth as f64 / FIELDS.len() as f64, target.name)?;
            let known = stored.iter().filter(|(name, _)| name == target.name);
            for (_, case) in known {
                let share = target.share_of(case)?;
                rows.push(field.row(target, "stored", (case, share)));
            }
            let mut random = Random::new(bench.seed).branch(target.name);
            let n = n_all / target.one_in;
            let (case, share) = field.search(target, n, &mut random)?;
            rows.push(
                field
                    .row(target, "found", (&case, share))
                    .with("n_evaluations", n),
            );
        }
    }
    Ok(Findings::new(rows, Vec::new(), NOTES))
}

const NOTES: [&str; 4] = [
    "The bound of amplitudes: |a − a_ref| is at most a_ref·(10^(bound/20) − 1) and a share `floor` \
     of what the surface would give unfiltered, and in level at most the bound where a_ref is a \
     thousandth of that or more. Filters are narrower than 1.2 octaves in a good part of the \
     cases.",
    "The bound of a stylus is 1e-10 of the energy that was there or put in, of a cloth 1 %, \
     wherever its steps are marked stable or taken at all; of a screen 255 V from peak to peak.",
    "A row holds the case as it was found, so that it can be copied to its table in \
     `src/studies/adversarial/`, where it is tried again for ever.",
    "A search proves nothing: what it did not find may be there.",
];

#[cfg(test)]
mod tests {
    use super::field::{Target, target};
    use super::*;

    #[test]
    fn no_stored_case_breaks_a_bound() {
        for field in &FIELDS {
            let stored = field.stored().unwrap();
            let shares = |target: &Target| -> Vec<f64> {
                let known = stored.iter().filter(|(name, _)| name == target.name);
                known
                    .map(|(_, case)| target.share_of(case).unwrap())
                    .collect()
            };
            for target in field.targets {
                let shares = shares(target);
                let is_kept = |share: &f64| (0.0..=1.0).contains(share);
                assert!(shares.iter().all(is_kept), "{}: {shares:?}", target.name);
            }
            let is_near = field
                .targets
                .iter()
                .flat_map(shares)
                .any(|share| share > 0.3);
            assert!(is_near, "{} has nothing that comes near", field.file);
        }
    }

    #[test]
    fn a_search_comes_to_the_same_from_the_same_seed_and_climbs() {
        for field in &FIELDS {
            let target = &field.targets[field.targets.len().min(3) - 1];
            let found = |n: usize| field.search(target, n, &mut Random::new(3)).unwrap();
            let (case, share) = found(40);
            assert_eq!(found(40), (case, share), "{}", target.name);
            assert!((0.0..=1.0).contains(&share), "{}: {share}", target.name);
        }
        let (_, share) = FIELDS[0]
            .search(&FIELDS[0].targets[2], 40, &mut Random::new(3))
            .unwrap();
        assert!(share > 0.0, "{share}");
    }

    #[test]
    fn a_share_above_one_is_a_broken_promise_and_what_is_no_number_is_above_one() {
        let field = &FIELDS[0];
        let case = field.anywhere(&mut Random::new(1));
        let broken = field.row(&field.targets[1], "found", (&case, 1.01));
        assert_eq!(broken.is_kept(), Some(false));
        let nothing = target("nothing", 1, |_| Ok(f64::NAN));
        assert!(nothing.share_of(&case).unwrap() > 1.0);
    }
}
