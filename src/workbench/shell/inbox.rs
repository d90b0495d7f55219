//! Inboxes: what the engine, other threads, the keyboard and the desktop have to say, taken in once
//! a frame before anything is drawn.

use std::time::Duration;

use eframe::egui;

use crate::bench::FRAME;
use crate::bench::command::{Command, FileCommand};
use crate::bench::pane::Pane;
use crate::shell::dialogs::Answer;
use crate::shell::window::Workbench;

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
        self.keep_settings();
        let now_s = ctx.input(|input| input.time);
        if let Some(wait_s) = self.bench.settings.save_if_changed(now_s) {
            ctx.request_repaint_after(Duration::from_secs_f64(wait_s));
        }
        if let Some(complaint) = self.bench.settings.take_failure() {
            self.bench.transient.notices.give(complaint);
        }
    }

    /// Whether the keyboard went to another program.
    fn is_keyboard_lost(&mut self, ctx: &egui::Context) -> bool {
        let window = &mut self.bench.transient.experiment.window;
        if !window.is_open {
            let is_left = |event: &egui::Event| matches!(event, egui::Event::WindowFocused(false));
            return ctx.input(|input| input.events.iter().any(is_left));
        }
        let (now_s, has_any) = ctx.input(|input| {
            let mut windows = input.raw.viewports.values();
            (
                input.time,
                windows.any(|window| window.focused == Some(true)),
            )
        });
        let wait_s = window.left_alone_s(now_s, has_any);
        if wait_s.is_some_and(|wait_s| wait_s > 0.0) {
            ctx.request_repaint_after(FRAME);
        }
        wait_s.is_some_and(|wait_s| wait_s <= 0.0)
    }

    /// What was pressed on the keyboard.
    pub(crate) fn take_keys(&mut self, ctx: &egui::Context) {
        let moment = &mut self.bench.transient.moment;
        ctx.input(|input| {
            moment.press += u64::from(input.pointer.any_pressed());
            moment.is_down = input.pointer.any_down();
            moment.t_s = input.time;
        });
        let is_watched = self.bench.settings.preferences.stops_on_focus_loss
            && self.bench.transient.live.is_armed();
        if is_watched && self.is_keyboard_lost(ctx) {
            self.dispatch(Command::AllOff);
        }
        let is_held = self.bench.transient.experiment.is_held();
        for command in crate::bench::keys::pressed(ctx) {
            // A participant who presses a key is told nothing of what it does elsewhere.
            if is_held && command != Command::AllOff {
                continue;
            }
            self.dispatch(command);
        }
    }

    /// A window that would lose changes asks before it closes; the device has stopped already.
    pub(crate) fn take_close_request(&mut self, ctx: &egui::Context) {
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        if is_asked && !self.shell.may_close && self.bench.document.is_edited() {
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
