//! `index.md`: every verdict, on which machine, and how to repeat it; `CHAPTER.md`: what was asked
//! and found.

use std::time::Duration;

use super::listing::{cell, table};
use super::machine::Machine;
use super::readable::{number, time};
use super::runner::{Options, Outcome, Report};
use super::{Effort, Findings, ReportError, Row, Study, chart, growth, write};

/// Where and how a report was made.
#[derive(Debug, Clone, Copy)]
struct About<'a> {
    /// The machine and the program.
    machine: &'a Machine,
    /// What was asked for.
    options: &'a Options,
    /// When.
    date: &'a str,
}

/// A study that is done, what it found, and how long that took.
type Told<'a> = (&'a Study, &'a Findings, &'a Duration);

/// Writes the index of a report that was made here, as was asked for, then, and its chapters.
pub(super) fn write(
    studies: &[Study],
    report: &Report,
    (machine, options, date): (&Machine, &Options, &str),
) -> Result<(), ReportError> {
    let about = &About {
        machine,
        options,
        date,
    };
    let outcomes = studies.iter().zip(&report.outcomes);
    let done: Vec<Told<'_>> = outcomes
        .filter_map(|(study, (_, outcome))| match outcome {
            Outcome::Done { findings, took } => Some((study, findings, took)),
            _ => None,
        })
        .collect();
    for chapter in done.chunk_by(|a, b| a.0.chapter == b.0.chapter) {
        let name = format!("{}.md", chapter[0].0.chapter);
        write::text(&name, &options.out, &chapter_text(chapter, about))?;
    }
    write::text("index.md", &options.out, &text(&done, report, about))
}

/// The first page.
fn text(done: &[Told<'_>], report: &Report, about: &About<'_>) -> String {
    let mut out = vec!["# Error against run time, stability, and what is left out\n".to_owned()];
    if report.is_cancelled {
        out.push("**Stopped before it was done.** What was finished is below.\n".to_owned());
    }
    for (study, findings, _) in done {
        broken(study, findings, &mut out);
    }
    for (name, why) in report.failures() {
        out.push(format!("**{name} failed**: {}\n", cell(why)));
    }
    if let Some(why) = &report.trouble {
        let words = "**Times are of fewer processes than they should be**, so that their intervals \
                     say less";
        out.push(format!("{words}: {}\n", cell(why)));
    }
    verdicts(done, &mut out);
    if let Some(since) = &report.since {
        out.push(since.text());
    }
    about_text(about, &mut out);
    not_run(report, &mut out);
    out.join("\n")
}

/// A chapter: a page by itself.
fn chapter_text(done: &[Told<'_>], about: &About<'_>) -> String {
    let mut out = vec![format!("# {}\n", chart::titled(done[0].0.chapter))];
    let line = |(study, ..): &Told<'_>| {
        let (title, question) = (chart::titled(study.name), cell(study.question));
        format!("- [{title}](#{}): {question}", anchor(study))
    };
    out.extend(done.iter().map(line));
    out.push("- [Where and how](#where-and-how)\n".to_owned());
    for (study, findings, took) in done {
        study_text(study, findings, &time(took.as_secs_f64()), &mut out);
    }
    out.push("## Where and how\n".to_owned());
    about_text(about, &mut out);
    out.join("\n")
}

/// Where a study begins on its page.
fn anchor(study: &Study) -> String {
    chart::titled(study.name).to_lowercase().replace(' ', "-")
}

/// Every study in a line: what it asks, how many promises it keeps, what keeps its promise at least
/// cost.
fn verdicts(done: &[Told<'_>], out: &mut Vec<String>) {
    out.push(
        "| chapter | study | it asks | promises kept | worst error where one is promised | took |"
            .to_owned(),
    );
    out.push("|---|---|---|---|---|---|".to_owned());
    for (study, findings, took) in done {
        let judged = findings.rows.iter().filter_map(Row::is_kept);
        let (n_kept, n) = judged.fold((0, 0), |(n_kept, n), is_kept| {
            (n_kept + usize::from(is_kept), n + 1)
        });
        let kept = match (n_kept, n) {
            (_, 0) => "none is made".to_owned(),
            (n_kept, n) if n_kept == n => format!("all {n}"),
            (n_kept, n) => format!("**{n_kept} of {n}**"),
        };
        let near = |row: &Row| Some((row.error? / row.promised?, row.error?, row.promised?));
        let worst = findings.rows.iter().filter_map(near);
        let worst = worst.filter(|(share, error, _)| share.is_finite() && error.is_finite());
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0));
        let worst = worst.map_or_else(String::new, |(_, error, promised)| {
            let unit = study.error.1;
            format!("{} of {} {unit}", number(error), number(promised))
        });
        let anchor = anchor(study);
        out.push(format!(
            "| {0} | [{1}]({0}.md#{anchor}) | {2} | {kept} | {3} | {4} |",
            study.chapter,
            study.name,
            cell(study.question),
            worst.trim_end(),
            time(took.as_secs_f64())
        ));
    }
    out.push(String::new());
}

