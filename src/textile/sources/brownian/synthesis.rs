//! Brownian surfaces that repeat: white noise coloured by `|k|^{−(H+1)}` on a torus.
//!
//! The spectrum is that of a Brownian surface (a surface's power falls as `k^{−(2H+2)}`, that of a
//! profile over it as `k^{−(2H+1)}`), cut off where the grid ends: at low H the rises over few
//! samples are too small by what lies beyond, and the slope of the structure function is too large.

use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform, Random};

/// What a periodic surface is made of: lengths in sides of the patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Colour {
    /// The Hurst exponent.
    pub(super) hurst: f64,
    /// No waves shorter than this; 0: down to two samples.
    pub(super) shortest: f64,
    /// Waves longer than this are no stronger than this one; 1: the whole patch.
    pub(super) longest: f64,
}

impl Colour {
    /// Amplitude factor of a wave with `cycles` in the patch.
    fn factor(&self, cycles: f64) -> f64 {
        let is_kept = cycles > 0.0 && cycles * self.shortest <= 1.0 + 1e-9;
        if is_kept {
            cycles.max(1.0 / self.longest).powf(-(self.hurst + 1.0))
        } else {
            0.0
        }
    }
}

/// A periodic surface over `n` × `n` points, with mean 0 and
/// `E[(z(x + d) − z(x))²] = 1` at `unit` points apart along either axis.
pub(super) fn surface(colour: &Colour, n: usize, unit: f64, random: &Random) -> Grid<f64> {
    let transform = PlaneTransform::new(n, n);
    let mut noise = random.branch("surface");
    let white = Grid::from_fn(n, n, |_, _| noise.normal());
    let mut spectrum = transform.forward(&white);
    let rise = rises(colour, n, &[unit])[0];
    let scale = if rise > 0.0 { 1.0 / rise.sqrt() } else { 0.0 };
    for row in 0..n {
        for (column, x) in spectrum.row_mut(row).iter_mut().enumerate() {
            *x *= Complex::from(scale * colour.factor(cycles(row, column, n)));
        }
    }
    transform.inverse(spectrum)
}

/// Cycles in the patch of a wave by its row and column of the transform.
fn cycles(row: usize, column: usize, n: usize) -> f64 {
    (row.min(n - row) as f64).hypot(column as f64)
}

/// `E[(z(x + d) − z(x))²]` along an axis at lags in points, before scaling, from the spectrum.
fn rises(colour: &Colour, n: usize, lags: &[f64]) -> Vec<f64> {
    let mut along = vec![0.0; n / 2 + 1];
    for row in 0..n {
        for (column, power) in along.iter_mut().enumerate() {
            // A column stands for itself and its mirror image, unless it is its own.
            let is_alone = column == 0 || 2 * column == n;
            let times = if is_alone { 1.0 } else { 2.0 };
            *power += times * colour.factor(cycles(row, column, n)).powi(2);
        }
    }
    let norm = 1.0 / (n * n) as f64;
    let rise = |lag: &f64| {
        let part = |(k, power): (usize, &f64)| {
            2.0 * power * norm * (1.0 - (std::f64::consts::TAU * k as f64 * lag / n as f64).cos())
        };
        along.iter().enumerate().map(part).sum()
    };
    lags.iter().map(rise).collect()
}

/// The structure function at whole lags relative to that at lag 1: what the cut-offs make of it.
#[cfg(test)]
pub(super) fn theory(colour: &Colour, n: usize, lags: &[f64]) -> Vec<f64> {
    let found = rises(colour, n, lags);
    let first = rises(colour, n, &[1.0])[0];
    found.iter().map(|rise| rise / first).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLOUR: Colour = Colour {
        hurst: 0.5,
        shortest: 0.0,
        longest: 1.0,
    };

    #[test]
    fn it_repeats_with_mean_0_and_rises_as_asked() {
        let n = 64;
        let mut sum = 0.0;
        let n_seeds = 60_u32;
        for seed in 0..n_seeds {
            let z = surface(&COLOUR, n, 8.0, &Random::new(u64::from(seed)));
            assert!(
                z.values().iter().sum::<f64>().abs() < 1e-8,
                "a mean is left"
            );
            let squares = z.values().iter().enumerate().map(|(i, a)| {
                let b = z.row(i / n)[(i % n + 8) % n];
                (a - b).powi(2)
            });
            sum += squares.sum::<f64>() / (n * n) as f64 / f64::from(n_seeds);
        }
        assert!((sum - 1.0).abs() < 0.1, "{sum}");
    }

    #[test]
    fn cut_offs_take_the_waves_beyond_them() {
        let colour = Colour {
            shortest: 0.125,
            longest: 0.25,
            ..COLOUR
        };
        assert_eq!(colour.factor(8.1), 0.0);
        assert!(colour.factor(8.0) > 0.0, "the shortest wave stays");
        assert_eq!(colour.factor(1.0), colour.factor(4.0));
        assert!(colour.factor(4.0) > colour.factor(5.0), "it falls beyond");
        assert_eq!(colour.factor(0.0), 0.0);
    }

    #[test]
    fn at_low_h_the_grid_bends_the_structure_function_as_is_said() {
        let slope = |hurst: f64| {
            let lags = theory(&Colour { hurst, ..COLOUR }, 256, &[1.0, 16.0]);
            (lags[1] / lags[0]).ln() / (2.0 * 16.0_f64.ln())
        };
        let [low, middle, high] = [0.2, 0.5, 0.8].map(slope);
        assert!((0.28..0.40).contains(&low), "{low}");
        assert!((0.50..0.60).contains(&middle), "{middle}");
        assert!((0.72..0.82).contains(&high), "{high}");
    }
}
