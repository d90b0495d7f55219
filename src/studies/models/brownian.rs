//! Brownian generators: the exponent that is found on what they make, and their rises.

use crate::readable::mean;
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_foundation::numerics::{quantile, structure_function};
use selvedge_textile::{Brownian, Generator, Hurst};

/// Lag at which rises are set beside the closed form, samples.
const LAG: usize = 16;
/// The exponent is promised to come back within this, in the mean over seeds.
const PROMISED: f64 = 0.05;
/// Distance of the points, mm.
const STEP_MM: f64 = 0.1;

/// Error of the Hurst exponent by generator, exponent and size, and what a surface costs.
pub(crate) const STUDY: Study = Study {
    name: "brownian",
    chapter: "surfaces",
    question: "Does the Hurst exponent that was asked for come back from a Brownian surface?",
    reference: "The exponent asked for; rises by the closed form σ²|d|^2H.",
    error: ("error of H", ""),
    cost_of: "surface",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let exponents = [0.1, 0.3, 0.5, 0.7, 0.9];
    let n_exponents = bench.effort.pick(3, exponents.len());
    // Few, but the ends and the middle.
    let chosen: Vec<f64> = (0..n_exponents)
        .map(|i| exponents[i * (exponents.len() - 1) / (n_exponents - 1)])
        .collect();
    let mut rows = Vec::new();
    for n in bench.effort.pick(vec![64], vec![64, 128]) {
        for (done, &hurst) in chosen.iter().enumerate() {
            bench.step(done as f64 / chosen.len() as f64, "making surfaces")?;
            for generator in [Generator::Exact, Generator::Periodic] {
                rows.push(row(hurst, generator, n, bench)?);
            }
        }
    }
    let notes = [
        "H is half the slope of the structure function over lags of 1 to 16 points, along all \
         rows and columns of a surface, in the mean over the seeds; the 99th percentile is of \
         single surfaces. Both hold for this estimator: others weigh other lags.",
        "The periodic generator has the right spectrum and cuts it off where the grid ends: \
         at low H that makes rises over few points too small and H too large. It promises \
         nothing; take it where a surface must repeat.",
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
}

fn row(
    hurst: f64,
    generator: Generator,
    n: usize,
    bench: &mut Bench<'_>,
) -> Result<Row, ReportError> {
    let of = |seed: u32| {
        let mut surface = Brownian::new(hurst, 1.0, generator, seed);
        (surface.length_mm, surface.step_mm) = (n as f64 * STEP_MM, STEP_MM);
        surface
    };
    let n_seeds = bench.effort.pick(8, 20);
    let first = u32::try_from(bench.seed % 1_000_000).unwrap_or(0) * 100;
    let (mut exponents, mut rises) = (Vec::new(), 0.0);
    for seed in first..first + n_seeds {
        let map = of(seed).surface(1.0)?;
        let z = map.heights_um();
        let column = |c: usize| -> Vec<f64> { (0..z.height()).map(|r| z.row(r)[c]).collect() };
        let mut lines: Vec<Vec<f64>> = (0..z.height()).map(|r| z.row(r).to_vec()).collect();
        lines.extend((0..z.width()).map(column));
        let each = lines.iter().map(|line| structure_function(line, LAG));
        rises += each.sum::<f64>() / (lines.len() as f64 * f64::from(n_seeds));
        let lines: Vec<&[f64]> = lines.iter().map(Vec::as_slice).collect();
        exponents.push(Hurst::of_lines_whole(&lines).unwrap_or(f64::NAN));
    }
    let mean = mean(&exponents);
    let mut errors: Vec<f64> = exponents.iter().map(|h| (h - hurst).abs()).collect();
    let theory = (LAG as f64 * STEP_MM).powf(2.0 * hurst);
    let is_exact = generator == Generator::Exact;
    let cost = bench.time(1, || of(first).surface(1.0).map(|map| map.sq_um()).ok());
    let method = if is_exact { "exact" } else { "periodic" };
    Ok(Row::of(method, "", format!("H {hurst}, {n} × {n} points"))
        .size((n * n) as f64)
        .error((mean - hurst).abs())
        .p99(quantile(&mut errors, 0.99))
        .promised(is_exact.then_some(PROMISED))
        .cost(cost)
        .number("h_found", 4, mean)
        .with("n_seeds", n_seeds)
        .number("rise_at_16_points_over_theory", 3, rises / theory))
}
