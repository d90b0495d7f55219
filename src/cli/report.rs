//! `selvedge report`: error against run time, stability, and what is left out, as tables and plots.

use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use clap::Args;

use super::output::{Cell, JsonArgs, OutFile};
use super::terminal::{Meter, notice};
use super::{CliError, output, signals, usage};

use selvedge_foundation::progress::CancelFlag;
use selvedge_foundation::quantity;
use selvedge_studies::{Again, Effort, Options, Report, ReportError, Standing, Study};

/// Between two looks at whether a further process has ended.
const LOOK_AFTER: Duration = Duration::from_millis(20);

/// What to report on, and where.
#[derive(Debug, Args)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is an option of its own"
)]
pub(super) struct ReportArgs {
    /// Folder for tables, plots and index.md; it is made where it is missing
    #[arg(long, value_name = "DIR", required_unless_present_any = ["list", "times_alone"])]
    out: Option<OutFile>,
    /// Run these studies only
    #[arg(long, value_name = "NAME", num_args = 1..)]
    only: Vec<String>,
    /// Fewer cases and repeats: everything within a minute
    #[arg(long)]
    quick: bool,
    /// What random numbers begin with
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Name the studies and what they ask
    #[arg(long)]
    list: bool,
    /// Name them as JSON, for other programs
    #[arg(long, requires = "list")]
    json: bool,
    /// Say what became slower or less exact since this report.json
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Time everything in this process alone: quicker, with intervals that say less
    #[arg(long)]
    one_process: bool,
    /// Print times alone: what a further process does
    #[arg(long, hide = true)]
    times_alone: bool,
}

/// Lists the studies, or runs them and writes what they found.
pub(super) fn run(args: &ReportArgs) -> Result<(), CliError> {
    let mut studies = selvedge_studies::studies();
    studies.extend(selvedge_workbench::studies());
    let studies = selvedge_studies::choose(studies, &args.only).map_err(meant)?;
    if args.times_alone {
        let cancel = CancelFlag::shared(signals::stop_flag()?);
        let times = selvedge_studies::times_alone(&studies, (effort(args), args.seed), &cancel)?;
        return output::print(&times);
    }
    match &args.out {
        Some(out) if !args.list => make(args, &studies, out),
        _ => list(&studies, args.json),
    }
}

/// With the name that was perhaps meant by one that is not known.
fn meant(error: ReportError) -> CliError {
    if let ReportError::Unknown { name, known } = &error
        && let Some(like) = usage::like(name, known.split(", "))
    {
        return CliError::Input(format!("no study is called {name:?}; did you mean {like}?"));
    }
    error.into()
}

fn list(studies: &[Study], is_json: bool) -> Result<(), CliError> {
    let width = studies.iter().map(|study| study.name.len()).max();
    let width = width.unwrap_or_default();
    let row = |study: &Study| [study.chapter, study.name, study.question].map(Cell::text);
    let rows: Vec<_> = studies.iter().map(row).collect();
    let how = JsonArgs { json: is_json };
    let columns = ["chapter", "study", "asks"];
    output::print_rows(&how, columns, &rows, || {
        let mut last = "";
        let line = |study: &Study| {
            let Study {
                chapter,
                name,
                question,
                ..
            } = *study;
            let is_new = std::mem::replace(&mut last, chapter) != chapter;
            let heading = if is_new {
                format!("{chapter}\n")
            } else {
                String::new()
            };
            format!("{heading}  {name:width$}  {question}\n")
        };
        studies.iter().map(line).collect()
    })
}

fn make(args: &ReportArgs, studies: &[Study], out: &Path) -> Result<(), CliError> {
    output::make_folder(out, "choose another --out")?;
    let options = Options {
        out: out.to_owned(),
        effort: effort(args),
        seed: args.seed,
        command: command(args, out),
        against: args.against.clone(),
    };
    let cancel = CancelFlag::shared(signals::stop_flag()?);
    let mut meter = Meter::new("reporting");
    let mut show = |standing: &Standing<'_>| meter.show(standing.share, &words(standing));
    let mut again = |names: &[&str]| further_process(args, names, &cancel);
    let again: Option<&mut Again<'_>> = if args.one_process {
        None
    } else {
        Some(&mut again)
    };
    let made = selvedge_studies::run(studies, &options, &cancel, again, &mut show)?;
    drop(meter);
    conclude(&made)
}

