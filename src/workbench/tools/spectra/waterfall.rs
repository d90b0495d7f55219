//! What both spectrograms share: the texture that scrolls, and the plot around it.
//!
//! Columns are written into a ring texture, as many as are new; scrolling moves only the corners
//! that the texture is read at. Nothing is sent to the graphics card while nothing is new.

use std::ops::Range;

use eframe::egui::{
    Align2, Color32, ColorImage, Context, Mesh, Painter, Pos2, Rangef, Rect, Response, Shape,
    Stroke, TextureHandle, TextureOptions, TextureWrapMode, Ui, pos2,
};

use crate::bench::on_finger::{OnFinger, paint_label};
use crate::bench::signals::history::{Entry, History};
use crate::bench::signals::ring::{ColumnRing, N_COLUMNS, N_SLOTS, slot_of};
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, N_ROWS, Rows, edge_hz, row_at};
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_outer_ticks};
use crate::kit::widgets::text::paint_quiet;
use crate::tools::spectra::Colours;
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::quantity;
use selvedge_render::scene::TICKS_PER_S;
use selvedge_textile::tactile::Band;

/// Width of the numbers on the left, points.
const LEFT: f32 = 34.0;
/// Width of the colour bar with its numbers, points.
const BAR: f32 = 42.0;
/// Height of the units on top, points.
const TOP: f32 = 18.0;
/// Height of the time axis, points.
const BOTTOM: f32 = 18.0;
/// From one part to the next, points.
const GAP: f32 = 8.0;
/// How the texture is read: it goes round.
const READ: TextureOptions = TextureOptions {
    wrap_mode: TextureWrapMode::Repeat,
    ..TextureOptions::LINEAR
};
/// Rows of the texture: the edge rows stand twice, so that no edge mixes with the other.
const N_PIXELS: usize = N_ROWS + 2;

/// The frequency axis of both spectrograms, linear or logarithmic.
pub(crate) fn frequency_axis(is_linear: bool) -> Axis {
    if is_linear {
        Axis::linear(LEAST_HZ, MOST_HZ)
    } else {
        Axis::log(LEAST_HZ, MOST_HZ)
    }
}

/// A column of a spectrogram as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownColumn {
    /// Columns to the left of the newest.
    pub ago: u64,
    /// Its tick.
    pub tick: u64,
    /// Its values, low frequencies first.
    pub rows: Rows,
}

/// The texture of a ring of columns.
#[derive(Clone, Default)]
pub(crate) struct RingImage {
    texture: Option<TextureHandle>,
    n_uploads: u64,
}

impl RingImage {
    /// Forgets the texture: the next upload is of every column.
    pub(crate) fn restart(&mut self) {
        self.texture = None;
    }

    /// How often anything was sent to the graphics card.
    #[cfg(test)]
    pub(crate) fn n_uploads(&self) -> u64 {
        self.n_uploads
    }

    /// Sends the fresh columns of a ring, in the colours of their values; empty ones are clear.
    pub(crate) fn upload(
        &mut self,
        (ctx, name): (&Context, &str),
        ring: &ColumnRing,
        fresh: Range<u64>,
        colour: impl Fn(f32) -> Color32,
    ) {
        let n_fresh = usize::try_from(fresh.end - fresh.start).unwrap_or(N_SLOTS);
        let Some(texture) = &mut self.texture else {
            let image = image_of(ring, 0..N_SLOTS, &colour);
            self.texture = Some(ctx.load_texture(name, image, READ));
            self.n_uploads += 1;
            return;
        };
        let first = slot_of(fresh.start);
        let before_seam = first..(first + n_fresh).min(N_SLOTS);
        let after_seam = 0..(first + n_fresh).saturating_sub(N_SLOTS);
        for slots in [before_seam, after_seam] {
            if !slots.is_empty() {
                let corner = [slots.start, 0];
                texture.set_partial(corner, image_of(ring, slots, &colour), READ);
                self.n_uploads += 1;
            }
        }
    }

