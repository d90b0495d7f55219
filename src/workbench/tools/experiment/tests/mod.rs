//! Sessions in the window: what is answered is on disk, what is seen tells nothing, and the
//! user's scene comes back.

pub(crate) mod apart;
pub(crate) mod before;
pub(crate) mod drawn;

use std::fs;
use std::path::PathBuf;

use eframe::egui::{Pos2, vec2};

use super::*;
use crate::bench::command::Command;
use crate::bench::command::device::DeviceCommand;
use crate::bench::command::edit::Edit;
use crate::bench::view::Live;
use crate::shell::headless::Headless;
use selvedge_experiment::Task;
use selvedge_experiment::design::Design;
use selvedge_experiment::session::{find_sessions, path_file, samples_file};
use selvedge_render::scene::ExplorationPath;
use selvedge_scratch::ScratchFolder as Folder;

/// A window in which a session of a design was begun.
fn begun(folder: &Folder, design: &'static str, pseudonym: &str) -> Headless {
    let mut window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
    window.pass(2);
    let form = &mut window.workbench.bench.transient.experiment.form;
    form.choose(small(folder, design));
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = pseudonym.to_owned();
    window.dispatch(ExperimentCommand::Begin);
    window.pass(3);
    let experiment = &window.workbench.bench.transient.experiment;
    assert_eq!(experiment.form.failure, None);
    assert!(experiment.is_held());
    window
}

const FOUR: &str = "textiles = [\"silk-crepe\", \"wool-twill\", \"jute-plain\", \"wool-rib\"]";

/// A design of the program with four textiles in place of all: they are ready soon.
fn small(folder: &Folder, design: &'static str) -> Chosen {
    let text = Design::shipped_text(design).unwrap();
    let Some((before, rest)) = text.split_once("textiles = [") else {
        return Chosen::Shipped(design);
    };
    let (_, after) = rest.split_once(']').unwrap();
    fs::create_dir_all(&folder.0).unwrap();
    let path = folder.0.join(format!("{design}.toml"));
    fs::write(&path, format!("{before}{FOUR}{after}")).unwrap();
    Chosen::File(path)
}

fn held(window: &Headless) -> &Held {
    window
        .workbench
        .bench
        .transient
        .experiment
        .held
        .as_deref()
        .unwrap()
}

/// Goes on until a trial waits.
fn to_trial(window: &mut Headless) {
    for _ in 0..6 {
        if held(window).trial().is_some() {
            break;
        }
        window.dispatch(ExperimentCommand::Pass);
        window.pass(2);
    }
    assert!(held(window).trial().is_some());
}

/// Moves the finger to and fro for so many ticks.
fn explore(window: &mut Headless, n_ticks: u16) {
    for n in 0..n_ticks {
        let at = Pos2::new(300.0 + 6.0 * f32::from(n % 40), 300.0);
        let stamp = window.workbench.bench.stamp();
        window
            .workbench
            .shell
            .tap
            .lock()
            .unwrap()
            .moved_to(stamp, at);
        window.pass(1);
    }
}

fn mark(window: &mut Headless, mark: Mark) {
    window.dispatch(ExperimentCommand::Mark(mark));
}

fn rank(window: &mut Headless, order: [usize; 4]) {
    for position in order {
        mark(window, Mark::Place(position));
    }
    window.dispatch(ExperimentCommand::Answer);
    window.pass(4);
}

fn log_of(window: &Headless) -> PathBuf {
    held(window).log.clone()
}

#[test]
fn an_answer_is_on_disk_with_its_path_before_the_next_trial_and_is_resumed() {
    let folder = Folder::new("ranking");
    let mut window = begun(&folder, "ranking-virtual-target", "p01");
    to_trial(&mut window);
    explore(&mut window, 60);
    assert!(
        window
            .workbench
            .amplitudes_um()
            .iter()
            .flatten()
            .any(|um| *um > 0.0)
    );
    let trial = held(&window).trial().unwrap().clone();
    rank(&mut window, [2, 0, 1, 3]);
    assert_eq!(held(&window).progress, (1, 8));
    let log = log_of(&window);
    let path = ExplorationPath::read(&path_file(&log, &trial, 1)).unwrap();
    assert!(path.n_ticks() >= 60, "{}", path.n_ticks());
    let moved = path.ticks().map(|(_, pose)| pose.velocity.speed_mm_per_s());
    assert!(
        moved.fold(0.0, f64::max) > 20.0,
        "it replays how the finger moved"
    );
    let reports = fs::read_to_string(samples_file(&log, &trial, 1)).unwrap();
    let rows: Vec<&str> = reports.lines().collect();
    assert!(
        rows[0] == "t_s,x_mm,y_mm" && rows.len() >= 60,
        "{}",
        rows.len()
    );
    window.dispatch(ExperimentCommand::End);
    window.pass(3);
    assert!(!window.workbench.bench.transient.experiment.is_held());
    assert_eq!(
        window.workbench.bench.take.as_ref().map(|_| ()),
        None,
        "no recording of the user's"
    );
    let found = find_sessions(&folder.0).unwrap().0;
    let [one] = &found[..] else {
        panic!("one session")
    };
    let answer = one.records[0].answer().cloned();
    assert_eq!(
        answer,
        Some(selvedge_experiment::Answer::Ranks([2, 3, 1, 4]))
    );
    assert!(!one.records[0].apparatus.stimulus_hash.is_empty());
    window.dispatch(ExperimentCommand::Resume(log));
    window.pass(3);
    to_trial(&mut window);
    assert_eq!(held(&window).progress, (1, 8));
    assert_ne!(held(&window).trial(), Some(&trial), "the next one");
}

