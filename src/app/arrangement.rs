//! Which pane stands where: a tree of tiles that the user may rearrange, and that is kept.
//!
//! A tree that comes from a file is only taken when every pane is in it exactly once and nothing in
//! it leads nowhere; otherwise the default arrangement is shown.

use std::path::Path;

use eframe::egui::{Id, Vec2};
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

use crate::files;

/// Widths and heights of the default arrangement, points.
const LIBRARY: f32 = 200.0;
const CONTROLS: f32 = 328.0;
const PICTURES: f32 = 236.0;
/// Less room than this, without header and timeline, stacks panes behind each other, points.
const ROOMY: Vec2 = Vec2::new(1100.0, 560.0);

/// A part of the window that can be moved, stacked and hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) enum Pane {
    /// The scene in mm with the display moving over it.
    Workspace,
    /// The textiles of the library and of the scene.
    Library,
    /// Gains, compression, filters.
    Tuning,
    /// The device.
    Bridge,
    /// Both bands of every contactor.
    Heatmaps,
    /// The spectrum that arrives at the selected contactor, over time.
    ContactSpectrum,
    /// The spectrum of what drives the selected contactor, over time.
    DriveSpectrum,
    /// The waveform that drives the selected contactor.
    DriveWave,
    /// Spatial spectra of the textile under the selected contactor.
    SpatialSpectra,
    /// Why the selected contactor does what it does.
    Why,
    /// Two tunings, textiles or methods set against each other.
    Compare,
    /// How accurate rendering is, and what it costs.
    Accuracy,
}

impl Pane {
    /// Every pane, in the order in which they are listed.
    pub(crate) const ALL: [Self; 12] = [
        Self::Workspace,
        Self::Library,
        Self::Tuning,
        Self::Bridge,
        Self::Heatmaps,
        Self::ContactSpectrum,
        Self::DriveSpectrum,
        Self::SpatialSpectra,
        Self::DriveWave,
        Self::Why,
        Self::Compare,
        Self::Accuracy,
    ];

    /// Its title.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Workspace => "Workspace",
            Self::Library => "Library",
            Self::Tuning => "Tuning",
            Self::Bridge => "Bridge",
            Self::Heatmaps => "Contactors",
            Self::ContactSpectrum => "Contact spectrum",
            Self::DriveSpectrum => "Drive spectrum",
            Self::DriveWave => "Drive waveform",
            Self::SpatialSpectra => "Spatial spectra",
            Self::Why => "Why",
            Self::Compare => "Compare",
            Self::Accuracy => "Accuracy",
        }
    }

    /// Its title where there is little room.
    pub(crate) fn short_title(self) -> &'static str {
        match self {
            Self::ContactSpectrum => "Contact",
            Self::DriveSpectrum => "Drive",
            Self::DriveWave => "Wave",
            Self::SpatialSpectra => "Spatial",
            Self::Workspace
            | Self::Library
            | Self::Tuning
            | Self::Bridge
            | Self::Heatmaps
            | Self::Why
            | Self::Accuracy
            | Self::Compare => self.title(),
        }
    }

    /// Its place in [`Self::ALL`].
    pub(crate) fn index(self) -> usize {
        Self::ALL
            .iter()
            .position(|pane| *pane == self)
            .unwrap_or_default()
    }
}

/// The arrangement that a window of this size begins with, points.
pub(crate) fn default_tree(size: Vec2) -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let root = if is_roomy(size) {
        roomy(&mut tiles, size)
    } else {
        stacked(&mut tiles)
    };
    Tree::new(Id::unique("arrangement"), root, tiles)
}

/// Whether a window of this size has room for everything side by side, points.
pub(crate) fn is_roomy(size: Vec2) -> bool {
    size.x >= ROOMY.x && size.y >= ROOMY.y
}

