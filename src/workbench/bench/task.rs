//! Work on a thread of its own that shows how far it is and can be stopped.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use eframe::egui;

use crate::bench::job::{Job, Polled};
use selvedge_foundation::progress::{CancelFlag, Progress};

/// Progress is drawn this often.
const NEWS: Duration = Duration::from_millis(100);

/// How far work is and the flag that stops it: what the window and the thread both hold.
#[derive(Debug, Clone, Default)]
pub(crate) struct Watch {
    cancel: CancelFlag,
    done_permille: Arc<AtomicU32>,
}

impl Watch {
    /// Does `work`, which says how far it is; `ctx` is woken as it goes on.
    pub(crate) fn over<T>(
        &self,
        ctx: &egui::Context,
        work: impl FnOnce(&mut Progress<'_>) -> T,
    ) -> T {
        let mut heard = |share: f64, _: &str| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a share of 1000"
            )]
            self.done_permille
                .store((1000.0 * share) as u32, Ordering::Relaxed);
            ctx.request_repaint_after(NEWS);
        };
        work(&mut Progress::new(&mut heard, self.cancel.clone()))
    }

    /// How far it is, 0…1.
    pub(crate) fn share(&self) -> f32 {
        let permille = self.done_permille.load(Ordering::Relaxed).min(1000);
        u16::try_from(permille).map_or(1.0, |permille| f32::from(permille) / 1000.0)
    }

    /// Asks it to stop.
    pub(crate) fn stop(&self) {
        self.cancel.cancel();
    }

    /// Whether it was asked to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        self.cancel.is_cancelled()
    }
}

/// Work under way.
#[derive(Debug)]
pub(crate) struct Task<T> {
    at: At<T>,
    watch: Watch,
}

#[derive(Debug)]
enum At<T> {
    /// On a thread.
    Thread(Job<Result<T, String>>),
    /// It was done here and now, or could not begin.
    Here(Option<Result<T, String>>),
}

impl<T: Send + 'static> Task<T> {
    /// Begins `work` on a thread called `name`; with `is_at_once` it is done here and now. `ctx` is
    /// woken as it goes on.
    pub(crate) fn start(
        (name, ctx): (&str, &egui::Context),
        is_at_once: bool,
        work: impl FnOnce(&mut Progress<'_>) -> Result<T, String> + Send + 'static,
    ) -> Self {
        let watch = Watch::default();
        let (own, waker) = (watch.clone(), ctx.clone());
        let work = move || own.over(&waker, work);
        let at = if is_at_once {
            At::Here(Some(work()))
        } else {
            match Job::start(name, ctx, work) {
                Ok(job) => At::Thread(job),
                Err(error) => At::Here(Some(Err(format!("no thread: {error}; try again")))),
            }
        };
        Self { at, watch }
    }

    /// How far it is, 0…1.
    pub(crate) fn share(&self) -> f32 {
        self.watch.share()
    }

    /// Asks it to stop.
    pub(crate) fn stop(&self) {
        self.watch.stop();
    }

    /// Whether it was asked to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        self.watch.is_stopped()
    }

    /// What came of it, once, when it is over.
    fn outcome(&mut self) -> Option<Result<T, String>> {
        match &mut self.at {
            At::Here(outcome) => outcome.take(),
            At::Thread(job) => match job.poll() {
                Polled::Working => None,
                Polled::Done(outcome) => Some(outcome),
                Polled::BrokeOff => Some(Err("the work broke off; try again".to_owned())),
            },
        }
    }
}

/// Takes what came of a task that is over; `None` while there is none or it is at work.
pub(crate) fn taken<T: Send + 'static>(
    task: &mut Option<Task<T>>,
) -> Option<(Result<T, String>, bool)> {
    let under_way = task.as_mut()?;
    let outcome = under_way.outcome()?;
    let was_stopped = under_way.is_stopped();
    *task = None;
    Some((outcome, was_stopped))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait<T: Send + 'static>(task: &mut Option<Task<T>>) -> (Result<T, String>, bool) {
        loop {
            if let Some(end) = taken(task) {
                return end;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_task_that_is_stopped_ends_at_its_next_step_and_says_so() {
        let ctx = egui::Context::default();
        let (go, begin) = std::sync::mpsc::sync_channel::<()>(1);
        let mut task = Some(Task::start(("test", &ctx), false, move |progress| {
            begin.recv().map_err(|error| error.to_string())?;
            progress
                .step(0.5, "half")
                .map_err(|stop| stop.to_string())?;
            Ok(7)
        }));
        assert!(taken(&mut task).is_none(), "it waits");
        task.as_ref().unwrap().stop();
        go.send(()).unwrap();
        assert_eq!(wait(&mut task), (Err("cancelled".to_owned()), true));
        assert!(task.is_none());
    }

    #[test]
    fn a_task_gives_its_result_once_on_a_thread_or_here() {
        let ctx = egui::Context::default();
        for is_at_once in [true, false] {
            let mut task = Some(Task::start(("test", &ctx), is_at_once, |_| Ok(7)));
            assert_eq!(wait(&mut task), (Ok(7), false));
            assert!(taken(&mut task).is_none());
        }
    }
}
