//! A hanging cloth: how exactly each way of stepping it answers, at what cost, and what it holds.

mod drift;
mod integrators;
mod orders;
mod speed;
mod stability;
#[cfg(test)]
mod tests;

pub(crate) use integrators::STUDY;
pub(crate) use orders::ORDERS;
pub(crate) use stability::{Deed, STABILITY, held};

use std::path::Path;

use super::ReportError;
use super::readable::rms;
use selvedge_drape::{Drape, DrapeScene, Hand, Integrator};

/// A cloth that is studied: how it hangs, how stiff it is, who touches it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Vertices along a side of 200 mm.
    pub(crate) n: usize,
    pins: &'static str,
    pub(crate) density_kg_per_m2: f64,
    /// Stiffness of its yarns if they are straight springs, N/m; else they are a shirting's.
    pub(crate) stiffness_n_per_m: Option<f64>,
    /// Rigidity of bending, gf·cm²/cm.
    rigidity: f64,
    n_fingers: usize,
    /// Air drags it, and it has hysteresis.
    is_lossy: bool,
}

impl Sample {
    const SHIRTING: Self = Self {
        n: 26,
        pins: "top",
        density_kg_per_m2: 0.2,
        stiffness_n_per_m: None,
        rigidity: 0.1,
        n_fingers: 0,
        is_lossy: false,
    };

    /// The cloth, stepped so; without fingers it lies flat at an angle, else it hangs.
    fn drape(
        &self,
        tilt_deg: f64,
        stepped: (Integrator, Option<f64>),
    ) -> Result<Drape, ReportError> {
        let mut drape = Drape::new(&self.scene(stepped)?, None, None)?;
        if self.n_fingers == 0 {
            drape.tilt(tilt_deg);
        } else {
            drape.place(&drape.start_hands());
        }
        Ok(drape)
    }

    fn scene(
        &self,
        (integrator, step_s): (Integrator, Option<f64>),
    ) -> Result<DrapeScene, ReportError> {
        let Self {
            n,
            pins,
            rigidity,
            is_lossy,
            ..
        } = self;
        let weight = 100.0 * self.density_kg_per_m2;
        // A straight line of 5 % at whatever load makes this stiffness; 1 gf/cm is 0.980665 N/m.
        let tension = self.stiffness_n_per_m.map_or_else(
            || "lt = 0.7".to_owned(),
            |stiffness| {
                format!(
                    "lt = 1.0\nfm_gf_per_cm = {:e}",
                    0.05 * stiffness / 0.980_665
                )
            },
        );
        let integrator = integrator.name();
        let step = step_s.map_or_else(String::new, |s| format!("step_ms = {:e}\n", 1e3 * s));
        let mut text = format!(
            "name = \"Studied\"\nsize_mm = [200.0, 200.0]\ngrid = [{n}, {n}]\npins = \"{pins}\"\n\
             air = {is_lossy}\nhysteresis = {is_lossy}\nintegrator = \"{integrator}\"\n{step}\
             [measured]\nweight_mg_per_cm2 = {weight:e}\nemt_percent = 5.0\n\
             {tension}\ng_gf_per_cm_deg = 0.5\nb_gf_cm2_per_cm = {rigidity}\nt0_mm = 0.5\n\
             rt_percent = 60.0\n2hg_gf_per_cm = 0.8\n2hg5_gf_per_cm = 1.6\n\
             2hb_gf_cm_per_cm = 0.03\n"
        );
        let finger = |side: &&str| {
            format!(
                "[[finger]]\nside = \"{side}\"\nstart_mm = [100.0, 80.0, 0.0]\nopening_mm = 20.0\n"
            )
        };
        text.extend(["front", "back"].iter().take(self.n_fingers).map(finger));
        Ok(DrapeScene::from_text(
            &text,
            Path::new("studied.drape.toml"),
        )?)
    }
}

/// Vertices times steps of a second of a cloth, which swings or hangs still beside open fingers:
/// asked for, and stepped by its counters.
pub(crate) fn stepped(swings: bool) -> Result<[u64; 2], ReportError> {
    let sample = Sample {
        n: 8,
        n_fingers: if swings { 0 } else { 2 },
        ..Sample::SHIRTING
    };
    let mut drape = sample.drape(
        if swings { 80.0 } else { 0.0 },
        (Integrator::Bdf2, Some(1e-3)),
    )?;
    let hands = pinch([100.0, 80.0, 0.0], 100.0);
    let hands = &hands[..sample.n_fingers];
    if !swings {
        drape.place(hands);
    }
    (0..1000).try_for_each(|_| drape.step(hands))?;
    let counters = drape.counters();
    let vertices = (sample.n * sample.n) as u64;
    Ok([counters.steps, counters.steps - counters.asleep].map(|steps| steps * vertices))
}

/// Two fingers at the same place of a grasp.
fn pinch(centre_mm: [f64; 3], opening_mm: f64) -> [Hand; 2] {
    [Hand {
        centre_mm,
        opening_mm,
    }; 2]
}

/// From vertices of a cloth to where they should be, rms, mm.
fn off_mm(drape: &Drape, truth_mm: &[[f64; 3]]) -> f64 {
    let pairs = drape.places_mm().zip(truth_mm);
    let apart = pairs.map(|(found, truth)| distance(found, *truth));
    rms(&apart.collect::<Vec<f64>>())
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Energy less the work of hands, J.
fn left_j(drape: &mut Drape) -> f64 {
    let [energy_j, work_j] = drape.energy_j();
    energy_j - work_j
}
