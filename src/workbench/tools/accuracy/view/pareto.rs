//! Every method on this very scene: error against time a tick, with those that nothing beats joined
//! and the one that runs marked.

use eframe::egui::{Margin, ProgressBar, Rect, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

use crate::bench::Bench;
use crate::kit::pane::paint_sentence;
use crate::kit::plot;
use crate::kit::plot::{Setting, Shown};
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::{button, line};
use crate::tools::accuracy::measuring::Measured;
use crate::tools::accuracy::sampling::Accuracy;
use crate::tools::accuracy::view::numbers::{HISTOGRAM, LINE, quiet_line};
use crate::tools::accuracy::view::{chart, numbers};
use selvedge_foundation::quantity;
use selvedge_studies::Row;

/// How near the pointer must be to a method, points.
const REACH: f32 = 7.0;

/// Shows the methods in the space that is left.
pub(crate) fn show(ui: &mut Ui, accuracy: &mut Accuracy, bench: &Bench) {
    show_head(ui, accuracy, bench);
    let chosen = accuracy.chosen;
    let words = (accuracy.measured.as_ref()).map(|measured| words_below(chosen, measured));
    let n_lines = if words.is_some() { 2.0 } else { 0.0 };
    let height = (ui.available_height() - n_lines * LINE).max(60.0);
    let size = vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let none = Measured::default();
    let measured = accuracy.measured.as_ref().unwrap_or(&none);
    let setting = Setting {
        name: "Error against time of every method on this scene",
        margin: Margin {
            left: 44,
            right: 10,
            top: 8,
            bottom: 18,
        },
        ..HISTOGRAM
    };
    let shown = plot::show(ui, rect, &chart::method_chart(measured), &setting);
    if measured.rows.is_empty() {
        let words = "Error against time of every method, measured on this scene along the last \
                     recording, or across its textiles";
        paint_sentence(ui.painter(), rect - setting.margin, words);
    }
    let rows = measured.rows.iter().enumerate();
    let clicked = shown.and_then(|shown| {
        rows.fold(None, |clicked, (index, row)| {
            let is_chosen = chosen == Some(index);
            let is_clicked = show_point(ui, &shown, (index, row), is_chosen);
            is_clicked.then_some(index).or(clicked)
        })
    });
    if let Some(index) = clicked {
        accuracy.chosen = (chosen != Some(index)).then_some(index);
        ui.ctx().request_repaint();
    }
    for line in words.unwrap_or_default() {
        quiet_line(ui, &line, &line);
    }
}

fn show_head(ui: &mut Ui, accuracy: &mut Accuracy, bench: &Bench) {
    line(ui, ROW, |ui| {
        if let Some(measuring) = &accuracy.measuring {
            if button(ui, "Stop", "Stop measuring", None) {
                measuring.stop();
            }
            let bar = ProgressBar::new(measuring.share())
                .desired_height(STEP)
                .fill(Palette::in_ui(ui).line);
            let response = ui.add(bar);
            response.widget_info(|| {
                WidgetInfo::labeled(Role::ProgressIndicator, true, "Measuring this scene")
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

/// What the pointer does with the point of a method; says whether it was clicked.
fn show_point(ui: &Ui, shown: &Shown, (index, row): (usize, &Row), is_chosen: bool) -> bool {
    let at = chart::method_point(row).map(|point| shown.at(point));
    let Some(at) = at.filter(|at| shown.area().expand(1.0).contains(*at)) else {
        return false;
    };
    let name = name_of(row);
    let response = ui.interact(
        Rect::from_center_size(at, vec2(2.0 * REACH, 2.0 * REACH)),
        ui.scope_id().with(("method", index)),
        Sense::click(),
    );
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, is_chosen, &name));
    if is_chosen || response.has_focus() || response.hovered() {
        let ink = Palette::in_ui(ui).selection;
        ui.painter().circle_stroke(at, 9.0, Stroke::new(1.0, ink));
    }
    let words = format!("{name}\n{}", words_of(row));
    response.on_hover_text(words).clicked()
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
        let [low, high] = cost.cpu_interval_s.map(quantity::time_span);
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
    let (error_db, s) = (row.error?, chart::method_point(row)?[1]);
    let on_front = measured.rows.iter().zip(&measured.front);
    let fronted = on_front.filter_map(|(other, is_front)| is_front.then_some(other));
    let better = fronted.filter(|other| {
        let is_accurate = other.error.is_some_and(|db| db <= error_db);
        is_accurate && chart::method_point(other).is_some_and(|[_, other_s]| other_s <= s)
    });
    let error = |row: &&Row| row.error.unwrap_or(f64::INFINITY);
    better.min_by(|a, b| error(a).total_cmp(&error(b)))
}
