//! The picture pane: from a picture of a cloth to a textile under the display.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use super::*;

/// A lit cloth with a cell of 20 × 24 px, in grey.
fn cloth(path: &Path) {
    let light = |x: f64, y: f64| {
        let (u, v) = (
            x / 20.0 * std::f64::consts::TAU,
            y / 24.0 * std::f64::consts::TAU,
        );
        let slope = 0.5 * (v + 0.4).cos() + 0.3 * (u + v).sin() + 0.2 * (2.0 * u - v).cos();
        let grain = ((x * 12.9898 + y * 78.233).sin() * 43_758.545_3).fract();
        128.0 + 60.0 * slope + 20.0 * (u + 1.0).cos() + 3.0 * grain
    };
    let picture = image::GrayImage::from_fn(300, 240, |x, y| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 … 255"
        )]
        let grey = light(f64::from(x), f64::from(y)).clamp(0.0, 255.0) as u8;
        image::Luma([grey])
    });
    picture.save(path).unwrap();
}

/// A window with a picture opened in its pane.
fn with_picture(folder: &Folder, write: impl Fn(&Path)) -> Harness<'static, Workbench> {
    let path = folder.path("Blue twill.png");
    write(&path);
    let mut harness = window(&folder.scene());
    harness.run();
    harness.state_mut().open_picture(path);
    harness.run_steps(4);
    click_tab(&mut harness, "Picture");
    harness.run_steps(4);
    harness
}

#[test]
fn an_empty_pane_says_what_to_do() {
    let folder = Folder::new("picture-empty");
    let mut harness = window(&folder.scene());
    harness.run();
    click_tab(&mut harness, "Picture");
    let words = harness.query_by_label_contains("at least three pixels wide");
    assert!(words.is_some());
    assert_eq!(harness.state().n_pictures_worked_out(), 0);
}

#[test]
fn a_picture_a_scale_and_a_height_are_enough_to_feel_a_cloth() {
    let folder = Folder::new("picture-felt");
    let mut harness = with_picture(&folder, cloth);
    let lattice = harness.state().picture_lattice().unwrap();
    let lengths = lattice.map(|[x, y]| x.hypot(y));
    assert!((lengths[0] - 20.0).abs() < 0.2, "{lattice:?}");
    assert!((lengths[1] - 24.0).abs() < 0.2, "{lattice:?}");
    harness.get_by_role_and_label(Role::Button, "Keep…").click();
    harness.run_steps(6);
    let asked = harness.query_by_label_contains("Keep and lay out");
    assert!(asked.is_none(), "no scale yet");
    type_into(&mut harness, "scale", "600");
    type_into(&mut harness, "height", "80");
    harness.render().unwrap();
    keep(&mut harness, "Keep…", "Keep and lay out");
    let made = folder.path("library/blue-twill");
    let manifest = fs::read_to_string(made.join("textile.toml")).unwrap();
    for part in [
        "kind = \"picture\"",
        "relief_um = 80.0",
        "picture = \"Blue twill.png\"",
    ] {
        assert!(manifest.contains(part), "{part} in {manifest}");
    }
    let library = selvedge_textile::Library::open(&folder.path("library")).unwrap();
    library.load("blue-twill").unwrap();
    let scene = harness.state().scene();
    let is_placed = scene.textiles.iter().any(|one| one.id == "blue-twill");
    assert!(is_placed, "it lies in the scene");
    assert!(
        harness.query_by_label_contains("handed to").is_none(),
        "the workspace is in sight now"
    );
    click_tab(&mut harness, "Picture");
    harness.run_steps(4);
    harness.get_by_label_contains("handed to the library: blue-twill");
}

#[test]
fn a_hidden_pane_works_nothing_out() {
    let folder = Folder::new("picture-hidden");
    let mut harness = with_picture(&folder, cloth);
    let n = harness.state().n_pictures_worked_out();
    assert!(n > 0);
    harness.run_steps(6);
    assert_eq!(
        harness.state().n_pictures_worked_out(),
        n,
        "nothing changed"
    );
    click_tab(&mut harness, "Workspace");
    let path = folder.path("other.png");
    cloth(&path);
    harness.state_mut().open_picture(path);
    click_tab(&mut harness, "Workspace");
    let n = harness.state().n_pictures_worked_out();
    harness.run_steps(6);
    assert_eq!(harness.state().n_pictures_worked_out(), n, "nobody looks");
}

#[test]
fn nonsense_is_one_line_at_the_first_step() {
    let folder = Folder::new("picture-nonsense");
    let harness = with_picture(&folder, |path| fs::write(path, "no picture").unwrap());
    assert!(harness.query_by_label_contains("Blue twill.png:").is_some());
    let refused = harness.query_by_label_contains("Step 1 has something to mend");
    assert!(refused.is_some());
    assert_eq!(harness.state().picture_lattice(), None);
}

