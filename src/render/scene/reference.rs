//! Recordings that belong to a scene, by where they lie.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// A recording that a scene refers to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordingReference {
    /// What people call it.
    pub name: String,
    /// Its folder, or a path file; relative to the scene's file. Nothing need be there.
    pub path: PathBuf,
}

impl RecordingReference {
    /// Where it is as seen from where the program runs, for a scene file at `scene`.
    pub fn place(&self, scene: Option<&Path>) -> PathBuf {
        let beside = scene.and_then(Path::parent);
        beside.map_or_else(|| self.path.clone(), |beside| beside.join(&self.path))
    }
}
