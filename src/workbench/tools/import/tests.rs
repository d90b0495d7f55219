//! From files to textiles: the bytes that the command line makes, one line for what is wrong.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use std::sync::Arc;

use eframe::egui;

use super::*;
use crate::bench::background::Executor;
use crate::bench::keep::NewTextile;
use crate::bench::latest::Standing;
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::import::failure::{Failure, Step};
use selvedge_foundation::progress::{CancelFlag, Cancelled, Progress};
use selvedge_scratch::ScratchFolder;
use selvedge_textile::surface::Representation;
use selvedge_textile::{
    ColumnRole, Description, HeightImport, ImportOptions, KesAsk, KesFile, KesImport, KesOptions,
    KesReading, Measurement,
};

/// Both ways over 30 mm, by place, with a decimal comma.
pub(crate) fn export() -> String {
    let mut text = String::from("KES-FB4\r\n\r\nWeg mm;forward um;return um;mu\r\n");
    for i in 0..1500_u16 {
        let x_mm = f64::from(i) * 0.02;
        let z = 6.0 * (15.0 * x_mm).sin() + 3.0 * (0.7 * x_mm * x_mm).sin() + 0.4 * x_mm;
        let mu = 0.21 + 0.02 * (9.0 * x_mm).sin();
        let row = format!("{x_mm:.2};{z:.3};{:.3};{mu:.4}\r\n", z + 0.5);
        text.push_str(&row.replace('.', ","));
    }
    text
}

/// 300 × 200 heights 0.05 mm apart without a word about units.
fn matrix() -> String {
    let mut text = String::new();
    for row in 0..200_u16 {
        for column in 0..300_u16 {
            let height = 5.0 * (f64::from(column) * 0.3).sin() + f64::from(row % 40) * 0.1;
            let end = if column == 299 { '\n' } else { '\t' };
            if (row, column) == (4, 3) {
                write!(text, "nan{end}").unwrap();
            } else {
                write!(text, "{height:.4}{end}").unwrap();
            }
        }
    }
    text
}

fn import_of(paths: &[PathBuf]) -> Import {
    let mut importing = Import::default();
    importing.add(paths.to_vec()).unwrap();
    read(&mut importing);
    importing
}

/// Reads as the pane does when it is drawn.
fn read(importing: &mut Import) {
    let ctx = egui::Context::default();
    importing.follow(&ctx, &Executor::InLine);
    // What was stopped on a thread ends first.
    while matches!(importing.standing(), Standing::Working(_)) {
        importing.poll();
        importing.follow(&ctx, &Executor::InLine);
        std::thread::yield_now();
    }
    assert_eq!(importing.standing(), Standing::Fresh);
}

fn failure(importing: &Import) -> &Failure {
    let failure = importing.found().unwrap().failure.as_ref().unwrap();
    assert!(!failure.line.contains('\n'), "{failure:?}");
    assert!(failure.line.contains("; "), "no mend: {failure:?}");
    failure
}

fn kept(importing: &Import) -> Vec<NewTextile> {
    keeping::textiles(importing.found().unwrap(), &importing.draft.words).unwrap()
}

#[test]
fn strokes_become_the_textile_that_the_command_line_makes() {
    let folder = ScratchFolder::made("strokes");
    let path = folder.write("twill.txt", export());
    let mut importing = import_of(std::slice::from_ref(&path));
    let strokes = importing.found().unwrap().strokes().unwrap();
    let suggested = strokes.import.as_ref().unwrap().figures().clone();
    importing.draft.looked.sections[0] = Some([5.0, 25.0]);
    importing.draft.looked.is_official = true;
    importing.draft.words.name = "Wool twill".to_owned();
    importing.draft.words.figures = vec![("weight_mg_per_cm2".to_owned(), "21,5".to_owned())];
    read(&mut importing);
    let bytes = fs::read(&path).unwrap();
    let file = KesFile {
        path: &path,
        bytes: &bytes,
    };
    let reading = KesReading::of(&[file], None, &KesOptions::default()).unwrap();
    let import = KesImport::new(reading, [Some([5.0, 25.0]), None], true).unwrap();
    assert_ne!(
        import.figures().smd_um,
        suggested.smd_um,
        "the section tells"
    );
    let words = Description {
        construction: selvedge_textile::Construction::Woven,
        figures: [("weight_mg_per_cm2".to_owned(), 21.5)].into(),
        ..Description::of("Wool twill")
    };
    let made = kept(&importing);
    assert_eq!((made.len(), made[0].id.as_str()), (1, "wool-twill"));
    assert_eq!(made[0].files, import.files(&words).unwrap());
    assert!(made[0].files.iter().any(|file| file.name == "friction.csv"));
}

