//! Every exportable pane of a window that explores the shipped scene: its numbers, its kinds of
//! files, and what is said when there is nothing.

pub(crate) mod opened;
pub(crate) mod over_cloth;
pub(crate) mod spectra;

use std::path::Path;
use std::time::Duration;
use std::{fs, thread};

use eframe::egui::vec2;

use super::*;
use crate::bench::command::lab::Beginning;
use crate::bench::command::{FileCommand, PlayCommand, PlaySource, Purpose, ShowCommand};
use crate::bench::overlays::Overlay;
use crate::bench::pane::Pane;
use crate::shell::headless::Headless;
use crate::tools::accuracy::Accuracy;
use crate::tools::compare::comparison::{Compare, Standing};
use crate::tools::lab::Lab;
use crate::tools::response::Response;
use selvedge_foundation::files::{self, Table};
use selvedge_foundation::quantity;
use selvedge_scratch::ScratchFolder;
use selvedge_textile::tactile::Band;

const ALL: &[Exportable] = &[
    Exportable::Pane(Pane::Heatmaps),
    Exportable::Pane(Pane::ContactSpectrum),
    Exportable::Pane(Pane::DriveSpectrum),
    Exportable::Pane(Pane::DriveWave),
    Exportable::Pane(Pane::SpatialSpectra),
    Exportable::Pane(Pane::Tuning),
    Exportable::Pane(Pane::Levels),
    Exportable::Pane(Pane::Why),
    Exportable::Pane(Pane::Response),
    Exportable::Pane(Pane::Accuracy),
    Exportable::Pane(Pane::Compare),
    Exportable::Pane(Pane::Stylus),
    Exportable::Pane(Pane::Lab),
    Exportable::Pane(Pane::Import),
    Exportable::Pane(Pane::Picture),
    #[cfg(feature = "friction")]
    Exportable::Pane(Pane::Friction),
    Exportable::Pane(Pane::Drape),
    Exportable::Pane(Pane::Workspace),
    Exportable::Pane(Pane::Collection),
    Exportable::Timeline,
];

/// The exploration that is exported from.
impl Headless {
    fn fresh() -> Self {
        let mut desk = Self::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
        desk.dispatch(ShowCommand::ToggleNumbers);
        desk
    }

    /// A window whose display has explored by itself for as many ticks.
    fn explored(n_ticks: u32) -> Self {
        let mut desk = Self::fresh();
        desk.import();
        desk.open_picture();
        #[cfg(feature = "friction")]
        desk.ask_friction();
        desk.hang_cloth();
        desk.dispatch(PlayCommand::Source(PlaySource::Stroke));
        desk.dispatch(ShowCommand::Overlay(Overlay::Map(Band::High)));
        // What is found on threads is found while its pane is in sight.
        desk.dispatch(Beginning::Example("brownian"));
        let window = &mut desk.workbench;
        let lab: &mut Lab = window.tools.get_mut().unwrap();
        lab.follow(&window.bench);
        let panes = [Pane::Response, Pane::Accuracy, Pane::Compare];
        for pane in panes {
            desk.dispatch(ShowCommand::Pane(pane));
            desk.pass_ticks(n_ticks / 3);
            desk.settle();
        }
        desk
    }

    /// The same with the library measured.
    fn collected(n_ticks: u32) -> Self {
        let mut desk = Self::explored(n_ticks);
        desk.dispatch(ShowCommand::Pane(Pane::Collection));
        desk.pass_ticks(2);
        let n_textiles = desk.workbench.bench.library.view.items().len() as u64;
        while desk.workbench.n_textiles_measured() < n_textiles {
            thread::sleep(Duration::from_millis(5));
            // However long it takes, the display stays where it is.
            desk.run_after(0).drop_without_applying_deltas();
        }
        desk
    }

