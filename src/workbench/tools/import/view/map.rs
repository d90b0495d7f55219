//! The third step for a height map: its relief, and the places where strokes cross on it.

use eframe::egui::{
    Align2, CursorIcon, DragValue, Label, Rect, RichText, ScrollArea, Sense, Stroke, Ui, UiBuilder,
    WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::axis::{Axis, Side, paint_outer_ticks};
use crate::kit::widgets::fields::form_line;
use crate::kit::widgets::relief::{BAR_ROOM, Relief, paint_height_bar};
use crate::kit::widgets::text::{button, named, paint_quiet, quiet, toggle};
use crate::tools::import::Import;
use crate::tools::import::draft::EvaluationDraft;
use crate::tools::import::view::curves;
use crate::tools::import::work::Heights;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_textile::surface::{Probe, Representation};

/// Room for numbers left of the map and below it, points.
const LEFT: f32 = 36.0;
const BELOW: f32 = 30.0;
/// Height of the profile along the line, and what its axis takes of it, points.
const LINE_PLOT: f32 = 92.0;
const AXIS_BELOW: f32 = 18.0;
/// Height of a place in the list, points.
const LINE: f32 = 22.0;
/// Width of the list beside the map, points.
const LIST: f32 = 236.0;
/// Places that are in sight at once below the map.
const MOST_LINES: usize = 4;
/// More places than these are no import.
const MOST_PLACES: usize = 16;
/// Where the next place lies, as shares of the map; round and round.
const NEXT: [[f64; 2]; 5] = [
    [0.25, 0.25],
    [0.75, 0.75],
    [0.25, 0.75],
    [0.75, 0.25],
    [0.5, 0.25],
];

/// Shows the step.
pub(crate) fn show(ui: &mut Ui, importing: &mut Import, heights: &Heights, map: ColourMap) {
    let Some(relief) = &heights.relief else {
        return;
    };
    let all = ui.available_rect_before_wrap().intersect(ui.clip_rect());
    let (whole, line) = all.split_top_bottom_at_y(all.bottom() - LINE_PLOT);
    let (upper, lower) = split(whole, relief, importing.draft.looked.places.len());
    let room = Rect::from_min_max(
        upper.min + vec2(LEFT, 6.0),
        upper.max - vec2(BAR_ROOM + 16.0, BELOW),
    );
    let rect = relief.fitted(room);
    importing.picture.paint(ui.painter(), rect, relief, map);
    paint_axes(ui, rect, relief);
    let bar = Rect::from_min_max(
        pos2(
            rect.right() + 16.0,
            rect.top().max(rect.center().y - 90.0) + 10.0,
        ),
        pos2(
            rect.right() + 26.0,
            rect.bottom().min(rect.center().y + 90.0),
        ),
    );
    paint_height_bar(ui.painter(), bar, relief, map);
    let is_felt_along =
        importing.draft.described.heights.representation == Representation::Economical;
    show_places(ui, rect, relief, &mut importing.draft.looked, is_felt_along);
    let mut child = ui.new_child(UiBuilder::new().max_rect(lower));
    show_list(
        &mut child,
        relief,
        (heights, is_felt_along),
        &mut importing.draft.looked,
    );
    let places = places_of(&importing.draft.looked, relief.size_mm);
    let last = places.last().map_or(0.0, |[_, w_mm]| *w_mm);
    let line = line.with_max_y(line.bottom() - AXIS_BELOW);
    curves::show_row(ui, line, heights.import.map(), last);
    ui.advance_cursor_after_rect(all);
}

/// The places of the map and of the list: side by side where the map leaves room.
fn split(whole: Rect, relief: &Relief, n_places: usize) -> (Rect, Rect) {
    let [u_mm, w_mm] = relief.size_mm;
    let width = to_single(u_mm / w_mm) * (whole.height() - BELOW) + LEFT + BAR_ROOM + 24.0;
    if width + LIST <= whole.width() {
        return whole.split_left_right_at_x(whole.left() + width);
    }
    let n_lines = n_places.clamp(1, MOST_LINES) as f32;
    let list = n_lines * (LINE + STEP) + LINE + 3.0 * STEP;
    whole.split_top_bottom_at_y((whole.bottom() - list).max(whole.top() + 80.0))
}

fn paint_axes(ui: &Ui, rect: Rect, relief: &Relief) {
    let [u_mm, w_mm] = relief.size_mm;
    let painter = ui.painter();
    let (u, w) = (Axis::linear(0.0, u_mm), Axis::linear(0.0, w_mm));
    paint_outer_ticks(
        painter,
        rect,
        (&u, Side::Bottom),
        &u.ticks(rect.width(), 48.0),
    );
    paint_outer_ticks(
        painter,
        rect,
        (&w, Side::Left),
        &w.ticks(rect.height(), 36.0),
    );
    let words = "warp, mm; weft upwards";
    let at = pos2(rect.right(), rect.bottom() + 16.0);
    paint_quiet(painter, at, Align2::RIGHT_TOP, words);
    let n_missing = relief.n_missing;
    if n_missing > 0 {
        let words = format!("hatched: {n_missing} points missing");
        let at = pos2(rect.left(), rect.bottom() + 16.0);
        paint_quiet(painter, at, Align2::LEFT_TOP, words);
    }
}

/// The places in mm; the middle if none was said.
fn places_of(looked: &EvaluationDraft, size_mm: [f64; 2]) -> Vec<[f64; 2]> {
    if looked.places.is_empty() {
        return vec![size_mm.map(|mm| 0.5 * mm)];
    }
    looked.places.clone()
}

/// A place on the map, in thousandths of a mm.
fn within(place_mm: [f64; 2], size_mm: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|axis| (place_mm[axis].clamp(0.0, size_mm[axis]) * 1e3).floor() / 1e3)
}

