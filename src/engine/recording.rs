//! Recording an exploration: what was done at every tick, handed over in blocks.
//!
//! The engine fills blocks that were made before; whoever holds the [`Recording`] takes full ones
//! away and gives empty ones back, on any thread. A recording is one exploration with a clock of
//! its own: its n-th row is at n/40 s exactly, so that replaying it meets every row on a tick and
//! gives the same amplitudes bit for bit, with the same scene, method and tuning: it does not hold
//! those.

use std::fmt;
use std::time::Instant;

use rtrb::{Consumer, Producer, RingBuffer};

use super::PointerSample;
use selvedge_device::SentFrame;
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{ExplorationPath, PathRow, Pose, SceneError, TICKS_PER_S};

/// Ticks in a block: half a second, which is all that a crash may take of a recording.
const BLOCK_TICKS: usize = 20;
/// Reports in a block: those of a tablet that sends one and a half thousand a second.
const BLOCK_SAMPLES: usize = 750;
/// Blocks on the way: 30 s may pass between two collections.
const N_BLOCKS: usize = 61;
/// The longest recording, ticks: four hours.
const LONGEST: u64 = 4 * 3600 * 40;

/// One tick of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedTick {
    /// The engine's tick.
    pub tick: u64,
    /// The pose that was rendered.
    pub pose: Pose,
    /// The frame that went to an armed device; `None` when the tick was only shown.
    pub sent: Option<SentFrame>,
    /// The step of a sequence that was played, from 0.
    pub sequence_step: Option<u16>,
    /// What the device had counted by then.
    pub tally: LinkTally,
}

/// What host and device have counted on a link so far, as proofs of presentation need it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkTally {
    /// Ticks at which the device was armed and had no frame.
    pub n_missed: u64,
    /// Values that limits of host and device changed.
    pub n_limited: u64,
}

/// One report of the pointer or tablet during a recording, as it came.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedSample {
    /// When it happened, s after the recording's first tick; before that tick, negative.
    pub t_s: f64,
    /// Where in the workspace, mm.
    pub position: Point,
}

#[derive(Debug)]
struct Block {
    samples: Vec<RecordedSample>,
    ticks: Vec<RecordedTick>,
    others: Vec<Pose>,
    amplitudes_um: Vec<[f32; 2]>,
}

impl Block {
    fn new([n_others, n_contactors]: [usize; 2]) -> Self {
        Self {
            samples: Vec::with_capacity(BLOCK_SAMPLES),
            ticks: Vec::with_capacity(BLOCK_TICKS),
            others: Vec::with_capacity(BLOCK_TICKS * n_others),
            amplitudes_um: Vec::with_capacity(BLOCK_TICKS * n_contactors),
        }
    }
}

/// The engine's side of a recording.
pub(super) struct Recorder {
    current: Option<Block>,
    spares: Consumer<Block>,
    full: Producer<Block>,
    n_ticks: u64,
    last_angle_deg: Option<f64>,
    /// When its first tick was.
    began: Option<Instant>,
}

/// A recording, as far as its blocks were collected.
pub struct Recording {
    spares: Producer<Block>,
    full: Consumer<Block>,
    n_others: usize,
    n_contactors: usize,
    ticks: Vec<RecordedTick>,
    samples: Vec<RecordedSample>,
    others: Vec<Pose>,
    amplitudes_um: Vec<[f32; 2]>,
    has_ended: bool,
}

/// Both sides of a recording of so many displays beside the first, and of `n_contactors`
/// contactors, those of all displays together.
pub(super) fn recording([n_others, n_contactors]: [usize; 2]) -> (Recorder, Recording) {
    let (mut spares, spares_out) = RingBuffer::new(N_BLOCKS);
    // Every block that exists finds room among the full ones.
    let (full_in, full) = RingBuffer::new(N_BLOCKS + 1);
    for _ in 1..N_BLOCKS {
        // Room for all of them was just made.
        drop(spares.push(Block::new([n_others, n_contactors])));
    }
    let recorder = Recorder {
        current: Some(Block::new([n_others, n_contactors])),
        spares: spares_out,
        full: full_in,
        n_ticks: 0,
        last_angle_deg: None,
        began: None,
    };
    let recording = Recording {
        spares,
        full,
        n_others,
        n_contactors,
        ticks: Vec::new(),
        samples: Vec::new(),
        others: Vec::new(),
        amplitudes_um: Vec::new(),
        has_ended: false,
    };
    (recorder, recording)
}

