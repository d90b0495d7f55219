//! The spatial spectra under a contactor: every bin of all four directions.

use super::spectrograms::ink;
use super::{Exported, Origin, Sheet, axis};
use crate::app::panes::{SPATIAL_LEVELS_DB, density_db, wavenumber_per_mm};
use crate::app::signals::{SpatialCurve, SpatialView};
use crate::figure::{At, Extent, Ink, Panel, Row, Rule, Scale, Series, Style, Weight};
use crate::surface::{Direction, N_BINS};
use crate::tactile::Band;

/// The spectra with the bins that sound in bold.
pub(super) fn spectra(view: &SpatialView, contactor: usize, tick: u64, origin: Origin) -> Exported {
    let mut series: Vec<Series> = Vec::new();
    for curve in view.curves.iter().rev() {
        series.extend(lines(view, curve));
    }
    let panel = Panel {
        x: axis(
            "wavenumber, cycles/mm",
            Scale::Log,
            [wavenumber_per_mm(1), wavenumber_per_mm(N_BINS)],
        ),
        y: axis(
            "power density, dB re 1 µm² per cycle/mm",
            Scale::Linear,
            SPATIAL_LEVELS_DB,
        ),
        series,
        rules: carriers(view),
        ..Panel::default()
    };
    let row = Row {
        panels: vec![panel],
        height_px: 340.0,
        bar: None,
    };
    let note = "One-sided power density of the textile's height at the nearest points of its four \
                profiles: the power of a bin over 0.23 cycles/mm. Bold: what sounds between 10 Hz \
                and 1 kHz at the present speed. Marked: what sounds at 40 and 320 Hz at the faster \
                of the two speeds.";
    let mut origin = origin.of_contactor(contactor).in_ticks(std::iter::once(tick));
    for felt in view.felt.iter().flatten() {
        let key = if felt.direction.index() >= 2 {
            "speed_weft_mm_per_s"
        } else {
            "speed_warp_mm_per_s"
        };
        let name = felt.direction.label();
        let speed = crate::quantity::with_unit(felt.speed_mm_per_s, 1, "mm/s");
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
        curves.flat_map(|curve| (1..).zip(&curve.density_um2_mm).map(move |bin| (curve, bin)))
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

/// A curve, and over it in bold what sounds of it.
fn lines(view: &SpatialView, curve: &SpatialCurve) -> Vec<Series> {
    let direction = curve.direction;
    let point = |(k, density): (usize, &f64)| [wavenumber_per_mm(k), density_db(*density)];
    let points: Vec<[f64; 2]> = (1..).zip(&curve.density_um2_mm).map(point).collect();
    let felt = view.felt_in(direction);
    let ink = if direction.index() >= 2 {
        Ink::Grey
    } else {
        Ink::Black
    };
    let line = |name: &str, points, weight| Series {
        name: name.to_owned(),
        points,
        style: if direction.is_reverse() {
            Style::Dashed
        } else {
            Style::Line
        },
        ink,
        weight,
        ..Series::default()
    };
    let Some(felt) = felt else {
        return vec![line(direction.label(), points, Weight::Thin)];
    };
    let lit = points.iter().filter(|[wavenumber, _]| felt.sounds(*wavenumber));
    let lit: Vec<[f64; 2]> = lit.copied().collect();
    vec![
        line("", points, Weight::Thin),
        line(direction.label(), lit, Weight::Bold),
    ]
}

fn carriers(view: &SpatialView) -> Vec<Rule> {
    let Some(felt) = view.fastest() else {
        return Vec::new();
    };
    let rule = |band: Band| Rule {
        at: At::X(felt.wavenumber_per_mm(band.carrier_hz())),
        ink: ink(band),
        extent: Extent::Across,
        ..Rule::default()
    };
    Band::ALL.map(rule).to_vec()
}
