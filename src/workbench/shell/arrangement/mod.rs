//! Which pane stands where: a tree of tiles that the user may rearrange, and that is kept.
//!
//! A tree that comes from a file is only taken when no pane is in it twice and nothing in it leads
//! nowhere; otherwise the default arrangement is shown. Panes that the program did not have when
//! the tree was kept come in as tabs, each beside a pane that it stands beside by default.

#[cfg(test)]
mod tests;

use std::path::Path;

use eframe::egui::{Id, Vec2};
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};

use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::shell::perspective::arrangement_for;
use selvedge_foundation::files;

/// Share of a window that the library, the controls and the pictures take, each between a least and
/// a most number of points.
const LIBRARY: [f32; 3] = [0.14, 200.0, 280.0];
const CONTROLS: [f32; 3] = [0.235, 328.0, 520.0];
const PICTURES: [f32; 3] = [0.3, 190.0, 420.0];
/// Less room than this, without header and timeline, stacks panes behind each other, points.
const ROOMY: Vec2 = Vec2::new(1100.0, 560.0);

/// The workspace and what stands behind it.
const FRONT: &[Pane] = &[
    Pane::Workspace,
    Pane::Lab,
    Pane::Import,
    Pane::Picture,
    #[cfg(feature = "friction")]
    Pane::Friction,
    Pane::Drape,
    Pane::Collection,
    Pane::Participant,
    Pane::Builder,
    Pane::Board,
    Pane::Analysis,
];

/// What belongs to other perspectives: hidden here until it is asked for.
const ELSEWHERE: &[Pane] = &[
    Pane::Lab,
    Pane::Import,
    Pane::Picture,
    #[cfg(feature = "friction")]
    Pane::Friction,
    Pane::Drape,
    Pane::Collection,
    Pane::Participant,
    Pane::Builder,
    Pane::Board,
    Pane::Experimenter,
    Pane::Analysis,
];

/// The arrangement that a window of this size begins with, points.
pub(crate) fn default_tree(size: Vec2) -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let root = if is_roomy(size) {
        roomy(&mut tiles, size)
    } else {
        stacked(&mut tiles)
    };
    let mut tree = Tree::new(Id::unique("arrangement"), root, tiles);
    for pane in ELSEWHERE {
        if let Some(tile) = tile_of(&tree, *pane) {
            tree.set_visible(tile, false);
        }
    }
    tree
}

fn part_of(whole: f32, [share, least, most]: [f32; 3]) -> f32 {
    (share * whole).clamp(least, most).round()
}

/// Whether a window of this size has room for everything side by side, points.
pub(crate) fn is_roomy(size: Vec2) -> bool {
    size.x >= ROOMY.x && size.y >= ROOMY.y
}

/// Everything in sight: cloth on the left, controls on the right, pictures below the cloth.
fn roomy(tiles: &mut Tiles<Pane>, size: Vec2) -> TileId {
    let [library_width, controls_width] = [LIBRARY, CONTROLS].map(|part| part_of(size.x, part));
    let pictures_height = part_of(size.y, PICTURES);
    let left = (size.x - controls_width).max(controls_width);
    let library = tabs(tiles, &[Pane::Library, Pane::Recordings]);
    let workspace = tabs(tiles, FRONT);
    let upper = [(library, library_width), (workspace, left - library_width)];
    let upper = linear(tiles, LinearDir::Horizontal, &upper);
    let heatmaps = tabs(tiles, &[Pane::Heatmaps]);
    let spectra = tabs(tiles, &[Pane::ContactSpectrum, Pane::DriveSpectrum]);
    let closer = [
        Pane::SpatialSpectra,
        Pane::Why,
        Pane::Response,
        Pane::Accuracy,
        Pane::Compare,
        Pane::Stylus,
    ];
    let spatial = tabs(tiles, &closer);
    let lower = [(heatmaps, 0.27), (spectra, 0.39), (spatial, 0.34)];
    let lower = linear(tiles, LinearDir::Horizontal, &lower);
    let height = (size.y - pictures_height).max(pictures_height);
    let parts = [(upper, height), (lower, pictures_height)];
    let middle = linear(tiles, LinearDir::Vertical, &parts);
    let tuning = tabs(tiles, &[Pane::Tuning, Pane::Levels]);
    let bridge = tabs(tiles, &[Pane::Bridge, Pane::Experimenter]);
    let wave = tabs(tiles, &[Pane::DriveWave]);
    let parts = [(tuning, 0.488), (bridge, 0.327), (wave, 0.185)];
    let controls = linear(tiles, LinearDir::Vertical, &parts);
    let parts = [(middle, left), (controls, controls_width)];
    linear(tiles, LinearDir::Horizontal, &parts)
}

