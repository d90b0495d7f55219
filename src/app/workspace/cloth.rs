//! Textiles drawn as cloth: their own picture, tiled from their origin and turned with them.

use eframe::egui::{
    Align2, Color32, CornerRadius, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2,
};
use eframe::epaint::Vertex;

use super::ViewTransform;
use crate::app::theme::{self, Palette};
use crate::app::view::{Cloth, ClothPicture};
use crate::geometry::Point;

/// Draws a textile; one under the display is lifted a little.
pub(crate) fn paint(painter: &Painter, view: &ViewTransform, cloth: &Cloth, is_lifted: bool) {
    let palette = Palette::of(painter.ctx().theme());
    let corners = corners(view, cloth);
    let drop = vec2(0.0, if is_lifted { 5.0 } else { 2.0 });
    for spread in [1.0_f32, 3.0, 5.0] {
        let veil = palette.shadow.gamma_multiply(0.4);
        let shadow = corners.map(|corner| corner + drop).to_vec();
        painter.add(Shape::convex_polygon(
            shadow,
            veil,
            Stroke::new(2.0 * spread, veil.gamma_multiply(0.5)),
        ));
    }
    let tint = if is_lifted {
        Color32::WHITE
    } else {
        palette.resting_cloth
    };
    match cloth.picture {
        Some(picture) => {
            painter.add(Shape::mesh(textured(corners, cloth.size_mm, picture, tint)));
        }
        None => {
            painter.add(Shape::convex_polygon(
                corners.to_vec(),
                palette.raised,
                Stroke::NONE,
            ));
        }
    }
    if is_lifted {
        let edge = Stroke::new(1.5, palette.selection);
        painter.add(Shape::closed_line(corners.to_vec(), edge));
    }
}

/// Draws the tag with the textile's label and name at its lower left corner on the screen.
pub(crate) fn paint_tag(painter: &Painter, view: &ViewTransform, cloth: &Cloth, is_lifted: bool) {
    let palette = Palette::of(painter.ctx().theme());
    let ink = if is_lifted { palette.text } else { palette.dim };
    let label = painter.layout_no_wrap(cloth.label.clone(), theme::body(), palette.text);
    let name = painter.layout_no_wrap(cloth.name.clone(), theme::small(), ink);
    let label_width = if cloth.label.is_empty() {
        0.0
    } else {
        label.size().x + 6.0
    };
    let size = vec2(label_width + name.size().x + 14.0, 20.0);
    let corner = lower_left(&corners(view, cloth));
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
}

/// Where the four corners are on the screen: origin, end of warp, far corner, end of weft.
fn corners(view: &ViewTransform, cloth: &Cloth) -> [Pos2; 4] {
    let [width, height] = cloth.size_mm;
    let frame = cloth.workspace_from_textile;
    [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
        .map(|[u, w]| view.screen(frame.point(Point::new(u, w))))
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

fn textured(corners: [Pos2; 4], size_mm: [f64; 2], picture: ClothPicture, tint: Color32) -> Mesh {
    let [n_across, n_up] = tiles(size_mm, picture);
    // Row 0 of a picture is its top, and the textile's origin is at the picture's lower left.
    let places = [
        [0.0, 1.0],
        [n_across, 1.0],
        [n_across, 1.0 - n_up],
        [0.0, 1.0 - n_up],
    ];
    let vertex = |(pos, [u, v]): (Pos2, [f32; 2])| Vertex {
        pos,
        uv: pos2(u, v),
        color: tint,
    };
    let vertices = corners.into_iter().zip(places).map(vertex).collect();
    Mesh {
        indices: vec![0, 1, 2, 0, 2, 3],
        vertices,
        texture_id: picture.texture,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the screen is drawn in single precision"
)]
fn tiles(size_mm: [f64; 2], picture: ClothPicture) -> [f32; 2] {
    [
        size_mm[0] as f32 / picture.tile_mm.x.max(1e-3),
        size_mm[1] as f32 / picture.tile_mm.y.max(1e-3),
    ]
}

/// Draws what the workspace says when no textile is placed.
pub(crate) fn paint_empty(painter: &Painter, rect: Rect) {
    let palette = Palette::of(painter.ctx().theme());
    let words = "No textile is placed: open a scene with Ctrl+O";
    painter.text(
        rect.center(),
        Align2::CENTER_CENTER,
        words,
        theme::body(),
        palette.dim,
    );
}

#[cfg(test)]
mod tests {
    use eframe::egui::TextureId;

    use super::*;

    #[test]
    fn a_picture_is_tiled_from_the_textiles_lower_left_corner() {
        let picture = ClothPicture {
            texture: TextureId::default(),
            tile_mm: vec2(25.0, 50.0),
        };
        let corners = [
            pos2(0.0, 100.0),
            pos2(100.0, 100.0),
            pos2(100.0, 0.0),
            pos2(0.0, 0.0),
        ];
        let mesh = textured(corners, [100.0, 100.0], picture, Color32::WHITE);
        assert_eq!(mesh.vertices[0].uv, pos2(0.0, 1.0));
        assert_eq!(mesh.vertices[2].uv, pos2(4.0, -1.0));
    }

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
}
