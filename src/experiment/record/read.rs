//! Rows back into records.

use std::path::Path;

use super::{Apparatus, Outcome, Record, SCHEMA_VERSION, Timing, column_names};
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
    let names = column_names(design);
    let columns = names.iter().map(|name| (name.as_str(), table.text(name)));
    let columns: Vec<(&str, Vec<&str>)> = columns
        .filter_map(|(name, cells)| Some((name, cells?)))
        .collect();
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
    columns: &'a [(&'a str, Vec<&'a str>)],
    nth: usize,
    place: (&'a Path, usize),
    design: &'a Design,
}

impl Row<'_> {
    fn record(&self) -> Result<Record, FileError> {
        let version: u32 = self.parsed("schema_version", "a version")?;
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
            attempt: self.parsed("attempt", "a number from 1")?,
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
            start_ns: self.parsed("t_start_ns", "whole ns")?,
            response_ns: self.parsed("t_response_ns", "whole ns")?,
        })
    }

    fn apparatus(&self) -> Result<Apparatus, FileError> {
        Ok(Apparatus {
            device: self.cell("device")?.to_owned(),
            tuning: Tuning {
                gain_db: self.parsed("gain_db", "a number of dB")?,
                gain_40_db: self.parsed("gain_40_db", "a number of dB")?,
                gain_320_db: self.parsed("gain_320_db", "a number of dB")?,
                compression: self.parsed("compression", "a number from 0 to 1")?,
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
                let start = |key: &str| self.parsed(&format!("start_{key}"), "a number");
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
                level_db: self.parsed("level_db", "a number of dB")?,
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
                self.parsed("rank1", "a rank")?,
                self.parsed("rank2", "a rank")?,
                self.parsed("rank3", "a rank")?,
                self.parsed("rank4", "a rank")?,
            ]),
            Task::OddOne { .. } => {
                let name = self.cell("grade")?;
                let grade = Grade::of_name(name).ok_or_else(|| {
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
            Task::Estimate { .. } => Answer::Magnitude(self.parsed("response", "a number")?),
            Task::Rate { .. } => {
                let Method::Rating(rating) = &self.design.method else {
                    return Err(self.wrong("a rating without scales", "restore the design"));
                };
                let place = |key: &str| self.parsed(&format!("rating_{key}"), "a number");
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
        let value = |key: &&str| self.parsed(&format!("value_{key}"), "a number");
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
            _ => self.parsed("confidence", "a grade from 1").map(Some),
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
        let number: usize = self.parsed(column, "a number from 1")?;
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

    fn parsed<T: std::str::FromStr>(&self, column: &str, expected: &str) -> Result<T, FileError> {
        let cell = self.cell(column)?;
        let wrong = |_| self.wrong(format!("{column} is {cell:?}"), format!("give {expected}"));
        cell.parse().map_err(wrong)
    }

    fn cell(&self, column: &str) -> Result<&str, FileError> {
        let found = self.columns.iter().find(|(name, _)| *name == column);
        let cell = found.and_then(|(_, cells)| cells.get(self.nth));
        cell.copied().ok_or_else(|| {
            self.wrong(
                format!("there is no column {column}"),
                "restore the log's header",
            )
        })
    }

    fn wrong(&self, what: impl Into<String>, mend: impl Into<String>) -> FileError {
        FileError::content(self.place.0, self.place.1, what, mend)
    }
}
