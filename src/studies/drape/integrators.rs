//! Error against run time of every integrator, on cloths that swing, fall and are stretched between
//! fingers; what preconditioners save; and what sleep saves.

use std::f64::consts::PI;
use std::time::Instant;

use super::{Sample, left_j, off_mm, pinch, speed};
use crate::chart::{chart, error_against_time, place};
use crate::readable::{number, whole};
use crate::{Bench, Effort, Findings, ReportError, Row, Study, Timing};
use selvedge_chart::{Axis, Chart, Style};
use selvedge_drape::{Drape, GRAVITY, Hand, Integrator};
use selvedge_foundation::progress::thread_cpu_seconds;

/// Error against run time.
pub(crate) const STUDY: Study = Study {
    name: "drape",
    chapter: "cloth",
    question: "How should a hanging cloth be stepped, and what does it cost?",
    reference: "Explicit steps of a twentieth of their limit, or of a microsecond; where cloth \
                stretches under its weight the closed form of a chain, which judges those too.",
    error: ("error of places, rms", "mm"),
    cost_of: "second of the cloth's",
    run,
};

/// What is done with a cloth.
#[derive(Debug, Clone, Copy)]
struct Motion {
    name: &'static str,
    sample: Sample,
    tilt_deg: f64,
    seconds: f64,
}

const SWING: Motion = Motion {
    name: "swing",
    sample: Sample::SHIRTING,
    tilt_deg: 46.0,
    seconds: 0.25,
};
const FALL: Motion = Motion {
    name: "drape",
    sample: Sample {
        pins: "corners",
        ..Sample::SHIRTING
    },
    tilt_deg: 90.0,
    seconds: 0.25,
};
/// Let go unstretched, so that every yarn is a chain of masses and springs that swings up and down.
const STRETCH: Motion = Motion {
    name: "stretch",
    sample: Sample {
        stiffness_n_per_m: Some(100.0),
        rigidity: 0.0,
        ..Sample::SHIRTING
    },
    tilt_deg: 0.0,
    seconds: 0.12,
};
const GRASP: Motion = Motion {
    name: "grasp and stretch",
    sample: Sample {
        n_fingers: 2,
        ..Sample::SHIRTING
    },
    tilt_deg: 0.0,
    seconds: 0.3,
};

/// Ways of stepping and their steps, s; that of explicit ones is a share of their limit.
const WAYS: [(Integrator, f64); 11] = [
    (Integrator::Explicit, 0.8),
    (Integrator::Bdf2, 1e-3),
    (Integrator::Bdf2, 1.0 / 480.0),
    (Integrator::Bdf2, 1.0 / 240.0),
    (Integrator::ImplicitEuler, 1e-3),
    (Integrator::ImplicitEuler, 1.0 / 480.0),
    (Integrator::ImplicitEuler, 1.0 / 240.0),
    (Integrator::Xpbd, 1.0 / 2400.0),
    (Integrator::Xpbd, 1.0 / 9600.0),
    (Integrator::Projective, 1e-3),
    (Integrator::Projective, 1.0 / 240.0),
];

