//! Displays beside the first: where each is and how it moves.
//!
//! All displays of a scene follow the first until a finger holds another of them. From then on they
//! are apart: each is where its own finger was last, and silent while no finger holds it. Another
//! scene or another source brings them together again.

use std::time::Instant;

use super::input::Touched;
use super::sample::SampleCounters;
use super::track::Track;
use super::{MAX_FINGERS, VelocityMethod};
use selvedge_render::scene::{ExplorationPath, Pose};

/// The displays beside the first. Nothing here allocates once it was made.
#[derive(Debug)]
pub(super) struct Fingers {
    all: Vec<Finger>,
    /// Displays of the scene beside the first that a finger may hold.
    n_others: usize,
    are_apart: bool,
    /// Poses of a tick, for the renderer; empty while they are together.
    rendered: Vec<Pose>,
    /// Ticks at which one of them moved by itself, or a scene took it elsewhere.
    n_moves: u64,
}

/// One display, and the finger that holds it.
#[derive(Debug)]
struct Finger {
    track: Track,
    pose: Pose,
    is_held: bool,
    /// Whether its samples began anew in this tick.
    restarted: bool,
}

impl Fingers {
    /// All together. Allocates.
    pub(super) fn new(method: VelocityMethod) -> Self {
        let finger = |_| Finger {
            track: Track::new(method),
            pose: Pose::default(),
            is_held: false,
            restarted: false,
        };
        Self {
            all: (1..MAX_FINGERS).map(finger).collect(),
            n_others: 0,
            are_apart: false,
            rendered: Vec::with_capacity(MAX_FINGERS),
            n_moves: 0,
        }
    }

    /// They follow the first again.
    pub(super) fn forget(&mut self) {
        if self.are_apart {
            self.n_moves += 1;
        }
        self.are_apart = false;
        self.rendered.clear();
        for finger in &mut self.all {
            finger.track.forget();
            finger.is_held = false;
        }
    }

    /// What comes from here on is of this tick, in a scene of so many displays.
    pub(super) fn begin_tick(&mut self, n_displays: usize) {
        self.n_others = n_others(n_displays);
        for finger in self.apart() {
            finger.track.begin_tick();
            finger.restarted = false;
        }
    }

    /// A finger did something with a display beside the first, which was at this pose. What holds
    /// no display of the scene does nothing.
    pub(super) fn hear(&mut self, touched: Touched, now: Instant, first: Pose) {
        let index = touched.display.wrapping_sub(1);
        if index >= self.n_others {
            return;
        }
        if !self.are_apart {
            self.are_apart = true;
            for finger in &mut self.all {
                finger.pose = first.at_rest();
            }
        }
        let finger = &mut self.all[index];
        if let Some(sample) = touched.sample {
            finger.restarted |= finger.track.take(sample, now);
            finger.is_held = true;
        } else {
            finger.track.lift();
            finger.is_held = false;
        }
    }

    /// Estimates at a tick; time and turn are those of the first. Where the first follows a path
    /// that tells of the others, they are where that has them; past its end they rest there.
    pub(super) fn follow(
        &mut self,
        (first, has_ended): (&Pose, bool),
        now: Instant,
        told: Option<&ExplorationPath>,
    ) {
        let mut poses = [*first; MAX_FINGERS];
        if let Some(path) = told {
            self.are_apart = true;
            path.poses_into(first, &mut poses);
        }
        let mut has_moved = false;
        for (finger, told_pose) in self.apart().iter_mut().zip(&poses[1..]) {
            finger.track.look(now, finger.restarted);
            let position = finger.track.position().unwrap_or(finger.pose.position);
            let pose = Pose {
                position,
                velocity: finger.track.estimate().velocity,
                ..*first
            };
            let pose = match told {
                Some(_) if has_ended => told_pose.at_rest(),
                Some(_) => *told_pose,
                None if finger.is_held => pose,
                None => pose.at_rest(),
            };
            let before = finger.pose;
            has_moved |= (before.position, before.velocity) != (pose.position, pose.velocity);
            finger.pose = pose;
        }
        self.n_moves += u64::from(has_moved);
    }

    /// The poses to render, of the second display and those after it; none where they go with the
    /// first.
    pub(super) fn rendered(&mut self, is_stopped: bool) -> &[Pose] {
        self.rendered.clear();
        if self.are_apart {
            let fingers = self.all[..self.n_others].iter();
            let pose = |finger: &Finger| {
                if is_stopped {
                    finger.pose.at_rest()
                } else {
                    finger.pose
                }
            };
            self.rendered.extend(fingers.map(pose));
        }
        &self.rendered
    }

    /// Where a display is and how it moves; `None` where it goes with the first.
    pub(super) fn pose(&self, display: usize) -> Option<Pose> {
        let index = display.checked_sub(1).filter(|_| self.are_apart)?;
        let finger = self.all.get(index).filter(|_| index < self.n_others)?;
        Some(finger.pose)
    }

    /// Times that something else was to be seen of them.
    pub(super) fn n_moves(&self) -> u64 {
        self.n_moves
    }

    /// Adds what became of their samples.
    pub(super) fn count_into(&self, samples: &mut SampleCounters) {
        if self.are_apart {
            let fingers = self.all[..self.n_others].iter();
            fingers.for_each(|finger| samples.add(finger.track.samples()));
        }
    }

    /// Those that a tick has to look at: none while they are together.
    fn apart(&mut self) -> &mut [Finger] {
        let n = if self.are_apart { self.n_others } else { 0 };
        &mut self.all[..n]
    }
}

/// Displays beside the first that fingers may hold, in a scene of so many.
pub(super) fn n_others(n_displays: usize) -> usize {
    n_displays.saturating_sub(1).min(MAX_FINGERS - 1)
}
