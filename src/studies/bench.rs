//! Measuring honestly: warm-up, repeats, medians with their spread, CPU time beside wall time.
//!
//! Wall time on a shared machine says little; the time that the thread itself used says more. Both
//! are given, as the median over several repeats with the quartiles around it.

use std::hint::black_box;
use std::time::Instant;

use super::ReportError;
use selvedge_foundation::numerics::{median, quantile};
use selvedge_foundation::progress::{Cancelled, Progress, thread_cpu_seconds};

/// How much work a report may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Effort {
    /// Fewer cases and repeats: all studies within a minute.
    Quick,
    /// Every case.
    #[default]
    Full,
}

impl Effort {
    /// One of two numbers, by the effort.
    pub fn pick<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// How long something took, s for each unit of work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Median CPU time of the thread.
    pub cpu_s: f64,
    /// Lower and upper quartile of the CPU time.
    pub cpu_quartiles_s: [f64; 2],
    /// Median wall time.
    pub wall_s: f64,
    /// Repeats that were measured.
    pub n_repeats: usize,
}

impl Timing {
    /// That of so many times the work, or of a part of it.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            cpu_s: factor * self.cpu_s,
            cpu_quartiles_s: self.cpu_quartiles_s.map(|s| factor * s),
            wall_s: factor * self.wall_s,
            ..self
        }
    }
}

/// Hears how far a study is.
type Step<'a> = dyn FnMut(f64, &str) -> Result<(), Cancelled> + 'a;

/// What a study measures with, and how far it may go.
pub struct Bench<'a> {
    /// How much work it may take.
    pub effort: Effort,
    /// What its random numbers begin with.
    pub seed: u64,
    step: Box<Step<'a>>,
}

impl std::fmt::Debug for Bench<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bench")
            .field("effort", &self.effort)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

impl<'a> Bench<'a> {
    /// A bench that tells `progress` how far a study is.
    pub fn new(effort: Effort, seed: u64, progress: &'a mut Progress<'_>) -> Self {
        Self {
            effort,
            seed,
            step: Box::new(|share, doing| progress.step(share, doing)),
        }
    }

    /// Says how far the study is, 0…1, and what it is doing.
    ///
    /// # Errors
    /// It should stop.
    pub fn step(&mut self, share: f64, doing: &str) -> Result<(), ReportError> {
        (self.step)(share, doing).map_err(|_cancelled| ReportError::Cancelled)
    }

    /// Measures `work`, which does `n_units` of what is counted and is repeated until its own time
    /// can be told from the clock's.
    pub fn time<T>(&mut self, n_units: usize, work: impl FnMut() -> T) -> Timing {
        self.time_repeated(self.effort.pick(5, 15), n_units, work)
    }

    /// The same with so many repeats: for work that takes long and so varies little.
    pub(crate) fn time_repeated<T>(
        &self,
        n_repeats: usize,
        n_units: usize,
        work: impl FnMut() -> T,
    ) -> Timing {
        let mut runs = Runs::new(self.least_s(), n_units, work);
        for _ in 0..n_repeats {
            runs.run();
        }
        runs.timing()
    }

    /// Measures several works of `n_units` each, repeat by repeat in turn, so that a machine that
    /// changes its pace meanwhile changes it for all. Beside each timing stands its CPU time as a
    /// multiple of the first's, in the median over the repeats.
    pub(crate) fn time_in_turn<T>(
        &self,
        n_units: usize,
        works: Vec<impl FnMut() -> T>,
    ) -> Vec<(Timing, f64)> {
        let runs = |work| Runs::new(self.least_s(), n_units, work);
        let mut all: Vec<_> = works.into_iter().map(runs).collect();
        for _ in 0..self.effort.pick(5, 15) {
            all.iter_mut().for_each(Runs::run);
        }
        let first_s = all.first().map(|first| first.cpu_s.clone());
        let first_s = first_s.unwrap_or_default();
        let with_multiple = |runs: Runs<_>| {
            let pairs = runs.cpu_s.iter().zip(&first_s);
            let mut multiples: Vec<f64> = pairs.map(|(own_s, first_s)| own_s / first_s).collect();
            (runs.timing(), median(&mut multiples))
        };
        all.into_iter().map(with_multiple).collect()
    }

