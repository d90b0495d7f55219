//! Fourier templates: textile by the statistics of its harmonics [Wall & Harwin 1999].
//!
//! Several profiles of a material give mean and standard deviation of the coefficients of each
//! harmonic; new profiles are drawn from them, so no two patches are alike and none is a copy.
//! Beyond the fundamental length the surface is mirrored. `template.rs` says how the paper is read
//! where it can be read in several ways.

mod readings;
mod series;
mod template;
#[cfg(test)]
mod tests;

pub use readings::ImportedProfile;
pub use readings::{Readings, import};
pub use series::FourierSeries;
pub use template::FourierTemplate;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::{
    Checker, Example, Group, KeySpec, Model, Recipe, SurfaceSample, choice, defaults, keys,
    parameters_of, seed, source,
};
use crate::surface::HeightMap;
use selvedge_foundation::files::{FileError, keys_from_str, keys_to_string, line_of_key};
use selvedge_foundation::numerics::{Random, to_index};

/// The five templates that are part of the program: invented, see the file.
const EXAMPLES: &str = include_str!("../../../../textiles/fourier-templates.toml");
/// Distance of the picture's points, mm.
const PICTURE_STEP_MM: f64 = 0.4;
/// Points of the surface to the shortest wave, as a stylus feels it: at best, and at least.
const POINTS_PER_WAVE: [f64; 2] = [8.0, 4.0];
/// Most points of that along a side.
const MAX_POINTS: f64 = 2000.0;

choice! {
    /// How two profiles become a surface.
    #[derive(Default)]
    pub(crate) enum Composition {
        /// A coefficient of its own for every pair of harmonics: no preferred lines.
        #[default]
        Independent = "independent",
        /// The product of two profiles, divided by the root of their rms: as the paper describes
        /// it.
        Product = "product",
    }
}

choice! {
    /// How the paper's sum is read.
    #[derive(Default)]
    pub enum Reading {
        /// `a_n cos + b_n sin` with 2/N.
        #[default]
        Corrected = "corrected",
        /// As printed: `a_n` in both sums and 1/N. Every harmonic stands at 45°, so the variance
        /// changes from place to place, and heights are half as large.
        Literal = "literal",
    }
}

keys! {
    /// The recipe of a surface drawn from a Fourier template (`kind = "fourier"`).
    source Fourier {
        /// Chooses what is drawn.
        pub(crate) seed: u32,
        #[serde(default)]
        pub(crate) composition: Composition
            => "Composition": "How two profiles become a surface",
        #[serde(default)]
        pub(crate) reading: Reading
            => "Reading": "The printed sum as corrected, or to the letter (with product)",
        #[serde(default = "default_lowest_per_m")]
        pub(crate) lowest_per_m: f64
            => "From" 0.0 ..= 1e5 "/m" "Harmonics below this are left out, cycles per metre",
        #[serde(default = "default_highest_per_m")]
        pub(crate) highest_per_m: f64
            => "To" 0.0 ..= 1e5 "/m" "Harmonics above this are left out, cycles per metre",
        #[serde(default = "default_length_mm")]
        pub(crate) length_mm: f64
            => "Mirrored beyond" 5.0 ..= 100.0 "mm" "Beyond this the surface is mirrored",
        #[serde(default = "default_step_mm")]
        pub(crate) step_mm: f64
            => "Step" 0.004 ..= 0.5 "mm" "Distance of the samples",
        /// The material along the warp.
        pub(crate) template: FourierTemplate
            => "Template": "Mean and spread of the coefficients of each harmonic",
        /// The material along the weft; the warp's if it is left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub(crate) weft_template: Option<FourierTemplate>
            => "Template": "Mean and spread of the coefficients of each harmonic",
    }
}

defaults! {
    default_lowest_per_m: f64 = 100.0;
    default_highest_per_m: f64 = 1000.0;
    default_length_mm: f64 = 50.0;
    default_step_mm: f64 = 0.05;
}

impl Fourier {
    /// The recipe of a template, everything else as usual.
    pub(crate) fn new(template: FourierTemplate, seed: u32) -> Self {
        source!(Self = "fourier" {
            seed,
            composition: Composition::default(),
            reading: Reading::default(),
            lowest_per_m: default_lowest_per_m(),
            highest_per_m: default_highest_per_m(),
            length_mm: default_length_mm(),
            step_mm: default_step_mm(),
            template,
            weft_template: None,
        })
    }

    fn templates(&self) -> [&FourierTemplate; 2] {
        let weft = self.weft_template.as_ref();
        [&self.template, weft.unwrap_or(&self.template)]
    }

    fn band_per_m(&self) -> [f64; 2] {
        [self.lowest_per_m, self.highest_per_m]
    }

    /// Four strokes over the surface and back from its mirror image, and a patch of it.
    pub(crate) fn sample(&self) -> Result<SurfaceSample, TextileError> {
        let random = Random::new(u64::from(self.seed));
        let how = (self.composition, self.reading);
        let plane = series::Plane::draw(self.templates(), self.band_per_m(), how, &random);
        let n = |step_mm: f64| to_index((2.0 * self.length_mm / step_mm).round());
        let line = |step_mm: f64| -> Vec<f64> {
            let at = |i: usize| mirrored(i as f64 * step_mm, self.length_mm);
            (0..n(step_mm)).map(at).collect()
        };
        let places = line(self.step_mm);
        let middle = [0.5 * self.length_mm];
        let warp = plane.heights_um(&places, &middle).values().to_vec();
        let weft = plane.heights_um(&middle, &places).values().to_vec();
        let places = line(PICTURE_STEP_MM);
        let patch = HeightMap::new(plane.heights_um(&places, &places), [PICTURE_STEP_MM; 2]);
        let patch = patch.map_err(TextileError::surface("the drawn surface"))?;
        Ok(SurfaceSample {
            area: self.area(&plane),
            ..SurfaceSample::of_lines([warp, weft], self.step_mm, patch)
        })
    }

