//! `selvedge experiment plan`: what is settled before the first subject comes.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::output::OutFile;
use super::super::{CliError, output};
use selvedge_experiment::Plan;
use selvedge_foundation::files::FileError;

/// Of which design, and where the plan goes.
#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Design: a file, or a name that "selvedge experiment designs" lists
    design: PathBuf,
    /// File of the plan; sessions are held by the one in their folder that has its usual name
    #[arg(long, value_name = "PLAN.toml")]
    out: Option<OutFile>,
    /// How many people take part (as many as the design says)
    #[arg(long, value_name = "N")]
    subjects: Option<usize>,
    /// How often a test may reject what is true
    #[arg(long, value_name = "ALPHA", default_value_t = 0.05)]
    alpha: f64,
    /// Differences between which two conditions count as equal
    #[arg(long, value_names = ["LOW", "HIGH"], num_args = 2, allow_negative_numbers = true)]
    equivalence: Option<Vec<f64>>,
}

/// Writes the plan that design and method suggest.
pub(super) fn run(args: &PlanArgs) -> Result<(), CliError> {
    let design = super::designs::design(&args.design)?;
    let mut plan = Plan::suggested(&design);
    plan.subjects = args.subjects.unwrap_or(plan.subjects);
    plan.alpha = args.alpha;
    plan.equivalence = match args.equivalence.as_deref() {
        Some(&[low, high]) => Some([low, high]),
        _ => None,
    };
    let usual = Plan::path(Path::new(""), &design);
    let out = args.out.as_deref().map_or(usual, Path::to_path_buf);
    plan.check(&out)?;
    if out.exists() {
        return Err(FileError::Exists { path: out }.into());
    }
    let text = plan.to_toml(&out)?;
    output::write_text(Some(&out), &text)?;
    output::print(&format!(
        "{}: edit it, then lay it into the folder of the sessions before the first one\n",
        out.display()
    ))
}
