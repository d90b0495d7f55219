//! The contact spectrogram: the vibration that arrives at the selected contactor, over felt time.
//!
//! What arrives are the surface's heights as the contactor's motion turns them into vibration,
//! before filters and gains. The two filters stand beside it on the same frequency axis.

use eframe::egui::{
    self, Align2, Color32, Painter, Pos2, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
};

use crate::bench::Bench;
use crate::bench::export::{Exported, NO_CONTACTOR, NOTHING_FELT, ink};
use crate::bench::pane::Pane;
use crate::bench::signals::contact::ContactColumns;
use crate::bench::signals::history::Entry;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, Rows};
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::pane::paint_sentence;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_outer_ticks};
use crate::kit::widgets::text::paint_quiet;
use crate::tools::spectra::waterfall::{Layout, Under, Waterfall};
use crate::tools::spectra::{
    Colours, contactor, exported, frequencies, on_finger, picture, show_levels,
    show_spectrogram_corner, waterfall,
};
use selvedge_chart as chart;
use selvedge_chart::{Chart, Series, Style, Upright};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, Filters};

/// Width of the filters' strip, points.
const STRIP: f32 = 40.0;
/// The same where the pane is narrow.
const NARROW_STRIP: f32 = 28.0;
/// Steps of a filter's exported curve.
const N_STEPS: u8 = 96;

/// What a spectrogram is made for: history, scene, contactor. Columns stay as they were felt when a
/// textile is moved afterwards; gains and filters come after what is shown.
type Key = (u64, u64, usize);

/// The spectrum that arrives: the columns that were computed and the texture that holds them.
#[derive(Default)]
pub(crate) struct ContactSpectrum {
    waterfall: Waterfall<Key>,
    columns: ContactColumns,
}

impl ContactSpectrum {
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
    fn catch_up(&mut self, bench: &mut Bench) -> bool {
        let (contactor, colours) = (contactor(bench), Colours::in_force(bench));
        let display = bench.display();
        let (history, inspection) = (&bench.past.history, &mut bench.inspection);
        let key = (history.n_clears, inspection.n_scenes, contactor);
        let (columns, inspector) = (&mut self.columns, &mut inspection.inspector);
        let name = (&bench.ctx, "contact spectrogram");
        let fill = |entry: &Entry, levels_db: &mut Rows| {
            columns.levels_db(
                inspector,
                [display, contactor],
                &entry.tick_sample.pose,
                levels_db,
            );
            // Where nothing arrives is a gap, not a very low level.
            let nothing = levels_db.iter_mut().filter(|level| level.is_infinite());
            nothing.for_each(|level| *level = f32::NAN);
        };
        self.waterfall
            .catch_up(name, (history, key), (colours, f64::from), fill)
    }

    /// Shows the spectrogram in the space that is left.
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let name = format!(
            "Contact spectrum of contactor {} over time, 10 Hz to 1 kHz",
            contactor(bench)
        );
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, &name));
        let strip = if rect.width() < 340.0 {
            NARROW_STRIP
        } else {
            STRIP
        };
        let axis = waterfall::frequency_axis(bench.selection.spectrum.is_linear);
        let Some(layout) = Layout::of(rect, strip, axis) else {
            return;
        };
        self.catch_up(bench);
        let Waterfall { ring, image, .. } = &self.waterfall;
        let painter = ui.painter();
        waterfall::paint(painter, &layout, (ring, image), on_finger(bench));
        if bench.past.history.newest().is_none() {
            let words = "Move over a textile: what arrives at the contactor is drawn here";
            paint_sentence(painter, layout.picture, words);
        }
        show_levels(ui, layout.bar, bench);
        let filters = &bench.document.scene().filters;
        paint_filters(painter, &layout, filters);
        let pointer = response.hover_pos();
        if let Some(at) = pointer.filter(|at| layout.strip.contains(*at)) {
            response.on_hover_text_at_pointer(filter_words(&layout, at, filters));
        } else if let Some(under) = pointer.and_then(|at| self.waterfall.read(&layout, at)) {
            waterfall::describe(ui, response, &layout, || words_of(&under));
        }
    }
}

