//! Ranking: numbers that are laid in order, by drag, click or digit.

use eframe::egui::{
    self, Align, Align2, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::experiment::draft::Act;
use crate::tools::experiment::draft::{Mark, Order};
use crate::tools::experiment::participant::big;
use crate::tools::experiment::participant::big::Face;
use crate::tools::experiment::participant::ground::count;

/// Side of a number and of its place, points.
const SIDE: f32 = 64.0;

/// Shows the numbers that are not ranked yet, and the ranks.
pub(crate) fn show(ui: &mut Ui, order: &Order, acts: &mut Vec<Act>) {
    ui.spacing_mut().item_spacing.x = 2.0 * STEP;
    for position in 0..order.n {
        let is_free = !order.slots.contains(&Some(position));
        let (rect, response) = ui.allocate_exact_size(vec2(SIDE, SIDE), Sense::click_and_drag());
        if !is_free {
            paint_gap(ui, rect);
            continue;
        }
        name(ui, &response, &format!("Fabric {}", position + 1));
        drag(ui, &response, position);
        paint_place(ui, rect, Some(position), response.hovered());
        big::ring(ui, rect, &response);
        if response.clicked() {
            acts.push(Act::Mark(Mark::Place(position)));
        }
    }
    ui.add_space(4.0 * STEP);
    let (rect, _) = ui.allocate_exact_size(vec2(28.0, SIDE), Sense::hover());
    paint_arrow(ui, rect);
    ui.add_space(4.0 * STEP);
    for rank in 0..order.slots.len() {
        show_rank(ui, rank, order, acts);
    }
}

fn show_rank(ui: &mut Ui, rank: usize, order: &Order, acts: &mut Vec<Act>) {
    let ranked = order.slots[rank];
    let (rect, response) = ui.allocate_exact_size(vec2(SIDE, SIDE), Sense::click_and_drag());
    let what = ranked.map_or_else(|| "empty".to_owned(), |at| format!("fabric {}", at + 1));
    name(ui, &response, &format!("Rank {}: {what}", rank + 1));
    if let Some(position) = ranked {
        drag(ui, &response, position);
    }
    let is_over = response.dnd_hover_payload::<usize>().is_some();
    paint_place(ui, rect, ranked, is_over || response.hovered());
    big::ring(ui, rect, &response);
    if rank == 0 {
        paint_end(ui, rect, Align::Max, &order.ends[0]);
    } else if rank + 1 == order.slots.len() {
        paint_end(ui, rect, Align::Min, &order.ends[1]);
    }
    if let Some(position) = response.dnd_release_payload::<usize>() {
        acts.push(Act::Mark(Mark::Rank(*position, rank)));
    }
}

fn name(ui: &Ui, response: &Response, label: &str) {
    let is_enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, is_enabled, label));
}

/// What an end of the ranks means, below it: in the middle, or, where that is too wide, away from
/// the other end.
fn paint_end(ui: &Ui, rect: Rect, away: Align, words: &str) {
    let dim = Palette::in_ui(ui).dim;
    let galley = ui
        .painter()
        .layout_no_wrap(words.to_owned(), theme::body(), dim);
    let is_narrow = galley.size().x <= rect.width();
    let across = if is_narrow { Align::Center } else { away };
    let below = rect.translate(vec2(0.0, SIDE + 4.0));
    let at = Align2([across, Align::Min]).align_size_within_rect(galley.size(), below);
    ui.painter().galley(at.min, galley, dim);
}

/// Lets a number be dragged, and draws it under the pointer.
fn drag(ui: &Ui, response: &Response, position: usize) {
    response.dnd_set_drag_payload(position);
    if response.dragged()
        && let Some(at) = ui.ctx().pointer_interact_pos()
    {
        let layer = egui::LayerId::new(egui::Order::Tooltip, response.id);
        let painter = ui.ctx().layer_painter(layer);
        let palette = Palette::in_ui(ui);
        let rect = Rect::from_center_size(at, vec2(SIDE, SIDE));
        painter.rect_filled(rect, 8, palette.hovered);
        paint_number(&painter, at, position, palette);
    }
}

fn paint_place(ui: &Ui, rect: Rect, held: Option<usize>, is_lit: bool) {
    let palette = Palette::in_ui(ui);
    let Some(position) = held else {
        return big::paint(ui, rect, Face::place(palette, is_lit));
    };
    big::paint(ui, rect, Face::loose(palette, is_lit));
    paint_number(ui.painter(), rect.center(), position, palette);
}

fn paint_number(painter: &egui::Painter, at: egui::Pos2, position: usize, palette: &Palette) {
    let number = (position + 1).to_string();
    painter.text(
        at,
        Align2::CENTER_CENTER,
        number,
        theme::huge(),
        palette.text,
    );
}

/// Where a number was before it was ranked: hardly there.
fn paint_gap(ui: &Ui, rect: Rect) {
    let stroke = Stroke::new(1.0, Palette::in_ui(ui).hairline);
    ui.painter()
        .rect_stroke(rect, 8, stroke, StrokeKind::Inside);
}

fn paint_arrow(ui: &Ui, rect: Rect) {
    let palette = Palette::in_ui(ui);
    let middle = rect.center();
    ui.painter().arrow(
        middle - vec2(12.0, 0.0),
        vec2(24.0, 0.0),
        Stroke::new(2.0, palette.line),
    );
}

/// Width of all of it, points.
pub(crate) fn width(order: &Order) -> f32 {
    count(order.n + order.slots.len()) * (SIDE + 2.0 * STEP) + 28.0 + 12.0 * STEP
}
