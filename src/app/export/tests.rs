//! Every exportable pane of a window that explores the shipped scene: its numbers, its kinds of
//! files, and what is said when there is nothing.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use eframe::App as _;
use eframe::egui::{Context, Pos2, RawInput, Rect, vec2};

use super::*;
use crate::app::command::{FileCommand, PlayCommand, PlaySource, Purpose, ShowCommand};
use crate::app::compare::Standing;
use crate::app::importing::ImportCommand;
use crate::app::importing::tests::export;
use crate::app::panes::density_db;
use crate::app::signals::N_ROWS;
use crate::app::{Drive, Workbench};
use crate::files::{self, Table};
use crate::{figure, quantity};

const ALL: [Exportable; 12] = [
    Exportable::Pane(Pane::Heatmaps),
    Exportable::Pane(Pane::ContactSpectrum),
    Exportable::Pane(Pane::DriveSpectrum),
    Exportable::Pane(Pane::DriveWave),
    Exportable::Pane(Pane::SpatialSpectra),
    Exportable::Pane(Pane::Tuning),
    Exportable::Pane(Pane::Why),
    Exportable::Pane(Pane::Response),
    Exportable::Pane(Pane::Accuracy),
    Exportable::Pane(Pane::Compare),
    Exportable::Pane(Pane::Import),
    Exportable::Timeline,
];

/// Ticks between two frames: 10 frames a second of simulated time.
const TICKS_A_FRAME: u32 = 4;

/// A window without a screen.
struct Desk {
    ctx: Context,
    bench: Workbench,
    frame: eframe::Frame,
    n_ticks: u32,
}

impl Desk {
    fn new() -> Self {
        let ctx = Context::default();
        let mut bench = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        bench.dispatch(&ctx, ShowCommand::ToggleNumbers.into());
        Self {
            ctx,
            bench,
            frame: eframe::Frame::_new_kittest(),
            n_ticks: 0,
        }
    }

    /// A window whose display has explored by itself for as many ticks.
    fn explored(n_ticks: u32) -> Self {
        let mut desk = Self::new();
        let stroke = PlayCommand::Source(PlaySource::Stroke);
        desk.bench.dispatch(&desk.ctx, stroke.into());
        // What is found on threads is found while its pane is in sight.
        for pane in [Pane::Response, Pane::Accuracy, Pane::Compare] {
            desk.bench
                .dispatch(&desk.ctx, ShowCommand::Pane(pane).into());
            desk.go_on(n_ticks / 3);
            desk.settle();
        }
        desk.import();
        desk
    }

    /// Reads strokes of the tester.
    fn import(&mut self) {
        let folder = Folder::new(&format!("strokes-{:?}", thread::current().id()));
        let path = folder.0.join("twill.txt");
        fs::write(&path, export()).unwrap();
        let add = ImportCommand::Add(vec![path]);
        self.bench.dispatch(&self.ctx, add.into());
        self.go_on(TICKS_A_FRAME);
    }

    /// Waits for the threads that compare and check.
    fn settle(&mut self) {
        for _ in 0..2000 {
            let [sampled, _] = self.bench.ticks_checked();
            let is_checked = self.bench.accuracy_view().found.n_ticks == sampled;
            let standing = self.bench.comparison_standing();
            if is_checked && !matches!(standing, Standing::Running(_)) {
                return;
            }
            thread::sleep(Duration::from_millis(5));
            self.bench.transient.comparison.poll();
        }
        panic!("a thread never came to its end");
    }

    fn go_on(&mut self, n_ticks: u32) {
        let ctx = self.ctx.clone();
        let end = self.n_ticks + n_ticks;
        while self.n_ticks < end {
            self.n_ticks = end.min(self.n_ticks + TICKS_A_FRAME);
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1400.0, 900.0))),
                time: Some(f64::from(self.n_ticks) / 40.0),
                ..RawInput::default()
            };
            let output = ctx.run_ui(input, |ui| {
                self.bench.logic(&ctx, &mut self.frame);
                self.bench.ui(ui, &mut self.frame);
            });
            output.drop_without_applying_deltas();
        }
    }

    fn exported(&mut self, what: Exportable) -> Exported {
        let exported = self.bench.exported(what);
        exported.unwrap_or_else(|words| panic!("{what:?}: {words}"))
    }

    fn file(&mut self, command: FileCommand) {
        self.bench.dispatch(&self.ctx.clone(), command.into());
    }

    fn notices(&self) -> String {
        self.bench.notices().join("\n")
    }
}

