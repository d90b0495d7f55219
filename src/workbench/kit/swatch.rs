//! A piece of cloth as a small square.

use eframe::egui::{Color32, CornerRadius, Mesh, Painter, Rect, Shape, Stroke, StrokeKind, pos2};
use eframe::epaint::Vertex;

use crate::bench::view::ClothPicture;
use crate::kit::theme::Palette;

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
