//! Triads of the odd one out (after Allerkamp et al.): every pair of stimuli once, two alike and
//! one odd.

use selvedge_foundation::numerics::Random;

/// One trial: which two stimuli, which of them is odd, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Triad {
    /// The stimulus that stands twice.
    pub twice: usize,
    /// The odd one.
    pub odd: usize,
    /// The position of the odd one, 0…2.
    pub position: usize,
}

impl Triad {
    /// The stimuli by position.
    pub(crate) fn items(&self) -> [usize; 3] {
        [0, 1, 2].map(|position| {
            if position == self.position {
                self.odd
            } else {
                self.twice
            }
        })
    }
}

/// All n(n − 1)/2 triads of a subject, in order.
///
/// The odd one stands in every position equally often, or once more. Which of a pair is odd changes
/// from one subject to the next; `nth_subject` counts them from 0. Two trials in a row have other
/// odd ones where that can be.
pub(crate) fn triads(n_stimuli: usize, nth_subject: usize, subject: &Random) -> Vec<Triad> {
    let mut pairs = Vec::with_capacity(n_stimuli * n_stimuli.saturating_sub(1) / 2);
    for a in 0..n_stimuli {
        for b in a + 1..n_stimuli {
            // Neighbouring pairs begin with different ones, so that no stimulus is mostly odd.
            let is_turned = (a + b + nth_subject) % 2 == 1;
            pairs.push(if is_turned { [b, a] } else { [a, b] });
        }
    }
    subject.branch("order").shuffle(&mut pairs);
    let mut positions: Vec<usize> = (0..pairs.len()).map(|nth| nth % 3).collect();
    subject.branch("positions").shuffle(&mut positions);
    spread(&mut pairs);
    let triad = |([odd, twice], position): ([usize; 2], usize)| Triad {
        twice,
        odd,
        position,
    };
    pairs.into_iter().zip(positions).map(triad).collect()
}

/// Brings a later pair forward where two in a row have the same odd one.
fn spread(pairs: &mut [[usize; 2]]) {
    for nth in 1..pairs.len() {
        let before = pairs[nth - 1][0];
        let other = (nth..pairs.len()).find(|&later| pairs[later][0] != before);
        if let Some(other) = other {
            pairs[nth..=other].rotate_right(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::subject_random;
    use super::*;

    #[test]
    fn seven_fabrics_make_21_triads_balanced_in_position_and_over_subjects() {
        let mut odd = [[0; 7]; 7];
        for nth in 0..8 {
            let random = subject_random(7, "odd one out", &format!("p{nth}"));
            let found = triads(7, nth, &random);
            assert_eq!(found.len(), 21);
            let mut positions = [0; 3];
            for triad in &found {
                positions[triad.position] += 1;
                odd[triad.odd][triad.twice] += 1;
                let items = triad.items();
                assert_eq!(items.iter().filter(|&&item| item == triad.odd).count(), 1);
                assert_eq!(items[triad.position], triad.odd);
            }
            assert_eq!(positions, [7; 3]);
            assert_eq!(found, triads(7, nth, &random), "no chance but the seed's");
        }
        for (a, row) in odd.iter().enumerate() {
            for (b, &n) in row.iter().enumerate() {
                assert_eq!(n, if a == b { 0 } else { 4 }, "{a} odd beside {b}");
            }
        }
    }

    #[test]
    fn few_stimuli_make_few_triads() {
        let random = Random::new(1);
        assert!(triads(0, 0, &random).is_empty() && triads(1, 0, &random).is_empty());
        assert_eq!(triads(2, 0, &random).len(), 1);
    }
}
