//! From the figures of the Kawabata testers to laws in SI units, and what is odd about them.
//!
//! Keys are those of a textile's `[measured]`; one of a direction (`emt_warp_percent`) goes before
//! one of both. `fm_gf_per_cm` is the load of the tensile test where it was not 500 gf/cm, as of
//! knits. A "warp" bending figure bends warp yarns.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::DrapeError;
use super::curve::Curve;
use super::fabric::{Compression, Fabric, Tension};
use selvedge_foundation::files;
use selvedge_textile::{KnownFigure, Library};

/// Mechanical figures of the textiles that are part of the program.
const FABRICS: &str = include_str!("../../assets/drape/fabrics.toml");
/// Figures by their keys.
pub(crate) type Figures = BTreeMap<String, f64>;

/// 1 gf/cm in N/m.
pub(crate) const N_PER_M: f64 = 0.980_665;
/// 1 gf·cm²/cm in N·m.
pub(crate) const N_M: f64 = 98.0665e-6;
/// 1 gf/(cm·°) in N/m per radian.
pub(crate) const N_PER_M_RAD: f64 = N_PER_M * 180.0 / std::f64::consts::PI;
/// 1 gf·cm/cm in N.
pub(crate) const N: f64 = 9.806_65e-3;
/// Load of the tensile test, gf/cm.
const TENSILE_GF_PER_CM: f64 = 500.0;
/// Its key where it was another.
const LOAD: &str = "fm_gf_per_cm";
/// Friction of a finger on cloth where nothing else is said: MIU is against steel.
pub(crate) const FINGER_FRICTION: f64 = 0.4;

/// Whether a figure may be given at all.
pub(crate) fn is_known(key: &str) -> bool {
    key == LOAD || KnownFigure::all().any(|figure| figure.key == key)
}

/// A figure along warp and weft.
pub(crate) fn along(figures: &Figures, symbol: &str, suffix: &str) -> Option<[f64; 2]> {
    let both = figures.get(&format!("{symbol}{suffix}"));
    let of = |side: &str| {
        figures
            .get(&format!("{symbol}_{side}{suffix}"))
            .or(both)
            .copied()
    };
    match (of("warp"), of("weft")) {
        (Some(warp), Some(weft)) => Some([warp, weft]),
        (one, other) => one.or(other).map(|value| [value; 2]),
    }
}

/// The mean of warp and weft.
pub(crate) fn mean(figures: &Figures, symbol: &str, suffix: &str) -> Option<f64> {
    along(figures, symbol, suffix).map(|[warp, weft]| 0.5 * (warp + weft))
}

impl Fabric {
    /// The cloth of these figures, and what is odd about them.
    ///
    /// # Errors
    /// A figure that a cloth cannot do without is missing, or one is out of its range.
    pub(crate) fn of_figures(figures: &Figures) -> Result<(Self, Vec<String>), DrapeError> {
        let need = |found: Option<[f64; 2]>, key: &str| {
            found.ok_or_else(|| {
                let mend = "add it to [measured], or name a textile whose figures are known";
                DrapeError::input(format!("there is no figure {key}"), mend)
            })
        };
        let weight = need(along(figures, "weight", "_mg_per_cm2"), "weight_mg_per_cm2")?[0];
        let emt = need(along(figures, "emt", "_percent"), "emt_percent")?;
        let load = figures.get(LOAD).copied().unwrap_or(TENSILE_GF_PER_CM);
        // Without LT it follows from WT, the area below the curve.
        let of_energy = along(figures, "wt", "_gf_cm_per_cm2")
            .map(|wt| [0, 1].map(|axis| 200.0 * wt[axis] / (load * emt[axis])));
        let lt = need(along(figures, "lt", "").or(of_energy), "lt")?;
        let shear = need(along(figures, "g", "_gf_per_cm_deg"), "g_gf_per_cm_deg")?;
        let bending = need(along(figures, "b", "_gf_cm2_per_cm"), "b_gf_cm2_per_cm")?;
        DrapeError::within(("weight", weight, "mg/cm²"), [0.1, 1e3])?;
        DrapeError::within(("tensile load", load, "gf/cm"), [0.1, 1e5])?;
        for axis in 0..2 {
            DrapeError::within(("EMT", emt[axis], "%"), [0.01, 500.0])?;
            DrapeError::within(("LT", lt[axis], ""), [0.1, 1.5])?;
            DrapeError::within(("G", shear[axis], "gf/(cm·°)"), [0.0, 1e3])?;
            DrapeError::within(("B", bending[axis], "gf·cm²/cm"), [0.0, 1e3])?;
        }
        let force = load * N_PER_M;
        let strains = emt.map(|emt| 0.01 * emt);
        let narrow = mean(figures, "2hg", "_gf_per_cm").unwrap_or(0.0);
        let wide = mean(figures, "2hg5", "_gf_per_cm").unwrap_or(narrow);
        let bent = along(figures, "2hb", "_gf_cm_per_cm").unwrap_or([0.0; 2]);
        let resilience = along(figures, "rt", "_percent").unwrap_or([100.0; 2]);
        let fabric = Self {
            density_kg_per_m2: 0.01 * weight,
            tension: [0, 1].map(|axis| Tension::new(force, strains[axis], lt[axis])),
            // f = (1 − RT) WT/2ε_m with WT = LT F_m ε_m/2.
            tension_friction_n_per_m: [0, 1].map(|axis| {
                (1.0 - 0.01 * resilience[axis]).clamp(0.0, 1.0) * 0.25 * lt[axis] * force
            }),
            shear_n_per_m: 0.5 * (shear[0] + shear[1]) * N_PER_M_RAD,
            shear_loop_n_per_m: [narrow, wide].map(|width| width * N_PER_M),
            bending_n_m: bending.map(|rigidity| rigidity * N_M),
            bending_loop_n: bent.map(|width| width * N),
            compression: compression(figures)?,
            friction: FINGER_FRICTION,
        };
        Ok((fabric, odd(figures, (emt, lt, load), weight)))
    }
}

