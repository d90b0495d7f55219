//! Import: measurements of one's own become textiles, in four steps that are all in sight.
//!
//! Files and what they mean on the left; what was read, and what it is called, on the right. Draws
//! what was found.

pub(crate) mod curves;
pub(crate) mod files;
pub(crate) mod heights;
pub(crate) mod keep;
pub(crate) mod map;
pub(crate) mod meaning;
pub(crate) mod section;
pub(crate) mod table;

use eframe::egui::{RichText, Ui, vec2};

use crate::bench::command::Commands;
use crate::bench::latest::Standing;
use crate::bench::tool::PaneContext;
use crate::kit::pane::{inside, scrolled_column};
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note_if, step_title};
use crate::tools::import::Import;
use crate::tools::import::failure::{Failure, Step};
use crate::tools::import::work::{Body, Found};
use selvedge_textile::Measurement;

/// A pane this wide has room for two columns, points.
const WIDE: f32 = 640.0;
/// Width of the left column, points.
const LEFT: f32 = 316.0;
/// Height of the last step, points.
const KEEP: f32 = 164.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, importing: &mut Import, context: &mut PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    let whole = ui.available_rect_before_wrap();
    let before = importing.draft.clone();
    if importing.draft.described.files.is_empty() {
        files::show_empty(ui, context.commands);
        return;
    }
    if whole.width() >= WIDE {
        let (left, right) = whole.split_left_right_at_x(whole.left() + LEFT);
        let hairline = Palette::in_ui(ui).hairline;
        ui.painter()
            .vline(left.right(), whole.y_range(), (1.0, hairline));
        inside(ui, left.with_max_x(left.right() - 10.0), |ui| {
            scrolled_column(ui, "import-left", |ui| {
                show_left(ui, importing, context.commands);
            });
        });
        let right = right.with_min_x(right.left() + 12.0);
        let edge = (right.bottom() - KEEP).max(right.top() + 0.45 * right.height());
        let (look, keep) = right.split_top_bottom_at_y(edge);
        inside(ui, look, |ui| {
            show_look(ui, importing, context.bench.settings.preferences.colour_map);
        });
        ui.painter()
            .hline(right.x_range(), edge - 4.0, (1.0, hairline));
        inside(ui, keep, |ui| {
            scrolled_column(ui, "import-keep", |ui| {
                keep::show(ui, importing, context.bench);
            });
        });
    } else {
        scrolled_column(ui, "import", |ui| {
            show_left(ui, importing, context.commands);
            let size = vec2(ui.available_width(), 0.8 * whole.height().max(300.0));
            let (rect, _) = ui.allocate_exact_size(size, eframe::egui::Sense::hover());
            inside(ui, rect, |ui| {
                show_look(ui, importing, context.bench.settings.preferences.colour_map);
            });
            keep::show(ui, importing, context.bench);
        });
    }
    ui.advance_cursor_after_rect(whole);
    if importing.draft != before {
        importing.forget_after(&before);
        ui.ctx().request_repaint();
    }
}

/// Files, and what they mean.
fn show_left(ui: &mut Ui, importing: &mut Import, commands: &mut Commands) {
    let found = importing.found().cloned();
    let found = found.as_deref();
    let failure = failure_of(importing, found).cloned();
    files::show(ui, importing, found, commands);
    show_failure(ui, failure.as_ref(), Step::Files);
    ui.add_space(2.0 * STEP);
    let kind = found.map(|found| found.kind);
    let state = match kind {
        Some(Measurement::Strokes) => "strokes of the surface tester",
        Some(Measurement::Heights) => "measured heights",
        None => "",
    };
    step_title(ui, 2, "What they mean", state);
    show_failure(ui, failure.as_ref(), Step::Meaning);
    match kind {
        Some(Measurement::Strokes) => meaning::show(ui, importing, found, failure.as_ref()),
        Some(Measurement::Heights) => heights::show(ui, importing, found, failure.as_ref()),
        None => {}
    }
}

/// The failure of what is chosen now; what was wrong before something else was typed is past.
fn failure_of<'a>(importing: &Import, found: Option<&'a Found>) -> Option<&'a Failure> {
    let is_past = importing.standing() == Standing::Empty;
    found
        .filter(|_| !is_past)
        .and_then(|found| found.failure.as_ref())
}

/// The line that says what is wrong at a step, if something is.
fn show_failure(ui: &mut Ui, failure: Option<&Failure>, step: Step) {
    let failure = failure.filter(|failure| failure.step == step);
    note_if(
        ui,
        failure.map(|failure| failure.line.as_str()),
        Tone::Wrong,
    );
}

/// What was read, before anything is saved.
fn show_look(ui: &mut Ui, importing: &mut Import, colours: ColourMap) {
    let standing = importing.standing();
    let found = importing.found().cloned();
    let state = match standing {
        Standing::Working(share) => format!("reading {:.0} %", 100.0 * share),
        Standing::Stopped => "stopped".to_owned(),
        Standing::Empty | Standing::Fresh => {
            let is_past = |found: &Found| found.heights().is_some() && !found.is_read();
            let is_past = found.as_deref().is_some_and(is_past);
            if is_past { "as before" } else { "" }.to_owned()
        }
    };
    step_title(ui, 3, "Look", &state);
    if matches!(standing, Standing::Working(_))
        && crate::kit::widgets::text::button(ui, "Stop reading", "", None)
    {
        importing.cancel();
    }
    let Some(found) = found else {
        return;
    };
    show_failure(ui, found.failure.as_ref(), Step::Look);
    match &found.body {
        Body::Strokes(strokes) if strokes.reading.is_some() => {
            curves::show(ui, &mut importing.draft, strokes);
        }
        Body::Heights(heights) if heights.relief.is_some() => {
            map::show(ui, importing, heights, colours);
        }
        Body::Heights(heights) => curves::show_profile(ui, heights),
        Body::Strokes(_) | Body::Nothing => {
            let palette = Palette::in_ui(ui);
            let words = "What was measured is shown here as soon as the steps on the left are \
                         complete";
            ui.label(RichText::new(words).color(palette.dim));
        }
    }
}
