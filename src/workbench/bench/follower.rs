//! Results that follow what is asked for: one run at a time, of the newest words only; the last
//! result stays until the next is there.
//!
//! ```text
//! inputs ─▶ follow ─▶ work (a thread, which gets the last result too) ─▶ poll ─▶ found
//! ```

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;

use crate::bench::job::{Job, Polled};
use crate::bench::task::Watch;
use selvedge_foundation::progress::{Cancelled, Progress};

/// How often it is looked whether the words have changed while there is work.
const LOOK: Duration = Duration::from_millis(100);

/// A result that knows what it was asked for.
pub(crate) trait Answer: Send + Sync + Sized + 'static {
    /// What is asked for.
    type Inputs: Clone + PartialEq + Send + 'static;
    /// What the thread is called.
    const THREAD: &str;

    /// What was asked for.
    fn inputs(&self) -> &Self::Inputs;

    /// Does the work; `prior` is the result before, whose parts may serve again.
    fn work(
        inputs: Self::Inputs,
        prior: Option<&Self>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled>;

    /// What stands for work that could not be done, with the reason.
    fn broken(inputs: Self::Inputs, why: &str) -> Self;

    /// Whether work under way is worth its end although something else is asked for now.
    fn serves(under_way: &Self::Inputs, now: &Self::Inputs) -> bool;
}

/// How a result stands to what is asked for now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Standing {
    /// Nothing is asked for.
    Empty,
    /// It is of what is asked for.
    Fresh,
    /// It is being made: the share that is done, 0…1.
    Working(f32),
    /// It was stopped.
    Stopped,
}

/// Work under way.
struct Running<A: Answer> {
    inputs: A::Inputs,
    job: Job<Result<A, Cancelled>>,
    watch: Watch,
}

/// The last result and the work on the next.
pub(crate) struct Follower<A: Answer> {
    found: Option<Arc<A>>,
    running: Option<Running<A>>,
    stopped: Option<A::Inputs>,
    n_begun: u64,
}

impl<A: Answer> Default for Follower<A> {
    fn default() -> Self {
        Self {
            found: None,
            running: None,
            stopped: None,
            n_begun: 0,
        }
    }
}