impl Recorder {
    /// Adds a report that came for the tick at `now`. One that a block has no room for is left out.
    pub(super) fn hear(&mut self, sample: PointerSample, now: Instant) {
        let began = *self.began.get_or_insert(now);
        let Some(block) = &mut self.current else {
            return;
        };
        if block.samples.len() < BLOCK_SAMPLES {
            let after_s = sample.stamp.saturating_duration_since(began).as_secs_f64();
            let before_s = began.saturating_duration_since(sample.stamp).as_secs_f64();
            block.samples.push(RecordedSample {
                t_s: after_s - before_s,
                position: sample.position,
            });
        }
    }

    /// The tick at `now` is the next that may be recorded.
    pub(super) fn begin_tick(&mut self, now: Instant) {
        if self.n_ticks == 0 {
            self.began = Some(now);
        }
    }

    /// The pose as the recording will replay it: it turns from its own last row, and not at first.
    pub(super) fn as_replayed(&self, pose: Pose) -> Pose {
        let before_deg = self.last_angle_deg.unwrap_or(pose.angle_deg);
        let angular_rad_per_s = Pose::turning_rad_per_s(before_deg, pose.angle_deg);
        Pose {
            angular_rad_per_s,
            ..pose
        }
    }

    /// Adds a tick with the poses of displays beside the first and the amplitudes of every
    /// contactor, µm. Fails, saying why, when it cannot.
    pub(super) fn push<'a>(
        &mut self,
        tick: RecordedTick,
        others: impl Iterator<Item = Pose>,
        amplitudes_um: impl Iterator<Item = &'a [[f32; 2]]>,
    ) -> Result<(), &'static str> {
        if self.n_ticks >= LONGEST {
            return Err("the recording is four hours long; that is the most");
        }
        if self
            .current
            .as_ref()
            .is_none_or(|block| block.ticks.len() == BLOCK_TICKS)
        {
            self.hand_over();
            self.current = self.spares.pop().ok();
        }
        let Some(block) = &mut self.current else {
            return Err("nobody collected the recording in time");
        };
        block.ticks.push(tick);
        block.others.extend(others);
        amplitudes_um.for_each(|display| block.amplitudes_um.extend_from_slice(display));
        self.last_angle_deg = Some(tick.pose.angle_deg);
        self.n_ticks += 1;
        Ok(())
    }

    /// Hands over what the current block holds.
    pub(super) fn hand_over(&mut self) {
        if let Some(block) = self.current.take()
            && let Err(rtrb::PushError::Full(block)) = self.full.push(block)
        {
            self.current = Some(block);
        }
    }

    /// Ticks recorded so far.
    pub(super) fn n_ticks(&self) -> u64 {
        self.n_ticks
    }
}

impl Recording {
    /// The ticks collected so far.
    pub fn ticks(&self) -> &[RecordedTick] {
        &self.ticks
    }

    /// The reports of the pointer or tablet collected so far, in the order in which they came;
    /// none of a source that states poses.
    pub fn samples(&self) -> &[RecordedSample] {
        &self.samples
    }

    /// Amplitudes [A40, A320] of every contactor at one of the collected ticks, displays in
    /// command,
    /// after gains and before output limits, µm.
    pub fn amplitudes_um(&self, index: usize) -> &[[f32; 2]] {
        let start = index * self.n_contactors;
        self.amplitudes_um
            .get(start..start + self.n_contactors)
            .unwrap_or_default()
    }

    /// Displays beside the first.
    pub fn n_others(&self) -> usize {
        self.n_others
    }

    /// Where they were at one of the collected ticks, in order, felt or not.
    pub fn others(&self, index: usize) -> &[Pose] {
        let start = index * self.n_others;
        let at = start..start + self.n_others;
        self.others.get(at).unwrap_or_default()
    }

