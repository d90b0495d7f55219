//! The window's own study: what a frame costs, what every view adds to it, and whether anything is
//! done while nothing changes.

use std::hint::black_box;
use std::time::Duration;

use eframe::egui::epaint::{ClippedPrimitive, Primitive};
use eframe::egui::{FullOutput, vec2};

use crate::bench::command::{PlayCommand, PlaySource, ShowCommand};
use crate::bench::error::AppError;
use crate::bench::pane::Pane;
use crate::shell::headless::Headless;
use selvedge_studies::{Bench, Findings, ReportError, Row, Study};

/// Width and height of the window, points.
const SIZE: [f32; 2] = [1400.0, 900.0];
/// Frames until everything has been read, laid out and lit.
const N_SETTLING: u32 = 60;
/// Frames of a still window that are looked at.
const N_STILL: u32 = 40;

/// The studies of the window.
pub fn studies() -> Vec<Study> {
    vec![STUDY]
}

/// What a frame costs.
const STUDY: Study = Study {
    name: "window",
    chapter: "window",
    question: "What does a frame of the window cost, what does each view add, and is anything \
               done while nothing changes?",
    reference: "A window in which nothing moves: it asks for no frame and uploads no picture.",
    error: ("work without a cause", "frames or pictures"),
    cost_of: "frame",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut findings = Findings::default();
    // Whoever is in a hurry asks about the views that a new user sees.
    let mut fresh = window()?;
    fresh.pass(1);
    let mut settings = vec![Setting::Default, Setting::NothingElse];
    let shell = &fresh.workbench.shell;
    let is_wanted = |pane: &Pane| bench.effort.pick(shell.shows(*pane), true);
    settings.extend(Pane::ALL.into_iter().filter(is_wanted).map(Setting::Only));
    let n_settings = settings.len() as f64 + 1.0;
    for (number, setting) in settings.into_iter().enumerate() {
        bench.step(number as f64 / n_settings, &setting.name())?;
        findings.rows.push(moving_row(bench, setting)?);
    }
    findings.rows.extend(still_rows()?);
    findings.notes = NOTES.map(str::to_owned).to_vec();
    Ok(findings)
}

/// What a reader should know.
const NOTES: [&str; 2] = [
    "app, hidden views: A view that is hidden or behind another is neither laid out nor computed; \
     its rows say what it would add to the frame that shows header and timeline alone.",
    "app, still windows: A frame in which nothing changed asks for no other, and pictures are \
     uploaded only when they changed.",
];

/// Which views are in sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Setting {
    /// Those that a new user sees.
    Default,
    /// None.
    NothingElse,
    /// This one.
    Only(Pane),
}

impl Setting {
    fn name(self) -> String {
        match self {
            Self::Default => "default arrangement".to_owned(),
            Self::NothingElse => "every view hidden".to_owned(),
            Self::Only(pane) => format!("only {}", pane.title().to_lowercase()),
        }
    }

    fn shows(self, pane: Pane) -> bool {
        self == Self::Only(pane)
    }
}

/// A window that explores by itself, with some views in sight.
fn moving(setting: Setting) -> Result<Headless, ReportError> {
    let mut window = window()?;
    window.dispatch(PlayCommand::Source(PlaySource::Stroke));
    window.pass(1);
    if setting != Setting::Default {
        // What stood behind a view that is hidden comes to the front in the next frame.
        for _ in Pane::ALL {
            if !show_only(&mut window, setting) {
                break;
            }
            window.pass(1);
        }
    }
    window.pass(N_SETTLING);
    Ok(window)
}

/// Whether there was anything to show or hide.
fn show_only(window: &mut Headless, setting: Setting) -> bool {
    let shell = &window.workbench.shell;
    let is_wrong = |pane: &Pane| shell.shows(*pane) != setting.shows(*pane);
    let wrong: Vec<Pane> = Pane::ALL.into_iter().filter(is_wrong).collect();
    for pane in &wrong {
        window.dispatch(ShowCommand::Pane(*pane));
    }
    !wrong.is_empty()
}

