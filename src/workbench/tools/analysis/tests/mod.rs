//! Analyses in the window: the numbers of the analysis itself, one line for what is wrong, and
//! nothing that nobody looks at.

pub(crate) mod drawn;

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use std::{fs, thread};

use eframe::egui::{self, vec2};

use super::*;
use crate::bench::background::Executor;
use crate::bench::command::ShowCommand;
use crate::bench::command::edit::Edit;
use crate::bench::session::SessionInSight;
use crate::shell::arrangement;
use crate::shell::headless::Headless;
use crate::tools::analysis::asked::{Asked, Choice, Effort};
use crate::tools::analysis::findings::find_out;
use selvedge_experiment::Simulation;
use selvedge_experiment::analysis::{self as study, Section};
use selvedge_experiment::design::{Design, Subject};
use selvedge_experiment::observer::{Observer, Stimuli};
use selvedge_experiment::session::Session;
use selvedge_foundation::progress::Progress;
use selvedge_scratch::ScratchFolder as Folder;
use selvedge_textile::Library;

const DESIGN: &str = "odd-one-out";

/// Simulated sessions of so many observers.
fn study(folder: &Folder, n_observers: usize) {
    let design = Design::shipped(DESIGN).unwrap();
    let library = Library::shipped().unwrap();
    let stimuli = Progress::unheard(|progress| Stimuli::of(&design, &library, progress)).unwrap();
    let simulation = Simulation {
        design: &design,
        stimuli: &stimuli,
        observer: &Observer::default(),
        seed: 3,
    };
    let numbers = (n_observers, 1);
    Progress::unheard(|progress| simulation.write(&folder.0, numbers, progress)).unwrap();
}

fn asked(folder: &Path) -> Asked {
    Asked {
        folder: folder.to_owned(),
        seed: 7,
        choice: Choice {
            effort: Effort::Quick,
            has_random_data: false,
            with_active: false,
        },
    }
}

/// A window with the pane in front that is asked for this.
fn window(asked: &Asked) -> Headless {
    let mut window = Headless::shipped();
    window.pass(2);
    window.dispatch(ShowCommand::Pane(Pane::Analysis));
    ask(&mut window, asked);
    window
}

fn ask(window: &mut Headless, asked: &Asked) {
    let analysis = analysis_mut(window);
    analysis.fields.seed = asked.seed.to_string();
    analysis.choice = asked.choice.clone();
}

fn analysis(window: &Headless) -> &Analysis {
    window.workbench.tools.get().unwrap()
}

fn analysis_mut(window: &mut Headless) -> &mut Analysis {
    window.workbench.tools.get_mut().unwrap()
}

/// Chooses a folder, as the dialog that asks for one does.
fn open(window: &mut Headless, folder: &Path) {
    window.dispatch(FileCommand::Use(Purpose::OpenLogs, folder.to_owned()));
}

fn begin(window: &mut Headless) {
    let workbench = &mut window.workbench;
    let analysis: &mut Analysis = workbench.tools.get_mut().unwrap();
    analysis.begin(&workbench.bench);
}

