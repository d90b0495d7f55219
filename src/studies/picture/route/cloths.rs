//! Model cloths whose relief is known, and their pictures.

use super::super::drawings::Bend;
use super::taking::{LIGHT, Taking};
use crate::shading::reliefs::in_px;
use crate::{Effort, ReportError, textiles};
use selvedge_foundation::numerics::{Grid, Random, to_index};
use selvedge_textile::picture::Place;
use selvedge_textile::picture::shading::picture_of;
use selvedge_textile::surface::HeightMap;
use selvedge_textile::{Library, Source, Weave};
use std::path::Path;

/// Share of white that faces the light.
const ALBEDO: f64 = 0.8;
/// Points of the relief along a pixel.
const POINTS_A_PX: usize = 2;

/// The fine cloth that has a double.
const FINE: &str = "polyamide-taffeta";
/// Models of the shipped library beside it, fine to coarse: what a textile of a picture is tuned by
/// was chosen on these.
const TUNED_ON: [&str; 11] = [
    "denim",
    "jute-plain",
    "polyester-satin",
    "silk-crepe",
    "polyester-interlock",
    "polyester-panama",
    "wool-twill",
    "polyamide-jersey",
    "polyamide-rib",
    "polyester-honeycomb",
    "wool-rib",
];
/// Models that nothing was tuned on: of those that the seventy-four have beside the shipped ones
/// every third, the first first, in the order of their file.
const FRESH: [&str; 12] = [
    "sisal-matting",
    "silk-habotai",
    "cotton-poplin",
    "polyester-lining",
    "silk-surah",
    "cotton-workwear-drill",
    "acetate-satin",
    "silk-ottoman",
    "cotton-waffle",
    "wool-jersey",
    "cotton-interlock",
    "acrylic-rib",
];

/// The corner of a relief that quick mode looks at: 10 mm, points 0.02 mm apart.
const CORNER: [usize; 4] = [0, 0, 500, 500];

/// What a cloth is made by.
pub(super) struct Recipe {
    pub(super) name: String,
    source: Source,
    /// What it is to those before it.
    pub(super) kin: Kin,
}

/// What a cloth is to what was known before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kin {
    /// Methods were tuned on it.
    Tuned,
    /// It is nearly the first cloth.
    Double,
    /// Nothing was tuned on it.
    Fresh,
}

/// A cloth with its relief.
#[derive(Debug, Clone)]
pub(super) struct Cloth {
    pub(super) name: String,
    pub(super) kin: Kin,
    pub(super) map: HeightMap,
}

/// The fine cloth first, then its doubles, then the others.
pub(super) fn recipes(effort: Effort) -> Result<Vec<Recipe>, ReportError> {
    let library = Library::shipped()?;
    let recipe = |library: &Library, id: &str, kin: Kin| {
        Ok::<_, ReportError>(Recipe {
            name: id.to_owned(),
            source: library.manifest(id)?.source,
            kin,
        })
    };
    let mut all = vec![recipe(&library, FINE, Kin::Tuned)?];
    if let Source::Weave(weave) = all[0].source.clone() {
        for number in 1..=effort.pick(1, 4) {
            let mut double: Weave = weave.as_ref().clone();
            double.weft_per_cm *= 1.03;
            double.seed += 1000 * number;
            all.push(Recipe {
                name: format!("its double {number}, picks 3 % closer"),
                source: Source::Weave(Box::new(double)),
                kin: Kin::Double,
            });
        }
    }
    for id in &TUNED_ON[..effort.pick(1, TUNED_ON.len())] {
        all.push(recipe(&library, id, Kin::Tuned)?);
    }
    let others = Library::named(Path::new("seventy-four"), None)?;
    for id in &FRESH[..effort.pick(0, FRESH.len())] {
        all.push(recipe(&others, id, Kin::Fresh)?);
    }
    Ok(all)
}

impl Recipe {
    /// The cloth, in quick mode a corner of it.
    pub(super) fn cloth(&self, effort: Effort) -> Result<Cloth, ReportError> {
        let map = textiles::relief(&self.name, &self.source)?;
        let map = match (effort, map.heights_um().part(CORNER)) {
            (Effort::Quick, Some(corner)) => {
                HeightMap::new(corner, map.step_mm()).map_err(textiles::wrong(&self.name))?
            }
            _ => map,
        };
        Ok(Cloth {
            name: self.name.clone(),
            kin: self.kin,
            map,
        })
    }
}

/// A picture of a part of a cloth, rows from the top, and the size of its pixels, mm.
pub(super) struct Photograph {
    pub(super) luminance: Grid<f64>,
    pub(super) px_mm: [f64; 2],
}

impl Cloth {
    /// Its picture under [`LIGHT`]: pixels are means of the relief's points.
    pub(super) fn photograph(&self, taking: &Taking, seed: u64) -> Photograph {
        let mut random = Random::new(seed).branch("camera").branch(&self.name);
        let mut heights_px = in_px(&self.map);
        let sides = [heights_px.width(), heights_px.height()]
            .map(|n| (n / POINTS_A_PX).min(taking.side_px));
        if taking.stretch > 0.0 {
            let side = (POINTS_A_PX * sides[0]) as f64;
            let bend = Bend::new(side, taking.stretch, &mut random.branch("bend"));
            heights_px = Grid::from_fn(heights_px.width(), heights_px.height(), |x, y| {
                between(&heights_px, bend.at([x as f64, y as f64]))
            });
        }
        let fine = picture_of(&heights_px, LIGHT);
        let seen = Grid::from_fn(sides[0], sides[1], |column, row| {
            let columns = column * POINTS_A_PX..(column + 1) * POINTS_A_PX;
            let rows = row * POINTS_A_PX..(row + 1) * POINTS_A_PX;
            let sums = rows.map(|row| fine.row(row)[columns.clone()].iter().sum::<f64>());
            let mean = sums.sum::<f64>() / (POINTS_A_PX * POINTS_A_PX) as f64;
            taking.seen(ALBEDO * mean, &mut random)
        });
        Photograph {
            luminance: seen.turned_over(),
            px_mm: self.map.step_mm().map(|mm| mm * POINTS_A_PX as f64),
        }
    }
}

/// A height between points, bilinear; the relief goes on beyond its edges as it began.
fn between(heights: &Grid<f64>, [x, y]: Place) -> f64 {
    let along = |at: f64, n: usize| {
        let at = at.rem_euclid(n as f64);
        let first = to_index(at) % n;
        (first, (first + 1) % n, at.fract())
    };
    let (i, next_i, s) = along(x, heights.width());
    let (j, next_j, t) = along(y, heights.height());
    let of_row = |row: &[f64]| row[i] + (row[next_i] - row[i]) * s;
    let [first, second] = [j, next_j].map(|row| of_row(heights.row(row)));
    first + (second - first) * t
}
