//! Why a cloth cannot be simulated: one line that says what, where and how to mend it.

use selvedge_foundation::files::FileError;
use selvedge_render::RenderError;
use selvedge_render::scene::SceneError;
use selvedge_textile::TextileError;

/// Why a cloth cannot be simulated.
#[derive(Debug, thiserror::Error)]
pub enum DrapeError {
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A textile or a library.
    #[error(transparent)]
    Textile(#[from] TextileError),
    /// A display.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// What is felt of it.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A figure that no cloth, or no step, can have.
    #[error("the {name} is {value} {unit}; give {min} to {max} {unit}")]
    Range {
        /// Which one.
        name: &'static str,
        /// What it is.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The smallest.
        min: f64,
        /// The largest.
        max: f64,
    },
    /// A step that explicit integration does not hold.
    #[error(
        "explicit steps of {:.3} ms are unstable: at most {:.3} ms with what is stretched now; \
         give a smaller --dt, or --integrator bdf2",
        1e3 * step_s, 1e3 * limit_s
    )]
    Unstable {
        /// The step, s.
        step_s: f64,
        /// The limit, s.
        limit_s: f64,
    },
    /// Anything else that is wrong with what was given.
    #[error("{what}; {mend}")]
    Input {
        /// What is wrong.
        what: String,
        /// How to mend it.
        mend: String,
    },
}

impl DrapeError {
    /// Refuses a figure that is outside a range, or no number.
    pub(crate) fn within(
        (name, value, unit): (&'static str, f64, &'static str),
        [min, max]: [f64; 2],
    ) -> Result<(), Self> {
        if (min..=max).contains(&value) {
            return Ok(());
        }
        Err(Self::Range {
            name,
            value,
            unit,
            min,
            max,
        })
    }

    pub(crate) fn input(what: impl Into<String>, mend: impl Into<String>) -> Self {
        let (what, mend) = (what.into(), mend.into());
        Self::Input { what, mend }
    }
}
