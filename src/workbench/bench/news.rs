//! What the engine and other threads have to say, taken in once a frame before anything is drawn.

use eframe::egui;

use crate::bench::{Bench, FRAME, query};
use selvedge_engine::{Notice, TICKS_PER_S};

/// At most as many notices are taken in a frame as anybody can be told of.
const MOST_NOTICES: usize = 64;

impl Bench {
    /// Takes what engine and threads have to say.
    pub(crate) fn take_news(&mut self, ctx: &egui::Context) {
        if self.is_stepped() {
            self.step_engine(ctx);
        }
        self.take_files();
        self.poll_library();
        self.poll_clips();
        self.poll_sources();
        if let Some(failure) = self.files.folders.poll() {
            self.notices.give(failure);
        }
        self.poll_prepared();
        self.take_notices();
        self.take_snapshot(ctx);
        self.poll_recordings();
        self.follow_array(ctx);
        if !self.engine.is_running() {
            let words = "The engine has stopped and the device with it: save the scene and start \
                         the program again";
            self.notices.give(words);
        }
    }

    fn take_notices(&mut self) {
        for _ in 0..MOST_NOTICES {
            let Some(notice) = self.engine.next_notice() else {
                break;
            };
            self.hear_of_array(&notice);
            let n_expected = &mut self.device.n_expected_refusals;
            if matches!(notice, Notice::Refused(_)) && *n_expected > 0 {
                *n_expected -= 1;
                continue;
            }
            let device = self.device.target.as_deref().unwrap_or("The device");
            if let Some(sentence) = query::words(&notice, device) {
                self.notices.give(sentence);
            }
        }
    }

    fn take_snapshot(&mut self, ctx: &egui::Context) {
        while let Some(tick_sample) = self.engine.next_tick_sample() {
            self.past.history.take(tick_sample);
        }
        let snapshot = self.engine.snapshot();
        let status = snapshot.link.and_then(|link| link.status);
        let interval_s = self
            .device
            .interval
            .take(status.map(|s| (s.tick, s.dev_us)));
        let mut live = query::live_view(snapshot, interval_s, &self.selection.mute_solo);
        if let Some(bridge) = &mut live.bridge
            && let Some(log) = self.engine.session_log()
        {
            bridge.timing.log = Some(log.path().display().to_string());
            bridge.timing.log_failure = log.failure();
        }
        if live.bridge.is_none() {
            live.bridge.clone_from(&self.device.pictured);
        }
        let largest = live.dots.iter().flat_map(|dot| dot.amplitude_um);
        let largest_um = largest.fold(0.0, f64::max);
        self.selection.scale = self.selection.scale.following(largest_um);
        if live.centre.is_some() && live.speed_mm_per_s > 0.0 {
            self.selection.probe = self.selection.probe.after(live.pose.velocity);
        }
        if self.past.trail.take(live.tick, live.centre) {
            ctx.request_repaint_after(FRAME);
        }
        self.live = live;
    }

    /// Lets a stepped engine do the ticks that are due by the toolkit's clock.
    fn step_engine(&mut self, ctx: &egui::Context) {
        let due = ctx.input(|input| input.time) * TICKS_PER_S;
        while (self.live.tick as f64) + 1.0 <= due {
            let Some(now) = self.engine.advance_ticks(1) else {
                return;
            };
            self.stepped_at = Some(now);
            let tick = self.engine.snapshot().tick;
            if tick <= self.live.tick {
                return;
            }
            self.live.tick = tick;
        }
    }

    /// Keeps what the user chose.
    pub(crate) fn keep_settings(&mut self) {
        let kept = &mut self.settings.preferences;
        kept.amplitude = self.selection.scale;
        kept.dots = self.selection.dot_style;
        kept.greys_below = self.selection.greys_below;
    }
}
