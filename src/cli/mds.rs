//! `selvedge mds`: maps from a table of dissimilarities.

use std::ops::RangeInclusive;
use std::path::Path;

use clap::Args;

use super::mds_json::{Chance, Document};
use super::output::{InFile, OutFile};
use super::terminal::with_meter;
use super::usage::one_of;
use super::{CliError, output};
use selvedge_foundation::files::{self, SquareTable};
use selvedge_foundation::numerics;
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::mds::{Dissimilarities, Elbow, Loss, Map, Mds, Null, NullKind, Ties};

/// The two sides of a pair may differ by this share of the largest: rounding in a file.
const ROUNDING_SHARE: f64 = 1e-6;
/// Starts on a line for each set of data without structure: exchange does the rest.
const STARTS_OF_CHANCE: usize = 100;

/// A table of dissimilarities, and how it is mapped.
#[derive(Debug, Args)]
pub(super) struct MdsArgs {
    /// Square table or a triangle of it, with or without names; an empty cell is missing; `-` is
    /// standard input
    dissimilarities: InFile,
    /// Numbers of dimensions: 2, or 1-5
    #[arg(long, value_name = "K-K", value_parser = dimensions, default_value = "1-5")]
    dims: Dimensions,
    /// What tied dissimilarities ask of distances: nothing, to be equal, to be equal in the mean
    #[arg(long, default_value = "primary",
        value_parser = one_of(Ties::ALL.map(|ties| (ties.name(), ties))))]
    ties: Ties,
    /// What is made small: Kruskal's stress-1, or the loss of ALSCAL on squared distances
    #[arg(long, default_value = "stress1",
        value_parser = one_of([("stress1", Loss::Stress1), ("sstress", Loss::SStress)]))]
    loss: Loss,
    /// Starts in two dimensions and more; on a line at least 1000
    #[arg(long, value_name = "N", default_value_t = Mds::DEFAULT_STARTS,
        value_parser = starts)]
    starts: usize,
    /// What random numbers begin with
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// File for the maps; `-` is standard output
    #[arg(long, value_name = "OUT")]
    json: Option<OutFile>,
    /// Take the mean where the two sides of a pair differ, instead of refusing the table
    #[arg(long)]
    average: bool,
    /// Sets of random ranks to compare the stress with; 100 takes half a minute
    #[arg(long, value_name = "N", default_value_t = 0)]
    random_data: u16,
    /// Permutations of the table's own numbers to compare the stress with
    #[arg(long, value_name = "N", default_value_t = 0)]
    permutations: u16,
    /// Threads that share the work (as many as the machine has); the bytes are the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..))]
    threads: Option<u8>,
}

/// From so many dimensions to so many.
type Dimensions = RangeInclusive<usize>;

fn dimensions(text: &str) -> Result<Dimensions, String> {
    let (least, most) = text.split_once('-').unwrap_or((text, text));
    let number = |part: &str| part.trim().parse::<usize>().ok();
    match (number(least), number(most)) {
        (Some(least), Some(most))
            if (1..=most).contains(&least) && most <= Mds::MOST_DIMENSIONS =>
        {
            Ok(least..=most)
        }
        _ => Err(format!(
            "give 1 to {} dimensions, such as 2 or 1-5",
            Mds::MOST_DIMENSIONS
        )),
    }
}

fn starts(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|n| (1..=1_000_000).contains(n));
    number.ok_or_else(|| "give 1 to 1000000 starts".to_owned())
}

impl MdsArgs {
    fn mds(&self) -> Mds {
        Mds {
            ties: self.ties,
            loss: self.loss,
            n_starts: self.starts,
            n_starts_on_a_line: self.starts.max(Mds::LEAST_STARTS_ON_A_LINE),
            seed: self.seed,
            n_threads: self.threads.map_or_else(numerics::n_threads, usize::from),
            ..Mds::default()
        }
    }

    /// How much there is to do for the maps, and for those of chance.
    fn work(&self, data: &Dissimilarities) -> [f64; 2] {
        let over_dims = |mds: &Mds| -> f64 { self.dims.clone().map(|k| mds.work(data, k)).sum() };
        let n_sets = f64::from(self.random_data) + f64::from(self.permutations);
        [
            over_dims(&self.mds()),
            n_sets * over_dims(&self.mds_of_chance()),
        ]
    }

    fn mds_of_chance(&self) -> Mds {
        Mds {
            n_starts_on_a_line: STARTS_OF_CHANCE,
            ..self.mds()
        }
    }
}

