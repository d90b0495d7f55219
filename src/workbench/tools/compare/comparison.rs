//! What is compared: what is asked for, how far it is, and what came of it.
//!
//! Both are replayed side by side on a thread of its own by what renders files and reports; here is
//! only what is asked for, when, and how far it is. Nothing is rendered while the pane is hidden.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use crate::bench::Bench;
use crate::bench::background::{Executor, Task};
use crate::bench::error::AppError;
use crate::bench::recording::Recording;
use crate::tools::compare::choice::{Choice, Inputs, Route, Side, What};
use selvedge_chart::Chart;
use selvedge_foundation::progress::Progress;
use selvedge_render::scene::{LoadedScene, Scene};
use selvedge_render::{DifferenceMeter, LevelDifference, RenderScene, replay_pair};

/// A path of at most so many ticks (ten minutes) is compared as soon as something has changed; a
/// longer one when it is asked for.
const MOST_AT_ONCE: u64 = 24_000;
/// Ticks between two looks at whether to stop.
const N_TICKS_A_STEP: u64 = 256;
/// How often progress is shown.
const PROGRESS: Duration = Duration::from_millis(100);

/// What a thread brings back; `None` when it was cancelled.
type Brought = Option<LevelDifference>;

/// A comparison under way.
struct Running {
    inputs: Inputs,
    task: Task<Brought>,
}

/// How a comparison ended.
enum End {
    Found(LevelDifference),
    Failed(String),
    Cancelled,
}

/// What is compared, and what came of it.
#[derive(Default)]
pub(crate) struct Compare {
    /// What the user chose.
    pub choice: Choice,
    /// Two recordings that are set against each other.
    pub(super) recorded: Option<Arc<[Recording; 2]>>,
    ended: Option<(Inputs, End)>,
    running: Option<Running>,
    chart: Option<Chart>,
    n_begun: u64,
}

/// How the newest comparison stands to what is chosen now.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Standing {
    /// It is of what is chosen.
    Fresh,
    /// It is of something that has changed since.
    Stale,
    /// There is none yet.
    None,
    /// Another one is under way: the share that is done, 0…1.
    Running(f32),
    /// It was stopped.
    Cancelled,
    /// It cannot be made: why, and what to do.
    Impossible(String),
}

impl Compare {
    /// Comparisons that were begun.
    pub(crate) fn n_begun(&self) -> u64 {
        self.n_begun
    }

