//! The stage by acts and by a clock of its own; visitors; the window.

mod ceiling;
mod visit;
mod visitors;
mod window;

use super::act::{Act, Hand, Motion};
use super::machine::{Machine, Phase};
use super::voltage::{DeviceState, Switch};
use selvedge_experiment::visits::{N_CLOTHS, VisitEnd};

const STEP_S: f64 = 0.1;

/// A machine with a device that does what it is told, on a clock of its own.
struct Hall {
    machine: Machine,
    device: DeviceState,
    now_s: f64,
    n_armed: u32,
}

impl Hall {
    fn new(seed: u64) -> Self {
        let names = ["silk", "wool", "jute", "jersey"].map(str::to_owned);
        Self {
            machine: Machine::new(seed, names),
            device: DeviceState::Ready,
            now_s: 0.0,
            n_armed: 0,
        }
    }

    fn act(&mut self, act: Act) {
        self.machine.act(act, "touch");
    }

    fn step(&mut self, hand: Hand) {
        self.now_s += STEP_S;
        match self.machine.step(self.now_s, hand, self.device) {
            Some(Switch::Arm) => {
                self.n_armed += 1;
                self.device = DeviceState::Armed;
            }
            Some(Switch::Disarm) if self.device == DeviceState::Armed => {
                self.device = DeviceState::Ready;
            }
            _ => {}
        }
    }

    fn pass(&mut self, seconds: f64, hand: Hand) {
        for _ in 0..steps(seconds) {
            self.step(hand);
        }
    }

    fn rest(&mut self, seconds: f64) {
        self.pass(seconds, Hand::default());
    }

    fn watches(&self) -> bool {
        matches!(self.machine.phase(), Phase::Watching)
    }

    fn ends(&mut self) -> Vec<VisitEnd> {
        let ended = self.machine.take_ended();
        ended.into_iter().map(|visit| visit.end).collect()
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "some hundred steps"
)]
fn steps(seconds: f64) -> u32 {
    (seconds / STEP_S).round() as u32
}

fn stroke(cloth: usize) -> Hand {
    Hand {
        is_down: true,
        moved_mm: 8.0,
        cloth: Some(cloth),
    }
}

#[test]
fn without_movement_the_ghost_hints_and_then_nobody_is_there() {
    let mut hall = Hall::new(1);
    assert_eq!(hall.machine.motion(), Motion::Ghost);
    hall.act(Act::Touch);
    assert_eq!(hall.machine.motion(), Motion::Finger, "in the same frame");
    hall.pass(3.0, stroke(1));
    // A sleeve that leans on the screen is no visitor.
    let sleeve = Hand {
        moved_mm: 0.0,
        ..stroke(1)
    };
    hall.pass(19.0, sleeve);
    assert_eq!(hall.machine.motion(), Motion::Finger);
    hall.pass(2.0, sleeve);
    assert!(hall.machine.has_ghost() && !hall.watches());
    hall.pass(19.1, sleeve);
    assert!(hall.watches() && hall.machine.fade() > 0.0);
    hall.rest(0.4);
    assert!(hall.machine.fade() <= 0.0);
    let visit = &hall.machine.take_ended()[0];
    assert_eq!((visit.end, visit.n_strokes), (VisitEnd::Idle, 1));
    assert!((visit.cloth_s[1] - 3.2).abs() < 0.3, "{:?}", visit.cloth_s);
}

#[test]
fn guessing_is_offered_after_three_cloths_or_twenty_seconds() {
    let mut hall = Hall::new(2);
    hall.act(Act::Touch);
    for cloth in 0..3 {
        assert!(!hall.machine.offers_guessing(), "{cloth}");
        hall.pass(1.0, stroke(cloth));
    }
    assert!(hall.machine.offers_guessing());
    let mut hall = Hall::new(2);
    hall.act(Act::Touch);
    hall.pass(19.5, stroke(0));
    assert!(!hall.machine.offers_guessing());
    hall.pass(1.0, stroke(0));
    assert!(hall.machine.offers_guessing());
}

#[test]
fn who_leaves_in_the_middle_of_a_guess_is_asked_and_then_gone() {
    let mut hall = Hall::new(3);
    hall.act(Act::Touch);
    hall.act(Act::Guess);
    hall.act(Act::Choose(0));
    hall.rest(29.0);
    assert_eq!(hall.machine.leaving_share(), None);
    hall.rest(2.0);
    assert!(
        hall.machine
            .leaving_share()
            .is_some_and(|share| share < 0.2)
    );
    hall.rest(15.0);
    let visit = &hall.machine.take_ended()[0];
    assert_eq!((visit.end, visit.guesses.len()), (VisitEnd::Idle, 1));
}

#[test]
fn what_a_visitor_chose_is_gone_with_the_visit() {
    let mut hall = Hall::new(4);
    for act in [Act::Touch, Act::SameStrength, Act::Large, Act::Sound] {
        hall.act(act);
    }
    let chosen = hall.machine.choices();
    assert!(chosen.same_strength && chosen.is_large);
    hall.act(Act::HoldRestart(true));
    hall.rest(0.8);
    assert!(!hall.watches());
    hall.act(Act::HoldRestart(false));
    hall.rest(1.0);
    assert!(!hall.watches(), "it was let go");
    hall.act(Act::HoldRestart(true));
    hall.rest(1.2);
    assert!(hall.watches());
    assert_eq!(hall.ends(), [VisitEnd::Restart]);
    assert_eq!(hall.machine.choices(), super::act::Choices::default());
}

#[test]
fn sound_is_off_while_nobody_is_there_and_where_it_would_give_the_answer_away() {
    let mut hall = Hall::new(5);
    assert!(!hall.machine.is_heard());
    hall.act(Act::Touch);
    hall.step(stroke(0));
    assert!(hall.machine.is_heard());
    hall.act(Act::Guess);
    assert!(
        hall.machine.is_heard(),
        "with nothing armed it is all there is"
    );
    hall.machine.voltage.permit(true);
    hall.act(Act::HoldFeel(true));
    hall.pass(1.5, stroke(0));
    assert!(hall.machine.is_armed() && !hall.machine.is_heard());
    hall.act(Act::Choose(1));
    hall.act(Act::Stop);
    let visit = &hall.machine.take_ended()[0];
    assert!(!visit.guesses[0].is_heard && visit.was_armed);
    assert_eq!(visit.end, VisitEnd::Stop);
}

#[test]
fn keys_stroke_a_cloth_for_six_seconds() {
    let mut hall = Hall::new(6);
    hall.machine.act(Act::Tour(2), "keys");
    assert_eq!(hall.machine.motion(), Motion::Tour(2));
    hall.rest(6.2);
    assert_eq!(hall.machine.motion(), Motion::Finger);
    hall.machine.act(Act::Tour(N_CLOTHS + 7), "keys");
    assert_eq!(hall.machine.motion(), Motion::Tour(N_CLOTHS - 1));
    hall.act(Act::Stop);
    let visit = &hall.machine.take_ended()[0];
    assert_eq!((visit.input, visit.n_strokes), ("keys", 2));
    assert!(visit.cloth_s[2] > 5.0);
}
