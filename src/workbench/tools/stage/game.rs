//! Three rounds of "which of four is it?": the order of questions and pictures, and the answers.

use selvedge_experiment::visits::{Comment, Guess, N_CLOTHS};
use selvedge_foundation::numerics::Random;

/// Rounds of a game.
pub(crate) const N_ROUNDS: usize = 3;
/// From an answer to its truth, s.
const TRUTH_S: f64 = 0.4;
/// From an answer to the next question, s.
const NEXT_S: f64 = 2.5;

/// The faces of the last question, and the words to choose.
pub(crate) const FACES: [&str; 3] = ["sad", "so-so", "glad"];
pub(crate) const WORDS: [&str; 6] = ["soft", "rough", "buzzy", "weak", "real", "fun"];

/// What is asked in a round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Round {
    /// The cloth that is felt.
    truth: usize,
    /// The cloths that the pictures show, by their places.
    order: [usize; N_CLOTHS],
}

/// A game under way.
#[derive(Debug, Clone)]
pub(crate) struct Game {
    rounds: [Round; N_ROUNDS],
    nth: usize,
    /// When the question was asked, s.
    asked_s: f64,
    /// The place that was chosen, and when, s.
    choice: Option<(usize, f64)>,
    guesses: Vec<Guess>,
    pub(crate) comment: Comment,
}

/// How it stands with an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answered {
    /// None yet.
    No,
    /// At this place; whether it is right is not told yet.
    Chosen(usize),
    /// At this place, and it was this one.
    Told { chosen: usize, truth: usize },
}

impl Game {
    /// A game in an order of its own.
    pub(crate) fn new(now_s: f64, random: &mut Random) -> Self {
        let mut truths = [0, 1, 2, 3];
        random.shuffle(&mut truths);
        let mut round = |nth: usize| {
            let mut order = [0, 1, 2, 3];
            random.shuffle(&mut order);
            let truth = truths[nth];
            Round { truth, order }
        };
        Self {
            rounds: [round(0), round(1), round(2)],
            nth: 0,
            asked_s: now_s,
            choice: None,
            guesses: Vec::new(),
            comment: Comment::default(),
        }
    }

    /// The cloth that is felt; `None` once all is answered.
    pub(crate) fn truth(&self) -> Option<usize> {
        self.round().map(|round| round.truth)
    }

    /// The cloths that the pictures show.
    pub(crate) fn order(&self) -> [usize; N_CLOTHS] {
        self.round().map_or([0, 1, 2, 3], |round| round.order)
    }

    /// Whether all is answered.
    pub(crate) fn is_over(&self) -> bool {
        self.nth >= N_ROUNDS
    }

    /// Right answers so far.
    pub(crate) fn n_right(&self) -> usize {
        self.guesses.iter().filter(|guess| guess.is_right()).count()
    }

    /// How it stands with this round.
    pub(crate) fn answered(&self, now_s: f64) -> Answered {
        match (self.choice, self.round()) {
            (Some((place, at_s)), Some(round)) if now_s - at_s >= TRUTH_S => Answered::Told {
                chosen: round.order[place],
                truth: round.truth,
            },
            (Some((place, _)), _) => Answered::Chosen(place),
            (None, _) => Answered::No,
        }
    }

    /// Takes an answer; one that was told goes on to the next question. `names` are the textiles'.
    pub(crate) fn choose(
        &mut self,
        now_s: f64,
        place: usize,
        (names, is_heard): (&[String; N_CLOTHS], bool),
    ) {
        if matches!(self.answered(now_s), Answered::Told { .. }) {
            return self.go_on(now_s);
        }
        let Some(round) = self.round().filter(|_| self.choice.is_none()) else {
            return;
        };
        let Some(&chosen) = round.order.get(place) else {
            return;
        };
        self.choice = Some((place, now_s));
        self.guesses.push(Guess {
            truth: names[round.truth].clone(),
            choice: names[chosen].clone(),
            order: round
                .order
                .iter()
                .map(|cloth| (cloth + 1).to_string())
                .collect(),
            is_heard,
            ms: milliseconds(now_s - self.asked_s),
        });
    }

    /// Goes on by itself once there was time to read.
    pub(crate) fn step(&mut self, now_s: f64) {
        if self.choice.is_some_and(|(_, at_s)| now_s - at_s >= NEXT_S) {
            self.go_on(now_s);
        }
    }

    /// What was answered.
    pub(crate) fn into_answers(self) -> (Vec<Guess>, Comment) {
        (self.guesses, self.comment)
    }

    fn go_on(&mut self, now_s: f64) {
        self.nth += 1;
        self.choice = None;
        self.asked_s = now_s;
    }

    fn round(&self) -> Option<Round> {
        self.rounds.get(self.nth).copied()
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "minutes at most"
)]
fn milliseconds(s: f64) -> u64 {
    (1000.0 * s.max(0.0)).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> [String; N_CLOTHS] {
        ["silk", "wool", "jute", "jersey"].map(str::to_owned)
    }

    #[test]
    fn an_answer_is_outlined_told_and_left_and_counts_once() {
        let mut game = Game::new(10.0, &mut Random::new(7));
        let names = names();
        let truth = game.truth().unwrap();
        let place = game
            .order()
            .iter()
            .position(|cloth| *cloth == truth)
            .unwrap();
        game.choose(12.0, place, (&names, true));
        game.choose(12.1, (place + 1) % 4, (&names, true));
        assert_eq!(game.answered(12.3), Answered::Chosen(place));
        let told = Answered::Told {
            chosen: truth,
            truth,
        };
        assert_eq!(game.answered(12.4), told);
        game.step(14.4);
        assert_eq!((game.n_right(), game.truth()), (1, Some(truth)));
        game.step(14.5);
        assert_eq!(game.answered(14.5), Answered::No);
        assert_ne!(game.truth(), Some(truth), "no cloth is asked for twice");
        let (guesses, _) = game.into_answers();
        assert_eq!((guesses.len(), guesses[0].ms), (1, 2000));
        assert_eq!(guesses[0].order.len(), 4);
    }

    #[test]
    fn a_tap_goes_on_and_after_three_rounds_it_is_over() {
        let mut game = Game::new(0.0, &mut Random::new(3));
        for round in 0..N_ROUNDS {
            let now_s = 10.0 * round as f64;
            assert!(!game.is_over());
            game.choose(now_s, 0, (&names(), false));
            game.choose(now_s + 0.5, 0, (&names(), false));
        }
        assert!(game.is_over() && game.truth().is_none());
        game.choose(99.0, 1, (&names(), false));
        assert_eq!(game.into_answers().0.len(), N_ROUNDS);
    }

    #[test]
    fn the_same_seed_asks_the_same_and_every_cloth_has_its_turn() {
        let order = |seed| {
            let mut random = Random::new(seed);
            let games = [(); 40].map(|()| Game::new(0.0, &mut random).rounds);
            games.to_vec()
        };
        assert_eq!(order(5), order(5));
        assert_ne!(order(5), order(6));
        for cloth in 0..N_CLOTHS {
            let n = order(5)
                .iter()
                .flatten()
                .filter(|r| r.truth == cloth)
                .count();
            assert!((15..=45).contains(&n), "cloth {cloth}: {n} of 120");
        }
    }
}
