//! The profiles that are part of the program.

use std::path::Path;

use super::ArrayProfile;

const SHIPPED: [(&str, &str); 3] = [
    (
        "exeter-24",
        include_str!("../../../assets/arrays/exeter-24.toml"),
    ),
    ("5x5", include_str!("../../../assets/arrays/5x5.toml")),
    ("10x10", include_str!("../../../assets/arrays/10x10.toml")),
];

impl ArrayProfile {
    /// The names of the profiles that are part of the program.
    pub const SHIPPED: [&'static str; 3] = [SHIPPED[0].0, SHIPPED[1].0, SHIPPED[2].0];

    /// The profile of the program with this name.
    pub fn shipped(name: &str) -> Option<Self> {
        let (_, text) = SHIPPED.into_iter().find(|(known, _)| *known == name)?;
        Self::from_toml(text, Path::new(name)).ok()
    }
}
