//! Presentations tick by tick: what counts, what waits, what is voided and why.

use super::*;

const STILL: PresentedTick = PresentedTick {
    is_sent: true,
    n_missed: 7,
    n_limited: 3,
    n_values: 48,
    position: Point {
        x_mm: 0.0,
        y_mm: 0.0,
    },
    speed_mm_per_s: 0.0,
    strongest_um: 0.0,
    sequence_step: None,
};

fn watch(name: &str, task: &Task) -> Watch {
    Watch::of(&Design::shipped(name).unwrap(), task, Proof::Array)
}

fn of_items(items: &[usize]) -> Task {
    Task {
        items: items.to_vec(),
        ..Task::default()
    }
}

/// A judgement of one textile, of which nothing has to be explored.
fn judged() -> Watch {
    let task = of_items(&[0]);
    watch("rating", &task)
}

fn shown(watch: &mut Watch, ticks: impl IntoIterator<Item = PresentedTick>) -> Standing {
    for tick in ticks {
        watch.tick(&tick, 1);
    }
    watch.standing()
}

fn void(standing: &Standing) -> &str {
    match standing {
        Standing::Void(why) => why,
        other => panic!("{other:?}"),
    }
}

#[test]
fn counters_that_ran_before_are_not_held_against_a_presentation() {
    let mut watch = judged();
    assert!(
        matches!(watch.standing(), Standing::Incomplete(_)),
        "nothing was presented"
    );
    assert_eq!(shown(&mut watch, [STILL; 200]), Standing::Valid);
    let row = watch.presentation(1000);
    assert_eq!((row.frames_applied, row.frames_late), (Some(200), Some(0)));
    assert_eq!((row.armed_share, row.limited_share), (Some(1.0), Some(0.0)));
    assert_eq!(row.validity(), Validity::Valid);
}

#[test]
fn one_tick_may_be_missed_or_one_of_a_hundred_and_never_three_in_a_row() {
    let missed = |n_missed: u64| PresentedTick { n_missed, ..STILL };
    let mut one = judged();
    assert_eq!(shown(&mut one, [STILL, missed(8)]), Standing::Valid);
    let standing = shown(&mut one, [missed(8), missed(9)]);
    assert!(void(&standing).contains("2 of 4"), "{standing:?}");
    let mut many = judged();
    let calm = std::iter::repeat_n(STILL, 400);
    assert_eq!(shown(&mut many, calm), Standing::Valid);
    let apart = [8, 8, 9, 9, 10, 10, 11, 11].map(missed);
    assert_eq!(shown(&mut many, apart), Standing::Valid, "four of 408");
    let standing = shown(&mut many, [12, 13, 14].map(missed));
    assert!(void(&standing).contains("in a row"), "{standing:?}");
    let mut at_once = judged();
    let standing = shown(&mut at_once, [STILL, missed(10)]);
    assert!(void(&standing).contains("3 ticks in a row"), "{standing:?}");
}

#[test]
fn an_array_that_grew_silent_for_want_of_frames_is_not_said_to_be_disarmed() {
    let missed = |n_missed: u64, is_sent| PresentedTick {
        is_sent,
        n_missed,
        ..STILL
    };
    let mut held_short = judged();
    shown(&mut held_short, std::iter::repeat_n(STILL, 400));
    shown(&mut held_short, [missed(8, true), missed(9, true)]);
    held_short.end("the array is not armed at full strength");
    let standing = held_short.standing();
    assert!(void(&standing).contains("2 ticks in a row"), "{standing:?}");
    let mut disarmed = judged();
    let standing = shown(&mut disarmed, [STILL, missed(11, false)]);
    assert!(void(&standing).contains("4 ticks in a row"), "{standing:?}");
}

#[test]
fn a_tick_that_no_armed_device_got_voids_for_good() {
    let mut watch = judged();
    let off = PresentedTick {
        is_sent: false,
        ..STILL
    };
    let standing = shown(&mut watch, [STILL, off, STILL, STILL]);
    assert!(void(&standing).contains("not armed"), "{standing:?}");
    let row = watch.presentation(0);
    assert_eq!(
        (row.armed_share, row.validity()),
        (Some(0.75), Validity::Void)
    );
    let mut stopped = judged();
    shown(&mut stopped, [STILL; 50]);
    stopped.end("everything was switched off");
    assert!(void(&stopped.standing()).contains("switched off"));
}

#[test]
fn limits_may_change_one_of_a_hundred_values_unless_levels_are_adjusted() {
    let limited = |n: u64| PresentedTick {
        n_limited: 3 + n,
        ..STILL
    };
    let mut watch = judged();
    assert_eq!(
        shown(&mut watch, [STILL, limited(19)]),
        Standing::Valid,
        "1 % of a second"
    );
    let standing = shown(&mut watch, [limited(20)]);
    assert!(void(&standing).contains("limits changed"), "{standing:?}");
    let task = Task {
        starts: vec![0.0],
        ..of_items(&[0])
    };
    let mut adjusted = self::watch("gain-matching", &task);
    assert_eq!(shown(&mut adjusted, [STILL, limited(40)]), Standing::Valid);
}

