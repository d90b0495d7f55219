//! The collection: the whole library as a plot with its table, selected by a frame, placed at once.

use std::time::Instant;

use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use selvedge_textile::Library;
use selvedge_textile::tactile::{Filters, Levels};

use super::*;

/// A folder with a scene without textiles over a library that is part of the program.
struct Bare(Lab);

impl Bare {
    fn new(name: &str, library: &str) -> Self {
        let folder = Lab::named(name);
        let scene = format!(
            "name = \"Bare\"\n{library}size_mm = [260.0, 260.0]\n[[display]]\n\
             geometry = \"exeter-24\"\n"
        );
        folder.write("bare.scene.toml", scene);
        Self(folder)
    }

    fn scene(&self) -> PathBuf {
        self.0.path("bare.scene.toml")
    }
}

/// A window with the pane in front and all sixteen textiles measured.
fn in_front(folder: &Bare) -> Harness<'static, Workbench> {
    let mut harness = window(&folder.scene());
    harness.run_steps(3);
    click_tab(&mut harness, "Collection");
    wait(&mut harness, |bench| bench.n_textiles_measured() == 16);
    harness.run_steps(3);
    harness
}

fn point(harness: &Harness<'_, Workbench>, name: &str) -> Rect {
    let label = format!("{name} in the plot");
    harness.get_by_role_and_label(Role::CheckBox, &label).rect()
}

/// Pulls a frame from one place to another.
fn pull(harness: &mut Harness<'_, Workbench>, from: Pos2, to: Pos2) {
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for share in [0.3, 0.7, 1.0] {
        harness.hover_at(from + share * (to - from));
        harness.step();
    }
    harness.drop_at(to);
    harness.run_steps(3);
}

/// A frame around a point on the ground.
fn pull_around(harness: &mut Harness<'_, Workbench>, name: &str) {
    let around = point(harness, name).expand(8.0);
    pull(harness, around.left_bottom(), around.right_top());
}

/// Clicks a point with Ctrl held.
fn click_more(harness: &mut Harness<'_, Workbench>, name: &str) {
    let pos = point(harness, name).center();
    harness.hover_at(pos);
    harness.step();
    for pressed in [true, false] {
        let press = Event::PointerButton {
            pos,
            button: eframe::egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::COMMAND,
        };
        harness.event_modifiers(press, Modifiers::COMMAND);
    }
    harness.run_steps(2);
}

