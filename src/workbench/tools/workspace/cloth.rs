//! Textiles drawn as cloth: their own picture, tiled from their origin and turned with them.

use eframe::egui::{CornerRadius, Painter, Pos2, Rect, Stroke, pos2, vec2};
use eframe::epaint::text::{LayoutJob, TextWrapping};

use crate::bench::view::Cloth;
use crate::kit::swatch::{SHADOW, Textile, is_in_sight, paint_outline};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::arrange::{screen_bounds, screen_corners};

/// Height of a tag, points.
const TAG: f32 = 20.0;
/// A tag on a textile narrower than this leaves the name out, points.
const NAMED: f32 = 72.0;
/// No tag's name is cut shorter than this, points.
const NARROWEST: f32 = 20.0;

/// Draws a textile, if it is in sight; one under the display is lifted a little.
pub(crate) fn paint(painter: &Painter, view: &ViewTransform, cloth: &Cloth, is_lifted: bool) {
    let textile = Textile {
        corners: screen_corners(view, cloth),
        size_mm: cloth.size_mm,
        picture: cloth.picture,
        is_muted: cloth.is_muted,
        is_lifted,
    };
    textile.paint(&within(painter, view, cloth));
}

/// A painter of where a textile is felt alone.
fn within(painter: &Painter, view: &ViewTransform, cloth: &Cloth) -> Painter {
    let felt = cloth.within_mm.map_or(Rect::EVERYTHING, |corners| {
        let [from, to] = corners.map(|corner| view.screen(corner));
        Rect::from_two_pos(from, to)
    });
    painter.with_clip_rect(painter.clip_rect().intersect(felt))
}

/// Draws the line around the textile that is felt, over whatever lies on it.
pub(crate) fn paint_lifted(painter: &Painter, view: &ViewTransform, cloth: &Cloth) {
    if is_in_sight(painter, screen_bounds(view, cloth).expand(SHADOW)) {
        let palette = Palette::of(painter.ctx().theme());
        let edge = Stroke::new(1.5, palette.selection);
        let painter = &within(painter, view, cloth);
        paint_outline(painter, screen_corners(view, cloth), edge);
    }
}

/// Draws the tag with the textile's label and name at its lower left corner on the screen. Says
/// where it is, if it is in sight.
pub(crate) fn paint_tag(
    painter: &Painter,
    view: &ViewTransform,
    cloth: &Cloth,
    is_lifted: bool,
) -> Option<Rect> {
    let corner = lower_left(&screen_corners(view, cloth));
    // No text is laid out where no tag can be seen; none is wider than this.
    let room = Rect::from_min_size(corner - vec2(0.0, TAG), vec2(400.0, TAG));
    if !is_in_sight(painter, room) {
        return None;
    }
    let palette = Palette::of(painter.ctx().theme());
    let ink = if is_lifted { palette.text } else { palette.dim };
    let label = painter.layout_no_wrap(cloth.label.clone(), theme::body(), palette.text);
    let width = screen_bounds(view, cloth).width();
    let is_narrow = width < NAMED;
    let name = match (is_narrow && !cloth.label.is_empty(), cloth.is_muted) {
        (false, false) => cloth.name.clone(),
        (false, true) => format!("{}  ·  muted", cloth.name),
        (true, false) => String::new(),
        (true, true) => "muted".to_owned(),
    };
    let label_width = if cloth.label.is_empty() {
        0.0
    } else {
        label.size().x + if name.is_empty() { 0.0 } else { 6.0 }
    };
    // A tag covers no neighbour: what does not fit on the textile is cut.
    let mut job = LayoutJob::simple_singleline(name, theme::small(), ink);
    job.wrap = TextWrapping::truncate_at_width((width - label_width - 14.0).max(NARROWEST));
    let name = painter.layout_job(job);
    let size = vec2(label_width + name.size().x + 14.0, TAG);
    let tag = Rect::from_min_size(pos2(corner.x, corner.y - size.y), size);
    let rounding = CornerRadius {
        ne: 5,
        ..CornerRadius::ZERO
    };
    painter.rect_filled(tag, rounding, palette.tag);
    let middle = tag.center().y;
    let at = |x: f32, height: f32| pos2(tag.left() + 7.0 + x, middle - 0.5 * height);
    painter.galley(at(0.0, label.size().y), label, palette.text);
    painter.galley(at(label_width, name.size().y), name, ink);
    Some(tag)
}

