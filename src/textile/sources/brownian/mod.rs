//! Brownian surfaces: roughness without a scale of its own, described by a Hurst exponent H.
//!
//! A fractional Brownian surface rises by `E[(z(x + d) − z(x))²] ∝ |d|^{2H}` in every direction;
//! its fractal dimension is 3 − H; a profile's power falls as `ν^{−(2H+1)}`. Low H is jagged, high
//! H gently rolling. Two generators: `exact` (Stein's embedding: no repeat, no approximation) and
//! `periodic` (spectral synthesis: repeats, takes cut-offs).
//!
//! It knows nothing of spectra in time, or of files.

mod hurst;
mod stein;
mod synthesis;
#[cfg(test)]
mod tests;

pub use hurst::Hurst;

use crate::error::TextileError;
use crate::recipe::{
    Checker, Example, Group, KeySpec, Model, ParameterKind, Recipe, SurfaceSample, choice,
    defaults, keys, parameter, parameters_of, seed, source, thinned,
};
use crate::surface::{HeightMap, Probe, ProfileSet};
use selvedge_foundation::numerics::{Random, to_index};

/// Most points along a side: the embedding of 1000 takes half a gigabyte.
const MAX_POINTS: f64 = 1000.0;
/// Rounds that bring a wire's reading to the SMD asked for.
const N_ROUNDS: usize = 8;

/// The order in which a window shows what has bounds.
const FIRST: &[&str] = &[
    "generator",
    "hurst",
    "length_mm",
    "step_mm",
    "noise_um",
    "smd_um",
    "rise_um",
];

choice! {
    /// How a Brownian surface is made.
    pub enum Generator {
        /// Stein's embedding: exact for any two points of a side's length or less.
        Exact = "exact",
        /// Spectral synthesis: repeats without a seam, too smooth over few samples at low H.
        Periodic = "periodic",
    }
}

choice! {
    /// What is drawn over the surface.
    #[derive(Default)]
    pub(crate) enum Tip {
        /// A point: reads the heights as they are.
        #[default]
        Point = "point",
        /// The wire of the virtual surface tester, 5 mm wide: smooths what is finer than it.
        Wire = "wire",
    }
}

keys! {
    /// The recipe of a Brownian surface (`kind = "brownian"`).
    source Brownian {
        /// Chooses the surface.
        pub seed: u32,
        pub hurst: f64
            => "Hurst exponent" 0.01 ..= 0.99 "" "Low is jagged, high gently rolling",
        #[serde(default = "exact")]
        pub generator: Generator
            => "Generator":
            "Exact: no approximation and no repeat; periodic: repeats, takes cut-offs",
        /// Amplitude: the mean roughness SMD of the four strokes, µm. This or `rise_um`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub smd_um: Option<f64>
            => "Roughness SMD" 0.0 ..= 1000.0 "µm"
            "Amplitude: the mean roughness of the four strokes",
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub rise_um: Option<f64>
            => "Rise over 1 mm" 0.0 ..= 1000.0 "µm"
            "Amplitude: the expected rms rise between points 1 mm apart",
        /// No waves shorter than this, mm; `periodic` alone.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shortest_mm: Option<f64>,
        /// Waves longer than this are no stronger than this one, mm; `periodic` alone.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub longest_mm: Option<f64>,
        #[serde(default = "default_length_mm")]
        pub length_mm: f64
            => "Side" 5.0 ..= 50.0 "mm" "Side of the patch",
        #[serde(default = "default_step_mm")]
        pub step_mm: f64
            => "Step" 0.005 ..= 0.2 "mm" "Distance of its points: 1000 along a side are the most",
        #[serde(default)]
        pub(crate) tip: Tip
            => "Tip": "A point, or the 5 mm wide wire of the virtual tester",
        #[serde(default)]
        pub noise_um: f64
            => "Noise of the tip" 0.0 ..= 10.0 "µm" "Noise of the tip, rms",
    }
}

defaults! {
    exact: Generator = Generator::Exact;
    default_length_mm: f64 = 20.0;
    default_step_mm: f64 = 0.02;
}

impl Brownian {
    /// A recipe with this exponent and roughness, everything else as usual.
    pub fn new(hurst: f64, smd_um: f64, generator: Generator, seed: u32) -> Self {
        source!(Self = "brownian" {
            seed,
            hurst,
            generator,
            smd_um: Some(smd_um),
            rise_um: None,
            shortest_mm: None,
            longest_mm: None,
            length_mm: default_length_mm(),
            step_mm: default_step_mm(),
            tip: Tip::Point,
            noise_um: 0.0,
        })
    }

    /// Points along a side.
    fn n_points(&self) -> usize {
        let n = (self.length_mm / self.step_mm).round();
        to_index(n.clamp(2.0, MAX_POINTS))
    }

    fn check_cut_offs(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let cut_offs = [
            ("shortest_mm", self.shortest_mm, 2.0 * self.step_mm),
            ("longest_mm", self.longest_mm, 4.0 * self.step_mm),
        ];
        for (key, value, min) in cut_offs {
            let Some(value) = value else { continue };
            if self.generator == Generator::Exact {
                let what = format!("{key} with generator = \"exact\", which cuts nothing off");
                let mend = "take generator = \"periodic\" or leave the cut-off out";
                return Err(checker.wrong("source", key, what, mend));
            }
            checker.within("source", key, value, min..=self.length_mm)?;
        }
        match (self.shortest_mm, self.longest_mm) {
            (Some(shortest), Some(longest)) if shortest >= longest => {
                let what = format!("shortest_mm is {shortest}, longest_mm {longest}");
                Err(checker.wrong("source", "shortest_mm", what, "put them in order"))
            }
            _ => Ok(()),
        }
    }