/// The workspace, with everything else behind two rows of tabs.
fn stacked(tiles: &mut Tiles<Pane>) -> TileId {
    let workspace = tabs(tiles, FRONT);
    let controls = [
        Pane::Tuning,
        Pane::Levels,
        Pane::Bridge,
        Pane::Library,
        Pane::Recordings,
    ];
    let controls = tabs(tiles, &controls);
    let pictures = tabs(
        tiles,
        &[
            Pane::Heatmaps,
            Pane::ContactSpectrum,
            Pane::DriveSpectrum,
            Pane::SpatialSpectra,
            Pane::Why,
            Pane::Response,
            Pane::Accuracy,
            Pane::Compare,
            Pane::Stylus,
            Pane::DriveWave,
            Pane::Experimenter,
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
        &[(workspace, 0.6), (right, 0.4)],
    )
}

/// Panes behind each other, the first in front.
pub(crate) fn tabs(tiles: &mut Tiles<Pane>, panes: &[Pane]) -> TileId {
    let children: Vec<TileId> = panes.iter().map(|pane| tiles.insert_pane(*pane)).collect();
    let front = children.first().copied();
    let id = tiles.insert_tab_tile(children);
    if let (Some(Tile::Container(Container::Tabs(tabs))), Some(front)) = (tiles.get_mut(id), front)
    {
        tabs.set_active(front);
    }
    id
}

/// Tiles beside or below each other, with their shares.
pub(crate) fn linear(
    tiles: &mut Tiles<Pane>,
    direction: LinearDir,
    parts: &[(TileId, f32)],
) -> TileId {
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

/// The arrangement of a perspective from text, with every pane in it; `None` when it is not a sound
/// one.
pub(crate) fn from_text(text: &str, perspective: Perspective) -> Option<Tree<Pane>> {
    let mut tree: Tree<Pane> = files::from_json_str(text, Path::new("arrangement")).ok()?;
    let found = panes_of(&tree)?;
    for pane in Pane::ALL.into_iter().filter(|pane| !found.contains(pane)) {
        insert(&mut tree, pane, perspective)?;
    }
    Some(tree)
}

/// Puts a pane that is not in the tree behind a pane that it stands beside by default, or else
/// behind any; `None` when there is none.
fn insert(tree: &mut Tree<Pane>, pane: Pane, perspective: Perspective) -> Option<()> {
    let defaults = [ROOMY, Vec2::ZERO].map(|size| arrangement_for(perspective, size));
    let beside = defaults.iter().flat_map(|tree| neighbours(tree, pane));
    let mut candidates = beside.chain(Pane::ALL.into_iter().rev());
    let neighbour = candidates.find_map(|pane| tile_of(tree, pane))?;
    let id = tree.tiles.insert_pane(pane);
    match tree.tiles.parent_of(neighbour) {
        Some(parent) => match tree.tiles.get_mut(parent)? {
            Tile::Container(container) => container.add_child(id),
            Tile::Pane(_) => return None,
        },
        None => tree.root = Some(tree.tiles.insert_tab_tile(vec![neighbour, id])),
    }
    Some(())
}

/// The panes that share a container with a pane, those listed nearest before it first.
fn neighbours(tree: &Tree<Pane>, pane: Pane) -> Vec<Pane> {
    let parent = tile_of(tree, pane).and_then(|id| tree.tiles.parent_of(id));
    let container = parent.and_then(|id| tree.tiles.get_container(id));
    let children = container.map_or_else(Vec::new, Container::children_vec);
    let panes = children
        .iter()
        .filter_map(|id| tree.tiles.get_pane(id).copied());
    let (mut before, after): (Vec<Pane>, Vec<Pane>) = panes
        .filter(|other| *other != pane)
        .partition(|other| *other < pane);
    before.reverse();
    before.extend(after);
    before
}

/// The panes of a tree in which every tile has a place and a size and no pane is twice; `None` for
/// any other.
fn panes_of(tree: &Tree<Pane>) -> Option<Vec<Pane>> {
    let mut panes = Vec::new();
    let mut seen = Vec::new();
    let mut next: Vec<TileId> = tree.root().into_iter().collect();
    while let Some(id) = next.pop() {
        if seen.contains(&id) {
            return None;
        }
        seen.push(id);
        match tree.tiles.get(id) {
            Some(Tile::Pane(pane)) => panes.push(*pane),
            Some(Tile::Container(container)) if has_sizes(container) => {
                next.extend(container.children());
            }
            _ => return None,
        }
    }
    panes.sort_unstable();
    let is_twice = panes.windows(2).any(|pair| pair[0] == pair[1]);
    let is_whole = !panes.is_empty() && seen.len() == tree.tiles.len();
    (is_whole && !is_twice).then_some(panes)
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
