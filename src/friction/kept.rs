//! Finished runs as one table, a row a run: what is shipped of them, and what a folder holds.
//!
//! A row tells how far a run was from what was felt, means over held-back windows, and what it
//! cost. Clocks are read elsewhere: here a cost is a number.

use std::path::Path;

use selvedge_foundation::files::{FileError, Table, TableWriter, read_text, write_atomic};

use crate::runs::{Contestant, Run};
use crate::score::{Measure, Measures};
use crate::{FrictionError, Scores};

/// The table's name in a folder of runs.
const NAME: &str = "runs.csv";
/// Runs that were really made, as `assets/friction/provenance.toml` says.
const SHIPPED: &str = include_str!("../../assets/friction/runs.csv");
/// What a row begins with.
const HEAD: [&str; 6] = ["run", "model", "split", "seed", "width", "rounds"];
/// What it ends with.
const TAIL: [&str; 2] = ["cpu_s", "commit"];

/// A finished run.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptRun {
    /// As [`Run::name`] has it.
    pub name: String,
    /// The method's name in tables.
    pub model: String,
    /// The split's letter, or what fabrics of one's own are called.
    pub split: String,
    /// Seed, channels and rounds of a network that learns; empty of others.
    pub lesson: [Option<f64>; 3],
    /// The mean of each of [`Measure`] over held-back windows.
    pub measures: Measures,
    /// CPU time that learning and scoring took, s, if it was made in one piece.
    pub cpu_s: Option<f64>,
    /// The commit of the code that made it, if it is known; else empty.
    pub commit: String,
}

impl KeptRun {
    /// Of a run and its scores.
    pub fn of(run: &Run<'_>, scores: &Scores, cpu_s: Option<f64>) -> Self {
        let (model, lesson) = match run.contestant {
            Contestant::Network(lesson) => {
                let [width, rounds] = [lesson.size.width, lesson.n_rounds].map(|n| n as f64);
                let numbers = [lesson.seed as f64, width, rounds];
                (lesson.method.word(), numbers.map(Some))
            }
            Contestant::Baseline(baseline) => (baseline.word(), [None; 3]),
            Contestant::Shipped => (Contestant::SHIPPED, [None; 3]),
        };
        let split = run.fabrics.unwrap_or_else(|| run.split.letter());
        Self {
            name: run.name(),
            model: model.to_owned(),
            split: split.to_owned(),
            lesson,
            measures: scores.mean(),
            cpu_s,
            commit: String::new(),
        }
    }

    /// The runs that are shipped.
    ///
    /// # Errors
    /// A table that is none: a fault of the program.
    pub fn shipped() -> Result<Vec<Self>, FrictionError> {
        Self::parse(SHIPPED, Path::new(NAME))
    }

    /// Puts it into the table of a folder of runs, in place of an earlier one of its name.
    ///
    /// # Errors
    /// A table that cannot be read or written.
    pub fn keep(self, folder: &Path) -> Result<(), FrictionError> {
        let path = folder.join(NAME);
        let mut all = Vec::new();
        if path.exists() {
            all = Self::parse(&read_text(&path)?, &path)?;
        }
        all.retain(|other| other.name != self.name);
        all.push(self);
        all.sort_by(|a, b| a.name.cmp(&b.name));
        Self::write(&all, &path)
    }

