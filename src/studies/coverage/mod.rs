//! The study of intervals and tests: how often 95 % intervals hold the truth, and how often tests
//! at 5 % find something where nothing is.

mod intervals;
mod nulls;
#[cfg(test)]
mod tests;

use selvedge_foundation::numerics::{Random, in_pieces, n_threads};
use selvedge_foundation::quantity;
use selvedge_statistics::Computed;

use super::{Bench, Findings, ReportError, Row, Study};

/// Coverage wanted, %: no further below and above 95 than this.
const COVERAGE_BAND: [f64; 2] = [90.0, 98.0];
/// False positives wanted, %.
const FALSE_POSITIVE_BAND: [f64; 2] = [3.5, 6.5];

/// Coverage of intervals and false positives of tests.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CoverageStudy;

/// Something that holds or not in one simulated study.
#[derive(Clone, Copy)]
struct Trial {
    name: &'static str,
    setting: &'static str,
    /// Studies, quick and full.
    n_studies: [usize; 2],
    /// Whether the band is promised; what is known to miss it is shown none the less.
    is_promised: bool,
    /// One study: whether the interval holds the truth, or the test rejects.
    study: fn(&mut Random) -> Computed<bool>,
}

/// The same without a promise.
const fn unpromised(trial: Trial) -> Trial {
    Trial {
        is_promised: false,
        ..trial
    }
}

impl Study for CoverageStudy {
    fn name(&self) -> &'static str {
        "coverage"
    }

    fn question(&self) -> &'static str {
        "How often do 95 % intervals hold the truth, and tests at 5 % find what is not there, in \
         simulated studies of eight subjects and of single subjects?"
    }

    fn reference(&self) -> &'static str {
        "The numbers that the studies were drawn from; 95 % and 5 % are what is stated."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("distance from what is stated", "%")
    }

    fn cost_of(&self) -> &'static str {
        "study"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let mut findings = Findings::default();
        let kinds = [
            ("95 % interval", 95.0, COVERAGE_BAND, intervals::ALL),
            ("test at 5 %", 5.0, FALSE_POSITIVE_BAND, nulls::ALL),
        ];
        let n_all: usize = kinds.iter().map(|kind| kind.3.len()).sum();
        let mut n_done = 0.0;
        for (case, stated, band, trials) in kinds {
            for trial in trials {
                bench.step(n_done / n_all as f64, trial.name)?;
                n_done += 1.0;
                let [quick, full] = trial.n_studies;
                let tally = tally(trial, bench.effort.pick(quick, full), bench.seed);
                findings.rows.push(tally.row(trial, case, stated, band));
            }
        }
        findings.notes.push(notes());
        Ok(findings)
    }
}

fn notes() -> String {
    let [low, high] = COVERAGE_BAND.map(|percent| quantity::fixed(percent, 0));
    let [least, most] = FALSE_POSITIVE_BAND.map(|percent| quantity::fixed(percent, 1));
    format!(
        "Promised: coverage of {low}–{high} %, false positives of {least}–{most} %, give or \
         take two standard errors of the simulation, which stand beside each share. Rows without \
         a promise are known to miss their level with so few subjects, and say by how much."
    )
}

/// How often it held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Tally {
    held: usize,
    undefined: usize,
    n_studies: usize,
}

/// Simulates studies; each has random numbers of its own, so that threads change nothing.
fn tally(trial: &Trial, n_studies: usize, seed: u64) -> Tally {
    let random = Random::new(seed).branch(trial.name).branch(trial.setting);
    let mut outcomes: Vec<Option<bool>> = vec![None; n_studies];
    let per_piece = 8;
    in_pieces(
        &mut outcomes,
        per_piece,
        n_threads(),
        || (),
        |(), number, piece| {
            for (nth, outcome) in piece.iter_mut().enumerate() {
                let mut random = random.branch(&format!("study {}", number * per_piece + nth));
                *outcome = (trial.study)(&mut random).ok();
            }
        },
    );
    let count = |wanted: Option<bool>| outcomes.iter().filter(|&&o| o == wanted).count();
    Tally {
        held: count(Some(true)),
        undefined: count(None),
        n_studies,
    }
}

impl Tally {
    fn percent(&self) -> f64 {
        100.0 * self.held as f64 / (self.n_studies - self.undefined) as f64
    }

    fn row(&self, trial: &Trial, case: &str, stated: f64, band: [f64; 2]) -> Row {
        let (percent, n) = (self.percent(), self.n_studies - self.undefined);
        let error = (percent * (100.0 - percent) / n as f64).sqrt();
        let width = if percent < stated {
            stated - band[0]
        } else {
            band[1] - stated
        };
        Row {
            method: trial.name.to_owned(),
            setting: trial.setting.to_owned(),
            case: case.to_owned(),
            error: Some((percent - stated).abs()),
            promised: trial.is_promised.then_some(width + 2.0 * error),
            more: vec![
                ("came_out_percent", format!("{percent:.2}")),
                ("simulation_error_percent", format!("{error:.2}")),
                ("studies", self.n_studies.to_string()),
                ("undefined", self.undefined.to_string()),
            ],
            ..Row::default()
        }
    }
}

/// Normal numbers about a mean.
fn normals<const N: usize>(random: &mut Random, mean: f64, sd: f64) -> [f64; N] {
    std::array::from_fn(|_| mean + sd * random.normal())
}

/// How many of `n` trials succeed.
fn successes(random: &mut Random, n: u32, p: f64) -> u32 {
    (0..n).map(|_| u32::from(random.uniform() < p)).sum()
}
