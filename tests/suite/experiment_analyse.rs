//! `selvedge experiment analyse` on folders as they come: complete, begun, damaged, of a later
//! version, and interrupted.

use std::fs;
use std::path::{Path, PathBuf};

use selvedge_experiment::design::{Design, Subject};
use selvedge_experiment::session::{Circumstances, Session};
use selvedge_experiment::{Answer, Apparatus, Presentation, Proof, Step, Timing};

use crate::program::{Lab, Outcome};

const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    title = \"Odd cloth\"\ntextiles = [\"a\", \"b\", \"c\", \"d\", \"e\"]\n[odd_one_out]\n";
const ANALYSE: [&str; 5] = ["experiment", "analyse", "logs", "--out", "found"];

/// A session of so many trials of ten, every third of them wrong.
fn on_disk(lab: &Lab, nth: usize, n_trials: usize, is_right: fn(usize) -> bool) -> PathBuf {
    let design = Design::from_toml(CLOTH, Path::new("cloth.toml")).unwrap();
    let subject = Subject {
        pseudonym: format!("p{:02}", nth + 1),
        nth,
        session: 1,
    };
    let mut session = Session::create(&lab.path("logs"), design, subject, "none").unwrap();
    for number in 0..n_trials {
        let Step::Trial(trial) = session.step() else {
            panic!("a trial waits");
        };
        let odd = trial.task.right.unwrap();
        let position = if is_right(number) { odd } else { (odd + 1) % 3 };
        let answer = Answer::chosen(position, [Some(1), Some(2), Some(3)][number % 3]);
        let circumstances = Circumstances {
            timing: Timing::between([std::time::UNIX_EPOCH; 2], [0, 5_000_000_000]),
            apparatus: Apparatus::default(),
            presentation: Presentation::confirmed(Proof::RealCloth),
            note: "",
            path: None,
            samples: &[],
        };
        session.answer(&answer, &circumstances).unwrap();
    }
    session.log().to_owned()
}

/// Every text that was written, by its file.
fn written(lab: &Lab) -> Vec<(String, String)> {
    let entries = fs::read_dir(lab.path("found")).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let is_text = |path: &PathBuf| path.extension().is_some_and(|ending| ending != "png");
    let text = |path: PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, fs::read_to_string(path).unwrap())
    };
    paths.filter(is_text).map(text).collect()
}

fn nothing_endless(lab: &Lab) {
    let all = written(lab);
    assert!(all.len() > 10, "{}", all.len());
    for (file, text) in all {
        for never in ["NaN", ",nan", ",inf", "Infinity", "∞"] {
            assert!(!text.contains(never), "{never} in {file}");
        }
    }
}

#[test]
fn a_log_of_a_later_version_is_left_out_with_a_line_and_the_rest_is_analysed() {
    let lab = Lab::new();
    on_disk(&lab, 0, 10, |number| number % 3 > 0);
    let later = on_disk(&lab, 1, 10, |number| number % 2 > 0);
    let sidecar = later.with_extension("json");
    let text = fs::read_to_string(&sidecar).unwrap();
    let newer = text.replacen("\"schema_version\": 2", "\"schema_version\": 3", 1);
    assert_ne!(text, newer, "the version is there");
    fs::write(&sidecar, newer).unwrap();
    let outcome = lab.run(&ANALYSE);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    let described = outcome.one_line();
    assert!(
        described.contains("cloth_odd_p02_1.csv is left out"),
        "{described}"
    );
    assert!(
        described.contains("version 3") && described.contains("use a later one"),
        "{described}"
    );
    let index = lab.read("found/index.md");
    assert!(index.contains("Logs that cannot be read"), "{index}");
    assert!(index.contains("cloth_odd_p02_1.csv"), "{index}");
    nothing_endless(&lab);

    let first = lab.path("logs/cloth_odd_p01_1.json");
    let text = fs::read_to_string(&first).unwrap();
    fs::write(
        first,
        text.replacen("\"schema_version\": 2", "\"schema_version\": 3", 1),
    )
    .unwrap();
    let described = lab.refuse(&["experiment", "analyse", "logs", "--out", "again"]);
    assert!(described.contains("version 3"), "{described}");
    assert!(!lab.path("again").exists(), "nothing was found");
}

