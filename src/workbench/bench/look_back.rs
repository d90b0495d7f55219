//! Looking back: every view shows a tick of the last minutes in place of what is felt now.
//!
//! Amplitudes and motion are as they were then; which textile lies under a contactor is asked of
//! the scene as it is now. The device goes on with what is felt now, and so does every counter.
//! Moving the pointer over the cloth ends it.

use crate::bench::Bench;
use crate::bench::on_finger::OnFinger;
use crate::bench::perceptual_level::PerceptualLevel;
use crate::bench::view::{Dot, EngineView, Source};
use selvedge_device::{Coder, LimiterState};
use selvedge_engine::TICKS_PER_S;
use selvedge_render::scene::Pose;
use selvedge_render::stylus::StylusState;

/// The tick that is looked back at.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LookBack {
    /// Its column in the history.
    pub(crate) column: u64,
    /// How long before the newest tick of then it was, in felt time, s.
    pub(crate) ago_s: f64,
    /// The newest column when it was asked for: a later one of the pointer ends it.
    newest: u64,
    tick: u64,
    pose: Pose,
    is_stylus: bool,
    dots: Vec<Dot>,
}

impl Bench {
    /// Looks back at the tick at a column of the history, or the last before it; `None`: at what
    /// is felt now.
    pub(crate) fn look_back_to(&mut self, column: Option<u64>) {
        self.past.look_back = column.and_then(|column| self.looked_back(column));
        self.ctx.request_repaint();
    }

    fn looked_back(&mut self, column: u64) -> Option<LookBack> {
        let history = &self.past.history;
        let place = history.place_of(column + 1).checked_sub(1)?;
        let entry = *history.entries().get(place)?;
        let newest = history.newest()?.column;
        let felt_um: Vec<[f32; 2]> = history.felt_um(entry.column)?.collect();
        let mut coder = Coder::new(&self.array(), felt_um.len());
        let bridge = self.live.bridge.as_ref();
        coder.set_link(bridge.and_then(|bridge| bridge.scale));
        coder.encode(&felt_um, 1.0);
        let pose = entry.tick_sample.pose;
        let felt = felt_um.iter().zip(coder.limited()).enumerate();
        let dots = felt.map(|(index, (um, limiter))| self.past_dot(index, &pose, (*um, *limiter)));
        Some(LookBack {
            column: entry.column,
            ago_s: (newest - entry.column) as f64 / TICKS_PER_S,
            newest,
            tick: entry.tick_sample.tick,
            pose,
            is_stylus: entry.tick_sample.is_stylus,
            dots: dots.collect(),
        })
    }

    fn past_dot(
        &mut self,
        contactor: usize,
        pose: &Pose,
        (um, limiter): ([f32; 2], LimiterState),
    ) -> Dot {
        let display = self.display();
        let trace = self.inspection.inspector.trace(display, contactor, pose);
        Dot {
            position: trace.as_ref().map_or(pose.position, |trace| trace.position),
            cloth: trace.and_then(|trace| Some(trace.touch?.textile)),
            amplitude_um: um.map(f64::from),
            limiter,
            on_finger: [OnFinger::Past; 2],
        }
    }

    /// Puts the tick that is looked back at, if one is, in place of what is felt now.
    pub(crate) fn show_past(&mut self, live: &mut EngineView) {
        let Some(back) = &self.past.look_back else {
            return;
        };
        let history = &self.past.history;
        let has_moved = history.newest().is_some_and(|newest| {
            newest.column > back.newest && newest.tick_sample.pose.velocity.speed_mm_per_s() > 0.0
        });
        let is_gone = history.at_column(back.column).is_none();
        let is_over = match live.play.source {
            Source::Recording => true,
            Source::Pointer => has_moved || is_gone,
            Source::Stroke | Source::Lines | Source::Device => is_gone,
        };
        if is_over || self.has_session() {
            self.past.look_back = None;
            return;
        }
        live.tick = back.tick;
        live.pose = back.pose;
        live.centre = Some(back.pose.position);
        live.speed_mm_per_s = back.pose.velocity.speed_mm_per_s();
        live.dots.clone_from(&back.dots);
        live.on_finger = OnFinger::Past;
        live.stylus = back.is_stylus.then_some(StylusState::Led);
        let amplitudes_um = back.dots.iter().map(|dot| dot.amplitude_um);
        live.perceptual_level = PerceptualLevel::of(amplitudes_um);
    }
}

#[cfg(test)]
mod tests {

    use crate::bench::command::PlayCommand;
    use crate::shell::headless::Headless;

    /// A window whose display has explored by itself for as many ticks.
    fn explored(n_ticks: u32) -> Headless {
        let mut desk = Headless::shipped();
        desk.dispatch(PlayCommand::Toggle);
        desk.pass_ticks(n_ticks);
        desk
    }

    #[test]
    fn every_view_shows_what_was_felt_then_and_now_again() {
        let mut desk = explored(200);
        let bench = &desk.workbench.bench;
        let columns = [40, 90, 150];
        let felt = columns.map(|column| {
            let um: Vec<_> = bench.past.history.felt_um(column).unwrap().collect();
            (*bench.past.history.at_column(column).unwrap(), um)
        });
        for (entry, um) in felt {
            desk.dispatch(PlayCommand::LookBack(Some(entry.column)));
            desk.pass(2);
            let live = &desk.workbench.bench.live;
            assert_eq!(live.pose, entry.tick_sample.pose);
            assert_eq!(live.tick, entry.tick_sample.tick);
            let shown = live.dots.iter().map(|dot| dot.amplitude_um);
            assert!(shown.eq(um.iter().map(|um| um.map(f64::from))));
            assert!(live.dots.iter().any(|dot| dot.cloth.is_some()), "on cloth");
        }
        desk.dispatch(PlayCommand::LookBack(None));
        desk.pass(2);
        let bench = &desk.workbench.bench;
        let newest = bench.past.history.newest().unwrap().tick_sample;
        assert_eq!(
            (bench.live.tick, bench.live.pose),
            (newest.tick, newest.pose)
        );
    }

    #[test]
    fn what_is_before_everything_is_not_looked_back_at() {
        let mut desk = explored(5);
        desk.workbench.bench.past.history.clear();
        desk.dispatch(PlayCommand::LookBack(Some(3)));
        assert_eq!(desk.workbench.bench.past.look_back, None);
    }
}
