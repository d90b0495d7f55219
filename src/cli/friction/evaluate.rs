//! `selvedge friction evaluate`: what is finished of all methods on all splits, as one table.

use clap::Args;

use super::super::output::OutFile;
use super::data::DataArgs;
use super::table::{Row, SHOWN, table};
use super::{folder, pages, run_timed};
use crate::CliError;
use crate::output::{TableOut, print};
use crate::terminal::with_meter;
use crate::usage::one_of;
use selvedge_foundation::numerics::n_threads;
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{
    Baseline, Contestant, Fabric, FrictionError, KeptRun, Lesson, Measure, Measures, Method, Run,
    Scores, Split, Taken,
};

/// Which runs are put together.
#[derive(Debug, Args)]
pub(crate) struct EvaluateArgs {
    /// Folder of runs, as train fills it; the table goes there, too
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    /// Splits to tell of
    #[arg(long, num_args = 1.., default_values = ["A", "B", "C", "D"],
        value_parser = one_of(Split::ALL.map(|split| (split.letter(), split))))]
    splits: Vec<Split>,
    /// Leave the simple methods out that are not finished (they take minutes a split)
    #[arg(long)]
    only_finished: bool,
    /// Tell of the runs of this folder alone, not of those that are shipped
    #[arg(long)]
    own: bool,
    #[command(flatten)]
    data: DataArgs,
}

pub(super) fn run(args: &EvaluateArgs) -> Result<(), CliError> {
    folder(&args.out)?;
    if let Some(fabrics) = args.data.fabrics()? {
        return of_fabrics(args, &fabrics);
    }
    let path = args.out.join("table.csv");
    let measures = Measure::COLUMNS
        .into_iter()
        .flat_map(|column| [column.to_owned(), format!("{column}_sd")]);
    let header: Vec<String> = ["split", "method", "runs"]
        .map(str::to_owned)
        .into_iter()
        .chain(measures)
        .collect();
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut csv = TableOut::new(Some(&path), &header)?;
    let shipped = if args.own {
        Vec::new()
    } else {
        KeptRun::shipped()?
    };
    let mut lines = Vec::new();
    for &split in &args.splits {
        let (rows, missing) = rows(args, split, &shipped)?;
        lines.push(format!("{}: {}", split.letter(), split.describe()));
        lines.extend(table(&rows));
        for row in &rows {
            let cells = csv
                .rows()
                .text(split.letter())
                .text(row.name)
                .number(row.n_runs);
            for number in row.measures.iter().flatten() {
                cells.number(number);
            }
            cells.end_row()?;
        }
        lines.extend(
            missing
                .iter()
                .map(|(method, seeds)| not_run(args, split, *method, seeds)),
        );
        lines.push(String::new());
    }
    csv.finish()?;
    families(args)?;
    lines.extend(others(args)?);
    if let Some(&split) = args.splits.first() {
        pages::draw(&args.out, split, n_threads())?;
    }
    print(&lines.join("\n"))
}

/// Writes the means of every family, a row a run of the folder and a family.
fn families(args: &EvaluateArgs) -> Result<(), CliError> {
    let path = args.out.join("families.csv");
    let header: Vec<&str> = ["run", "family"]
        .into_iter()
        .chain(Measure::COLUMNS)
        .collect();
    let mut csv = TableOut::new(Some(&path), &header)?;
    for (name, scores) in Run::all_finished(&args.out)? {
        for (family, means) in scores.by_cloth() {
            let cells = csv.rows().text(&name).text(family);
            for mean in means {
                cells.number(mean);
            }
            cells.end_row()?;
        }
    }
    csv.finish()
}

/// A run of the table.
fn kept(args: &EvaluateArgs, split: Split, contestant: Contestant) -> Run<'_> {
    Run {
        contestant,
        split,
        n_cloths: Split::N_CLOTHS,
        fabrics: None,
        folder: &args.out,
    }
}

/// Runs of another width, of other rounds, cloths or fabrics: no rows of the table.
fn others(args: &EvaluateArgs) -> Result<Vec<String>, CliError> {
    let lessons = |split: Split| {
        let all = Method::ALL.into_iter();
        all.flat_map(move |method| {
            method
                .seeds(split)
                .map(move |seed| Lesson::usual(method, seed))
        })
    };
    let of_split = |split: Split| {
        let simple = Baseline::ALL.into_iter().map(Contestant::Baseline);
        let simple = simple.chain([Contestant::Shipped]);
        let all = simple.chain(lessons(split).map(Contestant::Network));
        all.map(move |contestant| kept(args, split, contestant).name())
    };
    let in_table: Vec<String> = Split::ALL.into_iter().flat_map(of_split).collect();
    let mut lines = Vec::new();
    for (name, scores) in Run::all_finished(&args.out)? {
        if !in_table.contains(&name) {
            let mean = scores.mean();
            let [db, percent] = [SHOWN[0].0, SHOWN[1].0].map(|measure| fixed(measure.of(&mean), 2));
            lines.push(format!(
                "besides: {name}: spectrum {db} dB, level {percent} %"
            ));
        }
    }
    Ok(lines)
}

