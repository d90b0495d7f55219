//! A whole path through a renderer, off the real-time path: frames for files, figures for reports.
//!
//! Two scenes, or two methods, can be replayed side by side on the very same poses.
//! Rendering has no clock: whoever wants times hands one in. Errors are taken against `reference`
//! on the very same poses.

use std::ops::ControlFlow;

use super::array::{Accuracy, ArrayRenderer, DisplayFrame, ErrorBound, Method, unfiltered_um};
use super::error_meter::ErrorMeter;
use super::stats::{Histogram, RunStats};
use super::{RenderError, RenderScene};
use crate::scene::{ExplorationPath, Pose};

/// What to replay, and how.
#[derive(Debug, Clone, Copy)]
pub struct Replay<'a> {
    /// The scene. Displays that the path does not tell of go with the first.
    pub scene: &'a RenderScene,
    /// The method.
    pub method: Method,
    /// The accuracy it has to keep.
    pub accuracy: Accuracy,
    /// Whether to measure the error against `reference`: two more runs by it, and one more by the
    /// method, for its times.
    pub measures_error: bool,
}

/// Takes a tick's number, pose and frames; may stop the run.
pub(crate) type FrameSink<'a> = dyn FnMut(u64, &Pose, &[DisplayFrame]) -> ControlFlow<()> + 'a;

/// Replays the ticks of a path. `clock_ns` tells a monotonic time in ns; `sink` takes every tick's
/// number, the first display's pose and the frames, and may stop the run.
///
/// # Errors
/// What [`ArrayRenderer::prepare`] refuses.
pub fn replay(
    what: &Replay<'_>,
    path: &ExplorationPath,
    clock_ns: &mut dyn FnMut() -> u64,
    sink: &mut FrameSink<'_>,
) -> Result<RunStats, RenderError> {
    let started_ns = clock_ns();
    let (method, accuracy) = (what.method, &what.accuracy);
    let mut renderer = ArrayRenderer::prepare_along(what.scene, method, accuracy, path)?;
    let prepare_ns = clock_ns().saturating_sub(started_ns);
    let mut comparison = if what.measures_error {
        Some(Comparison::prepare(what.scene, path)?)
    } else {
        None
    };
    let mut times_ns = Histogram::default();
    let mut poses = vec![Pose::default(); what.scene.displays.len()];
    let mut timed_tick = |renderer: &mut ArrayRenderer, poses: &[Pose]| {
        let before_ns = clock_ns();
        renderer.tick(poses);
        times_ns.add(clock_ns().saturating_sub(before_ns) as f64);
    };
    if what.measures_error {
        // Timed in a run of its own: the reference between ticks would clear the caches.
        for (_, pose) in path.ticks() {
            path.poses_into(&pose, &mut poses);
            timed_tick(&mut renderer, &poses);
        }
        renderer.reset();
    }
    for (tick, pose) in path.ticks() {
        path.poses_into(&pose, &mut poses);
        if let Some(comparison) = &mut comparison {
            renderer.tick(&poses);
            comparison.add(&poses, renderer.frames(), &renderer.bound());
        } else {
            timed_tick(&mut renderer, &poses);
        }
        if sink(tick, &pose, renderer.frames()).is_break() {
            break;
        }
    }
    Ok(RunStats {
        method: what.method,
        method_used: renderer.method(),
        bound: renderer.bound(),
        n_contactors: what
            .scene
            .displays
            .iter()
            .map(|display| display.offsets.len())
            .sum(),
        prepare_ns,
        tick_median_ns: times_ns.quantile(0.5),
        tick_p99_ns: times_ns.quantile(0.99),
        tick_max_ns: times_ns.largest(),
        counters: *renderer.counters(),
        unfiltered_um: comparison.as_ref().map(Comparison::unfiltered_um),
        bound_share: comparison.as_ref().map(|comparison| comparison.bound_share),
        level_error: comparison.map(|comparison| comparison.meter.finish()),
    })
}