    /// Waits for the threads that compare and check.
    fn settle(&mut self) {
        for _ in 0..2000 {
            let [sampled, _] = self.workbench.ticks_checked();
            let accuracy = self.workbench.tools.get_mut::<Accuracy>().unwrap();
            accuracy.take_found();
            let is_checked = accuracy.found().n_ticks == sampled;
            let compare = self.workbench.tools.get_mut::<Compare>().unwrap();
            compare.poll();
            let standing = compare.standing(&compare.inputs(&self.workbench.bench));
            if is_checked && !matches!(standing, Standing::Running(_)) {
                return;
            }
            thread::sleep(Duration::from_millis(5));
        }
        panic!("a thread never came to its end");
    }

    fn exported(&mut self, what: Exportable) -> Exported {
        let exported = self.workbench.exported(what);
        exported.unwrap_or_else(|words| panic!("{what:?}: {words}"))
    }

    fn file(&mut self, command: FileCommand) {
        self.dispatch(command);
    }

    fn notices(&self) -> String {
        self.workbench.notices().join("\n")
    }
}

fn table_of(exported: &Exported) -> Table {
    let csv = exported.to_csv().unwrap();
    let header = csv.lines().find(|line| !line.starts_with('#')).unwrap();
    let columns: Vec<&str> = header.split(',').collect();
    Table::read(&csv, Path::new("exported.csv"), &columns, &[]).unwrap()
}

/// The numbers of a column, NaN where a cell is empty.
fn column(exported: &Exported, name: &str) -> Vec<f64> {
    let table = table_of(exported);
    let cells = table.text(name).unwrap();
    let number = |cell: &&str| cell.parse().unwrap_or(f64::NAN);
    cells.iter().map(number).collect()
}

#[test]
fn every_pane_is_exported_as_every_kind_the_same_twice() {
    let mut desk = Headless::collected(90);
    for &what in ALL {
        let exported = desk.exported(what);
        assert!(exported.sheet.n_rows() > 0, "{what:?}");
        assert_eq!(table_of(&exported).n_rows(), exported.sheet.n_rows());
        let again = desk.exported(what);
        for kind in Kind::ALL {
            let name = what.file_name(kind.ending());
            let path = Path::new(&name);
            let bytes = exported.bytes(kind, path).unwrap();
            assert_eq!(bytes, again.bytes(kind, path).unwrap(), "{name}");
            match kind {
                Kind::Png => {
                    let picture = files::Rgb8Image::from_png(&bytes, path).unwrap();
                    assert_eq!(picture.width, 1720, "{name}");
                    let n_white = picture
                        .pixels
                        .iter()
                        .filter(|rgb| **rgb == [255; 3])
                        .count();
                    assert!(n_white < picture.pixels.len() * 98 / 100, "{name} is empty");
                }
                Kind::Svg => {
                    let svg = String::from_utf8(bytes).unwrap();
                    assert!(is_well_formed(&svg), "{name}: {svg}");
                    let is_imported =
                        matches!(what.title(), "Import" | "Picture" | "Friction" | "Drape");
                    let of = if is_imported {
                        "file = "
                    } else {
                        "scene_sha256 = "
                    };
                    assert!(svg.contains(of), "{name}");
                    assert!(svg.len() < 400_000, "{name} has {} bytes", svg.len());
                }
                Kind::Csv => {
                    let csv = String::from_utf8(bytes).unwrap();
                    assert!(csv.starts_with("# program = selvedge "), "{name}");
                    assert!(!csv.contains("NaN") && !csv.contains("inf"), "{name}");
                }
            }
        }
    }
}

#[test]
fn heatmaps_hold_the_amplitudes_of_every_contactor() {
    let mut desk = Headless::explored(60);
    let exported = desk.exported(Exportable::Pane(Pane::Heatmaps));
    let dots = &desk.workbench.bench.live.dots;
    for (band, name) in ["a40_um", "a320_um"].into_iter().enumerate() {
        let shown: Vec<f64> = dots.iter().map(|dot| dot.amplitude_um[band]).collect();
        assert_eq!(column(&exported, name), shown);
    }
    assert!(
        column(&exported, "a40_um").iter().any(|um| *um > 0.0),
        "felt"
    );
    let textile = table_of(&exported).text("textile").unwrap()[0].to_owned();
    let scene = desk.workbench.scene();
    assert!(
        scene.textiles.iter().any(|placed| placed.id == textile),
        "{textile}"
    );
    let words = exported.figure.rows[0].panels[0].words.len();
    assert_eq!(words, 24, "a number in every cell");
}

