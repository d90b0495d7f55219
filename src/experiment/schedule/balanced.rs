//! Sets of equal size in which every two stimuli meet as often as may be.

use super::plane::{LINE_POINTS, Lines};
use selvedge_foundation::numerics::Random;

/// Tries at an exchange, for every set.
const EXCHANGES_A_SET: usize = 1000;
/// Tries at the arrangement of a set.
const TRIES: usize = 24;

/// Sets of `size` out of `n` stimuli, in order and by position: every stimulus comes `repeats`
/// times, or once more where the sets do not come out even.
///
/// The lines of a plane where there is one and the repeats fill it: every two meet equally often.
/// Otherwise each set is filled by those that came least and met its members least.
pub(crate) fn balanced_sets(
    (n, size): (usize, usize),
    repeats: usize,
    random: &Random,
) -> Vec<Vec<usize>> {
    let plane = Lines::over(n).filter(|_| size == LINE_POINTS);
    let n_through = plane.as_ref().map_or(0, |plane| plane.through(0).count());
    let mut sets = match plane {
        Some(plane) if repeats.is_multiple_of(n_through) => {
            let mut labels: Vec<usize> = (0..n).collect();
            random.branch("relabelling").shuffle(&mut labels);
            let lines = plane
                .lines
                .iter()
                .map(|line| line.map(|at| labels[at]).to_vec());
            let lines: Vec<Vec<usize>> = lines.collect();
            vec![lines; repeats / n_through].concat()
        }
        _ => filled((n, size), repeats, &mut random.branch("sets")),
    };
    random.branch("order").shuffle(&mut sets);
    arrange(&mut sets, n, &mut random.branch("positions"));
    sets
}

fn filled((n, size): (usize, usize), repeats: usize, random: &mut Random) -> Vec<Vec<usize>> {
    let mut times = vec![0_usize; n];
    let mut met = vec![vec![0_usize; n]; n];
    let n_sets = (n * repeats).div_ceil(size);
    let mut sets = Vec::with_capacity(n_sets);
    for _ in 0..n_sets {
        let mut set: Vec<usize> = Vec::with_capacity(size);
        while set.len() < size.min(n) {
            let mut free: Vec<usize> = (0..n).filter(|one| !set.contains(one)).collect();
            random.shuffle(&mut free);
            let cost = |one: &usize| {
                (
                    times[*one],
                    set.iter().map(|other| met[*one][*other]).sum::<usize>(),
                )
            };
            set.extend(free.into_iter().min_by_key(cost));
        }
        for &one in &set {
            times[one] += 1;
            for &other in &set {
                met[one][other] += 1;
            }
        }
        sets.push(set);
    }
    even_out(&mut sets, &mut met, random);
    sets
}

/// Exchanges members of two sets while that lets pairs meet more evenly: the sum of the squares of
/// how often they meet does not rise.
fn even_out(sets: &mut [Vec<usize>], met: &mut [Vec<usize>], random: &mut Random) {
    let (n_sets, size) = (sets.len(), sets.first().map_or(0, Vec::len));
    for _ in 0..EXCHANGES_A_SET * n_sets {
        let [a, b] = [random.index(n_sets), random.index(n_sets)];
        let [at_a, at_b] = [random.index(size), random.index(size)];
        let (x, y) = (sets[a][at_a], sets[b][at_b]);
        if a == b || sets[a].contains(&y) || sets[b].contains(&x) {
            continue;
        }
        let rest = |set: &[usize], out: usize| -> Vec<usize> {
            set.iter().copied().filter(|one| *one != out).collect()
        };
        let (rest_a, rest_b) = (rest(&sets[a], x), rest(&sets[b], y));
        let sum = |one: usize, others: &[usize]| {
            others.iter().map(|other| met[one][*other]).sum::<usize>()
        };
        // Each that leaves frees 2m − 1 squares, each that comes adds 2m + 1.
        let freed = sum(x, &rest_a) + sum(y, &rest_b);
        let added = sum(y, &rest_a) + sum(x, &rest_b) + rest_a.len() + rest_b.len();
        if added > freed {
            continue;
        }
        for (out, comes, others) in [(x, y, &rest_a), (y, x, &rest_b)] {
            for &other in others {
                met[out][other] -= 1;
                met[other][out] -= 1;
                met[comes][other] += 1;
                met[other][comes] += 1;
            }
        }
        sets[a][at_a] = y;
        sets[b][at_b] = x;
    }
}

/// Puts each set in an order in which its members stand where they stood least before.
fn arrange(sets: &mut [Vec<usize>], n: usize, random: &mut Random) {
    let size = sets.first().map_or(0, Vec::len);
    let mut stood = vec![vec![0_usize; size]; n];
    for set in sets {
        let cost = |set: &[usize]| -> usize {
            set.iter()
                .enumerate()
                .map(|(at, &one)| stood[one][at].pow(2))
                .sum()
        };
        let mut best = set.clone();
        for _ in 0..TRIES {
            random.shuffle(set);
            if cost(set) < cost(&best) {
                best.clone_from(set);
            }
        }
        for (at, &one) in best.iter().enumerate() {
            stood[one][at] += 1;
        }
        *set = best;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often each stimulus comes, and the fewest and most times that two meet.
    fn counted(n: usize, sets: &[Vec<usize>]) -> (Vec<usize>, [usize; 2]) {
        let times = |one: usize| sets.iter().filter(|set| set.contains(&one)).count();
        let met = |a: usize, b: usize| {
            let both = |set: &&Vec<usize>| set.contains(&a) && set.contains(&b);
            sets.iter().filter(both).count()
        };
        let pairs = (0..n).flat_map(|a| (0..a).map(move |b| [a, b]));
        let met: Vec<usize> = pairs.map(|[a, b]| met(a, b)).collect();
        let ends = [*met.iter().min().unwrap(), *met.iter().max().unwrap()];
        ((0..n).map(times).collect(), ends)
    }

    #[test]
    fn sixteen_meet_once_each_in_twenty_sets_of_four() {
        let sets = balanced_sets((16, 4), 5, &Random::new(1));
        assert_eq!(sets.len(), 20);
        assert_eq!(counted(16, &sets), (vec![5; 16], [1, 1]));
        let firsts = (0..16).map(|one| sets.iter().filter(|set| set[0] == one).count());
        assert!(firsts.max() <= Some(3), "spread over positions: {sets:?}");
    }

    #[test]
    fn other_numbers_are_as_even_as_may_be() {
        for (n, size, repeats) in [(10, 4, 6), (7, 3, 6), (8, 5, 5)] {
            let sets = balanced_sets((n, size), repeats, &Random::new(2));
            let (times, [fewest, most]) = counted(n, &sets);
            assert!(
                times.iter().all(|&t| t == repeats || t == repeats + 1),
                "{times:?}"
            );
            assert!(
                fewest >= 1 && most <= fewest + 2,
                "{n} in {size}: {fewest} to {most}"
            );
            assert!(sets.iter().all(|set| set.len() == size), "{sets:?}");
        }
    }
}
