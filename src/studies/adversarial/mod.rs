//! The adversarial study: looks for the case at which a method comes nearest to the bound that it
//! states, or breaks it: rendering, the stylus, the hanging cloth, the electrovibration screen.
//!
//! The search is a walk uphill from several random starts, bounded by a count of evaluations. The
//! worst that was ever found is kept in a table a field, so that it is tried again with every
//! report and by a test; another seed looks elsewhere.

mod cloth;
mod scene;
mod screen;
mod stylus;

use std::path::Path;

use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::files::Table;
use selvedge_foundation::numerics::Random;

/// Random starts, a part of all evaluations each.
const N_STARTS: usize = 4;
/// A share that is larger than any bound, and that a file can hold: what came out is no number.
const BROKEN: f64 = 1e9;

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

/// How a number is spaced over its range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Spaced {
    Even,
    Log,
}

/// A number of a case: its name, from where to where it goes, and how.
type Range = (&'static str, [f64; 2], Spaced);

/// What cases are made of, and which methods are tried on them.
struct Field {
    /// The table of the worst that was found so far.
    file: &'static str,
    stored: &'static str,
    ranges: &'static [Range],
    /// Where trouble is suspected: leads a case there, now and then.
    lead: Option<fn(&mut [f64], &mut Random)>,
    targets: &'static [Target],
}

/// A method and its bound.
struct Target {
    name: &'static str,
    /// It is tried once where the cheapest are tried so often.
    one_in: usize,
    /// The error of a case as a share of what is promised there; 0 where nothing is.
    share: fn(&[f64]) -> Result<f64, ReportError>,
}

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
     thousandth of that or more. Filters are narrower than 1.2 octaves in a good part of the cases.",
    "The bound of a stylus is 1e-10 of the energy that was there or put in, of a cloth 1 %, \
     wherever its steps are marked stable or taken at all; of a screen 255 V from peak to peak.",
    "A row holds the case as it was found, so that it can be copied to its table in \
     `src/studies/adversarial/`, where it is tried again for ever.",
    "A search proves nothing: what it did not find may be there.",
];

impl Target {
    /// The share of a case, in what a file can hold.
    fn share_of(&self, case: &[f64]) -> Result<f64, ReportError> {
        let share = (self.share)(case)?;
        Ok(if share.is_finite() { share } else { BROKEN })
    }
}

impl Field {
    fn row(&self, target: &Target, setting: &str, (case, share): (&[f64], f64)) -> Row {
        let row = Row::of(target.name, setting, "").error(share).promised(1.0);
        let columns = self.ranges.iter().zip(case);
        columns.fold(row, |row, ((name, ..), number)| row.with(name, *number))
    }

    /// The cases that are kept, with the names of what they were found for.
    fn stored(&self) -> Result<Vec<(String, Vec<f64>)>, ReportError> {
        let names: Vec<&str> = self.ranges.iter().map(|(name, ..)| *name).collect();
        let columns = [&["method"], &names[..]].concat();
        let place = Path::new("src/studies/adversarial").join(self.file);
        let table = Table::read(self.stored, &place, &columns, &[])?;
        let methods = table.text("method").unwrap_or_default();
        let numbers: Vec<Vec<f64>> = (names.iter())
            .map(|name| table.required_numbers(name).unwrap_or_default())
            .collect();
        let case = |nth: usize| numbers.iter().map(|column| column[nth]).collect();
        let named = methods.iter().enumerate();
        Ok(named
            .map(|(nth, name)| ((*name).to_owned(), case(nth)))
            .collect())
    }

    /// The worst of so many cases: from random starts, each step a case beside the worst so far.
    fn search(
        &self,
        target: &Target,
        n: usize,
        random: &mut Random,
    ) -> Result<(Vec<f64>, f64), ReportError> {
        let mut worst = (self.anywhere(random), 0.0);
        for _ in 0..N_STARTS {
            let mut best = (self.anywhere(random), 0.0);
            for step in 0..n / N_STARTS {
                // First far and wide, then ever nearer.
                let reach = 0.5_f64.powf(8.0 * step as f64 / (n / N_STARTS) as f64);
                let case = self.beside(&best.0, reach, random);
                let share = target.share_of(&case)?;
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

    fn anywhere(&self, random: &mut Random) -> Vec<f64> {
        let number = |(_, range, spaced): &Range| {
            let [low, high] = range.map(|x| spaced.place(x));
            spaced.number(random.uniform_in(low, high))
        };
        self.ranges.iter().map(number).collect()
    }

    /// Another case whose numbers are off by up to this share of their ranges; now and then one
    /// that is led to where trouble is suspected.
    fn beside(&self, case: &[f64], reach: f64, random: &mut Random) -> Vec<f64> {
        let mut numbers = case.to_vec();
        for (number, (_, range, spaced)) in numbers.iter_mut().zip(self.ranges) {
            let [low, high] = range.map(|x| spaced.place(x));
            let place = spaced.place(*number) + 0.3 * reach * (high - low) * random.normal();
            // Half of the numbers stay, so that one can be changed alone.
            if random.uniform() < 0.5 {
                *number = spaced.number(place.clamp(low, high));
            }
        }
        if let Some(lead) = self.lead
            && random.uniform() < 0.25
        {
            lead(&mut numbers, random);
        }
        numbers
    }
}

impl Spaced {
    fn place(self, number: f64) -> f64 {
        match self {
            Self::Even => number,
            Self::Log => number.ln(),
        }
    }

    fn number(self, place: f64) -> f64 {
        match self {
            Self::Even => place,
            Self::Log => place.exp(),
        }
    }
}

/// The numbers of a case by their places.
fn numbers<const N: usize>(case: &[f64]) -> Result<[f64; N], ReportError> {
    let wrong = |_| ReportError::Study(format!("a case has {} numbers, not {N}", case.len()));
    case.try_into().map_err(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_stored_case_breaks_a_bound() {
        for field in &FIELDS {
            let stored = field.stored().unwrap();
            for target in field.targets {
                let known: Vec<_> = stored
                    .iter()
                    .filter(|(name, _)| name == target.name)
                    .collect();
                assert!(!known.is_empty(), "{}", target.name);
                for (_, case) in known {
                    let share = target.share_of(case).unwrap();
                    assert!(
                        share <= 1.0 && share > 0.0,
                        "{}: {share} of {case:?}",
                        target.name
                    );
                }
            }
        }
    }

    #[test]
    fn a_search_climbs_and_comes_to_the_same_from_the_same_seed() {
        for field in &FIELDS {
            let target = &field.targets[field.targets.len().min(3) - 1];
            let found = || field.search(target, 40, &mut Random::new(3)).unwrap();
            let (case, share) = found();
            assert_eq!(found(), (case, share), "{}", target.name);
            assert!(share > 0.0 && share <= 1.0, "{}: {share}", target.name);
        }
    }

    #[test]
    fn a_share_above_one_is_a_broken_promise_and_what_is_no_number_is_above_one() {
        let field = &FIELDS[0];
        let case = field.anywhere(&mut Random::new(1));
        let broken = field.row(&field.targets[1], "found", (&case, 1.01));
        assert_eq!(broken.is_kept(), Some(false));
        let nothing = Target {
            name: "nothing",
            one_in: 1,
            share: |_| Ok(f64::NAN),
        };
        assert!(nothing.share_of(&case).unwrap() > 1.0);
    }
}
