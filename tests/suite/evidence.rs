//! Whether logs are as they were written, the plan that they were held by, and the same trials as a
//! data set that others read.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::program::{Lab, Outcome};

const DESIGNS: [&str; 4] = ["odd-one-out", "magnitude", "rating", "gain-matching"];

fn simulated(lab: &Lab, design: &str) {
    let simulate = [
        "experiment",
        "simulate",
        design,
        "--observers",
        "3",
        "--out",
        "logs",
    ];
    let outcome = lab.run(&simulate);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
}

fn verified(lab: &Lab) -> Outcome {
    lab.run(&["experiment", "verify", "logs"])
}

/// The logs, analysed without maps and random data, which take long.
fn analysed(lab: &Lab, choices: &[&str]) -> Outcome {
    let analyse = "experiment analyse logs --out found --maps 0 --random-data 0";
    let words: Vec<&str> = analyse.split(' ').collect();
    lab.run(&[&words[..], choices].concat())
}

/// The page that they give.
fn page(lab: &Lab) -> String {
    let outcome = analysed(lab, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    lab.read("found/index.md")
}

/// The log of the second observer.
fn second_log(lab: &Lab) -> std::path::PathBuf {
    let entries = fs::read_dir(lab.path("logs")).unwrap();
    let mut logs: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    logs.retain(|path| path.extension().is_some_and(|ending| ending == "csv"));
    logs.sort();
    logs[1].clone()
}

#[test]
fn logs_are_whole_until_a_row_is_cut_out_and_then_left_out_with_its_reason() {
    let lab = Lab::named("verify");
    simulated(&lab, "odd-one-out");
    let whole = verified(&lab);
    assert_eq!((whole.code, whole.out.as_str()), (0, "3 logs, 0 broken\n"));
    let log = second_log(&lab);
    let text = fs::read_to_string(&log).unwrap();
    let mut kept: Vec<&str> = text.lines().collect();
    kept.remove(5);
    fs::write(&log, kept.join("\n") + "\n").unwrap();
    let broken = verified(&lab);
    assert_eq!(broken.code, 1);
    assert!(
        broken.out.contains(":6: this row is not bound"),
        "{}",
        broken.out
    );
    assert!(broken.out.ends_with("3 logs, 1 broken\n"), "{}", broken.out);
    assert_eq!(broken.err.lines().count(), 1, "{}", broken.err);
    let page = page(&lab);
    assert!(
        page.contains("| o02 | 1 |") && page.contains("not as it was written"),
        "{page}"
    );
    fs::remove_file(log.with_extension("json")).unwrap();
    let lost = verified(&lab);
    assert_eq!(lost.code, 1);
    assert!(lost.out.contains("is missing; restore it"), "{}", lost.out);
    let nowhere = lab.run(&["experiment", "verify", "nowhere"]);
    assert_eq!((nowhere.code, nowhere.out.as_str()), (2, ""));
}

#[test]
fn a_plan_is_frozen_once_and_stands_beside_what_was_done() {
    let lab = Lab::named("plan");
    let plan = [
        "experiment",
        "plan",
        "odd-one-out",
        "--subjects",
        "3",
        "--alpha",
        "0.01",
    ];
    let written = lab.run(&plan);
    assert_eq!(written.code, 0, "{}", written.err);
    let name = written.out.split(':').next().unwrap().to_owned();
    let again = lab.run(&plan);
    assert_eq!(again.code, 2, "a plan is not overwritten");
    let wrong = lab.run(&["experiment", "plan", "rating", "--alpha", "7"]);
    assert!(
        wrong.err.contains("alpha is 7; give a number"),
        "{}",
        wrong.err
    );
    fs::create_dir_all(lab.path("logs")).unwrap();
    fs::rename(lab.path(&name), lab.path("logs").join(&name)).unwrap();
    simulated(&lab, "odd-one-out");
    let page = page(&lab);
    for line in ["| subjects | 3 | 3 |", "0 of 3 sessions", "α = 0.01"] {
        assert!(page.contains(line), "{line}: {page}");
    }
}

#[test]
fn a_data_set_for_others_makes_its_main_table_once_more() {
    for design in DESIGNS {
        let lab = Lab::named("bids");
        simulated(&lab, design);
        let choices = ["--permutations", "99", "--bids", "set"];
        let outcome = analysed(&lab, &choices);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        let set = lab.path("set");
        for file in [
            "dataset_description.json",
            "participants.tsv",
            "participants.json",
            "README",
        ] {
            assert!(set.join(file).is_file(), "{file}");
        }
        let beh = set.join("sub-o01/ses-1/beh");
        let names: Vec<String> = fs::read_dir(&beh)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        assert_eq!(names.len(), 2, "{names:?}");
        let table = fs::read_to_string(set.join("code/main-table.tsv")).unwrap();
        assert!(table.lines().count() > 3, "{table}");
        let taken = analysed(&lab, &choices);
        assert!(taken.err.contains("name a new folder"), "{}", taken.err);
        check_scripts(&set, &table, design);
    }
}

/// The scripts in Python and R make the same table, and notice another; the one whose program is
/// not installed is not tried.
#[expect(clippy::print_stderr, reason = "says what was skipped")]
fn check_scripts(set: &Path, table: &str, design: &str) {
    let (first, last) = table.trim_end().rsplit_once('\n').unwrap();
    let mut cells: Vec<&str> = last.split('\t').collect();
    cells[5] = "12345";
    let edited = format!("{first}\n{}\n", cells.join("\t"));
    let printed = set.join("code/main-table.tsv");
    let mut made: Vec<Vec<u8>> = Vec::new();
    for (program, script) in [("python3", "main_table.py"), ("Rscript", "main_table.R")] {
        let run = || {
            Command::new(program)
                .arg(set.join("code").join(script))
                .output()
        };
        fs::write(&printed, table).unwrap();
        let Ok(again) = run() else {
            eprintln!("no {program}: its script is not tried");
            continue;
        };
        let said = String::from_utf8_lossy(&again.stderr);
        let is_same = again.status.success() && said.contains("apart by");
        assert!(is_same, "{design}, {program}: {said}");
        made.push(again.stdout);
        fs::write(&printed, &edited).unwrap();
        let differs = run().unwrap();
        let why = String::from_utf8_lossy(&differs.stderr);
        let is_noticed = !differs.status.success();
        assert!(is_noticed, "{design}: {program} notices another: {why}");
    }
    let are_alike = made.windows(2).all(|pair| pair[0] == pair[1]);
    assert!(are_alike, "{design}: both print the same table");
}

#[test]
fn logs_of_the_first_version_are_whole_and_of_unknown_validity() {
    let lab = Lab::named("old");
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/old_logs");
    for entry in fs::read_dir(fixtures).unwrap() {
        let file = entry.unwrap().path();
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        lab.write(&format!("logs/{name}"), fs::read(&file).unwrap());
    }
    let whole = verified(&lab);
    assert_eq!((whole.code, whole.out.as_str()), (0, "4 logs, 0 broken\n"));
    let page = page(&lab);
    assert_eq!(page.matches("**unknown validity**").count(), 4, "{page}");
}