#[test]
fn a_folder_in_the_window_gives_the_numbers_of_the_analysis_and_its_files() {
    let folder = Folder::new("analysed");
    study(&folder, 3);
    let asked = asked(&folder.0);
    let mut window = window(&asked);
    open(&mut window, &folder.0);
    window.pass(3);
    let expected = Progress::unheard(|progress| {
        study::Analysis::of_folder(&folder.0, &asked.options(), progress)
    })
    .unwrap();
    let found = analysis(&window).found.as_ref().unwrap();
    assert_eq!(found.analysis, expected);
    assert_eq!((&found.asked, found.n_sessions), (&asked, 3));
    assert_eq!(found.left_out, [""; 0]);
    let [warning] = &found.warnings[..] else {
        panic!("{:?}", found.warnings)
    };
    assert!(warning.contains("3 of 4 planned subjects"), "{warning}");
    assert!(warning.contains("p values"), "{warning}");

    window.dispatch(FileCommand::Use(Purpose::WriteReport, folder.0.clone()));
    window.pass(2);
    assert!(!folder.0.join("index.md").exists(), "not among the logs");
    let out = analysis(&window).known_path(Purpose::WriteReport).unwrap();
    assert_eq!(analysis(&window).written, Some(Ok(out.clone())));
    let page = fs::read_to_string(out.join("index.md")).unwrap();
    assert_eq!(page, expected.page());
    let beyond = out.join("index.md").join("beyond");
    window.dispatch(FileCommand::Use(Purpose::WriteReport, beyond));
    window.pass(2);
    let line = analysis(&window).written.clone().unwrap().unwrap_err();
    assert!(line.contains("beyond") && !line.contains('\n'), "{line}");
    let again = Progress::unheard(|progress| find_out(asked.clone(), None, progress)).unwrap();
    assert_eq!(again.n_sessions, 3, "the report is no session");
}

#[test]
fn a_folder_that_is_missing_or_empty_says_so_in_one_line_and_the_last_result_stays() {
    let (folder, empty) = (Folder::new("some"), Folder::new("empty"));
    study(&folder, 2);
    fs::create_dir_all(&empty.0).unwrap();
    let mut window = window(&asked(&folder.0));
    open(&mut window, &folder.0);
    window.pass(2);
    let found = Arc::clone(analysis(&window).found.as_ref().unwrap());
    let missing = empty.0.join("nowhere");
    for (path, words) in [
        (&empty.0, "holds no session"),
        (&missing, "there is no folder"),
    ] {
        open(&mut window, path);
        window.pass(2);
        let analysis = analysis(&window);
        let line = analysis.failure.as_ref().unwrap();
        assert!(
            line.contains(words) && line.contains(&*path.to_string_lossy()),
            "{line}"
        );
        assert!(!line.contains('\n'), "{line}");
        assert!(
            Arc::ptr_eq(analysis.found.as_ref().unwrap(), &found),
            "the last one stays"
        );
        assert!(analysis.is_past(), "and says that it is of another folder");
    }
    analysis_mut(&mut window).fields.seed = "seven".to_owned();
    begin(&mut window);
    window.pass(2);
    let refusal = analysis(&window).refusal().unwrap();
    assert!(refusal.contains("whole number"), "{refusal}");
}

#[test]
fn an_analysis_that_is_cancelled_leaves_the_last_result() {
    let folder = Folder::new("cancelled");
    study(&folder, 2);
    let ctx = egui::Context::default();
    let mut analysis = Analysis::default();
    analysis.fields.folder = folder.0.display().to_string();
    analysis.choice = asked(&folder.0).choice;
    analysis.begin_with(&Executor::InLine, None);
    analysis.poll();
    let found = Arc::clone(analysis.found.as_ref().unwrap());
    analysis.choice = Choice {
        effort: Effort::Full,
        has_random_data: true,
        with_active: false,
    };
    analysis.begin_with(&Executor::Threads(ctx.clone()), None);
    assert!(analysis.share().is_some());
    analysis.stop();
    let began = Instant::now();
    while analysis.share().is_some() {
        assert!(began.elapsed() < Duration::from_mins(2), "it goes on");
        thread::sleep(Duration::from_millis(2));
        analysis.poll();
    }
    assert!(Arc::ptr_eq(analysis.found.as_ref().unwrap(), &found));
    assert_eq!(analysis.failure, None, "whoever cancels knows it");
    assert!(analysis.is_past());
}

