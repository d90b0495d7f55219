//! What Esc does. While a device may move, or a session is held, everything is off at once. With
//! nothing armed it puts away what lies on top, and if nothing does, it pauses what moves by
//! itself: the screen goes on.

use eframe::egui::Popup;

use crate::bench::command::Command;
use crate::shell::window::Workbench;

impl Workbench {
    /// Does what Esc does now.
    pub(crate) fn escape(&mut self) {
        if self.bench.live.is_armed() || self.bench.has_session() {
            return self.dispatch(Command::AllOff);
        }
        if self.shell.leave_key() {
            return;
        }
        let is_open = self.tools.iter().any(|tool| tool.is_open(&self.bench));
        if self.shell.is_covered() || is_open {
            return self.dispatch(Command::Dismiss);
        }
        // The toolkit closes menus, and ends the typing, on the same key.
        if Popup::is_any_open(&self.bench.ctx) || self.shell.keyboard.was_typing {
            return;
        }
        let play = self.bench.live.play;
        if play.moves_by_itself() && play.is_playing {
            self.bench.send(selvedge_engine::Command::Pause);
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers};

    use super::*;
    use crate::bench::command::{PlayCommand, ShowCommand};
    use crate::bench::recording::Recordings;
    use crate::bench::view::Source;
    use crate::shell::headless::Headless;
    use selvedge_scratch::ScratchFolder;

    fn loudest_um(window: &Headless) -> f64 {
        let levels = window.workbench.amplitudes_um();
        levels.into_iter().flatten().fold(0.0, f64::max)
    }

    #[test]
    fn with_nothing_armed_escape_pauses_the_screen_shows_on_and_recording_begins() {
        let root = ScratchFolder::made("escape");
        let mut window = Headless::drawn();
        let recordings = &mut window.workbench.bench.exploration.recordings;
        *recordings = Recordings::in_folder(root.to_owned());
        window.press(Modifiers::NONE, Key::Space);
        window.pass_ticks(20);
        window.press(Modifiers::NONE, Key::Escape);
        let bench = &window.workbench.bench;
        assert!(!bench.live.is_stopped && !bench.live.play.is_playing);
        assert!(
            loudest_um(&window) > 0.1,
            "what it felt last is still shown"
        );
        window.press(Modifiers::NONE, Key::Space);
        window.press(Modifiers::NONE, Key::R);
        window.pass_ticks(20);
        assert!(loudest_um(&window) > 0.1 && window.workbench.is_recording());
        window.press(Modifiers::NONE, Key::R);
        window.pass(2);
        let recordings = window.workbench.bench.exploration.recordings.entries();
        let [n_ticks, n_felt] = recordings[0].about.ticks.unwrap();
        assert!(n_ticks > 15 && n_felt == 0, "{n_felt} of {n_ticks}: shown");
        let recording = window.workbench.bench.exploration.at_hand.as_ref().unwrap();
        let is_loud = |um: &[f32; 2]| um[0] > 0.1 || um[1] > 0.1;
        let mut ticks = (0..n_ticks).filter_map(|tick| recording.amplitudes_um(tick));
        assert!(
            ticks.any(|ticks_um| ticks_um.iter().any(is_loud)),
            "as shown"
        );
        assert!(window.workbench.notices().is_empty());
    }

    #[test]
    fn escape_closes_what_lies_on_top_before_it_pauses() {
        let mut window = Headless::drawn();
        window.press(Modifiers::NONE, Key::Space);
        window.dispatch(ShowCommand::Help);
        window.dispatch(ShowCommand::Calibrate);
        window.pass(2);
        window.press(Modifiers::NONE, Key::Escape);
        assert!(window.workbench.shell.cover.is_none());
        assert!(window.workbench.bench.live.play.is_playing);
        window.press(Modifiers::NONE, Key::Escape);
        assert!(!window.workbench.bench.live.play.is_playing);
    }

    #[test]
    fn after_all_off_one_act_goes_on() {
        let mut window = Headless::drawn();
        window.dispatch(PlayCommand::Toggle);
        window.pass_ticks(10);
        window.dispatch(Command::AllOff);
        window.pass(3);
        assert!(window.workbench.is_stopped() && loudest_um(&window) == 0.0);
        window.dispatch(crate::bench::command::DeviceCommand::GoOn);
        window.pass_ticks(10);
        assert!(!window.workbench.is_stopped() && loudest_um(&window) > 0.1);
        assert_eq!(window.workbench.bench.live.play.source, Source::Stroke);
        assert!(window.workbench.notices().is_empty());
    }
}