#[test]
fn sessions_that_were_opened_or_begun_are_analysed_for_what_is_in_them() {
    let lab = Lab::new();
    on_disk(&lab, 0, 10, |number| number % 4 > 0);
    on_disk(&lab, 1, 0, |_| true);
    on_disk(&lab, 2, 2, |_| false);
    lab.print(&ANALYSE);
    nothing_endless(&lab);
    let held = lab.read("found/odd-sessions-held.csv");
    assert!(
        held.contains("p02") && held.contains("incomplete"),
        "{held}"
    );
}

#[test]
fn one_subject_always_right_or_always_wrong_gives_reasons() {
    for is_right in [|_| true, |_| false] {
        let lab = Lab::new();
        on_disk(&lab, 0, 10, is_right);
        lab.print(&ANALYSE);
        nothing_endless(&lab);
    }
}

#[test]
fn comparisons_that_nothing_joins_are_said_to_be_apart() {
    let lab = Lab::new();
    on_disk(&lab, 0, 2, |_| true);
    lab.print(&ANALYSE);
    nothing_endless(&lab);
    let index = lab.read("found/index.md");
    assert!(index.contains("no chain of pairs joins"), "{index}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_analysis_writes_nothing_and_has_failed() {
    use std::process::{Command, Stdio};
    use std::thread::sleep;
    use std::time::Duration;

    let lab = Lab::new();
    let simulate = ["experiment", "simulate", "ranking-virtual-target"];
    let more = ["--observers", "3", "--seed", "1", "--out", "logs"];
    lab.run(&[&simulate[..], &more].concat());
    let mut command = lab.command(&[&ANALYSE[..], &["--maps", "60000"]].concat());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = child.spawn().unwrap();
    sleep(Duration::from_secs(2));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    let outcome = Outcome::of(&child.wait_with_output().unwrap());
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(
        outcome
            .one_line()
            .contains("stopped before the work was done"),
        "{outcome:?}"
    );
    assert!(!lab.path("found").exists(), "nothing half done");
}

#[test]
fn tables_are_never_written_among_the_logs() {
    let lab = Lab::new();
    on_disk(&lab, 0, 10, |number| number % 3 > 0);
    let described = lab.refuse(&["experiment", "analyse", "logs", "--out", "logs"]);
    assert!(
        described.contains("another folder, such as logs/analysis"),
        "{described}"
    );
    assert!(!lab.path("logs/index.md").exists());
}

#[test]
fn a_session_is_one_page_of_figures_by_one_command() {
    let lab = Lab::named("figure-of-session");
    let log = on_disk(&lab, 0, 10, |number| number % 3 != 1);
    let name = log.file_name().unwrap().to_string_lossy().into_owned();
    let of = format!("logs/{name}");
    lab.print(&["figure", &of, "--out", "page"]);
    lab.print(&["figure", "logs", "--out", "all"]);
    for page in ["page", "all"] {
        let svg = fs::read_to_string(lab.path(&format!("{page}.svg"))).unwrap();
        assert!(svg.contains("Odd cloth"), "{page}");
        let png = fs::read(lab.path(&format!("{page}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG"), "{page}");
        let caption = fs::read_to_string(lab.path(&format!("{page}.txt"))).unwrap();
        assert!(
            caption.starts_with("Odd cloth") && caption.contains("\n(1) "),
            "{caption}"
        );
        assert!(!caption.contains("**"), "{caption}");
    }
    let read = |name: &str| fs::read(lab.path(name)).unwrap();
    assert_eq!(read("page.svg"), read("all.svg"), "it is the only one");
    let refused = |words: &[&str], expected: &str| {
        let Outcome { code, err, .. } = lab.run(words);
        assert!(code == 2 && err.contains(expected), "{code}: {err}");
    };
    refused(
        &["figure", &of, "--path", "a.csv", "--out", "f"],
        "leave --path",
    );
    refused(&["figure", "none.csv", "--out", "f"], "none.csv");
}
