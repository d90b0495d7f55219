//! The study of growth: how the cost of rendering rises with contactors, textiles and ticks.
//!
//! For each, costs at several sizes and the exponent of the power law that fits them best.

use std::sync::Arc;

use super::rendering::cloths::{self, WIDTH_MM, exeter, placed, scene_of};
use super::{Bench, Effort, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::geometry::{Displacement, Point, Velocity};
use selvedge_foundation::quantity;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{Pose, TICKS_PER_S};
use selvedge_render::{ContactorArray, RenderScene};
use selvedge_textile::surface::Surface;

/// Methods that are compared.
const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];
/// Contactors times textiles times ticks that the reference is asked for at most.
const MOST_OF_REFERENCE: usize = 60_000;
/// How far apart textiles lie, mm.
const GAP_MM: f64 = 5.0;
/// Textiles in a row.
const PER_ROW: usize = 10;

/// Cost over contactors, textiles and ticks a second.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GrowthStudy;

impl Study for GrowthStudy {
    fn name(&self) -> &'static str {
        "growth"
    }

    fn question(&self) -> &'static str {
        "How does the cost of a second of exploration grow with contactors, textiles and ticks?"
    }

    fn reference(&self) -> &'static str {
        "None: only cost is asked about."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("error", "none")
    }

    fn cost_of(&self) -> &'static str {
        "second of exploration"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let surfaces = surfaces(bench)?;
        let mut findings = Findings::default();
        for (number, grown) in Grown::ALL.into_iter().enumerate() {
            let mut series = Vec::new();
            for method in METHODS {
                let done = number as f64 / Grown::ALL.len() as f64;
                bench.step(done, grown.name())?;
                let rows = rows(bench, &surfaces, (grown, method))?;
                let points = points(&rows);
                if let Some(exponent) = exponent(&points) {
                    findings.notes.push(format!(
                        "{}: cost grows with {} to the power {}.",
                        method.name(),
                        grown.name(),
                        quantity::fixed(exponent, 2)
                    ));
                }
                series.push(Series {
                    name: method.name().to_owned(),
                    points,
                    style: Style::LineAndDots,
                    ..Series::default()
                });
                findings.rows.extend(rows);
            }
            findings
                .plots
                .push((grown.file().to_owned(), plot(grown, series)));
        }
        Ok(findings)
    }
}

/// What grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Grown {
    Contactors,
    Textiles,
    Ticks,
}

impl Grown {
    const ALL: [Self; 3] = [Self::Contactors, Self::Textiles, Self::Ticks];

    fn name(self) -> &'static str {
        match self {
            Self::Contactors => "contactors",
            Self::Textiles => "textiles",
            Self::Ticks => "ticks a second",
        }
    }

    fn file(self) -> &'static str {
        match self {
            Self::Contactors => "growth-contactors",
            Self::Textiles => "growth-textiles",
            Self::Ticks => "growth-ticks",
        }
    }

    fn sizes(self, effort: Effort) -> &'static [usize] {
        match (self, effort) {
            (Self::Contactors, Effort::Full) => &[24, 100, 300, 1000, 3000, 10_000],
            (Self::Contactors, Effort::Quick) => &[24, 100, 10_000],
            (Self::Textiles, Effort::Full) => &[1, 4, 10, 30, 100],
            (Self::Textiles, Effort::Quick) => &[1, 10, 100],
            (Self::Ticks, Effort::Full) => &[40, 100, 250, 500, 1000],
            (Self::Ticks, Effort::Quick) => &[40, 200, 1000],
        }
    }

    /// Contactors, textiles and ticks a second at a size.
    fn at(self, size: usize) -> [usize; 3] {
        match self {
            Self::Contactors => [size, 1, 40],
            Self::Textiles => [24, size, 40],
            Self::Ticks => [24, 1, size],
        }
    }
}

/// A few surfaces that many textiles share.
fn surfaces(bench: &Bench<'_>) -> Result<Vec<Arc<Surface>>, ReportError> {
    let weave = cloths::shipped("denim")?;
    Ok(vec![weave, cloths::noise(bench.seed)?])
}

