//! The columns of a log. Each is declared once: its name, unit, type and meaning, and what of a
//! record it holds. The header, the dictionary beside a log, rows and their reader go through the
//! same list.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::convert::Infallible;

use super::asked::{asked, chosen};
use super::values::{Count, Derived, Seconds, Value, derived, derived_if, flag, number};
use super::{Outcome, Record, SCHEMA_VERSION, TRIAL, blank, blank_answer};
use crate::design::Design;
use crate::presentation::{Presentation, Validity};
use crate::trial::Trial;

/// What the cells of a column hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Any text.
    Text,
    /// One of several texts that the meaning lists.
    Level,
    /// A version of these columns.
    Version,
    /// A number that counts from 1.
    Count,
    /// A rank, 1 the first.
    Rank,
    /// A grade from 1, or nothing.
    Grade,
    /// 0 or 1.
    Flag,
    /// The id of a stimulus of the design.
    Stimulus,
    /// A moment, UTC as RFC 3339.
    Moment,
    /// A whole number.
    Whole,
    /// A number.
    Number,
    /// A number from 0 to 1.
    Share,
}

/// A column.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) name: Cow<'static, str>,
    /// Empty where there is none.
    pub(super) unit: &'static str,
    pub(super) kind: Kind,
    pub(super) meaning: Cow<'static, str>,
}

impl Column {
    /// What a cell should hold, for whoever mends one.
    pub(super) fn expected(&self) -> &'static str {
        match self.kind {
            Kind::Text | Kind::Level | Kind::Stimulus | Kind::Moment => "a text",
            Kind::Version => "a version",
            Kind::Count => "a number from 1",
            Kind::Rank => "a rank",
            Kind::Grade => "a grade from 1",
            Kind::Flag => "0 or 1",
            Kind::Whole => "whole ns",
            Kind::Number if self.unit.starts_with("dB") => "a number of dB",
            Kind::Number => "a number",
            Kind::Share => "a number from 0 to 1",
        }
    }

    /// What the dictionary beside a log says of it.
    fn description(&self) -> String {
        match self.unit {
            "" => self.meaning.clone().into_owned(),
            unit => format!("{}, {unit}", self.meaning),
        }
    }
}

/// What is done with every column of a row: it is described, written or read.
pub(super) trait Visit {
    /// Why it cannot be done.
    type Error;

    /// Does it with a column and what a record has there.
    ///
    /// # Errors
    /// What is read is no such value.
    fn column(&mut self, column: Column, value: &mut dyn Value) -> Result<(), Self::Error>;

    /// Whether the columns are those of this version or a later one.
    fn is_since(&self, _version: u32) -> bool {
        true
    }
}

/// Columns: name, type, unit where there is one, and meaning, then what a record has there.
macro_rules! columns {
    ($to:expr; $($name:ident: $kind:ident $($unit:literal)?, $what:literal => $value:expr;)*) => {
        $($to.column(
            $crate::record::columns::Column {
                name: std::borrow::Cow::Borrowed(stringify!($name)),
                unit: concat!($($unit)?),
                kind: $crate::record::columns::Kind::$kind,
                meaning: std::borrow::Cow::Borrowed($what),
            },
            $value,
        )?;)*
    };
}
pub(super) use columns;

