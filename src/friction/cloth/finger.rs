//! What a finger feels as it is drawn along a cloth: the coefficient of friction along its path.
//!
//! `f(x) = µ (1 + α c(x) + β s(x)) + trend + slip + noise`: µ from fibre, hairs and how much of the
//! cloth touches; c is how the area of contact changes and s the slope of the surface, both as the
//! first ridges of the finger feel them (0.45 mm apart, each less than the one before); the rest
//! nobody can see in a picture. Means of 0.28 to 0.56 and deviations of about 4 % are those of
//! Cai et al. (2021), tables 1 and 2.

use std::f64::consts::TAU;

use selvedge_foundation::numerics::{Grid, Random, to_index};

use super::photo::blurred;
use super::{Area, PER_MM, Recipe};

/// Rows under the finger, 10 mm.
pub(crate) const FINGER_ROWS: usize = 128;
/// Distance of the finger's ridges, samples.
const RIDGE: f64 = 0.45 * PER_MM;
/// Ridges that are felt, and the share of each that the next has.
const RIDGES: (i32, f64) = (6, 0.6);

/// Friction along a path, one value a sample.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rubbed {
    /// What a sensor gives.
    pub friction: Vec<f64>,
    /// The part of it that hangs on the surface alone: nothing can predict more.
    pub of_surface: Vec<f64>,
}

impl Recipe {
    /// A finger drawn along x over a whole area with these heights, whose rows lie under it.
    pub(crate) fn rubbed(&self, relief_um: &Grid<f32>, area: Area, stroke: u64) -> Rubbed {
        let of_surface = self.of_surface(relief_um);
        Rubbed {
            friction: self.once_more(&of_surface, area, stroke),
            of_surface,
        }
    }

    /// Another stroke over the same place: what hangs on no surface is drawn anew.
    pub(crate) fn once_more(&self, of_surface: &[f64], area: Area, stroke: u64) -> Vec<f64> {
        let mean = of_surface.iter().sum::<f64>() / of_surface.len().max(1) as f64;
        let mut random = Random::new(self.seed_for("stroke")).branch(&stroke.to_string());
        let unseen = unseen(area.columns, &mut random);
        of_surface
            .iter()
            .zip(unseen)
            .map(|(f, unseen)| f + mean * unseen)
            .collect()
    }

    /// `µ (1 + α c + β s)`.
    fn of_surface(&self, relief_um: &Grid<f32>) -> Vec<f64> {
        let n = relief_um.width();
        let values = relief_um.values();
        let mean_um =
            values.iter().map(|&z| f64::from(z)).sum::<f64>() / values.len().max(1) as f64;
        let depth_um = self.crimp_um.max(1.0);
        // The skin reaches about a crimp deep, softly.
        let touches = |z: f32| 1.0 / (1.0 + (-3.0 * (f64::from(z) - mean_um) / depth_um).exp());
        let (mut contact, mut height_um) = (vec![0.0; n], vec![0.0; n]);
        for row in 0..relief_um.height() {
            for (at, &z) in relief_um.row(row).iter().enumerate() {
                contact[at] += touches(z);
                height_um[at] += f64::from(z);
            }
        }
        let share = 1.0 / relief_um.height().max(1) as f64;
        contact
            .iter_mut()
            .chain(&mut height_um)
            .for_each(|sum| *sum *= share);
        let touched = contact.iter().sum::<f64>() / n.max(1) as f64;
        let (contact, height_um) = (ridged(&contact), ridged(&height_um));
        let mu = 0.26 + 0.12 * self.fuzz + 0.2 * touched + self.fibre_mu;
        let slope = |at: usize| {
            let (before, after) = (at.saturating_sub(1), (at + 1).min(n - 1));
            1e-3 * PER_MM * (height_um[after] - height_um[before]) / 2.0
        };
        let felt = |at: usize| 1.0 + 0.5 * (contact[at] - touched) + 0.3 * slope(at);
        (0..n).map(|at| mu * felt(at)).collect()
    }
}

/// What the ridges of a finger leave of a profile: a comb that reaches back, softly.
fn ridged(profile: &[f64]) -> Vec<f64> {
    let soft = Grid::from_fn(profile.len(), 1, |at, _| {
        selvedge_foundation::numerics::to_single(profile[at])
    });
    let soft = blurred(&soft, 0.08 * PER_MM);
    let (n_ridges, share) = RIDGES;
    let total: f64 = (0..n_ridges).map(|ridge| share.powi(ridge)).sum();
    let at_ridge = |at: usize, ridge: i32| {
        let back = (at as f64 - RIDGE * f64::from(ridge)).max(0.0);
        f64::from(soft.values()[to_index(back)])
    };
    (0..profile.len())
        .map(|at| {
            (0..n_ridges)
                .map(|ridge| share.powi(ridge) * at_ridge(at, ridge))
                .sum::<f64>()
                / total
        })
        .collect()
}

/// What hangs on no surface, as a share of the mean: slow wandering (1/f), slight stick and slip
/// at places of its own, a sensor's noise.
fn unseen([from, n]: [usize; 2], random: &mut Random) -> Vec<f64> {
    let waves: Vec<[f64; 3]> = (1..=12)
        .map(|k| {
            let cycles_per_mm = 0.004 * f64::from(k);
            [
                cycles_per_mm,
                0.02 * random.normal() / f64::from(k),
                TAU * random.uniform(),
            ]
        })
        .collect();
    let mut slip = 0.0;
    let slip_mm = random.uniform_in(1.5, 4.0);
    let sample = |at: usize| {
        let x_mm = (from + at) as f64 / PER_MM;
        slip += 1.0 / (PER_MM * slip_mm) * (1.0 + 0.5 * random.normal());
        if slip > 1.0 {
            slip -= 1.0;
        }
        let slow = waves
            .iter()
            .map(|[nu, a, phase]| a * (TAU * nu * x_mm + phase).sin());
        slow.sum::<f64>() + 0.004 * (slip - 0.5) + 0.004 * random.normal()
    };
    (0..n).map(sample).collect()
}
