//! Where two stimuli are felt as equal, and how much they must differ to be told apart.

use super::{Fit, Psychometric, Resamples};
use crate::{Computed, Interval, Undefined, undefined};

/// A quantity of a fitted function with its intervals.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Its value.
    pub value: f64,
    /// Standard error by the delta method.
    pub se: Computed,
    /// Interval by the delta method.
    pub delta: Computed<Interval>,
    /// Interval by the parametric bootstrap.
    pub bootstrap: Computed<Interval>,
}

/// What answers `stronger than the reference` say.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The point of subjective equality: the stimulus called stronger half of the time.
    pub pse: Measured,
    /// How far it lies above the reference.
    pub constant_error: f64,
    /// Half the distance of the stimuli called stronger 25 % and 75 % of the time, lapses apart.
    pub jnd: Measured,
    /// JND over reference.
    pub weber_fraction: Computed<Measured>,
}

impl Fit {
    /// A quantity with its intervals at the level of the resamples.
    ///
    /// # Errors
    /// A quantity that the function does not have.
    fn measured(
        &self,
        quantity: impl Fn(&Psychometric) -> Computed,
        resamples: &Resamples,
    ) -> Computed<Measured> {
        let delta = self.delta(&quantity, resamples.level);
        self.measured_by(delta, quantity, resamples)
    }

    /// Likewise of a quantity above zero; see [`Self::delta_positive`].
    ///
    /// # Errors
    /// As [`Self::measured`].
    fn measured_positive(
        &self,
        quantity: impl Fn(&Psychometric) -> Computed,
        resamples: &Resamples,
    ) -> Computed<Measured> {
        let delta = self.delta_positive(&quantity, resamples.level);
        self.measured_by(delta, quantity, resamples)
    }

    fn measured_by(
        &self,
        delta: Computed<(f64, Interval)>,
        quantity: impl Fn(&Psychometric) -> Computed,
        resamples: &Resamples,
    ) -> Computed<Measured> {
        Ok(Measured {
            value: quantity(&self.curve)?,
            se: delta.clone().map(|(se, _)| se),
            delta: delta.map(|(_, interval)| interval),
            bootstrap: resamples.interval(&quantity).map(|(_, interval)| interval),
        })
    }

    /// Reads a two-sided function against its reference, both in the unit of the stimulus.
    ///
    /// # Errors
    /// A reference that is not finite.
    pub fn comparison(&self, reference: f64, resamples: &Resamples) -> Computed<Comparison> {
        if !reference.is_finite() {
            return undefined("the reference is not finite");
        }
        let pse = self.measured(|curve| curve.stimulus_at_shape(0.5), resamples)?;
        let per_reference = |curve: &Psychometric| {
            let is_positive = reference > 0.0;
            let share = is_positive.then(|| curve.jnd().map(|jnd| jnd / reference));
            let reason = || format!("a Weber fraction of a reference of {reference}");
            share.ok_or_else(|| Undefined::because(reason()))?
        };
        Ok(Comparison {
            constant_error: pse.value - reference,
            pse,
            jnd: self.measured_positive(Psychometric::jnd, resamples)?,
            weber_fraction: self.measured_positive(per_reference, resamples),
        })
    }
}
