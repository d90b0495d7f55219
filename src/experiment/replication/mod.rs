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

mod comparison;
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
use selvedge_foundation::progress::Progress;

pub use comparison::{Comparison, Options, Replication, Spread};
use comparison::{DesignWithStimuli, by_levels};

/// The papers' experiments as designs.
struct Papers {
    real: DesignWithStimuli,
    virtually: DesignWithStimuli,
    triads: [DesignWithStimuli; 3],
    judged: DesignWithStimuli,
}

impl Papers {
    fn open(options: &Options, progress: &mut Progress<'_>) -> Result<Self, ExperimentError> {
        let mut open = |name: &str, part| {
            progress.within(part, |part| DesignWithStimuli::open(name, options, part))
        };
        let [pen, optical, kawabata] = odd_one_out::GROUPS;
        Ok(Self {
            real: open("ranking-real-target", [0.0, 0.2])?,
            virtually: open("ranking-virtual-target", [0.2, 0.4])?,
            triads: [
                open(pen, [0.4, 0.45])?,
                open(optical, [0.45, 0.6])?,
                open(kawabata, [0.6, 0.65])?,
            ],
            judged: open("real-or-generated", [0.65, 1.0])?,
        })
    }
}

impl Replication {
    /// Simulates the papers' experiments with the shipped library.
    ///
    /// # Errors
    /// The library cannot be read, or it was cancelled.
    pub fn simulate(
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let options = &Options {
            n_studies: options.n_studies.max(20),
            ..options.clone()
        };
        let papers = progress.within([0.0, 0.1], |part| Papers::open(options, part))?;
        progress.within([0.1, 1.0], |part| replicated(&papers, options, part))
    }
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
        progress.within([0.0, 0.35], |part| ranked.section(all, part))?,
        progress.within([0.35, 0.75], |part| {
            maps::section(virtually, options, all, part)
        })?,
        progress.within([0.75, 0.85], |part| {
            odd_one_out::section(triads, options, all, part)
        })?,
        progress.within([0.85, 0.9], |part| {
            judgement::section(judged, options, all, part)
        })?,
    ];
    let listed = listing::section(&found.comparisons, options);
    let all = &mut found.analysis.sections;
    all.push(listed);
    all.extend(sections);
    all.push(printed::section());
    if options.is_detailed {
        let each: Vec<&DesignWithStimuli> = [real, virtually, judged]
            .into_iter()
            .chain(triads)
            .collect();
        all.extend(progress.within([0.9, 1.0], |part| in_full(&each, options, part))?);
    }
    Ok(found)
}

/// One study of each experiment as the logs of people would be analysed.
fn in_full(
    each: &[&DesignWithStimuli],
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<analysis::Section>, ExperimentError> {
    let mut found = Vec::new();
    progress.step(0.0, "one study of each in full")?;
    for laid in each {
        let observer = by_levels().observer;
        found.extend(studies::simulate_study(laid, observer, options)?);
    }
    let how = analysis::Options {
        seed: options.seed,
        cache: options.cache.clone(),
        ..analysis::Options::default()
    };
    let mut sections = Analysis::of(&found, &how, progress)?.sections;
    for section in &mut sections {
        section.title = format!("One study in full. {}", section.title);
    }
    Ok(sections)
}
