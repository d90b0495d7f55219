//! The columns of a log. Each is declared once: its name, unit, type and meaning, and what a row
//! has in it. The header, the rows, the dictionary beside a log and what a reader expects of a cell
//! follow from that.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::row::{Row, flag, id, number, number_at, position, right, text, value};
use super::{Outcome, Record, SCHEMA_VERSION};
use crate::design::{Adjusting, Design, JudgingProtocol, Method, Subject};
use crate::trial::Grade;

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
    unit: &'static str,
    kind: Kind,
    meaning: Cow<'static, str>,
    /// Which of several alike: the alternative, the parameter, the scale.
    nth: usize,
    cell: fn(&Row<'_>, usize) -> String,
}

/// Columns: name, type, unit where there is one, and meaning, then what a row has there.
macro_rules! columns {
    ($($name:ident: $kind:ident $($unit:literal)?, $meaning:literal => $cell:expr;)*) => {
        vec![$(Column {
            name: Cow::Borrowed(stringify!($name)),
            unit: concat!($($unit)?),
            kind: Kind::$kind,
            meaning: Cow::Borrowed($meaning),
            nth: 0,
            cell: $cell,
        }),*]
    };
}

impl Column {
    /// One of several alike.
    fn nth(
        nth: usize,
        (name, kind): (String, Kind),
        meaning: String,
        cell: fn(&Row<'_>, usize) -> String,
    ) -> Self {
        Self {
            name: Cow::Owned(name),
            unit: "",
            kind,
            meaning: Cow::Owned(meaning),
            nth,
            cell,
        }
    }

    /// One of several stimuli of a trial.
    fn stimulus(name: &str, meaning: &str, nth: usize) -> Self {
        let (name, number) = (format!("{name}{}", nth + 1), nth + 1);
        let meaning = format!("{meaning} {number}");
        Self::nth(nth, (name, Kind::Stimulus), meaning, id)
    }

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

/// The columns of a design's logs in order.
pub(super) fn columns(design: &Design) -> Vec<Column> {
    let mut all = before();
    all.extend(of_method(&design.method));
    all.extend(after(&design.method));
    all
}

/// The names of the columns of a design's logs.
pub(crate) fn column_names(design: &Design) -> Vec<String> {
    let names = columns(design).into_iter();
    names.map(|column| column.name.into_owned()).collect()
}

/// What each column of a design's logs holds, by name.
pub(crate) fn dictionary(design: &Design) -> BTreeMap<String, String> {
    let entry = |column: &Column| (column.name.clone().into_owned(), column.description());
    columns(design).iter().map(entry).collect()
}

/// The cells of a row, in the order of [`columns()`].
pub(super) fn cells(record: &Record, design: &Design, subject: &Subject) -> Vec<String> {
    let row = Row::of(record, design, subject);
    let all = columns(design).into_iter();
    all.map(|column| (column.cell)(&row, column.nth)).collect()
}

/// Columns before those of the method.
fn before() -> Vec<Column> {
    columns! {
        schema_version: Version, "version of these columns" => |_, _| SCHEMA_VERSION.to_string();
        study: Text, "id of the study" => |row, _| row.design.study.clone();
        experiment: Text, "which experiment of the study" => |row, _| row.design.experiment.clone();
        subject: Text, "pseudonym" => |row, _| row.subject.pseudonym.clone();
        session: Count, "session of this subject, from 1" =>
            |row, _| row.subject.session.to_string();
        block: Count, "block, from 1" => |row, _| position(row.record.trial.block);
        trial: Count, "trial, from 1; practice counts by itself" =>
            |row, _| position(row.record.trial.number);
        attempt: Count, "attempt at the trial, from 1" => |row, _| row.record.attempt.to_string();
        practice: Flag, "1 for practice, which does not count" =>
            |row, _| flag(row.record.trial.is_practice);
    }
}

/// Columns of each method: what was presented, and answers of several numbers.
fn of_method(method: &Method) -> Vec<Column> {
    match method {
        Method::Ranking(_) => of_ranking(),
        Method::OddOneOut(_) => {
            let items = (0..3).map(|nth| Column::stimulus("item", "stimulus", nth));
            let mut all: Vec<Column> = items.collect();
            all.extend(columns! {
                position_odd: Count, "where the odd one was, from 1" => right;
                grade: Level, "easy, normal or hard" =>
                    |row, _| text(row.answered.grade.map(Grade::name));
            });
            all
        }
        Method::Adjustment(adjusting) => of_adjustment(adjusting),
        Method::Judgement(judging) if judging.protocol == JudgingProtocol::Pair => {
            let items = (0..2).map(|nth| Column::stimulus("item", "stimulus", nth));
            let mut all: Vec<Column> = items.collect();
            all.extend(columns! {
                position_real: Count, "where the real one was, from 1" => right;
            });
            all
        }
        Method::Judgement(_) => {
            let mut all = item_and_condition();
            all.extend(columns! {
                is_real: Flag, "1 for a real one, 0 for a generated one" =>
                    |row, _| row.presented.is_real.map_or_else(String::new, flag);
            });
            all
        }
        Method::Levels(_) => columns! {
            track: Count, "which of the interleaved series, from 1" =>
                |row, _| row.presented.track.map_or_else(String::new, position);
            level_db: Number "dB re 1 µm", "level of the signal" =>
                |row, _| row.presented.level_db.map_or_else(String::new, number);
            interval_signal: Count, "which interval held it, from 1" => right;
        },
        Method::Magnitude { .. } => item_and_condition(),
        Method::Rating(rating) => {
            let mut all = item_and_condition();
            all.extend(rating.scales.iter().enumerate().map(|(nth, scale)| {
                let [low, high] = scale.bounds();
                let meaning = format!("{} ({low}) to {} ({high})", scale.low, scale.high);
                let name = format!("rating_{}", scale.key);
                Column::nth(nth, (name, Kind::Number), meaning, value)
            }));
            all
        }
    }
}

/// A target, its alternatives and their ranks.
fn of_ranking() -> Vec<Column> {
    let mut all = columns! {
        target: Stimulus, "the target" => |row, _| row.id_of(row.presented.target);
    };
    all.extend((0..4).map(|nth| Column::stimulus("alt", "alternative", nth)));
    all.extend(columns! {
        position_correct: Count, "where the target was, from 1" => right;
    });
    all.extend((0..4).map(|nth| {
        let (name, number) = (format!("rank{}", nth + 1), nth + 1);
        let meaning = format!("rank of alternative {number}, 1 most alike");
        let cell = |row: &Row<'_>, nth| text(row.answered.ranks.get(nth));
        Column::nth(nth, (name, Kind::Rank), meaning, cell)
    }));
    all
}

/// Where each parameter began and was left, then every change.
fn of_adjustment(adjusting: &Adjusting) -> Vec<Column> {
    let mut all = item_and_condition();
    for (nth, parameter) in adjusting.parameters.iter().enumerate() {
        let key = parameter.what.name();
        let (name, meaning) = (format!("start_{key}"), format!("{key} at the beginning"));
        let cell = |row: &Row<'_>, nth| number_at(row.presented.starts, nth);
        all.push(Column::nth(nth, (name, Kind::Number), meaning, cell));
        let (name, meaning) = (format!("value_{key}"), format!("{key} as it was left"));
        all.push(Column::nth(nth, (name, Kind::Number), meaning, value));
    }
    all.extend(columns! {
        steps: Text, "every change: ms since the beginning:key=value; …" =>
            |row, _| row.steps();
    });
    all
}

/// The only stimulus of a trial.
fn item_and_condition() -> Vec<Column> {
    columns! {
        item: Stimulus, "the stimulus" => id;
        condition: Text, "the stimulus's condition" => |row, _| {
            let item = row.presented.items.first();
            let found = item.and_then(|item| row.design.stimuli.get(*item));
            text(found.map(|stimulus| &stimulus.condition))
        };
    }
}

/// Columns after those of the method.
fn after(method: &Method) -> Vec<Column> {
    let mut all = columns! {
        response: Text, "what was chosen; empty where several numbers were given" =>
            |row, _| row.answered.response.clone();
        confidence: Grade, "how sure that was, from 1; empty where not asked" =>
            |row, _| text(row.answered.confidence);
        correct: Flag, "1 right, 0 wrong, empty where neither" =>
            |row, _| row.record.is_correct.map_or_else(String::new, flag);
        rt_ms: Number "ms", "from beginning to answer" =>
            |row, _| number(row.record.timing.response_ms());
        t_start_utc: Moment, "beginning, UTC, RFC 3339" =>
            |row, _| row.record.timing.start_utc.clone();
        t_response_utc: Moment, "answer, UTC, RFC 3339" =>
            |row, _| row.record.timing.response_utc.clone();
        t_start_ns: Whole "ns since the session was opened", "beginning" =>
            |row, _| row.record.timing.start_ns.to_string();
        t_response_ns: Whole "ns since the session was opened", "answer" =>
            |row, _| row.record.timing.response_ns.to_string();
        stimulus_hash: Text, "what the stimuli were made from" =>
            |row, _| row.record.apparatus.stimulus_hash.clone();
        device: Text, "the device as it calls itself" =>
            |row, _| row.record.apparatus.device.clone();
        gain_db: Number "dB", "gain of everything" =>
            |row, _| number(row.record.apparatus.tuning.gain_db);
        gain_40_db: Number "dB", "gain of the 40 Hz band" =>
            |row, _| number(row.record.apparatus.tuning.gain_40_db);
        gain_320_db: Number "dB", "gain of the 320 Hz band" =>
            |row, _| number(row.record.apparatus.tuning.gain_320_db);
        compression: Share, "compression, 0 to 1" =>
            |row, _| number(row.record.apparatus.tuning.compression);
        seed: Text, "seed of the study" => |row, _| row.design.seed.to_string();
        software: Text, "program and version" => |_, _| selvedge_foundation::PROGRAM.to_owned();
        aborted: Flag, "1 where the trial was given up and came again" =>
            |row, _| flag(row.record.outcome == Outcome::Aborted);
        note: Text, "the experimenter's note" => |row, _| row.record.note.clone();
    };
    all[0].kind = kind_of_response(method);
    all
}

fn kind_of_response(method: &Method) -> Kind {
    match method {
        Method::Judgement(judging) if judging.protocol == JudgingProtocol::Single => Kind::Level,
        Method::Ranking(_) | Method::OddOneOut(_) | Method::Levels(_) | Method::Judgement(_) => {
            Kind::Count
        }
        Method::Magnitude { .. } => Kind::Number,
        Method::Adjustment(_) | Method::Rating(_) => Kind::Text,
    }
}
