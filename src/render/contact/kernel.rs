//! A mass on a spring and a damper, exactly: `ÿ + 2α ẏ + κ y = g + j t`.
//!
//! What it does from any start is made of four responses: that to a unit of place (Z), of velocity
//! (G), of a constant force (H = ∫ G) and of one that rises (I = ∫ H). They are entire functions of
//! α, κ and t, so there is no case of critical damping, of a spring of 0 or of a frequency of 0:
//! their power series at a short time, then the time doubled by putting two steps after each other.

/// Terms of the series; with [`SHORT`] the rest is below rounding.
const TERMS: usize = 16;
/// `1/n`: a division costs as much as the rest of a term.
const INVERSES: [f64; TERMS + 3] = {
    let mut all = [0.0; TERMS + 3];
    let mut n = 1;
    while n < all.len() {
        all[n] = 1.0 / n as f64;
        n += 1;
    }
    all
};
/// Largest `2αt + √κ t` of the series.
const SHORT: f64 = 0.5;
/// More doublings than any step of 1 s has.
const MAX_DOUBLINGS: u32 = 60;

/// The responses after a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kernel {
    z: f64,
    g: f64,
    g_rate: f64,
    h: f64,
    i: f64,
    kappa: f64,
}

impl Kernel {
    /// Responses after `t_s` of a system with damping 2α, 1/s, and stiffness κ, 1/s².
    pub(super) fn new(two_alpha: f64, kappa: f64, t_s: f64) -> Self {
        let size = (two_alpha + kappa.sqrt()) * t_s;
        let n = (size / SHORT).log2().ceil().max(0.0);
        let n_doublings = selvedge_foundation::numerics::to_whole::<u32>(n).min(MAX_DOUBLINGS);
        let short_s = t_s * 0.5_f64.powi(n_doublings.cast_signed());
        let mut kernel = Self::series(two_alpha, kappa, short_s);
        let mut t_s = short_s;
        for _ in 0..n_doublings {
            kernel = kernel.doubled(t_s);
            t_s *= 2.0;
        }
        kernel
    }

    /// `g_{n+2} = −(a (n + 1) g_{n+1} + b g_n)/((n + 1)(n + 2))` in units of t, a = 2αt, b = κt².
    fn series(two_alpha: f64, kappa: f64, t_s: f64) -> Self {
        let (a, b) = (two_alpha * t_s, kappa * t_s * t_s);
        let (mut before, mut term) = (0.0, 1.0);
        let (mut g, mut rate, mut h, mut i) = (0.0, 0.0, 0.0, 0.0);
        for n in 1..=TERMS {
            let next_over = INVERSES[n + 1];
            g += term;
            rate += n as f64 * term;
            h += term * next_over;
            i += term * (next_over * INVERSES[n + 2]);
            let next = -(a * term + b * before * INVERSES[n]) * next_over;
            (before, term) = (term, next);
        }
        let h = h * t_s * t_s;
        Self {
            z: 1.0 - kappa * h,
            g: g * t_s,
            g_rate: rate,
            h,
            i: i * t_s * t_s * t_s,
            kappa,
        }
    }

    /// Twice the time, which was `t_s`.
    fn doubled(&self, t_s: f64) -> Self {
        let Self {
            z,
            g,
            g_rate,
            h,
            i,
            kappa,
        } = *self;
        let z_rate = -kappa * g;
        Self {
            z: z * z + g * z_rate,
            g: z * g + g * g_rate,
            g_rate: z_rate * g + g_rate * g_rate,
            h: z * h + g * g + h,
            i: z * i + g * h + t_s * h + i,
            kappa,
        }
    }

    /// How far it has gone, and its velocity, from a velocity `v` under an acceleration that begins
    /// as `pull` at the start and changes by `rise` a second.
    pub(super) fn moved(&self, v: f64, pull: f64, rise: f64) -> [f64; 2] {
        [
            v * self.g + pull * self.h + rise * self.i,
            v * self.g_rate + pull * self.g + rise * self.h,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn responses_are_the_closed_forms_whatever_the_damping() {
        for (alpha, kappa, t) in [
            (0.0, 1e4, 0.0137),
            (3.0, 1e4, 0.2),
            (2000.0, 1e4, 0.05),
            (0.1, 1e10, 1e-3),
        ] {
            let discriminant: f64 = kappa - alpha * alpha;
            let omega = discriminant.abs().sqrt();
            let g = if discriminant > 0.0 {
                (-alpha * t).exp() * (omega * t).sin() / omega
            } else {
                (((omega - alpha) * t).exp() - ((-omega - alpha) * t).exp()) / (2.0 * omega)
            };
            let kernel = Kernel::new(2.0 * alpha, kappa, t);
            let scale = 1.0 / omega;
            assert!((kernel.g - g).abs() < 1e-11 * scale, "{alpha} {kappa} {t}");
            let force = (1.0 - kernel.g_rate - 2.0 * alpha * kernel.g) / kappa;
            assert!((kernel.h - force).abs() < 1e-9 / kappa, "{alpha} {kappa}");
        }
    }

    #[test]
    fn without_a_spring_a_mass_falls_as_galileo_says_and_a_damper_slows_it() {
        let [gone, speed] = Kernel::new(0.0, 0.0, 2.0).moved(3.0, 10.0, 6.0);
        assert!((gone - (6.0 + 20.0 + 8.0)).abs() < 1e-12, "{gone}");
        assert!((speed - (3.0 + 20.0 + 12.0)).abs() < 1e-12, "{speed}");
        let [gone, speed] = Kernel::new(0.5, 0.0, 2.0).moved(1.0, 0.0, 0.0);
        let left = (-1.0_f64).exp();
        assert!((speed - left).abs() < 1e-14, "{speed}");
        assert!((gone - 2.0 * (1.0 - left)).abs() < 1e-14, "{gone}");
    }

    #[test]
    fn what_damps_without_end_comes_to_rest() {
        let kernel = Kernel::new(1e9, 1e10, 1.0);
        let [gone, speed] = kernel.moved(1.0, 0.0, 0.0);
        assert!(gone.abs() < 2e-9 && speed.abs() < 1e-7, "{gone} {speed}");
    }
}