#[test]
fn who_takes_part_in_a_session_under_way_is_left_out_unless_that_is_asked_for() {
    let folder = Folder::new("held");
    study(&folder, 2);
    let subject = Subject {
        pseudonym: "o02".to_owned(),
        nth: 1,
        session: 2,
    };
    let design = Design::shipped(DESIGN).unwrap();
    let held = Session::create(&folder.0, design, subject, "none").unwrap();
    let mut asked = asked(&folder.0);
    let find =
        |asked: &Asked| Progress::unheard(|progress| find_out(asked.clone(), None, progress));
    let found = find(&asked).unwrap();
    assert_eq!(found.left_out, ["o02"]);
    assert_eq!(found.n_sessions, 1, "neither of their sessions");
    asked.choice.with_active = true;
    let found = find(&asked).unwrap();
    assert_eq!((found.left_out.len(), found.n_sessions), (0, 3));
    asked.choice.with_active = false;
    let log = held.log().to_owned();
    drop(held);
    let found = find(&asked).unwrap();
    assert_eq!(found.n_sessions, 3, "it is over");
    let found =
        Progress::unheard(|progress| find_out(asked.clone(), Some(&log), progress)).unwrap();
    assert_eq!(found.left_out, ["o02"], "this window holds it");
    let alone = Folder::new("alone");
    fs::create_dir_all(&alone.0).unwrap();
    for ending in ["csv", "json"] {
        let name = log.with_extension(ending);
        fs::copy(&name, alone.0.join(name.file_name().unwrap())).unwrap();
    }
    let copied = alone.0.join(log.file_name().unwrap());
    asked.folder.clone_from(&alone.0);
    let refusal = Progress::unheard(|progress| find_out(asked.clone(), Some(&copied), progress));
    let line = refusal.unwrap_err();
    assert!(
        line.contains("nobody but o02") && !line.contains('\n'),
        "{line}"
    );
}

#[test]
fn figures_are_drawn_once_and_only_while_they_are_in_sight() {
    let folder = Folder::new("figures");
    study(&folder, 2);
    let mut window = window(&asked(&folder.0));
    open(&mut window, &folder.0);
    window.pass(4);
    let has_two = |s: &Section| s.figures.len() >= 2;
    let sections = &analysis(&window).found.as_ref().unwrap().analysis.sections;
    let map = sections.iter().position(has_two).unwrap();
    assert_eq!(analysis(&window).n_drawn(), 1, "the answer has its figure");
    analysis_mut(&mut window).section = map;
    window.pass(4);
    assert_eq!(analysis(&window).n_drawn(), 2);
    let pictures = Arc::clone(analysis(&window).pictures.value().unwrap());
    for image in &pictures.images[..2] {
        let image = image.as_ref().unwrap();
        let n_inked = image.pixels.iter().filter(|pixel| pixel.a() > 128).count();
        assert!(image.size[0] >= 540 && n_inked > 2000, "{n_inked} pixels");
    }
    window.pass(30);
    assert_eq!(analysis(&window).n_drawn(), 2, "nothing has changed");
    let toggle = ShowCommand::Pane(Pane::Analysis);
    window.dispatch(toggle.clone());
    assert!(!arrangement::is_shown(
        &window.workbench.shell.tree,
        Pane::Analysis
    ));
    analysis_mut(&mut window).section = map + 1;
    begin(&mut window);
    window.pass(10);
    assert_eq!(analysis(&window).n_drawn(), 2, "nobody looks");
    analysis_mut(&mut window).section = map;
    window.dispatch(toggle);
    window.pass(4);
    assert_eq!(analysis(&window).n_drawn(), 3, "somebody does");
}

#[test]
fn a_section_stays_at_hand_when_the_same_is_analysed_again() {
    let folder = Folder::new("stays");
    study(&folder, 2);
    let mut window = window(&asked(&folder.0));
    open(&mut window, &folder.0);
    window.pass(2);
    analysis_mut(&mut window).section = 2;
    let key = analysis(&window).section().unwrap().key.clone();
    begin(&mut window);
    window.pass(2);
    assert_eq!(analysis(&window).section().unwrap().key, key);
}

fn is_covered(window: &Headless) -> bool {
    analysis(window).is_covered(&window.workbench.bench)
}

