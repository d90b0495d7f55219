//! Axes of pictures, which charts have no part in: where a number lies along a line, which round
//! numbers are named on it, and the painting of ticks beside a picture.
//!
//! It knows nothing of what is plotted.

use eframe::egui::{Color32, Painter, Pos2, Rangef, Rect, Stroke, pos2, vec2};

use crate::kit::theme;
use crate::kit::theme::Palette;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// Most ticks that an axis ever has.
const MAX_TICKS: usize = 64;
/// From a plot's edge to the letters of its ticks, points.
const LETTER_GAP: f32 = 5.0;

/// A range of numbers along a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    least: f64,
    /// Its upper end.
    pub(crate) most: f64,
    is_log: bool,
}

/// A side of a plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Numbers left of the plot.
    Left,
    /// Numbers right of it.
    Right,
    /// Numbers below it.
    Bottom,
}

/// A number that an axis names.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    /// Where it stands.
    pub value: f64,
    /// What is written there.
    pub label: String,
}

impl Tick {
    /// A tick with a text of its own.
    pub(crate) fn named(value: f64, label: &str) -> Self {
        let label = label.to_owned();
        Self { value, label }
    }

    /// A tick with its number, as many decimals as the number needs at two digits.
    pub(crate) fn number(value: f64) -> Self {
        let label = quantity::fixed(value, decimals_of(value.abs()));
        Self { value, label }
    }
}

impl Axis {
    /// An even axis. Ends that make no range become one around the lower end, or 0…1.
    pub(crate) fn linear(least: f64, most: f64) -> Self {
        let is_log = false;
        let span = most - least;
        if least.is_finite() && span > 0.0 && span.is_finite() {
            return Self {
                least,
                most,
                is_log,
            };
        }
        let least = if least.is_finite() { least } else { 0.0 };
        Self {
            least,
            most: least + least.abs().max(1.0),
            is_log,
        }
    }

    /// A logarithmic axis. Ends that make no range become the decade above the lower end, or 1…10.
    pub(crate) fn log(least: f64, most: f64) -> Self {
        let is_log = true;
        let is_end = |end: f64| end > f64::MIN_POSITIVE && end < f64::MAX * 0.1;
        let least = if is_end(least) { least } else { 1.0 };
        let most = if is_end(most) && most > least {
            most
        } else {
            10.0 * least
        };
        Self {
            least,
            most,
            is_log,
        }
    }

    /// Where a number lies: 0 at the lower end, 1 at the upper, beyond them below 0 and above 1.
    /// What lies nowhere (NaN; 0 on a logarithmic axis) is far below the lower end.
    pub(crate) fn share(&self, value: f64) -> f64 {
        let share = if self.is_log {
            (value / self.least).ln() / (self.most / self.least).ln()
        } else {
            (value - self.least) / (self.most - self.least)
        };
        if share.is_nan() {
            return -1e3;
        }
        share.clamp(-1e3, 1e3)
    }

    /// The number at a share.
    pub(crate) fn value(&self, share: f64) -> f64 {
        if self.is_log {
            self.least * (self.most / self.least).powf(share)
        } else {
            self.least + (self.most - self.least) * share
        }
    }

    /// The number's place in a horizontal range, points.
    pub(crate) fn x(&self, range: Rangef, value: f64) -> f32 {
        range.min + to_single(self.share(value)) * range.span()
    }

    /// The number's place in a vertical range (the lower end of the axis at the bottom), points.
    pub(crate) fn y(&self, range: Rangef, value: f64) -> f32 {
        range.max - to_single(self.share(value)) * range.span()
    }

    /// The number at a horizontal place.
    pub(crate) fn value_at_x(&self, range: Rangef, x: f32) -> f64 {
        self.value(f64::from((x - range.min) / range.span().max(1e-3)))
    }

    /// The number at a vertical place.
    pub(crate) fn value_at_y(&self, range: Rangef, y: f32) -> f64 {
        self.value(f64::from((range.max - y) / range.span().max(1e-3)))
    }