    fn header() -> Vec<&'static str> {
        HEAD.into_iter()
            .chain(Measure::COLUMNS)
            .chain(TAIL)
            .collect()
    }

    fn parse(text: &str, path: &Path) -> Result<Vec<Self>, FrictionError> {
        let table = Table::read(text, path, &Self::header(), &[])?;
        let measures = Scores::rows_of(&table)?;
        let text = |column: &str| table.text(column).unwrap_or_default();
        let [names, models, splits, seeds, widths, rounds] = HEAD.map(text);
        let [costs, commits] = TAIL.map(text);
        // Cells that do not apply are empty.
        let perhaps = |row: usize, cell: &str| match cell.parse::<f64>() {
            _ if cell.is_empty() => Ok(None),
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(FileError::content(
                path,
                table.line_of(row),
                format!("\"{cell}\" is no number"),
                "write a finite decimal number with a point, or nothing",
            )),
        };
        let run = |row: usize| {
            let of_lesson = [seeds[row], widths[row], rounds[row]];
            let [seed, width, rounds] = of_lesson.map(|cell| perhaps(row, cell));
            Ok(Self {
                name: names[row].to_owned(),
                model: models[row].to_owned(),
                split: splits[row].to_owned(),
                lesson: [seed?, width?, rounds?],
                measures: measures[row],
                cpu_s: perhaps(row, costs[row])?,
                commit: commits[row].to_owned(),
            })
        };
        (0..table.n_rows()).map(run).collect()
    }

    fn write(all: &[Self], path: &Path) -> Result<(), FrictionError> {
        let mut table = TableWriter::new(Vec::new(), path, &Self::header())?;
        for run in all {
            table.text(&run.name).text(&run.model).text(&run.split);
            for number in run.lesson {
                table.optional(number);
            }
            for measure in run.measures {
                table.number(measure);
            }
            table.optional(run.cpu_s).text(&run.commit);
            table.end_row()?;
        }
        Ok(write_atomic(path, &table.finish()?)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Baseline, Lesson, Method, Split};
    use std::fs;

    fn run(contestant: Contestant, folder: &Path) -> Run<'_> {
        Run {
            contestant,
            split: Split::Cloths,
            n_cloths: Split::N_CLOTHS,
            fabrics: None,
            folder,
        }
    }

    #[test]
    fn shipped_runs_are_named_after_what_they_are_and_no_two_are_one() {
        let all = KeptRun::shipped().unwrap();
        assert!(all.len() > 10, "{} runs", all.len());
        let mut names: Vec<_> = all.iter().map(|run| run.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
        for kept in &all {
            let network = Method::ALL.into_iter().find(|m| m.word() == kept.model);
            let Some(method) = network else {
                assert_eq!(kept.lesson, [None; 3], "{kept:?}");
                continue;
            };
            let [seed, width, rounds] = kept.lesson.map(Option::unwrap);
            let index = selvedge_foundation::numerics::to_index;
            let mut lesson = Lesson::usual(method, index(seed) as u64);
            lesson.n_rounds = index(rounds);
            let contestant = Contestant::Network(lesson.with_width(index(width)));
            let is_split = |split: &Split| split.letter() == kept.split;
            let split = Split::ALL.into_iter().find(is_split).unwrap();
            let name = Run {
                split,
                ..run(contestant, Path::new(""))
            };
            assert_eq!(name.name(), kept.name);
            assert!(kept.measures.iter().all(|x| x.is_finite()) && !kept.commit.is_empty());
        }
    }

    #[test]
    fn a_run_takes_the_place_of_an_earlier_one_and_others_stay() {
        let folder = std::env::temp_dir().join(format!("selvedge-kept-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let network = Contestant::Network(Lesson::usual(Method::Ours, 7));
        let ridge = Contestant::Baseline(Baseline::Ridge);
        let kept = |contestant, measure, cpu_s| {
            let scores = Scores::of(&[], vec![[measure; Measure::N]]);
            KeptRun::of(&run(contestant, &folder), &scores, cpu_s)
        };
        for one in [
            kept(network, 1.5, Some(300.25)),
            kept(ridge, 0.1, Some(2.0)),
            kept(network, 2.5, None),
        ] {
            one.keep(&folder).unwrap();
        }
        let path = folder.join(NAME);
        let all = KeptRun::parse(&read_text(&path).unwrap(), &path).unwrap();
        assert_eq!(all, [kept(network, 2.5, None), kept(ridge, 0.1, Some(2.0))]);
        assert_eq!(all[0].lesson, [Some(7.0), Some(16.0), Some(8.0)]);
        let wrong = read_text(&path).unwrap().replace(",16,", ",wide,");
        let refused = KeptRun::parse(&wrong, &path).unwrap_err().to_string();
        assert!(refused.contains("\"wide\" is no number"), "{refused}");
        fs::remove_dir_all(&folder).unwrap();
    }
}
