//! The study of rendering: what each method costs, and how far it is from the reference.
//!
//! The product's methods at several settings, and tables that it might have had: other densities,
//! interpolations and digits, and one that ignores where bins cross 1 kHz.

pub(super) mod cloths;
mod study_table;
mod this_scene;

pub use this_scene::{Running, ThisSceneStudy};

use std::sync::Arc;

use cloths::{exeter, placed, poses_between, scene_of};
use study_table::{Digits, Nodes, Reading, StudyTable};

use super::{Bench, Effort, Findings, ReportError, Row, Study};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::Pose;
use selvedge_render::{ErrorMeter, RenderScene};
use selvedge_textile::surface::Surface;

/// The speeds that are promised, mm/s.
const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 2000.0];
/// The level error that is promised, dB.
const PROMISED_DB: f64 = 0.05;
/// What is promised below a thousandth of the largest amplitude, as a share of it.
const PROMISED_SHARE: f64 = 6e-6;
/// Poses that a measurement of time goes through.
const N_TIMED: usize = 16;
/// Shares of an amplitude below which `banded` leaves bins out.
const FLOORS: [f64; 5] = [1e-6, 1e-4, 1e-3, 1e-2, 1e-1];
/// Error budgets of the product's table, dB.
const BUDGETS_DB: [f64; 4] = [0.5, PROMISED_DB, 0.01, 0.002];

/// Reference, banded and tables on four kinds of textile.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RenderingStudy;

impl Study for RenderingStudy {
    fn name(&self) -> &'static str {
        "rendering"
    }

    fn question(&self) -> &'static str {
        "How far is each method of rendering from the reference, and what does a tick of 24 \
         contactors cost?"
    }

    fn reference(&self) -> &'static str {
        "The method reference: f64, every bin below 1 kHz, on the very same poses."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("level error", "dB")
    }

    fn cost_of(&self) -> &'static str {
        "tick of 24 contactors"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let mut findings = Findings::default();
        let cases = cases(bench)?;
        let n_cases = cases.len() as f64;
        for (number, case) in cases.iter().enumerate() {
            let done = |share: f64| (number as f64 + share) / n_cases;
            bench.step(done(0.0), &case.name)?;
            for (named, accuracy) in product_methods() {
                findings
                    .rows
                    .push(case.product_row(bench, named, &accuracy)?);
            }
            bench.step(done(0.5), &case.name)?;
            findings.rows.extend(table_rows(bench, case)?);
        }
        let [slow, fast] = SPEEDS_MM_PER_S.map(|v| quantity::with_unit(v, 0, "mm/s"));
        findings.notes = vec![
            format!(
                "{} poses a textile, from {slow} to {fast}; a quarter of them just where a bin \
                 crosses 1 kHz.",
                cases.first().map_or(0, |case| case.poses.len())
            ),
            "Level errors are taken where the reference reaches a thousandth of its band's largest \
             amplitude; below, the largest difference stands as a share of that amplitude."
                .to_owned(),
            "Tables called linear, cubic and uncut exist in this study alone; the product renders \
             with reference, banded and table."
                .to_owned(),
        ];
        Ok(findings)
    }
}

/// A textile, the poses it is felt at, and what the reference makes of them.
struct Case {
    name: String,
    scene: RenderScene,
    poses: Vec<Pose>,
    /// Pose by pose, contactor by contactor, µm.
    exact_um: Vec<[f64; 2]>,
    largest_um: [f64; 2],
}

fn cases(bench: &Bench<'_>) -> Result<Vec<Case>, ReportError> {
    let cloths = [
        (
            "smooth: polyester satin",
            cloths::shipped("polyester-satin")?,
        ),
        ("coarse: jute", cloths::shipped("jute-plain")?),
        ("a single line", cloths::line(40)?),
        ("broadband: white noise", cloths::noise(bench.seed)?),
    ];
    let random = Random::new(bench.seed).branch("rendering");
    let n_poses = bench.effort.pick(60, 600);
    let case = |(name, surface): (&'static str, Arc<Surface>)| {
        let poses = poses_between(SPEEDS_MM_PER_S, n_poses, &mut random.branch(name));
        Case::new(name, &surface, poses)
    };
    cloths.into_iter().map(case).collect()
}

impl Case {
    fn new(
        name: &'static str,
        surface: &Arc<Surface>,
        poses: Vec<Pose>,
    ) -> Result<Self, ReportError> {
        let scene = scene_of(vec![placed(surface, Point::default())], exeter());
        Self::of(name.to_owned(), scene, poses)
    }

    fn of(name: String, scene: RenderScene, poses: Vec<Pose>) -> Result<Self, ReportError> {
        let mut reference =
            ArrayRenderer::prepare(&scene, Method::Reference, &Accuracy::default())?;
        let mut exact_um = Vec::new();
        let mut largest_um = [0.0_f64; 2];
        let mut display_poses = vec![Pose::default(); scene.displays.len()];
        for pose in &poses {
            display_poses.fill(*pose);
            exact_um.extend(amplitudes(&mut reference, &display_poses));
        }
        for amplitudes in &exact_um {
            (0..2).for_each(|b| largest_um[b] = largest_um[b].max(amplitudes[b]));
        }
        Ok(Self {
            name,
            scene,
            poses,
            exact_um,
            largest_um,
        })
    }

