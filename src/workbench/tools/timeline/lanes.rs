//! The lanes, one above the other over the same time: ruler, spectrum, both bands of every
//! contactor, speed and levels.

use std::ops::Range;

use eframe::egui::{Align2, Color32, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};

use crate::bench::on_finger::OnFinger;
use crate::bench::recording::tiles::Tiles;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, N_ROWS, row_at};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::spectrum_scale::SpectrumScale;
use crate::kit::texture::{WHOLE, paint};
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::theme::{self, Palette};
use crate::tools::timeline::axes::{self, LEVELS_DB, round_above};
use crate::tools::timeline::code::{finger_of, level_of, speed_of, table};
use crate::tools::timeline::columns::{N_LINES, ON_FINGER};
use crate::tools::timeline::picture::{
    Columns, Drawing, LineInks, Picture, even_rows, gap_colours,
};
use crate::tools::timeline::span::Span;
use crate::tools::timeline::transport::TICK_MS;
use selvedge_foundation::numerics::{to_index, to_single};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Space for names on the left and for scales on the right, points.
const GUTTERS: [f32; 2] = [86.0, 46.0];
/// Height of the ruler, points.
const RULER: f32 = 16.0;
/// From a lane to the next, points.
const GAP: f32 = 2.0;
/// Shares of the height: spectrum, A40, A320, lines.
const SHARES: [f32; 4] = [0.4, 0.18, 0.18, 0.24];
/// Words of the ruler stand at least this far apart, points.
const APART: f32 = 6.0;

/// A lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lane {
    /// What arrives at the contactor.
    Spectrum,
    /// A band of every contactor.
    Raster(Band),
    /// Speed, mean levels, limits and missing ticks.
    Lines,
}

/// Every lane, from top to bottom.
pub(crate) const LANES: [Lane; 4] = [
    Lane::Spectrum,
    Lane::Raster(Band::Low),
    Lane::Raster(Band::High),
    Lane::Lines,
];

/// Where everything lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layout {
    /// The ruler.
    pub(crate) ruler: Rect,
    /// The lanes in the order of [`LANES`].
    pub(crate) lanes: [Rect; 4],
}

impl Layout {
    /// The parts of `rect`; `None` where there is no room.
    pub(crate) fn of(rect: Rect) -> Option<Self> {
        let (left, right) = (rect.left() + GUTTERS[0], rect.right() - GUTTERS[1]);
        let top = rect.top() + RULER;
        let room = rect.bottom() - top - 3.0 * GAP;
        if !(right - left > 40.0 && room > 24.0) {
            return None;
        }
        let mut next = top;
        let lanes = SHARES.map(|share| {
            let bottom = next + (share * room).round();
            let lane = Rect::from_min_max(pos2(left, next), pos2(right, bottom));
            next = bottom + GAP;
            lane
        });
        let ruler = Rect::from_min_max(pos2(left, rect.top()), pos2(right, top));
        Some(Self { ruler, lanes })
    }

    /// All lanes.
    pub(crate) fn body(&self) -> Rect {
        self.lanes[0].union(self.lanes[3])
    }

    /// The lane at a place.
    pub(crate) fn lane_at(&self, at: Pos2) -> Option<(Lane, Rect)> {
        let mut lanes = LANES.into_iter().zip(self.lanes);
        lanes.find(|(_, rect)| rect.contains(at))
    }

    /// Where a share of the width stands.
    pub(crate) fn x_at(&self, share: f64) -> f32 {
        let share = to_single(share.clamp(-1.0, 2.0));
        self.ruler.left() + share * self.ruler.width()
    }

    /// The share of the width at a place.
    pub(crate) fn share_at(&self, x: f32) -> f64 {
        f64::from((x - self.ruler.left()) / self.ruler.width())
    }
}

/// Space for the name of a lane.
pub(crate) fn name_of(lane: Rect) -> Rect {
    let left = lane.left() - GUTTERS[0];
    Rect::from_min_max(
        pos2(left, lane.top()),
        pos2(lane.left() - 5.0, lane.bottom()),
    )
}

/// How lanes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LaneStyle {
    /// The colours.
    pub(crate) map: ColourMap,
    /// The scale of amplitudes.
    pub(crate) scale: AmplitudeScale,
    /// The scale of the spectrum.
    pub(crate) spectrum: SpectrumScale,
}

/// The pictures of the lanes.
#[derive(Default)]
pub(crate) struct Pictures {
    spectrum: Columns,
    felt: Columns,
    lanes: [Picture; 4],
}

