//! What a cloth is, mechanically: a few laws in SI units.
//!
//! Tension is the exponential that Kawabata's tester asks for: `T = c (e^{aε/ε_m} − 1)`,
//! `c = F_m/(e^a − 1)`, straight on above `ε_m`, `k₀ ε` below 0. Shear and bending are linear with
//! a friction of their own. Knows nothing of meshes; where figures come from is `kes.rs`.

use super::curve::Curve;
use selvedge_foundation::numerics::bisected;

/// Stress of one yarn system by strain, per width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tension {
    /// Tangent at rest `k₀`, N/m.
    pub(crate) at_rest_n_per_m: f64,
    /// `a/ε_m`; 0 is a straight line.
    rate: f64,
    /// Strain `ε_m` up to which it was measured.
    pub(crate) max_strain: f64,
    /// Energy, tension and tangent there.
    top: [f64; 3],
    /// What was measured in the place of all that.
    curve: Option<Curve>,
}

impl Tension {
    /// The curve through `force_n_per_m` at `strain` of a linearity LT.
    pub(crate) fn new(force_n_per_m: f64, strain: f64, linearity: f64) -> Self {
        let a = exponent(linearity);
        if a == 0.0 {
            return Self {
                max_strain: strain,
                ..Self::linear(force_n_per_m / strain)
            };
        }
        let rate = a / strain;
        let mut curve = Self {
            at_rest_n_per_m: force_n_per_m * rate / a.exp_m1(),
            rate,
            max_strain: f64::INFINITY,
            top: [0.0; 3],
            curve: None,
        };
        curve.top = curve.at(strain);
        curve.max_strain = strain;
        curve
    }

    /// A straight line of this tangent, N/m, never overstretched.
    pub(crate) fn linear(tangent_n_per_m: f64) -> Self {
        Self {
            at_rest_n_per_m: tangent_n_per_m,
            rate: 0.0,
            max_strain: f64::INFINITY,
            top: [0.0; 3],
            curve: None,
        }
    }

    /// A measured curve.
    pub(crate) fn measured(curve: &Curve) -> Self {
        let [_, _, at_rest] = curve.at(0.0);
        Self {
            max_strain: curve.max_strain(),
            curve: Some(*curve),
            ..Self::linear(at_rest)
        }
    }

    /// Energy (J/m²), tension (N/m) and tangent (N/m) at a strain.
    #[inline]
    pub(crate) fn at(&self, strain: f64) -> [f64; 3] {
        if let Some(curve) = &self.curve {
            return curve.at(strain);
        }
        let k = self.at_rest_n_per_m;
        if strain <= 0.0 || self.rate == 0.0 {
            let tension = k * strain;
            return [0.5 * tension * strain, tension, k];
        }
        if strain > self.max_strain {
            let over = strain - self.max_strain;
            let [energy, tension, tangent] = self.top;
            let more = tangent * over;
            return [
                energy + (tension + 0.5 * more) * over,
                tension + more,
                tangent,
            ];
        }
        // Of y = aε/ε_m and q = (e^y − 1 − y)/y²: no difference of near numbers.
        let y = self.rate * strain;
        let (q, pulled) = (second_exponential(y), k * strain);
        [
            pulled * strain * q,
            pulled * (1.0 + y * q),
            k * (1.0 + y * (1.0 + y * q)),
        ]
    }
}

/// `(e^y − 1 − y)/y²`, y ≥ 0: by a polynomial up to 1, as far as a cloth is stretched by hand.
/// Chebyshev's fit, within 3e-18.
#[inline]
fn second_exponential(y: f64) -> f64 {
    if y > 1.0 {
        return (y.exp_m1() - y) / (y * y);
    }
    let even = [
        0.5,
        0.041_666_666_666_638_58,
        0.001_388_888_883_859_899_5,
        2.480_148_528_894_643_4e-5,
        2.751_984_625_703_798e-7,
        1.842_008_785_085_442_7e-9,
    ];
    let odd = [
        0.166_666_666_666_667_26,
        0.008_333_333_333_856_56,
        0.000_198_412_726_888_550_93,
        2.755_971_820_577_095_7e-6,
        2.543_589_853_687_994_4e-8,
        2.476_549_750_599_798e-10,
    ];
    polynomial([even, odd], y)
}

/// The value of a polynomial whose coefficients of even and of odd powers are given, lowest first:
/// both halves at once.
#[inline]
pub(crate) fn polynomial<const N: usize>(halves: [[f64; N]; 2], y: f64) -> f64 {
    let y2 = y * y;
    let [even, odd] = halves.map(|half| half.into_iter().rev().fold(0.0, |sum, c| sum * y2 + c));
    even + y * odd
}

/// The exponent a of a curve `(e^{as} − 1)/(e^a − 1)` of this linearity: twice the area below it,
/// `2 (1/a − 1/(e^a − 1))`. Exactly 0 for a straight line.
pub(crate) fn exponent(linearity: f64) -> f64 {
    if (linearity - 1.0).abs() < 1e-6 {
        return 0.0;
    }
    // Below 0.001 the difference of the two terms has no digits left; there it is 1 − a/6.
    let area = |a: f64| {
        if a.abs() < 1e-3 {
            1.0 - a / 6.0
        } else {
            2.0 * (a.recip() - a.exp_m1().recip())
        }
    };
    bisected([-20.0, 60.0], 100, |a| area(a) > linearity)
}

/// Thickness by pressure: the same exponential, to the tester's largest pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Compression {
    /// Thickness `T₀` without pressure, m.
    pub(crate) thickness_m: f64,
    /// What it yields up to the tester's pressure, `T₀ − T_m`, m.
    pub(crate) yield_m: f64,
    /// Exponent of the curve.
    exponent: f64,
    linearity: f64,
}

