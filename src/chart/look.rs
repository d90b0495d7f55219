//! Colours, dots and sizes of a figure: calm, on white, told apart by those who see fewer colours.
//!
//! The palette is that of Okabe and Ito. Amber and cyan mean 40 Hz and 320 Hz and nothing else;
//! shapes of dots differ too, so that a print in grey can be read.

use super::{Ink, Series, Style, Weight};

/// Nearly black: texts on white, and on whatever is bright.
pub(super) const INK: &str = "#222222";

/// How opaque areas and bars are.
pub(super) const FILL: f64 = 0.25;

const AMBER: &str = "#e69f00";
const CYAN: &str = "#56b4e9";

/// What a picture is drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Paper {
    /// White paper: files.
    #[default]
    White,
    /// Nothing: what is behind shows, and is bright.
    OnLight,
    /// Nothing: what is behind shows, and is dark.
    OnDark,
}

/// The colours that go with a paper.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Inks {
    /// The paper itself, or what is expected behind it.
    pub(super) ground: &'static str,
    /// Texts and the frame.
    pub(super) ink: &'static str,
    /// Labels of ticks, footnotes, and the first dashed line.
    pub(super) grey: &'static str,
    /// Hairlines of the grid.
    pub(super) grid: &'static str,
    /// The line around a frame.
    pub(super) edge: &'static str,
    /// Amber and cyan where letters are written in them: 4.5 : 1.
    letters: [&'static str; 2],
    /// Violet and rose.
    others: [&'static str; 2],
    /// Blue, vermilion, bluish green, reddish purple, and that of texts; then indigo, olive, wine,
    /// brown, slate, leaf green and teal, for charts of many series.
    colours: [&'static str; N_COLOURS],
}

/// Series of their own colour; further ones differ by their dots alone.
const N_COLOURS: usize = 12;

const WHITE: Inks = Inks {
    ground: "#ffffff",
    ink: INK,
    grey: "#5a5a5a",
    grid: "#e4e4e4",
    edge: "#9a9a9a",
    letters: ["#8f5a00", "#0b6a9e"],
    others: ["#6a4fc4", "#b8326e"],
    colours: [
        "#0072b2", "#d55e00", "#009e73", "#cc79a7", INK, "#332288", "#999933", "#882255",
        "#6b3e1d", "#5d7c8a", "#5a8f00", "#007f8c",
    ],
};

const ON_LIGHT: Inks = Inks {
    ground: "#f6f7f9",
    grid: "#dde1e6",
    ..WHITE
};

const ON_DARK: Inks = Inks {
    ground: "#14171b",
    ink: "#e7eaee",
    grey: "#97a1ad",
    grid: "#252a31",
    edge: "#4a525c",
    letters: [AMBER, CYAN],
    others: ["#a08cff", "#ff7fb4"],
    colours: [
        "#4a9fe0", "#e8743b", "#2cb58a", "#d68fb6", "#e7eaee", "#7d8cf0", "#c2c25a", "#d0608e",
        "#b98b66", "#93b0bd", "#93c742", "#5fd0c0",
    ],
};

impl Paper {
    /// Its colours.
    pub(super) fn inks(self) -> &'static Inks {
        match self {
            Self::White => &WHITE,
            Self::OnLight => &ON_LIGHT,
            Self::OnDark => &ON_DARK,
        }
    }
}

/// The shape of a dot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dot {
    /// A disc.
    Disc,
    /// A square on its side.
    Square,
    /// A triangle on its side.
    Triangle,
    /// A square on its corner.
    Diamond,
}

/// How a series looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Look {
    /// Its colour.
    pub(super) colour: &'static str,
    /// Its dots.
    pub(super) dot: Dot,
    /// Its line.
    pub(super) weight: Weight,
}

impl Weight {
    /// How wide a line is, px.
    pub(super) fn width_px(self) -> f64 {
        match self {
            Self::Thin => 0.8,
            Self::Normal => 1.6,
            Self::Bold => 2.0,
        }
    }
}

