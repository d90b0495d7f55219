//! Units as measurement files spell them: lengths, and what else a column may hold.

use serde::{Deserialize, Serialize};

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LengthUnit {
    /// m
    #[serde(rename = "m")]
    Metre,
    /// cm
    #[serde(rename = "cm")]
    Centimetre,
    /// mm
    #[serde(rename = "mm")]
    Millimetre,
    /// µm
    #[serde(rename = "um", alias = "µm")]
    Micrometre,
    /// nm
    #[serde(rename = "nm")]
    Nanometre,
    /// pm
    #[serde(rename = "pm")]
    Picometre,
    /// Å
    #[serde(rename = "angstrom")]
    Angstrom,
}

impl LengthUnit {
    /// The unit that a word means: `mm`, `µm`, `Micrometer`, `[nm]`; `None` for anything else.
    pub fn of(word: &str) -> Option<Self> {
        let is_decoration = |c: char| c.is_whitespace() || "[]()\0".contains(c);
        let word = word.trim_matches(is_decoration);
        let lower = word.to_lowercase();
        let name = lower.strip_suffix('s').unwrap_or(&lower);
        let means = |(_, _, signs, names): &&Row| signs.contains(&word) || names.contains(&name);
        LENGTHS.iter().find(means).map(|(unit, ..)| *unit)
    }

    /// The last unit among the words of a column's heading, such as `height_um` or `X [mm]`.
    pub(crate) fn in_heading(heading: &str) -> Option<Self> {
        let is_break = |c: char| !c.is_alphanumeric() && !"µμ".contains(c);
        let words = heading.rsplit(is_break).filter(|word| *word != "A");
        words.filter(|word| !word.is_empty()).find_map(Self::of)
    }

    /// Micrometres in one.
    pub fn um(self) -> f64 {
        LENGTHS[self as usize].1
    }

    /// How files of this program spell it.
    pub fn word(self) -> &'static str {
        LENGTHS[self as usize].2[0]
    }
}

/// A unit, micrometres in one, its signs, of which the first is that of this program's files, and
/// its names in lower case.
type Row = (
    LengthUnit,
    f64,
    &'static [&'static str],
    &'static [&'static str],
);

/// The units in their order.
const LENGTHS: [Row; 7] = {
    use LengthUnit as L;
    [
        (L::Metre, 1e6, &["m"], &["metre", "meter"]),
        (L::Centimetre, 1e4, &["cm"], &["centimetre", "centimeter"]),
        (L::Millimetre, 1e3, &["mm"], &["millimetre", "millimeter"]),
        // The micro sign, the Greek letter, the letter of an old code page, and what is left of it
        // where an encoding was lost.
        (
            L::Micrometre,
            1.0,
            &["um", "µm", "μm", "æm", "~m"],
            &["micrometre", "micrometer", "micron"],
        ),
        (L::Nanometre, 1e-3, &["nm"], &["nanometre", "nanometer"]),
        (L::Picometre, 1e-6, &["pm"], &["picometre", "picometer"]),
        (
            L::Angstrom,
            1e-4,
            &["angstrom", "Å", "A"],
            &["angstrom", "ångström", "angström"],
        ),
    ]
};

/// The unit of a column: a length, or what else a tester records. Places take lengths alone;
/// heights take a voltage too, with a sensitivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// A length.
    Length(LengthUnit),
    /// V
    Volt,
    /// mV
    Millivolt,
    /// s
    Second,
    /// A unit of something else.
    Other,
}

impl Unit {
    /// The length, if it is one.
    pub(crate) fn length(self) -> Option<LengthUnit> {
        match self {
            Self::Length(unit) => Some(unit),
            _ => None,
        }
    }

    /// How people write it; empty for a unit of something else.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Length(LengthUnit::Micrometre) => "µm",
            Self::Length(LengthUnit::Angstrom) => "Å",
            Self::Length(unit) => unit.word(),
            Self::Volt => "V",
            Self::Millivolt => "mV",
            Self::Second => "s",
            Self::Other => "",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_however_they_are_spelt() {
        for (word, um) in [
            ("µm", 1.0),
            ("\u{3bc}m", 1.0),
            ("[mm]", 1e3),
            ("Micrometers", 1.0),
            ("nm\0\0", 1e-3),
            ("angstrom", 1e-4),
        ] {
            assert_eq!(LengthUnit::of(word).unwrap().um(), um, "{word}");
        }
        for word in ["", "V", "mN", "s", "M", "km²"] {
            assert_eq!(LengthUnit::of(word), None, "{word}");
        }
        for unit in [
            LengthUnit::Metre,
            LengthUnit::Angstrom,
            LengthUnit::Picometre,
        ] {
            assert_eq!(LengthUnit::of(unit.word()), Some(unit));
        }
    }

    #[test]
    fn headings_hold_units_among_other_words() {
        let um = Some(LengthUnit::Micrometre);
        assert_eq!(LengthUnit::in_heading("height_um"), um);
        assert_eq!(LengthUnit::in_heading("Raw Micrometer"), um);
        assert_eq!(LengthUnit::in_heading("Z (µm)"), um);
        assert_eq!(LengthUnit::in_heading("iso1661029_a"), None);
        assert_eq!(LengthUnit::in_heading("profile A"), None);
    }
}
