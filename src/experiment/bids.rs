//! Sessions as a data set after BIDS (behavioural, version 1.10.0): events by session, units and
//! levels beside them, and two scripts that make the main table once more from the events.
//!
//! ```text
//! dataset_description.json  participants.tsv  participants.json  README
//! sub-p01/ses-1/beh/sub-p01_ses-1_task-EXPERIMENT_events.tsv, .json
//! code/main-table.tsv  main-table.json  main_table.py  main_table.R
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Serialize;

use crate::design::Design;
use crate::record::{ColumnDescription, described_columns};
use crate::session::{Found, make_folder};
use crate::{ExperimentError, Participants};
use selvedge_foundation::files::{FileError, to_json_string, write_atomic};

/// The version of BIDS.
const BIDS_VERSION: &str = "1.10.0";
/// What stands for no value.
const NOTHING: &str = "n/a";
const PYTHON: &str = include_str!("../../assets/bids/main_table.py");
const R: &str = include_str!("../../assets/bids/main_table.R");

#[derive(Serialize)]
struct Dataset<'a> {
    #[serde(rename = "Name")]
    name: &'a str,
    #[serde(rename = "BIDSVersion")]
    version: &'a str,
    #[serde(rename = "DatasetType")]
    kind: &'a str,
    #[serde(rename = "GeneratedBy")]
    by: [BTreeMap<&'a str, &'a str>; 1],
}

/// A column as a JSON file beside its table describes it.
#[derive(Serialize)]
struct Described {
    #[serde(rename = "Description")]
    description: String,
    #[serde(rename = "Units", skip_serializing_if = "String::is_empty")]
    units: String,
    #[serde(rename = "Levels", skip_serializing_if = "BTreeMap::is_empty")]
    levels: BTreeMap<String, String>,
}

impl Described {
    /// Without levels; a unit where it is not empty.
    fn plain(description: &str, unit: &str) -> Self {
        Self {
            description: description.to_owned(),
            units: unit.to_owned(),
            levels: BTreeMap::new(),
        }
    }
}

/// What is averaged by subject, and apart for each of what.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
struct MainValue {
    task: String,
    value: String,
    by: String,
    is_geometric: bool,
}

#[derive(Serialize)]
struct MainValues<'a> {
    tables: Vec<&'a MainValue>,
}

/// Values of the main table by what is averaged, subject and group.
type Cells = BTreeMap<(MainValue, String, String), Vec<f64>>;

/// Writes a data set into a folder, which must be empty or missing. Sessions whose files are not as
/// they were written are left out.
///
/// # Errors
/// The folder is not empty, two names are one without their marks, or a file cannot be written.
pub fn write_bids(
    found: &[Found],
    participants: &Participants,
    out: &Path,
) -> Result<(), ExperimentError> {
    make_folder(out)?;
    let is_empty = std::fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_none());
    if !is_empty {
        let mend = "name a new folder for the data set";
        return Err(FileError::whole(out, "the folder is not empty", mend).into());
    }
    let sessions: Vec<&Found> = found.iter().filter(|one| one.breaks.is_empty()).collect();
    check_labels(&sessions, out)?;
    let mut cells = Cells::new();
    for session in &sessions {
        write_session(session, out, &mut cells)?;
    }
    write_participants(&sessions, participants, out)?;
    write_main_table(&cells, &out.join("code"))?;
    write_dataset(&sessions, out)
}

/// A name as BIDS allows it: letters and digits.
fn label(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).collect()
}

/// Two names that differ by their marks alone would be one file.
fn check_labels(sessions: &[&Found], out: &Path) -> Result<(), FileError> {
    let mut seen: BTreeMap<(&str, String), &str> = BTreeMap::new();
    for session in sessions {
        let named = [
            ("participants", session.subject.pseudonym.as_str()),
            ("experiments", session.design.experiment.as_str()),
        ];
        for (kind, name) in named {
            let before = seen.entry((kind, label(name))).or_insert(name);
            if *before != name || label(name).is_empty() {
                let what = format!("the {kind} {before} and {name} have one name there");
                return Err(FileError::whole(
                    out,
                    what,
                    "rename one: BIDS knows letters and digits",
                ));
            }
        }
    }
    Ok(())
}