/// Visits every column of a record in order.
///
/// # Errors
/// What the visitor says.
pub(super) fn visit<V: Visit>(
    record: &mut Record,
    design: &Design,
    (pseudonym, session): (&str, u32),
    to: &mut V,
) -> Result<(), V::Error> {
    let (mut answer, is_answered) = match &record.outcome {
        Outcome::Answered(answer) => (answer.clone(), true),
        Outcome::Aborted => (blank_answer(&design.composition), false),
    };
    columns! { to;
        schema_version: Version, "version of these columns" => &mut derived(&SCHEMA_VERSION);
    }
    if to.is_since(2) {
        columns! { to;
            kind: Level, "trial, or opening and closing of the log" => &mut derived(TRIAL);
        }
    }
    columns! { to;
        study: Text, "id of the study" => &mut derived(&design.study);
        experiment: Text, "which experiment of the study" => &mut derived(&design.experiment);
        subject: Text, "pseudonym" => &mut derived(pseudonym);
        session: Count, "session of this subject, from 1" => &mut derived(&session);
    }
    placed(&mut record.trial, &mut record.attempt, to)?;
    asked(
        design,
        &mut record.trial.task,
        (&mut answer, is_answered),
        to,
    )?;
    chosen(design, (&mut answer, is_answered), to)?;
    let rt_ms = record.timing.response_ms();
    if to.is_since(2) {
        presented(&mut record.presentation, is_answered, to)?;
    }
    let (timing, apparatus) = (&mut record.timing, &mut record.apparatus);
    columns! { to;
        correct: Flag, "1 right, 0 wrong, empty where neither" =>
            &mut derived_if(record.is_correct.map(flag));
        rt_ms: Number "ms", "from the beginning of the trial to the answer, what is played included"
            => &mut Derived(number(rt_ms));
        t_start_utc: Moment, "beginning, UTC, RFC 3339" => &mut timing.start_utc;
        t_response_utc: Moment, "answer, UTC, RFC 3339" => &mut timing.response_utc;
        t_start_ns: Whole "ns since the session was opened", "beginning" => &mut timing.start_ns;
        t_response_ns: Whole "ns since the session was opened", "answer" =>
            &mut timing.response_ns;
        stimulus_hash: Text, "what the stimuli were made from" => &mut apparatus.stimulus_hash;
        device: Text, "the device as it calls itself" => &mut apparatus.device;
        gain_db: Number "dB", "gain of everything" => &mut apparatus.tuning.gain_db;
        gain_40_db: Number "dB", "gain of the 40 Hz band" => &mut apparatus.tuning.gain_40_db;
        gain_320_db: Number "dB", "gain of the 320 Hz band" => &mut apparatus.tuning.gain_320_db;
        compression: Share, "compression, 0 to 1" => &mut apparatus.tuning.compression;
        seed: Text, "seed of the study" => &mut derived(&design.seed);
        software: Text, "program and version" => &mut derived(selvedge_foundation::PROGRAM);
        aborted: Flag, "1 where the trial was given up and came again" =>
            &mut Derived(flag(!is_answered));
        note: Text, "the experimenter's note" => &mut record.note;
    }
    if to.is_since(2) {
        bound(&mut record.presentation.path_sha256, to)?;
    }
    if is_answered {
        record.outcome = Outcome::Answered(answer);
    }
    Ok(())
}

/// What binds a row to its path and to the row before it.
fn bound<V: Visit>(path_sha256: &mut String, to: &mut V) -> Result<(), V::Error> {
    columns! { to;
        path_sha256: Text, "SHA-256 of the file of how it was explored" => path_sha256;
        rows: Whole, "trials before an opening or a closing" => &mut derived("");
        before_sha256: Text, "SHA-256 of the row before, first of the sidecar" => &mut derived("");
    }
    Ok(())
}

/// Where a trial stands in its session.
fn placed<V: Visit>(trial: &mut Trial, attempt: &mut u32, to: &mut V) -> Result<(), V::Error> {
    columns! { to;
        block: Count, "block, from 1" => &mut Count(&mut trial.block);
        trial: Count, "trial, from 1; practice counts by itself" => &mut Count(&mut trial.number);
        attempt: Count, "attempt at the trial, from 1" => attempt;
        practice: Flag, "1 for practice, which does not count" => &mut trial.is_practice;
    }
    Ok(())
}

