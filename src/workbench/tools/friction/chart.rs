//! What the pane draws, as charts: friction along the strip and its spectrogram, voltage and the
//! simulated screen's friction over the last moments, and their spectra.

use crate::bench::export::{bar, rgb};
use crate::bench::signals::amplitudes::hann_amplitudes;
use crate::kit::plot::thinned;
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::friction::source::Trace;
use crate::tools::friction::stroke::Instant;
use selvedge_chart::{At, Axis, Band, Chart, ColourBar, Columns, Ink, Raster, Rule};
use selvedge_chart::{Series, Style, Weight};
use selvedge_foundation::numerics::extent;
use selvedge_friction::PredictedFriction;

/// How much of the second is drawn of what has the carrier's frequency, s.
const MOMENT_S: f64 = 0.2;
/// Lines are drawn by the least and the largest of so many parts.
const N_PARTS: usize = 600;
/// Frequencies of the spectra, Hz.
const FREQUENCIES_HZ: [f64; 2] = [5.0, 2000.0];
/// From the largest amplitude of a spectrum down to the least that is shown.
const DECADES: f64 = 1e-3;

/// What is drawn of a stroke over time, and its spectrum: titles, units, how it is drawn.
pub(crate) struct Felt {
    titles: [&'static str; 2],
    unit: [&'static str; 2],
    of: fn(&Instant) -> f64,
    ink: Ink,
}

/// The voltage, and what the simulated screen makes of it.
pub(crate) const FELT: [Felt; 2] = [
    Felt {
        titles: ["Voltage", "Its spectrum"],
        unit: ["voltage, V", "amplitude, V"],
        of: |instant| instant.driven.v,
        ink: Ink::Violet,
    },
    Felt {
        titles: ["Friction on the simulated screen", "Its spectrum"],
        unit: ["friction, N", "amplitude, N"],
        of: |instant| instant.friction_n,
        ink: Ink::Rose,
    },
];

fn along(trace: &Trace) -> Axis {
    Axis::linear("along the strip, mm").within([0.0, trace.length_mm()])
}

/// Friction along the strip with how far its level may be off, and the finger's place, mm.
pub(crate) fn friction(trace: &Trace, place_mm: Option<f64>) -> Chart {
    let (mu, within) = (&trace.predicted.mu, trace.predicted.level_within);
    let x_mm = |at: usize| at as f64 / PredictedFriction::PER_MM;
    let points: Vec<[f64; 2]> = (mu.iter().enumerate())
        .map(|(at, mu)| [x_mm(at), *mu])
        .collect();
    let band = Band {
        name: "95 % of cloths like those learnt".to_owned(),
        points: (points.iter())
            .map(|[x, mu]| [*x, mu - within, mu + within])
            .collect(),
        ink: Ink::Grey,
    };
    Chart {
        title: "Friction f(s)".to_owned(),
        x: along(trace),
        y: Axis::linear("coefficient of friction"),
        bands: vec![band],
        rules: (place_mm.into_iter())
            .map(|mm| Rule {
                at: At::X(mm),
                ink: Ink::Black,
                ..Rule::default()
            })
            .collect(),
        series: vec![Series {
            ink: Ink::Black,
            weight: Weight::Thin,
            ..Series::of("", Style::Line, points)
        }],
        columns: Columns::default()
            .with("x_mm", (0..mu.len()).map(x_mm).collect::<Vec<f64>>())
            .with("mu", mu.clone()),
        ..Chart::default()
    }
}

/// The frame of the spectrogram.
pub(crate) fn spectrogram_frame(trace: &Trace) -> Chart {
    let most_per_mm = 0.5 * PredictedFriction::PER_MM;
    Chart {
        title: "Spectrogram".to_owned(),
        x: along(trace),
        y: Axis::linear("wavenumber, cycles/mm").within([0.0, most_per_mm]),
        ..Chart::default()
    }
}

/// The cells of the spectrogram, and the bar of their colours.
pub(crate) fn spectrogram_cells(trace: &Trace, map: ColourMap) -> (Raster, ColourBar) {
    let log = trace.predicted.log_magnitudes();
    let ends = extent(log.values().iter().map(|&log| f64::from(log)));
    let shades = PredictedFriction::shades(log, log.width(), ends);
    let raster = Raster {
        n_columns: shades.width(),
        cells: (shades.values().iter())
            .map(|&shade| Some(rgb(map, shade)))
            .collect(),
    };
    let axis = Axis::linear("ln(1 + m / 0.02)").within(ends);
    (raster, bar(map, axis))
}

impl Felt {
    /// Over the last moments, and the spectrum of all of them: peak amplitudes under a Hann window
    /// (periodic) whose gain is compensated.
    pub(crate) fn charts(&self, stroke: &[Instant]) -> [Chart; 2] {
        let end_s = stroke.last().map_or(0.0, |last| last.t_s);
        let moment = (stroke.iter())
            .filter(|instant| instant.t_s >= end_s - MOMENT_S)
            .map(|instant| [1e3 * (instant.t_s - end_s), (self.of)(instant)]);
        let over_time = thinned(&moment.collect::<Vec<_>>(), N_PARTS);
        let stroke = &stroke[stroke.len() % 2..];
        let values: Vec<f64> = stroke.iter().map(self.of).collect();
        let span_s = stroke.first().map_or(0.0, |first| end_s - first.t_s);
        let [low, high] = FREQUENCIES_HZ;
        let spectrum = hann_amplitudes(&values, span_s);
        let shown: Vec<_> = (spectrum.into_iter())
            .filter(|[hz, _]| (low..=high).contains(hz))
            .collect();
        let most = shown.iter().map(|point| point[1]).fold(1e-9, f64::max);
        let least = DECADES * most;
        let floored: Vec<_> = (shown.into_iter())
            .map(|[hz, amplitude]| [hz, amplitude.max(least)])
            .collect();
        let chart = |nth: usize, x: Axis, y: Axis, points: Vec<[f64; 2]>| Chart {
            title: self.titles[nth].to_owned(),
            x,
            y,
            series: vec![Series {
                ink: self.ink,
                weight: Weight::Thin,
                ..Series::of("", Style::Line, points)
            }],
            ..Chart::default()
        };
        let time = Axis::linear("time before now, ms").within([-1e3 * MOMENT_S, 0.0]);
        let amplitude = Axis::log(self.unit[1]).within([least, 1.5 * most]);
        let frequency = Axis::log("frequency, Hz").within(FREQUENCIES_HZ);
        [
            chart(0, time, Axis::linear(self.unit[0]), over_time),
            chart(1, frequency, amplitude, thinned(&floored, N_PARTS)),
        ]
    }
}