/// Everything in sight: cloth on the left, controls on the right, pictures below the cloth.
fn roomy(tiles: &mut Tiles<Pane>, size: Vec2) -> TileId {
    let left = (size.x - CONTROLS).max(CONTROLS);
    let library = tabs(tiles, &[Pane::Library]);
    let workspace = tabs(tiles, &[Pane::Workspace]);
    let upper = [(library, LIBRARY), (workspace, left - LIBRARY)];
    let upper = linear(tiles, LinearDir::Horizontal, &upper);
    let heatmaps = tabs(tiles, &[Pane::Heatmaps]);
    let spectra = tabs(tiles, &[Pane::ContactSpectrum, Pane::DriveSpectrum]);
    let closer = [
        Pane::SpatialSpectra,
        Pane::Why,
        Pane::Accuracy,
        Pane::Compare,
    ];
    let spatial = tabs(tiles, &closer);
    let lower = [(heatmaps, 0.27), (spectra, 0.39), (spatial, 0.34)];
    let lower = linear(tiles, LinearDir::Horizontal, &lower);
    let height = (size.y - PICTURES).max(PICTURES);
    let parts = [(upper, height), (lower, PICTURES)];
    let middle = linear(tiles, LinearDir::Vertical, &parts);
    let tuning = tabs(tiles, &[Pane::Tuning]);
    let bridge = tabs(tiles, &[Pane::Bridge]);
    let wave = tabs(tiles, &[Pane::DriveWave]);
    let parts = [(tuning, 0.48), (bridge, 0.325), (wave, 0.195)];
    let controls = linear(tiles, LinearDir::Vertical, &parts);
    let parts = [(middle, left), (controls, CONTROLS)];
    linear(tiles, LinearDir::Horizontal, &parts)
}

/// The workspace, with everything else behind two rows of tabs.
fn stacked(tiles: &mut Tiles<Pane>) -> TileId {
    let workspace = tabs(tiles, &[Pane::Workspace]);
    let controls = tabs(tiles, &[Pane::Tuning, Pane::Bridge, Pane::Library]);
    let pictures = tabs(
        tiles,
        &[
            Pane::Heatmaps,
            Pane::ContactSpectrum,
            Pane::DriveSpectrum,
            Pane::SpatialSpectra,
            Pane::Why,
            Pane::Compare,
            Pane::Accuracy,
            Pane::DriveWave,
        ],
    );
    let right = linear(
        tiles,
        LinearDir::Vertical,
        &[(controls, 0.5), (pictures, 0.5)],
    );
    linear(
        tiles,
        LinearDir::Horizontal,
        &[(workspace, 0.55), (right, 0.45)],
    )
}

fn tabs(tiles: &mut Tiles<Pane>, panes: &[Pane]) -> TileId {
    let children: Vec<TileId> = panes.iter().map(|pane| tiles.insert_pane(*pane)).collect();
    let front = children.first().copied();
    let id = tiles.insert_tab_tile(children);
    if let (Some(Tile::Container(Container::Tabs(tabs))), Some(front)) = (tiles.get_mut(id), front)
    {
        tabs.set_active(front);
    }
    id
}

fn linear(tiles: &mut Tiles<Pane>, direction: LinearDir, parts: &[(TileId, f32)]) -> TileId {
    let mut linear = Linear::new(direction, parts.iter().map(|(id, _)| *id).collect());
    for &(id, share) in parts {
        linear.shares.set_share(id, share);
    }
    tiles.insert_container(Container::Linear(linear))
}

/// The arrangement as text, to be kept.
pub(crate) fn to_text(tree: &Tree<Pane>) -> Option<String> {
    files::to_json_string(tree, Path::new("arrangement")).ok()
}

/// The arrangement from text; `None` when it is not a whole one.
pub(crate) fn from_text(text: &str) -> Option<Tree<Pane>> {
    let tree: Tree<Pane> = files::from_json_str(text, Path::new("arrangement")).ok()?;
    is_sound(&tree).then_some(tree)
}

/// Whether every pane is in the tree once, and every tile has a place in it and a size.
fn is_sound(tree: &Tree<Pane>) -> bool {
    let mut panes = Vec::new();
    let mut seen = Vec::new();
    let mut next: Vec<TileId> = tree.root().into_iter().collect();
    while let Some(id) = next.pop() {
        if seen.contains(&id) {
            return false;
        }
        seen.push(id);
        match tree.tiles.get(id) {
            Some(Tile::Pane(pane)) => panes.push(*pane),
            Some(Tile::Container(container)) if has_sizes(container) => {
                next.extend(container.children());
            }
            _ => return false,
        }
    }
    panes.sort_unstable();
    let mut all = Pane::ALL;
    all.sort_unstable();
    panes == all && seen.len() == tree.tiles.len()
}

