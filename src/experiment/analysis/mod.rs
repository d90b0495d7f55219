//! What the logs of an experiment say: tables, tests, maps and the papers' figures.
//!
//! ```text
//! sessions ─▶ included trials (rules of the design) ─▶ by method ─▶ Analysis ─┬▶ files
//!                                                                  └▶ a pane
//! ```
//!
//! # Invariants
//! - what is left out is listed with its reason, before anything is counted
//! - a number that cannot be computed is a reason, in every file
//! - the same logs and options give the same bytes

mod adjustment;
mod answers;
mod choices;
mod dissimilarities;
mod draw;
mod draw_map;
mod first_page;
mod groups;
mod included_trials;
mod judgement;
mod judgement_cells;
mod judgement_confidence;
mod judgement_pairs;
mod judgement_power;
mod levels;
mod levels_series;
mod magnitude;
mod map;
mod map_speeds;
mod map_turn;
mod model;
mod odd_one_out;
mod odd_one_out_craven;
mod odd_one_out_variants;
mod one_page;
mod options;
mod orders;
mod own_speeds;
mod pairs;
mod properties;
mod random_data;
mod ranking;
mod ranking_confusions;
mod ranking_scale;
mod rating;
mod tables;
mod variance;
mod what_counts;
mod write;

use std::path::Path;

pub(super) use answers::{rank_trial, triad_answer};
pub(super) use draw::{Bar, bars, scatter};
pub(super) use draw_map::MapDrawing;
pub(super) use judgement_cells::called_real;
pub use model::{Analysis, Cell, Column, Drawn, Section, Table};
pub(crate) use model::{Cells, cells, known, or_undefined, percent_of};
pub(super) use odd_one_out::grade_weights;
pub use one_page::OnePage;
pub use options::Options;
pub use random_data::RandomData;

use super::ExperimentError;
use super::design::Kind;
use super::session::{Found, Unread};
use first_page::first_page;
use included_trials::Experiment;
use selvedge_foundation::progress::Progress;
use what_counts::describe_proof;

/// The key of the section that lists logs that cannot be read.
pub const UNREAD: &str = "unread";

impl Analysis {
    /// Analyses every session in a folder. A log that cannot be read, since a later version wrote
    /// it or it was damaged, is listed with its reason, and the others are analysed.
    ///
    /// # Errors
    /// The folder or all of its logs cannot be read, there are no sessions, or it was cancelled.
    pub fn of_folder(
        folder: &Path,
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let (found, unread) = sessions(folder, progress)?;
        Self::with_unread(&found, &unread, options, progress)
    }
}

/// The sessions of a folder with everything that is not as it was written, and its logs that cannot
/// be read.
///
/// # Errors
/// The folder or all of its logs cannot be read, there are no sessions, or it was cancelled.
pub fn sessions(
    folder: &Path,
    progress: &mut Progress<'_>,
) -> Result<(Vec<Found>, Vec<Unread>), ExperimentError> {
    let (mut found, unread) = Found::in_folder(folder)?;
    if !found.is_empty() {
        Found::verify_stimuli(&mut found, progress)?;
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

impl Analysis {
    /// Likewise, of sessions that were found beside logs that cannot be read.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn with_unread(
        found: &[Found],
        unread: &[Unread],
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let mut analysis = Self::of(found, options, progress)?;
        if !unread.is_empty() {
            analysis.sections.insert(0, left_out(unread));
        }
        Ok(analysis)
    }
}

/// The logs that cannot be read.
fn left_out(unread: &[Unread]) -> Section {
    let mut section = Section::new(UNREAD, "Logs that cannot be read");
    section.note("**These logs are left out of everything below.** The others are analysed.");
    let columns = "log; why: why, and how to mend it";
    let mut table = Table::new("logs", "Logs left out", columns);
    for one in unread {
        let name = one.log.file_name().unwrap_or_default().to_string_lossy();
        table.push(cells![name.into_owned(), one.error.to_string()]);
    }
    section.table(table);
    section
}

impl Analysis {
    /// Analyses sessions, experiment by experiment.
    ///
    /// # Errors
    /// It was cancelled. What cannot be computed is said in the analysis.
    pub fn of(
        found: &[Found],
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let experiments = included_trials::experiments(found);
        let mut sections = Vec::new();
        for experiment in &experiments {
            if experiment.subjects.is_empty() {
                sections.push(experiment.sessions_section());
                let mut empty =
                    Section::new(experiment.key("empty"), experiment.design.title.clone());
                describe_proof(&experiment.sessions, &mut empty);
                empty.note("No trial is left to analyse.");
                sections.push(empty);
                continue;
            }
            let mut found = sections_of(experiment, options, progress)?;
            sections.push(first_page(experiment, &mut found));
            sections.push(experiment.sessions_section());
            sections.extend(found);
        }
        sections.extend(groups::compared(&experiments));
        let titles: Vec<&str> = experiments
            .iter()
            .map(|e| e.design.title.as_str())
            .collect();
        Ok(Self {
            title: titles.join(" · "),
            sections,
        })
    }
}

fn sections_of(
    experiment: &Experiment<'_>,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, selvedge_foundation::progress::Cancelled> {
    let composition = &experiment.design.composition;
    match (composition.kind(), &composition.adaptation) {
        (Kind::Ranking, _) => ranking::sections(experiment, options, progress),
        (Kind::OddOneOut, _) => odd_one_out::sections(experiment, options, progress),
        (Kind::Adjustment, _) => adjustment::sections(experiment, options, progress),
        (Kind::Judgement, _) => Ok(judgement::sections(experiment, options)),
        (Kind::Levels | Kind::Equality, Some(adapted)) => {
            Ok(levels::sections(experiment, adapted, options))
        }
        (Kind::Magnitude, _) => Ok(magnitude::sections(experiment)),
        (Kind::Rating, _) => rating::sections(experiment, options, progress),
        (Kind::Choice, _) => Ok(choices::sections(experiment, options)),
        (Kind::Orders | Kind::Preference, _) => Ok(orders::sections(experiment, options)),
        (Kind::Dissimilarity | Kind::Sorting, _) => {
            dissimilarities::sections(experiment, options, progress)
        }
        (Kind::Levels | Kind::Equality, None) => Ok(Vec::new()),
    }
}

#[cfg(test)]
mod tests;