impl Compression {
    /// Largest pressure of the tester, 50 gf/cm², Pa.
    pub(crate) const TESTER_PA: f64 = 4903.325;

    /// Of a thickness, what it yields and its linearity LC.
    pub(crate) fn new(thickness_m: f64, yield_m: f64, linearity: f64) -> Self {
        Self {
            thickness_m,
            yield_m,
            exponent: exponent(linearity),
            linearity,
        }
    }

    /// Its linearity LC.
    pub(crate) fn linearity(&self) -> f64 {
        self.linearity
    }

    /// Work WC up to the tester's pressure, J/m².
    pub(crate) fn work_j_per_m2(&self) -> f64 {
        0.5 * self.linearity * Self::TESTER_PA * self.yield_m
    }

    /// How much thinner it is under a pressure, m; never thinner than a tenth.
    pub(crate) fn thinner_m(&self, pressure_pa: f64) -> f64 {
        let (a, share) = (self.exponent, pressure_pa / Self::TESTER_PA);
        let share = if a == 0.0 {
            share
        } else {
            (share * a.exp_m1()).ln_1p() / a
        };
        (self.yield_m * share).min(0.9 * self.thickness_m)
    }
}

/// The mechanical figures of a cloth; those of two directions are [warp, weft].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fabric {
    pub(crate) density_kg_per_m2: f64,
    pub(crate) tension: [Tension; 2],
    /// Friction of tension f, N/m.
    pub(crate) tension_friction_n_per_m: [f64; 2],
    /// Shear stiffness G, N/m per radian.
    pub(crate) shear_n_per_m: f64,
    /// Full widths 2HG and 2HG5 of the loop at 0.5° and 5°, N/m.
    pub(crate) shear_loop_n_per_m: [f64; 2],
    /// Bending rigidity B per width, N·m.
    pub(crate) bending_n_m: [f64; 2],
    /// Full width 2HB, N.
    pub(crate) bending_loop_n: [f64; 2],
    pub(crate) compression: Compression,
    /// Coefficient of friction against the finger.
    pub(crate) friction: f64,
}

impl Fabric {
    /// The grid spacing that resolves its folds and the pads of fingers, m: a third of the length
    /// `c = (B/ρg)^⅓` over which it bends by its own weight, at most `largest_m`.
    pub(crate) fn spacing_m(&self, largest_m: f64) -> f64 {
        let [warp, weft] = self.bending_n_m;
        let bends_m = (warp.min(weft) / (self.density_kg_per_m2 * super::GRAVITY)).cbrt();
        // A limp cloth has no such length; folds finer than 4 mm are not followed.
        (bends_m / 3.0).clamp(4e-3_f64.min(largest_m), largest_m)
    }

    /// A cloth without friction, equal in both directions, with straight laws: for closed forms.
    #[cfg(test)]
    pub(crate) fn plain(density: f64, tension: f64, shear: f64, bending: f64) -> Self {
        Self {
            density_kg_per_m2: density,
            tension: [Tension::linear(tension); 2],
            tension_friction_n_per_m: [0.0; 2],
            shear_n_per_m: shear,
            shear_loop_n_per_m: [0.0; 2],
            bending_n_m: [bending; 2],
            bending_loop_n: [0.0; 2],
            compression: Compression::new(0.5e-3, 0.0, 1.0),
            friction: 0.4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linearities_have_the_exponents_of_the_table() {
        let table = [
            (0.5, 3.594),
            (0.6, 2.672),
            (0.7, 1.906),
            (0.8, 1.230),
            (0.9, 0.604),
        ];
        for (linearity, a) in table {
            assert!((exponent(linearity) - a).abs() < 1e-3, "{linearity}");
        }
        assert_eq!(exponent(1.0), 0.0);
        assert!(exponent(1.1) < 0.0, "concave");
    }

    #[test]
    fn a_tension_curve_is_smooth_reaches_its_force_and_holds_its_energy() {
        let curve = Tension::new(490.33, 0.05, 0.7);
        let [energy, tension, _] = curve.at(0.05);
        assert!((tension - 490.33).abs() < 1e-9);
        assert!(
            (energy - 0.7 * 490.33 * 0.05 / 2.0).abs() < 1e-9,
            "{energy}"
        );
        for strain in [-0.02, -1e-9, 1e-4, 0.03, 0.05, 0.08] {
            let step = 1e-6;
            let [low, high] = [strain - step, strain + step].map(|strain| curve.at(strain));
            let [_, tension, tangent] = curve.at(strain);
            assert!(
                ((high[0] - low[0]) / (2.0 * step) - tension).abs() < 1e-3,
                "{strain}"
            );
            let slope = (high[1] - low[1]) / (2.0 * step);
            assert!(
                (slope / tangent - 1.0).abs() < 1e-3,
                "{strain}: {slope} {tangent}"
            );
        }
    }

    #[test]
    fn the_polynomial_is_the_exponential() {
        for step in 1..=1000 {
            let y = 1e-3 * f64::from(step);
            let expected = y.exp_m1();
            let off = y * (1.0 + y * second_exponential(y)) - expected;
            assert!(off.abs() <= 4.0 * f64::EPSILON * expected, "{y}: {off}");
        }
        assert!((second_exponential(1.0) - second_exponential(1.0 + 1e-15)).abs() < 1e-15);
    }

    #[test]
    fn a_cloth_yields_as_far_as_the_tester_found() {
        let cloth = Compression::new(0.8e-3, 0.2e-3, 0.35);
        assert!((cloth.thinner_m(Compression::TESTER_PA) - 0.2e-3).abs() < 1e-12);
        assert!(cloth.thinner_m(500.0) > 0.06e-3, "soft at first");
        assert_eq!(cloth.thinner_m(1e30), 0.72e-3);
    }
}
