//! The drive waveform: the last 50 ms, two ticks, of what drives the selected contactor.

use eframe::egui::{Sense, Ui};

use crate::bench::Bench;
use crate::bench::export::{Exported, NO_CONTACTOR, NOTHING_FELT};
use crate::bench::on_finger::{OnFinger, paint_label, sentences};
use crate::bench::pane::Pane;
use crate::bench::signals::drive::{drive_um, wave_um};
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::kit::widgets::axis::round_step;
use crate::tools::spectra::{contactor, show_contactor};
use selvedge_chart::{At, Axis, Chart, Columns, Extent, Ink, Rule, Series, Style, Weight};
use selvedge_device::Coder;
use selvedge_foundation::quantity;

/// A tick, ms.
const TICK_MS: f64 = 25.0;
/// Steps that a wave is drawn in: 24 in a cycle of 320 Hz, which misses its peaks by less than a
/// hundredth.
const N_SHOWN: u32 = 384;
/// The same in a file: 20 a millisecond.
const N_EXPORTED: u32 = 1000;
/// The axis at the least, µm.
const LEAST_TOP_UM: f64 = 0.1;
/// Height that is left for what the finger gets of it, points.
const LABEL: f32 = 18.0;
/// How long a smaller axis must have sufficed before it is taken, s.
const PATIENCE_S: f64 = 1.0;

/// What drove a contactor in the last two ticks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct TwoTicks {
    /// [A40, A320] of the tick before, µm.
    pub before_um: [f64; 2],
    /// [A40, A320] of this tick, µm.
    pub(crate) now_um: [f64; 2],
    /// The output limits of both bands, µm.
    pub limit_um: [f64; 2],
    /// What the finger gets of both bands.
    on_finger: [OnFinger; 2],
}

impl TwoTicks {
    /// Those of the chosen contactor: now as every other view shows it, before as it was played. A
    /// display that is held shows the tick at which it stands.
    pub(crate) fn of_chosen(bench: &Bench) -> Self {
        let live = &bench.live;
        let dot = live.dots.get(contactor(bench));
        let now_um = dot.map_or([0.0; 2], |dot| dot.amplitude_um);
        let watched = u32::try_from(contactor(bench)).unwrap_or(u32::MAX);
        let before_um = if live.on_finger == OnFinger::Held {
            now_um
        } else {
            drive_um(&bench.past.history, watched, live.tick.saturating_sub(1))
        };
        let bridge = live.bridge.as_ref();
        let mut coder = Coder::of_contactor(bench.engine.profile(), contactor(bench));
        coder.set_link(bridge.and_then(|bridge| bridge.scale));
        Self {
            before_um,
            now_um,
            limit_um: coder.limits(0).map(|limit| limit.um),
            on_finger: dot.map_or([live.on_finger; 2], |dot| dot.on_finger),
        }
        .finite()
    }

    /// Amplitudes and limits with 0 for what is no number.
    fn finite(self) -> Self {
        let finite = |pair: [f64; 2]| pair.map(|um| if um.is_finite() { um } else { 0.0 });
        Self {
            before_um: finite(self.before_um),
            now_um: finite(self.now_um),
            limit_um: finite(self.limit_um),
            ..self
        }
    }

    /// The farthest that the sum of both waves can reach, µm.
    pub(crate) fn reach_um(&self) -> f64 {
        let reach = |pair: [f64; 2]| pair[0].abs() + pair[1].abs();
        reach(self.before_um).max(reach(self.now_um))
    }

    /// Both waves at a time of the window, µm.
    pub(crate) fn waves_um(&self, t_ms: f64) -> [f64; 2] {
        let amplitudes_um = if t_ms < TICK_MS {
            self.before_um
        } else {
            self.now_um
        };
        wave_um(amplitudes_um, t_ms * 1e-3)
    }
}

/// The upper end of the axis: 1, 2 or 5 · 10ⁿ µm. It rises at once, and falls when a smaller one
/// has sufficed for a second, in which silence counts as time alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WaveScale {
    /// Its upper end, µm.
    pub(crate) most_um: f64,
    /// The largest reach since the axis could have been smaller, and since when, s.
    smaller: Option<(f64, f64)>,
}

impl Default for WaveScale {
    fn default() -> Self {
        Self {
            most_um: LEAST_TOP_UM,
            smaller: None,
        }
    }
}

