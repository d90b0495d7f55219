//! Where values stand on an axis, and where its ticks are: 1, 2, 5 in every decade.

use super::{Axis, Scale};
use selvedge_foundation::numerics::to_whole;

/// Values beyond this are drawn at it: far beyond anything that is measured.
const LARGEST: f64 = 1e300;
/// Up to this many decades each 1, 2 and 5 has a label.
const DECADES_WITH_ALL_LABELS: f64 = 3.0;
/// Up to this many decades each decade has a label.
const DECADES_WITH_LABELS: f64 = 10.0;
/// A view of a logarithmic axis with less than this many decades has even steps.
const LEAST_DECADES: f64 = 0.7;
/// What 1, 2 and 5 take of the room for labels in every decade of a view.
const LABELS_A_DECADE: f64 = 3.4;
/// Steps that a linear axis is divided into, about.
const N_STEPS: f64 = 5.0;
/// The same where every whole number ought to have a label.
const N_WHOLE_STEPS: f64 = 12.0;

/// An axis with its ends and ticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Ruler {
    scale: Scale,
    /// The ends, as values.
    ends: [f64; 2],
    /// Values with a label.
    pub(super) labelled: Vec<f64>,
    /// Values with a hairline; those with a label among them.
    pub(super) hairlines: Vec<f64>,
    /// The distance between labels of a linear axis; 0 on a logarithmic one.
    pub(super) step: f64,
}

impl Ruler {
    /// The ruler of an axis on which these values are to be seen.
    pub(super) fn of(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let has_place = |&value: &f64| axis.scale.place(value).is_some();
        let given = axis.range.filter(|[low, high]| {
            has_place(low) && has_place(high) && low < high && high.abs() <= LARGEST
        });
        let seen = values
            .filter(has_place)
            .map(|value| value.clamp(-LARGEST, LARGEST))
            .fold(None, |ends: Option<[f64; 2]>, value| {
                let [low, high] = ends.unwrap_or([value; 2]);
                Some([low.min(value), high.max(value)])
            });
        match axis.scale {
            Scale::Log => Self::log(given, seen.unwrap_or([1.0, 10.0])),
            Scale::Linear | Scale::Whole => {
                let seen = seen.unwrap_or([0.0, 1.0]);
                Self::even(axis.scale, given, seen)
            }
        }
    }

