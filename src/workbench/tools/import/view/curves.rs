//! The third step for strokes: every curve with what is marked of it, the evaluated section, and
//! the figures of it.

use eframe::egui::{Align2, Margin, Rect, Ui, pos2, vec2};

use crate::kit::plot;
use crate::kit::plot::{Setting, Shown};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::form_line;
use crate::kit::widgets::text::{paint_quiet, quiet, toggle};
use crate::tools::import::draft::Draft;
use crate::tools::import::envelope::Envelope;
use crate::tools::import::view::section;
use crate::tools::import::view::section::{Ends, Wish};
use crate::tools::import::work::{Heights, Strokes};
use selvedge_chart::{At, Axis, Band, Chart, Extent, Ink, Rule, Series, Style, Weight};
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_textile::surface::{Direction, HeightMap};
use selvedge_textile::{KesImport, KesReading, KesStroke, Mark, MarkKind, TextileAxis};

/// Room around the curves: for numbers and names, and on the right for figures.
const MARGIN: Margin = Margin {
    left: 44,
    right: 112,
    top: 15,
    bottom: 2,
};
/// Room below the last for places, points.
const BOTTOM: i8 = 18;
/// More outliers than this are not drawn.
const MAX_OUTLIERS: usize = 500;

/// A curve in the column of curves.
struct Lane<'a> {
    name: &'static str,
    rect: Rect,
    chart: &'a Chart,
    figures: Vec<(&'static str, String)>,
}

/// Shows the step.
pub(crate) fn show(ui: &mut Ui, draft: &mut Draft, strokes: &Strokes) {
    let Some(reading) = strokes.reading.as_deref() else {
        return;
    };
    let import = strokes.import.as_ref();
    let axes = [TextileAxis::Warp, TextileAxis::Weft].map(|axis| {
        let covered_mm = reading.covered_mm(axis)?;
        let said = draft.looked.sections[usize::from(axis == TextileAxis::Weft)];
        let section = import.and_then(|import| import.section(axis));
        let at_mm = said.or_else(|| section.map(|section| [section.from_mm, section.to_mm]));
        let at_mm = at_mm.unwrap_or(covered_mm);
        Some(Ends { at_mm, covered_mm })
    });
    show_sections(ui, draft, axes, import);
    let room = room_of(ui);
    let n = reading.strokes.len() + usize::from(reading.friction.is_some());
    let height = ((room.height() - f32::from(BOTTOM)) / n.max(1) as f32).max(44.0);
    let rect = |nth: usize| {
        let top = room.top() + height * nth as f32;
        Rect::from_x_y_ranges(room.x_range(), top..=top + height)
    };
    let ends = [places_of(reading), heights_of(strokes)];
    for (nth, (stroke, envelope)) in reading.strokes.iter().zip(&*strokes.envelopes).enumerate() {
        let axis = usize::from(stroke.axis() == TextileAxis::Weft);
        let section = axes[axis];
        let mut chart = stroke_chart(stroke, envelope, section.map(|ends| ends.at_mm), ends);
        chart.is_x_shared = nth + 1 < n;
        let lane = Lane {
            name: stroke.direction.label(),
            rect: rect(nth),
            chart: &chart,
            figures: import.map_or_else(Vec::new, |import| smd_words(import, stroke.direction)),
        };
        let shown = show_lane(ui, &lane);
        if let (Some(shown), Some(section)) = (shown, section)
            && let Some(moved) = section::drag(ui, &shown, stroke.direction.label(), section)
        {
            draft.looked.sections[axis] = Some(moved);
        }
    }
    if let (Some(friction), Some(envelope)) = (&reading.friction, &strokes.friction) {
        let place_mm = |sample: f64| friction.start_mm + sample * friction.step_mm;
        let section = import.and_then(KesImport::friction_section);
        let section = section.map(|one| [one.from_mm, one.to_mm]);
        let lane = Lane {
            name: "friction",
            rect: rect(n - 1),
            chart: &curve(envelope, place_mm, section, [ends[0], envelope.range()]),
            figures: import.map_or_else(Vec::new, friction_words),
        };
        show_lane(ui, &lane);
    }
    ui.advance_cursor_after_rect(room);
}

