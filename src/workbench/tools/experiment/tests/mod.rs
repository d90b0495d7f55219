//! Sessions in the window: what is answered is on disk, what is seen tells nothing, and the
//! user's scene comes back.

pub(crate) mod apart;
pub(crate) mod before;
pub(crate) mod drawn;
mod felt_by_stylus;
mod finger;
mod hanging;
mod in_turn;
pub(crate) mod presented;

use std::fs;
use std::path::PathBuf;

use eframe::egui::{Key, Modifiers, vec2};

use super::*;
use crate::bench::command::Command;
use crate::bench::command::device::DeviceCommand;
use crate::bench::command::edit::Edit;
use crate::bench::view::EngineView;
use crate::shell::headless::Headless;
use crate::tools::experiment::active_session::ActiveSession;
use crate::tools::experiment::draft::{Draft, Mark};
use crate::tools::experiment::noise::NoiseView;
use crate::tools::experiment::now::{Now, Pause};
use crate::tools::experiment::presenting::ArrayNow;
use crate::tools::experiment::view::{Ground, Link, TrialView};
use selvedge_experiment::AnswerValue;
use selvedge_experiment::design::Design;
use selvedge_experiment::session::{Found, path_file, samples_file};
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::ExplorationPath;
use selvedge_scratch::ScratchFolder as Folder;

use finger::{Frames, explore, feel, stroke};

/// A window in which a session of a design was begun.
fn begun(folder: &Folder, design: &'static str, pseudonym: &str) -> Headless {
    let mut window = Headless::shipped();
    window.pass(2);
    let form = &mut experiment_mut(&mut window).form;
    form.choose(small(folder, design));
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = pseudonym.to_owned();
    begin(&mut window);
    window.pass(3);
    let tool = experiment(&window);
    assert_eq!(tool.form.failure, None);
    assert!(tool.session.is_some());
    window
}

const FOUR: &str = "textiles = [\"silk-crepe\", \"wool-twill\", \"jute-plain\", \"wool-rib\"]";

/// A design of the program with four textiles in place of all: they are ready soon.
fn small(folder: &Folder, design: &'static str) -> Chosen {
    let text = Design::shipped_text(design).unwrap();
    let four = with_four(text);
    if four == text {
        return Chosen::Shipped(design);
    }
    fs::create_dir_all(&folder.0).unwrap();
    let path = folder.0.join(format!("{design}.toml"));
    fs::write(&path, four).unwrap();
    Chosen::File(path)
}

/// The text of a design with four textiles in place of all, where it lists more.
fn with_four(text: &str) -> String {
    let listed = text.split_once("textiles = [").and_then(|(before, rest)| {
        let (all, after) = rest.split_once(']')?;
        (all.matches('"').count() > 8).then(|| format!("{before}{FOUR}{after}"))
    });
    listed.unwrap_or_else(|| text.to_owned())
}

fn experiment(window: &Headless) -> &Experiment {
    window.workbench.tools.get().unwrap()
}

fn experiment_mut(window: &mut Headless) -> &mut Experiment {
    window.workbench.tools.get_mut().unwrap()
}

fn session(window: &Headless) -> &ActiveSession {
    experiment(window).session.as_deref().unwrap()
}

/// Does something that a button or a key does.
fn act(window: &mut Headless, act: impl FnOnce(&mut Experiment, &mut Bench)) {
    let workbench = &mut window.workbench;
    act(workbench.tools.get_mut().unwrap(), &mut workbench.bench);
}

/// Begins a session that nobody feels, on the screen alone.
fn begin(window: &mut Headless) {
    act(window, |one, bench| {
        let plan = one.form.plan();
        one.begin_on(plan, true, bench);
    });
}

fn pass(window: &mut Headless) {
    act(window, Experiment::pass);
}

fn mark(window: &mut Headless, mark: Mark) {
    act(window, move |one, bench| one.mark(&mark, bench));
}

fn answer(window: &mut Headless) {
    act(window, Experiment::hand_in);
}

fn end(window: &mut Headless) {
    act(window, Experiment::end);
}

