//! Replays and generated strokes: sources that know the pose of every tick.
//!
//! They move on by one tick of the path at every tick that they play, so that what is felt is what
//! an offline rendering computes, however late the engine was.

use std::sync::Arc;
use std::time::Instant;

use super::pointer::{Control, Playback, PointerInput, Reading, SourceKind};
use crate::PointerSample;
use selvedge_render::scene::{ExplorationPath, PathCursor, Pose, Stroke, TICKS_PER_S};

/// Whether the next tick moves on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Motion {
    Playing,
    Stepping,
    Held,
}

impl Motion {
    fn after(self, control: Control) -> Self {
        match control {
            Control::Play => Self::Playing,
            Control::Pause => Self::Held,
            Control::Step => Self::Stepping,
            // Where it stands now is to be seen.
            Control::Seek(_) if self == Self::Held => Self::Stepping,
            Control::Seek(_) | Control::Rewind | Control::Loop(_) | Control::LoopWithin(_) => self,
        }
    }

    /// Whether to move on now; a step is used up by it.
    fn takes_tick(&mut self) -> bool {
        let moves = *self != Self::Held;
        if *self == Self::Stepping {
            *self = Self::Held;
        }
        moves
    }
}

/// A recorded exploration, tick by tick.
#[derive(Debug)]
pub(crate) struct ReplayInput {
    path: Arc<ExplorationPath>,
    cursor: PathCursor,
    motion: Motion,
    does_loop: bool,
    loop_within: Option<[u64; 2]>,
    has_ended: bool,
    tick: u64,
}

impl ReplayInput {
    /// A replay that is held before its first tick.
    pub(crate) fn new(path: Arc<ExplorationPath>) -> Self {
        Self {
            path,
            cursor: PathCursor::default(),
            motion: Motion::Held,
            does_loop: false,
            loop_within: None,
            has_ended: false,
            tick: 0,
        }
    }

    fn rewind(&mut self) {
        self.cursor = PathCursor::default();
        self.has_ended = false;
        self.tick = 0;
    }

    fn seek(&mut self, tick: u64) {
        self.cursor = PathCursor::at(&self.path, tick);
        self.has_ended = false;
        self.tick = tick.min(self.path.n_ticks() - 1);
    }

    fn next(&mut self) -> Option<Pose> {
        let (tick, pose) = self.cursor.step(&self.path)?;
        self.tick = tick;
        Some(pose)
    }
}

impl PointerInput for ReplayInput {
    fn kind(&self) -> SourceKind {
        SourceKind::Replay
    }

    fn poll(&mut self, _now: Instant, _take: &mut dyn FnMut(PointerSample)) -> Reading {
        if self.has_ended {
            return Reading::Ended;
        }
        if !self.motion.takes_tick() {
            return Reading::Held;
        }
        if let Some([first, last]) = self.loop_within.filter(|_| self.does_loop)
            && self.tick == last
        {
            self.seek(first);
        }
        if let Some(pose) = self.next() {
            return Reading::Pose(pose);
        }
        if self.does_loop {
            self.rewind();
            if let Some(pose) = self.next() {
                return Reading::Pose(pose);
            }
        }
        self.has_ended = true;
        self.motion = Motion::Held;
        Reading::Ended
    }

    fn control(&mut self, control: Control) {
        match control {
            Control::Loop(does_loop) => self.does_loop = does_loop,
            Control::LoopWithin(ticks) => {
                let last = self.path.n_ticks() - 1;
                self.loop_within = ticks.map(|ticks| ticks.map(|tick| tick.min(last)));
            }
            Control::Play | Control::Step if self.has_ended => self.rewind(),
            Control::Rewind => self.rewind(),
            Control::Seek(tick) => self.seek(tick),
            Control::Play | Control::Step | Control::Pause => {}
        }
        self.motion = self.motion.after(control);
    }

    fn pose_before(&self, n_ticks: u64) -> Option<Pose> {
        let mut cursor = PathCursor::at(&self.path, self.tick.checked_sub(n_ticks)?);
        cursor.step(&self.path).map(|(_, pose)| pose)
    }

    fn path(&self) -> Option<&ExplorationPath> {
        Some(&*self.path).filter(|path| path.n_others() > 0)
    }

    fn playback(&self) -> Playback {
        Playback {
            is_playing: self.motion == Motion::Playing,
            has_ended: self.has_ended,
            does_loop: self.does_loop,
            tick: self.tick,
            n_ticks: self.path.n_ticks(),
        }
    }
}

