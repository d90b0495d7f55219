//! Lets sound follow what the user chose.
//!
//! It is off while a session of an experiment is held, since sound changes what is felt and gives
//! answers away, and wherever the toolkit's clock drives the engine. Where the system plays nothing
//! one notice says so; the rest stands at the button.

use std::sync::atomic::Ordering;

use crate::bench::sound::{Output, Sound};
use crate::bench::{Bench, FRAME};
use selvedge_engine::{Command, SoundOutput, SoundState, sonification};

impl Bench {
    /// Lets sound follow what the user chose. To be called every frame.
    pub(crate) fn follow_sound(&mut self) {
        let chosen = self.settings.preferences.sound;
        let is_wanted = chosen.is_on && !self.has_session() && !self.is_stepped();
        match (self.device.sound.output.is_some(), is_wanted) {
            (false, true) => self.begin_sound(),
            (true, false) => {
                self.device.sound = Sound::default();
                self.send(Command::SetSound(None));
            }
            _ => {}
        }
        let sound = &mut self.device.sound;
        let Some(playing) = &sound.output else { return };
        let level = if sound.is_held {
            0.0
        } else {
            chosen.loudness.share()
        };
        playing.output.set_level(level);
        playing.as_driven.store(chosen.as_driven, Ordering::Relaxed);
        match playing.output.state() {
            SoundState::Opening => self.ctx.request_repaint_after(FRAME),
            SoundState::Playing { .. } => sound.is_told = false,
            SoundState::Absent(why) => {
                if !std::mem::replace(&mut sound.is_told, true) {
                    self.notices.give(format!("Nothing is heard: {why}"));
                }
            }
        }
    }

    fn begin_sound(&mut self) {
        let (feed, sonifier, as_driven) = sonification();
        match SoundOutput::open(Box::new(sonifier)) {
            Ok(output) => {
                self.device.sound.output = Some(Output { output, as_driven });
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
}