#[test]
fn a_flat_picture_says_why_it_has_no_lattice() {
    let folder = Folder::new("picture-flat");
    let flat = |path: &Path| image::GrayImage::from_pixel(120, 100, image::Luma([90])).save(path);
    let harness = with_picture(&folder, |path| flat(path).unwrap());
    let reason = harness.query_by_label_contains("No lattice: the picture is of one colour");
    assert!(reason.is_some());
    assert_eq!(harness.state().picture_lattice(), None);
}

#[test]
fn a_lattice_that_is_dragged_shows_what_it_explains_and_is_taken_back() {
    let folder = Folder::new("picture-lattice");
    let mut harness = with_picture(&folder, cloth);
    let found = harness.state().picture_lattice().unwrap();
    let grip = harness.get_by_role_and_label(Role::Slider, "First vector of the lattice");
    let at = grip.rect().center();
    harness.drag_at(at);
    harness.step();
    for share in 1..=8_u8 {
        harness.hover_at(at + vec2(2.0 * f32::from(share), 0.0));
        harness.step();
    }
    harness.drop_at(at + vec2(16.0, 0.0));
    harness.run_steps(6);
    let drawn = harness.state().picture_lattice().unwrap();
    assert_ne!(drawn, found, "the lattice follows");
    harness.get_by_label_contains("chosen, explains");
    let found_again = harness.get_by_label_contains("Lattice found");
    found_again.click_accesskit();
    harness.run_steps(6);
    assert_eq!(harness.state().picture_lattice().unwrap(), found);
    let chosen = harness.query_by_label_contains("chosen, explains");
    assert!(chosen.is_none(), "it was taken back");
}

#[test]
fn the_sun_is_dragged_over_the_photograph_and_the_experts_plots_unfold() {
    let folder = Folder::new("picture-sun");
    let mut harness = with_picture(&folder, cloth);
    let sun = harness.get_by_label("Light from 0° clockwise of the top, 45° from above");
    let at = sun.rect().center();
    harness.drag_at(at);
    harness.step();
    for share in 1..=8_u8 {
        harness.hover_at(at + vec2(5.0 * f32::from(share), 0.0));
        harness.step();
    }
    harness.drop_at(at + vec2(40.0, 0.0));
    harness.run_steps(6);
    let before = harness.query_by_label("Light from 0° clockwise of the top, 45° from above");
    assert!(before.is_none(), "the light was moved");
    let sun = harness.get_by_label_contains("clockwise of the top");
    assert!(sun.rect().center().x > at.x + 30.0, "it follows");
    let is_shown = |harness: &Harness<'_, Workbench>| {
        let plots = harness.query_by_role_and_label(Role::Image, "Autocorrelation");
        plots.is_some()
    };
    assert!(!is_shown(&harness));
    harness.get_by_label("Expert’s plots").click_accesskit();
    harness.run_steps(2);
    assert!(is_shown(&harness));
}

#[test]
fn a_region_can_be_turned() {
    let folder = Folder::new("picture-turn");
    let mut harness = with_picture(&folder, cloth);
    let angle = |harness: &Harness<'_, Workbench>| {
        let [[x, y], _] = harness.state().picture_lattice().unwrap();
        y.atan2(x).to_degrees()
    };
    assert!(angle(&harness).abs() < 1.0, "along the rows");
    let region = "A rectangle, dragged on the picture";
    harness.get_by_label(region).click_accesskit();
    harness.run_steps(6);
    harness.get_by_role_and_label(Role::Slider, "turn").focus();
    for _ in 0..20 {
        press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    }
    harness.run_steps(6);
    let turned = angle(&harness);
    assert!((turned + 20.0).abs() < 1.5, "{turned}");
}

#[test]
fn a_turned_picture_says_its_turn_and_how_well_it_matches_and_can_be_left_out() {
    use crate::picture_turned::{fleece, picture};

    let folder = Folder::new("picture-turned");
    let values = fleece(3);
    let mut harness = with_picture(&folder, |path| {
        fs::write(path, picture(&values, 0)).unwrap();
    });
    for (name, bytes) in [
        ("b.png", picture(&values, 1)),
        ("c.png", picture(&fleece(4), 0)),
    ] {
        let path = folder.path(name);
        fs::write(&path, bytes).unwrap();
        harness.state_mut().add_turned_picture(path);
        harness.run_steps(4);
    }
    let turned = harness.query_by_label_contains("b.png shows it turned by 90.0° (match 0.");
    assert!(turned.is_some(), "the turn");
    let refused = harness.query_by_label_contains("c.png: it does not show the cloth");
    assert!(refused.is_some(), "another cloth");
    harness.render().unwrap();
    let remove: Vec<_> = harness
        .get_all_by_role_and_label(Role::Button, "Remove")
        .collect();
    assert_eq!(remove.len(), 2);
    remove[1].click();
    harness.run_steps(4);
    let refused = harness.query_by_label_contains("c.png");
    assert!(refused.is_none(), "left out");
    let turned = harness.query_by_label_contains("b.png shows it turned by 90.0°");
    assert!(turned.is_some(), "still there");
}
