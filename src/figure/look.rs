//! Colours, dots and sizes of a figure: calm, on white, told apart by those who see fewer colours.
//!
//! The palette is that of Okabe and Ito. Amber and cyan mean 40 Hz and 320 Hz and nothing else;
//! shapes of dots differ too, so that a print in grey can be read.

use super::{Ink, Series, Style, Weight};

/// Texts and the frame.
pub(super) const INK: &str = "#222222";
/// Labels of ticks, footnotes, and the first dashed line.
pub(super) const GREY: &str = "#5a5a5a";
/// Hairlines of the grid.
pub(super) const GRID: &str = "#e4e4e4";

const AMBER: &str = "#e69f00";
const CYAN: &str = "#56b4e9";
/// The same hues where letters are written in them: 4.5 : 1 on white.
const DARK_AMBER: &str = "#8f5a00";
const DARK_CYAN: &str = "#0b6a9e";
/// Blue, vermilion, bluish green, reddish purple, black.
const COLOURS: [&str; 5] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", INK];

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
    pub(super) fn colour(self) -> Option<&'static str> {
        match self {
            Self::Own => None,
            Self::Amber => Some(AMBER),
            Self::Cyan => Some(CYAN),
            Self::Black => Some(INK),
            Self::Grey => Some(GREY),
        }
    }

    /// The same for letters, which need more contrast with the paper.
    pub(super) fn letters(self) -> &'static str {
        match self {
            Self::Amber => DARK_AMBER,
            Self::Cyan => DARK_CYAN,
            Self::Grey => GREY,
            Self::Own | Self::Black => INK,
        }
    }
}

/// How every series looks, in their order.
pub(super) fn looks(series: &[Series]) -> Vec<Look> {
    let (mut n_plain, mut n_dashed) = (0, 0);
    series
        .iter()
        .map(|series| {
            let dots = [Dot::Disc, Dot::Square, Dot::Triangle, Dot::Diamond];
            let weight = series.weight;
            let given = series.ink.colour();
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
                        colour: GREY,
                        dot: Dot::Disc,
                        weight,
                    };
                }
            }
            let look = Look {
                colour: COLOURS[n_plain % COLOURS.len()],
                dot: dots[n_plain % dots.len()],
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
        let looks = looks(&names.map(named));
        assert_eq!((looks[1].colour, looks[2].colour), (AMBER, CYAN));
        for index in [0, 3, 4, 5, 6, 7] {
            let colour = looks[index].colour;
            assert!(colour != AMBER && colour != CYAN, "{}", names[index]);
        }
    }

    #[test]
    fn twenty_series_look_different() {
        let looks = looks(&(0..20).map(|n| named(&format!("m{n}"))).collect::<Vec<_>>());
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "{index}: {look:?}");
        }
    }
}
