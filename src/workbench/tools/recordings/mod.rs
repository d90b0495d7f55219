//! The list of recordings: what was explored, when, where and how; to replay, name, compare,
//! export and delete.
//!
//! A click makes a recording the one at hand; what can be done with it stands below the list. It
//! plays and writes nothing itself.

pub(crate) mod details;

use eframe::egui::{
    self, Rect, Response, RichText, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{FileCommand, PlayCommand, Purpose, RecordingCommand};
use crate::bench::keys::hint;
use crate::bench::pane::Pane;
use crate::bench::recording::{About, Entry, Place};
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::{framed, scroll_area};
use crate::kit::theme::{self, Palette, STEP};
use crate::kit::widgets::text::{button, mark, paint_line, quiet};
use selvedge_foundation::quantity;

/// Height of a row, points.
const ROW: f32 = 42.0;
/// Side of the picture of a path, points.
const OUTLINE: f32 = 34.0;
/// Height of what stands below the list while a recording is chosen, points.
const DETAILS: f32 = 232.0;
/// Time between two ticks, ms.
const TICK_MS: u64 = 25;

/// The list of recordings.
#[derive(Debug, Default)]
pub(crate) struct RecordingList {
    /// The one that is chosen, and its name as it is typed.
    chosen: Option<(Place, String)>,
}

impl Tool for RecordingList {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Recordings]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| self.show(ui, context));
    }
}

impl RecordingList {
    fn show(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let recordings = &context.bench.exploration.recordings;
        let entries: Vec<Entry> = recordings.entries().to_vec();
        self.follow(&entries, context);
        self.show_head(ui, context);
        let room = if self.chosen.is_some() { DETAILS } else { 0.0 };
        let height = (ui.available_height() - room).max(2.0 * ROW);
        let list = scroll_area("recordings");
        let row = ROW - ui.spacing().item_spacing.y;
        list.max_height(height)
            .show_rows(ui, row, entries.len(), |ui, range| {
                for entry in &entries[range] {
                    let is_chosen = self
                        .chosen
                        .as_ref()
                        .is_some_and(|(at, _)| *at == entry.place);
                    if show_row(ui, entry, is_chosen).clicked() {
                        let command = RecordingCommand::Choose(entry.place.clone());
                        context.commands.push(command.into());
                        self.chosen = Some((entry.place.clone(), entry.about.name.clone()));
                    }
                }
            });
        let chosen = self.chosen.as_mut().and_then(|(place, name)| {
            let entry = entries.iter().find(|entry| entry.place == *place)?;
            Some((entry, name))
        });
        if let Some((entry, name)) = chosen {
            details::show(ui, entry, name, &entries, context);
        }
    }

    /// The recording at hand is the one that is chosen, until another is.
    fn follow(&mut self, entries: &[Entry], context: &PaneContext<'_>) {
        let is_listed = |place: &Place| entries.iter().any(|entry| entry.place == *place);
        self.chosen.take_if(|(place, _)| !is_listed(place));
        let exploration = &context.bench.exploration;
        if self.chosen.is_none()
            && let Some(at_hand) = &exploration.at_hand
        {
            let entry = exploration.recordings.entry_of(at_hand);
            self.chosen = entry.map(|entry| (entry.place.clone(), entry.about.name.clone()));
        }
    }

    fn show_head(&self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let palette = Palette::in_ui(ui);
        let bench = &context.bench;
        if let Some(running) = &bench.exploration.recordings.running {
            ui.horizontal(|ui| {
                mark(ui, palette.selection, "Recording");
                let length = quantity::clock(bench.live.play.n_recorded * TICK_MS);
                ui.label(quiet(format!("{}: {length}", running.about.name)));
                if button(ui, "End", "End the recording", None) {
                    context.commands.push(PlayCommand::ToggleRecording.into());
                }
            });
        }
        if let Some(name) = bench.exploration.recordings.last_deleted() {
            ui.horizontal_wrapped(|ui| {
                ui.label(quiet(format!("“{name}” is deleted.")));
                if button(ui, "Undo", "Bring it back", None) {
                    context.commands.push(RecordingCommand::BringBack.into());
                }
            });
        }
        if bench.exploration.recordings.entries().is_empty() && self.chosen.is_none() {
            let key = hint(ui.ctx(), &PlayCommand::ToggleRecording.into());
            let words = format!(
                "Nothing is recorded yet: press {key} to begin and {key} again to end. Recordings \
                 are kept on disk from their first moment."
            );
            ui.label(quiet(words));
        }
        let open = FileCommand::Ask(Purpose::OpenRecording);
        if button(ui, "Open path…", "Open a path file (CSV) to replay", None) {
            context.commands.push(open.into());
        }
        ui.add_space(STEP);
    }
}

/// How long a recording is, or how it stands with it.
fn length(entry: &Entry) -> String {
    match (&entry.place, entry.about.ticks) {
        (Place::Missing(_), _) => "missing".to_owned(),
        (Place::Busy(_), _) => "being recorded".to_owned(),
        (Place::PathFile(_), _) => "path".to_owned(),
        (_, Some([n_ticks, _])) => quantity::clock(n_ticks * TICK_MS),
        (_, None) => "in memory".to_owned(),
    }
}

/// When it began: date and time, UTC.
fn began(about: &About) -> String {
    let text = about.began.replace('T', " ");
    text.get(..16).unwrap_or_default().to_owned()
}

fn show_row(ui: &mut Ui, entry: &Entry, is_chosen: bool) -> Response {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), ROW - ui.spacing().item_spacing.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let name = entry.about.name.as_str();
    response.widget_info(|| {
        WidgetInfo::selected(
            egui::Role::ListItem,
            true,
            is_chosen,
            format!("Recording {name}"),
        )
    });
    if is_chosen || response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 4, palette.raised);
    }
    let square = Rect::from_min_size(
        pos2(rect.left() + 2.0, rect.center().y - 0.5 * OUTLINE),
        vec2(OUTLINE, OUTLINE),
    );
    let colour = if is_chosen {
        palette.selection
    } else {
        palette.dim
    };
    paint_outline(ui, square, &entry.about.outline, Stroke::new(1.0, colour));
    let left = square.right() + 8.0;
    let room = rect.right() - left;
    let first = RichText::new(name).font(theme::body()).color(palette.text);
    paint_line(ui, pos2(left, rect.center().y - 8.0), room, first);
    let second = format!("{}  {}", length(entry), began(&entry.about));
    let second = quiet(second);
    paint_line(ui, pos2(left, rect.center().y + 9.0), room, second);
    response
}

/// Paints a path as large as its square allows.
fn paint_outline(ui: &Ui, square: Rect, outline: &[[f32; 2]], stroke: Stroke) {
    let extent = outline.iter().map(|&[x, y]| pos2(x, -y));
    let extent = Rect::from_points(&extent.collect::<Vec<_>>());
    let side = extent.width().max(extent.height());
    if !side.is_finite() {
        return;
    }
    // A finger that stayed where it was is a dot.
    let scale = (square.width() - 6.0) / side.max(1.0);
    let place = |&[x, y]: &[f32; 2]| square.center() + (pos2(x, -y) - extent.center()) * scale;
    let points: Vec<_> = outline.iter().map(place).collect();
    if let Some(&end) = points.last() {
        ui.painter().circle_filled(end, 1.5, stroke.color);
    }
    ui.painter().add(Shape::line(points, stroke));
}
