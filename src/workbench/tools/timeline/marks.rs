//! Markers on the ruler: where they stand, what they are called, and how they are named in place.

use eframe::egui::{
    self, Align2, Key, Popup, Rect, Response, Sense, Shape, Stroke, TextEdit, Ui, UiBuilder,
    WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Commands, PlayCommand, RecordingCommand};
use crate::bench::recording::Marker;
use crate::kit::theme::{self, Palette};
use crate::kit::widgets::text::named;
use crate::tools::timeline::scope::Scope;

/// Width of the field that a name is typed into, points.
const FIELD: f32 = 150.0;
/// Most of a name that is written on the ruler, points.
const NAME: f32 = 110.0;

/// A marker that is being named: its tick and what is typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Naming {
    tick: u64,
    text: String,
    has_focus: bool,
}

impl Naming {
    /// Begins to name a marker.
    pub(crate) fn of(marker: &Marker) -> Self {
        Self {
            tick: marker.tick,
            text: marker.name.clone(),
            has_focus: false,
        }
    }
}

/// Shows the markers of a recording.
pub(crate) fn show(
    ui: &mut Ui,
    scope: &Scope<'_>,
    naming: &mut Option<Naming>,
    commands: &mut Commands,
) {
    let markers = scope
        .view
        .shown_take()
        .map(|take| &take.about().markers[..]);
    for marker in markers.unwrap_or_default() {
        let share = scope.span.share_of(marker.tick);
        if (0.0..=1.0).contains(&share) {
            let acts = (&mut *naming, &mut *commands);
            show_marker(ui, scope, (marker, share), acts);
        }
    }
    let Some(named) = naming else { return };
    let share = scope.span.share_of(named.tick).clamp(0.0, 1.0);
    if let Some(is_kept) = show_field(ui, scope, share, named) {
        let (tick, text) = (named.tick, named.text.trim().to_owned());
        if is_kept && !text.is_empty() {
            commands.push(RecordingCommand::Mark(Marker { tick, name: text }).into());
        }
        *naming = None;
    }
}

fn show_marker(
    ui: &Ui,
    scope: &Scope<'_>,
    (marker, share): (&Marker, f64),
    (naming, commands): (&mut Option<Naming>, &mut Commands),
) {
    let (palette, painter) = (Palette::in_ui(ui), ui.painter());
    let x = painter.round_to_pixel_center(scope.layout.x_at(share));
    let (top, bottom) = (scope.layout.ruler.top(), scope.layout.body().bottom());
    let words = marker.name.clone();
    let galley = painter.layout(words, theme::small(), palette.text, NAME);
    let width = galley.rows.first().map_or(0.0, |row| row.rect().width());
    let flag = Rect::from_min_size(pos2(x, top), vec2(width + 8.0, 13.0));
    let id = ui.scope_id().with(("marker", marker.tick));
    let response = ui.interact(flag, id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &marker.name));
    painter.vline(x, top..=bottom, Stroke::new(1.0, palette.contactor));
    let ground = if response.hovered() {
        palette.hovered
    } else {
        palette.raised
    };
    painter.add(Shape::rect_filled(flag, 2, ground));
    let clipped = painter.with_clip_rect(flag);
    let at = flag.left_center() + vec2(4.0, 0.0);
    clipped.text(
        at,
        Align2::LEFT_CENTER,
        &marker.name,
        theme::small(),
        palette.text,
    );
    answer(&response, marker, (naming, commands));
    let tip = format!("{}\nclick to go there, two clicks to name it", marker.name);
    response.on_hover_text(tip);
}

fn answer(
    response: &Response,
    marker: &Marker,
    (naming, commands): (&mut Option<Naming>, &mut Commands),
) {
    if response.double_clicked() {
        *naming = Some(Naming::of(marker));
    } else if response.clicked() {
        commands.push(PlayCommand::Seek(marker.tick).into());
    }
    Popup::context_menu(response).show(|ui| {
        if ui.button("Name…").clicked() {
            *naming = Some(Naming::of(marker));
            ui.close();
        }
        if ui.button("Remove").clicked() {
            commands.push(RecordingCommand::Unmark(marker.tick).into());
            ui.close();
        }
    });
}

/// The field for a name at its marker. Whether the name is to be kept, once that is decided.
fn show_field(ui: &mut Ui, scope: &Scope<'_>, share: f64, naming: &mut Naming) -> Option<bool> {
    let ruler = scope.layout.ruler;
    let left = scope.layout.x_at(share).min(ruler.right() - FIELD);
    let place = Rect::from_min_size(pos2(left, ruler.top() - 2.0), vec2(FIELD, 18.0));
    let mut child = ui.new_child(UiBuilder::new().max_rect(place));
    let field = TextEdit::singleline(&mut naming.text)
        .font(theme::small())
        .desired_width(FIELD);
    let response = child.add(field);
    named(&response, "Name of the marker");
    if !std::mem::replace(&mut naming.has_focus, true) {
        response.request_focus();
        return None;
    }
    let (is_escaped, is_entered) = ui.input(|input| {
        (
            input.key_pressed(Key::Escape),
            input.key_pressed(Key::Enter),
        )
    });
    (is_escaped || is_entered || response.lost_focus()).then_some(!is_escaped)
}
