//! The study of the areal representation: what one profile a direction, repeated across, costs in
//! level beside spectra at every point of the cloth, and what the points cost in time and memory.

mod cases;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use cases::Case;

use super::chart::chart;
use super::readable::{deviation, mean};
use super::{Bench, Findings, ReportError, Row, Study, textiles};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::numerics::{Random, median, quantile};
use selvedge_foundation::quantity::{level_db, with_unit};
use selvedge_render::array::Method;
use selvedge_render::scene::Pose;
use selvedge_textile::surface::Surface;
use textiles::{amplitudes_um, poses_between, scene_with};

/// Speeds of exploring fingers, mm/s.
const SPEEDS_MM_PER_S: [f64; 2] = [20.0, 300.0];
/// Amplitudes are compared where they are at least this share of the band's largest.
const LEAST_SHARE: f64 = 1e-3;
/// Poses that a measurement of time goes through.
const N_TIMED: usize = 16;
/// The level error that tables promise, and the reference where all is known, dB.
const PROMISED_DB: f64 = 0.05;
const KNOWN_DB: f64 = 1e-9;

/// Economical against areal, on model cloths and a random relief.
pub(crate) const STUDY: Study = Study {
    name: "areal",
    chapter: "spectra",
    question: "How far is one profile a direction, repeated across, from spectra at every point, \
               and what do the points cost?",
    reference: "The areal surface of the same relief, rendered by reference: contactor by \
                contactor; of waves that grow across the closed form of every contactor, which \
                judges that reference too.",
    error: ("level error", "dB"),
    cost_of: "tick of 24 contactors",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
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
    let plot = chart(
        "One profile a direction beside every point",
        Axis::linear("level error of a contactor, dB"),
        Axis::linear("share of errors below, %").within([0.0, 100.0]),
        series,
        "Random places and strokes of 20 to 300 mm/s; the tester's wire of 5 mm.",
    );
    findings.plots = vec![("areal-errors".to_owned(), plot)];
    Ok(findings)
}

/// A case on random poses: what is felt of each surface.
struct Felt {
    poses: Vec<Pose>,
    /// Level errors of the economical surfaces, dB with sign, by wire: as in [`Case`].
    errors_db: [Vec<f64>; 2],
    /// Standard deviation of the level over the contactors of a display, dB, in the median over
    /// poses and bands: economical with the tester's wire, and areal.
    spread_db: [f64; 2],
    /// Largest level errors of the areal tables, and of the reference where all is known, dB.
    table_db: f64,
    reference_db: Option<f64>,
}

impl Felt {
    fn of(case: &Case, bench: &Bench<'_>) -> Result<Self, ReportError> {
        let mut random = Random::new(bench.seed).branch(&case.name);
        let n_poses = bench.effort.pick(40, 400);
        let mut poses = poses_between(SPEEDS_MM_PER_S, n_poses, &mut random);
        if case.is_known {
            for pose in &mut poses {
                pose.velocity.y_mm_per_s = 0.0;
            }
        }
        let felt = |surface, method| amplitudes(surface, method, &poses);
        let reference = felt(&case.areal, Method::Reference)?;
        let known = case.is_known.then(|| poses.iter().map(known).collect());
        let largest = |most: f64, db: &f64| most.max(db.abs());
        let worst_db = |found: &[Vec<[f64; 2]>], exact: &[Vec<[f64; 2]>]| {
            errors_db_of_table(found, exact).iter().fold(0.0, largest)
        };
        let reference_db = known
            .as_ref()
            .map(|known: &Vec<_>| worst_db(&reference, known));
        let exact = known.unwrap_or(reference);
        let [kes, narrow] = &case.economical;
        let economical = [
            felt(kes, Method::Reference)?,
            felt(narrow, Method::Reference)?,
        ];
        let table = felt(&case.areal, Method::Table)?;
        let errors_db = economical.each_ref().map(|own| errors_db(own, &exact));
        Ok(Self {
            spread_db: [spread_db(&economical[0]), spread_db(&exact)],
            table_db: worst_db(&table, &exact),
            reference_db,
            errors_db,
            poses,
        })
    }

