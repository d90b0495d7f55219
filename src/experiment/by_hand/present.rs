//! What is to be laid where. The right answer is not marked; whoever lays the cloth can often
//! tell it from what lies where.

use crate::design::{
    Composition, Design, Form, Medium, Sets, Shown, Source, Standard, Stimulus, Tunable,
};
use crate::trial::Task;
use selvedge_foundation::quantity::with_unit;

/// Something at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placed {
    /// Where it lies, or when it comes.
    pub place: String,
    /// What it is.
    pub what: String,
}

impl Placed {
    fn new(place: impl Into<String>, what: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            what: what.into(),
        }
    }
}

/// Whether only a tactile array presents what the design asks about.
pub fn needs_array(design: &Design) -> bool {
    let is_virtual = |stimulus: &Stimulus| !matches!(stimulus.source, Source::RealCloth(_));
    let composition = &design.composition;
    design.medium == Medium::Array
        || composition.adaptation.is_some()
        || matches!(composition.response.form, Form::Adjustment(_))
        || design.stimuli.iter().any(is_virtual)
}

impl Placed {
    /// What a trial needs, place by place.
    pub fn all_of(design: &Design, task: &Task) -> Vec<Self> {
        let composition = &design.composition;
        if task.adapted.is_some() {
            return adapted(design, task);
        }
        if matches!(composition.response.form, Form::Adjustment(_)) {
            return adjusted(design, task);
        }
        let mut placed = Vec::new();
        if let Some(reference) = task.reference {
            let is_real = composition.presentation.reference == Standard::RealCloth;
            let what = if is_real {
                cloth(design, reference)
            } else {
                named(design, reference)
            };
            let is_target = composition.order.sets == Sets::Targets;
            placed.push(Self::new(
                if is_target { "target" } else { "standard" },
                format!("{what}{}", lasting(composition)),
            ));
        }
        if let [item] = task.items.as_slice() {
            placed.push(Self::new("to be felt", named(design, *item)));
            return placed;
        }
        let position = |(at, item): (usize, &usize)| {
            let what = format!("{}{}", named(design, *item), lasting(composition));
            Self::new(format!("{} {}", place(composition), at + 1), what)
        };
        placed.extend(task.items.iter().enumerate().map(position));
        placed
    }
}

/// Where or when a stimulus comes, but for its number.
pub(super) fn place(composition: &Composition) -> &'static str {
    match composition.presentation.shown {
        Shown::Intervals => "interval",
        _ => "position",
    }
}

/// How long it is felt where it comes in an interval.
fn lasting(composition: &Composition) -> String {
    let presentation = &composition.presentation;
    match presentation.shown {
        Shown::Intervals => format!(" for {} ms", presentation.interval_ms),
        _ => String::new(),
    }
}

fn adjusted(design: &Design, task: &Task) -> Vec<Placed> {
    let item = task.item().unwrap_or(0);
    let mut placed = vec![Placed::new("to be adjusted", named(design, item))];
    if design.composition.presentation.reference == Standard::RealCloth {
        placed.push(Placed::new("compared with", cloth(design, item)));
    }
    let parameters = design.composition.parameters().iter();
    let keys = parameters.map(|turned| turned.what.name());
    let begun = keys.zip(&task.starts);
    placed.extend(begun.map(|(key, start)| Placed::new("begins at", format!("{key} = {start}"))));
    placed
}

/// What is adapted, at its value where it is adapted and at the reference elsewhere.
fn adapted(design: &Design, task: &Task) -> Vec<Placed> {
    let composition = &design.composition;
    let Some(adaptation) = &composition.adaptation else {
        return Vec::new();
    };
    let presentation = &composition.presentation;
    let at_value = |value: f64| {
        let (digits, parameter) = (2, adaptation.parameter);
        if adaptation.is_vibration() {
            let (hz, level) = (
                adaptation.band.carrier_hz(),
                with_unit(value, digits, parameter.unit()),
            );
            return format!("{hz} Hz at {level}{}", lasting(composition));
        }
        let of = named(design, task.item().unwrap_or(0));
        let lasting = match parameter {
            Tunable::Duration => String::new(),
            _ => lasting(composition),
        };
        format!("{of} with {} = {value}{lasting}", parameter.name())
    };
    let nothing = || format!("nothing{}", lasting(composition));
    let place = place(composition);
    let placed = |at: usize| {
        let value = task.adapted_at(adaptation, at);
        let what = value.map_or_else(nothing, at_value);
        Placed::new(format!("{place} {}", at + 1), what)
    };
    (0..presentation.n).map(placed).collect()
}

/// The real cloth that a stimulus is or stands for.
fn cloth(design: &Design, item: usize) -> String {
    let material = design.stimuli.get(item).map(Stimulus::cloth);
    format!("the real {}", material.unwrap_or_default())
}

