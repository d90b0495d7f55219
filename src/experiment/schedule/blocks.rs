//! Trials split into blocks in which every target stands once: perfect matchings of targets and
//! sets (Kőnig 1916: a graph of equal degree on both sides splits into as many of them).

use selvedge_foundation::numerics::Random;

/// Splits the pairs (target, set) into blocks; `sets_of[target]` are the sets in which it stands,
/// and every target has as many. In no block a set stands twice. Gives for each block the set of
/// each target.
///
/// Targets are filled up by dummies to as many as there are sets, each with as many sets as a
/// target has, so that the graph has one degree on both sides; `None` if that cannot be, for the
/// sets do not all stand with the same number of targets.
pub(super) fn split(
    sets_of: &[Vec<usize>],
    n_sets: usize,
    random: &mut Random,
) -> Option<Vec<Vec<usize>>> {
    let degree = sets_of.first().map_or(0, Vec::len);
    let mut left = with_dummies(sets_of, n_sets, degree, random)?;
    let mut blocks = Vec::with_capacity(degree);
    for _ in 0..degree {
        for sets in &mut left {
            random.shuffle(sets);
        }
        let matching = matching(&left, n_sets)?;
        for (sets, taken) in left.iter_mut().zip(&matching) {
            sets.retain(|set| set != taken);
        }
        blocks.push(matching[..sets_of.len()].to_vec());
    }
    Some(blocks)
}

/// The targets and the dummies that bring every set to `degree`.
fn with_dummies(
    sets_of: &[Vec<usize>],
    n_sets: usize,
    degree: usize,
    random: &mut Random,
) -> Option<Vec<Vec<usize>>> {
    let mut missing = vec![degree; n_sets];
    for &set in sets_of.iter().flatten() {
        let missing = missing.get_mut(set)?;
        *missing = missing.checked_sub(1)?;
    }
    let n_dummies = n_sets.checked_sub(sets_of.len())?;
    let mut all = sets_of.to_vec();
    let mut order: Vec<usize> = (0..n_sets).collect();
    random.shuffle(&mut order);
    // Sets that miss most are dealt first: no dummy gets one twice.
    order.sort_by_key(|&set| std::cmp::Reverse(missing[set]));
    let dealt = order.iter().flat_map(|&set| vec![set; missing[set]]);
    let mut dummies = vec![Vec::with_capacity(degree); n_dummies];
    for (nth, set) in dealt.enumerate() {
        dummies.get_mut(nth % n_dummies.max(1))?.push(set);
    }
    all.extend(dummies);
    let is_even = |sets: &Vec<usize>| {
        let mut sorted = sets.clone();
        sorted.sort_unstable();
        sorted.dedup();
        sorted.len() == degree
    };
    all.iter().all(is_even).then_some(all)
}

/// The set of each node, each set once, by augmenting paths (Kuhn 1955); `None` if there is none.
fn matching(sets_of: &[Vec<usize>], n_sets: usize) -> Option<Vec<usize>> {
    let mut owner = vec![None; n_sets];
    for node in 0..sets_of.len() {
        let mut seen = vec![false; n_sets];
        if !place(node, sets_of, &mut owner, &mut seen) {
            return None;
        }
    }
    let mut set_of = vec![0; sets_of.len()];
    for (set, node) in owner.iter().enumerate() {
        if let Some(node) = node {
            set_of[*node] = set;
        }
    }
    Some(set_of)
}

fn place(
    node: usize,
    sets_of: &[Vec<usize>],
    owner: &mut [Option<usize>],
    seen: &mut [bool],
) -> bool {
    for &set in &sets_of[node] {
        if std::mem::replace(&mut seen[set], true) {
            continue;
        }
        let is_free = owner[set].is_none_or(|other| place(other, sets_of, owner, seen));
        if is_free {
            owner[set] = Some(node);
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::super::plane::Lines;
    use super::*;

    #[test]
    fn every_target_stands_once_in_a_block_and_no_set_twice() {
        for n_points in [13, 16] {
            let plane = Lines::over(n_points).unwrap();
            let sets_of: Vec<Vec<usize>> =
                (0..n_points).map(|p| plane.through(p).collect()).collect();
            for seed in 0..50 {
                let mut random = Random::new(seed);
                let blocks = split(&sets_of, plane.lines.len(), &mut random).unwrap();
                assert_eq!(blocks.len(), sets_of[0].len());
                let mut pairs = Vec::new();
                for block in &blocks {
                    let mut sets = block.clone();
                    sets.sort_unstable();
                    sets.dedup();
                    assert_eq!(sets.len(), n_points, "a set twice in a block");
                    pairs.extend(block.iter().enumerate().map(|(target, set)| (target, *set)));
                }
                pairs.sort_unstable();
                let all = sets_of
                    .iter()
                    .enumerate()
                    .flat_map(|(target, sets)| sets.iter().map(move |set| (target, *set)));
                assert_eq!(pairs, all.collect::<Vec<_>>(), "every pair once");
            }
        }
    }

    #[test]
    fn what_cannot_be_split_is_not() {
        let mut random = Random::new(1);
        assert_eq!(split(&[vec![0, 1], vec![0, 1]], 3, &mut random), None);
        assert_eq!(split(&[vec![0, 9]], 2, &mut random), None);
        assert_eq!(split(&[], 0, &mut random), Some(Vec::new()));
    }
}
