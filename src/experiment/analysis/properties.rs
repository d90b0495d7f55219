//! What was measured of the textiles of a design: levels at the speed of reference and at the
//! speeds
//! that subjects moved at, anisotropy, spatial variation, and the figures of their manifests.

use std::collections::BTreeMap;
use std::path::Path;

use super::Options;
use super::kept::Experiment;
use super::model::{Cell, Section, Table};
use crate::experiment::design::Source;
use crate::experiment::session::path_file;
use crate::progress::{Cancelled, Progress};
use crate::quantity::level_db;
use crate::scene::ExplorationPath;
use crate::tactile::{Filters, LEVEL_SPEED_MM_PER_S, Levels};
use crate::textile::{Library, TextileError};

/// A measure of every stimulus, in the order of the design.
#[derive(Debug, Clone)]
pub(super) struct Measure {
    /// Its name in files.
    pub(super) name: String,
    /// Its name for people, with its unit.
    pub(super) heading: String,
    pub(super) values: Vec<f64>,
}

/// The measures of the stimuli of an experiment, or why there are none.
#[derive(Debug, Default)]
pub(super) struct Measures {
    pub(super) all: Vec<Measure>,
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
        let at = |speed: f64| -> Vec<Levels> {
            let of = |t: &std::sync::Arc<crate::textile::Textile>| {
                Levels::at(speed, t.surface(), &Filters::default())
            };
            textiles.iter().map(of).collect()
        };
        measures.add_levels(&at(LEVEL_SPEED_MM_PER_S), "", "");
        if let Some(speed) = own_speed(experiment) {
            let heading = format!(" at {speed:.0} mm/s, the subjects' own");
            measures.add_levels(&at(speed), "_own_speed", &heading);
        } else {
            measures.notes.push(
                "No recorded paths beside the logs: measures at subjects' own speeds are left out."
                    .to_owned(),
            );
        }
        let tables: Vec<&BTreeMap<String, f64>> =
            textiles.iter().map(|t| &t.manifest().measured).collect();
        measures.add_manifests(&tables);
        Ok(measures)
    }

    fn add_levels(&mut self, levels: &[Levels], suffix: &str, heading: &str) {
        let um: [Vec<f64>; 2] = [0, 1].map(|b| levels.iter().map(|l| l.mean_um[b]).collect());
        let db = um
            .each_ref()
            .map(|um| um.iter().map(|a| level_db(*a)).collect::<Vec<f64>>());
        let of = |f: &dyn Fn(&Levels) -> f64| levels.iter().map(f).collect::<Vec<f64>>();
        let standard = db.each_ref().map(|db| standardised(db));
        let mut add = |name: &str, told: &str, values: Vec<f64>| {
            if values.iter().all(|v| v.is_finite()) {
                self.all.push(Measure {
                    name: format!("{name}{suffix}"),
                    heading: format!("{told}{heading}"),
                    values,
                });
            } else {
                let note = format!("{told}{heading}: a textile is silent, so it is left out.");
                self.notes.push(note);
            }
        };
        let [db40, db320] = db;
        add("a40_db", "A40, dB re 1 µm", db40);
        add("a320_db", "A320, dB re 1 µm", db320);
        let level = |l: &Levels| l.level_db().unwrap_or(f64::NAN);
        add("level_db", "level of both bands, dB re 1 µm", of(&level));
        let [um40, um320] = um;
        add("a40_um", "A40, µm", um40);
        add("a320_um", "A320, µm", um320);
        let [z40, z320] = standard;
        let both = |sign: f64| z40.iter().zip(&z320).map(|(a, b)| a + sign * b).collect();
        add("sum", "sum of standardised levels", both(1.0));
        add(
            "difference",
            "difference of standardised levels (40 − 320 Hz)",
            both(-1.0),
        );
        add("cv40", "spatial variation of A40", of(&|l| l.cv[0]));
        add("cv320", "spatial variation of A320", of(&|l| l.cv[1]));
        add(
            "anisotropy40_db",
            "anisotropy of A40, dB",
            of(&|l| l.anisotropy_db[0]),
        );
        add(
            "anisotropy320_db",
            "anisotropy of A320, dB",
            of(&|l| l.anisotropy_db[1]),
        );
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
        let mut columns = vec![("item", "textile")];
        columns.extend(
            self.all
                .iter()
                .map(|m| (m.name.as_str(), m.heading.as_str())),
        );
        let mut table = Table::new("measures", "Physical measures", &columns);
        for (i, name) in names.iter().enumerate() {
            let mut row = vec![Cell::from(name.as_str())];
            row.extend(self.all.iter().map(|m| Cell::from(m.values[i])));
            table.push(row);
        }
        table
    }

    pub(super) fn tell(&self, section: &mut Section) {
        section.notes.extend(self.notes.iter().cloned());
        if !self.all.is_empty() {
            section.note(format!(
                "Levels are means over four directions at {LEVEL_SPEED_MM_PER_S} mm/s, before any \
                 tuning."
            ));
        }
    }
}

fn textile_ids(experiment: &Experiment<'_>) -> Result<Vec<String>, String> {
    let id = |stimulus: &crate::experiment::design::Stimulus| match &stimulus.source {
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
    let Some(name) = &experiment.design.library else {
        return Library::shipped();
    };
    if crate::textile::is_of_the_program(name) {
        return Library::named(name, options.cache.as_ref());
    }
    let beside = experiment
        .sessions
        .first()
        .and_then(|found| found.log.parent());
    let path = beside.unwrap_or_else(|| Path::new(".")).join(name);
    Library::named(&path, options.cache.as_ref())
}

/// The mean speed of movement over all recorded trials, mm/s: pauses left out, subjects alike.
fn own_speed(experiment: &Experiment<'_>) -> Option<f64> {
    let speed_of = |subject: &super::kept::Subject<'_>| {
        let paths = subject.sessions.iter().flat_map(|session| {
            let log = &session.found.log;
            let read = |r: &crate::experiment::Record| {
                ExplorationPath::read(&path_file(log, &r.trial, r.attempt)).ok()
            };
            session.trials.iter().filter_map(move |record| read(record))
        });
        let (mut way_mm, mut time_s) = (0.0, 0.0);
        for path in paths {
            for pair in path.rows().windows(2) {
                let [from, to] = [pair[0].position, pair[1].position];
                let step_mm = (to.x_mm - from.x_mm).hypot(to.y_mm - from.y_mm);
                let step_s = pair[1].t_s - pair[0].t_s;
                if step_mm > step_s {
                    way_mm += step_mm;
                    time_s += step_s;
                }
            }
        }
        (time_s > 0.0).then(|| way_mm / time_s)
    };
    let speeds: Vec<f64> = experiment.subjects.iter().filter_map(speed_of).collect();
    crate::statistics::mean(&speeds).ok()
}

/// Centred, with a standard deviation of 1; all 0 without spread.
fn standardised(values: &[f64]) -> Vec<f64> {
    let summary = crate::statistics::Summary::of(values);
    let of = |v: &f64| match &summary {
        Ok(s) if s.sd > 0.0 => (v - s.mean) / s.sd,
        _ => 0.0,
    };
    values.iter().map(of).collect()
}