/// The strokes on the map: crosses that are dragged; a double click adds one.
fn show_places(
    ui: &Ui,
    rect: Rect,
    relief: &Relief,
    looked: &mut EvaluationDraft,
    is_felt_along: bool,
) {
    let size_mm = relief.size_mm;
    let mm_at = |at: eframe::egui::Pos2| {
        let share = (at - rect.min) / rect.size();
        let place = [
            f64::from(share.x) * size_mm[0],
            f64::from(1.0 - share.y) * size_mm[1],
        ];
        within(place, size_mm)
    };
    let ground = ui.interact(rect, ui.scope_id().with("relief"), Sense::click());
    let label = format!(
        "Relief, {} × {} mm",
        fixed(size_mm[0], 2),
        fixed(size_mm[1], 2)
    );
    ground.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Image, true, label.clone()));
    if let Some(at) = ground.hover_pos() {
        let [u, w] = mm_at(at);
        let height = relief.height_at([u, w]);
        let height = height.map_or_else(|| "missing".to_owned(), |um| with_unit(um, 2, "µm"));
        let words = format!("{}, {} mm: {height}", fixed(u, 2), fixed(w, 2));
        ground.clone().on_hover_text_at_pointer(words);
    }
    let mut places = places_of(looked, size_mm);
    let (n, mut is_moved) = (places.len(), false);
    if is_felt_along
        && ground.double_clicked()
        && n < MOST_PLACES
        && let Some(at) = ground.interact_pointer_pos()
    {
        places.push(mm_at(at));
        is_moved = true;
    }
    for (nth, place_mm) in places.iter_mut().enumerate() {
        let at = pos2(
            rect.left() + to_single(place_mm[0] / size_mm[0]) * rect.width(),
            rect.bottom() - to_single(place_mm[1] / size_mm[1]) * rect.height(),
        );
        let grip = Rect::from_center_size(at, vec2(20.0, 20.0));
        let grip = ui.interact(grip, ui.scope_id().with(("place", nth)), Sense::drag());
        let label = format!("Place {}", nth + 1);
        grip.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Slider, true, label.clone()));
        let grip = grip.on_hover_cursor(CursorIcon::Grab);
        if grip.dragged()
            && let Some(pointer) = grip.interact_pointer_pos()
        {
            *place_mm = mm_at(pointer);
            is_moved = true;
        }
        paint_place(ui, rect, (at, size_mm), nth, n > 1);
    }
    if is_moved {
        looked.places = places;
    }
}