/// Goes on until a trial waits.
fn to_trial(window: &mut Headless) {
    for _ in 0..6 {
        if session(window).trial().is_some() {
            break;
        }
        pass(window);
        window.pass(2);
    }
    lay(window);
}

/// Lays the cloth, where there is any, so that the trial begins.
fn lay(window: &mut Headless) {
    experiment_mut(window).session.as_mut().unwrap().lay();
    window.pass(3);
    let session = session(window);
    assert!(session.trial().is_some() && !session.is_waiting());
}

fn rank(window: &mut Headless, order: [usize; 4]) {
    feel(window);
    for position in order {
        mark(window, Mark::Place(position));
    }
    answer(window);
    window.pass(4);
}

fn log_of(window: &Headless) -> PathBuf {
    session(window).log.clone()
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
    let trial = session(&window).trial().unwrap().clone();
    rank(&mut window, [2, 0, 1, 3]);
    assert_eq!(session(&window).progress, (1, 8));
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
    end(&mut window);
    window.pass(3);
    assert!(experiment(&window).session.is_none());
    assert_eq!(
        window
            .workbench
            .bench
            .exploration
            .at_hand
            .as_ref()
            .map(|_| ()),
        None,
        "no recording of the user's"
    );
    let found = Found::in_folder(&folder.0).unwrap().0;
    let [one] = &found[..] else {
        panic!("one session")
    };
    let answer = one.records[0].answer().cloned();
    assert_eq!(
        answer,
        Some(selvedge_experiment::Answer::in_order(&[2, 0, 1, 3]))
    );
    assert!(!one.records[0].apparatus.stimulus_hash.is_empty());
    act(&mut window, |one, bench| one.resume_session(log, bench));
    window.pass(3);
    to_trial(&mut window);
    assert_eq!(session(&window).progress, (1, 8));
    assert_ne!(session(&window).trial(), Some(&trial), "the next one");
}

