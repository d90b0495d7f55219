//! The spatial spectra under the selected contactor: power density over wavenumber, with the bins
//! lit that sound at its speed.

use eframe::egui::{self, Rect, Sense, Stroke, Ui, WidgetInfo, pos2};

use crate::bench::Bench;
use crate::bench::export::{Exported, NO_CONTACTOR, Sheet, ink};
use crate::bench::pane::Pane;
use crate::bench::signals::spatial::{
    DENSITIES_DB, SpatialCurve, SpatialView, density_db, wavenumber_per_mm,
};
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::pane::paint_sentence;
use crate::kit::theme::Palette;
use crate::tools::spectra::spatial_plot::{Plot, means_of, words_of};
use crate::tools::spectra::{contactor, show_contactor};
use selvedge_chart::{At, Axis, Chart, Extent, Ink, Row, Rule, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_textile::surface::{Direction, N_BINS};
use selvedge_textile::tactile::Band;

/// Places of the drawing on paper to a factor of e of wavenumber, each with one point of a curve at
/// most.
const STEPS_PER_E: f64 = 60.0;

/// What a view is made for: scene, contactor, place, turn, motion.
type Key = (u64, usize, [f64; 6]);

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
        let (contactor, pose) = (contactor(bench), &bench.live.pose);
        let motion = [
            pose.position.x_mm,
            pose.position.y_mm,
            pose.angle_deg,
            pose.velocity.x_mm_per_s,
            pose.velocity.y_mm_per_s,
            pose.angular_rad_per_s,
        ];
        let inspection = &mut bench.inspection;
        let key = (inspection.n_edits, contactor, motion);
        if self.key == Some(key) {
            return;
        }
        self.key = Some(key);
        self.n_views_computed += 1;
        let trace = inspection.inspector.trace(0, contactor, pose);
        self.view = trace.and_then(|trace| {
            let textile = trace.touch.as_ref()?.textile;
            let placed = inspection.scene.textiles.get(textile)?;
            SpatialView::of(&trace, &placed.surface)
        });
    }

    /// Shows the spectra in the space that is left.
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        let name = format!("Spatial spectra under contactor {}", contactor(bench));
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, &name));
        let area = Rect::from_min_max(
            pos2(rect.left() + 34.0, rect.top() + 18.0),
            pos2(rect.right() - 8.0, rect.bottom() - 18.0),
        );
        if area.width() < 48.0 || area.height() < 24.0 {
            return;
        }
        self.catch_up(bench);
        let Some(view) = &self.view else {
            let words =
                "The selected contactor is off every textile: its spectra show when it is on one";
            paint_sentence(ui.painter(), rect, words);
            return;
        };
        let plot = Plot::new(area);
        plot.paint(ui.painter(), view);
        let pointer = response.hover_pos().filter(|at| area.contains(*at));
        if let Some(at) = pointer {
            let k = plot.bin_at(at.x);
            let x = plot.x(wavenumber_per_mm(k));
            let stroke = Stroke::new(1.0, Palette::in_ui(ui).selection.gamma_multiply(0.35));
            ui.painter().vline(x, area.y_range(), stroke);
            response.on_hover_text_at_pointer(words_of(view, k));
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

/// The spectra with the bins that sound in bold.
fn exported(view: &SpatialView, contactor: usize, bench: &Bench) -> Exported {
    let mut series: Vec<Series> = names(view).collect();
    for curve in view.curves.iter().rev() {
        series.extend(lines(view, curve));
    }
    let panel = Chart {
        x: Axis::log("wavenumber, cycles/mm")
            .within([wavenumber_per_mm(1), wavenumber_per_mm(N_BINS)]),
        y: Axis::linear("power density, dB re 1 µm² per cycle/mm").within(DENSITIES_DB),
        series,
        rules: carriers(view),
        ..Chart::default()
    };
    let row = Row {
        panels: vec![panel],
        height_px: 340.0,
        bar: None,
    };
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
    Exported::new(title, sheet(view), vec![row], note, origin)
}

/// One row a bin and direction.
fn sheet(view: &SpatialView) -> Sheet {
    let bins = || {
        let curves = view.curves.iter();
        curves.flat_map(|curve| {
            (1..)
                .zip(&curve.density_um2_mm)
                .map(move |bin| (curve, bin))
        })
    };
    let words = |of: &dyn Fn(&SpatialCurve) -> Direction| -> Vec<String> {
        let names = bins().map(|(curve, _)| of(curve).label().to_owned());
        names.collect()
    };
    let number = |of: &dyn Fn(&SpatialCurve, usize, f64) -> f64| -> Vec<f64> {
        let values = bins().map(|(curve, (k, density))| of(curve, k, *density));
        values.collect()
    };
    let whole = |of: &dyn Fn(&SpatialCurve, usize) -> usize| -> Vec<u64> {
        let values = bins().map(|(curve, (k, _))| of(curve, k) as u64);
        values.collect()
    };
    let frequency_hz = |curve: &SpatialCurve, k: usize, _: f64| {
        let felt = view.felt_in(curve.direction);
        felt.map_or(f64::NAN, |felt| wavenumber_per_mm(k) * felt.speed_mm_per_s)
    };
    Sheet::default()
        .with("direction", words(&|curve| curve.direction))
        .with("taken_from", words(&|curve| curve.taken_from))
        .with("point", whole(&|curve, _| curve.point))
        .with("bin", whole(&|_, k| k))
        .with("wavenumber_per_mm", number(&|_, k, _| wavenumber_per_mm(k)))
        .with("density_um2_mm", number(&|_, _, density| density))
        .with("level_db", number(&|_, _, density| density_db(density)))
        .with("sounds_at_hz", number(&frequency_hz))
}

/// The names of the curves in their order, each as it is drawn.
fn names(view: &SpatialView) -> impl Iterator<Item = Series> {
    view.curves.iter().map(|curve| {
        let weight = match view.felt_in(curve.direction) {
            Some(_) => Weight::Bold,
            None => Weight::Thin,
        };
        Series {
            name: curve.direction.label().to_owned(),
            ..line(curve.direction, Vec::new(), weight)
        }
    })
}

/// A curve, and over it in bold what sounds of it; bins that fall together as their mean.
fn lines(view: &SpatialView, curve: &SpatialCurve) -> Vec<Series> {
    let direction = curve.direction;
    let level = |[wavenumber, density]: [f64; 2]| [wavenumber, density_db(density)];
    #[expect(clippy::cast_possible_truncation, reason = "a place on paper")]
    let x = |wavenumber: f64| (wavenumber.ln() * STEPS_PER_E) as f32;
    let means = means_of(&curve.density_um2_mm, 1.0, x);
    let points: Vec<[f64; 2]> = means.into_iter().map(level).collect();
    let Some(felt) = view.felt_in(direction) else {
        return vec![line(direction, points, Weight::Thin)];
    };
    let lit = points
        .iter()
        .filter(|[wavenumber, _]| felt.sounds(*wavenumber));
    let lit: Vec<[f64; 2]> = lit.copied().collect();
    vec![
        line(direction, points, Weight::Thin),
        line(direction, lit, Weight::Bold),
    ]
}

fn line(direction: Direction, points: Vec<[f64; 2]>, weight: Weight) -> Series {
    Series {
        points,
        style: if direction.is_reverse() {
            Style::Dashed
        } else {
            Style::Line
        },
        ink: if direction.index() >= 2 {
            Ink::Grey
        } else {
            Ink::Black
        },
        weight,
        ..Series::default()
    }
}

fn carriers(view: &SpatialView) -> Vec<Rule> {
    let Some(felt) = view.fastest() else {
        return Vec::new();
    };
    let rule = |band: Band| Rule {
        at: At::X(felt.wavenumber_per_mm(band.carrier_hz())),
        label: format!("{} Hz", quantity::fixed(band.carrier_hz(), 0)),
        ink: ink(band),
        extent: Extent::Across,
    };
    Band::ALL.map(rule).to_vec()
}
