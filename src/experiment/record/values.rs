//! What a record holds in a column: how it stands in a cell, and what a cell is taken for.

use crate::design::Design;
use crate::named::Named as _;
use crate::presentation::Proof;
use crate::trial::Adjustment;
use selvedge_foundation::files::push_number;

/// What is wrong with a cell after `COLUMN is`, and how to mend it; `None` where the type of the
/// column says both.
pub(super) type Wrong = Option<(String, String)>;

/// What a record holds in a column.
pub(super) trait Value {
    /// As its cell has it.
    fn cell(&self, design: &Design) -> String;

    /// Takes what a cell has.
    ///
    /// # Errors
    /// It is no such value.
    fn take(&mut self, cell: &str, design: &Design) -> Result<(), Wrong>;

    /// Whether it is read: not what follows from something else.
    fn is_read(&self) -> bool {
        true
    }
}

/// What follows from the rest of the record: written, not read.
pub(super) struct Derived(pub(super) String);

pub(super) fn derived(value: &(impl ToString + ?Sized)) -> Derived {
    Derived(value.to_string())
}

pub(super) fn derived_if(value: Option<impl ToString>) -> Derived {
    Derived(value.map_or_else(String::new, |value| value.to_string()))
}

impl Value for Derived {
    fn cell(&self, _: &Design) -> String {
        self.0.clone()
    }

    fn take(&mut self, _: &str, _: &Design) -> Result<(), Wrong> {
        Ok(())
    }

    fn is_read(&self) -> bool {
        false
    }
}

/// A part of an answer; an empty cell where nothing was answered.
pub(super) struct If<'a>(pub(super) bool, pub(super) &'a mut dyn Value);

impl Value for If<'_> {
    fn cell(&self, design: &Design) -> String {
        let cell = self.0.then(|| self.1.cell(design));
        cell.unwrap_or_default()
    }

    fn take(&mut self, cell: &str, design: &Design) -> Result<(), Wrong> {
        self.1.take(cell, design)
    }

    fn is_read(&self) -> bool {
        self.0 && self.1.is_read()
    }
}

/// What a cell has as it is parsed.
macro_rules! parsed {
    ($($kind:ty: $text:expr),+) => {$(
        impl Value for $kind {
            fn cell(&self, _: &Design) -> String {
                let text: fn(&Self) -> String = $text;
                text(self)
            }

            fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
                *self = cell.parse().ok().ok_or(None)?;
                Ok(())
            }
        }
    )+};
}
parsed!(
    u8: ToString::to_string,
    u32: ToString::to_string,
    u64: ToString::to_string,
    f64: |value| number(*value),
    String: Self::clone
);

impl Value for bool {
    fn cell(&self, _: &Design) -> String {
        flag(*self)
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        *self = ["0", "1"]
            .iter()
            .position(|known| *known == cell)
            .ok_or(None)?
            == 1;
        Ok(())
    }
}

/// What may be missing: an empty cell.
macro_rules! optional {
    ($($kind:ty: $text:expr),+) => {$(
        impl Value for Option<$kind> {
            fn cell(&self, _: &Design) -> String {
                let text: fn(&$kind) -> String = $text;
                self.as_ref().map_or_else(String::new, text)
            }

            fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
                *self = match cell {
                    "" => None,
                    cell => Some(cell.parse().ok().ok_or(None)?),
                };
                Ok(())
            }
        }
    )+};
}
optional!(
    u8: ToString::to_string,
    u64: ToString::to_string,
    f64: |value| number(*value)
);

impl Value for Option<Proof> {
    fn cell(&self, _: &Design) -> String {
        self.map_or_else(String::new, |proof| proof.name().to_owned())
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        let known = Proof::named().into_iter().find(|(name, _)| *name == cell);
        *self = known.map(|(_, proof)| proof);
        let mend = "give array, emulator, screen, real-cloth, elsewhere, simulated or nothing";
        if self.is_none() && !cell.is_empty() {
            return Err(Some((format!("{cell:?}"), mend.to_owned())));
        }
        Ok(())
    }
}

/// Several times, s.
pub(super) struct Seconds<'a>(pub(super) &'a mut Vec<f64>);

impl Value for Seconds<'_> {
    fn cell(&self, _: &Design) -> String {
        let texts = self.0.iter().map(|&value| number(value));
        texts.collect::<Vec<String>>().join("; ")
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        let texts = cell.split(';').filter(|_| !cell.is_empty());
        let values: Option<Vec<f64>> = texts.map(|text| text.trim().parse().ok()).collect();
        *self.0 = values
            .ok_or_else(|| Some((format!("{cell:?}"), "give s; s; … or nothing".to_owned())))?;
        Ok(())
    }
}

