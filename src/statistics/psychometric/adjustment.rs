//! The method of adjustment: settings made from above and from below.

use crate::summary::at_least;
use crate::{Computed, Outcome, Summary, TwoSamples, undefined};

/// How settings are averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Settings {
    /// As they are.
    Linear,
    /// By their natural logarithms: frequencies, amplitudes.
    Log,
}

/// Settings by where their adjustment began.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Starts<'a> {
    /// Adjusted upwards, from a low start.
    pub ascending: &'a [f64],
    /// Adjusted downwards, from a high start.
    pub descending: &'a [f64],
}

/// What settings come to.
#[derive(Debug, Clone, PartialEq)]
pub struct Adjustments {
    /// The mean in the unit of the settings: arithmetic, or geometric for logarithms.
    pub centre: f64,
    /// All of them, on the scale they are averaged on; sd by n − 1.
    pub all: Summary,
    /// Those from below.
    pub ascending: Computed<Summary>,
    /// Those from above.
    pub descending: Computed<Summary>,
    /// Whether the start decides: ascending less descending by Welch's test, on that scale.
    pub difference: Computed<Outcome>,
}

impl Adjustments {
    /// Of at least two settings, in whichever direction.
    ///
    /// # Errors
    /// Fewer, settings that are not finite, settings that have no logarithm where one is asked for.
    pub fn of(starts: Starts<'_>, settings: Settings) -> Computed<Self> {
        let scaled = |values: &[f64]| -> Computed<Vec<f64>> {
            at_least(values, 0)?;
            let bad = values.iter().position(|&v| v <= 0.0);
            match (settings, bad) {
                (Settings::Linear, _) => Ok(values.to_vec()),
                (Settings::Log, None) => Ok(values.iter().map(|v| v.ln()).collect()),
                (Settings::Log, Some(place)) => undefined(format!(
                    "setting {} of {} is {}: it has no logarithm",
                    place + 1,
                    values.len(),
                    values[place]
                )),
            }
        };
        let (ascending, descending) = (scaled(starts.ascending)?, scaled(starts.descending)?);
        let all = Summary::of(&[ascending.as_slice(), descending.as_slice()].concat())?;
        let [ascending, descending] = [ascending, descending].map(|values| Summary::of(&values));
        let difference = match (&ascending, &descending) {
            (Ok(up), Ok(down)) => TwoSamples::of(up, down).map(|both| both.welch),
            (Err(reason), _) | (_, Err(reason)) => Err(reason.clone()),
        };
        Ok(Self {
            centre: match settings {
                Settings::Linear => all.mean,
                Settings::Log => all.mean.exp(),
            },
            all,
            ascending,
            descending,
            difference,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_give_the_geometric_mean_and_the_start_its_effect() -> Computed<()> {
        let starts = Starts {
            ascending: &[10.0, 20.0, 40.0],
            descending: &[40.0, 80.0, 160.0],
        };
        let found = Adjustments::of(starts, Settings::Log)?;
        assert!((found.centre - 40.0).abs() < 1e-12, "{found:?}");
        // In octaves about the mean −2, −1, 0, 0, 1, 2: squares 10, over n − 1 = 5.
        assert!(
            (found.all.sd - 2.0_f64.ln() * 2.0_f64.sqrt()).abs() < 1e-12,
            "n − 1"
        );
        let difference = found.difference?;
        assert!(
            (difference.estimate?.value + 4.0_f64.ln()).abs() < 1e-12,
            "two octaves"
        );
        let linear = Adjustments::of(starts, Settings::Linear)?;
        assert!((linear.centre - 350.0 / 6.0).abs() < 1e-12, "{linear:?}");
        Ok(())
    }

    #[test]
    fn one_direction_alone_has_no_effect_of_the_start_and_zero_no_logarithm() -> Computed<()> {
        let up = Starts {
            ascending: &[1.0, 2.0],
            descending: &[],
        };
        let found = Adjustments::of(up, Settings::Linear)?;
        assert!(
            found.difference.is_err() && found.descending.is_err(),
            "{found:?}"
        );
        let zero = Starts {
            ascending: &[1.0, 0.0],
            descending: &[],
        };
        let refused = Adjustments::of(zero, Settings::Log).map_err(|e| e.reason);
        assert!(
            refused.is_err_and(|r| r.contains("setting 2 of 2 is 0")),
            "said"
        );
        Ok(())
    }
}
