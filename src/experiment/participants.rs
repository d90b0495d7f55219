//! `participants.csv` of a study's folder: who took part, by pseudonym, in the order of coming.
//!
//! It only grows, and what people are told apart by is all that it holds: pseudonyms and words
//! without blanks, so that no name finds its way in. What was not told is empty.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::ExperimentError;
use super::design::Design;
use selvedge_foundation::files::{self, FileError, Journal, Table};
use selvedge_foundation::quantity::rfc3339;

/// The columns of the table.
const COLUMNS: [&str; 7] = [
    "pseudonym",
    "age_years",
    "sex",
    "handedness",
    "experience",
    "room",
    "added_utc",
];
/// Particulars: the columns between pseudonym and moment.
const N_PARTICULARS: usize = 5;
/// The oldest age that is taken for one, years.
const OLDEST_YEARS: u32 = 120;

/// What to do where two things are told of one pseudonym.
const MEND: &str = "choose another pseudonym, or leave out what differs";

/// What is known of somebody who takes part; empty where it was not told.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Participant {
    pseudonym: String,
    /// In the order of [`COLUMNS`], from the second on.
    particulars: [String; N_PARTICULARS],
}

/// What was told of a participant, as it was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Particulars<'a> {
    /// Age, whole years.
    pub age_years: Option<u32>,
    /// `female`, `male` or `other`.
    pub sex: Option<&'a str>,
    /// `right`, `left` or `both`.
    pub handedness: Option<&'a str>,
    /// One word: `naive`, `practised`, …
    pub experience: Option<&'a str>,
    /// One word: where the sessions are held.
    pub room: Option<&'a str>,
}

impl Participant {
    /// What a table calls the sexes.
    pub const SEXES: [&str; 3] = ["female", "male", "other"];
    /// What a table calls the hands that somebody explores with.
    pub const HANDS: [&str; 3] = ["right", "left", "both"];

    /// A participant.
    ///
    /// # Errors
    /// The pseudonym is no name of a file, or a particular is none that is known.
    pub fn new(pseudonym: &str, described: Particulars<'_>) -> Result<Self, ExperimentError> {
        let text = |described: Option<&str>| described.unwrap_or_default().to_owned();
        let participant = Self {
            pseudonym: pseudonym.to_owned(),
            particulars: [
                described
                    .age_years
                    .map_or_else(String::new, |age| age.to_string()),
                text(described.sex),
                text(described.handedness),
                text(described.experience),
                text(described.room),
            ],
        };
        match participant.flaw() {
            None => Ok(participant),
            Some((what, mend)) => Err(ExperimentError::value(what, mend)),
        }
    }

    /// The pseudonym.
    pub fn pseudonym(&self) -> &str {
        &self.pseudonym
    }

    /// Age in years, sex, handedness, experience and room as they were told; empty where not.
    pub fn particulars(&self) -> &[String] {
        &self.particulars
    }

    /// What is wrong, and how to mend it.
    fn flaw(&self) -> Option<(String, String)> {
        let described = |name: &str, value: &str| format!("{name} is {value:?}");
        if !Design::is_name(&self.pseudonym) {
            let mend = "give 1 to 64 letters, digits, - and _, and no real name";
            return Some((described("pseudonym", &self.pseudonym), mend.to_owned()));
        }
        let [age, sex, hand, experience, room] = &self.particulars;
        let is_age = |text: &str| {
            text.parse()
                .is_ok_and(|age: u32| (1..=OLDEST_YEARS).contains(&age))
        };
        if !age.is_empty() && !is_age(age) {
            let mend = format!("give 1 to {OLDEST_YEARS} whole years, or leave it out");
            return Some((described("age_years", age), mend));
        }
        for (name, value, known) in [("sex", sex, Self::SEXES), ("handedness", hand, Self::HANDS)] {
            if !value.is_empty() && !known.contains(&value.as_str()) {
                let [first, second, third] = known;
                let mend = format!("give {first}, {second} or {third}, or leave it out");
                return Some((described(name, value), mend));
            }
        }
        let mut words = [("experience", experience), ("room", room)].into_iter();
        let (name, value) =
            words.find(|(_, value)| !value.is_empty() && !Design::is_name(value))?;
        let mend = "give one word of letters, digits, - and _, or leave it out";
        Some((described(name, value), mend.to_owned()))
    }

    /// The first particular that was told of `self` and is another of `known`, in one line.
    fn difference(&self, known: &Self) -> Option<String> {
        let pairs = self.particulars.iter().zip(&known.particulars);
        let mut pairs = COLUMNS[1..].iter().zip(pairs);
        let (column, (described, known)) =
            pairs.find(|(_, (described, known))| !described.is_empty() && described != known)?;
        let then = match known.as_str() {
            "" => "was not told".to_owned(),
            known => format!("was {known}"),
        };
        let who = &self.pseudonym;
        Some(format!(
            "{who} took part already: {column} {then} then, and is {described} now"
        ))
    }
}