impl Pictures {
    /// Makes what has changed and paints all lanes; gives the end of the speed axis, mm/s.
    pub(crate) fn paint(
        &mut self,
        ui: &Ui,
        (layout, style): (&Layout, &LaneStyle),
        (felt, spectrum): (&Tiles, &Tiles),
        (of, span): (u64, Span),
    ) -> f64 {
        let scale = ui.ctx().pixels_per_point();
        let n_columns = n_pixels(layout.ruler.width() * scale);
        self.felt.follow(felt, of, (span, n_columns));
        self.spectrum.follow(spectrum, of, (span, n_columns));
        let fastest = self.felt.each().filter_map(|rows| speed_of(*rows.first()?));
        let top = round_above(fastest.fold(0.0, f64::max));
        let palette = Palette::in_ui(ui);
        let n_contactors = felt.n_rows.saturating_sub(N_LINES) / 2;
        for ((lane, rect), picture) in LANES.into_iter().zip(layout.lanes).zip(&mut self.lanes) {
            let height = n_pixels(rect.height() * scale);
            let drawing = drawing(lane, style, palette, (height, n_contactors, top));
            let columns = match lane {
                Lane::Spectrum => &self.spectrum,
                Lane::Raster(_) | Lane::Lines => &self.felt,
            };
            ui.painter().rect_filled(rect, 0, palette.floor);
            let texture = picture.follow(ui.ctx(), (columns, height), &drawing);
            paint(ui.painter(), rect, WHOLE, texture);
        }
        self.veil(ui.painter(), layout, palette);
        top
    }

    /// Dims what the finger did not get, as every view does.
    fn veil(&self, painter: &Painter, layout: &Layout, palette: &Palette) {
        let n_columns = self.felt.each().len();
        let got = |rows: &[u8]| finger_of(rows.get(ON_FINGER).copied()?);
        let codes: Vec<Option<OnFinger>> = self.felt.each().map(got).collect();
        let mut x = 0;
        for run in codes.chunk_by(|a, b| a == b) {
            let ends = [x, x + run.len()].map(|x| layout.x_at(x as f64 / n_columns as f64));
            x += run.len();
            let Some(Some(on_finger)) = run.first() else {
                continue;
            };
            let ink = palette.floor.gamma_multiply(1.0 - on_finger.presence());
            for lane in layout.lanes {
                let part = Rect::from_x_y_ranges(ends[0]..=ends[1], lane.y_range());
                painter.rect_filled(part, 0, ink);
            }
        }
    }

    /// How often pictures were made.
    #[cfg(test)]
    pub(crate) fn n_uploads(&self) -> u64 {
        self.lanes.iter().map(|lane| lane.n_made).sum()
    }
}

fn drawing(
    lane: Lane,
    style: &LaneStyle,
    palette: &Palette,
    (height, n_contactors, top_mm_per_s): (usize, usize, f64),
) -> Drawing {
    let colours = |share: &dyn Fn(f64) -> f64| {
        let colour = |code| match level_of(code) {
            None | Some(f64::NEG_INFINITY) => palette.floor,
            Some(level_db) => style.map.colour(share(level_db)),
        };
        Box::new(table(colour))
    };
    let gap = gap_colours(palette);
    match lane {
        Lane::Spectrum => Drawing::Raster {
            rows: spectrum_rows(height, style.spectrum.is_linear),
            colours: colours(&|level_db| style.spectrum.levels.share(level_db)),
            gap,
        },
        Lane::Raster(band) => Drawing::Raster {
            rows: even_rows(N_LINES + band.index() * n_contactors, n_contactors, height),
            colours: colours(&|level_db| style.scale.share(quantity::factor_of_gain(level_db))),
            gap,
        },
        Lane::Lines => Drawing::Lines(LineInks::of(palette, to_index(top_mm_per_s.round()))),
    }
}

/// The rows of each pixel of the spectrum, high frequencies on top.
fn spectrum_rows(height: usize, is_linear: bool) -> Vec<Range<usize>> {
    let row = |share: f64| row_at(frequency_at(share, is_linear));
    let of = |y: usize| {
        let share = |y: usize| 1.0 - y as f64 / height as f64;
        let (low, high) = (row(share(y + 1)), row(share(y) - 1e-9));
        low..(high + 1).min(N_ROWS)
    };
    (0..height).map(of).collect()
}

/// The frequency at a share of the height, Hz.
pub(crate) fn frequency_at(share: f64, is_linear: bool) -> f64 {
    if is_linear {
        share * MOST_HZ
    } else {
        LEAST_HZ * (MOST_HZ / LEAST_HZ).powf(share)
    }
}

fn n_pixels(length: f32) -> usize {
    to_index(f64::from(length.round().clamp(1.0, 16_384.0)))
}

