//! The runner on studies made up for it: right, wrong, failing, panicking, endless.

use std::path::{Path, PathBuf};

use super::machine::Machine;
use super::pareto::tests::row;
use super::*;
use selvedge_chart::{Chart, Series};
use selvedge_foundation::files::Table;
use selvedge_foundation::progress::{CancelFlag, Progress};
use selvedge_scratch::ScratchFolder;

/// What a study finds in quick mode.
pub(super) fn quick(study: &Study, seed: u64) -> Findings {
    Progress::unheard(|progress| (study.run)(&mut Bench::new(Effort::Quick, seed, progress)))
        .unwrap()
}

/// Two runs found the same, no row lacks an error or a cost, and promises are made and kept.
pub(super) fn assert_complete_and_same(first: &Findings, second: &Findings) {
    assert_eq!(first.rows.len(), second.rows.len());
    assert_keeps_promises(first);
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!(
            (a.error, a.error_p99, &a.more),
            (b.error, b.error_p99, &b.more)
        );
        assert!(
            a.error.is_some_and(f64::is_finite) && a.cost.is_some(),
            "{a:?}"
        );
    }
}

/// Something is promised, and nothing that is promised is not kept.
pub(super) fn assert_keeps_promises(findings: &Findings) {
    let broken: Vec<&Row> = findings.broken().collect();
    assert!(broken.is_empty(), "{broken:#?}");
    assert!(findings.rows.iter().any(|row| row.promised.is_some()));
}

/// A study that does what it is told.
fn made_up(name: &'static str, run: fn(&mut Bench<'_>) -> Result<Findings, ReportError>) -> Study {
    Study {
        name,
        chapter: name,
        question: "Which way is best?",
        reference: "a closed form.",
        error: ("level error", "dB"),
        cost_of: "tick",
        run,
    }
}

/// A method that keeps its promise, one that is cheaper and wrong, and the reference.
fn one_is_wrong(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    bench.step(0.0, "weaving")?;
    let with = |method: &str, error, cpu_s, promised| Row {
        method: method.to_owned(),
        setting: "f32, \"fast\"".to_owned(),
        promised,
        more: vec![("nodes_per_octave", "24".to_owned())],
        ..row("silk|crêpe", error, cpu_s)
    };
    Ok(Findings {
        rows: vec![
            with("right", 0.04, 2e-7, Some(0.05)),
            with("wrong", 3.0, 1e-7, Some(0.05)),
            with("reference", 0.0, 4e-5, None),
            with("right", 0.01, 4e-7, Some(0.05)),
        ],
        plots: vec![(
            "further".to_owned(),
            Chart {
                series: vec![Series::default()],
                ..Chart::default()
            },
        )],
        notes: vec!["A note.".to_owned()],
        ..Findings::default()
    })
}

fn run_in(folder: &Path, studies: &[Study], cancel: &CancelFlag) -> (Report, Vec<f64>) {
    let options = Options {
        out: folder.to_owned(),
        effort: Effort::Quick,
        seed: 7,
        command: "selvedge report --out x --quick --seed 7".to_owned(),
        against: None,
    };
    let mut shares = Vec::new();
    let report = run(studies, &options, cancel, None, &mut |standing| {
        shares.push(standing.share);
    });
    (report.unwrap(), shares)
}

const COLUMNS: [&str; 17] = [
    "method",
    "setting",
    "case",
    "size",
    "error_db",
    "error_p99_db",
    "promised_db",
    "kept",
    "cpu_s",
    "cpu_low_s",
    "cpu_high_s",
    "wall_s",
    "n_repeats",
    "n_processes",
    "bytes",
    "pareto",
    "nodes_per_octave",
];