    fn rows(&self, case: &Case, bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
        let mut rows = Vec::new();
        let settings = ["one profile, wire of 5 mm", "one profile, wire of 1 mm"];
        for (setting, errors) in settings.into_iter().zip(&self.errors_db) {
            let mut sizes = magnitudes(errors);
            let row = Row::of("economical", setting, &case.name)
                .error(sizes.iter().copied().reduce(f64::max))
                .p99(quantile(&mut sizes, 0.99))
                .number("median_error_db", 3, quantile(&mut sizes, 0.5))
                .number("mean_offset_db", 3, mean(errors))
                .number("spread_db", 3, self.spread_db[0]);
            rows.push(row);
        }
        let row = Row::of("areal", "every mm, tables made on first touch", &case.name)
            .error(self.table_db)
            .promised(PROMISED_DB)
            .with("median_error_db", "")
            .with("mean_offset_db", "")
            .number("spread_db", 3, self.spread_db[1]);
        rows.push(row);
        let [kes, narrow] = &case.economical;
        let mut rows = self.add_costs(rows, [kes, narrow, &case.areal], bench)?;
        rows.extend(self.reference_db.map(|db| {
            let row = Row::of("areal", "by reference", &case.name).error(db);
            row.promised(KNOWN_DB)
        }));
        Ok(rows)
    }

    /// What a tick over each surface costs once all is made, also as a multiple of the first's;
    /// what preparing costs, and what is kept in memory.
    fn add_costs(
        &self,
        rows: Vec<Row>,
        surfaces: [&Arc<Surface>; 3],
        bench: &mut Bench<'_>,
    ) -> Result<Vec<Row>, ReportError> {
        let poses = &self.poses[..N_TIMED];
        let (mut prepared, mut strokes) = (Vec::new(), Vec::new());
        for (row, surface) in rows.into_iter().zip(surfaces) {
            let scene = scene_with(surface);
            let mut renderer = textiles::prepared(&scene, Method::Table)?;
            let preparing = bench.time(1, || textiles::prepared(&scene, Method::Table).is_ok());
            let row = row
                .bytes(renderer.n_bytes())
                .number("preparing_ms", 3, 1e3 * preparing.cpu_s)
                .with("points", cases::n_points(surface));
            prepared.push(row);
            strokes.push(move || {
                for pose in poses {
                    renderer.tick(std::slice::from_ref(pose));
                }
            });
        }
        let costs = bench.time_in_turn(N_TIMED, strokes).into_iter();
        let with_cost = |(row, (cost, multiple)): (Row, (_, f64))| {
            row.cost(cost).number("times_the_first", 3, multiple)
        };
        Ok(prepared.into_iter().zip(costs).map(with_cost).collect())
    }

    fn note(&self, case: &str) -> String {
        let median_db = |errors: &Vec<f64>| quantile(&mut magnitudes(errors), 0.5);
        let [errors, narrow] = self.errors_db.each_ref().map(median_db);
        let [economical, areal] = self.spread_db;
        let db = |db: f64| with_unit(db, 1, "dB");
        format!(
            "{case}: one profile is {} off in the median ({} in the mean), {} with a wire of 1 mm; \
             levels of the 24 contactors spread by {}, areally by {}.",
            db(errors),
            db(mean(&self.errors_db[0])),
            db(narrow),
            db(economical),
            db(areal)
        )
    }

    /// The share of level errors below so many dB.
    fn shares(&self, name: &str) -> Series {
        let mut sizes = magnitudes(&self.errors_db[0]);
        let point = |percent: u32| {
            let share = f64::from(percent) / 100.0;
            [quantile(&mut sizes, share), f64::from(percent)]
        };
        Series::of(name, Style::Dots, (0..=100).step_by(2).map(point))
    }
}

/// Amplitudes of all contactors at a pose along the warp of the waves, µm.
fn known(pose: &Pose) -> Vec<[f64; 2]> {
    let speed_mm_per_s = pose.velocity.x_mm_per_s.abs();
    let offsets = textiles::exeter().offsets;
    let at = |offset| cases::known_um((pose.position + offset).y_mm, speed_mm_per_s);
    offsets.into_iter().map(at).collect()
}

fn magnitudes(errors: &[f64]) -> Vec<f64> {
    errors.iter().map(|error| error.abs()).collect()
}

/// Amplitudes of all contactors at every pose, µm.
fn amplitudes(
    surface: &Arc<Surface>,
    method: Method,
    poses: &[Pose],
) -> Result<Vec<Vec<[f64; 2]>>, ReportError> {
    let mut renderer = textiles::prepared(&scene_with(surface), method)?;
    let tick = |pose: &Pose| amplitudes_um(&mut renderer, std::slice::from_ref(pose)).collect();
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
        deviation(&levels)
    };
    let frames = felt.iter();
    let spreads = frames.flat_map(|frame| [of_frame(frame, 0), of_frame(frame, 1)]);
    median(&mut spreads.filter(|db| db.is_finite()).collect::<Vec<f64>>())
}
