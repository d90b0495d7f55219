//! A list to choose from that is as wide as its room, however long the name in it.

use eframe::egui::{Align, AsIdSalt, ComboBox, Layout, Response, RichText, Ui, vec2};

use crate::kit::widgets::text::named;

/// Height of the list while it is closed, points.
const LINE: f32 = 20.0;

/// Shows a closed list with `text` in it and fills it with `content` when it is opened. Read out as
/// `label`.
pub(crate) fn list(
    ui: &mut Ui,
    (salt, label): (impl AsIdSalt, &str),
    width: f32,
    text: &str,
    content: impl FnOnce(&mut Ui),
) -> Response {
    let text = RichText::new(text).small();
    let line = Layout::left_to_right(Align::Center);
    let room = ui.allocate_ui_with_layout(vec2(width, LINE), line, |ui| {
        ui.set_max_width(width);
        let list = ComboBox::from_id_salt(salt);
        let list = list.width(width).truncate();
        list.selected_text(text).show_ui(ui, content).response
    });
    named(&room.inner, label);
    room.inner
}