    /// What was found last, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&LevelDifference> {
        match &self.ended {
            Some((_, End::Found(found))) => Some(found),
            _ => None,
        }
    }

    /// A and B of what was found last.
    pub(crate) fn sides(&self) -> Option<&[Side; 2]> {
        self.ended.as_ref().map(|(inputs, _)| &inputs.sides)
    }

    /// The path of what was found last.
    pub(crate) fn route(&self) -> Option<&Route> {
        self.ended.as_ref().map(|(inputs, _)| &inputs.route)
    }

    /// What was found last, and the chart of it over time, made once.
    pub(crate) fn found_over_time(
        &mut self,
        chart: impl Fn(&LevelDifference) -> Chart,
    ) -> Option<(&LevelDifference, &Chart)> {
        let Some((_, End::Found(found))) = &self.ended else {
            return None;
        };
        let chart = self.chart.get_or_insert_with(|| chart(found));
        Some((found, chart))
    }

    /// How it stands to what is asked for now.
    pub(crate) fn standing(&self, asked: &Result<Inputs, &'static str>) -> Standing {
        let inputs = match asked {
            Ok(inputs) => inputs,
            Err(words) => return Standing::Impossible((*words).to_owned()),
        };
        if let Some(running) = &self.running {
            return Standing::Running(running.task.share());
        }
        match &self.ended {
            Some((of, End::Cancelled)) if of == inputs => Standing::Cancelled,
            Some((of, End::Failed(words))) if of == inputs => Standing::Impossible(words.clone()),
            Some((of, End::Found(_))) if of == inputs => Standing::Fresh,
            Some((_, End::Found(_))) => Standing::Stale,
            Some(_) | None => Standing::None,
        }
    }

    /// Begins to compare.
    fn begin(&mut self, inputs: Inputs, loaded: &LoadedScene, executor: &Executor) {
        self.cancel();
        self.n_begun += 1;
        let (loaded, asked) = (loaded.clone(), inputs.clone());
        let task = executor.start("selvedge-compare", move |progress| {
            compare(&asked, &loaded, progress).map_err(|error| error.to_string())
        });
        self.running = Some(Running { inputs, task });
        self.poll();
    }

    /// Forgets what was chosen and found in another scene.
    pub(crate) fn forget(&mut self) {
        self.cancel();
        *self = Self {
            n_begun: self.n_begun,
            ..Self::default()
        };
    }

    /// Asks the comparison under way to stop.
    pub(crate) fn cancel(&self) {
        if let Some(running) = &self.running {
            running.task.stop();
        }
    }

    /// Takes what a thread has found, if it is done.
    pub(crate) fn poll(&mut self) {
        let Some(running) = self.running.take() else {
            return;
        };
        match running.task.poll() {
            None => self.running = Some(running),
            Some(brought) => self.take(running.inputs, brought),
        }
    }

    fn take(&mut self, inputs: Inputs, brought: Result<Brought, String>) {
        self.chart = None;
        let end = match brought {
            Ok(Some(found)) => End::Found(found),
            Ok(None) => End::Cancelled,
            Err(words) => End::Failed(words),
        };
        self.ended = Some((inputs, end));
    }

    /// What is asked for now.
    pub(crate) fn inputs(&self, bench: &Bench) -> Result<Inputs, &'static str> {
        let document = &bench.document;
        let tunings = [document.tuning(), document.default_tuning()];
        let route = self.route_now(bench);
        let scene = document.scene();
        Inputs::of(&self.choice, scene, tunings, (route, bench.display()))
    }

    /// The path that is followed now.
    pub(crate) fn route_now(&self, bench: &Bench) -> Route {
        match &self.recorded {
            Some(two) if self.choice.what == What::Recordings => Route::Recorded(Arc::clone(two)),
            _ => Route::at_hand(bench),
        }
    }

    /// Sets two recordings against each other.
    pub(crate) fn set_against(&mut self, two: [Recording; 2]) {
        self.choice.what = What::Recordings;
        self.recorded = Some(Arc::new(two));
    }

    /// Lets the comparison follow what was chosen: to be called while its pane is in sight. Nothing
    /// begins during a gesture, nor by itself along a path that takes long.
    pub(crate) fn follow(&mut self, bench: &Bench) -> Standing {
        let asked = self.inputs(bench);
        let standing = self.standing(&asked);
        let is_due = matches!(standing, Standing::Stale | Standing::None);
        if matches!(standing, Standing::Running(_)) {
            bench.ctx.request_repaint_after(PROGRESS);
        } else if let Ok(inputs) = &asked
            && is_due
            && inputs.route.n_ticks() <= MOST_AT_ONCE
            && !bench.pointer.moment.is_down
        {
            self.begin(inputs.clone(), &bench.engine_scene.loaded, &bench.executor);
            return self.standing(&asked);
        }
        standing
    }

    /// Compares what is asked for now, whether it was compared before or not.
    pub(crate) fn run(&mut self, bench: &Bench) {
        if let Ok(inputs) = self.inputs(bench) {
            self.begin(inputs, &bench.engine_scene.loaded, &bench.executor);
        }
    }
}

/// Sets a display's contactors of two recordings against each other as they were, as long as both
/// last.
fn compare_recorded(two: &[Recording; 2], (scene, display): (&Scene, usize)) -> LevelDifference {
    let [n_a, n_b] = two.each_ref().map(|one| one.path().n_ticks());
    let n_ticks = n_a.min(n_b);
    let mut meter = DifferenceMeter::new(n_ticks);
    for tick in 0..n_ticks {
        let [a, b] = two
            .each_ref()
            .map(|one| one.display_um(tick, (scene, display)).unwrap_or_default());
        let pairs = a.iter().zip(b);
        meter.add_amplitudes(tick, pairs.map(|(a, b)| [a, b].map(|um| um.map(f64::from))));
    }
    meter.finish()
}

/// Replays both and measures; `None` when it was asked to stop.
fn compare(
    inputs: &Inputs,
    loaded: &LoadedScene,
    progress: &mut Progress<'_>,
) -> Result<Option<LevelDifference>, AppError> {
    if let Route::Recorded(two) = &inputs.route {
        let found = compare_recorded(two, (loaded.scene(), inputs.display));
        return Ok(Some(found));
    }
    let mut scenes = Vec::with_capacity(2);
    for side in &inputs.sides {
        scenes.push(RenderScene::of(&loaded.with_scene(side.scene.clone())?));
    }
    let n_ticks = inputs.route.n_ticks();
    let mut meter = DifferenceMeter::new(n_ticks);
    let pair = [0, 1].map(|index| (&scenes[index], inputs.sides[index].method));
    let mut n_done = 0_u64;
    let route = (inputs.route.ticks(), inputs.route.path());
    let end = replay_pair(pair, route, &mut |tick, frames| {
        meter.add(tick, inputs.display, frames);
        n_done += 1;
        let is_due = n_done.is_multiple_of(N_TICKS_A_STEP) || n_done == 1;
        let share = n_done as f64 / n_ticks.max(1) as f64;
        if is_due && progress.step(share, "comparing").is_err() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    })?;
    Ok(end.is_continue().then(|| meter.finish()))
}

#[cfg(test)]
mod tests;
