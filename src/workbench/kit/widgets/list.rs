//! A list to choose from that is as wide as its room, however long the name in it.

use eframe::egui::{Align, AsIdSalt, ComboBox, Layout, Response, RichText, Ui, vec2};

use crate::kit::widgets::text::named;

/// Height of the list while it is closed, points.
const LINE: f32 = 20.0;

/// Shows a closed list with `text` in it and fills it with `content` when it is opened. Read out as
/// `label`.
pub(crate) fn list(
    ui: &mut Ui,
    name: (impl AsIdSalt, &str),
    width: f32,
    text: &str,
    content: impl FnOnce(&mut Ui),
) -> Response {
    list_within(ui, name, [width; 2], text, content)
}

/// The same within a room that may be wider than a short list.
pub(crate) fn list_within(
    ui: &mut Ui,
    (salt, label): (impl AsIdSalt, &str),
    [room, width]: [f32; 2],
    text: &str,
    content: impl FnOnce(&mut Ui),
) -> Response {
    let text = RichText::new(text).small();
    let line = Layout::left_to_right(Align::Center);
    let shown = ui.allocate_ui_with_layout(vec2(room, LINE), line, |ui| {
        ui.set_max_width(room);
        let list = ComboBox::from_id_salt(salt).width(width).truncate();
        list.selected_text(text).show_ui(ui, content).response
    });
    named(&shown.inner, label);
    shown.inner
}
