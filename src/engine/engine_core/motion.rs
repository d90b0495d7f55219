//! From what the source says of a tick to the pose of the first display.

use std::time::Instant;

use super::EngineCore;
use crate::input::{Reading, Touched};
use crate::{SourceKind, TICKS_PER_S};
use selvedge_render::scene::Pose;

impl EngineCore {
    /// Takes what the source and the fingers did since the last tick.
    pub(super) fn read(&mut self, now: Instant) -> Reading {
        let (track, recorder) = (&mut self.track, &mut self.recorder);
        let (fingers, first) = (&mut self.fingers, self.pose);
        track.begin_tick();
        fingers.begin_tick(self.scene.n_displays());
        if let Some(recorder) = recorder {
            recorder.begin_tick(now);
        }
        let mut restarted = false;
        let mut hear = |touched: Touched| match (touched.display, touched.sample) {
            (0, Some(sample)) => {
                restarted |= track.take(sample, now);
                if let Some(recorder) = recorder {
                    recorder.hear(sample, now);
                }
            }
            (0, None) => track.lift(),
            _ => fingers.hear(touched, now, first),
        };
        let Some(playable) = &mut self.playable else {
            self.live.poll(hear);
            track.look(now, restarted);
            return if track.is_lifted() {
                Reading::Lifted
            } else {
                Reading::Samples
            };
        };
        // What the mouse did meanwhile is nobody's business.
        self.live.poll(|_| {});
        let reading = playable.poll(now, &mut |sample| hear(Touched::first(sample)));
        playable.poll_others(&mut |display, sample| hear(Touched { display, sample }));
        track.look(now, restarted);
        if reading == Reading::Lifted {
            track.lift();
        }
        if let Some(angle_deg) = playable.angle_deg() {
            self.angle_deg = angle_deg;
        }
        reading
    }

    /// The pose that follows from samples: where the newest was, as fast as estimated, turned as
    /// told.
    pub(super) fn follow(&mut self) {
        let position = self.track.position().unwrap_or(self.pose.position);
        self.pose = Pose {
            t_s: self.tick as f64 / TICKS_PER_S,
            position,
            angle_deg: self.angle_deg,
            velocity: self.track.estimate().velocity,
            angular_rad_per_s: self.turning_rad_per_s(),
        };
    }

    /// The pose that a source states, turned as told if it has no angle of its own.
    pub(super) fn as_told(&mut self, pose: Pose) -> Pose {
        if !self.is_turnable() {
            return pose;
        }
        Pose {
            angle_deg: self.angle_deg,
            angular_rad_per_s: self.turning_rad_per_s(),
            ..pose
        }
    }

    /// Whether the source says nothing of angles: all but replays, which have their own.
    pub(super) fn is_turnable(&self) -> bool {
        self.source()
            .is_none_or(|source| source.kind() != SourceKind::Replay)
    }

    /// How fast the display was turned since the last tick, which this one follows.
    fn turning_rad_per_s(&mut self) -> f64 {
        let before_deg = self.last_angle_deg.unwrap_or(self.angle_deg);
        self.last_angle_deg = Some(self.angle_deg);
        Pose::turning_rad_per_s(before_deg, self.angle_deg)
    }
}
