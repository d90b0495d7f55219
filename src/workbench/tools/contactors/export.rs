//! Both bands of every contactor as two tables of cells.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet, bar, cells, rgb};
use crate::bench::on_finger::OnFinger;
use crate::bench::view::{Dot, EngineView, SceneView};
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::contactors::{HeatmapStyle, digits as cell_digits};
use selvedge_chart::{Axis, Chart, Row, Tone, Words};
use selvedge_textile::tactile::Band;

/// Height of a row of cells, px.
const CELL_PX: f64 = 46.0;
/// The most and the least height of the tables, px.
const HEIGHTS_PX: [f64; 2] = [160.0, 480.0];

/// The heatmaps of a display whose contactors form a grid of rows and columns.
pub(crate) fn heatmaps(
    scene: &SceneView,
    live: &EngineView,
    style: HeatmapStyle,
    (n_rows, n_columns): (usize, usize),
    origin: Origin,
) -> Exported {
    let panel = |band| panel(&live.dots, band, style, (n_rows, n_columns));
    let [least, most] = HEIGHTS_PX;
    let ends = [style.scale.least_um(), style.scale.most_um()];
    let row = Row {
        panels: Band::ALL.map(panel).to_vec(),
        height_px: (CELL_PX * n_rows as f64).clamp(least, most),
        bar: Some(bar(style.map, Axis::log("peak amplitude, µm").within(ends))),
    };
    let on_finger = live.on_finger.sentence();
    let on_finger = on_finger.map_or_else(String::new, |sentence| format!(" {sentence}."));
    let note = format!(
        "Peak amplitudes after gains and before output limits; a dash: off every textile. Row 0 is \
         at the fingertip, column 0 on its left.{on_finger}"
    );
    let origin = origin
        .by_method(live.status.method, live.status.bound_db)
        .in_ticks(std::iter::once(live.tick));
    let title = "Amplitudes of every contactor".to_owned();
    let sheet = sheet(scene, &live.dots, n_columns);
    Exported::new(title, sheet, vec![row], &note, origin)
}

fn sheet(scene: &SceneView, dots: &[Dot], n_columns: usize) -> Sheet {
    let whole = |of: &dyn Fn(usize) -> usize| -> Vec<u64> {
        (0..dots.len()).map(|index| of(index) as u64).collect()
    };
    let number = |of: &dyn Fn(&Dot) -> f64| -> Vec<f64> { dots.iter().map(of).collect() };
    let textile = |dot: &Dot| {
        let cloth = dot.cloth.and_then(|cloth| scene.cloths.get(cloth));
        cloth.map_or_else(String::new, |cloth| cloth.id.clone())
    };
    let yes = |of: &dyn Fn(&Dot) -> bool| -> Vec<u64> {
        dots.iter().map(|dot| u64::from(of(dot))).collect()
    };
    let words = |of: &dyn Fn(&Dot) -> OnFinger| -> Vec<String> {
        let label = |dot: &Dot| of(dot).label().unwrap_or("played").to_owned();
        dots.iter().map(label).collect()
    };
    Sheet::default()
        .with("contactor", whole(&|index| index))
        .with("row", whole(&|index| index / n_columns.max(1)))
        .with("column", whole(&|index| index % n_columns.max(1)))
        .with("x_mm", number(&|dot| dot.position.x_mm))
        .with("y_mm", number(&|dot| dot.position.y_mm))
        .with("textile", dots.iter().map(textile).collect::<Vec<_>>())
        .with("a40_um", number(&|dot| dot.amplitude_um[0]))
        .with("a320_um", number(&|dot| dot.amplitude_um[1]))
        .with("is_limited", yes(&|dot| dot.limiter.any()))
        .with("on_finger_40", words(&|dot| dot.on_finger[0]))
        .with("on_finger_320", words(&|dot| dot.on_finger[1]))
}

fn panel(dots: &[Dot], band: Band, style: HeatmapStyle, grid: (usize, usize)) -> Chart {
    let (_, n_columns) = grid;
    let share = |dot: &Dot| style.scale.share(dot.amplitude_um[band.index()]);
    let is_muted = |dot: &Dot| dot.on_finger[band.index()] == OnFinger::Muted;
    let is_shown = |dot: &Dot| dot.cloth.is_some() && !is_muted(dot);
    let cell = |index: usize| {
        let dot = dots.get(index).filter(|dot| is_shown(dot))?;
        Some(rgb(style.map, share(dot)))
    };
    let words = |(index, dot): (usize, &Dot)| {
        let (text, tone) = match (is_muted(dot), dot.cloth) {
            (true, _) => ("muted".to_owned(), Tone::Dark),
            (false, None) => ("–".to_owned(), Tone::Dark),
            (false, Some(_)) if style.has_numbers => (
                cell_digits(dot.amplitude_um[band.index()]),
                tone(style.map, share(dot)),
            ),
            (false, Some(_)) => return None,
        };
        let (row, column) = (index / n_columns.max(1), index % n_columns.max(1));
        Some(Words {
            at: [column as f64, row as f64],
            text,
            tone,
        })
    };
    let words = dots.iter().enumerate().filter_map(words).collect();
    cells::panel(band, grid, cell, words)
}

/// What reads on the colour of a share.
fn tone(map: ColourMap, share: f64) -> Tone {
    if map.ink(share) == eframe::egui::Color32::WHITE {
        Tone::Light
    } else {
        Tone::Dark
    }
}
