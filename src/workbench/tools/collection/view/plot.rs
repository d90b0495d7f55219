//! The plot: every textile as a small piece of its cloth between two axes.

use eframe::egui::{
    self, Align2, Color32, Painter, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo,
    pos2, vec2,
};

use crate::bench::library_selection::Joining;
use crate::kit::pane::paint_sentence;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Side, paint_ticks};
use crate::kit::{swatch, theme};
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{CollectionView, Entry};
use crate::tools::collection::view::hand::{Hand, answer, paint_focus};
use crate::tools::collection::view::points::{Placed, Plot};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, detection_threshold_db, just_noticeable_db};

/// Room around the plot for ticks and titles: left, top, right, bottom, points.
const ROOM: [f32; 4] = [40.0, 18.0, 8.0, 32.0];
/// Side of a piece of cloth, where there are few and where there are many, points.
const SIDES: [f32; 2] = [22.0, 15.0];
/// More textiles than this are many.
const MANY: usize = 32;
/// How much cloth a piece shows, mm.
const SHOWN_MM: f32 = 9.0;
/// The most height of the plot over its width.
const TALLEST: f32 = 1.1;
/// From a point to its name, points.
const AWAY: f32 = 4.0;
/// Contactors that are taken to sound when it is asked what is just noticed.
const N_ACTIVE: usize = 24;

/// Shows the plot in the space that there is.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let [left, top, right, bottom] = ROOM;
    let area = Rect::from_min_max(rect.min + vec2(left, top), rect.max - vec2(right, bottom));
    let [x, y] = &view.choice.axes;
    let name = format!("Plot of {} over {}", y.name(), x.name());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, &name));
    let area = area.with_max_y(area.bottom().min(area.top() + TALLEST * area.width()));
    let Some(plot) = Plot::of(area, view) else {
        let words = if view.progress.is_some() {
            "The library is being measured"
        } else {
            "No textile that is shown has both of these figures: choose other axes"
        };
        paint_sentence(ui.painter(), area, words);
        return;
    };
    paint_axes(ui.painter(), &plot, view);
    let placed = plot.placed(view);
    let side = SIDES[usize::from(placed.len() > MANY)];
    let framed = frame_selecting(ui, &response, &placed, hand);
    paint_tuning(ui, &placed);
    let marked = placed.iter().find(|one| one.entry.is_marked);
    if let Some(marked) = marked.filter(|_| x.is_log() && y.is_log()) {
        paint_just_noticed(ui.painter(), &plot, marked, view);
    }
    let palette = Palette::in_ui(ui);
    let inks = [palette.dim, palette.text];
    paint_names(ui.painter(), area, (&placed, side), inks);
    for one in in_order(&placed) {
        let library_view = &mut hand.bench.library.view;
        library_view.want(&one.entry.item.id);
        let picture = library_view.picture(&one.entry.item.id);
        let square = Rect::from_center_size(one.at, vec2(side, side));
        let response = ui.interact(
            square,
            ui.scope_id().with(("point", &one.entry.item.id)),
            Sense::click_and_drag(),
        );
        let name = format!("{} in the plot", one.entry.item.name);
        let is_selected = one.entry.is_selected;
        response
            .widget_info(|| WidgetInfo::selected(egui::Role::CheckBox, true, is_selected, &name));
        if picture.is_some() {
            swatch::paint(ui.painter(), square, SHOWN_MM, picture);
        } else {
            ui.painter().circle_filled(one.at, 4.0, palette.line);
        }
        let is_framed = framed.is_some_and(|frame| frame.contains(one.at));
        paint_state(ui.painter(), square, &one.entry, is_framed);
        paint_focus(ui, &response);
        answer(ui, &response, &one.entry, hand);
        response.on_hover_text(words_of(&one.entry, view));
    }
    if let Some(frame) = framed {
        let ink = palette.selection;
        ui.painter().rect_filled(frame, 0, ink.gamma_multiply(0.06));
        let edge = Stroke::new(1.0, ink);
        ui.painter().rect_stroke(frame, 0, edge, StrokeKind::Inside);
    }
}

/// What is selected or marked lies on top of the others.
fn in_order<'a, 'b>(placed: &'b [Placed<'a>]) -> Vec<&'b Placed<'a>> {
    let mut all: Vec<&Placed<'_>> = placed.iter().collect();
    all.sort_by_key(|one| u8::from(one.entry.is_selected) + 2 * u8::from(one.entry.is_marked));
    all
}

