//! Measuring honestly: warm-up, repeats, medians with their spread, CPU time beside wall time.
//!
//! Wall time on a shared machine says little; the time that the thread itself used says more. Both
//! are given. How far a time can be trusted no single process knows, since where its memory lies
//! and who shares the machine stay with it: [`rounds`](super::rounds) measures in several.

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
    /// What it is called.
    pub(crate) fn word(self) -> &'static str {
        self.pick("quick", "full")
    }

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
    /// Median CPU time of the thread: of the processes' medians.
    pub cpu_s: f64,
    /// What holds it: the smallest and the largest of the processes' medians; of one process the
    /// quartiles of its repeats, which say less.
    pub cpu_interval_s: [f64; 2],
    /// Median wall time.
    pub wall_s: f64,
    /// Repeats that were measured, in all processes.
    pub n_repeats: usize,
    /// The median of each process.
    rounds: Rounds,
}

/// What each of a few processes measured, in their order.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rounds {
    cpu_s: [f64; Self::MOST],
    n: usize,
}

impl Rounds {
    const MOST: usize = 8;

    fn of(all: impl IntoIterator<Item = f64>) -> Self {
        let mut rounds = Self {
            cpu_s: [0.0; Self::MOST],
            n: 0,
        };
        for (place, cpu_s) in rounds.cpu_s.iter_mut().zip(all) {
            *place = cpu_s;
            rounds.n += 1;
        }
        rounds
    }

    fn all(&self) -> &[f64] {
        &self.cpu_s[..self.n]
    }
}

impl Timing {
    /// What was measured of CPU and wall time in one process, repeat by repeat.
    pub(crate) fn of(cpu_s: &mut [f64], wall_s: &mut [f64]) -> Self {
        let middle_s = median(cpu_s);
        Self {
            cpu_s: middle_s,
            cpu_interval_s: [0.25, 0.75].map(|q| quantile(cpu_s, q)),
            wall_s: median(wall_s),
            n_repeats: cpu_s.len(),
            rounds: Rounds::of([middle_s]),
        }
    }

    /// With what further processes measured of the same: CPU and wall time, and repeats.
    pub(crate) fn and(self, others: &[(f64, f64, usize)]) -> Self {
        let rounds = Rounds::of(
            (self.rounds.all().iter().copied()).chain(others.iter().map(|other| other.0)),
        );
        let mut cpu_s = rounds.all().to_vec();
        let mut wall_s: Vec<f64> = others.iter().map(|other| other.1).collect();
        wall_s.push(self.wall_s);
        let of_others: usize = others.iter().map(|other| other.2).sum();
        Self {
            cpu_s: median(&mut cpu_s),
            cpu_interval_s: if others.is_empty() {
                self.cpu_interval_s
            } else {
                [0.0, 1.0].map(|q| quantile(&mut cpu_s, q))
            },
            wall_s: median(&mut wall_s),
            n_repeats: self.n_repeats + of_others,
            rounds,
        }
    }

    /// Processes that measured it.
    pub fn n_processes(&self) -> usize {
        self.rounds.n
    }

    /// The median CPU time of each process, s.
    pub(crate) fn of_processes(&self) -> &[f64] {
        self.rounds.all()
    }

    /// Whether it is cheaper than another one: in every process that measured both one after the
    /// other, so that the machine's own pace of that minute cancels; `None` where they do not
    /// agree. Of single processes their intervals decide.
    pub(crate) fn is_cheaper_than(&self, other: &Self) -> Option<bool> {
        let pairs = || self.rounds.all().iter().zip(other.rounds.all());
        let is_shared = self.rounds.n > 1 && self.rounds.n == other.rounds.n;
        let ([own_low, own_high], [low, high]) = (self.cpu_interval_s, other.cpu_interval_s);
        let (is_cheaper, is_dearer) = if is_shared {
            (
                pairs().all(|(own, other)| own < other),
                pairs().all(|(own, other)| own > other),
            )
        } else {
            (own_high < low, own_low > high)
        };
        (is_cheaper || is_dearer).then_some(is_cheaper)
    }

    /// It over another one, process by process where as many measured both; else by the medians.
    pub(crate) fn over(&self, other: &Self) -> Ratio {
        let mut all: Vec<f64> = if self.rounds.n == other.rounds.n {
            let pairs = self.rounds.all().iter().zip(other.rounds.all());
            pairs.map(|(own, other)| own / other).collect()
        } else {
            vec![self.cpu_s / other.cpu_s]
        };
        Ratio {
            middle: median(&mut all),
            smallest: all.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }

    /// That of so many times the work, or of a part of it.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            cpu_s: factor * self.cpu_s,
            cpu_interval_s: self.cpu_interval_s.map(|s| factor * s),
            wall_s: factor * self.wall_s,
            rounds: Rounds::of(self.rounds.all().iter().map(|s| factor * s)),
            ..self
        }
    }
}

