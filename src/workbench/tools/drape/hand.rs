//! What leads the fingers: a grasp by pointer and keys, or a path that was recorded or opened.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::background::{Task, finished};
use crate::tools::drape::grasp::Grasp;
use crate::tools::drape::hung::{Facts, Frame, Lead, Second};
use crate::tools::drape::motion::Motion;
use selvedge_drape::{Hand, HandPath};
use selvedge_foundation::files::write_atomic;

/// Longest recording, s.
const MAX_RECORDED_S: f64 = 600.0;

/// The hands.
#[derive(Default)]
pub(crate) struct Hands {
    pub(crate) grasp: Option<Grasp>,
    /// The path that was recorded or opened last.
    pub(crate) path: Option<Arc<HandPath>>,
    /// Where it is kept, if it is.
    pub(crate) file: Option<PathBuf>,
    /// A path that is being recorded, from this time of the scene on, s.
    recording: Option<(HandPath, f64)>,
    /// Whether the path leads.
    pub(crate) is_replaying: bool,
    reading: Option<(PathBuf, Task<HandPath>)>,
    /// What could not be read or written, in a line.
    pub(crate) trouble: Option<String>,
    led_at_s: Option<f64>,
    /// Where hands started for which the grasp was made, and whether they are beside each other.
    made_for: (Vec<Hand>, bool),
}

impl Hands {
    /// Makes a grasp where there is none yet, and writes down where hands are while they are
    /// recorded.
    pub(crate) fn meet(&mut self, motion: &Motion, second: Second) {
        let start = &motion.facts.hands;
        let made_for = (start.clone(), second == Second::Beside);
        if !start.is_empty() && (self.grasp.is_none() || self.made_for != made_for) {
            self.grasp = Some(Grasp::starting(start, made_for.1));
            self.made_for = made_for;
        }
        let Some(frame) = motion.frames.back() else {
            return;
        };
        if let Some((path, from_s)) = &mut self.recording {
            path.push(frame.t_s - *from_s, &frame.hands);
            let [_, end_s] = path.span_s();
            if frame.t_s < *from_s || end_s > MAX_RECORDED_S {
                self.end_recording();
            }
        }
    }

    /// What leads now; the second finger may be one of the device's, at a place of the cloth, mm.
    pub(crate) fn lead(
        &mut self,
        motion: &Motion,
        (second, device_mm): (Second, Option<[f64; 2]>),
        ctx: &egui::Context,
    ) -> Lead {
        let now_s = ctx.input(|input| input.time);
        let before_s = self.led_at_s.replace(now_s).unwrap_or(now_s);
        if let Some(path) = self.path.as_ref().filter(|_| self.is_replaying) {
            return Lead::Along(Arc::clone(path));
        }
        let n_fingers = motion.facts.hands.len();
        let Some(grasp) = self.grasp.as_mut().filter(|_| n_fingers > 0) else {
            return Lead::Towards(Vec::new());
        };
        grasp.lead((now_s - before_s).clamp(0.0, 0.1));
        let mut hands = grasp.hands(n_fingers);
        if let (Second::Recorded, Some(path), Some(frame)) =
            (second, &self.path, motion.frames.back())
        {
            let mut recorded = hands.clone();
            path.at(looped(path, frame.t_s), &mut recorded);
            hands.truncate(1);
            hands.extend(recorded.into_iter().skip(1));
        }
        if let (Some([x_mm, y_mm]), Some(hand)) = (device_mm, hands.get_mut(1)) {
            hand.centre_mm = [x_mm, y_mm, hand.centre_mm[2]];
        }
        Lead::Towards(hands)
    }

    /// Begins to record, or ends.
    pub(crate) fn toggle_recording(&mut self, motion: &Motion) {
        if self.recording.is_some() {
            return self.end_recording();
        }
        if let Some(frame) = motion.frames.back() {
            self.recording = Some((HandPath::starting(0.0, &frame.hands), frame.t_s));
        }
    }