    /// Paints the columns before `next` over the picture, the newest at its right edge, with this
    /// much of their ink: a strip for every row, as high as the frequency axis has it.
    fn paint(&self, painter: &Painter, layout: &Layout, next: u64, presence: f32) {
        let Some(texture) = &self.texture else { return };
        let first = slot_of((next + N_SLOTS as u64).saturating_sub(N_COLUMNS as u64));
        let across = |column: usize| column as f32 / N_SLOTS as f32;
        let columns = Rangef::new(across(first), across(first + N_COLUMNS));
        let ink = Color32::WHITE.gamma_multiply(presence);
        let mut mesh = Mesh::with_texture(texture.id());
        for row in 0..N_ROWS {
            let y = |edge: usize| {
                layout
                    .frequencies
                    .y(layout.picture.y_range(), edge_hz(edge))
            };
            // The lowest frequency is the last row of pixels but one.
            let v = |edge: usize| (N_ROWS + 1 - edge) as f32 / N_PIXELS as f32;
            let strip = layout.picture.with_min_y(y(row + 1)).with_max_y(y(row));
            let uv = Rect::from_x_y_ranges(columns, v(row + 1)..=v(row));
            mesh.add_rect_with_uv(strip, uv, ink);
        }
        painter.add(Shape::mesh(mesh));
    }
}

/// A spectrogram: its columns, made for one key and made anew for another, and its texture in the
/// colours that were asked for last.
#[derive(Clone)]
pub(crate) struct Waterfall<K> {
    key: Option<K>,
    colours: Option<Colours>,
    pub(crate) ring: ColumnRing,
    pub(crate) image: RingImage,
}

impl<K> Default for Waterfall<K> {
    fn default() -> Self {
        Self {
            key: None,
            colours: None,
            ring: ColumnRing::default(),
            image: RingImage::default(),
        }
    }
}

impl<K: PartialEq> Waterfall<K> {
    /// Catches up with the history: computes what is new (everything, under a new key), sends it to
    /// the graphics card (everything, in new colours), and asks for another frame while more is
    /// due, which it says. `fill` leaves NaN where there is nothing, which stays clear.
    pub(crate) fn catch_up(
        &mut self,
        (ctx, name): (&Context, &str),
        (history, key): (&History, K),
        (colours, level_db): (Colours, fn(f32) -> f64),
        fill: impl FnMut(&Entry, &mut Rows),
    ) -> bool {
        if self.key.as_ref() != Some(&key) {
            self.key = Some(key);
            self.ring.restart();
            self.image.restart();
        }
        if self.colours.replace(colours) != Some(colours) {
            self.image.restart();
        }
        let progress = self.ring.catch_up(history, fill);
        self.image
            .upload((ctx, name), &self.ring, progress.fresh, |value| {
                colours.of(level_db(value))
            });
        if progress.is_behind {
            ctx.request_repaint();
        }
        progress.is_behind
    }

    /// The columns that are shown, old to new, without pauses and what was not computed.
    pub(crate) fn shown(&self, history: &History) -> Vec<ShownColumn> {
        let next = self.ring.next;
        let first = next.saturating_sub(N_COLUMNS as u64);
        let of = |column: u64| {
            let rows = *self.ring.column(column)?;
            let entry = history.at_column(column)?;
            let is_empty = rows.iter().all(|value| value.is_nan());
            (!is_empty).then_some(ShownColumn {
                ago: next - 1 - column,
                tick: entry.tick_sample.tick,
                rows,
            })
        };
        (first..next).filter_map(of).collect()
    }

    /// Reads the picture at a place.
    pub(crate) fn read(&self, layout: &Layout, at: Pos2) -> Option<Under> {
        read(layout, &self.ring, at)
    }
}

fn image_of(
    ring: &ColumnRing,
    slots: Range<usize>,
    colour: &impl Fn(f32) -> Color32,
) -> ColorImage {
    let width = slots.len();
    let mut pixels = vec![Color32::TRANSPARENT; width * N_PIXELS];
    for (x, slot) in slots.enumerate() {
        let rows = ring.slot(slot);
        for y in 0..N_PIXELS {
            // The top row holds the highest frequency.
            let row = N_ROWS - 1 - y.saturating_sub(1).min(N_ROWS - 1);
            if !rows[row].is_nan() {
                pixels[y * width + x] = colour(rows[row]);
            }
        }
    }
    ColorImage::new([width, N_PIXELS], pixels)
}

