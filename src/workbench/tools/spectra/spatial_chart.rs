//! The spatial spectra as a chart, with the bins that sound in bold.
//!
//! Every direction has a colour of its own, and reverse ones are dashed: amber and cyan are left to
//! the wavenumbers that sound at 40 and 320 Hz.

use crate::bench::export::ink;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ};
use crate::bench::signals::spatial::{
    DENSITIES_DB, SpatialCurve, SpatialView, density_db, wavenumber_per_mm,
};
use selvedge_chart::{At, Axis, Chart, Columns, Extent, Ink, Rule, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_textile::surface::{Direction, N_BINS};
use selvedge_textile::tactile::Band;

/// Places of the chart to a factor of e of wavenumber, each with one point of a curve at
/// most.
const STEPS_PER_E: f64 = 60.0;

/// How much of their ink curves lack where they do not sound.
pub(crate) const UNLIT: f32 = 0.5;

/// The spectra with the bins that sound in bold; without the columns.
pub(crate) fn chart(view: &SpatialView) -> Chart {
    let mut series: Vec<Series> = names(view).collect();
    for curve in view.curves.iter().rev() {
        series.extend(lines(view, curve));
    }
    Chart {
        x: Axis::log("wavenumber, cycles/mm")
            .within([wavenumber_per_mm(1), wavenumber_per_mm(N_BINS)]),
        y: Axis::linear("power density, dB re 1 µm² per cycle/mm").within(DENSITIES_DB),
        series,
        rules: carriers(view),
        ..Chart::default()
    }
}

/// The chart with the frequencies that wavenumbers sound at above it, and the carriers of the
/// slower direction; what does not sound is faint.
pub(crate) fn with_frequencies(view: &SpatialView) -> Chart {
    let mut chart = chart(view);
    for series in &mut chart.series {
        if series.weight == Weight::Thin {
            series.faintness = UNLIT;
        }
    }
    let Some(fastest) = view.fastest() else {
        return chart;
    };
    let rule = |wavenumber: f64, ink, extent| Rule {
        at: At::X(wavenumber),
        ink,
        extent,
        ..Rule::default()
    };
    chart
        .rules
        .extend([LEAST_HZ, 100.0, MOST_HZ].map(|hz| Rule {
            label: quantity::fixed(hz, 0),
            ..rule(fastest.wavenumber_per_mm(hz), Ink::Grey, Extent::Edge)
        }));
    for slower in view.felt.iter().flatten().filter(|felt| **felt != fastest) {
        chart.rules.extend(Band::ALL.map(|band| {
            let wavenumber = slower.wavenumber_per_mm(band.carrier_hz());
            rule(wavenumber, ink(band), Extent::Dashed)
        }));
    }
    chart
}

/// One row a bin and direction.
pub(crate) fn columns(view: &SpatialView) -> Columns {
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
    Columns::default()
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

/// The curve of a density as `[wavenumber, density]`: bins nearer to one another than a step as
/// their mean.
fn means_of(density_um2_mm: &[f64]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    let (mut n_bins, mut wavenumbers, mut densities) = (0.0, 0.0, 0.0);
    let mut next = f64::NEG_INFINITY;
    for (k, density) in (1..).zip(density_um2_mm) {
        n_bins += 1.0;
        wavenumbers += wavenumber_per_mm(k);
        densities += density;
        let at = (wavenumbers / n_bins).ln() * STEPS_PER_E;
        if at >= next {
            points.push([wavenumbers / n_bins, densities / n_bins]);
            (n_bins, wavenumbers, densities) = (0.0, 0.0, 0.0);
            next = at + 1.0;
        }
    }
    points
}

/// A curve, and over it in bold what sounds of it; bins that fall together as their mean.
fn lines(view: &SpatialView, curve: &SpatialCurve) -> Vec<Series> {
    let direction = curve.direction;
    let level = |[wavenumber, density]: [f64; 2]| [wavenumber, density_db(density)];
    let means = means_of(&curve.density_um2_mm);
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

/// A line as those of a direction are drawn.
pub(crate) fn line(direction: Direction, points: Vec<[f64; 2]>, weight: Weight) -> Series {
    Series {
        points,
        style: if direction.is_reverse() {
            Style::Dashed
        } else {
            Style::Line
        },
        ink: match direction {
            Direction::WarpForward => Ink::Black,
            Direction::WarpReverse => Ink::Violet,
            Direction::WeftForward => Ink::Rose,
            Direction::WeftReverse => Ink::Grey,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_is_told_apart_by_its_colour() {
        let inks = Direction::ALL.map(|direction| line(direction, Vec::new(), Weight::Thin).ink);
        for (nth, ink) in inks.iter().enumerate() {
            assert!(!inks[..nth].contains(ink), "{ink:?} twice");
            assert!(![Ink::Amber, Ink::Cyan, Ink::Own].contains(ink), "{ink:?}");
        }
    }

    #[test]
    fn a_flat_density_stays_flat_however_many_bins_fall_together() {
        let points = means_of(&[0.1; N_BINS]);
        let is_flat = |[_, density]: &[f64; 2]| (density - 0.1).abs() < 1e-12;
        assert!(points.iter().all(is_flat), "{points:?}");
        assert!(points.len() < N_BINS, "{}", points.len());
        let is_rising = |pair: &[[f64; 2]]| pair[0][0] < pair[1][0];
        assert!(points.windows(2).all(is_rising), "rising");
    }
}