fn has_sizes(container: &Container) -> bool {
    let is_size = |share: &f32| share.is_finite() && *share > 0.0;
    match container {
        Container::Tabs(_) => true,
        Container::Linear(linear) => linear.shares.iter().all(|(_, share)| is_size(share)),
        Container::Grid(grid) => [&grid.col_shares, &grid.row_shares]
            .into_iter()
            .flatten()
            .all(is_size),
    }
}

/// The tile that holds a pane.
pub(crate) fn tile_of(tree: &Tree<Pane>, pane: Pane) -> Option<TileId> {
    tree.tiles.find_pane(&pane)
}

/// Shows a pane that is hidden, brings one that is behind others to the front, and hides one that
/// is in sight.
pub(crate) fn toggle(tree: &mut Tree<Pane>, pane: Pane) {
    let Some(id) = tile_of(tree, pane) else {
        return;
    };
    let is_in_sight = is_shown(tree, pane);
    tree.set_visible(id, !is_in_sight);
    if !is_in_sight {
        tree.make_active(|tile, _| tile == id);
    }
}

/// Whether a pane is neither hidden nor behind others.
pub(crate) fn is_shown(tree: &Tree<Pane>, pane: Pane) -> bool {
    let is_active = |id| tree.is_visible(id) && tree.active_tiles().contains(&id);
    tile_of(tree, pane).is_some_and(is_active)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: [Vec2; 3] = [
        Vec2::new(1400.0, 900.0),
        Vec2::new(1280.0, 720.0),
        Vec2::new(700.0, 450.0),
    ];

    #[test]
    fn every_default_holds_every_pane_and_survives_being_kept() {
        for size in SIZES {
            let tree = default_tree(size);
            assert!(is_sound(&tree), "{size:?}");
            let text = to_text(&tree).unwrap();
            assert_eq!(from_text(&text).as_ref(), Some(&tree), "{size:?}");
        }
    }

    #[test]
    fn a_damaged_arrangement_is_not_taken() {
        let tree = default_tree(SIZES[0]);
        let text = to_text(&tree).unwrap();
        let damaged = [
            String::new(),
            "null".to_owned(),
            text.replace("\"Bridge\"", "\"Tuning\""),
            text.replace("\"Bridge\"", "\"Orchestra\""),
            text[..text.len() / 2].to_owned(),
        ];
        for text in damaged {
            assert_eq!(from_text(&text), None, "{text}");
        }
        let mut without = tree.clone();
        let bridge = tile_of(&without, Pane::Bridge).unwrap();
        without.tiles.remove(bridge);
        assert!(!is_sound(&without), "a tab leads nowhere");
        let mut circle = tree.clone();
        let root = circle.root().unwrap();
        let tuning = tile_of(&circle, Pane::Tuning).unwrap();
        let parent = circle.tiles.parent_of(tuning).unwrap();
        if let Some(Tile::Container(container)) = circle.tiles.get_mut(parent) {
            container.add_child(root);
        }
        assert!(!is_sound(&circle), "it goes round");
    }

    #[test]
    fn a_pane_comes_to_the_front_before_it_is_hidden() {
        let mut tree = default_tree(SIZES[0]);
        assert!(!is_shown(&tree, Pane::DriveSpectrum), "behind another");
        toggle(&mut tree, Pane::DriveSpectrum);
        assert!(is_shown(&tree, Pane::DriveSpectrum));
        assert!(!is_shown(&tree, Pane::ContactSpectrum), "now behind");
        toggle(&mut tree, Pane::DriveSpectrum);
        assert!(!is_shown(&tree, Pane::DriveSpectrum), "hidden");
        toggle(&mut tree, Pane::DriveSpectrum);
        assert!(is_shown(&tree, Pane::DriveSpectrum), "and back");
    }
}
