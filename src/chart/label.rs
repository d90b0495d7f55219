//! How ticks are labelled: `10 µs`, `0.05`, `−3`, `2e−7`.
//!
//! Axes in seconds, hertz or bytes take their prefix into the ticks and lose the unit in the title.

use super::Scale;
use super::ticks::Ruler;
use selvedge_foundation::numerics::to_whole;
use selvedge_foundation::quantity::{fixed, with_unit};

/// Units that take prefixes.
const PREFIXED: [&str; 3] = ["s", "Hz", "B"];
/// Prefixes with their factors, smallest first.
const PREFIXES: [(f64, &str); 9] = [
    (1e-15, "f"),
    (1e-12, "p"),
    (1e-9, "n"),
    (1e-6, "µ"),
    (1e-3, "m"),
    (1.0, ""),
    (1e3, "k"),
    (1e6, "M"),
    (1e9, "G"),
];

impl Ruler {
    /// Its labels with their values, and the title of an axis of this name, which loses its unit
    /// where the labels have it.
    pub fn labels(&self, label: &str) -> (Vec<(f64, String)>, String) {
        let Labels { title, ticks } = Labels::of(self, label);
        (self.labelled.iter().copied().zip(ticks).collect(), title)
    }

    /// A value as it is read off an axis of this name: with its unit, finer than the labels.
    pub fn reading(&self, label: &str, value: f64) -> String {
        if !value.is_finite() {
            return "–".to_owned();
        }
        let (_, unit) = label.rsplit_once(", ").unwrap_or((label, ""));
        let largest = match self.scale() {
            Scale::Log => value.abs(),
            Scale::Linear | Scale::Whole => self.ends()[0].abs().max(self.ends()[1].abs()),
        };
        let is_prefixed = PREFIXED.contains(&unit);
        let (factor, prefix) = if is_prefixed {
            prefix_of(largest)
        } else {
            (1.0, "")
        };
        let step = match self.scale() {
            Scale::Log => 0.01 * (value / factor).abs(),
            Scale::Linear => 0.01 * (self.ends()[1] - self.ends()[0]) / factor,
            Scale::Whole => 1.0,
        };
        let decimals = if step > 0.0 { decimals_of(step) } else { 0 };
        with_unit(value / factor, decimals, &format!("{prefix}{unit}"))
            .trim_end()
            .to_owned()
    }
}

/// What an axis is called and how its ticks are labelled.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Labels {
    /// The title of the axis.
    pub(super) title: String,
    /// One label for each labelled tick.
    pub(super) ticks: Vec<String>,
}

impl Labels {
    /// The labels of a ruler whose axis is called `label`.
    pub(super) fn of(ruler: &Ruler, label: &str) -> Self {
        let prefixed = label.rsplit_once(", ").and_then(|(what, unit)| {
            let unit = PREFIXED.into_iter().find(|known| *known == unit)?;
            Some((what, unit))
        });
        let numbers = ruler.labelled.iter().copied();
        let ticks = match (prefixed, ruler.scale()) {
            (Some((_, unit)), Scale::Log) => numbers.map(|x| with_prefix(x, unit)).collect(),
            (Some((_, unit)), Scale::Linear | Scale::Whole) => with_one_prefix(ruler, unit),
            (None, Scale::Log) => numbers.map(plain).collect(),
            (None, Scale::Linear | Scale::Whole) => {
                numbers.map(|x| stepped(x, ruler.step)).collect()
            }
        };
        Self {
            title: prefixed.map_or(label, |(what, _)| what).to_owned(),
            ticks,
        }
    }
}

/// A 1, 2 or 5 of any decade with the prefix that leaves 1 to 500.
fn with_prefix(value: f64, unit: &str) -> String {
    let fits = |(factor, _): &&(f64, &str)| value >= factor * (1.0 - 1e-9);
    match PREFIXES.iter().rev().find(fits) {
        Some((factor, prefix)) if value < 999.5 * factor => {
            format!("{} {prefix}{unit}", plain(value / factor))
        }
        _ => format!("{} {unit}", plain(value)),
    }
}