/// A measured tension curve along warp and weft from a table of `strain_percent`, `warp_gf_per_cm`
/// and, unless both are alike, `weft_gf_per_cm`; with the figures that it stands for.
///
/// # Errors
/// One line: what is wrong, where, and how to mend it.
pub(crate) fn tension_curves(path: &Path) -> Result<([Tension; 2], Figures), DrapeError> {
    let text = files::read_text(path)?;
    let names = ["strain_percent", "warp_gf_per_cm", "weft_gf_per_cm"];
    let table = files::Table::read(&text, path, &names[..2], &names[2..])?;
    let strains = table.required_numbers(names[0])?;
    let warp = table.required_numbers(names[1])?;
    let weft = table.numbers(names[2])?;
    let mut figures = Figures::new();
    let mut curve = |loads: &[f64], side: &str| {
        let points = strains.iter().zip(loads);
        let points: Vec<[f64; 2]> = points.map(|(s, gf)| [0.01 * s, gf * N_PER_M]).collect();
        let wrong = |error: DrapeError| {
            let flaw = files::Flaw::described(("", 0, ""), &error.to_string(), "correct it");
            DrapeError::from(flaw.in_file(&text, path))
        };
        let tension = Tension::measured(&Curve::new(&points).map_err(wrong)?);
        let [work, load, _] = tension.at(tension.max_strain);
        figures.insert(format!("emt_{side}_percent"), 100.0 * tension.max_strain);
        let lt = work / (0.5 * load * tension.max_strain);
        figures.insert(format!("lt_{side}"), lt);
        figures.insert(LOAD.to_owned(), load / N_PER_M);
        Ok::<_, DrapeError>(tension)
    };
    let both = [
        curve(&warp, "warp")?,
        curve(weft.as_deref().unwrap_or(&warp), "weft")?,
    ];
    Ok((both, figures))
}

fn compression(figures: &Figures) -> Result<Compression, DrapeError> {
    let figure = |key: &str| figures.get(key).copied();
    let thickness = figure("t0_mm")
        .or_else(|| figure("thickness_mm"))
        .unwrap_or(0.5);
    DrapeError::within(("thickness T0", thickness, "mm"), [0.01, 20.0])?;
    let linearity = figure("lc").unwrap_or(0.4);
    DrapeError::within(("LC", linearity, ""), [0.1, 1.5])?;
    let of_energy = figure("wc_gf_cm_per_cm2")
        .map(|wc| 2e3 * wc * N_PER_M / (linearity * Compression::TESTER_PA));
    let yields = of_energy
        .or_else(|| figure("tm_mm").map(|tm| thickness - tm))
        .unwrap_or(0.0);
    DrapeError::within(("yield T0 − TM", yields, "mm"), [0.0, 0.9 * thickness])?;
    Ok(Compression::new(1e-3 * thickness, 1e-3 * yields, linearity))
}

