//! `selvedge experiment replicate`: the papers' experiments by simulated observers, printed beside
//! obtained.

use clap::Args;

use super::super::output::OutFile;
use super::super::terminal::with_meter;
use super::super::{CliError, output};

use selvedge_experiment::replication::{Comparison, Options, Replication};
use selvedge_foundation::quantity::fixed;

/// How much is simulated, and where it goes.
#[derive(Debug, Args)]
pub(crate) struct ReplicateArgs {
    /// Folder for index.md, tables and figures; it is made where it is missing
    #[arg(long, value_name = "OUT")]
    out: OutFile,
    /// What all chance begins with
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Studies of every comparison
    #[arg(long, value_name = "N", default_value_t = 200,
        value_parser = clap::value_parser!(u16).range(20..=10_000))]
    studies: u16,
    /// How much observers differ in their noise: standard deviation of its logarithm
    #[arg(long, value_name = "SD", default_value_t = 0.2)]
    spread: f64,
    /// Besides, one study of each experiment in full, as analyse has it
    #[arg(long)]
    full: bool,
}

/// Simulates the papers' experiments, and writes what came out.
pub(super) fn run(args: &ReplicateArgs) -> Result<(), CliError> {
    let options = Options {
        seed: args.seed,
        n_studies: usize::from(args.studies),
        spread: args.spread,
        is_detailed: args.full,
        cache: selvedge_workbench::build_cache(),
    };
    let found = with_meter("replicating", |progress| {
        Replication::simulate(&options, progress)
    })??;
    found.analysis.write(&args.out)?;
    output::print(&summary(&found, args))
}

fn summary(found: &Replication, args: &ReplicateArgs) -> String {
    let mut lines = vec![format!(
        "{:>9}  {:>8}  {:>17}  {:<6}  of what",
        "printed", "obtained", "95 of 100 studies", "within"
    )];
    let with_print = found.comparisons.iter().filter(|one| one.printed.is_some());
    lines.extend(with_print.map(line));
    let page = args.out.join("index.md");
    lines.push(format!(
        "Nothing was fitted. All of it, with what is assumed: {}",
        page.display()
    ));
    lines.join("\n") + "\n"
}

fn line(one: &Comparison) -> String {
    let number = |value: f64| fixed(value, 2);
    let spread = one.obtained;
    let within = match one.is_within() {
        Some(true) => "yes",
        Some(false) => "no",
        None => "",
    };
    format!(
        "{:>9}  {:>8}  {:>17}  {within:<6}  {}: {}; {}",
        one.printed.map(number).unwrap_or_default(),
        number(spread.mean),
        format!("{} … {}", number(spread.low), number(spread.high)),
        one.paper,
        one.quantity,
        one.observer
    )
}
