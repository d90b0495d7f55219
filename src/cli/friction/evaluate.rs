//! `selvedge friction evaluate`: what is finished of all methods on all splits, as one table.

use clap::Args;

use super::super::output::OutFile;
use super::data::DataArgs;
use super::{folder, pages};
use crate::CliError;
use crate::output::{TableOut, print};
use crate::terminal::{self, with_meter};
use crate::usage::one_of;
use selvedge_foundation::numerics::n_threads;
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{
    Baseline, Contestant, Fabric, FrictionError, Lesson, Method, Run, Scores, Split, Taken,
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
    #[command(flatten)]
    data: DataArgs,
}

/// A row of the table: who, how many runs, each measure's mean and deviation over seeds.
struct Row {
    name: &'static str,
    n_runs: usize,
    measures: [[f64; 2]; Scores::N],
}

pub(super) fn run(args: &EvaluateArgs) -> Result<(), CliError> {
    folder(&args.out)?;
    if let Some(fabrics) = args.data.fabrics()? {
        return of_fabrics(args, &fabrics);
    }
    let path = args.out.join("table.csv");
    let measures = Scores::COLUMNS
        .into_iter()
        .flat_map(|column| [column.to_owned(), format!("{column}_sd")]);
    let header: Vec<String> = ["split", "method", "runs"]
        .map(str::to_owned)
        .into_iter()
        .chain(measures)
        .collect();
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut csv = TableOut::new(Some(&path), &header)?;
    let mut lines = Vec::new();
    for &split in &args.splits {
        let (rows, missing) = rows(args, split)?;
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
    lines.extend(others(args)?);
    if let Some(&split) = args.splits.first() {
        pages::draw(&args.out, split, n_threads())?;
    }
    print(&lines.join("\n"))
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
        let all = simple.chain(lessons(split).map(Contestant::Network));
        all.map(move |contestant| kept(args, split, contestant).name())
    };
    let in_table: Vec<String> = Split::ALL.into_iter().flat_map(of_split).collect();
    let mut lines = Vec::new();
    for (name, scores) in Run::all_finished(&args.out)? {
        if !in_table.contains(&name) {
            let mean = scores.mean();
            let [db, percent] = [SHOWN[0].0, SHOWN[1].0].map(|measure| fixed(mean[measure], 2));
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

fn rows(args: &EvaluateArgs, split: Split) -> Result<(Vec<Row>, Missing), CliError> {
    let mut rows = Vec::new();
    for (baseline, scores) in baselines(args, split)? {
        rows.push(Row {
            name: baseline.word(),
            n_runs: 1,
            measures: scores.mean().map(|mean| [mean, 0.0]),
        });
    }
    let mut missing = Vec::new();
    for method in Method::ALL {
        let (mut found, mut not_run) = (Vec::new(), Vec::new());
        for seed in method.seeds(split) {
            let lesson = Lesson::usual(method, seed);
            match kept(args, split, Contestant::Network(lesson)).finished()? {
                Some(scores) => found.push(scores.mean()),
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

/// Scores of the simple methods: those that are kept, and those that are made now.
fn baselines(args: &EvaluateArgs, split: Split) -> Result<Vec<(Baseline, Scores)>, CliError> {
    let mut found = Vec::new();
    let mut taken = None;
    for baseline in Baseline::ALL {
        let run = kept(args, split, Contestant::Baseline(baseline));
        if let Some(scores) = run.finished()? {
            found.push((baseline, scores));
        } else if !args.only_finished {
            let scores = with_meter("evaluate", |progress| -> Result<Scores, FrictionError> {
                let step = progress.step(0.0, "making pictures of cloth");
                step.map_err(|_stopped| FrictionError::Cancelled)?;
                let taken =
                    taken.get_or_insert_with(|| Taken::of(split, Split::N_CLOTHS, n_threads()));
                run.run(taken, progress, &mut |said| terminal::line(said))
            })??;
            found.push((baseline, scores));
        }
    }
    Ok(found)
}

/// Mean and standard deviation (0 of a single run) of runs with other seeds.
fn over_seeds(runs: &[[f64; Scores::N]]) -> [[f64; 2]; Scores::N] {
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

/// What is read first: spectra, level, deviations, the paper's own measures.
const SHOWN: [(usize, &str, usize); 8] = [
    (Scores::LOG_SPECTRAL, "spectrum dB", 2),
    (Scores::LEVEL, "level %", 2),
    (8, "bands dB", 2),
    (6, "deviations", 2),
    (9, "period mm", 2),
    (10, "correlation", 2),
    (0, "spectrogram RMSE", 3),
    (4, "signal RMSE %", 2),
];

fn table(rows: &[Row]) -> Vec<String> {
    let line = |name: &str, runs: &str, cells: Vec<String>| {
        let cells: Vec<_> = cells.iter().map(|cell| format!("{cell:>16}")).collect();
        format!("{name:17} {runs:>4}  {}", cells.join("  "))
    };
    let head = SHOWN.map(|(_, name, _)| name.to_owned());
    let row = |row: &Row| {
        let cell = |(measure, _, digits): (usize, &str, usize)| {
            let [mean, sd] = row.measures[measure].map(|number| fixed(number, digits));
            if row.n_runs > 1 {
                format!("{mean} ± {sd}")
            } else {
                mean
            }
        };
        line(row.name, &row.n_runs.to_string(), SHOWN.map(cell).to_vec())
    };
    let head = line("method", "runs", head.to_vec());
    std::iter::once(head).chain(rows.iter().map(row)).collect()
}
