//! The lowest place of a function of few variables, without derivatives (Nelder & Mead 1965).

/// What a search found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lowest<const N: usize> {
    /// Where.
    pub place: [f64; N],
    /// The value there.
    pub value: f64,
}

/// Evaluations before a search is given up.
const MAX_EVALUATIONS: usize = 2000;

impl<const N: usize> Lowest<N> {
    /// Walks downhill from `start` with a simplex whose edges are `steps`, until its values agree
    /// to about 1e-12; infinite values are walls.
    ///
    /// A simplex can shrink onto a slope: search again from what was found where that matters.
    pub fn of(
        mut function: impl FnMut(&[f64; N]) -> f64,
        start: [f64; N],
        steps: [f64; N],
    ) -> Self {
        let mut at = |place: [f64; N]| {
            let value = function(&place);
            let value = if value.is_nan() { f64::INFINITY } else { value };
            Self { place, value }
        };
        let mut corners = vec![at(start)];
        for (axis, step) in steps.iter().enumerate() {
            let mut place = start;
            place[axis] += step;
            corners.push(at(place));
        }
        for _ in 0..MAX_EVALUATIONS {
            corners.sort_by(|a, b| a.value.total_cmp(&b.value));
            if is_small(&corners, &steps) {
                break;
            }
            improve(&mut corners, &mut at);
        }
        corners.sort_by(|a, b| a.value.total_cmp(&b.value));
        corners[0]
    }
}

/// Whether neither values nor places differ any more.
fn is_small<const N: usize>(corners: &[Lowest<N>], steps: &[f64; N]) -> bool {
    let (first, last) = (&corners[0], &corners[N]);
    let is_level = last.value - first.value <= 1e-12 * (1.0 + first.value.abs());
    let is_close = |axis: usize| {
        let apart = |corner: &Lowest<N>| (corner.place[axis] - first.place[axis]).abs();
        corners.iter().all(|c| apart(c) <= 1e-5 * steps[axis].abs())
    };
    is_level && (0..N).all(is_close)
}

/// Moves the worst corner, or draws all towards the best.
fn improve<const N: usize>(corners: &mut [Lowest<N>], at: &mut impl FnMut([f64; N]) -> Lowest<N>) {
    let mut middle = [0.0; N];
    for corner in &corners[..N] {
        for (m, x) in middle.iter_mut().zip(corner.place) {
            *m += x / N as f64;
        }
    }
    let (worst, second) = (corners[N], corners[N - 1].value);
    let mut along = |share: f64| {
        let mut place = worst.place;
        for (x, m) in place.iter_mut().zip(middle) {
            *x = m + share * (m - *x);
        }
        at(place)
    };
    let mirrored = along(1.0);
    let moved = if mirrored.value < corners[0].value {
        let farther = along(2.0);
        Some(if farther.value < mirrored.value {
            farther
        } else {
            mirrored
        })
    } else if mirrored.value < second {
        Some(mirrored)
    } else {
        let is_outside = mirrored.value < worst.value;
        let nearer = along(if is_outside { 0.5 } else { -0.5 });
        (nearer.value < mirrored.value.min(worst.value)).then_some(nearer)
    };
    if let Some(moved) = moved {
        corners[N] = moved;
        return;
    }
    let best = corners[0].place;
    for corner in &mut corners[1..] {
        let mut place = corner.place;
        for (x, b) in place.iter_mut().zip(best) {
            *x = 0.5 * (*x + b);
        }
        *corner = at(place);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_bent_valley_is_found() {
        let rosenbrock = |p: &[f64; 2]| (1.0 - p[0]).powi(2) + 100.0 * (p[1] - p[0] * p[0]).powi(2);
        let found = Lowest::of(rosenbrock, [-1.2, 1.0], [0.5, 0.5]);
        assert!((found.place[0] - 1.0).abs() < 1e-5, "{found:?}");
        assert!((found.place[1] - 1.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn a_wall_is_not_crossed() {
        let walled = |p: &[f64; 3]| {
            let inside = p[0] > 0.5;
            let sum: f64 = p.iter().map(|x| x * x).sum();
            if inside { sum } else { f64::NAN }
        };
        let found = Lowest::of(walled, [2.0, 1.0, -1.0], [0.3; 3]);
        assert!(
            found.place[0] > 0.5 && found.value < 0.2501 + 0.02,
            "{found:?}"
        );
    }
}
