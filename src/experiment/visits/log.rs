//! Three tables that only grow. A row is on disk once [`VisitLog::write`] returns; what cannot be
//! written is counted, and the visits go on.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use selvedge_foundation::files::{FileError, Journal, Table};
use selvedge_foundation::quantity::rfc3339;

use super::{
    COMMENT_COLUMNS, COMMENTS, GUESS_COLUMNS, GUESSES, Tally, VISIT_COLUMNS, VISITS, Visit,
};
use selvedge_foundation::numerics::to_whole;

/// As much is written in a day, bytes.
const MAX_BYTES_A_DAY: usize = 10_000_000;

/// The log of a stage; one process at a time writes it.
#[derive(Debug)]
pub struct VisitLog {
    folder: PathBuf,
    visits: Journal,
    guesses: Journal,
    comments: Journal,
    tally: Tally,
    /// The number of the visit that was written last.
    last_number: u64,
    day: String,
    bytes_today: usize,
    n_unwritten: u64,
    failure: Option<String>,
}

impl VisitLog {
    /// Opens the log in a folder, or begins one. A piece of a row that a crash left is set aside.
    ///
    /// # Errors
    /// It cannot be read or written, another process writes it, or it is no such log.
    pub fn in_folder(folder: &Path) -> Result<Self, FileError> {
        fs::create_dir_all(folder).map_err(FileError::write(folder))?;
        let (visits, table) = opened(&folder.join(VISITS), &VISIT_COLUMNS)?;
        let (guesses, _) = opened(&folder.join(GUESSES), &GUESS_COLUMNS)?;
        let (comments, _) = opened(&folder.join(COMMENTS), &COMMENT_COLUMNS)?;
        let mut tally = Tally::default();
        let mut last_number = 0;
        if let Some(table) = table {
            let column = |name| table.required_numbers(name);
            let rows = column("guesses")?.into_iter().zip(column("right")?);
            for (n_guesses, n_right) in rows {
                tally.count(to_whole(n_guesses), to_whole(n_right));
            }
            let numbers = column("visit")?;
            last_number = numbers.into_iter().map(to_whole).max().unwrap_or(0);
        }
        Ok(Self {
            folder: folder.to_owned(),
            visits,
            guesses,
            comments,
            tally,
            last_number,
            day: String::new(),
            bytes_today: 0,
            n_unwritten: 0,
            failure: None,
        })
    }

    /// Writes a visit that is over and waits until it is on disk; one that cannot be written is
    /// counted and lost.
    pub fn write(&mut self, visit: &Visit, now: SystemTime) {
        self.tally.take(visit);
        if let Err(why) = self.try_write(visit, now) {
            self.n_unwritten += 1;
            self.failure = Some(why);
        }
    }

    /// What earlier visitors guessed.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Visits that could not be written, and why the last of them could not.
    pub fn unwritten(&self) -> Option<(u64, &str)> {
        Some((self.n_unwritten, self.failure.as_deref()?))
    }

    /// Where it lies.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn try_write(&mut self, visit: &Visit, now: SystemTime) -> Result<(), String> {
        let number = self.last_number + 1;
        let row = line(&visit.row(number, now))?;
        let number_word = number.to_string();
        let mut guesses = Vec::new();
        for guess in &visit.guesses {
            guesses.extend(line(&[
                number_word.clone(),
                guess.truth.clone(),
                guess.choice.clone(),
                guess.order.clone(),
                if guess.is_heard { "on" } else { "off" }.to_owned(),
                guess.ms.to_string(),
            ])?);
        }
        let said = &visit.comment;
        let comment = if said.is_empty() {
            Vec::new()
        } else {
            let text: String = said.text.chars().take(super::Comment::LONGEST).collect();
            line(&[
                number_word,
                said.face.to_owned(),
                said.words.join(" "),
                text.replace(char::is_control, " "),
            ])?
        };
        self.spend(row.len() + guesses.len() + comment.len(), now)?;
        let said = |error: FileError| error.to_string();
        self.visits.append_lines(&row).map_err(said)?;
        self.last_number = number;
        if !guesses.is_empty() {
            self.guesses.append_lines(&guesses).map_err(said)?;
        }
        if !comment.is_empty() {
            self.comments.append_lines(&comment).map_err(said)?;
        }
        Ok(())
    }

    /// Takes so much of what may be written today.
    fn spend(&mut self, n_bytes: usize, now: SystemTime) -> Result<(), String> {
        let moment = rfc3339(now);
        let today = moment.get(0..10).unwrap_or_default();
        if self.day != today {
            today.clone_into(&mut self.day);
            self.bytes_today = 0;
        }
        if self.bytes_today + n_bytes > MAX_BYTES_A_DAY {
            return Err("the log of today is full; visits are only counted".to_owned());
        }
        self.bytes_today += n_bytes;
        Ok(())
    }
}

/// A table of these columns to be continued, with what it holds; or a new one.
fn opened(path: &Path, columns: &[&str]) -> Result<(Journal, Option<Table>), FileError> {
    if fs::symlink_metadata(path).is_err() {
        return Ok((Journal::create(path, columns)?, None));
    }
    let reopened = Journal::reopen(path, columns)?;
    Ok((reopened.journal, Some(reopened.table)))
}

fn line(cells: &[String]) -> Result<Vec<u8>, String> {
    Journal::row_line(cells, Path::new("")).map_err(|error| error.to_string())
}