impl WaveScale {
    /// The scale after a reach at a time.
    pub(crate) fn following(self, reach_um: f64, time_s: f64) -> Self {
        let round = |um: f64| round_step(um.clamp(LEAST_TOP_UM, 1e9));
        let is_sound = reach_um > 0.0 && reach_um.is_finite();
        if is_sound && round(reach_um) >= self.most_um {
            return Self {
                most_um: round(reach_um),
                smaller: None,
            };
        }
        let smaller = match self.smaller {
            Some((largest, since_s)) if is_sound => Some((largest.max(reach_um), since_s)),
            None if is_sound => Some((reach_um, time_s)),
            before => before,
        };
        match smaller {
            Some((largest, since_s)) if time_s - since_s >= PATIENCE_S => Self {
                most_um: round(largest),
                smaller: None,
            },
            _ => Self { smaller, ..self },
        }
    }
}

/// Both waves and their sum over the last two ticks, on the axis up to `most_um`.
fn chart(view: &TwoTicks, most_um: f64, n_steps: u32) -> Chart {
    let samples: Vec<[f64; 3]> = (0..=n_steps)
        .map(|step| {
            let t_ms = 2.0 * TICK_MS * f64::from(step) / f64::from(n_steps);
            let [low, high] = view.waves_um(t_ms);
            [t_ms * 1e-3, low, high]
        })
        .collect();
    let column = |of: &dyn Fn(&[f64; 3]) -> f64| -> Vec<f64> { samples.iter().map(of).collect() };
    let columns = Columns::default()
        .with("t_s", column(&|sample| sample[0]))
        .with("wave_40_um", column(&|sample| sample[1]))
        .with("wave_320_um", column(&|sample| sample[2]))
        .with("sum_um", column(&|sample| sample[1] + sample[2]));
    let [low, high] = view.on_finger.map(OnFinger::presence);
    let line = |name: &str, column: &str, (ink, presence), weight| Series {
        name: name.to_owned(),
        points: columns.points("t_s", column),
        style: Style::Line,
        ink,
        faintness: 1.0 - presence,
        weight,
        ..Series::default()
    };
    Chart {
        x: Axis::linear("time, s").within([0.0, 2e-3 * TICK_MS]),
        y: Axis::linear("displacement, µm").within([-most_um, most_um]),
        series: vec![
            line("40 Hz", "wave_40_um", (Ink::Amber, low), Weight::Normal),
            line("320 Hz", "wave_320_um", (Ink::Cyan, high), Weight::Normal),
            line("sum", "sum_um", (Ink::Black, low.max(high)), Weight::Thin),
        ],
        rules: limits(view.limit_um, most_um),
        columns,
        ..Chart::default()
    }
}

/// The output limits that lie on the axis.
fn limits(limit_um: [f64; 2], most_um: f64) -> Vec<Rule> {
    let of = |(um, ink): (f64, Ink)| {
        let rule = |um| Rule {
            at: At::Y(um),
            ink,
            extent: Extent::Dashed,
            ..Rule::default()
        };
        (um > 0.0 && um <= most_um).then(|| [rule(-um), rule(um)])
    };
    let limits = limit_um.into_iter().zip([Ink::Amber, Ink::Cyan]);
    limits.filter_map(of).flatten().collect()
}

/// The waveform that drives a contactor.
#[derive(Debug, Default)]
pub(crate) struct DriveWave {
    scale: WaveScale,
}

impl DriveWave {
    /// Shows the waveform in the space that is left.
    fn show(&mut self, ui: &mut Ui, bench: &Bench) {
        let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let shown = TwoTicks::of_chosen(bench);
        let time_s = ui.input(|input| input.time);
        self.scale = self.scale.following(shown.reach_um(), time_s);
        let setting = Setting {
            name: "Drive waveform of the selected contactor, the last 50 ms",
            note: "The last two ticks of the drive, after gains and before output limits; \
                   amplitudes change at ticks, where both waves cross zero",
            ..Setting::default()
        };
        let chart = chart(&shown, self.scale.most_um, N_SHOWN);
        if let Some(plot) = plot::show(ui, rect, &chart, &setting) {
            // The upper corner is the axis's.
            let lower = plot.area().with_min_y(plot.area().bottom() - LABEL);
            paint_label(ui.painter(), lower, shown.on_finger);
        }
    }
}

