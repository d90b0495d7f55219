//! The ways of stepping, and which one is taken by itself.

use selvedge_foundation::named;

named! {
    /// How a cloth is stepped.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Integrator {
        /// Semi-implicit Euler: exact enough where it is stable.
        Explicit = "explicit",
        /// Implicit Euler: holds anything, and damps it.
        ImplicitEuler = "ie",
        /// The second backward difference formula.
        Bdf2 = "bdf2",
        /// Positions moved by constraints, once a step: for pictures only.
        Xpbd = "xpbd",
        /// Projective dynamics: one matrix factored once; locks rotation, to compare only.
        Projective = "pd",
        /// By counts of vertices and the explicit limit.
        #[default]
        Auto = "auto",
    }
    /// Its name on the command line and in files.
    pub fn name;
}

/// The share of its limit that an explicit step may take.
const SAFE_SHARE: f64 = 0.9;
/// An explicit step shorter than this is not worth taking, s.
const LEAST_EXPLICIT_S: f64 = 0.25e-3;

impl Integrator {
    /// What is chosen for a cloth of so many vertices whose explicit limit is this: never itself
    /// `auto`, with a step, s, and the reason. From counts, never a clock.
    pub(crate) fn chosen(self, n_vertices: usize, limit_s: f64) -> (Self, f64, String) {
        let safe_s = SAFE_SHARE * limit_s;
        let (largest_s, size) = match n_vertices {
            0..=700 => (1e-3, "up to 700 vertices"),
            701..=2700 => (2e-3, "up to 2700 vertices"),
            _ => (1.0 / 240.0, "more than 2700 vertices"),
        };
        match self {
            Self::Auto if safe_s >= LEAST_EXPLICIT_S => {
                let why = format!("explicit steps are stable up to {:.3} ms", 1e3 * limit_s);
                (Self::Explicit, safe_s.min(1e-3), why)
            }
            Self::Auto => {
                let limit_ms = 1e3 * limit_s;
                let why = format!("{size}; explicit steps are stable only up to {limit_ms:.3} ms");
                (Self::Bdf2, largest_s, why)
            }
            Self::Explicit => (self, safe_s.min(1e-3), "as asked".to_owned()),
            Self::Xpbd => (self, 1.0 / 2400.0, "for pictures only".to_owned()),
            _ => (self, largest_s, "as asked".to_owned()),
        }
    }
}

impl Integrator {
    /// Whether fingers touch a cloth that is stepped so: else they are led, and there is no force
    /// to tell.
    pub fn has_touch(self) -> bool {
        !matches!(self, Self::Xpbd | Self::Projective)
    }
}

impl std::str::FromStr for Integrator {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|one| one.name() == name);
        found.ok_or_else(|| format!("use {}", Self::ALL.map(Self::name).join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_chosen_follows_from_counts() {
        let of = |n, limit| {
            let (chosen, step_s, _) = Integrator::Auto.chosen(n, limit);
            (chosen, step_s)
        };
        assert_eq!(of(676, 0.5e-3), (Integrator::Explicit, 0.9 * 0.5e-3));
        assert_eq!(of(676, 0.1e-3), (Integrator::Bdf2, 1e-3));
        assert_eq!(of(2601, 0.1e-3), (Integrator::Bdf2, 2e-3));
        assert_eq!(of(10_201, 0.1e-3), (Integrator::Bdf2, 1.0 / 240.0));
        assert_eq!("bdf2".parse(), Ok(Integrator::Bdf2));
        assert!(
            "rk4"
                .parse::<Integrator>()
                .unwrap_err()
                .contains("explicit, ie")
        );
    }
}
