//! Where the lamp stood over pictures of one cloth that was turned under it.
//!
//! Laid over each other, the pictures have the lamp on different sides, by known angles. To first
//! order picture k shows of every wave `−i(l_k·κ) Z + A`, where A, the albedo, is the same in all.
//! For every tilt of the first light the least squares over Z and A (drawn towards 0 by [`EVEN`])
//! leave a share of the pictures' power; the true tilt leaves the least. The other side
//! (tilt + 180°) leaves as much, of the relief turned inside out: it is chosen so that what is
//! bright in all pictures lies high.

use std::f64::consts::PI;

use super::shape::{EVEN, ShadingOptions, about_mean, mean, mean_of};
use super::{Light, View, linear};
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform, extent, to_index};

/// Tilts that are tried over half a turn, and sectors of waves: one a degree.
const N_TILTS: usize = 180;
/// Waves that are looked at, cycles/px.
const PER_PX: [f64; 2] = [0.015, 0.25];
/// The share of a wave that a light across it shows all the same.
const LEAST: f64 = 0.02;
/// Tilts that leave less than this many times the least may be the true one, and what is left of
/// perfect pictures too.
const NEARLY: f64 = 1.5;
const NOISE_SHARE: f64 = 0.01;
/// Within so many degrees a tilt is never known better.
const WITHIN_DEG: f64 = 4.0;
/// How many independent readings the shares that are left count for.
const N_READINGS: f64 = 4.0;
/// A slant to tell the side by.
const SLANT_DEG: f64 = 45.0;

/// What turned pictures say of the lamp.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Turns {
    /// The share of power that shading leaves, by the first light's tilt in degrees, 0 to 179.
    left: Vec<f64>,
    /// The share that pictures leave that are all alike, as dark is deep has them.
    left_alike: f64,
    /// The first light's tilt, degrees.
    tilt_deg: f64,
    /// Within so many degrees.
    pub(crate) within_deg: f64,
}

/// Sums of products of the pictures' waves, by sectors of direction.
type Products = Vec<Vec<Vec<f64>>>;

impl Turns {
    /// Of pictures laid over each other and the degrees that the cloth was turned by in each,
    /// counter-clockwise; row 0 the lowest y. The first is not turned.
    pub(crate) fn of(pictures: &[(&Grid<f64>, f64)]) -> Self {
        let products = products(pictures);
        let n = pictures.len() as f64;
        let trace = |m: &Vec<Vec<f64>>| (0..m.len()).map(|k| m[k][k]).sum::<f64>();
        let all = products.iter().map(trace).sum::<f64>().max(1e-300);
        let whole = |m: &Vec<Vec<f64>>| m.iter().flatten().sum::<f64>();
        let left_at = |tilt: usize| {
            let share = 1.0 / (n + EVEN);
            let of_sector = |(sector, m): (usize, &Vec<Vec<f64>>)| {
                let along = |(_, turn): &(&Grid<f64>, f64)| {
                    let light = (tilt as f64 - turn).to_radians();
                    (PI * (sector as f64 + 0.5) / N_TILTS as f64 - light).cos()
                };
                let h: Vec<f64> = pictures.iter().map(along).collect();
                let mean = share * h.iter().sum::<f64>();
                let rest: Vec<f64> = h.iter().map(|h| h - mean).collect();
                let rows = m.iter().zip(&rest);
                let inner = |row: &Vec<f64>| row.iter().zip(&rest).map(|(m, h)| m * h).sum::<f64>();
                let found: f64 = rows.map(|(row, h)| h * inner(row)).sum();
                let length: f64 = h.iter().zip(&rest).map(|(a, b)| a * b).sum();
                trace(m) - share * whole(m) - found / (length + LEAST)
            };
            products.iter().enumerate().map(of_sector).sum::<f64>() / all
        };
        let left: Vec<f64> = (0..N_TILTS).map(left_at).collect();
        let [least, _] = extent(left.iter().copied());
        let at = left.iter().position(|share| *share <= least).unwrap_or(0);
        let limit = NEARLY * least + NOISE_SHARE;
        let reach = |step: usize| {
            let ways = (1..N_TILTS / 2).take_while(|i| left[(at + i * step) % N_TILTS] < limit);
            ways.count() as f64
        };
        let within_deg = reach(1).max(reach(N_TILTS - 1)).max(WITHIN_DEG);
        let alike = products.iter().map(|m| trace(m) - whole(m) / n);
        let mut turns = Self {
            left_alike: alike.sum::<f64>() / all,
            left,
            tilt_deg: at as f64,
            within_deg,
        };
        if !turns.is_upright(pictures) {
            turns.tilt_deg -= 180.0;
        }
        turns
    }