/// Stiffnesses of yarns, N/m, to beyond any cloth's.
const STIFFNESSES: [f64; 6] = [1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
/// What precedes conjugate gradients: the second is what steps use.
pub(super) const PRECONDITIONERS: [&str; 2] = ["diagonal", "line"];

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let motions = motions(bench.effort);
    let (mut rows, mut plots) = (Vec::new(), Vec::new());
    for (nth, motion) in motions.iter().enumerate() {
        bench.step(0.9 * nth as f64 / motions.len() as f64, &motion.case())?;
        let own = Findings::new(compare(motion, bench)?, Vec::new(), [""; 0]);
        let picture = error_against_time(&STUDY, &own).map(|picture| Chart {
            title: motion.case(),
            ..picture
        });
        let name = format!(
            "drape-{}-{}",
            motion.name.replace(' ', "-"),
            motion.sample.n
        );
        let is_cloth = motion.sample.stiffness_n_per_m.is_none();
        plots.extend(picture.filter(|_| is_cloth).map(|picture| (name, picture)));
        rows.extend(own.rows);
    }
    bench.step(0.9, "preconditioners")?;
    let (iterations, picture) = preconditioners(bench.effort.pick(26, 51))?;
    rows.extend(iterations);
    bench.step(0.92, "parts of a step, and whole scenes")?;
    rows.extend(speed::rows(bench)?);
    bench.step(0.95, "sleep")?;
    let (asleep, saved) = sleep()?;
    rows.extend(asleep);
    let notes = [
        format!("A cloth that sleeps costs {saved} of one that rests awake."),
        "XPBD and projective dynamics let fingers touch nothing: they are left out where cloth is \
         grasped."
            .to_owned(),
        "reach: what is asked for of ns_a_vertex, of the cost of a second (cores) and p99_ms, or \
         of contact's us_a_newton_step; it was set at 2.5 GHz."
            .to_owned(),
        "energy_beyond_percent: energy at the end less the work of hands, beyond the reference's, \
         of the cloth's weight times its length: below 0 the way of stepping itself has lost it; \
         XPBD stretches yarns farther than it pulls with."
            .to_owned(),
    ];
    plots.push(("drape-iterations".to_owned(), picture));
    Ok(Findings::new(rows, plots, notes))
}

/// A small cloth for a look; else two grids, and stiffnesses beyond any cloth's.
fn motions(effort: Effort) -> Vec<Motion> {
    if effort == Effort::Quick {
        let short = |motion: Motion| Motion {
            seconds: 0.12,
            ..motion.with(13, motion.sample.stiffness_n_per_m)
        };
        return [STRETCH, SWING, GRASP].map(short).into();
    }
    let mut all = [SWING, FALL, GRASP]
        .map(|motion| motion.with(26, None))
        .to_vec();
    // Steps of the reference cost ten times as much there.
    all.extend([SWING, FALL, GRASP].map(|motion| Motion {
        seconds: 0.5 * motion.seconds,
        ..motion.with(51, None)
    }));
    all.push(STRETCH);
    all.extend(STIFFNESSES.map(|k| SWING.with(26, Some(k))));
    all
}

impl Motion {
    fn with(self, n: usize, stiffness_n_per_m: Option<f64>) -> Self {
        let sample = Sample {
            n,
            stiffness_n_per_m,
            ..self.sample
        };
        Self { sample, ..self }
    }

    fn case(&self) -> String {
        let yarns = match self.sample.stiffness_n_per_m {
            None => "shirting".to_owned(),
            Some(stiffness) => format!("K {stiffness:e} N/m"),
        };
        format!("{}, {}², {yarns}", self.name, self.sample.n)
    }

    /// Where hands are: they close within 0.1 s, then stretch what they hold by 20 mm in 0.2 s.
    fn hands(t_s: f64) -> [Hand; 2] {
        let pulled = 20.0 * ((t_s - 0.1) / 0.2).clamp(0.0, 1.0);
        pinch(
            [100.0, 80.0 - pulled, 0.3 * pulled],
            20.0 - 220.0 * t_s.min(0.1),
        )
    }

    /// Moves a cloth to the end; how long that took.
    fn run(&self, drape: &mut Drape, n_steps: usize) -> Result<Timing, ReportError> {
        let mut step = || {
            let hands = Self::hands(drape.t_s() + drape.step_s());
            drape.step(&hands[..self.sample.n_fingers])
        };
        let steps = || (0..n_steps).try_for_each(|_| step());
        let ((), timing) = timed_once(self.seconds, steps)?;
        Ok(timing)
    }

