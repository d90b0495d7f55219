//! Two hundred visitors, each after a kind, by a seed.

use super::*;
use selvedge_foundation::numerics::Random;

/// One visitor of the `nth` kind.
fn visit(hall: &mut Hall, kind: usize, random: &mut Random) {
    hall.act(Act::Touch);
    match kind {
        // A looker touches once and looks on.
        0 => hall.pass(0.5, stroke(0)),
        // A dragger strokes for long.
        1 => drag(hall, random, 12),
        // A toddler with two hands presses whatever there is.
        2 => toddle(hall, random),
        // A guesser goes through all of it.
        3 => guess(hall, random, 3),
        // A leaver goes away in the middle of it.
        4 => guess(hall, random, 1),
        // A writer says what it was like.
        5 => {
            guess(hall, random, 3);
            hall.act(Act::Face(random.index(3)));
            hall.act(Act::Word(random.index(6)));
            hall.act(Act::Comment("ü, \"quite\"\nso".repeat(60)));
            hall.act(Act::Done);
        }
        // One feels, and presses STOP.
        6 => {
            feel(hall, random);
            hall.act(Act::Stop);
            hall.device = DeviceState::Ready;
        }
        // One feels, and somebody presses Alt+F4.
        _ => {
            feel(hall, random);
            hall.machine.end(VisitEnd::Stop);
        }
    }
    hall.act(Act::HoldFeel(false));
    for _ in 0..600 {
        if hall.watches() {
            break;
        }
        hall.step(Hand::default());
    }
}

fn drag(hall: &mut Hall, random: &mut Random, n_strokes: usize) {
    for _ in 0..n_strokes {
        hall.act(Act::Touch);
        hall.pass(random.uniform_in(0.3, 2.0), stroke(random.index(N_CLOTHS)));
        hall.rest(random.uniform_in(0.1, 3.0));
    }
}

fn guess(hall: &mut Hall, random: &mut Random, n_rounds: usize) {
    drag(hall, random, 6);
    hall.act(Act::Guess);
    for _ in 0..n_rounds {
        hall.act(Act::Touch);
        hall.pass(random.uniform_in(0.5, 4.0), stroke(random.index(N_CLOTHS)));
        hall.act(Act::Choose(random.index(N_CLOTHS)));
        hall.rest(3.0);
    }
}

fn feel(hall: &mut Hall, random: &mut Random) {
    drag(hall, random, 2);
    hall.act(Act::HoldFeel(true));
    hall.pass(1.5, stroke(0));
    hall.act(Act::HoldFeel(false));
    drag(hall, random, 3);
}

fn toddle(hall: &mut Hall, random: &mut Random) {
    for _ in 0..80 {
        let act = match random.index(12) {
            0 => Act::Guess,
            1 => Act::Choose(random.index(9)),
            2 => Act::SameStrength,
            3 => Act::Sound,
            4 => Act::Large,
            5 => Act::Face(random.index(9)),
            6 => Act::Word(random.index(9)),
            7 => Act::HoldFeel(random.index(2) == 0),
            8 => Act::Tour(random.index(9)),
            _ => Act::Touch,
        };
        hall.act(act);
        hall.pass(random.uniform_in(0.1, 0.8), stroke(random.index(N_CLOTHS)));
    }
}

#[test]
fn two_hundred_visits_end_in_watching_with_a_row_each_and_high_voltage_off() {
    let mut random = Random::new(2026);
    let mut hall = Hall::new(9);
    let mut visits = Vec::new();
    for nth in 0..200 {
        hall.machine.voltage.permit(nth % 3 != 0);
        let before = hall.n_armed;
        visit(&mut hall, nth % 8, &mut random);
        assert!(hall.watches(), "visitor {nth}");
        assert!(nth % 3 != 0 || hall.n_armed == before, "not permitted");
        hall.step(Hand::default());
        assert_eq!(hall.device, DeviceState::Ready, "visitor {nth}");
        hall.rest(random.uniform_in(0.0, 30.0));
        assert_eq!(hall.device, DeviceState::Ready, "by itself, after {nth}");
        visits.append(&mut hall.machine.take_ended());
        assert_eq!(visits.len(), nth + 1, "one row a visit");
    }
    assert!(hall.n_armed > 20, "{} were armed", hall.n_armed);
    let n = |end| visits.iter().filter(|visit| visit.end == end).count();
    assert_eq!(n(VisitEnd::Stop), 50);
    assert_eq!(n(VisitEnd::Restart), 0);
    assert!(
        n(VisitEnd::Done) >= 50,
        "guessers and writers: {}",
        n(VisitEnd::Done)
    );
    let longest = visits
        .iter()
        .map(|visit| visit.comment.text.chars().count());
    assert_eq!(longest.max(), Some(200), "comments are capped");
    assert!(visits.iter().all(|visit| visit.guesses.len() <= 3));
}

#[test]
fn the_same_visitors_leave_the_same_rows() {
    let told = |seed| {
        let mut random = Random::new(seed);
        let mut hall = Hall::new(seed);
        hall.machine.voltage.permit(true);
        for nth in 0..16 {
            visit(&mut hall, nth % 8, &mut random);
        }
        hall.machine.take_ended()
    };
    assert_eq!(told(3), told(3));
    assert_ne!(told(3), told(4));
}