/// Figures that contradict each other, or that hardly any cloth has: a line each.
fn odd(figures: &Figures, (emt, lt, load): ([f64; 2], [f64; 2], f64), weight: f64) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(wt) = along(figures, "wt", "_gf_cm_per_cm2") {
        for (axis, side) in ["warp", "weft"].into_iter().enumerate() {
            let expected = load * lt[axis] * emt[axis] / 200.0;
            let off = wt[axis] / expected - 1.0;
            if off.abs() > 0.05 {
                lines.push(format!(
                    "WT of the {side} is {} gf·cm/cm², but LT and EMT give {expected:.3}: {:+.0} %",
                    wt[axis],
                    100.0 * off
                ));
            }
        }
    }
    if let Some(miu) = mean(figures, "miu", "").filter(|miu| *miu > 1.0) {
        let what = "more than 1 is hardly cloth on steel";
        lines.push(format!("MIU is {miu}: {what}"));
    }
    if weight > 80.0 {
        let what = "more than 80 is hardly cloth";
        lines.push(format!("the weight is {weight} mg/cm²: {what}"));
    }
    lines
}

/// Figures of the program, which nobody measured: their keys, and the class that they are of.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Plausible {
    class: String,
    pub(crate) keys: Vec<String>,
}

impl Plausible {
    /// Those that are left where some are stated.
    pub(crate) fn without(mut self, stated: &Figures) -> Self {
        let is_left = |key: &String| {
            let (symbol, suffix) = parts(key);
            along(stated, symbol, suffix).is_none()
        };
        self.keys.retain(is_left);
        self
    }

    /// What is to be told of them.
    pub(crate) fn line(&self) -> Option<String> {
        let (n, class) = (self.keys.len(), &self.class);
        (n > 0).then(|| format!("{n} of its figures are plausible ones of {class}, not measured"))
    }
}

/// Symbol and unit of a key: `emt` and `_percent`.
pub(crate) fn parts(key: &str) -> (&str, &str) {
    key.split_at(key.find('_').unwrap_or(key.len()))
}

/// Mechanical figures of a textile: those of the program, below those that its own manifest states;
/// and which are of the program.
pub(crate) fn of_textile(
    id: &str,
    library: Option<&Path>,
) -> Result<(Figures, Plausible), DrapeError> {
    let own = Library::named_or_shipped(library, None)?
        .manifest(id)?
        .measured;
    let path = Path::new("fabrics.toml");
    let mut known: BTreeMap<String, FabricKeys> = files::keys_from_str(FABRICS, path)?;
    let known = known.remove(id).unwrap_or_default();
    let own = own.into_iter().filter(|(key, _)| is_known(key));
    let own: Figures = own.collect();
    let plausible = Plausible {
        class: known.class,
        keys: known.figures.keys().cloned().collect(),
    };
    let figures = known.figures.into_iter().chain(own.clone());
    Ok((figures.collect(), plausible.without(&own)))
}

/// An entry of the figures of the program.
#[derive(Default, Deserialize)]
struct FabricKeys {
    #[serde(default)]
    class: String,
    #[serde(flatten)]
    figures: Figures,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(pairs: &[(&str, f64)]) -> Figures {
        pairs
            .iter()
            .map(|(key, value)| ((*key).to_owned(), *value))
            .collect()
    }

    const DENIM: [(&str, f64); 6] = [
        ("weight_mg_per_cm2", 32.0),
        ("emt_percent", 5.0),
        ("lt", 0.7),
        ("g_gf_per_cm_deg", 2.0),
        ("b_warp_gf_cm2_per_cm", 0.2),
        ("b_weft_gf_cm2_per_cm", 0.1),
    ];

