//! An axis as plain data: what it measures, how values are laid on it, where it ends.

/// How values are laid on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm; values that are not above zero have no place.
    Log,
    /// Evenly, with a label at whole numbers alone: rows, columns, counts.
    Whole,
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// What it measures, with the unit: `time a tick, s`.
    pub label: String,
    /// How values are laid on it.
    pub scale: Scale,
    /// Its ends; `None` takes those of the values, rounded.
    pub range: Option<[f64; 2]>,
}

impl Scale {
    /// Where a value stands before it is scaled to an axis; `None` where it has no place.
    pub fn place(self, value: f64) -> Option<f64> {
        match self {
            _ if !value.is_finite() => None,
            Self::Linear | Self::Whole => Some(value),
            Self::Log => (value >= f64::MIN_POSITIVE).then(|| value.log10()),
        }
    }

    /// The value that stands at a place.
    pub fn value(self, place: f64) -> f64 {
        match self {
            Self::Linear | Self::Whole => place,
            Self::Log => 10_f64.powf(place),
        }
    }
}

impl Axis {
    /// One on which values are laid evenly, from the least to the largest.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    /// One on which they are laid by their logarithm.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// One with labels at whole numbers alone.
    pub fn whole(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Whole,
            ..Self::linear(label)
        }
    }

    /// The same from here to there, whatever the values.
    #[must_use]
    pub fn within(self, ends: [f64; 2]) -> Self {
        Self {
            range: Some(ends),
            ..self
        }
    }
}