/// Names and axes beside the lanes.
pub(crate) fn paint_axes(ui: &Ui, layout: &Layout, style: &LaneStyle, top_mm_per_s: f64) {
    let (palette, painter) = (Palette::in_ui(ui), ui.painter());
    let write = |at: Pos2, anchor: Align2, words: &str, ink: Color32| {
        painter.text(at, anchor, words, theme::small_number(), ink);
    };
    for (lane, rect) in LANES.into_iter().zip(layout.lanes) {
        let (left, right) = (rect.left() - 5.0, rect.right() + 5.0);
        let ends = |top: &str, bottom: &str, x: f32, anchor| {
            write(pos2(x, rect.top() + 4.0), anchor, top, palette.dim);
            if rect.height() > 22.0 {
                write(pos2(x, rect.bottom() - 4.0), anchor, bottom, palette.dim);
            }
        };
        match lane {
            Lane::Spectrum => {
                let least = if style.spectrum.is_linear {
                    "0"
                } else {
                    "10 Hz"
                };
                ends("1 kHz", least, left, Align2::RIGHT_CENTER);
            }
            Lane::Raster(band) => {
                let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
                let at = pos2(left, rect.center().y);
                write(at, Align2::RIGHT_CENTER, &name, palette.band(band));
            }
            Lane::Lines => {
                let [least, most] = LEVELS_DB.map(|level_db| quantity::fixed(level_db, 0));
                ends(&format!("{most} dB"), &least, left, Align2::RIGHT_CENTER);
                let top = quantity::fixed(top_mm_per_s, 0);
                ends(&top, "mm/s", right, Align2::LEFT_CENTER);
            }
        }
    }
}

/// Time marks on the ruler and through the lanes. `all` ends where the newest of what is felt is;
/// a recording is counted from its first tick.
pub(crate) fn paint_times(painter: &Painter, layout: &Layout, span: Span, newest: Option<f64>) {
    let palette = Palette::of(painter.ctx().theme());
    let tick_ms = TICK_MS as f64;
    let origin = newest.unwrap_or(0.0);
    let [start_ms, end_ms] = [span.start, span.end].map(|place| (place - origin) * tick_ms);
    let step = axes::step_ms(
        to_index((end_ms - start_ms).round()) as u64,
        layout.ruler.width(),
    );
    let step_ms = step as f64;
    let mut free = layout.ruler.left();
    let mut nth = (start_ms / step_ms).ceil();
    while nth * step_ms <= end_ms {
        let time_ms = nth * step_ms;
        nth += 1.0;
        let x = layout.x_at((time_ms - start_ms) / (end_ms - start_ms));
        let x = painter.round_to_pixel_center(x);
        let hairline = Stroke::new(1.0, palette.hairline.gamma_multiply(0.7));
        painter.vline(x, layout.body().y_range(), hairline);
        let foot = layout.ruler.bottom() - 4.0..=layout.ruler.bottom();
        painter.vline(x, foot, Stroke::new(1.0, palette.line));
        let words = axes::time_words(to_index(time_ms.abs().round()) as u64, step);
        let words = if time_ms < 0.0 {
            format!("−{words}")
        } else {
            words
        };
        let galley = painter.layout_no_wrap(words, theme::small_number(), palette.dim);
        let place = Align2::CENTER_CENTER
            .anchor_size(pos2(x, layout.ruler.center().y - 2.0), galley.size());
        let shift = (free - place.left()).max(0.0);
        if shift < 0.6 * place.width() && place.right() + shift <= layout.ruler.right() + 20.0 {
            painter.galley(place.min + vec2(shift, 0.0), galley, palette.dim);
            free = place.right() + shift + APART;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_share_their_room_and_none_is_where_there_is_none() {
        let rect = Rect::from_min_size(pos2(3.0, 4.0), vec2(900.0, 132.0));
        let layout = Layout::of(rect).unwrap();
        for pair in layout.lanes.windows(2) {
            assert_eq!(pair[0].bottom() + GAP, pair[1].top());
            assert_eq!(pair[0].x_range(), layout.ruler.x_range());
        }
        assert!(layout.body().bottom() <= rect.bottom() + 2.0);
        for (width, height) in [(0.0, 0.0), (120.0, 200.0), (900.0, 30.0), (f32::NAN, 90.0)] {
            let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
            assert_eq!(Layout::of(rect), None);
        }
    }

    #[test]
    fn every_frequency_has_its_pixel_on_both_axes() {
        for is_linear in [false, true] {
            let rows = spectrum_rows(60, is_linear);
            assert_eq!(rows[0].end, N_ROWS, "1 kHz is on top");
            assert_eq!(rows[59].start, 0, "10 Hz is at the bottom");
            for row in 0..N_ROWS {
                assert!(rows.iter().any(|rows| rows.contains(&row)), "{row}");
            }
        }
        assert_eq!(frequency_at(0.5, true), 500.0);
        assert!((frequency_at(0.5, false) - 100.0).abs() < 1e-9);
    }
}
