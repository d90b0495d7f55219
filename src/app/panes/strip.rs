//! The level strip: the mean amplitude of both bands over the last seconds of exploration.
//!
//! It moves only while something is felt: stillness is not drawn.

use std::collections::VecDeque;

use eframe::egui::{
    self, Align2, Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::app::theme::{self, Palette};
use crate::app::view::Dot;
use crate::quantity;
use crate::tactile::Band;

/// Ticks that the strip shows (8 s).
const N_TICKS: u64 = 320;
/// Ends of the level axis, dB re 1 µm.
const LEAST_DB: f64 = -10.0;
const MOST_DB: f64 = 40.0;
/// Width of the axis on the left, points.
const AXIS: f32 = 34.0;
/// Width of the numbers on the right, points.
const NUMBERS: f32 = 96.0;
/// Height of the title, points.
const TITLE: f32 = 20.0;

/// Mean amplitudes of the last ticks in which something was felt.
#[derive(Debug, Clone, Default)]
pub(crate) struct Levels {
    /// (ticks of felt exploration, mean amplitudes in µm), old to new.
    felt: VecDeque<(u64, [f64; 2])>,
    last_tick: u64,
}

impl Levels {
    /// Takes in a tick. Says whether the strip looks different now.
    pub(crate) fn take(&mut self, tick: u64, dots: &[Dot]) -> bool {
        let now = mean_um(dots);
        let was_silent = self.felt.back().is_none_or(|(_, mean)| is_silent(mean));
        let gap = tick.saturating_sub(self.last_tick);
        self.last_tick = tick;
        if gap == 0 || (was_silent && is_silent(&now)) {
            return false;
        }
        // A pause between two strokes is one tick wide.
        let step = if was_silent { 1 } else { gap.min(8) };
        let at = self.felt.back().map_or(0, |(at, _)| at + step);
        self.felt.push_back((at, now));
        while self.felt.front().is_some_and(|(old, _)| old + N_TICKS < at) {
            self.felt.pop_front();
        }
        true
    }

    /// The newest mean amplitudes, µm.
    fn newest_um(&self) -> [f64; 2] {
        self.felt.back().map_or([0.0; 2], |(_, mean)| *mean)
    }
}

fn is_silent(mean_um: &[f64; 2]) -> bool {
    mean_um.iter().all(|um| *um <= 0.0)
}

/// Mean amplitudes over the contactors that are on a textile, µm; 0 when none is.
fn mean_um(dots: &[Dot]) -> [f64; 2] {
    let on_cloth = || dots.iter().filter(|dot| dot.cloth.is_some());
    let n = on_cloth().count().max(1) as f64;
    [0, 1].map(|band| on_cloth().map(|dot| dot.amplitude_um[band]).sum::<f64>() / n)
}

/// Shows the strip in the space that is left.
pub(crate) fn show(ui: &mut Ui, levels: &Levels) {
    let palette = Palette::in_ui(ui);
    let size = ui.available_size();
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, "Level strip"));
    let title_at = pos2(rect.left() + AXIS, rect.top() + 0.5 * TITLE - 1.0);
    let title = "Mean level on cloth";
    ui.painter().text(
        title_at,
        Align2::LEFT_CENTER,
        title,
        theme::small(),
        palette.dim,
    );
    let plot = Rect::from_min_max(
        pos2(rect.left() + AXIS, rect.top() + TITLE),
        pos2(rect.right() - NUMBERS, rect.bottom() - 14.0),
    );
    paint_axes(ui.painter(), plot);
    for band in Band::ALL {
        paint_band(ui.painter(), plot, levels, band, palette.band(band));
    }
    paint_numbers(ui.painter(), rect, plot, levels.newest_um());
    response.on_hover_text(
        "Mean peak amplitude over the contactors that are on a textile, after gains, over the last \
         8 s in which anything was felt",
    );
}

