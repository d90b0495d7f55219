//! Arrangements: whole, kept and mended.

use super::*;
use crate::bench::command::{FileCommand, Purpose, ShowCommand};
use crate::shell::headless::Headless;
use selvedge_scratch::ScratchFolder;

fn from_text(text: &str) -> Option<Tree<Pane>> {
    super::from_text(text, Perspective::Explore)
}

const SIZES: [Vec2; 3] = [
    Vec2::new(1400.0, 900.0),
    Vec2::new(1280.0, 720.0),
    Vec2::new(700.0, 450.0),
];

#[test]
fn every_default_holds_every_pane_and_survives_being_kept() {
    for size in SIZES {
        let tree = default_tree(size);
        assert_eq!(
            panes_of(&tree).map_or(0, |panes| panes.len()),
            Pane::ALL.len()
        );
        let text = to_text(&tree).unwrap();
        assert_eq!(from_text(&text).as_ref(), Some(&tree), "{size:?}");
    }
}

#[test]
fn what_belongs_to_other_perspectives_is_no_tab_until_it_is_asked_for() {
    for size in SIZES {
        let mut tree = default_tree(size);
        for &pane in ELSEWHERE {
            let tile = tile_of(&tree, pane).unwrap();
            assert!(!tree.is_visible(tile), "{pane:?}");
            toggle(&mut tree, pane);
            assert!(is_shown(&tree, pane), "{pane:?}");
        }
    }
}

#[test]
fn a_larger_window_gives_every_part_more_room() {
    let parts = |width| [LIBRARY, CONTROLS, PICTURES].map(|part| part_of(width, part));
    let [small, large] = [1100.0, 1800.0].map(parts);
    assert!(small.iter().zip(large).all(|(small, large)| *small < large));
    assert_eq!(parts(1e4), [280.0, 520.0, 420.0]);
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
    assert_eq!(panes_of(&without), None, "a tab leads nowhere");
    let mut circle = tree.clone();
    let root = circle.root().unwrap();
    let tuning = tile_of(&circle, Pane::Tuning).unwrap();
    let parent = circle.tiles.parent_of(tuning).unwrap();
    if let Some(Tile::Container(container)) = circle.tiles.get_mut(parent) {
        container.add_child(root);
    }
    assert_eq!(panes_of(&circle), None, "it goes round");
}

/// The tree as a program without these panes would have kept it.
fn without(tree: &Tree<Pane>, panes: &[Pane]) -> Tree<Pane> {
    let mut tree = tree.clone();
    for pane in panes {
        let id = tile_of(&tree, *pane).unwrap();
        tree.remove_recursively(id);
    }
    tree
}

#[test]
fn an_arrangement_from_before_a_pane_was_there_takes_it_in_as_a_tab() {
    for size in SIZES {
        let default = default_tree(size);
        for pane in Pane::ALL {
            let mut older = without(&default, &[pane]);
            older.simplify(&egui_tiles::SimplificationOptions {
                all_panes_must_have_tabs: true,
                ..egui_tiles::SimplificationOptions::default()
            });
            let tree = from_text(&to_text(&older).unwrap()).unwrap();
            assert_eq!(
                panes_of(&tree).map(|panes| panes.len()),
                Some(Pane::ALL.len())
            );
            let shown = |tree: &Tree<Pane>| Pane::ALL.map(|pane| is_shown(tree, pane));
            let own = pane.index();
            for (other, (now, before)) in shown(&tree).iter().zip(shown(&older)).enumerate() {
                assert!(other == own || *now == before, "{pane:?}: {other} changed");
            }
        }
    }
}

#[test]
fn a_new_pane_stands_behind_its_neighbours_wherever_they_were_put() {
    let newer = [Pane::Response, Pane::Why, Pane::Accuracy, Pane::Compare];
    let mut older = without(&default_tree(SIZES[0]), &newer);
    let spatial = tile_of(&older, Pane::SpatialSpectra).unwrap();
    let wave = tile_of(&older, Pane::DriveWave).unwrap();
    let tabs = older.tiles.parent_of(wave).unwrap();
    older.move_tile_to_container(spatial, tabs, 1, false);
    let tree = from_text(&to_text(&older).unwrap()).unwrap();
    let parent = |pane| tree.tiles.parent_of(tile_of(&tree, pane).unwrap());
    assert_eq!(parent(Pane::Response), Some(tabs));
    assert_eq!(parent(Pane::Why), Some(tabs));
    let alone = Tree::new_tabs(Id::unique("alone"), vec![Pane::Workspace]);
    let tree = from_text(&to_text(&alone).unwrap()).unwrap();
    assert_eq!(
        panes_of(&tree).map(|panes| panes.len()),
        Some(Pane::ALL.len())
    );
    assert_eq!(
        from_text(&to_text(&Tree::empty(Id::unique("nothing"))).unwrap()),
        None
    );
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

/// Saved with its arrangement, opened by somebody who has another one, and left again.
#[test]
fn a_scene_that_keeps_its_arrangement_shows_it_and_leaves_the_users_own_alone() {
    let folder = ScratchFolder::made("arrangement");
    let path = folder.join("with-arrangement.toml");
    let shows = |window: &Headless, pane| window.workbench.shell.shows(pane);
    let mut window = Headless::shipped();
    window.pass(2);
    window.dispatch(ShowCommand::ToggleSceneArrangement);
    assert!(window.workbench.bench.document.is_edited());
    window.dispatch(ShowCommand::Reveal(Pane::Why));
    window.dispatch(ShowCommand::Pane(Pane::Heatmaps));
    window.pass(2);
    window.dispatch(FileCommand::Use(Purpose::SaveScene, path.clone()));
    let told = window.workbench.bench.notices.shown().to_vec();
    assert!(!window.workbench.bench.document.is_edited(), "{told:?}");
    let kept = window.workbench.bench.settings.preferences.arrangements[0].clone();
    assert_eq!(kept, None, "the user's own is as it was");

    let mut other = Headless::shipped();
    other.dispatch(ShowCommand::Perspective(Perspective::Cloth));
    other.pass(2);
    other.dispatch(FileCommand::Use(Purpose::OpenScene, path.clone()));
    other.pass(3);
    assert!(shows(&other, Pane::Why) && !shows(&other, Pane::Heatmaps));
    other.dispatch(FileCommand::OpenShipped);
    other.pass(3);
    assert!(shows(&other, Pane::Heatmaps) && !shows(&other, Pane::Why));

    let text = folder.read("with-arrangement.toml");
    let broken = text.replace("\"root\"", "\"rood\"");
    assert_ne!(text, broken);
    std::fs::write(&path, broken).unwrap();
    other.dispatch(FileCommand::Use(Purpose::OpenScene, path.clone()));
    other.pass(3);
    assert!(shows(&other, Pane::Heatmaps), "as the user had it");
    let told = other.workbench.bench.notices.shown();
    let is_told = told
        .iter()
        .any(|notice| notice.text.contains("could not be used"));
    assert!(is_told, "{told:?}");
}
