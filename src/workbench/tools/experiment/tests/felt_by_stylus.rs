//! Sessions that a stylus feels: its vibration is played by all contactors, force alone by none, a
//! trial counts only while the stylus is felt.

use super::presented::{arm, begun_on_array, present, rows, strongest_um};
use super::*;
use crate::tools::stylus::Stylus;
use selvedge_experiment::Validity;
use selvedge_experiment::design::Source;
use selvedge_render::stylus::StylusState;

const DESIGN: &str = "force-or-vibration";

/// Strokes over a place, and says what the array was told at most, µm, and whether all contactors
/// did the same.
fn stroked(window: &mut Headless, at: usize) -> (f64, bool) {
    let corner = session(window).layout.places[at].origin_mm;
    let (mut most_um, mut is_alike) = (0.0_f64, true);
    for nth in 0..60 {
        stroke(window, corner, nth..nth + 1);
        if nth < 12 {
            // The finger comes from elsewhere, and the tip to its speed.
            continue;
        }
        most_um = most_um.max(strongest_um(window));
        let all = window.workbench.amplitudes_um();
        is_alike &= all.iter().all(|one| *one == all[0]);
    }
    (most_um, is_alike)
}

/// Whether what lies at a place of the trial is given as force alone.
fn is_force_alone(window: &Headless, at: usize) -> bool {
    let session = session(window);
    let stimulus = session.layout.places[at].stimulus;
    match &session.design.stimuli[stimulus].source {
        Source::Textile { variant, .. } => variant.is_force_alone,
        _ => false,
    }
}

#[test]
fn vibration_is_felt_on_all_contactors_and_force_alone_on_none() {
    let folder = Folder::new("force-or-vibration");
    let mut window = begun_on_array(&folder, DESIGN);
    let live = |window: &Headless| window.workbench.bench.live.stylus;
    assert!(live(&window).is_some(), "before the first trial");
    arm(&mut window);
    present(&mut window);
    for at in [0, 1] {
        let (most_um, is_alike) = stroked(&mut window, at);
        assert_eq!(live(&window), Some(StylusState::Led));
        assert!(is_alike, "the stylus drives all of them");
        if is_force_alone(&window, at) {
            assert!(most_um <= 0.0, "{most_um} µm by force alone");
        } else {
            assert!(most_um > 0.5, "{most_um} µm");
        }
    }
    assert_ne!(is_force_alone(&window, 0), is_force_alone(&window, 1));
    assert_eq!(session(&window).missing(), None, "both were felt");
    mark(&mut window, Mark::Place(0));
    answer(&mut window);
    window.pass(4);
    assert_eq!(session(&window).progress.0, 1);
    let presentation = rows(&folder)[0].presentation.clone();
    assert_eq!(presentation.validity(), Validity::Valid);
    end(&mut window);
    window.pass(3);
    assert_eq!(live(&window), None, "the array is felt again");
}

#[test]
fn a_trial_waits_for_its_stylus_and_is_void_without_it() {
    let folder = Folder::new("no-stylus");
    let mut window = begun_on_array(&folder, DESIGN);
    arm(&mut window);
    experiment_mut(&mut window).session.as_mut().unwrap().lay();
    for (stylus, why) in [
        (None, "the stylus is not felt"),
        (Some(StylusState::BrokenOff), "the stylus broke off"),
    ] {
        let now = ArrayNow::of(&window.workbench.bench);
        let waits = session(&window).waits_for(ArrayNow { stylus, ..now });
        assert!(waits.is_some_and(|line| line.starts_with(why)), "{waits:?}");
    }
    present(&mut window);
    stroked(&mut window, 0);
    // The finger rests: what the array would play of a stroke without its stylus is another reason.
    window.pass(20);
    window.workbench.bench.feel_stylus(None);
    window.pass(4);
    let rows = rows(&folder);
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0].presentation.void, "the stylus is not felt");
    assert_eq!(session(&window).progress.0, 0, "it comes again");
}

#[test]
fn the_panes_stylus_is_switched_off_by_a_session_that_feels_the_array() {
    let folder = Folder::new("pane-off");
    let mut window = Headless::shipped();
    window.pass(2);
    let stylus: &mut Stylus = window.workbench.tools.get_mut().unwrap();
    stylus.through.is_on = true;
    window.pass(40);
    assert!(window.workbench.bench.live.stylus.is_some());
    let form = &mut experiment_mut(&mut window).form;
    form.choose(small(&folder, "odd-one-out"));
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = "p01".to_owned();
    begin(&mut window);
    window.pass(4);
    let stylus: &mut Stylus = window.workbench.tools.get_mut().unwrap();
    assert!(!stylus.through.is_on);
    let bench = &window.workbench.bench;
    assert_eq!((bench.live.stylus, &bench.device.stylus), (None, &None));
}