    /// The surface whose expected rms rise over 1 mm is `rise_um`.
    pub fn surface(&self, rise_um: f64) -> Result<HeightMap, TextileError> {
        let n = self.n_points();
        let random = Random::new(u64::from(self.seed));
        let per_mm = 1.0 / self.length_mm;
        let (heights, scale) = match self.generator {
            Generator::Exact => {
                let heights = stein::surface(self.hurst, n, &random);
                (
                    heights,
                    rise_um * self.length_mm.powf(self.hurst) / 2.0_f64.sqrt(),
                )
            }
            Generator::Periodic => {
                let colour = synthesis::Colour {
                    hurst: self.hurst,
                    shortest: self.shortest_mm.unwrap_or(0.0) * per_mm,
                    longest: self.longest_mm.unwrap_or(self.length_mm) * per_mm,
                };
                let unit = n as f64 * per_mm;
                (synthesis::surface(&colour, n, unit, &random), rise_um)
            }
        };
        let step_mm = self.length_mm / n as f64;
        let map = HeightMap::new(heights.map(|height| height * scale), [step_mm; 2]);
        let map = map.map_err(no_surface)?;
        Ok(match self.generator {
            Generator::Exact => map,
            Generator::Periodic => map.periodic(),
        })
    }

    fn strokes(&self, map: &HeightMap) -> Result<ProfileSet, TextileError> {
        let probe = match self.tip {
            Tip::Wire => Probe::default(),
            Tip::Point => Probe {
                radius_mm: 0.0,
                width_mm: 0.0,
                ..Probe::ideal()
            },
        };
        let probe = Probe {
            noise_um: self.noise_um,
            ..probe
        };
        let random = Random::new(u64::from(self.seed)).branch("probe");
        let middle_mm = [0.5 * self.length_mm; 2];
        map.strokes(&probe, middle_mm, &random)
            .map_err(|(_, source)| no_surface(source))
    }

    /// Four strokes over the surface, with the roughness asked for and the exponent found.
    pub(crate) fn sample(&self) -> Result<SurfaceSample, TextileError> {
        let mut map = self.surface(self.rise_um.unwrap_or(1.0))?;
        let mut strokes = self.strokes(&map)?;
        if let Some(smd_um) = self.smd_um {
            for _ in 0..N_ROUNDS {
                let found = crate::surface::smd_um(&strokes);
                let factor = if found > 0.0 { smd_um / found } else { 0.0 };
                if (factor - 1.0).abs() < 1e-9 {
                    break;
                }
                map = map.scaled(factor);
                strokes = self.strokes(&map)?;
            }
        }
        let stride = (map.heights_um().width() / 200).max(1);
        let patch = thinned(&map, stride).unwrap_or_else(|| map.clone());
        let mut drawn = SurfaceSample::of_strokes(&strokes, patch);
        drawn.step_mm = map.step_mm();
        drawn.area = Some(map);
        let lines = [0, 2].map(|index| drawn.strokes_um[index].as_slice());
        if let Some(found) = Hurst::of_lines(&lines) {
            drawn.measured = vec![("hurst", found.exponent), ("hurst_error", found.error)];
        }
        Ok(drawn)
    }
}

impl Recipe for Brownian {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        let n = self.length_mm / self.step_mm;
        if n > MAX_POINTS + 0.5 {
            let what = format!("length_mm / step_mm is {n:.0} points");
            let mend = "1000 are the most: take a larger step or a shorter side";
            return Err(checker.wrong("source", "step_mm", what, mend));
        }
        match (self.smd_um, self.rise_um) {
            (Some(_), None) | (None, Some(_)) => {}
            (both, _) => {
                let key = if both.is_some() { "rise_um" } else { "kind" };
                let mend = "give exactly one of smd_um and rise_um";
                return Err(checker.wrong("source", key, "the amplitude is not clear", mend));
            }
        }
        self.check_cut_offs(checker)
    }

    fn model(&self) -> Result<Option<Box<dyn Model>>, TextileError> {
        Ok(Some(Box::new(self.sample()?)))
    }

    fn groups() -> Vec<Group> {
        let cut_off = |key, name, what| {
            let kind = ParameterKind::Optional {
                min: 0.01,
                max: 50.0,
                unit: "mm",
                instead_of: "",
            };
            parameter(key, (name, what), kind)
        };
        let mut parameters = parameters_of("source", Self::KEYS, FIRST);
        for parameter in &mut parameters {
            if let ParameterKind::Optional { instead_of, .. } = &mut parameter.kind {
                *instead_of = match parameter.place.key {
                    "smd_um" => "rise_um",
                    _ => "smd_um",
                };
            }
        }
        let tip = parameters.split_off(FIRST.len());
        parameters.extend([
            cut_off(
                "shortest_mm",
                "Shortest wave",
                "No waves shorter than this; periodic alone",
            ),
            cut_off(
                "longest_mm",
                "Longest wave",
                "Waves longer than this are no stronger than this one; periodic alone",
            ),
        ]);
        parameters.extend(tip);
        parameters.push(seed());
        vec![Group::new("Surface", parameters)]
    }

    fn example() -> Result<Option<Example<Self>>, TextileError> {
        // Coarser than is usual and without the costly embedding: what is edited should be seen at
        // once.
        let recipe = Self {
            step_mm: 0.05,
            ..Self::new(0.5, 6.0, Generator::Periodic, 1)
        };
        Ok(Some(Example::Own {
            name: "Brownian surface",
            like: None,
            recipe,
        }))
    }
}

fn no_surface(source: crate::surface::SurfaceError) -> TextileError {
    TextileError::surface("the Brownian surface")(source)
}
