//! The spatial spectra under a contactor: every bin of all four directions.

use crate::bench::export::ink;
use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet};
use crate::bench::signals::spatial::{SpatialCurve, SpatialView};
use crate::tools::spectra::spatial::{
    LEVELS_DB as SPATIAL_LEVELS_DB, density_db, means_of, wavenumber_per_mm,
};
use selvedge_chart::{At, Axis, Chart, Extent, Ink, Row, Rule, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_textile::surface::{Direction, N_BINS};
use selvedge_textile::tactile::Band;

/// Places of the drawing to a factor of e of wavenumber, each with one point of a curve at most.
const STEPS_PER_E: f64 = 60.0;

/// The spectra with the bins that sound in bold.
pub(crate) fn spectra(view: &SpatialView, contactor: usize, tick: u64, origin: Origin) -> Exported {
    let mut series: Vec<Series> = names(view).collect();
    for curve in view.curves.iter().rev() {
        series.extend(lines(view, curve));
    }
    let panel = Chart {
        x: Axis::log("wavenumber, cycles/mm")
            .within([wavenumber_per_mm(1), wavenumber_per_mm(N_BINS)]),
        y: Axis::linear("power density, dB re 1 µm² per cycle/mm").within(SPATIAL_LEVELS_DB),
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
    let mut origin = origin
        .of_contactor(contactor)
        .in_ticks(std::iter::once(tick));
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