/// A row a size: the cost of one second by one method.
fn rows(
    bench: &mut Bench<'_>,
    surfaces: &[Arc<Surface>],
    (grown, method): (Grown, Method),
) -> Result<Vec<Row>, ReportError> {
    let mut rows = Vec::new();
    for &size in grown.sizes(bench.effort) {
        let [n_contactors, n_textiles, n_ticks] = grown.at(size);
        let is_heavy = n_contactors * n_ticks > bench.effort.pick(6000, MOST_OF_REFERENCE);
        if is_heavy && method == Method::Reference {
            continue;
        }
        let scene = scene(surfaces, n_contactors, n_textiles);
        let mut renderer = ArrayRenderer::prepare(&scene, method, &Accuracy::default())?;
        let poses = second(n_ticks, n_textiles);
        let cost = bench.time(1, || {
            for pose in &poses {
                renderer.tick(std::slice::from_ref(pose));
            }
        });
        let per_touch_s = cost.cpu_s / (n_ticks * n_contactors) as f64;
        rows.push(Row {
            method: method.name().to_owned(),
            setting: format!("{n_contactors} contactors, {n_textiles} textiles, {n_ticks} Hz"),
            case: grown.name().to_owned(),
            size: Some(size as f64),
            cost: Some(cost),
            bytes: Some(renderer.n_bytes() as u64),
            more: vec![("ns_per_contactor_tick", format!("{}", per_touch_s * 1e9))],
            ..Row::default()
        });
    }
    Ok(rows)
}

/// Textiles side by side under a square of contactors 0.1 mm apart, or under the 24.
fn scene(surfaces: &[Arc<Surface>], n_contactors: usize, n_textiles: usize) -> RenderScene {
    let place = |number: usize| {
        let [column, row] = [number % PER_ROW, number / PER_ROW].map(|n| n as f64);
        let pitch_mm = WIDTH_MM + GAP_MM;
        let origin = Point::new(column * pitch_mm, row * pitch_mm);
        placed(&surfaces[number % surfaces.len()], origin)
    };
    let array = if n_contactors == 24 {
        exeter()
    } else {
        square(n_contactors)
    };
    scene_of((0..n_textiles).map(place).collect(), array)
}

/// Contactors 0.1 mm apart, row by row in a square.
pub(super) fn square(n_contactors: usize) -> ContactorArray {
    let n_columns = n_contactors.saturating_sub(1).isqrt() + 1;
    let middle = (n_columns as f64 - 1.0) / 2.0;
    let offset = |n: usize| {
        let [column, row] = [n % n_columns, n / n_columns].map(|n| n as f64);
        Displacement::new((column - middle) * 0.1, (middle - row) * 0.1)
    };
    ContactorArray {
        offsets: (0..n_contactors).map(offset).collect(),
        rotation_deg: 0.0,
    }
}

/// One second aslant over the middle of the textile in the middle of all.
fn second(n_ticks: usize, n_textiles: usize) -> Vec<Pose> {
    let middle = n_textiles / 2;
    let corner = [middle % PER_ROW, middle / PER_ROW].map(|n| n as f64 * (WIDTH_MM + GAP_MM));
    let velocity = Velocity::new(60.0, 37.0);
    let pose = |n: usize| {
        let t_s = n as f64 / n_ticks as f64;
        let x_mm = corner[0] + 20.0 + velocity.x_mm_per_s * t_s;
        let y_mm = corner[1] + 20.0 + velocity.y_mm_per_s * t_s;
        // Every stroke of a finger varies in speed, so no tick repeats the one before.
        let swing = 1.0 + 0.2 * (t_s * 2.0 * TICKS_PER_S).sin();
        Pose {
            t_s,
            position: Point::new(x_mm, y_mm),
            velocity: Velocity::new(velocity.x_mm_per_s * swing, velocity.y_mm_per_s * swing),
            ..Pose::default()
        }
    };
    (0..n_ticks).map(pose).collect()
}