#[test]
fn the_document_learns_nothing_and_the_users_scene_is_felt_again() {
    let folder = Folder::new("document");
    let mut window = Headless::shipped();
    window.pass(2);
    window.dispatch(Edit::MasterGain(-7.5));
    window.dispatch(Edit::RemoveCloth(2));
    let before = window.workbench.bench.document.scene().clone();
    let form = &mut experiment_mut(&mut window).form;
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = "p01".to_owned();
    form.choose(small(&folder, "ranking-virtual-target"));
    begin(&mut window);
    window.pass(3);
    to_trial(&mut window);
    window.dispatch(Edit::MasterGain(3.0));
    window.dispatch(Command::Undo);
    window.dispatch(DeviceCommand::CopyLogPath);
    assert_eq!(window.workbench.bench.document.scene(), &before);
    assert_eq!(
        window.workbench.bench.document.steps().undo(),
        Some("removed textile")
    );
    let described = window.workbench.notices();
    assert!(
        described.iter().any(|line| line.contains("end it first")),
        "{described:?}"
    );
    end(&mut window);
    window.pass(3);
    assert_eq!(window.workbench.bench.document.scene(), &before);
    let serial = window.workbench.bench.engine_scene.serial;
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
    let trial = session(&window).trial().unwrap().clone();
    // A file stands where the folder of paths must be.
    let paths = path_file(&log, &trial, 1).parent().unwrap().to_owned();
    fs::write(&paths, "").unwrap();
    explore(&mut window, 10);
    rank(&mut window, [0, 1, 2, 3]);
    let stuck = session(&window);
    assert!(
        stuck.failure.is_some() && stuck.is_writing(),
        "{:?}",
        stuck.failure
    );
    assert_eq!((stuck.progress.0, stuck.trial()), (0, Some(&trial)));
    let view = experiment(&window).participant(&EngineView::default(), 0.0);
    assert!(
        matches!(view, ParticipantView::Words { left_s: None, .. }),
        "{view:?}"
    );
    fs::remove_file(&paths).unwrap();
    act(&mut window, |one, bench| one.retry(bench));
    window.pass(4);
    let (failure, progress) = (session(&window).failure.clone(), session(&window).progress);
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
        let target = session(&window).trial().unwrap().task.reference.unwrap();
        let bench = &window.workbench.bench;
        let device = (Link::of(bench), ArrayNow::of(bench));
        let described = format!("{:?}", session(&window).view(device, 0.0));
        let view = experiment(&window).participant(&EngineView::default(), 0.0);
        let words = format!("{view:?}");
        for stimulus in &design.stimuli {
            assert!(!words.contains(&stimulus.id), "{words}");
            assert!(!described.contains(&stimulus.id), "{described}");
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
    let participant = Pane::Participant.index();
    assert!(window.workbench.shell.n_drawn[participant] > trail[participant]);
}

#[test]
fn a_trial_that_is_given_up_comes_again_and_a_pause_waits_for_the_answer() {
    let folder = Folder::new("abort");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let trial = session(&window).trial().unwrap().clone();
    let session_mut = experiment_mut(&mut window).session.as_mut();
    session_mut.unwrap().note = "a cough".to_owned();
    act(&mut window, |one, bench| one.end_trial(None, bench));
    window.pass(4);
    assert_eq!(
        (session(&window).trial(), session(&window).progress.0),
        (Some(&trial), 0)
    );
    assert_eq!(session(&window).note, "", "it is in the row");
    act(&mut window, |one, bench| one.pause(true, bench));
    assert!(session(&window).trial().is_some(), "it is finished first");
    window.pass(2);
    feel(&mut window);
    mark(&mut window, Mark::Place(1));
    mark(&mut window, Mark::Confidence(1));
    answer(&mut window);
    window.pass(4);
    assert_eq!(
        (session(&window).trial(), session(&window).progress.0),
        (None, 1)
    );
    act(&mut window, |one, bench| one.pause(false, bench));
    window.pass(2);
    assert!(session(&window).trial().is_some_and(|next| *next != trial));
    let found = Found::in_folder(&folder.0).unwrap().0;
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
    let start = session(&window).tuning().gain_db;
    assert!((felt_db(&mut window) - start).abs() < 1e-9);
    mark(&mut window, Mark::Turn(0, 2));
    mark(&mut window, Mark::Turn(0, -1));
    window.pass(2);
    let turned = session(&window).tuning().gain_db;
    assert!((turned - start).abs() > 0.5, "{start} {turned}");
    assert!((felt_db(&mut window) - turned).abs() < 1e-9);
    feel(&mut window);
    answer(&mut window);
    window.pass(4);
    let found = Found::in_folder(&folder.0).unwrap().0;
    let Some(AnswerValue::Adjusted { values, steps }) = found[0].records[0].value() else {
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
    let intervals = session(&window).intervals().unwrap();
    assert_eq!((intervals.n, intervals.played), (1, Some(0)));
    window.pass(40);
    assert!(loudest(&window) <= 0.0 && session(&window).may_play_again());
    act(&mut window, |one, bench| one.play_again(bench));
    window.pass(35);
    assert!(loudest(&window) > 0.1);
    feel(&mut window);
    mark(&mut window, Mark::Type("12.5".to_owned()));
    answer(&mut window);
    window.pass(4);
    assert_eq!(session(&window).progress.0, 1);
}

#[test]
fn sessions_of_a_folder_are_listed_and_one_is_not_begun_twice() {
    let folder = Folder::new("list");
    let mut window = begun(&folder, "odd-one-out", "p01");
    end(&mut window);
    window.pass(3);
    let form = &experiment(&window).form;
    let [row] = &form.found[..] else {
        panic!("one session")
    };
    assert_eq!(
        (row.subject.pseudonym.as_str(), row.progress),
        ("p01", (0, 9))
    );
    begin(&mut window);
    window.pass(3);
    let failure = experiment(&window).form.failure.clone();
    assert!(failure.unwrap().contains("resume it on the Study board"));
    experiment_mut(&mut window).form.who.pseudonym = "p02".to_owned();
    begin(&mut window);
    window.pass(3);
    assert_eq!(session(&window).subject.nth, 1, "the second of the study");
}
