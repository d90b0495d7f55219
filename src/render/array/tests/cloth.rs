//! Surfaces to render: sines, weaves, Brownian motion, lines, noise.

use std::f64::consts::TAU;
use std::sync::Arc;

use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::surface::{BIN_SPACING_PER_MM, HeightMap, Profile, ProfileSet, Surface};

pub(super) const STEP_MM: f64 = 1.0 / 230.0;

pub(super) fn profile(n: u32, mut height_um: impl FnMut(f64) -> f64) -> Profile {
    let heights = (0..n).map(|i| height_um(f64::from(i) * STEP_MM)).collect();
    Profile::new(STEP_MM, heights).unwrap()
}

pub(super) fn surface(profiles: ProfileSet) -> Arc<Surface> {
    Arc::new(Surface::from_profiles(profiles, 0.0).unwrap())
}

/// The same profile along warp and weft, there and back.
pub(super) fn uniform(profile: Profile) -> Arc<Surface> {
    surface([Some(profile), None, None, None])
}

/// The profile along the warp; a weft that is flat.
pub(super) fn along_warp(profile: Profile) -> Arc<Surface> {
    let flat = Profile::new(STEP_MM, vec![0.0; 1000]).unwrap();
    surface([Some(profile), None, Some(flat), None])
}

/// A sine of 20 mm.
pub(super) fn sine(amplitude_um: f64, wavelength_mm: f64) -> Profile {
    profile(4600, |x| {
        amplitude_um * (TAU * x / wavelength_mm + 0.4).sin()
    })
}

/// One wave that fits a window exactly: a line at bin k, with only its window's neighbours.
pub(super) fn line(bin: u16) -> Profile {
    profile(1000, |x| {
        (TAU * BIN_SPACING_PER_MM * f64::from(bin) * x).cos()
    })
}

/// Yarns of a pitch with harmonics, some irregularity and noise.
pub(super) fn weave(random: &mut Random, n: u32) -> Profile {
    let pitch_mm = random.uniform_in(0.25, 1.2);
    let phase = random.uniform_in(0.0, TAU);
    profile(n, |x| {
        let turn = TAU * x / pitch_mm + 0.4 * (TAU * x / 7.0).sin() + phase;
        5.0 * turn.cos()
            + 1.5 * (2.0 * turn).cos()
            + 0.4 * (3.0 * turn).sin()
            + 0.1 * random.normal()
    })
}

pub(super) fn noise(random: &mut Random, n: u32) -> Profile {
    profile(n, |_| random.normal())
}

/// Brownian motion with Hurst exponent H: white noise, fractionally summed (order H + ½).
pub(super) fn brownian(random: &mut Random, n: usize, hurst: f64) -> Profile {
    let burn_in = n;
    let order = hurst + 0.5;
    let mut weights = vec![1.0];
    for j in 1..n + burn_in {
        weights.push(weights[j - 1] * (j as f64 - 1.0 + order) / j as f64);
    }
    let white: Vec<f64> = (0..n + burn_in).map(|_| random.normal()).collect();
    let height = |i: usize| {
        let past = white[..=i].iter().rev();
        weights.iter().zip(past).map(|(w, e)| w * e).sum::<f64>()
    };
    Profile::new(STEP_MM, (burn_in..n + burn_in).map(height).collect()).unwrap()
}

/// A rough map of 9 × 8 mm that varies both ways, felt areally.
pub(super) fn areal(seed: u64) -> Arc<Surface> {
    Arc::new(Surface::areal(&map(seed, 1.0), 0.0).unwrap())
}

/// A rough map of 9 × 8 mm; what varies along w is `share` of what it may be.
pub(super) fn map(seed: u64, share: f64) -> HeightMap {
    let mut random = Random::new(seed);
    let along: Vec<f64> = (0..180).map(|_| random.normal()).collect();
    let height = |i: usize| {
        let (column, row) = (i % 180, i / 180);
        let w_mm = 0.05 * row as f64 * share;
        along[column] * (2.0 + (0.9 * w_mm).sin()) + share * random.normal()
    };
    let heights = (0..180 * 160).map(height).collect();
    HeightMap::new(Grid::from_rows(180, heights).unwrap(), [0.05; 2]).unwrap()
}

/// A surface of one of five kinds.
pub(super) fn of_kind(kind: u8, seed: u64) -> Arc<Surface> {
    let mut random = Random::new(seed);
    match kind {
        0 => {
            let wavelength_mm = random.uniform_in(0.05, 4.0);
            uniform(sine(3.0, wavelength_mm))
        }
        1 => surface([
            Some(weave(&mut random, 2300)),
            None,
            Some(weave(&mut random, 1500)),
            Some(weave(&mut random, 1600)),
        ]),
        2 => {
            let hurst = random.uniform_in(0.1, 0.9);
            uniform(brownian(&mut random, 1300, hurst))
        }
        3 => {
            let bin = u16::try_from(1 + random.index(500)).unwrap();
            along_warp(line(bin))
        }
        _ => uniform(noise(&mut random, 1700)),
    }
}
