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

use eframe::egui::{RichText, Ui};

use crate::bench::Bench;
use crate::bench::export::Sheet;
use crate::bench::signals::ring::N_COLUMNS;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, N_ROWS, row_centre_hz};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::tools::spectra::waterfall::ShownColumn;
use selvedge_chart::{Axis, Chart, Raster};
use selvedge_render::scene::TICKS_PER_S;

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
    let ink = Palette::in_ui(ui).dim;
    let label = ui.label(RichText::new(words).font(theme::small()).color(ink));
    label.on_hover_text("Click a cell of the heatmaps to choose another contactor");
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

fn frequencies() -> Axis {
    Axis::log("frequency, Hz").within([LEAST_HZ, MOST_HZ])
}

/// A spectrogram on paper with its axes, the newest column at its right edge.
fn picture(columns: &[ShownColumn], colour: impl Fn(f32) -> [u8; 3]) -> Chart {
    let mut cells = vec![None; N_COLUMNS * N_ROWS];
    for column in columns {
        let from_right = usize::try_from(column.ago).unwrap_or(usize::MAX);
        let Some(x) = N_COLUMNS.checked_sub(from_right.saturating_add(1)) else {
            continue;
        };
        for (y, value) in column.rows.iter().rev().enumerate() {
            cells[y * N_COLUMNS + x] = (!value.is_nan()).then(|| colour(*value));
        }
    }
    let shown_s = N_COLUMNS as f64 / TICKS_PER_S;
    let felt = "felt time before the newest tick, s";
    Chart {
        x: Axis::linear(felt).within([-shown_s, 0.0]),
        y: frequencies(),
        raster: Some(Raster {
            n_columns: N_COLUMNS,
            cells,
        }),
        ..Chart::default()
    }
}
