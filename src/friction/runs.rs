//! Runs of lessons, kept in a folder: what is finished is read, what was broken off goes on.
//!
//! Of every run the folder holds `NAME.scores.csv` (a row a held-back window), `NAME.rounds.csv`
//! (what was lost, a row a round), `NAME.weights` (ours only) and, until it is finished,
//! `NAME.checkpoint`.

use std::fs;
use std::path::{Path, PathBuf};

use selvedge_foundation::files::{FileError, read, write_atomic};
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::Progress;

use crate::FrictionError;
use crate::baseline::Baseline;
use crate::example::{Example, all_taken};
use crate::network::{Learning, Lesson, Losses, Method};
use crate::predict::Predictor;
use crate::score::{Prediction, score};
use crate::scores::Scores;
use crate::split::Split;

/// What files of scores end in.
const SCORES: &str = "scores.csv";

impl Method {
    /// Which seeds it is run with on a split, for the table.
    pub fn seeds(self, split: Split) -> std::ops::RangeInclusive<u64> {
        let n = match (self, split) {
            (Self::Ours, Split::Cloths) => 5,
            (Self::Ours, _) | (Self::FrictGan, Split::Cloths) => 3,
            (Self::FrictGan | Self::OursAdversarial, _) => 1,
        };
        1..=n
    }
}

/// A method that is scored on a split.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contestant {
    /// A network that learns.
    Network(Lesson),
    /// Something simple.
    Baseline(Baseline),
    /// The networks that are shipped, together: they learnt on split A.
    Shipped,
}

impl Contestant {
    /// What [`Self::Shipped`] is called in tables.
    pub const SHIPPED: &str = "shipped networks";
}

/// A contestant on a split, in a folder.
#[derive(Debug, Clone)]
pub struct Run<'a> {
    /// Who.
    pub contestant: Contestant,
    /// What is held back.
    pub split: Split,
    /// Cloths of each family that are learnt from, [`Split::N_CLOTHS`] for the table.
    pub n_cloths: usize,
    /// The fabrics that are learnt from and held back, by name, where it is not procedural cloth.
    pub fabrics: Option<&'a str>,
    /// Where it is kept.
    pub folder: &'a Path,
}

/// The windows of a split, taken.
#[derive(Debug)]
pub struct Taken {
    /// What is learnt from.
    pub(crate) learnt: Vec<Example>,
    /// What is held back.
    pub(crate) held_back: Vec<Example>,
}

impl Taken {
    /// The windows of a split with so many cloths of each family.
    pub fn of(split: Split, n_cloths: usize, n_threads: usize) -> Self {
        let windows = split.windows(n_cloths);
        let [learnt, held_back] = windows.map(|windows| all_taken(&windows, n_threads));
        Self { learnt, held_back }
    }

    /// The windows that are held back alone.
    pub fn held_back(split: Split, n_cloths: usize, n_threads: usize) -> Self {
        let [_, held_back] = split.windows(n_cloths);
        Self {
            learnt: Vec::new(),
            held_back: all_taken(&held_back, n_threads),
        }
    }

    /// Windows that are held back: the family, the strip of [`PredictedFriction::PER_MM`], what was
    /// felt along it.
    ///
    /// [`PredictedFriction::PER_MM`]: crate::PredictedFriction::PER_MM
    pub fn pictures(&self) -> impl Iterator<Item = (&str, &Grid<f32>, &[f64])> {
        let windows = self.held_back.iter();
        windows.map(|of| (of.cloth.as_str(), &of.strip, of.trace.as_slice()))
    }
}