/// What is known of the presentation.
fn presented<V: Visit>(
    presentation: &mut Presentation,
    is_answered: bool,
    to: &mut V,
) -> Result<(), V::Error> {
    let valid = match presentation.validity() {
        Validity::Unknown => None,
        validity => Some(flag(is_answered && validity == Validity::Valid)),
    };
    columns! { to;
        proof: Level, "by what it is known that something was felt: array, emulator or screen \
            (nobody felt it), real-cloth, elsewhere or simulated" => &mut presentation.proof;
        valid: Flag, "1 where the presentation is proved and answered, 0 where not" =>
            &mut derived_if(valid);
        void: Text, "why it does not count; empty where it does" => &mut presentation.void;
        armed_share: Share, "ticks at which the device was armed, of all" =>
            &mut presentation.armed_share;
        frames_applied: Whole, "ticks whose frame the device applied" =>
            &mut presentation.frames_applied;
        frames_late: Whole, "ticks whose frame came late or not at all" =>
            &mut presentation.frames_late;
        limited_share: Share, "values that limits changed, of all" =>
            &mut presentation.limited_share;
        explored_s: Text "s", "how long each item was felt in movement, by position, the target \
            last: a; b; …" => &mut Seconds(&mut presentation.explored_s);
        onset_ns: Whole "ns since the session was opened", "first tick of a vibration" =>
            &mut presentation.onset_ns;
    }
    Ok(())
}

impl Column {
    /// One of several alike.
    pub(super) fn of(name: String, kind: Kind, meaning: String) -> Self {
        Self {
            name: name.into(),
            unit: "",
            kind,
            meaning: meaning.into(),
        }
    }
}

/// Keeps what columns a version has.
struct Columns(u32, Vec<Column>);

impl Visit for Columns {
    type Error = Infallible;

    fn column(&mut self, column: Column, _: &mut dyn Value) -> Result<(), Infallible> {
        self.1.push(column);
        Ok(())
    }

    fn is_since(&self, version: u32) -> bool {
        self.0 >= version
    }
}

fn of_design(design: &Design, version: u32) -> Vec<Column> {
    let mut columns = Columns(version, Vec::new());
    let Ok(()) = visit(&mut blank(design), design, ("", 0), &mut columns);
    columns.1
}

/// The names of the columns of a design's logs in order, as a version has them.
pub(crate) fn column_names(design: &Design, version: u32) -> Vec<String> {
    let columns = of_design(design, version).into_iter();
    columns.map(|column| column.name.into_owned()).collect()
}

/// What a trial asks, in the words of its columns: `block=1; trial=2; …`, without what is answered.
pub(crate) fn describe_trial(design: &Design, trial: &Trial) -> String {
    let mut record = Record {
        trial: trial.clone(),
        outcome: Outcome::Aborted,
        ..blank(design)
    };
    let mut cells = Asked(design, Vec::new());
    let (mut answer, trial) = (blank_answer(&design.composition), &mut record.trial);
    let Ok(()) = placed(trial, &mut 1, &mut cells);
    let Ok(()) = asked(design, &mut trial.task, (&mut answer, false), &mut cells);
    cells.1.join("; ")
}

/// Keeps the cells that are not empty, with their columns.
struct Asked<'a>(&'a Design, Vec<String>);

impl Visit for Asked<'_> {
    type Error = Infallible;

    fn column(&mut self, column: Column, value: &mut dyn Value) -> Result<(), Infallible> {
        let cell = value.cell(self.0);
        if !cell.is_empty() {
            self.1.push(format!("{}={cell}", column.name));
        }
        Ok(())
    }
}

/// A column of a design's logs, as other formats describe it.
pub(crate) struct ColumnDescription {
    pub(crate) name: String,
    /// Empty where there is none.
    pub(crate) unit: &'static str,
    pub(crate) meaning: String,
    /// Whether its cells are some of a few words.
    pub(crate) has_levels: bool,
}

/// The columns of a design's logs in order.
pub(crate) fn described_columns(design: &Design) -> Vec<ColumnDescription> {
    let described = |column: Column| ColumnDescription {
        has_levels: matches!(column.kind, Kind::Level | Kind::Stimulus | Kind::Flag),
        name: column.name.into_owned(),
        unit: column.unit,
        meaning: column.meaning.into_owned(),
    };
    let columns = of_design(design, SCHEMA_VERSION).into_iter();
    columns.map(described).collect()
}

/// What each column of a design's logs holds, by name.
pub(crate) fn dictionary(design: &Design) -> BTreeMap<String, String> {
    let entry = |column: &Column| (column.name.clone().into_owned(), column.description());
    let columns = of_design(design, SCHEMA_VERSION);
    columns.iter().map(entry).collect()
}