/// Where the parts of a spectrogram lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layout {
    /// The picture.
    pub(crate) picture: Rect,
    /// A strip beside it that shares its frequency axis; of no width where none is wanted.
    pub(crate) strip: Rect,
    /// The bar of colours.
    pub(crate) bar: Rect,
    /// The frequencies, along its height.
    pub(crate) frequencies: Axis,
}

impl Layout {
    /// The parts in `all`, with a strip of `strip` points; `None` where there is no room.
    pub(crate) fn of(all: Rect, strip: f32, frequencies: Axis) -> Option<Self> {
        let rows = all.y_range();
        let (top, bottom) = (rows.min + TOP, rows.max - BOTTOM);
        let bar_left = all.right() - BAR;
        let strip_right = bar_left - GAP;
        let right = strip_right - if strip > 0.0 { strip + 4.0 } else { 0.0 };
        let part = |left: f32, right: f32| Rect::from_min_max(pos2(left, top), pos2(right, bottom));
        let layout = Self {
            picture: part(all.left() + LEFT, right),
            strip: part(strip_right - strip, strip_right),
            bar: part(bar_left, bar_left + 8.0),
            frequencies,
        };
        let size = layout.picture.size();
        (size.x >= 24.0 && size.y >= 16.0).then_some(layout)
    }
}

/// Paints a spectrogram with its axes, with what becomes of it on the finger.
pub(crate) fn paint(
    painter: &Painter,
    layout: &Layout,
    (ring, image): (&ColumnRing, &RingImage),
    on_finger: [OnFinger; 2],
) {
    let palette = Palette::of(painter.ctx().theme());
    let picture = layout.picture;
    painter.rect_filled(picture, 0, palette.floor);
    let presence = on_finger.map(OnFinger::presence);
    image.paint(painter, layout, ring.next, presence[0].max(presence[1]));
    paint_label(painter, picture, on_finger);
    let axis = layout.frequencies;
    let ticks = axis.ticks(picture.height(), 18.0);
    paint_outer_ticks(painter, picture, (&axis, Side::Left), &ticks);
    let unit_at = pos2(picture.left() - 5.0, picture.top() - 6.0);
    paint_quiet(painter, unit_at, Align2::RIGHT_BOTTOM, "Hz");
    paint_time(painter, picture);
}

/// Marks the carriers at the right edge of a picture, in their bands' colours.
pub(crate) fn paint_carriers(painter: &Painter, layout: &Layout) {
    let palette = Palette::of(painter.ctx().theme());
    let picture = layout.picture;
    for band in Band::ALL {
        let y = layout.frequencies.y(picture.y_range(), band.carrier_hz());
        let y = painter.round_to_pixel_center(y);
        let across = picture.right() + 1.0..=picture.right() + 5.0;
        painter.hline(across, y, Stroke::new(2.0, palette.band(band)));
    }
}

fn paint_time(painter: &Painter, picture: Rect) {
    let shown_s = N_COLUMNS as f64 / TICKS_PER_S;
    let axis = Axis::linear(-shown_s, 0.0);
    let is_wide = picture.width() >= 240.0;
    let between = if is_wide {
        &[-6.0, -4.0, -2.0][..]
    } else {
        &[-4.0]
    };
    let mut ticks = vec![Tick::named(-shown_s, "8 s ago"), Tick::named(0.0, "now")];
    for &time_s in between {
        ticks.push(Tick::named(time_s, &quantity::fixed(-time_s, 0)));
    }
    paint_outer_ticks(painter, picture, (&axis, Side::Bottom), &ticks);
}

/// What lies under the pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Under {
    /// How long ago in felt time, s.
    pub(crate) ago_s: f64,
    /// The frequency there, Hz.
    pub(crate) frequency_hz: f64,
    /// The value there; `None` in a pause and before anything was felt.
    pub(crate) value: Option<f32>,
}

/// Reads the picture at a place.
fn read(layout: &Layout, ring: &ColumnRing, at: Pos2) -> Option<Under> {
    let picture = layout.picture;
    if !picture.contains(at) {
        return None;
    }
    let axis = layout.frequencies;
    let frequency_hz = axis.value_at_y(picture.y_range(), at.y);
    let n_columns = N_COLUMNS as f32;
    let from_right = ((picture.right() - at.x) / picture.width()).clamp(0.0, 1.0) * n_columns;
    let back = to_index(f64::from(from_right.floor().min(n_columns - 1.0))) as u64;
    let rows = (ring.next.checked_sub(back + 1)).and_then(|column| ring.column(column));
    let value = rows.map(|rows| rows[row_at(frequency_hz)]);
    Some(Under {
        ago_s: back as f64 / TICKS_PER_S,
        frequency_hz,
        value: value.filter(|value| !value.is_nan()),
    })
}