/// Makes the maps, and writes them.
pub(super) fn run(args: &MdsArgs) -> Result<(), CliError> {
    let path: &Path = &args.dissimilarities;
    let text = files::read_text(path)?;
    let table = SquareTable::read(&text, path)?;
    let data = checked(&table, path, args.average)?;
    let mds = args.mds();
    let (maps, chance) = with_meter("mds", |progress| -> Result<_, CliError> {
        let [own, other] = args.work(&data);
        let from = own / (own + other);
        let maps = progress.within([0.0, from], |progress| {
            mds.maps(&data, args.dims.clone(), progress)
        })?;
        let chance = progress.within([from, 1.0], |progress| chance(args, &data, progress))?;
        Ok((maps, chance))
    })??;
    let elbow = elbow(&maps, mds.loss, &chance);
    let out = args.json.as_deref();
    if let Some(out) = out {
        let document = Document::of(&data, &mds, &maps, &chance, &elbow);
        output::write_text(Some(out), &files::to_json_string(&document, out)?)?;
    }
    match out {
        Some(out) if output::named_file(Some(out)).is_none() => Ok(()),
        _ => output::print(&summary(&data, &mds, &maps, &elbow)),
    }
}

/// The table as dissimilarities.
fn checked(table: &SquareTable, path: &Path, average: bool) -> Result<Dissimilarities, CliError> {
    let wrong = |what: String| CliError::Input(format!("{}: {what}", path.display()));
    let (names, n) = (&table.names, table.names.len());
    let mut values = table.values.clone();
    let largest = values.iter().flatten().copied().fold(0.0, f64::max);
    for i in 0..n {
        for j in i + 1..n {
            let (a, b) = (&names[i], &names[j]);
            let (Some(one), Some(other)) = (values[i * n + j], values[j * n + i]) else {
                continue;
            };
            if (one - other).abs() > ROUNDING_SHARE * largest && !average {
                let what = format!(
                    "{a} to {b} is {one}, {b} to {a} is {other}; mend the table, or take the mean \
                     of both with --average"
                );
                return Err(wrong(what));
            }
            let mean = 0.5 * (one + other);
            (values[i * n + j], values[j * n + i]) = (Some(mean), Some(mean));
        }
    }
    let negative = values
        .iter()
        .position(|value| value.is_some_and(|x| x < 0.0));
    if let Some(at) = negative {
        let (a, b) = (&names[at / n], &names[at % n]);
        let what = format!("{a} to {b} is negative; a dissimilarity is 0 or more");
        return Err(wrong(what));
    }
    Dissimilarities::new(names.clone(), &values)
        .map_err(|undefined| wrong(format!("{}; add what is missing", undefined.reason)))
}

/// What data without structure give, in every number of dimensions, as far as it is asked for.
fn chance(
    args: &MdsArgs,
    data: &Dissimilarities,
    progress: &mut Progress<'_>,
) -> Result<Chance, CliError> {
    let mds = args.mds_of_chance();
    let (mut all, mut done) = (Chance::default(), 0.0);
    let [_, total] = args.work(data);
    for (kind, n) in [
        (NullKind::RandomRanks, args.random_data),
        (NullKind::Permuted, args.permutations),
    ] {
        for k in args.dims.clone().filter(|_| n > 0) {
            let share = f64::from(n) * mds.work(data, k) / total;
            let null = progress.within([done, done + share], |progress| {
                Null::of(&mds, data, kind, (k, usize::from(n)), progress)
            })?;
            done += share;
            match kind {
                NullKind::RandomRanks => all.random_data.push(null),
                NullKind::Permuted => all.permutations.push(null),
            }
        }
    }
    Ok(all)
}

fn elbow(maps: &[Map], loss: Loss, chance: &Chance) -> Elbow {
    let losses: Vec<(usize, f64)> = maps.iter().map(|map| (map.dims, map.loss(loss))).collect();
    let on_a_line = chance.random_data.first().filter(|null| null.dims == 1);
    let five_percent = chance.random_data.iter().map(Null::five_percent);
    Elbow::of(
        &losses,
        on_a_line.map(Null::mean),
        &five_percent.collect::<Vec<_>>(),
    )
}

/// What a reader wants to know first.
fn summary(data: &Dissimilarities, mds: &Mds, maps: &[Map], elbow: &Elbow) -> String {
    let (n, n_missing) = (data.n_objects(), data.n_missing());
    let mut lines = vec![format!(
        "{n} objects, {} pairs, {n_missing} missing; {} ties, {} made small",
        data.pairs().len(),
        mds.ties.name(),
        mds.loss.name()
    )];
    lines.push("dims  stress-1  S-stress  Spearman  starts that reached it".to_owned());
    for map in maps {
        let spearman = map
            .spearman
            .as_ref()
            .map_or_else(|_none| "none".to_owned(), |r| fixed(*r, 3));
        lines.push(format!(
            "{:4}  {:>8}  {:>8}  {spearman:>8}  {} of {}",
            map.dims,
            fixed(map.stress1, 5),
            fixed(map.sstress, 5),
            map.n_reached,
            map.n_starts
        ));
    }
    if let Some(k) = elbow.by_bend {
        lines.push(format!("the curve bends most at {k}"));
    }
    if let Some(k) = elbow.below_chance {
        lines.push(format!("below the 5 % point of random data from {k} on"));
    }
    for map in maps {
        let warned = map.warnings.iter();
        lines.extend(warned.map(|warning| format!("{}-D: {warning}", map.dims)));
    }
    lines.push(String::new());
    lines.join("\n")
}
