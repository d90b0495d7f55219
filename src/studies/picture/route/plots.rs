//! Levels by every route against those in truth, and the spectrum of one cloth.

use super::felt::Felt;
use super::results::Tried;
use super::ways::Way;
use crate::chart::chart;
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_textile::surface::BIN_SPACING_PER_MM;

/// Waves longer than this many cycles a mm are in the plot of spectra.
const MOST_PER_MM: f64 = 8.0;

/// The plots of pictures that were taken in the plainest way, with the names of their files.
pub(super) fn plots(results: &[Tried]) -> Vec<(String, Chart)> {
    let plain: Vec<&Tried> = results.iter().filter(|tried| tried.is_plain).collect();
    let of_bands = [(0, "40"), (1, "320")];
    let levels =
        of_bands.map(|(band, name)| (format!("levels-{name}"), levels(&plain, band, name)));
    let spectra = plain
        .first()
        .map(|fine| ("spectrum".to_owned(), spectra(fine)));
    levels.into_iter().chain(spectra).collect()
}

fn levels(results: &[&Tried], band: usize, name: &str) -> Chart {
    let truth = |tried: &&Tried| tried.truth.levels_db[band];
    let mut all: Vec<Series> = Way::ALL
        .map(|way| {
            let dot = |tried: &&Tried| Some([truth(tried), tried.felt_by(way)?.levels_db[band]]);
            Series::of(way.name(), Style::Dots, results.iter().filter_map(dot))
        })
        .into();
    let of_all = || results.iter().map(truth);
    let ends = [
        of_all().fold(f64::INFINITY, f64::min),
        of_all().fold(f64::NEG_INFINITY, f64::max),
    ];
    all.push(Series::of(
        "as in truth",
        Style::Dashed,
        ends.map(|x| [x, x]),
    ));
    chart(
        format!("Level at {name} Hz by every route against the relief's own"),
        Axis::linear(format!("A{name} of the relief, dB re 1 µm")),
        Axis::linear(format!("A{name} by the route, dB re 1 µm")),
        all,
        "100 mm/s; a dot a cloth and route. Above the line a cloth feels stronger than it is.",
    )
}

fn spectra(fine: &Tried) -> Chart {
    let line = |name: String, felt: &Felt, style: Style| {
        let half = felt.spectrum_um.len() / 2;
        let bins = felt.spectrum_um.iter().take(half).enumerate();
        let points = bins.map(|(k, um)| [(k + 1) as f64 * BIN_SPACING_PER_MM, *um]);
        Series::of(
            name,
            style,
            points.filter(|[per_mm, _]| *per_mm <= MOST_PER_MM),
        )
    };
    let by_way = |way: Way| Some(line(way.name(), fine.felt_by(way)?, Style::Line));
    let mut all = vec![line(
        "the relief's own".to_owned(),
        &fine.truth,
        Style::Dashed,
    )];
    all.extend(Way::ALL.into_iter().filter_map(by_way));
    chart(
        format!("Spectrum along the warp of {}", fine.name),
        Axis::linear("wavenumber, cycles/mm"),
        Axis::log("amplitude a bin, µm"),
        all,
        "Rms over all places of the stroke.",
    )
}