/// A drag over the ground selects what lies in its frame; a click on the ground selects nothing.
/// The frame as it is pulled.
fn frame_selecting(
    ui: &Ui,
    response: &Response,
    placed: &[Placed<'_>],
    hand: &mut Hand<'_>,
) -> Option<Rect> {
    if response.clicked() {
        hand.select(Vec::new(), Joining::Alone);
    }
    if !(response.dragged() || response.drag_stopped()) {
        return None;
    }
    let (from, to) = ui.input(|input| {
        let pointer = &input.pointer;
        let began = pointer
            .press_origin()
            .or_else(|| response.interact_pointer_pos());
        (began, pointer.latest_pos())
    });
    let began = ui.scope_id().with("frame began");
    let kept = ui.data(|data| data.get_temp(began));
    let from = if response.drag_started() {
        from
    } else {
        kept.or(from)
    };
    if let Some(from) = from {
        ui.data_mut(|data| data.insert_temp(began, from));
    }
    let frame = Rect::from_two_pos(from?, to?);
    if !response.drag_stopped() {
        return Some(frame);
    }
    let within = placed.iter().filter(|one| frame.contains(one.at));
    let ids = within.map(|one| one.entry.item.id.clone()).collect();
    let is_more = ui.input(|input| input.modifiers.command || input.modifiers.shift);
    let joining = if is_more {
        Joining::Also
    } else {
        Joining::Alone
    };
    hand.select(ids, joining);
    None
}

fn paint_axes(painter: &Painter, plot: &Plot, view: &CollectionView<'_>) {
    let palette = Palette::of(painter.ctx().theme());
    let area = plot.area;
    paint_ticks(
        painter,
        area,
        (&plot.x, Side::Bottom),
        &plot.x.ticks(area.width(), 44.0),
    );
    paint_ticks(
        painter,
        area,
        (&plot.y, Side::Left),
        &plot.y.ticks(area.height(), 28.0),
    );
    let ink = |measure: &Measure| {
        measure
            .band()
            .map_or(palette.dim, |band| palette.band(band))
    };
    let [x, y] = &view.choice.axes;
    let at = pos2(area.left(), area.top() - 4.0);
    let (text, font) = (y.label(view.items), theme::small());
    painter.text(at, Align2::LEFT_BOTTOM, text, font.clone(), ink(y));
    let at = pos2(area.right(), area.bottom() + 17.0);
    painter.text(at, Align2::RIGHT_TOP, x.label(view.items), font, ink(x));
}

/// Faint lines from where textiles are without the tuning to where they are with it.
fn paint_tuning(ui: &Ui, placed: &[Placed<'_>]) {
    let palette = Palette::in_ui(ui);
    for one in placed {
        let Some(raw) = one.raw else { continue };
        let is_lit = one.entry.is_marked || one.entry.is_selected;
        let ink = if is_lit {
            palette.line
        } else {
            palette.line.gamma_multiply(0.45)
        };
        ui.painter()
            .line_segment([raw, one.at], Stroke::new(1.0, ink));
        ui.painter().circle_filled(raw, 1.5, ink);
    }
}

/// Writes names right or left of their points where they touch no point and no other name; those
/// that are selected or marked first.
fn paint_names(
    painter: &Painter,
    area: Rect,
    (placed, side): (&[Placed<'_>], f32),
    inks: [Color32; 2],
) {
    let square = |one: &Placed<'_>| Rect::from_center_size(one.at, vec2(side, side));
    let mut taken: Vec<Rect> = placed.iter().map(square).collect();
    let is_first = |one: &&Placed<'_>| one.entry.is_selected || one.entry.is_marked;
    let (first, rest): (Vec<&Placed<'_>>, Vec<&Placed<'_>>) = placed.iter().partition(is_first);
    let first = first.into_iter().map(|one| (one, inks[1]));
    let rest = rest.into_iter().map(|one| (one, inks[0]));
    for (one, ink) in first.chain(rest) {
        let name = one.entry.item.name.clone();
        let galley = painter.layout_no_wrap(name, theme::small(), ink);
        let size = galley.size();
        let out = 0.5 * side + AWAY;
        let places = [
            one.at + vec2(out, -0.5 * size.y),
            one.at + vec2(-out - size.x, -0.5 * size.y),
            one.at + vec2(-0.5 * size.x, out - 2.0),
            one.at + vec2(-0.5 * size.x, -out - size.y + 2.0),
        ];
        let is_free = |rect: &Rect| {
            let is_inside = area.contains_rect(*rect);
            is_inside && taken.iter().all(|other| !other.intersects(*rect))
        };
        let rects = places.map(|corner| Rect::from_min_size(corner, size));
        if let Some(rect) = rects.into_iter().find(|rect| is_free(rect)) {
            painter.galley(rect.min, galley, ink);
            taken.push(rect);
        }
    }
}

/// A frame around a textile within which no other is told from it by either amplitude, by a model.
fn paint_just_noticed(
    painter: &Painter,
    plot: &Plot,
    marked: &Placed<'_>,
    view: &CollectionView<'_>,
) {
    let Some(mean_um) = marked.entry.mean_um(view.choice.is_tuned) else {
        return;
    };
    let palette = Palette::of(painter.ctx().theme());
    let bands = view.choice.axes.each_ref().map(Measure::band);
    let [Some(x), Some(y)] = bands else { return };
    let ends = [x, y].map(|band| {
        let um = mean_um[band.index()];
        let above_db = quantity::level_db(um) - detection_threshold_db(band, N_ACTIVE);
        let factor = quantity::factor_of_gain(just_noticeable_db(above_db));
        [um / factor, um * factor]
    });
    let frame = Rect::from_two_pos(
        plot.at([ends[0][0], ends[1][0]]),
        plot.at([ends[0][1], ends[1][1]]),
    );
    let edge = Stroke::new(1.0, palette.line);
    let painter = painter.with_clip_rect(plot.area.expand(1.0));
    painter.rect_stroke(frame, 4, edge, StrokeKind::Inside);
}

/// Selected: white edge. Marked: a second one outside. In the scene: a mark at the corner.
fn paint_state(painter: &Painter, square: Rect, entry: &Entry<'_>, is_framed: bool) {
    let palette = Palette::of(painter.ctx().theme());
    let edge = |rect: Rect, width: f32, ink: Color32| {
        let stroke = Stroke::new(width, ink);
        painter.rect_stroke(rect, 0, stroke, StrokeKind::Inside);
    };
    if entry.placed.is_some() {
        let corner = square.right_top();
        painter.circle(corner, 3.5, palette.text, Stroke::new(1.5, palette.panel));
    }
    if entry.is_selected || is_framed {
        edge(square.expand(1.0), 2.0, palette.selection);
    }
    if entry.is_marked {
        edge(square.expand(3.0), 1.0, palette.selection);
    }
}

/// A textile in words: name, kind, numbers.
fn words_of(entry: &Entry<'_>, view: &CollectionView<'_>) -> String {
    let is_tuned = view.choice.is_tuned;
    let number = |measure: Measure, decimals: usize, unit: &str| {
        let value = entry.value(&measure, is_tuned);
        value.map_or_else(
            || "silent".to_owned(),
            |value| quantity::with_unit(value, decimals, unit),
        )
    };
    let pair = |of: fn(Band) -> Measure, decimals, unit| {
        let [low, high] = Band::ALL.map(|band| number(of(band), decimals, unit));
        format!("{low} and {high}")
    };
    let speed = quantity::with_unit(view.choice.speed_mm_per_s, 0, "mm/s");
    let how = if is_tuned { ", as tuned" } else { "" };
    let (smd, is_measured) = crate::tools::collection::listing::smd_um(entry);
    let smd = smd.map_or_else(String::new, |um| {
        let of = if is_measured {
            "measured"
        } else {
            "of the heights"
        };
        format!("\nSMD {} {of}", quantity::with_unit(um, 2, "µm"))
    });
    let scene = if entry.placed.is_some() {
        "\nIn the scene"
    } else {
        ""
    };
    format!(
        "{}\n{}\nA40 {}, A320 {}\nlevel {}, at {speed}{how}\nvariation {} over all points\n\
         anisotropy {}{smd}{scene}\nClick to select it, double click to add it, drag it into the \
         workspace",
        entry.item.name,
        entry.item.kind,
        number(Measure::Amplitude(Band::Low), 2, "µm"),
        number(Measure::Amplitude(Band::High), 2, "µm"),
        number(Measure::Level, 1, "dB re 1 µm"),
        pair(Measure::Variation, 0, "%"),
        pair(Measure::Anisotropy, 1, "dB"),
    )
}
