//! What weavers call a repeat, as far as its lattice in the threads tells.

use super::basis::{Basis, generated, greatest_divisor, whole};

/// The name of the weave that repeats by `repeat` in threads that cross by `threads`, if the
/// lattice alone tells it: a satin of 5 and its sateen look alike.
pub(super) fn weave_name(threads: &Basis, repeat: &Basis) -> Option<String> {
    let steps = [repeat.p1, repeat.p2].map(|vector| threads.coordinates(vector).map(whole));
    let [[across, shift], [_, down]] = generated(&steps)?;
    match (across, shift, down) {
        (1, 1, 2) => Some("plain weave".to_owned()),
        (1, shift, n) if n > 2 && (shift == 1 || shift == n - 1) => {
            Some(format!("twill of {n} threads"))
        }
        (1, 2, 4) | (2, 1, 2) => Some("rib of 2 threads".to_owned()),
        (1, shift, n) if n > 4 && greatest_divisor(shift, n) == 1 => {
            Some(format!("satin of {n} threads"))
        }
        (n, shift, d) if n > 1 && shift == n && d == 2 * n => {
            Some(format!("basket of {n} threads"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_have_the_names_of_their_weaves() {
        let threads = Basis::new([7.0, 1.0], [-1.2, 8.0]);
        for ([first, second], expected) in [
            ([[1.0, 1.0], [1.0, -1.0]], Some("plain weave")),
            ([[1.0, 1.0], [0.0, 4.0]], Some("twill of 4 threads")),
            ([[1.0, -1.0], [0.0, 3.0]], Some("twill of 3 threads")),
            ([[1.0, 2.0], [2.0, -1.0]], Some("satin of 5 threads")),
            ([[1.0, 3.0], [0.0, 8.0]], Some("satin of 8 threads")),
            ([[2.0, 2.0], [2.0, -2.0]], Some("basket of 2 threads")),
            ([[3.0, 3.0], [0.0, 6.0]], Some("basket of 3 threads")),
            ([[1.0, 2.0], [0.0, 4.0]], Some("rib of 2 threads")),
            ([[2.0, 1.0], [0.0, 2.0]], Some("rib of 2 threads")),
            ([[4.0, 0.0], [0.0, 4.0]], None),
            ([[1.0, 0.0], [0.0, 1.0]], None),
        ] {
            let repeat = Basis::new(threads.place(first), threads.place(second)).reduced();
            let name = weave_name(&threads, &repeat);
            assert_eq!(name.as_deref(), expected, "{first:?} {second:?}");
        }
    }
}
