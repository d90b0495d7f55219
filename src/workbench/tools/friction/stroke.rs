//! A finger's stroke over the strip: voltages to a screen, and the friction that it makes of them.

use std::collections::VecDeque;

use crate::bench::signals::history::Entry;
use crate::tools::friction::source::Trace;
use selvedge_chart::Columns;
use selvedge_engine::TICKS_PER_S;
use selvedge_render::electrovibration::{
    Driven, Electrovibration, SimulatedScreen, VoltageSink as _,
};

/// Ticks that are shown: one second.
pub(crate) const WINDOW: u64 = 40;
/// Voltages a tick: 20,000 a second, twenty to a period of the fastest carrier.
const A_TICK: u32 = 500;
/// How hard the simulated finger presses, N, as lightly as people stroke a screen.
pub(crate) const PRESS_N: f64 = 0.5;
/// Coefficient of friction of skin on the bare glass.
pub(crate) const BARE_MU: f64 = 0.3;
/// How fast the stroke goes that is written down, mm/s.
pub(crate) const STROKE_MM_PER_S: f64 = 100.0;

/// An instant of a stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Instant {
    /// When, s.
    pub(crate) t_s: f64,
    /// Where on the strip, mm.
    pub(crate) place_mm: f64,
    pub(crate) mu: f64,
    pub(crate) driven: Driven,
    /// Friction on the simulated screen, N.
    pub(crate) friction_n: f64,
}

/// A place at a time, mm and s.
type Led = (f64, f64);

/// What is felt on a path of ticks: of x over the workspace, evenly between them.
fn felt(trace: &Trace, drive: &Electrovibration, path: &[Led]) -> Vec<Instant> {
    let mut screen = SimulatedScreen::new(PRESS_N, BARE_MU);
    let mut instants = Vec::new();
    for led in path.windows(2) {
        let [(from_mm, start_s), (to_mm, end_s)] = [led[0], led[1]];
        let step_s = (end_s - start_s) / f64::from(A_TICK);
        for step in 0..A_TICK {
            let share = f64::from(step) / f64::from(A_TICK);
            let t_s = start_s + share * (end_s - start_s);
            let place_mm = trace.place_mm(from_mm + share * (to_mm - from_mm));
            let mu = trace.mu(place_mm);
            let driven = drive.driven(mu, t_s);
            screen.hold(driven.v, step_s);
            instants.push(Instant {
                t_s,
                place_mm,
                mu,
                driven,
                friction_n: 0.0,
            });
        }
    }
    for (instant, [_, friction_n]) in instants.iter_mut().zip(screen.felt()) {
        instant.friction_n = *friction_n;
    }
    instants
}

/// What was felt in the second up to a column of the history, back to the last pause.
pub(crate) fn of_history(
    trace: &Trace,
    drive: &Electrovibration,
    (entries, end): (&VecDeque<Entry>, u64),
) -> Vec<Instant> {
    let shown = end.saturating_sub(WINDOW)..=end;
    let mut path: Vec<Led> = Vec::new();
    let mut before = None;
    for entry in entries.iter().filter(|entry| shown.contains(&entry.column)) {
        if before.is_some_and(|before| before + 1 < entry.column) {
            path.clear();
        }
        before = Some(entry.column);
        let x_mm = entry.tick_sample.pose.position.x_mm;
        path.push((x_mm, entry.column as f64 / TICKS_PER_S));
    }
    felt(trace, drive, &path)
}

/// What a stroke along the whole strip gives.
pub(crate) fn along(trace: &Trace, drive: &Electrovibration) -> Vec<Instant> {
    let a_tick_mm = STROKE_MM_PER_S / TICKS_PER_S;
    let whole = (0..=WINDOW * 1000)
        .map(|tick| tick as f64)
        .take_while(|tick| tick * a_tick_mm <= trace.length_mm());
    let path: Vec<Led> = whole
        .map(|tick| (tick * a_tick_mm, tick / TICKS_PER_S))
        .collect();
    felt(trace, drive, &path)
}

/// A stroke as a table.
pub(crate) fn columns(stroke: &[Instant]) -> Columns {
    let start_s = stroke.first().map_or(0.0, |first| first.t_s);
    let of = |value: &dyn Fn(&Instant) -> f64| stroke.iter().map(value).collect::<Vec<f64>>();
    Columns::default()
        .with("t_s", of(&|instant| instant.t_s - start_s))
        .with("x_mm", of(&|instant| instant.place_mm))
        .with("mu", of(&|instant| instant.mu))
        .with("voltage_v", of(&|instant| instant.driven.v))
        .with("friction_n", of(&|instant| instant.friction_n))
}
