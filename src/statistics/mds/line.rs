//! Maps on a line, which are orders: a search that exchanges and moves objects.

use super::descend::{Until, majorise};
use super::fit::Fit;
use super::search::{Plan, downhill};

/// What an order is tried with before it is followed to the end.
const GLANCE: Until = Until {
    n_steps: 4,
    share: 1e-6,
};
/// An order is followed when a glance at it is within this factor of the best squared loss.
const WORTH: f64 = 1.15;

/// Improves a map on a line until no exchange of two objects and no move of one helps.
pub(super) fn exchange(fit: &mut Fit<'_>, plan: &Plan, x: &mut [f64], f: f64) -> f64 {
    let n = x.len();
    let mut best = f;
    let mut tried = x.to_vec();
    loop {
        let before = best;
        for from in 0..n {
            for to in 0..n {
                for is_swap in [true, false] {
                    // Moving to the next place is an exchange, and so is every swap backwards.
                    let is_new = if is_swap {
                        from < to
                    } else {
                        from.abs_diff(to) > 1
                    };
                    if !is_new {
                        continue;
                    }
                    rearranged(x, from, to, is_swap, &mut tried);
                    if majorise(fit, &mut tried, GLANCE) > WORTH * best {
                        continue;
                    }
                    let next = downhill(fit, plan, &mut tried);
                    if next < best * (1.0 - 1e-9) - 1e-15 {
                        best = next;
                        x.copy_from_slice(&tried);
                    }
                }
            }
        }
        if best >= before {
            return best;
        }
    }
}

/// The objects at two ranks exchanged, or one moved to the other's rank and those between shifted;
/// the places on the line stay.
fn rearranged(x: &[f64], from: usize, to: usize, is_swap: bool, out: &mut [f64]) {
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let places: Vec<f64> = order.iter().map(|&i| x[i]).collect();
    if is_swap {
        order.swap(from, to);
    } else {
        let moved = order.remove(from);
        order.insert(to, moved);
    }
    for (&object, place) in order.iter().zip(places) {
        out[object] = place;
    }
}
