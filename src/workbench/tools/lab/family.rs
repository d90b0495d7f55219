//! A family: recipes that differ in one parameter, and what is felt of each.

use crate::kit::widgets::axis::round_step;
use crate::tools::lab::preview::{Felt, Preview};
use crate::tools::lab::steps::parameter_at;
use selvedge_foundation::files::KeyValue;
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Filters;
use selvedge_textile::{Draft, Manifest, Parameter, ParameterKind, Place};

/// What is typed and chosen where a family is planned.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct FamilyFields {
    /// The parameter that varies.
    pub place: Option<Place>,
    /// Its first and last value, as typed.
    pub ends: [String; 2],
    /// How many textiles, as typed.
    pub n: String,
}

impl FamilyFields {
    /// Varies a parameter over a reasonable range about its value.
    pub(crate) fn vary(&mut self, parameter: &Parameter, value: Option<f64>) {
        self.place = Some(parameter.place);
        let (ParameterKind::Number { min, max, .. } | ParameterKind::Optional { min, max, .. }) =
            parameter.kind
        else {
            return;
        };
        let middle = value.unwrap_or(0.5 * (min + max));
        let ends = if max - min <= 1.0 {
            [min + 0.1 * (max - min), max - 0.1 * (max - min)]
        } else {
            [0.5 * middle, 1.5 * middle]
        };
        // Round numbers: a family is told by its values.
        let step = if max - min <= 1.0 {
            round_step((max - min) / 25.0)
        } else {
            round_step(middle.abs().max(1e-6) / 50.0)
        };
        let short = |value: f64| {
            let rounded = ((value / step).round() * step).clamp(min, max);
            format!("{}", (rounded * 1e6).round() / 1e6)
        };
        self.ends = ends.map(short);
        if self.n.is_empty() {
            "5".clone_into(&mut self.n);
        }
    }

    /// The plan, or what is wrong with what was typed.
    pub(crate) fn plan(&self) -> Result<Plan, &'static str> {
        let place = self.place.ok_or("Choose the parameter that varies")?;
        let number = |text: &String| {
            let plain = text.trim().replace('−', "-").replace(',', ".");
            plain.parse::<f64>().ok().filter(|value| value.is_finite())
        };
        let [Some(first), Some(last)] = self.ends.each_ref().map(number) else {
            return Err("Write two numbers");
        };
        let n: Option<u8> = self.n.trim().parse().ok();
        let n = n.filter(|n| (2..=Plan::MOST).contains(n));
        Ok(Plan {
            place,
            ends: [first, last],
            n: n.ok_or("Make 2 to 12 textiles")?,
        })
    }
}

/// A family: one parameter over several values, evenly apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    /// The parameter.
    pub place: Place,
    /// Its first and its last value.
    pub ends: [f64; 2],
    /// How many values.
    pub n: u8,
}

impl Plan {
    /// Most textiles of a family.
    pub(crate) const MOST: u8 = 12;

    /// The values, evenly apart from end to end.
    pub(crate) fn values(&self) -> Vec<f64> {
        let n = self.n.clamp(2, Self::MOST);
        let [first, last] = self.ends;
        let share = |i: u8| f64::from(i) / f64::from(n - 1);
        let value = |i: u8| first + (last - first) * share(i);
        // Ten digits: what is evenly apart is as short in files as when it is typed.
        (0..n).map(|i| (value(i) * 1e9).round() / 1e9).collect()
    }
}

/// One of a family.
#[derive(Debug, Clone)]
pub(crate) struct Member {
    /// The value that it has, in words: `Hurst exponent 0.3`.
    pub label: String,
    /// The value alone.
    pub value: f64,
    /// Its recipe.
    pub manifest: Manifest,
    /// What is felt of it.
    pub felt: Felt,
}

/// A family that was tried.
#[derive(Debug, Clone)]
pub(crate) struct Family {
    /// The name and the unit of the parameter.
    pub parameter: [&'static str; 2],
    /// From the first to the last value.
    pub members: Vec<Member>,
}

impl Family {
    /// Makes every recipe of a plan and feels it.
    ///
    /// # Errors
    /// A value that the reader of recipes refuses; the work was stopped.
    pub(crate) fn of(
        draft: &Draft,
        plan: &Plan,
        filters: &Filters,
        progress: &mut Progress<'_>,
    ) -> Result<Self, String> {
        let parameter = parameter_at(draft, plan.place);
        let parameter = parameter.ok_or("this recipe has no such parameter")?;
        let (unit, is_whole) = match parameter.kind {
            ParameterKind::Number { unit, is_whole, .. } => (unit, is_whole),
            ParameterKind::Optional { unit, .. } => (unit, false),
            ParameterKind::Seed => ("", true),
            _ => return Err("this parameter is no number".to_owned()),
        };
        let recipe = |value: f64| {
            let mut own = draft.clone();
            own.set(plan.place, Some(key_value(value, is_whole)));
            own.read().map_err(|fault| fault.message)
        };
        let values = plan.values();
        // What is wrong with the last one is said before the first is made.
        let recipes: Vec<Manifest> = values
            .iter()
            .map(|value| recipe(*value))
            .collect::<Result<_, String>>()?;
        let n = values.len() as f64;
        let mut members = Vec::with_capacity(values.len());
        for (done, (value, manifest)) in values.into_iter().zip(recipes).enumerate() {
            let step = progress.step(done as f64 / n, parameter.name);
            step.map_err(|stop| stop.to_string())?;
            let preview = Progress::unheard(|own| Preview::of(manifest, filters, own))?;
            members.push(Member {
                label: label(parameter.name, value, unit),
                value,
                manifest: preview.manifest,
                felt: preview.felt,
            });
        }
        Ok(Self {
            parameter: [parameter.name, unit],
            members,
        })
    }
}

/// A number as a recipe states it.
pub(crate) fn key_value(value: f64, is_whole: bool) -> KeyValue {
    if is_whole {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a number that is too large for a recipe is refused by its reader"
        )]
        return KeyValue::Integer(value.round() as i64);
    }
    KeyValue::Float(value)
}

fn label(name: &str, value: f64, unit: &str) -> String {
    let decimals = (0..4)
        .find(|decimals| {
            let scale = 10_f64.powi(*decimals);
            ((value * scale).round() / scale - value).abs() < 1e-9
        })
        .unwrap_or(4);
    let digits = quantity::fixed(value, usize::try_from(decimals).unwrap_or(4));
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    format!("{name} {digits}{unit}")
}
