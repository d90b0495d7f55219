//! Resampling: what lies between samples, by the nearest, by straight lines, by the transform.

use std::f64::consts::TAU;

use crate::readable::apart_percent;
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::numerics::{Random, RealTransform, at_place};

/// Length that everything repeats after, mm.
const LENGTH_MM: f64 = 20.0;
/// Samples after resampling: 230 a mm.
const N_FINE: usize = 4600;

/// A way to resample to `N_FINE` samples.
type Way = fn(&[f64]) -> Vec<f64>;
/// The largest rms error, as a part of the rms, of waves so many steps long: in closed form.
type Bound = fn(f64) -> f64;

/// Error of resampling by the step of the original, and what it costs.
pub(crate) const STUDY: Study = Study {
    name: "resampling",
    chapter: "surfaces",
    question: "What does it cost to resample a profile to 230 samples a millimetre, by its own \
               step?",
    reference: "A sum of 40 waves by its formula, at every fine sample.",
    error: ("rms error", "%"),
    cost_of: "profile of 20 mm",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let ways: [(&str, Way, Bound); 3] = [
        // What a wave changes by in up to half a step, and what it bends by within one.
        ("nearest sample", nearest, |steps| {
            TAU / steps / 12.0_f64.sqrt()
        }),
        ("straight lines", lines, |steps| {
            (TAU / steps).powi(2) / 120.0_f64.sqrt()
        }),
        ("Fourier", fourier, |_| 1e-11),
    ];
    let mut rows = Vec::new();
    for (done, shortest_mm) in [1.25, 0.5].into_iter().enumerate() {
        bench.step(0.5 * done as f64, "resampling")?;
        let waves = Waves::new(shortest_mm, &mut Random::new(bench.seed).branch("waves"));
        let truth = waves.sampled(N_FINE);
        let counts = bench
            .effort
            .pick(vec![40, 200, 1000], vec![40, 100, 200, 400, 1000, 2000]);
        for n in counts {
            let coarse = waves.sampled(n);
            let step_mm = LENGTH_MM / n as f64;
            for (method, way, bound) in ways {
                let setting = format!("{step_mm} mm");
                let row = Row::of(method, setting, format!("waves down to {shortest_mm} mm"));
                let row = row.error(apart_percent(&way(&coarse), &truth));
                let steps = shortest_mm / step_mm;
                let row = row.promised((steps > 2.0).then(|| 100.0 * bound(steps)));
                rows.push(row.cost(bench.time(1, || way(&coarse))));
            }
        }
    }
    let notes = [
        "What repeats and is sampled more than twice a wave comes back by the transform to \
         rounding; measured profiles do not repeat, so this is its best case. Half a \
         millimetre, the step of Wall & Harwin 1999, shows waves from 1 mm on.",
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
}

/// A sum of waves that repeats after 20 mm: cycles in the length, amplitude, phase.
struct Waves(Vec<[f64; 3]>);

impl Waves {
    fn new(shortest_mm: f64, random: &mut Random) -> Self {
        let most = LENGTH_MM / shortest_mm;
        let wave = |i: u32| {
            let cycles = (1.0 + (most - 1.0) * f64::from(i) / 39.0).round();
            [cycles, 1.0 / cycles.sqrt(), random.uniform()]
        };
        Self((0..40).map(wave).collect())
    }

    fn sampled(&self, n: usize) -> Vec<f64> {
        let at = |i: usize| {
            let x = i as f64 / n as f64;
            let height = |&[cycles, a, phase]: &[f64; 3]| a * (TAU * (cycles * x + phase)).cos();
            self.0.iter().map(height).sum()
        };
        (0..n).map(at).collect()
    }
}

/// Places of the fine samples among `n` coarse ones.
fn places(n: usize) -> impl Iterator<Item = f64> {
    (0..N_FINE).map(move |i| i as f64 * n as f64 / N_FINE as f64)
}

fn nearest(coarse: &[f64]) -> Vec<f64> {
    let round = |place: f64| at_place(coarse, place.round());
    places(coarse.len()).map(round).collect()
}

fn lines(coarse: &[f64]) -> Vec<f64> {
    let mut closed = coarse.to_vec();
    closed.extend(coarse.first());
    places(coarse.len())
        .map(|place| at_place(&closed, place))
        .collect()
}

fn fourier(coarse: &[f64]) -> Vec<f64> {
    let mut spectrum = RealTransform::new(coarse.len()).forward(coarse);
    let is_even = coarse.len().is_multiple_of(2);
    if let (Some(last), true) = (spectrum.last_mut(), is_even) {
        // The wave of two samples stands for itself and its mirror image.
        *last *= 0.5;
    }
    let scale = N_FINE as f64 / coarse.len() as f64;
    let fine = RealTransform::new(N_FINE).inverse(&spectrum);
    fine.into_iter().map(|height| height * scale).collect()
}
