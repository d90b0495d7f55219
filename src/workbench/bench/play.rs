//! What moves the display, recording it, and what may be felt through it in place of the scene.

use std::ops::Range;

use crate::bench::Bench;
use crate::bench::command::{PlayCommand, PlaySource};
use crate::bench::notices::Until;
use crate::bench::view::Source;
use selvedge_engine::{ClothDrive, InputSource};
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{Scene, Stroke};
use selvedge_render::stylus::StylusDrive;

/// How fast the display explores by itself, mm/s.
const STROKE_MM_PER_S: f64 = 120.0;

impl Bench {
    pub(crate) fn dispatch_play(&mut self, command: PlayCommand) {
        match command {
            PlayCommand::Toggle => self.toggle_play(),
            PlayCommand::Source(PlaySource::Pointer) => {
                self.send(selvedge_engine::Command::SetSource(InputSource::Pointer));
            }
            PlayCommand::Source(PlaySource::Stroke) => self.explore_alone(),
            PlayCommand::Source(PlaySource::Recording) => self.replay(),
            // Opening one takes a thread: `choose_input` does it.
            PlayCommand::Source(PlaySource::Input) => {}
            PlayCommand::Step => self.send(selvedge_engine::Command::Step),
            PlayCommand::Rewind => self.send(selvedge_engine::Command::Rewind),
            PlayCommand::Seek(tick) => self.send(selvedge_engine::Command::Seek(tick)),
            PlayCommand::LookBack(column) => self.look_back_to(column),
            PlayCommand::ReplayAt(tick) => self.seek_in_take(tick),
            PlayCommand::LoopWithin(ticks) => self.loop_within(ticks),
            PlayCommand::Mark => self.mark_here(),
            PlayCommand::Loop(does_loop) => {
                self.exploration.does_loop = does_loop;
                self.send(selvedge_engine::Command::SetLoop(does_loop));
            }
            PlayCommand::ToggleLoop => {
                self.dispatch_play(PlayCommand::Loop(!self.exploration.does_loop));
            }
            PlayCommand::ToggleRecording => self.toggle_recording(),
            PlayCommand::Turn(by_deg) => self.send(selvedge_engine::Command::TurnBy(by_deg)),
            PlayCommand::TurnBack => self.send(selvedge_engine::Command::SetAngle(0.0)),
        }
    }

    /// Takes positions from the tablet or program that was chosen last.
    pub(crate) fn choose_input(&mut self) {
        if let Some(chosen) = self.exploration.sources.chosen().cloned() {
            self.dispatch_source(chosen);
        } else {
            let words = "Choose a tablet in the Bridge pane first";
            self.notices.give_until(Until::InputChosen, words);
        }
    }

    /// What can be played plays or is held; the pointer gives way to a stroke.
    fn toggle_play(&mut self) {
        match self.live.play.source {
            Source::Pointer | Source::Lines | Source::Device => self.explore_alone(),
            Source::Stroke | Source::Recording => {
                let play = if self.live.play.is_playing {
                    selvedge_engine::Command::Pause
                } else {
                    selvedge_engine::Command::Play
                };
                self.send(play);
            }
        }
    }

    /// Shows a tick of the recording at hand, whatever moved the display before.
    fn seek_in_take(&mut self, tick: u64) {
        if self.exploration.at_hand.is_none() {
            return;
        }
        if self.live.play.source != Source::Recording {
            self.replay();
        }
        self.send(selvedge_engine::Command::Seek(tick));
    }

    fn loop_within(&mut self, ticks: Option<Range<u64>>) {
        let ends = ticks.as_ref().map(|ticks| [ticks.start, ticks.end - 1]);
        self.send(selvedge_engine::Command::LoopWithin(ends));
        if let Some([first, _]) = ends {
            self.dispatch_play(PlayCommand::Loop(true));
            self.dispatch_play(PlayCommand::Seek(first));
            self.send(selvedge_engine::Command::Play);
        }
        self.exploration.loop_within = ticks;
    }

    /// Lets the engine feel a stylus, told in a line, or the array; the log of links hears which.
    pub(crate) fn feel_stylus(&mut self, stylus: Option<(StylusDrive, String)>) {
        let (drive, words) = stylus.unzip();
        self.send(selvedge_engine::Command::SetStylus(drive.map(Box::new)));
        let before = std::mem::replace(&mut self.device.stylus, words.clone());
        self.say_felt("stylus", [before, words]);
    }

    /// Lets the engine feel a cloth that hangs, told in a line, or the scene again; the log of
    /// links hears which.
    pub(crate) fn feel_cloth(&mut self, cloth: Option<(ClothDrive, String)>) {
        let (drive, words) = cloth.unzip();
        self.send(selvedge_engine::Command::SetCloth(drive.map(Box::new)));
        let before = std::mem::replace(&mut self.device.cloth, words.clone());
        self.say_felt("cloth", [before, words]);
    }

    /// The log of links hears what is felt in place of the rest, where that changed.
    fn say_felt(&mut self, what: &'static str, [before, now]: [Option<String>; 2]) {
        if before != now {
            self.engine
                .say_what(what, now.unwrap_or_else(|| "off".to_owned()));
        }
    }

    fn explore_alone(&mut self) {
        let stroke = resting_stroke(self.document.scene());
        self.send(selvedge_engine::Command::SetSource(InputSource::Stroke(
            stroke,
        )));
        self.send(selvedge_engine::Command::Play);
    }
}

/// The stroke that the display explores a scene with: a circle around its middle.
pub(crate) fn resting_stroke(scene: &Scene) -> Stroke {
    let [width_mm, height_mm] = scene.size_mm;
    Stroke::Circle {
        centre: Point::new(width_mm / 2.0, height_mm / 2.0),
        radius_mm: 0.25 * width_mm.min(height_mm),
        speed_mm_per_s: STROKE_MM_PER_S,
    }
}
