//! A row of an analysis of variance, and what its numbers say of each other.

use crate::distribution::f_upper;
use crate::{Computed, Undefined, undefined};

/// One effect against its own error.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Its name: a factor, or `signal × material`.
    pub name: String,
    /// Sum of squares of the effect.
    pub ss: f64,
    /// Degrees of freedom of the effect.
    pub df: f64,
    /// Sum of squares of its error term.
    pub ss_error: f64,
    /// Degrees of freedom of the error.
    pub df_error: f64,
    /// F = (SS/df)/(SS error/df error).
    pub f: Computed,
    /// P(F > f).
    pub p: Computed,
    /// SS/(SS + SS error) (Cohen 1973).
    pub partial_eta_squared: Computed,
    /// SS over itself and all variation between and within subjects (Olejnik & Algina 2003).
    pub generalised_eta_squared: Computed,
    /// Of within-subject effects with two or more degrees of freedom whose error term varies.
    pub sphericity: Option<Sphericity>,
}

/// Whether all differences between levels vary alike, and p if they are taken not to.
#[derive(Debug, Clone, PartialEq)]
pub struct Sphericity {
    /// Mauchly's W (1940).
    pub mauchly_w: Computed,
    /// Its p by χ² with Box's second term.
    pub mauchly_p: Computed,
    /// ε of Greenhouse & Geisser (1959).
    pub greenhouse_geisser: f64,
    /// ε of Huynh & Feldt (1976) as computed, which may exceed 1.
    pub huynh_feldt: Computed,
    /// p with both degrees of freedom times ε of Greenhouse and Geisser.
    pub p_greenhouse_geisser: Computed,
    /// p with both degrees of freedom times ε of Huynh and Feldt, at most 1.
    pub p_huynh_feldt: Computed,
}

/// Sums of squares and degrees of freedom of an effect and its error, from which a row follows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums {
    pub(super) ss: f64,
    pub(super) df: f64,
    pub(super) ss_error: f64,
    pub(super) df_error: f64,
}

impl Sums {
    /// A row; `ss_all` is what the generalised effect size divides by.
    pub(super) fn row(self, name: &str, ss_all: f64) -> Effect {
        let Self {
            ss,
            df,
            ss_error,
            df_error,
        } = self;
        let f = if ss_error > 0.0 {
            Ok((ss / df) / (ss_error / df_error))
        } else if ss > 0.0 {
            undefined(format!(
                "{name}: no variation in its error term, F is infinite"
            ))
        } else {
            undefined(format!(
                "{name}: no effect and no variation in its error term, F is 0/0"
            ))
        };
        let share = |part: f64, whole: f64| {
            let is_there = whole > 0.0;
            is_there
                .then(|| part / whole)
                .ok_or_else(|| Undefined::because(format!("{name}: no variation, 0/0")))
        };
        Effect {
            name: name.to_owned(),
            ss,
            df,
            ss_error,
            df_error,
            p: f.clone().and_then(|f| f_upper(f, df, df_error)),
            f,
            partial_eta_squared: share(ss, ss + ss_error),
            generalised_eta_squared: share(ss, ss_all),
            sphericity: None,
        }
    }
}

/// Partial eta squared of a printed F: F·df/(F·df + df error).
///
/// # Errors
/// F negative or not finite, degrees of freedom not positive.
pub fn partial_eta_squared(f: f64, df: f64, df_error: f64) -> Computed {
    if !(f >= 0.0 && f.is_finite() && df > 0.0 && df_error > 0.0) {
        return undefined(format!("F = {f} with df = {df}, {df_error}"));
    }
    Ok(f * df / (f * df + df_error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_three_printed_effect_sizes_one_follows_from_its_f() -> Computed<()> {
        let rounded = |f: f64, df: f64, df_error: f64| -> Computed {
            Ok((partial_eta_squared(f, df, df_error)? * 1e4).round() / 1e4)
        };
        assert_eq!(rounded(0.044, 1.0, 11.0)?, 0.0040, "printed 0.003");
        assert_eq!(rounded(0.508, 1.0, 11.0)?, 0.0441, "printed 0.004");
        assert_eq!(rounded(0.584, 7.0, 77.0)?, 0.0504, "printed 0.050");
        assert!(partial_eta_squared(f64::NAN, 1.0, 11.0).is_err(), "no F");
        Ok(())
    }

    #[test]
    fn an_effect_without_variation_says_which_kind_of_nothing_it_is() {
        let sums = |ss: f64| Sums {
            ss,
            df: 1.0,
            ss_error: 0.0,
            df_error: 11.0,
        };
        let nothing = sums(0.0).row("material", 3.0);
        assert!(nothing.f.is_err_and(|e| e.reason.contains("0/0")), "0/0");
        assert!(nothing.partial_eta_squared.is_err(), "0/0");
        let infinite = sums(2.0).row("material", 3.0);
        assert!(
            infinite.p.is_err_and(|e| e.reason.contains("infinite")),
            "2/0"
        );
        assert_eq!(infinite.partial_eta_squared, Ok(1.0));
    }
}