#[test]
fn what_is_asked_for_names_its_field_and_an_answer_ends_it() {
    let folder = ScratchFolder::made("asks");
    let volts = folder.write("volts.txt", export().replace("forward um", "forward V"));
    let mut importing = import_of(&[volts]);
    let found = failure(&importing);
    assert_eq!(
        (found.step, found.ask),
        (Step::Meaning, Some(KesAsk::UmPerVolt))
    );
    importing.draft.described.strokes.um_per_volt = "zwölf".to_owned();
    read(&mut importing);
    assert!(failure(&importing).line.starts_with("“zwölf” is no number"));
    assert!(
        !importing
            .found()
            .unwrap()
            .strokes()
            .unwrap()
            .looks
            .is_empty()
    );
    // Columns in µm and in V do not go together: both are said.
    importing.draft.described.strokes.um_per_volt = "12,5".to_owned();
    importing.draft.described.strokes.columns = Some(vec![
        ColumnRole::Distance,
        ColumnRole::from_word("forward").unwrap(),
        ColumnRole::Skip,
        ColumnRole::Skip,
    ]);
    read(&mut importing);
    assert_eq!(importing.found().unwrap().failure, None);
    let bare = folder.write("bare.txt", "1.5\n2.5\n1.0\n".repeat(500));
    let mut importing = import_of(&[bare]);
    assert_eq!(failure(&importing).ask, Some(KesAsk::Step));
    importing.draft.described.strokes.step_mm = "0.02".to_owned();
    read(&mut importing);
    assert_eq!(importing.found().unwrap().failure, None);
}

#[test]
fn a_map_becomes_a_textile_for_every_place() {
    let folder = ScratchFolder::made("map");
    let path = folder.write("cloth.txt", matrix());
    let mut importing = import_of(std::slice::from_ref(&path));
    assert_eq!(importing.found().unwrap().kind, Measurement::Heights);
    let asked = failure(&importing).clone();
    assert_eq!(asked.step, Step::Meaning);
    assert!(asked.line.contains("--height-unit"), "{asked:?}");
    let unit = selvedge_textile::LengthUnit::Micrometre;
    importing.draft.described.heights.height_unit = Some(unit);
    importing.draft.described.heights.step_mm = "0.05".to_owned();
    importing.draft.looked.places = vec![[5.0, 4.0], [9.0, 6.0]];
    importing.draft.words.name = "Ripple".to_owned();
    read(&mut importing);
    assert_eq!(importing.found().unwrap().failure, None);
    let options = ImportOptions {
        asked: importing.draft.described.height_options().unwrap().asked,
        ..ImportOptions::default()
    };
    let bytes = fs::read(&path).unwrap();
    let import = HeightImport::of(&bytes, &path, &options).unwrap();
    let made = kept(&importing);
    assert_eq!(
        made.iter().map(|one| one.id.as_str()).collect::<Vec<_>>(),
        ["ripple-1", "ripple-2"]
    );
    for (nth, (one, place_mm)) in made.iter().zip([[5.0, 4.0], [9.0, 6.0]]).enumerate() {
        let place = import.place(Some(place_mm)).unwrap();
        let words = Description::of("Ripple").nth(nth, 2);
        assert_eq!(one.files, import.files(&place, &words, &bytes).unwrap());
    }
    importing.draft.looked.places[1] = [9.0, 60.0];
    read(&mut importing);
    assert_eq!(failure(&importing).step, Step::Look);
    assert!(failure(&importing).line.contains("is not on the map"));
    assert!(importing.found().unwrap().heights().unwrap().places[0].is_ok());
    assert!(importing.refusal().unwrap().starts_with("Step 3 has"));
}

#[test]
fn a_map_that_is_felt_at_every_point_brings_its_file_along() {
    let folder = ScratchFolder::made("areal");
    let path = folder.write("cloth.txt", matrix());
    let mut importing = import_of(std::slice::from_ref(&path));
    let heights = &mut importing.draft.described.heights;
    heights.height_unit = Some(selvedge_textile::LengthUnit::Micrometre);
    heights.step_mm = "0.05".to_owned();
    heights.representation = Representation::Areal;
    read(&mut importing);
    let made = kept(&importing);
    for file in &made[0].files {
        let textile = folder.join("library").join(&made[0].id);
        fs::create_dir_all(&textile).unwrap();
        fs::write(textile.join(&file.name), &file.bytes).unwrap();
    }
    let library = selvedge_textile::Library::named(&folder.join("library"), None).unwrap();
    let textile = library.load("cloth").unwrap();
    assert_eq!(textile.surface().representation(), Representation::Areal);
}

#[test]
fn nonsense_is_one_line_at_the_files() {
    let folder = ScratchFolder::made("nonsense");
    let nothing = folder.write("empty.txt", "");
    let words = folder.write("words.txt", "there is nothing\nto measure here\n");
    let picture = folder.write("picture.bin", [0_u8; 400]);
    for path in [nothing, words, picture, folder.join("missing.txt")] {
        let importing = import_of(std::slice::from_ref(&path));
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let found = failure(&importing);
        assert_eq!(found.step, Step::Files, "{found:?}");
        assert!(found.line.contains(&name), "{found:?}");
        assert!(importing.refusal().is_some());
    }
    let huge = fs::File::create(folder.join("huge.txt")).unwrap();
    huge.set_len(3 << 30).unwrap();
    let importing = import_of(&[folder.join("huge.txt")]);
    assert!(
        failure(&importing).line.contains("is larger than 60 MB"),
        "{:?}",
        failure(&importing)
    );
}

