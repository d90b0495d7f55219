//! One of m alternatives is right and the strongest is chosen, without bias to any.

use super::choice::integral;
use crate::distribution::{normal_density, normal_lower};
use crate::{Computed, undefined};

/// The share of correct choices among `m` ≥ 2 alternatives at a distance d′:
/// ∫ φ(x − d′) Φ(x)^(m−1) dx (Green & Swets 1966).
///
/// # Errors
/// Fewer than two or more than 1000 alternatives, a distance that is not finite.
pub(crate) fn choice_share(d_prime: f64, m: u32) -> Computed {
    if !(2..=1000).contains(&m) || !d_prime.is_finite() {
        return undefined(format!("d′ = {d_prime} among {m} alternatives"));
    }
    Ok(share(d_prime, m))
}

fn share(d_prime: f64, m: u32) -> f64 {
    // About the mean of the right one; far below chance the weight lies above it.
    let exponent = f64::from(m - 1);
    let at = |x: f64| normal_density(x) * normal_lower(x + d_prime).powf(exponent);
    integral(at, [-9.0, 9.0 + (-d_prime).clamp(0.0, 20.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detection::{Correction, Relation};
    use selvedge_foundation::numerics::Random;
    use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

    #[test]
    fn two_alternatives_agree_with_their_closed_form() -> Computed<()> {
        for d in [-6.0, -1.0, 0.0, 0.3, 1.0, 2.5, 6.0] {
            let closed = normal_lower(d * FRAC_1_SQRT_2);
            let found = choice_share(d, 2)?;
            assert!(
                (found / closed - 1.0).abs() < 1e-12,
                "{d}: {found} for {closed}"
            );
            let back = Relation::Alternatives(2).d_prime(closed)?;
            assert!((back - d).abs() < 1e-10, "{back} for {d}");
        }
        Ok(())
    }

    #[test]
    fn without_a_difference_the_share_is_chance_and_its_slope_the_mean_of_the_largest()
    -> Computed<()> {
        for m in [2_u32, 3, 4, 8, 100] {
            let chance = choice_share(0.0, m)?;
            assert!((chance - 1.0 / f64::from(m)).abs() < 1e-14, "{m}: {chance}");
        }
        // dPc/dd′ at 0 is ∫ x φ Φ^(m−1): the mean of the largest of m over m, for m = 3
        // 3/(2√π)/3, for m = 4 3(1 + (2/π) asin ⅓)/(2√π)/4.
        let slope =
            |m: u32| -> Computed { Ok((choice_share(1e-4, m)? - choice_share(-1e-4, m)?) / 2e-4) };
        let root = 2.0 * PI.sqrt();
        assert!((slope(3)? - 1.0 / root).abs() < 1e-9, "three");
        let four = 0.75 * (1.0 + 2.0 / PI * (1.0_f64 / 3.0).asin()) / root;
        assert!((slope(4)? - four).abs() < 1e-9, "four");
        Ok(())
    }

    #[test]
    fn four_alternatives_agree_with_a_simulated_observer_and_lead_back() -> Computed<()> {
        let d = Relation::Alternatives(4).d_prime(0.413)?;
        assert!((choice_share(d, 4)? - 0.413).abs() < 1e-13, "{d}");
        let mut random = Random::new(12);
        let n = 100_000;
        let mut chooses = || {
            let right = random.normal() + d;
            (0..3).all(|_| random.normal() < right)
        };
        let n_right = (0..n).filter(|_| chooses()).count();
        let found = n_right as f64 / f64::from(n);
        assert!((found - 0.413).abs() < 0.005, "{found}");
        for share in [1e-6, 0.01, 0.2, 0.641, 0.999_999] {
            let back = choice_share(Relation::Alternatives(4).d_prime(share)?, 4)?;
            assert!((back / share - 1.0).abs() < 1e-10, "{back} for {share}");
        }
        Ok(())
    }

    #[test]
    fn a_subject_below_chance_has_a_negative_distance_and_a_flag() -> Computed<()> {
        let found = Relation::Alternatives(4).choice(15, 80, Correction::LogLinear)?;
        assert!(found.d_prime < 0.0 && found.is_below_chance, "{found:?}");
        assert!(found.correction.is_none(), "neither 0 nor 1");
        let interval = found.interval?;
        assert!(
            interval.low < found.d_prime && found.d_prime < interval.high,
            "{interval:?}"
        );
        assert!(interval.holds(0.0), "15 of 80 may be chance: {interval:?}");
        Ok(())
    }

    #[test]
    fn two_alternatives_have_the_error_of_the_normal() -> Computed<()> {
        // d′ = √2 z(Pc): error √2 √(pq/n)/φ(z).
        let found = Relation::Alternatives(2).choice(60, 80, Correction::LogLinear)?;
        let z = crate::normal_quantile(0.75)?;
        let error = SQRT_2 * (0.75_f64 * 0.25 / 80.0).sqrt() / normal_density(z);
        assert!((found.se? / error - 1.0).abs() < 1e-6, "{error}");
        Ok(())
    }

    #[test]
    fn all_right_is_corrected_and_nothing_is_not_computable() -> Computed<()> {
        let all = Relation::Alternatives(4).choice(80, 80, Correction::LogLinear)?;
        assert_eq!(all.correction, Some(Correction::LogLinear));
        assert_eq!(all.share, 80.5 / 81.0);
        assert!(all.interval.is_err(), "its upper end is infinite");
        let clipped = Relation::Alternatives(4).choice(0, 80, Correction::Clip)?;
        assert_eq!(clipped.share, 0.5 / 80.0);
        assert!(
            Relation::Alternatives(4)
                .choice(0, 0, Correction::Clip)
                .is_err(),
            "no trials"
        );
        assert!(
            Relation::Alternatives(1)
                .choice(1, 2, Correction::Clip)
                .is_err(),
            "no choice"
        );
        assert!(Relation::Alternatives(4).d_prime(1.0).is_err(), "infinite");
        Ok(())
    }
}