/// A folder that is removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("selvedge-export-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).unwrap();
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
    let mut desk = Desk::explored(90);
    for what in ALL {
        let exported = desk.exported(what);
        assert!(exported.sheet.n_rows() > 0, "{what:?}");
        assert_eq!(table_of(&exported).n_rows(), exported.sheet.n_rows());
        let again = desk.exported(what);
        for kind in Kind::ALL {
            let name = what.file_name(kind);
            let path = Path::new(&name);
            let bytes = exported.bytes(kind, path).unwrap();
            assert_eq!(bytes, again.bytes(kind, path).unwrap(), "{name}");
            match kind {
                Kind::Png => {
                    let picture = files::decode_png(&bytes, path).unwrap();
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
                    assert!(figure::is_well_formed(&svg), "{name}: {svg}");
                    let is_imported = what == Exportable::Pane(Pane::Import);
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
    let mut desk = Desk::explored(60);
    let exported = desk.exported(Exportable::Pane(Pane::Heatmaps));
    let dots = &desk.bench.transient.live.dots;
    for (band, name) in ["a40_um", "a320_um"].into_iter().enumerate() {
        let shown: Vec<f64> = dots.iter().map(|dot| dot.amplitude_um[band]).collect();
        assert_eq!(column(&exported, name), shown);
    }
    assert!(
        column(&exported, "a40_um").iter().any(|um| *um > 0.0),
        "felt"
    );
    let textile = table_of(&exported).text("textile").unwrap()[0].to_owned();
    let scene = desk.bench.scene();
    assert!(
        scene.textiles.iter().any(|placed| placed.id == textile),
        "{textile}"
    );
    let words = exported.figure.rows[0].panels[0].words.len();
    assert_eq!(words, 24, "a number in every cell");
}

#[test]
fn spectrograms_hold_what_was_computed_even_behind_other_panes() {
    let mut desk = Desk::explored(400);
    for (what, name) in [
        (Pane::ContactSpectrum, "level_db"),
        (Pane::DriveSpectrum, "amplitude_um"),
    ] {
        let exported = desk.exported(Exportable::Pane(what));
        let (values, ticks) = (column(&exported, name), column(&exported, "tick"));
        assert_eq!(values.len(), 320 * N_ROWS, "8 s, whether drawn or not");
        let newest = desk.bench.transient.history.newest().unwrap().glimpse;
        assert_eq!(ticks.last().copied(), Some(newest.tick as f64));
        let times = column(&exported, "t_s");
        assert_eq!(
            (times[0], times.last().copied()),
            (-319.0 / 40.0, Some(0.0))
        );
        let last = &values[values.len() - N_ROWS..];
        if what == Pane::DriveSpectrum {
            let largest = last.iter().copied().fold(0.0, f64::max);
            let louder = newest.watched_um.map(f64::from);
            let most = louder[0].max(louder[1]);
            assert!(
                largest > 0.3 * most && largest < 3.0 * most,
                "{largest} of {most}"
            );
        } else {
            let contactor = desk.bench.workspace.contactor.unwrap();
            let mut expected = [0.0; N_ROWS];
            crate::app::signals::ContactColumns::default().levels_db(
                &mut desk.bench.eye.inspector,
                contactor,
                &newest.pose,
                &mut expected,
            );
            for (read, shown) in last.iter().zip(expected) {
                let is_same = if shown.is_finite() {
                    (*read - f64::from(shown)).abs() < 1e-5
                } else {
                    read.is_nan()
                };
                assert!(is_same, "{read} for {shown}");
            }
        }
    }
}

#[test]
fn the_waveform_is_the_sum_of_both_bands_with_their_amplitudes() {
    let mut desk = Desk::explored(60);
    let exported = desk.exported(Exportable::Pane(Pane::DriveWave));
    let shown = desk.bench.drive_wave_view();
    let times = column(&exported, "t_s");
    for (band, name) in ["wave_40_um", "wave_320_um"].into_iter().enumerate() {
        let wave = column(&exported, name);
        let second = times.iter().position(|t_s| *t_s >= 0.025).unwrap();
        let most = wave[second..].iter().copied().fold(0.0, f64::max);
        let amplitude = shown.now_um[band];
        assert!(
            (most - amplitude).abs() < 0.02 * amplitude,
            "{most} of {amplitude}"
        );
    }
    let waves = ["wave_40_um", "wave_320_um", "sum_um"].map(|name| column(&exported, name));
    for ((low, high), sum) in waves[0].iter().zip(&waves[1]).zip(&waves[2]) {
        assert!((low + high - sum).abs() < 1e-9, "{low} + {high} = {sum}");
    }
}

#[test]
fn spatial_spectra_hold_every_bin_of_every_direction() {
    let mut desk = Desk::explored(60);
    let exported = desk.exported(Exportable::Pane(Pane::SpatialSpectra));
    let (density, level) = (
        column(&exported, "density_um2_mm"),
        column(&exported, "level_db"),
    );
    assert_eq!(density.len(), 4 * 500);
    for (density, level) in density
        .iter()
        .zip(&level)
        .filter(|(density, _)| **density > 0.0)
    {
        assert!((density_db(*density) - level).abs() < 1e-9, "{level}");
    }
    let sounds = column(&exported, "sounds_at_hz");
    assert!(sounds.iter().any(|hz| *hz > 0.0), "something sounds");
    let rules = &exported.figure.rows[0].panels[0].rules;
    assert_eq!(rules.len(), 2, "40 and 320 Hz are marked");
}

#[test]
fn the_compression_curve_holds_the_library_at_its_levels() {
    let mut desk = Desk::explored(4);
    let edit = crate::app::command::Edit::Compression(0.5);
    desk.bench.dispatch(&desk.ctx.clone(), edit.into());
    desk.go_on(4);
    let exported = desk.exported(Exportable::Pane(Pane::Tuning));
    let (before, after) = (
        column(&exported, "level_in_db"),
        column(&exported, "level_out_db"),
    );
    assert_eq!(before.len(), desk.bench.library.len());
    let reference = desk.bench.transient.reference_db.unwrap();
    for (before, after) in before.iter().zip(after) {
        assert!(
            (after - 0.5 * (before + reference)).abs() < 1e-9,
            "{before} → {after}"
        );
    }
}

#[test]
fn the_timeline_holds_speed_and_means_of_every_tick() {
    let mut desk = Desk::explored(80);
    let exported = desk.exported(Exportable::Timeline);
    let glimpses: Vec<_> = desk.bench.transient.history.glimpses().copied().collect();
    let ticks: Vec<f64> = glimpses.iter().map(|glimpse| glimpse.tick as f64).collect();
    assert_eq!(column(&exported, "tick"), ticks);
    let means = column(&exported, "mean_a320_um");
    for (mean, glimpse) in means.iter().zip(&glimpses) {
        assert_eq!(*mean, f64::from(glimpse.mean_um[1]));
    }
    let level = quantity::level_db(*means.last().unwrap());
    let line = &exported.figure.rows[1].panels[0].series[1];
    assert_eq!(line.points.last().unwrap()[1], level);
}

#[test]
fn what_was_seen_when_it_was_asked_for_is_what_is_written() {
    let folder = Folder::new("seen");
    let mut desk = Desk::explored(60);
    for what in ALL {
        let path = folder.0.join(what.file_name(Kind::Csv));
        let seen = desk.exported(what).bytes(Kind::Csv, &path).unwrap();
        desk.file(FileCommand::Ask(Purpose::Export(what)));
        desk.go_on(7);
        let ask = desk.bench.transient.ask.as_ref();
        let suggested = ask.map(|ask| ask.path.clone()).unwrap_or_default();
        let last = desk.bench.transient.exports.last.clone();
        let kind = last.map_or(Kind::Png, |(_, kind)| kind);
        assert!(suggested.ends_with(&what.file_name(kind)), "{suggested}");
        desk.file(FileCommand::Use(Purpose::Export(what), path.clone()));
        assert_eq!(fs::read(&path).unwrap(), seen, "{what:?}");
        assert!(desk.bench.transient.ask.is_none(), "answered");
    }
    assert_eq!(desk.notices(), "");
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), ALL.len());
}

#[test]
fn a_name_of_no_known_kind_is_refused_with_the_mend_and_may_be_mended() {
    let folder = Folder::new("kind");
    let mut desk = Desk::explored(30);
    let purpose = Purpose::Export(Exportable::Pane(Pane::DriveWave));
    desk.file(FileCommand::Ask(purpose));
    desk.go_on(2);
    for name in ["wave.pdf", "wave", "wave.png.txt"] {
        let path = folder.0.join(name);
        desk.file(FileCommand::Use(purpose, path));
        let notices = desk.notices();
        assert!(notices.contains(name), "{notices}");
        assert!(
            notices.contains("end its name in .png, .svg or .csv"),
            "{notices}"
        );
        assert!(desk.bench.transient.ask.is_some(), "the field stays");
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
    let path = folder.0.join("WAVE.SVG");
    desk.file(FileCommand::Use(purpose, path.clone()));
    assert!(
        figure::is_well_formed(&fs::read_to_string(path).unwrap()),
        "mended"
    );
    let nowhere = folder.0.join("missing/wave.csv");
    desk.file(FileCommand::Use(purpose, nowhere));
    assert!(
        desk.notices().contains("cannot write"),
        "{}",
        desk.notices()
    );
}

#[test]
fn with_nothing_to_show_it_is_said_what_to_do() {
    let mut desk = Desk::new();
    desk.go_on(2);
    let has_levels = |what: &Exportable| *what == Exportable::Pane(Pane::Tuning);
    for what in ALL.into_iter().filter(|what| !has_levels(what)) {
        let is_chosen = what == Exportable::Timeline || what == ALL[0] || what == ALL[1];
        desk.bench.workspace.contactor = is_chosen.then_some(9);
        let words = desk.bench.exported(what).expect_err("nothing is shown yet");
        assert!(
            words.starts_with("There is nothing to export"),
            "{what:?}: {words}"
        );
        desk.file(FileCommand::Ask(Purpose::Export(what)));
        assert!(desk.notices().contains(words), "{what:?}");
        assert!(desk.bench.transient.exports.seen.is_none(), "{what:?}");
    }
    let workspace = Exportable::Pane(Pane::Workspace);
    assert!(!is_exportable(Pane::Workspace) && desk.bench.exported(workspace).is_err());
}

#[test]
fn every_export_has_a_name_of_its_own() {
    let mut names: Vec<String> = ALL.map(|what| what.file_name(Kind::Png)).to_vec();
    assert_eq!(names[1], "contact-spectrum.png");
    names.sort();
    names.dedup();
    assert_eq!(names.len(), ALL.len());
    let is_listed = |pane: &Pane| ALL.contains(&Exportable::Pane(*pane));
    for pane in Pane::ALL {
        assert_eq!(is_exportable(pane), is_listed(&pane), "{pane:?}");
    }
}

#[test]
fn curves_errors_and_differences_are_those_of_their_panes() {
    let mut desk = Desk::explored(90);
    let response = desk.exported(Exportable::Pane(Pane::Response));
    let rms_um = column(&response, "a320_rms_um");
    let curves = &desk.bench.transient.curves;
    assert_eq!(
        rms_um.len(),
        curves.around().len() + curves.over_speed().len()
    );
    let textile = desk.bench.transient.asked_textile.unwrap();
    let factors = desk
        .bench
        .eye
        .inspector
        .response(textile)
        .unwrap()
        .factors();
    let first_um = curves.around()[0].scaled(factors).rms_um[1];
    assert_eq!(rms_um[0].to_bits(), first_um.to_bits());

    let accuracy = desk.exported(Exportable::Pane(Pane::Accuracy));
    let counted: f64 = column(&accuracy, "count").iter().sum();
    let view = desk.bench.accuracy_view();
    let errors: u64 = view.found.counts.iter().flatten().sum();
    let ticks: u64 = view.cost.costs.buckets().map(|b| u64::from(b.count)).sum();
    assert_eq!(counted, (errors + ticks) as f64);
    assert!(errors > 100, "{errors} amplitudes");

    let compared = desk.exported(Exportable::Pane(Pane::Compare));
    let means_db = column(&compared, "mean_db");
    let found = desk.bench.comparison().unwrap();
    assert_eq!(
        means_db.len(),
        2 * (found.by_contactor.len() + found.over_time.len())
    );
    let first_db = found.by_contactor[0][0].mean_db().unwrap();
    assert_eq!(means_db[0].to_bits(), first_db.to_bits());
}