#[test]
fn the_document_learns_nothing_and_the_users_scene_is_felt_again() {
    let folder = Folder::new("document");
    let mut window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
    window.pass(2);
    window.dispatch(Edit::MasterGain(-7.5));
    window.dispatch(Edit::RemoveCloth(2));
    let before = window.workbench.bench.document.scene().clone();
    let form = &mut window.workbench.bench.transient.experiment.form;
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = "p01".to_owned();
    form.choose(small(&folder, "ranking-virtual-target"));
    window.dispatch(ExperimentCommand::Begin);
    window.pass(3);
    to_trial(&mut window);
    window.dispatch(Edit::MasterGain(3.0));
    window.dispatch(Command::Undo);
    window.dispatch(DeviceCommand::CopyLogPath);
    assert_eq!(window.workbench.bench.document.scene(), &before);
    assert_eq!(
        window.workbench.bench.document.undo_name(),
        Some("removed textile")
    );
    let told = window.workbench.notices();
    assert!(
        told.iter().any(|line| line.contains("end it first")),
        "{told:?}"
    );
    window.dispatch(ExperimentCommand::End);
    window.pass(3);
    assert_eq!(window.workbench.bench.document.scene(), &before);
    let serial = window.workbench.bench.scene_serial;
    let snapshot = window.workbench.bench.engine.snapshot();
    assert_eq!(snapshot.scene_serial, serial);
    assert!((snapshot.rendering.tuning.gain_db + 7.5).abs() < 1e-9);
}

#[test]
fn a_row_that_cannot_be_written_waits_with_its_answer_until_it_is() {
    let folder = Folder::new("full");
    let mut window = begun(&folder, "ranking-virtual-target", "p01");
    to_trial(&mut window);
    let log = log_of(&window);
    let trial = held(&window).trial().unwrap().clone();
    // A file stands where the folder of paths must be.
    let paths = path_file(&log, &trial, 1).parent().unwrap().to_owned();
    fs::write(&paths, "").unwrap();
    explore(&mut window, 10);
    rank(&mut window, [0, 1, 2, 3]);
    let stuck = held(&window);
    assert!(
        stuck.failure.is_some() && stuck.is_writing(),
        "{:?}",
        stuck.failure
    );
    assert_eq!((stuck.progress.0, stuck.trial()), (0, Some(&trial)));
    let view = window
        .workbench
        .bench
        .transient
        .experiment
        .participant(&Live::default(), 0.0);
    assert!(
        matches!(view, ParticipantView::Words { left_s: None, .. }),
        "{view:?}"
    );
    fs::remove_file(&paths).unwrap();
    window.dispatch(ExperimentCommand::Retry);
    window.pass(4);
    let (failure, progress) = (held(&window).failure.clone(), held(&window).progress);
    assert_eq!((failure, progress.0), (None, 1));
    assert!(path_file(&log, &trial, 1).exists());
}

#[test]
fn what_is_seen_of_a_trial_is_the_same_whatever_is_right() {
    let mut seen = Vec::new();
    let design = Design::shipped("ranking-virtual-target").unwrap();
    for pseudonym in ["p01", "p02", "p04"] {
        let folder = Folder::new(pseudonym);
        let mut window = begun(&folder, "ranking-virtual-target", pseudonym);
        to_trial(&mut window);
        let Task::Rank { target, .. } = held(&window).trial().unwrap().task else {
            panic!("a ranking")
        };
        let link = Link::of((None, None), false, [1.0; 2]);
        let experiment = &window.workbench.bench.transient.experiment;
        let told = format!("{:?}", experiment.experimenter(link, 0.0));
        let view = experiment.participant(&Live::default(), 0.0);
        let words = format!("{view:?}");
        for stimulus in &design.stimuli {
            assert!(!words.contains(&stimulus.id), "{words}");
            assert!(!told.contains(&stimulus.id), "{told}");
        }
        let ParticipantView::Trial(trial) = view else {
            panic!("a trial")
        };
        let picture = trial.ground.picture;
        assert!(picture.is_some(), "all look like the target");
        let ground = Ground {
            picture: None,
            ..trial.ground
        };
        seen.push((target, format!("{:?}", TrialView { ground, ..trial })));
    }
    let [(one, first), (two, second), (three, third)] = &seen[..] else {
        panic!("three")
    };
    assert!(one != two || one != three, "the targets differ");
    assert_eq!(first, second);
    assert_eq!(second, third);
}