    /// The surface there and back both ways; `None` where its waves are too short for its size.
    fn area(&self, plane: &series::Plane) -> Option<HeightMap> {
        let side_mm = 2.0 * self.length_mm;
        let n_waves = side_mm * self.highest_per_m / 1000.0;
        let [most, least] = POINTS_PER_WAVE.map(|points| points * n_waves);
        let n = most.clamp(side_mm / PICTURE_STEP_MM, MAX_POINTS).round();
        (least <= n).then_some(())?;
        let step_mm = side_mm / n;
        let at = |i: usize| mirrored(i as f64 * step_mm, self.length_mm);
        let places: Vec<f64> = (0..to_index(n)).map(at).collect();
        let map = HeightMap::new(plane.heights_um(&places, &places), [step_mm; 2]);
        Some(map.ok()?.periodic())
    }
}

impl Recipe for Fourier {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let within = |key, value, range| checker.within("source", key, value, range);
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        within("highest_per_m", self.highest_per_m, self.lowest_per_m..=1e5)?;
        let max_per_m = 500.0 / self.step_mm;
        if self.highest_per_m > max_per_m {
            let what = format!("highest_per_m is {}", self.highest_per_m);
            let mend = format!("samples step_mm apart show {max_per_m:.0} at most");
            return Err(checker.wrong("source", "highest_per_m", what, mend));
        }
        for (template, table) in self
            .templates()
            .into_iter()
            .zip(["source.template", "source.weft_template"])
        {
            if let Some((key, what, mend)) = template.fault() {
                return Err(checker.wrong(table, key, what, mend));
            }
            if template.harmonics(self.band_per_m()).is_empty() {
                let what = format!("no harmonic of \"{}\" lies in the band", template.name);
                let mend = "widen lowest_per_m … highest_per_m";
                return Err(checker.wrong("source", "lowest_per_m", what, mend));
            }
        }
        if (self.composition, self.reading) == (Composition::Independent, Reading::Literal) {
            let what = "reading = \"literal\" with composition = \"independent\"";
            let mend = "the printed sum has no pairs of harmonics: take composition = \"product\"";
            return Err(checker.wrong("source", "reading", what, mend));
        }
        Ok(())
    }

    fn model(&self) -> Result<Option<Box<dyn Model>>, TextileError> {
        Ok(Some(Box::new(self.sample()?)))
    }

    fn groups() -> Vec<Group> {
        let first = &["composition", "reading", "length_mm", "step_mm"];
        let mut surface = parameters_of("source", Self::KEYS, first);
        let templates = surface.split_off(surface.len() - 2);
        surface.push(seed());
        let of_axis = |((title, table), template)| {
            let mut parameters = vec![template];
            parameters.extend(parameters_of(table, FourierTemplate::KEYS, &[]));
            Group { title, parameters }
        };
        let axes = [
            ("Along the warp", "source.template"),
            ("Along the weft", "source.weft_template"),
        ];
        let axes = axes.into_iter().zip(templates);
        let mut groups = vec![Group::new("Surface", surface)];
        groups.extend(axes.map(of_axis));
        groups
    }

    fn example() -> Result<Option<Example<Self>>, TextileError> {
        let templates = FourierTemplate::examples()?;
        let none = || TextileError::Model("there is no example of a template".to_owned());
        let template = templates.into_iter().next().ok_or_else(none)?;
        Ok(Some(Example::Own {
            name: "Fourier surface",
            like: None,
            recipe: Self::new(template, 1),
        }))
    }
}

/// The place within 0 … `length_mm` that stands for any place: there and back.
fn mirrored(x_mm: f64, length_mm: f64) -> f64 {
    let folded = x_mm.rem_euclid(2.0 * length_mm);
    folded.min(2.0 * length_mm - folded)
}

/// A file of templates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TemplateFile {
    template: Vec<FourierTemplate>,
}

impl FourierTemplate {
    /// Reads a file of templates. `path` only names it in errors.
    pub fn list_from_toml(text: &str, path: &Path) -> Result<Vec<Self>, TextileError> {
        let file: TemplateFile = keys_from_str(text, path)?;
        for (nth, template) in file.template.iter().enumerate() {
            if let Some((key, what, mend)) = template.fault() {
                let line = line_of_key(text, "template", nth, key);
                return Err(FileError::content(path, line, what, mend).into());
            }
        }
        Ok(file.template)
    }

    /// Templates as a file.
    pub fn list_to_toml(templates: &[Self], path: &Path) -> Result<String, TextileError> {
        let template = templates.to_vec();
        Ok(keys_to_string(&TemplateFile { template }, path)?)
    }

    /// The five templates that are part of the program. They are invented: smooth spectra with a
    /// peak, scaled to the range of standard deviations that Wall & Harwin print, not measured on
    /// textile.
    pub fn examples() -> Result<Vec<Self>, TextileError> {
        Self::list_from_toml(EXAMPLES, Path::new("the example templates"))
    }
}
