//! Shape from shading: how near the methods come to reliefs that are known, by light, noise and
//! iterations.

pub(super) mod reliefs;
#[cfg(test)]
mod tests;

use super::chart::chart;
use super::readable::mean;
use super::{Bench, Effort, Findings, ReportError, Row, Study};
use reliefs::{Relief, Truth};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::shading::{Light, LightEstimate, Method, ShadingOptions, Shape};

/// The light that everything else is varied about.
const LIGHT: Light = Light {
    slant_deg: 45.0,
    tilt_deg: 30.0,
};
/// The weave that light and noise are varied on.
const WEAVE: Relief = Relief::PlainWeave {
    rise: 0.1,
    section: 0.1,
};
/// Correlation that the variational method promises on weaves without steps or noise, in light
/// from 45° along neither yarn.
const PROMISED_CORRELATION: f64 = 0.95;

/// Error of heights by method, iterations, light and noise, and what finding them costs.
pub(crate) const STUDY: Study = Study {
    name: "shading",
    chapter: "pictures",
    question: "How much of a known relief comes back from its picture?",
    reference: "The relief that the picture was drawn of, four points to a pixel's side.",
    error: ("height error", "%"),
    cost_of: "tile",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let n = bench.effort.pick(32, 96);
    let mut findings = Findings::new(Vec::new(), Vec::new(), NOTES);
    of_reliefs(n, bench, &mut findings.rows)?;
    let weave = WEAVE.truth(n, bench.seed)?;
    of_iterations(&weave, bench, &mut findings.rows)?;
    let lights = |step: f64, last: f64| -> Vec<f64> {
        let step = bench.effort.pick(6.0 * step, step);
        (0..=200_u8)
            .map(|i| f64::from(i) * step)
            .take_while(|x| *x <= last)
            .collect()
    };
    let (slants, tilts) = (lights(5.0, 80.0), lights(7.5, 180.0));
    let noises = bench
        .effort
        .pick(vec![0.0, 0.03], vec![0.0, 0.003, 0.01, 0.03, 0.1]);
    let sweeps = [
        ("slant", "slant of the light, degrees", slants),
        ("tilt", "tilt of the light, degrees", tilts),
        ("noise", "noise, share of white, rms", noises),
    ];
    for (i, (name, label, values)) in sweeps.into_iter().enumerate() {
        bench.step(0.4 + 0.2 * i as f64, name)?;
        let points = of_sweep(&weave, (name, &values), bench, &mut findings.rows);
        let plot = plot(name, label, points);
        findings.plots.push((format!("by-{name}"), plot));
    }
    findings.notes.push(of_estimates(&weave, bench));
    Ok(findings)
}

/// What a reader should know.
const NOTES: [&str; 3] = [
    "The height error is what is left after the best factor, √(1 − r²) with r the correlation \
         of heights: a textile's relief is scaled afterwards anyway. nrmse is the error without \
         that factor, as a share of the relief's rms.",
    "Promised: r of 0.95 for the variational method on weaves without steps and noise, under \
         light from 45° and 30° beside a yarn. Light along a yarn (tilt 0° or 90°) hardly shows \
         slopes across it: the linear inversion loses them, the full reflectance gets most back \
         from how much they darken.",
    "Model cloths have steps where yarns cross and gaps to the ground: a wall takes no room \
         in a picture, so its height cannot be found from shading, by any method.",
];

/// How near a shape comes.
#[derive(Debug, Clone, Copy)]
struct Near {
    correlation: f64,
    nrmse: f64,
    gain: f64,
    residual: f64,
}

impl Near {
    fn of(shape: &Shape, truth: &Grid<f64>) -> Self {
        let mean = truth.values().iter().sum::<f64>() / truth.values().len() as f64;
        let pairs = || {
            let heights = shape.height_px.values().iter();
            heights.zip(truth.values()).map(|(z, t)| (*z, t - mean))
        };
        let sum = |f: fn(f64, f64) -> f64| pairs().map(|(z, t)| f(z, t)).sum::<f64>();
        let [zz, zt, tt] = [sum(|z, _| z * z), sum(|z, t| z * t), sum(|_, t| t * t)];
        let apart = sum(|z, t| (z - t) * (z - t));
        Self {
            correlation: if zz > 0.0 { zt / (zz * tt).sqrt() } else { 0.0 },
            nrmse: (apart / tt).sqrt(),
            gain: (zz / tt).sqrt(),
            residual: shape.residuals.last().copied().unwrap_or(0.0),
        }
    }

    /// What is left after the best factor, %. A relief that is inside out has nothing left.
    fn error_percent(&self) -> f64 {
        let r = self.correlation.max(0.0);
        100.0 * (1.0 - r * r).max(0.0).sqrt()
    }

    fn row(&self, method: Method, setting: String, case: String) -> Row {
        Row::of(method.label(), setting, case)
            .error(self.error_percent())
            .number("correlation", 4, self.correlation)
            .number("nrmse", 4, self.nrmse)
            .number("gain", 4, self.gain)
            .number("residual", 5, self.residual)
    }
}

fn promised_percent() -> f64 {
    100.0 * (1.0 - PROMISED_CORRELATION * PROMISED_CORRELATION).sqrt()
}

fn found(picture: &Grid<f64>, light: Light, options: &ShadingOptions) -> Option<Shape> {
    Progress::unheard(|progress| Shape::from_shading(picture, light, options, progress)).ok()
}

fn options(method: Method, iterations: Option<usize>) -> ShadingOptions {
    ShadingOptions {
        method,
        iterations,
        ..ShadingOptions::default()
    }
}

