//! Sphericity of orthonormal contrasts between the levels of a within-subject effect.

use super::effect::Sphericity;
use crate::distribution::{chi_squared_upper, f_upper};
use crate::{Computed, Undefined, undefined};

impl Sphericity {
    /// From the sums of products about their means of `p` orthonormal contrasts over `n` subjects
    /// (p × p, row by row), and the F of the effect.
    ///
    /// With S the sums: W = |S|/(tr S/p)^p, tested by χ² = −(n − 1)ρ ln W,
    /// ρ = 1 − (2p² + p + 2)/(6p(n − 1)), with the second term of Box's expansion (Anderson 1958,
    /// as R's `mauchly.test`); ε = (tr S)²/(p tr S²); Huynh and Feldt's
    /// (npε − 2)/(p(n − 1 − pε)).
    ///
    /// # Errors
    /// No variation of any contrast.
    pub(super) fn of(products: &[f64], p: usize, n: usize, f: &Computed) -> Computed<Self> {
        let (levels, subjects) = (p as f64, n as f64);
        let trace: f64 = products.iter().step_by(p + 1).sum();
        let square: f64 = products.iter().map(|x| (x / trace).powi(2)).sum();
        if !(trace > 0.0 && square.is_finite()) {
            return undefined("no variation of the differences");
        }
        let epsilon = (1.0 / (levels * square)).min(1.0);
        let rest = subjects - 1.0 - levels * epsilon;
        // Two subjects differ in one way: nothing is left but rounding.
        let huynh_feldt = if rest > 1e-9 * subjects {
            Ok((subjects * levels * epsilon - 2.0) / (levels * rest))
        } else {
            let reason = format!("{n} subjects are too few for ε of Huynh and Feldt");
            undefined(reason)
        };
        let corrected = |epsilon: f64| {
            let df = levels * epsilon;
            f_upper(f.clone()?, df, df * (subjects - 1.0))
        };
        let mauchly_w = mauchly_w(products, p, n, trace);
        Ok(Self {
            mauchly_p: mauchly_w
                .clone()
                .and_then(|w| mauchly_p(w, levels, subjects)),
            mauchly_w,
            greenhouse_geisser: epsilon,
            p_greenhouse_geisser: corrected(epsilon),
            p_huynh_feldt: huynh_feldt
                .clone()
                .and_then(|e| corrected(e.clamp(epsilon, 1.0))),
            huynh_feldt,
        })
    }
}

fn mauchly_w(products: &[f64], p: usize, n: usize, trace: f64) -> Computed {
    if n <= p {
        let reason = format!("Mauchly's test of {p} contrasts needs over {p} subjects, not {n}");
        return undefined(reason);
    }
    let mean = trace / p as f64;
    let scaled: Vec<f64> = products.iter().map(|x| x / mean).collect();
    let w = determinant(scaled, p);
    let reason = "Mauchly's test: some differences do not vary at all";
    (w > 0.0)
        .then_some(w)
        .ok_or_else(|| Undefined::because(reason))
}

fn mauchly_p(w: f64, p: f64, n: f64) -> Computed {
    let df = n - 1.0;
    let rho = 1.0 - (2.0 * p * p + p + 2.0) / (6.0 * p * df);
    if rho <= 0.0 {
        return undefined(format!("Mauchly's test: {n} subjects are too few for χ²"));
    }
    let chi = (-df * rho * w.ln()).max(0.0);
    let cubic = 2.0 * p.powi(3) + 6.0 * p * p + 3.0 * p + 2.0;
    let second = (p + 2.0) * (p - 1.0) * (p - 2.0) * cubic / (288.0 * (df * p * rho).powi(2));
    let freedom = 0.5 * p * (p + 1.0) - 1.0;
    let first = chi_squared_upper(chi, freedom)?;
    let more = chi_squared_upper(chi, freedom + 4.0)?;
    Ok((first + second * (more - first)).clamp(0.0, 1.0))
}

/// By Cholesky's factors; 0 for a matrix that is not positive definite beyond rounding.
fn determinant(mut matrix: Vec<f64>, p: usize) -> f64 {
    let mut product = 1.0;
    for i in 0..p {
        let pivot = matrix[i * p + i];
        if pivot <= 1e-12 {
            return 0.0;
        }
        product *= pivot;
        for row in i + 1..p {
            let factor = matrix[row * p + i] / pivot;
            for column in i + 1..p {
                matrix[row * p + column] -= factor * matrix[i * p + column];
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_has_w_and_epsilon_of_one() -> Computed<()> {
        let found = Sphericity::of(&[2.0, 0.0, 0.0, 2.0], 2, 10, &Ok(3.0))?;
        assert_eq!(found.mauchly_w, Ok(1.0));
        assert_eq!(found.mauchly_p, Ok(1.0));
        assert_eq!(found.greenhouse_geisser, 1.0);
        assert_eq!(found.p_greenhouse_geisser, f_upper(3.0, 2.0, 18.0));
        assert!(found.huynh_feldt? > 1.0, "as computed");
        assert_eq!(found.p_huynh_feldt, f_upper(3.0, 2.0, 18.0), "capped");
        Ok(())
    }

    #[test]
    fn w_of_two_contrasts_is_that_by_hand() -> Computed<()> {
        // |S| = 4·1 − 1 = 3, (tr/2)² = 6.25; ε = 25/(2·(16 + 1 + 2)); p = W^((n − 2)/2) exactly.
        let found = Sphericity::of(&[4.0, 1.0, 1.0, 1.0], 2, 12, &Ok(3.0))?;
        let w = 3.0 / 6.25;
        assert!((found.mauchly_w? - w).abs() < 1e-14, "W");
        assert!((found.greenhouse_geisser - 25.0 / 38.0).abs() < 1e-14, "ε");
        // For p = 2 the second term is 0, χ² has 2 df: p = W^(½(n − 1)ρ), ρ = 1 − 1/(n − 1).
        assert!(
            (found.mauchly_p? - w.powf(5.0)).abs() < 1e-12,
            "closed form"
        );
        Ok(())
    }

    #[test]
    fn contrasts_on_one_line_reach_the_lower_bound() -> Computed<()> {
        let found = Sphericity::of(&[1.0, 2.0, 2.0, 4.0], 2, 8, &Ok(3.0))?;
        assert!((found.greenhouse_geisser - 0.5).abs() < 1e-14, "1/p");
        assert!(found.mauchly_w.is_err(), "singular");
        let few = Sphericity::of(&[1.0, 0.0, 0.0, 1.0], 2, 2, &Ok(3.0))?;
        assert!(
            few.mauchly_w
                .is_err_and(|e| e.reason.contains("needs over 2")),
            "few"
        );
        assert!(few.huynh_feldt.is_err(), "few");
        assert!(Sphericity::of(&[0.0; 4], 2, 8, &Ok(3.0)).is_err(), "none");
        Ok(())
    }

    #[test]
    fn two_subjects_are_too_few_for_huynh_and_feldt_whatever_rounding_leaves() {
        for i in 1..200_i32 {
            // Two subjects differ along one line: the sums of products are those of one vector.
            let x = f64::from(i);
            let differences = [0.1 * x, 0.7, -x.sqrt()];
            let products: Vec<f64> = differences
                .iter()
                .flat_map(|a| differences.map(|b| a * b))
                .collect();
            let found = Sphericity::of(&products, 3, 2, &Ok(1.0)).unwrap();
            assert!((found.greenhouse_geisser - 1.0 / 3.0).abs() < 1e-9);
            assert!(found.huynh_feldt.is_err(), "{i}: {found:?}");
        }
    }
}
