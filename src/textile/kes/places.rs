//! Places along a stroke: which way they run, and whether they are even.

/// Which way places run, in the order of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Run {
    /// They rise.
    Rising,
    /// They fall: a return stroke in the order of measuring.
    Falling,
    /// They rise up to this row and fall from the next: out and back in one table.
    OutAndBack {
        /// The last row of the way out, from 0.
        turn: usize,
    },
}

/// Which way places run; the first row (from 0) that is out of order.
pub(super) fn run_of(x: &[f64]) -> Result<Run, usize> {
    let sign = |i: usize| {
        let rise = x[i + 1] - x[i];
        if rise > 0.0 {
            1
        } else if rise < 0.0 {
            -1
        } else {
            0
        }
    };
    let n_steps = x.len().saturating_sub(1);
    let n_rising = (0..n_steps).take_while(|i| sign(*i) > 0).count();
    if n_rising == n_steps {
        return Ok(Run::Rising);
    }
    // At the turn, and only there, a place may be met twice.
    let is_dwell =
        n_rising > 0 && n_rising + 1 < n_steps && sign(n_rising) == 0 && sign(n_rising + 1) < 0;
    let back = n_rising + usize::from(is_dwell);
    match (back..n_steps).find(|i| sign(*i) >= 0) {
        Some(step) => Err(step + 1),
        None if n_rising == 0 => Ok(Run::Falling),
        None => Ok(Run::OutAndBack { turn: n_rising }),
    }
}

/// Whether a column may be places: they rise, fall, or go out and back.
pub(super) fn is_ordered(x: &[f64]) -> bool {
    let n_turning = |run: Run| match run {
        Run::Rising | Run::Falling => true,
        // A few samples may rise and fall by chance.
        Run::OutAndBack { turn } => turn >= 3 && x.len() - turn > 3,
    };
    // A place that stands twice is still no height: the whole column decides.
    let n_steps = x.len().saturating_sub(1);
    let n_rising = x.windows(2).filter(|pair| pair[1] > pair[0]).count();
    let n_falling = x.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let mostly = |n: usize| n_steps > 3 && 20 * n >= 19 * n_steps;
    run_of(x).is_ok_and(n_turning) || mostly(n_rising) || mostly(n_falling)
}

/// Why places have no common step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Uneven {
    /// The row (from 0) that is off.
    pub(super) row: usize,
    /// The step to it.
    pub(super) step: f64,
    /// The mean step.
    pub(super) mean: f64,
}

/// The step of places that run one way (its size), and whether they are even only because they are
/// printed coarsely.
///
/// Even means: each step within 1 % of the mean, or no further off than rounding to `quantum`, the
/// last printed digit, explains.
pub(super) fn step_of(x: &[f64], quantum: f64) -> Result<(f64, bool), Uneven> {
    let n_steps = x.len().saturating_sub(1).max(1) as f64;
    let (first, last) = (
        x.first().copied().unwrap_or(0.0),
        x.last().copied().unwrap_or(0.0),
    );
    let mean = (last - first) / n_steps;
    let slack = 0.01 * mean.abs();
    let off = |i: usize| (x[i + 1] - x[i] - mean).abs();
    let is_off = |i: &usize| {
        let (i, rounding) = (*i, quantum * (1.0 + 1e-6));
        let from_line = |i: usize| (x[i] - first - mean * i as f64).abs();
        let is_rounded = off(i) <= rounding && from_line(i + 1) <= rounding + slack;
        off(i) > slack && !is_rounded
    };
    let indices = 0..x.len().saturating_sub(1);
    match indices.clone().find(is_off) {
        Some(i) => Err(Uneven {
            row: i + 1,
            step: x[i + 1] - x[i],
            mean,
        }),
        None => Ok((mean.abs(), indices.clone().any(|i| off(i) > slack))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_rise_fall_or_go_out_and_back() {
        assert_eq!(run_of(&[0.0, 1.0, 2.0]), Ok(Run::Rising));
        assert_eq!(run_of(&[2.0, 1.0, -1.0]), Ok(Run::Falling));
        assert_eq!(
            run_of(&[0.0, 1.0, 2.0, 1.0]),
            Ok(Run::OutAndBack { turn: 2 })
        );
        assert_eq!(
            run_of(&[0.0, 1.0, 2.0, 2.0, 1.0]),
            Ok(Run::OutAndBack { turn: 2 })
        );
        assert_eq!(run_of(&[0.0, 1.0, 1.0, 2.0]), Err(2));
        assert_eq!(run_of(&[0.0, 1.0, 2.0, 2.0]), Err(3));
        assert_eq!(run_of(&[0.0, 0.0]), Err(1));
    }

    #[test]
    fn rounded_places_are_even_and_uneven_ones_are_not() {
        let rounded: Vec<f64> = (0..2000)
            .map(|i| (f64::from(i) / 230.0 * 1e3).round() / 1e3)
            .collect();
        let (step, is_rounded) = step_of(&rounded, 1e-3).unwrap();
        assert!((step * 230.0 - 1.0).abs() < 1e-3 && is_rounded, "{step}");
        let exact: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.25).collect();
        assert_eq!(step_of(&exact, 0.01).unwrap(), (0.25, false));
        let mut uneven = exact;
        uneven[7] += 0.02;
        assert_eq!(step_of(&uneven, 0.01).unwrap_err().row, 7);
        let bent: Vec<f64> = (0..200).map(|i| f64::from(i).powi(2) * 1e-4).collect();
        assert!(step_of(&bent, 1e-3).is_err(), "a speed that changes");
    }
}