/// Size and CPU time of rows.
fn points(rows: &[Row]) -> Vec<[f64; 2]> {
    let point = |row: &Row| Some([row.size?, row.cost?.cpu_s]);
    rows.iter().filter_map(point).collect()
}

/// The exponent e of `cost = c·sizeᵉ` that fits best over the logarithms; `None` of less than two
/// points.
pub(super) fn exponent(points: &[[f64; 2]]) -> Option<f64> {
    let logs = points.iter().filter(|[x, y]| *x > 0.0 && *y > 0.0);
    let logs: Vec<[f64; 2]> = logs.map(|point| point.map(f64::ln)).collect();
    let n = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|point| point[axis]).sum::<f64>() / n;
    let [mean_x, mean_y] = [mean(0), mean(1)];
    let (mut squares, mut products) = (0.0, 0.0);
    for [x, y] in &logs {
        squares += (x - mean_x).powi(2);
        products += (x - mean_x) * (y - mean_y);
    }
    (squares > 0.0).then(|| products / squares)
}

fn plot(grown: Grown, mut series: Vec<Series>) -> Chart {
    let first = series
        .last()
        .and_then(|series| series.points.first().copied());
    if let Some([size, cost_s]) = first {
        let sizes = grown.sizes(Effort::Full);
        let ends = [sizes.first(), sizes.last()].into_iter().flatten();
        let in_proportion = |&end: &usize| [end as f64, cost_s * end as f64 / size];
        series.push(Series {
            name: "in proportion".to_owned(),
            points: ends.map(in_proportion).collect(),
            style: Style::Dashed,
            ..Series::default()
        });
    }
    Chart {
        title: format!("Cost of a second of exploration over {}", grown.name()),
        x: Axis::log(grown.name()),
        y: Axis::log("CPU time for a second, s"),
        series,
        footnote: String::new(),
        ..Chart::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn the_exponent_of_a_power_law_is_found() {
        let cubic = |x: f64| [x, 7.0 * x.powi(3)];
        let found = exponent(&[cubic(1.0), cubic(4.0), cubic(90.0)]).unwrap();
        assert!((found - 3.0).abs() < 1e-12, "{found}");
        assert_eq!(exponent(&[]), None);
        assert_eq!(exponent(&[[2.0, 3.0]]), None);
        assert_eq!(exponent(&[[2.0, 3.0], [0.0, f64::NAN]]), None);
    }

    #[test]
    fn every_size_costs_something_and_is_plotted() {
        let findings = quick(&GrowthStudy, 1);
        assert_eq!(findings.plots.len(), 3);
        assert_eq!(findings.notes.len(), 9, "{:?}", findings.notes);
        for grown in Grown::ALL {
            let of_case = findings.rows.iter().filter(|row| row.case == grown.name());
            let tables: Vec<&Row> = of_case.filter(|row| row.method == "table").collect();
            assert_eq!(tables.len(), grown.sizes(Effort::Quick).len());
        }
        for row in &findings.rows {
            assert!(
                row.cost.is_some() && row.size.is_some() && row.error.is_none(),
                "{row:?}"
            );
        }
        let n_dots: usize = findings
            .plots
            .iter()
            .flat_map(|(_, plot)| &plot.series)
            .filter(|series| series.style == Style::LineAndDots)
            .map(|series| series.points.len())
            .sum();
        assert_eq!(n_dots, findings.rows.len());
    }

    #[test]
    fn textiles_and_contactors_are_as_many_as_asked_for() {
        let surfaces = [cloths::line(3).unwrap()];
        let scene = scene(&surfaces, 300, 30);
        assert_eq!(scene.textiles.len(), 30);
        assert_eq!(scene.displays[0].offsets.len(), 300);
        let mut renderer =
            ArrayRenderer::prepare(&scene, Method::Table, &Accuracy::default()).unwrap();
        for pose in second(40, 30) {
            let frame = &renderer.tick(&[pose])[0];
            assert_eq!(frame.textile(7), Some(15), "the middle one");
        }
    }
}
