//! What the pane tells of figures and stepping, and the second finger that has a device of its own.

use super::*;
use crate::bench::command::PlaySource;
use crate::bench::recording::tests::TWO_DISPLAYS;
use crate::kit::view_transform::Pointed;

/// What stands in a window that shows all controls, and where.
fn texts(desk: &mut Headless) -> Vec<(String, Rect)> {
    let output = desk.run();
    let texts = output.shapes.iter().filter_map(|shape| match &shape.shape {
        eframe::egui::Shape::Text(text) => {
            Some((text.galley.text().to_owned(), text.visual_bounding_rect()))
        }
        _ => None,
    });
    let texts = texts.collect();
    output.drop_without_applying_deltas();
    texts
}

fn words(desk: &mut Headless) -> String {
    let texts = texts(desk).into_iter();
    texts.map(|(text, _)| text + "\n").collect()
}

#[test]
fn the_second_finger_goes_where_the_second_display_is() {
    let folder = ScratchFolder::made("drape-second");
    let scene = folder.write("two.scene.toml", TWO_DISPLAYS);
    let size = eframe::egui::vec2(1400.0, 900.0);
    let mut desk = Headless::new(Some(&scene), size, 1.0).unwrap();
    desk.dispatch(PlayCommand::Source(PlaySource::Pointer));
    desk.pass(4);
    // The workspace is 260 mm wide, the cloth 200 mm.
    for x_mm in [150.0, 155.0, 160.0] {
        let mut tap = desk.workbench.shell.tap.lock().unwrap();
        let stamp = desk.workbench.bench.clock.stamp();
        let place = selvedge_foundation::geometry::Point::new(x_mm, 120.0);
        let at = tap.screen(place).unwrap();
        let pixel = [at.x, at.y].map(f64::from);
        tap.moved_to_pixel(stamp, Pointed::Workbench, (1, pixel));
        drop(tap);
        desk.pass(1);
    }
    desk.dispatch(ShowCommand::Reveal(Pane::Drape));
    tool(&mut desk).chosen.second = Second::Device;
    desk.pass(40);
    let hands = tool(&mut desk).motion.frames.back().unwrap().hands.clone();
    let [x_mm, y_mm, _] = hands[1].centre_mm;
    assert!(
        (x_mm - 130.0).abs() < 1.0 && (y_mm - 90.0).abs() < 1.0,
        "{hands:?}"
    );
    assert_ne!(hands[0].centre_mm, hands[1].centre_mm);
}

#[test]
fn what_a_figure_is_worth_and_how_the_cloth_is_stepped_is_told() {
    let folder = ScratchFolder::made("drape-told");
    let scene = folder.write(
        "a.drape.toml",
        "name = \"A\"\ntextile = \"denim\"\ngrid = [8, 8]\nintegrator = \"xpbd\"\n\
         [measured]\nemt_percent = 0.05\n[[finger]]\nstart_mm = [100.0, 60.0, 0.0]\n\
         opening_mm = 60.0\n",
    );
    let size = eframe::egui::vec2(1400.0, 1600.0);
    let mut desk = Headless::new(None, size, 1.0).unwrap();
    desk.dispatch(ShowCommand::Reveal(Pane::Drape));
    desk.pass(40);
    let all = texts(&mut desk);
    let of = |name: &str| all.iter().find(|(text, _)| text == name).unwrap().1;
    let (name, first) = (of("Second"), of("mirrored"));
    assert!(name.right() < first.left(), "there is room: {name} {first}");
    let shown = words(&mut desk);
    assert!(
        shown.contains("are plausible ones of denim, not measured"),
        "{shown}"
    );
    assert!(
        shown.contains("explicit steps are stable only up to"),
        "{shown}"
    );
    assert!(
        !shown.contains(controls::LOSSLESS) && !shown.contains("WT"),
        "{shown}"
    );
    assert!(shown.contains("2HG5") && shown.contains("RT") && shown.contains("WC"));
    desk.dispatch(FileCommand::Use(Purpose::OpenDrape, scene));
    desk.pass(40);
    let shown = words(&mut desk);
    assert!(shown.contains("times softer: for pictures only"), "{shown}");
    assert!(shown.contains(controls::LOSSLESS), "{shown}");
    assert!(shown.contains(felt_rows::UNTOUCHED), "{shown}");
    assert!(shown.contains("Stretched beyond EMT in"), "{shown}");
}
