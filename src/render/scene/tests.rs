//! Scene files: good ones survive, wrong ones name the line and the mend.

use std::path::Path;

use proptest::prelude::*;

use super::*;
use selvedge_foundation::geometry::{Displacement, Point};
use selvedge_textile::tactile::{Filters, Tuning};

const GOOD: &str = r#"name = "Two"
library = "textiles"
size_mm = [260, 130.5]

[[textile]]
id = "silk-crepe"
origin_mm = [20.0, 20.0]
size_mm = [100.0, 100.0]
gain_db = -inf

[[textile]]
id = "jute-plain"
origin_mm = [60.1, 20.0]
size_mm = [100.0, 100.0]
rotation_deg = 90.0
label = "2"

[[display]]
geometry = "exeter-24"
rotation_deg = 361.0

[[display]]
contactors_mm = [[0.0, 0.0], [1.5, -2.0]]

[filters]
kind = "log-gaussian"
octaves = 1.5

[tuning]
gain_db = -3.1
compression = 0.5
"#;

fn read(text: &str) -> Result<Scene, SceneError> {
    Scene::from_toml(text, Path::new("a.scene.toml"))
}

#[test]
fn a_scene_survives_writing_and_reading() {
    let scene = read(GOOD).unwrap();
    assert_eq!(scene.textiles[0].gain_db, f64::NEG_INFINITY);
    assert_eq!(scene.displays[1].geometry.n_contactors(), 2);
    let text = scene.to_toml().unwrap();
    assert_eq!(read(&text).unwrap(), scene);
    assert_eq!(read(&text).unwrap().to_toml().unwrap(), text);
}

#[test]
fn a_short_scene_has_the_exeter_array_and_the_default_filters() {
    let scene = read("name = \"Empty\"\nsize_mm = [10.0, 10.0]\n").unwrap();
    assert_eq!(scene.displays, [Display::default()]);
    assert!(
        scene.textiles.is_empty() && scene.tuning.is_none(),
        "{scene:?}"
    );
    assert_eq!(read(&scene.to_toml().unwrap()).unwrap(), scene);
}

/// What is replaced in the good scene, by what, the line of the error and how it begins.
#[rustfmt::skip]
const WRONG: [(&str, &str, usize, &str); 18] = [
    ("size_mm = [260, 130.5]", "size_mm = [260, 0]", 3, "size_mm is [260, 0]"),
    ("size_mm = [260, 130.5]", "sise_mm = [260, 0]", 3, "unknown field `sise_mm`"),
    ("id = \"jute-plain\"", "id = \"../jute\"", 12, "\"../jute\" is no textile's id"),
    ("[60.1, 20.0]", "[nan, 20.0]", 13, "origin_mm is [NaN, 20]"),
    ("gain_db = -inf", "gain_db = inf", 9, "gain_db is inf"),
    ("rotation_deg = 90.0", "rotation_deg = inf", 15, "rotation_deg is inf"),
    ("rotation_deg = 90.0", "gain_40_db = nan", 15, "gain_40_db is NaN"),
    ("rotation_deg = 90.0", "gain_320_db = inf", 15, "gain_320_db is inf"),
    ("rotation_deg = 90.0", "within_mm = [[0, 9], [5, 9]]", 15, "within_mm is [[0, 9], [5, 9]]"),
    ("exeter-24", "exeter-25", 19, "unknown geometry \"exeter-25\""),
    ("geometry = \"exeter-24\"", "", 18, "the display has no geometry"),
    ("[1.5, -2.0]", "[0, -0.0]", 23, "contactors 0 and 1 are at the same place"),
    ("[[0.0, 0.0], [1.5, -2.0]]", "[]", 23, "0 contactors"),
    ("octaves = 1.5", "octaves = 0.0", 27, "octaves is 0"),
    ("log-gaussian", "gammatone", 26, "unknown filters \"gammatone\""),
    ("compression = 0.5", "compression = 1.5", 31, "compression is 1.5"),
    ("gain_db = -3.1", "gain_db = nan", 30, "gain_db is NaN"),
    ("gain_db = -3.1", "gain_db = \"3 dB\"", 30, "invalid type"),
];