#[test]
fn a_wrong_method_shows_up_as_wrong() {
    let folder = ScratchFolder::made("runner");
    let studies = [made_up("made-up", one_is_wrong)];
    let (report, _) = run_in(&folder, &studies, &CancelFlag::new());
    assert_eq!(report.n_broken(), 1);
    let table = Table::read(
        &folder.read("made-up.csv"),
        Path::new("t.csv"),
        &COLUMNS,
        &[],
    )
    .unwrap();
    assert_eq!(
        table.text("method").unwrap(),
        ["right", "wrong", "reference", "right"]
    );
    assert_eq!(table.text("kept").unwrap(), ["true", "false", "", "true"]);
    assert_eq!(
        table.text("pareto").unwrap(),
        ["true", "false", "true", "true"]
    );
    assert_eq!(table.text("setting").unwrap()[0], "f32, \"fast\"");
    let index = folder.read("index.md");
    let broken = "## Broken promises: made-up\n\n\
                  - wrong, f32, \"fast\", silk\\|crêpe: 3.00 dB where \
                  0.0500 dB is promised";
    assert!(index.contains(broken), "{index}");
    let verdict = "| [made-up](made-up.md#made-up) | Which way is best? | **2 of 3** | \
                   3.00 of 0.0500 dB |";
    assert!(index.contains(verdict), "{index}");
    let (broken, verdicts) = (index.find("Broken").unwrap(), index.find("| chapter |"));
    assert!(broken < verdicts.unwrap(), "broken promises are on top");
    let page = folder.read("made-up.md");
    assert!(
        page.contains("| wrong | f32, \"fast\" | silk\\|crêpe | 3.00 |"),
        "{page}"
    );
    assert!(page.contains("| **no** |"), "{page}");
}

#[test]
fn no_file_of_a_report_holds_what_is_no_finite_number() {
    let folder = ScratchFolder::made("finite");
    let endless = |_: &mut Bench<'_>| {
        let mut other = row("b", f64::INFINITY, 2.0);
        other.size = Some(f64::NEG_INFINITY);
        let endless = row("a", f64::NAN, 1.0)
            .p99(f64::INFINITY)
            .promised(f64::INFINITY)
            .with("bound_db", f64::INFINITY)
            .with("lost_db", format!("{:e}", f64::NEG_INFINITY))
            .with("spread_db", f64::NAN);
        let rows = vec![endless, other, row("c", 0.1, 1.0)];
        Ok(Findings::new(rows, Vec::new(), Vec::<String>::new()))
    };
    let studies = [made_up("endless", endless)];
    run_in(&folder, &studies, &CancelFlag::new());
    let files = std::fs::read_dir(&folder)
        .unwrap()
        .map(|file| file.unwrap().path());
    let is_text = |path: &PathBuf| path.extension().is_some_and(|kind| kind != "png");
    let texts: Vec<PathBuf> = files.filter(is_text).collect();
    assert_eq!(texts.len(), 5, "{texts:?}");
    for path in texts {
        let text = std::fs::read_to_string(&path).unwrap();
        let mut words = text.split(|c: char| !c.is_alphanumeric() && !"+-.∞".contains(c));
        let odd = words.find(|word| {
            let is_no_number = |value: f64| !value.is_finite();
            word.contains('∞') || word.parse().is_ok_and(is_no_number)
        });
        assert_eq!(odd, None, "{}", path.display());
    }
}

#[test]
fn the_table_holds_what_the_plot_shows() {
    let folder = ScratchFolder::made("runner");
    let studies = [made_up("made-up", one_is_wrong)];
    run_in(&folder, &studies, &CancelFlag::new());
    let table = Table::read(
        &folder.read("made-up.csv"),
        Path::new("t.csv"),
        &COLUMNS,
        &[],
    )
    .unwrap();
    let findings =
        Progress::unheard(|progress| (studies[0].run)(&mut Bench::new(Effort::Quick, 7, progress)));
    let plot = chart::error_against_time(&studies[0], &findings.unwrap()).unwrap();
    let (methods, fronts) = (table.text("method").unwrap(), table.text("pareto").unwrap());
    let errors = table.required_numbers("error_db").unwrap();
    let costs_s = table.required_numbers("cpu_s").unwrap();
    let rows =
        (0..table.n_rows()).map(|i| (methods[i], [costs_s[i], errors[i]], fronts[i] == "true"));
    for series in plot
        .series
        .iter()
        .filter(|series| !series.name.starts_with("promised"))
    {
        let of_method = rows.clone().filter(|(method, ..)| *method == series.name);
        let mut of_method: Vec<_> = of_method.map(|(_, at, front)| (at, front)).collect();
        // One case: its rows in the order of what they cost.
        of_method.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let (points, marks): (Vec<_>, Vec<_>) = of_method.into_iter().unzip();
        assert_eq!(series.points, points, "{}", series.name);
        let marked: Vec<usize> = (0..marks.len()).filter(|i| marks[*i]).collect();
        assert_eq!(series.marked, marked, "{}", series.name);
    }
    assert_eq!(plot.series.len(), 4, "three methods and a promise");
    assert_eq!(folder.read("made-up.svg"), plot.to_svg());
    for name in ["made-up.png", "made-up-further.svg", "made-up-further.png"] {
        assert!(folder.join(name).is_file(), "{name}");
    }
}

