//! Brownian surfaces without approximation: Stein's intrinsic embedding (Stein 2002, "Fast and
//! exact simulation of fractional Brownian surfaces"; Kroese & Botev 2015).
//!
//! Isotropic covariance that is compact, made periodic, coloured by its transform, is exact over
//! distances up to 1; it lacks `2 c₂ r²` of the variance of rises, which a **random plane** gives:
//! `√(2c₂)(x N₁ + y N₂)`. (A widely copied program adds the product of two random ramps instead,
//! which gives no such rise: its surfaces are too smooth at large distances.)

use selvedge_foundation::numerics::{Grid, PlaneTransform, Random};

/// Above this exponent 2H the covariance needs twice the reach to be one.
const WIDE_FROM: f64 = 1.5;

/// The compact covariance of Stein's embedding for `α = 2H`, over distances in units of the side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Embedding {
    alpha: f64,
    beta: f64,
    c0: f64,
    /// Half the variance of either slope of the plane.
    pub(super) c2: f64,
    /// Beyond this distance nothing is correlated.
    pub(super) reach: f64,
}

impl Embedding {
    /// The covariance for a Hurst exponent in (0, 1).
    pub(super) fn new(hurst: f64) -> Self {
        let alpha = 2.0 * hurst;
        if alpha <= WIDE_FROM {
            let c2 = 0.5 * alpha;
            return Self {
                alpha,
                beta: 0.0,
                c0: 1.0 - c2,
                c2,
                reach: 1.0,
            };
        }
        let reach: f64 = 2.0;
        let beta = alpha * (2.0 - alpha) / (3.0 * reach * (reach * reach - 1.0));
        let c2 = 0.5 * (alpha - beta * (reach - 1.0).powi(2) * (reach + 2.0));
        let c0 = beta * (reach - 1.0).powi(3) + 1.0 - c2;
        Self {
            alpha,
            beta,
            c0,
            c2,
            reach,
        }
    }

    /// Covariance at a distance ≥ 0.
    pub(super) fn covariance(&self, r: f64) -> f64 {
        if r <= 1.0 {
            self.c0 - r.powf(self.alpha) + self.c2 * r * r
        } else if r <= self.reach {
            self.beta * (self.reach - r).powi(3) / r
        } else {
            0.0
        }
    }

    /// Points along a side of the periodic grid for `n` along the side of the patch.
    fn n_embedded(&self, n: usize) -> usize {
        if self.reach > 1.0 { 4 * n } else { 2 * n }
    }

    /// The covariance over the periodic grid, point (0, 0) at distance 0.
    fn grid(&self, n: usize) -> Grid<f64> {
        let n_embedded = self.n_embedded(n);
        let away = |i: usize| i.min(n_embedded - i) as f64 / n as f64;
        Grid::from_fn(n_embedded, n_embedded, |column, row| {
            self.covariance(away(column).hypot(away(row)))
        })
    }
}

/// A Brownian surface over `n` × `n` points of a unit square, 0 at its corner:
/// `E[(z(a) − z(b))²] = 2 |a − b|^{2H}` for all points at most 1 apart.
pub(super) fn surface(hurst: f64, n: usize, random: &Random) -> Grid<f64> {
    let embedding = Embedding::new(hurst);
    let n_embedded = embedding.n_embedded(n);
    let transform = PlaneTransform::new(n_embedded, n_embedded);
    let powers = transform.forward(&embedding.grid(n));
    let mut noise = random.branch("surface");
    let white = Grid::from_fn(n_embedded, n_embedded, |_, _| noise.normal());
    let mut spectrum = transform.forward(&white);
    for (x, power) in spectrum.values_mut().iter_mut().zip(powers.values()) {
        // Rounding may leave the least powers just below 0.
        *x *= power.re.max(0.0).sqrt();
    }
    let whole = transform.inverse(spectrum);
    let mut plane = random.branch("plane");
    let slopes =
        [plane.normal(), plane.normal()].map(|x| x * (2.0 * embedding.c2).sqrt() / n as f64);
    let corner = whole.row(0)[0];
    Grid::from_fn(n, n, |column, row| {
        let rise = slopes[1] * row as f64 - corner;
        whole.row(row)[column] + rise + slopes[0] * column as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_covariance_with_its_plane_has_brownian_rises() {
        for hurst in [0.01, 0.2, 0.5, 0.75, 0.8, 0.99] {
            let embedding = Embedding::new(hurst);
            for r in [0.001_f64, 0.1, 0.7, 1.0] {
                let rise = 2.0 * (embedding.covariance(0.0) - embedding.covariance(r));
                let whole = rise + 2.0 * embedding.c2 * r * r;
                let brownian = 2.0 * r.powf(2.0 * hurst);
                assert!(
                    (whole - brownian).abs() < 1e-12,
                    "H {hurst}, r {r}: {whole}"
                );
            }
            let [inside, outside] = [1.0 - 1e-9, 1.0 + 1e-9].map(|r| embedding.covariance(r));
            assert!((inside - outside).abs() < 1e-7, "H {hurst}: a jump at 1");
            assert!(
                embedding.covariance(embedding.reach).abs() < 1e-12,
                "H {hurst}"
            );
        }
    }

    #[test]
    fn the_embedding_has_no_negative_power() {
        for hurst in [0.01, 0.2, 0.5, 0.74, 0.75, 0.76, 0.9, 0.99] {
            let n = 32;
            let embedding = Embedding::new(hurst);
            let n_embedded = embedding.n_embedded(n);
            let powers = PlaneTransform::new(n_embedded, n_embedded).forward(&embedding.grid(n));
            let real = powers.values().iter().map(|x| x.re);
            let (min, max) = real.fold((f64::MAX, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
            assert!(min > -1e-9 * max, "H {hurst}: {min} of {max}");
        }
    }

    #[test]
    fn rises_over_many_surfaces_have_the_variance_of_the_closed_form() {
        let n = 32;
        for hurst in [0.3, 0.9] {
            let (mut near, mut far, mut slant) = (0.0, 0.0, 0.0);
            let n_seeds = 600_u32;
            for seed in 0..n_seeds {
                let z = surface(hurst, n, &Random::new(u64::from(seed)));
                near += (z.row(10)[11] - z.row(10)[10]).powi(2) / f64::from(n_seeds);
                far += (z.row(3)[31] - z.row(3)[0]).powi(2) / f64::from(n_seeds);
                slant += (z.row(24)[18] - z.row(0)[0]).powi(2) / f64::from(n_seeds);
            }
            let theory = |d: f64| 2.0 * (d / n as f64).powf(2.0 * hurst);
            // The mean of 600 squares of normal numbers has a standard error of 5.8 %.
            for (found, d) in [(near, 1.0), (far, 31.0), (slant, 30.0)] {
                let ratio = found / theory(d);
                assert!((ratio - 1.0).abs() < 0.2, "H {hurst}, {d} points: {ratio}");
            }
        }
    }
}
