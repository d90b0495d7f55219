//! The figures that a manifest's `[measured]` may hold: those of the Kawabata testers by the names
//! and in the units that the testers print, and what else carries a unit in its name.
//!
//! Figures that have a direction may be given for one: `smd_warp_um`, `b_weft_gf_cm2_per_cm`.

use std::collections::BTreeMap;

use crate::error::TextileError;
use crate::recipe::Checker;

/// A known figure.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Known {
    /// The letters of the key.
    symbol: &'static str,
    /// The unit in the key, with its underscore; may be empty.
    suffix: &'static str,
    /// The symbol for people.
    name: &'static str,
    /// What it is.
    what: &'static str,
    /// The unit for people.
    unit: &'static str,
    /// The largest that is taken.
    max: f64,
    has_directions: bool,
}

/// Rows of known figures: symbol, suffix: name, what, unit, the largest that is taken; `by_axis`
/// where there may be one of a direction.
macro_rules! known {
    ($($symbol:literal $suffix:literal: $name:literal, $what:literal, $unit:literal,
        $max:literal $(, $by_axis:ident)?;)+) => {
        &[$(Known {
            symbol: $symbol,
            suffix: $suffix,
            name: $name,
            what: $what,
            unit: $unit,
            max: $max,
            has_directions: !concat!($(stringify!($by_axis))?).is_empty(),
        }),+]
    };
}

/// In the order in which a sheet shows them.
const KNOWN: &[Known] = known! {
    "smd" "_um": "SMD", "roughness", "µm", 1e4, by_axis;
    "smd_official" "_um": "SMD ≤ 1 mm", "roughness, official band", "µm", 1e4, by_axis;
    "hurst" "": "H", "Hurst exponent found", "", 2.0;
    "hurst_error" "": "± H", "standard error of H", "", 10.0;
    "n_missing" "": "missing", "points without a height, filled for the strokes", "", 64e6;
    "miu" "": "MIU", "mean friction", "", 10.0, by_axis;
    "mmd" "": "MMD", "mean deviation of friction", "", 10.0, by_axis;
    "mmd_official" "": "MMD ≤ 1 mm", "the same, official band", "", 10.0, by_axis;
    "lc" "": "LC", "linearity of compression", "", 2.0;
    "wc" "_gf_cm_per_cm2": "WC", "energy of compression", "gf·cm/cm²", 100.0;
    "rc" "_percent": "RC", "resilience of compression", "%", 100.0;
    "t0" "_mm": "T0", "thickness at 0.5 gf/cm²", "mm", 100.0;
    "tm" "_mm": "TM", "thickness at 50 gf/cm²", "mm", 100.0;
    "thickness" "_mm": "T", "thickness", "mm", 100.0;
    "weight" "_mg_per_cm2": "W", "weight", "mg/cm²", 1e3;
    "b" "_gf_cm2_per_cm": "B", "bending rigidity", "gf·cm²/cm", 1e3, by_axis;
    "2hb" "_gf_cm_per_cm": "2HB", "hysteresis of bending", "gf·cm/cm", 1e3, by_axis;
    "g" "_gf_per_cm_deg": "G", "shear stiffness", "gf/(cm·°)", 1e3, by_axis;
    "2hg" "_gf_per_cm": "2HG", "hysteresis of shear at 0.5°", "gf/cm", 1e3, by_axis;
    "2hg5" "_gf_per_cm": "2HG5", "hysteresis of shear at 5°", "gf/cm", 1e3, by_axis;
    "lt" "": "LT", "linearity of extension", "", 2.0, by_axis;
    "wt" "_gf_cm_per_cm2": "WT", "energy of extension", "gf·cm/cm²", 1e4, by_axis;
    "rt" "_percent": "RT", "resilience of extension", "%", 100.0, by_axis;
    "emt" "_percent": "EMT", "extension at 500 gf/cm", "%", 1e3, by_axis;
    "em" "_percent": "EM", "extension", "%", 1e3, by_axis;
};

/// Units that other figures may end with.
const UNITS: [&str; 22] = [
    "_um", "_mm", "_cm", "_m", "_nm", "_um2", "_mm2", "_percent", "_deg", "_db", "_hz", "_s", "_n",
    "_mn", "_pa", "_kpa", "_per_mm", "_per_cm", "_per_cm2", "_per_m", "_per_m2", "_tex",
];

/// The whole, and its directions.
const SIDES: [&str; 3] = ["", "warp", "weft"];

/// A figure for people.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its symbol, such as `SMD warp`.
    pub name: String,
    /// What it is; empty if this program does not know.
    pub what: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit; may be empty.
    pub unit: &'static str,
}

