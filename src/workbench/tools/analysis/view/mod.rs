//! Analysis: what the logs in a folder say, section by section.
//!
//! Folder, choices and the sections on the left; the section at hand on the right: what to know,
//! its figures, its tables. Draws what `app::analysis` found; asks for everything by commands.

pub(crate) mod columns;
pub(crate) mod figure;
pub(crate) mod form;
pub(crate) mod outline;
pub(crate) mod section;
pub(crate) mod table;
pub(crate) mod words;

use eframe::egui::{Align, Layout, Rect, RichText, ScrollArea, Ui, UiBuilder, vec2};

use crate::bench::command::Commands;
use crate::kit::pane::{inside, scrolled_column as scrolled};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::button;
use crate::tools::analysis::AnalysisView;
use crate::tools::analysis::asked::Fields;
use crate::tools::analysis::command::AnalysisCommand;
use selvedge_chart::Paper;

pub(crate) use crate::tools::analysis::view::section::Looks;

/// A pane this wide has room for two columns, points.
const WIDE: f32 = 640.0;
/// Width of the left column, points.
const LEFT: f32 = 244.0;
/// What is said before anything was analysed.
const EMPTY: [&str; 3] = [
    "A folder that sessions were kept in: logs as CSV, each with its .json beside it. Several \
     experiments may lie there; each is analysed by its own design.",
    "What the rules of a design leave out is listed first; then come tables, tests with effect \
     sizes and intervals, maps and figures. What cannot be computed says why.",
    "Logs are read and never changed; a session may go on meanwhile.",
];

/// What is typed in the pane, and what it keeps from frame to frame.
pub(crate) struct AnalysisHands<'a> {
    /// Folder and seed.
    pub fields: &'a mut Fields,
    /// Tables and figures as they are laid out.
    pub looks: &'a mut Looks,
}

/// How the figures in sight are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sight {
    /// How wide, px of the screen.
    pub width_px: u32,
    /// What is behind them.
    pub paper: Paper,
}

/// Shows the pane; says how the figures in sight are wanted, if there are any.
pub(crate) fn show(
    ui: &mut Ui,
    view: &AnalysisView<'_>,
    hands: &mut AnalysisHands<'_>,
    commands: &mut Commands,
) -> Option<Sight> {
    ui.spacing_mut().item_spacing.y = STEP;
    let whole = ui.available_rect_before_wrap();
    let Some(found) = view.found else {
        show_empty(ui, view, hands.fields, commands);
        return None;
    };
    let sections = &found.analysis.sections;
    let mut sight = None;
    if whole.width() >= WIDE {
        let (left, right) = whole.split_left_right_at_x(whole.left() + LEFT);
        let hairline = (1.0, Palette::in_ui(ui).hairline);
        ui.painter().vline(left.right(), whole.y_range(), hairline);
        inside(ui, left.with_max_x(left.right() - 10.0), |ui| {
            scrolled(ui, "analysis-left", |ui| {
                form::show(ui, view, hands.fields, commands);
                outline::show(ui, sections, view.section, commands);
                form::show_report(ui, view, commands);
            });
        });
        inside(ui, right.with_min_x(right.left() + 14.0), |ui| {
            sight = show_found(ui, view, hands.looks, commands);
        });
    } else {
        inside(ui, whole, |ui| {
            form::show_folded(ui, view, hands.fields, commands);
            outline::show_closed(ui, sections, view.section, commands);
            ui.add_space(STEP);
            sight = show_found(ui, view, hands.looks, commands);
        });
    }
    ui.advance_cursor_after_rect(whole);
    sight
}

/// The section at hand below what must be known before it is looked at.
fn show_found(
    ui: &mut Ui,
    view: &AnalysisView<'_>,
    looks: &mut Looks,
    commands: &mut Commands,
) -> Option<Sight> {
    let found = view.found?;
    // Room for the bar beside a line that matters.
    let room = ui.available_rect_before_wrap();
    inside_margin(ui, room, |ui| {
        for warning in &found.warnings {
            note(ui, warning, Tone::Wrong);
            ui.add_space(STEP);
        }
        if let Some(who) = view.held {
            show_held(ui, who, view.is_covered, commands);
        }
        if view.is_covered {
            return None;
        }
        let at = found.analysis.sections.get(view.section)?;
        let area = ScrollArea::vertical()
            .id_salt(("analysed", &at.key))
            .auto_shrink(false);
        // With or without a bar that scrolls, figures are as wide.
        let room = ui.available_width();
        area.show(ui, |ui| {
            section::show(ui, view, (at, room), looks, commands)
        })
        .inner
    })
}

fn inside_margin<R>(ui: &mut Ui, room: Rect, content: impl FnOnce(&mut Ui) -> R) -> R {
    let room = room.with_min_x(room.left() + 8.0);
    let mut child = ui.new_child(UiBuilder::new().max_rect(room));
    content(&mut child)
}

/// What is said while a session is held in this window.
fn show_held(ui: &mut Ui, who: &str, is_covered: bool, commands: &mut Commands) {
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
            commands.push(AnalysisCommand::Uncover(is_covered).into());
        }
    });
}

/// What to do when there is nothing yet.
fn show_empty(ui: &mut Ui, view: &AnalysisView<'_>, fields: &mut Fields, commands: &mut Commands) {
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
        if let Some(who) = view.held {
            let words = format!(
                "A session of {who} is being held. Who takes part is left out unless you ask for \
                 it."
            );
            note(ui, &words, Tone::Quiet);
        }
        ui.add_space(STEP);
        form::show(ui, view, fields, commands);
        ui.add_space(2.0 * STEP);
        for words in EMPTY {
            note(ui, words, Tone::Quiet);
            ui.add_space(STEP);
        }
    });
}