impl Ink {
    /// Its colour, if it is not one that is given out.
    pub(super) fn colour(self, inks: &Inks) -> Option<&'static str> {
        match self {
            Self::Own => None,
            Self::Amber => Some(AMBER),
            Self::Cyan => Some(CYAN),
            Self::Black => Some(inks.ink),
            Self::Grey => Some(inks.grey),
            Self::Violet => Some(inks.others[0]),
            Self::Rose => Some(inks.others[1]),
        }
    }

    /// The same for letters, which need more contrast with the paper.
    pub(super) fn letters(self, inks: &Inks) -> &'static str {
        match self {
            Self::Amber => inks.letters[0],
            Self::Cyan => inks.letters[1],
            Self::Grey => inks.grey,
            Self::Violet => inks.others[0],
            Self::Rose => inks.others[1],
            Self::Own | Self::Black => inks.ink,
        }
    }
}

/// How every series looks, in their order.
pub(super) fn looks(series: &[Series], inks: &Inks) -> Vec<Look> {
    let (mut n_plain, mut n_dashed) = (0, 0);
    series
        .iter()
        .map(|series| {
            let dots = [Dot::Disc, Dot::Square, Dot::Triangle, Dot::Diamond];
            let weight = series.weight;
            let given = series.ink.colour(inks);
            if let Some(colour) = given.or_else(|| colour_of_band(&series.name)) {
                let dot = if series.ink == Ink::Grey {
                    Dot::Square
                } else {
                    Dot::Disc
                };
                return Look {
                    colour,
                    dot,
                    weight,
                };
            }
            if series.style == Style::Dashed {
                n_dashed += 1;
                if n_dashed == 1 {
                    return Look {
                        colour: inks.grey,
                        dot: Dot::Disc,
                        weight,
                    };
                }
            }
            let look = Look {
                colour: inks.colours[n_plain % inks.colours.len()],
                // Another dot where the colours begin again.
                dot: dots[(n_plain + n_plain / inks.colours.len()) % dots.len()],
                weight,
            };
            n_plain += 1;
            look
        })
        .collect()
}

/// Amber for what is called 40 Hz, cyan for what is called 320 Hz.
fn colour_of_band(name: &str) -> Option<&'static str> {
    let is_named = |band: &str| {
        name.match_indices(band).any(|(at, _)| {
            let before = name[..at].chars().next_back();
            !before.is_some_and(|c| c.is_ascii_digit() || c == '.')
        })
    };
    if is_named("320 Hz") {
        Some(CYAN)
    } else {
        is_named("40 Hz").then_some(AMBER)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> Series {
        Series {
            name: name.to_owned(),
            ..Series::default()
        }
    }

    #[test]
    fn amber_and_cyan_are_for_the_bands_alone() {
        let names = [
            "table",
            "40 Hz",
            "level at 320 Hz",
            "340 Hz",
            "1.40 Hz",
            "f",
            "g",
            "h",
        ];
        let looks = looks(&names.map(named), &WHITE);
        assert_eq!((looks[1].colour, looks[2].colour), (AMBER, CYAN));
        for index in [0, 3, 4, 5, 6, 7] {
            let colour = looks[index].colour;
            assert!(colour != AMBER && colour != CYAN, "{}", names[index]);
        }
    }

    #[test]
    fn a_dozen_series_have_colours_of_their_own() {
        let series: Vec<Series> = (0..N_COLOURS).map(|n| named(&format!("m{n}"))).collect();
        for inks in [&WHITE, &ON_LIGHT, &ON_DARK] {
            let looks = looks(&series, inks);
            for (index, look) in looks.iter().enumerate() {
                let is_known = looks[..index]
                    .iter()
                    .any(|other| other.colour == look.colour);
                assert!(!is_known, "{index}: {look:?}");
            }
        }
    }

    #[test]
    fn twenty_series_look_different() {
        let series: Vec<Series> = (0..20).map(|n| named(&format!("m{n}"))).collect();
        let looks = looks(&series, &WHITE);
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "{index}: {look:?}");
        }
    }
}