fn write_session(session: &Found, out: &Path, cells: &mut Cells) -> Result<(), ExperimentError> {
    let (subject, nth) = (label(&session.subject.pseudonym), session.subject.session);
    let task = label(&session.design.experiment);
    let folder = out
        .join(format!("sub-{subject}"))
        .join(format!("ses-{nth}"))
        .join("beh");
    make_folder(&folder)?;
    let path = folder.join(format!("sub-{subject}_ses-{nth}_task-{task}_events.tsv"));
    let columns = described_columns(&session.design);
    let mut names = vec!["onset", "duration"];
    names.extend(columns.iter().map(|column| column.name.as_str()));
    let mut rows: Vec<Vec<String>> = Vec::new();
    for record in &session.records {
        let onset_s = record.timing.start_ns() as f64 * 1e-9;
        let duration_s = record.timing.response_ms() * 1e-3;
        let mut row = vec![format!("{onset_s:.6}"), format!("{duration_s:.6}")];
        row.extend(record.cells(&session.design, &session.subject));
        rows.push(row);
    }
    write_tsv(&path, &names, &rows)?;
    let described = describe(&columns, &rows, &session.design);
    let beside = path.with_extension("json");
    write_json(&beside, &described)?;
    gather(&columns, &rows, (&task, &format!("sub-{subject}")), cells);
    Ok(())
}

fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), FileError> {
    write_atomic(path, to_json_string(value, path)?.as_bytes())
}

/// A table with tabs; what is empty is said to be.
fn write_tsv(path: &Path, names: &[&str], rows: &[Vec<String>]) -> Result<(), FileError> {
    let mut text = names.join("\t");
    text.push('\n');
    for row in rows {
        let cells = row.iter().map(|cell| match cell.as_str() {
            "" => NOTHING.to_owned(),
            cell => cell.replace(['\t', '\n', '\r', '"'], " "),
        });
        text.push_str(&cells.collect::<Vec<String>>().join("\t"));
        text.push('\n');
    }
    write_atomic(path, text.as_bytes())
}

fn describe(
    columns: &[ColumnDescription],
    rows: &[Vec<String>],
    design: &Design,
) -> BTreeMap<String, Described> {
    let onset = "beginning of the trial, since the session was opened";
    let times = [
        ("onset", onset),
        ("duration", "from the beginning to the answer"),
    ];
    let mut described: BTreeMap<String, Described> = times
        .map(|(name, meaning)| (name.to_owned(), Described::plain(meaning, "s")))
        .into();
    for (at, column) in columns.iter().enumerate() {
        let mut levels = BTreeMap::new();
        let values = rows
            .iter()
            .map(|row| row[at + 2].as_str())
            .filter(|cell| !cell.is_empty());
        for value in values.filter(|_| column.has_levels) {
            let stimulus = design.stimuli.iter().find(|stimulus| stimulus.id == value);
            let meaning = stimulus.map_or(value, |stimulus| stimulus.material.as_str());
            levels.insert(value.to_owned(), meaning.to_owned());
        }
        let plain = Described::plain(&column.meaning, column.unit);
        described.insert(column.name.clone(), Described { levels, ..plain });
    }
    described
}

/// Adds what the main table averages: right answers of those that can be right, else every number
/// that was answered, stimulus by stimulus; strengths by their geometric mean.
fn gather(
    columns: &[ColumnDescription],
    rows: &[Vec<String>],
    (task, subject): (&str, &str),
    cells: &mut Cells,
) {
    let at = |name: &str| {
        columns
            .iter()
            .position(|column| column.name == name)
            .map(|at| at + 2)
    };
    let is = |row: &[String], name: &str, cell: &str| at(name).is_some_and(|at| row[at] == cell);
    let counts = |row: &&Vec<String>| {
        is(row, "practice", "0") && is(row, "aborted", "0") && !is(row, "valid", "0")
    };
    let counted: Vec<&Vec<String>> = rows.iter().filter(counts).collect();
    let is_judged = at("correct").is_some_and(|at| counted.iter().any(|row| !row[at].is_empty()));
    let answers = columns
        .iter()
        .map(|column| column.name.as_str())
        .filter(|name| match *name {
            "correct" => is_judged,
            "response" => !is_judged,
            name => !is_judged && (name.starts_with("rating_") || name.starts_with("value_")),
        });
    for name in answers {
        let by = if is_judged { "" } else { "item" };
        let value = MainValue {
            task: task.to_owned(),
            value: name.to_owned(),
            by: by.to_owned(),
            is_geometric: name == "response",
        };
        for row in &counted {
            let cell = at(name).map_or("", |at| row[at].as_str());
            let group = at(by).map_or("all", |at| row[at].as_str()).to_owned();
            if let Ok(number) = cell.parse() {
                let key = (value.clone(), subject.to_owned(), group);
                cells.entry(key).or_default().push(number);
            }
        }
    }
}

