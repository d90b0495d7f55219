//! Why a contactor does what it does: its chain of numbers, and the energy of every bin.

use crate::bench::export::Exported;
use crate::bench::export::ink;
use crate::bench::export::origin::Origin;
use crate::bench::export::row;
use crate::tools::why::explanation::Explanation;
use crate::tools::why::text::sheet;
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, Filters};

/// Frequencies that are drawn, Hz.
const FREQUENCIES_HZ: [f64; 2] = [10.0, 1000.0];
/// Steps of a filter's curve.
const N_STEPS: u8 = 192;
/// How far the bands' lines stand apart, so that neither hides the other: their frequencies are
/// drawn this factor too low and too high.
const APART: f64 = 1.003;

/// The energy that each band takes, bin by bin, and the filters below it.
pub(crate) fn charts(why: &Explanation, filters: &Filters) -> [Chart; 2] {
    let energies = why.energies();
    let taken = |(_, taken): &(f64, [f64; 2])| taken[0].max(taken[1]);
    let largest = energies.iter().map(taken).fold(0.0, f64::max);
    let most_um2 = if largest > 0.0 { 1.05 * largest } else { 1.0 };
    let stems = |band: Band| Series {
        name: format!("{} Hz", quantity::fixed(band.carrier_hz(), 0)),
        points: energies
            .iter()
            .map(|(hz, taken)| {
                let apart = if band == Band::Low {
                    1.0 / APART
                } else {
                    APART
                };
                [hz * apart, taken[band.index()]]
            })
            .collect(),
        style: Style::Stems,
        ink: ink(band),
        ..Series::default()
    };
    let frequency = || Axis::log("frequency, Hz").within(FREQUENCIES_HZ);
    let energy = Chart {
        x: frequency(),
        is_x_shared: true,
        y: Axis::linear("energy of a bin, µm²").within([0.0, most_um2]),
        series: Band::ALL.map(stems).to_vec(),
        ..Chart::default()
    };
    let gains = Chart {
        x: frequency(),
        y: Axis::linear("filter gain").within([0.0, 1.0]),
        series: Band::ALL.map(|band| curve(filters, band)).to_vec(),
        ..Chart::default()
    };
    [energy, gains]
}

/// The explanation that is shown.
pub(crate) fn explanation(why: &Explanation, filters: &Filters, origin: Origin) -> Exported {
    let [energy, gains] = charts(why, filters);
    let [low, high] = why
        .trace
        .amplitudes_um
        .map(|um| quantity::with_unit(um, 3, "µm"));
    let note = format!(
        "Energy that each band takes of every bin that sounds below 1 kHz: its power times the \
         filter's power gain. With gains the contactor's amplitudes are {low} at 40 Hz and {high} \
         at 320 Hz."
    );
    let origin = origin
        .of_contactor(why.contactor)
        .in_ticks(std::iter::once(why.tick))
        .and("textile", why.textile.as_deref().unwrap_or_default(), "");
    let title = format!("Energy by bin at contactor {}", why.contactor);
    let rows = vec![row(energy, 240.0), row(gains, 110.0)];
    Exported::new(title, sheet(why), rows, &note, origin)
}

fn curve(filters: &Filters, band: Band) -> Series {
    let [least_hz, most_hz] = FREQUENCIES_HZ;
    let point = |i: u8| {
        let frequency_hz = least_hz * (most_hz / least_hz).powf(f64::from(i) / f64::from(N_STEPS));
        [frequency_hz, filters.gain(band, frequency_hz)]
    };
    Series {
        points: (0..=N_STEPS).map(point).collect(),
        style: Style::Line,
        ink: ink(band),
        ..Series::default()
    }
}
