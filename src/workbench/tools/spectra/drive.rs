//! The drive spectrogram: the spectrum of what drives the selected contactor, over felt time.
//!
//! Its axes are those of the contact spectrogram; its colours are those of every amplitude.

use eframe::egui::{self, Sense, Ui, WidgetInfo};

use crate::bench::Bench;
use crate::bench::export::{Exported, NO_CONTACTOR, NOTHING_FELT, bar, ink, rgb};
use crate::bench::pane::Pane;
use crate::bench::signals::drive::DriveSpectrum as Spectrum;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::pane::framed;
use crate::kit::pane::paint_sentence;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::Tick;
use crate::tools::spectra::waterfall;
use crate::tools::spectra::waterfall::{ColourScale, Layout, Under, Waterfall};
use crate::tools::spectra::{HEIGHT_PX, picture, sheet, show_contactor};
use selvedge_chart::{At, Axis, Chart, Extent, Row, Rule};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// What a spectrogram is made for: history, contactor, ends of the scale as bits, colours.
type Key = (u64, Option<u32>, u64, ColourMap);

/// The spectrum that drives the contactor which the newest tick watched: the columns that were
/// computed and the texture that holds them.
#[derive(Debug, Default)]
pub(crate) struct DriveSpectrum {
    waterfall: Waterfall<Key>,
    spectrum: Spectrum,
}

impl DriveSpectrum {
    /// Columns computed so far: it stands still while nothing moves or nobody looks.
    pub(crate) fn n_columns_computed(&self) -> u64 {
        self.waterfall.ring.n_columns_computed()
    }

    /// How often its texture was written.
    #[cfg(test)]
    pub(crate) fn n_uploads(&self) -> u64 {
        self.waterfall.image.n_uploads()
    }

    /// Computes what is new, as much as one frame may; says whether more is due.
    fn catch_up(&mut self, bench: &Bench) -> bool {
        let (history, scale) = (&bench.past.history, bench.selection.scale);
        let map = bench.settings.preferences.colour_map;
        let watched = history.newest().map(|entry| entry.tick_sample.watched);
        let key = (history.n_clears(), watched, scale.most_um().to_bits(), map);
        let colour = |um: f32| map.colour(scale.share(f64::from(um)));
        let spectrum = &mut self.spectrum;
        let name = (&bench.ctx, "drive spectrogram");
        self.waterfall
            .catch_up(name, (history, key), colour, |entry, rows_um| {
                // What another contactor did is not shown under this one's name.
                let tick_sample = &entry.tick_sample;
                if Some(tick_sample.watched) == watched {
                    spectrum.rows_um(history, tick_sample.watched, tick_sample.tick, rows_um);
                }
            })
    }

    /// Shows the spectrogram in the space that is left.
    fn show(&mut self, ui: &mut Ui, bench: &Bench) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let name = "Drive spectrum of the selected contactor over time, 10 Hz to 1 kHz";
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, name));
        let Some(layout) = Layout::of(rect, 0.0) else {
            return;
        };
        self.catch_up(bench);
        let Waterfall { ring, image, .. } = &self.waterfall;
        let painter = ui.painter();
        let colours = colours(bench.selection.scale, bench.settings.preferences.colour_map);
        waterfall::paint(painter, &layout, (ring, image), &colours);
        waterfall::paint_carriers(painter, layout.picture);
        if bench.past.history.newest().is_none() {
            let words = "Move over a textile: what drives the contactor is drawn here";
            paint_sentence(painter, layout.picture, words);
        }
        let pointer = response.hover_pos();
        if let Some(under) = pointer.and_then(|at| self.waterfall.read(&layout, at)) {
            waterfall::describe(ui, response, &layout, || words_of(&under));
        }
    }
}

impl Tool for DriveSpectrum {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::DriveSpectrum]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 8, |ui| self.show(ui, context.bench));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        show_contactor(ui, context.bench);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let contactor = bench.selection.contactor.ok_or(NO_CONTACTOR)?;
        while self.catch_up(bench) {}
        let columns = self.waterfall.shown(&bench.past.history);
        let mut amplitudes_um = columns.iter().flat_map(|column| column.rows);
        if !amplitudes_um.any(|um| um > 0.0) {
            return Err(NOTHING_FELT);
        }
        let (scale, map) = (bench.selection.scale, bench.settings.preferences.colour_map);
        let carrier = |band: Band| Rule {
            at: At::Y(band.carrier_hz()),
            ink: ink(band),
            extent: Extent::Edge,
            ..Rule::default()
        };
        let picture = Chart {
            rules: Band::ALL.map(carrier).to_vec(),
            ..picture(&columns, |um| rgb(map, scale.share(f64::from(um))))
        };
        let ends = [scale.least_um(), scale.most_um()];
        let row = Row {
            panels: vec![picture],
            height_px: HEIGHT_PX,
            bar: Some(bar(map, Axis::log("peak amplitude, µm").within(ends))),
        };
        let title = format!("Spectrum that drives contactor {contactor}");
        let note = "Amplitude spectrum (peak) of the drive, after gains and before output limits: \
                    100 ms under a Hann window whose gain is compensated; the largest in rows 4.9 \
                    % of the frequency wide. Marks on the right: 40 and 320 Hz.";
        let ticks = columns.iter().map(|column| column.tick);
        let origin = bench.rendered_origin();
        let origin = origin.of_contactor(contactor).in_ticks(ticks);
        let sheet = sheet(&columns, "amplitude_um");
        Ok(Exported::new(title, sheet, vec![row], note, origin))
    }
}

fn colours(scale: AmplitudeScale, map: ColourMap) -> ColourScale {
    let mark = |um: f64| Tick {
        value: scale.share(um),
        ..Tick::number(um)
    };
    ColourScale {
        map,
        marks: scale.marks_um().into_iter().map(mark).collect(),
        unit: "µm",
    }
}

fn words_of(under: &Under) -> String {
    let amplitude = match under.value {
        None => "nothing was felt".to_owned(),
        Some(um) => quantity::with_unit(f64::from(um), 2, "µm"),
    };
    format!(
        "{}\n{amplitude}\nPeak amplitude, after gains and before output limits: 100 ms of the \
         drive under a Hann window, whose gain is compensated",
        waterfall::place_words(under)
    )
}
