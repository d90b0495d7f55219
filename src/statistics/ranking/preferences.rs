//! How often each of some items was preferred to each other.

use super::connection::Connection;
use crate::{Computed, Undefined, undefined};

/// Counts of comparisons of two items.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Preferences {
    n_items: usize,
    wins: Vec<u64>,
}

/// Two items that were compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct Compared {
    /// Their indices, the smaller first.
    pub(super) items: [usize; 2],
    /// How often each was preferred.
    pub(super) wins: [u64; 2],
}

impl Compared {
    pub(super) fn n(&self) -> u64 {
        self.wins[0] + self.wins[1]
    }
}

/// The most that a step of values changes the difference of two items that were compared.
pub(super) fn span_of_pairs(pairs: &[Compared], step: &[f64]) -> f64 {
    let of_pair = |pair: &Compared| (step[pair.items[0]] - step[pair.items[1]]).abs();
    pairs.iter().map(of_pair).fold(0.0, f64::max)
}

impl Preferences {
    /// Of items that were not compared yet.
    pub fn new(n_items: usize) -> Self {
        Self {
            n_items,
            wins: vec![0; n_items * n_items],
        }
    }

    /// From a square table: how often the item of the row was preferred to that of the column.
    ///
    /// # Errors
    /// A table that is not square, an item preferred to itself.
    pub fn of_wins(rows: &[Vec<u64>]) -> Computed<Self> {
        let mut all = Self::new(rows.len());
        all.wins = square(rows)?;
        Ok(all)
    }

    /// Every ranking, best first, taken apart into its pairs. They are not independent: errors of
    /// a scale from them are too small, and `plackett_luce` has the right
    /// ones.
    ///
    /// # Errors
    /// As `plackett_luce`.
    pub fn of_rankings<R: AsRef<[usize]>>(n_items: usize, rankings: &[R]) -> Computed<Self> {
        check_rankings(n_items, rankings)?;
        let mut all = Self::new(n_items);
        for ranking in rankings {
            let ranking = ranking.as_ref();
            for (place, &upper) in ranking.iter().enumerate() {
                for &lower in &ranking[place + 1..] {
                    all.wins[upper * n_items + lower] += 1;
                }
            }
        }
        Ok(all)
    }

    /// All comparisons of several together, of as many items each.
    ///
    /// # Errors
    /// None, or other numbers of items.
    pub fn together<'a>(all: impl IntoIterator<Item = &'a Self>) -> Computed<Self> {
        let mut all = all.into_iter();
        let first = all.next();
        let mut sum = first
            .cloned()
            .ok_or_else(|| Undefined::because("no comparisons"))?;
        for one in all {
            if one.n_items != sum.n_items {
                return undefined(format!("{} items beside {}", one.n_items, sum.n_items));
            }
            for (count, more) in sum.wins.iter_mut().zip(&one.wins) {
                *count += more;
            }
        }
        Ok(sum)
    }

    /// Number of items.
    pub fn n_items(&self) -> usize {
        self.n_items
    }

    /// How often an item was preferred to another; 0 for items that are unknown.
    pub fn wins(&self, upper: usize, lower: usize) -> u64 {
        if upper < self.n_items && lower < self.n_items {
            self.wins[upper * self.n_items + lower]
        } else {
            0
        }
    }

    /// Comparisons in all.
    pub fn n_comparisons(&self) -> u64 {
        self.compared().iter().map(Compared::n).sum()
    }

    /// How they hang together.
    pub fn connection(&self) -> Connection {
        Connection::of(self.n_items, |i, j| self.wins(i, j) > 0)
    }

    /// The pairs that were compared.
    pub(super) fn compared(&self) -> Vec<Compared> {
        let pairs = (0..self.n_items).flat_map(|i| (i + 1..self.n_items).map(move |j| (i, j)));
        let of_pair = |(i, j)| Compared {
            items: [i, j],
            wins: [self.wins(i, j), self.wins(j, i)],
        };
        pairs.map(of_pair).filter(|pair| pair.n() > 0).collect()
    }

    /// Refuses fewer than two items and none compared.
    pub(super) fn check(&self) -> Computed<()> {
        check_items(self.n_items)?;
        if self.compared().is_empty() {
            return undefined("no comparisons");
        }
        Ok(())
    }

    /// Pairs whose number of comparisons is wrong, in words for a reason.
    pub(super) fn pairs_where(&self, is_wrong: impl Fn(u64) -> bool) -> Vec<String> {
        let n = self.n_items;
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let count = |&(i, j): &(usize, usize)| is_wrong(self.wins(i, j) + self.wins(j, i));
        let name = |(i, j)| format!("{} and {}", i + 1, j + 1);
        pairs.filter(count).map(name).collect()
    }
}

