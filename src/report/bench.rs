//! Measuring honestly: warm-up, repeats, medians with their spread, CPU time beside wall time.
//!
//! Wall time on a shared machine says little; the time that the thread itself used says more. Both
//! are given, as the median over several repeats with the quartiles around it.

use std::hint::black_box;
use std::time::Instant;

use super::ReportError;
use crate::numerics::{median, quantile};
use crate::progress::{Cancelled, Progress, thread_cpu_seconds};

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

/// What a study measures with, and how far it may go.
pub struct Bench<'a> {
    /// How much work it may take.
    pub effort: Effort,
    /// What its random numbers begin with.
    pub seed: u64,
    progress: &'a mut (dyn Heard + 'a),
}

/// Who hears how far a study is; a [`Progress`] without its own lifetime.
trait Heard {
    fn step(&mut self, share: f64, doing: &str) -> Result<(), Cancelled>;
}

impl Heard for Progress<'_> {
    fn step(&mut self, share: f64, doing: &str) -> Result<(), Cancelled> {
        Progress::step(self, share, doing)
    }
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
            progress,
        }
    }

    /// Says how far the study is, 0…1, and what it is doing.
    ///
    /// # Errors
    /// It should stop.
    pub fn step(&mut self, share: f64, doing: &str) -> Result<(), ReportError> {
        self.progress
            .step(share, doing)
            .map_err(|_cancelled| ReportError::Cancelled)
    }

    /// Measures `work`, which does `n_units` of what is counted and is repeated until its own time
    /// can be told from the clock's.
    pub fn time<T>(&mut self, n_units: usize, work: impl FnMut() -> T) -> Timing {
        self.time_repeated(self.effort.pick(5, 15), n_units, work)
    }

    /// The same with so many repeats: for work that takes long and so varies little.
    pub fn time_repeated<T>(
        &mut self,
        n_repeats: usize,
        n_units: usize,
        mut work: impl FnMut() -> T,
    ) -> Timing {
        let least_s = self.effort.pick(0.5e-3, 2e-3);
        black_box(work());
        let n_inner = inner_repeats(least_s, &mut work);
        let n = (n_inner * n_units.max(1)) as f64;
        let mut cpu_s = Vec::with_capacity(n_repeats);
        let mut wall_s = Vec::with_capacity(n_repeats);
        for _ in 0..n_repeats {
            let (start, start_cpu_s) = (Instant::now(), thread_cpu_seconds());
            for _ in 0..n_inner {
                black_box(work());
            }
            cpu_s.push((thread_cpu_seconds() - start_cpu_s) / n);
            wall_s.push(start.elapsed().as_secs_f64() / n);
        }
        Timing {
            cpu_s: median(&mut cpu_s),
            cpu_quartiles_s: [0.25, 0.75].map(|q| quantile(&mut cpu_s, q)),
            wall_s: median(&mut wall_s),
            n_repeats,
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
    use crate::progress::CancelFlag;

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
