//! The study of the areal representation: what one profile a direction, repeated across, costs in
//! level beside spectra at every point of the cloth, and what the points cost in time and memory.

mod cases;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use cases::Case;

use super::rendering::cloths::{exeter, placed, poses_between, scene_of};
use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart, Series};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::{Random, quantile};
use selvedge_foundation::quantity::{level_db, with_unit};
use selvedge_render::RenderScene;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::Pose;
use selvedge_textile::surface::Surface;

/// Speeds of exploring fingers, mm/s.
const SPEEDS_MM_PER_S: [f64; 2] = [20.0, 300.0];
/// Amplitudes are compared where they are at least this share of the band's largest.
const LEAST_SHARE: f64 = 1e-3;
/// Poses that a measurement of time goes through.
const N_TIMED: usize = 16;
/// The level error that tables promise, dB.
const PROMISED_DB: f64 = 0.05;

/// Economical against areal, on model cloths and a random relief.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ArealStudy;

impl Study for ArealStudy {
    fn name(&self) -> &'static str {
        "areal"
    }

    fn question(&self) -> &'static str {
        "How far is one profile a direction, repeated across, from spectra at every point, and \
         what do the points cost?"
    }

    fn reference(&self) -> &'static str {
        "The areal surface of the same relief, rendered by reference: contactor by contactor."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("level error", "dB")
    }

    fn cost_of(&self) -> &'static str {
        "tick of 24 contactors"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let names = cases::names(bench.effort);
        let mut findings = Findings::default();
        let mut series = Vec::new();
        for (number, name) in names.iter().enumerate() {
            bench.step(number as f64 / names.len() as f64, name)?;
            let case = Case::of(name, bench.seed)?;
            let felt = Felt::of(&case, bench)?;
            series.push(felt.shares(&case.name));
            findings.rows.extend(felt.rows(&case, bench)?);
            findings.notes.push(felt.note(&case.name));
        }
        findings.plots = vec![("areal-errors".to_owned(), plot(series))];
        Ok(findings)
    }
}

/// A case on random poses: what is felt of each surface.
struct Felt {
    poses: Vec<Pose>,
    /// Level errors of the economical surfaces, dB with sign, by wire: as in [`Case`].
    errors_db: [Vec<f64>; 2],
    /// Standard deviation of the level over the contactors of a display, dB, in the median over
    /// poses and bands: economical with the tester's wire, and areal.
    spread_db: [f64; 2],
    /// Largest level error of the areal tables, dB.
    table_db: f64,
}

impl Felt {
    fn of(case: &Case, bench: &Bench<'_>) -> Result<Self, ReportError> {
        let mut random = Random::new(bench.seed).branch(&case.name);
        let n_poses = bench.effort.pick(40, 400);
        let poses = poses_between(SPEEDS_MM_PER_S, n_poses, &mut random);
        let felt = |surface, method| amplitudes(surface, method, &poses);
        let exact = felt(&case.areal, Method::Reference)?;
        let [kes, narrow] = &case.economical;
        let economical = [
            felt(kes, Method::Reference)?,
            felt(narrow, Method::Reference)?,
        ];
        let table = felt(&case.areal, Method::Table)?;
        let errors_db = economical.each_ref().map(|own| errors_db(own, &exact));
        let largest = |most: f64, db: &f64| most.max(db.abs());
        Ok(Self {
            spread_db: [spread_db(&economical[0]), spread_db(&exact)],
            table_db: errors_db_of_table(&table, &exact).iter().fold(0.0, largest),
            errors_db,
            poses,
        })
    }

    fn rows(&self, case: &Case, bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
        let mut rows = Vec::new();
        let settings = ["one profile, wire of 5 mm", "one profile, wire of 1 mm"];
        for (setting, errors) in settings.into_iter().zip(&self.errors_db) {
            let mut sizes: Vec<f64> = errors.iter().map(|db| db.abs()).collect();
            let row = Row {
                method: "economical".to_owned(),
                setting: setting.to_owned(),
                error: sizes.iter().copied().reduce(f64::max),
                error_p99: Some(quantile(&mut sizes, 0.99)),
                more: vec![
                    ("median_error_db", number(quantile(&mut sizes, 0.5))),
                    ("mean_offset_db", number(mean(errors))),
                    ("spread_db", number(self.spread_db[0])),
                ],
                ..Row::default()
            };
            rows.push(row);
        }
        rows.push(Row {
            method: "areal".to_owned(),
            setting: "every mm, tables made on first touch".to_owned(),
            error: Some(self.table_db),
            promised: Some(PROMISED_DB),
            more: vec![
                ("median_error_db", String::new()),
                ("mean_offset_db", String::new()),
                ("spread_db", number(self.spread_db[1])),
            ],
            ..Row::default()
        });
        let [kes, narrow] = &case.economical;
        self.add_costs(&mut rows, [kes, narrow, &case.areal], bench)?;
        for row in &mut rows {
            row.case.clone_from(&case.name);
        }
        Ok(rows)
    }

