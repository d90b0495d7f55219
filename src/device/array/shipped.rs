//! The profiles that are part of the program.

use std::path::Path;
use std::sync::OnceLock;

use super::ArrayProfile;

/// What was read of them: asked for with every frame of the window.
static PROFILES: OnceLock<[Option<ArrayProfile>; 3]> = OnceLock::new();

const SHIPPED: [(&str, &str); 3] = [
    (
        "exeter-24",
        include_str!("../../../assets/arrays/exeter-24.toml"),
    ),
    ("5x5", include_str!("../../../assets/arrays/5x5.toml")),
    ("10x10", include_str!("../../../assets/arrays/10x10.toml")),
];

/// The text of a profile of the program.
pub(super) fn text(name: &str) -> Option<&'static str> {
    let mut shipped = SHIPPED.into_iter();
    shipped
        .find(|(known, _)| *known == name)
        .map(|(_, text)| text)
}

impl ArrayProfile {
    /// The names of the profiles that are part of the program.
    pub const SHIPPED: [&'static str; 3] = [SHIPPED[0].0, SHIPPED[1].0, SHIPPED[2].0];

    /// The profile of the program with this name.
    pub fn shipped(name: &str) -> Option<Self> {
        let read = |name| Self::from_toml(text(name)?, Path::new(name)).ok();
        let all = PROFILES.get_or_init(|| Self::SHIPPED.map(read));
        let mut shipped = all.iter().flatten();
        shipped.find(|profile| profile.name == name).cloned()
    }
}
