//! Work that takes longer than a frame: on a named thread, or here and now where nothing may depend
//! on a clock; it says how far it is, can be stopped, and has one result.
//!
//! Dropping a task lets its thread end by itself; nobody waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;
use std::time::Duration;

use eframe::egui;
use selvedge_foundation::numerics::to_index;

use selvedge_foundation::progress::{CancelFlag, Progress};

/// Progress is drawn this often.
const NEWS: Duration = Duration::from_millis(100);

/// Where work is done.
#[derive(Debug, Clone)]
pub(crate) enum Executor {
    /// On threads; this window is woken as the work goes on.
    Threads(egui::Context),
    /// Here and now.
    InLine,
}

impl Executor {
    /// Begins `work`, on a thread called `name` if it is to be one.
    pub(crate) fn start<T: Send + 'static>(
        &self,
        name: &str,
        work: impl FnOnce(&mut Progress<'_>) -> Result<T, String> + Send + 'static,
    ) -> Task<T> {
        let watch = Watch::default();
        let (sender, result) = sync_channel(1);
        match self {
            Self::InLine => {
                let mut unheard = |_: f64, _: &str| {};
                let outcome = work(&mut Progress::new(&mut unheard, watch.cancel.clone()));
                // There is room for one.
                drop(sender.send(outcome));
            }
            Self::Threads(ctx) => {
                let (own, waker, failed) = (watch.clone(), ctx.clone(), sender.clone());
                let job = thread::Builder::new().name(name.to_owned());
                let job = job.spawn(move || {
                    // Nobody listens any more when something else was asked for meanwhile.
                    drop(sender.send(own.over(&waker, work)));
                    drop(sender);
                    waker.request_repaint();
                });
                if let Err(error) = job {
                    drop(failed.send(Err(format!("no thread: {error}; try again"))));
                }
            }
        }
        Task { result, watch }
    }
}

/// How far work is and the flag that stops it: what the window and the thread both hold.
#[derive(Debug, Clone, Default)]
struct Watch {
    cancel: CancelFlag,
    done_permille: Arc<AtomicUsize>,
}

impl Watch {
    /// Does `work`, which says how far it is; `ctx` is woken as it goes on.
    fn over<T>(&self, ctx: &egui::Context, work: impl FnOnce(&mut Progress<'_>) -> T) -> T {
        let mut heard = |share: f64, _: &str| {
            self.done_permille
                .store(to_index(1000.0 * share), Ordering::Relaxed);
            ctx.request_repaint_after(NEWS);
        };
        work(&mut Progress::new(&mut heard, self.cancel.clone()))
    }
}

/// Work under way, with one result.
#[derive(Debug)]
pub(crate) struct Task<T> {
    result: Receiver<Result<T, String>>,
    watch: Watch,
}

impl<T> Task<T> {
    /// How far it is, 0…1.
    pub(crate) fn share(&self) -> f32 {
        let permille = self.watch.done_permille.load(Ordering::Relaxed).min(1000);
        u16::try_from(permille).map_or(1.0, |permille| f32::from(permille) / 1000.0)
    }

    /// Asks it to stop.
    pub(crate) fn stop(&self) {
        self.watch.cancel.cancel();
    }

    /// Whether it was asked to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        self.watch.cancel.is_cancelled()
    }

    /// What came of it, once it is over.
    pub(crate) fn poll(&self) -> Option<Result<T, String>> {
        match self.result.try_recv() {
            Ok(outcome) => Some(outcome),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err("the work broke off; try again".to_owned()))
            }
        }
    }
}

/// Takes what came of a task that is over; `None` while there is none or it is at work, and of one
/// without a result since it was stopped.
pub(crate) fn finished<T>(task: &mut Option<Task<T>>) -> Option<Result<T, String>> {
    let under_way = task.as_ref()?;
    let outcome = under_way.poll()?;
    let is_told = outcome.is_ok() || !under_way.is_stopped();
    *task = None;
    is_told.then_some(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn threads() -> Executor {
        Executor::Threads(egui::Context::default())
    }

    fn wait<T>(task: Task<T>) -> Result<T, String> {
        let mut task = Some(task);
        loop {
            if let Some(outcome) = finished(&mut task) {
                assert!(task.is_none(), "it gives its result once");
                return outcome;
            }
            thread::yield_now();
        }
    }

    #[test]
    fn a_task_gives_the_same_on_a_thread_and_in_line() {
        for executor in [threads(), Executor::InLine] {
            assert_eq!(wait(executor.start("test", |_| Ok(7))), Ok(7));
            let failing = executor.start("test", |_| Err::<(), _>("no; mend it".to_owned()));
            assert_eq!(wait(failing), Err("no; mend it".to_owned()));
        }
    }

    #[test]
    fn a_task_that_is_stopped_ends_at_its_next_step() {
        let task = threads().start("test", |progress| -> Result<(), String> {
            loop {
                progress
                    .step(0.5, "waiting")
                    .map_err(|_stopped| "stopped".to_owned())?;
                thread::yield_now();
            }
        });
        assert!(!task.is_stopped() && task.share() <= 0.5);
        task.stop();
        assert!(task.is_stopped());
        let mut task = Some(task);
        while task.is_some() {
            assert_eq!(finished(&mut task), None, "whoever stopped it knows");
            thread::yield_now();
        }
    }

    #[test]
    fn a_task_that_dies_says_so() {
        let task: Task<()> = threads().start("test", |_| panic!("on purpose"));
        assert!(wait(task).unwrap_err().contains("broke off"));
    }
}
