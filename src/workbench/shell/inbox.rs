//! Inboxes: what the engine, other threads, the keyboard and the desktop have to say, taken in once
//! a frame before anything is drawn.

use std::time::Duration;

use eframe::egui;

use crate::bench::command::{Command, FileCommand};
use crate::bench::job::{Job, Polled};
use crate::bench::opening::Opening;
use crate::bench::{Bench, FRAME, query};
use crate::shell::dialogs::Answer;
use selvedge_device::BridgeState;
use selvedge_engine::{Notice, TICKS_PER_S};

/// At most as many notices are taken in a frame as anybody can be told of.
const MOST_NOTICES: usize = 64;

impl Bench {
    /// Empties the inboxes.
    pub(crate) fn take_news(&mut self, ctx: &egui::Context) {
        if self.is_stepped {
            self.step_engine(ctx);
        }
        self.take_files(ctx);
        self.poll_prepared(ctx);
        self.transient.comparison.poll();
        self.poll_import(ctx);
        self.transient.picturing.poll();
        self.transient.analysing.poll();
        self.take_notices();
        self.take_snapshot(ctx);
        self.take_recording();
        self.poll_experiment(ctx);
        self.follow_array(ctx);
        if !self.engine.is_running() {
            let words = "The engine has stopped and the device with it: save the scene and start \
                         the program again";
            self.transient.notices.give(words);
        }
        self.keep_settings();
        let now_s = ctx.input(|input| input.time);
        if let Some(wait_s) = self.settings.save_if_changed(now_s) {
            ctx.request_repaint_after(Duration::from_secs_f64(wait_s));
        }
        if let Some(complaint) = self.settings.take_failure() {
            self.transient.notices.give(complaint);
        }
    }

    /// Scenes, recordings and paths that other threads bring.
    fn take_files(&mut self, ctx: &egui::Context) {
        if let Some(outcome) = self.transient.opening.as_ref().and_then(Opening::poll) {
            self.transient.opening = None;
            self.take_opened(outcome);
        }
        match self.transient.reading.as_ref().map(Job::poll) {
            Some(Polled::Done(outcome)) => {
                self.transient.reading = None;
                self.take_take(outcome);
            }
            Some(Polled::BrokeOff) => self.transient.reading = None,
            Some(Polled::Working) | None => {}
        }
        match self.transient.saving.as_ref().map(Job::poll) {
            Some(Polled::Done(outcome)) => {
                self.transient.saving = None;
                self.take_saved(outcome);
            }
            Some(Polled::BrokeOff) => self.transient.saving = None,
            Some(Polled::Working) | None => {}
        }
        self.poll_kept(ctx);
        self.poll_exports(ctx);
        self.poll_clips();
        self.poll_sources();
        self.poll_lab(ctx);
        self.transient.ports.poll();
        if let Some(failure) = self.transient.folders.poll() {
            self.transient.notices.give(failure);
        }
        self.poll_measuring();
        self.rest_collection();
        match self.transient.dialogs.poll() {
            Some(Answer::Path(purpose, path)) => {
                self.dispatch(ctx, FileCommand::Use(purpose, path).into());
            }
            Some(Answer::NoPortal(purpose)) => self.show_field(purpose),
            Some(Answer::Cancelled) | None => {}
        }
    }

    fn take_notices(&mut self) {
        for _ in 0..MOST_NOTICES {
            let Some(notice) = self.engine.next_notice() else {
                break;
            };
            self.hear_of_array(&notice);
            let n_expected = &mut self.transient.n_expected_refusals;
            if matches!(notice, Notice::Refused(_)) && *n_expected > 0 {
                *n_expected -= 1;
                continue;
            }
            let device = self.transient.target.as_deref().unwrap_or("The device");
            if let Some(sentence) = query::words(&notice, device) {
                self.transient.notices.give(sentence);
            }
        }
    }

