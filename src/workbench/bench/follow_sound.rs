//! Lets sound follow what the user chose.
//!
//! It is off while a session of an experiment is held, since sound changes what is felt and gives
//! answers away, and wherever the toolkit's clock drives the engine. Where the system plays nothing
//! one notice says so; the rest stands at the button.

use crate::bench::notices::Until;
use crate::bench::on_finger::OnFinger;
use crate::bench::sound::{Heard, Sound};
use crate::bench::{Bench, FRAME};
use selvedge_device::Coder;
use selvedge_engine::{
    Command, SoundOutput, SoundState, StereoLevels, sonification, stereo_levels,
};
use selvedge_foundation::numerics::to_single;

impl Bench {
    /// Lets sound follow what the user chose. To be called every frame.
    pub(crate) fn follow_sound(&mut self) {
        let chosen = self.settings.preferences.sound;
        let is_wanted = chosen.is_on && !self.has_session() && !self.is_stepped();
        match (self.device.sound.playing.is_some(), is_wanted) {
            (false, true) => self.begin_sound(),
            (true, false) => {
                self.device.sound = Sound::default();
                self.send(Command::SetSound(None));
            }
            _ => {}
        }
        let (alone, scrubbed) = (self.heard_alone(), self.scrubbed_levels());
        let sound = &mut self.device.sound;
        let Some((output, control)) = &mut sound.playing else {
            return;
        };
        let level = if sound.of_display == Heard::Nothing {
            0.0
        } else {
            chosen.loudness.share()
        };
        output.set_level(level);
        control.choose(chosen.as_driven, alone);
        control.scrub(scrubbed);
        match output.state() {
            SoundState::Opening => self.ctx.request_repaint_after(FRAME),
            SoundState::Playing { .. } => sound.is_told = false,
            SoundState::Absent(why) => {
                if !std::mem::replace(&mut sound.is_told, true) {
                    let words = format!("Nothing is heard (tried again every 2 s): {why}");
                    self.notices.give_until(Until::Heard, words);
                }
            }
        }
    }

    /// The contactor that alone is heard, if one is.
    pub(crate) fn heard_alone(&self) -> Option<usize> {
        let is_alone =
            self.settings.preferences.sound.is_on && self.device.sound.of_display == Heard::Alone;
        self.selection.contactor.filter(|_| is_alone)
    }

    /// Lets the chosen contactor alone be heard, and what was off with it, or all of them again.
    pub(crate) fn hear_alone(&mut self, is_alone: bool) {
        self.device.sound.of_display = if is_alone { Heard::Alone } else { Heard::All };
        self.settings.preferences.sound.is_on |= is_alone;
    }

    /// What is heard of the tick that every view shows, while the line of time is dragged.
    pub(crate) fn scrubbed_levels(&mut self) -> Option<StereoLevels> {
        if !std::mem::take(&mut self.device.sound.is_scrubbed) {
            return None;
        }
        let dots = &self.live.dots;
        let coder = Coder::new(self.engine.profile(), dots.len());
        let contactors = dots.iter().enumerate().map(|(index, dot)| {
            let felt = [0, 1].map(|band| match dot.on_finger[band] {
                OnFinger::Muted => 0.0,
                _ => to_single(dot.amplitude_um[band]),
            });
            (dot.position.x_mm, coder.limited_um(index, felt))
        });
        let centre_mm = self.document.scene().size_mm[0] / 2.0;
        let middles_mm = [self.live.pose.position.x_mm, centre_mm];
        Some(stereo_levels(middles_mm, contactors, self.heard_alone()))
    }

    fn begin_sound(&mut self) {
        let (feed, sonifier, control) = sonification();
        match SoundOutput::open(Box::new(sonifier)) {
            Ok(output) => {
                self.device.sound.playing = Some((output, control));
                self.send(Command::SetSound(Some(Box::new(feed))));
            }
            Err(error) => {
                self.settings.preferences.sound.is_on = false;
                self.notices.give(error.to_string());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::bench::Drive;
    use crate::bench::command::ShowCommand;
    use crate::bench::settings::preferences::{Loudness, SoundPreferences};
    use crate::shell::window::Workbench;

    #[test]
    fn what_is_chosen_of_sound_is_kept_and_a_stepped_window_opens_nothing() {
        let ctx = eframe::egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        let first = window.bench.settings.preferences.sound;
        assert_eq!(first, SoundPreferences::default());
        assert!(!first.is_on && first.loudness.share() == 0.6);
        for command in [
            ShowCommand::ToggleSound,
            ShowCommand::Loudness(Loudness::Loud),
            ShowCommand::ToggleAsDriven,
        ] {
            window.dispatch(command.into());
        }
        let chosen = SoundPreferences {
            is_on: true,
            loudness: Loudness::Loud,
            as_driven: true,
        };
        assert_eq!(window.bench.settings.preferences.sound, chosen);
        window.bench.follow_sound();
        assert_eq!(window.bench.device.sound.state(), None);
    }

    #[test]
    fn one_contactor_alone_is_heard_until_all_are_or_sound_is_off() {
        let ctx = eframe::egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        window.bench.hear_alone(true);
        assert!(window.bench.settings.preferences.sound.is_on);
        window.dispatch(ShowCommand::SelectContactor(3).into());
        assert_eq!(window.bench.heard_alone(), Some(3), "the chosen one");
        window.dispatch(ShowCommand::ToggleSound.into());
        assert_eq!(window.bench.heard_alone(), None, "nothing is heard");
        window.bench.hear_alone(true);
        window.bench.hear_alone(false);
        assert_eq!(window.bench.heard_alone(), None);
        assert!(window.bench.settings.preferences.sound.is_on, "all are");
    }
}