impl Tool for DriveWave {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::DriveWave]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 8, |ui| self.show(ui, context.bench));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        show_contactor(ui, context.bench);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let contactor = bench.selection.contactor.ok_or(NO_CONTACTOR)?;
        let shown = TwoTicks::of_chosen(bench);
        let tick_samples = bench.past.history.tick_samples();
        let mut felt_um = tick_samples.flat_map(|one| one.watched_um);
        if !felt_um.any(|um| um > 0.0) && shown.reach_um() <= 0.0 {
            return Err(NOTHING_FELT);
        }
        let tick = bench.live.tick;
        let most_um = self.scale.most_um.max(shown.reach_um());
        let [low, high] = shown.limit_um.map(|um| quantity::with_unit(um, 1, "µm"));
        let on_finger = match sentences(shown.on_finger).join("; ") {
            words if words.is_empty() => words,
            words => format!(" {words}."),
        };
        let note = format!(
            "The last two ticks of the drive, after gains and before output limits ({low} at 40 \
             Hz, {high} at 320 Hz, dashed where they lie on the axis); amplitudes change at ticks, \
             where both waves cross zero.{on_finger}"
        );
        let pair = |[low, high]: [f64; 2]| format!("{low} and {high}");
        let origin = bench.rendered_origin();
        let origin = origin
            .of_contactor(contactor)
            .and("amplitudes_before_um", &pair(shown.before_um), "")
            .and("amplitudes_now_um", &pair(shown.now_um), "")
            .and("limits_um", &pair(shown.limit_um), "")
            .in_ticks([tick.saturating_sub(1), tick].into_iter());
        let title = format!("Waveform that drives contactor {contactor}");
        let chart = chart(&shown, most_um, N_EXPORTED);
        Ok(Exported::of_chart(&title, chart, 300.0, &note, origin))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::tactile::Band;

    #[test]
    fn a_display_that_is_held_shows_what_the_heatmaps_show_and_says_so() {
        let ctx = eframe::egui::Context::default();
        let mut bench = Bench::new(&ctx, None, crate::bench::Drive::Stepped).unwrap();
        let dot = crate::bench::view::Dot {
            amplitude_um: [49.0, 3.0],
            on_finger: [OnFinger::Held; 2],
            ..crate::bench::view::Dot::default()
        };
        bench.live.dots = vec![dot; 24];
        bench.live.on_finger = OnFinger::Held;
        let shown = TwoTicks::of_chosen(&bench);
        assert_eq!((shown.before_um, shown.now_um), ([49.0, 3.0], [49.0, 3.0]));
        let chart = chart(&shown, 100.0, 10);
        assert!(chart.series.iter().all(|one| one.faintness > 0.3), "dimmed");
    }

    #[test]
    fn each_tick_has_its_own_amplitudes_and_the_waves_meet_at_zero() {
        let view = TwoTicks {
            before_um: [2.0, 0.0],
            now_um: [0.0, 3.0],
            ..TwoTicks::default()
        };
        assert!(
            (view.waves_um(6.25)[0] - 2.0).abs() < 1e-9,
            "a quarter of 40 Hz"
        );
        assert!(
            (view.waves_um(25.0 + 0.781_25)[1] - 3.0).abs() < 1e-9,
            "of 320 Hz"
        );
        for t_ms in [0.0, 25.0, 50.0] {
            let sum: f64 = view.waves_um(t_ms).iter().sum();
            assert!(sum.abs() < 1e-9, "{t_ms} ms: {sum}");
        }
        assert_eq!(view.reach_um(), 3.0);
    }

    #[test]
    fn waves_are_drawn_in_steps_that_miss_their_peaks_by_less_than_a_hundredth() {
        for (band, other) in [(Band::Low, Band::High), (Band::High, Band::Low)] {
            let mut now_um = [0.0; 2];
            now_um[band.index()] = 1.0;
            let view = TwoTicks {
                before_um: now_um,
                now_um,
                ..TwoTicks::default()
            };
            let chart = chart(&view, 2.0, N_SHOWN);
            let heights = |band: Band| chart.series[band.index()].points.iter().map(|at| at[1]);
            let most = heights(band).fold(0.0, f64::max);
            assert!(most > 0.99 && most <= 1.0, "{band:?}: {most}");
            assert!(heights(other).all(|um| um == 0.0));
        }
    }

    #[test]
    fn the_axis_rises_at_once_and_falls_after_a_calm_second() {
        let mut scale = WaveScale::default().following(7.0, 0.0);
        assert_eq!(scale.most_um, 10.0);
        scale = scale.following(3.0, 0.1).following(0.4, 0.9);
        assert_eq!(scale.most_um, 10.0, "a dip moves nothing");
        scale = scale.following(6.0, 1.0);
        assert_eq!(scale.smaller, None, "it is needed again");
        scale = scale.following(1.5, 3.0).following(0.1, 4.1);
        assert_eq!(scale.most_um, 2.0);
        for nothing in [0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(scale.following(nothing, 9.0).most_um, 2.0, "{nothing}");
        }
    }

    #[test]
    fn silent_ticks_do_not_keep_the_axis_from_falling() {
        let mut scale = WaveScale::default().following(400.0, 0.0);
        for tick in 1..60_u8 {
            // Every other tick lies in a gap between two textiles.
            let reach_um = if tick % 2 == 0 { 60.0 } else { 0.0 };
            scale = scale.following(reach_um, f64::from(tick) / 40.0);
        }
        assert_eq!(scale.most_um, 100.0);
    }
}
