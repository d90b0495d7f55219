//! The study of rendering: what each method costs, and how far it is from the reference.
//!
//! The product's methods at several settings, and tables that it might have had: other densities,
//! interpolations and digits, and one that ignores where bins cross 1 kHz.

mod known;
mod study_table;
mod this_scene;
mod total;
mod turning;

pub use this_scene::{Running, ThisSceneStudy};

use study_table::table_rows;
pub(crate) use total::STUDY as TOTAL;
pub(crate) use turning::STUDY as TURNING;

use super::{Bench, Findings, ReportError, Row, Study, textiles};
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity;
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::Pose;
use selvedge_render::{ErrorMeter, RenderScene};
use textiles::{amplitudes_um, poses_between, scene_with};

/// The speeds that are promised, mm/s.
const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 2000.0];
/// The level error that is promised, dB.
pub(crate) const PROMISED_DB: f64 = 0.05;
/// What is promised below a thousandth of the largest amplitude, as a share of it.
pub(crate) const PROMISED_SHARE: f64 = 6e-6;
/// Poses that a measurement of time goes through.
const N_TIMED: usize = 16;
/// Shares of an amplitude below which `banded` leaves bins out.
const FLOORS: [f64; 5] = [1e-6, 1e-4, 1e-3, 1e-2, 1e-1];
/// Error budgets of the product's table, dB.
const BUDGETS_DB: [f64; 4] = [0.5, PROMISED_DB, 0.01, 0.002];

/// Reference, banded and tables on four kinds of textile.
pub(crate) const STUDY: Study = Study {
    name: "rendering",
    chapter: "amplitudes",
    question: "How far is each method of rendering from the reference, and what does a tick of \
               24 contactors cost?",
    reference: "The method reference: f64, every bin below 1 kHz, on the very same poses; for the \
                last case, and for the reference itself, amplitudes computed to 60 digits \
                elsewhere.",
    error: ("level error", "dB"),
    cost_of: "tick of 24 contactors",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut findings = Findings::default();
    let mut cases = cases(bench)?;
    cases.push(known::case()?);
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

/// A textile, the poses it is felt at, and what the reference makes of them.
struct Case {
    name: String,
    scene: RenderScene,
    /// Tick by tick the pose of every display.
    poses: Vec<Vec<Pose>>,
    /// Pose by pose, contactor by contactor, µm.
    exact_um: Vec<[f64; 2]>,
    largest_um: [f64; 2],
}

fn cases(bench: &Bench<'_>) -> Result<Vec<Case>, ReportError> {
    let surfaces = [
        (
            "smooth: polyester satin",
            textiles::shipped("polyester-satin")?,
        ),
        ("coarse: jute", textiles::shipped("jute-plain")?),
        ("a single line", textiles::line(40)?),
        ("broadband: white noise", textiles::noise(bench.seed)?),
    ];
    let random = Random::new(bench.seed).branch("rendering");
    let n_poses = bench.effort.pick(60, 600);
    let case = |(name, surface): (&str, _)| {
        let poses = poses_between(SPEEDS_MM_PER_S, n_poses, &mut random.branch(name));
        let poses = poses.into_iter().map(|pose| vec![pose]).collect();
        Case::new(name.to_owned(), scene_with(&surface), poses)
    };
    surfaces.into_iter().map(case).collect()
}

impl Case {
    fn new(name: String, scene: RenderScene, poses: Vec<Vec<Pose>>) -> Result<Self, ReportError> {
        let mut reference = textiles::prepared(&scene, Method::Reference)?;
        let mut exact_um = Vec::new();
        for poses in &poses {
            exact_um.extend(amplitudes_um(&mut reference, poses));
        }
        Ok(Self::known(name, scene, poses, exact_um))
    }

    /// With amplitudes that are known.
    fn known(
        name: String,
        scene: RenderScene,
        poses: Vec<Vec<Pose>>,
        exact_um: Vec<[f64; 2]>,
    ) -> Self {
        let mut largest_um = [0.0_f64; 2];
        for amplitudes in &exact_um {
            (0..2).for_each(|b| largest_um[b] = largest_um[b].max(amplitudes[b]));
        }
        Self {
            name,
            scene,
            poses,
            exact_um,
            largest_um,
        }
    }

    /// A method's row: what `tick` makes of every pose against the reference, and its time.
    fn row(
        &self,
        bench: &mut Bench<'_>,
        (method, setting): (&str, String),
        mut tick: impl FnMut(&[Pose], &mut Vec<[f64; 2]>),
    ) -> Row {
        let mut found_um = Vec::new();
        let mut meter = ErrorMeter::new(self.largest_um);
        let mut exact_um = self.exact_um.iter();
        for poses in &self.poses {
            found_um.clear();
            tick(poses, &mut found_um);
            for (found, exact) in found_um.iter().zip(exact_um.by_ref()) {
                meter.add(*found, *exact);
            }
        }
        let error = meter.finish();
        let n_step = (self.poses.len() / N_TIMED).max(1);
        let timed: Vec<&Vec<Pose>> = self.poses.iter().step_by(n_step).collect();
        let cost = bench.time(timed.len(), || {
            for poses in &timed {
                found_um.clear();
                tick(poses, &mut found_um);
            }
        });
        Row::of(method, setting, &self.name)
            .error(error.max_db)
            .p99(error.p99_db)
            .cost(cost)
            .with("share_below", format!("{:e}", error.max_share_below))
            .with(
                "share_below_is_kept",
                error.max_share_below <= PROMISED_SHARE,
            )
            .with("n_amplitudes", error.n_amplitudes)
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
        let method_used = renderer.method();
        let row = self.row(bench, (method_used.name(), setting), |poses, out| {
            out.extend(amplitudes_um(&mut renderer, poses));
        });
        Ok(row
            .bytes(n_bytes)
            .with("bound_db", format!("{:e}", bound.level_db))
            .promised(promised_db(method_used, accuracy)))
    }
}

/// A method, what is said of its setting, and that setting.
type Configured = ((Method, String), Accuracy);

/// The methods of the product at several settings.
fn product_methods() -> Vec<Configured> {
    let default = Accuracy::default();
    let mut methods = vec![((Method::Reference, String::new()), default)];
    methods.extend(FLOORS.map(|banded_floor| {
        let setting = format!("floor {banded_floor:e}");
        let accuracy = Accuracy {
            banded_floor,
            ..default
        };
        ((Method::Banded, setting), accuracy)
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

#[cfg(test)]
mod tests;
