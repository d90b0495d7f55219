//! A whole exploration on one page: where displays went, what vibrated under one, how strong every
//! contactor was, speed and mean levels; with a caption.
//!
//! A recording is drawn as it was felt, a path as the scene makes it felt. The same exploration
//! gives the same bytes.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::bench::error::AppError;
use crate::bench::export::origin::Origin;
use crate::bench::export::write::Kind;
use crate::bench::export::{Exported, bar, ink, rgb};
use crate::bench::recording::{Felt, Recording, file};
use crate::bench::signals::contact::ContactColumns;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, N_ROWS, row_centre_hz};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::spectrum_scale::LevelRange;
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::timeline::export::recorded;
use crate::tools::timeline::figure_map::map;
use crate::tools::timeline::figure_moment::Moment;
use selvedge_chart::{At, Axis, Chart, Ink, Raster, Row, Rule, Series, Style, Upright};
use selvedge_foundation::quantity::fixed;
use selvedge_render::array::{Accuracy, ContactInspector, DisplayFrame, Method};
use selvedge_render::scene::{ExplorationPath, LoadedScene, Pose, TICKS_PER_S};
use selvedge_render::{RenderScene, Replay, replay};
use selvedge_textile::BuildCache;
use selvedge_textile::tactile::Band;

/// Columns of a strip: a longer exploration has several ticks in each; the strongest shows.
const MOST_COLUMNS: u64 = 1200;
const COLOURS: ColourMap = ColourMap::Viridis;
/// Height of the upper row, the width that its panels share, and the most of it for the map, px.
const MAP_PX: [f64; 3] = [300.0, 690.0, 450.0];

/// What is drawn.
#[derive(Debug, Clone)]
pub struct FigureOf {
    /// The text of the scene's file and its place; `None`: the one that the recording was made in.
    pub scene: Option<(String, PathBuf)>,
    /// A recording's folder or a path file; `None`: the first recording that the scene names.
    pub exploration: Option<PathBuf>,
    /// The contactor whose spectrum is drawn, among those of all displays one after the other;
    /// `None`: the one that vibrated most.
    pub contactor: Option<usize>,
}

/// A page and what it shows.
#[derive(Debug, Clone)]
pub struct FigureFiles {
    /// The page as SVG.
    pub svg: Vec<u8>,
    /// The same as PNG.
    pub png: Vec<u8>,
    /// What to print below it.
    pub caption: String,
}

/// Draws an exploration of a scene.
///
/// # Errors
/// The scene or the exploration cannot be read or rendered; there is no such contactor.
pub fn exploration_figure(
    of: &FigureOf,
    cache: Option<&BuildCache>,
) -> Result<FigureFiles, AppError> {
    let loaded = scene_of(of, cache)?;
    let scene = RenderScene::of(&loaded);
    let found = read(of, &loaded)?;
    let was_felt = found.n_contactors() > 0;
    let recording = with_amplitudes(found, &scene)?;
    let moment = Moment::of(&recording, loaded.scene(), of.contactor)?;
    let caption = caption(&loaded, (&recording, was_felt), &moment);
    let drawn = exported((&loaded, &scene), &recording, &moment, &caption)?;
    let bytes = |kind: Kind| {
        let bytes = drawn.bytes(kind, Path::new("figure"));
        bytes.map_err(|error| AppError::Exploration(error.to_string()))
    };
    Ok(FigureFiles {
        svg: bytes(Kind::Svg)?,
        png: bytes(Kind::Png)?,
        caption: format!("{caption}\n{}\n", drawn.origin.lines().join("\n")),
    })
}

/// The scene that is given, or the one that the recording says that it was made in.
fn scene_of(of: &FigureOf, cache: Option<&BuildCache>) -> Result<LoadedScene, AppError> {
    if let Some((text, place)) = &of.scene {
        return Ok(LoadedScene::from_text(text, place, cache)?);
    }
    let folder = of.exploration.as_deref().unwrap_or_else(|| Path::new(""));
    let about =
        file::About::read(folder).map_err(|error| AppError::Exploration(error.to_string()))?;
    if let Some(scene) = about.scene_file {
        return Ok(LoadedScene::read(&scene, cache)?);
    }
    let shipped = LoadedScene::shipped()?;
    if shipped.scene().name == about.scene {
        return Ok(shipped);
    }
    let what = format!(
        "{}: no file holds its scene “{}”",
        folder.display(),
        about.scene
    );
    let mend = "give a scene first and the recording with --path";
    Err(AppError::Exploration(format!("{what}; {mend}")))
}

