//! Where things stand on a stage of any size and proportion: cloths above, bars beside or below
//! them, a row of buttons, a strip with one sentence. Pure.

use eframe::egui::{Rect, pos2, vec2};

use selvedge_foundation::numerics::to_single;

/// The shorter side of the screen that sizes are given for, points.
const DESIGN: f32 = 1080.0;
/// How much larger letters are where they were asked to be.
const LARGE: f32 = 1.5;
/// Of the height that cloths take at most while the screen is wide.
const CLOTHS: f32 = 0.76;

/// Heights in points of the screen that sizes are given for: strip, words, labels.
const STRIP: f32 = 120.0;
const WORDS: f32 = 38.0;
const LABEL: f32 = 26.0;
/// Between bars and the edge of the screen, points.
const EDGE: f32 = 40.0;
/// Room for bars beside cloths, and below them.
const BARS_ACROSS: f32 = 330.0;
const BARS_DOWN: f32 = 190.0;

/// The parts of the screen, points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layout {
    /// All of it.
    pub(crate) whole: Rect,
    /// Everything above the buttons.
    pub(crate) area: Rect,
    /// The square that shows the cloths.
    pub(crate) square: Rect,
    /// The two bars.
    pub(crate) bars: Rect,
    /// The row of buttons.
    pub(crate) row: Rect,
    /// The strip at the bottom.
    pub(crate) strip: Rect,
    /// Size of words and labels.
    pub(crate) words: f32,
    pub(crate) label: f32,
    /// A point of the screen that sizes are given for.
    pub(crate) unit: f32,
    /// A millimetre.
    pub(crate) mm: f32,
}

impl Layout {
    /// On a screen as wide as this; `is_large`: with larger letters.
    pub(crate) fn of(whole: Rect, screen_width_mm: f64, is_large: bool) -> Self {
        let unit = whole.width().min(whole.height()) / DESIGN;
        let mm = whole.width().max(whole.height()) / to_single(screen_width_mm);
        let zoom = if is_large { LARGE } else { 1.0 };
        let gap = 8.0 * unit;
        let strip_height = (zoom * STRIP * unit).max(32.0 * mm);
        let strip = whole.with_min_y(whole.bottom() - strip_height);
        let row_height = 26.0 * mm;
        let row = Rect::from_min_max(
            pos2(whole.left(), strip.top() - row_height),
            pos2(whole.right(), strip.top()),
        );
        let area = whole.with_max_y(row.top() - gap).shrink(gap);
        let (across, down) = (zoom * BARS_ACROSS * unit, zoom * BARS_DOWN * unit);
        let is_wide = area.width() >= area.height();
        let side = if is_wide {
            let side = area.height().min(CLOTHS * whole.height());
            side.min(area.width() - across)
        } else {
            area.width().min(area.height() - down)
        };
        let free = area.size() - vec2(side, side);
        let (square, bars) = if is_wide {
            let left = (0.5 * free.x).min(free.x - across);
            let top = area.top() + 0.5 * free.y;
            let square = Rect::from_min_size(pos2(area.left() + left, top), vec2(side, side));
            let beside = Rect::from_min_max(
                pos2(square.right() + 2.0 * gap, square.top()),
                pos2(area.right(), square.bottom()),
            );
            (square, beside.shrink2(vec2(0.0, 0.5 * (side - down))))
        } else {
            let top = area.top() + 0.5 * (free.y - down).max(0.0);
            let at = pos2(area.center().x - 0.5 * side, top);
            let square = Rect::from_min_size(at, vec2(side, side));
            let bars = square.translate(vec2(0.0, side + gap));
            (square, bars.with_max_y(bars.top() + down - gap))
        };
        let bars = bars.intersect(whole.shrink(EDGE * unit));
        Self {
            whole,
            area,
            square,
            bars,
            row,
            strip,
            words: zoom * WORDS * unit,
            label: zoom * LABEL * unit,
            unit,
            mm,
        }
    }

    /// `n` places of a row from its middle, each so wide and high, mm.
    pub(crate) fn places<const N: usize>(
        &self,
        row: Rect,
        [width_mm, height_mm]: [f32; 2],
    ) -> [Rect; N] {
        let gap = 16.0 * self.unit;
        let n = N as f32;
        let width = (width_mm * self.mm).min((row.width() - (n + 1.0) * gap) / n);
        let size = vec2(width, (height_mm * self.mm).min(row.height()));
        let left = row.center().x - 0.5 * (n * width + (n - 1.0) * gap);
        let mut nth = 0.0;
        [(); N].map(|()| {
            let at = pos2(left + nth * (width + gap), row.center().y - 0.5 * size.y);
            nth += 1.0;
            Rect::from_min_size(at, size)
        })
    }

    /// The middle picture of a round, and the four around it.
    pub(crate) fn round(&self) -> (Rect, [Rect; 4]) {
        let area = self.area;
        let is_wide = area.width() >= area.height();
        let gap = 24.0 * self.unit;
        let (long, short) = if is_wide {
            (area.width(), area.height())
        } else {
            (area.height(), area.width())
        };
        let side = (0.5 * (short - gap)).min((long - 4.0 * gap) / 3.2);
        let middle = (1.2 * side).min(short);
        let centre = area.center();
        let from_middle = 0.5 * middle + 2.0 * gap + 0.5 * side;
        let apart = 0.5 * (side + gap);
        let pictures = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(|[x, y]| {
            let off = if is_wide {
                vec2(x * from_middle, y * apart)
            } else {
                vec2(x * apart, y * from_middle)
            };
            Rect::from_center_size(centre + off, vec2(side, side))
        });
        (
            Rect::from_center_size(centre, vec2(middle, middle)),
            pictures,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_overlaps_or_leaves_the_screen_whatever_its_size() {
        for (width, height) in [
            (1280.0, 720.0),
            (1920.0, 1080.0),
            (3840.0, 2160.0),
            (1080.0, 1920.0),
            (1280.0, 1024.0),
            (853.0, 480.0),
        ] {
            for is_large in [false, true] {
                let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
                let layout = Layout::of(whole, 531.0, is_large);
                let parts = [layout.square, layout.bars, layout.row, layout.strip];
                for (nth, part) in parts.iter().enumerate() {
                    let why = format!("{width} × {height}, large {is_large}: {layout:?}");
                    assert!(whole.contains_rect(*part) && part.is_positive(), "{why}");
                    for other in &parts[nth + 1..] {
                        assert!(!part.shrink(0.5).intersects(*other), "{why}");
                    }
                }
                let within = whole.shrink(0.99 * EDGE * layout.unit);
                assert!(within.contains_rect(layout.bars), "{layout:?}");
                let words = 9.0 * layout.label;
                assert!(layout.bars.width() >= words, "room for words: {layout:?}");
                let (middle, pictures) = layout.round();
                for picture in pictures {
                    assert!(whole.contains_rect(picture) && !picture.intersects(middle));
                    assert!(picture.width() >= 20.0 * layout.mm);
                }
            }
        }
    }
}
