//! Model cloths whose relief is known, from fine to coarse, and their pictures.

use crate::shading::reliefs::in_px;
use crate::{Effort, ReportError, textiles};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::shading::{Light, picture_of};
use selvedge_textile::surface::HeightMap;
use selvedge_textile::{Lamp, Library, Source, Weave};

/// Where the light comes from: along neither yarn.
pub(super) const LIGHT: Light = Light {
    slant_deg: 45.0,
    tilt_deg: 30.0,
};
/// Share of white that faces the light.
const ALBEDO: f64 = 0.8;

/// How a picture is taken, and what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taking {
    /// Pixels a side at most, each of so many points of the relief each way.
    pub(super) side_px: usize,
    pub(super) points_a_px: usize,
    /// Noise of the camera, share of white.
    pub(super) noise: f64,
    /// Bits a pixel.
    pub(super) bits: i32,
    /// The lamp as it is told.
    pub(super) lamp: Lamp,
}

impl Taking {
    /// Under a lamp that is told right, with little noise.
    pub(super) const PLAIN: Self = Self {
        side_px: 300,
        points_a_px: 2,
        noise: 0.01,
        bits: 16,
        lamp: Lamp::Known {
            light: LIGHT,
            within_deg: Lamp::WITHIN_DEG,
        },
    };

    /// In words.
    pub(super) fn name(&self) -> String {
        let light = match self.lamp {
            Lamp::Unknown | Lamp::Turned { .. } => "light unknown",
            Lamp::Known { light, .. } if light == LIGHT => "light known",
            Lamp::Known { .. } => "light 15° off",
        };
        let (per_mm, bits, percent) = (50 / self.points_a_px, self.bits, 100.0 * self.noise);
        format!("{per_mm} px/mm, {light}, {bits} bits, noise {percent} %")
    }
}

/// The fine cloth that has a double.
const FINE: &str = "polyamide-taffeta";
/// Models of the shipped library beside it, fine to coarse.
const IDS: [&str; 11] = [
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

/// The corner of a relief that quick mode looks at: 10 mm, points 0.02 mm apart.
const CORNER: [usize; 4] = [0, 0, 500, 500];

/// A cloth with its relief.
#[derive(Debug, Clone)]
pub(super) struct Cloth {
    pub(super) name: String,
    pub(super) map: HeightMap,
    /// Whether it is nearly the first cloth.
    pub(super) is_double: bool,
}

/// The fine cloth first, then its doubles, then the others.
pub(super) fn cloths(effort: Effort) -> Result<Vec<Cloth>, ReportError> {
    let library = Library::shipped()?;
    let mut cloths = Vec::new();
    if let Source::Weave(weave) = library.manifest(FINE)?.source {
        cloths.push(of(FINE, &Source::Weave(weave.clone()), effort)?);
        for number in 1..=effort.pick(1, 4) {
            let mut double: Weave = weave.as_ref().clone();
            double.weft_per_cm *= 1.03;
            double.seed += 1000 * number;
            let name = format!("its double {number}, picks 3 % closer");
            let double = of(&name, &Source::Weave(Box::new(double)), effort)?;
            cloths.push(Cloth {
                is_double: true,
                ..double
            });
        }
    }
    for id in IDS.iter().take(effort.pick(1, IDS.len())) {
        cloths.push(of(id, &library.manifest(id)?.source, effort)?);
    }
    Ok(cloths)
}

/// The relief of a model, in quick mode a corner of it.
fn of(name: &str, source: &Source, effort: Effort) -> Result<Cloth, ReportError> {
    let map = textiles::relief(name, source)?;
    let map = match (effort, map.heights_um().part(CORNER)) {
        (Effort::Quick, Some(corner)) => {
            HeightMap::new(corner, map.step_mm()).map_err(textiles::wrong(name))?
        }
        _ => map,
    };
    Ok(Cloth {
        name: name.to_owned(),
        map,
        is_double: false,
    })
}

/// A picture of a part of a cloth, rows as heights have them, and the size of its pixels, mm.
pub(super) struct Photograph {
    pub(super) luminance: Grid<f64>,
    pub(super) px_mm: [f64; 2],
}

impl Cloth {
    /// Its picture under [`LIGHT`]: pixels are means of the relief's points.
    pub(super) fn photograph(&self, taking: &Taking, seed: u64) -> Photograph {
        let Taking {
            side_px,
            points_a_px,
            noise,
            bits,
            ..
        } = *taking;
        let steps = 2.0_f64.powi(bits) - 1.0;
        let step_mm = self.map.step_mm();
        let fine = picture_of(&in_px(&self.map), LIGHT);
        let sides = [fine.width(), fine.height()].map(|n| (n / points_a_px).min(side_px));
        let mut random = Random::new(seed).branch("camera").branch(&self.name);
        let mut luminance = Grid::filled(sides[0], sides[1], 0.0);
        for row in 0..sides[1] {
            for (column, value) in luminance.row_mut(row).iter_mut().enumerate() {
                let columns = column * points_a_px..(column + 1) * points_a_px;
                let rows = row * points_a_px..(row + 1) * points_a_px;
                let sums = rows.map(|row| fine.row(row)[columns.clone()].iter().sum::<f64>());
                let mean = sums.sum::<f64>() / (points_a_px * points_a_px) as f64;
                let seen = (ALBEDO * mean + noise * random.normal()).clamp(0.0, 1.0);
                *value = (seen * steps).round() / steps;
            }
        }
        Photograph {
            luminance,
            px_mm: step_mm.map(|mm| mm * points_a_px as f64),
        }
    }
}
