//! The drive waveform: the last 50 ms, two ticks, of what drives the selected contactor.

use eframe::egui::{
    self, Align2, Color32, Painter, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
};

use crate::bench::signals::drive::wave_um;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks, paint_unit, round_step};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// A tick, ms.
const TICK_MS: f64 = 25.0;
/// The axis at the least, µm.
const LEAST_TOP_UM: f64 = 0.1;
/// How long a smaller axis must have sufficed before it is taken, s.
const PATIENCE_S: f64 = 2.0;

/// What the pane shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(clippy::struct_field_names, reason = "units are part of names")]
pub(crate) struct DriveWaveView {
    /// [A40, A320] of the tick before, µm.
    pub before_um: [f64; 2],
    /// [A40, A320] of this tick, µm.
    pub(crate) now_um: [f64; 2],
    /// The output limits of both bands, µm.
    pub limit_um: [f64; 2],
}

impl DriveWaveView {
    /// Amplitudes and limits with 0 for what is no number.
    pub(crate) fn finite(self) -> Self {
        let finite = |pair: [f64; 2]| pair.map(|um| if um.is_finite() { um } else { 0.0 });
        Self {
            before_um: finite(self.before_um),
            now_um: finite(self.now_um),
            limit_um: finite(self.limit_um),
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

/// The upper end of the axis: 1, 2 or 5 · 10ⁿ µm. It rises at once, and falls only when a smaller
/// one has sufficed for two seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WaveScale {
    most_um: f64,
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
    /// Its upper end, µm.
    pub(crate) fn most_um(self) -> f64 {
        self.most_um
    }

    /// The scale after a reach at a time.
    pub(crate) fn following(self, reach_um: f64, time_s: f64) -> Self {
        let round = |um: f64| round_step(um.clamp(LEAST_TOP_UM, 1e9));
        if !(reach_um > 0.0 && reach_um.is_finite()) {
            // Silence says nothing of what comes after it.
            return Self {
                smaller: None,
                ..self
            };
        }
        let needed = round(reach_um);
        if needed >= self.most_um {
            return Self {
                most_um: needed,
                smaller: None,
            };
        }
        let (largest, since_s) = self.smaller.unwrap_or((reach_um, time_s));
        let largest = largest.max(reach_um);
        if time_s - since_s >= PATIENCE_S {
            return Self {
                most_um: round(largest),
                smaller: None,
            };
        }
        Self {
            smaller: Some((largest, since_s)),
            ..self
        }
    }
}

/// Shows the waveform in the space that is left.
pub(crate) fn show(ui: &mut Ui, scale: &mut WaveScale, view: &DriveWaveView) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    let name = "Drive waveform of the selected contactor, the last 50 ms";
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, name));
    let plot = Rect::from_min_max(
        pos2(rect.left() + 34.0, rect.top() + 18.0),
        pos2(rect.right() - 8.0, rect.bottom() - 18.0),
    );
    if plot.width() < 24.0 || plot.height() < 16.0 {
        return;
    }
    let view = view.finite();
    *scale = scale.following(view.reach_um(), ui.input(|input| input.time));
    let axes = Axes::new(scale.most_um());
    axes.paint(ui.painter(), plot);
    axes.paint_limits(ui.painter(), plot, view.limit_um);
    axes.paint_waves(ui.painter(), plot, &view);
    let [low, high] = view.now_um.map(|um| quantity::with_unit(um, 2, "µm"));
    response.on_hover_text(format!(
        "The last two ticks of the drive, after gains and before output limits\n40 Hz  \
         {low}\n320 Hz  {high}\namplitudes change at ticks, where both waves cross zero"
    ));
}

struct Axes {
    t_ms: Axis,
    height_um: Axis,
}

impl Axes {
    fn new(most_um: f64) -> Self {
        Self {
            t_ms: Axis::linear(0.0, 2.0 * TICK_MS),
            height_um: Axis::linear(-most_um, most_um),
        }
    }

    fn paint(&self, painter: &Painter, plot: Rect) {
        let most_um = self.height_um.most();
        let share = if plot.height() > 100.0 { 0.5 } else { 1.0 };
        let heights = [
            self.height_um.least(),
            -share * most_um,
            0.0,
            share * most_um,
            most_um,
        ];
        let mut heights: Vec<Tick> = heights.map(Tick::number).to_vec();
        heights.dedup();
        paint_ticks(painter, plot, (&self.height_um, Side::Left), &heights);
        let end = Tick::named(2.0 * TICK_MS, "50 ms");
        let times = [Tick::number(0.0), Tick::number(TICK_MS), end];
        paint_ticks(painter, plot, (&self.t_ms, Side::Bottom), &times);
        let unit_at = pos2(plot.left() - 5.0, plot.top() - 6.0);
        paint_unit(painter, unit_at, Align2::RIGHT_BOTTOM, "µm");
    }

