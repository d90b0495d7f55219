//! The points of a textile's profiles, 1 mm apart: one small picture of a point, tiled over the
//! cloth, so that a thousand points cost as much as one.

use eframe::egui::{
    Color32, ColorImage, Context, Painter, Rect, Shape, TextureFilter, TextureHandle,
    TextureOptions, TextureWrapMode, pos2,
};

use crate::bench::view::Cloth;
use crate::kit::swatch::tiled;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::arrange::{screen_bounds, screen_corners};
use selvedge_foundation::numerics::{to_byte, to_single};

/// Points nearer to one another than this are not drawn, points of the screen.
const LEAST_STEP: f64 = 6.0;
/// Pixels of the pictures, one for each range of magnification.
const SIDES: [u8; 4] = [8, 16, 32, 64];
/// Radius of a point, pixels of its picture.
const RADIUS: f32 = 1.4;
/// How opaque a point and its rim are.
const STRENGTHS: [f32; 2] = [0.9, 0.55];

/// Pictures of a point, from coarse to fine.
#[derive(Default)]
pub(crate) struct Lattice {
    pictures: Vec<TextureHandle>,
}

/// Whether points 1 mm apart can be told apart, at this many points of the screen a millimetre.
pub(crate) fn has_room(points_per_mm: f64) -> bool {
    points_per_mm >= LEAST_STEP
}

impl Lattice {
    /// Makes the pictures when they are first needed.
    pub(crate) fn prepare(&mut self, ctx: &Context) {
        if !self.pictures.is_empty() {
            return;
        }
        let options = TextureOptions {
            magnification: TextureFilter::Linear,
            minification: TextureFilter::Linear,
            wrap_mode: TextureWrapMode::Repeat,
            mipmap_mode: None,
        };
        let load = |side: u8| ctx.load_texture(format!("point {side}"), picture(side), options);
        self.pictures = SIDES.map(load).to_vec();
    }

    /// Draws the points of a textile, if there is room for them.
    pub(crate) fn paint(&self, painter: &Painter, view: &ViewTransform, cloth: &Cloth) {
        let bounds = screen_bounds(view, cloth);
        if !has_room(view.points_per_mm) || !painter.clip_rect().intersects(bounds) {
            return;
        }
        let step = view.length(1.0) * painter.ctx().pixels_per_point();
        let fitting = SIDES.iter().position(|side| f32::from(*side) >= step);
        let place = fitting.unwrap_or(SIDES.len() - 1);
        let Some(picture) = self.pictures.get(place) else {
            return;
        };
        let [width, height] = cloth.size_mm.map(to_single);
        // A picture has its point in the middle, and point 0 lies on the edge of the cloth.
        let corners = screen_corners(view, cloth);
        let from = pos2(0.5, 0.5);
        let uv = Rect::from_min_max(from, pos2(width + 0.5, height + 0.5));
        let mesh = tiled(corners, uv, picture.id(), Color32::WHITE);
        painter.add(Shape::mesh(mesh));
    }
}

/// One point on nothing: white, with a dark rim that tells it from bright cloth.
fn picture(side: u8) -> ColorImage {
    let middle = 0.5 * f32::from(side);
    let pixels = (0..side).flat_map(|y| (0..side).map(move |x| [x, y]));
    let pixel = |[x, y]: [u8; 2]| {
        let [dx, dy] = [x, y].map(|at| f32::from(at) + 0.5 - middle);
        let distance = dx.hypot(dy);
        let covers = |radius: f32| (radius + 0.5 - distance).clamp(0.0, 1.0);
        let (point, rim) = (covers(RADIUS), covers(RADIUS + 1.0));
        let white = STRENGTHS[0] * point;
        let dark = STRENGTHS[1] * rim;
        let opacity = dark + white * (1.0 - dark);
        let [grey, alpha] =
            [white, opacity].map(|share| to_byte(f64::from((255.0 * share).round())));
        Color32::from_rgba_premultiplied(grey, grey, grey, alpha.max(grey))
    };
    let side = usize::from(side);
    ColorImage::new([side, side], pixels.map(pixel).collect())
}

#[cfg(test)]
mod tests {
    use eframe::egui;

    use super::*;

    #[test]
    fn a_point_stands_in_the_middle_of_its_picture_and_reaches_no_edge() {
        for side in SIDES {
            let picture = picture(side);
            let last = usize::from(side) - 1;
            let middle = usize::from(side) / 2;
            assert!(picture[(middle, middle)].r() > 200, "{side}");
            for at in [(0, 0), (last, 0), (middle, 0), (last, last), (0, middle)] {
                assert_eq!(picture[at], Color32::TRANSPARENT, "{side}: {at:?}");
            }
        }
    }

    #[test]
    fn all_points_of_a_textile_are_one_quad_and_none_where_there_is_no_room() {
        let ctx = Context::default();
        let sight = Rect::from_min_size(pos2(0.0, 0.0), egui::vec2(400.0, 400.0));
        let cloth = Cloth {
            size_mm: [300.0; 2],
            ..Cloth::default()
        };
        let mut lattice = Lattice::default();
        let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
            lattice.prepare(ui.ctx());
            for points_per_mm in [2.0, 5.9, 10.0] {
                let centre = selvedge_foundation::geometry::Point::new(100.0, 100.0);
                let view = ViewTransform::new(sight, centre, points_per_mm);
                lattice.paint(&ui.painter_at(sight), &view, &cloth);
            }
        });
        output.textures_delta.clear();
        let shapes = output.shapes.iter();
        let quads: Vec<usize> = shapes
            .filter_map(|clipped| match &clipped.shape {
                Shape::Mesh(mesh) => Some(mesh.vertices.len()),
                _ => None,
            })
            .collect();
        assert_eq!(quads, [4]);
    }

    #[test]
    fn points_need_six_pixels_each() {
        assert!(has_room(6.0) && has_room(200.0));
        assert!(!has_room(5.9) && !has_room(f64::NAN));
    }
}