    /// Least time of one measurement, s.
    fn least_s(&self) -> f64 {
        self.effort.pick(0.5e-3, 2e-3)
    }
}

/// Work and how long it took, run by run.
struct Runs<W> {
    work: W,
    n_inner: usize,
    n_units: usize,
    cpu_s: Vec<f64>,
    wall_s: Vec<f64>,
}

impl<T, W: FnMut() -> T> Runs<W> {
    /// Warms up, and finds how often the work is to be repeated for one measurement.
    fn new(least_s: f64, n_units: usize, mut work: W) -> Self {
        black_box(work());
        Self {
            n_inner: inner_repeats(least_s, &mut work),
            n_units: n_units.max(1),
            work,
            cpu_s: Vec::new(),
            wall_s: Vec::new(),
        }
    }

    fn run(&mut self) {
        let (start, start_cpu_s) = (Instant::now(), thread_cpu_seconds());
        for _ in 0..self.n_inner {
            black_box((self.work)());
        }
        let n = (self.n_inner * self.n_units) as f64;
        self.cpu_s.push((thread_cpu_seconds() - start_cpu_s) / n);
        self.wall_s.push(start.elapsed().as_secs_f64() / n);
    }

    fn timing(mut self) -> Timing {
        Timing {
            cpu_s: median(&mut self.cpu_s),
            cpu_quartiles_s: [0.25, 0.75].map(|q| quantile(&mut self.cpu_s, q)),
            wall_s: median(&mut self.wall_s),
            n_repeats: self.cpu_s.len(),
        }
    }
}

/// How often the work is repeated for one measurement: until it takes `least_s`.
fn inner_repeats<T>(least_s: f64, work: &mut impl FnMut() -> T) -> usize {
    let mut n = 1;
    loop {
        let start = Instant::now();
        for _ in 0..n {
            black_box(work());
        }
        if start.elapsed().as_secs_f64() >= least_s || n >= 1 << 20 {
            return n;
        }
        n *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::progress::CancelFlag;

    #[test]
    fn work_is_measured_for_each_unit_and_counted() {
        let mut n_calls = 0_u64;
        let mut report = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut report, CancelFlag::new());
        let mut bench = Bench::new(Effort::Quick, 1, &mut progress);
        let timing = bench.time(1000, || n_calls += 1);
        assert_eq!(timing.n_repeats, 5);
        assert!(n_calls > 5 && timing.cpu_s >= 0.0, "{timing:?}");
        let [low, high] = timing.cpu_quartiles_s;
        assert!(low <= timing.cpu_s && timing.cpu_s <= high, "{timing:?}");
    }

    #[test]
    fn works_measured_in_turn_are_compared_with_the_first() {
        let mut report = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut report, CancelFlag::new());
        let bench = Bench::new(Effort::Quick, 1, &mut progress);
        let work = |n: u64| move || (0..n).fold(0, |sum: u64, i| black_box(sum ^ i));
        let found = bench.time_in_turn(1, vec![work(100), work(10_000)]);
        let [(first, of_itself), (second, of_first)] = found[..] else {
            panic!("{found:?}");
        };
        assert!((of_itself - 1.0).abs() < 1e-12, "{of_itself}");
        assert_eq!((first.n_repeats, second.n_repeats), (5, 5));
        assert!(of_first.is_finite() && of_first >= 0.0, "{of_first}");
    }

    #[test]
    fn a_cancelled_study_stops_at_its_next_step() {
        let cancel = CancelFlag::new();
        let mut report = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut report, cancel.clone());
        let mut bench = Bench::new(Effort::Full, 1, &mut progress);
        assert!(bench.step(0.1, "one").is_ok());
        cancel.cancel();
        assert!(matches!(
            bench.step(0.2, "two"),
            Err(ReportError::Cancelled)
        ));
    }
}
