//! Measured profiles, and the names of profile files.

use serde::{Deserialize, Serialize};

use crate::kes::KesOrigin;
use crate::surface::Direction;

/// Profiles as they were measured (`kind = "profiles"`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profiles {
    /// Always `profiles`.
    pub kind: String,
    /// Along the warp: a CSV of `x_mm,height_um` beside the manifest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warp_forward: Option<String>,
    /// Along the warp and back, in travel order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warp_reverse: Option<String>,
    /// Along the weft.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weft_forward: Option<String>,
    /// Along the weft and back, in travel order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weft_reverse: Option<String>,
    /// The coefficient of friction along the warp: a CSV of `x_mm,mu`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<String>,
    /// Where they were imported from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub imported: Option<Box<KesOrigin>>,
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

/// Profile files by [`Direction::index`], beside the manifest.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct ProfileFiles(pub [Option<String>; 4]);

impl ProfileFiles {
    /// Whether no file is named.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// The file of a direction.
    pub(crate) fn of(&self, direction: Direction) -> Option<&str> {
        self.0[direction.index()].as_deref()
    }
}

/// The files and the hash that the keys of every recipe hold alike, read and set.
macro_rules! profile_file_keys {
    ($keys:ty) => {
        impl $keys {
            /// The profile files that stand for the recipe, if it names them.
            pub(crate) fn files(&self) -> crate::manifest::ProfileFiles {
                crate::manifest::ProfileFiles([
                    self.warp_forward.clone(),
                    self.warp_reverse.clone(),
                    self.weft_forward.clone(),
                    self.weft_reverse.clone(),
                ])
            }

            /// Names the profile files, and the recipe that they came from.
            pub(crate) fn set_files(
                &mut self,
                files: crate::manifest::ProfileFiles,
                recipe_hash: Option<String>,
            ) {
                [
                    self.warp_forward,
                    self.warp_reverse,
                    self.weft_forward,
                    self.weft_reverse,
                ] = files.0;
                self.recipe_hash = recipe_hash;
            }
        }
    };
}
pub(crate) use profile_file_keys;
