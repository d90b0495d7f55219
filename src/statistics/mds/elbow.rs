//! How many dimensions are worth it, by rules that anybody can repeat.

/// How the loss falls from dimension to dimension, and what two rules make of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Elbow {
    /// The dimensions, rising one by one.
    pub dims: Vec<usize>,
    /// The loss in each.
    pub loss: Vec<f64>,
    /// The loss taken for one dimension less than the first, where one is.
    pub before: Option<f64>,
    /// How much the loss falls on the way to each; `None` where nothing stands before.
    pub first_differences: Vec<Option<f64>>,
    /// The fall to each less the fall after it: large where the curve bends.
    pub second_differences: Vec<Option<f64>>,
    /// Where the second difference is largest; of equals, the fewest dimensions.
    pub by_bend: Option<usize>,
    /// The fewest dimensions whose loss lies below the 5 % point of data without structure.
    pub below_chance: Option<usize>,
}

impl Elbow {
    /// Of losses in rising dimensions. `before` stands for one dimension less than the first: the
    /// mean loss of data without structure on a line, when the first is one. `chance` holds 5 %
    /// points of data without structure, dimension by dimension, or nothing.
    pub fn of(losses: &[(usize, f64)], before: Option<f64>, chance: &[f64]) -> Self {
        let loss: Vec<f64> = losses.iter().map(|(_, loss)| *loss).collect();
        let dims: Vec<usize> = losses.iter().map(|(dims, _)| *dims).collect();
        let at = |i: usize| {
            if i == 0 {
                before
            } else {
                loss.get(i - 1).copied()
            }
        };
        let fall = |i: usize| Some(at(i)? - at(i + 1)?);
        let n = loss.len();
        let first_differences: Vec<Option<f64>> = (0..n).map(fall).collect();
        let bend = |i: usize| Some(fall(i)? - fall(i + 1)?);
        let second_differences: Vec<Option<f64>> = (0..n).map(bend).collect();
        let mut by_bend: Option<(usize, f64)> = None;
        for (&k, bend) in dims.iter().zip(&second_differences) {
            if let Some(bend) = *bend
                && by_bend.is_none_or(|(_, best)| bend > best)
            {
                by_bend = Some((k, bend));
            }
        }
        let is_below = |(_, (loss, chance)): &(&usize, (&f64, &f64))| loss < chance;
        let below_chance = dims.iter().zip(loss.iter().zip(chance)).find(is_below);
        Self {
            by_bend: by_bend.map(|(k, _)| k),
            below_chance: below_chance.map(|(k, _)| *k),
            before,
            first_differences,
            second_differences,
            dims,
            loss,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bend_is_where_the_fall_ends() {
        let losses = [(1, 0.40), (2, 0.15), (3, 0.12), (4, 0.10)];
        let found = Elbow::of(&losses, Some(0.45), &[0.38, 0.14, 0.13, 0.05]);
        assert_eq!(found.by_bend, Some(2));
        assert_eq!(found.below_chance, Some(3));
        assert!((found.second_differences[1].unwrap() - 0.22).abs() < 1e-12);
        assert_eq!(found.second_differences[3], None);
    }

    #[test]
    fn one_dimension_is_chosen_only_against_what_chance_gives() {
        let losses = [(1, 0.10), (2, 0.08), (3, 0.07)];
        assert_eq!(Elbow::of(&losses, Some(0.4), &[]).by_bend, Some(1));
        assert_eq!(Elbow::of(&losses, None, &[]).by_bend, Some(2));
        assert_eq!(Elbow::of(&losses[..1], None, &[]).by_bend, None);
    }
}
