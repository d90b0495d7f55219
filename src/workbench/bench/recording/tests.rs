//! Recordings against what was felt, and what other tests record.

use super::*;
use eframe::egui::vec2;

use crate::bench::Drive;
use crate::bench::command::{PlayCommand, PlaySource, ShowCommand};
use crate::kit::view_transform::Pointed;
use crate::shell::headless::Headless;
use crate::shell::window::Workbench;
use selvedge_engine::Command;
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::PathRow;
use selvedge_scratch::ScratchFolder;

/// So many ticks of the shipped scene explored by itself, recorded.
pub(crate) fn explored(n_ticks: u64) -> selvedge_engine::Recording {
    let ctx = eframe::egui::Context::default();
    let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
    window.dispatch(PlayCommand::Toggle.into());
    let engine = &mut window.bench.engine;
    engine.advance_ticks(3).unwrap();
    let mut recording = engine.record().unwrap();
    engine.advance_ticks(n_ticks).unwrap();
    engine.send(Command::StopRecording).unwrap();
    engine.advance_ticks(1).unwrap();
    recording.collect();
    assert!(recording.has_ended());
    recording
}

/// A cloth that fills most of the workspace, under two displays.
pub(crate) const TWO_DISPLAYS: &str = "name = \"Two fingers\"\nsize_mm = [260.0, 260.0]\n\
    [[textile]]\nid = \"jute-plain\"\norigin_mm = [10.0, 10.0]\nsize_mm = [240.0, 240.0]\n\
    [[display]]\ngeometry = \"exeter-24\"\n[[display]]\ngeometry = \"exeter-24\"\n";

/// A window that has shown this display of two while each stroked along a line of its own, the
/// second faster, beginning later and lifted sooner: 40 ticks, recorded in `folder` and at hand.
pub(crate) fn two_apart(folder: &ScratchFolder, shown: usize) -> Headless {
    let scene = folder.write("two.scene.toml", TWO_DISPLAYS);
    let mut desk = Headless::new(Some(&scene), vec2(1400.0, 900.0), 1.0).unwrap();
    desk.workbench.bench.exploration.recordings = Recordings::in_folder(folder.join("kept"));
    desk.dispatch(PlayCommand::Source(PlaySource::Pointer));
    desk.dispatch(ShowCommand::SelectDisplay(shown));
    desk.pass(4);
    desk.dispatch(PlayCommand::ToggleRecording);
    for n in 0..40 {
        let mut tap = desk.workbench.shell.tap.lock().unwrap();
        let stamp = desk.workbench.bench.clock.stamp();
        let lines = [(60.0, 2.0, 0..40), (150.0, 3.0, 8..30)];
        for (display, (y_mm, step_mm, within)) in lines.into_iter().enumerate() {
            let place = Point::new(40.0 + step_mm * f64::from(n), y_mm);
            let at = tap.screen(place).unwrap();
            if within.contains(&n) {
                let pixel = [at.x, at.y].map(f64::from);
                tap.moved_to_pixel(stamp, Pointed::Workbench, (display, pixel));
            } else if n == within.end {
                tap.lift(display);
            }
        }
        drop(tap);
        desk.pass(1);
    }
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass(3);
    desk
}

/// The page of a recording of this name.
pub(crate) fn page(name: &str) -> About {
    About {
        name: name.to_owned(),
        began: "2026-11-23T08:30:12Z".to_owned(),
        scene: "Sampler".to_owned(),
        ..About::default()
    }
}

#[test]
fn a_recording_replays_what_was_felt() {
    let recording = explored(60);
    let take = Recording::from_recording(&recording, page("One")).unwrap();
    assert!(take.file().is_none() && take.n_contactors() > 0);
    assert_eq!(take.path().n_ticks(), 60);
    let felt = (0..60).filter_map(|tick| take.amplitudes_um(tick));
    let mut high_um = felt.flatten().map(|um| um[1]);
    assert!(high_um.any(|um| um > 0.0), "it went over cloth");
    assert_eq!(take.missing(), [0; 0]);
}

#[test]
fn a_path_file_is_a_take_without_levels() {
    let row = |t_s, x_mm| PathRow {
        t_s,
        position: Point::new(x_mm, 0.0),
        ..PathRow::default()
    };
    let path = ExplorationPath::new(vec![row(0.0, 0.0), row(1.0, 80.0)]).unwrap();
    let take = Recording::from_path(PathBuf::from("/somewhere/slow stroke.csv"), path);
    assert_eq!(take.name(), "slow stroke");
    assert!(take.file().is_some(), "it came from one");
    assert!(take.amplitudes_um(0).is_none() && take.n_contactors() == 0);
}

#[test]
fn ticks_that_are_missing_are_known() {
    let ticks = [5, 6, 7, 12, 13, 15];
    assert_eq!(*missing_before(ticks.into_iter()), [3, 5]);
    assert!(missing_before([9].into_iter()).is_empty());
}