/// A grade from 1 by its word.
pub(super) struct Grade<'a>(pub(super) &'a mut Option<u8>, pub(super) &'a [&'a str]);

impl Value for Grade<'_> {
    fn cell(&self, _: &Design) -> String {
        let word = self
            .0
            .and_then(|grade| self.1.get(usize::from(grade).checked_sub(1)?));
        word.map_or_else(String::new, |word| (*word).to_owned())
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        let at = named_one_of(cell, self.1)?;
        *self.0 = u8::try_from(at + 1).ok();
        Ok(())
    }
}

/// Which of several words a cell has.
fn named_one_of(cell: &str, words: &[&str]) -> Result<usize, Wrong> {
    let found = words.iter().position(|word| *word == cell);
    found.ok_or_else(|| Some((format!("{cell:?}"), format!("give {}", words.join(" or ")))))
}

/// A number from 0 that files count from 1.
pub(super) struct Count<'a>(pub(super) &'a mut usize);

impl Value for Count<'_> {
    fn cell(&self, _: &Design) -> String {
        position(*self.0)
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        let number: usize = cell.parse().ok().ok_or(None)?;
        let less = number.checked_sub(1);
        *self.0 = less.ok_or_else(|| Some(("0".to_owned(), "count from 1".to_owned())))?;
        Ok(())
    }
}

/// A stimulus by its number in the design; cells have its id.
pub(super) struct Stimulus<'a>(pub(super) &'a mut usize);

impl Value for Stimulus<'_> {
    fn cell(&self, design: &Design) -> String {
        let found = design.stimuli.get(*self.0);
        found.map_or_else(String::new, |stimulus| stimulus.id.clone())
    }

    fn take(&mut self, cell: &str, design: &Design) -> Result<(), Wrong> {
        let found = design
            .stimuli
            .iter()
            .position(|stimulus| stimulus.id == cell);
        *self.0 = found.ok_or_else(|| {
            let what = format!("{cell:?}, which is no stimulus of the design");
            Some((what, "use the design that the log was made with".to_owned()))
        })?;
        Ok(())
    }
}

/// The word that was chosen.
pub(super) struct Word<'a>(pub(super) &'a mut usize, pub(super) &'a [&'a str; 2]);

impl Value for Word<'_> {
    fn cell(&self, _: &Design) -> String {
        let word = self.1.get(*self.0);
        word.map_or_else(String::new, |word| (*word).to_owned())
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        *self.0 = named_one_of(cell, self.1)?;
        Ok(())
    }
}

/// Whether the first of two is right.
pub(super) struct First<'a>(pub(super) &'a mut usize);

impl Value for First<'_> {
    fn cell(&self, _: &Design) -> String {
        flag(*self.0 == 0)
    }

    fn take(&mut self, cell: &str, design: &Design) -> Result<(), Wrong> {
        let mut is_first = false;
        is_first.take(cell, design)?;
        *self.0 = usize::from(!is_first);
        Ok(())
    }
}

/// Every change of an adjustment, by the keys of its parameters.
pub(super) struct Steps<'a>(
    pub(super) &'a mut Vec<Adjustment>,
    pub(super) &'a [&'static str],
);

impl Value for Steps<'_> {
    fn cell(&self, _: &Design) -> String {
        let texts = self.0.iter().filter_map(|step| {
            let (at_ms, value) = (number(step.at_ms), number(step.value));
            Some(format!("{at_ms}:{}={value}", self.1.get(step.parameter)?))
        });
        texts.collect::<Vec<_>>().join("; ")
    }

    fn take(&mut self, cell: &str, _: &Design) -> Result<(), Wrong> {
        let step = |text: &str| {
            let (at_ms, rest) = text.trim().split_once(':')?;
            let (key, value) = rest.split_once('=')?;
            Some(Adjustment {
                at_ms: at_ms.parse().ok()?,
                parameter: self.1.iter().position(|&known| known == key)?,
                value: value.parse().ok()?,
            })
        };
        let texts = cell.split(';').filter(|_| !cell.is_empty());
        let steps: Option<Vec<Adjustment>> = texts.map(step).collect();
        let mend = "give ms:key=value; … or nothing".to_owned();
        let wrong = || Some((format!("{cell:?}"), mend));
        *self.0 = steps.ok_or_else(wrong)?;
        Ok(())
    }
}

pub(super) fn flag(is_so: bool) -> String {
    u8::from(is_so).to_string()
}

pub(super) fn position(at: usize) -> String {
    (at + 1).to_string()
}

pub(super) fn number(value: f64) -> String {
    let mut text = String::new();
    push_number(&mut text, value);
    text
}
