//! Signals of the contactor that is looked at closer: the spectrum that arrives, the spectrum and
//! the waveform that drive, and the spatial spectra under it.

pub(crate) mod contact;
pub(crate) mod drive;
pub(crate) mod export;
pub(crate) mod spatial;
pub(crate) mod spatial_plot;
#[cfg(test)]
mod tests;
pub(crate) mod wave;

use eframe::egui::{RichText, Ui};

use crate::bench::Bench;
use crate::kit::theme;
use crate::kit::theme::Palette;

/// The contactor that is looked at closer; without one, a number that no contactor has.
fn contactor(bench: &Bench) -> usize {
    bench.workspace.contactor.unwrap_or(usize::MAX)
}

/// What stands over each of the panes: whose signals these are.
fn show_contactor(ui: &mut Ui, bench: &Bench) {
    let words = bench.workspace.contactor.map_or_else(
        || "no contactor chosen".to_owned(),
        |contactor| format!("contactor {contactor}"),
    );
    let ink = Palette::in_ui(ui).dim;
    let label = ui.label(RichText::new(words).font(theme::small()).color(ink));
    label.on_hover_text("Click a cell of the heatmaps to choose another contactor");
}