#[test]
fn the_compression_curve_holds_the_library_at_its_levels() {
    let mut desk = Headless::explored(4);
    let edit = crate::bench::command::edit::Edit::Compression(0.5);
    desk.dispatch(edit);
    desk.pass_ticks(4);
    let exported = desk.exported(Exportable::Pane(Pane::Tuning));
    let (before, after) = (
        column(&exported, "level_in_db"),
        column(&exported, "level_out_db"),
    );
    assert_eq!(before.len(), desk.workbench.bench.library.levels.dots.len());
    let reference = desk.workbench.bench.live.reference_db.unwrap();
    for (before, after) in before.iter().zip(after) {
        assert!(
            (after - 0.5 * (before + reference)).abs() < 1e-9,
            "{before} → {after}"
        );
    }
}

#[test]
fn the_timeline_holds_speed_and_means_of_every_tick() {
    let mut desk = Headless::explored(80);
    let exported = desk.exported(Exportable::Timeline);
    let tick_samples: Vec<_> = desk
        .workbench
        .bench
        .past
        .history
        .tick_samples()
        .copied()
        .collect();
    let ticks: Vec<f64> = tick_samples
        .iter()
        .map(|tick_sample| tick_sample.tick as f64)
        .collect();
    assert_eq!(column(&exported, "tick"), ticks);
    let means = column(&exported, "mean_a320_um");
    for (mean, tick_sample) in means.iter().zip(&tick_samples) {
        assert_eq!(*mean, f64::from(tick_sample.mean_um[1]));
    }
    let level = quantity::level_db(*means.last().unwrap());
    let line = &exported.figure.rows[1].panels[0].series[1];
    assert_eq!(line.points.last().unwrap()[1], level);
}

#[test]
fn what_was_seen_when_it_was_asked_for_is_what_is_written() {
    let folder = ScratchFolder::made("seen");
    let mut desk = Headless::collected(60);
    for &what in ALL {
        let path = folder.join(what.file_name("csv"));
        let seen = desk.exported(what).bytes(Kind::Csv, &path).unwrap();
        desk.file(FileCommand::Ask(Purpose::Export(what)));
        desk.pass_ticks(7);
        let ask = desk.workbench.shell.ask.as_ref();
        let suggested = ask.map(|ask| ask.path.clone()).unwrap_or_default();
        let last = desk.workbench.shell.exports.last.clone();
        let kind = last.map_or(Kind::Png, |(_, kind)| kind);
        assert!(
            suggested.ends_with(&what.file_name(kind.ending())),
            "{suggested}"
        );
        desk.file(FileCommand::Use(Purpose::Export(what), path.clone()));
        assert_eq!(fs::read(&path).unwrap(), seen, "{what:?}");
        assert!(desk.workbench.shell.ask.is_none(), "answered");
    }
    let notices = desk.notices();
    assert!(
        notices.lines().all(|line| line.ends_with(" is written")),
        "{notices}"
    );
    assert_eq!(fs::read_dir(&folder).unwrap().count(), ALL.len());
}

