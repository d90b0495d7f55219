//! Who takes part, as it is typed: filled in from what is known of a pseudonym, checked as the
//! table of participants checks it.

use selvedge_experiment::{Participant, Participants, Particulars};

/// Fields of the form that tell of a participant.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Who {
    /// Pseudonym.
    pub pseudonym: String,
    /// Age, years.
    pub age: String,
    /// One of the table's words, or empty.
    pub sex: String,
    /// One of the table's words, or empty.
    pub handedness: String,
    /// One word.
    pub experience: String,
    /// One word.
    pub room: String,
    /// Whose particulars were filled in, and what they are.
    filled: Option<Participant>,
}

impl Who {
    /// Fills in what is known of the pseudonym that was typed; takes it out again once another is
    /// typed. What was typed since stays.
    pub(crate) fn follow(&mut self, known: &Participants) {
        let described = self.pseudonym.trim();
        if self
            .filled
            .as_ref()
            .is_some_and(|filled| filled.pseudonym() == described)
        {
            return;
        }
        let before = self.filled.take();
        let now = known.nth(described).map(|nth| known.rows()[nth].clone());
        if let Some(before) = before {
            for (field, value) in self.fields().into_iter().zip(before.particulars()) {
                if field == value {
                    field.clear();
                }
            }
        }
        if let Some(now) = &now {
            for (field, value) in self.fields().into_iter().zip(now.particulars()) {
                if field.trim().is_empty() {
                    field.clone_from(value);
                }
            }
        }
        self.filled = now;
    }

    /// Whether the table knows the pseudonym.
    pub(crate) fn is_known(&self) -> bool {
        self.filled.is_some()
    }

    /// Forgets where fields came from: another folder has another table.
    pub(crate) fn leave_table(&mut self) {
        self.follow(&Participants::default());
    }

    /// Who takes part.
    ///
    /// # Errors
    /// What is wrong with what was typed, and how to mend it.
    pub(crate) fn participant(&self) -> Result<Participant, String> {
        let word = |typed: &'_ str| Some(typed.trim().to_owned()).filter(|word| !word.is_empty());
        let age_years = match word(&self.age).map(|age| age.parse()) {
            None => None,
            Some(Ok(years)) => Some(years),
            Some(Err(_)) => return Err("Give the age in whole years, or leave it out".to_owned()),
        };
        let words = [&self.sex, &self.handedness, &self.experience, &self.room];
        let [sex, hand, experience, room] = words.map(|typed| word(typed));
        let particulars = Particulars {
            age_years,
            sex: sex.as_deref(),
            handedness: hand.as_deref(),
            experience: experience.as_deref(),
            room: room.as_deref(),
        };
        Participant::new(self.pseudonym.trim(), particulars).map_err(|error| error.to_string())
    }

    /// In the order of the table.
    fn fields(&mut self) -> [&mut String; 5] {
        [
            &mut self.age,
            &mut self.sex,
            &mut self.handedness,
            &mut self.experience,
            &mut self.room,
        ]
    }
}

#[cfg(test)]
mod tests {
    use std::time::UNIX_EPOCH;

    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn known(name: &str) -> Participants {
        let folder = ScratchFolder::new(name);
        std::fs::create_dir_all(&folder.0).unwrap();
        let described = Particulars {
            age_years: Some(31),
            handedness: Some("left"),
            ..Particulars::default()
        };
        let participant = Participant::new("p01", described).unwrap();
        Participants::enrol(&folder.0, &participant, UNIX_EPOCH).unwrap();
        Participants::read(&folder.0).unwrap()
    }

    #[test]
    fn what_is_known_of_a_pseudonym_is_filled_in_and_taken_out_again() {
        let known = known("who");
        let mut who = Who {
            pseudonym: " p01 ".to_owned(),
            room: "B-214".to_owned(),
            ..Who::default()
        };
        who.follow(&known);
        assert!(who.is_known());
        assert_eq!((who.age.as_str(), who.handedness.as_str()), ("31", "left"));
        assert_eq!(who.room, "B-214", "what was typed stays");
        who.pseudonym.push('2');
        who.follow(&known);
        assert!(!who.is_known());
        assert_eq!((who.age.as_str(), who.handedness.as_str()), ("", ""));
    }

    #[test]
    fn what_is_told_otherwise_than_before_is_contradicted() {
        let known = known("who-otherwise");
        let mut who = Who {
            pseudonym: "p01".to_owned(),
            ..Who::default()
        };
        who.follow(&known);
        assert_eq!(known.contradiction(&who.participant().unwrap()), None);
        who.handedness = "right".to_owned();
        who.follow(&known);
        let line = known.contradiction(&who.participant().unwrap()).unwrap();
        assert!(
            line.contains("handedness was left then, and is right now"),
            "{line}"
        );
        who.age = "12.5".to_owned();
        assert!(who.participant().unwrap_err().contains("whole years"));
    }
}