/// Shows a curve with its name and its figures beside it.
fn show_lane(ui: &Ui, lane: &Lane<'_>) -> Option<Shown> {
    let mut margin = MARGIN;
    let mut rect = lane.rect;
    if !lane.chart.is_x_shared {
        margin.bottom = BOTTOM;
        rect.max.y += f32::from(BOTTOM - MARGIN.bottom);
    }
    let setting = Setting {
        name: &format!("Curve of {}", lane.name),
        margin,
        link: Some("places of imported strokes"),
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    let shown = plot::show(ui, rect, lane.chart, &setting)?;
    let (at, ink) = (
        shown.area().right_top() + vec2(10.0, -2.0),
        Palette::in_ui(ui).text,
    );
    ui.painter()
        .text(at, Align2::LEFT_BOTTOM, lane.name, theme::small(), ink);
    paint_figures(ui, shown.area(), lane.name, &lane.figures);
    Some(shown)
}

/// A curve in grey, and in black what is evaluated of it; ends are those of places and of values.
fn curve(
    envelope: &Envelope,
    place_mm: impl Fn(f64) -> f64,
    section: Option<[f64; 2]>,
    [places_mm, values]: [[f64; 2]; 2],
) -> Chart {
    let points = envelope.points();
    let points: Vec<[f64; 2]> = points
        .map(|(sample, value)| [place_mm(sample), value])
        .collect();
    let within = |[from, to]: [f64; 2]| {
        let own = points.iter().filter(move |at| from <= at[0] && at[0] <= to);
        own.copied().collect()
    };
    let line = |points: Vec<[f64; 2]>, ink| Series {
        points,
        style: Style::Line,
        ink,
        weight: Weight::Thin,
        ..Series::default()
    };
    let section = section.map_or_else(Vec::new, within);
    Chart {
        x: Axis::linear("place along the forward stroke, mm").within(places_mm),
        y: Axis::linear("").within(values),
        series: vec![line(points, Ink::Grey), line(section, Ink::Black)],
        ..Chart::default()
    }
}

/// A stroke: on grey what is left out, with its name; dots are outliers.
fn stroke_chart(
    stroke: &KesStroke,
    envelope: &Envelope,
    section: Option<[f64; 2]>,
    ends: [[f64; 2]; 2],
) -> Chart {
    let sign = if stroke.direction.is_reverse() {
        -1.0
    } else {
        1.0
    };
    let place_mm = |sample: f64| stroke.start_mm + sample * sign * stroke.step_mm;
    let mut chart = curve(envelope, place_mm, section, ends);
    "height, µm".clone_into(&mut chart.y.label);
    let is_outlier = |mark: &&Mark| mark.kind == MarkKind::Outlier;
    for mark in stroke.marks.iter().filter(|mark| !is_outlier(mark)) {
        let span = [mark.samples.start, mark.samples.end];
        let span = span.map(|sample| place_mm(sample as f64 - 0.5));
        chart.bands.push(Band {
            points: span.map(|mm| [mm, ends[1][0], ends[1][1]]).to_vec(),
            ink: Ink::Grey,
            ..Band::default()
        });
        chart.rules.push(Rule {
            at: At::X(0.5 * (span[0] + span[1])),
            label: mark.kind.label().to_owned(),
            ink: Ink::Grey,
            extent: Extent::Edge,
        });
    }
    let farthest = |mark: &Mark| {
        let of = |i: &usize| stroke.heights_um[*i].abs();
        let farthest = mark
            .samples
            .clone()
            .max_by(|a, b| of(a).total_cmp(&of(b)))?;
        Some([place_mm(farthest as f64), stroke.heights_um[farthest]])
    };
    let outliers = stroke.marks.iter().filter(is_outlier);
    chart.series.push(Series {
        points: outliers.take(MAX_OUTLIERS).filter_map(farthest).collect(),
        ink: Ink::Black,
        ..Series::default()
    });
    chart
}

/// The sections in numbers, and whether the official band is asked for.
fn show_sections(
    ui: &mut Ui,
    draft: &mut Draft,
    axes: [Option<Ends>; 2],
    import: Option<&KesImport>,
) {
    form_line(ui, |ui| {
        for (index, (axis, name)) in [(TextileAxis::Warp, "warp"), (TextileAxis::Weft, "weft")]
            .into_iter()
            .enumerate()
        {
            let Some(ends) = axes[index] else {
                continue;
            };
            ui.label(quiet(format!("{name}, mm")));
            let section = import.and_then(|import| import.section(axis));
            if let Some(wanted) = section::numbers(ui, name, ends, section) {
                draft.looked.sections[index] = match wanted {
                    Wish::Suggested => None,
                    Wish::Section(section) => Some(section),
                };
            }
            ui.add_space(2.0 * STEP);
        }
        let tip = "Also give SMD and MMD without what varies over more than 1 mm";
        if toggle(ui, "official band", draft.looked.is_official, tip) {
            draft.looked.is_official = !draft.looked.is_official;
        }
    });
}

/// What is left of the pane below what was shown, however wide that was.
fn room_of(ui: &Ui) -> Rect {
    ui.available_rect_before_wrap().intersect(ui.clip_rect())
}

/// The places that all strokes are drawn over.
fn places_of(reading: &KesReading) -> [f64; 2] {
    let friction = reading.friction.as_ref().map(|friction| {
        let length_mm = friction.mu.len() as f64 * friction.step_mm;
        [friction.start_mm, friction.start_mm + length_mm]
    });
    let strokes = reading
        .strokes
        .iter()
        .map(KesStroke::range_mm)
        .chain(friction);
    let range = strokes.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    range.unwrap_or([0.0, 1.0])
}

/// The heights of all strokes, so that they share a scale.
fn heights_of(strokes: &Strokes) -> [f64; 2] {
    let ranges = strokes.envelopes.iter().map(Envelope::range);
    let range = ranges.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    let [low, high] = range.unwrap_or([0.0, 1.0]);
    let margin = 0.05 * (high - low);
    [low - margin, high + margin]
}

/// Names and values right of a plot.
fn paint_figures(ui: &Ui, area: Rect, of: &str, figures: &[(&'static str, String)]) {
    let right = area.right() + f32::from(MARGIN.right);
    let palette = Palette::in_ui(ui);
    let mut y = area.top() + 7.0;
    for (name, value) in figures {
        let left = area.right() + 10.0;
        let painter = ui.painter();
        paint_quiet(painter, pos2(left, y), Align2::LEFT_CENTER, name);
        let right = pos2(right - 4.0, y);
        painter.text(
            right,
            Align2::RIGHT_CENTER,
            value,
            theme::number(),
            palette.text,
        );
        y += 15.0;
    }
    let described: Vec<String> = figures
        .iter()
        .map(|(name, value)| format!("{name} {value}"))
        .collect();
    let described = format!("{of}: {}", described.join(", "));
    let response = ui.interact(
        Rect::from_x_y_ranges(area.right()..=right, area.y_range()),
        ui.scope_id().with((of, "figures")),
        eframe::egui::Sense::hover(),
    );
    response.widget_info(|| {
        eframe::egui::WidgetInfo::labeled(eframe::egui::Role::Label, true, described.clone())
    });
}

fn smd_words(import: &KesImport, direction: Direction) -> Vec<(&'static str, String)> {
    let figures = import.figures();
    let of = |values: &[(Direction, f64)]| {
        let found = values.iter().find(|(of, _)| *of == direction);
        found.map(|(_, smd_um)| with_unit(*smd_um, 2, "µm"))
    };
    let smd = of(&figures.smd_um).map(|words| ("SMD", words));
    let official = of(&figures.smd_official_um).map(|words| ("≤ 1 mm", words));
    smd.into_iter().chain(official).collect()
}

fn friction_words(import: &KesImport) -> Vec<(&'static str, String)> {
    let figures = import.figures();
    let all = [
        ("MIU", figures.miu),
        ("MMD", figures.mmd),
        ("≤ 1 mm", figures.mmd_official),
    ];
    let known = all
        .into_iter()
        .filter_map(|(name, value)| Some((name, fixed(value?, 4))));
    known.collect()
}

/// A profile of an instrument.
pub(crate) fn show_profile(ui: &mut Ui, heights: &Heights) {
    let (Some(envelope), room) = (heights.profile.as_deref(), room_of(ui)) else {
        return;
    };
    let map = heights.import.map();
    let height = (room.height() - f32::from(BOTTOM)).clamp(60.0, 320.0);
    let smd = heights.places.iter().flatten().next();
    let smd = smd.map(|place| ("SMD", with_unit(place.smd_um(), 2, "µm")));
    let lane = Lane {
        name: "profile",
        rect: room.with_max_y(room.top() + height),
        chart: &profile_chart(map, envelope),
        figures: smd.into_iter().collect(),
    };
    show_lane(ui, &lane);
    ui.advance_cursor_after_rect(room);
}

/// Shows the heights along u at a place across, as they are without their tilt.
pub(crate) fn show_row(ui: &Ui, rect: Rect, map: &HeightMap, w_mm: f64) {
    let heights_um = map.heights_um();
    let row = to_index(w_mm / map.step_mm()[1]).min(heights_um.height().saturating_sub(1));
    let lane = Lane {
        name: "along the line",
        rect,
        chart: &profile_chart(map, &Envelope::of(heights_um.row(row))),
        figures: Vec::new(),
    };
    show_lane(ui, &lane);
}

/// A profile over its length.
pub(crate) fn profile_chart(map: &HeightMap, envelope: &Envelope) -> Chart {
    let (length_mm, step_mm) = (map.size_mm()[0], map.step_mm()[0]);
    let whole = [0.0, length_mm];
    let mut chart = curve(
        envelope,
        |sample| sample * step_mm,
        Some(whole),
        [whole, envelope.range()],
    );
    "place, mm".clone_into(&mut chart.x.label);
    "height, µm".clone_into(&mut chart.y.label);
    chart
}
