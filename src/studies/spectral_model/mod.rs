//! The study of the spectral model: what its window, its bins and its nearest point cost.
//!
//! Window length and bin spacing are let free and set beside the formula of waves whose amplitudes
//! are known, and beside the spectrum of a textile's whole profile; the nearest point is set beside
//! the mean over the points that a contactor crosses in a tick.

mod crossing;
mod surfaces;
mod window;
mod windows;

use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::numerics::{Random, median};
use selvedge_foundation::quantity::with_unit;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, WINDOW_LENGTH_MM};

/// The product's window length in mm and bin spacing in cycles/mm.
const PRODUCT: [f64; 2] = [WINDOW_LENGTH_MM, BIN_SPACING_PER_MM];

/// Level error of window lengths, bin spacings and the choice of points, and what they cost.
pub(crate) const STUDY: Study = Study {
    name: "spectral-model",
    chapter: "spectra",
    question: "What do the window of 4.35 mm, bins of 0.23 cycles/mm and the nearest point cost \
               in level?",
    reference: "Sums of waves by the filters' formula, whole profiles, the mean power over a \
                tick's way.",
    error: ("level error", "dB"),
    cost_of: "spectrum, or tick of a contactor",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut random = Random::new(bench.seed).branch("phases");
    let waves = surfaces::sums_of_waves(bench.effort.pick(3, 8), &mut random);
    let textiles = surfaces::textiles(bench.effort.pick(2, 16))?;
    bench.step(0.0, "windows on sums of waves")?;
    let mut rows = windows::rows(&waves, bench);
    bench.step(0.3, "windows on textiles")?;
    rows.extend(windows::rows(&textiles, bench));
    bench.step(0.6, "points crossed in a tick")?;
    let crossing = crossing::rows(&textiles, bench);
    let mut notes = windows::notes();
    notes.extend(crossing_note(&crossing));
    rows.extend(crossing);
    bench.step(0.9, "windows by speed")?;
    let plots = vec![("window-at-40-hz".to_owned(), windows::plot())];
    Ok(Findings::new(rows, plots, notes))
}

/// The median 99th percentile of the nearest point's errors beside that of the mean.
fn crossing_note(rows: &[Row]) -> Option<String> {
    let of = |is_nearest: bool| {
        let own = rows
            .iter()
            .filter(|row| (row.method == "nearest point") == is_nearest);
        median(&mut own.filter_map(|row| row.error_p99).collect::<Vec<f64>>())
    };
    let [nearest, mean] = [of(true), of(false)].map(|db| with_unit(db, 2, "dB"));
    (!rows.is_empty()).then(|| {
        format!(
            "Taking the nearest point instead of all that a contactor crosses in a tick is \
             {nearest} off at the 99th percentile, in the median over textiles and speeds; the \
             mean over the points crossed is {mean} off."
        )
    })
}

#[cfg(test)]
mod tests;
