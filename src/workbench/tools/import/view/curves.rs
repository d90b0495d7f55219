//! The third step for strokes: every curve with what is marked of it, the evaluated section, and
//! the figures of it.

use eframe::egui::{
    Align, Align2, Layout, Painter, Pos2, Rect, RichText, Shape, Stroke, Ui, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::axis::{Axis, Side, paint_ticks, paint_unit};
use crate::kit::widgets::polyline::corners;
use crate::kit::widgets::text::toggle;
use crate::tools::import::draft::Draft;
use crate::tools::import::envelope::Envelope;
use crate::tools::import::view::section;
use crate::tools::import::view::section::{Ends, Wish};
use crate::tools::import::work::{Heights, Strokes};
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_textile::surface::Direction;
use selvedge_textile::{KesImport, KesReading, KesStroke, MarkKind, TextileAxis};

/// Height of the row of sections, points.
const LINE: f32 = 22.0;
/// Room left of the plots for numbers, right of them for figures, points.
const LEFT: f32 = 44.0;
const RIGHT: f32 = 112.0;
/// Room above a plot for its name, and below the last for places, points.
const TOP: f32 = 15.0;
const BOTTOM: f32 = 32.0;

/// A curve in its plot.
struct Plot<'a> {
    name: &'static str,
    /// The plot, and the room right of it.
    rect: Rect,
    x: Axis,
    y: Axis,
    envelope: &'a Envelope,
    /// The place of sample 0, and mm a sample, with sign.
    start_mm: f64,
    step_mm: f64,
}

impl Plot<'_> {
    fn place_mm(&self, sample: f64) -> f64 {
        self.start_mm + sample * self.step_mm
    }

    fn at(&self, sample: f64, value: f64) -> Pos2 {
        pos2(
            self.x.x(self.rect.x_range(), self.place_mm(sample)),
            self.y.y(self.rect.y_range(), value),
        )
    }

    fn span(&self, samples: &std::ops::Range<usize>) -> Rect {
        let ends = [samples.start, samples.end].map(|sample| {
            let place = self.place_mm(sample as f64 - 0.5);
            self.x.x(self.rect.x_range(), place)
        });
        let range = ends[0].min(ends[1])..=ends[0].max(ends[1]);
        Rect::from_x_y_ranges(range, self.rect.y_range()).intersect(self.rect)
    }

    fn paint_line(&self, painter: &Painter, section: Option<[f64; 2]>) {
        let palette = Palette::of(painter.ctx().theme());
        let points = self.envelope.points();
        let points: Vec<Pos2> = points
            .map(|(sample, value)| self.at(sample, value))
            .collect();
        let line = corners(&points);
        let within = painter.with_clip_rect(self.rect.intersect(painter.clip_rect()));
        within.add(Shape::line(line.clone(), Stroke::new(1.0, palette.line)));
        if let Some(section) = section {
            let [from, to] = section.map(|mm| self.x.x(self.rect.x_range(), mm));
            let part = Rect::from_x_y_ranges(from..=to, self.rect.y_range());
            let within = within.with_clip_rect(part.intersect(within.clip_rect()));
            within.add(Shape::line(line, Stroke::new(1.0, palette.text)));
        }
    }
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
    let height = ((room.height() - BOTTOM) / n.max(1) as f32).max(44.0);
    let x = places_of(reading);
    let y = heights_of(strokes);
    for (nth, (stroke, envelope)) in reading.strokes.iter().zip(&*strokes.envelopes).enumerate() {
        let plot = Plot {
            name: stroke.direction.label(),
            rect: rect_of(room, height, nth),
            x,
            y,
            envelope,
            start_mm: stroke.start_mm,
            step_mm: stroke.step_mm
                * if stroke.direction.is_reverse() {
                    -1.0
                } else {
                    1.0
                },
        };
        let axis = usize::from(stroke.axis() == TextileAxis::Weft);
        paint_frame(ui, &plot, nth + 1 == n, "µm");
        paint_marks(ui, &plot, stroke);
        plot.paint_line(ui.painter(), axes[axis].map(|ends| ends.at_mm));
        paint_outliers(ui, &plot, stroke);
        if let Some(import) = import {
            paint_figures(ui, &plot, &smd_words(import, stroke.direction));
        }
        if let Some(ends) = axes[axis]
            && let Some(moved) = section::drag(ui, (plot.rect, &plot.x), plot.name, ends)
        {
            draft.looked.sections[axis] = Some(moved);
        }
    }
    show_friction(ui, strokes, (rect_of(room, height, n.max(1) - 1), x));
    ui.advance_cursor_after_rect(room);
}

