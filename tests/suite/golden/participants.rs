//! Sessions of experiments in the window: what the participant and the experimenter see of every
//! kind of question.

use std::path::PathBuf;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use selvedge_experiment::design::Design;

use super::compare::Golden;
use super::stage::Stage;
use crate::program::Lab;

/// Ticks from one picture to the next.
const SLOT: u32 = 80;
/// Size of the participant's pane, points.
const PARTICIPANT: [u16; 2] = [760, 620];
/// Size of the experimenter's pane, points.
const EXPERIMENTER: [u16; 2] = [360, 620];

const FOUR: &str = "textiles = [\"silk-crepe\", \"wool-twill\", \"jute-plain\", \"wool-rib\"]";

/// A design of the program with four textiles in place of all: they are ready soon.
fn small(lab: &Lab, design: &str) -> PathBuf {
    let text = Design::shipped_text(design).unwrap();
    let text = match text.split_once("textiles = [") {
        None => text.to_owned(),
        Some((before, rest)) => {
            let (_, after) = rest.split_once(']').unwrap();
            format!("{before}{FOUR}{after}")
        }
    };
    lab.write(&format!("{design}.toml"), text)
}

/// A window in which a design is chosen, before its session begins.
fn chosen(lab: &Lab, design: &str) -> Stage {
    let mut stage = Stage::alone(None);
    stage.front("Experimenter", EXPERIMENTER);
    // The entry stands below what the list shows at first, where no pointer reaches it.
    stage.click_named("Design");
    stage.click_named("Open a design…");
    stage.type_path(&small(lab, design));
    if stage.harness.query_by_label("Open a design…").is_some() {
        stage.harness.get_by_label("Design").click();
        stage.harness.run_steps(4);
        stage.harness.remove_cursor();
    }
    stage.type_into("folder", &lab.path(design).display().to_string());
    stage.type_into("pseudonym", "p01");
    stage
}

/// Begins a pilot, which needs no array.
fn begin(stage: &mut Stage) {
    stage.click(Role::Button, "Pilot");
    stage.without_timeline();
}

/// Goes on to the first trial, past instructions and movements, and looks at it.
fn to_trial(stage: &mut Stage) {
    stage.front("Experimenter", EXPERIMENTER);
    for _ in 0..8 {
        if stage.harness.query_by_label("answered so far").is_some() {
            break;
        }
        stage.click(Role::Button, "Go on");
    }
    if stage
        .harness
        .query_by_label("The cloth lies there")
        .is_some()
    {
        stage.click(Role::Button, "The cloth lies there");
    }
    stage.front("Participant", PARTICIPANT);
}

#[test]
fn golden_session_of_rankings() {
    let mut golden = Golden::of("pictures/ranking");
    let lab = Lab::named("ranking");
    let mut stage = chosen(&lab, "ranking-virtual-target");
    stage.hide_field("folder");
    stage.compare(&mut golden, "form", SLOT);
    begin(&mut stage);
    stage.front("Participant", PARTICIPANT);
    stage.compare_dark(&mut golden, "instructions", 2 * SLOT);
    to_trial(&mut stage);
    stage.compare(&mut golden, "trial", 3 * SLOT);
    for fabric in ["Fabric 3", "Fabric 1"] {
        stage.click_named(fabric);
    }
    stage.compare_dark(&mut golden, "two-ranked", 4 * SLOT);
    stage.front("Experimenter", EXPERIMENTER);
    // The path of the log comes next, and moves what is below it.
    stage.hide_below("Session");
    stage.compare(&mut golden, "experimenter", 5 * SLOT);
    stage.front("Workspace", EXPERIMENTER);
    stage.compare_dark(&mut golden, "veil", 6 * SLOT);
    golden.finish();
}

#[test]
fn golden_questions() {
    let mut golden = Golden::of("pictures/questions");
    let lab = Lab::named("questions");
    for design in [
        "odd-one-out",
        "real-or-generated",
        "threshold-40",
        "magnitude",
        "rating",
        "adjustment-two-gains",
    ] {
        let mut stage = chosen(&lab, design);
        begin(&mut stage);
        to_trial(&mut stage);
        // The theme is that of the rankings.
        stage.compare_dark(&mut golden, design, 2 * SLOT);
    }
    golden.finish();
}
