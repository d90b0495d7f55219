//! What was measured of the textiles of a design: levels at the speed of reference and at the
//! speeds that subjects moved at, anisotropy, spatial variation, and the figures of their
//! manifests.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::included_trials::Experiment;
use super::model::{Cell, Column, Section, Table, cells};
use super::options::Options;
use super::own_speeds::{self, MOVING_MM_PER_S, OwnSpeeds};
use crate::design::Source;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_foundation::quantity::level_db;
use selvedge_textile::tactile::{Filters, LEVEL_SPEED_MM_PER_S, Levels};
use selvedge_textile::{Library, Textile, TextileError};

/// A measure of every stimulus, in the order of the design.
#[derive(Debug, Clone)]
pub(super) struct Measure {
    /// Its name in files.
    pub(super) name: String,
    /// Its name for people, with its unit.
    pub(super) heading: String,
    pub(super) values: Vec<f64>,
}

/// A subject, and what was measured at their speeds.
#[derive(Debug, Clone)]
pub(super) struct Own {
    pub(super) subject: String,
    pub(super) n_trials: usize,
    /// `None` without a recorded path that moves.
    pub(super) moved: Option<(OwnSpeeds, Vec<Measure>)>,
}

impl Own {
    fn measures(&self) -> Option<&Vec<Measure>> {
        self.moved.as_ref().map(|(_, measures)| measures)
    }
}

/// The measures of the stimuli of an experiment, or why there are none.
#[derive(Debug, Default)]
pub(super) struct Measures {
    pub(super) all: Vec<Measure>,
    /// Subject by subject; empty where no path was recorded at all.
    pub(super) own: Vec<Own>,
    pub(super) notes: Vec<String>,
}

impl Measures {
    pub(super) fn named(&self, name: &str) -> Option<&Measure> {
        self.all.iter().find(|measure| measure.name == name)
    }

    /// Of the stimuli of a design, all of which must be textiles.
    ///
    /// # Errors
    /// It was cancelled.
    pub(super) fn of(
        experiment: &Experiment<'_>,
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let mut measures = Self::default();
        let ids = match textile_ids(experiment) {
            Ok(ids) => ids,
            Err(note) => {
                measures.notes.push(note);
                return Ok(measures);
            }
        };
        progress.step(0.0, "reading textiles")?;
        let loaded = library(experiment, options).and_then(|library| {
            let load = |id: &String| library.load(id);
            ids.iter().map(load).collect::<Result<Vec<_>, _>>()
        });
        let textiles = match loaded {
            Ok(textiles) => textiles,
            Err(error) => {
                measures
                    .notes
                    .push(format!("No physical measures: {error}"));
                return Ok(measures);
            }
        };
        progress.step(0.5, "levels of textiles")?;
        let at_reference: Vec<Levels> = textiles
            .iter()
            .map(|t| Levels::of(t.surface(), &Filters::default()))
            .collect();
        measures.add(of_levels(&at_reference), "", "");
        measures.add_own_speeds(experiment, &textiles, progress)?;
        let tables: Vec<&BTreeMap<String, f64>> =
            textiles.iter().map(|t| &t.manifest().measured).collect();
        measures.add_manifests(&tables);
        Ok(measures)
    }

    /// Measures that are defined for every textile; others are told.
    fn add(&mut self, measures: Vec<Measure>, suffix: &str, heading: &str) {
        for measure in measures {
            let described = format!("{}{heading}", measure.heading);
            if measure.values.iter().all(|v| v.is_finite()) {
                self.all.push(Measure {
                    name: format!("{}{suffix}", measure.name),
                    heading: described,
                    values: measure.values,
                });
            } else {
                let note = format!("{described}: a textile is silent, so it is left out.");
                self.notes.push(note);
            }
        }
    }

    /// Measures at the speeds of each subject, and their means over subjects.
    fn add_own_speeds(
        &mut self,
        experiment: &Experiment<'_>,
        textiles: &[Arc<Textile>],
        progress: &mut Progress<'_>,
    ) -> Result<(), Cancelled> {
        let speeds = own_speeds::speeds(experiment, progress)?;
        if speeds.iter().all(Option::is_none) {
            self.notes.push(
                "No recorded paths beside the logs: measures at subjects' own speeds are left out."
                    .to_owned(),
            );
            return Ok(());
        }
        let levels = own_speeds::levels(&speeds, textiles, progress)?;
        let subjects = experiment.subjects.iter().zip(speeds).zip(levels);
        self.own = subjects
            .map(|((subject, speeds), levels)| Own {
                subject: subject.name.to_owned(),
                n_trials: subject.trials().count(),
                moved: speeds.zip(levels.map(|levels| of_levels(&levels))),
            })
            .collect();
        let moved: Vec<&Vec<Measure>> = self.own.iter().filter_map(Own::measures).collect();
        let means = over_subjects(&moved);
        let n = moved.len();
        self.add(
            means,
            "_own_speed",
            &format!(" at own speeds, mean of {n} subjects"),
        );
        Ok(())
    }

