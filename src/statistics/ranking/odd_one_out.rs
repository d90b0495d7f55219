//! Distances from triads of two alike and one odd: how easily each pair was told apart.

use super::preferences::{check_distinct, check_items};
use crate::{Computed, Undefined, undefined};
use selvedge_foundation::named;

named! {
    /// How hard a choice was, as the subject graded it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Grade {
        /// Easy.
        Easy = "easy",
        /// Neither easy nor hard.
        Normal = "normal",
        /// Hard.
        Hard = "hard",
    }
    /// As files and people call it.
    pub fn name;
}

/// What a correct choice counts by its grade. A wrong one counts nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GradeWeights {
    /// Of an easy one, the most.
    pub easy: f64,
    /// Of one in between.
    pub normal: f64,
    /// Of a hard one, the least.
    pub hard: f64,
}

impl From<[f64; 3]> for GradeWeights {
    /// From easy to hard.
    fn from([easy, normal, hard]: [f64; 3]) -> Self {
        Self { easy, normal, hard }
    }
}

impl GradeWeights {
    fn check(self) -> Computed<()> {
        let Self { easy, normal, hard } = self;
        let is_falling = easy >= normal && normal >= hard && hard >= 0.0;
        if is_falling && easy > 0.0 && easy.is_finite() {
            return Ok(());
        }
        let reason = format!("weights {easy}, {normal}, {hard} do not fall from easy to hard");
        undefined(reason)
    }
}

/// One triad answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TriadAnswer {
    /// Indices of the two items, the one that was there twice and the odd one, in any order.
    pub pair: [usize; 2],
    /// Whether the odd one was found.
    pub is_correct: bool,
    /// How hard it was.
    pub grade: Grade,
}

/// Answers to the triads of one pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairTally {
    /// Indices of the two items, the smaller first.
    pub items: [usize; 2],
    /// Correct answers graded easy, normal and hard.
    pub correct: [usize; 3],
    /// Wrong answers graded easy, normal and hard.
    pub wrong: [usize; 3],
    /// Their distance: the sum of the weights over all answers.
    pub distance: f64,
}

impl PairTally {
    /// Triads answered.
    pub fn n(&self) -> usize {
        self.n_correct() + self.wrong.iter().sum::<usize>()
    }

    /// Triads answered correctly.
    pub fn n_correct(&self) -> usize {
        self.correct.iter().sum()
    }

    /// The distance for one answer: comparable where pairs were asked different numbers of times.
    pub(crate) fn mean_weight(&self) -> f64 {
        self.distance / self.n() as f64
    }
}

/// Wrong answers to triads that one item was part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ItemErrors {
    /// Triads with it, as odd one or as one of two alike.
    pub n_triads: usize,
    /// Wrong answers among them.
    pub n_wrong: usize,
}

/// Distances from triads.
#[derive(Debug, Clone, PartialEq)]
pub struct OddOneOut {
    /// Number of items.
    pub n_items: usize,
    /// Pairs that were asked, by their items.
    pub pairs: Vec<PairTally>,
    /// Pairs that were never asked.
    pub n_missing: usize,
    /// Pairs at the ceiling: always right and easy.
    pub n_ceiling: usize,
    /// Pairs at the floor: never right, or right for nothing.
    pub n_floor: usize,
    /// Wrong answers of each item; both items of a pair count.
    pub errors: Vec<ItemErrors>,
    /// What answers counted.
    pub weights: GradeWeights,
}

impl OddOneOut {
    /// Of answers, subjects together or one alone.
    ///
    /// # Errors
    /// Fewer than two items, no answers, one (with its number) whose items are unknown or the
    /// same, weights that are negative or do not fall from easy to hard.
    pub fn of(n_items: usize, answers: &[TriadAnswer], weights: GradeWeights) -> Computed<Self> {
        check_items(n_items)?;
        weights.check()?;
        if answers.is_empty() {
            return undefined("no answers");
        }
        let mut tallies = vec![[[0; 3]; 2]; n_items * n_items];
        let mut errors = vec![ItemErrors::default(); n_items];
        for (index, answer) in answers.iter().enumerate() {
            check_distinct(n_items, &answer.pair)
                .map_err(|why| Undefined::because(format!("answer {}: {why}", index + 1)))?;
            let [i, j] = answer.pair;
            let grade = answer.grade as usize;
            tallies[i.min(j) * n_items + i.max(j)][usize::from(!answer.is_correct)][grade] += 1;
            for item in answer.pair {
                errors[item].n_triads += 1;
                errors[item].n_wrong += usize::from(!answer.is_correct);
            }
        }
        let cells = (0..n_items).flat_map(|i| (i + 1..n_items).map(move |j| [i, j]));
        let pairs: Vec<PairTally> = cells
            .map(|items| weights.tally(items, tallies[items[0] * n_items + items[1]]))
            .filter(|pair| pair.n() > 0)
            .collect();
        Ok(Self {
            n_items,
            n_missing: n_items * (n_items - 1) / 2 - pairs.len(),
            n_ceiling: pairs.iter().filter(|p| p.correct[0] == p.n()).count(),
            n_floor: pairs.iter().filter(|p| p.distance <= 0.0).count(),
            pairs,
            errors,
            weights,
        })
    }

