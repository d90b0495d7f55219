//! What a cloth is: its family and its figures, drawn from a seed.

use selvedge_foundation::named;
use selvedge_foundation::numerics::Random;

named! {
    /// How a cloth is made.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Family {
        /// Over one, under one.
        Plain = "plain",
        /// Floats that step by one from pick to pick.
        Twill = "twill",
        /// Long floats whose crossings lie apart.
        Satin = "satin",
        /// Two over, two under.
        Basket = "basket",
        /// Knitted: wales that stand out and stand back.
        Rib = "rib",
        /// Knitted: one face of loops.
        Jersey = "jersey",
        /// Tufts that stand up.
        Pile = "pile",
        /// Fibres that lie anyhow.
        Nonwoven = "nonwoven",
    }
    /// Its name in files and on the command line.
    pub fn word;
}

/// The figures of a cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Recipe {
    /// How it is made.
    pub family: Family,
    /// What its chance is drawn from; cloths of one family differ by it.
    pub seed: u64,
    /// Distance of yarns, wales or tufts along x and y, mm.
    pub pitch_mm: [f64; 2],
    /// Width of a yarn as a share of its pitch.
    pub cover: f64,
    /// How far yarns rise and fall, µm.
    pub crimp_um: f64,
    /// Crossings that a float passes (twill, satin), wales of a rib.
    pub repeat: usize,
    /// Standard deviation of the places of yarns, share of the pitch.
    pub jitter: f64,
    /// Standard deviation of a yarn's thickness along it, share of its thickness.
    pub slub: f64,
    /// Loose fibres: 0 none, 1 a nap.
    pub fuzz: f64,
    /// Turn of the cloth against the finger's path, radians.
    pub turn: f64,
    /// What the fibre itself adds to the coefficient of friction; hardly to be seen.
    pub fibre_mu: f64,
    /// How much it shines, 0 to 1; smooth fibres shine.
    pub lustre: f64,
}

impl Recipe {
    /// The cloth of a family and a seed.
    pub(crate) fn of(family: Family, seed: u64) -> Self {
        let mut random = Random::new(seed).branch(family.word());
        let mut between = |low: f64, high: f64| random.uniform_in(low, high);
        // Pitches are spread evenly in their logarithm: fine cloth is as frequent as coarse.
        let pitch = |t: f64, [low, high]: [f64; 2]| low * f64::powf(high / low, t);
        let range_mm = match family {
            Family::Plain | Family::Basket => [0.25, 1.6],
            Family::Twill | Family::Satin => [0.2, 0.8],
            Family::Rib | Family::Jersey => [0.6, 2.0],
            Family::Pile | Family::Nonwoven => [0.3, 1.5],
        };
        let along = pitch(between(0.0, 1.0), range_mm);
        let across = along * between(0.75, 1.3);
        let fuzz = match family {
            Family::Pile => between(0.6, 1.0),
            Family::Nonwoven => between(0.3, 0.9),
            Family::Satin => between(0.0, 0.15),
            _ => between(0.0, 0.6),
        };
        let lustre = (1.0 - fuzz) * between(0.1, 1.0);
        Self {
            family,
            seed,
            pitch_mm: [along, across],
            cover: between(0.6, 0.98),
            crimp_um: 1e3 * along.min(across) * between(0.06, 0.25),
            repeat: match family {
                Family::Twill => 3 + usize::from(between(0.0, 1.0) < 0.5),
                Family::Satin => 5 + 3 * usize::from(between(0.0, 1.0) < 0.5),
                _ => 2,
            },
            jitter: between(0.01, 0.08),
            slub: between(0.02, 0.2),
            fuzz,
            turn: between(-0.05, 0.05),
            fibre_mu: 0.03 * (2.0 * between(0.0, 1.0) - 1.0) - 0.05 * lustre,
            lustre,
        }
    }

    /// A generator of its own for a purpose.
    pub(super) fn seed_for(&self, purpose: &str) -> u64 {
        let family = Random::new(self.seed).branch(self.family.word());
        family.branch(purpose).seed()
    }
}
