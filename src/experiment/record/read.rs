//! Rows back into records.

use std::path::Path;

use super::columns::{Column, columns};
use super::{Apparatus, Outcome, Record, SCHEMA_VERSION, Timing};
use crate::ExperimentError;
use crate::design::{Design, JudgingProtocol, Method};
use crate::trial::{Adjustment, Answer, Grade, Task, Trial};
use selvedge_foundation::files::{FileError, Table};
use selvedge_textile::tactile::Tuning;

/// The records of a log.
///
/// # Errors
/// A cell does not hold what its column says, a stimulus is none of the design's, or the log was
/// written by a later version.
pub(crate) fn read_records(
    design: &Design,
    table: &Table,
    path: &Path,
) -> Result<Vec<Record>, ExperimentError> {
    let with_cells = |column: Column| {
        let cells = table.text(&column.name)?;
        Some((column, cells))
    };
    let columns: Vec<(Column, Vec<&str>)> =
        columns(design).into_iter().filter_map(with_cells).collect();
    let row = |nth: usize| {
        let row = Row {
            columns: &columns,
            nth,
            place: (path, table.line_of(nth)),
            design,
        };
        row.record()
    };
    let records: Result<Vec<Record>, FileError> = (0..table.n_rows()).map(row).collect();
    Ok(records?)
}

struct Row<'a> {
    columns: &'a [(Column, Vec<&'a str>)],
    nth: usize,
    place: (&'a Path, usize),
    design: &'a Design,
}

