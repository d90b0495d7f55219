//! What is compared: designs with their stimuli, kinds of observers, and what was printed beside
//! what is obtained.

use crate::ExperimentError;
use crate::analysis::{Analysis, Bar};
use crate::design::Design;
use crate::observer::{Observer, Stimuli, Strategy, Weighting};
use selvedge_chart::{Series, Style};
use selvedge_foundation::numerics::quantile;
use selvedge_foundation::progress::Progress;
use selvedge_statistics::{Computed, Summary, mean};
use selvedge_textile::BuildCache;

/// How much is simulated.
#[derive(Debug, Clone)]
pub struct Options {
    /// What all chance begins with.
    pub seed: u64,
    /// Studies of every comparison, figure and point of a sweep, at least 20.
    pub n_studies: usize,
    /// How much observers differ in their noise: standard deviation of its logarithm.
    pub spread: f64,
    /// Whether one study of each experiment is analysed in full besides.
    pub is_detailed: bool,
    /// Where textiles that are built from recipes are kept.
    pub cache: Option<BuildCache>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            n_studies: 200,
            spread: 0.2,
            is_detailed: false,
            cache: None,
        }
    }
}

/// A printed number, and what the same study of simulated observers comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Paper and experiment.
    pub paper: &'static str,
    /// What is compared, with its unit.
    pub quantity: String,
    /// What was printed; `None` where only chance or nothing can be compared with.
    pub printed: Option<f64>,
    /// How the observers felt and answered.
    pub observer: &'static str,
    /// What of that is assumed: nothing, or in words.
    pub assumed: &'static str,
    /// What came of the studies.
    pub obtained: Spread,
}

impl Comparison {
    /// Whether the printed number lies where 95 of 100 simulated studies lie.
    pub fn is_within(&self) -> Option<bool> {
        let printed = self.printed?;
        Some((self.obtained.low..=self.obtained.high).contains(&printed))
    }
}

/// Printed and obtained.
#[derive(Debug, Clone, PartialEq)]
pub struct Replication {
    /// Number by number.
    pub comparisons: Vec<Comparison>,
    /// All of it, to be read.
    pub analysis: Analysis,
}

impl Replication {
    /// Adds what studies of a kind of observer came to, one number a study; nothing where fewer
    /// than two studies have it.
    pub(super) fn add(
        &mut self,
        (paper, kind): (&'static str, &Kind),
        (quantity, printed): (&str, Option<f64>),
        values: &[f64],
    ) {
        if let Ok(obtained) = Spread::of(values) {
            self.comparisons.push(Comparison {
                paper,
                quantity: quantity.to_owned(),
                printed,
                observer: kind.description,
                assumed: kind.assumed,
                obtained,
            });
        }
    }
}

/// A kind of observer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    pub(super) description: &'static str,
    pub(super) assumed: &'static str,
    pub(super) observer: Observer,
}

/// Levels of both bands, noise from published differences, one look.
pub(super) fn by_levels() -> Kind {
    Kind {
        description: "levels, one look",
        assumed: "nothing",
        observer: Observer::default(),
    }
}

/// All that the array tells, each cue by what it is worth.
pub(super) fn practised() -> Kind {
    Kind {
        description: "all cues by their worth, one look",
        assumed: "cues beyond levels have the noise of levels",
        observer: Observer {
            strategy: Strategy::All,
            weighting: Weighting::Learnt,
            ..Observer::default()
        },
    }
}

/// Nothing to go by.
pub(super) fn guessing() -> Kind {
    Kind {
        description: "guesses",
        assumed: "nothing",
        observer: Observer {
            strategy: Strategy::None,
            ..Observer::default()
        },
    }
}

/// A shipped design, and its stimuli as they are measured.
pub(super) struct DesignWithStimuli {
    pub(super) design: Design,
    pub(super) stimuli: Stimuli,
}

impl DesignWithStimuli {
    pub(super) fn open(
        name: &str,
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let design = Design::shipped(name).ok_or_else(|| {
            let what = format!("there is no design {name}");
            ExperimentError::value(what, "take a build of the program that has all designs")
        })?;
        let library = design.open_library(std::path::Path::new(""), options.cache.as_ref())?;
        let stimuli = Stimuli::of(&design, &library, progress)?;
        Ok(Self { design, stimuli })
    }
}

/// A printed number as a line across a plot.
pub(super) fn printed_line(name: &str, value: f64, ends: [f64; 2]) -> Series {
    Series::of(name, Style::Dashed, ends.map(|at| [at, value]))
}

/// The mean over studies as a bar, with the interval in which 95 of 100 studies lie; none where
/// fewer than two have it.
pub(super) fn bar(name: &str, group: &str, values: &[f64]) -> Option<Bar> {
    let spread = Spread::of(values).ok()?;
    Some(Bar::of(
        name,
        group,
        spread.mean,
        Some([spread.low, spread.high]),
    ))
}

/// How a number is spread over studies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Studies in which it could be computed.
    pub n: usize,
    /// Its mean over studies.
    pub mean: f64,
    /// What the mean is uncertain by, since studies are not endless: its standard error.
    pub se: f64,
    /// The lower end of the middle 95 of 100 studies.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Spread {
    /// Of one number a study.
    ///
    /// # Errors
    /// Fewer than two of them.
    pub fn of(values: &[f64]) -> Computed<Self> {
        let summary = Summary::of(values)?;
        let mut sorted = values.to_vec();
        Ok(Self {
            n: summary.n,
            mean: mean(values)?,
            se: summary.se,
            low: quantile(&mut sorted, 0.025),
            high: quantile(&mut sorted, 0.975),
        })
    }
}