    /// How far along the axis a value stands, 0 at its low end and 1 at its high one; `None` where
    /// it has no place.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        let at = self.scale.place(value)?;
        let [low, high] = self.ends.map(|end| self.scale.place(end).unwrap_or(0.0));
        let share = (at - low) / (high - low);
        share.is_finite().then_some(share)
    }

    /// The ends, as values.
    pub fn ends(&self) -> [f64; 2] {
        self.ends
    }

    /// How its values are laid.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// The ruler of a part of an axis with room for about so many labels: 1, 2, 5 of each decade,
    /// or whole decades, or every second decade …, on a logarithmic axis; even steps on an even
    /// one, and where a logarithmic one shows less than a decade.
    pub fn in_view(scale: Scale, ends: [f64; 2], room: f64) -> Self {
        let room = room.clamp(2.0, 40.0);
        let decades = (ends[1] / ends[0]).log10();
        if scale == Scale::Log && decades >= LEAST_DECADES {
            let ruler = Self::log_in_view(ends, decades, room);
            if ruler.labelled.len() > 1 {
                return ruler;
            }
        }
        let finer = (0..5).map(|i| room * 1.6_f64.powi(i));
        let mut rulers = finer.map(|room| Self::even_in_view(scale, ends, room));
        let coarsest = rulers
            .next()
            .unwrap_or_else(|| Self::even(scale, None, ends));
        if coarsest.labelled.len() > 1 || scale == Scale::Whole {
            return coarsest;
        }
        let found = rulers.find(|ruler| ruler.labelled.len() > 1);
        found.unwrap_or(coarsest)
    }

    fn log_in_view(ends: [f64; 2], decades: f64, room: f64) -> Self {
        let steps = steps_within(ends);
        let labelled = if LABELS_A_DECADE * decades <= room {
            steps
        } else {
            let stride = (decades / room).ceil().max(1.0);
            let is_in_stride = |value: &f64| {
                is_power_of_ten(*value) && f64::from(decade_of(*value)).rem_euclid(stride) < 0.5
            };
            steps.into_iter().filter(is_in_stride).collect()
        };
        Self {
            scale: Scale::Log,
            ends,
            hairlines: labelled.clone(),
            labelled,
            step: 0.0,
        }
    }

    fn even_in_view(scale: Scale, ends: [f64; 2], room: f64) -> Self {
        let step = step_near((ends[1] - ends[0]) / room);
        let step = if scale == Scale::Whole {
            step.max(1.0)
        } else {
            step
        };
        let (first, last) = (ends[0] / step - 1e-9, ends[1] / step + 1e-9);
        Self::stepped(scale, ends, step, [first.ceil(), last.floor()])
    }

    /// Labels from the first to the last multiple of a step.
    fn stepped(scale: Scale, ends: [f64; 2], step: f64, [first, last]: [f64; 2]) -> Self {
        let mut labelled = Vec::new();
        let mut at = first;
        while at <= last && labelled.len() < 100 {
            labelled.push(at * step);
            at += 1.0;
        }
        Self {
            scale,
            ends,
            hairlines: labelled.clone(),
            labelled,
            step,
        }
    }

    fn log(given: Option<[f64; 2]>, [least, most]: [f64; 2]) -> Self {
        let mut ends = given.unwrap_or_else(|| [step_below(least), step_above(most)]);
        if ends[0] >= ends[1] {
            ends = [step_below(ends[0] * 0.99), step_above(ends[1] * 1.01)];
        }
        let decades = (ends[1] / ends[0]).log10();
        let steps = steps_within(ends);
        let is_decade = |value: &f64| is_power_of_ten(*value);
        let decades_only: Vec<f64> = steps.iter().copied().filter(is_decade).collect();
        let (labelled, hairlines) = if decades <= DECADES_WITH_ALL_LABELS {
            (steps.clone(), steps)
        } else if decades <= DECADES_WITH_LABELS {
            (decades_only, steps)
        } else {
            let every = decades_only.len().div_ceil(8).max(1);
            let labelled = decades_only.iter().copied().step_by(every).collect();
            (labelled, decades_only)
        };
        Self {
            scale: Scale::Log,
            ends,
            labelled,
            hairlines,
            step: 0.0,
        }
    }

    fn even(scale: Scale, given: Option<[f64; 2]>, [least, most]: [f64; 2]) -> Self {
        let mut ends = given.unwrap_or([least, most]);
        let largest = ends[0].abs().max(ends[1].abs());
        if ends[1] - ends[0] <= 1e-9 * largest || ends[0] >= ends[1] {
            let around = if largest > 0.0 { 0.1 * largest } else { 1.0 };
            ends = [ends[0] - around, ends[1] + around];
        }
        let step = if scale == Scale::Whole {
            step_near((ends[1] - ends[0]) / N_WHOLE_STEPS).max(1.0)
        } else {
            step_near((ends[1] - ends[0]) / N_STEPS)
        };
        let (first, last) = if given.is_some() {
            let (low, high) = (ends[0] / step - 1e-9, ends[1] / step + 1e-9);
            (low.ceil(), high.floor())
        } else {
            let (low, high) = (ends[0] / step + 1e-9, ends[1] / step - 1e-9);
            ends = [low.floor() * step, high.ceil() * step];
            (low.floor(), high.ceil())
        };
        Self::stepped(scale, ends, step, [first, last])
    }
}

/// The decade that a value above zero lies in: `⌊log₁₀ v⌋`.
fn decade_of(value: f64) -> i32 {
    to_whole((value.log10() + 1e-9).floor())
}

/// `mantissa · 10^decade`, exactly as its digits read.
fn power(mantissa: u8, decade: i32) -> f64 {
    format!("{mantissa}e{decade}").parse().unwrap_or(f64::NAN)
}

fn is_power_of_ten(value: f64) -> bool {
    let ten = power(1, decade_of(value));
    (value - ten).abs() <= 1e-9 * ten
}

/// The largest of 1, 2, 5 in any decade that is not above a value.
fn step_below(value: f64) -> f64 {
    let decade = decade_of(value);
    let is_below = |&mantissa: &u8| power(mantissa, decade) <= value * (1.0 + 1e-9);
    power([5, 2, 1].into_iter().find(is_below).unwrap_or(1), decade).max(f64::MIN_POSITIVE)
}

