//! `selvedge experiment preview`: what a design comes to before it is used.

use std::path::PathBuf;

use clap::Args;

use super::super::output::{Cell, JsonArgs};
use super::super::{CliError, output};
use selvedge_experiment::design::Design;
use selvedge_experiment::{Preview, PreviewOptions};

/// Which design, and for whom.
#[derive(Debug, Args)]
pub(crate) struct PreviewArgs {
    /// The design's file, or the name of one of the program
    design: PathBuf,
    /// Subjects; the design's own number, or 8 where it leaves that open
    #[arg(long, value_name = "N")]
    subjects: Option<usize>,
    /// The effect that is looked for: d′ of a trial, or standard deviations over subjects where
    /// nothing is right or wrong
    #[arg(long, value_name = "D", default_value_t = 1.0)]
    effect: f64,
    /// What chance begins with
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    how: JsonArgs,
}

/// Prints it.
pub(super) fn run(args: &PreviewArgs) -> Result<(), CliError> {
    let design = super::designs::design(&args.design)?;
    let options = PreviewOptions {
        n_subjects: args.subjects,
        effect: args.effect,
        seed: args.seed,
    };
    let preview = Preview::of(&design, &options)?;
    let rows = figures(&design, &preview);
    let columns = ["what", "value"];
    output::print_rows(&args.how, columns, &rows, || described(&design, &preview))
}

/// The figures of what is described, for programs.
fn figures(design: &Design, preview: &Preview) -> Vec<[Cell; 2]> {
    let [played_s, answer_s] = preview.trial_s;
    let mut rows = vec![
        ("title", Cell::text(&design.title)),
        ("method", Cell::text(design.composition.kind().name())),
        ("trials", Cell::count(preview.n_trials)),
        ("blocks", Cell::count(preview.n_blocks)),
        ("practice", Cell::count(preview.n_practice)),
        ("session_s", Cell::number(preview.duration_s)),
        ("played_s", Cell::number(played_s)),
        ("answer_s", Cell::number(answer_s)),
        ("subjects", Cell::count(preview.n_subjects)),
        ("power", Cell::number(preview.power.share)),
        ("simulated_studies", Cell::count(preview.power.n_studies)),
    ];
    let uneven = preview.balance.iter().filter(|one| !one.is_even());
    rows.extend(uneven.map(|one| ("not_even", Cell::text(one.what))));
    let left_out = design.rules.exclusions().into_iter();
    rows.extend(left_out.map(|rule| ("left_out", Cell::text(rule))));
    let row = |(what, value)| [Cell::text(what), value];
    rows.into_iter().map(row).collect()
}

fn described(design: &Design, preview: &Preview) -> String {
    let [played_s, answer_s] = preview.trial_s;
    let mut lines = vec![
        format!("{} ({})", design.title, design.composition.kind().name()),
        format!(
            "{} trials at most in {} block{}, {} of practice before them",
            preview.n_trials,
            preview.n_blocks,
            if preview.n_blocks == 1 { "" } else { "s" },
            preview.n_practice
        ),
        format!(
            "about {:.0} min a session: {played_s:.1} s played and {answer_s:.1} s for an answer \
             (assumed), 2 s between",
            preview.duration_s / 60.0
        ),
        format!("balance over {} subjects", preview.n_subjects),
    ];
    if preview.balance.is_empty() {
        lines.push("  what comes next follows the answers".to_owned());
    }
    for one in &preview.balance {
        let [fewest, most] = one.times;
        let times = if fewest == most {
            format!("{most}")
        } else {
            format!("{fewest} to {most}")
        };
        let even = if one.is_even() { "even" } else { "NOT EVEN" };
        lines.push(format!(
            "  {}: {times} times, {even} ({} of them)",
            one.what, one.n
        ));
    }
    let left_out = design.rules.exclusions();
    if !left_out.is_empty() {
        lines.push(format!("left out: {}", left_out.join("; ")));
    }
    lines.push(format!(
        "power {:.0} % of {} simulated studies: {}",
        100.0 * preview.power.share,
        preview.power.n_studies,
        preview.power.described
    ));
    lines.join("\n") + "\n"
}
