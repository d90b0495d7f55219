//! A measured tension curve: a cubic between its points that rises wherever they rise.
//!
//! Slopes are those of Fritsch & Carlson (1980) with the weights of Fritsch & Butland (1984): no
//! tangent is below 0, so that Newton's method stays on firm ground.

use super::DrapeError;

/// Most points, the one at rest with them: a curve is copied with its cloth.
pub(crate) const MAX_POINTS: usize = 16;

/// Stress by strain through measured points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Curve {
    n: usize,
    /// Strain, energy (J/m²), tension (N/m) and tangent (N/m) at every point.
    knots: [[f64; 4]; MAX_POINTS],
}

impl Curve {
    /// The curve through the origin and points of strain and tension, N/m.
    ///
    /// # Errors
    /// Fewer than two points beside the origin, more than fit, or such as do not rise.
    pub(crate) fn new(points: &[[f64; 2]]) -> Result<Self, DrapeError> {
        let points: Vec<[f64; 2]> = std::iter::once([0.0; 2])
            .chain(
                points
                    .iter()
                    .copied()
                    .skip_while(|[strain, tension]| strain.max(*tension) == 0.0),
            )
            .collect();
        let is_rising = |pair: &[[f64; 2]]| (0..2).all(|of| pair[1][of] > pair[0][of]);
        if !(3..=MAX_POINTS).contains(&points.len()) {
            let what = format!("a tension curve of {} points", points.len() - 1);
            let most = MAX_POINTS - 1;
            return Err(DrapeError::input(
                what,
                format!("give 2 to {most} beside the origin"),
            ));
        }
        if !points.windows(2).all(is_rising) {
            let mend = "let strain and tension rise from row to row, from 0 on";
            return Err(DrapeError::input("this tension curve does not rise", mend));
        }
        let mut curve = Self {
            n: points.len(),
            knots: [[0.0; 4]; MAX_POINTS],
        };
        let slopes = slopes(&points);
        for (nth, ([strain, tension], slope)) in points.into_iter().zip(slopes).enumerate() {
            curve.knots[nth] = [strain, 0.0, tension, slope];
            if nth > 0 {
                let energy = curve.within(nth - 1, strain)[0];
                curve.knots[nth][1] = energy;
            }
        }
        Ok(curve)
    }

    /// The last strain that was measured.
    pub(crate) fn max_strain(&self) -> f64 {
        self.knots[self.n - 1][0]
    }

    /// Energy, tension and tangent at a strain: straight on beyond both ends.
    pub(crate) fn at(&self, strain: f64) -> [f64; 3] {
        let last = self.n - 1;
        let beyond = match strain {
            _ if strain <= 0.0 => Some(0),
            _ if strain >= self.knots[last][0] => Some(last),
            _ => None,
        };
        if let Some(end) = beyond {
            let [from, energy, tension, tangent] = self.knots[end];
            let over = strain - from;
            let more = tangent * over;
            return [
                energy + (tension + 0.5 * more) * over,
                tension + more,
                tangent,
            ];
        }
        let above = self.knots[..self.n]
            .iter()
            .position(|knot| strain < knot[0]);
        self.within(above.unwrap_or(last) - 1, strain)
    }

    /// The same between a point and the next.
    fn within(&self, nth: usize, strain: f64) -> [f64; 3] {
        let ([a, energy, low, slope], [b, _, high, next]) = (self.knots[nth], self.knots[nth + 1]);
        let (h, t) = (b - a, (strain - a) / (b - a));
        // T = low + h (slope t + c t² + d t³).
        let secant = (high - low) / h;
        let (c, d) = (
            3.0 * secant - 2.0 * slope - next,
            slope + next - 2.0 * secant,
        );
        let rise = t * (slope + t * (c + t * d));
        let area = t * (low + h * t * (slope / 2.0 + t * (c / 3.0 + t * d / 4.0)));
        [
            energy + h * area,
            low + h * rise,
            slope + t * (2.0 * c + 3.0 * t * d),
        ]
    }
}

/// Tangents at points that rise: weighted harmonic means of the secants on both sides.
fn slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let spans = points.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    let rises = points.windows(2).map(|pair| pair[1][1] - pair[0][1]);
    let (spans, secants): (Vec<f64>, Vec<f64>) = spans
        .zip(rises)
        .map(|(span, rise)| (span, rise / span))
        .unzip();
    let inner = |nth: usize| {
        let (before, after) = (spans[nth - 1], spans[nth]);
        let (weight, other) = (2.0 * after + before, after + 2.0 * before);
        (weight + other) / (weight / secants[nth - 1] + other / secants[nth])
    };
    // At an end the parabola through three points, never flat and never thrice the secant.
    let end = |near: usize, far: usize| {
        let parabola = ((2.0 * spans[near] + spans[far]) * secants[near]
            - spans[near] * secants[far])
            / (spans[near] + spans[far]);
        parabola.clamp(0.1 * secants[near], 3.0 * secants[near])
    };
    let last = secants.len() - 1;
    std::iter::once(end(0, 1))
        .chain((1..=last).map(inner))
        .chain([end(last, last - 1)])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::Tension;

    #[test]
    fn a_sampled_exponential_is_the_exponential() {
        let exact = Tension::new(490.33, 0.05, 0.7);
        let points: Vec<[f64; 2]> = (1..=12)
            .map(|nth| 0.05 * f64::from(nth) / 12.0)
            .map(|strain| [strain, exact.at(strain)[1]])
            .collect();
        let curve = Curve::new(&points).unwrap();
        for step in -20..=100 {
            let strain = 5e-4 * f64::from(step);
            let (found, expected) = (curve.at(strain), exact.at(strain));
            for of in 0..2 {
                let off = (found[of] - expected[of]).abs() / exact.at(0.05)[of];
                assert!(off < 4e-3, "{strain} {of}: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn a_curve_rises_everywhere_and_its_energy_is_the_work() {
        let points = [
            [0.001, 0.1],
            [0.002, 40.0],
            [0.01, 41.0],
            [0.05, 500.0],
            [0.06, 501.0],
        ];
        let curve = Curve::new(&points).unwrap();
        let mut work = 0.0;
        let (n, most) = (70_000, 0.07);
        for step in 0..n {
            let strain = most * (f64::from(step) + 0.5) / f64::from(n);
            let [_, tension, tangent] = curve.at(strain);
            assert!(tangent >= 0.0, "{strain}: {tangent}");
            work += tension * most / f64::from(n);
        }
        let [energy, ..] = curve.at(most);
        assert!((work / energy - 1.0).abs() < 1e-6, "{work} {energy}");
        for [strain, tension] in points {
            assert!((curve.at(strain)[1] - tension).abs() < 1e-9);
        }
        assert!(
            curve.at(-0.01)[1] < 0.0,
            "yarns hold against being pushed, too"
        );
    }

    #[test]
    fn curves_that_fall_or_are_too_short_are_refused() {
        for (points, expected) in [
            (
                &[[0.0, 0.0], [0.01, 3.0]][..],
                "curve of 1 points; give 2 to 15",
            ),
            (&[[0.01, 3.0], [0.02, 2.0]], "does not rise"),
            (&[[0.01, 3.0], [f64::NAN, 4.0]], "does not rise"),
        ] {
            let error = Curve::new(points).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
