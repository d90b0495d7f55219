//! The work: sessions of a folder, those under way left out, their analysis, what a reader must
//! know before looking at it, and what is taken along of it.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs::Metadata;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet};
use crate::bench::session::title_of;
use crate::tools::analysis::asked::Asked;
use selvedge_experiment::analysis::{Analysis, Cell, Drawn, Table, sessions};
use selvedge_experiment::design::Source;
use selvedge_experiment::session::Found;
use selvedge_foundation::progress::Progress;
use selvedge_textile::{id_in, is_of_the_program};

/// The library of designs that name none.
pub(crate) const SHIPPED: &str = "sixteen";

/// What was found, and of what.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Findings {
    /// What was asked for.
    pub asked: Asked,
    /// What was found.
    pub analysis: Analysis,
    /// Sessions that were read.
    pub n_sessions: usize,
    /// Who was left out, since a session of theirs is being held.
    pub left_out: Vec<String>,
    /// What a reader must know before looking at any p value.
    pub warnings: Vec<String>,
    /// Names of stimuli and materials, and by which ids a scene finds their textiles.
    pub(crate) textiles: BTreeMap<String, String>,
    /// What the folder held when it was read.
    pub(crate) stamp: u64,
}

impl Findings {
    /// Where a report goes unless another folder is chosen.
    pub(crate) fn report_folder(&self) -> PathBuf {
        self.asked.folder.join("analysis")
    }

    /// Writes tables, figures and the page to read into a folder; says where. Beside the logs a
    /// table would be taken for one: there it is a folder within.
    pub(crate) fn write(&self, folder: PathBuf) -> Result<PathBuf, String> {
        let same = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let folder = if same(&folder) == same(&self.asked.folder) {
            self.report_folder()
        } else {
            folder
        };
        let written = self.analysis.write(&folder);
        written.map_err(|error| error.to_string())?;
        Ok(folder)
    }

    /// A figure as it would stand in the report, and the points that it is drawn from.
    pub(crate) fn exported(&self, drawn: &Drawn) -> Exported {
        let program = selvedge_foundation::PROGRAM;
        let options = self.asked.options();
        let origin = Origin::default()
            .and("program", program, "")
            .and("analysed", &self.analysis.title, "")
            .and("sessions", &self.n_sessions.to_string(), "")
            .and("seed", &options.seed.to_string(), "")
            .and("resamples", &options.n_resamples.to_string(), "")
            .and("permutations", &options.n_permutations.to_string(), "");
        Exported {
            sheet: sheet(&drawn.points),
            figure: drawn.figure.clone(),
            origin,
        }
    }
}

/// Reads the sessions of a folder and analyses them. `active` is the log of the session that is
/// active in this window.
///
/// # Errors
/// One line: there is no such folder, it holds no session that can be read, or it was stopped.
pub(crate) fn find_out(
    asked: Asked,
    active: Option<&Path>,
    progress: &mut Progress<'_>,
) -> Result<Findings, String> {
    let folder = &asked.folder;
    if !folder.is_dir() {
        let folder = folder.display();
        return Err(format!("there is no folder {folder}; check the path"));
    }
    let stamp = stamp_of(folder);
    let (mut found, unread) = sessions(folder, progress).map_err(|error| error.to_string())?;
    let left_out = if asked.choice.with_active {
        Vec::new()
    } else {
        leave_out(&mut found, active)
    };
    if found.is_empty() {
        return Err(format!(
            "nobody but {} is in the folder, and that session is still being held; analyse it \
             once it is over",
            left_out.join(", ")
        ));
    }
    let analysis = Analysis::with_unread(&found, &unread, &asked.options(), progress)
        .map_err(|error| error.to_string())?;
    Ok(Findings {
        analysis,
        n_sessions: found.len(),
        warnings: interim(&found),
        textiles: textiles(&found),
        stamp,
        left_out,
        asked,
    })
}

/// What a folder holds, as a number: names, sizes and times of its logs and what lies beside them.
pub(crate) fn stamp_of(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<(OsString, u64, Option<SystemTime>)> = entries
        .filter_map(|entry| {
            let about = entry.metadata().ok().filter(Metadata::is_file)?;
            Some((entry.file_name(), about.len(), about.modified().ok()))
        })
        .collect();
    files.sort();
    let mut hasher = DefaultHasher::new();
    files.hash(&mut hasher);
    hasher.finish()
}

/// The textiles of all designs, as far as a scene finds them whatever its own library is.
fn textiles(found: &[Found]) -> BTreeMap<String, String> {
    let mut textiles = BTreeMap::new();
    for design in found.iter().map(|one| &one.design) {
        let library = match design.library.as_deref() {
            Some(library) if is_of_the_program(library) || library.is_absolute() => library,
            Some(_) => continue,
            None => Path::new(SHIPPED),
        };
        for stimulus in &design.stimuli {
            if let Source::Textile { id, .. } = &stimulus.source {
                for name in [&stimulus.id, &stimulus.material] {
                    let key = || id_in(library, id);
                    textiles.entry(name.clone()).or_insert_with(key);
                }
            }
        }
    }
    textiles
}

/// Leaves out every session of whoever takes part in one that is being held; says who that is.
fn leave_out(found: &mut Vec<Found>, active: Option<&Path>) -> Vec<String> {
    let is_held = |one: &&Found| active == Some(one.log.as_path()) || one.is_held();
    let who = |one: &Found| (one.design.study.clone(), one.subject.pseudonym.clone());
    let held: BTreeSet<(String, String)> = found.iter().filter(is_held).map(who).collect();
    found.retain(|one| !held.contains(&who(one)));
    held.into_iter().map(|(_, pseudonym)| pseudonym).collect()
}

/// What is to be said of experiments with fewer subjects than their designs plan.
fn interim(found: &[Found]) -> Vec<String> {
    let mut subjects: BTreeMap<(&str, &str, &str), (&Found, BTreeSet<&str>)> = BTreeMap::new();
    for one in found {
        let design = &one.design;
        let key = (&*design.study, &*design.experiment, &*design.hash);
        let of_design = subjects
            .entry(key)
            .or_insert_with(|| (one, BTreeSet::new()));
        of_design.1.insert(&one.subject.pseudonym);
    }
    let described = |(one, subjects): &(&Found, BTreeSet<&str>)| {
        let (n, n_planned) = (subjects.len(), one.design.rules.subjects);
        let title = title_of(&one.design);
        (n < n_planned).then(|| {
            format!(
                "{title}: {n} of {n_planned} planned subjects. Whoever looks at p values now and \
                 goes on afterwards makes them invalid."
            )
        })
    };
    subjects.values().filter_map(described).collect()
}

/// The same table by its columns; a cell is empty where there is no number.
fn sheet(table: &Table) -> Sheet {
    let mut sheet = Sheet::default();
    for (at, column) in table.columns.iter().enumerate() {
        let cells: Vec<&Cell> = table.rows.iter().filter_map(|row| row.get(at)).collect();
        let has_words = cells.iter().any(|cell| matches!(cell, Cell::Text(_)));
        let name = column.name.clone();
        sheet = if has_words {
            let words: Vec<String> = cells.into_iter().map(word).collect();
            sheet.with(name, words)
        } else {
            let number = |cell: &Cell| cell.number().unwrap_or(f64::NAN);
            let numbers: Vec<f64> = cells.into_iter().map(number).collect();
            sheet.with(name, numbers)
        };
    }
    sheet
}

fn word(cell: &Cell) -> String {
    match cell {
        Cell::Number(value) => value.to_string(),
        Cell::Text(text) => text.clone(),
        Cell::Undefined(_) => String::new(),
    }
}
