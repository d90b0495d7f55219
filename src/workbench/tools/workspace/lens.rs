//! The lens: the display ten times larger than it is, with the cloth under it; beside that the
//! display as large as it is, and where it is and how fast.
//!
//! It takes the room that the workspace leaves, and a part of it where there is little. Where ten
//! times does not fit, the display fills the glass, and what is written beside it says how much
//! larger it is.

use eframe::egui::{
    self, Align2, CursorIcon, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::on_finger::paint_label;
use crate::bench::paint_display;
use crate::bench::view::{EngineView, SceneView};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::ground::{paint_cloths, paint_display};
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::tips;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// How many times larger than it is the display is shown, where that fits.
const MAGNIFICATION: f64 = 10.0;
/// What a contactor takes around its middle, mm.
const RIM_MM: f64 = 1.0;
/// What the display as large as it is stands on, mm.
const TRUE_SIDE_MM: f64 = 16.0;
/// The same at least and at most, points.
const TRUE_SIDE: [f32; 2] = [40.0, 96.0];
/// What the lens asks for: a display of 8 mm by 12 mm ten times larger, points.
const WANTED: f32 = 328.0;
/// Space around the lens, points.
const MARGIN: f32 = 12.0;
/// Height of the line above the lens, points.
const TITLE: f32 = 20.0;
/// Height of a map's legend below the lens, points.
const LEGEND: f32 = 150.0;
/// Less room than this has no lens, width and height in points.
const LEAST: [f32; 2] = [240.0, 110.0];
/// A lower column has the glass alone, points.
const LEAST_FOR_FOOT: f32 = 170.0;

/// Parts the workspace's frame into the ground and the lens's part: what the whole workspace does
/// not need, on its right, or below it in a high frame.
pub(crate) fn split(inner: Rect, size_mm: [f64; 2]) -> (Rect, Option<Rect>) {
    let aspect = to_single(size_mm[0] / size_mm[1].max(1e-9));
    if inner.width() < LEAST[0] || inner.height() < LEAST[1] || !aspect.is_finite() {
        return (inner, None);
    }
    let share = |whole: f32, needed: f32| {
        let least = WANTED.min(0.42 * whole);
        (whole - needed).clamp(least, 0.5 * whole).round()
    };
    let (mut ground, mut lens) = (inner, inner);
    if inner.width() >= inner.height() {
        let width = share(inner.width(), inner.height() * aspect);
        ground.max.x -= width;
        lens.min.x = ground.max.x;
    } else {
        let height = share(inner.height(), inner.width() / aspect.max(1e-3));
        ground.max.y -= height;
        lens.min.y = ground.max.y;
    }
    (ground, Some(lens))
}

/// What stands where in the lens's part.
struct Parts {
    title: Rect,
    glass: Rect,
    /// The display as large as it is.
    true_size: Option<Rect>,
    readings: Option<Rect>,
    legend: Option<Rect>,
}

impl Parts {
    fn of(column: Rect, true_points_per_mm: f64, has_legend: bool) -> Self {
        let mut room = column.shrink2(vec2(MARGIN, 0.5 * MARGIN));
        let title = room.with_max_y(room.top() + TITLE);
        room.min.y = title.bottom();
        let legend = (has_legend && room.height() > 2.5 * LEGEND).then(|| {
            let legend = room.with_min_y(room.bottom() - LEGEND);
            room.max.y = legend.top() - MARGIN;
            legend
        });
        let has_foot = column.height() >= LEAST_FOR_FOOT;
        let foot = has_foot.then(|| {
            let side = to_single(TRUE_SIDE_MM * true_points_per_mm);
            let side = side.clamp(TRUE_SIDE[0], TRUE_SIDE[1]).round();
            let foot = room.with_min_y(room.bottom() - side);
            room.max.y = foot.top() - MARGIN;
            (
                foot.with_max_x(foot.left() + side),
                foot.with_min_x(foot.left() + side + MARGIN),
            )
        });
        Self {
            title,
            glass: room,
            true_size: foot.map(|(true_size, _)| true_size),
            readings: foot.map(|(_, readings)| readings),
            legend,
        }
    }
}

/// Points per millimetre under the lens: ten times true size, or what shows all of the display.
fn points_per_mm(glass: Rect, true_points_per_mm: f64, live: &EngineView) -> f64 {
    let [width_mm, height_mm] = extent_mm(live);
    let fitting = (f64::from(glass.width()) / width_mm).min(f64::from(glass.height()) / height_mm);
    fitting.min(MAGNIFICATION * true_points_per_mm)
}

/// How much of the workspace the display takes around its middle, mm.
fn extent_mm(live: &EngineView) -> [f64; 2] {
    let centre = live.centre.unwrap_or_default();
    let far = |pick: fn(Point) -> f64| {
        let off = live
            .dots
            .iter()
            .map(|dot| (pick(dot.position) - pick(centre)).abs());
        2.0 * (off.fold(0.0, f64::max) + RIM_MM)
    };
    [far(|place| place.x_mm), far(|place| place.y_mm)]
}

/// Shows the lens and its readings in `column`; a click on a contactor looks closer at it.
pub(crate) fn show(ui: &Ui, column: Rect, stage: &Stage<'_>, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let true_points_per_mm = stage.true_points_per_mm();
    let parts = Parts::of(column, true_points_per_mm, has_legend(stage));
    let painter = ui.painter_at(column);
    painter.rect_filled(column, 0, palette.panel);
    let scale = points_per_mm(parts.glass, true_points_per_mm, stage.sight.live);
    show_title(ui, parts.title, (scale / true_points_per_mm, stage));
    let glass = parts.glass;
    let response = ui.interact(glass, ui.scope_id().with("lens"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, "Lens"));
    painter.rect_filled(glass, 4, palette.floor);
    let centre = stage.sight.live.centre;
    if let Some(centre) = centre {
        let view = ViewTransform::new(glass, centre, scale);
        let painter = ui.painter_at(glass);
        paint_cloths(&painter, &view, stage);
        paint_display(&painter, &view, stage);
        paint_label(&painter, glass, [stage.sight.live.on_finger; 2]);
        choose(&response, &view, stage, commands);
        paint_scale_bar(&painter, glass, scale);
    } else {
        let (words, font) = ("Move the pointer over a textile", theme::small());
        let at = glass.center();
        painter.text(at, Align2::CENTER_CENTER, words, font, palette.dim);
    }
    let edge = Stroke::new(1.0, palette.hairline);
    painter.rect_stroke(glass, 4, edge, StrokeKind::Outside);
    if let (Some(place), Some(centre)) = (parts.true_size, centre) {
        let view = ViewTransform::new(place, centre, true_points_per_mm);
        let painter = ui.painter_at(place);
        paint_cloths(&painter, &view, stage);
        paint_display(&painter, &view, stage);
    }
    if let Some(place) = parts.readings {
        paint_readings(ui, place, stage.sight.scene, stage.sight.live);
    }
}

/// Whether a map of the cloth is shown, which needs a legend.
fn has_legend(stage: &Stage<'_>) -> bool {
    stage.state.overlays.map.is_some()
}

/// Where a map's legend stands below the lens; `None` where there is little room.
pub(crate) fn room_for_legend(column: Rect, stage: &Stage<'_>) -> Option<Rect> {
    Parts::of(column, stage.true_points_per_mm(), has_legend(stage)).legend
}

/// What is shown, and how many times larger than it is.
fn show_title(ui: &Ui, place: Rect, (times, stage): (f64, &Stage<'_>)) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter_at(place);
    let font = theme::small();
    let words = "Under the finger";
    painter.text(
        place.left_center(),
        Align2::LEFT_CENTER,
        words,
        font,
        palette.dim,
    );
    let decimals = usize::from(times < 9.95);
    let larger = format!("{} ×", quantity::fixed(times, decimals));
    let font = theme::small_number();
    let at = place.right_center();
    let written = painter.text(at, Align2::RIGHT_CENTER, &larger, font, palette.dim);
    let response = ui.interact(written, ui.scope_id().with("lens scale"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &larger));
    response.on_hover_text(match stage.state.true_pixels_per_mm {
        Some(_) => "So many times larger than true size, by your calibration of the screen",
        None => {
            "So many times larger than true size on a screen of 96 dots an inch; View → Calibrate \
             to true size measures yours"
        }
    });
}

/// Tells of the contactor under the pointer, and chooses the one that is clicked.
fn choose(response: &Response, view: &ViewTransform, stage: &Stage<'_>, commands: &mut Commands) {
    let at = response.hover_pos();
    let Some(index) = at.and_then(|at| paint_display::hit(view, &stage.sight.live.dots, at)) else {
        return;
    };
    response.ctx.set_cursor_icon(CursorIcon::PointingHand);
    commands.push(ShowCommand::Hover(Part::Contactor(index)).into());
    if response.clicked() {
        commands.push(ShowCommand::SelectContactor(index).into());
    }
    tips::describe_dot(response, stage, index);
}

/// A length on the lens, with its number: the longest of a few that takes less than half.
fn paint_scale_bar(painter: &egui::Painter, glass: Rect, points_per_mm: f64) {
    let palette = Palette::of(painter.ctx().theme());
    let most_mm = 0.4 * f64::from(glass.width()) / points_per_mm;
    let Some(mm) = [20.0, 10.0, 5.0, 2.0, 1.0]
        .into_iter()
        .find(|mm| *mm <= most_mm)
    else {
        return;
    };
    let length = to_single(mm * points_per_mm);
    let size = vec2(length + 16.0, 22.0);
    let tag = Rect::from_min_size(glass.right_bottom() - size, size);
    let corner = egui::CornerRadius {
        nw: 5,
        ..egui::CornerRadius::ZERO
    };
    painter.rect_filled(tag, corner, palette.tag);
    let y = tag.bottom() - 5.0;
    let ends = (tag.left() + 8.0)..=(tag.right() - 8.0);
    painter.hline(ends, y, Stroke::new(1.5, palette.text));
    let at = pos2(tag.center().x, y - 3.0);
    let words = quantity::with_unit(mm, 0, "mm");
    let font = theme::small_number();
    painter.text(at, Align2::CENTER_BOTTOM, words, font, palette.text);
}

/// The textile, where the display is on it and how fast, in digits that keep their places.
fn paint_readings(ui: &Ui, place: Rect, scene: &SceneView, live: &EngineView) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter_at(place);
    let under = (live.centre)
        .and_then(|_| live.cloth_under_display())
        .and_then(|index| scene.cloths.get(index));
    let cloth = under.map_or("no textile", |cloth| cloth.name.as_str());
    let digits = |value: Option<f64>, decimals| {
        value.map_or_else(|| "–".to_owned(), |value| quantity::fixed(value, decimals))
    };
    let (x, y) = (
        digits(live.centre.map(|centre| centre.x_mm), 1),
        digits(live.centre.map(|centre| centre.y_mm), 1),
    );
    let speed = digits(live.centre.map(|_| live.speed_mm_per_s), 0);
    let at = format!("{x:>6} {y:>6} mm");
    let speed = format!("{speed:>6} mm/s");
    let middle = place.center().y;
    let wide = place.width() >= 190.0;
    let row = |nth: f32| pos2(place.left(), middle + nth * 18.0);
    let numbers = theme::small_number();
    let (first, last) = if wide { (-0.5, 0.5) } else { (-1.0, 1.0) };
    let left = Align2::LEFT_CENTER;
    painter.text(row(first), left, cloth, theme::body(), palette.text);
    if wide {
        let both = format!("{at}  {speed}");
        painter.text(row(last), left, both, numbers, palette.text);
    } else {
        painter.text(row(0.0), left, at, numbers.clone(), palette.text);
        painter.text(row(last), left, speed, numbers, palette.text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::view::Dot;

    /// The workspace pane of some windows, points.
    const PANES: [[f32; 2]; 5] = [
        [800.0, 520.0],
        [2000.0, 1000.0],
        [600.0, 490.0],
        [260.0, 150.0],
        [330.0, 700.0],
    ];
    /// Points per millimetre on a screen of 96 dots an inch.
    const TRUE: f64 = 96.0 / 25.4;

    fn display() -> EngineView {
        let dots = [[-3.0, 5.0], [3.0, -5.0]].map(|[x, y]| Dot {
            position: Point::new(50.0 + x, 60.0 + y),
            ..Dot::default()
        });
        EngineView {
            centre: Some(Point::new(50.0, 60.0)),
            dots: dots.to_vec(),
            ..EngineView::default()
        }
    }

    #[test]
    fn workspace_and_lens_share_all_the_room_and_neither_has_less_than_two_fifths() {
        for [width, height] in PANES {
            let inner = Rect::from_min_size(pos2(10.0, 20.0), vec2(width, height));
            let (ground, lens) = split(inner, [260.0, 260.0]);
            let lens = lens.unwrap();
            assert_eq!(ground.union(lens), inner);
            let area = |rect: Rect| rect.area() / inner.area();
            assert!(area(ground) >= 0.499, "{width} × {height}: {ground}");
            let is_enough = area(lens) > 0.41 || lens.width() >= WANTED || lens.height() >= WANTED;
            assert!(is_enough, "{width} × {height}: {lens}");
        }
        let narrow = Rect::from_min_size(pos2(0.0, 0.0), vec2(200.0, 600.0));
        assert_eq!(split(narrow, [260.0, 260.0]), (narrow, None));
    }

    #[test]
    fn all_of_the_display_is_under_the_lens_and_ten_times_larger_where_that_fits() {
        for [width, height] in PANES {
            let inner = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
            let (_, lens) = split(inner, [260.0, 260.0]);
            let parts = Parts::of(lens.unwrap(), TRUE, false);
            let scale = points_per_mm(parts.glass, TRUE, &display());
            let [width_mm, height_mm] = extent_mm(&display());
            assert_eq!([width_mm, height_mm], [8.0, 12.0]);
            assert!(scale * height_mm <= f64::from(parts.glass.height()) + 1e-3);
            assert!(scale * width_mm <= f64::from(parts.glass.width()) + 1e-3);
            let fits = parts.glass.width() >= 303.0 && parts.glass.height() >= 454.0;
            assert_eq!(
                fits,
                (scale / TRUE - 10.0).abs() < 1e-9,
                "{width} × {height}"
            );
            let stands = parts
                .true_size
                .is_some_and(|place| inner.contains_rect(place));
            assert_eq!(stands, height > LEAST_FOR_FOOT, "{width} × {height}");
        }
    }
}
