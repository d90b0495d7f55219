//! Every method on this very scene: error against time a tick, with those that nothing beats joined
//! and the one that runs marked.

use eframe::egui::{
    self, Align, Align2, Layout, Painter, Pos2, ProgressBar, Rect, Sense, Shape, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

use crate::bench::Bench;
use crate::kit::pane::paint_sentence;
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks};
use crate::kit::widgets::text::button;
use crate::tools::accuracy::measuring::Measured;
use crate::tools::accuracy::sampling::Accuracy;
use crate::tools::accuracy::view::numbers;
use crate::tools::accuracy::view::numbers::{LINE, quiet_line};
use selvedge_foundation::quantity;
use selvedge_studies::Row;

/// The axis of errors, dB. Smaller ones, and none at all, stand at its left end.
const ERRORS_DB: [f64; 2] = [1e-8, 100.0];
/// How near the pointer must be to a method, points.
const REACH: f32 = 7.0;

/// Shows the methods in the space that is left.
pub(crate) fn show(ui: &mut Ui, accuracy: &mut Accuracy, bench: &mut Bench) {
    show_head(ui, accuracy, bench);
    let chosen = accuracy.chosen;
    let words = (accuracy.measured.as_ref()).map(|measured| words_below(chosen, measured));
    let n_lines = if words.is_some() { 2.0 } else { 0.0 };
    let height = (ui.available_height() - n_lines * LINE).max(60.0);
    let size = vec2(ui.available_width(), height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let name = "Error against time of every method on this scene";
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, name));
    let Some(measured) = &accuracy.measured else {
        let words = "Error against time of every method, measured on this scene along the last \
                     recording, or across its textiles";
        paint_sentence(ui.painter(), rect, words);
        return;
    };
    let plot = Plot::of(rect, measured);
    plot.paint_axes(ui.painter());
    plot.paint_front(ui.painter(), measured);
    for (index, row) in measured.rows.iter().enumerate() {
        if show_point(ui, &plot, (measured, index, row), chosen) {
            accuracy.chosen = (chosen != Some(index)).then_some(index);
            ui.ctx().request_repaint();
        }
    }
    plot.paint_names(ui.painter(), measured);
    for line in words.unwrap_or_default() {
        quiet_line(ui, &line, &line);
    }
}

fn show_head(ui: &mut Ui, accuracy: &mut Accuracy, bench: &mut Bench) {
    let size = vec2(ui.available_width(), ROW);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        if let Some(measuring) = &accuracy.measuring {
            if button(ui, "Stop", "Stop measuring", None) {
                measuring.stop();
            }
            let bar = ProgressBar::new(measuring.share())
                .desired_height(STEP)
                .fill(Palette::in_ui(ui).line);
            let response = ui.add(bar);
            response.widget_info(|| {
                WidgetInfo::labeled(egui::Role::ProgressIndicator, true, "Measuring this scene")
            });
            return;
        }
        let tip = "Measure the error and the time of every method on this scene, along the last \
                   recording or across its textiles: a few seconds on a thread of its own";
        if button(ui, "Measure this scene", tip, None) {
            accuracy.measure(bench);
            ui.ctx().request_repaint();
        }
        if let Some(measured) = &accuracy.measured {
            let before = if measured.n_edits == bench.inspection.n_edits {
                ""
            } else {
                "Before the last change: "
            };
            let words = format!("{before}{}", measured.note);
            quiet_line(ui, &words, &words);
        }
    });
}

/// One method as a point; says whether it was clicked.
fn show_point(
    ui: &Ui,
    plot: &Plot,
    (measured, index, row): (&Measured, usize, &Row),
    chosen: Option<usize>,
) -> bool {
    let Some(at) = plot.place_of(row) else {
        return false;
    };
    let palette = Palette::in_ui(ui);
    let id = ui.scope_id().with(("method", index));
    let response = ui.interact(
        Rect::from_center_size(at, vec2(2.0 * REACH, 2.0 * REACH)),
        id,
        Sense::click(),
    );
    let is_chosen = chosen == Some(index);
    let name = name_of(row);
    response.widget_info(|| WidgetInfo::selected(egui::Role::RadioButton, true, is_chosen, &name));
    let painter = ui.painter();
    let is_front = measured.front.get(index).copied().unwrap_or_default();
    if is_front {
        painter.circle_filled(at, 3.5, palette.text);
    } else {
        painter.circle(at, 3.0, palette.panel, Stroke::new(1.0, palette.line));
    }
    if measured.running() == Some(index) {
        painter.circle_stroke(at, 6.0, Stroke::new(1.5, palette.text));
    }
    if is_chosen || response.has_focus() || response.hovered() {
        painter.circle_stroke(at, 9.0, Stroke::new(1.0, palette.selection));
    }
    let words = format!("{name}\n{}", words_of(row));
    response.on_hover_text(words).clicked()
}

struct Plot {
    area: Rect,
    error_db: Axis,
    cost_us: Axis,
}

