//! The lens: the cloth under the finger, enlarged, and where the finger is and how fast.
//!
//! It stands beside the workspace where there is room, and is left out where there is none.

use eframe::egui::{
    self, Align2, CursorIcon, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::view::{EngineView, SceneView};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::ground::{paint_cloths, paint_display};
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::{display, tips};
use selvedge_foundation::quantity;

/// Width of the column that holds the lens, points.
const COLUMN: f32 = 232.0;
/// Space around the lens, points.
const MARGIN: f32 = 16.0;
/// Points per millimetre under the lens.
const POINTS_PER_MM: f64 = 11.0;
/// Height of a line of readings, points.
const LINE: f32 = 20.0;

/// Parts the workspace's frame into the ground and, where there is room, the lens's column.
pub(crate) fn split(inner: Rect, size_mm: [f64; 2]) -> (Rect, Option<Rect>) {
    #[expect(clippy::cast_possible_truncation, reason = "a ratio, for the screen")]
    let aspect = (size_mm[0] / size_mm[1].max(1e-9)) as f32;
    let needed = inner.height() * aspect;
    if inner.width() - needed < COLUMN || inner.height() < 320.0 {
        return (inner, None);
    }
    let edge = inner.right() - COLUMN;
    let ground = Rect::from_min_max(inner.min, pos2(edge, inner.bottom()));
    (
        ground,
        Some(Rect::from_min_max(pos2(edge, inner.top()), inner.max)),
    )
}

/// Shows the lens and its readings in `column`; a click on a contactor looks closer at it.
pub(crate) fn show(ui: &Ui, column: Rect, stage: &Stage<'_>, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter_at(column);
    painter.vline(
        column.left() + 0.5,
        column.y_range(),
        Stroke::new(1.0, palette.hairline),
    );
    let left = column.left() + MARGIN;
    let title_at = pos2(left, column.top() + MARGIN);
    painter.text(
        title_at,
        Align2::LEFT_CENTER,
        "Under the finger",
        theme::small(),
        palette.dim,
    );
    let side = COLUMN - 2.0 * MARGIN;
    let glass = Rect::from_min_size(pos2(left, column.top() + MARGIN + 14.0), vec2(side, side));
    let response = ui.interact(glass, ui.scope_id().with("lens"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, "Lens"));
    painter.rect_filled(glass, 4, palette.panel);
    if let Some(centre) = stage.sight.live.centre {
        let view = ViewTransform::new(glass, centre, POINTS_PER_MM);
        let painter = ui.painter_at(glass);
        paint_cloths(&painter, &view, stage);
        paint_display(&painter, &view, stage);
        choose(&response, &view, stage, commands);
    } else {
        let words = "Move the pointer over a textile";
        painter.text(
            glass.center(),
            Align2::CENTER_CENTER,
            words,
            theme::small(),
            palette.dim,
        );
    }
    painter.rect_stroke(
        glass,
        4,
        Stroke::new(1.0, palette.hairline),
        StrokeKind::Outside,
    );
    paint_scale_bar(&painter, glass);
    show_readings(
        ui,
        pos2(left, glass.bottom() + 20.0),
        side,
        stage.sight.scene,
        stage.sight.live,
    );
}

/// The part of the lens's column below its readings; `None` where little is left.
pub(crate) fn room_below(column: Rect) -> Option<Rect> {
    let taken = MARGIN + 14.0 + COLUMN - 2.0 * MARGIN + 20.0 + 24.0 + 4.0 * LINE;
    let room = column
        .with_min_y(column.top() + taken)
        .shrink2(vec2(MARGIN, 0.0));
    (room.height() >= 120.0).then_some(room)
}

/// Tells of the contactor under the pointer, and chooses the one that is clicked.
fn choose(response: &Response, view: &ViewTransform, stage: &Stage<'_>, commands: &mut Commands) {
    let at = response.hover_pos();
    let Some(index) = at.and_then(|at| display::hit(view, &stage.sight.live.dots, at)) else {
        return;
    };
    response.ctx.set_cursor_icon(CursorIcon::PointingHand);
    commands.push(ShowCommand::Hover(Part::Contactor(index)).into());
    if response.clicked() {
        commands.push(ShowCommand::SelectContactor(index).into());
    }
    tips::describe_dot(response, stage, index);
}

fn paint_scale_bar(painter: &egui::Painter, glass: Rect) {
    let palette = Palette::of(painter.ctx().theme());
    #[expect(clippy::cast_possible_truncation, reason = "a length on the screen")]
    let length = 5.0 * POINTS_PER_MM as f32;
    let tag = Rect::from_min_size(
        glass.right_bottom() - vec2(length + 16.0, 22.0),
        vec2(length + 16.0, 22.0),
    );
    painter.rect_filled(
        tag,
        egui::CornerRadius {
            nw: 5,
            ..egui::CornerRadius::ZERO
        },
        palette.tag,
    );
    let y = tag.bottom() - 5.0;
    painter.hline(
        (tag.left() + 8.0)..=(tag.right() - 8.0),
        y,
        Stroke::new(1.5, palette.text),
    );
    let at = pos2(tag.center().x, y - 3.0);
    painter.text(
        at,
        Align2::CENTER_BOTTOM,
        "5 mm",
        theme::small_number(),
        palette.text,
    );
}

fn show_readings(ui: &Ui, corner: egui::Pos2, width: f32, scene: &SceneView, live: &EngineView) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let under = live
        .centre
        .and_then(|_| live.cloth_under_display())
        .and_then(|index| scene.cloths.get(index));
    let cloth = under.map_or_else(|| "no textile".to_owned(), |cloth| cloth.name.clone());
    let galley = painter.layout(cloth, theme::body(), palette.text, width);
    painter.galley(pos2(corner.x, corner.y - 8.0), galley, palette.text);
    let place = |pick: fn(selvedge_foundation::geometry::Point) -> f64| {
        live.centre
            .map_or_else(|| "–".to_owned(), |centre| quantity::fixed(pick(centre), 1))
    };
    let speed = live.centre.map_or_else(
        || "–".to_owned(),
        |_| quantity::fixed(live.speed_mm_per_s, 0),
    );
    let readings = [
        ("x", place(|p| p.x_mm), "mm"),
        ("y", place(|p| p.y_mm), "mm"),
        ("Speed", speed, "mm/s"),
    ];
    for (i, (name, digits, unit)) in readings.into_iter().enumerate() {
        let y = corner.y + 24.0 + i as f32 * LINE;
        let (left, right) = (corner.x, corner.x + width);
        painter.text(
            pos2(left, y),
            Align2::LEFT_CENTER,
            name,
            theme::body(),
            palette.dim,
        );
        painter.text(
            pos2(right - 30.0, y),
            Align2::LEFT_CENTER,
            unit,
            theme::small(),
            palette.dim,
        );
        let at = pos2(right - 36.0, y);
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            digits,
            theme::number(),
            palette.text,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lens_stands_where_there_is_room() {
        let wide = Rect::from_min_size(pos2(0.0, 0.0), vec2(1040.0, 600.0));
        let (ground, lens) = split(wide, [260.0, 260.0]);
        assert_eq!(
            ground.width() + lens.map_or(0.0, |lens| lens.width()),
            1040.0
        );
        let narrow = Rect::from_min_size(pos2(0.0, 0.0), vec2(700.0, 600.0));
        assert_eq!(split(narrow, [260.0, 260.0]), (narrow, None));
    }
}
