//! The papers' experiments once more, by simulated observers: printed beside what comes out.
//!
//! ```text
//! shipped designs ─▶ many studies of simulated observers ─▶ Comparison (printed, obtained)
//!                                                        └▶ Analysis (tables, figures, one study
//!                                                           of each in full)
//! ```
//!
//! The observers' noise is calibrated on published just noticeable differences and on nothing else.
//! What is assumed beyond that is swept over its range and shown, not chosen by its outcome; where
//! an outcome is inverted, to say what it would take, that is called a fit.
//!
//! # Invariants
//! - studies have random numbers of their own: neither their number nor threads change one of them
//! - numbers that were printed stand in `printed.rs` alone

mod judgement;
mod listing;
mod maps;
mod odd_one_out;
mod printed;
mod ranking;
mod studies;
#[cfg(test)]
mod tests;

use crate::ExperimentError;
use crate::analysis::{self, Analysis};
use crate::design::Design;
use crate::observer::{Observer, Stimuli, Strategy, Weighting};
use selvedge_chart::{Plot, Series, Style};
use selvedge_foundation::progress::Progress;
use selvedge_textile::BuildCache;

pub use studies::Spread;

/// How much is simulated.
#[derive(Debug, Clone)]
pub struct Options {
    /// What all chance begins with.
    pub seed: u64,
    /// Studies of every comparison, at least 20.
    pub n_studies: usize,
    /// Studies of every point of a sweep, at least 2.
    pub n_swept: usize,
    /// Studies that maps are made of, at least 2.
    pub n_maps: usize,
    /// Whether one study of each experiment is analysed in full.
    pub is_detailed: bool,
    /// Where textiles that are built from recipes are kept.
    pub cache: Option<BuildCache>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            n_studies: 200,
            n_swept: 50,
            n_maps: 50,
            is_detailed: true,
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
    /// What changes with what is assumed, and the names of the files.
    pub sweeps: Vec<(String, Plot)>,
    /// All of it, to be read.
    pub analysis: Analysis,
}

impl Replication {
    /// Adds what studies of a kind of observer came to, one number a study; nothing where fewer
    /// than two studies have it.
    fn add(
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
                observer: kind.told,
                assumed: kind.assumed,
                obtained,
            });
        }
    }
}

/// A kind of observer.
#[derive(Debug, Clone, Copy)]
struct Kind {
    told: &'static str,
    assumed: &'static str,
    observer: Observer,
}

/// Levels of both bands, noise from published differences, one look.
fn by_levels() -> Kind {
    Kind {
        told: "levels, one look",
        assumed: "nothing",
        observer: Observer::default(),
    }
}

/// All that the array tells, each cue by what it is worth.
fn practised() -> Kind {
    Kind {
        told: "all cues by their worth, one look",
        assumed: "cues beyond levels have the noise of levels",
        observer: Observer {
            strategy: Strategy::All,
            weighting: Weighting::Learnt,
            ..Observer::default()
        },
    }
}

/// Nothing to go by.
fn guessing() -> Kind {
    Kind {
        told: "guesses",
        assumed: "nothing",
        observer: Observer {
            strategy: Strategy::None,
            ..Observer::default()
        },
    }
}

/// A shipped design, and its stimuli as they are measured.
struct Laid {
    design: Design,
    stimuli: Stimuli,
}

impl Laid {
    fn open(
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
fn printed_line(name: &str, value: f64, [from, to]: [f64; 2]) -> Series {
    Series {
        name: name.to_owned(),
        points: vec![[from, value], [to, value]],
        style: Style::Dashed,
        ..Series::default()
    }
}

/// The papers' experiments as designs.
struct Papers {
    real: Laid,
    virtually: Laid,
    triads: Laid,
    judged: Laid,
}

impl Papers {
    fn open(options: &Options, progress: &mut Progress<'_>) -> Result<Self, ExperimentError> {
        let mut open =
            |name: &str, part| progress.within(part, |part| Laid::open(name, options, part));
        Ok(Self {
            real: open("ranking-real-target", [0.0, 0.2])?,
            virtually: open("ranking-virtual-target", [0.2, 0.4])?,
            triads: open("odd-one-out", [0.4, 0.5])?,
            judged: open("real-or-generated", [0.5, 1.0])?,
        })
    }
}

/// Simulates the papers' experiments with the shipped library.
///
/// # Errors
/// The library cannot be read, or it was cancelled.
pub fn replicate(
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Replication, ExperimentError> {
    let options = &Options {
        n_studies: options.n_studies.max(20),
        n_swept: options.n_swept.max(2),
        n_maps: options.n_maps.max(2),
        ..options.clone()
    };
    let papers = progress.within([0.0, 0.1], |part| Papers::open(options, part))?;
    progress.within([0.1, 1.0], |part| replicated(&papers, options, part))
}

fn replicated(
    papers: &Papers,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Replication, ExperimentError> {
    let Papers {
        real,
        virtually,
        triads,
        judged,
    } = papers;
    let mut found = Replication {
        comparisons: Vec::new(),
        sweeps: Vec::new(),
        analysis: Analysis {
            title: "Published against obtained, by simulated observers".to_owned(),
            sections: Vec::new(),
        },
    };
    let ranked = ranking::Rankings {
        real,
        virtually,
        options,
    };
    let all = &mut found;
    let sections = [
        progress.within([0.0, 0.5], |part| ranked.section(all, part))?,
        progress.within([0.5, 0.6], |part| {
            maps::section(virtually, options, all, part)
        })?,
        progress.within([0.6, 0.75], |part| {
            odd_one_out::section(triads, options, all, part)
        })?,
        progress.within([0.75, 0.85], |part| {
            judgement::section(judged, options, all, part)
        })?,
    ];
    let listed = listing::section(&found.comparisons);
    let all = &mut found.analysis.sections;
    all.push(listed);
    all.extend(sections);
    all.push(printed::section());
    if options.is_detailed {
        let each = [real, virtually, triads, judged];
        all.extend(progress.within([0.85, 1.0], |part| in_full(&each, options, part))?);
    }
    Ok(found)
}

/// One study of each experiment as the logs of people would be analysed.
fn in_full(
    each: &[&Laid],
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<analysis::Section>, ExperimentError> {
    let mut found = Vec::new();
    progress.step(0.0, "one study of each in full")?;
    for laid in each {
        let n_sessions = odd_one_out::sessions_of(&laid.design);
        found.extend(studies::held(
            laid,
            by_levels().observer,
            n_sessions,
            options,
        )?);
    }
    let how = analysis::Options {
        seed: options.seed,
        cache: options.cache.clone(),
        ..analysis::Options::default()
    };
    let mut sections = analysis::analyse(&found, &how, progress)?.sections;
    for section in &mut sections {
        section.title = format!("One study in full. {}", section.title);
    }
    Ok(sections)
}
