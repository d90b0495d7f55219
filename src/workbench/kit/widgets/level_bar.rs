//! The bar of colours beside a spectrogram: which colour stands for which level, and two handles
//! that choose between which levels colours differ.

use eframe::egui::{
    CursorIcon, Painter, Rangef, Rect, Response, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
    vec2,
};

use crate::kit::spectrum_scale::{Handle, LEVELS_DB, LevelRange};
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::{Axis, Side, paint_outer_ticks};
use crate::kit::widgets::bar::colour_bar;

/// How near to a handle it is taken hold of, points.
const REACH: f32 = 7.0;
/// Half the height of a handle, points.
const HALF_HANDLE: f32 = 4.0;

/// What is held of a bar, and the range when it was taken.
type Grip = (Handle, LevelRange);

fn axis() -> Axis {
    Axis::linear(LEVELS_DB[0], LEVELS_DB[1])
}

/// Paints the bar, and lets its handles be dragged; a double click goes back to the first range.
pub(crate) fn show(ui: &Ui, bar: Rect, map: ColourMap, range: &mut LevelRange) {
    let id = ui.scope_id().with("levels");
    let response = ui.interact(
        bar.expand2(vec2(6.0, HALF_HANDLE)),
        id,
        Sense::click_and_drag(),
    );
    response.widget_info(|| {
        WidgetInfo::labeled(
            Role::Slider,
            true,
            format!("Levels shown, {}", range.words()),
        )
    });
    if response.double_clicked() {
        *range = LevelRange::default();
    } else {
        drag(&response, bar, range);
    }
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
    }
    paint(ui.painter(), bar, map, *range);
    if !response.dragged() {
        let words = range.words();
        response.on_hover_text(format!(
            "Colours from {words}\nDrag a handle to move an end, the bar to move both; double \
             click goes back"
        ));
    }
}

fn drag(response: &Response, bar: Rect, range: &mut LevelRange) {
    let rows = bar.y_range();
    // Where it was pressed: a drag is known only once it has moved away from there.
    let pressed = response.ctx.input(|input| input.pointer.press_origin());
    if response.drag_started()
        && let Some(at) = pressed
    {
        let grip: Grip = (handle_at(rows, at.y, *range), *range);
        response
            .ctx
            .data_mut(|data| data.insert_temp(response.id, grip));
    }
    let grip: Option<Grip> = response.ctx.data(|data| data.get_temp(response.id));
    let dragged = response.total_drag_delta().filter(|_| response.dragged());
    if let (Some((handle, before)), Some(by)) = (grip, dragged) {
        let db_per_point = (LEVELS_DB[1] - LEVELS_DB[0]) / f64::from(rows.span().max(1.0));
        *range = before.moved(handle, -f64::from(by.y) * db_per_point);
    }
}

/// What is taken hold of at a place: a handle that is near, else both.
fn handle_at(rows: Rangef, y: f32, range: LevelRange) -> Handle {
    let [floor, top] = range.ends_db().map(|db| (axis().y(rows, db) - y).abs());
    match (floor.min(top) <= REACH, floor < top) {
        (true, true) => Handle::Floor,
        (true, false) => Handle::Top,
        (false, _) => Handle::Both,
    }
}

fn paint(painter: &Painter, bar: Rect, map: ColourMap, range: LevelRange) {
    let palette = Palette::of(painter.ctx().theme());
    let axis = axis();
    colour_bar(painter, bar, |share| {
        map.colour(range.share(axis.value(share)))
    });
    let ticks = axis.ticks(bar.height(), 26.0);
    paint_outer_ticks(painter, bar, (&axis, Side::Right), &ticks);
    for level_db in range.ends_db() {
        let y = painter.round_to_pixel_center(axis.y(bar.y_range(), level_db));
        let across = bar.left() - 1.0..=bar.right() + 1.0;
        painter.hline(across, y, Stroke::new(1.5, palette.selection));
        let tip = pos2(bar.left(), y);
        let corners = [vec2(-6.0, -HALF_HANDLE), vec2(-6.0, HALF_HANDLE)].map(|by| tip + by);
        let rim = Stroke::new(1.0, palette.tag);
        let shape =
            Shape::convex_polygon(vec![tip, corners[0], corners[1]], palette.selection, rim);
        painter.add(shape);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{self, Pos2, RawInput};

    /// One frame of a window that holds nothing but a bar.
    fn frame(ctx: &egui::Context, range: &mut LevelRange, event: egui::Event) {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(100.0, 300.0))),
            events: vec![event],
            ..RawInput::default()
        };
        let bar = Rect::from_min_max(pos2(40.0, 100.0), pos2(48.0, 260.0));
        let output = ctx.run_ui(input, |ui| show(ui, bar, ColourMap::Viridis, range));
        output.drop_without_applying_deltas();
    }

    #[test]
    fn a_handle_that_is_pressed_moves_alone_however_fast_it_is_dragged() {
        let (ctx, mut range) = (egui::Context::default(), LevelRange::default());
        let button = |y: f32, pressed| egui::Event::PointerButton {
            pos: pos2(44.0, y),
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        let moved = |y: f32| egui::Event::PointerMoved(pos2(44.0, y));
        frame(&ctx, &mut range, moved(220.0));
        // A decibel is a point high: the floor of −40 dB stands at 220.
        for event in [
            moved(220.0),
            button(220.0, true),
            moved(200.0),
            button(200.0, false),
        ] {
            frame(&ctx, &mut range, event);
        }
        assert_eq!(range.ends_db(), [-20.0, 40.0]);
    }

    #[test]
    fn the_nearest_handle_is_taken_and_between_them_both() {
        let (rows, range) = (Rangef::new(100.0, 260.0), LevelRange::default());
        let at = |y| handle_at(rows, y, range);
        assert_eq!(
            [130.0, 144.0, 180.0, 222.0].map(at),
            [Handle::Both, Handle::Top, Handle::Both, Handle::Floor]
        );
    }
}