    #[test]
    fn figures_become_si_units() {
        let (fabric, odd) = Fabric::of_figures(&figures(&DENIM)).unwrap();
        assert!(odd.is_empty(), "{odd:?}");
        assert!((fabric.density_kg_per_m2 - 0.32).abs() < 1e-12);
        assert!((fabric.tension[0].at(0.05)[1] - 490.3325).abs() < 1e-6);
        assert!((fabric.shear_n_per_m - 2.0 * 56.188).abs() < 1e-3);
        assert!((fabric.bending_n_m[0] - 19.6133e-6).abs() < 1e-12);
        assert!((fabric.bending_n_m[1] - 9.80665e-6).abs() < 1e-12);
        let more = [("wc_gf_cm_per_cm2", 0.2), ("lc", 0.4), ("t0_mm", 1.0)];
        let (fabric, _) = Fabric::of_figures(&figures(&[&DENIM[..], &more[..]].concat())).unwrap();
        // T0 − TM = 2 WC/(LC P_m): 2·0.1961 J/m² over 0.4·4903 Pa.
        assert!((fabric.compression.yield_m - 0.2e-3).abs() < 1e-9);
    }

    #[test]
    fn odd_and_missing_figures_are_told_in_a_line() {
        let more = [
            ("wt_gf_cm_per_cm2", 12.0),
            ("miu", 1.3),
            ("weight_mg_per_cm2", 90.0),
        ];
        let (_, odd) = Fabric::of_figures(&figures(&[&DENIM[..], &more[..]].concat())).unwrap();
        let expected = [
            "WT of the warp",
            "WT of the weft",
            "MIU is 1.3",
            "the weight is 90",
        ];
        assert_eq!(odd.len(), 4);
        for (line, start) in odd.iter().zip(expected) {
            assert!(line.starts_with(start), "{line}");
        }
        let error = Fabric::of_figures(&figures(&DENIM[1..]))
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("no figure weight_mg_per_cm2; add it"),
            "{error}"
        );
        let heavy = figures(&[&DENIM[..], &[("weight_mg_per_cm2", f64::NAN)]].concat());
        assert!(Fabric::of_figures(&heavy).is_err());
        assert!(is_known("fm_gf_per_cm") && is_known("2hb_warp_gf_cm_per_cm"));
        assert!(!is_known("2hb"));
    }

    #[test]
    fn linearity_follows_from_the_energy() {
        let mut given = figures(&DENIM);
        given.remove("lt");
        given.insert("wt_gf_cm_per_cm2".to_owned(), 2.5 * 0.7 * 5.0);
        let (fabric, _) = Fabric::of_figures(&given).unwrap();
        let expected = Tension::new(490.3325, 0.05, 0.7).at_rest_n_per_m;
        assert!((fabric.tension[0].at_rest_n_per_m / expected - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_measured_curve_takes_the_place_of_emt_and_lt() {
        let folder = selvedge_scratch::ScratchFolder::made("drape-tension");
        let (path, curve) = (folder.join("a.drape.toml"), folder.join("tension.csv"));
        let text = "name = \"a\"\ntension = \"tension.csv\"\n[measured]\n\
            weight_mg_per_cm2 = 20\ng_gf_per_cm_deg = 0.5\nb_gf_cm2_per_cm = 0.1\n";
        std::fs::write(&path, text).unwrap();
        let rows = "strain_percent,warp_gf_per_cm,weft_gf_per_cm\n1,50,20\n2,150,60\n4,500,200\n";
        std::fs::write(&curve, rows).unwrap();
        let scene = crate::DrapeScene::read(&path).unwrap();
        for (axis, gf_per_cm) in [150.0, 60.0].into_iter().enumerate() {
            let [_, tension, _] = scene.fabric().tension[axis].at(0.02);
            assert!(
                (tension / (gf_per_cm * N_PER_M) - 1.0).abs() < 1e-9,
                "{tension}"
            );
        }
        assert!((scene.fabric().tension[1].max_strain - 0.04).abs() < 1e-12);
        for (rows, expected) in [
            ("strain_percent\n1\n", "no column warp_gf_per_cm"),
            (
                "strain_percent,warp_gf_per_cm\n1,50\n2,40\n",
                "does not rise; let strain",
            ),
        ] {
            std::fs::write(&curve, rows).unwrap();
            let error = crate::DrapeScene::read(&path).unwrap_err().to_string();
            assert!(
                error.contains("tension.csv") && error.contains(expected),
                "{error}"
            );
        }
    }

    #[test]
    fn the_figures_of_the_program_are_known_ones() {
        let entries: BTreeMap<String, FabricKeys> =
            files::keys_from_str(FABRICS, Path::new("fabrics.toml")).unwrap();
        assert_eq!(entries.len(), 16);
        for (id, entry) in entries {
            let odd = entry.figures.keys().find(|key| !is_known(key));
            assert!(odd.is_none(), "{id}: {odd:?}");
        }
    }
}
