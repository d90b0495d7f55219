//! Generated weaves in waves, and what must not be laid straight.

use std::f64::consts::{PI, TAU};

use super::super::{Analysis, AnalysisOptions, DirectionOptions, EvenLight, Found, Picture};
use super::*;
use selvedge_foundation::numerics::{Random, to_whole};
use selvedge_foundation::progress::Progress;

const SIDE_PX: usize = 320;

/// A weave at 8 × 9 px a thread, yarns shaded round and dark where they dive, in waves of this
/// largest stretch.
fn woven(rows: &[&str], stretch: f64) -> Grid<f64> {
    let turns = TAU / SIDE_PX as f64;
    let amplitude_px = stretch / turns;
    let mut random = Random::new(7);
    let n = rows.len().cast_signed();
    let picture = Grid::from_fn(SIDE_PX, SIDE_PX, |column, row| {
        let [x, y] = [column as f64, row as f64];
        let x = x + amplitude_px * ((turns * y + 1.0).sin() + 0.5 * (turns * x).sin());
        let y = y + amplitude_px * (turns * x + 2.0).sin();
        let [end, pick] = [x / 8.0, y / 9.0];
        let of = |at: f64| to_whole::<isize>(at.floor());
        let [e, p] = [of(end).rem_euclid(n), of(pick).rem_euclid(n)];
        let is_warp = rows[p.unsigned_abs()].as_bytes()[e.unsigned_abs()] == b'X';
        let [across, along] = if is_warp { [end, pick] } else { [pick, end] };
        let round = (PI * (across - across.floor())).sin();
        let dive = (PI * (along - along.floor())).sin();
        let bright = if is_warp { 0.55 } else { 0.45 };
        bright * (0.5 + 0.3 * round + 0.2 * dive)
    });
    picture.map(|value| value + 0.02 * random.normal())
}

fn found(luminance: Grid<f64>) -> Found {
    let options = AnalysisOptions {
        light: EvenLight::Off,
        directions: DirectionOptions::default(),
        n_threads: 2,
    };
    let picture = Picture::grey(luminance);
    let analysis = Progress::unheard(|p| Analysis::of(picture.clone(), &options, p)).unwrap();
    analysis.found.unwrap()
}

#[test]
fn weaves_bent_by_up_to_eight_per_cent_are_laid_straight() {
    for (name, rows) in [
        ("plain", &["X.", ".X"][..]),
        ("twill 2/2", &["XX..", ".XX.", "..XX", "X..X"]),
        ("satin 5", &[".XXXX", "XXX.X", "X.XXX", "XXXX.", "XX.XX"]),
    ] {
        let straight = found(woven(rows, 0.0));
        assert!(straight.unwarped.is_none(), "{name}: it lies flat");
        for stretch in [0.04, 0.08] {
            let bent = found(woven(rows, stretch));
            let share = bent.explained_variance / straight.explained_variance;
            let unwarped = bent.unwarped.as_ref();
            println!(
                "{name} {stretch}: {share}, {:?} px, {:?}",
                unwarped.map(|u| u.bend_px),
                unwarped.map(|u| u.stretch)
            );
            assert!(share >= 0.6, "{name} {stretch}: {share}");
            let unwarped = unwarped.unwrap();
            assert!(
                (0.5 * stretch..3.0 * stretch).contains(&unwarped.stretch),
                "{name}"
            );
            assert!(unwarped.luminance.width() > SIDE_PX / 2, "{name}");
        }
    }
}

#[test]
fn what_repeats_nowhere_is_not_laid_straight() {
    let mut random = Random::new(3);
    let noise = Grid::from_fn(120, 110, |_, _| random.uniform_in(0.0, 1.0));
    let lattice = Lattice {
        p1_px: [12.0, 0.0],
        p2_px: [0.0, 11.0],
        confidence: 0.5,
        false_alarm_rate: 0.0,
        method: "hough",
        thread_grid: None,
        held_out: None,
        level: 0.9,
        level_between: 0.1,
        cover: 1.0,
        hit: 1.0,
    };
    let flat = FlatPart {
        place: [0, 0, 60, 55],
        tile: Tile::fold(&noise, lattice.basis(), 1),
        explained_variance: 0.1,
    };
    let none = straight(&noise, (&lattice, lattice.basis()), &flat, 1, |_| {
        Ok::<(), ()>(())
    })
    .unwrap();
    assert!(none.is_none(), "noise");
}
