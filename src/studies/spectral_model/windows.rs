//! Window length and bin spacing: the amplitudes that a short window finds, against the formula of
//! a sum of waves and against the whole profile of a textile.

use crate::{Bench, Row, Timing};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::numerics::{Random, quantile};
use selvedge_foundation::quantity::with_unit;
use selvedge_textile::tactile::Filters;

use super::PRODUCT;
use super::surfaces::Surface;
use super::window::Model;
use crate::chart::chart;
use crate::readable::{deviation, mean, power_level_db};

/// Speeds that errors are taken over, mm/s.
const SPEEDS_MM_PER_S: [f64; 5] = [20.0, 50.0, 100.0, 200.0, 400.0];
/// Window length in mm and bin spacing in cycles/mm; the product's first.
const SETTINGS: [[f64; 2]; 8] = [
    PRODUCT,
    [2.0, 0.5],
    [8.0, 0.125],
    [16.0, 0.0625],
    [3.79, 1.0 / 3.79],
    [3.79, 0.23],
    [PRODUCT[0], 0.115],
    [2.0, 0.23],
];
/// A band is compared where it holds at least this share of the surface's amplitude.
const LEAST_SHARE: f64 = 0.05;
/// Of a wave that fills the window n times, bins of 1/L give this part over n² of its power more
/// than the formula, where its band is weakest: Hamming's two outer bins, each 0.133 of it, lie
/// 1/n beside it, and a band 26 dB down bends by 38 over an e-fold.
const BEYOND: f64 = 6.0;
/// The fewest waves of a window that this is said of.
const LEAST_WAVES: f64 = 3.0;
/// Speeds of the plot are this far apart.
const OCTAVE_STEPS: i32 = 6;

/// What a model finds on a surface.
#[expect(clippy::struct_field_names, reason = "names carry their units")]
struct Found {
    errors_db: Vec<f64>,
    /// Level of A40 at 100 mm/s over the true one, dB; NaN where it is too weak.
    low_at_100_db: f64,
    /// The largest spread of a level from point to point, dB (standard deviation).
    spread_db: f64,
}

/// A row for every setting and surface.
pub(super) fn rows(surfaces: &[Surface], bench: &mut Bench<'_>) -> Vec<Row> {
    let n_settings = bench.effort.pick(4, SETTINGS.len());
    let mut rows = Vec::new();
    for setting in SETTINGS.iter().take(n_settings) {
        for surface in surfaces {
            let model = Model::new(surface.step_mm, setting[0], setting[1]);
            if model.n_window() > surface.heights_um.len() {
                continue;
            }
            let window = &surface.heights_um[..model.n_window()];
            let cost = bench.time(1, || model.powers_um2(window));
            let n_bins = model.powers_um2(window).len();
            let found = found(&model, surface);
            rows.push(row(*setting, surface, n_bins, (found, cost)));
        }
    }
    rows
}

fn row(setting: [f64; 2], surface: &Surface, n_bins: usize, (found, cost): (Found, Timing)) -> Row {
    let mut errors_db = found.errors_db;
    let against = if surface.waves.is_empty() {
        "the whole profile"
    } else {
        "the formula"
    };
    let case = format!("{} against {against}", surface.label);
    Row::of("window", label(setting), case)
        .error(errors_db.iter().copied().reduce(f64::max))
        .promised(promised_db(setting, surface))
        .p99(quantile(&mut errors_db, 0.99))
        .cost(cost)
        .bytes(n_bins * size_of::<f64>())
        .number("window_mm", 3, setting[0])
        .number("spacing_per_mm", 4, setting[1])
        .number("a40_at_100_mm_per_s_db", 3, found.low_at_100_db)
        .number("spread_between_points_db", 3, found.spread_db)
}

/// What is promised of waves that are short beside the window, dB.
fn promised_db([window_mm, spacing_per_mm]: [f64; 2], surface: &Surface) -> Option<f64> {
    let longest = surface.waves.iter().map(|wave| wave[0] * window_mm);
    let n = longest.reduce(f64::min)?;
    let is_own = (window_mm * spacing_per_mm - 1.0).abs() < 1e-9;
    (is_own && n >= LEAST_WAVES).then(|| power_level_db(1.0 + BEYOND / (n * n)))
}

fn label([window_mm, spacing_per_mm]: [f64; 2]) -> String {
    format!("{window_mm:.2} mm, bins {spacing_per_mm:.3}/mm")
}

