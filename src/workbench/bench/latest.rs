//! The newest of what is computed in the background: one run at a time, of the newest key only; the
//! last result stays until the next is there.
//!
//! ```text
//! key ─▶ follow ─▶ compute (an executor, which has the last result too) ─▶ poll ─▶ value
//! ```

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;

use crate::bench::background::{Executor, Task};
use selvedge_foundation::progress::{Cancelled, Progress};

/// How often it is looked whether the key has changed while there is work.
const LOOK: Duration = Duration::from_millis(100);

/// A value that is computed from a key.
pub(crate) trait Computed<Key>: Send + Sync + Sized + 'static {
    /// What the thread is called.
    const THREAD: &str;

    /// Does the work; `prior` is the key and the value before, whose parts may serve again.
    fn compute(
        key: &Key,
        prior: Option<(&Key, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled>;

    /// What stands for a value that could not be computed, with the reason.
    fn broken(key: &Key, why: &str) -> Self;

    /// Whether it is done; if not, it is shown, and the work goes on from it.
    fn is_whole(&self) -> bool {
        true
    }

    /// Whether work under way is worth its end although another key is asked for now.
    fn serves(under_way: &Key, now: &Key) -> bool;
}

/// How the last value stands to what is asked for now.
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

/// The last value with its key, and the work on the next.
#[derive(Debug)]
pub(crate) struct Latest<Key, Value> {
    found: Option<(Key, Arc<Value>)>,
    running: Option<(Key, Task<Value>)>,
    stopped: Option<Key>,
    n_begun: u64,
}

impl<Key, Value> Default for Latest<Key, Value> {
    fn default() -> Self {
        Self {
            found: None,
            running: None,
            stopped: None,
            n_begun: 0,
        }
    }
}

impl<Key: Clone + PartialEq + Send + Sync + 'static, Value: Computed<Key>> Latest<Key, Value> {
    /// The last value, whatever has changed since.
    pub(crate) fn value(&self) -> Option<&Arc<Value>> {
        self.found.as_ref().map(|(_, value)| value)
    }

    /// What the last value was computed from.
    pub(crate) fn key(&self) -> Option<&Key> {
        self.found.as_ref().map(|(key, _)| key)
    }

    /// Runs that were begun.
    pub(crate) fn n_begun(&self) -> u64 {
        self.n_begun
    }

    /// How the last value stands to `key`.
    pub(crate) fn standing(&self, key: &Key) -> Standing {
        let is_of = |(of, value): &(Key, Arc<Value>)| of == key && value.is_whole();
        if self.found.as_ref().is_some_and(is_of) {
            return Standing::Fresh;
        }
        if self.stopped.as_ref() == Some(key) {
            return Standing::Stopped;
        }
        let running = self.running.as_ref();
        Standing::Working(running.map_or(0.0, |(_, task)| task.share()))
    }

    /// Stops until something else is asked for.
    pub(crate) fn stop(&mut self) {
        if let Some((key, task)) = &self.running {
            task.stop();
            self.stopped = Some(key.clone());
        }
    }

    /// Forgets that anything was stopped.
    pub(crate) fn go_on(&mut self) {
        self.stopped = None;
    }

    /// Takes what was computed, if it is done.
    pub(crate) fn poll(&mut self) {
        let Some((key, task)) = self.running.take() else {
            return;
        };
        match task.poll() {
            None => self.running = Some((key, task)),
            Some(Ok(value)) => self.found = Some((key, Arc::new(value))),
            Some(Err(_)) if task.is_stopped() => {}
            Some(Err(why)) => {
                let broken = Value::broken(&key, &why);
                self.found = Some((key, Arc::new(broken)));
            }
        }
    }

    /// Begins the work that is due; what is done in line is there at once. `ctx` is woken to look
    /// again while other work is under way.
    pub(crate) fn follow(&mut self, ctx: &egui::Context, executor: &Executor, key: &Key) {
        if !matches!(self.standing(key), Standing::Working(_)) {
            return;
        }
        if let Some((running, task)) = &self.running {
            if !Value::serves(running, key) {
                task.stop();
            }
            ctx.request_repaint_after(LOOK);
            return;
        }
        self.n_begun += 1;
        let (asked, prior) = (key.clone(), self.found.clone());
        let task = executor.start(Value::THREAD, move |progress| {
            let prior = prior.as_ref().map(|(key, value)| (key, &**value));
            Value::compute(&asked, prior, progress).map_err(|Cancelled| "stopped".to_owned())
        });
        self.running = Some((key.clone(), task));
        if matches!(executor, Executor::InLine) {
            self.poll();
            let is_part = |(of, value): &(Key, Arc<Value>)| of == key && !value.is_whole();
            if self.found.as_ref().is_some_and(is_part) {
                self.follow(ctx, executor, key);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The double of a number, or why there is none.
    #[derive(Debug)]
    struct Double(Result<u32, String>);

    impl Computed<u32> for Double {
        const THREAD: &str = "test";

        fn compute(
            key: &u32,
            _prior: Option<(&u32, &Self)>,
            progress: &mut Progress<'_>,
        ) -> Result<Self, Cancelled> {
            // Odd numbers wait until they are stopped.
            if key % 2 == 1 {
                loop {
                    progress.step(0.5, "waiting")?;
                    std::thread::yield_now();
                }
            }
            assert!(*key != 4, "broken by four");
            Ok(Self(Ok(2 * key)))
        }

        fn broken(_: &u32, why: &str) -> Self {
            Self(Err(why.to_owned()))
        }

        fn serves(under_way: &u32, now: &u32) -> bool {
            under_way == now
        }
    }

    type Doubles = Latest<u32, Double>;

    fn threads() -> (egui::Context, Executor) {
        let ctx = egui::Context::default();
        (ctx.clone(), Executor::Threads(ctx))
    }

    fn wait(latest: &mut Doubles, key: u32) {
        let (ctx, executor) = threads();
        while matches!(latest.standing(&key), Standing::Working(_)) {
            latest.poll();
            latest.follow(&ctx, &executor, &key);
            std::thread::yield_now();
        }
    }

    #[test]
    fn the_newest_key_wins_and_the_last_value_stays_until_then() {
        let mut latest = Doubles::default();
        wait(&mut latest, 2);
        let (ctx, executor) = threads();
        latest.follow(&ctx, &executor, &3);
        assert!(matches!(latest.standing(&3), Standing::Working(_)));
        assert_eq!(latest.value().unwrap().0, Ok(4), "of the key before");
        wait(&mut latest, 6);
        assert_eq!(latest.value().unwrap().0, Ok(12));
        assert_eq!(latest.n_begun(), 3);
    }

    #[test]
    fn in_line_it_is_there_at_once() {
        let mut latest = Doubles::default();
        latest.follow(&egui::Context::default(), &Executor::InLine, &8);
        assert_eq!(latest.standing(&8), Standing::Fresh);
        assert_eq!(latest.value().unwrap().0, Ok(16));
    }

    #[test]
    fn what_was_stopped_is_not_begun_again_until_it_is_asked_to_go_on() {
        let mut latest = Doubles::default();
        let (ctx, executor) = threads();
        latest.follow(&ctx, &executor, &5);
        latest.stop();
        assert_eq!(latest.standing(&5), Standing::Stopped);
        latest.follow(&ctx, &executor, &5);
        assert_eq!(latest.n_begun(), 1);
        wait(&mut latest, 8);
        latest.go_on();
        assert!(matches!(latest.standing(&5), Standing::Working(_)));
    }

    #[test]
    fn work_that_broke_off_is_a_value_that_says_so() {
        let mut latest = Doubles::default();
        wait(&mut latest, 4);
        assert!(
            latest
                .value()
                .unwrap()
                .0
                .as_ref()
                .unwrap_err()
                .contains("broke off")
        );
        assert_eq!(latest.standing(&4), Standing::Fresh);
    }
}