    /// Figures that every manifest has.
    fn add_manifests(&mut self, tables: &[&BTreeMap<String, f64>]) {
        let Some(first) = tables.first() else {
            return;
        };
        for name in first.keys() {
            let values: Option<Vec<f64>> = tables.iter().map(|t| t.get(name).copied()).collect();
            if let Some(values) = values {
                self.all.push(Measure {
                    name: format!("measured_{name}"),
                    heading: format!("{name} (measured)"),
                    values,
                });
            }
        }
    }

    /// All of them, a row a stimulus.
    pub(super) fn table(&self, names: &[String]) -> Table {
        let mut table = Table::new("measures", "Physical measures", "item: textile");
        let own = self.all.iter().map(|m| Column::new(&m.name, &m.heading));
        table.columns.extend(own);
        for (i, name) in names.iter().enumerate() {
            let values: Vec<Cell> = self.all.iter().map(|m| m.values[i].into()).collect();
            table.push(cells![name, values]);
        }
        table
    }

    pub(super) fn describe(&self, section: &mut Section) {
        section.notes.extend(self.notes.iter().cloned());
        if !self.all.is_empty() {
            section.note(format!(
                "Levels are means over four directions at {LEVEL_SPEED_MM_PER_S} mm/s, before any \
                 tuning."
            ));
        }
        if !self.own.is_empty() {
            section.note(format!(
                "At own speeds: what each subject felt on the mean over all recorded time in which \
                 the display moved faster than {MOVING_MM_PER_S} mm/s, along one axis and over \
                 four directions as above; for the group, the mean over subjects."
            ));
        }
    }
}

fn textile_ids(experiment: &Experiment<'_>) -> Result<Vec<String>, String> {
    let id = |stimulus: &crate::design::Stimulus| match &stimulus.source {
        Source::Textile { id, .. } => Ok(id.clone()),
        Source::RealCloth(_) | Source::Vibration { .. } => Err(format!(
            "No physical measures: {} is no textile of a library.",
            stimulus.id
        )),
    };
    experiment.design.stimuli.iter().map(id).collect()
}

/// The library of a design, sought beside the logs.
fn library(experiment: &Experiment<'_>, options: &Options) -> Result<Library, TextileError> {
    let first = experiment.sessions.first();
    let beside = first.and_then(|found| found.log.parent());
    let folder = beside.unwrap_or_else(|| Path::new("."));
    (experiment.design).open_library(folder, options.cache.as_ref())
}

/// What follows from levels.
fn of_levels(levels: &[Levels]) -> Vec<Measure> {
    let of = |f: &dyn Fn(&Levels) -> f64| levels.iter().map(f).collect::<Vec<f64>>();
    let um = [0, 1].map(|b| of(&|l| l.mean_um[b]));
    let db = um
        .each_ref()
        .map(|um| um.iter().map(|a| level_db(*a)).collect::<Vec<f64>>());
    let [z40, z320] = db.each_ref().map(|db| standardised(db));
    let both = |sign: f64| z40.iter().zip(&z320).map(|(a, b)| a + sign * b).collect();
    let of_both = of(&|l| l.level_db().unwrap_or(f64::NAN));
    let [cv40, cv320] = [0, 1].map(|b| of(&|l| l.cv[b]));
    let [anisotropy40, anisotropy320] = [0, 1].map(|b| of(&|l| l.anisotropy_db[b]));
    let difference = "difference of standardised levels (40 − 320 Hz)";
    let [db40, db320] = db;
    let [um40, um320] = um;
    let all = [
        ("a40_db", "A40, dB re 1 µm", db40),
        ("a320_db", "A320, dB re 1 µm", db320),
        ("level_db", "level of both bands, dB re 1 µm", of_both),
        ("a40_um", "A40, µm", um40),
        ("a320_um", "A320, µm", um320),
        ("sum", "sum of standardised levels", both(1.0)),
        ("difference", difference, both(-1.0)),
        ("cv40", "spatial variation of A40", cv40),
        ("cv320", "spatial variation of A320", cv320),
        ("anisotropy40_db", "anisotropy of A40, dB", anisotropy40),
        ("anisotropy320_db", "anisotropy of A320, dB", anisotropy320),
    ];
    let measure = |(name, heading, values): (&str, &str, Vec<f64>)| Measure {
        name: name.to_owned(),
        heading: heading.to_owned(),
        values,
    };
    all.map(measure).into()
}

/// The mean of each measure over subjects, who have the same ones.
fn over_subjects(all: &[&Vec<Measure>]) -> Vec<Measure> {
    let Some((first, others)) = all.split_first() else {
        return Vec::new();
    };
    let mut means: Vec<Measure> = (*first).clone();
    for (at, mean) in means.iter_mut().enumerate() {
        for (item, value) in mean.values.iter_mut().enumerate() {
            let sum: f64 = others.iter().map(|own| own[at].values[item]).sum();
            *value = (*value + sum) / all.len() as f64;
        }
    }
    means
}

/// Centred, with a standard deviation of 1; all 0 without spread.
fn standardised(values: &[f64]) -> Vec<f64> {
    let summary = selvedge_statistics::Summary::of(values);
    let of = |v: &f64| match &summary {
        Ok(s) if s.sd > 0.0 => (v - s.mean) / s.sd,
        _ => 0.0,
    };
    values.iter().map(of).collect()
}
