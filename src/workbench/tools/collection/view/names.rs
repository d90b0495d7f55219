//! Names beside points, as many as have room.

use eframe::egui::{Color32, Painter, Rect, vec2};

use crate::kit::theme;
use crate::tools::collection::view::points::Placed;

/// From a point to its name, points.
const AWAY: f32 = 4.0;

/// Writes names right or left of their points where they touch no point and no other name; those
/// that are selected or marked first.
pub(crate) fn paint(
    painter: &Painter,
    area: Rect,
    (placed, side): (&[Placed<'_>], f32),
    inks: [Color32; 2],
) {
    let square = |one: &Placed<'_>| Rect::from_center_size(one.at, vec2(side, side));
    let mut taken: Vec<Rect> = placed.iter().map(square).collect();
    let is_first = |one: &&Placed<'_>| one.entry.is_selected || one.entry.is_marked;
    let (first, rest): (Vec<&Placed<'_>>, Vec<&Placed<'_>>) = placed.iter().partition(is_first);
    let first = first.into_iter().map(|one| (one, inks[1]));
    let rest = rest.into_iter().map(|one| (one, inks[0]));
    for (one, ink) in first.chain(rest) {
        let name = one.entry.item.name.clone();
        let galley = painter.layout_no_wrap(name, theme::small(), ink);
        let size = galley.size();
        let out = 0.5 * side + AWAY;
        let places = [
            one.at + vec2(out, -0.5 * size.y),
            one.at + vec2(-out - size.x, -0.5 * size.y),
            one.at + vec2(-0.5 * size.x, out - 2.0),
            one.at + vec2(-0.5 * size.x, -out - size.y + 2.0),
        ];
        let is_free = |rect: &Rect| {
            let is_inside = area.contains_rect(*rect);
            is_inside && taken.iter().all(|other| !other.intersects(*rect))
        };
        let rects = places.map(|corner| Rect::from_min_size(corner, size));
        if let Some(rect) = rects.into_iter().find(|rect| is_free(rect)) {
            painter.galley(rect.min, galley, ink);
            taken.push(rect);
        }
    }
}
