//! Signals of the contactor that is looked at closer: the spectrum that arrives, the spectrum and
//! the waveform that drive, and the spatial spectra under it.

pub(crate) mod contact;
pub(crate) mod drive;
pub(crate) mod spatial;
pub(crate) mod spatial_chart;
#[cfg(test)]
mod tests;
pub(crate) mod waterfall;
pub(crate) mod wave;

use eframe::egui::{Align2, Color32, Rect, Ui, pos2};

use crate::bench::Bench;
use crate::bench::export::{Exported, Origin, Sheet, bar, rgb};
use crate::bench::on_finger::OnFinger;
use crate::bench::signals::ring::N_COLUMNS;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, N_ROWS, row_at, row_centre_hz};
use crate::kit::spectrum_scale::{EVENLY, LevelRange};
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::level_bar;
use crate::kit::widgets::text::{paint_quiet, quiet, toggle};
use crate::tools::spectra::waterfall::ShownColumn;
use selvedge_chart::{Axis, Chart, ColourBar, Raster, Row};
use selvedge_render::scene::TICKS_PER_S;

/// From the bar of colours to the right end of its unit, points.
const UNIT: f32 = 34.0;
/// Height of a spectrogram on paper, px.
const HEIGHT_PX: f64 = 300.0;

/// The contactor that is looked at closer; without one, a number that no contactor has.
fn contactor(bench: &Bench) -> usize {
    bench.selection.contactor.unwrap_or(usize::MAX)
}

/// What stands over each of the panes: whose signals these are.
fn show_contactor(ui: &mut Ui, bench: &Bench) {
    let words = bench.selection.contactor.map_or_else(
        || "no contactor chosen".to_owned(),
        |contactor| format!("contactor {contactor}"),
    );
    let label = ui.label(quiet(words));
    label.on_hover_text("Click a cell of the heatmaps to choose another contactor");
}

/// What the finger gets of both bands of the contactor.
fn on_finger(bench: &Bench) -> [OnFinger; 2] {
    let live = &bench.live;
    let dot = live.dots.get(contactor(bench));
    dot.map_or([live.on_finger; 2], |dot| dot.on_finger)
}

/// What stands over a spectrogram: whose it is, and how its frequencies lie.
fn show_spectrogram_corner(ui: &mut Ui, bench: &mut Bench) {
    let is_linear = bench.selection.spectrum.is_linear;
    if toggle(ui, "linear", is_linear, EVENLY) {
        bench.selection.spectrum.is_linear = !is_linear;
    }
    show_contactor(ui, bench);
}

/// The bar of colours beside a spectrogram.
fn show_levels(ui: &Ui, bar: Rect, bench: &mut Bench) {
    let map = bench.settings.preferences.colour_map;
    level_bar::show(ui, bar, map, &mut bench.selection.spectrum.levels);
    let unit_at = pos2(bar.right() + UNIT, bar.top() - 6.0);
    paint_quiet(ui.painter(), unit_at, Align2::RIGHT_BOTTOM, "dB re 1 µm");
}

/// The colours of a spectrogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Colours {
    map: ColourMap,
    levels: LevelRange,
}

impl Colours {
    /// Those in force in every spectrogram.
    fn in_force(bench: &Bench) -> Self {
        Self {
            map: bench.settings.preferences.colour_map,
            levels: bench.selection.spectrum.levels,
        }
    }

    /// The colour of a level, dB re 1 µm.
    pub(crate) fn of(&self, level_db: f64) -> Color32 {
        self.map.colour(self.levels.share(level_db))
    }

    /// The same on paper.
    fn on_paper(&self, level_db: f64) -> [u8; 3] {
        rgb(self.map, self.levels.share(level_db))
    }

    /// Their bar on paper.
    fn bar(&self) -> ColourBar {
        let levels = Axis::linear("level, dB re 1 µm").within(self.levels.ends_db());
        bar(self.map, levels)
    }
}

/// A spectrogram that is exported: its panels with the bar of their colours, and every value.
fn exported(
    columns: &[ShownColumn],
    value: &'static str,
    (panels, bar): (Vec<Chart>, ColourBar),
    (title, note): (String, &str),
    origin: Origin,
) -> Exported {
    let row = Row {
        panels,
        height_px: HEIGHT_PX,
        bar: Some(bar),
    };
    let origin = origin.in_ticks(columns.iter().map(|column| column.tick));
    Exported::new(title, sheet(columns, value), vec![row], note, origin)
}

/// One row a cell, old to new and low to high.
fn sheet(columns: &[ShownColumn], value: &'static str) -> Sheet {
    let each = |of: &dyn Fn(&ShownColumn) -> f64| -> Vec<f64> {
        let each_row = |column| std::iter::repeat_n(of(column), N_ROWS);
        columns.iter().flat_map(each_row).collect()
    };
    let ticks = columns.iter().map(|column| column.tick);
    let ticks: Vec<u64> = ticks.flat_map(|tick| [tick; N_ROWS]).collect();
    let frequencies = (0..columns.len()).flat_map(|_| (0..N_ROWS).map(row_centre_hz));
    let values = columns.iter().flat_map(|column| column.rows);
    Sheet::default()
        .with("tick", ticks)
        .with("t_s", each(&|column| -(column.ago as f64) / TICKS_PER_S))
        .with("frequency_hz", frequencies.collect::<Vec<f64>>())
        .with(value, values.collect::<Vec<f32>>())
}

fn frequencies(is_linear: bool) -> Axis {
    let axis = if is_linear {
        Axis::linear("frequency, Hz")
    } else {
        Axis::log("frequency, Hz")
    };
    axis.within([LEAST_HZ, MOST_HZ])
}

/// A spectrogram on paper with its axes, the newest column at its right edge.
fn picture(columns: &[ShownColumn], is_linear: bool, colour: impl Fn(f32) -> [u8; 3]) -> Chart {
    let row = |y: usize| {
        if is_linear {
            let share = (N_ROWS as f64 - y as f64 - 0.5) / N_ROWS as f64;
            row_at(LEAST_HZ + share * (MOST_HZ - LEAST_HZ))
        } else {
            N_ROWS - 1 - y
        }
    };
    let mut cells = vec![None; N_COLUMNS * N_ROWS];
    for column in columns {
        let from_right = usize::try_from(column.ago).unwrap_or(usize::MAX);
        let Some(x) = N_COLUMNS.checked_sub(from_right.saturating_add(1)) else {
            continue;
        };
        for y in 0..N_ROWS {
            let value = column.rows[row(y)];
            cells[y * N_COLUMNS + x] = (!value.is_nan()).then(|| colour(value));
        }
    }
    let shown_s = N_COLUMNS as f64 / TICKS_PER_S;
    let felt = "felt time before the newest tick, s";
    Chart {
        x: Axis::linear(felt).within([-shown_s, 0.0]),
        y: frequencies(is_linear),
        raster: Some(Raster {
            n_columns: N_COLUMNS,
            cells,
        }),
        ..Chart::default()
    }
}