/// Evenly spaced values, all with the prefix of the largest.
fn with_one_prefix(ruler: &Ruler, unit: &str) -> Vec<String> {
    let [low, high] = ruler.ends();
    let largest = low.abs().max(high.abs());
    let (factor, prefix) = prefix_of(largest);
    let (decimals, unit) = (decimals_of(ruler.step / factor), format!("{prefix}{unit}"));
    let label = |value: &f64| with_unit(value / factor, decimals, &unit);
    ruler.labelled.iter().map(label).collect()
}

/// The prefix of numbers up to this, with its factor.
fn prefix_of(largest: f64) -> (f64, &'static str) {
    let mut from_largest = PREFIXES.into_iter().rev();
    let found = from_largest.find(|(factor, _)| largest >= *factor);
    found.unwrap_or((1.0, ""))
}

/// A value between which and its neighbours lies `step`.
fn stepped(value: f64, step: f64) -> String {
    if !(1e-6..1e6).contains(&step) {
        return if value.abs() < 0.5 * step {
            fixed(0.0, 0)
        } else {
            plain(value)
        };
    }
    fixed(value, decimals_of(step))
}

/// Decimals that tell multiples of a step apart.
fn decimals_of(step: f64) -> usize {
    to_whole((-(step.log10() + 1e-9).floor()).clamp(0.0, 12.0))
}

/// A number with the digits that it has: `0.05`, `200`, and `2e−7` far from 1.
fn plain(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude > 0.0 && !(1e-4..1e5).contains(&magnitude) {
        let text = format!("{value:.1e}").replace(".0e", "e").replace('-', "−");
        return text;
    }
    let text = fixed(value, 6);
    let shortest = text.trim_end_matches('0').trim_end_matches('.');
    if text.contains('.') {
        shortest.to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    fn labels(label: &str, scale: Scale, values: &[f64]) -> Labels {
        let axis = Axis {
            label: label.to_owned(),
            scale,
            range: None,
        };
        Labels::of(&Ruler::of(&axis, values.iter().copied()), label)
    }

    #[test]
    fn seconds_take_their_prefix_into_the_ticks() {
        let found = labels("time a tick, s", Scale::Log, &[2e-7, 1e-5]);
        assert_eq!(found.title, "time a tick");
        assert_eq!(
            found.ticks,
            ["200 ns", "500 ns", "1 µs", "2 µs", "5 µs", "10 µs"]
        );
        let found = labels("time, s", Scale::Linear, &[0.0, 0.004]);
        assert_eq!(found.ticks, ["0 ms", "1 ms", "2 ms", "3 ms", "4 ms"]);
    }

    #[test]
    fn other_axes_keep_their_unit_and_have_plain_numbers() {
        let found = labels("level error, dB", Scale::Log, &[0.01, 0.05]);
        assert_eq!(found.title, "level error, dB");
        assert_eq!(found.ticks, ["0.01", "0.02", "0.05"]);
        let found = labels("gain, dB", Scale::Linear, &[-0.4, 0.6]);
        assert_eq!(found.ticks, ["−0.4", "−0.2", "0.0", "0.2", "0.4", "0.6"]);
    }

    #[test]
    fn numbers_far_from_one_are_written_by_their_power() {
        assert_eq!(plain(2e-7), "2e−7");
        assert_eq!(plain(1e6), "1e6");
        assert_eq!(plain(-0.05), "−0.05");
        assert_eq!(plain(200.0), "200");
        assert_eq!(plain(0.0), "0");
        assert_eq!(with_prefix(2e4, "Hz"), "20 kHz");
        assert_eq!(with_prefix(1e-20, "s"), "1e−20 s");
    }
}
