//! Where numbers come from: program, scene, textiles, filters, tuning, method, ticks.
//!
//! Free of paths, clocks and names of machines, so that the same work gives the same bytes.

use std::collections::BTreeMap;

use selvedge_foundation::{files, quantity};
use selvedge_render::scene::Scene;
use selvedge_textile::tactile::{Filters, Tuning};

/// Characters of a hash that tell scenes apart for people.
const BRIEF_HASH: usize = 12;
/// Characters of a line below a figure.
const LINE: usize = 136;

/// One thing that is known of where numbers come from.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Fact {
    key: &'static str,
    value: String,
    /// The same below a figure; empty where it is left out.
    brief: String,
}

/// Where numbers come from, in the order in which it is told.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Origin {
    facts: Vec<Fact>,
}

impl Origin {
    /// The program and the scene: which one by its content, what lies in it, filters and tuning.
    /// `reference_db` is the level that compression leaves alone.
    pub(crate) fn of(scene: &Scene, tuning: &Tuning, reference_db: Option<f64>) -> Self {
        let program = selvedge_foundation::PROGRAM;
        let hash = identity(scene);
        let short: String = hash.chars().take(BRIEF_HASH).collect();
        let placed = scene.textiles.iter();
        let textiles: Vec<String> = placed
            .map(|textile| {
                format!("{} {}", textile.label, textile.id)
                    .trim()
                    .to_owned()
            })
            .collect();
        let textiles = textiles.join(", ");
        let display = scene.displays.first();
        let display = display.map_or_else(String::new, |display| display.geometry.label());
        let (filters, octaves) = match scene.filters {
            Filters::LogGaussian { octaves } => ("log-gaussian", Some(octaves)),
            Filters::Receptor => ("receptor", None),
        };
        let width = octaves.map_or_else(String::new, |octaves| format!(" {octaves} oct"));
        Self::default()
            .and("program", program, program)
            .and("scene", &scene.name, &scene.name)
            .and("scene_sha256", &hash, &format!("sha256 {short}"))
            .and("textiles", &textiles, &textiles)
            .and("display", &display, &display)
            .and("filters", filters, &format!("filters {filters}{width}"))
            .and("filters_octaves", &optional(octaves), "")
            .tuned(tuning, reference_db)
    }

    fn tuned(self, tuning: &Tuning, reference_db: Option<f64>) -> Self {
        let Tuning {
            gain_db,
            gain_40_db,
            gain_320_db,
            compression,
            ..
        } = *tuning;
        let [master, low, high] =
            [gain_db, gain_40_db, gain_320_db].map(|db| quantity::fixed(db, 1));
        let gains = format!("gains {master}, 40 Hz {low}, 320 Hz {high} dB");
        let percent = quantity::with_unit(100.0 * compression, 0, "%");
        let about = reference_db.map_or_else(String::new, |db| {
            format!(" about {}", quantity::with_unit(db, 1, "dB"))
        });
        self.and("gain_db", &gain_db.to_string(), &gains)
            .and("gain_40_db", &gain_40_db.to_string(), "")
            .and("gain_320_db", &gain_320_db.to_string(), "")
            .and(
                "compression",
                &compression.to_string(),
                &format!("compression {percent}{about}"),
            )
            .and("compression_reference_db", &optional(reference_db), "")
    }

    /// The same with one thing more; nothing is added where there is no value.
    pub(crate) fn and(mut self, key: &'static str, value: &str, brief: &str) -> Self {
        let line = |text: &str| -> String {
            let is_break = |c: char| c.is_control() || c == '\u{2028}' || c == '\u{2029}';
            text.replace(is_break, " ").trim().to_owned()
        };
        if !value.trim().is_empty() {
            self.facts.push(Fact {
                key,
                value: line(value),
                brief: line(brief),
            });
        }
        self
    }

    /// The same for one contactor.
    pub(crate) fn of_contactor(self, contactor: usize) -> Self {
        let value = contactor.to_string();
        self.and("contactor", &value, &format!("contactor {value}"))
    }

