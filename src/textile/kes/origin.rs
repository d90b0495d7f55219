//! Where measured profiles come from, as the manifest keeps it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::TextileError;
use crate::manifest::Checker;

/// The name of the importer in manifests.
pub(crate) const IMPORTER: &str = "kes-f";

/// `[source.imported]`: which files, which section, what was taken off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KesOrigin {
    /// Always `kes-f`.
    pub importer: String,
    /// The names of the files.
    pub files: Vec<String>,
    /// Their SHA-256, in the same order.
    pub sha256: Vec<String>,
    /// What one volt stood for, µm, where heights were in volts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub um_per_volt: Option<f64>,
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
    pub tilt_um_per_mm: BTreeMap<String, f64>,
}

impl KesOrigin {
    pub fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
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
