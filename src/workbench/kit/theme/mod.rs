//! Every colour, distance and letter size of the window, dark and light.
//!
//! One colour has one meaning: amber is 40 Hz, cyan is 320 Hz, green are the contactors, red is
//! armed high voltage, a fault or "all off", and nothing else. Selection is white (black in the
//! light theme). No other file names a colour.

pub(crate) mod colour_map;
pub(crate) mod style;
#[cfg(test)]
mod tests;

#[cfg(test)]
pub(crate) use crate::kit::theme::colour_map::ColourMap;
pub(crate) use crate::kit::theme::colour_map::Diverging;
pub(crate) use crate::kit::theme::style::install;

use eframe::egui::{self, Color32, FontId};

use selvedge_textile::tactile::Band;

/// Distances are steps of this many points.
pub(crate) const STEP: f32 = 4.0;
/// The height of one row of controls, points.
pub(crate) const ROW: f32 = 24.0;

/// The colours of one theme.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Palette {
    /// Behind everything; the floor of the workspace.
    pub floor: Color32,
    /// Panels.
    pub panel: Color32,
    /// Fields and buttons on panels.
    pub raised: Color32,
    /// The same under the pointer.
    pub hovered: Color32,
    /// Lines that only part one thing from another.
    pub hairline: Color32,
    /// Lines that carry meaning without colour: rails, axes, rings.
    pub line: Color32,
    /// Text.
    pub text: Color32,
    /// Units, titles, and what matters less.
    pub dim: Color32,
    /// Selection and focus.
    pub selection: Color32,
    /// 40 Hz.
    pub low: Color32,
    /// 320 Hz.
    pub high: Color32,
    /// Contactors.
    pub contactor: Color32,
    /// Contactors on cloth, which may be bright or dark: bright green with a rim of `rim`.
    pub lit: Color32,
    /// Contactors on cloth that are not felt: grey, with the same rim.
    pub faint: Color32,
    /// The rim around what is lit.
    pub rim: Color32,
    /// Armed, fault, all off.
    pub(crate) danger: Color32,
    /// Text on `danger`.
    pub(crate) on_danger: Color32,
    /// The ground behind a textile's tag and behind tips.
    pub tag: Color32,
    /// Shadows.
    pub shadow: Color32,
    /// How textiles are tinted that are not under the display.
    pub(crate) resting_cloth: Color32,
}

const DARK: Palette = Palette {
    floor: Color32::from_rgb(0x0b, 0x0d, 0x10),
    panel: Color32::from_rgb(0x14, 0x17, 0x1b),
    raised: Color32::from_rgb(0x1f, 0x24, 0x2a),
    hovered: Color32::from_rgb(0x2b, 0x31, 0x39),
    hairline: Color32::from_rgb(0x25, 0x2a, 0x31),
    line: Color32::from_rgb(0x6c, 0x76, 0x82),
    text: Color32::from_rgb(0xe7, 0xea, 0xee),
    dim: Color32::from_rgb(0x97, 0xa1, 0xad),
    selection: Color32::from_rgb(0xff, 0xff, 0xff),
    low: Color32::from_rgb(0xff, 0xb2, 0x3e),
    high: Color32::from_rgb(0x45, 0xcb, 0xe6),
    contactor: Color32::from_rgb(0x52, 0xe8, 0x8c),
    lit: Color32::from_rgb(0x52, 0xe8, 0x8c),
    faint: Color32::from_rgb(0xc3, 0xc9, 0xd0),
    rim: Color32::from_rgba_premultiplied(0, 0, 0, 160),
    danger: Color32::from_rgb(0xe5, 0x48, 0x3f),
    on_danger: Color32::from_rgb(0x0b, 0x04, 0x04),
    tag: Color32::from_rgb(0x14, 0x17, 0x1b),
    shadow: Color32::from_rgba_premultiplied(0, 0, 0, 110),
    resting_cloth: Color32::from_rgb(0xd4, 0xd4, 0xd4),
};

/// The dark colours with more contrast: nothing grey that is to be read.
const STARK: Palette = Palette {
    floor: Color32::BLACK,
    panel: Color32::BLACK,
    raised: Color32::BLACK,
    hairline: Color32::WHITE,
    line: Color32::WHITE,
    text: Color32::WHITE,
    dim: Color32::WHITE,
    faint: Color32::WHITE,
    danger: Color32::from_rgb(0xff, 0x6a, 0x60),
    tag: Color32::BLACK,
    ..DARK
};

