//! Work that takes longer than a frame: on a named thread, with one result that is polled for.
//!
//! Dropping a job lets its thread end by itself; nobody waits for it.

use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;

use eframe::egui;

/// A thread at work on a `T`.
#[derive(Debug)]
pub(crate) struct Job<T> {
    result: Receiver<T>,
}

/// How far a job is.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Polled<T> {
    /// Still at work.
    Working,
    /// It is done; there is nothing more to come.
    Done(T),
    /// Its thread ended without a result.
    BrokeOff,
}

impl<T: Send + 'static> Job<T> {
    /// Begins `work` on a thread called `name`; `ctx` is woken when it is done.
    ///
    /// # Errors
    /// The system gives no thread.
    pub(crate) fn start(
        name: &str,
        ctx: &egui::Context,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> std::io::Result<Self> {
        let (sender, result) = sync_channel(1);
        let ctx = ctx.clone();
        thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                // Nobody listens any more when something else was asked for meanwhile.
                drop(sender.send(work()));
                drop(sender);
                ctx.request_repaint();
            })?;
        Ok(Self { result })
    }

    /// The result, once it is there.
    pub(crate) fn poll(&self) -> Polled<T> {
        match self.result.try_recv() {
            Ok(result) => Polled::Done(result),
            Err(TryRecvError::Empty) => Polled::Working,
            Err(TryRecvError::Disconnected) => Polled::BrokeOff,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait<T: Send + 'static>(job: &Job<T>) -> Polled<T> {
        loop {
            match job.poll() {
                Polled::Working => thread::yield_now(),
                end => return end,
            }
        }
    }

    #[test]
    fn a_job_gives_its_result_once() {
        let ctx = egui::Context::default();
        let job = Job::start("test", &ctx, || 7).unwrap();
        assert_eq!(wait(&job), Polled::Done(7));
        assert_eq!(
            wait(&job),
            Polled::BrokeOff,
            "there is nothing more to come"
        );
    }

    #[test]
    fn a_job_that_dies_says_so() {
        let ctx = egui::Context::default();
        let job: Job<()> = Job::start("test", &ctx, || panic!("on purpose")).unwrap();
        assert_eq!(wait(&job), Polled::BrokeOff);
    }
}