impl Run<'_> {
    /// Its name: method, split, seed, and what differs from what results are told of.
    pub fn name(&self) -> String {
        let split = self.fabrics.unwrap_or_else(|| self.split.letter());
        let lesson = match self.contestant {
            Contestant::Network(lesson) => lesson,
            Contestant::Baseline(baseline) => return named(baseline.word(), split),
            Contestant::Shipped => return named(Contestant::SHIPPED, split),
        };
        let usual = Lesson::usual(lesson.method, lesson.seed);
        let mut parts = vec![lesson.method.word().to_owned(), split.to_owned()];
        parts.push(lesson.seed.to_string());
        parts.extend((lesson.loss != usual.loss).then(|| lesson.loss.word().to_owned()));
        parts.extend(
            (self.n_cloths != Split::N_CLOTHS).then(|| format!("cloths-{}", self.n_cloths)),
        );
        let width = lesson.size.width;
        parts.extend((width != usual.size.width).then(|| format!("width-{width}")));
        let n_rounds = lesson.n_rounds;
        parts.extend((n_rounds != usual.n_rounds).then(|| format!("rounds-{n_rounds}")));
        parts.join("-")
    }

    fn file(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}.{ending}", self.name()))
    }

    /// Its scores, if it is finished.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn finished(&self) -> Result<Option<Scores>, FrictionError> {
        let path = self.file(SCORES);
        if path.exists() {
            Scores::read(&path).map(Some)
        } else {
            Ok(None)
        }
    }

    /// Whether it was broken off: what it cost so far is not known.
    pub fn is_begun(&self) -> bool {
        self.file("checkpoint").exists()
    }

    /// All runs of a folder that are finished, by name.
    ///
    /// # Errors
    /// As [`Self::finished`].
    pub fn all_finished(folder: &Path) -> Result<Vec<(String, Scores)>, FrictionError> {
        let entries = fs::read_dir(folder).map_err(FileError::read(folder))?;
        let mut found = Vec::new();
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned());
            let name = name
                .and_then(|name| Some(name.strip_suffix(SCORES)?.strip_suffix('.')?.to_owned()));
            if let Some(name) = name {
                found.push((name, Scores::read(&path)?));
            }
        }
        found.sort_by(|a, b| a.0.cmp(&b.0));
        Ok(found)
    }

    /// Runs it to its end, from where it was broken off, and keeps what comes out.
    ///
    /// # Errors
    /// Cancelled (what is done stays); files that cannot be written; a checkpoint that is none.
    pub fn run(
        &self,
        taken: &Taken,
        progress: &mut Progress<'_>,
        said: &mut dyn FnMut(&str),
    ) -> Result<Scores, FrictionError> {
        let scores = match self.contestant {
            Contestant::Baseline(baseline) => {
                let fitted = baseline.fitted(&taken.learnt);
                scored(taken, progress, &|example| fitted.predict(example))?
            }
            Contestant::Shipped => {
                let shipped = Predictor::shipped()?;
                scored(taken, progress, &|example| {
                    Prediction::of_course(&shipped.course(&example.looks))
                })?
            }
            Contestant::Network(lesson) => {
                let learning = self.learnt(lesson, &taken.learnt, progress, said)?;
                let network = learning.network();
                let scores = scored(taken, progress, &|example| network.predict(example))?;
                if let Some(weights) = network.weights() {
                    write_atomic(&self.file("weights"), &weights.to_bytes())?;
                }
                scores
            }
        };
        scores.write(&taken.held_back, &self.file(SCORES))?;
        // Whether it can be removed does not matter: a finished run is read.
        drop(fs::remove_file(self.file("checkpoint")));
        Ok(scores)
    }

    fn learnt(
        &self,
        lesson: Lesson,
        examples: &[Example],
        progress: &mut Progress<'_>,
        said: &mut dyn FnMut(&str),
    ) -> Result<Learning, FrictionError> {
        let checkpoint = self.file("checkpoint");
        let mut learning = if checkpoint.exists() {
            Learning::resume(lesson, examples, &read(&checkpoint)?)?
        } else {
            Learning::begin(lesson, examples)
        };
        while learning.n_rounds_done() < lesson.n_rounds {
            let lost = learning.round(examples, progress)?;
            let round = learning.n_rounds_done();
            said(&format!(
                "{}: round {round} of {}: spectra {:.4}, level {:.4}, critic {:.4}",
                self.name(),
                lesson.n_rounds,
                lost.spectra,
                lost.level,
                lost.critic
            ));
            self.note(round, lost)?;
            write_atomic(&checkpoint, &learning.checkpoint())?;
        }
        Ok(learning)
    }

    /// A row of what was lost; rounds that are done again after a break are kept once.
    fn note(&self, round: usize, lost: Losses) -> Result<(), FrictionError> {
        let path = self.file("rounds.csv");
        let before = fs::read_to_string(&path).unwrap_or_default();
        let mut rows: Vec<&str> = before.lines().skip(1).take(round - 1).collect();
        let row = format!("{round},{},{},{}", lost.spectra, lost.level, lost.critic);
        rows.push(&row);
        let text = format!("round,spectra,level,critic\n{}\n", rows.join("\n"));
        Ok(write_atomic(&path, text.as_bytes())?)
    }
}

