//! Analysis: what the logs in a folder say, section by section.
//!
//! Folder, choices and the sections on the left; the section at hand on the right: what to know,
//! its figures, its tables.

pub(crate) mod columns;
pub(crate) mod figure;
pub(crate) mod form;
pub(crate) mod outline;
pub(crate) mod section;
pub(crate) mod table;
pub(crate) mod words;

use std::sync::Arc;

use eframe::egui::{Align, Layout, Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

use crate::bench::tool::PaneContext;
use crate::kit::pane::{inside, scrolled_column as scrolled};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::button;
use crate::tools::analysis::findings::Findings;
use crate::tools::analysis::pictures::Wanted;
use crate::tools::analysis::state::Analysis;

/// A pane this wide has room for two columns, points.
const WIDE: f32 = 640.0;
/// Width of the left column, points.
const LEFT: f32 = 244.0;
/// How bright results are that are of other logs or choices by now.
const PAST: f32 = 0.5;
/// What is said before anything was analysed.
const EMPTY: [&str; 3] = [
    "A folder that sessions were kept in: logs as CSV, each with its .json beside it. Several \
     experiments may lie there; each is analysed by its own design.",
    "What the rules of a design leave out is listed first; then come tables, tests with effect \
     sizes and intervals, maps and figures. What cannot be computed says why.",
    "Logs are read and never changed; a session may go on meanwhile.",
];

/// Shows the pane; says which figures are wanted, if any are in sight.
pub(crate) fn show(
    ui: &mut Ui,
    analysis: &mut Analysis,
    context: &mut PaneContext<'_>,
) -> Option<Wanted> {
    ui.spacing_mut().item_spacing.y = STEP;
    let whole = ui.available_rect_before_wrap();
    let Some(found) = analysis.found.clone() else {
        show_empty(ui, analysis, context);
        return None;
    };
    let sections = &found.analysis.sections;
    let mut wanted = None;
    if whole.width() >= WIDE {
        let (left, right) = whole.split_left_right_at_x(whole.left() + LEFT);
        let hairline = (1.0, Palette::in_ui(ui).hairline);
        ui.painter().vline(left.right(), whole.y_range(), hairline);
        inside(ui, left.with_max_x(left.right() - 10.0), |ui| {
            scrolled(ui, "analysis-left", |ui| {
                form::show(ui, analysis, context);
                outline::show(ui, sections, &mut analysis.section);
                form::show_report(ui, analysis, context);
            });
        });
        inside(ui, right.with_min_x(right.left() + 14.0), |ui| {
            wanted = show_found(ui, &found, analysis, context);
        });
    } else {
        inside(ui, whole, |ui| {
            form::show_folded(ui, analysis, context);
            outline::show_closed(ui, sections, &mut analysis.section);
            ui.add_space(STEP);
            wanted = show_found(ui, &found, analysis, context);
        });
    }
    ui.advance_cursor_after_rect(whole);
    wanted
}

/// The section at hand below what must be known before it is looked at.
fn show_found(
    ui: &mut Ui,
    found: &Arc<Findings>,
    analysis: &mut Analysis,
    context: &mut PaneContext<'_>,
) -> Option<Wanted> {
    // Room for the bar beside a line that matters.
    let room = ui.available_rect_before_wrap();
    inside_margin(ui, room, |ui| {
        for warning in &found.warnings {
            note(ui, warning, Tone::Wrong);
            ui.add_space(STEP);
        }
        if let Some(session) = &context.bench.session.active {
            show_session(ui, &session.pseudonym, &mut analysis.is_uncovered);
        }
        if analysis.is_covered(context.bench) {
            return None;
        }
        let at = found.analysis.sections.get(analysis.section)?;
        if analysis.is_past() || analysis.has_moved_on() {
            ui.multiply_opacity(PAST);
        }
        let area = ScrollArea::vertical()
            .id_salt(("analysed", &at.key))
            .auto_shrink(false);
        // With or without a bar that scrolls, figures are as wide.
        let room = ui.available_width();
        area.show(ui, |ui| {
            section::show(ui, found, (at, room), analysis, context)
        })
        .inner
    })
}

fn inside_margin<R>(ui: &mut Ui, room: Rect, content: impl FnOnce(&mut Ui) -> R) -> R {
    let room = room.with_min_x(room.left() + 8.0);
    let mut child = ui.new_child(UiBuilder::new().max_rect(room));
    content(&mut child)
}

/// What is said while a session is active in this window.
fn show_session(ui: &mut Ui, who: &str, is_uncovered: &mut bool) {
    let is_covered = !*is_uncovered;
    ui.horizontal_wrapped(|ui| {
        let words = if is_covered {
            format!(
                "A session of {who} is being held: results stay covered, since who takes part may \
                 see them."
            )
        } else {
            format!("A session of {who} is being held, and results are in sight.")
        };
        ui.label(RichText::new(words).font(theme::small()));
        let (verb, tip) = if is_covered {
            (
                "Show them",
                "Results are seen by whoever looks at this screen",
            )
        } else {
            ("Cover them", "Nobody who takes part ought to see results")
        };
        if button(ui, verb, tip, None) {
            *is_uncovered = is_covered;
            ui.ctx().request_repaint();
        }
    });
}

/// What to do when there is nothing yet.
fn show_empty(ui: &mut Ui, analysis: &mut Analysis, context: &mut PaneContext<'_>) {
    let palette = Palette::in_ui(ui);
    let whole = ui.available_rect_before_wrap();
    let size = vec2(whole.width().min(520.0), whole.height().min(420.0));
    let room = Rect::from_center_size(whole.center(), size);
    let layout = Layout::top_down(Align::Min);
    let mut child = ui.new_child(UiBuilder::new().max_rect(room).layout(layout));
    ScrollArea::vertical().show(&mut child, |ui| {
        ui.spacing_mut().item_spacing.y = STEP;
        ui.label(RichText::new("Analyse sessions").font(theme::title()));
        let words = "Choose the folder that the sessions were kept in.";
        ui.label(RichText::new(words).color(palette.text));
        ui.add_space(STEP);
        if let Some(session) = &context.bench.session.active {
            let who = &session.pseudonym;
            let words = format!(
                "A session of {who} is being held. Who takes part is left out unless you ask for \
                 it."
            );
            note(ui, &words, Tone::Quiet);
        }
        ui.add_space(STEP);
        form::show(ui, analysis, context);
        ui.add_space(2.0 * STEP);
        for words in EMPTY {
            note(ui, words, Tone::Quiet);
            ui.add_space(STEP);
        }
    });
}
