//! Levels of every textile of the library at a chosen speed: on a thread, one after the other, each
//! shown as soon as it is there.
//!
//! What was measured is kept by speed and filters. Surfaces stay in memory only while the pane is
//! in sight, up to a bound.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use eframe::egui;

use crate::bench::background::{Executor, Task};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_textile::Library;
use selvedge_textile::surface::{Direction, Surface};
use selvedge_textile::tactile::{Filters, LEVEL_SPEED_MM_PER_S, Levels};

/// Speeds and filters whose measurements are kept.
const MOST_KEPT: usize = 64;
/// Surfaces are kept up to about this many bytes together.
const MOST_BYTES: usize = 256 << 20;

/// What is asked of every textile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Asked {
    /// The speed along one axis, mm/s.
    pub speed_mm_per_s: f64,
    /// The filters.
    pub filters: Filters,
}

/// What was found of a textile, without any gain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figures {
    /// Its levels at the speed that was asked for.
    pub levels: Levels,
    /// Its level at 100 mm/s, by which compression goes, dB re 1 µm; `None` for silence.
    pub level_db: Option<f64>,
    /// Mean absolute deviation of its heights, µm.
    pub smd_um: f64,
}

/// What was found of textiles by their ids; `None` of one that cannot be read.
type Found = BTreeMap<String, Option<Figures>>;

/// What was measured so far.
#[derive(Debug, Default)]
pub(crate) struct Measurements {
    /// The newest last.
    found: Vec<(Asked, Found)>,
    surfaces: BTreeMap<String, Arc<Surface>>,
    n_bytes: usize,
    work: Option<Work>,
    halted: Option<Asked>,
    /// Textiles measured so far: it stands still while nothing changes or nobody looks.
    pub(crate) n_measured: u64,
    /// What could not be read, in words, and which of it was told.
    flaws: Vec<String>,
    flawed: BTreeSet<String>,
}

/// A thread at work.
#[derive(Debug)]
struct Work {
    asked: Asked,
    task: Task<()>,
    news: Receiver<News>,
}

/// What it has to say of one textile.
type News = (String, Result<(Figures, Arc<Surface>), String>);

impl Drop for Work {
    fn drop(&mut self) {
        self.task.stop();
    }
}

impl Figures {
    /// Of a surface.
    pub(crate) fn of(surface: &Surface, asked: &Asked) -> Self {
        let Asked {
            speed_mm_per_s,
            filters,
        } = asked;
        let levels = Levels::at(*speed_mm_per_s, surface, filters);
        let is_level = speed_mm_per_s.to_bits() == LEVEL_SPEED_MM_PER_S.to_bits();
        let for_level = if is_level {
            levels
        } else {
            Levels::of(surface, filters)
        };
        Self {
            levels,
            level_db: for_level.level_db(),
            smd_um: surface.smd_um(),
        }
    }
}

impl Measurements {
    /// Has what is asked of these textiles, as soon as a thread has measured it. To be called while
    /// it is drawn.
    pub(crate) fn catch_up(
        &mut self,
        ctx: &egui::Context,
        library: &Arc<Library>,
        asked: Asked,
        ids: impl Iterator<Item = String>,
    ) {
        self.take();
        if self.work.as_ref().is_some_and(|work| work.asked != asked) {
            self.work = None;
        }
        if self.halted.is_some_and(|halted| halted != asked) {
            self.halted = None;
        }
        if self.work.is_some() || self.halted.is_some() {
            return;
        }
        let known = self.of(&asked);
        let missing = ids.filter(|id| !known.is_some_and(|known| known.contains_key(id)));
        let wanted: Vec<(String, Option<Arc<Surface>>)> = missing
            .map(|id| {
                let surface = self.surfaces.get(&id).map(Arc::clone);
                (id, surface)
            })
            .collect();
        if !wanted.is_empty() {
            self.work = Some(Work::start(ctx, Arc::clone(library), asked, wanted));
        }
    }

    /// What could not be read since this was asked last, each textile once, in words.
    pub(crate) fn take_flaws(&mut self) -> Vec<String> {
        std::mem::take(&mut self.flaws)
    }

    /// Ends what is at work and lets surfaces go: nobody looks.
    pub(crate) fn rest(&mut self) {
        self.take();
        self.work = None;
        self.surfaces.clear();
        self.n_bytes = 0;
    }

    /// Stops until something else is asked for, or until it is told to go on.
    pub(crate) fn halt(&mut self) {
        self.take();
        self.halted = self.work.take().map(|work| work.asked);
    }