    fn take_snapshot(&mut self, ctx: &egui::Context) {
        while let Some(glimpse) = self.engine.next_tick_sample() {
            self.transient.history.take(glimpse);
        }
        let snapshot = self.engine.snapshot();
        let transient = &mut self.transient;
        if let Some(held) = &mut transient.experiment.held {
            held.vibration = snapshot.vibration;
        }
        let status = snapshot.link.and_then(|link| link.status);
        let is_lost = snapshot
            .link
            .is_some_and(|link| link.state == BridgeState::Lost);
        let uid = snapshot
            .link
            .and_then(|link| link.caps)
            .map(|caps| caps.uid);
        if let Some(found) = transient.ports.follow(ctx, is_lost, uid) {
            transient
                .notices
                .give(crate::tools::bridge::back::notice(&found));
        }
        let interval_s = transient.interval.take(status.map(|s| (s.tick, s.dev_us)));
        transient.reference_db = snapshot.rendering.compression_reference_db;
        let mut live = query::live_view(snapshot, interval_s, &transient.mute_solo);
        if let Some(bridge) = &mut live.bridge
            && let Some(log) = self.engine.session_log()
        {
            bridge.timing.log = Some(log.path().display().to_string());
            bridge.timing.log_failure = log.failure();
        }
        if live.bridge.is_none() {
            live.bridge.clone_from(&transient.pictured_bridge);
        }
        let largest = live.dots.iter().flat_map(|dot| dot.amplitude_um);
        let largest_um = largest.fold(0.0, f64::max);
        self.workspace.scale = self.workspace.scale.following(largest_um);
        if live.centre.is_some() && live.speed_mm_per_s > 0.0 {
            self.workspace.probe = self.workspace.probe.after(live.pose.velocity);
        }
        if transient.trail.take(live.tick, live.centre) {
            ctx.request_repaint_after(FRAME);
        }
        transient.live = live;
    }

    /// Lets a stepped engine do the ticks that are due by the toolkit's clock.
    fn step_engine(&mut self, ctx: &egui::Context) {
        let due = ctx.input(|input| input.time) * TICKS_PER_S;
        while (self.transient.live.tick as f64) + 1.0 <= due {
            let Some(now) = self.engine.advance_ticks(1) else {
                return;
            };
            self.now = now;
            let tick = self.engine.snapshot().tick;
            if tick <= self.transient.live.tick {
                return;
            }
            self.transient.live.tick = tick;
        }
    }

    /// Whether the keyboard went to another program.
    fn is_keyboard_lost(&mut self, ctx: &egui::Context) -> bool {
        let window = &mut self.transient.experiment.window;
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
        let moment = &mut self.transient.moment;
        ctx.input(|input| {
            moment.press += u64::from(input.pointer.any_pressed());
            moment.is_down = input.pointer.any_down();
            moment.t_s = input.time;
        });
        let is_watched =
            self.settings.preferences.stops_on_focus_loss && self.transient.live.is_armed();
        if is_watched && self.is_keyboard_lost(ctx) {
            self.dispatch(ctx, Command::AllOff);
        }
        let is_held = self.transient.experiment.is_held();
        for command in crate::shell::keys::pressed(ctx) {
            // A participant who presses a key is told nothing of what it does elsewhere.
            if is_held && command != Command::AllOff {
                continue;
            }
            self.dispatch(ctx, command);
        }
    }

    /// A window that would lose changes asks before it closes; the device has stopped already.
    pub(crate) fn take_close_request(&mut self, ctx: &egui::Context) {
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        if is_asked && !self.transient.may_close && self.document.is_edited() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.dispatch(ctx, FileCommand::Close.into());
        }
    }

    /// Keeps what the user chose.
    pub(crate) fn keep_settings(&mut self) {
        let kept = &mut self.settings.preferences;
        kept.amplitude = self.workspace.scale;
        kept.dots = self.workspace.dot_style;
        kept.greys_below = self.workspace.greys_below;
        kept.overlays = self.workspace.overlays;
        kept.pixels_per_mm = self.workspace.true_pixels_per_mm;
        let form = &self.transient.experiment.form;
        kept.sessions_folder = form.kept_folder();
        kept.design = form.chosen.word();
    }
}