    /// Where vertices are at the end, mm, where that is known: from where a chain comes to rest it
    /// swings in its modes, `sin((2k − 1)πi/2N)` at the i-th of N masses from the top.
    fn known_mm(&self) -> Option<Vec<[f64; 3]>> {
        if self.name != STRETCH.name {
            return None;
        }
        let n = self.sample.n;
        let last = (n - 1) as f64;
        let h_m = 0.2 / last;
        let density = self.sample.density_kg_per_m2;
        let stiffness = self.sample.stiffness_n_per_m?;
        // By how much the weight of one mass stretches one spring.
        let step_m = density * h_m * h_m * GRAVITY / stiffness;
        let at_rest = |i: usize| step_m * i as f64 * (last - 0.5 * i as f64);
        let angle = |k: usize| (k as f64 - 0.5) * PI / last;
        let modes = (1..n).map(|k| {
            let part = |i: usize| {
                let weight = if i + 1 == n { 0.5 } else { 1.0 };
                weight * at_rest(i) * (angle(k) * i as f64).sin()
            };
            let size_m = 2.0 / last * (1..n).map(part).sum::<f64>();
            let per_s = 2.0 / h_m * (stiffness / density).sqrt() * (0.5 * angle(k)).sin();
            (angle(k), size_m * (per_s * self.seconds).cos())
        });
        let modes: Vec<(f64, f64)> = modes.collect();
        let place = |vertex: usize| {
            let [column, i] = [vertex % n, n - 1 - vertex / n];
            let swings = modes
                .iter()
                .map(|(angle, size_m)| size_m * (angle * i as f64).sin());
            let down_m = i as f64 * h_m + at_rest(i) - swings.sum::<f64>();
            [1e3 * column as f64 * h_m, 1e3 * (0.2 - down_m), 0.0]
        };
        Some((0..n * n).map(place).collect())
    }

    /// The cloth at the start, in so many steps to the end as come near to a step's length.
    fn start(&self, integrator: Integrator, step_s: f64) -> Result<(Drape, usize), ReportError> {
        let n_steps = (self.seconds / step_s - 1e-9).ceil();
        let step_s = self.seconds / n_steps;
        let stepped = (integrator, Some(step_s));
        Ok((self.sample.drape(self.tilt_deg, stepped)?, whole(n_steps)))
    }
}

/// What steps of the reference keep within of the closed form, mm.
const REFERENCE_MM: f64 = 1e-3;
/// Steps of the reference are no shorter, s.
const SHORTEST_S: f64 = 1.01e-6;

/// A row for every way of stepping.
fn compare(motion: &Motion, bench: &Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let limit_s = motion
        .sample
        .drape(motion.tilt_deg, (Integrator::Bdf2, None))?
        .limit_s();
    // Scenes may ask for a microsecond at least. Stretched on its way a cloth is stiffer than at
    // its start.
    let share = bench.effort.pick(0.2, 0.05);
    let reference_s = (share * limit_s).max(SHORTEST_S).min(0.5 * limit_s);
    let (mut reference, n_steps) = motion.start(Integrator::Explicit, reference_s)?;
    // Minutes on the finer grid.
    if bench.wants_errors() {
        motion.run(&mut reference, n_steps)?;
    }
    let known_mm = motion.known_mm();
    let row = |drape: &Drape| {
        let setting = format!("{} ms", number(1e3 * drape.step_s()));
        Row::of(drape.integrator().0.name(), setting, motion.case())
    };
    let mut rows = Vec::new();
    if let Some(known_mm) = &known_mm {
        let off_mm = bench.wants_errors().then(|| off_mm(&reference, known_mm));
        rows.push(row(&reference).error(off_mm).promised(REFERENCE_MM));
    }
    let truth_mm = known_mm.unwrap_or_else(|| reference.places_mm().collect());
    for (integrator, step) in WAYS {
        let is_explicit = integrator == Integrator::Explicit;
        if !integrator.has_touch() && motion.sample.n_fingers > 0 {
            continue;
        }
        let step_s = if is_explicit { step * limit_s } else { step };
        let (mut drape, n_steps) = motion.start(integrator, step_s)?;
        let row = row(&drape);
        let cost = match motion.run(&mut drape, n_steps) {
            Ok(cost) => cost,
            Err(refused) => {
                rows.push(row.with("refused", refused));
                continue;
            }
        };
        let counters = *drape.counters();
        let percent = 100.0 * (left_j(&mut drape) - left_j(&mut reference)) / drape.scale_j();
        // Where it falls any step comes late to a fold that snaps.
        let is_stiffened = motion.name == SWING.name && motion.sample.stiffness_n_per_m.is_some();
        let promised = match integrator {
            _ if motion.name == FALL.name || is_stiffened => None,
            Integrator::Explicit => Some(0.02),
            Integrator::Bdf2 => Some(0.5),
            _ => None,
        };
        let off_mm = bench.wants_errors().then(|| off_mm(&drape, &truth_mm));
        let row = row.error(off_mm).cost(cost);
        let row = row.promised(promised);
        rows.push(
            row.number("energy_beyond_percent", 3, percent)
                .number("newton_a_step", 2, counters.newton as f64 / n_steps as f64)
                .number("linear_a_step", 1, counters.linear as f64 / n_steps as f64)
                .with("redone", counters.redone)
                .with("unconverged", counters.unconverged),
        );
    }
    Ok(rows)
}

