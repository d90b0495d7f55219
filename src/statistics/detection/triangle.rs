//! The triangle test: two alike and one odd, the odd one is to be found.

use crate::distribution::{normal_density, normal_lower};

/// The share of correct triads at a distance d′ (Ura 1960; Ennis 1990):
/// 2 ∫₀^∞ [Φ(−x√3 + d′√⅔) + Φ(−x√3 − d′√⅔)] φ(x) dx.
///
/// By the rule of Gauss and Legendre with five nodes in each eighth from 0 to 9 (Abramowitz &
/// Stegun table 25.4): exact to rounding.
pub(crate) fn triangle_share(d_prime: f64) -> f64 {
    const NODES: [[f64; 2]; 5] = [
        [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
        [-0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
        [0.0, 0.568_888_888_888_888_9],
        [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
        [0.906_179_845_938_664, 0.236_926_885_056_189_1],
    ];
    let shift = d_prime * (2.0_f64 / 3.0).sqrt();
    let at = |x: f64| {
        let place = -x * 3.0_f64.sqrt();
        (normal_lower(place + shift) + normal_lower(place - shift)) * normal_density(x)
    };
    let half = 1.0 / 16.0;
    let piece = |i: i32| {
        let middle = f64::from(2 * i + 1) * half;
        NODES
            .iter()
            .map(|[x, w]| w * at(middle + half * x))
            .sum::<f64>()
    };
    2.0 * half * (0..72).map(piece).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Computed;
    use crate::detection::{Correction, Relation};
    use selvedge_foundation::numerics::Random;

    #[test]
    fn without_a_difference_a_third_is_right_and_far_apart_all() {
        assert!(
            (triangle_share(0.0) - 1.0 / 3.0).abs() < 1e-14,
            "{}",
            triangle_share(0.0)
        );
        assert!(
            triangle_share(20.0) > 1.0 - 1e-14,
            "{}",
            triangle_share(20.0)
        );
        assert!(
            (triangle_share(-1.3) - triangle_share(1.3)).abs() < 1e-15,
            "even"
        );
    }

    #[test]
    fn shares_are_those_of_a_simulated_observer() {
        let mut random = Random::new(14);
        for d in [0.7, 1.5, 3.0] {
            let n = 60_000;
            let mut finds = || {
                let (a, b, odd) = (random.normal(), random.normal(), random.normal() + d);
                // The pair closest together is taken to be alike.
                (a - b).abs() < (a - odd).abs().min((b - odd).abs())
            };
            let found = (0..n).filter(|_| finds()).count() as f64 / f64::from(n);
            assert!(
                (found - triangle_share(d)).abs() < 0.007,
                "{d}: {found} and {}",
                triangle_share(d)
            );
        }
    }

    #[test]
    fn shares_lead_back_to_their_distance() -> Computed<()> {
        for d in [0.2, 1.0, 2.5, 5.0] {
            let back = Relation::Triangle.d_prime(triangle_share(d))?;
            assert!((back - d).abs() < 1e-10, "{back} for {d}");
        }
        Ok(())
    }

    #[test]
    fn below_chance_the_distance_is_none_and_flagged() -> Computed<()> {
        let found = Relation::Triangle.choice(5, 21, Correction::LogLinear)?;
        assert!(found.is_below_chance, "{found:?}");
        assert_eq!(found.d_prime, 0.0);
        assert!(found.se.is_err(), "the share does not change there");
        let all = Relation::Triangle.choice(21, 21, Correction::LogLinear)?;
        assert_eq!(all.correction, Some(Correction::LogLinear));
        assert!(
            Relation::Triangle.choice(0, 0, Correction::Clip).is_err(),
            "no trials"
        );
        assert!(Relation::Triangle.d_prime(1.0).is_err(), "infinite");
        Ok(())
    }
}