    /// Distances, row by row as [`Dissimilarities::new`] takes them; `None` on the diagonal and for
    /// pairs that were never asked. Only comparable where every pair was asked as often
    /// ([`Self::is_balanced`]).
    ///
    /// [`Dissimilarities::new`]: crate::mds::Dissimilarities::new
    pub fn distances(&self) -> Vec<Option<f64>> {
        self.table(|pair| pair.distance)
    }

    /// Likewise for one answer.
    pub fn mean_weights(&self) -> Vec<Option<f64>> {
        self.table(PairTally::mean_weight)
    }

    /// Whether every two items were asked, and as often.
    pub fn is_balanced(&self) -> bool {
        let mut counts = self.pairs.iter().map(PairTally::n);
        let first = counts.next();
        self.n_missing == 0 && counts.all(|n| Some(n) == first)
    }

    fn table(&self, value: impl Fn(&PairTally) -> f64) -> Vec<Option<f64>> {
        let n = self.n_items;
        let mut table = vec![None; n * n];
        for pair in &self.pairs {
            let [i, j] = pair.items;
            table[i * n + j] = Some(value(pair));
            table[j * n + i] = Some(value(pair));
        }
        table
    }
}

impl GradeWeights {
    fn tally(self, items: [usize; 2], [correct, wrong]: [[usize; 3]; 2]) -> PairTally {
        // Counts before weights: the sum does not depend on the order of answers.
        let [easy, normal, hard] = correct.map(|n| n as f64);
        PairTally {
            items,
            correct,
            wrong,
            distance: easy * self.easy + normal * self.normal + hard * self.hard,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    impl Default for GradeWeights {
        fn default() -> Self {
            [1.0, 0.5, 0.1].into()
        }
    }

    fn answer(pair: [usize; 2], is_correct: bool, grade: Grade) -> TriadAnswer {
        TriadAnswer {
            pair,
            is_correct,
            grade,
        }
    }

    fn five() -> Vec<TriadAnswer> {
        vec![
            answer([0, 1], true, Grade::Easy),
            answer([1, 0], true, Grade::Hard),
            answer([0, 2], false, Grade::Easy),
            answer([2, 0], false, Grade::Hard),
            answer([2, 1], true, Grade::Easy),
        ]
    }

    #[test]
    fn distances_and_errors_are_those_by_hand() -> Computed<()> {
        let found = OddOneOut::of(4, &five(), GradeWeights::default())?;
        let d = found.distances();
        assert_eq!(d[1], Some(1.1));
        assert_eq!((d[4], d[2], d[6]), (d[1], Some(0.0), Some(1.0)));
        assert_eq!((d[0], d[3]), (None, None), "itself, and never asked");
        assert_eq!((found.n_ceiling, found.n_floor, found.n_missing), (1, 1, 3));
        let errors: Vec<(usize, usize)> = found
            .errors
            .iter()
            .map(|e| (e.n_wrong, e.n_triads))
            .collect();
        assert_eq!(errors, [(2, 4), (0, 3), (2, 3), (0, 0)]);
        assert_eq!(found.pairs[1].wrong, [1, 0, 1]);
        assert_eq!(found.mean_weights()[1], Some(0.55));
        assert!(!found.is_balanced(), "asked twice and once");
        Ok(())
    }

    #[test]
    fn the_order_of_answers_and_of_a_pair_changes_nothing() -> Computed<()> {
        let mut answers: Vec<TriadAnswer> = five().into_iter().cycle().take(55).collect();
        let found = OddOneOut::of(3, &answers, GradeWeights::default())?;
        Random::new(2).shuffle(&mut answers);
        for answer in &mut answers {
            answer.pair.reverse();
        }
        assert_eq!(found, OddOneOut::of(3, &answers, GradeWeights::default())?);
        Ok(())
    }

    #[test]
    fn twelve_easy_answers_to_every_pair_are_all_at_the_ceiling() -> Computed<()> {
        let pairs = (0..7).flat_map(|i| (i + 1..7).map(move |j| [i, j]));
        let answers: Vec<TriadAnswer> = pairs
            .flat_map(|pair| std::iter::repeat_n(answer(pair, true, Grade::Easy), 12))
            .collect();
        let found = OddOneOut::of(7, &answers, GradeWeights::default())?;
        assert_eq!((found.n_ceiling, found.n_floor), (21, 0));
        assert!(found.pairs.iter().all(|p| p.distance == 12.0), "the most");
        assert!(found.is_balanced(), "twelve each");
        assert!(found.errors.iter().all(|e| e.n_triads == 72), "six pairs");
        Ok(())
    }

    #[test]
    fn answers_and_weights_that_make_no_sense_are_refused() {
        let of = |answers: &[TriadAnswer], weights| {
            OddOneOut::of(3, answers, weights).map_err(|e| e.reason)
        };
        let usual = GradeWeights::default();
        let same = of(&[answer([1, 1], true, Grade::Easy)], usual);
        assert_eq!(same, Err("answer 1: item 2 twice".to_owned()));
        let unknown = of(&[answer([1, 3], true, Grade::Easy)], usual);
        assert_eq!(unknown, Err("answer 1: item 4 of 3".to_owned()));
        assert!(of(&[], usual).is_err(), "none");
        let rising = GradeWeights { hard: 0.7, ..usual };
        assert!(of(&five(), rising).is_err_and(|e| e.contains("fall")));
        let broken = GradeWeights {
            normal: f64::NAN,
            ..usual
        };
        assert!(of(&five(), broken).is_err(), "no number");
        assert!(OddOneOut::of(1, &five(), usual).is_err(), "one alone");
    }
}
