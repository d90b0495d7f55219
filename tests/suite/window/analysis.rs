//! The analysis of logs: a folder is typed, its numbers stand in the window and are taken along.

use eframe::egui::OutputCommand;
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use selvedge_experiment::analysis::{Analysis, Options, Section};
use selvedge_foundation::progress::{CancelFlag, Progress};

use super::*;
use crate::program::Lab;

/// A window with the pane in front, and the folder of a simulated study typed into it.
fn in_front(scene: &Folder, logs: &Path) -> Harness<'static, Workbench> {
    let mut harness = window(&scene.scene());
    harness.run_steps(3);
    click_tab(&mut harness, "Analysis");
    let field = harness.get_by_role_and_label(Role::TextInput, "folder");
    field.click();
    harness.step();
    let path = logs.display().to_string();
    harness.event(Event::Text(path));
    harness.run_steps(2);
    harness.get_by_label_contains("For a look").click();
    harness.run_steps(2);
    harness
}

fn click(harness: &mut Harness<'_, Workbench>, name: &str) {
    harness.get_by_role_and_label(Role::Button, name).click();
    harness.run_steps(4);
}

/// The folder of a simulated study, and what is known of it.
fn study(lab: &Lab) -> (PathBuf, Analysis) {
    let simulate = "experiment simulate odd-one-out --observers 2 --seed 3 --out logs";
    lab.print(&simulate.split(' ').collect::<Vec<_>>());
    let logs = lab.path("logs");
    let options = Options {
        n_resamples: 100,
        n_permutations: 99,
        n_maps: 0,
        n_starts: 1,
        n_starts_on_a_line: 1,
        ..Options::default()
    };
    let mut unheard = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut unheard, CancelFlag::default());
    let expected = Analysis::of_folder(&logs, &options, &mut progress).unwrap();
    (logs, expected)
}

/// What is copied when a button is clicked.
fn copied_by(harness: &mut Harness<'_, Workbench>, name: &str) -> String {
    harness.get_by_label(name).click();
    let mut copied = String::new();
    for _ in 0..3 {
        harness.step();
        for command in &harness.output().platform_output.commands {
            if let OutputCommand::CopyText(text) = command {
                copied.clone_from(text);
            }
        }
    }
    copied
}

#[test]
fn a_folder_of_logs_is_analysed_and_its_numbers_stand_in_the_window() {
    let lab = Lab::new();
    let (logs, expected) = study(&lab);
    let accuracy = |one: &&Section| one.key == "odd-one-out-accuracy";
    let of_subjects = &expected.sections.iter().find(accuracy).unwrap().tables[0];
    let right = |row| of_subjects.cell(row, "right").unwrap().number().unwrap();
    let scene = Folder::new("analysed");
    let mut harness = in_front(&scene, &logs);
    click(&mut harness, "Analyse");
    harness.get_by_label_contains("2 of 4 planned subjects");
    click(&mut harness, "Odd one out of three: accuracy");
    for (row, subject) in ["o01", "o02"].into_iter().enumerate() {
        let n_right = right(row);
        let words = format!("subject {subject}, session 1, triads 21, right {n_right}, %");
        harness.get_by_label_contains(&words);
    }
    let copied = copied_by(
        &mut harness,
        &format!("Copy “{}” as CSV", of_subjects.title),
    );
    assert_eq!(copied, of_subjects.to_csv().unwrap());
    harness.run_steps(40);
    assert_eq!(repaint_delay(&harness), Duration::MAX, "still");
}

#[test]
fn a_figure_and_the_report_are_taken_along() {
    let lab = Lab::new();
    let (logs, expected) = study(&lab);
    let scene = Folder::new("reported");
    let mut harness = in_front(&scene, &logs);
    click(&mut harness, "Analyse");
    let figure = &expected.sections[0].figures[0].figure;
    harness.get_by_role_and_label(Role::Image, &figure.title);
    let save = format!("Save “{}” as PNG, SVG or CSV", figure.title);
    harness.get_by_label(&save).click();
    harness.run_steps(2);
    let picture = lab.path("right.svg");
    type_path(&mut harness, &picture.display().to_string());
    assert_eq!(
        fs::read_to_string(&picture).unwrap(),
        figure.to_svg().unwrap()
    );
    click(&mut harness, "Write report…");
    let out = lab.path("report");
    type_path(&mut harness, &out.display().to_string());
    harness.get_by_label_contains("Written: begin with");
    assert!(out.join("index.md").exists());
    harness.render().unwrap();
}

#[test]
fn a_folder_without_sessions_says_what_to_do_in_one_line() {
    let lab = Lab::new();
    let scene = Folder::new("no-sessions");
    let mut harness = in_front(&scene, &lab.path(""));
    click(&mut harness, "Analyse");
    harness.get_by_label_contains("holds no session; name a folder with logs");
}