/// What methods make of fabrics of one's own, each left out in turn; the networks are as shipped.
fn of_fabrics(args: &EvaluateArgs, fabrics: &[Fabric]) -> Result<(), CliError> {
    let rows = with_meter("evaluate", |progress| Fabric::left_out(fabrics, progress))??;
    let path = args.out.join("fabrics.csv");
    let mut csv = TableOut::new(
        Some(&path),
        &["method", "level_rmse", "log_spectral_distance_db"],
    )?;
    let mut lines = vec![format!(
        "{:17}  {:>10}  {:>11}",
        "method", "level RMSE", "spectrum dB"
    )];
    for row in rows {
        let (name, level, distance) = (row.method, row.level_rmse, row.log_spectral_distance_db);
        let cell = distance.map_or_else(|| "-".to_owned(), |db| fixed(db, 2));
        lines.push(format!("{name:17}  {:>10}  {cell:>11}", fixed(level, 4)));
        let distance = distance.map(|db| db.to_string()).unwrap_or_default();
        csv.rows()
            .text(name)
            .number(level)
            .text(&distance)
            .end_row()?;
    }
    csv.finish()?;
    print(&format!("{}\n", lines.join("\n")))
}

/// What is not run yet, and how it is run.
fn not_run(args: &EvaluateArgs, split: Split, method: Method, seeds: &[u64]) -> String {
    let (method, split, out) = (method.word(), split.letter(), args.out.display());
    let seeds = seeds
        .iter()
        .map(u64::to_string)
        .collect::<Vec<_>>()
        .join(" ");
    format!(
        "not run: {method}, seeds {seeds}: selvedge friction train --out {out} --method {method} \
         --split {split} --seeds {seeds}"
    )
}

type Missing = Vec<(Method, Vec<u64>)>;

/// What came of a run: of the folder's, or else of the shipped one.
fn means(run: &Run<'_>, shipped: &[KeptRun]) -> Result<Option<Measures>, CliError> {
    if let Some(scores) = run.finished()? {
        return Ok(Some(scores.mean()));
    }
    let name = run.name();
    let kept = shipped.iter().find(|kept| kept.name == name);
    Ok(kept.map(|kept| kept.measures))
}

fn rows(
    args: &EvaluateArgs,
    split: Split,
    shipped: &[KeptRun],
) -> Result<(Vec<Row>, Missing), CliError> {
    let mut rows = simple(args, split, shipped)?;
    let mut missing = Vec::new();
    for method in Method::ALL {
        let (mut found, mut not_run) = (Vec::new(), Vec::new());
        for seed in method.seeds(split) {
            let lesson = Lesson::usual(method, seed);
            let run = kept(args, split, Contestant::Network(lesson));
            match means(&run, shipped)? {
                Some(means) => found.push(means),
                None => not_run.push(seed),
            }
        }
        if !found.is_empty() {
            rows.push(Row {
                name: method.word(),
                n_runs: found.len(),
                measures: over_seeds(&found),
            });
        }
        if !not_run.is_empty() {
            missing.push((method, not_run));
        }
    }
    Ok((rows, missing))
}

/// Rows of what learns nothing by rounds: what is kept, and what is made now. The shipped networks
/// know what B and C hold back.
fn simple(args: &EvaluateArgs, split: Split, shipped: &[KeptRun]) -> Result<Vec<Row>, CliError> {
    let simple = Baseline::ALL.into_iter();
    let all = simple.map(|baseline| (baseline.word(), Contestant::Baseline(baseline)));
    let of_shipped = (Contestant::SHIPPED, Contestant::Shipped);
    let all = all.chain((split == Split::Cloths).then_some(of_shipped));
    let mut rows = Vec::new();
    let mut taken = None;
    for (name, contestant) in all {
        let run = kept(args, split, contestant);
        let mut found = means(&run, shipped)?;
        if found.is_none() && !args.only_finished {
            let scores = with_meter("evaluate", |progress| -> Result<Scores, FrictionError> {
                let step = progress.step(0.0, "making pictures of cloth");
                step.map_err(|_stopped| FrictionError::Cancelled)?;
                let taken =
                    taken.get_or_insert_with(|| Taken::of(split, Split::N_CLOTHS, n_threads()));
                run_timed(&run, taken, progress)
            })??;
            found = Some(scores.mean());
        }
        rows.extend(found.map(|means| Row {
            name,
            n_runs: 1,
            measures: means.map(|mean| [mean, 0.0]),
        }));
    }
    Ok(rows)
}

/// Mean and standard deviation (0 of a single run) of runs with other seeds.
fn over_seeds(runs: &[Measures]) -> [[f64; 2]; Measure::N] {
    let n = runs.len() as f64;
    std::array::from_fn(|measure| {
        let mean = runs.iter().map(|run| run[measure]).sum::<f64>() / n;
        let squares = runs
            .iter()
            .map(|run| (run[measure] - mean).powi(2))
            .sum::<f64>();
        [mean, (squares / (n - 1.0).max(1.0)).sqrt()]
    })
}