impl Plot {
    fn of(rect: Rect, measured: &Measured) -> Self {
        let area = Rect::from_min_max(rect.min + vec2(34.0, 8.0), rect.max - vec2(10.0, 18.0));
        let costs_us = measured.rows.iter().filter_map(cost_us);
        let ends = costs_us.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], us| {
            [least.min(us), most.max(us)]
        });
        Self {
            area,
            error_db: Axis::log(ERRORS_DB[0], ERRORS_DB[1]),
            cost_us: Axis::log(0.6 * ends[0], 1.8 * ends[1]),
        }
    }

    /// Where a method stands; errors beyond the axis at its ends.
    fn place_of(&self, row: &Row) -> Option<Pos2> {
        let [least, most] = ERRORS_DB;
        let error_db = row.error?.clamp(least, most);
        let x = self.error_db.x(self.area.x_range(), error_db);
        Some(pos2(x, self.cost_us.y(self.area.y_range(), cost_us(row)?)))
    }

    fn paint_axes(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        let errors = [
            (1e-8, "0"),
            (1e-6, "1e−6"),
            (1e-4, "1e−4"),
            (1e-2, "0.01"),
            (1.0, "1"),
        ];
        let mut errors = errors.map(|(db, name)| Tick::named(db, name)).to_vec();
        errors.push(Tick::named(ERRORS_DB[1], "dB"));
        paint_ticks(painter, self.area, (&self.error_db, Side::Bottom), &errors);
        let costs = self.cost_us.ticks(self.area.height(), 22.0);
        paint_ticks(painter, self.area, (&self.cost_us, Side::Left), &costs);
        let corner = self.area.right_top() + vec2(-2.0, 1.0);
        let words = "µs a tick";
        painter.text(
            corner,
            Align2::RIGHT_TOP,
            words,
            theme::small(),
            palette.dim,
        );
    }

    /// Joins what nothing beats, from exact and slow to coarse and fast.
    fn paint_front(&self, painter: &Painter, measured: &Measured) {
        let on_front = measured.rows.iter().zip(&measured.front);
        let mut places: Vec<Pos2> = on_front
            .filter(|(_, is_front)| **is_front)
            .filter_map(|(row, _)| self.place_of(row))
            .collect();
        places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let ink = Palette::of(painter.ctx().theme()).line;
        let steps = places.windows(2).flat_map(|pair| {
            let corner = pos2(pair[1].x, pair[0].y);
            [pair[0], corner, pair[1]]
        });
        painter.add(Shape::line(steps.collect(), Stroke::new(1.0, ink)));
    }

    /// Names each method once, beside its first point or where it is the one that runs.
    fn paint_names(&self, painter: &Painter, measured: &Measured) {
        let palette = Palette::of(painter.ctx().theme());
        let mut named: Vec<&str> = Vec::new();
        let running = measured
            .running()
            .and_then(|index| measured.rows.get(index));
        for row in running.into_iter().chain(&measured.rows) {
            let is_named = named.contains(&&*row.method);
            let Some(at) = self.place_of(row).filter(|_| !is_named) else {
                continue;
            };
            let is_running = running.is_some_and(|running| std::ptr::eq(running, row));
            let name = if is_running {
                format!("{}, runs now", row.method)
            } else {
                row.method.clone()
            };
            named.push(&row.method);
            let has_room = at.y - self.area.top() > 16.0;
            let (anchor, by) = if has_room {
                (Align2::LEFT_BOTTOM, vec2(-4.0, -9.0))
            } else {
                (Align2::LEFT_CENTER, vec2(12.0, 0.0))
            };
            let ink = palette.text;
            painter.text(at + by, anchor, name, theme::small(), ink);
        }
    }
}

fn cost_us(row: &Row) -> Option<f64> {
    let us = row.cost?.cpu_s * 1e6;
    (us > 0.0 && us.is_finite()).then_some(us)
}

fn name_of(row: &Row) -> String {
    format!("{} {}", row.method, row.setting)
        .trim_end()
        .to_owned()
}

/// Error and cost of a method in words.
fn words_of(row: &Row) -> String {
    let error = row.error.map_or_else(|| "–".to_owned(), numbers::level);
    let p99 = row.error_p99.map_or_else(|| "–".to_owned(), numbers::level);
    let cost = row.cost.map_or_else(String::new, |cost| {
        let [low, high] = cost.cpu_quartiles_s.map(quantity::time_span);
        let median = quantity::time_span(cost.cpu_s);
        format!("\n{median} of CPU time a tick ({low} … {high})")
    });
    let memory = row.bytes.map_or_else(String::new, |bytes| {
        let megabytes = quantity::with_unit(bytes as f64 * 1e-6, 2, "MB");
        format!(", {megabytes}")
    });
    format!("error at most {error} dB, 99 % within {p99} dB{cost}{memory}")
}

/// What stands below the plot: the chosen method.
fn words_below(chosen: Option<usize>, measured: &Measured) -> [String; 2] {
    let chosen = chosen.and_then(|index| {
        let row = measured.rows.get(index)?;
        Some((index, row))
    });
    let Some((index, row)) = chosen else {
        let words = "Click a point: what it is, in words".to_owned();
        return [words, String::new()];
    };
    let is_front = measured.front.get(index).copied().unwrap_or_default();
    let place = match better_than(row, measured) {
        _ if is_front => "nothing beats it".to_owned(),
        _ if row.is_kept() == Some(false) => "it breaks its promise".to_owned(),
        Some(better) => {
            let name = name_of(better);
            format!("{name} is no slower and no less accurate")
        }
        None => "another one beats it".to_owned(),
    };
    let runs = if measured.running() == Some(index) {
        "runs now; "
    } else {
        ""
    };
    let words = words_of(row).replace('\n', "; ");
    [format!("{}: {runs}{place}", name_of(row)), words]
}

/// The most accurate method that is neither slower nor less accurate than this one.
fn better_than<'a>(row: &Row, measured: &'a Measured) -> Option<&'a Row> {
    let (error_db, us) = (row.error?, cost_us(row)?);
    let on_front = measured.rows.iter().zip(&measured.front);
    let fronted = on_front.filter_map(|(other, is_front)| is_front.then_some(other));
    let better = fronted.filter(|other| {
        let is_accurate = other.error.is_some_and(|db| db <= error_db);
        is_accurate && cost_us(other).is_some_and(|other_us| other_us <= us)
    });
    let error = |row: &&Row| row.error.unwrap_or(f64::INFINITY);
    better.min_by(|a, b| error(a).total_cmp(&error(b)))
}