fn found(model: &Model, surface: &Surface) -> Found {
    let filters = Filters::default();
    let points = model.powers_along(surface, 1.0);
    let truth = Truth::of(surface);
    let mut found = Found {
        errors_db: Vec::new(),
        low_at_100_db: f64::NAN,
        spread_db: 0.0,
    };
    for speed in SPEEDS_MM_PER_S {
        let at = |powers: &Vec<f64>| model.squared_amplitudes_um2(powers, speed, &filters);
        let squared: Vec<[f64; 2]> = points.iter().map(at).collect();
        let truth_um2 = truth.squared_um2(surface, speed, &filters);
        for (b, truth_um2) in truth_um2.into_iter().enumerate() {
            if truth_um2 < LEAST_SHARE * LEAST_SHARE * truth.total_um2 {
                continue;
            }
            let levels: Vec<f64> = squared
                .iter()
                .map(|pair| power_level_db(pair[b] / truth_um2))
                .collect();
            let all: Vec<f64> = squared.iter().map(|pair| pair[b]).collect();
            let mean_db = power_level_db(mean(&all) / truth_um2);
            if surface.waves.is_empty() {
                // A textile differs from place to place: its mean power is compared.
                found.errors_db.push(mean_db.abs());
            } else {
                found.errors_db.extend(levels.iter().map(|db| db.abs()));
            }
            found.spread_db = found.spread_db.max(deviation(&levels));
            if b == 0 && (speed - 100.0).abs() < 1e-9 {
                found.low_at_100_db = mean_db;
            }
        }
    }
    found
}

/// What amplitudes are measured against.
struct Truth {
    /// The model of the whole profile and its powers; `None` where a formula knows better.
    whole: Option<(Model, Vec<f64>)>,
    /// Twice the mean square of the heights: the squared amplitude of everything, µm².
    total_um2: f64,
}

impl Truth {
    fn of(surface: &Surface) -> Self {
        if !surface.waves.is_empty() {
            let total_um2 = surface.waves.iter().map(|wave| wave[1] * wave[1]).sum();
            return Self {
                whole: None,
                total_um2,
            };
        }
        let length_mm = surface.length_mm();
        let model = Model::new(surface.step_mm, length_mm, 1.0 / length_mm);
        let powers = model.powers_um2(&surface.heights_um);
        Self {
            total_um2: 2.0 * powers.iter().sum::<f64>(),
            whole: Some((model, powers)),
        }
    }

    fn squared_um2(&self, surface: &Surface, speed: f64, filters: &Filters) -> [f64; 2] {
        match &self.whole {
            Some((model, powers)) => model.squared_amplitudes_um2(powers, speed, filters),
            None => surface.analytic_um2(speed, filters).unwrap_or_default(),
        }
    }
}

/// Level of A40 of the wave that sounds at 40 Hz over its amplitude, by speed and window length.
pub(super) fn plot() -> Chart {
    let lengths = [2.0, 3.79, PRODUCT[0], 8.0, 16.0];
    let line = |window_mm: f64| {
        let is_product = window_mm.to_bits() == PRODUCT[0].to_bits();
        let steps = 0..=5 * OCTAVE_STEPS;
        let speeds = steps.map(|n| 12.5 * (f64::from(n) / f64::from(OCTAVE_STEPS)).exp2());
        let style = if is_product {
            Style::LineAndDots
        } else {
            Style::Line
        };
        let points = speeds.map(|speed| [speed, low_at_40_hz_db(window_mm, speed)]);
        Series::of(format!("{window_mm:.2} mm"), style, points)
    };
    chart(
        "What the window costs a wave that sounds at 40 Hz",
        Axis::log("speed, mm/s"),
        Axis::linear("level of A40 re the wave, dB"),
        lengths.map(line).into(),
        "mean power over points; bins one over the window's length apart",
    )
}

/// The level that a window gives to A40 of the wave that sounds at 40 Hz at a speed, dB re its
/// amplitude: the mean power over points 1 mm apart.
pub(super) fn low_at_40_hz_db(window_mm: f64, speed_mm_per_s: f64) -> f64 {
    let waves = vec![[40.0 / speed_mm_per_s, 1.0]];
    let surface = Surface::of_waves("wave", waves, &mut Random::new(1));
    let model = Model::new(surface.step_mm, window_mm, 1.0 / window_mm);
    let filters = Filters::default();
    let points = model.powers_along(&surface, 1.0);
    let low = |powers: &Vec<f64>| model.squared_amplitudes_um2(powers, speed_mm_per_s, &filters)[0];
    power_level_db(mean(&points.iter().map(low).collect::<Vec<f64>>()))
}

/// What the product's window costs, a sentence each.
pub(super) fn notes() -> Vec<String> {
    let at = |speed: f64| {
        let [ours, double] =
            [PRODUCT[0], 8.0].map(|mm| with_unit(low_at_40_hz_db(mm, speed), 2, "dB"));
        format!(
            "At {speed} mm/s a wave that sounds at 40 Hz ({:.2} mm) gets {ours} from the window of \
             {:.3} mm, {double} from one of 8 mm.",
            speed / 40.0,
            PRODUCT[0],
        )
    };
    let promised = format!(
        "Promised of waves that fill a window n times, n at least {LEAST_WAVES}, where bins are \
         one over its length apart: 10 log₁₀(1 + {BEYOND}/n²) dB."
    );
    [50.0, 100.0, 200.0]
        .map(at)
        .into_iter()
        .chain([promised])
        .collect()
}
