//! Which stimuli are shown in which trial: pure functions of a seed and a subject.
//!
//! Each purpose (relabelling, blocks, order, positions) draws from a branch of its own, so that a
//! change in one shifts none of the others.

mod balanced;
mod blocks;
mod plane;
mod ranking;
mod square;
mod triads;

pub(crate) use balanced::balanced_sets;
pub use ranking::ScheduleError;
pub(crate) use ranking::{RankingSchedule, is_ranked};
pub(crate) use square::square_rounds;
pub(crate) use triads::{Triad, triads};

use selvedge_foundation::numerics::Random;

/// The generator of one subject in one experiment of a study.
pub(crate) fn subject_random(study_seed: u64, experiment: &str, subject: &str) -> Random {
    Random::new(study_seed).branch(experiment).branch(subject)
}

/// `n_rounds` orders of 0…n−1. No stimulus comes twice in a row where there are two or more.
pub(crate) fn rounds(n: usize, n_rounds: usize, random: &mut Random) -> Vec<Vec<usize>> {
    let mut last = None;
    let one = |_| {
        let mut order: Vec<usize> = (0..n).collect();
        random.shuffle(&mut order);
        if n > 1 && order.first().copied() == last {
            order.swap(0, 1 + random.index(n - 1));
        }
        last = order.last().copied();
        order
    };
    (0..n_rounds).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_round_has_each_once_and_none_twice_in_a_row() {
        for seed in 0..50 {
            let made = rounds(5, 4, &mut Random::new(seed));
            let flat: Vec<usize> = made.iter().flatten().copied().collect();
            assert!(flat.windows(2).all(|pair| pair[0] != pair[1]), "{flat:?}");
            for mut round in made {
                round.sort_unstable();
                assert_eq!(round, [0, 1, 2, 3, 4]);
            }
        }
    }

    #[test]
    fn one_stimulus_comes_again_and_again() {
        assert_eq!(rounds(1, 3, &mut Random::new(1)), [[0], [0], [0]]);
        assert!(rounds(0, 2, &mut Random::new(1)).iter().all(Vec::is_empty));
    }
}