/// Iterations of conjugate gradients for one step, by stiffness and by what precedes them.
fn preconditioners(n: usize) -> Result<(Vec<Row>, Chart), ReportError> {
    let (mut rows, mut series) = (Vec::new(), Vec::new());
    for step_s in [1e-3, 1.0 / 240.0] {
        for k in STIFFNESSES {
            let swing = SWING.with(n, Some(k));
            let (mut drape, _) = swing.start(Integrator::Bdf2, step_s)?;
            (0..10).try_for_each(|_| drape.step(&[]))?;
            let setting = format!("{} ms", number(1e3 * drape.step_s()));
            for (name, found) in PRECONDITIONERS.into_iter().zip(drape.linear_iterations()) {
                let line = format!("{name}, {setting}");
                let at = place(&mut series, &line, Style::LineAndDots);
                series[at].points.push([k, f64::from(found)]);
                let row = Row::of(name, setting.clone(), swing.case());
                rows.push(row.with("iterations", found));
            }
        }
    }
    let picture = chart(
        "Iterations of conjugate gradients",
        Axis::log("stiffness of the yarns, N/m"),
        Axis::log("iterations to a thousandth"),
        series,
        "The first Newton step of one step of a cloth that swings.",
    );
    Ok((rows, picture))
}

/// What work comes to, and what it costs a unit: long work that is done once.
fn timed_once<T, E>(n_units: f64, work: impl FnOnce() -> Result<T, E>) -> Result<(T, Timing), E> {
    let (start_s, start) = (thread_cpu_seconds(), Instant::now());
    let done = work()?;
    let cpu_s = (thread_cpu_seconds() - start_s) / n_units;
    let wall_s = start.elapsed().as_secs_f64() / n_units;
    Ok((done, Timing::of(&mut [cpu_s], &mut [wall_s])))
}

/// What a second of a cloth at rest costs, awake and asleep.
fn sleep() -> Result<(Vec<Row>, String), ReportError> {
    let sample = Sample {
        n_fingers: 2,
        ..Sample::SHIRTING
    };
    let mut drape = sample.drape(0.0, (Integrator::Bdf2, Some(1e-3)))?;
    let hands = pinch([100.0, 80.0, 0.0], 100.0);
    drape.place(&hands);
    let mut rows = Vec::new();
    let mut costs = Vec::new();
    for (method, skipped, n_steps) in [("awake", 0, 400), ("asleep", 400, 400)] {
        (0..skipped).try_for_each(|_| drape.step(&hands))?;
        let before = drape.counters().asleep;
        let seconds = f64::from(n_steps) * drape.step_s();
        let steps = || (0..n_steps).try_for_each(|_| drape.step(&hands));
        let ((), cost) = timed_once(seconds, steps)?;
        costs.push(cost.cpu_s);
        let row = Row::of(method, "bdf2, 1 ms", "rest, 26², shirting").cost(cost);
        rows.push(row.with("steps_asleep", drape.counters().asleep - before));
    }
    let saved = number(costs[1] / costs[0]);
    Ok((rows, saved))
}
