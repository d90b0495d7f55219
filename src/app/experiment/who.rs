//! Who takes part, as it is typed: filled in from what is known of a pseudonym, checked as the
//! table of participants checks it.

use crate::experiment::{Participant, Participants, Particulars};

/// Fields of the form that tell of a participant.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Who {
    /// Pseudonym.
    pub(crate) pseudonym: String,
    /// Age, years.
    pub(crate) age: String,
    /// One of the table's words, or empty.
    pub(crate) sex: String,
    /// One of the table's words, or empty.
    pub(crate) handedness: String,
    /// One word.
    pub(crate) experience: String,
    /// One word.
    pub(crate) room: String,
    /// Whose particulars were filled in, and what they are.
    filled: Option<Participant>,
}

impl Who {
    /// Fills in what is known of the pseudonym that was typed; takes it out again once another is
    /// typed. What was typed since stays.
    pub(crate) fn follow(&mut self, known: &Participants) {
        let told = self.pseudonym.trim();
        if self
            .filled
            .as_ref()
            .is_some_and(|filled| filled.pseudonym() == told)
        {
            return;
        }
        let before = self.filled.take();
        let now = known.nth(told).map(|nth| known.rows()[nth].clone());
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
    pub(crate) fn told(&self) -> Result<Participant, String> {
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
