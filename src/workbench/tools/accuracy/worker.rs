//! The thread that checks ticks: a bounded queue in, the latest errors out.
//!
//! Whoever samples never waits: a sample that finds the queue full is dropped, and the sampler
//! counts it. Dropping this ends the thread.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread;

use eframe::egui;
use triple_buffer::{Input, Output};

use crate::bench::FRAME;
use crate::tools::accuracy::checker::{Checker, ErrorView, TickSample};

/// Samples that may wait: the ticks of 0.4 s.
const MOST_WAITING: usize = 16;

/// Checks ticks, on a thread of its own or at once.
pub(crate) enum Checking {
    /// On a thread.
    Thread {
        /// Samples on their way to it.
        samples: SyncSender<TickSample>,
        /// What it found last.
        found: Output<ErrorView>,
    },
    /// On this thread, so that a picture is the same every time.
    AtOnce(Box<Checker>),
}

impl Checking {
    /// A thread that waits for samples; `ctx` is woken when one was checked.
    ///
    /// # Errors
    /// The system gives no thread.
    pub(crate) fn start(ctx: &egui::Context) -> std::io::Result<Self> {
        let (samples, waiting) = sync_channel(MOST_WAITING);
        let (publish, found) = triple_buffer::triple_buffer(&ErrorView::default());
        let ctx = ctx.clone();
        thread::Builder::new()
            .name("selvedge-accuracy".to_owned())
            .spawn(move || check(&waiting, publish, &ctx))?;
        Ok(Self::Thread { samples, found })
    }

    /// Checks a tick, or hands it to the thread. Says whether there was room for it.
    pub(crate) fn take(&mut self, sample: TickSample) -> bool {
        match self {
            Self::Thread { samples, .. } => !matches!(
                samples.try_send(sample),
                Err(TrySendError::Full(_) | TrySendError::Disconnected(_))
            ),
            Self::AtOnce(checker) => {
                checker.take(&sample);
                true
            }
        }
    }

    /// What was found last.
    pub(crate) fn found(&mut self) -> ErrorView {
        match self {
            Self::Thread { found, .. } => found.read().clone(),
            Self::AtOnce(checker) => checker.view(),
        }
    }
}

fn check(waiting: &Receiver<TickSample>, mut publish: Input<ErrorView>, ctx: &egui::Context) {
    let mut checker = Checker::default();
    while let Ok(sample) = waiting.recv() {
        checker.take(&sample);
        // Something is shown even if more samples come than can be checked.
        for sample in waiting.try_iter().take(MOST_WAITING) {
            checker.take(&sample);
        }
        publish.write(checker.view());
        ctx.request_repaint_after(FRAME);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::tools::accuracy::checker::Setting;
    use selvedge_render::RenderScene;

    fn sample(run: u64) -> TickSample {
        let scene = RenderScene::default();
        TickSample {
            run,
            setting: Arc::new(Setting { scene, n_edits: 0 }),
            poses: Vec::new(),
            is_felt: Vec::new(),
            displays_um: Vec::new(),
        }
    }

    #[test]
    fn a_full_queue_drops_samples_and_blocks_nobody() {
        let (samples, waiting) = sync_channel(2);
        let (_, found) = triple_buffer::triple_buffer(&ErrorView::default());
        let mut checking = Checking::Thread { samples, found };
        let taken: Vec<bool> = (0..4).map(|_| checking.take(sample(0))).collect();
        assert_eq!(taken, [true, true, false, false]);
        drop(waiting);
        assert!(!checking.take(sample(0)), "nobody is there any more");
    }

    #[test]
    fn a_thread_checks_what_it_is_given_and_says_so() {
        let mut checking = Checking::start(&egui::Context::default()).unwrap();
        assert!(checking.take(sample(7)), "there is room");
        let found = loop {
            let found = checking.found();
            if found.n_ticks > 0 {
                break found;
            }
            thread::yield_now();
        };
        assert_eq!((found.run, found.n_ticks), (7, 1));
    }
}