#[test]
fn a_page_says_what_was_asked_where_how_and_how_to_repeat_it() {
    let folder = ScratchFolder::made("runner");
    run_in(
        &folder,
        &[made_up("made-up", one_is_wrong)],
        &CancelFlag::new(),
    );
    let (page, machine) = (folder.read("made-up.md"), Machine::here());
    for text in [
        &format!("{} cores", machine.n_cores),
        &machine.program,
        "| seed | 7 |",
        "quick",
        "`selvedge report --out x --quick --seed 7`",
        "- [Made up](#made-up): Which way is best?\n- [Where and how](#where-and-how)\n",
        "## Made up\n\nWhich way is best?",
        "Reference: a closed form.",
        "(made-up.csv)",
        "(made-up.png)",
        "(made-up-further.svg)",
        "- A note.",
        "CPU a tick",
        "200 ns",
        " UTC |",
    ] {
        assert!(page.contains(text), "{text}: {page}");
    }
}

#[test]
fn a_study_that_fails_or_panics_harms_no_other() {
    let folder = ScratchFolder::made("runner");
    let fails = |_: &mut Bench<'_>| {
        Err(ReportError::Unknown {
            name: "x".to_owned(),
            known: "y".to_owned(),
        })
    };
    let studies = [
        made_up("fails", fails),
        made_up("panics", |_| panic!("out of cloth")),
        made_up("made-up", one_is_wrong),
    ];
    let (report, shares) = run_in(&folder, &studies, &CancelFlag::new());
    let failures: Vec<(&str, &str)> = report.failures().collect();
    assert_eq!(failures.len(), 2);
    assert_eq!(failures[1], ("panics", "it panicked: out of cloth"));
    assert!(!report.is_cancelled && folder.join("made-up.csv").is_file());
    let index = folder.read("index.md");
    for text in ["**fails failed**: no study", "**panics failed**"] {
        assert!(index.contains(text), "{text}: {index}");
    }
    assert!(
        shares.is_sorted() && shares.iter().all(|share| (0.0..=1.0).contains(share)),
        "{shares:?}"
    );
}

#[test]
fn a_cancelled_report_keeps_what_is_finished() {
    let folder = ScratchFolder::made("runner");
    let cancel = CancelFlag::new();
    let cancels = |bench: &mut Bench<'_>| {
        bench.step(0.5, "halfway")?;
        Ok(Findings::default())
    };
    let studies = [
        made_up("never", cancels),
        made_up("cancels", cancels),
        made_up("made-up", one_is_wrong),
    ];
    let options = Options {
        out: folder.to_owned(),
        effort: Effort::Full,
        seed: 1,
        command: String::new(),
        against: None,
    };
    let report = run(&studies, &options, &cancel, None, &mut |standing| {
        if standing.doing == "halfway" {
            cancel.cancel();
        }
    })
    .unwrap();
    assert!(report.is_cancelled && matches!(report.outcomes[1].1, Outcome::Stopped));
    assert!(folder.join("made-up.csv").is_file() && !folder.join("cancels.csv").exists());
    let index = folder.read("index.md");
    assert!(index.contains("**Stopped before it was done.**"), "{index}");
    assert!(index.contains("Not finished: never, cancels."), "{index}");
}

#[test]
fn studies_are_chosen_by_name_and_nonsense_is_refused() {
    let all = || vec![made_up("a", one_is_wrong), made_up("b", one_is_wrong)];
    let names = |only: &[&str]| {
        let only: Vec<String> = only.iter().map(|name| (*name).to_owned()).collect();
        choose(all(), &only).map(|studies| studies.iter().map(|s| s.name).collect::<Vec<_>>())
    };
    assert_eq!(names(&[]).unwrap(), ["a", "b"]);
    assert_eq!(names(&["b"]).unwrap(), ["b"]);
    let error = names(&["b", "c"]).unwrap_err().to_string();
    assert_eq!(error, "no study is called \"c\"; choose from a, b");
}

