//! The plot: every textile as a small piece of its cloth between two axes.

use eframe::egui::{
    Color32, Painter, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui,
    Vec2, WidgetInfo, vec2,
};

use crate::bench::library_selection::Joining;
use crate::kit::pane::paint_sentence;
use crate::kit::plot::{Drag, Setting, Shown};
use crate::kit::theme::Palette;
use crate::kit::{plot, swatch, theme};
use crate::tools::collection::chart;
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{CollectionView, Entry};
use crate::tools::collection::view::hand::{Hand, answer, paint_focus};
use selvedge_chart::{Chart, Ruler, Scale};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, just_noticeable_db};

/// Room for pieces of cloth beyond the outermost points, as a share of an axis.
const BESIDE: f64 = 0.05;
/// How much of their ink lines lack that lead from where textiles are without the tuning.
const FAINT: f32 = 0.55;
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

/// A textile in the plot.
struct Placed<'a> {
    entry: Entry<'a>,
    at: Pos2,
}

/// Shows the plot in the space that there is.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    let rect = rect.with_max_y(rect.bottom().min(rect.top() + TALLEST * rect.width()));
    let [x, y] = &view.choice.axes;
    let chart = chart::chart(view, FAINT);
    if chart.series.iter().all(|series| series.points.is_empty()) {
        let words = if view.progress.is_some() {
            "The library is being measured"
        } else {
            "No textile that is shown has both of these figures: choose other axes"
        };
        paint_sentence(ui.painter(), rect, words);
        return;
    }
    let setting = Setting {
        name: &format!("Plot of {} over {}", y.name(), x.name()),
        drag: Drag::Chooses,
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    let chart = with_room(chart, rect.size() - setting.margin.sum());
    let Some(shown) = plot::show(ui, rect, &chart, &setting) else {
        return;
    };
    let placed = placed(&shown, view);
    let side = SIDES[usize::from(placed.len() > MANY)];
    let framed = frame_selecting(ui, &shown.response, &placed, hand);
    let marked = placed.iter().find(|one| one.entry.is_marked);
    if let Some(marked) = marked.filter(|_| x.is_log() && y.is_log()) {
        paint_just_noticed(ui.painter(), &shown, &marked.entry, view);
    }
    let palette = Palette::in_ui(ui);
    let inks = [palette.dim, palette.text];
    paint_names(ui.painter(), shown.area(), (&placed, side), inks);
    for one in in_order(&placed) {
        show_piece(ui, one, (side, framed), view, hand);
    }
    if let Some(frame) = framed {
        let ink = palette.selection;
        ui.painter().rect_filled(frame, 0, ink.gamma_multiply(0.06));
        let edge = Stroke::new(1.0, ink);
        ui.painter().rect_stroke(frame, 0, edge, StrokeKind::Inside);
    }
}

/// The chart as the screen shows it: with room at the ends for pieces of cloth, a decade as long
/// on both of two logarithmic axes, and names placed by where there is room.
fn with_room(mut chart: Chart, size: Vec2) -> Chart {
    let lengths = [size.x, size.y].map(|length| f64::from(length.max(1.0)));
    let rulers = chart.rulers();
    let scales = rulers.each_ref().map(Ruler::scale);
    let ends = rulers.each_ref().map(|ruler| {
        let place = |end| ruler.scale().place(end).unwrap_or_default();
        ruler.ends().map(place)
    });
    let mut spans = ends.map(|[low, high]| (1.0 + 2.0 * BESIDE) * (high - low));
    if scales == [Scale::Log; 2] {
        let a_point = (spans[0] / lengths[0]).max(spans[1] / lengths[1]);
        spans = lengths.map(|length| a_point * length);
    }
    for (nth, axis) in [&mut chart.x, &mut chart.y].into_iter().enumerate() {
        let middle = 0.5 * (ends[nth][0] + ends[nth][1]);
        let wider = [-0.5, 0.5].map(|half| scales[nth].value(middle + half * spans[nth]));
        axis.range = Some(wider);
    }
    chart.words.clear();
    chart
}

/// The textiles that have both figures and lie in the frame, in the view's order.
fn placed<'a>(shown: &Shown, view: &CollectionView<'a>) -> Vec<Placed<'a>> {
    let placed = |entry: &Entry<'a>| {
        let at = shown.at(chart::point(entry, view, view.choice.is_tuned)?);
        let is_seen = shown.area().contains(at);
        is_seen.then_some(Placed { entry: *entry, at })
    };
    view.entries.iter().filter_map(placed).collect()
}

/// One textile as a piece of its cloth.
fn show_piece(
    ui: &Ui,
    one: &Placed<'_>,
    (side, framed): (f32, Option<Rect>),
    view: &CollectionView<'_>,
    hand: &mut Hand<'_>,
) {
    let item = &one.entry.item;
    hand.bench.library.view.want(&item.id);
    let square = Rect::from_center_size(one.at, vec2(side, side));
    let id = ui.scope_id().with(("point", &item.id));
    let response = ui.interact(square, id, Sense::click_and_drag());
    let name = format!("{} in the plot", item.name);
    let is_selected = one.entry.is_selected;
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_selected, &name));
    let picture = hand.bench.library.view.picture(&item.id);
    if picture.is_some() {
        swatch::paint(ui.painter(), square, SHOWN_MM, picture);
    }
    let is_framed = framed.is_some_and(|frame| frame.contains(one.at));
    paint_state(ui.painter(), square, &one.entry, is_framed);
    paint_focus(ui, &response);
    answer(ui, &response, &one.entry, hand);
    response.on_hover_text(words_of(&one.entry, view));
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
    let button = PointerButton::Primary;
    if !(response.dragged_by(button) || response.drag_stopped_by(button)) {
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
    let from = if response.drag_started_by(button) {
        from
    } else {
        kept.or(from)
    };
    if let Some(from) = from {
        ui.data_mut(|data| data.insert_temp(began, from));
    }
    let frame = Rect::from_two_pos(from?, to?);
    if !response.drag_stopped_by(button) {
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
    shown: &Shown,
    marked: &Entry<'_>,
    view: &CollectionView<'_>,
) {
    let Some(mean_um) = marked.mean_um(view.choice.is_tuned) else {
        return;
    };
    let palette = Palette::of(painter.ctx().theme());
    let bands = view.choice.axes.each_ref().map(Measure::band);
    let [Some(x), Some(y)] = bands else { return };
    let ends = [x, y].map(|band| {
        let um = mean_um[band.index()];
        let above_db = quantity::level_db(um) - band.detection_threshold_db(N_ACTIVE);
        let factor = quantity::factor_of_gain(just_noticeable_db(above_db));
        [um / factor, um * factor]
    });
    let frame = Rect::from_two_pos(
        shown.at([ends[0][0], ends[1][0]]),
        shown.at([ends[0][1], ends[1][1]]),
    );
    let edge = Stroke::new(1.0, palette.line);
    let painter = painter.with_clip_rect(shown.area().expand(1.0));
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
