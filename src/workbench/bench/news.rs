//! What the engine and other threads have to say, taken in once a frame before anything is drawn.

use eframe::egui;

use crate::bench::{Bench, FRAME, query};
use selvedge_engine::{Notice, TICKS_PER_S};

/// At most as many notices are taken in a frame as anybody can be told of.
const MOST_NOTICES: usize = 64;

impl Bench {
    /// Takes what engine and threads have to say.
    pub(crate) fn take_news(&mut self, ctx: &egui::Context) {
        if self.is_stepped {
            self.step_engine(ctx);
        }
        self.take_files();
        self.poll_kept();
        self.poll_clips();
        self.poll_sources();
        if let Some(failure) = self.transient.folders.poll() {
            self.transient.notices.give(failure);
        }
        self.poll_prepared();
        self.take_notices();
        self.take_snapshot(ctx);
        self.ended_recording = self.engine.take_recording();
        self.follow_array(ctx);
        if !self.engine.is_running() {
            let words = "The engine has stopped and the device with it: save the scene and start \
                         the program again";
            self.transient.notices.give(words);
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
        let status = snapshot.link.and_then(|link| link.status);
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

    /// Keeps what the user chose.
    pub(crate) fn keep_settings(&mut self) {
        let kept = &mut self.settings.preferences;
        kept.amplitude = self.workspace.scale;
        kept.dots = self.workspace.dot_style;
        kept.greys_below = self.workspace.greys_below;
    }
}