fn read(of: &FigureOf, loaded: &LoadedScene) -> Result<Recording, AppError> {
    let first = loaded.scene().recordings.first();
    let scene = of.scene.as_ref().map(|(_, place)| place.as_path());
    let first = first.map(|recording| recording.place(scene));
    let Some(place) = of.exploration.clone().or(first) else {
        let scene = scene.unwrap_or_else(|| Path::new(""));
        let what = format!("{} names no recording", scene.display());
        let mend = "give a recording or a path with --path";
        return Err(AppError::Exploration(format!("{what}; {mend}")));
    };
    if place.is_dir() {
        return file::read(&place).map_err(AppError::Exploration);
    }
    let path = ExplorationPath::read(&place)?;
    Ok(Recording::from_path(place, path))
}

/// The recording as it was felt; a path as it would be felt in the scene.
fn with_amplitudes(recording: Recording, scene: &RenderScene) -> Result<Recording, AppError> {
    if recording.n_contactors() > 0 {
        return Ok(recording);
    }
    let path = ExplorationPath::clone(recording.path());
    let what = Replay {
        scene,
        method: Method::Auto,
        accuracy: Accuracy::default(),
        measures_error: false,
    };
    let mut felt = Felt::default();
    replay(&what, &path, &mut || 0, &mut |_, _, frames| {
        felt.n_contactors = frames.iter().map(DisplayFrame::n_contactors).sum();
        let displays = frames.iter().map(DisplayFrame::amplitudes_um);
        displays.for_each(|um| felt.amplitudes_um.extend_from_slice(um));
        ControlFlow::Continue(())
    })?;
    let about = recording.about().clone();
    Ok(Recording::felt(about, path, &[], felt))
}

fn exported(
    (loaded, scene): (&LoadedScene, &RenderScene),
    recording: &Recording,
    moment: &Moment,
    caption: &str,
) -> Result<Exported, AppError> {
    let scene_file = loaded.scene();
    let origin = Origin::of(scene_file, &loaded.tuning(), loaded.library_reference_db());
    let [display, contactor] = moment.contactor;
    let mut origin = origin.of_contactor(contactor);
    if scene_file.displays.len() > 1 {
        let number = (display + 1).to_string();
        origin = origin.and("display", &number, &format!("of display {number}"));
    }
    let lines = recorded(recording, (scene_file, display), origin);
    let mut inspector = ContactInspector::new(scene);
    let [height_px, room_px, most_px] = MAP_PX;
    let [width_mm, height_mm] = scene_file.size_mm;
    let width = (height_px * width_mm / height_mm).min(most_px);
    let map = Chart {
        width,
        ..map(loaded, recording, moment)?
    };
    let spectrum = Chart {
        width: room_px - width,
        ..spectrum_at(&mut inspector, recording.path(), moment)
    };
    let mut rows = vec![Row {
        panels: vec![map, spectrum],
        height_px,
        bar: None,
    }];
    rows.extend(Band::ALL.map(|band| strip(recording, band, moment)));
    rows.push(spectrogram(&mut inspector, recording, moment));
    rows.extend(lines.figure.rows);
    let title = format!("{} in {}", recording.name(), scene_file.name);
    Ok(Exported::new(
        title,
        lines.sheet,
        rows,
        caption,
        lines.origin,
    ))
}

/// What vibrates under the contactor at the moment that stands out.
fn spectrum_at(inspector: &mut ContactInspector, path: &ExplorationPath, moment: &Moment) -> Chart {
    let mut levels_db = [0.0; N_ROWS];
    let mut columns = ContactColumns::default();
    let pose = moment.pose(path, &moment.first);
    columns.levels_db(inspector, moment.contactor, &pose, &mut levels_db);
    let points = levels_db.iter().enumerate();
    let points = points.map(|(row, db)| [row_centre_hz(row), f64::from(*db)]);
    let carrier = |band: Band| Rule {
        at: At::X(band.carrier_hz()),
        ink: ink(band),
        ..Rule::default()
    };
    Chart {
        title: format!("under {} at {} s", moment.name, fixed(moment.t_s(), 2)),
        x: Axis::log("frequency, Hz").within([LEAST_HZ, MOST_HZ]),
        y: Axis::linear("level, dB re 1 µm").within(LevelRange::default().ends_db()),
        rules: Band::ALL.map(carrier).to_vec(),
        series: vec![Series {
            ink: Ink::Black,
            ..Series::of("", Style::Line, points)
        }],
        ..Chart::default()
    }
}

/// A strip over the time of an exploration.
fn over_time(n_ticks: u64, raster: Raster, y: Axis, moment: &Moment) -> Chart {
    let end_s = n_ticks.saturating_sub(1) as f64 / TICKS_PER_S;
    Chart {
        x: Axis::linear("time, s").within([0.0, end_s]),
        is_x_shared: true,
        y,
        raster: Some(raster),
        rules: vec![moment.rule()],
        ..Chart::default()
    }
}

