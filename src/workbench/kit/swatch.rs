//! Pictures of textiles: as a small square, or as they lie on the ground.

use eframe::egui::{
    Color32, CornerRadius, Mesh, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, TextureId, Vec2,
    pos2, vec2,
};
use eframe::epaint::Vertex;

use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_single;

/// How far a shadow reaches beyond its textile, points.
pub(crate) const SHADOW: f32 = 16.0;
/// How much is seen of a muted textile.
const MUTED: f32 = 0.4;

/// The picture that a textile is tiled with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClothPicture {
    /// The texture that holds it.
    pub(crate) texture: TextureId,
    /// How much cloth one tile shows, mm.
    pub(crate) tile_mm: Vec2,
}

/// A textile as it lies on the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Textile {
    /// Its corners on the screen: the origin, along the warp, the far one, along the weft.
    pub(crate) corners: [Pos2; 4],
    /// Width and height, mm.
    pub(crate) size_mm: [f64; 2],
    /// What it is tiled with, once that is there.
    pub(crate) picture: Option<ClothPicture>,
    /// Whether it is not felt.
    pub(crate) is_muted: bool,
    /// Whether it is lifted a little, under the display.
    pub(crate) is_lifted: bool,
}

impl Textile {
    /// Draws it, if it is in sight.
    pub(crate) fn paint(self, painter: &Painter) {
        let Self {
            corners,
            is_lifted,
            is_muted,
            ..
        } = self;
        if !is_in_sight(painter, Rect::from_points(&corners).expand(SHADOW)) {
            return;
        }
        let palette = Palette::of(painter.ctx().theme());
        let presence = if is_muted { MUTED } else { 1.0 };
        let drop = vec2(0.0, if is_lifted { 5.0 } else { 2.0 });
        for spread in [1.0_f32, 3.0, 5.0] {
            let veil = palette.shadow.gamma_multiply(0.4 * presence);
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
        let tint = tint.gamma_multiply(presence);
        match self.picture {
            Some(picture) => {
                painter.add(Shape::mesh(textured(corners, self.size_mm, picture, tint)));
            }
            None => {
                painter.add(Shape::convex_polygon(
                    corners.to_vec(),
                    palette.raised.gamma_multiply(presence),
                    Stroke::NONE,
                ));
            }
        }
        if is_muted && !is_lifted {
            paint_outline(painter, corners, Stroke::new(1.0, palette.hairline));
        }
    }
}

/// Draws a textile that lies straight, with nothing on it that tells which it is.
pub(crate) fn paint_plain(
    painter: &Painter,
    view: &ViewTransform,
    (origin_mm, size_mm): (Point, [f64; 2]),
    picture: Option<ClothPicture>,
) {
    let [width, height] = size_mm;
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    let corners = corners
        .map(|[x_mm, y_mm]| view.screen(Point::new(origin_mm.x_mm + x_mm, origin_mm.y_mm + y_mm)));
    let textile = Textile {
        corners,
        size_mm,
        picture,
        is_muted: false,
        is_lifted: false,
    };
    textile.paint(painter);
    let palette = Palette::of(painter.ctx().theme());
    paint_outline(painter, corners, Stroke::new(1.0, palette.line));
}

/// Draws a line around a textile.
pub(crate) fn paint_outline(painter: &Painter, corners: [Pos2; 4], stroke: Stroke) {
    painter.add(Shape::closed_line(corners.to_vec(), stroke));
}

/// Whether a part of the screen is to be seen.
pub(crate) fn is_in_sight(painter: &Painter, rect: Rect) -> bool {
    painter.clip_rect().intersects(rect)
}

fn textured(corners: [Pos2; 4], size_mm: [f64; 2], picture: ClothPicture, tint: Color32) -> Mesh {
    let [width, height] = size_mm.map(to_single);
    let n_across = width / picture.tile_mm.x.max(1e-3);
    let n_up = height / picture.tile_mm.y.max(1e-3);
    // Row 0 of a picture is its top, and the textile's origin is at the picture's lower left.
    let uv = Rect {
        min: pos2(0.0, 1.0),
        max: pos2(n_across, 1.0 - n_up),
    };
    tiled(corners, uv, picture.texture, tint)
}

/// A quad from the textile's origin along its warp and its weft, with a texture from `uv.min` at
/// the origin to `uv.max` at the far corner.
pub(crate) fn tiled(corners: [Pos2; 4], uv: Rect, texture_id: TextureId, tint: Color32) -> Mesh {
    let places = [
        uv.min,
        pos2(uv.max.x, uv.min.y),
        uv.max,
        pos2(uv.min.x, uv.max.y),
    ];
    let vertex = |(pos, uv): (Pos2, Pos2)| Vertex {
        pos,
        uv,
        color: tint,
    };
    Mesh {
        indices: vec![0, 1, 2, 0, 2, 3],
        vertices: corners.into_iter().zip(places).map(vertex).collect(),
        texture_id,
    }
}

/// Paints `shown_mm` millimetres of cloth along both sides of a square; an empty field until the
/// picture is there.
pub(crate) fn paint(painter: &Painter, rect: Rect, shown_mm: f32, picture: Option<ClothPicture>) {
    let palette = Palette::of(painter.ctx().theme());
    let Some(picture) = picture else {
        painter.rect_filled(rect, 3, palette.raised);
        return;
    };
    let [across, up] = [picture.tile_mm.x, picture.tile_mm.y].map(|mm| shown_mm / mm.max(1e-3));
    let corners = [
        (rect.left_top(), pos2(0.0, 1.0 - up)),
        (rect.right_top(), pos2(across, 1.0 - up)),
        (rect.right_bottom(), pos2(across, 1.0)),
        (rect.left_bottom(), pos2(0.0, 1.0)),
    ];
    let vertex = |(pos, uv)| Vertex {
        pos,
        uv,
        color: Color32::WHITE,
    };
    let mesh = Mesh {
        indices: vec![0, 1, 2, 0, 2, 3],
        vertices: corners.map(vertex).to_vec(),
        texture_id: picture.texture,
    };
    painter.add(Shape::mesh(mesh));
    let edge = Stroke::new(1.0, palette.hairline);
    painter.rect_stroke(rect, CornerRadius::ZERO, edge, StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
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
}