/// What promised too much, on top where nobody overlooks it.
fn broken(study: &Study, findings: &Findings, out: &mut Vec<String>) {
    let rows: Vec<&Row> = findings.broken().collect();
    if rows.is_empty() {
        return;
    }
    out.push(format!("## Broken promises: {}\n", study.name));
    for row in rows {
        let parts = [&row.method, &row.setting, &row.case].map(|part| cell(part));
        let named: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        let unit = study.error.1;
        let [error, promised] = [row.error, row.promised]
            .map(|value| value.filter(|value| value.is_finite()).map(number));
        let error = error.unwrap_or_else(|| "nothing".to_owned());
        let promised = promised.unwrap_or_default();
        let came = match row.further("came_back") {
            "" => format!("{error} {unit} where {promised} {unit} is promised"),
            came => format!(
                "{} where this should be: {}",
                cell(came),
                cell(row.further("should"))
            ),
        };
        out.push(format!("- {}: {came}", named.join(", ")));
    }
    out.push(String::new());
}

fn about_text(about: &About<'_>, out: &mut Vec<String>) {
    let (machine, options) = (about.machine, about.options);
    let effort = match options.effort {
        Effort::Quick => "quick: fewer cases and repeats",
        Effort::Full => "full",
    };
    let effort = format!("{effort}; two studies at a time where two cores are");
    let build = if machine.is_debug {
        "without optimisation: **times say little**"
    } else {
        "release"
    };
    let cores = format!("{} cores, {}", machine.n_cores, cell(&machine.cpu));
    let program = format!("{}, {}, {build}", machine.program, machine.compiler);
    let commit = machine.commit.as_deref().map_or("unknown", |commit| commit);
    let commit = cell(commit);
    let load = machine
        .loads
        .each_ref()
        .map(|load| load.as_deref().unwrap_or("unknown"));
    let load = format!("{} before, {} at the end", load[0], load[1]);
    let command = format!("`{}`", options.command.replace('`', "'"));
    out.push("| | |\n|---|---|".to_owned());
    for (what, value) in [
        ("machine", cores),
        ("system", cell(&machine.system)),
        ("instructions", cell(&machine.instructions)),
        ("load", load),
        ("program", program),
        ("commit", commit),
        ("seed", options.seed.to_string()),
        ("effort", effort),
        ("date", about.date.to_owned()),
        ("to repeat it", command),
    ] {
        out.push(format!("| {what} | {value} |"));
    }
    out.push(
        "\nErrors depend on the seed alone; times are this machine's: CPU time of the thread, the \
         median of several processes' medians over repeats after a warm-up, with the smallest and \
         the largest of them as the interval; of one process, the quartiles of its repeats. ● is \
         on the Pareto front: on its case nothing else is both surely cheaper and as exact; surely \
         is in every process. ○ is open: something more exact may be as cheap.\n"
            .to_owned(),
    );
}

fn study_text(study: &Study, findings: &Findings, took: &str, out: &mut Vec<String>) {
    let name = study.name;
    out.push(format!("## {}\n", chart::titled(name)));
    out.push(format!("{}\n", study.question));
    out.push(format!(
        "Reference: {} Took {took}. Numbers: [{name}.csv]({name}.csv).\n",
        study.reference
    ));
    for (file, plot) in write::plots(study, findings) {
        let title = cell(&plot.title).replace(['[', ']'], "");
        out.push(format!("![{title}]({file}.png)\n\n[as SVG]({file}.svg)\n"));
    }
    let grown = growth::sentences(findings);
    let notes = || findings.notes.iter().chain(&grown);
    for note in notes() {
        out.push(format!("- {note}"));
    }
    if notes().next().is_some() {
        out.push(String::new());
    }
    table(study, findings, out);
}

/// What did not run because the report was stopped.
fn not_run(report: &Report, out: &mut Vec<String>) {
    let is_stopped = |(_, outcome): &&(&str, Outcome)| matches!(outcome, Outcome::Stopped);
    let stopped = report.outcomes.iter().filter(is_stopped);
    let stopped: Vec<&str> = stopped.map(|(name, _)| *name).collect();
    if report.is_cancelled && !stopped.is_empty() {
        out.push(format!("Not finished: {}.\n", stopped.join(", ")));
    }
}
