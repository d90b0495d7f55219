//! What a slider measures: its ends, its steps, and how values lie along its rail.

/// The share of a rail over decades that is kept for zero.
const ZERO_SHARE: f64 = 0.08;
/// Steps of the arrow keys in a decade.
const STEPS_A_DECADE: f64 = 20.0;

/// How a slider's values lie along its rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Curve {
    /// Evenly.
    Even,
    /// Evenly over so many decades below the highest value, with zero at the lower end.
    Decades(f64),
}

/// What a slider measures.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    /// Lowest value.
    pub least: f64,
    /// Highest value.
    pub most: f64,
    /// The value that a double click goes back to.
    pub resting: f64,
    /// One step of the arrow keys; values from the rail are multiples of it.
    pub step: f64,
    /// Digits after the point.
    pub decimals: usize,
    /// The unit.
    pub unit: &'static str,
    /// Shown values are stored values times this (100 for %).
    pub factor: f64,
    /// The change that is just noticed, if it is known: marked while the slider is held or hovered.
    pub noticed: Option<f64>,
    /// How values lie along the rail.
    pub curve: Curve,
}

impl Scale {
    /// Even steps between two ends, shown with so many decimals and a unit.
    pub(crate) const fn even(
        [least, most]: [f64; 2],
        resting: f64,
        step: f64,
        (decimals, unit): (usize, &'static str),
    ) -> Self {
        Self {
            least,
            most,
            resting,
            step,
            decimals,
            unit,
            factor: 1.0,
            noticed: None,
            curve: Curve::Even,
        }
    }

    /// Gains from −30 to +30 dB.
    pub(crate) fn gain(resting: f64) -> Self {
        Self::even([-30.0, 30.0], resting, 0.1, (1, "dB"))
    }

    /// The same with the change that is just noticed.
    pub(crate) fn with_noticed(self, noticed: Option<f64>) -> Self {
        Self { noticed, ..self }
    }

    /// Shares from 0 to 100 %.
    pub(crate) fn share(resting: f64) -> Self {
        Self {
            factor: 100.0,
            ..Self::even([0.0, 1.0], resting, 0.01, (0, "%"))
        }
    }

    /// A value from the rail, rounded as befits it.
    pub(crate) fn stepped(&self, value: f64) -> f64 {
        if let Curve::Decades(_) = self.curve {
            return two_digits(value).clamp(self.least, self.most);
        }
        let whole = (value / self.step).round();
        // Dividing by the reciprocal keeps tenths as short in files as on the screen.
        (whole / (1.0 / self.step).round()).clamp(self.least, self.most)
    }

    /// The value so many steps of the arrow keys away.
    pub(crate) fn moved(&self, value: f64, steps: f64) -> f64 {
        let Curve::Decades(decades) = self.curve else {
            return (value + steps * self.step).clamp(self.least, self.most);
        };
        let lowest = self.most * 10.0_f64.powf(-decades);
        let factor = 10.0_f64.powf(steps / STEPS_A_DECADE);
        match value * factor {
            _ if value <= 0.0 && steps > 0.0 => lowest,
            next if next < lowest * 0.999 => 0.0,
            next => next.min(self.most),
        }
    }

    /// Where a value lies along the rail, 0…1.
    pub(crate) fn share_of(&self, value: f64) -> f64 {
        if let Curve::Decades(decades) = self.curve {
            if value <= 0.0 {
                return 0.0;
            }
            let share = 1.0 + (value / self.most).log10() / decades;
            return ZERO_SHARE + (1.0 - ZERO_SHARE) * share.clamp(0.0, 1.0);
        }
        ((value - self.least) / (self.most - self.least)).clamp(0.0, 1.0)
    }

    /// The value at a share of the rail.
    pub(crate) fn value_at(&self, share: f64) -> f64 {
        if let Curve::Decades(decades) = self.curve {
            let above = (share.clamp(0.0, 1.0) - ZERO_SHARE) / (1.0 - ZERO_SHARE);
            return if share < 0.5 * ZERO_SHARE {
                0.0
            } else {
                self.most * 10.0_f64.powf(decades * (above.max(0.0) - 1.0))
            };
        }
        self.least + share.clamp(0.0, 1.0) * (self.most - self.least)
    }

    /// Reads what was typed and brings it within the ends.
    pub(crate) fn parsed(&self, text: &str) -> Option<f64> {
        let value = self.read(text)?;
        Some(value.clamp(self.least, self.most))
    }

    /// Reads what was typed: digits with a comma or a point, any minus, the unit or none.
    pub(crate) fn read(&self, text: &str) -> Option<f64> {
        let bare = text.trim().trim_end_matches(self.unit).trim();
        let plain = bare.replace('−', "-").replace(',', ".");
        let value = plain.parse::<f64>().ok()? / self.factor;
        value.is_finite().then_some(value)
    }
}

/// A positive number rounded to two digits; 0 stays.
fn two_digits(value: f64) -> f64 {
    // What is printed and read again is as short in files as on the screen.
    format!("{value:.1e}").parse().unwrap_or(value)
}