/// A time over another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ratio {
    /// The median over the processes.
    pub(crate) middle: f64,
    /// What no process is below.
    pub(crate) smallest: f64,
}

/// Hears how far a study is.
type Step<'a> = dyn FnMut(f64, &str) -> Result<(), Cancelled> + 'a;

/// What a study measures with, and how far it may go.
pub struct Bench<'a> {
    /// How much work it may take.
    pub effort: Effort,
    /// What its random numbers begin with.
    pub seed: u64,
    /// Whether times alone are asked for, once more: what is found else is known.
    is_again: bool,
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
            is_again: false,
            step: Box::new(|share, doing| progress.step(share, doing)),
        }
    }

    /// The same where times alone are asked for, once more.
    pub(crate) fn again(self) -> Self {
        Self {
            is_again: true,
            ..self
        }
    }

    /// Whether errors are asked for: where they are long work, a study leaves it out if they are
    /// not, and its rows come without them.
    pub(crate) fn wants_errors(&self) -> bool {
        !self.is_again
    }

    /// Repeats of a measurement: fewer in each of several processes.
    fn n_repeats(&self) -> usize {
        if self.is_again {
            self.effort.pick(2, 5)
        } else {
            self.effort.pick(5, 15)
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
        self.time_repeated(self.n_repeats(), n_units, work)
    }

    /// The same with so many repeats: for work that takes long and so varies little.
    pub(crate) fn time_repeated<T>(
        &self,
        n_repeats: usize,
        n_units: usize,
        work: impl FnMut() -> T,
    ) -> Timing {
        let mut runs = Runs::new(self.least_s(), n_units, work);
        for _ in 0..n_repeats.min(self.n_repeats()) {
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
        for _ in 0..self.n_repeats() {
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

    /// Measures what `whole` takes beyond `part` of it: both in turn, and the difference of each
    /// pair, so that what slows the machine for a while slows both.
    pub(crate) fn time_beyond<T, U>(
        &self,
        n_units: usize,
        whole: impl FnMut() -> T,
        part: impl FnMut() -> U,
    ) -> Timing {
        let mut whole = Runs::new(self.least_s(), n_units, whole);
        let mut part = Runs::new(self.least_s(), n_units, part);
        for _ in 0..self.n_repeats() {
            whole.run();
            part.run();
        }
        let beyond = |whole: &[f64], part: &[f64]| -> Vec<f64> {
            whole.iter().zip(part).map(|(all, own)| all - own).collect()
        };
        Timing::of(
            &mut beyond(&whole.cpu_s, &part.cpu_s),
            &mut beyond(&whole.wall_s, &part.wall_s),
        )
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
        Timing::of(&mut self.cpu_s, &mut self.wall_s)
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
        let [low, high] = timing.cpu_interval_s;
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
    fn what_processes_do_not_agree_on_is_open() {
        let of = |cpu_s: f64| Timing::of(&mut [cpu_s, 1.1 * cpu_s], &mut [cpu_s]);
        let with = |first: f64, others: &[f64]| {
            let others: Vec<_> = others.iter().map(|s| (*s, *s, 2)).collect();
            of(first).and(&others)
        };
        let slow_then_fast = with(2.0, &[1.0, 1.1]);
        let half_of_it = with(1.0, &[0.5, 0.6]);
        let neither = with(1.5, &[1.2, 0.9]);
        // Their intervals overlap, and yet one is the cheaper in every process.
        assert_eq!(half_of_it.is_cheaper_than(&slow_then_fast), Some(true));
        assert_eq!(slow_then_fast.is_cheaper_than(&half_of_it), Some(false));
        assert_eq!(neither.is_cheaper_than(&slow_then_fast), None);
        assert_eq!((neither.n_processes(), neither.n_repeats), (3, 6));
        let [low, high] = slow_then_fast.cpu_interval_s;
        assert!(low == 1.0 && high > 2.0 && slow_then_fast.cpu_s == 1.1);
        assert_eq!(of(1.0).is_cheaper_than(&of(2.0)), Some(true));
        assert_eq!(of(1.0).is_cheaper_than(&of(1.02)), None);
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
