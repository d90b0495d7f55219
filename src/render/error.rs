//! Why something cannot be rendered.

use selvedge_textile::tactile::TuningError;

/// Why something cannot be rendered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// A gain, or compression, makes no sense.
    #[error(transparent)]
    Tuning(#[from] TuningError),
    /// A place, size or angle is NaN or infinite.
    #[error("the place, size or angle of {what} {index} is not finite; give finite numbers")]
    NotFinite {
        /// Textile or display.
        what: &'static str,
        /// Which one, from 0.
        index: usize,
    },
    /// More textiles than an index can name.
    #[error("{n_textiles} textiles in one scene; place at most {at_most}")]
    TooManyTextiles {
        /// How many there are.
        n_textiles: usize,
        /// How many there may be.
        at_most: usize,
    },
    /// A textile that the scene does not place.
    #[error("there is no textile {index}; the scene places {n_textiles}, counted from 0")]
    NoTextile {
        /// Which one was meant, from 0.
        index: usize,
        /// How many there are.
        n_textiles: usize,
    },
    /// Levels do not match the textiles placed.
    #[error("{given} levels for {wanted} textiles; give one for each")]
    WrongNumberOfLevels {
        /// How many were given.
        given: usize,
        /// How many textiles there are.
        wanted: usize,
    },
    /// The tables of these textiles would not fit.
    #[error("the tables would take {megabytes} MB; use method banded, or shorter profiles")]
    TableTooLarge {
        /// How much they would take, 10⁶ bytes.
        megabytes: usize,
    },
    /// An error budget or a filter floor that is no number or negative.
    #[error("{key} is {value}; give a finite number, 0 or above")]
    Accuracy {
        /// Which one.
        key: &'static str,
        /// What it was.
        value: f64,
    },
    /// A sample rate or a scale that no waveform can have.
    #[error("{key} is {value}; {mend}")]
    Drive {
        /// Which one.
        key: &'static str,
        /// What it was.
        value: f64,
        /// How to mend it.
        mend: &'static str,
    },
    /// A stylus, its surface or its device that cannot be, or that no method holds.
    #[error("{what}; {mend}")]
    Stylus {
        /// What is wrong.
        what: String,
        /// How to mend it.
        mend: String,
    },
}

impl RenderError {
    /// What is wrong with a stylus, and how to mend it.
    pub(crate) fn stylus(what: impl Into<String>, mend: impl Into<String>) -> Self {
        let (what, mend) = (what.into(), mend.into());
        Self::Stylus { what, mend }
    }

    /// Refuses a figure of a stylus that is outside a range, in a unit, or no number.
    pub(crate) fn within(
        (name, value, unit): (&str, f64, &str),
        [min, max]: [f64; 2],
    ) -> Result<(), Self> {
        if (min..=max).contains(&value) {
            return Ok(());
        }
        let short = |number: f64| {
            if number.abs() >= 1e5 && number.is_finite() {
                format!("{number:e}")
            } else {
                number.to_string()
            }
        };
        Err(Self::stylus(
            format!("the {name} is {} {unit}", short(value)),
            format!("give one from {} to {} {unit}", short(min), short(max)),
        ))
    }
}