    /// Contactors of all displays together.
    pub fn n_contactors(&self) -> usize {
        self.n_contactors
    }

    /// Whether it is over and complete.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// The exploration as a path with its own velocities: its row n is at n/40 s.
    ///
    /// # Errors
    /// Nothing was recorded.
    pub fn to_path(&self) -> Result<ExplorationPath, SceneError> {
        let row = |(n, recorded): (usize, &RecordedTick)| PathRow {
            t_s: n as f64 / TICKS_PER_S,
            position: recorded.pose.position,
            angle_deg: recorded.pose.angle_deg,
            velocity: Some(recorded.pose.velocity),
        };
        let path = ExplorationPath::new(self.ticks.iter().enumerate().map(row).collect())?;
        let mut others = Vec::with_capacity(self.others.len());
        for (n, recorded) in self.ticks.iter().enumerate() {
            let beside = |own: &Pose| own.beside(&recorded.pose);
            others.extend(self.others(n).iter().map(beside));
        }
        path.with_others(self.n_others, others)
    }

    /// Takes full blocks away and gives empty ones back: to be called every few seconds until it
    /// has ended, for the engine has room for thirty.
    pub fn collect(&mut self) {
        // The engine's side is dropped by the engine's owner once it is over: what it handed over
        // before is all.
        let is_over = self.full.is_abandoned();
        while let Ok(mut block) = self.full.pop() {
            self.ticks.append(&mut block.ticks);
            self.samples.append(&mut block.samples);
            self.others.append(&mut block.others);
            self.amplitudes_um.append(&mut block.amplitudes_um);
            // A full ring only means that the engine has enough.
            drop(self.spares.push(block));
        }
        self.has_ended = is_over;
    }
}

impl fmt::Debug for Recorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder")
            .field("n_ticks", &self.n_ticks)
            .finish_non_exhaustive()
    }
}

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recording")
            .field("n_ticks", &self.ticks.len())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::iter;

    fn tick(n: u64) -> RecordedTick {
        let pose = Pose {
            position: Point::new(n as f64, 0.0),
            ..Pose::default()
        };
        RecordedTick {
            tick: 100 + n,
            pose,
            sent: None,
            sequence_step: None,
            tally: LinkTally::default(),
        }
    }

    fn amplitudes(n: u64) -> [[f32; 2]; 2] {
        [[n as f32, 1.0], [2.0, n as f32]]
    }

    #[test]
    fn blocks_arrive_in_order_and_rows_lie_on_the_ticks() {
        let (mut recorder, mut recording) = recording([0, 2]);
        for n in 0..5000 {
            recorder
                .push(tick(n), iter::empty(), [&amplitudes(n)[..]].into_iter())
                .unwrap();
            if n % 500 == 0 {
                recording.collect();
            }
        }
        recorder.hand_over();
        assert_eq!(recorder.n_ticks(), 5000);
        drop(recorder);
        recording.collect();
        assert!(recording.has_ended() && recording.ticks().len() == 5000);
        assert_eq!(recording.amplitudes_um(4321), amplitudes(4321));
        let path = recording.to_path().unwrap();
        assert_eq!(path.n_ticks(), 5000);
        for (n, pose) in path.ticks() {
            assert_eq!(pose.position.x_mm, n as f64);
        }
    }

    #[test]
    fn a_recording_that_nobody_collects_ends_with_the_reason() {
        let (mut recorder, mut recording) = recording([0, 2]);
        let failed = (0..).find_map(|n| {
            recorder
                .push(tick(n), iter::empty(), [&amplitudes(n)[..]].into_iter())
                .err()
                .map(|why| (n, why))
        });
        assert_eq!(
            failed,
            Some((1220, "nobody collected the recording in time"))
        );
        recording.collect();
        assert_eq!(recording.ticks().len(), 1220);
    }

    #[test]
    fn an_empty_recording_is_no_path() {
        let (mut recorder, mut recording) = recording([0, 1]);
        recorder.hand_over();
        recording.collect();
        assert!(recording.to_path().is_err());
    }
}
