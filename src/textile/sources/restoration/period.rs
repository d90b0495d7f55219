//! The period of a profile: by autocorrelation, which noise leaves alone but at lag 0.

use std::f64::consts::TAU;

use selvedge_foundation::numerics::{Complex, LineFit, autocorrelation, to_index};

/// The first maximum that reaches this share of the largest is the period, not its multiple.
const SHARE_OF_LARGEST: f64 = 0.85;
/// A maximum below this share of the variance is no period.
const LEAST: f64 = 0.15;
/// Harmonics that the last refinement listens to.
const N_LISTENED: u32 = 8;

/// The period of heights without their line, in samples; `None` if none stands out over at least
/// three of its repeats.
pub(super) fn period(heights_um: &[f64]) -> Option<f64> {
    let n = heights_um.len();
    let r = autocorrelation(heights_um);
    let farthest = n / 3;
    let zero = r.iter().position(|&value| value <= 0.0)?;
    let after = r.get(zero..=farthest).filter(|after| after.len() > 2)?;
    let largest = after.iter().copied().fold(f64::MIN, f64::max);
    let is_seen = largest > LEAST.max(4.0 / ((n - farthest) as f64).sqrt()) * r[0];
    let first = zero
        + after
            .iter()
            .position(|&value| value >= SHARE_OF_LARGEST * largest)?;
    let climbed = is_seen.then(|| highest(&r, first, first + first / 4 + 2))?;
    // From multiple to multiple: the error of a maximum is shared by more and more periods.
    let mut period = vertex(&r, climbed, 0.1 * climbed as f64);
    let mut times = 2.0;
    while times * period < (2 * farthest) as f64 * 0.9 {
        let [low, high] = [
            times * period - 0.25 * period,
            times * period + 0.25 * period,
        ];
        let top = highest(&r, to_index(low), to_index(high));
        if r.get(top).is_none_or(|&value| value < 0.4 * largest) {
            // One that does not come again is none.
            return (times > 2.5).then(|| sharpened(heights_um, period));
        }
        period = vertex(&r, top, 0.1 * period) / times;
        times *= 2.0;
    }
    (times > 2.5).then(|| sharpened(heights_um, period))
}

/// The lag of the largest value between two lags.
fn highest(r: &[f64], low: usize, high: usize) -> usize {
    let range = low.min(r.len() - 1)..=high.min(r.len() - 1);
    range.max_by(|&a, &b| r[a].total_cmp(&r[b])).unwrap_or(low)
}

/// Where a parabola through the values around a maximum has its top (least squares).
fn vertex(r: &[f64], top: usize, reach: f64) -> f64 {
    let reach = to_index(reach)
        .clamp(1, top.max(1))
        .min(r.len() - 1 - top.min(r.len() - 1));
    if reach == 0 {
        return top as f64;
    }
    // About the middle, odd and even parts part: slope from the odd, bend from the even one.
    let pairs: Vec<[f64; 3]> = (1..=reach)
        .map(|d| [d as f64, r[top - d], r[top + d]])
        .collect();
    let odd: f64 = pairs.iter().map(|[d, a, b]| d * (b - a)).sum();
    let square: f64 = pairs.iter().map(|[d, _, _]| 2.0 * d * d).sum();
    let mut even: Vec<[f64; 2]> = pairs
        .iter()
        .map(|[d, a, b]| [d * d, 0.5 * (a + b)])
        .collect();
    even.push([0.0, r[top]]);
    let mut weights = vec![2.0; reach];
    weights.push(1.0);
    let bend = LineFit::weighted(&even, &weights).map_or(0.0, |fit| fit.slope);
    let shift = if bend < 0.0 {
        -0.5 * (odd / square) / bend
    } else {
        0.0
    };
    top as f64 + shift.clamp(-(reach as f64), reach as f64)
}

/// The period near one at which the first harmonics are strongest over the whole profile.
fn sharpened(heights_um: &[f64], period: f64) -> f64 {
    let spread = 0.6 * period / heights_um.len() as f64;
    let strength = |period: f64| -> f64 {
        let harmonics = (1..=N_LISTENED).filter(|&k| f64::from(k) * 2.0 < period);
        harmonics
            .map(|k| line(heights_um, f64::from(k) / period).norm_sqr())
            .sum()
    };
    let at = |step: i32| period * (1.0 + spread * f64::from(step) / 30.0);
    let best = (-30..=30)
        .map(|step| (strength(at(step)), step))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(0, |(_, step)| step);
    let [a, b, c] = [best - 1, best, best + 1].map(|step| strength(at(step)));
    let bend = a - 2.0 * b + c;
    let shift = if bend < 0.0 {
        (0.5 * (a - c) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    };
    at(best) + (at(1) - at(0)) * shift
}

/// `2/n Σ z e^{−2πiνx}`: `A e^{iφ}` of a wave `A cos(2πνx + φ)`; ν in cycles a sample.
pub(super) fn line(heights_um: &[f64], per_sample: f64) -> Complex {
    let turn = Complex::from_polar(1.0, -TAU * per_sample);
    let mut sum = Complex::default();
    for (block, heights) in heights_um.chunks(64).enumerate() {
        // The turning phasor starts anew so that rounding does not pile up.
        let mut phase = Complex::from_polar(1.0, -TAU * (per_sample * (64 * block) as f64).fract());
        for height in heights {
            sum += phase * height;
            phase *= turn;
        }
    }
    sum * (2.0 / heights_um.len().max(1) as f64)
}
