//! A window as the desktop knows it: its name, and the icon and the entry that belong to it.

use std::sync::Arc;

use eframe::egui::ViewportBuilder;
use eframe::icon_data::from_png_bytes;

/// The icon where the desktop has none of that name: the program was not installed.
const ICON: &[u8] = include_bytes!("../../../assets/packaging/icons/128.png");
/// The name of the entry in `assets/packaging`, by which desktops join windows to it.
const APP_ID: &str = "selvedge";

/// A window of this program with a title.
pub(crate) fn own_window(title: &str) -> ViewportBuilder {
    let window = ViewportBuilder::default()
        .with_title(title)
        .with_app_id(APP_ID);
    match from_png_bytes(ICON) {
        Ok(icon) => window.with_icon(Arc::new(icon)),
        Err(_damaged) => window,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_desktop_entry_belongs_to_the_window_and_has_its_icon() {
        let entry = include_str!("../../../assets/packaging/selvedge.desktop");
        for line in ["StartupWMClass", "Icon"].map(|key| format!("{key}={APP_ID}")) {
            assert!(
                entry.lines().any(|own| own == line),
                "no {line} in the entry"
            );
        }
        let window = own_window("Selvedge");
        assert_eq!(window.app_id.as_deref(), Some(APP_ID), "WM_CLASS");
        let icon = window.icon.expect("it can be decoded");
        assert_eq!([icon.width, icon.height], [128, 128], "pixels");
        let is_seen = |pixel: &[u8]| pixel[3] == u8::MAX && pixel[0] > 200;
        assert!(
            icon.rgba.chunks(4).any(is_seen),
            "the amber thread is there"
        );
    }
}