/// A cross with the width of the wire, and its number.
fn paint_place(
    ui: &Ui,
    rect: Rect,
    (at, size_mm): (eframe::egui::Pos2, [f64; 2]),
    nth: usize,
    is_numbered: bool,
) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter_at(rect.expand(1.0));
    let half_mm = 0.5 * Probe::default().width_mm;
    let half_y = to_single(half_mm / size_mm[1]) * rect.height();
    let half_x = to_single(half_mm / size_mm[0]) * rect.width();
    let wire = palette.selection.gamma_multiply(0.16);
    for band in [
        Rect::from_x_y_ranges(rect.x_range(), at.y - half_y..=at.y + half_y),
        Rect::from_x_y_ranges(at.x - half_x..=at.x + half_x, rect.y_range()),
    ] {
        painter.rect_filled(band.intersect(rect), 0, wire);
    }
    // Dark below light: the line shows on every colour.
    for (width, ink) in [(3.0, palette.rim), (1.0, eframe::egui::Color32::WHITE)] {
        painter.hline(rect.x_range(), at.y, Stroke::new(width, ink));
        painter.vline(at.x, rect.y_range(), Stroke::new(width, ink));
    }
    painter.circle_filled(at, 8.0, palette.tag);
    painter.circle_stroke(at, 8.0, Stroke::new(1.0, palette.selection));
    if is_numbered {
        let number = (nth + 1).to_string();
        painter.text(
            at,
            Align2::CENTER_CENTER,
            number,
            theme::small_number(),
            palette.text,
        );
    } else {
        painter.circle_filled(at, 2.0, palette.text);
    }
}

/// The places in numbers with their roughness.
fn show_list(
    ui: &mut Ui,
    relief: &Relief,
    (heights, is_felt_along): (&Heights, bool),
    looked: &mut EvaluationDraft,
) {
    ui.spacing_mut().item_spacing.y = STEP;
    if !is_felt_along {
        let words = "Felt at every point of the map; the cross only says where SMD is read.";
        ui.label(quiet(words));
    }
    let size_mm = relief.size_mm;
    let mut places = places_of(looked, size_mm);
    let before = places.clone();
    let mut gone = None;
    let area = ScrollArea::vertical().id_salt("import-places");
    let height = ui.available_height() - LINE - 2.0 * STEP;
    area.max_height(height.max(LINE))
        .auto_shrink([false, true])
        .show(ui, |ui| {
            for (nth, place) in places.iter_mut().enumerate() {
                let found = heights.places.get(nth);
                if show_place(ui, (nth, before.len()), place, (size_mm, found)) {
                    gone = Some(nth);
                }
            }
        });
    if let Some(nth) = gone {
        places.remove(nth);
    }
    let n = places.len();
    let full = (n >= MOST_PLACES).then(|| format!("An import has at most {MOST_PLACES} places"));
    let refusal = if is_felt_along {
        full.as_deref()
    } else {
        Some("Felt at every point, the map is one textile")
    };
    let tip = "Another textile of the same map; a double click on the map adds one there";
    if button(ui, "Add a place", tip, refusal) {
        let next = NEXT[(n - 1) % NEXT.len()];
        places.push(within(
            [0, 1].map(|axis| next[axis] * size_mm[axis]),
            size_mm,
        ));
    }
    if places != before {
        looked.places = places;
    }
}

/// A place; says whether it is to go.
fn show_place(
    ui: &mut Ui,
    (nth, n): (usize, usize),
    place_mm: &mut [f64; 2],
    (size_mm, found): (
        [f64; 2],
        Option<&Result<std::sync::Arc<selvedge_textile::HeightPlace>, String>>,
    ),
) -> bool {
    let mut is_gone = false;
    form_line(ui, |ui| {
        ui.label(quiet(if n > 1 {
            format!("place {}", nth + 1)
        } else {
            "place".to_owned()
        }));
        for (axis, name) in ["u", "w"].into_iter().enumerate() {
            let value = DragValue::new(&mut place_mm[axis])
                .speed(0.02)
                .fixed_decimals(2);
            let response = ui.add(value.range(0.0..=size_mm[axis]));
            let label = format!("Place {} {name} in mm", nth + 1);
            named(&response, label);
        }
        ui.label(quiet("mm".to_owned()));
        ui.add_space(2.0 * STEP);
        match found {
            Some(Ok(place)) => {
                ui.label(quiet("SMD".to_owned()));
                let smd = with_unit(place.smd_um(), 2, "µm");
                let label = ui.label(RichText::new(smd.clone()).font(theme::number()));
                let described = format!("Place {} SMD {smd}", nth + 1);
                named(&label, described);
            }
            Some(Err(words)) => {
                ui.add(Label::new(quiet(words.clone())).truncate())
                    .on_hover_text(words);
            }
            None => {
                ui.label(quiet("…".to_owned()));
            }
        }
        is_gone = n > 1 && toggle(ui, "×", false, &format!("Leave out place {}", nth + 1));
    });
    is_gone
}
