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
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity::with_unit;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, WINDOW_LENGTH_MM};

/// The product's window length in mm and bin spacing in cycles/mm.
const PRODUCT: [f64; 2] = [WINDOW_LENGTH_MM, BIN_SPACING_PER_MM];

/// Level error of window lengths, bin spacings and the choice of points, and what they cost.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SpectralModelStudy;

impl Study for SpectralModelStudy {
    fn name(&self) -> &'static str {
        "spectral-model"
    }

    fn question(&self) -> &'static str {
        "What do the window of 4.35 mm, bins of 0.23 cycles/mm and the nearest point cost in level?"
    }

    fn reference(&self) -> &'static str {
        "Sums of waves by the filters' formula, whole profiles, the mean power over a tick's way."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("level error", "dB")
    }

    fn cost_of(&self) -> &'static str {
        "spectrum, or tick of a contactor"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
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
        Ok(Findings {
            rows,
            plots: vec![("window-at-40-hz".to_owned(), windows::plot())],
            notes,
        })
    }
}

/// The median 99th percentile of the nearest point's errors beside that of the mean.
fn crossing_note(rows: &[Row]) -> Option<String> {
    let of = |is_nearest: bool| {
        let is_its = |row: &&Row| (row.method == "nearest point") == is_nearest;
        let mut errors: Vec<f64> = rows
            .iter()
            .filter(is_its)
            .filter_map(|row| row.error_p99)
            .collect();
        selvedge_foundation::numerics::median(&mut errors)
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

/// `10 log₁₀` of a ratio of powers, dB.
fn level_db(power_ratio: f64) -> f64 {
    10.0 * power_ratio.log10()
}

#[cfg(test)]
mod tests;