/// A figure that may be entered.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownFigure {
    /// Its key in a manifest, such as `smd_warp_um`.
    pub key: String,
    /// Its symbol, such as `SMD warp`.
    pub name: String,
    /// What it is.
    pub what: &'static str,
    /// Its unit for people; may be empty.
    pub unit: &'static str,
    /// The largest that is taken.
    pub max: f64,
}

impl KnownFigure {
    /// Every known figure in the testers' order, with those of one direction after it.
    pub fn all() -> impl Iterator<Item = Self> {
        KNOWN.iter().flat_map(|known| {
            let n_sides = if known.has_directions { SIDES.len() } else { 1 };
            SIDES[..n_sides].iter().map(|side| {
                let between = if side.is_empty() { "" } else { "_" };
                Self {
                    key: [known.symbol, between, side, known.suffix].concat(),
                    name: [known.name, side].join(" ").trim_end().to_owned(),
                    what: known.what,
                    unit: known.unit,
                    max: known.max,
                }
            })
        })
    }
}

impl Figure {
    /// The figures of a manifest for people: the known ones in the testers' order, then the others
    /// by their keys.
    pub fn all_of(measured: &BTreeMap<String, f64>) -> Vec<Self> {
        let known: Vec<KnownFigure> = KnownFigure::all().collect();
        let is_other = |key: &&String| known.iter().all(|figure| figure.key != **key);
        let others: Vec<&String> = measured.keys().filter(is_other).collect();
        let others = others.into_iter().map(|key| Self {
            name: key.clone(),
            what: "",
            value: measured[key],
            unit: "",
        });
        let found = known.iter().filter_map(|figure| {
            Some(Self {
                name: figure.name.clone(),
                what: figure.what,
                value: *measured.get(&figure.key)?,
                unit: figure.unit,
            })
        });
        found.chain(others).collect()
    }
}

/// Refuses a figure out of its range, and a key that says no unit.
pub(super) fn check(checker: &Checker<'_>, key: &str, value: f64) -> Result<(), TextileError> {
    if let Some(known) = KnownFigure::all().find(|known| known.key == key) {
        return checker.within("measured", key, value, 0.0..=known.max);
    }
    checker.within("measured", key, value, -1e12..=1e12)?;
    let has_unit = |unit: &str| key.len() > unit.len() && key.ends_with(unit);
    if UNITS.iter().any(|unit| has_unit(unit)) {
        return Ok(());
    }
    let what = format!("unknown figure \"{key}\"");
    let mend = "name one of the guide (smd_um, miu, rc_percent …), or end it with its unit";
    Err(checker.wrong("measured", key, what, mend))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn checked(key: &str, value: f64) -> Result<(), String> {
        let text = format!("[measured]\n{key} = {value}\n").to_lowercase();
        let checker = Checker {
            text: &text,
            path: Path::new("t.toml"),
            nth: 0,
        };
        check(&checker, key, value).map_err(|error| error.to_string())
    }

    #[test]
    fn every_known_figure_takes_its_range_and_nothing_beyond() {
        for known in KnownFigure::all() {
            checked(&known.key, known.max).unwrap();
            for value in [f64::NAN, -0.1, known.max * 1.01] {
                let error = checked(&known.key, value).unwrap_err();
                let start = format!("t.toml:2: {} is ", known.key);
                assert!(error.starts_with(&start), "{error}");
            }
        }
    }

    #[test]
    fn directions_are_for_figures_that_have_one() {
        let keys: Vec<String> = KnownFigure::all().map(|known| known.key).collect();
        let is_known = |key: &str| keys.iter().any(|known| known == key);
        assert!(is_known("smd_warp_um") && is_known("mmd_official_weft"));
        assert!(!is_known("rc_warp_percent"));
        assert!(keys.len() > KNOWN.len());
        assert!(
            KNOWN
                .iter()
                .all(|known| is_known(&[known.symbol, known.suffix].concat()))
        );
    }

    #[test]
    fn other_figures_say_their_unit() {
        checked("sq_um", -3.0).unwrap();
        for key in ["smd", "drape", "_um"] {
            let error = checked(key, 1.0).unwrap_err();
            assert!(
                error.contains("unknown figure") && error.contains("; "),
                "{error}"
            );
        }
    }

    #[test]
    fn figures_stand_in_the_testers_order() {
        let keys = [
            "emt_percent",
            "miu",
            "smd_weft_um",
            "smd_um",
            "sq_um",
            "smd_warp_um",
        ];
        let measured = keys.map(|key| (key.to_owned(), 1.0)).into_iter().collect();
        let names: Vec<String> = Figure::all_of(&measured)
            .into_iter()
            .map(|figure| figure.name)
            .collect();
        assert_eq!(
            names,
            ["SMD", "SMD warp", "SMD weft", "MIU", "EMT", "sq_um"]
        );
    }
}
