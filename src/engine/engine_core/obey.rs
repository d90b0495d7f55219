//! What commands do to the core: scenes, gains, masks, sources, angles, recordings; and what is
//! heard of it.
//!
//! Everything takes effect at the next tick. What is replaced goes back to be dropped elsewhere.

use super::{EngineCore, Say};
use crate::input::PointerInput;
use crate::ready::{CoreCommand, NextScene, Retired};
use crate::sequence::Sequence;
use crate::{Notice, SoundFeed, Tap, stereo_levels};
use selvedge_render::RenderError;
use selvedge_render::scene::Pose;

impl EngineCore {
    /// Hands the last tick to whoever makes sound of it: what a device at full gain plays, armed
    /// or not.
    pub(crate) fn sound_to(&self, feed: &mut SoundFeed) {
        let Some(frame) = self.scene.renderer().frames().first() else {
            return;
        };
        let contactors = self.felt_um().iter().enumerate().map(|(index, &felt_um)| {
            let x_mm = frame.contactor_position(index).x_mm;
            (x_mm, self.scene.limited_um(index, felt_um))
        });
        let middles_mm = [frame.position().x_mm, self.scene.start().x_mm];
        feed.push(stereo_levels(middles_mm, contactors, feed.alone()));
    }

    /// Writes the last tick to whoever listens at a tap: what the device plays, before its limits.
    pub fn write_to(&self, tap: &mut Tap) {
        let Pose {
            position,
            angle_deg,
            ..
        } = self.pose();
        let place = [position.x_mm, position.y_mm, angle_deg];
        tap.write(self.tick, place, self.felt_um());
    }

    /// Obeys, and hands back what was replaced: at most two things.
    pub(crate) fn obey(&mut self, command: CoreCommand, say: Say<'_>) -> [Option<Retired>; 2] {
        let mut retired = [None, None];
        match command {
            CoreCommand::Scene(next) => retired = self.next_scene(next),
            CoreCommand::Gains {
                tuning,
                textiles_db,
            } => {
                let set = self.scene.renderer.set_gains(&tuning, &textiles_db);
                self.revise(set, say);
                retired[0] = Some(Retired::Gains(textiles_db));
            }
            CoreCommand::Levels(levels) => {
                let set = self.scene.renderer.set_levels(&levels);
                self.revise(set, say);
                retired[0] = Some(Retired::Levels(levels));
            }
            CoreCommand::Mask(mask) => {
                retired[0] = Some(Retired::Mask(std::mem::replace(&mut self.mask, mask)));
                self.revision += 1;
            }
            CoreCommand::PlaySequence(next) => {
                let next = self.playable_sequence(next, say);
                let last = std::mem::replace(&mut self.sequence, next);
                retired[0] = Some(Retired::Sequence(last));
            }
            CoreCommand::Stylus(next) => {
                retired[0] = self.in_place.stylus.exchange(next).map(Retired::Stylus);
                self.revision += 1;
            }
            CoreCommand::Cloth(next) => {
                retired[0] = std::mem::replace(&mut self.in_place.cloth, next).map(Retired::Cloth);
                self.revision += 1;
            }
            CoreCommand::Source(source) => retired[0] = self.set_source(source),
            CoreCommand::Angle(angle_deg) => self.set_angle(angle_deg, say),
            CoreCommand::Turn(by_deg) => self.set_angle(self.angle_deg + by_deg, say),
            CoreCommand::Control(control) => self.control(control),
            CoreCommand::Record(recorder) => {
                retired[0] = self.end_recording();
                self.recorder = Some(recorder);
            }
            CoreCommand::EndRecording => retired[0] = self.end_recording(),
        }
        retired
    }

    /// A sequence that may begin now; one that may not is at its end.
    fn playable_sequence(&mut self, mut sequence: Sequence, say: Say<'_>) -> Sequence {
        let refusal = if !sequence.is_sound() {
            Some("a vibration's amplitude is none: nothing is played")
        } else if self.is_stopped && sequence.has_anything() {
            Some("everything is off: arm before a sequence is played")
        } else {
            None
        };
        if let Some(reason) = refusal {
            self.ignored += 1;
            sequence.end();
            say(Notice::Refused(reason));
        }
        sequence
    }

    /// The next scene is felt from the next tick on; its renderer already holds its tuning.
    fn next_scene(&mut self, next: NextScene) -> [Option<Retired>; 2] {
        let mut scene = next.scene;
        let goes_on = next.is_edited && scene.has_arrays_of(&self.scene);
        let recording = if goes_on { None } else { self.end_recording() };
        if !next.is_edited || scene.n_displays() != self.scene.n_displays() {
            self.fingers.forget();
        }
        if next.is_edited {
            // A device that asks before the next tick feels the last pose on the new scene.
            scene.renderer.go_on_from(&self.scene.renderer);
        } else {
            if self.track.position().is_none() && self.playable.is_none() {
                self.pose = Pose {
                    position: scene.start(),
                    ..self.pose.at_rest()
                };
            }
            self.rendered = self.pose.at_rest();
        }
        let retired = std::mem::replace(&mut self.scene, scene);
        self.in_place.stylus.is_over |= !next.is_edited;
        self.render_again();
        [recording, Some(Retired::Scene(retired))]
    }

    /// Counts a change of what a display that stands still shows, or its refusal.
    fn revise(&mut self, outcome: Result<(), RenderError>, say: Say<'_>) {
        match outcome {
            Ok(()) => self.revision += 1,
            Err(error) => {
                self.ignored += 1;
                say(Notice::GainIgnored(error));
            }
        }
    }

    pub(super) fn set_source(&mut self, source: Option<Box<dyn PointerInput>>) -> Option<Retired> {
        self.track.forget();
        self.fingers.forget();
        self.last_angle_deg = None;
        self.has_ended = false;
        self.pose = self.pose.at_rest();
        std::mem::replace(&mut self.playable, source).map(Retired::Source)
    }

    fn set_angle(&mut self, angle_deg: f64, say: Say<'_>) {
        if angle_deg.is_finite() {
            self.angle_deg = angle_deg;
        } else {
            self.ignored += 1;
            say(Notice::Refused(
                "the display's angle is not finite; it stays as it was",
            ));
        }
    }
}
