//! A relief seen from the side: a lit block that is turned by dragging and drawn nearer by the
//! wheel, with axes in mm and µm.
//!
//! Heights are averaged to at most [`MOST_POINTS`] a side. The picture is one mesh, painted from
//! back to front, and kept until the relief, the view or its place change.

pub(crate) mod axes;
pub(crate) mod mesh;
#[cfg(test)]
mod tests;

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::Arc;

use eframe::egui::{
    EventFilter, Id, InputState, Key, Mesh, Rect, Response, Role, Sense, Stroke, Ui, WidgetInfo,
    vec2,
};

use crate::kit::theme::{Palette, ROW};
use crate::kit::widgets::relief3d::mesh::Projection;
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::slider_row;
use selvedge_foundation::numerics::{Grid, extent};
use selvedge_foundation::quantity;
use selvedge_textile::surface::HeightMap;

/// Most points along a side that are drawn.
pub(crate) const MOST_POINTS: usize = 128;
/// The steepest a view may be exaggerated.
const MOST_EXAGGERATION: f64 = 30.0;
/// Share of the shorter side that the relief is exaggerated to at first.
const FIRST_SHARE: f64 = 0.15;
/// Degrees that a view turns for each point dragged, and for each arrow key.
const DRAG_DEG: f32 = 0.5;
const KEY_DEG: f32 = 5.0;
/// Points of scrolling that bring it nearer by a factor of e.
const SCROLL: f32 = 250.0;
/// What a key brings it nearer by.
const KEY_ZOOM: f32 = 1.15;

/// Heights to be looked at, averaged.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Relief3d {
    heights_um: Grid<f64>,
    step_mm: [f64; 2],
    range_um: [f64; 2],
    content: u64,
}

impl Relief3d {
    /// The relief of a map; what is missing is filled.
    pub(crate) fn of(map: &HeightMap) -> Self {
        let filled = map.filled();
        let heights_um = averaged(filled.heights_um());
        let n = [heights_um.width(), heights_um.height()];
        let size_mm = map.size_mm();
        let step_mm = [0, 1].map(|axis| size_mm[axis] / n[axis] as f64);
        let range_um = extent(heights_um.values().iter().copied());
        let mut hasher = DefaultHasher::new();
        n.hash(&mut hasher);
        let numbers = heights_um.values().iter().chain(&step_mm);
        numbers.for_each(|number| number.to_bits().hash(&mut hasher));
        Self {
            heights_um,
            step_mm,
            range_um,
            content: hasher.finish(),
        }
    }

    /// Extent along u and w, mm.
    pub(crate) fn size_mm(&self) -> [f64; 2] {
        let n = [self.heights_um.width(), self.heights_um.height()];
        [0, 1].map(|axis| n[axis] as f64 * self.step_mm[axis])
    }

    /// From the lowest to the highest height, µm.
    pub(crate) fn relief_um(&self) -> f64 {
        self.range_um[1] - self.range_um[0]
    }
}

/// From where a relief is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View3d {
    /// Turned counter-clockwise about the vertical, degrees.
    pub(crate) yaw_deg: f32,
    /// From how far above the level it is seen, degrees: 90 is from straight above.
    pub(crate) pitch_deg: f32,
    /// How near: 1 shows all of it.
    pub(crate) zoom: f32,
    /// How many times heights are drawn too high.
    pub(crate) exaggeration: f64,
}

impl View3d {
    /// From a corner, so much exaggerated that the relief shows.
    pub(crate) fn for_relief(relief: &Relief3d) -> Self {
        let [u, w] = relief.size_mm();
        let wanted = FIRST_SHARE * u.min(w) * 1000.0 / relief.relief_um();
        let exaggeration = if wanted.is_finite() { wanted } else { 1.0 };
        Self {
            yaw_deg: 30.0,
            pitch_deg: 40.0,
            zoom: 1.0,
            exaggeration: round_half(exaggeration).clamp(1.0, MOST_EXAGGERATION),
        }
    }

    fn turned(self, yaw_deg: f32, pitch_deg: f32) -> Self {
        Self {
            yaw_deg: (self.yaw_deg + yaw_deg).rem_euclid(360.0),
            pitch_deg: (self.pitch_deg + pitch_deg).clamp(5.0, 90.0),
            ..self
        }
    }

    fn nearer(self, factor: f32) -> Self {
        Self {
            zoom: (self.zoom * factor).clamp(0.5, 8.0),
            ..self
        }
    }
}

/// Rounded to halves, as the slider steps.
fn round_half(x: f64) -> f64 {
    (2.0 * x).round() / 2.0
}

/// Shows a relief in all the room there is, with a slider for its exaggeration below; says the
/// view that the user turned it to. `name` is what it is called; no two in a window are called
/// alike.
pub(crate) fn relief3d(ui: &mut Ui, name: &str, relief: &Relief3d, view: View3d) -> Option<View3d> {
    let size = vec2(
        ui.available_width(),
        (ui.available_height() - ROW - ui.spacing().item_spacing.y).max(4.0 * ROW),
    );
    let (_, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, ui.is_enabled(), name));
    let description = spoken(relief, view);
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_description(description);
    });
    let moved = moved(ui, &response, relief, view);
    paint(ui, name, &response, relief, moved);
    let ink = Palette::in_ui(ui).line;
    let scale = exaggeration_scale(relief);
    let (exaggeration, _) = slider_row(ui, "Exaggeration", ink, scale, view.exaggeration);
    let new = View3d {
        exaggeration: exaggeration.unwrap_or(moved.exaggeration),
        ..moved
    };
    (new != view).then_some(new)
}

