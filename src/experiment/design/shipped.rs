//! The designs that are part of the program: the papers' sessions and the usual measurements.

use std::path::Path;

use super::Design;

macro_rules! shipped {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../assets/designs/", $name, ".toml")),
        )
    };
}
const SHIPPED: [(&str, &str); 12] = [
    shipped!("ranking-real-target"),
    shipped!("ranking-virtual-target"),
    shipped!("odd-one-out"),
    shipped!("adjustment-two-gains"),
    shipped!("gain-matching"),
    shipped!("real-or-generated"),
    shipped!("threshold-40"),
    shipped!("threshold-320"),
    shipped!("jnd-40"),
    shipped!("jnd-320"),
    shipped!("magnitude"),
    shipped!("rating"),
];

impl Design {
    /// The names of the designs that are part of the program.
    pub fn shipped_names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// The text of a design of the program.
    pub fn shipped_text(name: &str) -> Option<&'static str> {
        let mut shipped = SHIPPED.iter();
        shipped
            .find(|(known, _)| *known == name)
            .map(|(_, text)| *text)
    }

    /// The design of the program with this name.
    pub fn shipped(name: &str) -> Option<Self> {
        let text = Self::shipped_text(name)?;
        Self::from_toml(text, Path::new(name)).ok()
    }
}