/// The smallest of 1, 2, 5 in any decade that is not below a value.
fn step_above(value: f64) -> f64 {
    let decade = decade_of(value);
    let is_above = |&mantissa: &u8| power(mantissa, decade) >= value * (1.0 - 1e-9);
    power([1, 2, 5].into_iter().find(is_above).unwrap_or(10), decade)
}

/// Whichever of 1, 2, 5 in any decade is the first at or above a value.
fn step_near(value: f64) -> f64 {
    if value > 0.0 { step_above(value) } else { 1.0 }
}

/// Every 1, 2, 5 within two ends.
fn steps_within([low, high]: [f64; 2]) -> Vec<f64> {
    let is_within = |value: &f64| *value >= low * (1.0 - 1e-9) && *value <= high * (1.0 + 1e-9);
    (decade_of(low)..=decade_of(high))
        .flat_map(|decade| [1, 2, 5].map(|mantissa| power(mantissa, decade)))
        .filter(is_within)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ruler(scale: Scale, range: Option<[f64; 2]>, values: &[f64]) -> Ruler {
        let axis = Axis {
            label: String::new(),
            scale,
            range,
        };
        Ruler::of(&axis, values.iter().copied())
    }

    #[test]
    fn a_logarithmic_axis_has_1_2_5_in_every_decade() {
        let axis = ruler(Scale::Log, None, &[0.03, 0.7]);
        assert_eq!(axis.ends(), [0.02, 1.0]);
        assert_eq!(axis.labelled, [0.02, 0.05, 0.1, 0.2, 0.5, 1.0]);
        let share = axis.share(0.1).unwrap();
        assert!(
            (share - 5.0_f64.log10() / 50.0_f64.log10()).abs() < 1e-12,
            "{share}"
        );
        let long = ruler(Scale::Log, None, &[1e-7, 1.0]);
        assert_eq!(
            long.labelled,
            [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0]
        );
        assert_eq!(long.hairlines.len(), 7 * 3 + 1);
        let longest = ruler(Scale::Log, None, &[1e-30, 1.0]);
        assert!(longest.labelled.len() <= 9, "{:?}", longest.labelled);
    }

    #[test]
    fn a_logarithmic_axis_has_no_place_for_what_is_not_above_zero() {
        let axis = ruler(
            Scale::Log,
            None,
            &[0.0, -1.0, f64::NAN, f64::INFINITY, 2.0, 3.0],
        );
        assert_eq!(axis.ends(), [2.0, 5.0]);
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(axis.share(value), None, "{value}");
        }
        assert_eq!(axis.share(2.0), Some(0.0));
        assert_eq!(axis.share(5.0), Some(1.0));
    }

    #[test]
    fn a_linear_axis_is_rounded_outward_to_its_steps() {
        let axis = ruler(Scale::Linear, None, &[-0.9, 3.1]);
        assert_eq!(axis.ends(), [-1.0, 4.0]);
        assert_eq!(axis.labelled, [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(axis.share(1.5), Some(0.5));
    }

    #[test]
    fn given_ends_are_kept_unless_they_make_no_sense() {
        let given = ruler(Scale::Linear, Some([0.0, 0.95]), &[7.0]);
        assert_eq!(given.ends(), [0.0, 0.95]);
        assert_eq!(given.labelled.len(), 5);
        for range in [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0]] {
            assert_eq!(
                ruler(Scale::Linear, Some(range), &[0.0, 5.0]).ends(),
                [0.0, 5.0]
            );
        }
        assert_eq!(
            ruler(Scale::Log, Some([0.0, 5.0]), &[1.0, 5.0]).ends(),
            [1.0, 5.0]
        );
    }

    #[test]
    fn nothing_one_value_and_extremes_still_make_an_axis() {
        let extreme = [f64::MIN_POSITIVE, f64::MAX, 5e-324, -f64::MAX];
        let lists: [&[f64]; 6] = [&[], &[3.0], &[0.0], &[-2.0, -2.0], &[f64::NAN], &extreme];
        for scale in [Scale::Linear, Scale::Log] {
            for values in lists {
                let axis = ruler(scale, None, values);
                let [low, high] = axis.ends();
                assert!(
                    low < high && (high - low).is_finite(),
                    "{scale:?} {values:?}: {axis:?}"
                );
                assert!(!axis.labelled.is_empty(), "{scale:?} {values:?}: {axis:?}");
                assert!(axis.hairlines.len() < 2000, "{scale:?} {values:?}");
            }
        }
    }
}