/// The participants of a study, in the order of coming.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Participants {
    rows: Vec<Participant>,
}

impl Participants {
    /// Those of a study's folder; none where nobody came yet.
    ///
    /// # Errors
    /// The table cannot be read, or a row is none.
    pub fn read(folder: &Path) -> Result<Self, ExperimentError> {
        let path = table_path(folder);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = files::read_text(&path)?;
        // Another session may be in the middle of adding one.
        let complete = text.rfind('\n').map_or(0, |end| end + 1);
        let table = Table::read(&text[..complete], &path, &COLUMNS, &[])?;
        Ok(Self::of(&table, &path)?)
    }

    fn of(table: &Table, path: &Path) -> Result<Self, FileError> {
        let columns: Vec<Vec<&str>> = COLUMNS
            .iter()
            .filter_map(|column| table.text(column))
            .collect();
        let mut rows: Vec<Participant> = Vec::new();
        for nth in 0..table.n_rows() {
            let cell = |at: usize| columns.get(at).map_or("", |cells| cells[nth]).to_owned();
            let participant = Participant {
                pseudonym: cell(0),
                particulars: std::array::from_fn(|particular| cell(particular + 1)),
            };
            let is_twice = rows
                .iter()
                .any(|row| row.pseudonym == participant.pseudonym);
            let twice = || {
                let what = format!("{} is there twice", participant.pseudonym);
                (what, "remove the later row".to_owned())
            };
            let flaw = participant.flaw().or_else(|| is_twice.then(twice));
            if let Some((what, mend)) = flaw {
                return Err(FileError::content(path, table.line_of(nth), what, mend));
            }
            rows.push(participant);
        }
        Ok(Self { rows })
    }

    /// Which participant this is, from 0: what is balanced over subjects goes by it.
    pub fn nth(&self, pseudonym: &str) -> Option<usize> {
        self.rows.iter().position(|row| row.pseudonym == pseudonym)
    }

    /// The participant with this pseudonym.
    pub(crate) fn find(&self, pseudonym: &str) -> Option<&Participant> {
        self.rows.iter().find(|row| row.pseudonym == pseudonym)
    }

    /// All of them.
    pub fn rows(&self) -> &[Participant] {
        &self.rows
    }

    /// Which participant this is, from 0, who is added to the table where that was not done yet.
    /// What was not told now may have been told then.
    ///
    /// # Errors
    /// The table cannot be read or written, or other particulars were told of this pseudonym.
    pub fn enrol(
        folder: &Path,
        participant: &Participant,
        now: SystemTime,
    ) -> Result<usize, ExperimentError> {
        let path = table_path(folder);
        if let Some(nth) = Self::read(folder)?.known(participant, &path)? {
            return Ok(nth);
        }
        let (mut journal, nth) = match Journal::create(&path, &COLUMNS) {
            Ok(journal) => (journal, 0),
            Err(FileError::Exists { .. }) => {
                let reopened = Journal::reopen(&path, &COLUMNS)?;
                // Somebody may have been added since it was read.
                let there = Self::of(&reopened.table, &path)?;
                if let Some(nth) = there.known(participant, &path)? {
                    return Ok(nth);
                }
                (reopened.journal, there.rows.len())
            }
            Err(error) => return Err(error.into()),
        };
        let added = rfc3339(now);
        let mut cells = vec![participant.pseudonym.as_str()];
        cells.extend(participant.particulars.iter().map(String::as_str));
        cells.push(&added);
        journal.append(&cells)?;
        Ok(nth)
    }

    /// What is told of a pseudonym in another way than it was told before, in one line.
    pub fn contradiction(&self, participant: &Participant) -> Option<String> {
        let nth = self.nth(&participant.pseudonym)?;
        let difference = participant.difference(&self.rows[nth])?;
        Some(format!("{difference}; {MEND}"))
    }

    fn known(
        &self,
        participant: &Participant,
        path: &Path,
    ) -> Result<Option<usize>, ExperimentError> {
        let Some(nth) = self.nth(&participant.pseudonym) else {
            return Ok(None);
        };
        match participant.difference(&self.rows[nth]) {
            None => Ok(Some(nth)),
            Some(difference) => Err(FileError::whole(path, difference, MEND).into()),
        }
    }
}

