//! How the window is arranged for each perspective. Each keeps its own arrangement of all the
//! panes.

use eframe::egui::{Id, Vec2};
use egui_tiles::{LinearDir, TileId, Tiles, Tree};

use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::shell::arrangement;
use crate::shell::arrangement::{is_roomy, linear, tabs};

/// Width of the library beside the lab, points.
const LIBRARY: f32 = 200.0;
/// Height of what stands below the lab, points.
const BELOW: f32 = 168.0;
/// Width of the experimenter's view, points.
const EXPERIMENTER: f32 = 328.0;

/// The arrangement that a window of this size begins with, points.
pub(crate) fn arrangement_for(perspective: Perspective, size: Vec2) -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let (id, root) = match perspective {
        Perspective::Explore => return arrangement::default_tree(size),
        Perspective::Cloth => ("cloth", cloth(&mut tiles, size)),
        Perspective::Experiment => ("experiment", experiment(&mut tiles, size)),
    };
    let mut tree = Tree::new(Id::unique(id), root, tiles);
    // The business of Explore, and rows of tabs are full.
    if let Some(tile) = arrangement::tile_of(&tree, Pane::Levels) {
        tree.set_visible(tile, false);
    }
    tree
}

/// The library on the left, the lab in the middle, every other pane in a row of tabs below it; in
/// a small window the lab in front of all.
fn cloth(tiles: &mut Tiles<Pane>, size: Vec2) -> TileId {
    let middle = [
        Pane::Lab,
        Pane::Import,
        Pane::Picture,
        #[cfg(feature = "friction")]
        Pane::Friction,
        Pane::Drape,
        Pane::Collection,
        Pane::Workspace,
    ];
    if !is_roomy(size) {
        let mut all = Pane::ALL;
        all.sort_by_key(|pane| match pane {
            Pane::Lab => 0,
            Pane::Library => 1,
            Pane::Collection => 2,
            Pane::Workspace => 3,
            _ => 4,
        });
        return tabs(tiles, &all);
    }
    let stands = |pane: &Pane| !middle.contains(pane) && *pane != Pane::Library;
    let mut below: Vec<Pane> = Pane::ALL.into_iter().filter(stands).collect();
    // In front stands what shows the amplitudes of the contactors.
    below.sort_by_key(|pane| *pane != Pane::Heatmaps);
    let below = tabs(tiles, &below);
    let middle = tabs(tiles, &middle);
    let height = (size.y - BELOW).max(BELOW);
    let parts = [(middle, height), (below, BELOW)];
    let middle = linear(tiles, LinearDir::Vertical, &parts);
    let library = tabs(tiles, &[Pane::Library]);
    let parts = [(library, LIBRARY), (middle, size.x - LIBRARY)];
    linear(tiles, LinearDir::Horizontal, &parts)
}

/// The participant's view, large, and behind it the study and what was found; the experimenter's
/// beside them, with the device and every other pane below. In a small window the participant's
/// stands in front.
fn experiment(tiles: &mut Tiles<Pane>, size: Vec2) -> TileId {
    let mut rest = Pane::ALL.to_vec();
    rest.sort_by_key(|pane| match pane {
        Pane::Participant => 0,
        Pane::Builder => 1,
        Pane::Board => 2,
        Pane::Analysis => 3,
        Pane::Experimenter => 4,
        Pane::Bridge => 5,
        _ => 6,
    });
    if !is_roomy(size) {
        return tabs(tiles, &rest);
    }
    let participant = tabs(tiles, &rest[..4]);
    let experimenter = tabs(tiles, &rest[4..5]);
    let rest = tabs(tiles, &rest[5..]);
    let parts = [(experimenter, 0.66), (rest, 0.34)];
    let right = linear(tiles, LinearDir::Vertical, &parts);
    let parts = [(participant, size.x - EXPERIMENTER), (right, EXPERIMENTER)];
    linear(tiles, LinearDir::Horizontal, &parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell::arrangement::{from_text, is_shown, to_text};

    #[test]
    fn every_perspective_holds_every_pane_and_survives_being_kept() {
        for perspective in Perspective::ALL {
            for size in [Vec2::new(1400.0, 900.0), Vec2::new(700.0, 450.0)] {
                let tree = arrangement_for(perspective, size);
                for pane in Pane::ALL {
                    let tile = arrangement::tile_of(&tree, pane);
                    assert!(tile.is_some(), "{perspective:?} {pane:?}");
                }
                let text = to_text(&tree).unwrap();
                assert_eq!(from_text(&text, perspective), Some(tree));
            }
        }
    }

    #[test]
    fn the_lab_stands_in_front_where_cloth_is_made_and_behind_where_it_is_felt() {
        let size = Vec2::new(1400.0, 900.0);
        let shows =
            |perspective: Perspective, pane| is_shown(&arrangement_for(perspective, size), pane);
        assert!(shows(Perspective::Cloth, Pane::Lab));
        assert!(shows(Perspective::Cloth, Pane::Library));
        assert!(!shows(Perspective::Cloth, Pane::Workspace));
        assert!(!shows(Perspective::Explore, Pane::Lab));
        assert!(shows(Perspective::Explore, Pane::Workspace));
    }
}