/// A row of a method with so many iterations on a relief; `None` where it refuses the light.
fn row(
    (relief, truth): (Relief, &Truth),
    (method, iterations): (Method, Option<usize>),
    is_timed: bool,
    bench: &mut Bench<'_>,
) -> Option<Row> {
    let picture = truth.picture(LIGHT, 0.0, &mut Random::new(bench.seed));
    let options = options(method, iterations);
    let shape = found(&picture, LIGHT, &options)?;
    let work = || found(&picture, LIGHT, &options).map(|shape| shape.albedo);
    let cost = is_timed.then(|| bench.time(1, work));
    let setting = match iterations {
        None => format!("{} iterations", shape.n_iterations()),
        Some(n) => format!("{n} iterations at most"),
    };
    let near = Near::of(&shape, &truth.height_px);
    let size = picture.values().len() as f64;
    Some(
        near.row(method, setting, relief.name())
            .size(size)
            .cost(cost),
    )
}

/// Every method with its usual settings on every relief.
fn of_reliefs(n: usize, bench: &mut Bench<'_>, rows: &mut Vec<Row>) -> Result<(), ReportError> {
    let steeper = Relief::PlainWeave {
        rise: 0.15,
        section: 0.12,
    };
    let mut reliefs = vec![WEAVE, steeper, Relief::Brownian];
    if bench.effort == Effort::Full {
        let models = ["wool-twill", "silk-crepe", "polyamide-jersey", "wool-rib"];
        reliefs.extend([Relief::EggCrate(0.1), Relief::EggCrate(0.2)]);
        reliefs.extend(models.map(Relief::Model));
    }
    let n_reliefs = reliefs.len() as f64;
    for (done, relief) in reliefs.into_iter().enumerate() {
        bench.step(0.2 * done as f64 / n_reliefs, &relief.name())?;
        let truth = relief.truth(n, bench.seed)?;
        let is_timed = relief == WEAVE || bench.effort == Effort::Full;
        for method in Method::OF_SHADING {
            let is_promised =
                matches!(relief, Relief::PlainWeave { .. }) && method == Method::Variational;
            let row = row((relief, &truth), (method, None), is_timed, bench);
            rows.extend(row.map(|row| row.promised(is_promised.then(promised_percent))));
        }
    }
    Ok(())
}

/// More iterations on one weave.
fn of_iterations(
    weave: &Truth,
    bench: &mut Bench<'_>,
    rows: &mut Vec<Row>,
) -> Result<(), ReportError> {
    let [sketch, variational]: [&[usize]; 2] = bench.effort.pick(
        [&[5, 200], &[4]],
        [&[1, 2, 5, 10, 20, 100, 200, 500], &[1, 2, 4, 8, 32, 64]],
    );
    for (method, counts) in [
        (Method::TsaiShah, sketch),
        (Method::Variational, variational),
    ] {
        for &n in counts {
            bench.step(0.3, &format!("{} × {n}", method.label()))?;
            rows.extend(row((WEAVE, weave), (method, Some(n)), true, bench));
        }
    }
    Ok(())
}

/// One thing about the light varied on one weave; correlations of every method.
fn of_sweep(
    weave: &Truth,
    (name, values): (&str, &[f64]),
    bench: &Bench<'_>,
    rows: &mut Vec<Row>,
) -> Vec<Series> {
    let mut curves = Vec::new();
    for method in Method::OF_SHADING {
        let mut points = Vec::new();
        for &value in values {
            let (mut light, mut noise) = (LIGHT, 0.0);
            match name {
                "slant" => light.slant_deg = value,
                "tilt" => light.tilt_deg = value,
                _ => noise = value,
            }
            let mut random = Random::new(bench.seed).branch("noise");
            let picture = weave.picture(light, noise, &mut random);
            let case = format!("{}, {name} {value}", WEAVE.name());
            if let Some(shape) = found(&picture, light, &options(method, None)) {
                let near = Near::of(&shape, &weave.height_px);
                points.push([value, near.correlation]);
                rows.push(near.row(method, format!("by {name}"), case));
            } else {
                let setting = format!("by {name}: refused");
                rows.push(Row::of(method.label(), setting, case));
            }
        }
        curves.push(Series::of(method.label(), Style::Line, points));
    }
    curves
}

fn plot(name: &str, label: &str, curves: Vec<Series>) -> Chart {
    chart(
        format!("Shading: correlation with the weave by {name}"),
        Axis::linear(label),
        Axis::linear("correlation of heights"),
        curves,
        format!(
            "A plain weave whose yarns touch; light from {}°, tilt {}°, where it is not varied.",
            LIGHT.slant_deg, LIGHT.tilt_deg
        ),
    )
}

/// How far the light that is estimated on the weave's own pictures is off.
fn of_estimates(weave: &Truth, bench: &Bench<'_>) -> String {
    let mut random = Random::new(bench.seed);
    let mut off = [Vec::new(), Vec::new()];
    for tilt_deg in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 120.0, 150.0] {
        let light = Light { tilt_deg, ..LIGHT };
        let picture = weave.picture(light, 0.0, &mut random);
        let Ok(estimate) = LightEstimate::of(&picture) else {
            continue;
        };
        let apart = (estimate.light.tilt_deg - tilt_deg).rem_euclid(180.0);
        off[0].push(apart.min(180.0 - apart));
        off[1].push((estimate.light.slant_deg - light.slant_deg).abs());
    }
    format!(
        "The light estimated on {} pictures of the weave from 45° is off by {:.0}° of tilt (up to \
         180°) and {:.0}° of slant in the mean: a weave has less contrast than the ball that the \
         estimate of the slant takes it for. Give the slant.",
        off[0].len(),
        mean(&off[0]),
        mean(&off[1])
    )
}
