//! What the logs of an experiment say: tables, tests, maps and the papers' figures.
//!
//! ```text
//! sessions ─▶ kept (rules of the design) ─▶ by method ─▶ Analysis ─┬▶ files
//!                                                                  └▶ a pane
//! ```
//!
//! # Invariants
//! - what is left out is listed with its reason, before anything is counted
//! - a number that cannot be computed is a reason, in every file
//! - the same logs and options give the same bytes

mod adjustment;
mod draw;
mod draw_map;
mod groups;
mod judgement;
mod judgement_cells;
mod judgement_confidence;
mod judgement_pairs;
mod judgement_power;
mod kept;
mod levels;
mod magnitude;
mod map;
mod map_chance;
mod map_speeds;
mod map_turn;
mod model;
mod odd_one_out;
mod odd_one_out_craven;
mod odd_one_out_distances;
mod odd_one_out_variants;
mod own_speeds;
mod pairs;
mod properties;
mod ranking;
mod ranking_confusions;
mod ranking_pairs;
mod ranking_scale;
mod rating;
mod variance;
mod write;

use std::path::Path;

pub(super) use draw::scatter;
pub(super) use judgement::said as judged;
pub use map_chance::RandomData;
pub use model::{Analysis, Cell, Column, Drawn, Section, Table};
pub(super) use odd_one_out::{triad as triad_answer, weights as grade_weights};
pub(super) use ranking::ranking as rank_trial;

use super::ExperimentError;
use super::design::Method;
use super::session::{self, Found, Unread};
use kept::Experiment;
use selvedge_foundation::progress::Progress;
use selvedge_statistics::Resampling;
use selvedge_textile::BuildCache;

/// The key of the section that lists logs that cannot be read.
pub const UNREAD: &str = "unread";

/// Choices that the logs leave open.
#[derive(Debug, Clone)]
pub struct Options {
    /// What chance begins with.
    pub seed: u64,
    /// Resamples of subjects for intervals, at least 100.
    pub n_resamples: usize,
    /// Permutations for p values.
    pub n_permutations: usize,
    /// Maps of resampled subjects, from which ellipses follow; 0 for none.
    pub n_maps: usize,
    /// Starts of a map in two dimensions and more.
    pub n_starts: usize,
    /// Starts of a map on a line.
    pub n_starts_on_a_line: usize,
    /// Sets of random ranks to compare the stress of maps with; 0 for none.
    pub n_random_data: usize,
    /// What was found of them before.
    pub random_data: RandomData,
    /// Where textiles that are built from recipes are kept.
    pub cache: Option<BuildCache>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            n_resamples: 2000,
            n_permutations: 4999,
            n_maps: 100,
            n_starts: 50,
            n_starts_on_a_line: 1000,
            n_random_data: 40,
            random_data: RandomData::default(),
            cache: None,
        }
    }
}

impl Options {
    fn resampling(&self) -> Resampling {
        Resampling {
            n_resamples: self.n_resamples.max(100),
            seed: self.seed,
            level: 0.95,
        }
    }
}

/// Analyses every session in a folder. A log that cannot be read, since a later version wrote it or
/// it was damaged, is listed with its reason, and the others are analysed.
///
/// # Errors
/// The folder or all of its logs cannot be read, there are no sessions, or it was cancelled.
pub fn analyse_folder(
    folder: &Path,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Analysis, ExperimentError> {
    let (found, unread) = sessions(folder)?;
    analyse_with_unread(&found, &unread, options, progress)
}

/// The sessions of a folder, and its logs that cannot be read.
///
/// # Errors
/// The folder or all of its logs cannot be read, or there are no sessions.
pub fn sessions(folder: &Path) -> Result<(Vec<Found>, Vec<Unread>), ExperimentError> {
    let (found, unread) = session::find_readable(folder)?;
    if !found.is_empty() {
        return Ok((found, unread));
    }
    let none = || {
        ExperimentError::value(
            format!("{} holds no session", folder.display()),
            "name a folder with logs and the .json file beside each of them",
        )
    };
    let first = unread.into_iter().next();
    Err(first.map_or_else(none, |first| first.error))
}

/// Likewise, of sessions that were found beside logs that cannot be read.
///
/// # Errors
/// It was cancelled.
pub fn analyse_with_unread(
    found: &[Found],
    unread: &[Unread],
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Analysis, ExperimentError> {
    let mut analysis = analyse(found, options, progress)?;
    if !unread.is_empty() {
        analysis.sections.insert(0, left_out(unread));
    }
    Ok(analysis)
}

/// The logs that cannot be read.
fn left_out(unread: &[Unread]) -> Section {
    let mut section = Section::new(UNREAD, "Logs that cannot be read");
    section.note("**These logs are left out of everything below.** The others are analysed.");
    let columns = [("log", "log"), ("why", "why, and how to mend it")];
    let mut table = Table::new("logs", "Logs left out", &columns);
    for one in unread {
        let name = one.log.file_name().unwrap_or_default().to_string_lossy();
        table.push([name.into_owned().into(), one.error.to_string().into()]);
    }
    section.tables.push(table);
    section
}

/// Analyses sessions, experiment by experiment.
///
/// # Errors
/// It was cancelled. What cannot be computed is said in the analysis.
pub fn analyse(
    found: &[Found],
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Analysis, ExperimentError> {
    let experiments = kept::experiments(found);
    let mut sections = Vec::new();
    for experiment in &experiments {
        sections.push(experiment.sessions_section());
        if experiment.subjects.is_empty() {
            let mut empty = Section::new(experiment.key("empty"), experiment.design.title.clone());
            empty.note("No trial is left to analyse.");
            sections.push(empty);
            continue;
        }
        sections.extend(sections_of(experiment, options, progress)?);
    }
    sections.extend(groups::compared(&experiments));
    let titles: Vec<&str> = experiments
        .iter()
        .map(|e| e.design.title.as_str())
        .collect();
    Ok(Analysis {
        title: titles.join(" · "),
        sections,
    })
}

fn sections_of(
    experiment: &Experiment<'_>,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, selvedge_foundation::progress::Cancelled> {
    match &experiment.design.method {
        Method::Ranking(ranking) => ranking::sections(experiment, *ranking, options, progress),
        Method::OddOneOut(choosing) => {
            odd_one_out::sections(experiment, choosing.weights, options, progress)
        }
        Method::Adjustment(adjusting) => {
            adjustment::sections(experiment, adjusting, options, progress)
        }
        Method::Judgement(judging) => Ok(judgement::sections(experiment, judging, options)),
        Method::Levels(levels) => Ok(levels::sections(experiment, levels, options)),
        Method::Magnitude { .. } => Ok(magnitude::sections(experiment)),
        Method::Rating(rating) => rating::sections(experiment, rating, options, progress),
    }
}

#[cfg(test)]
mod tests;
