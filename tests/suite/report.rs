//! `selvedge report`, run as a user runs it.

use selvedge_foundation::files::Table;

use crate::program::{Lab, Outcome};

const COLUMNS: &str = "method,setting,case,size,error_cases,error_p99_cases,promised_cases,kept,\
                       cpu_s,cpu_low_s,cpu_high_s,wall_s,n_repeats,n_processes,bytes,pareto,\
                       came_back,should";

fn table(lab: &Lab, name: &str) -> Table {
    let columns: Vec<&str> = COLUMNS.split(',').collect();
    Table::read(&lab.read(name), &lab.path(name), &columns, &[]).unwrap()
}

fn quick(lab: &Lab, out: &str, more: &[&str]) -> Outcome {
    let args = ["report", "--out", out, "--quick", "--only", "stability"];
    let outcome = lab.run(&[&args[..], more].concat());
    assert_eq!((outcome.code, outcome.out.as_str()), (0, ""), "{outcome:?}");
    outcome
}

#[test]
fn a_quick_report_tables_what_came_back_and_says_where_it_was_made() {
    let lab = Lab::new();
    let outcome = quick(&lab, "made/here", &["--seed", "42"]);
    assert_eq!(outcome.err, "", "no promise is broken");
    let rows = table(&lab, "made/here/stability.csv");
    let first = lab.read("made/here/stability.csv");
    assert_eq!(first.lines().next().unwrap(), COLUMNS);
    assert!(rows.n_rows() > 40, "{} cases", rows.n_rows());
    let kept = rows.text("kept").unwrap();
    assert!(kept.iter().all(|kept| *kept == "true"), "{kept:?}");
    let errors = rows.required_numbers("error_cases").unwrap();
    assert!(errors.iter().all(|n| *n == 0.0), "{errors:?}");
    let (index, page) = (
        lab.read("made/here/index.md"),
        lab.read("made/here/stability.md"),
    );
    let n_cores = std::thread::available_parallelism().unwrap();
    for text in [
        &format!("| {n_cores} cores, "),
        "| seed | 42 |",
        "`selvedge report --out made/here --only stability --quick --seed 42`",
        "## Stability",
        "(stability.csv)",
        "| speed | NaN mm/s |",
        "selvedge ",
    ] {
        assert!(page.contains(text), "{text}: {page}");
    }
    assert!(!index.contains("Broken"), "{index}");
}

#[test]
fn the_same_seed_gives_the_same_numbers_but_for_times() {
    let lab = Lab::new();
    let columns = |out: &str| {
        quick(&lab, out, &[]);
        let rows = table(&lab, &format!("{out}/stability.csv"));
        let is_told = |name: &&str| !name.ends_with("_s") && *name != "pareto";
        let names = COLUMNS.split(',').filter(is_told);
        let cells = |name: &str| rows.text(name).unwrap().join("\n");
        names.map(cells).collect::<Vec<String>>()
    };
    assert_eq!(columns("a"), columns("b"));
}

#[test]
fn nonsense_is_refused_with_what_is_known() {
    let lab = Lab::new();
    let line = lab.refuse(&["report", "--out", "r", "--only", "nonsense"]);
    assert!(
        line.contains("no study is called \"nonsense\"; choose from"),
        "{line}"
    );
    assert!(line.contains("stability"), "{line}");
    assert!(!lab.path("r").exists(), "nothing is made");
    lab.refuse(&["report"]);
    lab.refuse(&["report", "--out", "r", "--seed", "many"]);
    lab.write("taken", "a file");
    let line = lab.refuse(&["report", "--out", "taken", "--only", "stability"]);
    assert!(line.contains("cannot make the folder taken"), "{line}");
}

#[test]
fn studies_are_listed_with_what_they_ask() {
    let out = Lab::new().print(&["report", "--list"]);
    let (studies, chapters): (Vec<&str>, Vec<&str>) =
        out.lines().partition(|line| line.starts_with(' '));
    let is_it = |line: &&&str| line.starts_with("  stability  ");
    assert_eq!(studies.iter().filter(is_it).count(), 1, "{out}");
    assert!(studies.iter().all(|line| line.contains('?')), "{out}");
    assert!(chapters.contains(&"evidence"), "{out}");
}
