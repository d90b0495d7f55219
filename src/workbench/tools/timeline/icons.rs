//! Buttons with painted signs, and a choice of one of several.
//!
//! The signs are painted here because no font can be relied on to have them.

use std::f32::consts::TAU;

use eframe::egui::{
    self, Align2, Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, ROW};

/// A sign on a button.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Icon {
    /// A ring; filled while it records.
    Record {
        /// Whether it records.
        is_on: bool,
    },
    /// A triangle.
    Play,
    /// Two bars.
    Pause,
    /// A triangle against a bar.
    Step,
    /// The same backwards.
    Rewind,
    /// An arrow that bites its tail.
    Loop,
}

/// A button: its sign, how it is read out, what it does, and why it does nothing now.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Act {
    pub(crate) icon: Icon,
    pub(crate) label: &'static str,
    pub(crate) what: &'static str,
    pub(crate) refusal: Option<&'static str>,
}

/// A button with a sign. `is_on`: whether what it turns on is on, if it does.
pub(crate) fn icon_button(ui: &mut Ui, act: Act, tip: &str, is_on: Option<bool>) -> bool {
    let is_enabled = act.refusal.is_none();
    let palette = Palette::in_ui(ui);
    let sense = if is_enabled {
        Sense::click()
    } else {
        Sense::hover()
    };
    let (rect, response) = ui.allocate_exact_size(vec2(30.0, ROW), sense);
    response.widget_info(|| {
        let role = egui::Role::Button;
        match is_on {
            Some(is_on) => WidgetInfo::selected(role, is_enabled, is_on, act.label),
            None => WidgetInfo::labeled(role, is_enabled, act.label),
        }
    });
    let is_lit = is_on == Some(true);
    let ink = match (is_enabled, is_on) {
        (false, _) => faint(palette),
        (true, Some(false)) => palette.dim,
        (true, _) => palette.text,
    };
    paint_ground(ui, rect, &response, is_lit);
    paint(ui.painter(), act.icon, rect.center(), ink);
    response.on_hover_text(act.refusal.unwrap_or(tip)).clicked()
}

/// One of several, side by side. Each has a name, a tip and, if it cannot be chosen, the reason.
pub(crate) fn segments(
    ui: &mut Ui,
    width: f32,
    parts: &[(&str, String, Option<&str>)],
    chosen: usize,
) -> Option<usize> {
    let palette = Palette::in_ui(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(width, ROW), Sense::hover());
    ui.painter().rect_filled(rect, 4, palette.raised);
    let each = width / parts.len().max(1) as f32;
    let mut clicked = None;
    for (index, (name, tip, refusal)) in parts.iter().enumerate() {
        let left = rect.left() + each * index as f32;
        let part = Rect::from_min_size(pos2(left, rect.top()), vec2(each, ROW));
        let (is_chosen, is_enabled) = (index == chosen, refusal.is_none());
        let sense = if is_enabled {
            Sense::click()
        } else {
            Sense::hover()
        };
        let response = ui.interact(part, ui.scope_id().with(("source", index)), sense);
        response.widget_info(|| {
            WidgetInfo::selected(egui::Role::RadioButton, is_enabled, is_chosen, name)
        });
        let inner = part.shrink(2.0);
        paint_ground(ui, inner, &response, is_chosen);
        let ink = match (is_enabled, is_chosen) {
            (false, _) => faint(palette),
            (true, true) => palette.selection,
            (true, false) => palette.dim,
        };
        let painter = ui.painter();
        painter.text(
            part.center(),
            Align2::CENTER_CENTER,
            name,
            theme::body(),
            ink,
        );
        if is_chosen {
            // Not by brightness alone.
            let y = inner.bottom() - 0.5;
            let line = Stroke::new(1.0, palette.selection);
            painter.hline(inner.shrink2(vec2(8.0, 0.0)).x_range(), y, line);
        }
        let words = refusal.map_or(tip.as_str(), |why| why);
        if response.on_hover_text(words).clicked() && !is_chosen {
            clicked = Some(index);
        }
    }
    clicked
}

fn paint_ground(ui: &Ui, rect: Rect, response: &Response, is_lit: bool) {
    let palette = Palette::in_ui(ui);
    let is_touched = response.sense.senses_click() && response.hovered();
    if is_lit || is_touched {
        ui.painter().rect_filled(rect, 3, palette.hovered);
    }
    if response.has_focus() {
        let edge = Stroke::new(1.0, palette.selection);
        ui.painter().rect_stroke(rect, 3, edge, StrokeKind::Inside);
    }
}

/// What cannot be used.
fn faint(palette: &Palette) -> Color32 {
    palette.line.gamma_multiply(0.8)
}

fn paint(painter: &Painter, icon: Icon, middle: Pos2, ink: Color32) {
    let at = |x: f32, y: f32| middle + vec2(x, y);
    let bar = |left: f32, width: f32| {
        let rect = Rect::from_min_size(at(left, -5.5), vec2(width, 11.0));
        painter.rect_filled(rect, 0.5, ink);
    };
    let triangle = |points: [Vec2; 3]| {
        let corners = points.map(|point| middle + point).to_vec();
        painter.add(Shape::convex_polygon(corners, ink, Stroke::NONE));
    };
    match icon {
        Icon::Record { is_on: true } => {
            painter.circle_filled(middle, 6.0, ink);
        }
        Icon::Record { is_on: false } => {
            painter.circle_stroke(middle, 5.25, Stroke::new(1.5, ink));
        }
        Icon::Play => triangle([vec2(-4.0, -6.0), vec2(6.0, 0.0), vec2(-4.0, 6.0)]),
        Icon::Pause => {
            bar(-5.0, 3.5);
            bar(1.5, 3.5);
        }
        Icon::Step => {
            triangle([vec2(-5.0, -5.5), vec2(3.0, 0.0), vec2(-5.0, 5.5)]);
            bar(4.0, 2.0);
        }
        Icon::Rewind => {
            triangle([vec2(5.0, -5.5), vec2(5.0, 5.5), vec2(-3.0, 0.0)]);
            bar(-6.0, 2.0);
        }
        Icon::Loop => paint_loop(painter, middle, ink),
    }
}

fn paint_loop(painter: &Painter, middle: Pos2, ink: Color32) {
    let radius = 5.5;
    let on_ring = |turn: f32| {
        let (sin, cos) = (turn * TAU).sin_cos();
        middle + radius * vec2(cos, sin)
    };
    // From a little after the top right all the way round to just before it.
    let arc = (0..=28_u8).map(|i| on_ring(-0.02 + 0.80 * f32::from(i) / 28.0));
    painter.add(Shape::line(arc.collect(), Stroke::new(1.5, ink)));
    let head = on_ring(0.80);
    let corners = vec![
        head + vec2(-1.0, -3.5),
        head + vec2(4.0, 0.3),
        head + vec2(-1.5, 3.5),
    ];
    painter.add(Shape::convex_polygon(corners, ink, Stroke::NONE));
}