#[test]
fn wrong_values_name_their_line_and_the_mend() {
    for (from, to, line, what) in WRONG {
        assert!(GOOD.contains(from), "{from}");
        let error = read(&GOOD.replacen(from, to, 1)).unwrap_err().to_string();
        let expected = format!("a.scene.toml:{line}: {what}");
        assert!(error.starts_with(&expected), "{to}: {error}");
        assert!(error.contains("; ") && !error.contains('\n'), "{error}");
    }
}

#[test]
fn the_last_textile_is_on_top_and_edges_belong_to_one_side() {
    let scene = read(GOOD).unwrap();
    // The second is turned by 90° about (60.1, 20): it covers x from −39.9 to 60.1.
    assert_eq!(scene.textile_at(Point::new(30.0, 50.0)), Some(1));
    assert_eq!(scene.textile_at(Point::new(90.0, 50.0)), Some(0));
    assert_eq!(scene.textile_at(Point::new(120.0, 50.0)), None);
    assert_eq!(scene.textile_at(Point::new(20.0 - 5e-7, 20.0)), Some(1));
    assert_eq!(scene.textile_at(Point::new(200.0, 20.0)), None);
    let silk = &scene.textiles[0];
    assert!(silk.contains(Point::new(-5e-7, 0.0)) && !silk.contains(Point::new(100.0, 0.0)));
}

#[test]
fn a_library_is_found_beside_its_scene() {
    let scene = read(GOOD).unwrap();
    let folder = scene.library_folder(Path::new("/lab/scenes/a.scene.toml"));
    assert_eq!(folder.as_deref(), Some(Path::new("/lab/scenes/textiles")));
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in any::<String>()) {
        drop(read(&text));
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        at in 0..GOOD.len(),
        end in 0..GOOD.len(),
        put in ".{0,8}",
    ) {
        let mut text = GOOD.to_owned();
        text.replace_range(at.min(end)..at.max(end), &put);
        if let Ok(scene) = read(&text) {
            prop_assert_eq!(read(&scene.to_toml().unwrap()).unwrap(), scene);
        }
    }

    #[test]
    fn any_good_scene_survives_writing_and_reading(
        numbers in prop::array::uniform8(-1e9..1e9_f64),
        text in any::<String>(),
        octaves in 1e-3..10.0_f64,
        compression in prop::option::of(0.0..=1.0_f64),
    ) {
        let [x_mm, y_mm, width_mm, height_mm, rotation_deg, gain_db, dx_mm, dy_mm] = numbers;
        let size_mm = [width_mm.abs() + 1e-3, height_mm.abs() + 1e-3];
        let textile = PlacedTextile {
            id: "wool".to_owned(),
            origin_mm: Point::new(x_mm, y_mm),
            size_mm,
            rotation_deg,
            gain_db,
            gain_40_db: dy_mm,
            gain_320_db: 0.0,
            within_mm: (dx_mm > 0.0).then(|| [Point::new(x_mm, y_mm), Point::new(1e10, 2e10)]),
            label: text.clone(),
            target_40_db_sl: Some(dx_mm),
            target_320_db_sl: None,
            slot_gains_db: [(SlotLetter::A, gain_db), (SlotLetter::H, 0.0)].into(),
        };
        let slot = TuningSlot {
            letter: SlotLetter::H,
            name: text.clone(),
            note: String::new(),
            tuning: Tuning { gain_db, ..Tuning::default() },
        };
        let offsets = vec![Displacement::new(dx_mm, dy_mm), Displacement::new(dx_mm + 1.0, 0.0)];
        let scene = Scene {
            name: text,
            library: None,
            size_mm,
            textiles: vec![textile],
            displays: vec![Display { geometry: Geometry::Contactors(offsets), rotation_deg }],
            filters: Filters::LogGaussian { octaves },
            tuning: compression.map(|compression| Tuning { compression, ..Tuning::default() }),
            slots: vec![slot],
            recordings: vec![RecordingReference {
                name: "Slow".to_owned(),
                path: "strokes/slow.csv".into(),
            }],
            contents: [("sixteen:denim".to_owned(), "9f2c".to_owned())].into(),
            arrangement: Some(Arrangement {
                perspective: "cloth".to_owned(),
                panes: "{\n  \"root\": 1\n}".to_owned(),
            }),
        };
        prop_assert_eq!(read(&scene.to_toml().unwrap()).unwrap(), scene);
    }
}