fn named(design: &Design, item: usize) -> String {
    let Some(stimulus) = design.stimuli.get(item) else {
        return String::new();
    };
    match &stimulus.source {
        Source::RealCloth(cloth) => cloth.clone(),
        Source::Textile { id, variant } => {
            let differs = variant.numbers().into_iter();
            let differs = differs.filter(|(_, value, _)| value.abs() > f64::EPSILON);
            let words = |(key, value, unit): (&str, f64, &'static str)| {
                let value = with_unit(value, 1, unit);
                match key {
                    "gain_db" => format!("at {value} more"),
                    "rotation_deg" => format!("turned by {value}"),
                    _ => format!("with {key} = {value}"),
                }
            };
            let force = variant.is_force_alone.then(|| "by force alone".to_owned());
            let parts = std::iter::once(id.clone()).chain(differs.map(words));
            parts.chain(force).collect::<Vec<_>>().join(" ")
        }
        Source::Vibration { band, level_db } => {
            let level = with_unit(*level_db, 2, "dB re 1 µm");
            format!("{} Hz at {level}", band.carrier_hz())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::Adapted;

    fn described(name: &str, task: &Task) -> Vec<String> {
        let design = Design::shipped(name).unwrap();
        let placed = Placed::all_of(&design, task).into_iter();
        placed
            .map(|placed| format!("{}: {}", placed.place, placed.what))
            .collect()
    }

    #[test]
    fn cloth_lies_at_its_position_and_the_target_by_itself() {
        let task = Task {
            items: vec![0, 1, 2, 3],
            reference: Some(1),
            right: Some(1),
            ..Task::default()
        };
        let real = described("ranking-real-target", &task);
        assert_eq!(real[0], "target: the real wool-twill");
        assert_eq!(real[2], "position 2: wool-twill");
        assert_eq!(real.len(), 5);
        let virtually = described("ranking-virtual-target", &task);
        assert_eq!(virtually[0], "target: wool-twill");
    }

    #[test]
    fn the_interval_with_the_signal_is_told_to_whoever_presents_it() {
        let task = Task {
            right: Some(1),
            adapted: Some(Adapted {
                track: 0,
                value: -1.5,
            }),
            ..Task::default()
        };
        let threshold = described("threshold-40", &task);
        assert!(
            threshold[0].starts_with("interval 1: nothing for "),
            "{threshold:?}"
        );
        assert!(threshold[1].contains("40 Hz at −1.50"), "{threshold:?}");
        let jnd = described("jnd-40", &task);
        assert!(jnd[0].contains("40 Hz at "), "{jnd:?}");
        assert_ne!(
            jnd[0].replace("interval 1", ""),
            jnd[1].replace("interval 2", "")
        );
    }

    #[test]
    fn cloth_in_intervals_is_told_interval_by_interval() {
        let text = include_str!("../analysis/tests/designs/roughness-intervals.toml");
        let design = Design::from_toml(text, std::path::Path::new("a.toml")).unwrap();
        let task = Task {
            items: vec![3, 0],
            right: Some(0),
            ..Task::default()
        };
        let placed = Placed::all_of(&design, &task);
        let expected = [
            Placed::new("interval 1", "denim for 2000 ms"),
            Placed::new("interval 2", "silk-crepe for 2000 ms"),
        ];
        assert_eq!(placed, expected);
        assert_eq!(super::super::form(&design), "type the interval: 1 or 2");
    }

    #[test]
    fn an_adjustment_says_where_its_parameters_begin() {
        let task = Task {
            items: vec![0],
            starts: vec![20.0, -13.0],
            ..Task::default()
        };
        let expected = [
            "to be adjusted: silk-crepe",
            "compared with: the real silk-crepe",
            "begins at: gain_40_db = 20",
            "begins at: gain_320_db = -13",
        ];
        assert_eq!(described("adjustment-two-gains", &task), expected);
    }

    #[test]
    fn only_questions_about_cloth_do_without_an_array() {
        for name in Design::shipped_names() {
            let design = Design::shipped(name).unwrap();
            let is_felt_on_it = design.medium == Medium::Array;
            assert_eq!(needs_array(&design), is_felt_on_it, "{name}");
        }
        let head = "study = \"s\"\nexperiment = \"e\"\nmedium = \"real-cloth\"\nseed = 1\n";
        let design = |text: &str| {
            let text = format!("{head}{text}");
            Design::from_toml(&text, std::path::Path::new("a.toml")).unwrap()
        };
        assert!(!needs_array(&design(
            "textiles = [\"a\", \"b\"]\n[presentation]\nkind = \"single\"\n\
             [response]\nkind = \"number\"\n"
        )));
        let vibration = "[[stimulus]]\nid = \"v\"\nband_hz = 40\nlevel_db = 0\n";
        let mixed = format!(
            "textiles = [\"a\"]\n{vibration}[presentation]\nkind = \"single\"\n\
             [response]\nkind = \"number\"\n"
        );
        assert!(needs_array(&design(&mixed)));
    }
}
