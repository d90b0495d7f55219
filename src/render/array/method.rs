//! Which method renders, how accurate it has to be, and how accurate it is.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::RenderError;
use selvedge_foundation::named;
use selvedge_textile::surface::{Direction, Surface};

named! {
    /// How amplitudes are computed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Method {
        /// f64, every bin, no shortcut.
        Reference = "reference",
        /// f64, only the bins that a filter can hear at this speed, nothing twice in a tick.
        Banded = "banded",
        /// Powers tabulated over log speed as they are needed, interpolated in f32.
        Table = "table",
        /// The cheapest of these within the error budget, preparing included.
        #[default]
        Auto = "auto",
    }
    /// Its name on the command line and in files.
    pub fn name;
}

/// No method has this name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no method {0:?}; use reference, banded, table or auto")]
pub struct UnknownMethod(String);

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        let found = Self::ALL.into_iter().find(|method| method.name() == name);
        found.ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}

/// How accurate rendering has to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accuracy {
    /// Largest level error of `table`, and of what `auto` chooses, dB. 0 asks for `reference`.
    pub budget_db: f64,
    /// `banded` leaves out bins that a filter lets less than this share of their amplitude
    /// through.
    pub banded_floor: f64,
}

impl Default for Accuracy {
    /// 0.05 dB; a millionth.
    fn default() -> Self {
        Self {
            budget_db: 0.05,
            banded_floor: 1e-6,
        }
    }
}

impl Accuracy {
    /// The default with another error budget.
    pub fn within_db(budget_db: f64) -> Self {
        Self {
            budget_db,
            ..Self::default()
        }
    }

    pub(super) fn check(&self) -> Result<(), RenderError> {
        let keys = [
            ("budget_db", self.budget_db),
            ("banded_floor", self.banded_floor),
        ];
        let odd = keys
            .into_iter()
            .find(|(_, value)| !(*value >= 0.0 && value.is_finite()));
        odd.map_or(Ok(()), |(key, value)| {
            Err(RenderError::Accuracy { key, value })
        })
    }
}

/// How far an amplitude `a` may be from that of `reference`, `a_ref`, both before gains.
///
/// Let T be the amplitude that the surface would have unfiltered, `√(2 Σ_d Σ_k P_{d,k})`, largest
/// over its points. Then `|20 log₁₀(a/a_ref)| ≤ level_db` wherever `a_ref ≥ T/1000`, and anywhere
/// `|a − a_ref| ≤ a_ref·(10^(level_db/20) − 1) + floor·T`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorBound {
    /// Level error of what can be felt, dB.
    pub level_db: f64,
    /// Error of what cannot, as a share of the unfiltered amplitude.
    pub floor: f64,
}

impl ErrorBound {
    /// No error but rounding.
    pub(super) const EXACT: Self = Self {
        level_db: 0.0,
        floor: 0.0,
    };

    /// Bins left out where `H < floor`: `a_ref² − a² < floor²·2ΣP ≤ floor² T²`.
    pub(super) fn of_floor(floor: f64) -> Self {
        // At a_ref = T/1000 the share of power lost is (1000·floor)².
        let lost = (1000.0 * floor).powi(2).min(1.0);
        Self {
            level_db: -10.0 * (1.0 - lost).log10(),
            floor,
        }
    }

    /// An error as a share of what the bound allows, above 1 where it is broken: of an amplitude
    /// and the reference's, both before gains, on a surface that gives `unfiltered_um` unfiltered.
    pub fn share_of(&self, unfiltered_um: f64, [a, a_ref]: [f64; 2]) -> f64 {
        let of_level = a_ref * (10.0_f64.powf(self.level_db / 20.0) - 1.0);
        let off = (a - a_ref).abs();
        let of_amplitude = if off > 0.0 {
            off / (of_level + self.floor * unfiltered_um)
        } else {
            0.0
        };
        if a_ref >= 1e-3 * unfiltered_um {
            of_amplitude.max((20.0 * (a / a_ref).log10()).abs() / self.level_db)
        } else {
            of_amplitude
        }
    }
}

/// T of [`ErrorBound`], µm: `√(2 Σ_d Σ_k P)`, the largest over points, and over the directions
/// along either thread.
pub fn unfiltered_um(surface: &Surface) -> f64 {
    let of_direction = |direction: &Direction| {
        let spectra = surface.spectra(*direction);
        let powers = (0..spectra.n_points()).map(|point| spectra.powers_um2(point).iter().sum());
        powers.fold(0.0, f64::max)
    };
    let of_axis = |both: &[Direction]| both.iter().map(of_direction).fold(0.0, f64::max);
    let sum: f64 = Direction::ALL.chunks(2).map(of_axis).sum();
    (2.0 * sum).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_found_by_name() {
        for method in Method::ALL {
            assert_eq!(method.name().parse(), Ok(method));
        }
        let error = "fast".parse::<Method>().unwrap_err();
        assert_eq!(
            error.to_string(),
            "no method \"fast\"; use reference, banded, table or auto"
        );
    }

    #[test]
    fn senseless_accuracies_are_refused() {
        for budget_db in [-0.1, f64::NAN, f64::INFINITY] {
            assert!(
                Accuracy::within_db(budget_db).check().is_err(),
                "{budget_db}"
            );
        }
        assert!(
            Accuracy::default().check().is_ok(),
            "the default makes sense"
        );
    }

    #[test]
    fn a_floor_of_a_millionth_costs_microdecibels_at_a_thousandth() {
        assert!(
            ErrorBound::of_floor(1e-6).level_db < 5e-6,
            "(1e-3)² of the power"
        );
        assert_eq!(ErrorBound::of_floor(0.1).level_db, f64::INFINITY);
    }
}
