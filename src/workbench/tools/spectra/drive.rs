//! The drive spectrogram: the spectrum of what drives the selected contactor, over felt time.
//!
//! Its axes and colours are those of the contact spectrogram.

use eframe::egui::{self, Sense, Ui, WidgetInfo};

use crate::bench::Bench;
use crate::bench::export::{Exported, NO_CONTACTOR, NOTHING_FELT, ink};
use crate::bench::pane::Pane;
use crate::bench::signals::drive::DriveSpectrum as Spectrum;
use crate::bench::signals::history::Entry;
use crate::bench::signals::rows::Rows;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::pane::paint_sentence;
use crate::tools::spectra::waterfall::{Layout, Under, Waterfall};
use crate::tools::spectra::{
    Colours, exported, on_finger, picture, show_levels, show_spectrogram_corner, waterfall,
};
use selvedge_chart::{At, Chart, Extent, Rule};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// What a spectrogram is made for: history, contactor.
type Key = (u64, Option<u32>);

/// The spectrum that drives the contactor which the newest tick watched: the columns that were
/// computed and the texture that holds them.
#[derive(Default)]
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
        let history = &bench.past.history;
        let watched = history.newest().map(|entry| entry.tick_sample.watched);
        let key = (history.n_clears, watched);
        let spectrum = &mut self.spectrum;
        let name = (&bench.ctx, "drive spectrogram");
        let fill = |entry: &Entry, rows_um: &mut Rows| {
            // What another contactor did is not shown under this one's name.
            let tick_sample = &entry.tick_sample;
            if Some(tick_sample.watched) == watched {
                spectrum.rows_um(history, tick_sample.watched, tick_sample.tick, rows_um);
                let silent = rows_um.iter_mut().filter(|um| **um <= 0.0);
                silent.for_each(|um| *um = f32::NAN);
            }
        };
        let colours = (Colours::in_force(bench), level_of as fn(f32) -> f64);
        self.waterfall.catch_up(name, (history, key), colours, fill)
    }

    /// Shows the spectrogram in the space that is left.
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let name = "Drive spectrum of the selected contactor over time, 10 Hz to 1 kHz";
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, name));
        let axis = waterfall::frequency_axis(bench.selection.spectrum.is_linear);
        let Some(layout) = Layout::of(rect, 0.0, axis) else {
            return;
        };
        self.catch_up(bench);
        let Waterfall { ring, image, .. } = &self.waterfall;
        let painter = ui.painter();
        waterfall::paint(painter, &layout, (ring, image), on_finger(bench));
        waterfall::paint_carriers(painter, &layout);
        show_levels(ui, layout.bar, bench);
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
        show_spectrogram_corner(ui, context.bench);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let contactor = bench.selection.contactor.ok_or(NO_CONTACTOR)?;
        while self.catch_up(bench) {}
        let columns = self.waterfall.shown(&bench.past.history);
        if columns.is_empty() {
            return Err(NOTHING_FELT);
        }
        let (colours, is_linear) = (Colours::in_force(bench), bench.selection.spectrum.is_linear);
        let carrier = |band: Band| Rule {
            at: At::Y(band.carrier_hz()),
            ink: ink(band),
            extent: Extent::Edge,
            ..Rule::default()
        };
        let picture = Chart {
            rules: Band::ALL.map(carrier).to_vec(),
            ..picture(&columns, is_linear, |um| colours.on_paper(level_of(um)))
        };
        let title = format!("Spectrum that drives contactor {contactor}");
        let note = "Amplitude spectrum (peak) of the drive, after gains and before output limits: \
                    100 ms under a Hann window whose gain is compensated; the largest in rows 4.9 \
                    % of the frequency wide; white where nothing drove it. Marks on the right: 40 \
                    and 320 Hz.";
        let origin = bench.rendered_origin().of_contactor(contactor);
        let panels = (vec![picture], colours.bar());
        Ok(exported(
            &columns,
            "amplitude_um",
            panels,
            (title, note),
            origin,
        ))
    }
}

/// The level of an amplitude in µm, dB re 1 µm.
fn level_of(amplitude_um: f32) -> f64 {
    quantity::level_db(amplitude_um.into())
}

fn words_of(under: &Under) -> String {
    let amplitude = match under.value {
        None => "nothing drives it".to_owned(),
        Some(um) => {
            let level = quantity::with_unit(level_of(um), 1, "dB re 1 µm");
            format!("{}, {level}", quantity::with_unit(f64::from(um), 2, "µm"))
        }
    };
    format!(
        "{}\n{amplitude}\nPeak amplitude, after gains and before output limits: 100 ms of the \
         drive under a Hann window, whose gain is compensated",
        waterfall::place_words(under)
    )
}