/// The name of a run that learns nothing by rounds.
fn named(word: &str, split: &str) -> String {
    format!("{}-{split}", word.replace(' ', "-").to_lowercase())
}

fn scored(
    taken: &Taken,
    progress: &mut Progress<'_>,
    predict: &dyn Fn(&Example) -> Prediction,
) -> Result<Scores, FrictionError> {
    let n = taken.held_back.len() as f64;
    let mut scores = Vec::with_capacity(taken.held_back.len());
    for (at, example) in taken.held_back.iter().enumerate() {
        let step = progress.step(at as f64 / n, "scoring");
        step.map_err(|_stopped| FrictionError::Cancelled)?;
        scores.push(score(&predict(example), &example.trace));
    }
    Ok(Scores::of(&taken.held_back, scores))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::Size;
    use crate::score::Measure;
    use selvedge_foundation::progress::{CancelFlag, Progress};

    #[test]
    fn a_run_that_was_broken_off_ends_as_one_that_was_not_and_is_read_afterwards() {
        let folder = std::env::temp_dir().join(format!("selvedge-runs-{}", std::process::id()));
        let taken = Taken::of(Split::Places, 2, 2);
        let lesson = Lesson {
            size: Size {
                width: 4,
                n_layers: 1,
            },
            n_rounds: 2,
            ..Lesson::usual(Method::Ours, 1)
        };
        let outcome = |name: &str, is_broken_off: bool| {
            let folder = folder.join(name);
            fs::create_dir_all(&folder).unwrap();
            let run = Run {
                contestant: Contestant::Network(lesson),
                split: Split::Places,
                n_cloths: 2,
                fabrics: None,
                folder: &folder,
            };
            assert_eq!(run.finished().unwrap(), None);
            if is_broken_off {
                let flag = CancelFlag::new();
                let mut heard = |_: f64, _: &str| {};
                let mut progress = Progress::new(&mut heard, flag.clone());
                let ended = run.run(&taken, &mut progress, &mut |_| flag.cancel());
                assert!(matches!(ended, Err(FrictionError::Cancelled)), "{ended:?}");
                assert!(run.file("checkpoint").exists());
            }
            let scores =
                Progress::unheard(|progress| run.run(&taken, progress, &mut |_| {})).unwrap();
            let families = scores.by_cloth();
            assert_eq!(families.len(), 8);
            let sum: f64 = families
                .iter()
                .map(|(_, mean)| Measure::LevelError.of(mean))
                .sum();
            // As many windows of each.
            assert!((sum / 8.0 - Measure::LevelError.of(&scores.mean())).abs() < 1e-12);
            let [of_name, of_windows] = [Measure::LevelError.of(&families[2].1), {
                let windows = taken.held_back.iter().zip(scores.windows());
                let of_family = windows.filter(|(of, _)| of.cloth == families[2].0);
                of_family
                    .map(|(_, scores)| Measure::LevelError.of(scores))
                    .sum::<f64>()
                    / 2.0
            }];
            assert!((of_name - of_windows).abs() < 1e-12);
            assert_eq!(run.finished().unwrap(), Some(scores));
            assert!(!run.file("checkpoint").exists());
            ["scores.csv", "rounds.csv", "weights"]
                .map(|ending| fs::read(run.file(ending)).unwrap())
        };
        assert!(outcome("whole", false) == outcome("broken", true));
        fs::remove_dir_all(&folder).unwrap();
    }
}
