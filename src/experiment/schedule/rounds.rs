//! Every stimulus once a round, in an order by chance.

use selvedge_foundation::numerics::Random;

/// `n_rounds` orders of 0…n−1. No stimulus comes twice in a row where there are two or more.
pub fn rounds(n: usize, n_rounds: usize, random: &mut Random) -> Vec<Vec<usize>> {
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
