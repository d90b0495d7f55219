//! Reliefs that are known, and their pictures.

use std::f64::consts::TAU;

use crate::readable::whole;
use crate::{ReportError, textiles};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::shading::{Light, picture_of};
use selvedge_textile::surface::HeightMap;
use selvedge_textile::{Brownian, Generator, Library};

/// Points of a relief to a pixel's side.
const FINE: usize = 4;
/// The Brownian relief's exponent, and points of its side.
const HURST: f64 = 0.9;
/// Rise of the Brownian relief over 1 mm, µm, on points 0.02 mm apart.
const RISE_UM: f64 = 60.0;
/// Pixels of a model cloth, mm.
const MODEL_PX_MM: f64 = 0.1;

/// A relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Relief {
    /// Two by two yarns that touch: cosine paths, parabolic sections; the rise of the paths and
    /// that of the sections are shares of the pitch.
    PlainWeave { rise: f64, section: f64 },
    /// Two waves across one another, amplitude in shares of their length.
    EggCrate(f64),
    /// A periodic Brownian surface.
    Brownian,
    /// A model of the shipped library: yarns with gaps between them and steps where they cross.
    Model(&'static str),
}

/// A relief that is known: heights finer than the picture's pixels, and as its pixels.
#[derive(Debug, Clone)]
pub(super) struct Truth {
    /// px of the fine grid.
    fine: Grid<f64>,
    n_px: [usize; 2],
    /// px.
    pub(super) height_px: Grid<f64>,
}

impl Relief {
    pub(super) fn name(self) -> String {
        match self {
            Self::PlainWeave { rise, .. } => format!("plain weave, rise {rise}"),
            Self::EggCrate(share) => format!("egg-crate {share}"),
            Self::Brownian => format!("Brownian, H {HURST}"),
            Self::Model(id) => format!("model {id}"),
        }
    }

    /// The relief on about `n` × `n` pixels.
    pub(super) fn truth(self, n: usize, seed: u64) -> Result<Truth, ReportError> {
        let fine = n * FINE;
        let pitch_px = fine as f64 / 2.0;
        Ok(match self {
            Self::PlainWeave { rise, section } => {
                let height = |x: f64, y: f64| pitch_px * plain_weave([rise, section], x, y);
                Truth::of(drawn(fine, height), [n, n])
            }
            Self::EggCrate(share) => {
                let wave = |t: f64| (2.0 * TAU * t).sin();
                let height = |x: f64, y: f64| share * pitch_px * wave(x) * wave(y);
                Truth::of(drawn(fine, height), [n, n])
            }
            Self::Brownian => {
                let step_mm = 0.02;
                let seed = u32::try_from(seed % 1_000_000).unwrap_or(1);
                let mut surface = Brownian::new(HURST, 1.0, Generator::Periodic, seed);
                (surface.length_mm, surface.step_mm) = (fine as f64 * step_mm, step_mm);
                surface.shortest_mm = Some(4.0 * FINE as f64 * step_mm);
                let map = surface.surface(RISE_UM)?;
                Truth::of(in_px(&map), [n, n])
            }
            Self::Model(id) => {
                let map = textiles::relief(id, &Library::shipped()?.manifest(id)?.source)?;
                let n_px = map.size_mm().map(|mm| (mm / MODEL_PX_MM).round().max(1.0));
                Truth::of(in_px(&map), n_px.map(whole))
            }
        })
    }
}

/// The height of a plain weave as a share of its pitch; x and y from 0 to 1 over two yarns.
fn plain_weave([rise, section]: [f64; 2], x: f64, y: f64) -> f64 {
    let sign = |t: f64| {
        if (t * 2.0).floor() % 2.0 < 0.5 {
            1.0
        } else {
            -1.0
        }
    };
    let arch = |t: f64| section * (1.0 - (2.0 * ((t * 2.0).fract() - 0.5)).powi(2));
    let warp = rise * (TAU * y).sin() * sign(x) + arch(x);
    let weft = -rise * (TAU * x).sin() * sign(y) + arch(y);
    warp.max(weft)
}

fn drawn(n: usize, height: impl Fn(f64, f64) -> f64) -> Grid<f64> {
    let at = |i: usize| (i as f64 + 0.5) / n as f64;
    let mut grid = Grid::filled(n, n, 0.0);
    for row in 0..n {
        for (column, value) in grid.row_mut(row).iter_mut().enumerate() {
            *value = height(at(column), at(row));
        }
    }
    grid
}

/// Heights of a map in its own points' distance.
pub(crate) fn in_px(map: &HeightMap) -> Grid<f64> {
    let mut heights = map.heights_um().clone();
    let um = map.step_mm()[0] * 1000.0;
    heights.values_mut().iter_mut().for_each(|z| *z /= um);
    heights
}

impl Truth {
    fn of(fine: Grid<f64>, n_px: [usize; 2]) -> Self {
        let mut height_px = averaged(&fine, n_px);
        let shrink = n_px[0] as f64 / fine.width() as f64;
        height_px.values_mut().iter_mut().for_each(|z| *z *= shrink);
        Self {
            fine,
            n_px,
            height_px,
        }
    }

    /// Its picture: slopes of the fine relief, pixels as means of what lies in them, and noise.
    pub(super) fn picture(&self, light: Light, noise: f64, random: &mut Random) -> Grid<f64> {
        let mut picture = averaged(&picture_of(&self.fine, light), self.n_px);
        if noise > 0.0 {
            for value in picture.values_mut() {
                *value = (*value + noise * random.normal()).clamp(0.0, 1.0);
            }
        }
        picture
    }
}

/// Means over cells.
pub(crate) fn averaged(fine: &Grid<f64>, [width, height]: [usize; 2]) -> Grid<f64> {
    let span = |i: usize, n: usize, of: usize| i * of / n..((i + 1) * of / n).max(i * of / n + 1);
    let mut coarse = Grid::filled(width, height, 0.0);
    for row in 0..height {
        for column in 0..width {
            let rows = span(row, height, fine.height());
            let columns = span(column, width, fine.width());
            let n = (rows.len() * columns.len()) as f64;
            let sums = rows.map(|row| fine.row(row)[columns.clone()].iter().sum::<f64>());
            coarse.row_mut(row)[column] = sums.sum::<f64>() / n;
        }
    }
    coarse
}