    fn paint_limits(&self, painter: &Painter, plot: Rect, limit_um: [f64; 2]) {
        let palette = Palette::of(painter.ctx().theme());
        let is_in_range = |um: f64| um > 0.0 && um <= self.height_um.most();
        for band in Band::ALL {
            let um = limit_um[band.index()];
            if is_in_range(um) {
                for um in [-um, um] {
                    let y = self.height_um.y(plot.y_range(), um);
                    let y = painter.round_to_pixel_center(y);
                    let ends = [pos2(plot.left(), y), pos2(plot.right(), y)];
                    // The two lines may coincide: each fills the other's gaps.
                    let shift = 5.0 * band.index() as f32;
                    let stroke = Stroke::new(1.0, palette.band(band));
                    painter.add(Shape::Vec(Shape::dashed_line_with_offset(
                        &ends,
                        stroke,
                        &[5.0],
                        &[5.0],
                        shift,
                    )));
                }
            }
        }
    }

    fn paint_waves(&self, painter: &Painter, plot: Rect, view: &DriveWaveView) {
        let palette = Palette::of(painter.ctx().theme());
        let inks = Band::ALL.map(|band| palette.band(band).gamma_multiply(0.55));
        let clip = painter.with_clip_rect(plot.expand(1.0));
        let line = |pick: &dyn Fn([f64; 2]) -> f64, fastest: Band, ink: Color32, width: f32| {
            let points = sample_times_ms(fastest).map(|t_ms| {
                let y = self.height_um.y(plot.y_range(), pick(view.waves_um(t_ms)));
                pos2(self.t_ms.x(plot.x_range(), t_ms), y)
            });
            clip.add(Shape::line(points.collect(), Stroke::new(width, ink)));
        };
        line(&|waves| waves[0], Band::Low, inks[0], 1.0);
        line(&|waves| waves[1], Band::High, inks[1], 1.0);
        let sum = |waves: [f64; 2]| waves[0] + waves[1];
        line(&sum, Band::High, palette.text, 1.25);
    }
}

/// Times at which a wave is drawn: 24 in a cycle of the fastest band in it, which misses its peaks
/// by less than a hundredth.
fn sample_times_ms(fastest: Band) -> impl Iterator<Item = f64> {
    let n_cycles: u32 = match fastest {
        Band::Low => 2,
        Band::High => 16,
    };
    let n_steps = 24 * n_cycles;
    (0..=n_steps).map(move |i| 2.0 * TICK_MS * f64::from(i) / f64::from(n_steps))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_tick_has_its_own_amplitudes_and_the_waves_meet_at_zero() {
        let view = DriveWaveView {
            before_um: [2.0, 0.0],
            now_um: [0.0, 3.0],
            ..DriveWaveView::default()
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
            let view = DriveWaveView {
                before_um: now_um,
                now_um,
                ..DriveWaveView::default()
            };
            let waves = |fastest| sample_times_ms(fastest).map(|t_ms| view.waves_um(t_ms));
            let most = waves(band).map(|um| um[band.index()]).fold(0.0, f64::max);
            assert!(most > 0.99 && most <= 1.0, "{band:?}: {most}");
            assert!(waves(band).all(|um| um[other.index()] == 0.0));
        }
    }

    #[test]
    fn the_axis_rises_at_once_and_falls_after_two_calm_seconds() {
        let mut scale = WaveScale::default().following(7.0, 0.0);
        assert_eq!(scale.most_um(), 10.0);
        scale = scale.following(3.0, 0.1).following(0.4, 1.9);
        assert_eq!(scale.most_um(), 10.0, "a dip moves nothing");
        scale = scale.following(6.0, 2.0);
        assert_eq!(scale.smaller, None, "it is needed again");
        scale = scale.following(1.5, 3.0).following(0.1, 5.1);
        assert_eq!(scale.most_um(), 2.0);
        for nothing in [0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(scale.following(nothing, 9.0).most_um(), 2.0, "{nothing}");
        }
    }
}
