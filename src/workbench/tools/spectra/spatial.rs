//! The spatial spectra under the selected contactor: power density over wavenumber, with the bins
//! lit that sound at its speed.

use eframe::egui::{Align2, Painter, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2};

use crate::bench::Bench;
use crate::bench::export::{Exported, NO_CONTACTOR};
use crate::bench::pane::Pane;
use crate::bench::signals::spatial::{SpatialCurve, SpatialView, density_db, wavenumber_per_mm};
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::pane::paint_sentence;
use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::kit::plot::layers::colour;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::paint_quiet;
use crate::tools::spectra::spatial_chart::{UNLIT, chart, columns, line, with_frequencies};
use crate::tools::spectra::{contactor, show_contactor};
use selvedge_chart::{Chart, Style, Weight};
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::quantity;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, N_BINS};

/// What a view is made for: scene, contactor, place, turn, motion.
type Key = (u64, [usize; 2], [f64; 6]);

/// Nothing is computed for a pane without room for anything, points.
const SMALLEST: f32 = 48.0;

/// The spectra as they were last computed.
#[derive(Debug, Default)]
pub(crate) struct SpatialSpectra {
    key: Option<Key>,
    view: Option<SpatialView>,
    n_views_computed: u64,
}

impl SpatialSpectra {
    /// Views computed so far: it stands still while nothing moves or nobody looks.
    #[cfg(test)]
    pub(crate) fn n_views_computed(&self) -> u64 {
        self.n_views_computed
    }

    fn catch_up(&mut self, bench: &mut Bench) {
        let [display, contactor] = [bench.display(), contactor(bench)];
        let pose = &bench.live.pose;
        let motion = [
            pose.position.x_mm,
            pose.position.y_mm,
            pose.angle_deg,
            pose.velocity.x_mm_per_s,
            pose.velocity.y_mm_per_s,
            pose.angular_rad_per_s,
        ];
        let inspection = &mut bench.inspection;
        let key = (inspection.n_edits, [display, contactor], motion);
        if self.key == Some(key) {
            return;
        }
        self.key = Some(key);
        self.n_views_computed += 1;
        let trace = inspection.inspector.trace(display, contactor, pose);
        self.view = trace.and_then(|trace| {
            let textile = trace.touch.as_ref()?.textile;
            let placed = inspection.scene.textiles.get(textile)?;
            SpatialView::of(&trace, &placed.surface)
        });
    }

    /// Shows the spectra in the space that is left.
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench) {
        let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        if rect.size().min_elem() < SMALLEST {
            return;
        }
        self.catch_up(bench);
        let Some(view) = &self.view else {
            let words =
                "The selected contactor is off every textile: its spectra show when it is on one";
            paint_sentence(ui.painter(), rect, words);
            return;
        };
        let setting = Setting {
            name: "Spatial spectra of a contactor",
            hover: false,
            has_legend: false,
            ..Setting::default()
        };
        let Some(shown) = plot::show(ui, rect, &with_frequencies(view), &setting) else {
            return;
        };
        let name = format!("Spatial spectra under contactor {}", contactor(bench));
        let response = &shown.response;
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, &name));
        paint_legend(ui.painter(), shown.area(), view);
        if let Some(at) = shown.pointer().filter(|_| !response.dragged()) {
            let k = bin_of(shown.values_at(at)[0]);
            let x = shown.at([wavenumber_per_mm(k), 0.0]).x;
            let stroke = Stroke::new(1.0, Palette::in_ui(ui).selection.gamma_multiply(0.35));
            ui.painter().vline(x, shown.area().y_range(), stroke);
            shown.response.on_hover_text_at_pointer(words_of(view, k));
        }
    }
}

impl Tool for SpatialSpectra {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::SpatialSpectra]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 8, |ui| self.show(ui, context.bench));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        show_contactor(ui, context.bench);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let contactor = bench.selection.contactor.ok_or(NO_CONTACTOR)?;
        self.catch_up(bench);
        let view = self.view.as_ref().ok_or(
            "There is nothing to export: the chosen contactor is off every textile; move over one",
        )?;
        Ok(exported(view, contactor, bench))
    }
}

