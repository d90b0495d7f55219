//! Inboxes: what the engine, other threads, the keyboard and the desktop have to say, taken in once
//! a frame before anything is drawn.

use std::sync::atomic::Ordering;
use std::time::Duration;

use eframe::egui;

use crate::bench::FRAME;
use crate::bench::command::{Command, FileCommand};
use crate::bench::keys;
use crate::bench::pane::Pane;
use crate::shell::dialogs::Answer;
use crate::shell::window::Workbench;

/// The keyboard may be on its way from one window to the other for so long, s.
const PASSING_S: f64 = 0.25;

impl Workbench {
    /// Empties the inboxes.
    pub(crate) fn take_news(&mut self, ctx: &egui::Context) {
        let in_sight = Pane::ALL.into_iter().filter(|pane| self.shell.shows(*pane));
        self.bench.in_sight = in_sight.collect();
        self.bench.take_news(ctx);
        self.poll_exports();
        match self.shell.dialogs.poll() {
            Some(Answer::Path(purpose, path)) => {
                self.dispatch(FileCommand::Use(purpose, path).into());
            }
            Some(Answer::NoPortal(purpose)) => self.show_field(purpose),
            Some(Answer::Cancelled) | None => {}
        }
        for tool in self.tools.iter_mut() {
            tool.logic(&mut self.bench);
        }
        self.settle();
        self.follow_unsaved(ctx);
        self.keep_settings();
        let now_s = self.bench.clock.now_s();
        if let Some(wait_s) = self.bench.settings.save_if_changed(now_s) {
            ctx.request_repaint_after(Duration::from_secs_f64(wait_s));
        }
        if let Some(complaint) = self.bench.settings.take_failure() {
            self.bench.notices.give(complaint);
        }
    }

    /// Whether the keyboard went to another program.
    fn is_keyboard_lost(&mut self, ctx: &egui::Context) -> bool {
        let since_s = &mut self.shell.keyboard.left_since_s;
        if !self.bench.session.has_window {
            *since_s = None;
            // As it is, not as events tell: they wait for a frame, which a window that is not shown
            // does not get.
            return ctx.input(|input| !input.raw.focused);
        }
        let has_any = ctx.input(|input| {
            let mut windows = input.raw.viewports.values();
            windows.any(|window| window.focused == Some(true))
        });
        let wait_s = left_alone_s(since_s, self.bench.clock.now_s(), has_any);
        if wait_s.is_some_and(|wait_s| wait_s > 0.0) {
            ctx.request_repaint_after(FRAME);
        }
        wait_s.is_some_and(|wait_s| wait_s <= 0.0)
    }

    /// What was pressed on the keyboard.
    pub(crate) fn take_keys(&mut self, ctx: &egui::Context) {
        let moment = &mut self.bench.pointer.moment;
        ctx.input(|input| {
            moment.press += u64::from(input.pointer.any_pressed());
            moment.is_down = input.pointer.any_down();
            moment.t_s = input.time;
        });
        let is_watched =
            self.bench.settings.preferences.stops_on_focus_loss && self.bench.live.is_armed();
        if is_watched && self.is_keyboard_lost(ctx) {
            self.dispatch(Command::AllOff);
        }
        // While a session is held every other key is an answer, and does nothing elsewhere; one
        // that is to be given to an act does nothing yet.
        let takes_all = self.bench.has_session() || self.shell.awaits_key();
        let pressed = if takes_all {
            keys::escape(ctx).into_iter().collect()
        } else {
            keys::pressed(ctx)
        };
        for command in pressed {
            self.dispatch(command);
        }
    }

    /// A window that would lose changes asks before it closes; the device has stopped already. One
    /// that is told to end by a signal asks nobody: everything stays for the next start.
    pub(crate) fn take_close_request(&mut self, ctx: &egui::Context) {
        if self.shell.ends.load(Ordering::Relaxed) {
            self.bench.files.recovery.keeps = true;
            self.shell.may_close = true;
        }
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        if is_asked && !self.shell.may_close && !self.unsaved().is_empty() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.dispatch(FileCommand::Close.into());
        }
    }

    /// Keeps what the user chose.
    pub(crate) fn keep_settings(&mut self) {
        self.bench.keep_settings();
        for tool in self.tools.iter() {
            tool.keep_preferences(&mut self.bench.settings.preferences);
        }
    }
}

/// How long the windows must still be without the keyboard until another program is sure to have
/// it, s; `None` while one of them has it.
fn left_alone_s(since_s: &mut Option<f64>, now_s: f64, has_keyboard: bool) -> Option<f64> {
    if has_keyboard {
        *since_s = None;
        return None;
    }
    let since_s = *since_s.get_or_insert(now_s);
    Some((since_s + PASSING_S - now_s).max(0.0))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::left_alone_s;
    use crate::shell::headless::Headless;

    #[test]
    fn the_keyboard_is_lost_only_when_neither_window_has_it_for_a_while() {
        let mut since_s = None;
        assert_eq!(left_alone_s(&mut since_s, 1.0, true), None);
        let wait_s = left_alone_s(&mut since_s, 1.1, false).unwrap();
        assert!((wait_s - 0.25).abs() < 1e-12);
        let it_went_to_the_other = left_alone_s(&mut since_s, 1.2, true);
        assert_eq!(it_went_to_the_other, None);
        assert!(left_alone_s(&mut since_s, 2.0, false).unwrap() > 0.0);
        assert_eq!(left_alone_s(&mut since_s, 2.3, false), Some(0.0));
    }

    #[test]
    fn a_keyboard_that_left_both_windows_is_missed_where_neither_is_shown() {
        let mut window = Headless::shipped();
        window.pass(2);
        let (ctx, workbench) = (window.ctx.clone(), &mut window.workbench);
        workbench.bench.session.has_window = true;
        assert!(!workbench.is_keyboard_lost(&ctx), "it may be on its way");
        // The look after the last frame, and one a second later: no frame, and the toolkit's clock
        // stands still.
        workbench.bench.clock.look(&ctx);
        assert!(!workbench.is_keyboard_lost(&ctx));
        workbench.bench.clock.unseen_for(Duration::from_secs(1));
        workbench.bench.clock.look(&ctx);
        assert!(workbench.is_keyboard_lost(&ctx));
    }
}