    /// Round numbers on an axis `length` points long, at least `apart` points from one another:
    /// steps of 1, 2 or 5 on an even axis; 1, 2, 5 of each decade, or whole decades, or every
    /// second decade …, on a logarithmic one.
    pub(crate) fn ticks(&self, length: f32, apart: f32) -> Vec<Tick> {
        let room = f64::from(length / apart.max(1.0)).max(1.0);
        let values = if self.is_log {
            self.log_values(room)
        } else {
            self.even_values(room)
        };
        values.into_iter().map(Tick::number).collect()
    }

    fn even_values(&self, room: f64) -> Vec<f64> {
        let step = round_step((self.most - self.least) / room);
        let first = (self.least / step - 1e-9).ceil();
        let values = (0..MAX_TICKS).map(|i| (first + i as f64) * step);
        let end = self.most + 1e-9 * step;
        values.take_while(|value| *value <= end).collect()
    }

    fn log_values(&self, room: f64) -> Vec<f64> {
        let n_decades = (self.most / self.least).log10();
        let first = self.least.log10().floor();
        let of_decade: &[f64] = if 3.4 * n_decades <= room {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        let stride = (n_decades / room).ceil().max(1.0);
        let decades = (0..MAX_TICKS).map(|i| first + i as f64);
        let whole = decades.filter(|decade| of_decade.len() > 1 || decade.rem_euclid(stride) < 0.5);
        let all = whole.flat_map(|decade| of_decade.iter().map(move |f| f * 10_f64.powf(decade)));
        let is_within =
            |value: &f64| *value >= self.least * 0.999_999 && *value <= self.most * 1.000_001;
        all.filter(is_within).take(MAX_TICKS).collect()
    }
}

/// The least of 1, 2, 5 · 10ⁿ that is not below `step`; 1 for what is no positive number.
pub(crate) fn round_step(step: f64) -> f64 {
    if !(step > 0.0 && step.is_finite()) {
        return 1.0;
    }
    let decade = 10_f64.powf(step.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|f| f * decade);
    let fitting = steps
        .into_iter()
        .find(|round| *round >= step * (1.0 - 1e-9));
    fitting.unwrap_or(step)
}

/// Decimals that show the first digit of a number, two at 0.2x, none from 1 up.
fn decimals_of(magnitude: f64) -> usize {
    let is_whole = |scale: f64| ((magnitude * scale).round() - magnitude * scale).abs() < 1e-6;
    [1.0, 10.0, 100.0, 1e3, 1e4]
        .iter()
        .position(|scale| is_whole(*scale) && (magnitude * scale >= 0.5 || magnitude < 1e-12))
        .unwrap_or(4)
}

/// Paints short strokes outside a plot at the ticks of an axis, and their numbers behind them:
/// beside pictures, which hairlines would cut.
pub(crate) fn paint_outer_ticks(
    painter: &Painter,
    plot: Rect,
    (axis, side): (&Axis, Side),
    ticks: &[Tick],
) {
    let palette = Palette::of(painter.ctx().theme());
    let stroke = Stroke::new(1.0, palette.line);
    for tick in ticks {
        let at = place_of(plot, axis, side, tick.value);
        let at = pos2(
            painter.round_to_pixel_center(at.x),
            painter.round_to_pixel_center(at.y),
        );
        let out = match side {
            Side::Left => vec2(-3.0, 0.0),
            Side::Right => vec2(3.0, 0.0),
            Side::Bottom => vec2(0.0, 3.0),
        };
        painter.line_segment([at, at + out], stroke);
        paint_label(painter, plot, (at, side), &tick.label, palette.dim);
    }
}

/// Writes a label at a place on a side of a plot, moved inwards where it would leave the plot's
/// length.
fn paint_label(painter: &Painter, plot: Rect, (at, side): (Pos2, Side), label: &str, ink: Color32) {
    let text = painter.layout_no_wrap(label.to_owned(), theme::small_number(), ink);
    let half = 0.5 * text.size();
    let centre = match side {
        Side::Left => pos2(plot.left() - LETTER_GAP - half.x, at.y),
        Side::Right => pos2(plot.right() + LETTER_GAP + half.x, at.y),
        Side::Bottom => pos2(at.x, plot.bottom() + 3.0 + half.y),
    };
    let within = |place: f32, range: Rangef, half: f32| {
        place.clamp(range.min + half, (range.max - half).max(range.min + half))
    };
    let centre = match side {
        // Half a letter may stand out above and below: the number stays beside its place.
        Side::Left | Side::Right => pos2(
            centre.x,
            within(centre.y, plot.y_range().expand(2.0), half.y),
        ),
        Side::Bottom => pos2(within(centre.x, plot.x_range(), half.x), centre.y),
    };
    painter.galley(centre - half, text, ink);
}

fn place_of(plot: Rect, axis: &Axis, side: Side, value: f64) -> Pos2 {
    match side {
        Side::Left => pos2(plot.left(), axis.y(plot.y_range(), value)),
        Side::Right => pos2(plot.right(), axis.y(plot.y_range(), value)),
        Side::Bottom => pos2(axis.x(plot.x_range(), value), plot.bottom()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis, length: f32, apart: f32) -> Vec<String> {
        let ticks = axis.ticks(length, apart);
        ticks.into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn even_ticks_are_round_and_have_room() {
        let axis = Axis::linear(-40.0, 20.0);
        assert_eq!(labels(axis, 160.0, 50.0), ["−40", "−20", "0", "20"]);
        assert_eq!(labels(Axis::linear(0.0, 0.5), 100.0, 50.0), ["0", "0.5"]);
        assert_eq!(labels(Axis::linear(-0.1, 0.1), 100.0, 30.0).len(), 3);
    }

    #[test]
    fn logarithmic_ticks_thin_out_with_the_room() {
        let axis = Axis::log(10.0, 1000.0);
        let all = ["10", "20", "50", "100", "200", "500", "1000"];
        assert_eq!(labels(axis, 160.0, 18.0), all);
        assert_eq!(labels(axis, 80.0, 18.0), ["10", "100", "1000"]);
        let wavenumbers = Axis::log(0.23, 115.0);
        assert_eq!(labels(wavenumbers, 100.0, 30.0), ["1", "10", "100"]);
        assert_eq!(labels(wavenumbers, 300.0, 20.0)[0], "0.5");
        assert_eq!(labels(Axis::log(1e-8, 1e2), 90.0, 30.0).len(), 3);
    }

    #[test]
    fn a_share_and_its_number_undo_each_other() {
        for axis in [Axis::log(10.0, 1000.0), Axis::linear(-3.0, 8.0)] {
            for share in [0.0, 0.25, 1.0] {
                assert!(
                    (axis.share(axis.value(share)) - share).abs() < 1e-12,
                    "{share}"
                );
            }
            let range = Rangef::new(10.0, 210.0);
            let value = axis.value_at_y(range, 60.0);
            assert!((axis.y(range, value) - 60.0).abs() < 1e-3, "{value}");
        }
    }

    #[test]
    fn senseless_numbers_and_ranges_are_harmless() {
        let nan = f64::NAN;
        for (least, most) in [(1.0, 1.0), (nan, 2.0), (2.0, -1.0), (0.0, f64::INFINITY)] {
            for axis in [Axis::log(least, most), Axis::linear(least, most)] {
                assert!(axis.most > axis.least, "{axis:?}");
                let ticks = axis.ticks(0.0, 0.0);
                assert!(ticks.len() <= MAX_TICKS, "{axis:?}: {}", ticks.len());
            }
        }
        for value in [0.0, nan, -1.0, f64::INFINITY] {
            let share = Axis::log(1.0, 10.0).share(value);
            assert!(share.is_finite(), "{value}: {share}");
        }
        assert_eq!(round_step(nan), 1.0);
        assert_eq!(round_step(0.03), 0.05);
    }
}