#[test]
fn a_name_of_no_known_kind_is_refused_with_the_mend_and_may_be_mended() {
    let folder = ScratchFolder::made("kind");
    let mut desk = Headless::explored(30);
    let purpose = Purpose::Export(Exportable::Pane(Pane::DriveWave));
    desk.file(FileCommand::Ask(purpose));
    desk.pass_ticks(2);
    for name in ["wave.pdf", "wave", "wave.png.txt"] {
        let path = folder.join(name);
        desk.file(FileCommand::Use(purpose, path));
        let notices = desk.notices();
        assert!(notices.contains(name), "{notices}");
        assert!(
            notices.contains("end its name in .png, .svg or .csv"),
            "{notices}"
        );
        assert!(desk.workbench.shell.ask.is_some(), "the field stays");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
    let path = folder.join("WAVE.SVG");
    desk.file(FileCommand::Use(purpose, path.clone()));
    assert!(is_well_formed(&fs::read_to_string(path).unwrap()), "mended");
    let nowhere = folder.join("missing/wave.csv");
    desk.file(FileCommand::Use(purpose, nowhere));
    assert!(
        desk.notices().contains("cannot write"),
        "{}",
        desk.notices()
    );
}

#[test]
fn with_nothing_to_show_it_is_said_what_to_do() {
    let mut desk = Headless::fresh();
    desk.pass_ticks(2);
    let of_levels = [Pane::Tuning, Pane::Levels].map(Exportable::Pane);
    let has_levels = |what: &Exportable| of_levels.contains(what);
    for what in ALL.iter().copied().filter(|what| !has_levels(what)) {
        let is_chosen = what == Exportable::Timeline || what == ALL[0] || what == ALL[1];
        desk.workbench.bench.selection.contactor = is_chosen.then_some(9);
        let words = desk
            .workbench
            .exported(what)
            .expect_err("nothing is shown yet");
        assert!(
            words.starts_with("There is nothing to export"),
            "{what:?}: {words}"
        );
        desk.file(FileCommand::Ask(Purpose::Export(what)));
        assert!(desk.notices().contains(words), "{what:?}");
        assert!(desk.workbench.shell.exports.seen.is_none(), "{what:?}");
    }
    let library = Exportable::Pane(Pane::Library);
    assert!(!Pane::Library.has_export() && desk.workbench.exported(library).is_err());
    assert!(!Pane::Library.has_export() && desk.workbench.exported(library).is_err());
}

#[test]
fn every_export_has_a_name_of_its_own() {
    let mut names: Vec<String> = ALL.iter().map(|what| what.file_name("png")).collect();
    assert_eq!(names[1], "contact-spectrum.png");
    names.sort();
    names.dedup();
    assert_eq!(names.len(), ALL.len());
    let is_listed = |pane: &Pane| ALL.contains(&Exportable::Pane(*pane));
    for pane in Pane::ALL {
        // What is measured on a link needs one: its export has tests of its own.
        let is_tested = is_listed(&pane) || pane == Pane::Bridge;
        assert_eq!(pane.has_export(), is_tested, "{pane:?}");
    }
}

#[test]
fn curves_errors_and_differences_are_those_of_their_panes() {
    let mut desk = Headless::explored(90);
    let response = desk.exported(Exportable::Pane(Pane::Response));
    let rms_um = column(&response, "a320_rms_um");
    let shown = desk.workbench.tools.get::<Response>().unwrap();
    let curves = &shown.curves;
    assert_eq!(
        rms_um.len(),
        curves.around().len() + curves.over_speed().len()
    );
    let textile = shown.textile.unwrap();
    let factors = desk
        .workbench
        .bench
        .inspection
        .inspector
        .response(textile)
        .unwrap()
        .factors();
    let first_um = curves.around()[0].scaled(factors).rms_um[1];
    assert_eq!(rms_um[0].to_bits(), first_um.to_bits());

    let accuracy = desk.exported(Exportable::Pane(Pane::Accuracy));
    let counted: f64 = column(&accuracy, "count").iter().sum();
    let shown = desk.workbench.tools.get::<Accuracy>().unwrap();
    let errors: u64 = shown.found().counts.iter().flatten().sum();
    let ticks: u64 = shown
        .cost()
        .costs
        .buckets()
        .map(|b| u64::from(b.count))
        .sum();
    assert_eq!(counted, (errors + ticks) as f64);
    assert!(errors > 100, "{errors} amplitudes");

    let compared = desk.exported(Exportable::Pane(Pane::Compare));
    let means_db = column(&compared, "mean_db");
    let found = desk.workbench.comparison().unwrap();
    assert_eq!(
        means_db.len(),
        2 * (found.by_contactor.len() + found.over_time.len())
    );
    let first_db = found.by_contactor[0][0].mean_db().unwrap();
    assert_eq!(means_db[0].to_bits(), first_db.to_bits());
}

/// Whether a text is XML that can be read to its end.
fn is_well_formed(svg: &str) -> bool {
    files::visit_elements(svg.as_bytes(), Path::new("figure.svg"), |_, _| Ok(())).is_ok()
}