/// Names the curves, and lights those that are felt.
fn paint_legend(painter: &Painter, area: Rect, view: &SpatialView) {
    let palette = Palette::of(painter.ctx().theme());
    let right = area.right() - 6.0;
    for (y, curve) in (0_u8..)
        .map(|nth| area.top() + 10.0 + 13.0 * f32::from(nth))
        .zip(&view.curves)
    {
        let direction = curve.direction;
        let line = line(direction, Vec::new(), Weight::Thin);
        let ink = colour(line.ink, palette);
        let at = pos2(right - 28.0, y);
        paint_quiet(painter, at, Align2::RIGHT_CENTER, direction.label());
        let sample = [pos2(right - 22.0, y), pos2(right, y)];
        let stroke = match view.felt_in(direction) {
            Some(_) => Stroke::new(2.0, ink),
            None => Stroke::new(1.0, ink.gamma_multiply(1.0 - UNLIT)),
        };
        if line.style == Style::Dashed {
            painter.extend(Shape::dashed_line(&sample, stroke, 5.0, 4.0));
        } else {
            painter.line_segment(sample, stroke);
        }
    }
}

/// The bin nearest to a wavenumber.
fn bin_of(wavenumber_per_mm: f64) -> usize {
    to_index((wavenumber_per_mm / BIN_SPACING_PER_MM).round()).clamp(1, N_BINS)
}

fn words_of(view: &SpatialView, k: usize) -> String {
    let wavenumber = quantity::with_unit(wavenumber_per_mm(k), 2, "cycles/mm");
    let curves = view.curves.iter().map(|curve| curve_words(view, curve, k));
    let curves: Vec<String> = curves.collect();
    format!(
        "{wavenumber}, bin {k}\n{}\nOne-sided power density re 1 µm² per cycle/mm: the power of a \
         bin over 0.23 cycles/mm",
        curves.join("\n")
    )
}

fn curve_words(view: &SpatialView, curve: &SpatialCurve, k: usize) -> String {
    let density = curve.density_um2_mm.get(k - 1).copied().unwrap_or(0.0);
    let level = quantity::with_unit(density_db(density), 1, "dB");
    let (name, point) = (curve.direction.label(), curve.point);
    let source = if curve.taken_from == curve.direction {
        String::new()
    } else {
        format!(", taken from {}", curve.taken_from.label())
    };
    let sounds = view.felt_in(curve.direction).map(|felt| {
        let frequency_hz = wavenumber_per_mm(k) * felt.speed_mm_per_s;
        format!(", sounds at {}", quantity::with_unit(frequency_hz, 0, "Hz"))
    });
    format!(
        "{name}  {level}, point {point}{source}{}",
        sounds.unwrap_or_default()
    )
}

/// The spectra with their numbers.
fn exported(view: &SpatialView, contactor: usize, bench: &Bench) -> Exported {
    let note = "One-sided power density of the heights at the nearest points of the four profiles: \
                the power of a bin over 0.23 cycles/mm; bins that fall together as their mean. \
                Bold: what sounds between 10 Hz and 1 kHz at the present speed; marked: what \
                sounds at 40 and 320 Hz at the faster of the two.";
    let mut origin = bench
        .origin()
        .of_contactor(contactor)
        .in_ticks(std::iter::once(bench.live.tick));
    for felt in view.felt.iter().flatten() {
        let key = if felt.direction.index() >= 2 {
            "speed_weft_mm_per_s"
        } else {
            "speed_warp_mm_per_s"
        };
        let name = felt.direction.label();
        let speed = quantity::with_unit(felt.speed_mm_per_s, 1, "mm/s");
        let brief = format!("{name} {speed}");
        origin = origin.and(key, &felt.speed_mm_per_s.to_string(), &brief);
    }
    let title = format!("Spatial spectra under contactor {contactor}");
    let chart = Chart {
        columns: columns(view),
        ..chart(view)
    };
    Exported::of_chart(&title, chart, 340.0, note, origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wavenumber_finds_its_bin() {
        for k in [1, 2, 7, 40] {
            assert_eq!(bin_of(wavenumber_per_mm(k)), k);
        }
        assert_eq!((bin_of(1e-6), bin_of(1e6)), (1, N_BINS));
    }
}