#[test]
fn nothing_that_tells_what_is_felt_is_drawn_while_a_session_is_held() {
    let folder = Folder::new("veil");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let columns = window.workbench.columns_computed();
    let trail = window.workbench.shell.n_drawn;
    explore(&mut window, 20);
    assert_eq!(window.workbench.columns_computed(), columns);
    let participant = crate::bench::pane::Pane::Participant.index();
    assert!(window.workbench.shell.n_drawn[participant] > trail[participant]);
}

#[test]
fn a_trial_that_is_given_up_comes_again_and_a_pause_waits_for_the_answer() {
    let folder = Folder::new("abort");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let trial = held(&window).trial().unwrap().clone();
    window
        .workbench
        .bench
        .transient
        .experiment
        .held
        .as_mut()
        .unwrap()
        .note = "a cough".to_owned();
    window.dispatch(ExperimentCommand::Abort);
    window.pass(4);
    assert_eq!(
        (held(&window).trial(), held(&window).progress.0),
        (Some(&trial), 0)
    );
    assert_eq!(held(&window).note, "", "it is in the row");
    window.dispatch(ExperimentCommand::Pause(true));
    assert!(held(&window).trial().is_some(), "it is finished first");
    mark(&mut window, Mark::Place(1));
    mark(&mut window, Mark::Grade(selvedge_experiment::Grade::Easy));
    window.dispatch(ExperimentCommand::Answer);
    window.pass(4);
    assert_eq!((held(&window).trial(), held(&window).progress.0), (None, 1));
    window.dispatch(ExperimentCommand::Pause(false));
    window.pass(2);
    assert!(held(&window).trial().is_some_and(|next| *next != trial));
    let found = find_sessions(&folder.0).unwrap().0;
    let rows = &found[0].records;
    assert_eq!(
        (rows.len(), rows[0].note.as_str(), rows[1].attempt),
        (2, "a cough", 2)
    );
}

#[test]
fn what_is_turned_is_felt_at_once_and_logged() {
    let folder = Folder::new("adjust");
    let mut window = begun(&folder, "gain-matching", "p01");
    to_trial(&mut window);
    let felt_db = |window: &mut Headless| {
        window
            .workbench
            .bench
            .engine
            .snapshot()
            .rendering
            .tuning
            .gain_db
    };
    let start = held(&window).tuning().gain_db;
    assert!((felt_db(&mut window) - start).abs() < 1e-9);
    mark(&mut window, Mark::Turn(0, 2));
    mark(&mut window, Mark::Turn(0, -1));
    window.pass(2);
    let turned = held(&window).tuning().gain_db;
    assert!((turned - start).abs() > 0.5, "{start} {turned}");
    assert!((felt_db(&mut window) - turned).abs() < 1e-9);
    window.dispatch(ExperimentCommand::Answer);
    window.pass(4);
    let found = find_sessions(&folder.0).unwrap().0;
    let Some(selvedge_experiment::Answer::Adjusted { values, steps }) =
        found[0].records[0].answer()
    else {
        panic!("an adjustment")
    };
    assert!((values[0] - turned).abs() < 1e-9 && steps.len() == 2);
    assert!((found[0].records[0].apparatus.tuning.gain_db - turned).abs() < 1e-9);
}

#[test]
fn a_vibration_is_played_at_the_beginning_of_its_trial_and_again_when_asked() {
    let folder = Folder::new("magnitude");
    let mut window = begun(&folder, "magnitude", "p01");
    to_trial(&mut window);
    let loudest = |window: &Headless| {
        let all = window.workbench.amplitudes_um();
        all.iter().flatten().copied().fold(0.0, f64::max)
    };
    window.pass(40);
    assert!(loudest(&window) > 0.1, "after the silence it begins with");
    assert_eq!(held(&window).interval(), Some(0));
    window.pass(40);
    assert!(loudest(&window) <= 0.0 && held(&window).may_play_again());
    window.dispatch(ExperimentCommand::Play);
    window.pass(35);
    assert!(loudest(&window) > 0.1);
    mark(&mut window, Mark::Type("12.5".to_owned()));
    window.dispatch(ExperimentCommand::Answer);
    window.pass(4);
    assert_eq!(held(&window).progress.0, 1);
}

#[test]
fn sessions_of_a_folder_are_listed_and_one_is_not_begun_twice() {
    let folder = Folder::new("list");
    let mut window = begun(&folder, "odd-one-out", "p01");
    window.dispatch(ExperimentCommand::End);
    window.pass(3);
    let form = &window.workbench.bench.transient.experiment.form;
    let [row] = &form.found[..] else {
        panic!("one session")
    };
    assert_eq!(
        (row.subject.pseudonym.as_str(), row.progress),
        ("p01", (0, 9))
    );
    window.dispatch(ExperimentCommand::Begin);
    window.pass(3);
    let failure = window
        .workbench
        .bench
        .transient
        .experiment
        .form
        .failure
        .clone();
    assert!(failure.unwrap().contains("resume it below"));
    window
        .workbench
        .bench
        .transient
        .experiment
        .form
        .who
        .pseudonym = "p02".to_owned();
    window.dispatch(ExperimentCommand::Begin);
    window.pass(3);
    assert_eq!(held(&window).subject.nth, 1, "the second of the study");
}