impl<A: Answer> Follower<A> {
    /// The last result, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&Arc<A>> {
        self.found.as_ref()
    }

    /// Runs that were begun.
    pub(crate) fn n_begun(&self) -> u64 {
        self.n_begun
    }

    /// How the last result stands to `inputs`.
    pub(crate) fn standing(&self, inputs: &A::Inputs) -> Standing {
        let is_asked = |found: &Arc<A>| found.inputs() == inputs;
        if self.found.as_ref().is_some_and(is_asked) {
            return Standing::Fresh;
        }
        if self.stopped.as_ref() == Some(inputs) {
            return Standing::Stopped;
        }
        let running = self.running.as_ref();
        Standing::Working(running.map_or(0.0, |running| running.watch.share()))
    }

    /// Stops until something else is asked for.
    pub(crate) fn stop(&mut self) {
        if let Some(running) = &self.running {
            running.watch.stop();
            self.stopped = Some(running.inputs.clone());
        }
    }

    /// Forgets that anything was stopped.
    pub(crate) fn go_on(&mut self) {
        self.stopped = None;
    }

    /// Takes what a thread has made, if it is done.
    pub(crate) fn poll(&mut self) {
        let Some(running) = self.running.take() else {
            return;
        };
        match running.job.poll() {
            Polled::Working => self.running = Some(running),
            Polled::Done(Ok(found)) => self.found = Some(Arc::new(found)),
            Polled::Done(Err(Cancelled)) => {}
            Polled::BrokeOff => self.take_broken(running.inputs, "the work broke off"),
        }
    }

    /// Begins the work that is due; with `is_at_once` it is done here and now. `ctx` is woken as it
    /// goes on.
    pub(crate) fn follow(&mut self, ctx: &egui::Context, is_at_once: bool, inputs: A::Inputs) {
        if !matches!(self.standing(&inputs), Standing::Working(_)) {
            return;
        }
        if let Some(running) = &self.running {
            if !A::serves(&running.inputs, &inputs) {
                running.watch.stop();
            }
            ctx.request_repaint_after(LOOK);
            return;
        }
        self.n_begun += 1;
        let watch = Watch::default();
        let (own, waker) = (watch.clone(), ctx.clone());
        let (asked, prior) = (inputs.clone(), self.found.clone());
        let work = move || {
            own.over(&waker, |progress| {
                A::work(asked, prior.as_deref(), progress)
            })
        };
        if is_at_once {
            if let Ok(found) = work() {
                self.found = Some(Arc::new(found));
            }
            return;
        }
        match Job::start(A::THREAD, ctx, work) {
            Ok(job) => self.running = Some(Running { inputs, job, watch }),
            Err(error) => self.take_broken(inputs, &format!("no thread: {error}")),
        }
    }

    fn take_broken(&mut self, inputs: A::Inputs, why: &str) {
        self.found = Some(Arc::new(A::broken(inputs, why)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number and its double, or why there is none.
    #[derive(Debug)]
    struct Double(u32, Result<u32, String>);

    impl Answer for Double {
        type Inputs = u32;
        const THREAD: &str = "test";

        fn inputs(&self) -> &u32 {
            &self.0
        }

        fn work(
            inputs: u32,
            _prior: Option<&Self>,
            progress: &mut Progress<'_>,
        ) -> Result<Self, Cancelled> {
            // Odd numbers wait until they are stopped.
            if inputs % 2 == 1 {
                loop {
                    progress.step(0.5, "waiting")?;
                    std::thread::yield_now();
                }
            }
            assert!(inputs != 4, "broken by four");
            Ok(Self(inputs, Ok(2 * inputs)))
        }

        fn broken(inputs: u32, why: &str) -> Self {
            Self(inputs, Err(why.to_owned()))
        }

        fn serves(under_way: &u32, now: &u32) -> bool {
            under_way == now
        }
    }

    fn wait(follower: &mut Follower<Double>, inputs: u32) {
        let ctx = egui::Context::default();
        while matches!(follower.standing(&inputs), Standing::Working(_)) {
            follower.poll();
            follower.follow(&ctx, false, inputs);
            std::thread::yield_now();
        }
    }

    #[test]
    fn the_newest_words_win_and_the_last_result_stays_until_then() {
        let mut follower = Follower::<Double>::default();
        wait(&mut follower, 2);
        let ctx = egui::Context::default();
        follower.follow(&ctx, false, 3);
        assert!(matches!(follower.standing(&3), Standing::Working(_)));
        assert_eq!(follower.found().unwrap().1, Ok(4), "of the words before");
        wait(&mut follower, 6);
        assert_eq!(follower.found().unwrap().1, Ok(12));
        assert_eq!(follower.n_begun(), 3);
    }

    #[test]
    fn what_was_stopped_is_not_begun_again_until_it_is_asked_to_go_on() {
        let mut follower = Follower::<Double>::default();
        let ctx = egui::Context::default();
        follower.follow(&ctx, false, 5);
        follower.stop();
        assert_eq!(follower.standing(&5), Standing::Stopped);
        follower.follow(&ctx, false, 5);
        assert_eq!(follower.n_begun(), 1);
        wait(&mut follower, 8);
        follower.go_on();
        assert!(matches!(follower.standing(&5), Standing::Working(_)));
    }

    #[test]
    fn work_that_broke_off_is_a_result_that_says_so() {
        let mut follower = Follower::<Double>::default();
        wait(&mut follower, 4);
        let found = follower.found().unwrap();
        assert_eq!(found.1, Err("the work broke off".to_owned()));
        assert_eq!(follower.standing(&4), Standing::Fresh);
    }
}