#[test]
fn while_a_session_is_held_results_are_covered_and_its_subject_is_left_out() {
    let folder = Folder::new("covered");
    study(&folder, 2);
    let mut window = window(&asked(&folder.0));
    open(&mut window, &folder.0);
    window.pass(3);
    let subject = Subject {
        pseudonym: "p07".to_owned(),
        nth: 2,
        session: 1,
    };
    let design = Design::shipped("threshold-40").unwrap();
    let active = Session::create(&folder.0, design, subject, "none").unwrap();
    window.workbench.bench.session.active = Some(SessionInSight {
        pseudonym: "p07".to_owned(),
        log: active.log().to_owned(),
        hung: None,
    });
    window.pass(2);
    assert!(is_covered(&window));
    analysis_mut(&mut window).is_uncovered = true;
    window.pass(2);
    assert!(!is_covered(&window));
    begin(&mut window);
    window.pass(2);
    assert_eq!(window.workbench.notices(), [""; 0], "that is allowed");
    let found = analysis(&window).found.as_ref().unwrap();
    assert_eq!(
        (found.n_sessions, &found.left_out[..]),
        (2, &["p07".to_owned()][..])
    );
    window.workbench.bench.session.active = None;
    window.pass(3);
    assert!(!analysis(&window).is_uncovered, "the next one is covered");
}

#[test]
fn results_say_that_their_folder_has_changed_since() {
    let folder = Folder::new("moved-on");
    study(&folder, 2);
    let mut window = window(&asked(&folder.0));
    open(&mut window, &folder.0);
    window.pass(3);
    let look = |window: &mut Headless| {
        analysis_mut(window).looked_s = f64::INFINITY;
        window.pass(3);
        analysis(window).has_moved_on()
    };
    assert!(!look(&mut window), "nothing has changed");
    fs::write(folder.0.join("another.csv"), "late").unwrap();
    assert!(look(&mut window));
    fs::remove_file(folder.0.join("another.csv")).unwrap();
    assert!(!look(&mut window), "it is as it was");
}

#[test]
fn a_point_of_a_map_that_is_clicked_is_felt_in_the_workspace() {
    let folder = Folder::new("map");
    study(&folder, 4);
    let mut window = window(&asked(&folder.0));
    open(&mut window, &folder.0);
    window.pass(3);
    let found = Arc::clone(analysis(&window).found.as_ref().unwrap());
    let mut sections = found.analysis.sections.iter();
    let points = sections.find_map(|section| {
        let drawn = section.figures.iter();
        let mut points = drawn.map(|drawn| view::figure::textiles_at(drawn, &found));
        points.find(|points| !points.is_empty())
    });
    let points = points.unwrap();
    assert!(points.len() >= 4, "{points:?}");
    let (name, key, _) = &points[0];
    assert_eq!(key, &format!("sixteen:{name}"));
    let bench = &window.workbench.bench;
    let (scene, own) = (
        bench.plain_scene_view(),
        bench.engine_scene.loaded.library(),
    );
    let commands = |key: &str| view::section::felt(key, &scene, own);
    let expected = match scene.placed(name) {
        Some(index) => Command::from(ShowCommand::SelectCloth(Some(index))),
        None => Edit::AddCloths(vec![name.clone()]).into(),
    };
    assert_eq!(commands(key)[0], expected);
    let elsewhere = Edit::AddCloths(vec!["seventy-four:serge".to_owned()]);
    assert_eq!(commands("seventy-four:serge")[0], elsewhere.into());
    let added = commands("sixteen:denim");
    for command in added {
        window.dispatch(command);
    }
    window.pass(2);
    let textiles = &window.workbench.bench.document.scene().textiles;
    assert!(
        textiles.iter().any(|cloth| cloth.id == "denim"),
        "{textiles:?}"
    );
    assert!(window.workbench.shell.shows(Pane::Workspace));
}