    fn end_recording(&mut self) {
        let Some((path, _)) = self.recording.take() else {
            return;
        };
        let [start_s, end_s] = path.span_s();
        if end_s > start_s {
            (self.path, self.file) = (Some(Arc::new(path)), None);
        }
    }

    /// How long what is being recorded is, s.
    pub(crate) fn recorded_s(&self) -> Option<f64> {
        let (path, _) = self.recording.as_ref()?;
        Some(path.span_s()[1])
    }

    /// Lets the path lead, from a cloth at rest on.
    pub(crate) fn replay(&mut self, motion: &mut Motion) {
        if self.path.is_some() {
            self.end_recording();
            self.is_replaying = true;
            motion.restart();
        }
    }

    /// Gives the hand back to pointer and keys, where the path has led it.
    pub(crate) fn take_over(&mut self, frame: Option<&Arc<Frame>>) {
        if !std::mem::take(&mut self.is_replaying) {
            return;
        }
        if let (Some(grasp), Some(frame)) = (&mut self.grasp, frame) {
            grasp.follow_from(&frame.hands);
        }
    }

    /// Reads a path for the fingers that are there.
    pub(crate) fn read(&mut self, path: &Path, facts: &Facts, bench: &Bench) {
        let Some(cloth) = facts.cloths.first() else {
            self.trouble = Some("No cloth hangs: open one first".to_owned());
            return;
        };
        let (scene, from) = (cloth.scene.clone(), path.to_owned());
        let task = bench.executor.start("selvedge-hands", move |_| {
            HandPath::read(&from, &scene).map_err(|error| error.to_string())
        });
        self.reading = Some((path.to_owned(), task));
    }

    /// Takes a path that was read.
    pub(crate) fn take_read(&mut self, bench: &Bench) {
        let Some((file, task)) = self.reading.take() else {
            return;
        };
        let mut task = Some(task);
        match finished(&mut task) {
            Some(Ok(path)) => {
                (self.path, self.file) = (Some(Arc::new(path)), Some(file));
                self.trouble = None;
            }
            Some(Err(why)) => self.trouble = Some(why),
            None => {
                bench.ctx.request_repaint_after(crate::bench::FRAME);
                self.reading = task.map(|task| (file, task));
            }
        }
    }

    /// Writes the path.
    pub(crate) fn save(&mut self, file: &Path, bench: &mut Bench) {
        let Some(path) = &self.path else {
            return bench
                .notices
                .give("There are no hands to save: record them first");
        };
        let written = path
            .to_csv()
            .map_err(|error| error.to_string())
            .and_then(|csv| write_atomic(file, &csv).map_err(|error| error.to_string()));
        match written {
            Ok(()) => self.file = Some(file.to_owned()),
            Err(why) => bench.notices.give(why),
        }
    }

    /// What the path is called, and how long it is, s.
    pub(crate) fn about_path(&self) -> Option<(String, f64)> {
        let path = self.path.as_ref()?;
        let name = self.file.as_ref().and_then(|file| file.file_name());
        let name = name.map_or_else(|| "recorded".into(), |name| name.to_string_lossy());
        let [start_s, end_s] = path.span_s();
        Some((name.into_owned(), end_s - start_s))
    }
}

/// A time of a path that begins again at its end.
fn looped(path: &HandPath, t_s: f64) -> f64 {
    let [start_s, end_s] = path.span_s();
    start_s + t_s.rem_euclid((end_s - start_s).max(1e-3))
}

impl Grasp {
    /// Goes on from where hands are.
    fn follow_from(&mut self, hands: &[Hand]) {
        let Some(first) = hands.first() else { return };
        let second = hands.get(1).unwrap_or(first);
        let middle = |axis: usize| 0.5 * (first.centre_mm[axis] + second.centre_mm[axis]);
        self.centre_mm = [0, 1, 2].map(middle);
        self.shift_mm = [0, 1].map(|axis| first.centre_mm[axis] - second.centre_mm[axis]);
        self.opening_mm = first.opening_mm;
    }
}