fn write_main_table(cells: &Cells, folder: &Path) -> Result<(), ExperimentError> {
    make_folder(folder)?;
    let names: Vec<&str> = "task value participant_id by n mean by_column is_geometric"
        .split(' ')
        .collect();
    let row = |((value, subject, group), numbers): (&(MainValue, String, String), &Vec<f64>)| {
        let n = numbers.len() as f64;
        let mean = if value.is_geometric {
            (numbers.iter().map(|number| number.ln()).sum::<f64>() / n).exp()
        } else {
            numbers.iter().sum::<f64>() / n
        };
        vec![
            value.task.clone(),
            value.value.clone(),
            subject.clone(),
            group.clone(),
            numbers.len().to_string(),
            mean.to_string(),
            value.by.clone(),
            u8::from(value.is_geometric).to_string(),
        ]
    };
    let rows: Vec<Vec<String>> = cells.iter().map(row).collect();
    write_tsv(&folder.join("main-table.tsv"), &names, &rows)?;
    let mut tables: Vec<&MainValue> = cells.keys().map(|(value, ..)| value).collect();
    tables.dedup();
    let path = folder.join("main-table.json");
    write_json(&path, &MainValues { tables })?;
    write_atomic(&folder.join("main_table.py"), PYTHON.as_bytes())?;
    write_atomic(&folder.join("main_table.R"), R.as_bytes())?;
    Ok(())
}

/// Columns of the participants' file: name, meaning, unit.
const PARTICIPANTS: [(&str, &str, &str); 6] = [
    ("participant_id", "pseudonym", ""),
    ("age", "age as it was told", "year"),
    ("sex", "female, male or other, as it was told", ""),
    ("handedness", "hand that explores: right, left or both", ""),
    ("experience", "one word", ""),
    ("room", "where the sessions were held, one word", ""),
];

fn write_participants(
    sessions: &[&Found],
    participants: &Participants,
    out: &Path,
) -> Result<(), ExperimentError> {
    let names = PARTICIPANTS.map(|(name, ..)| name);
    let subjects = sessions.iter().map(|session| &session.subject);
    let pseudonyms: BTreeSet<&str> = subjects.map(|one| one.pseudonym.as_str()).collect();
    let row = |pseudonym: &&str| {
        let mut cells = vec![format!("sub-{}", label(pseudonym))];
        match participants.find(pseudonym) {
            Some(known) => cells.extend(known.particulars().iter().cloned()),
            None => cells.resize(names.len(), String::new()),
        }
        cells
    };
    let rows: Vec<Vec<String>> = pseudonyms.iter().map(row).collect();
    write_tsv(&out.join("participants.tsv"), &names, &rows)?;
    let described: BTreeMap<&str, Described> = PARTICIPANTS
        .map(|(name, meaning, unit)| (name, Described::plain(meaning, unit)))
        .into();
    let path = out.join("participants.json");
    Ok(write_json(&path, &described)?)
}

fn write_dataset(sessions: &[&Found], out: &Path) -> Result<(), ExperimentError> {
    let study = sessions
        .first()
        .map_or("sessions", |session| session.design.study.as_str());
    let (program, version) = selvedge_foundation::PROGRAM
        .split_once(' ')
        .unwrap_or((selvedge_foundation::PROGRAM, ""));
    let dataset = Dataset {
        name: study,
        version: BIDS_VERSION,
        kind: "raw",
        by: [BTreeMap::from([("Name", program), ("Version", version)])],
    };
    let path = out.join("dataset_description.json");
    write_json(&path, &dataset)?;
    let readme = "Events of every session, one row a trial; columns are described beside them. \
                  Practice, what was given up (aborted) and what was not felt (valid = 0) do not \
                  count. code/main_table.py and code/main_table.R make code/main-table.tsv once \
                  more.\n";
    Ok(write_atomic(&out.join("README"), readme.as_bytes())?)
}