#[test]
fn only_what_has_changed_is_read_anew() {
    let folder = ScratchFolder::made("again");
    let path = folder.write("twill.txt", export());
    let mut importing = import_of(std::slice::from_ref(&path));
    let reading = |importing: &Import| {
        let strokes = importing.found().unwrap().strokes().unwrap();
        Arc::clone(strokes.reading.as_ref().unwrap())
    };
    let before = reading(&importing);
    importing.draft.looked.sections[0] = Some([4.0, 14.0]);
    read(&mut importing);
    assert!(
        Arc::ptr_eq(&before, &reading(&importing)),
        "the strokes are the same"
    );
    importing.draft.described.strokes.return_order = Some(selvedge_textile::ReturnOrder::Travel);
    read(&mut importing);
    assert!(!Arc::ptr_eq(&before, &reading(&importing)));
    importing.draft.words.name = "Another".to_owned();
    let n_read = importing.n_read();
    let ctx = egui::Context::default();
    importing.follow(&ctx, &Executor::InLine);
    assert_eq!(importing.n_read(), n_read, "a name needs no reading");
}

#[test]
fn work_that_is_cancelled_stops_and_begins_again_with_other_words() {
    let folder = ScratchFolder::made("cancel");
    let path = folder.write("twill.txt", export());
    let mut importing = Import::default();
    importing.add(vec![path]).unwrap();
    let inputs = importing.inputs();
    let flag = CancelFlag::new();
    flag.cancel();
    let mut silent = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut silent, flag);
    assert!(matches!(
        work::read(inputs, None, &mut progress),
        Err(Cancelled)
    ));
    let ctx = egui::Context::default();
    importing.follow(&ctx, &Executor::Threads(ctx.clone()));
    importing.cancel();
    assert_eq!(importing.standing(), Standing::Stopped);
    importing.draft.looked.is_official = true;
    read(&mut importing);
    let found =
        Progress::unheard(|progress| work::read(importing.inputs(), None, progress)).unwrap();
    assert!(found.failure.is_none());
}

#[test]
fn real_height_maps_are_read_when_they_are_there() {
    let Some(data) = std::env::var_os("SELVEDGE_TEST_DATA") else {
        eprintln!("skipped: SELVEDGE_TEST_DATA is not set");
        return;
    };
    let heights = Path::new(&data).join("heights");
    for name in [
        "derived/tmd1.gwy",
        "surfacetopography/tmd-1.tmd",
        "x3ptools/sample-land.x3p",
    ] {
        let path = heights.join(name);
        if !path.exists() {
            eprintln!("skipped: no {}", path.display());
            continue;
        }
        let mut importing = import_of(std::slice::from_ref(&path));
        let found = importing.found().unwrap();
        assert_eq!(found.kind, Measurement::Heights, "{name}");
        if found.failure.is_some() {
            assert!(
                failure(&importing).line.contains("periodic"),
                "{:?}",
                failure(&importing)
            );
            importing.draft.described.heights.is_periodic = true;
            read(&mut importing);
        }
        assert_eq!(importing.found().unwrap().failure, None, "{name}");
        assert!(!kept(&importing)[0].files.is_empty());
    }
}

#[test]
fn what_the_pane_shows_is_exported_with_where_it_comes_from() {
    let folder = ScratchFolder::made("export");
    let path = folder.write("twill.txt", export());
    let importing = import_of(std::slice::from_ref(&path));
    let found = importing.found().unwrap();
    let strokes = found.strokes().unwrap().import.as_ref().unwrap();
    let exported = export::measurement(found, ColourMap::default()).unwrap();
    assert_eq!(exported.sheet.n_rows(), 3 * 1500);
    let [file, sha256] = &strokes.reading().files[0];
    let pairs = exported.origin.pairs();
    assert!(
        pairs.contains(&("file".to_owned(), format!("{file}: {sha256}"))),
        "{pairs:?}"
    );
    assert_eq!(
        exported.figure.rows.len(),
        3,
        "two strokes and the friction"
    );
    let map = folder.write("map.gsf", gsf());
    let importing = import_of(&[map]);
    let exported = export::measurement(importing.found().unwrap(), ColourMap::default());
    let exported = exported.unwrap();
    assert_eq!(exported.sheet.n_rows(), 120 * 100);
    let raster = exported.figure.rows[0].panels[0].raster.as_ref().unwrap();
    assert_eq!(
        (raster.n_columns, raster.cells.iter().flatten().count()),
        (120, 120 * 100)
    );
}

/// A map of 120 × 100 points, 12 × 10 mm.
fn gsf() -> Vec<u8> {
    let mut bytes = b"Gwyddion Simple Field 1.0\nXRes = 120\nYRes = 100\nXReal = 0.012\nYReal = \
                      0.01\nXYUnits = m\nZUnits = m\n"
        .to_vec();
    bytes.resize(bytes.len() + 4 - bytes.len() % 4, 0);
    for i in 0..120 * 100_u16 {
        let height_m = 5e-6 * (f32::from(i % 120) * 0.3).sin();
        bytes.extend(height_m.to_le_bytes());
    }
    bytes
}