fn exaggeration_scale(relief: &Relief3d) -> Scale {
    let resting = View3d::for_relief(relief).exaggeration;
    Scale::even([1.0, MOST_EXAGGERATION], resting, 0.5, (1, "×"))
}

/// What it shows, in words.
fn spoken(relief: &Relief3d, view: View3d) -> String {
    let [u, w] = relief.size_mm();
    let number = |x: f64, decimals| quantity::fixed(x, decimals);
    format!(
        "{} by {} mm, relief {} µm, drawn {} times too high; turned by {}°, seen from {}° above",
        number(u, 2),
        number(w, 2),
        number(relief.relief_um(), 0),
        number(view.exaggeration, 1),
        number(f64::from(view.yaw_deg), 0),
        number(f64::from(view.pitch_deg), 0),
    )
}

/// The view that pointer, wheel and keys turn it to.
fn moved(ui: &Ui, response: &Response, relief: &Relief3d, view: View3d) -> View3d {
    if response.double_clicked() {
        return View3d::for_relief(relief);
    }
    let mut new = view;
    if response.dragged() {
        let by = response.drag_delta();
        new = new.turned(by.x * DRAG_DEG, by.y * DRAG_DEG);
    }
    if response.hovered() {
        let scrolled = ui.input(|input| input.smooth_scroll_delta().y);
        let pinched = ui.input(InputState::zoom_delta);
        new = new.nearer((scrolled / SCROLL).exp() * pinched);
    }
    if response.has_focus() {
        new = moved_by_keys(ui, response, new);
    }
    new
}

fn moved_by_keys(ui: &Ui, response: &Response, view: View3d) -> View3d {
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let presses = |key: Key| ui.input(|input| u8::try_from(input.num_presses(key)).unwrap_or(0));
    let less = |more: Key, less: Key| f32::from(presses(more)) - f32::from(presses(less));
    let yaw_deg = KEY_DEG * less(Key::ArrowRight, Key::ArrowLeft);
    let pitch_deg = KEY_DEG * less(Key::ArrowDown, Key::ArrowUp);
    let nearer = f32::from(presses(Key::Plus)) + f32::from(presses(Key::Equals));
    let steps = nearer - f32::from(presses(Key::Minus));
    view.turned(yaw_deg, pitch_deg).nearer(KEY_ZOOM.powf(steps))
}

/// What a mesh was made of.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Made {
    content: u64,
    view: View3d,
    rect: Rect,
    is_dark: bool,
}

/// A mesh that was made, and how many before it.
#[derive(Debug, Clone)]
struct Kept {
    made: Made,
    mesh: Arc<Mesh>,
    n_made: u64,
}

fn mesh_id(name: &str) -> Id {
    Id::unique(("relief3d", name))
}

fn paint(ui: &Ui, name: &str, response: &Response, relief: &Relief3d, view: View3d) {
    let rect = response.rect;
    let palette = Palette::in_ui(ui);
    let made = Made {
        content: relief.content,
        view,
        rect,
        is_dark: ui.visuals().dark_mode,
    };
    let projection = Projection::of(relief, view, rect);
    let id = mesh_id(name);
    let before: Option<Kept> = ui.data(|data| data.get_temp(id));
    let kept = match before {
        Some(kept) if kept.made == made => kept,
        before => Kept {
            made,
            mesh: Arc::new(mesh::of(relief, &projection, palette)),
            n_made: before.map_or(1, |kept| kept.n_made + 1),
        },
    };
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    axes::paint_frame(&painter, relief, &projection);
    painter.add(Arc::clone(&kept.mesh));
    axes::paint(&painter, relief, &projection);
    if response.has_focus() {
        let stroke = Stroke::new(1.0, palette.selection);
        painter.rect_stroke(
            rect.shrink(1.0),
            2.0,
            stroke,
            eframe::egui::StrokeKind::Inside,
        );
    }
    ui.data_mut(|data| data.insert_temp(id, kept));
}

/// The heights as means over cells, at most [`MOST_POINTS`] a side.
fn averaged(heights: &Grid<f64>) -> Grid<f64> {
    let [width, height] = [heights.width(), heights.height()];
    let n = [width, height].map(|n| n.min(MOST_POINTS));
    let span = |i: usize, n: usize, of: usize| i * of / n..((i + 1) * of / n).max(i * of / n + 1);
    let mut coarse = Grid::filled(n[0], n[1], 0.0);
    for row in 0..n[1] {
        for column in 0..n[0] {
            let (rows, columns) = (span(row, n[1], height), span(column, n[0], width));
            let count = (rows.len() * columns.len()) as f64;
            let sum: f64 = rows
                .map(|r| heights.row(r)[columns.clone()].iter().sum::<f64>())
                .sum();
            coarse.row_mut(row)[column] = sum / count;
        }
    }
    coarse
}
