//! Correlation and restoration: a textile from one warp and one weft profile, by what repeats in
//! them [after Huang, Metaxas & Govindaraj 2003; the steps are ours, theirs are not published in
//! what could be read].
//!
//! Autocorrelation finds the period in noise; the strongest harmonics of it and the spectrum of
//! the rest are kept; from these the profile is restored to any length, as rough as it was; two
//! profiles are composed to a surface by one of four rules.

mod period;
mod reduced;
#[cfg(test)]
mod tests;

pub use reduced::Reduced;

use crate::error::TextileError;
use crate::recipe::{
    Checker, Example, Group, KeySpec, Model, Recipe, SurfaceSample, choice, defaults, keys,
    parameters_of, seed, source,
};
use crate::shipped;
use crate::surface::{Direction, HeightMap, Profile};
use selvedge_foundation::numerics::{Grid, Random, to_index};

/// The shipped textile that the example restores.
const LIKE: &str = "polyester-panama";
/// Most harmonics that are kept of a profile that is restored.
const N_HARMONICS: usize = 12;
/// Distance of the picture's points, mm.
const PICTURE_STEP_MM: f64 = 0.1;

choice! {
    /// How a warp and a weft profile become a surface.
    #[derive(Default)]
    pub(crate) enum Rule {
        /// `z_warp(x) + z_weft(y)`: the only rule by which a stroke reads the profile it came from.
        #[default]
        Additive = "additive",
        /// `z_warp(x)·z_weft(y)`, divided by the root of both rms: as a weave's relief multiplies.
        Product = "product",
        /// The higher of the two: yarns that hide what lies below.
        Max = "max",
        /// A chequerboard of half periods: warp profile and weft profile take turns on top.
        Gated = "gated",
    }
}

keys! {
    /// The recipe of a restored surface (`kind = "restoration"`).
    source Restoration {
        /// Chooses the noise.
        pub(crate) seed: u32,
        #[serde(default)]
        pub(crate) composition: Rule
            => "Composition": "How a warp and a weft profile become a surface",
        #[serde(default = "yes")]
        pub(crate) residual: bool
            => "Residual": "Whether noise with the spectrum of the residual is added",
        #[serde(default = "default_length_mm")]
        pub(crate) length_mm: f64
            => "Side" 5.0 ..= 100.0 "mm" "Side of the patch",
        #[serde(default = "default_step_mm")]
        pub(crate) step_mm: f64
            => "Step" 0.002 ..= 0.1 "mm" "Distance of the samples",
        /// What was kept of the warp profile.
        pub(crate) warp: Reduced,
        /// What was kept of the weft profile; the warp's if it is left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub(crate) weft: Option<Reduced>,
    }
}

defaults! {
    yes: bool = true;
    default_length_mm: f64 = 20.0;
    default_step_mm: f64 = 1.0 / 230.0;
}

impl Restoration {
    /// The recipe of reduced profiles, everything else as usual.
    pub(crate) fn new(warp: Reduced, weft: Option<Reduced>, composition: Rule, seed: u32) -> Self {
        source!(Self = "restoration" {
            seed,
            composition,
            residual: true,
            length_mm: default_length_mm(),
            step_mm: default_step_mm(),
            warp,
            weft,
        })
    }

    /// The recipe that restores a warp and a weft profile: what repeats in them and the spectrum of
    /// the rest.
    ///
    /// # Errors
    /// A profile that is too short.
    pub(crate) fn of_profiles(
        warp: &Profile,
        weft: Option<&Profile>,
    ) -> Result<Self, TextileError> {
        let reduced = |profile| Reduced::of(profile, N_HARMONICS);
        Ok(Self::new(
            reduced(warp)?,
            weft.map(reduced).transpose()?,
            Rule::Additive,
            1,
        ))
    }

    fn of_axis(&self, is_weft: bool) -> &Reduced {
        let weft = self.weft.as_ref().filter(|_| is_weft);
        weft.unwrap_or(&self.warp)
    }

    fn n_samples(&self) -> usize {
        to_index((self.length_mm / self.step_mm).round())
    }