/// The corner that looks most like "lower left".
fn lower_left(corners: &[Pos2; 4]) -> Pos2 {
    let leftness = |corner: &Pos2| corner.y - corner.x;
    corners
        .iter()
        .copied()
        .max_by(|a, b| leftness(a).total_cmp(&leftness(b)))
        .unwrap_or_default()
}

/// Draws what the workspace says when no textile is placed.
pub(crate) fn paint_empty(painter: &Painter, ground: Rect) {
    let palette = Palette::of(painter.ctx().theme());
    let words =
        "No textile is placed. Drag one here from the library, or open a scene with Ctrl+O."
            .to_owned();
    let width = (ground.width() - 64.0).max(64.0);
    let galley = painter.layout(words, theme::body(), palette.dim, width);
    let corner = ground.center() - 0.5 * galley.size();
    painter.galley(corner, galley, palette.dim);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tag_hangs_on_the_lower_left_corner_however_the_textile_is_turned() {
        let corners = [
            pos2(100.0, 100.0),
            pos2(100.0, 0.0),
            pos2(0.0, 0.0),
            pos2(0.0, 100.0),
        ];
        assert_eq!(lower_left(&corners), pos2(0.0, 100.0));
    }

    fn cloth(name: &str, side_mm: f64) -> Cloth {
        Cloth {
            label: "1".to_owned(),
            name: name.to_owned(),
            size_mm: [side_mm; 2],
            ..Cloth::default()
        }
    }

    #[test]
    fn no_tag_covers_the_neighbour_of_its_textile() {
        let ctx = eframe::egui::Context::default();
        let sight = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 400.0));
        let mut widths = Vec::new();
        let mut output = ctx.run_ui(eframe::egui::RawInput::default(), |ui| {
            for side_mm in [40.0, 80.0, 300.0] {
                let centre = selvedge_foundation::geometry::Point::new(100.0, 100.0);
                let view = ViewTransform::new(sight, centre, 1.0);
                let cloth = cloth("Cotton and polyester denim", side_mm);
                let tag = paint_tag(&ui.painter_at(sight), &view, &cloth, false);
                widths.push(tag.map_or(0.0, |tag| tag.width()));
            }
        });
        output.textures_delta.clear();
        assert!(widths[0] > 0.0 && widths[0] <= 40.0, "{widths:?}");
        assert!(widths[1] > widths[0] && widths[1] <= 80.0, "{widths:?}");
        assert!(widths[2] > 120.0, "the whole name: {widths:?}");
    }

    #[test]
    fn what_is_out_of_sight_is_not_drawn() {
        let ctx = eframe::egui::Context::default();
        let sight = Rect::from_min_size(pos2(0.0, 0.0), vec2(100.0, 100.0));
        let cloth = cloth("Felt", 50.0);
        let input = eframe::egui::RawInput {
            screen_rect: Some(sight),
            ..eframe::egui::RawInput::default()
        };
        let mut tags = Vec::new();
        let mut output = ctx.run_ui(input, |ui| {
            for x_mm in [-500.0, 25.0, 500.0] {
                let centre = selvedge_foundation::geometry::Point::new(x_mm, 25.0);
                let view = ViewTransform::new(sight, centre, 1.0);
                let painter = ui.painter_at(sight);
                paint(&painter, &view, &cloth, false);
                tags.push(paint_tag(&painter, &view, &cloth, false).is_some());
            }
        });
        output.textures_delta.clear();
        tags.truncate(3);
        assert_eq!(tags, [false, true, false]);
        // Three shadows, the cloth, the tag and its two texts: once.
        let n_shapes = output
            .shapes
            .iter()
            .filter(|s| s.clip_rect == sight)
            .count();
        assert_eq!(n_shapes, 7);
    }
}