    /// What a tick over each surface costs once all is made, also as a multiple of the first's;
    /// what preparing costs, and what is kept in memory.
    fn add_costs(
        &self,
        rows: &mut [Row],
        surfaces: [&Arc<Surface>; 3],
        bench: &mut Bench<'_>,
    ) -> Result<(), ReportError> {
        let mut renderers = Vec::new();
        for (row, surface) in rows.iter_mut().zip(surfaces) {
            let scene = scene(surface);
            let renderer = prepared(&scene, Method::Table)?;
            let preparing = bench.time(1, || prepared(&scene, Method::Table).is_ok());
            row.bytes = u64::try_from(renderer.n_bytes()).ok();
            row.more.extend([
                ("preparing_ms", number(1e3 * preparing.cpu_s)),
                ("points", cases::n_points(surface).to_string()),
            ]);
            renderers.push(renderer);
        }
        let poses = &self.poses[..N_TIMED];
        let stroke = |mut renderer: ArrayRenderer| {
            move || {
                for pose in poses {
                    renderer.tick(std::slice::from_ref(pose));
                }
            }
        };
        let strokes = renderers.into_iter().map(stroke).collect();
        let costs = bench.time_in_turn(N_TIMED, strokes);
        for (row, (cost, multiple)) in rows.iter_mut().zip(costs) {
            row.cost = Some(cost);
            row.more.push(("times_the_first", number(multiple)));
        }
        Ok(())
    }

    fn note(&self, case: &str) -> String {
        let [errors, narrow] = self.errors_db.each_ref().map(|errors| {
            let mut sizes: Vec<f64> = errors.iter().map(|db| db.abs()).collect();
            with_unit(quantile(&mut sizes, 0.5), 1, "dB")
        });
        let offset = with_unit(mean(&self.errors_db[0]), 1, "dB");
        let [economical, areal] = self.spread_db.map(|db| with_unit(db, 1, "dB"));
        format!(
            "{case}: one profile is {errors} off in the median ({offset} in the mean), {narrow} \
             with a wire of 1 mm; levels of the 24 contactors spread by {economical}, areally by \
             {areal}."
        )
    }

    /// The share of level errors below so many dB.
    fn shares(&self, name: &str) -> Series {
        let mut sizes: Vec<f64> = self.errors_db[0].iter().map(|db| db.abs()).collect();
        let point = |percent: u32| {
            let share = f64::from(percent) / 100.0;
            [quantile(&mut sizes, share), f64::from(percent)]
        };
        Series {
            name: name.to_owned(),
            points: (0..=100).step_by(2).map(point).collect(),
            ..Series::default()
        }
    }
}

fn scene(surface: &Arc<Surface>) -> RenderScene {
    scene_of(vec![placed(surface, Point::default())], exeter())
}

fn prepared(scene: &RenderScene, method: Method) -> Result<ArrayRenderer, ReportError> {
    let accuracy = Accuracy::within_db(PROMISED_DB);
    Ok(ArrayRenderer::prepare(scene, method, &accuracy)?)
}

/// Amplitudes of all contactors at every pose, µm.
fn amplitudes(
    surface: &Arc<Surface>,
    method: Method,
    poses: &[Pose],
) -> Result<Vec<Vec<[f64; 2]>>, ReportError> {
    let mut renderer = prepared(&scene(surface), method)?;
    let tick = |pose: &Pose| {
        let frame = &renderer.tick(std::slice::from_ref(pose))[0];
        let of_contactor = |contactor| frame.amplitude_um(contactor);
        (0..frame.n_contactors()).map(of_contactor).collect()
    };
    Ok(poses.iter().map(tick).collect())
}

/// Level errors of amplitudes, dB with sign, where both can be felt.
fn errors_db(found: &[Vec<[f64; 2]>], exact: &[Vec<[f64; 2]>]) -> Vec<f64> {
    let pairs = || found.iter().flatten().zip(exact.iter().flatten());
    let mut errors = Vec::new();
    for b in 0..2 {
        let least = LEAST_SHARE * pairs().map(|(_, exact)| exact[b]).fold(0.0, f64::max);
        let felt = pairs().filter(|(found, exact)| exact[b] >= least && found[b] >= least);
        errors.extend(felt.map(|(found, exact)| level_db(found[b] / exact[b])));
    }
    errors.retain(|db| db.is_finite());
    errors
}

/// The same of tables, for which a silent amplitude is an error too.
fn errors_db_of_table(found: &[Vec<[f64; 2]>], exact: &[Vec<[f64; 2]>]) -> Vec<f64> {
    let floored = |frames: &[Vec<[f64; 2]>]| -> Vec<Vec<[f64; 2]>> {
        let floor = |pair: &[f64; 2]| pair.map(|um| um.max(1e-12));
        let frame = |frame: &Vec<[f64; 2]>| frame.iter().map(floor).collect();
        frames.iter().map(frame).collect()
    };
    errors_db(&floored(found), exact)
}

/// Standard deviation of the level over a display, dB, in the median over poses and bands.
fn spread_db(felt: &[Vec<[f64; 2]>]) -> f64 {
    let of_frame = |frame: &Vec<[f64; 2]>, b: usize| {
        let levels: Vec<f64> = frame.iter().map(|pair| level_db(pair[b])).collect();
        let mean = mean(&levels);
        let squares = levels.iter().map(|db| (db - mean).powi(2)).sum::<f64>();
        (squares / levels.len() as f64).sqrt()
    };
    let mut spreads: Vec<f64> = felt
        .iter()
        .flat_map(|frame| [of_frame(frame, 0), of_frame(frame, 1)])
        .filter(|db| db.is_finite())
        .collect();
    selvedge_foundation::numerics::median(&mut spreads)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn number(value: f64) -> String {
    format!("{value:.3}")
}

fn plot(series: Vec<Series>) -> Chart {
    Chart {
        title: "One profile a direction beside every point".to_owned(),
        x: Axis::linear("level error of a contactor, dB"),
        y: Axis::linear("share of errors below, %").within([0.0, 100.0]),
        series,
        footnote: "Random places and strokes of 20 to 300 mm/s; the tester's wire of 5 mm."
            .to_owned(),
        ..Chart::default()
    }
}
