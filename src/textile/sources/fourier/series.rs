//! Drawing from a template: new profiles, and surfaces of two kinds.

use std::f64::consts::TAU;

use super::template::FourierTemplate;
use super::{Composition, Reading};
use selvedge_foundation::numerics::{Grid, Random};

/// A harmonic that was drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wave {
    per_mm: f64,
    cos_um: f64,
    sin_um: f64,
}

/// A profile that was drawn: a sum of harmonics.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierSeries {
    waves: Vec<Wave>,
}

impl FourierSeries {
    /// Draws the coefficients within a band of cycles a metre. Those outside are drawn too and
    /// thrown away: the band changes no other harmonic.
    pub fn draw(
        template: &FourierTemplate,
        band_per_m: [f64; 2],
        reading: Reading,
        random: &mut Random,
    ) -> Self {
        let kept = template.harmonics(band_per_m);
        let mut waves = Vec::with_capacity(kept.len());
        for n in 1..=template.mean_cos_um.len() {
            let i = n - 1;
            let a = template.mean_cos_um[i] + template.sd_cos_um[i] * random.normal();
            let b = template.mean_sin_um[i] + template.sd_sin_um[i] * random.normal();
            let (cos_um, sin_um) = match reading {
                Reading::Corrected => (a, b),
                // As printed: a_n in both sums, 1/N with a one-sided sum.
                Reading::Literal => (0.5 * a, 0.5 * a),
            };
            if kept.binary_search(&n).is_ok() {
                let per_mm = template.per_mm(n);
                waves.push(Wave {
                    per_mm,
                    cos_um,
                    sin_um,
                });
            }
        }
        Self { waves }
    }

    /// The height at a place, µm.
    pub fn height_um(&self, x_mm: f64) -> f64 {
        let part = |wave: &Wave| {
            let (sin, cos) = (TAU * wave.per_mm * x_mm).sin_cos();
            wave.cos_um * cos + wave.sin_um * sin
        };
        self.waves.iter().map(part).sum()
    }

    fn rms_um(&self) -> f64 {
        let square = |wave: &Wave| 0.5 * (wave.cos_um.powi(2) + wave.sin_um.powi(2));
        self.waves.iter().map(square).sum::<f64>().sqrt()
    }
}

/// A surface that was drawn.
#[derive(Debug, Clone)]
pub(super) enum Plane {
    /// `f(x, y) = Σ_n Σ_m` of all four products of cosines and sines, coefficients independent.
    Independent {
        per_mm: [Vec<f64>; 2],
        /// Row 2i, 2i + 1: cosine and sine of the i-th harmonic along the warp; columns likewise
        /// for the weft. µm.
        coefficients_um: Grid<f64>,
    },
    /// `f(x, y) = g(x) h(y) / √(rms g · rms h)`: heights stay µm, but vanish along lines.
    Product(FourierSeries, FourierSeries),
}

impl Plane {
    /// Draws a surface from the templates of warp and weft.
    pub(super) fn draw(
        [warp, weft]: [&FourierTemplate; 2],
        band_per_m: [f64; 2],
        (composition, reading): (Composition, Reading),
        random: &Random,
    ) -> Self {
        match composition {
            Composition::Independent => {
                Self::independent([warp, weft], band_per_m, &mut random.branch("plane"))
            }
            Composition::Product => {
                let draw = |template, name| {
                    FourierSeries::draw(template, band_per_m, reading, &mut random.branch(name))
                };
                Self::Product(draw(warp, "warp"), draw(weft, "weft"))
            }
        }
    }

    /// Each product has the variance `p_n q_m / √(Σp Σq)`: a line along the warp has the warp
    /// template's spectrum, one along the weft the weft's, both scaled to one total variance (that
    /// of a stationary surface is the same along every line).
    fn independent(
        templates: [&FourierTemplate; 2],
        band_per_m: [f64; 2],
        random: &mut Random,
    ) -> Self {
        let harmonics = templates.map(|template| template.harmonics(band_per_m));
        let powers = [0, 1].map(|axis| -> Vec<f64> {
            let power = |&n: &usize| templates[axis].variance_um2(n);
            harmonics[axis].iter().map(power).collect()
        });
        let total = powers.each_ref().map(|powers| powers.iter().sum::<f64>());
        let norm = (total[0] * total[1]).sqrt();
        let [n_rows, n_columns] = harmonics.each_ref().map(|list| 2 * list.len());
        let mut coefficients_um = Grid::filled(n_columns.max(1), n_rows, 0.0);
        for row in 0..n_rows {
            for column in 0..n_columns {
                let variance = powers[0][row / 2] * powers[1][column / 2] / norm;
                let sd = if norm > 0.0 { variance.sqrt() } else { 0.0 };
                coefficients_um.row_mut(row)[column] = sd * random.normal();
            }
        }
        let per_mm = [0, 1].map(|axis| {
            let of = |&n: &usize| templates[axis].per_mm(n);
            harmonics[axis].iter().map(of).collect()
        });
        Self::Independent {
            per_mm,
            coefficients_um,
        }
    }

    /// Heights at all pairs of places, µm: a row for every `w_mm`, columns by `u_mm`.
    pub(super) fn heights_um(&self, u_mm: &[f64], w_mm: &[f64]) -> Grid<f64> {
        let mut heights = Grid::filled(u_mm.len(), w_mm.len(), 0.0);
        match self {
            Self::Product(g, h) => {
                let norm = (g.rms_um() * h.rms_um()).sqrt();
                let scale = if norm > 0.0 { 1.0 / norm } else { 0.0 };
                let along: Vec<f64> = u_mm.iter().map(|&u| g.height_um(u) * scale).collect();
                for (row, &w) in w_mm.iter().enumerate() {
                    let across = h.height_um(w);
                    let pairs = heights.row_mut(row).iter_mut().zip(&along);
                    pairs.for_each(|(height, along)| *height = along * across);
                }
            }
            Self::Independent {
                per_mm,
                coefficients_um,
            } => {
                let along: Vec<Vec<f64>> = u_mm.iter().map(|&u| basis(&per_mm[0], u)).collect();
                for (row, &w) in w_mm.iter().enumerate() {
                    let across = basis(&per_mm[1], w);
                    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum();
                    let sums: Vec<f64> = (0..coefficients_um.height())
                        .map(|k| dot(coefficients_um.row(k), &across))
                        .collect();
                    let pairs = heights.row_mut(row).iter_mut().zip(&along);
                    pairs.for_each(|(height, along)| *height = dot(&sums, along));
                }
            }
        }
        heights
    }
}

/// Cosine and sine of every harmonic at a place.
fn basis(per_mm: &[f64], x_mm: f64) -> Vec<f64> {
    let pair = |per_mm: &f64| {
        let (sin, cos) = (TAU * per_mm * x_mm).sin_cos();
        [cos, sin]
    };
    per_mm.iter().flat_map(pair).collect()
}
