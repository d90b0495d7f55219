//! Scene files: what is read, what is refused, and how it is stepped.

use std::path::Path;

use super::*;
use crate::{Drape, DrapeScene};
use selvedge_scratch::ScratchFolder;
use selvedge_textile::Library;

#[test]
fn every_shipped_textile_has_figures_that_fit() {
    for id in Library::shipped().unwrap().ids() {
        let scene = DrapeScene::of_textile(id).unwrap();
        let (notes, plausible) = (scene.notes().count(), scene.plausible().unwrap());
        let is_told = plausible.contains(" of its figures are plausible ones of ");
        assert!(notes == 0 && is_told, "{id}: {notes}, {plausible}");
    }
}

#[test]
fn a_second_finger_may_have_a_device_of_its_own() {
    let finger = |mapping: &str| {
        format!("[[finger]]\nmapping = \"{mapping}\"\nstart_mm = [9, 9, 0]\nopening_mm = 9\n")
    };
    for (second, has_device) in [("device", true), ("mirrored", false), ("path", false)] {
        let text = format!(
            "name = \"a\"\ntextile = \"denim\"\n{}{}",
            finger("path"),
            finger(second)
        );
        let scene = DrapeScene::from_text(&text, Path::new("a.drape.toml")).unwrap();
        assert_eq!(scene.has_second_device(), has_device, "{second}");
    }
}

#[test]
fn wrong_scenes_name_the_line_and_the_mend() {
    let folder = ScratchFolder::made("drape-scene");
    let path = folder.join("a.drape.toml");
    for (text, expected) in [
        ("textile = \"denim\"\nsize = 3\n", ":3: unknown field"),
        ("textile = \"velvet\"\n", ":2: "),
        (
            "textile = \"denim\"\npins = \"left\"\n",
            ":3: the pins are \"left\"; give",
        ),
        ("textile = \"denim\"\ngrid = \"fine\"\n", ":3: the grid is"),
        (
            "textile = \"denim\"\ngrid = [1, 9]\n",
            "the grid is 1 vertices a side; give 2 to 400",
        ),
        (
            "textile = \"denim\"\nstep_ms = nan\n",
            ":3: this is no step",
        ),
        (
            "textile = \"denim\"\nfriction = -1.0\n",
            ":3: the friction is -1",
        ),
        (
            "textile = \"denim\"\n[measured]\nemt_percent = 0\n",
            ":3: the EMT is 0 %",
        ),
        (
            "textile = \"denim\"\n[measured]\nb = 1\n",
            ":4: unknown figure \"b\"",
        ),
        (
            "[measured]\nlt = 0.7\n",
            ":2: there is no figure weight_mg_per_cm2",
        ),
        (
            "textile = \"denim\"\n[[finger]]\nside = \"left\"\nstart_mm = [0, 0, 0]\n\
             opening_mm = 9\n",
            ":4: the side is \"left\"; give \"front\"",
        ),
        (
            "textile = \"denim\"\n[[finger]]\nmapping = \"mirrored\"\nstart_mm = [0, 0, 0]\n\
             opening_mm = 9\n",
            ":4: the mapping is \"mirrored\"",
        ),
        (
            "textile = \"denim\"\n[[finger]]\nmapping = \"device\"\nstart_mm = [0, 0, 0]\n\
             opening_mm = 9\n",
            ":4: the mapping is \"device\"; give \"path\"",
        ),
    ] {
        std::fs::write(&path, format!("name = \"a\"\n{text}")).unwrap();
        let error = DrapeScene::read(&path).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("; "), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn the_shipped_scene_is_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/denim.drape.toml");
    let scene = DrapeScene::read(&path).unwrap();
    assert_eq!(
        (scene.name(), scene.textile()),
        ("Denim under two fingers", Some("denim"))
    );
    let (cloth, why) = scene.cloth(None, None).unwrap();
    assert_eq!(cloth.fingers().len(), 2);
    assert_eq!(cloth.stepping.integrator, Integrator::Bdf2, "{why}");
    assert!(scene.fingers()[1].is_mirrored);
}

/// A soft knit of a weight, in mg/cm², between two fingers.
fn knit(weight: f64) -> DrapeScene {
    let finger = |side: &str| {
        format!("[[finger]]\nside = \"{side}\"\nstart_mm = [100.0, 80.0, 0.0]\nopening_mm = 20.0\n")
    };
    let text = format!(
        "name = \"Knit\"\ngrid = [26, 26]\n[measured]\nweight_mg_per_cm2 = {weight}\n\
         emt_percent = 50.0\nfm_gf_per_cm = 30.0\nlt = 1.0\ng_gf_per_cm_deg = 0.02\n\
         b_gf_cm2_per_cm = 0.02\n{}{}",
        finger("front"),
        finger("back")
    );
    DrapeScene::from_text(&text, Path::new("knit.drape.toml")).unwrap()
}

#[test]
fn what_is_chosen_by_itself_is_not_refused_once_fingers_touch() {
    let mut drape = Drape::new(&knit(40.0), None, None).unwrap();
    assert_eq!(drape.integrator().0, Integrator::Explicit);
    let mut hands = drape.start_hands();
    while drape.t_s() < 0.15 {
        for hand in &mut hands {
            hand.opening_mm = (20.0 - 220.0 * drape.t_s()).max(-2.0);
        }
        drape.step(&hands).unwrap();
    }
    assert!(drape.finger(0).n_contacts > 10);
    // Half as heavy it is stable in long enough steps only as long as nobody touches it.
    let lighter = Drape::new(&knit(20.0), None, None).unwrap();
    let (integrator, why) = lighter.integrator();
    assert_eq!(integrator, Integrator::Bdf2, "{why}");
}
