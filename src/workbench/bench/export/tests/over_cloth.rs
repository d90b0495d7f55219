//! Exports of what textiles give all over: maps over the cloth, and the library as a whole.

use super::*;
use crate::bench::library_selection::Joining;
use crate::tools::workspace::Workspace;
use selvedge_textile::tactile::{Band, Filters, Levels};

#[test]
fn the_map_holds_what_lies_under_the_pointer_at_every_point_of_every_textile() {
    let mut desk = Headless::explored(30);
    let exported = desk.exported(Exportable::Pane(Pane::Workspace));
    let numbers = ["place", "u_mm", "w_mm", "amplitude_um"].map(|name| column(&exported, name));
    let table = table_of(&exported);
    let textiles = table.text("textile").unwrap();
    let scene = desk.workbench.scene();
    let n_points: f64 = scene
        .textiles
        .iter()
        .map(|cloth| (cloth.size_mm[0] + 1.0) * (cloth.size_mm[1] + 1.0))
        .sum();
    assert_eq!(numbers[3].len() as f64, n_points);
    let workspace: &Workspace = desk.workbench.tools.get().unwrap();
    let maps = &workspace.maps;
    for (row, (place, amplitude_um)) in numbers[0].iter().zip(&numbers[3]).enumerate() {
        let index = (0..scene.textiles.len()).find(|index| *index as f64 == *place);
        let index = index.unwrap();
        assert_eq!(textiles[row], scene.textiles[index].id);
        let at = [numbers[1][row], numbers[2][row]];
        assert_eq!(maps.amplitude_um(index, at), Some(*amplitude_um), "{at:?}");
    }
    assert_eq!(column(&exported, "band_hz")[0], 320.0);
    let panels: usize = exported
        .figure
        .rows
        .iter()
        .map(|row| row.panels.len())
        .sum();
    assert_eq!(panels, scene.textiles.len(), "one panel a textile");
}

#[test]
fn without_a_map_the_entry_says_how_to_show_one() {
    let mut desk = Headless::fresh();
    desk.pass_ticks(1);
    desk.file(FileCommand::Ask(Purpose::Export(Exportable::Pane(
        Pane::Workspace,
    ))));
    assert!(desk.notices().contains("“Overlay”"), "{}", desk.notices());
}

#[test]
fn the_collection_holds_the_levels_of_every_textile() {
    let mut desk = Headless::collected(4);
    let chosen = vec!["silk-crepe".to_owned()];
    let selection = &mut desk.workbench.bench.library.selection;
    selection.select(chosen, Joining::Alone);
    let exported = desk.exported(Exportable::Pane(Pane::Collection));
    let table = table_of(&exported);
    let ids = table.text("textile").unwrap();
    let library = std::sync::Arc::clone(desk.workbench.bench.library.view.library());
    assert_eq!(ids, library.ids());
    for (band, name) in Band::ALL.into_iter().zip(["raw_a40_um", "raw_a320_um"]) {
        for (id, um) in ids.iter().zip(column(&exported, name)) {
            let textile = library.load(id).unwrap();
            let levels = Levels::of(textile.surface(), &Filters::default());
            assert_eq!(um.to_bits(), levels.mean_um[band.index()].to_bits(), "{id}");
        }
    }
    let [raw_db, gains_db, tuned_db] =
        ["raw_level_db", "gain_40_db", "tuned_level_db"].map(|name| column(&exported, name));
    for (i, id) in ids.iter().enumerate() {
        let is_tuned = (raw_db[i] + gains_db[i] - tuned_db[i]).abs() < 1e-9;
        assert!(is_tuned, "{id}: the bands have no gain of their own");
    }
    let n_selected: f64 = column(&exported, "is_selected").iter().sum();
    assert_eq!(n_selected, 1.0);
}
