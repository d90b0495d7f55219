//! Limits of walls that are sampled: known figures, theory beside eigenvalues, the noise that
//! sampling makes of a texture, and what a tick costs.

use std::time::Instant;

use super::surfaces::{Surface, place_mm, relief_of, setup};
use crate::chart::chart;
use crate::readable::{rms, whole};
use crate::{Bench, Effort, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::numerics::{Grid, quantile};
use selvedge_render::contact::{
    Contact, ContactLaw, DeviceSpec, Friction, Hand, HapticLoop, Relief, Sampling, SimulatedDevice,
    Stepper, StylusRun, StylusStart, Tip, WallCase,
};
use selvedge_render::scene::Geometry;
use selvedge_textile::Library;
use std::f64::consts::TAU;

/// Limits of the sampled wall, buzzing, and ticks.
pub(crate) const STUDY: Study = Study {
    name: "stylus-limits",
    chapter: "contact",
    question: "How stiff may a sampled wall be, and what does sampling make of a texture?",
    reference: "Largest stiffnesses by other programs' eigenvalues; the same texture's force at \
                all times.",
    error: ("error of the limit, or noise", "of it"),
    cost_of: "tick",
    run,
};

/// Mass, damping of the device and of the wall, ticks of delay, and the largest stiffness at 1 kHz,
/// known to a unit.
const KNOWN: [(f64, f64, f64, usize, f64); 12] = [
    (0.075, 0.02, 0.0, 0, 40.0),
    (0.075, 0.02, 0.0, 1, 13.0),
    (0.075, 0.02, 2.0, 0, 3934.0),
    (0.075, 0.02, 2.0, 1, 1307.0),
    (0.075, 0.02, 5.0, 0, 9393.0),
    (0.075, 0.02, 5.0, 1, 3098.0),
    (0.075, 0.02, 20.0, 0, 30621.0),
    (0.075, 0.02, 20.0, 1, 9305.0),
    (0.10, 0.10, 1.0, 0, 2178.0),
    (0.10, 0.10, 1.0, 1, 725.0),
    (0.075, 1.0, 2.0, 0, 5856.0),
    (0.075, 1.0, 2.0, 1, 1948.0),
];
/// What the known figures are rounded by, N/m.
const ROUNDED: f64 = 0.6;
/// Points along a side of the relief of a tick, and the side, mm.
const RELIEF: (usize, f64) = (512, 2.0);

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    bench.step(0.0, "limits")?;
    let (mut rows, mut plots) = (Vec::new(), Vec::new());
    if bench.wants_errors() {
        rows.extend(KNOWN.iter().map(known));
        bench.step(0.2, "maps")?;
        plots = vec![
            ("stylus-limits-rate".to_owned(), by_rate(bench.effort)),
            ("stylus-limits-damping".to_owned(), by_damping(bench.effort)),
        ];
        rows.extend(map(bench.effort));
        bench.step(0.4, "a sampled texture")?;
        rows.extend(buzzing(bench)?);
    }
    bench.step(0.7, "ticks")?;
    rows.push(tick(&Tip::stylus(0.1), "1 contact", bench)?);
    let array = Geometry::default().contactors();
    rows.push(tick(&Tip::array(&array, 0.1), "24 contacts", bench)?);
    bench.step(0.9, "rolling")?;
    rows.extend(rolling(bench)?);
    let notes = [
        "Without damping of the wall (75 g, b = 0.02 N·s/m, 1 kHz) the eigenvalues give 40.0018 \
         N/m and 2b/T gives 40: with x = bT/m and e = exp(−x) the limit is \
         (b²/m)(1 − e)/(1 − e − x e) = (2b/T)(1 + x/6 + …), so that 2b/T is exact only as bT/m \
         goes to 0.",
        "CHAI3D took 673 µs in the median and 1.07 ms in the 99th percentile for 24 contacts with \
         the same relief as a mesh; at most 20 µs are aimed at here.",
        "Rows called map: what the eigenvalues and the passivity of the held wall say of a device \
         of 75 g and 0.02 N·s/m.",
    ];
    Ok(Findings::new(rows, plots, notes))
}

fn case((mass_kg, b, wall, ticks): (f64, f64, f64, usize), rate_hz: f64) -> WallCase {
    WallCase {
        mass_kg,
        damping_n_s_per_m: b,
        stiffness_n_per_m: 0.0,
        wall_damping_n_s_per_m: wall,
        period_s: 1.0 / rate_hz,
        delay_ticks: Some(ticks),
        method: Stepper::Exact,
    }
}

