//! The drive spectrogram: the spectrum of what drives the selected contactor, over felt time.
//!
//! Its axes are those of the contact spectrogram; its colours are those of every amplitude.

use eframe::egui::{self, Sense, Ui, WidgetInfo};

use crate::bench::amplitude::AmplitudeScale;
use crate::bench::signals::drive::DriveSpectrum;
use crate::bench::signals::history::History;
use crate::kit::spectrogram;
use crate::kit::spectrogram::{ColourScale, Layout, ShownColumn, Under, Waterfall};
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::Tick;
use selvedge_foundation::quantity;

/// What the pane shows: the contactor that the newest tick of the history watched.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriveSpectrumView<'a> {
    /// The last seconds.
    pub(crate) history: &'a History,
    /// The scale of amplitudes.
    pub scale: AmplitudeScale,
    /// Its colours.
    pub map: ColourMap,
}

/// What a spectrogram is made for: history, contactor, ends of the scale as bits, colours.
type Key = (u64, Option<u32>, u64, ColourMap);

/// The columns that were computed and the texture that holds them.
#[derive(Debug, Clone, Default)]
pub(crate) struct DriveSpectrogram {
    waterfall: Waterfall<Key>,
    spectrum: DriveSpectrum,
}

impl DriveSpectrogram {
    /// Columns computed so far: it stands still while nothing moves or nobody looks.
    pub(crate) fn n_columns_computed(&self) -> u64 {
        self.waterfall.ring.n_columns_computed()
    }

    /// How often its texture was written.
    #[cfg(test)]
    pub(crate) fn n_uploads(&self) -> u64 {
        self.waterfall.image.n_uploads()
    }

    /// The columns that are shown, old to new, all of them caught up.
    pub(crate) fn shown(
        &mut self,
        ctx: &egui::Context,
        view: &DriveSpectrumView<'_>,
    ) -> Vec<ShownColumn> {
        while self.catch_up(ctx, view) {}
        self.waterfall.shown(view.history)
    }

    /// Computes what is new, as much as one frame may; says whether more is due.
    fn catch_up(&mut self, ctx: &egui::Context, view: &DriveSpectrumView<'_>) -> bool {
        let DriveSpectrumView {
            history,
            scale,
            map,
        } = *view;
        let watched = history.newest().map(|entry| entry.glimpse.watched);
        let key = (history.n_clears(), watched, scale.most_um().to_bits(), map);
        let colour = |um: f32| map.colour(scale.share(f64::from(um)));
        let spectrum = &mut self.spectrum;
        let name = (ctx, "drive spectrogram");
        self.waterfall
            .catch_up(name, (history, key), colour, |entry, rows_um| {
                // What another contactor did is not shown under this one's name.
                let glimpse = &entry.glimpse;
                if Some(glimpse.watched) == watched {
                    spectrum.rows_um(history, glimpse.watched, glimpse.tick, rows_um);
                }
            })
    }
}

/// Shows the spectrogram in the space that is left.
pub(crate) fn show(ui: &mut Ui, state: &mut DriveSpectrogram, view: &DriveSpectrumView<'_>) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    let name = "Drive spectrum of the selected contactor over time, 10 Hz to 1 kHz";
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, name));
    let Some(layout) = Layout::of(rect, 0.0) else {
        return;
    };
    state.catch_up(ui.ctx(), view);
    let Waterfall { ring, image, .. } = &state.waterfall;
    let painter = ui.painter();
    spectrogram::paint(painter, &layout, (ring, image), &colours(view));
    spectrogram::paint_carriers(painter, layout.picture);
    if view.history.newest().is_none() {
        let words = "Move over a textile: what drives the contactor is drawn here";
        spectrogram::paint_sentence(painter, layout.picture, words);
    }
    let pointer = response.hover_pos();
    if let Some(under) = pointer.and_then(|at| state.waterfall.read(&layout, at)) {
        spectrogram::tell(ui, response, &layout, || words_of(&under));
    }
}

fn colours(view: &DriveSpectrumView<'_>) -> ColourScale {
    let mark = |um: f64| Tick {
        value: view.scale.share(um),
        ..Tick::number(um)
    };
    ColourScale {
        map: view.map,
        marks: view.scale.marks_um().into_iter().map(mark).collect(),
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
        spectrogram::place_words(under)
    )
}