    /// The restored profiles of warp and weft, µm.
    pub(crate) fn profiles_um(&self) -> [Vec<f64>; 2] {
        let random = Random::new(u64::from(self.seed));
        let n = self.n_samples();
        [(false, "warp"), (true, "weft")].map(|(is_weft, name)| {
            let reduced = self.of_axis(is_weft);
            if self.residual {
                reduced.restored_um(n, self.step_mm, &mut random.branch(name))
            } else {
                reduced.waves_um(n, self.step_mm)
            }
        })
    }

    /// Four strokes over the composed surface, and a patch of it.
    pub(crate) fn sample(&self) -> Result<SurfaceSample, TextileError> {
        let [warp, weft] = self.profiles_um();
        let n = self.n_samples();
        let all: Vec<usize> = (0..n).collect();
        let middle = [n / 2];
        let compose = |u: &[usize], w: &[usize]| self.composed_um([&warp, &weft], [u, w]);
        let lines = [compose(&all, &middle), compose(&middle, &all)];
        let stride = to_index((PICTURE_STEP_MM / self.step_mm).round()).max(1);
        let few: Vec<usize> = (0..n).step_by(stride).collect();
        let step_mm = [self.step_mm * stride as f64; 2];
        let patch = HeightMap::new(compose(&few, &few), step_mm);
        let patch = patch.map_err(TextileError::surface("the restored surface"))?;
        let lines = lines.map(|line| line.values().to_vec());
        Ok(SurfaceSample::of_lines(lines, self.step_mm, patch))
    }

    /// The composed surface at samples of the two profiles, µm: a row for every one along the
    /// weft, columns along the warp.
    pub(crate) fn composed_um(&self, profiles: [&[f64]; 2], samples: [&[usize]; 2]) -> Grid<f64> {
        let rms = |z: &[f64]| {
            let squares: f64 = z.iter().map(|z| z * z).sum();
            (squares / z.len().max(1) as f64).sqrt()
        };
        let norm = (rms(profiles[0]) * rms(profiles[1])).sqrt();
        let half = |is_weft: bool, i: usize| {
            let period_mm = self.of_axis(is_weft).period_mm.unwrap_or(2.0);
            (2.0 * i as f64 * self.step_mm / period_mm).floor()
        };
        Grid::from_fn(samples[0].len(), samples[1].len(), |column, row| {
            let (i, j) = (samples[0][column], samples[1][row]);
            let (a, b) = (profiles[0][i], profiles[1][j]);
            match self.composition {
                Rule::Additive => a + b,
                Rule::Product if norm > 0.0 => a * b / norm,
                Rule::Product => 0.0,
                Rule::Max => a.max(b),
                Rule::Gated => {
                    let is_warp = (half(false, i) + half(true, j)).rem_euclid(2.0) < 0.5;
                    if is_warp { a } else { b }
                }
            }
        })
    }
}

impl Recipe for Restoration {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, "source"))?;
        for (is_weft, table) in [(false, "source.warp"), (true, "source.weft")] {
            if let Some((key, what, mend)) = self.of_axis(is_weft).fault() {
                return Err(checker.wrong(table, key, what, mend));
            }
        }
        Ok(())
    }

    fn model(&self) -> Result<Option<Box<dyn Model>>, TextileError> {
        Ok(Some(Box::new(self.sample()?)))
    }

    fn groups() -> Vec<Group> {
        let mut surface = parameters_of("source", Self::KEYS, &[]);
        surface.push(seed());
        vec![
            Group::new("Surface", surface),
            Reduced::group("source.warp", "Warp profile"),
            Reduced::group("source.weft", "Weft profile"),
        ]
    }

    fn example() -> Result<Option<Example<Self>>, TextileError> {
        let profile = |direction| shipped::profile(LIKE, direction);
        let (warp, weft) = (
            profile(Direction::WarpForward)?,
            profile(Direction::WeftForward)?,
        );
        Ok(Some(Example::Own {
            name: "Restored panama",
            like: Some(LIKE),
            recipe: Self::of_profiles(&warp, Some(&weft))?,
        }))
    }
}