#[test]
fn a_chapter_stands_for_its_studies_which_follow_each_other() {
    let chosen = choose(studies(), &["waveforms".to_owned()]).unwrap();
    let names: Vec<&str> = chosen.iter().map(|study| study.name).collect();
    assert_eq!(names, ["drive-updates", "coding", "bimorph"]);
    let all = studies();
    let mut chapters: Vec<&str> = all.iter().map(|study| study.chapter).collect();
    chapters.dedup();
    let mut distinct = chapters.clone();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), chapters.len(), "{chapters:?}");
    assert!((12..=16).contains(&chapters.len()), "{chapters:?}");
    let is_clear = |study: &Study| {
        let own = |other: &&Study| other.chapter == study.chapter;
        !chapters.contains(&study.name) || all.iter().filter(own).count() == 1
    };
    assert!(all.iter().all(is_clear), "a name means one thing");
}

#[test]
fn names_of_studies_are_distinct_and_fit_files() {
    let names: Vec<&str> = studies().iter().map(|study| study.name).collect();
    for (nth, name) in names.iter().enumerate() {
        assert!(!names[..nth].contains(name), "{name} twice");
        assert!(
            name.bytes().all(|b| b.is_ascii_lowercase() || b == b'-'),
            "{name}"
        );
    }
}

#[test]
fn further_processes_are_asked_for_times_and_an_old_report_is_compared_with() {
    let folder = ScratchFolder::made("runner");
    let studies = [
        made_up("made-up", one_is_wrong),
        made_up("untimed", |_| Ok(Findings::default())),
    ];
    let mut options = Options {
        out: folder.to_owned(),
        effort: Effort::Quick,
        seed: 7,
        command: String::new(),
        against: None,
    };
    let cancel = CancelFlag::new();
    let mut asked = Vec::new();
    let mut again = |names: &[&str]| {
        asked.push(names.join(" "));
        times_alone(&studies[..1], (Effort::Quick, 7), &cancel)
    };
    run(&studies, &options, &cancel, Some(&mut again), &mut |_| {}).unwrap();
    assert_eq!(asked, ["made-up"; 3], "what has no times is not asked for");
    let path = folder.join("made-up.csv");
    let read = |folder: &ScratchFolder| {
        Table::read(&folder.read("made-up.csv"), &path, &COLUMNS, &[]).unwrap()
    };
    assert_eq!(read(&folder).text("n_processes").unwrap(), ["4"; 4]);
    assert_eq!(read(&folder).text("n_repeats").unwrap(), ["12"; 4]);

    options.against = Some(folder.join("report.json"));
    let mut fails = |_: &[&str]| Err(ReportError::Study("no memory".to_owned()));
    let report = run(&studies, &options, &cancel, Some(&mut fails), &mut |_| {}).unwrap();
    let since = report.since.unwrap();
    assert_eq!((since.n_compared, since.n_alone), (4, 0));
    assert!(since.slower.is_empty() && since.less_exact.is_empty());
    assert_eq!(read(&folder).text("n_processes").unwrap(), ["1"; 4]);
    let index = folder.read("index.md");
    assert!(index.contains("process 2 of 4: no memory"), "{index}");
    options.against = Some(folder.join("nowhere.json"));
    let refused = run(&studies, &options, &cancel, None, &mut |_| {});
    assert!(refused.unwrap_err().to_string().contains("nowhere.json"));
}

#[test]
fn a_line_joins_the_settings_of_a_method_on_one_case_alone() {
    let study = made_up("made-up", one_is_wrong);
    let findings = Findings {
        rows: vec![row("a", 0.1, 2.0), row("b", 0.3, 1.0), row("a", 0.2, 1.0)],
        ..Findings::default()
    };
    let plot = chart::error_against_time(&study, &findings).unwrap();
    let [series] = &plot.series[..] else {
        panic!("{:?}", plot.series);
    };
    assert_eq!(series.points[..2], [[1.0, 0.2], [2.0, 0.1]]);
    assert!(series.points[2][0].is_nan());
    assert_eq!((series.points[3], series.points.len()), ([1.0, 0.3], 4));
    assert_eq!(series.marked, [0, 1, 3]);
    let svg = plot.to_svg();
    assert!(!svg.contains("left out"), "a break is no point");
}