#[test]
fn each_of_several_textiles_is_felt_in_movement_for_a_second() {
    let task = Task {
        right: Some(1),
        ..of_items(&[0, 1, 0])
    };
    let mut watch = watch("odd-one-out", &task);
    let places = Layout::of(&Design::shipped("odd-one-out").unwrap(), &task).places;
    for (nth, place) in places.iter().enumerate() {
        let on = |speed_mm_per_s: f64| PresentedTick {
            position: Point::new(place.origin_mm.x_mm + 50.0, place.origin_mm.y_mm + 50.0),
            speed_mm_per_s,
            ..STILL
        };
        shown(&mut watch, [on(0.5); 80]);
        let waits = format!("number {} was not felt for 1 s yet", nth + 1);
        assert_eq!(watch.standing(), Standing::Incomplete(waits));
        shown(&mut watch, [on(30.0); 40]);
    }
    assert_eq!(watch.standing(), Standing::Valid);
    assert_eq!(watch.presentation(0).explored_s, [1.0; 3]);
}

#[test]
fn every_interval_is_played_to_its_end_and_its_onset_told() {
    let design = Design::shipped("threshold-40").unwrap();
    let (track, value) = (0, 10.0);
    let task = Task {
        right: Some(0),
        adapted: Some(crate::trial::Adapted { track, value }),
        ..Task::default()
    };
    let steps = sequence(&design, &task);
    let mut watch = Watch::of(&design, &task, Proof::Array);
    shown(
        &mut watch,
        [PresentedTick {
            sequence_step: Some(0),
            ..STILL
        }; 24],
    );
    for (nth, step) in (1..).zip(&steps) {
        assert!(
            matches!(watch.standing(), Standing::Incomplete(_)),
            "step {nth}"
        );
        let tick = PresentedTick {
            sequence_step: Some(nth),
            ..STILL
        };
        shown(&mut watch, (0..step.n_ticks).map(|_| tick));
    }
    assert_eq!(watch.standing(), Standing::Valid);
    let onset_ns = watch.presentation(5).onset_ns;
    assert_eq!(onset_ns, Some(24 * TICK_NS + 5), "behind the silence");
}

/// A watch over two intervals of cloth of 2 s, and ticks of one of them.
fn in_intervals() -> (Watch, impl Fn(u16, f64) -> PresentedTick) {
    let text = include_str!("../analysis/tests/designs/roughness-intervals.toml");
    let design = Design::from_toml(text, std::path::Path::new("a.toml")).unwrap();
    let task = of_items(&[3, 0]);
    let tick = |step: u16, speed_mm_per_s: f64| PresentedTick {
        position: Point::new(50.0, 50.0),
        speed_mm_per_s,
        sequence_step: Some(step),
        ..STILL
    };
    (Watch::of(&design, &task, Proof::Array), tick)
}

#[test]
fn each_interval_of_cloth_is_felt_in_movement_for_a_second_while_it_is_uncovered() {
    let (mut watch, tick) = in_intervals();
    // The lead and the pause are silent: movement in them explores nothing.
    let ticks = [(0, 24, 0), (1, 40, 40), (2, 12, 0), (3, 40, 40)];
    for (step, n_moving, n_still) in ticks {
        let still = std::iter::repeat_n(tick(step, 1.9), n_still);
        let standing = shown(&mut watch, still);
        assert!(matches!(standing, Standing::Incomplete(_)), "{standing:?}");
        shown(&mut watch, std::iter::repeat_n(tick(step, 30.0), n_moving));
    }
    assert_eq!(watch.standing(), Standing::Valid);
    // What comes behind them is silent too.
    shown(&mut watch, [tick(4, 30.0); 40]);
    assert_eq!(watch.standing(), Standing::Valid);
    let row = watch.presentation(0);
    assert_eq!(row.explored_s, [1.0; 2]);
    assert_eq!(row.onset_ns, Some(24 * TICK_NS));
}

#[test]
fn an_interval_in_which_the_display_rested_voids_once_it_is_over() {
    let (mut watch, tick) = in_intervals();
    shown(&mut watch, [tick(0, 30.0); 24]);
    shown(&mut watch, [tick(1, 30.0); 39]);
    let standing = shown(&mut watch, [tick(1, 0.0); 40]);
    assert!(matches!(standing, Standing::Incomplete(_)), "{standing:?}");
    let standing = shown(&mut watch, [tick(1, 0.0)]);
    let why = "interval 1 was felt in movement for 0.97 s, not 1 s";
    assert_eq!(void(&standing), why);
    assert_eq!(watch.presentation(0).validity(), Validity::Void);
    // Beside the cloth is not on it.
    let (mut beside, tick) = in_intervals();
    let away = PresentedTick {
        position: Point::new(5.0, 50.0),
        ..tick(1, 30.0)
    };
    assert!(void(&shown(&mut beside, [away; 80])).contains("0.00 s"));
}

#[test]
fn a_cloth_that_hangs_has_to_be_rubbed_wherever_the_pointer_is() {
    let mut watch = watch("rating-hanging", &of_items(&[0]));
    let moved = PresentedTick {
        speed_mm_per_s: 90.0,
        ..STILL
    };
    let standing = shown(&mut watch, [moved; 100]);
    let Standing::Incomplete(why) = standing else {
        panic!("{standing:?}");
    };
    assert!(why.contains("not rubbed"), "{why}");
    let rubbed = PresentedTick {
        strongest_um: 2.0,
        ..STILL
    };
    assert_ne!(shown(&mut watch, [rubbed; 39]), Standing::Valid);
    assert_eq!(shown(&mut watch, [rubbed]), Standing::Valid);
    assert_eq!(watch.presentation(0).explored_s, [1.0]);
}