    /// Goes on after it was stopped.
    pub(crate) fn go_on(&mut self) {
        self.halted = None;
    }

    /// Whether it was stopped.
    pub(crate) fn is_halted(&self, asked: &Asked) -> bool {
        self.halted.as_ref() == Some(asked)
    }

    /// How many textiles are measured, while it is at work on this.
    pub(crate) fn progress(&self, asked: &Asked) -> Option<usize> {
        let work = self.work.as_ref().filter(|work| work.asked == *asked)?;
        Some(self.of(&work.asked).map_or(0, BTreeMap::len))
    }

    /// What was found of a textile.
    pub(crate) fn figures(&self, asked: &Asked, id: &str) -> Option<&Figures> {
        self.of(asked)?.get(id)?.as_ref()
    }

    fn of(&self, asked: &Asked) -> Option<&Found> {
        let of = self.found.iter().find(|(other, _)| other == asked);
        of.map(|(_, found)| found)
    }

    /// Takes what a thread has measured.
    fn take(&mut self) {
        let Some(work) = &self.work else {
            return;
        };
        // Its end is asked for first: nothing is said after it.
        let is_over = work.task.poll().is_some();
        let (asked, news): (Asked, Vec<News>) = (work.asked, work.news.try_iter().collect());
        if is_over {
            self.work = None;
        }
        for (id, outcome) in news {
            self.n_measured += 1;
            let figures = match outcome {
                Ok((figures, surface)) => {
                    self.keep(&id, surface);
                    Some(figures)
                }
                Err(flaw) => {
                    if self.flawed.insert(id.clone()) {
                        self.flaws.push(flaw);
                    }
                    None
                }
            };
            self.place(asked).insert(id, figures);
        }
    }

    fn keep(&mut self, id: &str, surface: Arc<Surface>) {
        let n_bytes = bytes_of(&surface);
        if self.n_bytes + n_bytes <= MOST_BYTES && !self.surfaces.contains_key(id) {
            self.n_bytes += n_bytes;
            self.surfaces.insert(id.to_owned(), surface);
        }
    }

    fn place(&mut self, asked: Asked) -> &mut Found {
        let known = self.found.iter().position(|(other, _)| *other == asked);
        let newest = known.map_or_else(|| (asked, Found::new()), |at| self.found.remove(at));
        if self.found.len() >= MOST_KEPT {
            self.found.remove(0);
        }
        self.found.push(newest);
        let last = self.found.len() - 1;
        &mut self.found[last].1
    }
}

impl Work {
    /// Begins; on a thread in every window, since what is there is shown while the rest is
    /// measured.
    fn start(
        ctx: &egui::Context,
        library: Arc<Library>,
        asked: Asked,
        wanted: Vec<(String, Option<Arc<Surface>>)>,
    ) -> Self {
        let (sender, news) = sync_channel(wanted.len().max(1));
        let executor = Executor::Threads(ctx.clone());
        let task = executor.start("selvedge-collection", move |progress| {
            let measured = measure(&library, &asked, wanted, &sender, progress);
            measured.map_err(|stop| stop.to_string())
        });
        Self { asked, task, news }
    }
}

fn measure(
    library: &Library,
    asked: &Asked,
    wanted: Vec<(String, Option<Arc<Surface>>)>,
    news: &SyncSender<News>,
    progress: &mut Progress<'_>,
) -> Result<(), Cancelled> {
    let n = wanted.len().max(1) as f64;
    for (done, (id, surface)) in wanted.into_iter().enumerate() {
        progress.step(done as f64 / n, &id)?;
        let loaded = surface.map_or_else(
            || {
                library
                    .load(&id)
                    .map(|textile| Arc::clone(textile.surface()))
            },
            Ok,
        );
        let outcome = loaded
            .map(|surface| (Figures::of(&surface, asked), surface))
            .map_err(|error| error.to_string());
        // The bounded queue holds one word of every textile: it is never full.
        if news.send((id, outcome)).is_err() {
            return Err(Cancelled);
        }
    }
    Ok(())
}

/// What the spectra of a surface take, about.
fn bytes_of(surface: &Surface) -> usize {
    let spectra = Direction::ALL.map(|direction| surface.spectra(direction).n_points());
    let n_bytes = selvedge_textile::surface::N_BINS * size_of::<f64>();
    spectra.into_iter().sum::<usize>() * n_bytes
}