fn known(&(mass_kg, b, wall, ticks, known): &(f64, f64, f64, usize, f64)) -> Row {
    let found = case((mass_kg, b, wall, ticks), 1000.0).stiffness_limits(0.0, 0.0);
    let name = format!("{mass_kg} kg, b {b}, B {wall}, {ticks} ticks late");
    Row::of("eigenvalues", "1000 Hz", name)
        .error((found.exact / known - 1.0).abs())
        .promised(ROUNDED / known)
        .number("limit_n_per_m", 2, found.exact)
        .number("known_n_per_m", 0, known)
        .number("passive_n_per_m", 1, found.passive)
        .number("rule_n_per_m", 1, found.rule)
}

/// The limits of a usual device against the rate.
fn by_rate(effort: Effort) -> Chart {
    let n = effort.pick(8, 40);
    let rates = (0..=n).map(|i| 250.0 * 160.0_f64.powf(f64::from(i) / f64::from(n)));
    let rates: Vec<f64> = rates.collect();
    let of = |rate_hz: f64| case((0.075, 0.1, 0.05, 0), rate_hz).stiffness_limits(0.04, 0.03);
    let line =
        |name: &str, style: Style, y: fn(&selvedge_render::contact::StiffnessLimits) -> f64| {
            Series::of(name, style, rates.iter().map(|hz| [*hz, y(&of(*hz))]))
        };
    chart(
        "Largest stiffness against rate",
        Axis::log("rate, Hz"),
        Axis::log("stiffness, N/m"),
        vec![
            line("eigenvalues", Style::Line, |limits| limits.exact),
            line("(b + B)/(T/2)", Style::Dashed, |limits| limits.rule),
            line("passive", Style::Line, |limits| limits.passive),
            line("no limit cycles", Style::Dashed, |limits| limits.quiet),
        ],
        "75 g, b = 0.1 N·s/m, B = 0.05 N·s/m, f_c = 0.04 N, 0.03 mm. Between passive and \
         eigenvalues a wall is stable alone, but may chatter in a hand.",
    )
}

/// The limit against the wall's damping, by delay.
fn by_damping(effort: Effort) -> Chart {
    let n = effort.pick(8, 60);
    let dampings = (0..=n).map(|i| 0.1 * 1000.0_f64.powf(f64::from(i) / f64::from(n)));
    let dampings: Vec<f64> = dampings.collect();
    let line = |ticks: usize| {
        let points = dampings.iter().map(|wall| {
            let limits = case((0.075, 0.02, *wall, ticks), 1000.0).stiffness_limits(0.0, 0.0);
            [*wall, limits.exact]
        });
        Series::of(
            format!("{ticks} ticks late"),
            Style::Line,
            points.filter(|at| at[1] > 0.0),
        )
    };
    chart(
        "Largest stiffness against damping of the wall",
        Axis::log("damping of the wall, N·s/m"),
        Axis::log("stiffness, N/m"),
        [0, 1, 2, 4].map(line).into(),
        "75 g, b = 0.02 N·s/m, 1 kHz. More damping holds more until the delay turns it into its \
         opposite.",
    )
}

/// What holds where: stiffness, damping and rate.
fn map(effort: Effort) -> Vec<Row> {
    let stiffnesses = effort.pick(&[10.0, 1e3][..], &[1.0, 10.0, 100.0, 1e3, 1e4, 1e5]);
    let dampings = effort.pick(&[0.0, 5.0][..], &[0.0, 0.01, 1.0, 5.0, 20.0]);
    let mut rows = Vec::new();
    for rate_hz in effort.pick(&[1e3][..], &[250.0, 1e3, 4e3, 4e4]) {
        for wall in dampings {
            let standings = stiffnesses.iter().map(|k| {
                let case = case((0.075, 0.02, *wall, 0), *rate_hz).with_stiffness(*k);
                format!("{k}: {}", case.standing().word())
            });
            let words: Vec<String> = standings.collect();
            let row = Row::of("map", format!("{rate_hz} Hz"), format!("B {wall} N·s/m"));
            rows.push(row.with("standing_by_n_per_m", words.join("; ")));
        }
    }
    rows
}