    /// The same for ticks from the first to the last.
    pub(crate) fn in_ticks(self, ticks: impl Iterator<Item = u64> + Clone) -> Self {
        let (Some(first), Some(last)) = (ticks.clone().min(), ticks.max()) else {
            return self;
        };
        let value = format!("{first} to {last}");
        let brief = if first == last {
            format!("tick {first}")
        } else {
            format!("ticks {first} to {last}")
        };
        self.and("ticks", &value, &brief)
    }

    /// The same for amplitudes from a rendering method with a bound of its level error, dB.
    pub(crate) fn by_method(self, method: &str, bound_db: f64) -> Self {
        let bound = quantity::with_unit(bound_db, 3, "dB");
        let brief = if bound_db > 0.0 {
            format!("method {method}, level error at most {bound}")
        } else {
            format!("method {method}")
        };
        self.and("method", method, &brief)
            .and("method_bound_db", &bound_db.to_string(), "")
    }

    /// Every key with its value.
    pub(crate) fn pairs(&self) -> Vec<(String, String)> {
        let pair = |fact: &Fact| (fact.key.to_owned(), fact.value.clone());
        self.facts.iter().map(pair).collect()
    }

    /// In lines for people, none of them broken within a fact.
    pub(crate) fn lines(&self) -> Vec<String> {
        let briefs = self.facts.iter().map(|fact| fact.brief.as_str());
        let mut lines: Vec<String> = Vec::new();
        for brief in briefs.filter(|brief| !brief.is_empty()) {
            let n = brief.chars().count() + 3;
            match lines.last_mut() {
                Some(line) if line.chars().count() + n <= LINE => {
                    line.push_str(" · ");
                    line.push_str(brief);
                }
                _ => lines.push(brief.to_owned()),
            }
        }
        lines
    }
}

/// The scene by its content: the hash of its file without the folders of library and recordings,
/// which are elsewhere on every computer, and without what its textiles were when it was saved.
fn identity(scene: &Scene) -> String {
    let content = Scene {
        library: None,
        recordings: Vec::new(),
        contents: BTreeMap::default(),
        ..scene.clone()
    };
    let text = content.to_toml().unwrap_or_default();
    files::sha256_hex([text.as_bytes()])
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_known_by_its_content_wherever_its_library_lies() {
        let scene = selvedge_render::scene::LoadedScene::shipped()
            .unwrap()
            .scene()
            .clone();
        let elsewhere = Scene {
            library: Some("/somewhere/textiles".into()),
            ..scene.clone()
        };
        let of = |scene: &Scene| Origin::of(scene, &Tuning::default(), None);
        assert_eq!(of(&scene), of(&elsewhere));
        let mut moved = scene.clone();
        moved.textiles[0].origin_mm.x_mm += 1.0;
        assert_ne!(of(&scene), of(&moved));
        let line = of(&scene).lines().join("\n");
        assert!(line.starts_with("selvedge "), "{line}");
        assert!(line.contains(&scene.textiles[0].id), "{line}");
        assert!(!line.contains('/'), "no path: {line}");
        assert!(
            line.lines().all(|line| line.chars().count() <= LINE),
            "{line}"
        );
    }

    #[test]
    fn what_is_told_stays_in_its_line_and_nothing_is_not_told() {
        let origin = Origin::default()
            .and("scene", "one\ntwo", "one\u{2028}two")
            .and("empty", "  ", "never");
        let pair = ("scene".to_owned(), "one two".to_owned());
        assert_eq!(
            (origin.pairs(), origin.lines()),
            (vec![pair], vec!["one two".to_owned()])
        );
        let ticks = Origin::default().in_ticks([9_u64, 3, 5].into_iter());
        assert_eq!(ticks.lines(), ["ticks 3 to 9"]);
        assert_eq!(
            Origin::default().in_ticks([].into_iter()),
            Origin::default()
        );
    }
}
