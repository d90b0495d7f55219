//! What can be marked, muted and drawn: parts of a scene, and how a contactor is drawn.

use selvedge_textile::tactile::Band;

/// Something that can be muted or felt alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// A band.
    Band(Band),
    /// The textile at this place in the scene's list.
    Cloth(usize),
    /// A contactor.
    Contactor(usize),
}

/// How a contactor's two amplitudes are drawn as a dot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum DotStyle {
    /// A40 is its size, A320 its glow.
    #[default]
    #[serde(rename = "size and glow")]
    SizeAndGlow,
    /// Both by size: A40 the disc, A320 a ring around it.
    Size,
    /// Both by brightness: the larger of the two.
    Brightness,
}
