//! What is written: the same bytes, reasons instead of what is no number.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::*;
use crate::session::tests::any_answer;
use selvedge_foundation::numerics::Random;
use selvedge_scratch::ScratchFolder as Scratch;

fn files_of(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap();
    let of = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().unwrap();
        (name, fs::read(entry.path()).unwrap())
    };
    entries.map(|entry| of(entry.unwrap())).collect()
}

fn is_picture(file: &str) -> bool {
    Path::new(file)
        .extension()
        .is_some_and(|ending| ending == "png")
}

fn check_files(found: &[Found], name: &str) {
    let folder = Scratch::new(name);
    let analysis = analysed(found);
    for section in &analysis.sections {
        let tables = section.tables.iter().map(|table| table.key.as_str());
        let figures = section.figures.iter().map(|figure| figure.key.as_str());
        let mut keys: Vec<&str> = tables.chain(figures).collect();
        keys.sort_unstable();
        let n_keys = keys.len();
        keys.dedup();
        assert_eq!(
            keys.len(),
            n_keys,
            "one file for two: {} {keys:?}",
            section.key
        );
    }
    analysis.write(&folder.0).unwrap();
    let files = files_of(&folder.0);
    assert!(files.contains_key("index.md"), "{name}");
    for (file, bytes) in files.iter().filter(|(file, _)| !is_picture(file)) {
        let text = String::from_utf8_lossy(bytes);
        for never in ["NaN", "nan,", ",inf", "∞"] {
            assert!(!text.contains(never), "{name}: {never} in {file}");
        }
    }
}

#[test]
fn a_folder_without_sessions_is_refused_in_one_line() {
    let folder = Scratch::new("empty");
    fs::create_dir_all(&folder.0).unwrap();
    let error =
        Progress::unheard(|progress| Analysis::of_folder(&folder.0, &few(), progress)).unwrap_err();
    let described = error.to_string();
    assert!(
        described.contains("holds no session") && !described.contains('\n'),
        "{described}"
    );
}

#[test]
fn the_same_logs_give_the_same_bytes() {
    let design = Design::shipped("odd-one-out").unwrap();
    let answered = |seed: u64| {
        let mut random = Random::new(seed);
        move |task: &Task, _: usize| odd(task, random.index(3) > 0, Grade::ALL[random.index(3)])
    };
    let all = (0..3).map(|nth| held(&design, (nth, 1), answered(nth as u64)));
    let found: Vec<Found> = all.collect();
    let folders = ["first", "second"].map(Scratch::new);
    for folder in &folders {
        analysed(&found).write(&folder.0).unwrap();
    }
    let [first, second] = folders.each_ref().map(|folder| files_of(&folder.0));
    assert!(first.len() > 30, "{:?}", first.keys());
    assert!(first == second, "other bytes");
}

#[test]
fn one_subject_answering_by_chance_gives_reasons_and_never_nan() {
    for name in Design::shipped_names() {
        let mut design = Design::shipped(name).unwrap();
        // Building the large library is not what is asked here.
        design.library = None;
        let mut random = Random::new(5);
        let own = design.clone();
        let one = held(&design, (0, 1), |task, _| {
            any_answer(&own, task, &mut random)
        });
        check_files(&[one], name);
    }
}

#[test]
fn subjects_who_always_answer_the_same_give_reasons_and_never_nan() {
    for name in [
        "ranking-virtual-target",
        "odd-one-out",
        "real-or-generated",
        "rating",
        "magnitude",
    ] {
        let mut design = Design::shipped(name).unwrap();
        design.library = None;
        let same = |task: &Task, _: usize| match name {
            "ranking-virtual-target" => Answer::in_order(&[0, 1, 2, 3]),
            "odd-one-out" => Answer::chosen(0, Some(3)),
            "magnitude" => AnswerValue::Number(1.0).into(),
            "rating" => AnswerValue::Ratings(vec![50.0; 4]).into(),
            _ => judged(task, true, 1),
        };
        let found: Vec<Found> = (0..2).map(|nth| held(&design, (nth, 1), same)).collect();
        check_files(&found, &format!("same-{name}"));
    }
}
