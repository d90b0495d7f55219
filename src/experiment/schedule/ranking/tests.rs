//! What the construction promises, counted.

use super::super::subject_random;
use super::*;

fn schedule(n: usize, subject: u32) -> RankingSchedule {
    RankingSchedule::of(
        n,
        &subject_random(2012, "ranking", &format!("p{subject:02}")),
    )
    .unwrap()
}

impl RankingTrial {
    /// The position of the correct alternative, from 0.
    fn correct(&self) -> usize {
        let found = self.alternatives.iter().position(|&a| a == self.target);
        found.unwrap_or(N_ALTERNATIVES)
    }
}

#[test]
fn sixteen_textiles_make_eighty_trials_balanced_in_every_way() {
    for subject in 0..16 {
        let found = schedule(16, subject);
        assert!(found.is_pair_balanced);
        assert_eq!(found.trials.len(), 80);
        let mut correct = [0; 4];
        let mut at = [[0; 4]; 16];
        let mut met = [[0; 16]; 16];
        let mut together = [[0; 16]; 16];
        for trial in &found.trials {
            correct[trial.correct()] += 1;
            for (position, &textile) in trial.alternatives.iter().enumerate() {
                at[textile][position] += 1;
                if textile == trial.target {
                    continue;
                }
                met[trial.target][textile] += 1;
                let wrong = trial.alternatives.iter().filter(|&&a| a != trial.target);
                wrong.for_each(|&other| together[textile][other] += 1);
            }
        }
        assert_eq!(correct, [20; 4], "the correct one's positions");
        assert_eq!(at, [[5; 4]; 16], "every textile's positions");
        for a in 0..16 {
            for b in (0..16).filter(|&b| b != a) {
                assert_eq!(met[a][b], 1, "{b} is an alternative to {a} once");
                assert_eq!(
                    together[a][b], 2,
                    "{a} and {b} are incorrect together twice"
                );
            }
        }
    }
}

#[test]
fn a_block_has_every_target_once_and_no_four_twice() {
    for subject in 0..40 {
        for (n, n_blocks) in [(16, 5), (13, 4)] {
            let found = schedule(n, subject);
            for block in 0..n_blocks {
                let trials = found.trials.iter().filter(|trial| trial.block == block);
                let mut targets: Vec<usize> = trials.clone().map(|trial| trial.target).collect();
                targets.sort_unstable();
                assert_eq!(targets, (0..n).collect::<Vec<_>>());
                let mut fours: Vec<[usize; 4]> = trials
                    .map(|trial| {
                        let mut four = trial.alternatives;
                        four.sort_unstable();
                        four
                    })
                    .collect();
                fours.sort_unstable();
                fours.dedup();
                assert_eq!(fours.len(), n);
            }
            let in_a_row = found.trials.windows(2);
            assert!(in_a_row.clone().all(|two| two[0].target != two[1].target));
            assert!(found.trials.is_sorted_by_key(|trial| trial.block));
        }
    }
}

#[test]
fn other_numbers_meet_every_target_once_and_say_that_pairs_are_not_even() {
    for n in [4, 7, 10, 19, 22] {
        let found = schedule(n, 3);
        assert_eq!(found.is_pair_balanced, n == 4);
        assert_eq!(found.trials.len(), n * (n - 1) / 3);
        let mut met = vec![vec![0; n]; n];
        for trial in &found.trials {
            let others = trial.alternatives.iter().filter(|&&a| a != trial.target);
            others.for_each(|&other| met[trial.target][other] += 1);
            assert!(trial.correct() < 4);
        }
        for (target, row) in met.iter().enumerate() {
            for (other, &n_met) in row.iter().enumerate() {
                assert_eq!(n_met, u32::from(target != other));
            }
        }
    }
    for n in [0, 1, 3, 15] {
        let refused = RankingSchedule::of(n, &Random::new(1));
        assert_eq!(refused, Err(ScheduleError::NoTriples { n }));
    }
}

#[test]
fn a_schedule_is_its_seeds_and_subjects_alone() {
    assert_eq!(schedule(16, 1), schedule(16, 1));
    assert_ne!(schedule(16, 1), schedule(16, 2));
    let first: Vec<_> = schedule(16, 1).trials[..3]
        .iter()
        .map(|trial| (trial.target, trial.alternatives))
        .collect();
    // Written down when this was made: another order would be another experiment.
    assert_eq!(first, GOLDEN);
}

const GOLDEN: [(usize, [usize; 4]); 3] = [
    (8, [14, 8, 4, 13]),
    (3, [3, 1, 0, 15]),
    (15, [15, 10, 5, 14]),
];