/// The strongest share of every row in every column; `of` writes those of a tick, the top row
/// first, below 0 where there is nothing.
fn raster(
    recording: &Recording,
    n_rows: usize,
    mut of: impl FnMut(u64, &Pose, &mut [f64]),
) -> Raster {
    let n_ticks = recording.path().n_ticks();
    let each = n_ticks.div_ceil(MOST_COLUMNS).max(1);
    let n_columns = usize::try_from(n_ticks.div_ceil(each)).unwrap_or(0);
    let mut strongest = vec![-1.0_f64; n_columns * n_rows];
    let mut shares = vec![0.0; n_rows];
    for (tick, pose) in recording.path().ticks() {
        of(tick, &pose, &mut shares);
        let column = usize::try_from(tick / each).unwrap_or(0);
        for (row, share) in shares.iter().enumerate() {
            let cell = &mut strongest[row * n_columns + column];
            *cell = cell.max(*share);
        }
    }
    let colour = |share: f64| (share >= 0.0).then(|| rgb(COLOURS, share));
    Raster {
        n_columns,
        cells: strongest.into_iter().map(colour).collect(),
    }
}

/// How strong every contactor was in a band.
fn strip(recording: &Recording, band: Band, moment: &Moment) -> Row {
    let scale = AmplitudeScale::default();
    let n = recording.n_contactors();
    let raster = raster(recording, n, |tick, _, shares| {
        let amplitudes_um = recording.amplitudes_um(tick).unwrap_or_default();
        for (share, um) in shares.iter_mut().zip(amplitudes_um) {
            let um = f64::from(um[band.index()]);
            *share = if um > 0.0 { scale.share(um) } else { -1.0 };
        }
    });
    let y = Axis::whole("contactor").within([-0.5, n as f64 - 0.5]);
    let chart = Chart {
        title: format!("{} Hz", fixed(band.carrier_hz(), 0)),
        ink: ink(band),
        upright: Upright::Downward,
        ..over_time(recording.path().n_ticks(), raster, y, moment)
    };
    let ends = [scale.least_um(), scale.most_um()];
    let axis = Axis::log("peak amplitude, µm").within(ends);
    Row {
        panels: vec![chart],
        height_px: 110.0,
        bar: Some(bar(COLOURS, axis)),
    }
}

/// What vibrates under the contactor, over time.
fn spectrogram(inspector: &mut ContactInspector, recording: &Recording, moment: &Moment) -> Row {
    let levels = LevelRange::default();
    let (mut columns, mut levels_db) = (ContactColumns::default(), [0.0; N_ROWS]);
    let raster = raster(recording, N_ROWS, |_, first, shares| {
        let pose = moment.pose(recording.path(), first);
        columns.levels_db(inspector, moment.contactor, &pose, &mut levels_db);
        for (share, db) in shares.iter_mut().zip(levels_db.iter().rev()) {
            let db = f64::from(*db);
            *share = if db.is_finite() {
                levels.share(db)
            } else {
                -1.0
            };
        }
    });
    let y = Axis::log("frequency, Hz").within([LEAST_HZ, MOST_HZ]);
    Row {
        panels: vec![Chart {
            title: format!("under {}", moment.name),
            ..over_time(recording.path().n_ticks(), raster, y, moment)
        }],
        height_px: 130.0,
        bar: Some(bar(
            COLOURS,
            Axis::linear("level, dB re 1 µm").within(levels.ends_db()),
        )),
    }
}

fn caption(
    loaded: &LoadedScene,
    (recording, was_felt): (&Recording, bool),
    moment: &Moment,
) -> String {
    let (name, scene) = (recording.name(), &loaded.scene().name);
    let (contactor, t_s) = (&moment.name, fixed(moment.t_s(), 2));
    let end_s = fixed(recording.path().duration_s(), 2);
    let amplitudes = if was_felt {
        "as they were recorded"
    } else {
        "as the scene renders the path"
    };
    let nth = moment.contactor[0] + 1;
    let (ways, all, whose) = if loaded.scene().displays.len() > 1 {
        let whose = [format!("display {nth}'s"), "its".to_owned()];
        (
            ["the displays' ways", "their"],
            ", displays one after the other,",
            whose,
        )
    } else {
        let whose = ["the display's", "the"].map(str::to_owned);
        (["the display's way", "its"], "", whose)
    };
    let ([way, their], [whose, its]) = (ways, whose);
    format!(
        "Exploration \"{name}\" of the scene \"{scene}\", {end_s} s. Above, left: {way} over the \
         textiles, with {their} contactors at {t_s} s, when most was felt (dashed below); right: \
         spectrum of the surface under {contactor} at that moment, before filters and gains. \
         Below, over time: peak amplitudes of every contactor{all} at 40 Hz and 320 Hz \
         {amplitudes}, after gains and before output limits, white where silent; spectrum under \
         {contactor}; speed of {whose} middle; mean level of {its} contactors that vibrate."
    )
}

#[cfg(test)]
mod tests;