fn paint_axes(painter: &Painter, plot: Rect) {
    let palette = Palette::of(painter.ctx().theme());
    for step in 0..=5_u8 {
        let level_db = LEAST_DB + f64::from(step) * 10.0;
        let y = painter.round_to_pixel_center(y_of(plot, level_db));
        painter.hline(plot.x_range(), y, Stroke::new(1.0, palette.hairline));
        let digits = quantity::fixed(level_db, 0);
        let at = pos2(plot.left() - 6.0, y);
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            digits,
            theme::small_number(),
            palette.dim,
        );
    }
    let unit_at = pos2(plot.left() - 6.0, plot.top() - 11.0);
    painter.text(
        unit_at,
        Align2::RIGHT_CENTER,
        "dB",
        theme::small(),
        palette.dim,
    );
    for (share, words) in [(0.0, "8 s ago"), (0.5, "4 s"), (1.0, "now")] {
        let at = pos2(plot.left() + share * plot.width(), plot.bottom() + 3.0);
        let anchor = match words {
            "8 s ago" => Align2::LEFT_TOP,
            "now" => Align2::RIGHT_TOP,
            _ => Align2::CENTER_TOP,
        };
        painter.text(at, anchor, words, theme::small_number(), palette.dim);
    }
}

fn paint_band(painter: &Painter, plot: Rect, levels: &Levels, band: Band, ink: Color32) {
    let Some(&(newest, _)) = levels.felt.back() else {
        return;
    };
    let point = |(at, mean): &(u64, [f64; 2])| {
        #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
        let ago = ((newest - at) as f64 / N_TICKS as f64) as f32;
        let x = plot.right() - ago * plot.width();
        pos2(x, y_of(plot, quantity::level_db(mean[band.index()])))
    };
    let painter = painter.with_clip_rect(plot.expand(1.0));
    let felt: Vec<_> = levels.felt.iter().collect();
    // Silence between two strokes is a gap, not a plunge.
    for stroke in felt.split(|(_, mean)| mean[band.index()] <= 0.0) {
        let points: Vec<Pos2> = stroke.iter().map(|entry| point(entry)).collect();
        painter.add(Shape::line(points, Stroke::new(1.5, ink)));
    }
}

fn paint_numbers(painter: &Painter, rect: Rect, plot: Rect, newest_um: [f64; 2]) {
    let palette = Palette::of(painter.ctx().theme());
    for band in Band::ALL {
        let y = plot.top() + 14.0 + 44.0 * band.index() as f32;
        let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
        let left = pos2(plot.right() + 16.0, y - 9.0);
        painter.text(
            left,
            Align2::LEFT_CENTER,
            name,
            theme::small(),
            palette.band(band),
        );
        let digits = quantity::fixed(newest_um[band.index()], 2);
        let right = pos2(rect.right() - 22.0, y + 7.0);
        painter.text(
            right,
            Align2::RIGHT_CENTER,
            digits,
            theme::number(),
            palette.text,
        );
        let unit_at = right + vec2(4.0, 0.0);
        painter.text(
            unit_at,
            Align2::LEFT_CENTER,
            "µm",
            theme::small(),
            palette.dim,
        );
    }
}

fn y_of(plot: Rect, level_db: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
    let share = ((level_db - LEAST_DB) / (MOST_DB - LEAST_DB)).clamp(0.0, 1.0) as f32;
    plot.bottom() - share * plot.height()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn felt(um: f64) -> Vec<Dot> {
        let on = Dot {
            cloth: Some(0),
            amplitude_um: [um, 2.0 * um],
            ..Dot::default()
        };
        vec![
            on,
            Dot {
                amplitude_um: [99.0; 2],
                ..Dot::default()
            },
        ]
    }

    #[test]
    fn only_contactors_on_cloth_count() {
        assert_eq!(mean_um(&felt(3.0)), [3.0, 6.0]);
        assert_eq!(mean_um(&[]), [0.0, 0.0]);
    }

    #[test]
    fn stillness_is_drawn_once_and_then_stands() {
        let mut levels = Levels::default();
        assert!(levels.take(1, &felt(1.0)));
        assert!(levels.take(2, &felt(0.0)), "the fall to silence shows");
        assert!(!levels.take(3, &felt(0.0)));
        assert!(!levels.take(4_000, &felt(0.0)));
        assert!(levels.take(4_001, &felt(1.0)));
        assert_eq!(levels.felt.back().map(|(at, _)| *at), Some(2));
    }

    #[test]
    fn eight_seconds_are_kept() {
        let mut levels = Levels::default();
        for tick in 1..2_000 {
            levels.take(tick, &felt(1.0));
        }
        assert!(levels.felt.len() <= 322, "{}", levels.felt.len());
    }
}
