//! What the engine and other threads have to say, taken in once a frame before anything is drawn.

use std::time::Duration;

use eframe::egui;

use crate::bench::notices::Until;
use crate::bench::view::BridgePhase;
use crate::bench::{Bench, FRAME, query};
use selvedge_engine::{SoundState, TICKS_PER_S};

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
        self.poll_listening();
        self.poll_clips();
        self.poll_sources();
        if let Some(failure) = self.files.folders.poll() {
            self.notices.give(failure);
        }
        self.poll_prepared();
        self.take_notices();
        self.take_snapshot(ctx);
        self.poll_recordings();
        self.poll_excerpt();
        self.follow_array(ctx);
        self.log_what_is_felt();
        self.follow_sound();
        if !self.engine.is_running() {
            let words = "The engine has stopped and the device with it: save the scene and start \
                         the program again";
            if !self.notices.says(words) {
                self.notices.give(words);
            }
        }
        self.follow_notices(ctx);
    }

    /// Lets notices go whose reason is over.
    fn follow_notices(&mut self, ctx: &egui::Context) {
        let phase = self.live.bridge.as_ref().map(|bridge| bridge.phase);
        let is_armed = phase == Some(BridgePhase::Armed);
        let is_in_time = (self.live.bridge.as_ref()).is_none_or(|bridge| bridge.depth <= 1);
        let (records, has_session) = (self.live.play.is_recording, self.has_session());
        let has_input = self.exploration.sources.chosen().is_some();
        let is_unheard = matches!(self.device.sound.state(), Some(SoundState::Absent(_)));
        let now_s = self.clock.now_s();
        let next_s = self.notices.follow(now_s, |until| match until {
            Until::PutAway | Until::Read => false,
            Until::Armed => is_armed,
            Until::Ready => is_armed || phase == Some(BridgePhase::Ready),
            Until::Recorded => !records,
            Until::SessionOver => !has_session,
            Until::InputChosen => has_input,
            Until::InTime => is_in_time,
            Until::Heard => !is_unheard,
        });
        if let Some(next_s) = next_s {
            ctx.request_repaint_after(Duration::from_secs_f64(next_s));
        }
    }

    fn take_notices(&mut self) {
        for _ in 0..MOST_NOTICES {
            let Some(notice) = self.engine.next_notice() else {
                break;
            };
            self.hear_of_array(&notice);
            let device = self.device.target.as_deref().unwrap_or("The device");
            if let Some((until, sentence)) = query::words(&notice, device) {
                self.notices.give_until(until, sentence);
            }
        }
    }

    fn take_snapshot(&mut self, ctx: &egui::Context) {
        while let Some(felt) = self.engine.next_felt_tick() {
            self.past.history.take_felt(felt);
        }
        let snapshot = self.engine.snapshot();
        let status = snapshot.link.and_then(|link| link.status);
        let interval_s = self
            .device
            .interval
            .take(status.map(|s| (s.tick, s.dev_us)));
        let looked_at = (self.selection.display, &self.selection.mute_solo);
        let mut live = query::live_view(snapshot, interval_s, looked_at);
        if let Some(bridge) = &mut live.bridge
            && let Some(log) = self.engine.session_log()
        {
            bridge.timing.log = Some(log.path().display().to_string());
            bridge.timing.log_failure = log.failure();
        }
        let largest = live.dots.iter().flat_map(|dot| dot.amplitude_um);
        let largest_um = largest.fold(0.0, f64::max);
        self.selection.scale = self.selection.scale.following(largest_um);
        if live.centre.is_some() && live.speed_mm_per_s > 0.0 {
            self.selection.probe = self.selection.probe.after(live.pose.velocity);
        }
        let trails = self.past.trail.take(live.tick, live.centre);
        if trails && !self.past.is_paced {
            ctx.request_repaint_after(FRAME);
        }
        self.show_past(&mut live);
        self.live = live;
    }

    /// Lets a stepped engine do the ticks that are due by the toolkit's clock.
    fn step_engine(&mut self, ctx: &egui::Context) {
        let due = ctx.input(|input| input.time) * TICKS_PER_S;
        let mut done = self.engine.snapshot().tick;
        while (done as f64) + 1.0 <= due {
            let Some(now) = self.engine.advance_ticks(1) else {
                return;
            };
            self.clock.stepped_at = Some(now);
            let tick = self.engine.snapshot().tick;
            if tick <= done {
                return;
            }
            done = tick;
        }
    }

    /// Keeps what the user chose.
    pub(crate) fn keep_settings(&mut self) {
        let kept = &mut self.settings.preferences;
        kept.scales.amplitude = self.selection.scale;
        kept.scales.spectrum = self.selection.spectrum;
        kept.dots = self.selection.dot_style;
        kept.greys_below = self.selection.greys_below;
    }
}
