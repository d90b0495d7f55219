//! What is kept of what the hand holds or feels: tablets by their names, the stylus, what drives an
//! electrovibration screen.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use selvedge_engine::Area;
use selvedge_render::electrovibration::Electrovibration;
use selvedge_render::stylus::StylusSettings;

/// Tablets, the stylus, the screen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct HandTools {
    /// Where the surfaces of tablets of these names lie in the workspace.
    #[serde(
        rename = "tablet_areas_mm",
        with = "areas",
        skip_serializing_if = "BTreeMap::is_empty"
    )]
    pub(crate) tablet_areas: BTreeMap<String, Area>,
    /// The stylus as it is applied.
    pub(crate) stylus: StylusSettings,
    /// What was asked of it and waits, since it cannot be held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) stylus_waiting: Option<StylusSettings>,
    /// How friction drives a screen; kept by builds without its pane, too.
    pub(crate) electrovibration: Electrovibration,
}

/// Areas by the names of their tablets, as left, bottom, width and height.
mod areas {
    use std::collections::BTreeMap;

    use serde::de::Error as _;
    use serde::{Deserialize as _, Deserializer, Serializer};

    use selvedge_engine::Area;

    pub(super) fn serialize<S: Serializer>(
        areas: &BTreeMap<String, Area>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        to.collect_map(areas.iter().map(|(name, area)| (name, area.numbers())))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<BTreeMap<String, Area>, D::Error> {
        let areas = BTreeMap::<String, [f64; 4]>::deserialize(from)?;
        let area = |(name, numbers)| Ok((name, Area::of(numbers).map_err(D::Error::custom)?));
        areas.into_iter().map(area).collect()
    }
}