/// Says what is under the pointer, with a cross there.
pub(crate) fn describe(
    ui: &Ui,
    response: Response,
    layout: &Layout,
    words: impl FnOnce() -> String,
) {
    let Some(at) = response.hover_pos() else {
        return;
    };
    if layout.picture.contains(at) {
        let palette = Palette::in_ui(ui);
        let stroke = Stroke::new(1.0, palette.selection.gamma_multiply(0.35));
        ui.painter().hline(layout.picture.x_range(), at.y, stroke);
        ui.painter().vline(at.x, layout.picture.y_range(), stroke);
        response.on_hover_text_at_pointer(words());
    }
}

/// The lines of a hover text that both spectrograms begin with.
pub(crate) fn place_words(under: &Under) -> String {
    format!(
        "{} ago in felt time, {}",
        quantity::with_unit(under.ago_s, 2, "s"),
        quantity::with_unit(under.frequency_hz, 0, "Hz")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::vec2;
    use selvedge_engine::TickSample;

    fn layout(width: f32, height: f32) -> Option<Layout> {
        let all = Rect::from_min_size(pos2(3.0, 5.0), vec2(width, height));
        Layout::of(all, 40.0, frequency_axis(false))
    }

    #[test]
    fn the_parts_have_room_or_are_not_there() {
        for (width, height) in [(400.0, 210.0), (300.0, 150.0), (800.0, 500.0)] {
            let layout = layout(width, height).unwrap();
            assert!(layout.picture.right() < layout.strip.left(), "{width}");
            assert!(layout.strip.right() < layout.bar.left(), "{width}");
            assert_eq!(layout.strip.width(), 40.0);
            assert_eq!(layout.picture.y_range(), layout.strip.y_range());
        }
        for (width, height) in [(0.0, 0.0), (100.0, 300.0), (300.0, 40.0), (f32::NAN, 9.0)] {
            assert_eq!(layout(width, height), None);
        }
    }

    #[test]
    fn the_picture_reads_newest_right_and_high_up() {
        let (mut ring, mut history) = (ColumnRing::default(), History::default());
        for tick in [1, 2, 3, 90, 91] {
            history.take(TickSample {
                tick,
                ..TickSample::default()
            });
        }
        ring.catch_up(&history, |entry, rows| {
            let tick = f32::from(u16::try_from(entry.tick_sample.tick).unwrap());
            rows.iter_mut()
                .zip(0_u8..)
                .for_each(|(row, i)| *row = tick + f32::from(i) / 100.0);
        });
        let layout = layout(400.0, 210.0).unwrap();
        let picture = layout.picture;
        let column = picture.width() / N_COLUMNS as f32;
        let at = |back: f32, y: f32| pos2(picture.right() - (back + 0.5) * column, y);
        let value = |back, y| read(&layout, &ring, at(back, y)).unwrap().value;
        assert_eq!(value(0.0, picture.bottom() - 0.1), Some(91.0));
        assert_eq!(value(1.0, picture.top() + 0.1), Some(90.95));
        assert_eq!(value(2.0, picture.center().y), None, "the pause");
        assert_eq!(value(3.0, picture.bottom() - 0.1), Some(3.0));
        assert_eq!(value(100.0, picture.center().y), None, "before the first");
        let under = read(&layout, &ring, at(4.0, picture.center().y)).unwrap();
        assert_eq!(under.ago_s, 0.1);
        assert!((under.frequency_hz - 100.0).abs() < 0.1, "{under:?}");
        assert_eq!(read(&layout, &ring, picture.max + vec2(1.0, 0.0)), None);
        let linear = Layout {
            frequencies: frequency_axis(true),
            ..layout
        };
        let under = read(&linear, &ring, at(4.0, picture.center().y)).unwrap();
        assert!((under.frequency_hz - 505.0).abs() < 2.0, "{under:?}");
    }
}