    /// A method's row: what `tick` makes of every pose against the reference, and its time.
    fn row(
        &self,
        bench: &mut Bench<'_>,
        (method, setting): (&str, String),
        mut tick: impl FnMut(&Pose, &mut Vec<[f64; 2]>),
    ) -> Row {
        let mut found_um = Vec::new();
        let mut meter = ErrorMeter::new(self.largest_um);
        let mut exact_um = self.exact_um.iter();
        for pose in &self.poses {
            found_um.clear();
            tick(pose, &mut found_um);
            for (found, exact) in found_um.iter().zip(exact_um.by_ref()) {
                meter.add(*found, *exact);
            }
        }
        let error = meter.finish();
        let n_step = (self.poses.len() / N_TIMED).max(1);
        let timed: Vec<Pose> = self.poses.iter().step_by(n_step).copied().collect();
        let cost = bench.time(timed.len(), || {
            for pose in &timed {
                found_um.clear();
                tick(pose, &mut found_um);
            }
        });
        let is_below = error.max_share_below <= PROMISED_SHARE;
        Row {
            method: method.to_owned(),
            setting,
            case: self.name.clone(),
            error: Some(error.max_db),
            error_p99: Some(error.p99_db),
            cost: Some(cost),
            more: vec![
                ("share_below", format!("{:e}", error.max_share_below)),
                ("share_below_is_kept", is_below.to_string()),
                ("n_amplitudes", error.n_amplitudes.to_string()),
            ],
            ..Row::default()
        }
    }

    /// The row of a renderer of the product.
    fn product_row(
        &self,
        bench: &mut Bench<'_>,
        (method, setting): (Method, String),
        accuracy: &Accuracy,
    ) -> Result<Row, ReportError> {
        let mut renderer = ArrayRenderer::prepare(&self.scene, method, accuracy)?;
        let (n_bytes, bound) = (renderer.n_bytes(), renderer.bound());
        let mut poses = vec![Pose::default(); self.scene.displays.len()];
        let method_used = renderer.method();
        let mut row = self.row(bench, (method_used.name(), setting), |pose, out| {
            poses.fill(*pose);
            out.extend(amplitudes(&mut renderer, &poses));
        });
        row.bytes = Some(n_bytes as u64);
        row.more.push(("bound_db", format!("{:e}", bound.level_db)));
        row.promised = promised_db(method_used, accuracy);
        Ok(row)
    }
}

/// All amplitudes of all displays at their poses, µm.
fn amplitudes(renderer: &mut ArrayRenderer, poses: &[Pose]) -> impl Iterator<Item = [f64; 2]> {
    let frames = renderer.tick(poses).iter();
    frames
        .flat_map(|frame| (0..frame.n_contactors()).map(|contactor| frame.amplitude_um(contactor)))
}

/// A method, what is said of its setting, and that setting.
type Configured = ((Method, String), Accuracy);

/// The methods of the product at several settings.
fn product_methods() -> Vec<Configured> {
    let default = Accuracy::default();
    let mut methods = vec![((Method::Reference, String::new()), default)];
    methods.extend(FLOORS.map(|banded_floor| {
        let accuracy = Accuracy {
            banded_floor,
            ..default
        };
        (
            (Method::Banded, format!("floor {banded_floor:e}")),
            accuracy,
        )
    }));
    methods.extend(BUDGETS_DB.map(|budget_db| {
        let setting = format!("within {budget_db} dB");
        ((Method::Table, setting), Accuracy::within_db(budget_db))
    }));
    methods
}

/// The error that a method promises at a setting, dB.
fn promised_db(method: Method, accuracy: &Accuracy) -> Option<f64> {
    let default_floor = Accuracy::default().banded_floor;
    let has_default_floor = accuracy.banded_floor.to_bits() == default_floor.to_bits();
    match method {
        Method::Banded => has_default_floor.then_some(PROMISED_DB),
        Method::Table => Some(accuracy.budget_db),
        Method::Reference | Method::Auto => None,
    }
}

/// The tables that the product might have had.
fn table_rows(bench: &mut Bench<'_>, case: &Case) -> Result<Vec<Row>, ReportError> {
    let densities: &[usize] = match bench.effort {
        Effort::Quick => &[2, 24, 48],
        Effort::Full => &[2, 6, 12, 24, 48, 96],
    };
    let mut rows = Vec::new();
    for &per_octave in densities {
        bench.step(0.5, &case.name)?;
        let nodes = Nodes::new(per_octave, true);
        let table = StudyTable::new(&case.scene, nodes, Reading::Linear);
        for reading in Reading::BOTH {
            rows.push(table_row(
                bench,
                case,
                per_octave,
                &table.as_read::<f32>(reading),
            ));
            rows.push(table_row(
                bench,
                case,
                per_octave,
                &table.as_read::<f64>(reading),
            ));
        }
    }
    let per_octave = 48;
    let uncut = StudyTable::new(&case.scene, Nodes::new(per_octave, false), Reading::Cubic);
    rows.push(table_row(bench, case, per_octave, &uncut));
    Ok(rows)
}

fn table_row<T: Digits>(
    bench: &mut Bench<'_>,
    case: &Case,
    per_octave: usize,
    table: &StudyTable<T>,
) -> Row {
    let setting = format!("{per_octave} nodes an octave");
    let mut row = case.row(bench, (&table.name(), setting), |pose, out| {
        out.resize(case.exact_um.len() / case.poses.len().max(1), [0.0; 2]);
        table.tick(pose, out);
    });
    row.bytes = Some(table.n_bytes() as u64);
    row
}

#[cfg(test)]
mod tests;
