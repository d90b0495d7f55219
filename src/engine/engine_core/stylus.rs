//! The stylus that is felt in place of the array: which places it is led to at a tick.
//!
//! What a recording holds follows from its rows alone: a run begins with the first of them, and
//! goes on from row to row. So its replay, which begins a run with its first tick, is the same.

use super::EngineCore;
use crate::{PointerInput, SourceKind};
use selvedge_render::scene::Pose;
use selvedge_render::stylus::{StylusDrive, StylusState};

/// The stylus, if one is felt.
#[derive(Debug, Default)]
pub(super) struct FeltStylus {
    drive: Option<Box<StylusDrive>>,
    /// Whether another scene came since.
    pub(super) is_over: bool,
    /// The tick of a path that it felt last.
    source_tick: u64,
    /// Steps of all that were felt.
    n_steps: u64,
}

impl FeltStylus {
    /// Feels another one, or the array; what was felt comes back.
    pub(super) fn exchange(&mut self, next: Option<Box<StylusDrive>>) -> Option<Box<StylusDrive>> {
        self.is_over = false;
        std::mem::replace(&mut self.drive, next)
    }

    fn felt(&self) -> Option<&StylusDrive> {
        self.drive.as_deref().filter(|_| !self.is_over)
    }

    /// What the first display is driven with: a textile, and amplitudes before its gains, µm.
    pub(super) fn driven(&self) -> Option<(usize, [f64; 2])> {
        self.felt().map(StylusDrive::driven)
    }

    /// Steps made so far.
    pub(super) fn n_steps(&self) -> u64 {
        self.n_steps
    }
}

impl EngineCore {
    /// What the stylus does, if one is felt in place of the array.
    pub fn stylus(&self) -> Option<StylusState> {
        self.in_place.stylus.felt().map(StylusDrive::state)
    }

    /// Leads the stylus to where the display is at this tick; while that is held it stays as it
    /// was.
    pub(super) fn lead_stylus(&mut self) {
        let Some(mut drive) = self.in_place.stylus.drive.take() else {
            return;
        };
        let is_felt =
            drive.is_for(self.scene.renderer().surfaces()) && !self.in_place.stylus.is_over;
        if self.is_stopped || self.sequence.played().is_some() || !is_felt {
            drive.leave();
        } else if !self.is_held {
            let place_of = |pose: Pose| self.scene.renderer().place_on_textile(pose.position);
            let mut n_steps = 0;
            if self.begins_anew() {
                drive.leave();
                let n_before = self.n_ticks_before().min(drive.n_catch_up());
                let pose_before = |n_ticks| self.source()?.pose_before(n_ticks);
                for pose in (1..=n_before).rev().filter_map(pose_before) {
                    n_steps += drive.follow(place_of(pose));
                }
            }
            n_steps += drive.follow(place_of(self.rendered));
            self.in_place.stylus.source_tick = self.playback().tick;
            self.in_place.stylus.n_steps += n_steps as u64;
        }
        self.in_place.stylus.drive = Some(drive);
    }

    /// Whether this tick does not follow the one that the stylus felt last.
    fn begins_anew(&self) -> bool {
        if let Some(recorder) = &self.recorder {
            return recorder.n_ticks() == 0;
        }
        let (before, tick) = (self.in_place.stylus.source_tick, self.playback().tick);
        let follows = tick > 0 && (tick == before || tick == before + 1);
        self.is_on_path() && (self.is_sought() || !follows)
    }

    /// Ticks of a path before this one; none while a recording is made.
    fn n_ticks_before(&self) -> u64 {
        let is_known = self.is_on_path() && self.recorder.is_none();
        if is_known { self.playback().tick } else { 0 }
    }

    fn is_on_path(&self) -> bool {
        let kind = self.source().map(PointerInput::kind);
        matches!(kind, Some(SourceKind::Replay | SourceKind::Stroke))
    }
}