impl Row<'_> {
    fn record(&self) -> Result<Record, FileError> {
        let version: u32 = self.parsed("schema_version")?;
        if version > SCHEMA_VERSION {
            let what = format!("the log has version {version} of its columns");
            let mend = format!("this program knows up to {SCHEMA_VERSION}: use a later one");
            return Err(self.wrong(what, mend));
        }
        for (column, expected) in [
            ("study", &self.design.study),
            ("experiment", &self.design.experiment),
        ] {
            let found = self.cell(column)?;
            if found != expected {
                let what = format!("{column} is {found:?}, the design's is {expected:?}");
                return Err(self.wrong(what, "keep the logs of each experiment by themselves"));
            }
        }
        let task = self.task()?;
        let is_aborted = self.is_set("aborted")?;
        let outcome = if is_aborted {
            Outcome::Aborted
        } else {
            Outcome::Answered(self.answer(&task)?)
        };
        let is_correct = match &outcome {
            Outcome::Answered(answer) => task
                .verdict(answer)
                .map_err(|error| self.wrong(error.to_string(), "restore the row"))?,
            Outcome::Aborted => None,
        };
        Ok(Record {
            trial: Trial {
                block: self.counted("block")?,
                number: self.counted("trial")?,
                is_practice: self.is_set("practice")?,
                task,
            },
            attempt: self.parsed("attempt")?,
            outcome,
            is_correct,
            timing: self.timing()?,
            apparatus: self.apparatus()?,
            note: self.cell("note")?.to_owned(),
        })
    }

    fn timing(&self) -> Result<Timing, FileError> {
        Ok(Timing {
            start_utc: self.cell("t_start_utc")?.to_owned(),
            response_utc: self.cell("t_response_utc")?.to_owned(),
            start_ns: self.parsed("t_start_ns")?,
            response_ns: self.parsed("t_response_ns")?,
        })
    }

    fn apparatus(&self) -> Result<Apparatus, FileError> {
        Ok(Apparatus {
            device: self.cell("device")?.to_owned(),
            tuning: Tuning {
                gain_db: self.parsed("gain_db")?,
                gain_40_db: self.parsed("gain_40_db")?,
                gain_320_db: self.parsed("gain_320_db")?,
                compression: self.parsed("compression")?,
                compression_reference_db: None,
            },
            stimulus_hash: self.cell("stimulus_hash")?.to_owned(),
        })
    }

    fn task(&self) -> Result<Task, FileError> {
        Ok(match &self.design.method {
            Method::Ranking(_) => Task::Rank {
                target: self.item("target")?,
                alternatives: [
                    self.item("alt1")?,
                    self.item("alt2")?,
                    self.item("alt3")?,
                    self.item("alt4")?,
                ],
            },
            Method::OddOneOut(_) => Task::OddOne {
                items: [
                    self.item("item1")?,
                    self.item("item2")?,
                    self.item("item3")?,
                ],
                odd: self.counted("position_odd")?,
            },
            Method::Adjustment(adjusting) => {
                let start = |key: &str| self.parsed(&format!("start_{key}"));
                let keys = adjusting
                    .parameters
                    .iter()
                    .map(|parameter| parameter.what.name());
                Task::Adjust {
                    item: self.item("item")?,
                    starts: keys.map(start).collect::<Result<_, _>>()?,
                }
            }
            Method::Judgement(judging) => match judging.protocol {
                JudgingProtocol::Single => Task::Judge {
                    item: self.item("item")?,
                    is_real: self.is_set("is_real")?,
                },
                JudgingProtocol::Pair => Task::JudgePair {
                    items: [self.item("item1")?, self.item("item2")?],
                    real: self.counted("position_real")?,
                },
            },
            Method::Levels(_) => Task::Interval {
                track: self.counted("track")?,
                level_db: self.parsed("level_db")?,
                signal: self.counted("interval_signal")?,
            },
            Method::Magnitude { .. } => Task::Estimate {
                item: self.item("item")?,
            },
            Method::Rating(_) => Task::Rate {
                item: self.item("item")?,
            },
        })
    }

    fn answer(&self, task: &Task) -> Result<Answer, FileError> {
        Ok(match task {
            Task::Rank { .. } => Answer::Ranks([
                self.parsed("rank1")?,
                self.parsed("rank2")?,
                self.parsed("rank3")?,
                self.parsed("rank4")?,
            ]),
            Task::OddOne { .. } => {
                let name = self.cell("grade")?;
                let mut grades = Grade::ALL.into_iter();
                let grade = grades.find(|grade| grade.name() == name).ok_or_else(|| {
                    let what = format!("grade is {name:?}");
                    self.wrong(what, "give easy, normal or hard")
                })?;
                Answer::Odd {
                    position: self.counted("response")?,
                    grade,
                }
            }
            Task::Adjust { .. } => self.adjusted()?,
            Task::Judge { .. } => Answer::Judged {
                is_real: match self.cell("response")? {
                    "real" => true,
                    "generated" => false,
                    other => {
                        let what = format!("response is {other:?}");
                        return Err(self.wrong(what, "give real or generated"));
                    }
                },
                confidence: self.confidence()?,
            },
            Task::JudgePair { .. } | Task::Interval { .. } => Answer::Chosen {
                position: self.counted("response")?,
                confidence: self.confidence()?,
            },
            Task::Estimate { .. } => Answer::Magnitude(self.parsed("response")?),
            Task::Rate { .. } => {
                let Method::Rating(rating) = &self.design.method else {
                    return Err(self.wrong("a rating without scales", "restore the design"));
                };
                let place = |key: &str| self.parsed(&format!("rating_{key}"));
                let keys = rating.scales.iter().map(|scale| scale.key.as_str());
                Answer::Ratings(keys.map(place).collect::<Result<_, _>>()?)
            }
        })
    }

    fn adjusted(&self) -> Result<Answer, FileError> {
        let Method::Adjustment(adjusting) = &self.design.method else {
            return Err(self.wrong("an adjustment without parameters", "restore the design"));
        };
        let keys: Vec<&str> = adjusting
            .parameters
            .iter()
            .map(|parameter| parameter.what.name())
            .collect();
        let value = |key: &&str| self.parsed(&format!("value_{key}"));
        let values = keys.iter().map(value).collect::<Result<_, _>>()?;
        let text = self.cell("steps")?;
        let step = |text: &str| {
            let (at_ms, rest) = text.trim().split_once(':')?;
            let (key, value) = rest.split_once('=')?;
            Some(Adjustment {
                at_ms: at_ms.parse().ok()?,
                parameter: keys.iter().position(|&known| known == key)?,
                value: value.parse().ok()?,
            })
        };
        let steps: Option<Vec<Adjustment>> = match text {
            "" => Some(Vec::new()),
            text => text.split(';').map(step).collect(),
        };
        let steps = steps.ok_or_else(|| {
            self.wrong(
                format!("steps is {text:?}"),
                "give ms:key=value; … or nothing",
            )
        })?;
        Ok(Answer::Adjusted { values, steps })
    }

    fn confidence(&self) -> Result<Option<u8>, FileError> {
        match self.cell("confidence")? {
            "" => Ok(None),
            _ => self.parsed("confidence").map(Some),
        }
    }

    /// The stimulus that a cell names.
    fn item(&self, column: &str) -> Result<usize, FileError> {
        let id = self.cell(column)?;
        let found = self
            .design
            .stimuli
            .iter()
            .position(|stimulus| stimulus.id == id);
        found.ok_or_else(|| {
            let what = format!("{column} is {id:?}, which is no stimulus of the design");
            self.wrong(what, "use the design that the log was made with")
        })
    }

    /// A number that counts from 1, from 0.
    fn counted(&self, column: &str) -> Result<usize, FileError> {
        let number: usize = self.parsed(column)?;
        let less = number.checked_sub(1);
        less.ok_or_else(|| self.wrong(format!("{column} is 0"), "count from 1"))
    }

    fn is_set(&self, column: &str) -> Result<bool, FileError> {
        match self.cell(column)? {
            "0" => Ok(false),
            "1" => Ok(true),
            other => Err(self.wrong(format!("{column} is {other:?}"), "give 0 or 1")),
        }
    }

    fn parsed<T: std::str::FromStr>(&self, name: &str) -> Result<T, FileError> {
        let (column, cell) = self.at(name)?;
        let wrong = |_| {
            let mend = format!("give {}", column.expected());
            self.wrong(format!("{name} is {cell:?}"), mend)
        };
        cell.parse().map_err(wrong)
    }

    fn cell(&self, name: &str) -> Result<&str, FileError> {
        Ok(self.at(name)?.1)
    }

    /// A column and the row's cell in it.
    fn at(&self, name: &str) -> Result<(&Column, &str), FileError> {
        let found = self.columns.iter().find(|(column, _)| column.name == name);
        let cell = found.and_then(|(column, cells)| Some((column, *cells.get(self.nth)?)));
        cell.ok_or_else(|| {
            self.wrong(
                format!("there is no column {name}"),
                "restore the log's header",
            )
        })
    }

    fn wrong(&self, what: impl Into<String>, mend: impl Into<String>) -> FileError {
        FileError::content(self.place.0, self.place.1, what, mend)
    }
}
