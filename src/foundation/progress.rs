//! Progress and cancellation of long work, and the clock that counts a thread's own CPU time.
//!
//! Long work takes a [`Progress`], says how far it is and asks whether to stop; it neither knows
//! who listens (a terminal, a window, a test) nor prints.
//!
//! # Invariants
//! - no I/O, no locks; cancelling is one atomic flag
//! - work that is cancelled returns [`Cancelled`] and leaves nothing half-done behind

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that asks long work to stop. Clones share the flag.
#[derive(Debug, Clone, Default)]
pub struct CancelFlag(Arc<AtomicBool>);

impl CancelFlag {
    /// A flag that is not raised.
    pub fn new() -> Self {
        Self::default()
    }

    /// A flag over an atomic that somebody else raises, a signal handler for one.
    pub fn shared(flag: Arc<AtomicBool>) -> Self {
        Self(flag)
    }

    /// Asks the work to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The work was asked to stop before it was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// What long work reports to and asks.
pub struct Progress<'a> {
    report: &'a mut dyn FnMut(f64, &str),
    cancel: CancelFlag,
}

impl<'a> Progress<'a> {
    /// Progress told to `report` as (share done 0…1, what is being done).
    pub fn new(report: &'a mut dyn FnMut(f64, &str), cancel: CancelFlag) -> Self {
        Self { report, cancel }
    }

    /// Says how far the work is, 0…1, and what it is doing; fails when it should stop.
    pub fn step(&mut self, share: f64, doing: &str) -> Result<(), Cancelled> {
        (self.report)(share.clamp(0.0, 1.0), doing);
        if self.cancel.is_cancelled() {
            Err(Cancelled)
        } else {
            Ok(())
        }
    }

    /// A part of the work that tells progress of its own from 0 to 1, which is told as from `from`
    /// to `to` of the whole.
    pub fn within<T>(
        &mut self,
        [from, to]: [f64; 2],
        work: impl FnOnce(&mut Progress<'_>) -> T,
    ) -> T {
        let whole = &mut *self.report;
        let mut part = |share: f64, doing: &str| whole(from + share * (to - from), doing);
        work(&mut Progress::new(&mut part, self.cancel.clone()))
    }
}

impl std::fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Progress")
            .field("cancel", &self.cancel)
            .finish_non_exhaustive()
    }
}

impl Progress<'_> {
    /// Runs `work` with progress that nobody hears and that never cancels.
    pub fn unheard<T>(work: impl FnOnce(&mut Progress<'_>) -> T) -> T {
        let mut report = |_: f64, _: &str| {};
        work(&mut Progress::new(&mut report, CancelFlag::new()))
    }
}

/// CPU time that the calling thread has used, s, from an arbitrary origin; wall time on a system
/// without a clock of that.
pub fn thread_cpu_seconds() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }
    #[cfg(not(unix))]
    {
        static ORIGIN: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
        let origin = ORIGIN.get_or_init(std::time::Instant::now);
        origin.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_raised_flag_stops_the_next_step() {
        let flag = CancelFlag::new();
        let mut heard = Vec::new();
        let mut report = |share: f64, _: &str| heard.push(share);
        let mut progress = Progress::new(&mut report, flag.clone());
        assert_eq!(progress.step(0.5, "weaving"), Ok(()));
        flag.cancel();
        assert_eq!(progress.step(2.0, "weaving"), Err(Cancelled));
        assert_eq!(heard, [0.5, 1.0]);
    }

    #[test]
    fn a_part_is_told_as_its_share_of_the_whole_and_stops_with_it() {
        let flag = CancelFlag::new();
        let mut heard = Vec::new();
        let mut report = |share: f64, _: &str| heard.push(share);
        let mut progress = Progress::new(&mut report, flag.clone());
        progress.within([0.5, 0.75], |part| {
            assert_eq!(part.step(0.0, "warping"), Ok(()));
            assert_eq!(part.step(0.5, "weaving"), Ok(()));
            flag.cancel();
            assert_eq!(part.step(1.0, "weaving"), Err(Cancelled));
        });
        assert_eq!(heard, [0.5, 0.625, 0.75]);
    }
}