/// Takes a tick's number and the frames of both runs; may stop them.
pub(crate) type PairSink<'a> = dyn FnMut(u64, [&[DisplayFrame]; 2]) -> ControlFlow<()> + 'a;

/// Replays the same ticks in two scenes, each by its method, side by side: for comparing them.
///
/// Displays beside the first are where a `path` has them; without one they go with it. Says whether
/// every tick was replayed.
///
/// # Errors
/// What [`ArrayRenderer::prepare`] refuses.
pub fn replay_pair(
    [a, b]: [(&RenderScene, Method); 2],
    (ticks, path): (impl Iterator<Item = (u64, Pose)>, Option<&ExplorationPath>),
    sink: &mut PairSink<'_>,
) -> Result<ControlFlow<()>, RenderError> {
    let prepare = |(scene, method): (&RenderScene, Method)| {
        let renderer = ArrayRenderer::prepare(scene, method, &Accuracy::default())?;
        Ok::<_, RenderError>((renderer, vec![Pose::default(); scene.displays.len()]))
    };
    let (mut a, mut b) = (prepare(a)?, prepare(b)?);
    for (tick, pose) in ticks {
        let frames = [&mut a, &mut b].map(|(renderer, poses)| {
            match path {
                Some(path) => path.poses_into(&pose, poses),
                None => poses.fill(pose),
            }
            renderer.tick(poses)
        });
        if sink(tick, frames).is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// The reference beside a run.
struct Comparison<'a> {
    scene: &'a RenderScene,
    reference: ArrayRenderer,
    meter: ErrorMeter,
    /// What each textile that was felt gives unfiltered, µm.
    unfiltered_um: Vec<Option<f64>>,
    /// The largest error as a share of the bound.
    bound_share: f64,
}

impl<'a> Comparison<'a> {
    /// Runs the reference once to learn its largest amplitudes.
    fn prepare(scene: &'a RenderScene, path: &ExplorationPath) -> Result<Self, RenderError> {
        let mut reference = ArrayRenderer::prepare(scene, Method::Reference, &Accuracy::default())?;
        let mut largest_um = [0.0_f64; 2];
        let mut poses = vec![Pose::default(); scene.displays.len()];
        for (_, pose) in path.ticks() {
            path.poses_into(&pose, &mut poses);
            for frame in reference.tick(&poses) {
                for contactor in 0..frame.n_contactors() {
                    let amplitudes = frame.amplitude_um(contactor);
                    (0..2).for_each(|b| largest_um[b] = largest_um[b].max(amplitudes[b]));
                }
            }
        }
        Ok(Self {
            scene,
            reference,
            meter: ErrorMeter::new(largest_um),
            unfiltered_um: vec![None; scene.textiles.len()],
            bound_share: 0.0,
        })
    }

    fn add(&mut self, poses: &[Pose], frames: &[DisplayFrame], bound: &ErrorBound) {
        self.reference.tick(poses);
        for (frame, reference) in frames.iter().zip(self.reference.frames()) {
            for contactor in 0..frame.n_contactors() {
                let found = frame.amplitude_um(contactor);
                let exact = reference.amplitude_um(contactor);
                self.meter.add(found, exact);
                let Some(textile) = reference.textile(contactor) else {
                    continue;
                };
                let surface = &self.scene.textiles[textile].surface;
                let known_um = &mut self.unfiltered_um[textile];
                let of_textile_um = *known_um.get_or_insert_with(|| unfiltered_um(surface));
                // The bound is of amplitudes before gains.
                let factors = self.reference.gain_factors(textile);
                for (b, factor) in factors.into_iter().enumerate() {
                    if factor > 0.0 && factor.is_finite() {
                        let pair = [found[b] / factor, exact[b] / factor];
                        let share = bound.share_of(of_textile_um, pair);
                        self.bound_share = self.bound_share.max(share);
                    }
                }
            }
        }
    }

    /// The largest of all textiles that were felt, µm.
    fn unfiltered_um(&self) -> f64 {
        let felt = self.unfiltered_um.iter().flatten().copied();
        felt.fold(0.0, f64::max)
    }
}
