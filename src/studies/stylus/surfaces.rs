//! What the stylus is led over: a wall it falls on, a sine, a random relief of every wavelength.

use crate::ReportError;
use selvedge_foundation::named;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_render::contact::{
    Contact, ContactLaw, DeviceSpec, Friction, Relief, Stepper, StylusSetup, Tip,
};
use selvedge_textile::surface::HeightMap;
use std::f64::consts::TAU;

/// How far it falls onto the wall, mm.
pub(super) const DROP_MM: f64 = 2.0;
/// Speed along the surface, mm/s.
const SPEED_MM_PER_S: f64 = 50.0;
/// Points of a profile, and their distance, mm.
const POINTS: (usize, f64) = (2048, 0.005);
/// Damping of the wall as a share of the critical.
const DAMPING: f64 = 0.1;

named! {
    /// A surface.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(super) enum Surface {
        /// A wall that the tip falls on.
        Flat = "a fall on a flat wall", "flat",
        /// 50 µm, 2 mm.
        Sine = "a sine of 50 µm and 2 mm", "sine",
        /// Every wavelength, longer ones higher.
        Broadband = "a random relief", "broadband",
    }
    /// What it is called.
    pub(super) fn name;
    /// Its word in names of files.
    pub(super) fn word;
}

impl Surface {
    /// A point of a stylus on it.
    pub(super) fn relief(self, seed: u64) -> Result<Contact, ReportError> {
        let (n, step_mm) = POINTS;
        let row = match self {
            Self::Flat => vec![0.0; n],
            Self::Sine => {
                let waves = (n as f64 * step_mm / 2.0).round() / n as f64;
                (0..n)
                    .map(|i| 50.0 * (TAU * waves * i as f64).sin())
                    .collect()
            }
            Self::Broadband => random_um(n, seed),
        };
        contact(&row, step_mm)
    }
}

fn contact(row_um: &[f64], step_mm: f64) -> Result<Contact, ReportError> {
    let grid = Grid::from_fn(row_um.len(), 1, |column, _| row_um[column]);
    let (relief, tip) = (relief_of(grid, step_mm)?, Tip::stylus(0.0));
    let law = ContactLaw::default();
    Ok(Contact::new(&relief, tip, law, Friction::none())?)
}

/// Heights in µm that repeat.
pub(crate) fn relief_of(heights_um: Grid<f64>, step_mm: f64) -> Result<Relief, ReportError> {
    let map = HeightMap::new(heights_um, [step_mm; 2]);
    let map = map.map_err(|error| ReportError::Study(error.to_string()))?;
    Ok(Relief::of_map(&map.periodic()))
}

/// A profile that repeats, its amplitude as the wavelength, 20 µm rms.
fn random_um(n: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed).branch("stylus");
    let waves: Vec<[f64; 2]> = (1..=200_u16)
        .map(|k| [random.normal(), random.normal()].map(|x| x / f64::from(k)))
        .collect();
    let height = |i: usize| {
        let of = |(k, [a, b]): (f64, &[f64; 2])| {
            let (sin, cos) = (TAU * k * i as f64 / n as f64).sin_cos();
            a * cos + b * sin
        };
        let numbered = (1_u16..).map(f64::from).zip(&waves);
        numbered.map(of).sum::<f64>()
    };
    let row: Vec<f64> = (0..n).map(height).collect();
    let scale = 20.0 / crate::readable::rms(&row);
    row.into_iter().map(|um| scale * um).collect()
}

/// Where the stylus is led.
pub(super) fn place_mm(t_s: f64) -> [f64; 2] {
    [SPEED_MM_PER_S * t_s, 0.0]
}

fn damping(stiffness: f64) -> f64 {
    2.0 * DAMPING * (stiffness * DeviceSpec::default().mass_kg).sqrt()
}

/// A stylus in a hand that presses with 1 N.
pub(super) fn setup(
    contact: &Contact,
    (stiffness, method, rate_hz): (f64, Stepper, f64),
) -> Result<StylusSetup, ReportError> {
    let mut contact = contact.clone();
    contact.set_law(ContactLaw {
        stiffness_n_per_m: stiffness,
        damping_n_s_per_m: damping(stiffness),
        ..ContactLaw::default()
    })?;
    Ok(StylusSetup::of(contact, method, rate_hz))
}
