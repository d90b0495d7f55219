//! Pages of recordings and paths, of one display and of two.

use super::*;

const SCENE: &str = "../../assets/scenes/four-alternatives.scene.toml";

fn read_at(scene: &Path) -> (String, PathBuf) {
    (std::fs::read_to_string(scene).unwrap(), scene.to_owned())
}

fn figure(contactor: Option<usize>) -> Result<FigureFiles, AppError> {
    let scratch = selvedge_scratch::ScratchFolder::made("figure");
    let row = |n: u32| format!("{},{},60\n", f64::from(n) / 40.0, 30.0 + 4.0 * f64::from(n));
    let rows: String = (0..=40).map(row).collect();
    let path = scratch.write("stroke.csv", format!("t_s,x_mm,y_mm\n{rows}"));
    let of = FigureOf {
        scene: Some(read_at(&Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENE))),
        exploration: Some(path),
        contactor,
    };
    exploration_figure(&of, None)
}

#[test]
fn a_page_is_the_same_twice_and_its_caption_names_what_it_shows() {
    let [one, other] = [figure(None), figure(None)].map(Result::unwrap);
    assert_eq!((&one.svg, &one.png), (&other.svg, &other.png));
    for words in [
        "\"stroke\"",
        "as the scene renders the path",
        "1.00 s",
        "sha256",
    ] {
        assert!(one.caption.contains(words), "{words}: {}", one.caption);
    }
    let svg = String::from_utf8(one.svg).unwrap();
    // Cloth and three strips over time are pictures, all frames of time equally wide.
    assert_eq!(svg.matches("<image").count(), 4);
    let chosen = figure(Some(3)).unwrap();
    assert!(
        chosen.caption.contains("under contactor 3 "),
        "{}",
        chosen.caption
    );
    let error = figure(Some(24)).unwrap_err().to_string();
    assert!(error.ends_with("give 0 to 23"), "{error}");
}

#[test]
fn a_recording_alone_is_drawn_in_the_scene_that_it_was_made_in() {
    let root = selvedge_scratch::ScratchFolder::made("figure-recording");
    let recorded = |scene: &str, scene_file: Option<PathBuf>| {
        let made = crate::bench::recording::tests::explored(40);
        let about = file::About {
            scene: scene.to_owned(),
            scene_file,
            ..crate::bench::recording::tests::page("One")
        };
        let mut on_disk =
            file::RecordingFile::create(&root, about, [0, made.n_contactors()]).unwrap();
        on_disk.append(&made, 0).unwrap();
        let of = FigureOf {
            scene: None,
            exploration: Some(on_disk.finish().unwrap().0),
            contactor: None,
        };
        exploration_figure(&of, None)
    };
    let shipped = LoadedScene::shipped().unwrap().scene().name.clone();
    let page = recorded(&shipped, None).unwrap();
    assert!(page.caption.contains("One"), "{}", page.caption);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENE);
    let same = recorded("any name", Some(file)).unwrap();
    assert!(!same.png.is_empty());
    let unknown = recorded("never saved", None).unwrap_err().to_string();
    assert!(
        unknown.contains("“never saved”; give a scene first"),
        "{unknown}"
    );
}

/// Numbers of two sheets: live the method is chosen for a minute, of a path for its own ticks, and
/// both keep their budget.
fn assert_alike(a: &str, b: &str) {
    let cells = |sheet: &str| -> Vec<f64> {
        let cells = sheet.split([',', '[', ']', '(', ')', ' ']);
        cells.filter_map(|cell| cell.parse().ok()).collect()
    };
    let (a, b) = (cells(a), cells(b));
    assert!(a.len() == b.len() && a.len() > 150, "{} numbers", a.len());
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() <= 0.006 * b.abs(), "{a} for {b}");
    }
}

#[test]
fn two_displays_are_drawn_and_the_one_under_whose_contactor_it_looks_is_told_of() {
    let folder = selvedge_scratch::ScratchFolder::made("figure-two");
    let desk = crate::bench::recording::tests::two_apart(&folder, 0);
    let made = desk.workbench.bench.exploration.at_hand.clone().unwrap();
    let csv = folder.join("two.csv");
    std::fs::write(&csv, made.path().to_csv().unwrap()).unwrap();
    let scene = folder.join("two.scene.toml");
    let of = |exploration: &Path, contactor| FigureOf {
        scene: Some(read_at(&scene)),
        exploration: Some(exploration.to_owned()),
        contactor,
    };
    let page = exploration_figure(&of(&csv, Some(30)), None).unwrap();
    for words in [
        "contactor 6 of display 2",
        "display 2's middle",
        "ways over",
    ] {
        assert!(page.caption.contains(words), "{words}: {}", page.caption);
    }
    let beyond = exploration_figure(&of(&csv, Some(48)), None).unwrap_err();
    assert!(beyond.to_string().ends_with("give 0 to 47"), "{beyond}");
    // As it was felt and as it is rendered: all is the same but what it is called.
    let loaded = LoadedScene::read(&scene, None).unwrap();
    let render = RenderScene::of(&loaded);
    let path = Recording::from_path(csv, (**made.path()).clone());
    let rendered = with_amplitudes(path, &render).unwrap();
    let sheets = [&made, &rendered].map(|recording| {
        let moment = Moment::of(recording, loaded.scene(), Some(30)).unwrap();
        assert_eq!(moment.contactor, [1, 6]);
        let drawn = exported((&loaded, &render), recording, &moment, "").unwrap();
        let strip = drawn.figure.rows[1].panels[0].raster.clone().unwrap();
        let shows = |rows: std::ops::Range<usize>| {
            let cells = rows.start * strip.n_columns..rows.end * strip.n_columns;
            strip.cells[cells].iter().flatten().count()
        };
        assert_eq!(strip.cells.len(), 48 * strip.n_columns);
        assert!(shows(0..24) > shows(24..48) && shows(24..48) > 0);
        let spectrogram = drawn.figure.rows[3].panels[0].raster.clone().unwrap();
        assert!(
            spectrogram.cells.iter().any(Option::is_some),
            "it is on the cloth"
        );
        format!("{:?}", drawn.sheet)
    });
    assert_alike(&sheets[0], &sheets[1]);
    assert!(
        sheets[0].contains("120.0"),
        "as fast as the second: {}",
        sheets[0]
    );
}
