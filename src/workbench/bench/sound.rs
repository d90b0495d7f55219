//! The sound of what is felt, as the user switched it: a stream while it is on, none otherwise.
//!
//! It is off while a session of an experiment is held, since sound changes what is felt and gives
//! answers away, and wherever the toolkit's clock drives the engine. Where the system plays nothing
//! one notice says so; the rest stands at the button.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::bench::{Bench, FRAME};
use selvedge_engine::{Command, SoundOutput, SoundState, sonification};

/// Sound, as far as it was begun.
#[derive(Debug, Default)]
pub(crate) struct Sound {
    output: Option<Output>,
    /// Whether the user knows why nothing is heard.
    is_told: bool,
}

/// What plays.
#[derive(Debug)]
struct Output {
    output: SoundOutput,
    as_driven: Arc<AtomicBool>,
}

impl Sound {
    /// How it stands with what plays, if anything is to.
    pub(crate) fn state(&self) -> Option<SoundState> {
        self.output.as_ref().map(|playing| playing.output.state())
    }
}

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
        playing.output.set_level(chosen.loudness.share());
        playing.as_driven.store(chosen.as_driven, Ordering::Relaxed);
        match playing.output.state() {
            SoundState::Opening => self.ctx.request_repaint_after(FRAME),
            SoundState::Playing(_) => sound.is_told = false,
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
