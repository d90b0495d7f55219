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
        Some(match word {
            "m" => Self::Metre,
            "cm" => Self::Centimetre,
            "mm" => Self::Millimetre,
            // The micro sign, the Greek letter, the letter of an old code page, and what is left
            // of it where an encoding was lost.
            "um" | "µm" | "μm" | "æm" | "~m" => Self::Micrometre,
            "nm" => Self::Nanometre,
            "pm" => Self::Picometre,
            "Å" | "A" => Self::Angstrom,
            _ => return Self::of_name(&word.to_lowercase()),
        })
    }

    fn of_name(name: &str) -> Option<Self> {
        let name = name.strip_suffix('s').unwrap_or(name);
        Some(match name {
            "metre" | "meter" => Self::Metre,
            "centimetre" | "centimeter" => Self::Centimetre,
            "millimetre" | "millimeter" => Self::Millimetre,
            "micrometre" | "micrometer" | "micron" => Self::Micrometre,
            "nanometre" | "nanometer" => Self::Nanometre,
            "picometre" | "picometer" => Self::Picometre,
            "angstrom" | "ångström" | "angström" => Self::Angstrom,
            _ => return None,
        })
    }

    /// The last unit among the words of a column's heading, such as `height_um` or `X [mm]`.
    pub(crate) fn in_heading(heading: &str) -> Option<Self> {
        let is_break = |c: char| !c.is_alphanumeric() && !"µμ".contains(c);
        let words = heading.rsplit(is_break).filter(|word| *word != "A");
        words.filter(|word| !word.is_empty()).find_map(Self::of)
    }

    /// Micrometres in one.
    pub fn um(self) -> f64 {
        match self {
            Self::Metre => 1e6,
            Self::Centimetre => 1e4,
            Self::Millimetre => 1e3,
            Self::Micrometre => 1.0,
            Self::Nanometre => 1e-3,
            Self::Picometre => 1e-6,
            Self::Angstrom => 1e-4,
        }
    }

    /// How files of this program spell it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Micrometre => "um",
            Self::Nanometre => "nm",
            Self::Picometre => "pm",
            Self::Angstrom => "angstrom",
        }
    }
}

/// The unit of a column: a length, or what else a tester records. Places take lengths alone;
/// heights take a voltage too, with a sensitivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