impl Tool for ContactSpectrum {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::ContactSpectrum]
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
        let picture = Chart {
            width: 9.0,
            ..picture(&columns, is_linear, |level_db| {
                colours.on_paper(level_db.into())
            })
        };
        let filters = filters(&bench.document.scene().filters, is_linear);
        let title = format!("Vibration that arrives at contactor {contactor}");
        let note = "Peak amplitude at the surface, before filters and gains, in rows 4.9 % of the \
                    frequency wide; each column is a tick of 25 ms, white where nothing arrived. \
                    Right: amplitude gain of the filters.";
        let origin = bench.origin().of_contactor(contactor);
        let panels = (vec![picture, filters], colours.bar());
        Ok(exported(
            &columns,
            "level_db",
            panels,
            (title, note),
            origin,
        ))
    }
}

fn words_of(under: &Under) -> String {
    let level = match under.value {
        None => "nothing arrives".to_owned(),
        Some(level_db) => quantity::with_unit(f64::from(level_db), 1, "dB re 1 µm"),
    };
    format!(
        "{}\n{level}\nPeak amplitude of a row 4.9 % of the frequency wide, at the surface: before \
         filters and gains. The power of each bin of the spatial spectrum is spread evenly over \
         its width, Δf = speed × 0.23 cycles/mm.",
        waterfall::place_words(under)
    )
}

fn filter_words(layout: &Layout, at: Pos2, filters: &Filters) -> String {
    let frequency_hz = (layout.frequencies).value_at_y(layout.strip.y_range(), at.y);
    let gain = |band| quantity::fixed(filters.gain(band, frequency_hz), 2);
    format!(
        "Filters at {}\n40 Hz  {}\n320 Hz  {}\namplitude gain",
        quantity::with_unit(frequency_hz, 0, "Hz"),
        gain(Band::Low),
        gain(Band::High)
    )
}

/// Draws both filters upright: gain 0…1 to the right, frequency as in the picture beside.
fn paint_filters(painter: &Painter, layout: &Layout, filters: &Filters) {
    let palette = Palette::of(painter.ctx().theme());
    let (strip, frequencies) = (layout.strip, layout.frequencies);
    painter.rect_filled(strip, 0, palette.floor);
    let gains = Axis::linear(0.0, 1.0);
    let clip = painter.with_clip_rect(strip.expand(1.0));
    for band in Band::ALL {
        let ink = palette.band(band);
        let carrier_y = frequencies.y(strip.y_range(), band.carrier_hz());
        let carrier_y = painter.round_to_pixel_center(carrier_y);
        clip.hline(strip.x_range(), carrier_y, Stroke::new(1.0, faint(ink)));
        let points = (0..=96_u8).map(|i| {
            let frequency_hz = frequencies.value(f64::from(i) / 96.0);
            let gain = filters.gain(band, frequency_hz);
            pos2(
                gains.x(strip.x_range(), gain),
                frequencies.y(strip.y_range(), frequency_hz),
            )
        });
        clip.add(Shape::line(points.collect(), Stroke::new(1.5, ink)));
    }
    let most = [Tick::number(1.0)];
    paint_outer_ticks(painter, strip, (&gains, Side::Bottom), &most);
    let unit_at = pos2(strip.center().x, strip.top() - 6.0);
    if strip.width() >= STRIP {
        paint_quiet(painter, unit_at, Align2::CENTER_BOTTOM, "gain");
    }
}

fn faint(ink: Color32) -> Color32 {
    ink.gamma_multiply(0.4)
}

/// Both filters upright on the frequency axis of the exported picture.
fn filters(filters: &Filters, is_linear: bool) -> Chart {
    let curve = |band: Band| {
        let point = |i: u8| {
            let share = f64::from(i) / f64::from(N_STEPS);
            let frequency_hz = LEAST_HZ * (MOST_HZ / LEAST_HZ).powf(share);
            [filters.gain(band, frequency_hz), frequency_hz]
        };
        Series {
            points: (0..=N_STEPS).map(point).collect(),
            style: Style::Line,
            ink: ink(band),
            ..Series::default()
        }
    };
    Chart {
        x: chart::Axis::whole("gain").within([0.0, 1.0]),
        y: frequencies(is_linear),
        upright: Upright::Shared,
        series: Band::ALL.map(curve).to_vec(),
        ..Chart::default()
    }
}