fn square(rows: &[Vec<u64>]) -> Computed<Vec<u64>> {
    for (i, row) in rows.iter().enumerate() {
        if row.len() != rows.len() {
            let (n, found) = (rows.len(), row.len());
            return undefined(format!("row {} has {found} of {n} columns", i + 1));
        }
        if row[i] != 0 {
            return undefined(format!("item {} is preferred to itself", i + 1));
        }
    }
    Ok(rows.concat())
}

pub(super) fn check_items(n_items: usize) -> Computed<()> {
    match n_items {
        0 => undefined("no items"),
        1 => undefined("one item alone: nothing to compare"),
        _ => Ok(()),
    }
}

/// Refuses rankings that are none, with the number of the first.
pub(super) fn check_rankings<R: AsRef<[usize]>>(n_items: usize, rankings: &[R]) -> Computed<()> {
    check_items(n_items)?;
    if rankings.is_empty() {
        return undefined("no rankings");
    }
    for (index, ranking) in rankings.iter().enumerate() {
        check_distinct(n_items, ranking.as_ref()).map_err(|why| {
            let reason = format!("ranking {}: {why}", index + 1);
            Undefined::because(reason)
        })?;
    }
    Ok(())
}

/// Says what is wrong with items that should be two or more, known and different.
pub(super) fn check_distinct(n_items: usize, items: &[usize]) -> Result<(), String> {
    if items.len() < 2 {
        return Err(format!("{} items, at least 2 are needed", items.len()));
    }
    for (place, &item) in items.iter().enumerate() {
        if item >= n_items {
            return Err(format!("item {} of {n_items}", item + 1));
        }
        if items[..place].contains(&item) {
            return Err(format!("item {} twice", item + 1));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Preferences {
        /// Counts one comparison.
        pub(in crate::ranking) fn prefer(&mut self, upper: usize, lower: usize) {
            self.wins[upper * self.n_items + lower] += 1;
        }
    }

    #[test]
    fn a_ranking_is_taken_apart_into_all_of_its_pairs() -> Computed<()> {
        let found = Preferences::of_rankings(4, &[[2, 0, 3], [3, 2, 1]])?;
        let mut by_hand = Preferences::new(4);
        for (upper, lower) in [(2, 0), (2, 3), (0, 3), (3, 2), (3, 1), (2, 1)] {
            by_hand.prefer(upper, lower);
        }
        assert_eq!(found, by_hand);
        assert_eq!(found.n_comparisons(), 6);
        assert_eq!(found.compared().len(), 5);
        Ok(())
    }

    #[test]
    fn tables_and_counting_one_by_one_agree() -> Computed<()> {
        let mut counted = Preferences::new(2);
        counted.prefer(1, 0);
        let table = Preferences::of_wins(&[vec![0, 0], vec![1, 0]])?;
        assert_eq!(table, counted);
        assert_eq!(counted.n_comparisons(), 1);
        Ok(())
    }

    #[test]
    fn comparisons_of_several_add_up() -> Computed<()> {
        let mut one = Preferences::new(3);
        one.prefer(0, 1);
        one.prefer(2, 1);
        let both = Preferences::together([&one, &one])?;
        assert_eq!((both.wins(0, 1), both.wins(2, 1)), (2, 2));
        assert!(Preferences::together([&one, &Preferences::new(2)]).is_err());
        assert!(Preferences::together([]).is_err(), "nothing");
        Ok(())
    }

    #[test]
    fn what_is_no_comparison_is_refused_with_its_place() {
        let reason = |found: Computed<Preferences>| found.map_err(|e| e.reason).unwrap_err();
        let short = reason(Preferences::of_wins(&[vec![0, 1], vec![1]]));
        assert_eq!(short, "row 2 has 1 of 2 columns");
        let own = reason(Preferences::of_wins(&[vec![0, 1], vec![1, 3]]));
        assert_eq!(own, "item 2 is preferred to itself");
        let twice = reason(Preferences::of_rankings(3, &[vec![0, 1], vec![2, 1, 2]]));
        assert_eq!(twice, "ranking 2: item 3 twice");
        let unknown = reason(Preferences::of_rankings(3, &[[0, 3]]));
        assert_eq!(unknown, "ranking 1: item 4 of 3");
        let alone = reason(Preferences::of_rankings(3, &[[0]]));
        assert_eq!(alone, "ranking 1: 1 items, at least 2 are needed");
    }
}
