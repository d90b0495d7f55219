//! The kind `profiles`: profiles as they were measured, and what they were imported from.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::{Checker, ProfileFiles, Recipe, SourceKeys};
use crate::surface::Direction;

/// Profiles as they were measured (`kind = "profiles"`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profiles {
    /// Always `profiles`.
    pub(crate) kind: String,
    /// Along the warp: a CSV of `x_mm,height_um` beside the manifest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) warp_forward: Option<String>,
    /// Along the warp and back, in travel order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) warp_reverse: Option<String>,
    /// Along the weft.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) weft_forward: Option<String>,
    /// Along the weft and back, in travel order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) weft_reverse: Option<String>,
    /// The coefficient of friction along the warp: a CSV of `x_mm,mu`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) friction: Option<String>,
    /// Where they were imported from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) imported: Option<Box<KesOrigin>>,
}

impl Default for Profiles {
    /// No files yet.
    fn default() -> Self {
        Self {
            kind: "profiles".to_owned(),
            warp_forward: None,
            warp_reverse: None,
            weft_forward: None,
            weft_reverse: None,
            friction: None,
            imported: None,
        }
    }
}

impl Profiles {
    /// The file of a direction, to be set.
    pub(crate) fn file_mut(&mut self, direction: Direction) -> &mut Option<String> {
        match direction {
            Direction::WarpForward => &mut self.warp_forward,
            Direction::WarpReverse => &mut self.warp_reverse,
            Direction::WeftForward => &mut self.weft_forward,
            Direction::WeftReverse => &mut self.weft_reverse,
        }
    }
}

impl SourceKeys for Profiles {
    fn kind(&self) -> &str {
        &self.kind
    }

    fn files(&self) -> ProfileFiles {
        ProfileFiles([
            self.warp_forward.clone(),
            self.warp_reverse.clone(),
            self.weft_forward.clone(),
            self.weft_reverse.clone(),
        ])
    }

    /// Measured files are the source itself.
    fn set_files(&mut self, _files: ProfileFiles, _recipe_hash: Option<String>) {}
}

impl Recipe for Profiles {
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        if self.warp_forward.is_none() && self.warp_reverse.is_none() {
            let mend = "add warp_forward = \"FILE.csv\"";
            return Err(checker.wrong("source", "kind", "no warp profile", mend));
        }
        checker.file_name("source", "friction", self.friction.as_deref())?;
        self.imported
            .as_ref()
            .map_or(Ok(()), |origin| origin.check(checker))
    }

    fn friction(&self) -> Option<&str> {
        self.friction.as_deref()
    }

    fn assumed(&self) -> &[String] {
        self.imported.as_ref().map_or(&[], |origin| &origin.assumed)
    }
}

/// The name of the importer in manifests.
pub(crate) const IMPORTER: &str = "kes-f";

/// `[source.imported]`: which files, which section, what was taken off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct KesOrigin {
    /// Always `kes-f`.
    pub(crate) importer: String,
    /// The names of the files.
    pub(crate) files: Vec<String>,
    /// Their SHA-256, in the same order.
    pub(crate) sha256: Vec<String>,
    /// Units that were assumed because nothing stated them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) assumed: Vec<String>,
    /// What one volt stood for, µm, where heights were in volts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) um_per_volt: Option<f64>,
    /// The evaluated section along the warp, mm on the stroke: from, to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) warp_section_mm: Option<[f64; 2]>,
    /// The same along the weft.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) weft_section_mm: Option<[f64; 2]>,
    /// Whether the sections were suggested by rule.
    #[serde(default)]
    pub(crate) is_section_suggested: bool,
    /// The slope of the line taken off each stroke, µm for every mm of travel, by direction.
    #[serde(default)]
    pub(crate) tilt_um_per_mm: BTreeMap<String, f64>,
}

impl KesOrigin {
    /// Refuses what is no origin.
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let table = "source.imported";
        let wrong = |key, what: &str, mend: &str| Err(checker.wrong(table, key, what, mend));
        if self.importer != IMPORTER {
            return wrong("importer", "unknown importer", "write importer = \"kes-f\"");
        }
        let is_hash =
            |text: &String| text.len() == 64 && text.bytes().all(|b| b.is_ascii_hexdigit());
        if self.sha256.len() != self.files.len() || !self.sha256.iter().all(is_hash) {
            return wrong(
                "sha256",
                "not one hash a file",
                "give a SHA-256 for each of files",
            );
        }
        let sections = [
            ("warp_section_mm", self.warp_section_mm),
            ("weft_section_mm", self.weft_section_mm),
        ];
        for (key, section) in sections {
            let is_section = |[from, to]: [f64; 2]| from.is_finite() && to.is_finite() && from < to;
            if !section.is_none_or(is_section) {
                return wrong(key, "not a section", "give [FROM, TO] in mm, rising");
            }
        }
        if !self.tilt_um_per_mm.values().all(|tilt| tilt.is_finite()) {
            return wrong(
                "tilt_um_per_mm",
                "a tilt is no number",
                "give finite slopes",
            );
        }
        Ok(())
    }
}