fn effort(args: &ReportArgs) -> Effort {
    if args.quick {
        Effort::Quick
    } else {
        Effort::Full
    }
}

/// Has another process of this program measure studies once more; what it printed.
fn further_process(
    args: &ReportArgs,
    names: &[&str],
    cancel: &CancelFlag,
) -> Result<String, ReportError> {
    let failed = |why: String| ReportError::Study(why);
    let program = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let mut command = Command::new(program);
    command.args(["report", "--times-alone", "--seed"]);
    command.arg(args.seed.to_string()).arg("--only").args(names);
    if args.quick {
        command.arg("--quick");
    }
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null());
    let mut child = command.spawn().map_err(|error| failed(error.to_string()))?;
    let Some(mut printed) = child.stdout.take() else {
        return Err(failed("it printed nothing".to_owned()));
    };
    let read = move || {
        let mut text = String::new();
        printed.read_to_string(&mut text).map(|_| text)
    };
    let builder = std::thread::Builder::new().name("selvedge-times".to_owned());
    let reading = builder
        .spawn(read)
        .map_err(|error| failed(error.to_string()))?;
    let status = loop {
        match child
            .try_wait()
            .map_err(|error| failed(error.to_string()))?
        {
            Some(status) => break status,
            None if cancel.is_cancelled() => {
                drop(child.kill());
                drop(child.wait());
                return Err(ReportError::Cancelled);
            }
            None => std::thread::sleep(LOOK_AFTER),
        }
    };
    let text = reading.join().ok().and_then(Result::ok);
    match text.filter(|_| status.success()) {
        Some(text) => Ok(text),
        None => Err(failed(format!("it ended with {status}"))),
    }
}

/// What runs, and about how long the rest takes.
fn words(standing: &Standing<'_>) -> String {
    let left = standing.left.map_or_else(String::new, |left| {
        format!(
            ", about {} left",
            quantity::with_unit(left.as_secs_f64().ceil(), 0, "s")
        )
    });
    let doing = standing.doing;
    let gap = if doing.is_empty() { "" } else { ": " };
    format!("{}{gap}{doing}{left}", standing.study)
}

/// One line about broken promises, and the exit code of what did not work.
fn conclude(made: &Report) -> Result<(), CliError> {
    let n_broken = made.n_broken();
    if n_broken > 0 {
        let what = if n_broken == 1 {
            "promise is"
        } else {
            "promises are"
        };
        notice(&format!(
            "{n_broken} {what} broken; index.md begins with what and how"
        ));
    }
    if made.is_cancelled {
        return Err(ReportError::Cancelled.into());
    }
    let failures: Vec<String> = made
        .failures()
        .map(|(name, why)| format!("study {name} failed: {why}"))
        .collect();
    if failures.is_empty() {
        Ok(())
    } else {
        Err(CliError::Failed(format!(
            "{}; the others are done",
            failures.join("; ")
        )))
    }
}

/// The command that makes the report again.
fn command(args: &ReportArgs, out: &Path) -> String {
    let mut words = vec![
        "selvedge report --out".to_owned(),
        quoted(&out.display().to_string()),
    ];
    if !args.only.is_empty() {
        words.push("--only".to_owned());
        words.extend(args.only.iter().cloned());
    }
    if args.quick {
        words.push("--quick".to_owned());
    }
    if args.one_process {
        words.push("--one-process".to_owned());
    }
    words.push(format!("--seed {}", args.seed));
    words.join(" ")
}

/// A path as a shell takes it.
fn quoted(path: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+".contains(c);
    if path.chars().all(is_plain) {
        path.to_owned()
    } else {
        format!("'{}'", path.replace('\'', "'\\''"))
    }
}
