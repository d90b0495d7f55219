//! Samples of ticks: what histories of the last seconds need of every tick, however seldom they
//! are drawn.
//!
//! A snapshot shows only the latest tick; a spectrogram or a timeline needs all of them. Each tick
//! that moved or sounded, and the first that did not, leaves one sample in a bounded ring, if
//! somebody asked for them. When the ring is full the newest is lost and counted. Amplitudes of all
//! contactors, and the poses of all displays of a scene with several, go by rings of their own,
//! those of a sample before it.

use rtrb::{Consumer, Producer, RingBuffer};

use super::EngineCore;
use selvedge_foundation::geometry::Velocity;
use selvedge_render::scene::Pose;

/// Samples on the way: almost 13 s of movement.
const MAX_TICK_SAMPLES: usize = 512;
/// Amplitudes on the way: those of as many samples of 64 contactors.
const MAX_AMPLITUDES: usize = 64 * MAX_TICK_SAMPLES;
/// Poses on the way: those of as many samples of two displays.
const MAX_POSES: usize = 2 * MAX_TICK_SAMPLES;

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
    /// The device's tick at which the first display's frame is played; `None` when no armed device
    /// got it.
    pub apply_tick: Option<u32>,
    /// The display that is watched: its place in the scene's list.
    pub display: u32,
    /// Mean amplitudes [A40, A320] over the contactors of that display that lie on a textile,
    /// after gains and before output limits, µm; 0 when none does.
    pub mean_um: [f32; 2],
    /// The contactor that is watched.
    pub watched: u32,
    /// Its amplitudes [A40, A320] after gains and before output limits, µm.
    pub watched_um: [f32; 2],
    /// The first of the display's contactors among those of all displays one after the other.
    pub first_contactor: u32,
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
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let before = (0..display).map(|before| core.felt_um_of(before).len());
        Self {
            tick: core.tick_count(),
            pose: core.shown_pose(display),
            is_silent: core.is_silent(),
            is_stylus: core.stylus().is_some(),
            apply_tick,
            display: count(display),
            mean_um: sum.map(|sum| sum / f32::max(n_placed, 1.0)),
            watched: count(watched),
            watched_um: amplitudes_um.get(watched).copied().unwrap_or_default(),
            first_contactor: count(before.sum()),
            n_contactors: count(amplitudes_um.len()),
        }
    }
}

/// The engine's side of the ring: says which ticks leave a sample.
#[derive(Debug)]
pub(super) struct TickSampler {
    ring: Producer<(TickSample, [usize; 2])>,
    amplitudes: Producer<[f32; 2]>,
    poses: Producer<Pose>,
    is_heard: bool,
    /// The display that is watched, and its contactor.
    watched: [usize; 2],
    /// The first display's pose at the last tick that was looked at and how often others had moved,
    /// and whether that tick was still and silent.
    last: Option<(Pose, u64)>,
    was_quiet: bool,
    n_lost: u64,
}

impl TickSampler {
    /// Nobody listens yet. Both ends.
    pub(super) fn new() -> (Self, TickSamples) {
        let (ring, samples) = RingBuffer::new(MAX_TICK_SAMPLES);
        let (amplitudes, amplitudes_out) = RingBuffer::new(MAX_AMPLITUDES);
        let (poses, poses_out) = RingBuffer::new(MAX_POSES);
        let heard = TickSamples {
            ring: samples,
            amplitudes: amplitudes_out,
            poses: poses_out,
            newest_um: Vec::with_capacity(MAX_AMPLITUDES / MAX_TICK_SAMPLES),
            newest_poses: Vec::new(),
        };
        let sampler = Self {
            ring,
            amplitudes,
            poses,
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
        let (pose, n_moves) = (core.shown_pose(0), core.others_moved());
        let is_there = |(last, n_before): &(Pose, u64)| {
            last.position == pose.position
                && last.angle_deg.to_bits() == pose.angle_deg.to_bits()
                && *n_before == n_moves
        };
        let is_still = self.last.as_ref().is_none_or(is_there)
            && pose.velocity == Velocity::ZERO
            && pose.angular_rad_per_s == 0.0;
        let is_zero = |[low, high]: &[f32; 2]| *low == 0.0 && *high == 0.0;
        let mut displays = 0..core.scene().n_displays();
        let is_quiet = is_still && displays.all(|nth| core.felt_um_of(nth).iter().all(is_zero));
        self.last = Some((pose, n_moves));
        let was_quiet = std::mem::replace(&mut self.was_quiet, is_quiet);
        let is_left = !(is_quiet && was_quiet);
        if is_left && !self.leave(core, apply_tick) {
            self.n_lost += 1;
        }
    }

    /// Leaves a sample if there is room for all of it.
    fn leave(&mut self, core: &EngineCore, apply_tick: Option<u32>) -> bool {
        let n_displays = core.scene().n_displays();
        let n_poses = if n_displays > 1 { n_displays } else { 0 };
        let n_contactors = core.scene().n_contactors();
        let is_full = self.ring.slots() == 0
            || self.amplitudes.slots() < n_contactors
            || self.poses.slots() < n_poses;
        if is_full {
            return false;
        }
        let mut n_left = [0; 2];
        for um in (0..n_displays).flat_map(|nth| core.felt_um_of(nth)) {
            n_left[0] += usize::from(self.amplitudes.push(*um).is_ok());
        }
        for nth in 0..n_poses {
            n_left[1] += usize::from(self.poses.push(core.shown_pose(nth)).is_ok());
        }
        let sample = TickSample::of(core, self.watched, apply_tick);
        self.ring.push((sample, n_left)).is_ok()
    }
}

/// A sample, [A40, A320] of the contactors of all displays, µm, and the poses of all displays.
pub(super) type SampledTick<'a> = (TickSample, &'a [[f32; 2]], &'a [Pose]);

/// The other end of the ring.
#[derive(Debug)]
pub(super) struct TickSamples {
    ring: Consumer<(TickSample, [usize; 2])>,
    amplitudes: Consumer<[f32; 2]>,
    poses: Consumer<Pose>,
    newest_um: Vec<[f32; 2]>,
    newest_poses: Vec<Pose>,
}

impl TickSamples {
    /// The oldest sample that was not taken yet, [A40, A320] of the contactors of all displays, µm,
    /// and the poses of all displays, none where there is one.
    pub(super) fn next(&mut self) -> Option<SampledTick<'_>> {
        let (sample, [n_contactors, n_poses]) = self.ring.pop().ok()?;
        self.newest_um.clear();
        self.newest_poses.clear();
        for _ in 0..n_contactors {
            self.newest_um.extend(self.amplitudes.pop().ok());
        }
        for _ in 0..n_poses {
            self.newest_poses.extend(self.poses.pop().ok());
        }
        Some((sample, &self.newest_um, &self.newest_poses))
    }
}