/// The friction with its section and its figures.
fn show_friction(ui: &Ui, strokes: &Strokes, (rect, x): (Rect, Axis)) {
    let import = strokes.import.as_ref();
    let friction = strokes
        .reading
        .as_ref()
        .and_then(|reading| reading.friction.as_ref());
    if let (Some(friction), Some(envelope)) = (friction, &strokes.friction) {
        let [low, high] = envelope.range();
        let plot = Plot {
            name: "friction",
            rect,
            x,
            y: Axis::linear(low, high),
            envelope,
            start_mm: friction.start_mm,
            step_mm: friction.step_mm,
        };
        paint_frame(ui, &plot, true, "");
        let section = import.and_then(KesImport::friction_section);
        plot.paint_line(ui.painter(), section.map(|one| [one.from_mm, one.to_mm]));
        if let Some(import) = import {
            paint_figures(ui, &plot, &friction_words(import));
        }
    }
}

/// The sections in numbers, and whether the official band is asked for.
fn show_sections(
    ui: &mut Ui,
    draft: &mut Draft,
    axes: [Option<Ends>; 2],
    import: Option<&KesImport>,
) {
    let line = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(vec2(ui.available_width(), LINE), line, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.spacing_mut().interact_size.y = LINE - 2.0;
        let dim = Palette::in_ui(ui).dim;
        let quiet = |words: &str| RichText::new(words).font(theme::small()).color(dim);
        for (index, (axis, name)) in [(TextileAxis::Warp, "warp"), (TextileAxis::Weft, "weft")]
            .into_iter()
            .enumerate()
        {
            let Some(ends) = axes[index] else {
                continue;
            };
            ui.label(quiet(&format!("{name}, mm")));
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
fn places_of(reading: &KesReading) -> Axis {
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
    let [low, high] = range.unwrap_or([0.0, 1.0]);
    Axis::linear(low, high)
}

/// The heights of all strokes, so that they share a scale.
fn heights_of(strokes: &Strokes) -> Axis {
    let ranges = strokes.envelopes.iter().map(Envelope::range);
    let range = ranges.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    let [low, high] = range.unwrap_or([0.0, 1.0]);
    let margin = 0.05 * (high - low);
    Axis::linear(low - margin, high + margin)
}

fn rect_of(room: Rect, height: f32, nth: usize) -> Rect {
    let top = room.top() + height * nth as f32;
    Rect::from_min_max(
        pos2(room.left() + LEFT, top + TOP),
        pos2(room.right() - RIGHT, top + height - 2.0),
    )
}

fn paint_frame(ui: &Ui, plot: &Plot<'_>, is_last: bool, unit: &str) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    painter.rect_filled(plot.rect, 0, palette.floor);
    paint_ticks(
        painter,
        plot.rect,
        (&plot.y, Side::Left),
        &plot.y.ticks(plot.rect.height(), 26.0),
    );
    let ticks = plot.x.ticks(plot.rect.width(), 48.0);
    if is_last {
        paint_ticks(painter, plot.rect, (&plot.x, Side::Bottom), &ticks);
        let at = pos2(plot.rect.right(), plot.rect.bottom() + 14.0);
        paint_unit(
            painter,
            at,
            Align2::RIGHT_TOP,
            "mm along the forward stroke",
        );
    }
    let title = plot.rect.left_top() - vec2(0.0, 2.0);
    let (font, name) = (theme::small(), plot.name);
    painter.text(title, Align2::LEFT_BOTTOM, name, font, palette.text);
    let unit_at = pos2(plot.rect.left() - 6.0, plot.rect.top() - 2.0);
    paint_unit(painter, unit_at, Align2::RIGHT_BOTTOM, unit);
}

/// Run-in and turn-round: on grey, with their names.
fn paint_marks(ui: &Ui, plot: &Plot<'_>, stroke: &KesStroke) {
    let palette = Palette::in_ui(ui);
    for mark in stroke
        .marks
        .iter()
        .filter(|mark| mark.kind != MarkKind::Outlier)
    {
        let span = plot.span(&mark.samples);
        ui.painter().rect_filled(span, 0, palette.raised);
        let at = pos2(span.center().x, plot.rect.top() - 2.0);
        let at = pos2(
            at.x.clamp(plot.rect.left() + 96.0, plot.rect.right() - 30.0),
            at.y,
        );
        let label = mark.kind.label();
        let font = theme::small();
        ui.painter()
            .text(at, Align2::CENTER_BOTTOM, label, font, palette.dim);
    }
}

/// Outliers: rings around what stands off.
fn paint_outliers(ui: &Ui, plot: &Plot<'_>, stroke: &KesStroke) {
    let ink = Palette::in_ui(ui).text;
    let outliers = stroke
        .marks
        .iter()
        .filter(|mark| mark.kind == MarkKind::Outlier);
    for mark in outliers.take(500) {
        let of = |i: &usize| stroke.heights_um[*i].abs();
        let farthest = mark.samples.clone().max_by(|a, b| of(a).total_cmp(&of(b)));
        if let Some(i) = farthest {
            let at = plot.at(i as f64, stroke.heights_um[i]);
            ui.painter().circle_stroke(at, 4.0, Stroke::new(1.0, ink));
        }
    }
}

/// Names and values right of a plot.
fn paint_figures(ui: &Ui, plot: &Plot<'_>, figures: &[(&'static str, String)]) {
    let palette = Palette::in_ui(ui);
    let mut y = plot.rect.top() + 7.0;
    for (name, value) in figures {
        let left = plot.rect.right() + 10.0;
        let painter = ui.painter();
        let font = theme::small();
        painter.text(pos2(left, y), Align2::LEFT_CENTER, name, font, palette.dim);
        let right = pos2(plot.rect.right() + RIGHT - 4.0, y);
        painter.text(
            right,
            Align2::RIGHT_CENTER,
            value,
            theme::number(),
            palette.text,
        );
        y += 15.0;
    }
    let told: Vec<String> = figures
        .iter()
        .map(|(name, value)| format!("{name} {value}"))
        .collect();
    let told = format!("{}: {}", plot.name, told.join(", "));
    let response = ui.interact(
        plot.rect
            .translate(vec2(plot.rect.width(), 0.0))
            .with_max_x(plot.rect.right() + RIGHT),
        ui.scope_id().with((plot.name, "figures")),
        eframe::egui::Sense::hover(),
    );
    response.widget_info(|| {
        eframe::egui::WidgetInfo::labeled(eframe::egui::Role::Label, true, told.clone())
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
    let height = (room.height() - BOTTOM).clamp(60.0, 320.0);
    let [low, high] = envelope.range();
    let plot = Plot {
        name: "profile",
        rect: rect_of(room, height, 0),
        x: Axis::linear(0.0, map.size_mm()[0]),
        y: Axis::linear(low, high),
        envelope,
        start_mm: 0.0,
        step_mm: map.step_mm()[0],
    };
    paint_frame(ui, &plot, true, "µm");
    plot.paint_line(ui.painter(), Some([0.0, map.size_mm()[0]]));
    let smd = heights.places.iter().flatten().next();
    let smd = smd.map(|place| ("SMD", with_unit(place.smd_um(), 2, "µm")));
    paint_figures(ui, &plot, smd.as_slice());
    ui.advance_cursor_after_rect(room);
}
