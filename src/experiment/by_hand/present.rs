//! What is to be laid where. The right answer is not marked; whoever lays the cloth can often
//! tell it from what lies where.

use crate::design::{Design, Medium, Method, Source, Standard, Stimulus};
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
    design.medium == Medium::Array
        || matches!(design.method, Method::Levels(_) | Method::Adjustment(_))
        || design.stimuli.iter().any(is_virtual)
}

/// What a trial needs, place by place.
pub fn to_present(design: &Design, task: &Task) -> Vec<Placed> {
    match task {
        Task::Rank {
            target,
            alternatives,
        } => {
            let target = match design.method.standard() {
                Some(Standard::RealCloth) => cloth(design, *target),
                _ => named(design, *target),
            };
            let mut placed = vec![Placed::new("target", target)];
            placed.extend(positions(design, alternatives));
            placed
        }
        Task::OddOne { items, .. } => positions(design, items),
        Task::JudgePair { items, .. } => positions(design, items),
        Task::Adjust { item, starts } => adjusted(design, *item, starts),
        Task::Judge { item, .. } | Task::Estimate { item } | Task::Rate { item } => {
            vec![Placed::new("to be felt", named(design, *item))]
        }
        Task::Interval {
            level_db, signal, ..
        } => intervals(design, *level_db, *signal),
    }
}

fn positions(design: &Design, items: &[usize]) -> Vec<Placed> {
    let placed = |(at, item): (usize, &usize)| {
        Placed::new(format!("position {}", at + 1), named(design, *item))
    };
    items.iter().enumerate().map(placed).collect()
}

fn adjusted(design: &Design, item: usize, starts: &[f64]) -> Vec<Placed> {
    let mut placed = vec![Placed::new("to be adjusted", named(design, item))];
    if design.method.standard() == Some(Standard::RealCloth) {
        placed.push(Placed::new("compared with", cloth(design, item)));
    }
    let parameters = design.method.parameters().iter();
    let keys = parameters.map(|turned| turned.what.name());
    let begun = keys.zip(starts);
    placed.extend(begun.map(|(key, start)| Placed::new("begins at", format!("{key} = {start}"))));
    placed
}

fn intervals(design: &Design, level_db: f64, signal: usize) -> Vec<Placed> {
    let Some(levels) = design.method.levels() else {
        return Vec::new();
    };
    let hz = levels.band.carrier_hz();
    let vibration = |db: f64| {
        let level = with_unit(db, 2, "dB re 1 µm");
        format!("{hz} Hz at {level} for {} ms", levels.interval_ms)
    };
    let others = levels.reference_db.map_or_else(
        || format!("nothing for {} ms", levels.interval_ms),
        vibration,
    );
    let signals = vibration(level_db);
    let placed = |at: usize| {
        let what = if at == signal { &signals } else { &others };
        Placed::new(format!("interval {}", at + 1), what)
    };
    (0..levels.intervals).map(placed).collect()
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
        Source::Textile { id, gain_db } if gain_db.abs() < f64::EPSILON => id.clone(),
        Source::Textile { id, gain_db } => format!("{id} at {} more", with_unit(*gain_db, 1, "dB")),
        Source::Vibration { band, level_db } => {
            let level = with_unit(*level_db, 2, "dB re 1 µm");
            format!("{} Hz at {level}", band.carrier_hz())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(name: &str, task: &Task) -> Vec<String> {
        let design = Design::shipped(name).unwrap();
        let placed = to_present(&design, task).into_iter();
        placed
            .map(|placed| format!("{}: {}", placed.place, placed.what))
            .collect()
    }

    #[test]
    fn cloth_lies_at_its_position_and_the_target_by_itself() {
        let task = Task::Rank {
            target: 1,
            alternatives: [0, 1, 2, 3],
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
        let task = Task::Interval {
            track: 0,
            level_db: -1.5,
            signal: 1,
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
    fn an_adjustment_says_where_its_parameters_begin() {
        let task = Task::Adjust {
            item: 0,
            starts: vec![20.0, -13.0],
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
            assert!(needs_array(&Design::shipped(name).unwrap()), "{name}");
        }
        let head = "study = \"s\"\nexperiment = \"e\"\nmedium = \"real-cloth\"\nseed = 1\n";
        let design = |text: &str| {
            let text = format!("{head}{text}");
            Design::from_toml(&text, std::path::Path::new("a.toml")).unwrap()
        };
        assert!(!needs_array(&design(
            "textiles = [\"a\", \"b\"]\n[magnitude]\n"
        )));
        let vibration = "[[stimulus]]\nid = \"v\"\nband_hz = 40\nlevel_db = 0\n";
        let mixed = format!("textiles = [\"a\"]\n[magnitude]\n{vibration}");
        assert!(needs_array(&design(&mixed)));
    }
}
