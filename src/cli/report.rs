//! `selvedge report`: error against run time, stability, and what is left out, as tables and plots.

use std::path::{Path, PathBuf};

use clap::Args;

use super::terminal::{Meter, notice};
use super::{CliError, output, signals};

use selvedge_foundation::progress::CancelFlag;
use selvedge_foundation::quantity;
use selvedge_studies::{Effort, Options, Report, Standing, Study};

/// What to report on, and where.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Folder for tables, plots and index.md; it is made where it is missing
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,
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
}

/// Lists the studies, or runs them and writes what they found.
pub(super) fn run(args: &ReportArgs) -> Result<(), CliError> {
    let mut studies = selvedge_studies::studies();
    studies.extend(selvedge_workbench::studies());
    let studies = selvedge_studies::choose(studies, &args.only)?;
    match &args.out {
        Some(out) if !args.list => make(args, &studies, out),
        _ => list(&studies),
    }
}

fn list(studies: &[Study]) -> Result<(), CliError> {
    let width = studies.iter().map(|study| study.name.len()).max();
    let width = width.unwrap_or_default();
    let line = |study: &Study| format!("{:width$}  {}\n", study.name, study.question);
    output::print(&studies.iter().map(line).collect::<String>())
}

fn make(args: &ReportArgs, studies: &[Study], out: &Path) -> Result<(), CliError> {
    output::make_folder(out, "choose another --out")?;
    let options = Options {
        out: out.to_owned(),
        effort: if args.quick {
            Effort::Quick
        } else {
            Effort::Full
        },
        seed: args.seed,
        command: command(args, out),
    };
    let cancel = CancelFlag::shared(signals::stop_flag()?);
    let mut meter = Meter::new("reporting");
    let mut show = |standing: &Standing<'_>| meter.show(standing.share, &words(standing));
    let made = selvedge_studies::run(studies, &options, &cancel, &mut show)?;
    drop(meter);
    conclude(&made)
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
        return Err(selvedge_studies::ReportError::Cancelled.into());
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