/// A generated stroke, tick by tick; it never ends.
#[derive(Debug)]
pub(crate) struct StrokeInput {
    stroke: Stroke,
    motion: Motion,
    next_tick: u64,
}

impl StrokeInput {
    /// A stroke that is held before its first tick.
    pub(crate) fn new(stroke: Stroke) -> Self {
        Self {
            stroke,
            motion: Motion::Held,
            next_tick: 0,
        }
    }
}

impl PointerInput for StrokeInput {
    fn kind(&self) -> SourceKind {
        SourceKind::Stroke
    }

    fn poll(&mut self, _now: Instant, _take: &mut dyn FnMut(PointerSample)) -> Reading {
        if !self.motion.takes_tick() {
            return Reading::Held;
        }
        let t_s = self.next_tick as f64 / TICKS_PER_S;
        self.next_tick = self.next_tick.saturating_add(1);
        Reading::Pose(self.stroke.pose_at(t_s))
    }

    fn control(&mut self, control: Control) {
        match control {
            Control::Rewind => self.next_tick = 0,
            Control::Seek(tick) => self.next_tick = tick,
            Control::Play
            | Control::Pause
            | Control::Step
            | Control::Loop(_)
            | Control::LoopWithin(_) => {}
        }
        self.motion = self.motion.after(control);
    }

    fn pose_before(&self, n_ticks: u64) -> Option<Pose> {
        let tick = (self.next_tick.checked_sub(1)?).checked_sub(n_ticks)?;
        Some(self.stroke.pose_at(tick as f64 / TICKS_PER_S))
    }

    fn playback(&self) -> Playback {
        Playback {
            is_playing: self.motion == Motion::Playing,
            does_loop: true,
            tick: self.next_tick.saturating_sub(1),
            ..Playback::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::Point;
    use selvedge_render::scene::PathRow;

    fn path() -> Arc<ExplorationPath> {
        let row = |n: i32| PathRow {
            t_s: 3.0 + f64::from(n) * 0.04,
            position: Point::new(f64::from(n * n) * 0.3, f64::from(n)),
            angle_deg: f64::from(n) * 7.0,
            velocity: None,
        };
        Arc::new(ExplorationPath::new((0..9).map(row).collect()).unwrap())
    }

    fn poll(input: &mut dyn PointerInput) -> Reading {
        input.poll(Instant::now(), &mut |sample| {
            panic!("a path has no samples: {sample:?}")
        })
    }

    #[test]
    fn a_replay_gives_the_very_poses_of_the_path_and_then_ends() {
        let path = path();
        let mut replay = ReplayInput::new(Arc::clone(&path));
        assert_eq!(poll(&mut replay), Reading::Held);
        replay.control(Control::Play);
        for (tick, pose) in path.ticks() {
            assert_eq!(poll(&mut replay), Reading::Pose(pose));
            assert_eq!(replay.playback().tick, tick);
        }
        assert_eq!(poll(&mut replay), Reading::Ended);
        assert!(replay.playback().has_ended);
        replay.control(Control::Play);
        assert!(
            matches!(poll(&mut replay), Reading::Pose(_)),
            "playing again begins again"
        );
    }

    #[test]
    fn steps_pauses_and_loops_move_by_whole_ticks() {
        let path = path();
        let poses: Vec<Pose> = path.ticks().map(|(_, pose)| pose).collect();
        let mut replay = ReplayInput::new(path);
        replay.control(Control::Loop(true));
        replay.control(Control::Step);
        assert_eq!(poll(&mut replay), Reading::Pose(poses[0]));
        assert_eq!(poll(&mut replay), Reading::Held);
        replay.control(Control::Play);
        for pose in poses[1..].iter().chain(&poses) {
            assert_eq!(poll(&mut replay), Reading::Pose(*pose));
        }
        replay.control(Control::Rewind);
        assert_eq!(poll(&mut replay), Reading::Pose(poses[0]));
    }

    #[test]
    fn a_stroke_is_drawn_at_the_ticks() {
        let stroke = Stroke::Circle {
            centre: Point::new(50.0, 50.0),
            radius_mm: 20.0,
            speed_mm_per_s: 100.0,
        };
        let mut input = StrokeInput::new(stroke);
        assert_eq!(poll(&mut input), Reading::Held);
        input.control(Control::Play);
        for tick in 0..100_u32 {
            let pose = stroke.pose_at(f64::from(tick) / 40.0);
            assert_eq!(poll(&mut input), Reading::Pose(pose));
        }
    }
}
