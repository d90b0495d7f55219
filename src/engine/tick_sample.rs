//! Samples of ticks: what histories of the last seconds need of every tick, however seldom they
//! are drawn.
//!
//! A snapshot shows only the latest tick; a spectrogram or a timeline needs all of them. Each tick
//! that moved or sounded, and the first that did not, leaves one sample in a bounded ring, if
//! somebody asked for them. When the ring is full the newest is lost and counted. Amplitudes of all
//! contactors go by a ring of their own, those of a sample before it.

use rtrb::{Consumer, Producer, RingBuffer};

use super::EngineCore;
use selvedge_foundation::geometry::Velocity;
use selvedge_render::scene::Pose;

/// Samples on the way: almost 13 s of movement.
const MAX_TICK_SAMPLES: usize = 512;
/// Amplitudes on the way: those of as many samples of 64 contactors.
const MAX_AMPLITUDES: usize = 64 * MAX_TICK_SAMPLES;

/// One tick, as histories keep it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TickSample {
    /// Ticks since the engine started.
    pub tick: u64,
    /// Where the display that is watched was, how it was turned and how it moved.
    pub pose: Pose,
    /// Whether the device played silence (stopped, or held).
    pub is_silent: bool,
    /// Whether a stylus was felt in place of the array.
    pub is_stylus: bool,
    /// The device's tick at which its frame is played; `None` when no armed device got it, as of
    /// every display but the first.
    pub apply_tick: Option<u32>,
    /// Mean amplitudes [A40, A320] over the contactors of that display that lie on a textile,
    /// after gains and before output limits, µm; 0 when none does.
    pub mean_um: [f32; 2],
    /// The contactor that is watched.
    pub watched: u32,
    /// Its amplitudes [A40, A320] after gains and before output limits, µm.
    pub watched_um: [f32; 2],
    /// Contactors of the display.
    pub n_contactors: u32,
}

impl TickSample {
    /// The tick that a core did last.
    fn of(core: &EngineCore, [display, watched]: [usize; 2], apply_tick: Option<u32>) -> Self {
        let amplitudes_um = core.felt_um_of(display);
        let frame = core.scene().renderer().frames().get(display);
        let is_placed = |&(index, _): &(usize, &[f32; 2])| {
            frame.is_some_and(|frame| frame.textile(index).is_some())
        };
        let (mut sum, mut n_placed) = ([0.0; 2], 0.0);
        for (_, [low, high]) in amplitudes_um.iter().enumerate().filter(is_placed) {
            sum = [sum[0] + low, sum[1] + high];
            n_placed += 1.0;
        }
        Self {
            tick: core.tick_count(),
            pose: core.shown_pose(display),
            is_silent: core.is_silent(),
            is_stylus: core.stylus().is_some(),
            apply_tick: apply_tick.filter(|_| display == 0),
            mean_um: sum.map(|sum| sum / f32::max(n_placed, 1.0)),
            watched: u32::try_from(watched).unwrap_or(u32::MAX),
            watched_um: amplitudes_um.get(watched).copied().unwrap_or_default(),
            n_contactors: u32::try_from(amplitudes_um.len()).unwrap_or(u32::MAX),
        }
    }
}

/// The engine's side of the ring: says which ticks leave a sample.
#[derive(Debug)]
pub(super) struct TickSampler {
    ring: Producer<TickSample>,
    amplitudes: Producer<[f32; 2]>,
    is_heard: bool,
    /// The display that is watched, and its contactor.
    watched: [usize; 2],
    /// The pose of the last tick that was looked at, and whether that was still and silent.
    last: Option<Pose>,
    was_quiet: bool,
    n_lost: u64,
}

impl TickSampler {
    /// Nobody listens yet. Both ends.
    pub(super) fn new() -> (Self, TickSamples) {
        let (ring, samples) = RingBuffer::new(MAX_TICK_SAMPLES);
        let (amplitudes, amplitudes_out) = RingBuffer::new(MAX_AMPLITUDES);
        let heard = TickSamples {
            ring: samples,
            amplitudes: amplitudes_out,
            newest_um: Vec::with_capacity(MAX_AMPLITUDES / MAX_TICK_SAMPLES),
        };
        let sampler = Self {
            ring,
            amplitudes,
            is_heard: false,
            watched: [0; 2],
            last: None,
            was_quiet: false,
            n_lost: 0,
        };
        (sampler, heard)
    }

    /// Whether somebody listens from now on; the first tick leaves a sample.
    pub(super) fn listen(&mut self, is_heard: bool) {
        self.is_heard = is_heard;
        self.last = None;
        self.was_quiet = false;
    }

    /// Watches this contactor of the display; one that is not there is silent.
    pub(super) fn watch(&mut self, contactor: usize) {
        self.watched[1] = contactor;
    }

    /// Watches this display of the scene; its first tick leaves a sample.
    pub(super) fn watch_display(&mut self, display: usize) {
        self.watched[0] = display;
        self.listen(self.is_heard);
    }

    /// Samples that found the ring full.
    pub(super) fn n_lost(&self) -> u64 {
        self.n_lost
    }

    /// Leaves a sample of the tick that was just done, if it moved, turned or sounded, or is the
    /// first that did not. A tick that is held, or shows where it was put to, leaves none.
    pub(super) fn look(&mut self, core: &EngineCore, apply_tick: Option<u32>) {
        if !self.is_heard {
            return;
        }
        if core.is_held() || core.is_sought() {
            // What follows is new, even if it stands still.
            self.was_quiet = false;
            return;
        }
        let pose = core.shown_pose(self.watched[0]);
        let is_there = |last: &Pose| {
            last.position == pose.position && last.angle_deg.to_bits() == pose.angle_deg.to_bits()
        };
        let is_still = self.last.as_ref().is_none_or(is_there)
            && pose.velocity == Velocity::ZERO
            && pose.angular_rad_per_s == 0.0;
        let is_zero = |[low, high]: &[f32; 2]| *low == 0.0 && *high == 0.0;
        let is_quiet = is_still && core.felt_um_of(self.watched[0]).iter().all(is_zero);
        self.last = Some(pose);
        let was_quiet = std::mem::replace(&mut self.was_quiet, is_quiet);
        let is_left = !(is_quiet && was_quiet);
        if is_left && !self.leave(core, apply_tick) {
            self.n_lost += 1;
        }
    }

    /// Leaves a sample if there is room for all of it.
    fn leave(&mut self, core: &EngineCore, apply_tick: Option<u32>) -> bool {
        let amplitudes_um = core.felt_um_of(self.watched[0]);
        if self.ring.slots() == 0 || self.amplitudes.slots() < amplitudes_um.len() {
            return false;
        }
        let sample = TickSample::of(core, self.watched, apply_tick);
        let is_whole = amplitudes_um
            .iter()
            .all(|&um| self.amplitudes.push(um).is_ok());
        is_whole && self.ring.push(sample).is_ok()
    }
}

/// The other end of the ring.
#[derive(Debug)]
pub(super) struct TickSamples {
    ring: Consumer<TickSample>,
    amplitudes: Consumer<[f32; 2]>,
    newest_um: Vec<[f32; 2]>,
}

impl TickSamples {
    /// The oldest sample that was not taken yet, and [A40, A320] of its contactors, µm.
    pub(super) fn next(&mut self) -> Option<(TickSample, &[[f32; 2]])> {
        let sample = self.ring.pop().ok()?;
        self.newest_um.clear();
        for _ in 0..sample.n_contactors {
            self.newest_um.extend(self.amplitudes.pop().ok());
        }
        Some((sample, &self.newest_um))
    }
}