fn window() -> Result<Headless, ReportError> {
    let [width, height] = SIZE;
    let of_window = |error: AppError| ReportError::Study(error.to_string());
    Headless::new(None, vec2(width, height), 1.0).map_err(of_window)
}

/// Logic, layout and tessellation of a frame that shows something new.
fn moving_row(bench: &mut Bench<'_>, setting: Setting) -> Result<Row, ReportError> {
    let mut window = moving(setting)?;
    let drawn = tessellated(&mut window);
    let cost = bench.time(1, || black_box(tessellated(&mut window)));
    Ok(Row {
        method: "window".to_owned(),
        setting: setting.name(),
        case: "exploring by itself".to_owned(),
        cost: Some(cost),
        more: vec![
            ("draw_calls", drawn.n_calls.to_string()),
            ("vertices", drawn.n_vertices.to_string()),
        ],
        ..Row::default()
    })
}

/// What a graphics card is given for a frame.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    n_calls: usize,
    n_vertices: usize,
}

fn tessellated(window: &mut Headless) -> Drawn {
    let FullOutput {
        shapes,
        mut textures_delta,
        pixels_per_point,
        ..
    } = window.run();
    textures_delta.clear();
    let primitives = window.ctx.tessellate(shapes, pixels_per_point);
    let n_vertices = |primitive: &ClippedPrimitive| match &primitive.primitive {
        Primitive::Mesh(mesh) => mesh.vertices.len(),
        Primitive::Callback(_) => 0,
    };
    Drawn {
        n_calls: primitives.len(),
        n_vertices: primitives.iter().map(n_vertices).sum(),
    }
}

/// What a window does in which nothing moves: it ought to be nothing.
fn still_rows() -> Result<[Row; 2], ReportError> {
    let mut window = window()?;
    window.pass(N_SETTLING);
    let (mut n_asked, mut n_uploaded) = (0_u32, 0_usize);
    for _ in 0..N_STILL {
        let mut output = window.run();
        let is_asked = |delay: Duration| delay < Duration::from_secs(1);
        let mut delays = output.viewport_output.values();
        n_asked += u32::from(delays.any(|viewport| is_asked(viewport.repaint_delay)));
        n_uploaded += output.textures_delta.set.len();
        output.textures_delta.clear();
    }
    let row = |setting: &str, n: f64| Row {
        method: "window".to_owned(),
        setting: setting.to_owned(),
        case: format!("still, {N_STILL} frames"),
        error: Some(n),
        promised: Some(0.0),
        ..Row::default()
    };
    Ok([
        row("frames asked for", f64::from(n_asked)),
        row("pictures uploaded", n_uploaded as f64),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::progress::{CancelFlag, Progress};
    use selvedge_studies::Effort;

    #[test]
    fn hidden_views_cost_nothing_and_a_still_window_does_nothing() {
        let [frames, pictures] = still_rows().unwrap();
        assert_eq!(
            (frames.is_kept(), pictures.is_kept()),
            (Some(true), Some(true))
        );
        let mut bare = moving(Setting::NothingElse).unwrap();
        let n_drawn = bare.workbench.shell.n_drawn;
        let drawn = tessellated(&mut bare);
        assert_eq!(bare.workbench.shell.n_drawn, n_drawn, "none is drawn");
        let mut full = moving(Setting::Default).unwrap();
        assert!(tessellated(&mut full).n_vertices > 4 * drawn.n_vertices);
    }

    #[test]
    fn every_view_has_a_row_and_only_it_was_in_sight() {
        let window = moving(Setting::Only(Pane::Heatmaps)).unwrap();
        let in_sight = Pane::ALL.map(|pane| window.workbench.shell.shows(pane));
        let n_in_sight = in_sight.into_iter().filter(|is| *is).count();
        assert_eq!((n_in_sight, in_sight[Pane::Heatmaps.index()]), (1, true));
        let mut report = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut report, CancelFlag::new());
        let mut bench = Bench::new(Effort::Quick, 1, &mut progress);
        let row = moving_row(&mut bench, Setting::Only(Pane::Heatmaps)).unwrap();
        assert_eq!(row.setting, "only contactors");
        assert!(row.cost.is_some_and(|cost| cost.cpu_s > 0.0));
    }
}
