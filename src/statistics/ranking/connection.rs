//! Which items comparisons join, and which they leave apart or one above the other for good.

use crate::{Computed, undefined};

/// How the comparisons of some items hang together. Only where they are whole is there a most
/// likely scale with finite values (Ford 1957; Hunter 2004, assumption 1).
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Connection {
    /// Every item was preferred to every other, at once or by way of others.
    Whole,
    /// Groups, higher ones first; no item of a later one was ever preferred to one of an earlier.
    Ordered(Vec<Vec<usize>>),
    /// Groups that no chain of comparisons joins, by their first items.
    Apart(Vec<Vec<usize>>),
}

impl Connection {
    /// Of `n_items` by whether the first of two was ever preferred to the second.
    pub(super) fn of(n_items: usize, is_above: impl Fn(usize, usize) -> bool) -> Self {
        let either = |i, j| is_above(i, j) || is_above(j, i);
        let apart = mutual(n_items, &reached(n_items, either));
        if apart.len() > 1 {
            return Self::Apart(apart);
        }
        let reach = reached(n_items, is_above);
        let mut groups = mutual(n_items, &reach);
        if groups.len() < 2 {
            return Self::Whole;
        }
        // A group reaches whatever those below it reach, and themselves.
        let n_below = |group: &Vec<usize>| reach[group[0]].iter().filter(|&&r| r).count();
        groups.sort_by_key(|group| (n_items - n_below(group), group[0]));
        Self::Ordered(groups)
    }

    /// The groups; none where the comparisons are whole.
    pub fn groups(&self) -> &[Vec<usize>] {
        match self {
            Self::Whole => &[],
            Self::Ordered(groups) | Self::Apart(groups) => groups,
        }
    }

    /// Refuses what is not whole, in one line with the groups by the names that the caller has for
    /// items.
    ///
    /// # Errors
    /// The comparisons are not whole.
    pub fn check(&self, name: impl Fn(usize) -> String) -> Computed<()> {
        let listed = |between: &str| {
            let names = |group: &Vec<usize>| {
                let names: Vec<String> = group.iter().map(|&item| name(item)).collect();
                format!("{{{}}}", names.join(", "))
            };
            let groups: Vec<String> = self.groups().iter().map(names).collect();
            groups.join(between)
        };
        let reason = match self {
            Self::Whole => return Ok(()),
            Self::Ordered(_) => format!(
                "no item of a later group was ever preferred to one of an earlier: {}; without a \
                 prior the distance of the groups is infinite",
                listed(" over ")
            ),
            Self::Apart(_) => format!(
                "no chain of comparisons joins {}: nothing tells the distance of the groups",
                listed(" and ")
            ),
        };
        undefined(reason)
    }
}

/// The name of an item whose name is not known here: its number from 1.
pub(super) fn number(item: usize) -> String {
    (item + 1).to_string()
}

/// Which items a chain of steps leads to from each, itself included (Warshall 1962).
fn reached(n_items: usize, steps: impl Fn(usize, usize) -> bool) -> Vec<Vec<bool>> {
    let row = |i| (0..n_items).map(|j| i == j || steps(i, j)).collect();
    let mut reach: Vec<Vec<bool>> = (0..n_items).map(row).collect();
    for via in 0..n_items {
        let onward = reach[via].clone();
        for row in reach.iter_mut().filter(|row| row[via]) {
            for (r, &on) in row.iter_mut().zip(&onward) {
                *r |= on;
            }
        }
    }
    reach
}

/// Groups of items that reach each other, by their first items.
fn mutual(n_items: usize, reach: &[Vec<bool>]) -> Vec<Vec<usize>> {
    let group = |i: usize| -> Vec<usize> {
        (0..n_items)
            .filter(|&j| reach[i][j] && reach[j][i])
            .collect()
    };
    let is_first = |(i, group): &(usize, Vec<usize>)| group.first() == Some(i);
    let groups = (0..n_items).map(|i| (i, group(i))).filter(is_first);
    groups.map(|(_, group)| group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(n_items: usize, wins: &[(usize, usize)]) -> Connection {
        Connection::of(n_items, |i, j| wins.contains(&(i, j)))
    }

    #[test]
    fn a_circle_is_whole_and_a_chain_falls_into_its_links() {
        assert_eq!(of(3, &[(0, 1), (1, 2), (2, 0)]), Connection::Whole);
        let chain = of(3, &[(2, 0), (0, 1)]);
        assert_eq!(chain, Connection::Ordered(vec![vec![2], vec![0], vec![1]]));
        assert_eq!(of(1, &[]), Connection::Whole);
    }

    #[test]
    fn groups_are_named_the_higher_first() {
        let circles = [(0, 1), (1, 0), (2, 3), (3, 2), (3, 0)];
        let found = of(4, &circles);
        assert_eq!(found.groups(), [vec![2, 3], vec![0, 1]]);
        let named = found.check(|i| ["silk", "wool", "felt", "denim"][i].to_owned());
        let reason = named.map_err(|e| e.reason).unwrap_err();
        assert!(
            reason.contains("{felt, denim} over {silk, wool}"),
            "{reason}"
        );
    }

    #[test]
    fn what_nothing_joins_is_apart_even_where_each_part_is_whole() {
        let found = of(5, &[(0, 2), (2, 0), (1, 3), (3, 1)]);
        assert_eq!(
            found,
            Connection::Apart(vec![vec![0, 2], vec![1, 3], vec![4]])
        );
        let reason = found.check(number).map_err(|e| e.reason).unwrap_err();
        assert!(reason.contains("{1, 3} and {2, 4} and {5}"), "{reason}");
    }
}
