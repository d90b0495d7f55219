//! The strips of a take as shapes, made when something about them changed and kept until then.
//!
//! Four hours of ticks are walked through once for each width, never in every frame.

use std::sync::Arc;

use eframe::egui::{Pos2, Shape, Stroke, Ui, pos2};

use crate::bench::recording::strips::{Column, Extent, Strips};
use crate::kit::theme::Palette;
use crate::kit::widgets::polyline::corners;
use crate::tools::timeline::plot;
use crate::tools::timeline::plot::Plot;
use selvedge_textile::tactile::Band;

/// How solid columns are: where the bands overlap, both show.
const COLUMNS: f32 = 0.8;
/// How solid the ground under the speed is.
const GROUND: f32 = 0.22;

/// The strips of a take as shapes, kept until something about them changes.
pub(crate) struct Picture {
    strips: Arc<Strips>,
    plot: Plot,
    pixels_per_point: f32,
    is_dark: bool,
    shapes: Vec<Shape>,
}

/// The shapes of a take: those of the last frame, or new ones when something changed.
pub(crate) fn drawn(
    ui: &Ui,
    plot: &Plot,
    strips: &Arc<Strips>,
    last: &mut Option<Picture>,
) -> Vec<Shape> {
    let (pixels_per_point, is_dark) = (ui.ctx().pixels_per_point(), ui.visuals().dark_mode);
    let is_the_same = |picture: &&Picture| {
        Arc::ptr_eq(&picture.strips, strips)
            && picture.plot == *plot
            && (picture.pixels_per_point - pixels_per_point).abs() < f32::EPSILON
            && picture.is_dark == is_dark
    };
    if let Some(picture) = last.as_ref().filter(is_the_same) {
        return picture.shapes.clone();
    }
    let shapes = strip_shapes(plot, strips, Palette::in_ui(ui), pixels_per_point);
    *last = Some(Picture {
        strips: Arc::clone(strips),
        plot: *plot,
        pixels_per_point,
        is_dark,
        shapes: shapes.clone(),
    });
    shapes
}

fn strip_shapes(plot: &Plot, strips: &Strips, palette: &Palette, ppp: f32) -> Vec<Shape> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "pixels in a row of the screen"
    )]
    let n_pixels = (plot.area.width() * ppp).round().max(1.0) as usize;
    let columns = strips.columns(n_pixels);
    let is_each_tick = columns.len() < n_pixels;
    let last = columns.len().saturating_sub(1).max(1) as f64;
    let x_of = |index: usize| plot.x_at(index as f64 / last);
    let top = |(index, column): (usize, &Column)| {
        pos2(x_of(index), plot.y_of_speed(column.speed_mm_per_s.most))
    };
    let speeds: Vec<Pos2> = columns.iter().enumerate().map(top).collect();
    let mut shapes = speed_shapes(plot, &speeds, palette);
    for band in Band::ALL {
        let ink = palette.band(band);
        let level = |column: &Column| column.level_db[band.index()];
        if is_each_tick {
            let point = |(index, column): (usize, &Column)| {
                level(column).map(|level_db| pos2(x_of(index), plot.y_of_level(level_db.most)))
            };
            let points: Vec<_> = columns.iter().enumerate().map(point).collect();
            shapes.extend(plot::lines(&points, ink));
        } else {
            let ends = |db: Extent| [plot.y_of_level(db.most), plot.y_of_level(db.least)];
            let extents: Vec<_> = columns
                .iter()
                .map(|column| level(column).map(ends))
                .collect();
            let width = plot.area.width() / columns.len() as f32;
            let mesh = plot::columns_mesh(
                plot.area.left(),
                width,
                &extents,
                ink.gamma_multiply(COLUMNS),
            );
            shapes.push(Shape::mesh(mesh));
        }
    }
    shapes
}

/// The speed: a quiet ground with its edge.
pub(crate) fn speed_shapes(plot: &Plot, points: &[Pos2], palette: &Palette) -> Vec<Shape> {
    let points = corners(points);
    let ink = palette.line.gamma_multiply(GROUND);
    let ground = plot::ground_mesh(&points, plot.area.bottom(), ink);
    let edge = Stroke::new(1.0, palette.line.gamma_multiply(0.7));
    vec![Shape::mesh(ground), Shape::line(points, edge)]
}

#[cfg(test)]
impl Picture {
    /// Where its shapes lie: elsewhere once they were made anew.
    pub(crate) fn address(&self) -> usize {
        self.shapes.as_ptr().addr()
    }
}