    /// Whether what is bright in all pictures lies high under a light from the tilt.
    fn is_upright(&self, pictures: &[(&Grid<f64>, f64)]) -> bool {
        let view = |&(e, turn_deg): &(_, f64)| {
            let mut light = self.light();
            light.tilt_deg -= turn_deg;
            (e, light)
        };
        let views: Vec<View<'_>> = pictures.iter().map(view).collect();
        let Some((first, _)) = views.first() else {
            return true;
        };
        let heights = linear::heights(&views, &ShadingOptions::default());
        let bright = about_mean(&mean_of(&views, first));
        let pairs = heights.values().iter().zip(bright.values());
        pairs.map(|(z, e)| z * e).sum::<f64>() >= 0.0
    }

    /// The first light; its slant is a guess.
    pub(crate) fn light(&self) -> Light {
        Light {
            slant_deg: SLANT_DEG,
            tilt_deg: self.tilt_deg,
        }
    }

    /// How sure all this is, in a sentence or two.
    pub(crate) fn words(&self) -> String {
        format!(
            "The turned pictures put the tilt's axis within {:.0}°; its side is taken so that what \
             is bright in all of them lies high, and the slant is not to be had from them.",
            self.within_deg
        )
    }

    /// Logarithm of the odds for shading under light of a tilt (degrees from +x), against dark is
    /// deep.
    pub(crate) fn log_odds(&self, tilt_deg: f64) -> f64 {
        let at = to_index(tilt_deg.rem_euclid(N_TILTS as f64)) % N_TILTS;
        let [alike, left] = [self.left_alike, self.left[at]].map(|share| share + NOISE_SHARE);
        0.5 * N_READINGS * (alike / left).ln()
    }
}

/// The pictures' products by sectors over half a turn, the fine waves of all of them together.
fn products(pictures: &[(&Grid<f64>, f64)]) -> Products {
    let n = pictures.len();
    let mut sums = vec![vec![vec![0.0; n]; n]; N_TILTS];
    let Some((first, _)) = pictures.first() else {
        return sums;
    };
    let (width, height) = (first.width(), first.height());
    let transform = PlaneTransform::new(width, height);
    let contrast = |&(e, _): &(&Grid<f64>, f64)| {
        let level = mean(e).max(f64::MIN_POSITIVE);
        transform.forward(&e.map(|e| e / level - 1.0))
    };
    let spectra: Vec<Grid<Complex>> = pictures.iter().map(contrast).collect();
    for row in 0..height {
        let y = linear::wavenumber(row, height) / (2.0 * PI);
        for column in 0..=width / 2 {
            let x = linear::wavenumber(column, width) / (2.0 * PI);
            if !(PER_PX[0]..=PER_PX[1]).contains(&x.hypot(y)) {
                continue;
            }
            let turn = y.atan2(x).rem_euclid(PI) / PI;
            let sector = &mut sums[to_index(turn * N_TILTS as f64) % N_TILTS];
            let at = |k: usize| spectra[k].row(row)[column];
            for (j, sums) in sector.iter_mut().enumerate() {
                for (k, sum) in sums.iter_mut().enumerate() {
                    *sum += (at(j) * at(k).conj()).re;
                }
            }
        }
    }
    sums
}