#[test]
fn a_frame_selects_and_what_is_selected_is_added_in_one_step_of_undo() {
    let folder = Bare::new("frame", "");
    let mut harness = in_front(&folder);
    let plot = harness.get_by_label("Plot of A320 over A40").rect();
    pull(
        &mut harness,
        plot.min + vec2(44.0, 22.0),
        plot.max - vec2(10.0, 34.0),
    );
    assert_eq!(
        harness.state().selected_textiles().len(),
        16,
        "a frame around all"
    );
    pull_around(&mut harness, "Polyester satin");
    assert_eq!(harness.state().selected_textiles(), ["polyester-satin"]);
    harness.get_by_label("Sort by A40").click();
    harness.run_steps(2);
    let chosen = ["silk-crepe", "polyester-fleece", "polyester-satin"];
    for name in ["Silk crêpe de chine", "Polyester fleece"] {
        click_more(&mut harness, name);
    }
    let mut sorted = chosen.map(str::to_owned).to_vec();
    sorted.sort();
    assert_eq!(harness.state().selected_textiles(), sorted);
    harness
        .get_by_label_contains("Place what is selected")
        .click();
    harness.run_steps(3);
    let placed = &harness.state().scene().textiles;
    assert_eq!(placed.len(), 3);
    for id in chosen {
        assert!(placed.iter().any(|cloth| cloth.id == id), "{id}");
    }
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(
        harness.state().scene().textiles.len(),
        3,
        "the workspace is brought in sight first"
    );
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(harness.state().scene().textiles.is_empty(), "one step");
    press(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(harness.state().scene().textiles.len(), 3, "and again");
}

#[test]
fn the_numbers_of_the_table_are_the_levels_at_a_hundred_millimetres_a_second() {
    let folder = Bare::new("numbers", "");
    let mut harness = in_front(&folder);
    harness
        .get_by_label_contains("As the present gains")
        .click();
    harness.run_steps(3);
    let library = Library::shipped().unwrap();
    for id in library.ids() {
        let textile = library.load(id).unwrap();
        let levels = Levels::of(textile.surface(), &Filters::default());
        let [low, high] = levels.mean_um;
        let level_db = levels.level_db().unwrap();
        let name = &textile.manifest().name;
        let words = format!("{name} in the table: {low:.2}, {high:.2}, {level_db:.1}, ");
        harness.get_by_label_contains(&words);
    }
}

#[test]
fn a_point_is_dragged_into_the_workspace_and_a_double_click_finds_a_place() {
    let folder = Bare::new("drag", "");
    let mut harness = in_front(&folder);
    let at = point(&harness, "Polyester fleece").center();
    harness.drag_at(at);
    harness.step();
    for share in [0.2, 0.6, 1.0] {
        harness.hover_at(at + share * vec2(60.0, -40.0));
        harness.run_steps(2);
    }
    let ground = harness.get_by_label("Workspace with 0 textiles").rect();
    harness.hover_at(ground.center());
    harness.run_steps(2);
    harness.drop_at(ground.center());
    harness.run_steps(3);
    let placed = harness.state().scene().textiles.clone();
    assert_eq!(
        placed.len(),
        1,
        "let go in the workspace, which came in sight"
    );
    assert_eq!(placed[0].id, "polyester-fleece");
    assert_eq!(
        placed[0].origin_mm.x_mm, 80.0,
        "its middle is where it was let go"
    );
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    click_tab(&mut harness, "Collection");
    harness.run_steps(40);
    let at = point(&harness, "Polyester satin").center();
    for _ in 0..2 {
        harness.drag_at(at);
        harness.drop_at(at);
        harness.step();
    }
    harness.run_steps(3);
    let placed = &harness.state().scene().textiles;
    assert_eq!(placed.len(), 1, "one double click, one textile");
    assert_eq!(placed[0].id, "polyester-satin");
    assert_eq!(harness.state().chosen()[0], Some(0), "it is chosen");
}

#[test]
fn the_pointer_over_a_point_marks_the_textile_in_every_view() {
    let folder = Folder::new("pointed");
    let mut harness = window(&folder.scene());
    harness.run_steps(3);
    click_tab(&mut harness, "Collection");
    wait(&mut harness, |bench| bench.n_textiles_measured() == 1);
    harness.run_steps(3);
    let at = point(&harness, "Ripple").center();
    harness.hover_at(at);
    harness.run_steps(3);
    assert_eq!(harness.state().hovered()[0], Some(0));
    harness.render().unwrap();
}

#[test]
fn cloths_share_search_and_selection_and_only_those_in_sight_are_there() {
    let folder = Bare::new("cloths", "");
    let mut harness = in_front(&folder);
    pull_around(&mut harness, "Polyester satin");
    harness
        .get_by_label("The library as pieces of cloth")
        .click();
    harness.run_steps(3);
    let satin = harness.get_by_role_and_label(Role::ListItem, "Piece of Polyester satin");
    assert_eq!(satin.accesskit_node().toggled(), Some(Toggled::True));
    let field = harness.get_by_role_and_label(Role::TextInput, "Search the collection");
    field.click();
    harness.step();
    harness.event(Event::Text("knitted polyamide".to_owned()));
    harness.run_steps(3);
    assert!(
        harness.query_by_label("Piece of Polyester satin").is_none(),
        "it is no knit"
    );
    harness.get_by_label("Piece of Polyamide jersey");
    harness.get_by_label("3 of 16 textiles, 1 selected");
}

#[test]
fn a_still_collection_stays_still() {
    let folder = Bare::new("still", "");
    let mut harness = in_front(&folder);
    harness.run_steps(60);
    assert_eq!(repaint_delay(&harness), Duration::MAX);
    let n_measured = harness.state().n_textiles_measured();
    harness.get_by_label("Workspace").click();
    harness.run_steps(20);
    assert_eq!(harness.state().n_textiles_measured(), n_measured);
}

#[test]
fn seventy_four_textiles_are_measured_beside_the_frames_until_somebody_stops_it() {
    let folder = Bare::new("many", "library = \"seventy-four\"\n");
    let mut harness = window(&folder.scene());
    harness.run_steps(3);
    click_tab(&mut harness, "Collection");
    let said = harness.query_all_by_label_contains(" of 74").next();
    assert!(said.is_some(), "it says how far it is");
    // Textiles are woven meanwhile; frames go on without one of them being ready.
    let began = Instant::now();
    while harness.state().n_textiles_measured() < 2 {
        harness.step();
        assert!(began.elapsed() < Duration::from_mins(2), "none is ready");
        thread::sleep(Duration::from_millis(5));
    }
    harness.get_by_label("Stop measuring the library").click();
    harness.run_steps(3);
    harness.get_by_label("Go on measuring the library");
    let n_measured = harness.state().n_textiles_measured();
    assert!(n_measured < 74, "stopped after {n_measured}");
}
