//! Colours for numbers: viridis, cividis and grey, all of rising lightness; and one with two arms
//! for differences.
//!
//! Each map is a short table of evenly spaced sRGB colours, mixed linearly in between. Smith and
//! van der Walt 2015 (viridis); Nuñez, Anderton and Renslow 2018 (cividis, for any colour vision).

use eframe::egui::Color32;
use selvedge_foundation::numerics::to_byte;
use serde::{Deserialize, Serialize};

/// Which colours stand for numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ColourMap {
    /// Purple, green, yellow.
    #[default]
    Viridis,
    /// Blue, grey, yellow: alike for every colour vision.
    Cividis,
    /// Black to white.
    Grey,
}

const VIRIDIS: [u32; 11] = [
    0x0044_0154,
    0x0048_2475,
    0x0041_4487,
    0x0035_5f8d,
    0x002a_788e,
    0x0021_918c,
    0x0022_a884,
    0x0044_bf70,
    0x007a_d151,
    0x00bd_df26,
    0x00fd_e725,
];
const CIVIDIS: [u32; 10] = [
    0x0000_224e,
    0x0012_3570,
    0x003b_496c,
    0x0057_5d6d,
    0x0070_7173,
    0x008a_8678,
    0x00a5_9c74,
    0x00c3_b369,
    0x00e1_cc55,
    0x00fe_e838,
];
const GREY: [u32; 2] = [0x0010_1010, 0x00fa_fafa];

impl ColourMap {
    /// Every map, in the order in which they are offered.
    pub(crate) const ALL: [Self; 3] = [Self::Viridis, Self::Cividis, Self::Grey];

    /// The colour of writing on that of a share 0…1 of the scale: black on bright, white on dark.
    pub(crate) fn ink(self, share: f64) -> Color32 {
        ink_on(self.colour(share))
    }

    /// Its name.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Viridis => "viridis",
            Self::Cividis => "cividis",
            Self::Grey => "grey",
        }
    }

    /// The colour of a share 0…1 of the scale; outside it, and for NaN, the nearest end.
    pub(crate) fn colour(self, share: f64) -> Color32 {
        let table: &[u32] = match self {
            Self::Viridis => &VIRIDIS,
            Self::Cividis => &CIVIDIS,
            Self::Grey => &GREY,
        };
        let place = share.clamp(0.0, 1.0).max(0.0) * (table.len() - 1) as f64;
        let below = (0..table.len() - 1)
            .rev()
            .find(|&i| i as f64 <= place)
            .unwrap_or(0);
        let mix = place - below as f64;
        let (from, to) = (channels(table[below]), channels(table[below + 1]));
        let [r, g, b] = std::array::from_fn(|i| mixed(from[i], to[i], mix));
        Color32::from_rgb(r, g, b)
    }
}

/// Colours of differences: from violet through the ground of the theme to yellow. Both arms get
/// farther from the ground alike, so that no difference is the calmest colour and the strongest
/// stand out; violet and yellow are told apart by every colour vision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Diverging {
    below: u32,
    none: u32,
    above: u32,
}

impl Diverging {
    pub(crate) const DARK: Self = Self {
        below: 0x00c0_b0ff,
        none: 0x0026_2b32,
        above: 0x00d9_c229,
    };
    pub(crate) const LIGHT: Self = Self {
        below: 0x0051_2fb8,
        none: 0x00ee_eff1,
        above: 0x0061_4a00,
    };

    /// The colour of a share −1…1 of the scale; outside it the nearest end, for NaN the middle.
    pub(crate) fn colour(self, share: f64) -> Color32 {
        let share = if share.is_nan() {
            0.0
        } else {
            share.clamp(-1.0, 1.0)
        };
        let end = if share < 0.0 { self.below } else { self.above };
        let (from, to) = (channels(self.none), channels(end));
        let [r, g, b] = std::array::from_fn(|i| mixed(from[i], to[i], share.abs()));
        Color32::from_rgb(r, g, b)
    }

    /// The colour of writing on that of a share.
    pub(crate) fn ink(self, share: f64) -> Color32 {
        ink_on(self.colour(share))
    }
}

/// Black on bright, white on dark.
fn ink_on(ground: Color32) -> Color32 {
    let [r, g, b, _] = ground.to_array().map(f64::from);
    // Lightness as the eye weighs it, roughly.
    if 0.3 * r + 0.6 * g + 0.1 * b > 115.0 {
        Color32::BLACK
    } else {
        Color32::WHITE
    }
}

fn channels(rgb: u32) -> [u8; 3] {
    let [_, r, g, b] = rgb.to_be_bytes();
    [r, g, b]
}

fn mixed(from: u8, to: u8, share: f64) -> u8 {
    to_byte((f64::from(from) + (f64::from(to) - f64::from(from)) * share).round())
}
