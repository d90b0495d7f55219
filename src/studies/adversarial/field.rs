//! What a search walks over: cases in numbers, the methods that are tried on them, and the walk.

use std::path::Path;

use crate::{ReportError, Row};
use selvedge_foundation::files::Table;
use selvedge_foundation::numerics::Random;

/// Random starts, a part of all evaluations each.
const N_STARTS: usize = 4;
/// A share that is larger than any bound, and that a file can hold: what came out is no number.
pub(super) const BROKEN: f64 = 1e9;

/// How a number is spaced over its range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spaced {
    Even,
    Log,
}

/// A number of a case: its name, from where to where it goes, and how.
pub(super) type Range = (&'static str, [f64; 2], Spaced);

/// What cases are made of, and which methods are tried on them.
pub(super) struct Field {
    /// The table of the worst that was found so far.
    pub(super) file: &'static str,
    pub(super) stored: &'static str,
    pub(super) ranges: &'static [Range],
    /// Where trouble is suspected: leads a case there, now and then.
    pub(super) lead: Option<fn(&mut [f64], &mut Random)>,
    pub(super) targets: &'static [Target],
}

/// A method and its bound.
pub(super) struct Target {
    pub(super) name: &'static str,
    /// It is tried once where the cheapest are tried so often.
    pub(super) one_in: usize,
    /// The error of a case as a share of what is promised there; 0 where nothing is.
    pub(super) share: fn(&[f64]) -> Result<f64, ReportError>,
}

/// A method by its name, how seldom it is tried, and its share.
pub(super) const fn target(
    name: &'static str,
    one_in: usize,
    share: fn(&[f64]) -> Result<f64, ReportError>,
) -> Target {
    Target {
        name,
        one_in,
        share,
    }
}

impl Target {
    /// The share of a case, in what a file can hold.
    pub(super) fn share_of(&self, case: &[f64]) -> Result<f64, ReportError> {
        let share = (self.share)(case)?;
        Ok(if share.is_finite() { share } else { BROKEN })
    }
}

impl Field {
    pub(super) fn row(&self, target: &Target, setting: &str, (case, share): (&[f64], f64)) -> Row {
        let row = Row::of(target.name, setting, "").error(share).promised(1.0);
        let columns = self.ranges.iter().zip(case);
        columns.fold(row, |row, ((name, ..), number)| row.with(name, *number))
    }

    /// The cases that are kept, with the names of what they were found for.
    pub(super) fn stored(&self) -> Result<Vec<(String, Vec<f64>)>, ReportError> {
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
    pub(super) fn search(
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

    pub(super) fn anywhere(&self, random: &mut Random) -> Vec<f64> {
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
pub(super) fn numbers<const N: usize>(case: &[f64]) -> Result<[f64; N], ReportError> {
    let wrong = |_| ReportError::Study(format!("a case has {} numbers, not {N}", case.len()));
    case.try_into().map_err(wrong)
}