fn table_path(folder: &Path) -> PathBuf {
    folder.join("participants.csv")
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::time::UNIX_EPOCH;

    use super::*;
    use crate::session::tests::Folder;

    const TOLD: Particulars<'static> = Particulars {
        age_years: Some(31),
        sex: Some("female"),
        handedness: None,
        experience: Some("practised"),
        room: Some("B-214"),
    };

    fn folder(name: &str) -> Folder {
        let folder = Folder::new(name);
        fs::create_dir_all(&folder.0).unwrap();
        folder
    }

    fn enrol(
        folder: &Folder,
        pseudonym: &str,
        described: Particulars<'_>,
    ) -> Result<usize, String> {
        let participant =
            Participant::new(pseudonym, described).map_err(|error| error.to_string())?;
        let nth = Participants::enrol(&folder.0, &participant, UNIX_EPOCH);
        nth.map_err(|error| error.to_string())
    }

    #[test]
    fn participants_are_numbered_in_the_order_of_coming() {
        let folder = folder("enrol");
        assert_eq!(enrol(&folder, "p01", TOLD), Ok(0));
        assert_eq!(enrol(&folder, "p02", Particulars::default()), Ok(1));
        assert_eq!(enrol(&folder, "p01", TOLD), Ok(0), "the same again");
        assert_eq!(enrol(&folder, "p01", Particulars::default()), Ok(0));
        let text = fs::read_to_string(table_path(&folder.0)).unwrap();
        let rows = "pseudonym,age_years,sex,handedness,experience,room,added_utc\n\
                    p01,31,female,,practised,B-214,1970-01-01T00:00:00.000000Z\n\
                    p02,,,,,,1970-01-01T00:00:00.000000Z\n";
        assert_eq!(text, rows);
        let read = Participants::read(&folder.0).unwrap();
        assert_eq!(read.nth("p02"), Some(1));
        assert_eq!(read.nth("p03"), None);
    }

    #[test]
    fn a_pseudonym_with_other_particulars_is_refused_and_nothing_is_written() {
        let folder = folder("differs");
        enrol(&folder, "p01", TOLD).unwrap();
        let before = fs::read(table_path(&folder.0)).unwrap();
        let left = Particulars {
            handedness: Some("left"),
            ..TOLD
        };
        let described = enrol(&folder, "p01", left).unwrap_err();
        assert!(
            described.contains("handedness was not told then, and is left now"),
            "{described}"
        );
        let older = Particulars {
            age_years: Some(32),
            ..TOLD
        };
        let described = enrol(&folder, "p01", older).unwrap_err();
        assert!(
            described.contains("age_years was 31 then, and is 32 now"),
            "{described}"
        );
        assert_eq!(fs::read(table_path(&folder.0)).unwrap(), before);
    }

    #[test]
    fn names_of_people_and_words_that_are_not_known_are_refused() {
        let folder = folder("words");
        for (pseudonym, described, expected) in [
            ("Ada Lovelace", TOLD, "no real name"),
            (
                "p01",
                Particulars {
                    age_years: Some(0),
                    ..TOLD
                },
                "1 to 120 whole years",
            ),
            (
                "p01",
                Particulars {
                    sex: Some("F"),
                    ..TOLD
                },
                "female, male or other",
            ),
            (
                "p01",
                Particulars {
                    room: Some("Ada's, upstairs"),
                    ..TOLD
                },
                "one word",
            ),
        ] {
            let error = enrol(&folder, pseudonym, described).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        assert!(!table_path(&folder.0).exists());
    }

    #[test]
    fn a_row_that_was_cut_off_is_set_aside_and_the_numbers_stay() {
        let folder = folder("torn");
        enrol(&folder, "p01", TOLD).unwrap();
        let path = table_path(&folder.0);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, [&whole[..], b"p02,2"].concat()).unwrap();
        assert_eq!(Participants::read(&folder.0).unwrap().rows().len(), 1);
        assert_eq!(enrol(&folder, "p02", Particulars::default()), Ok(1));
        let aside = folder.0.join("participants.csv.torn-1");
        assert_eq!(fs::read(aside).unwrap(), b"p02,2");
        assert!(fs::read(&path).unwrap().starts_with(&whole));
    }

    #[test]
    fn a_row_that_was_edited_wrongly_is_named_with_its_line() {
        let folder = folder("edited");
        let header = COLUMNS.join(",");
        let path = table_path(&folder.0);
        fs::write(&path, format!("{header}\np01,,,,,,\np01,,,,,,\n")).unwrap();
        let described = Participants::read(&folder.0).unwrap_err().to_string();
        assert!(
            described.contains("participants.csv:3: p01 is there twice"),
            "{described}"
        );
        fs::write(&path, format!("{header}\np01,old,,,,,\n")).unwrap();
        let described = Participants::read(&folder.0).unwrap_err().to_string();
        assert!(
            described.contains(":2: age_years is \"old\""),
            "{described}"
        );
    }
}