/// What sampling adds to the force of a texture that is stroked: its rms against that of the force
/// at all times.
fn buzzing(bench: &Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let contact = Surface::Sine.relief(bench.seed)?;
    let forces = |rate_hz: f64, k: f64, sampling: Option<Sampling>| {
        let mut setup = setup(&contact, (k, Stepper::Exact, rate_hz))?;
        setup.device.damping_n_s_per_m = 1.0;
        setup.sampling = sampling;
        let mut run = StylusRun::new(setup, place_mm(0.0), StylusStart::Resting)?;
        let n = whole(0.5 * rate_hz);
        let every = whole(rate_hz / 250.0);
        let mut forces = Vec::new();
        for nth in 1..=n {
            let row = run.step(place_mm(nth as f64 / rate_hz))?;
            if nth % every == 0 && nth > n / 2 {
                forces.push(row.force_n);
            }
        }
        Ok::<_, ReportError>(forces)
    };
    let mut rows = Vec::new();
    for k in bench.effort.pick(&[400.0][..], &[200.0, 400.0, 800.0]) {
        let truth = forces(4e4, *k, None)?;
        let swing = crate::readable::deviation(&truth);
        for rate_hz in bench
            .effort
            .pick(&[1e3, 4e3][..], &[250.0, 1e3, 4e3, 1e4, 4e4])
        {
            let found = forces(*rate_hz, *k, Some(Sampling::default())).ok();
            let noise = found.map(|found| {
                let off: Vec<f64> = found.iter().zip(&truth).map(|(a, b)| a - b).collect();
                rms(&off) / swing
            });
            let name = format!("buzzing, {k} N/m, a sine of 50 µm and 2 mm");
            let row = Row::of("sampled", format!("{rate_hz} Hz"), name);
            rows.push(row.error(noise).with("rate_hz", rate_hz));
        }
    }
    Ok(rows)
}

/// What it costs to roll a tip over a cloth of the library, of a million points, by its radius.
fn rolling(bench: &Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let mut rows = Vec::new();
    let library = Library::shipped()?;
    for id in bench
        .effort
        .pick(&["denim"][..], &["denim", "silk-crepe", "wool-rib"])
    {
        let map = crate::textiles::relief(id, &library.manifest(id)?.source)?;
        let [width, height] = [map.heights_um().width(), map.heights_um().height()];
        let relief = Relief::of_map(&map);
        for radius_mm in bench.effort.pick(&[0.5][..], &[0.1, 0.5, 2.0]) {
            let n_repeats = bench.effort.pick(1, 5);
            let cost = bench.time_repeated(n_repeats, 1, || relief.under_sphere(*radius_mm));
            let row = Row::of(
                "roll",
                format!("a tip of {radius_mm} mm"),
                format!("{id}'s relief"),
            );
            rows.push(row.cost(cost).with("points", width * height));
        }
    }
    Ok(rows)
}

/// What a tick of the loop costs at 1 kHz on a relief of 512 × 512 points.
fn tick(tip: &Tip, name: &str, bench: &mut Bench<'_>) -> Result<Row, ReportError> {
    let (n, side_mm) = RELIEF;
    let turn = |i: usize| (TAU * i as f64 / n as f64).sin();
    let grid = Grid::from_fn(n, n, |column, row| 50.0 * turn(column) * turn(row));
    let relief = relief_of(grid, side_mm / n as f64)?;
    let law = ContactLaw::default();
    let contact = Contact::new(&relief, tip.clone(), law, Friction::coulomb(0.3))?;
    let spec = DeviceSpec::default();
    let hand = Hand::pressing(1.0);
    let place = [0.0, 0.0, -0.5];
    let mut device = SimulatedDevice::new(spec, hand, (Stepper::Exact, 1e-3), place)?;
    let sampling = (1000.0, Sampling::default());
    let mut haptic = HapticLoop::new(contact, sampling, spec.mass_kg, hand.press_n)?;
    let mut nth = 0_u32;
    let mut once = || {
        nth = nth.wrapping_add(1);
        let x_mm = 0.1 * f64::from(nth % 10_000);
        device.lead_to([x_mm, 0.37 * x_mm]);
        haptic.tick(&mut device).is_ok()
    };
    let cost = bench.time(1, &mut once);
    let mut wall_s: Vec<f64> = (0..bench.effort.pick(2_000, 50_000))
        .map(|_| {
            let start = Instant::now();
            once();
            start.elapsed().as_secs_f64()
        })
        .collect();
    let p99_us = 1e6 * quantile(&mut wall_s, 0.99);
    let setting = format!("{name}, sampled at 1 kHz");
    Ok(Row::of("tick", setting, "512 × 512 points of 2 mm")
        .cost(cost)
        .number("p99_us", 3, p99_us))
}