const LIGHT: Palette = Palette {
    floor: Color32::from_rgb(0xe2, 0xe5, 0xe9),
    panel: Color32::from_rgb(0xf6, 0xf7, 0xf9),
    raised: Color32::from_rgb(0xe7, 0xea, 0xee),
    hovered: Color32::from_rgb(0xda, 0xde, 0xe4),
    hairline: Color32::from_rgb(0xd3, 0xd8, 0xde),
    line: Color32::from_rgb(0x79, 0x82, 0x8d),
    text: Color32::from_rgb(0x14, 0x18, 0x1d),
    dim: Color32::from_rgb(0x4f, 0x58, 0x63),
    selection: Color32::from_rgb(0x00, 0x00, 0x00),
    low: Color32::from_rgb(0xa3, 0x5f, 0x00),
    high: Color32::from_rgb(0x00, 0x75, 0x90),
    contactor: Color32::from_rgb(0x00, 0x7f, 0x3c),
    lit: Color32::from_rgb(0x52, 0xe8, 0x8c),
    faint: Color32::from_rgb(0xc3, 0xc9, 0xd0),
    rim: Color32::from_rgba_premultiplied(0, 0, 0, 160),
    danger: Color32::from_rgb(0xc4, 0x28, 0x20),
    on_danger: Color32::from_rgb(0xff, 0xff, 0xff),
    tag: Color32::from_rgb(0xf6, 0xf7, 0xf9),
    shadow: Color32::from_rgba_premultiplied(0, 0, 0, 40),
    resting_cloth: Color32::from_rgb(0xe8, 0xe8, 0xe8),
};

impl Palette {
    /// The colours of a theme.
    pub(crate) fn of(theme: egui::Theme) -> &'static Self {
        match theme {
            egui::Theme::Dark => &DARK,
            egui::Theme::Light => &LIGHT,
        }
    }

    /// Those of a dark ground with more contrast.
    pub(crate) fn stark() -> &'static Self {
        &STARK
    }

    /// The colours in force in `ui`.
    pub(crate) fn in_ui(ui: &egui::Ui) -> &'static Self {
        Self::of_visuals(ui.visuals())
    }

    /// The colours that go with the toolkit's own.
    pub(crate) fn of_visuals(visuals: &egui::Visuals) -> &'static Self {
        Self::of(if visuals.dark_mode {
            egui::Theme::Dark
        } else {
            egui::Theme::Light
        })
    }

    /// The colours of differences, whose middle is this theme's ground.
    pub(crate) fn differences(&self) -> Diverging {
        if self == &DARK {
            Diverging::DARK
        } else {
            Diverging::LIGHT
        }
    }

    /// Violet and rose, for lines that belong to no band.
    pub(crate) fn others(&self) -> [Color32; 2] {
        if self == &DARK {
            [
                Color32::from_rgb(0xa0, 0x8c, 0xff),
                Color32::from_rgb(0xff, 0x7f, 0xb4),
            ]
        } else {
            [
                Color32::from_rgb(0x6a, 0x4f, 0xc4),
                Color32::from_rgb(0xb8, 0x32, 0x6e),
            ]
        }
    }

    /// The colour of a band.
    pub(crate) fn band(&self, band: Band) -> Color32 {
        match band {
            Band::Low => self.low,
            Band::High => self.high,
        }
    }
}

/// Small text: ticks, units, tags.
pub(crate) fn small() -> FontId {
    FontId::proportional(11.0)
}

/// Text of the usual size.
pub(crate) fn body() -> FontId {
    FontId::proportional(13.5)
}

/// The name of the scene.
pub(crate) fn title() -> FontId {
    FontId::proportional(17.0)
}

/// What a participant reads from a metre away.
pub(crate) fn large() -> FontId {
    FontId::proportional(22.0)
}

/// Numbers of places and titles, to be read from a metre away.
pub(crate) fn huge() -> FontId {
    FontId::proportional(34.0)
}

/// Numbers.
pub(crate) fn number() -> FontId {
    FontId::monospace(12.0)
}

/// Small numbers: ticks of rulers and colour bars.
pub(crate) fn small_number() -> FontId {
    FontId::monospace(10.0)
}
