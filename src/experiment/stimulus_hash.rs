//! What trials present, as hashes: the same where the same is felt, another where a textile, its
//! gain, its place or interval, or a vibration differs.

use std::collections::BTreeMap;

use crate::ExperimentError;
use crate::design::{Design, Source};
use crate::layout::{Layout, sequence};
use crate::trial::Task;
use selvedge_engine::Played;
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::progress::Progress;
use selvedge_textile::{Library, TextileError};

/// What the textiles of a design are made of.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StimulusHashes {
    /// Hashes of contents by id.
    textiles: BTreeMap<String, String>,
}

impl StimulusHashes {
    /// Of textiles by id and the hash of their content.
    pub fn of(textiles: impl IntoIterator<Item = (String, String)>) -> Self {
        Self {
            textiles: textiles.into_iter().collect(),
        }
    }

    /// Of a design's textiles in a library.
    ///
    /// # Errors
    /// A textile is not in the library or cannot be read, or the work was cancelled.
    pub(crate) fn of_library(
        design: &Design,
        library: &Library,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let loaded = library.load_all(&design.textile_ids(), progress)?;
        let hashed = loaded.iter().map(|textile| -> Result<_, TextileError> {
            Ok((textile.id().to_owned(), textile.content_hash()?))
        });
        let textiles: Result<BTreeMap<String, String>, TextileError> = hashed.collect();
        Ok(Self {
            textiles: textiles?,
        })
    }

    /// Of all of them together; empty where there is none.
    pub fn all(&self) -> String {
        match self.textiles.len() {
            0 => String::new(),
            _ => sha256_hex(self.textiles.values().map(String::as_bytes)),
        }
    }

    /// Of what a trial presents and where.
    pub fn of_task(&self, design: &Design, task: &Task) -> String {
        let mut parts = Vec::new();
        for place in Layout::of(design, task).places {
            let Some(stimulus) = design.stimuli.get(place.stimulus) else {
                continue;
            };
            let what = match &stimulus.source {
                Source::Textile { id, variant } => {
                    let content = self.textiles.get(id).map_or(id.as_str(), String::as_str);
                    let [(_, gain_db, _), others @ ..] = variant.numbers();
                    let others = others.into_iter().filter(|(_, value, _)| *value != 0.0);
                    let others = others.map(|(key, value, _)| format!(" {key} {value}"));
                    let force = if variant.is_force_alone { " force" } else { "" };
                    format!("{content} {gain_db}{}{force}", others.collect::<String>())
                }
                Source::RealCloth(cloth) => format!("cloth {cloth}"),
                Source::Vibration { .. } => String::new(),
            };
            parts.push(format!("{:?} {what}\n", place.number));
            // What is adapted of this place alone.
            parts.extend(place.adapted.map(|value| format!("{value}\n")));
        }
        let stylus = design.composition.presentation.stylus.as_ref();
        parts.extend(stylus.map(|stylus| format!("{}\n", stylus.words())));
        let hangs = design.composition.presentation.hangs;
        parts.extend(hangs.then(|| "hangs\n".to_owned()));
        let alone = task
            .adapted
            .filter(|_| design.composition.presentation.n == 1);
        parts.extend(alone.map(|adapted| format!("{}\n", adapted.value)));
        for step in sequence(design, task) {
            let played = match step.played {
                Played::Vibration(amplitude_um) => format!("{amplitude_um:?}"),
                Played::Textile(textile) => format!("place {textile}"),
            };
            parts.push(format!("{played} {}\n", step.n_ticks));
        }
        sha256_hex(parts.iter().map(String::as_bytes))
    }
}
