//! What the parts of a step cost, and what whole scenes do: printed for people to read.
//!
//! `cargo test --release -p selvedge-drape -- --ignored --nocapture speed`

use super::*;
use crate::finger::Finger;
use selvedge_foundation::numerics::median;
use selvedge_foundation::progress::thread_cpu_seconds;

/// Repeats of a measurement.
const N_REPEATS: usize = 15;

/// CPU time of some work, s, in the median over repeats of `n` each.
fn seconds(n: usize, mut work: impl FnMut()) -> f64 {
    let repeat = |_| {
        let start_s = thread_cpu_seconds();
        (0..n).for_each(|_| work());
        (thread_cpu_seconds() - start_s) / n as f64
    };
    median(&mut (0..N_REPEATS).map(repeat).collect::<Vec<f64>>())
}

/// A shirting of 200 × 200 mm that falls from its corners, on its way.
fn falling(n: usize, (integrator, step_s): (Integrator, f64)) -> Cloth {
    let mut fabric = shirting();
    fabric.density_kg_per_m2 = 0.2;
    let grid = ([n, n], [0.2; 2]);
    let mut cloth = cloth(grid, fabric, &Pins::Top, (integrator, step_s));
    cloth.stepping.gain = crate::cloth::LIVE;
    cloth.stepping.max_steps = 20;
    cloth.tilt(46.0);
    cloth
}

#[test]
#[ignore = "prints what the parts of a step cost, for people to read"]
fn speed_of_the_parts_of_a_step() {
    for n in [26, 51] {
        let mut cloth = falling(n, (Integrator::Bdf2, 1e-3));
        (0..20).for_each(|_| cloth.step(&[]).unwrap());
        let per_vertex = |seconds: f64| 1e9 * seconds / (n * n) as f64;
        let x = cloth.x.clone();
        let (mut out, p) = (x.clone(), cloth.v.clone());
        let Cloth { system, newton, .. } = &mut cloth;
        let gradient = seconds(200, || {
            system.evaluate(&x, &mut out);
        });
        let product = seconds(500, || system.product(&p, &mut out));
        let prepared = seconds(200, || system.precondition(&x, &mut newton.lines));
        let line = seconds(500, || newton.lines.apply(&p, &mut out));
        let mut moved = falling(n, (Integrator::Xpbd, 1.0 / 2400.0));
        let substep = seconds(200, || moved.step(&[]).unwrap());
        let [gradient, product, line, substep, prepared] =
            [gradient, product, line, substep, prepared].map(per_vertex);
        println!(
            "{n}²: gradient {gradient:.1}, product {product:.1}, line {line:.1}, \
             XPBD {substep:.1}; making line {prepared:.1} ns a vertex"
        );
    }
}

/// Steps a cloth for a while; prints what it took.
fn run(what: &str, cloth: &mut Cloth, targets: impl Fn(f64) -> Vec<Vector>) {
    let step_s = cloth.stepping.step_s;
    let n = (0.5 / step_s).round();
    let before = cloth.counters;
    let mut took_s: Vec<f64> = Vec::new();
    for step in 0..selvedge_foundation::numerics::to_index(n) {
        let targets = targets(step as f64 * step_s);
        let start_s = thread_cpu_seconds();
        cloth.step(&targets).unwrap();
        took_s.push(thread_cpu_seconds() - start_s);
    }
    let share = took_s.iter().sum::<f64>() / (n * step_s);
    took_s.sort_by(f64::total_cmp);
    let [half, most] = [0.5, 0.99].map(|at| {
        let nth = selvedge_foundation::numerics::to_index(at * took_s.len() as f64);
        1e3 * took_s[nth]
    });
    let newton = (cloth.counters.newton - before.newton) as f64 / n;
    let linear = (cloth.counters.linear - before.linear) as f64 / n;
    println!(
        "{what}: {share:.2} cores; a step {half:.2} ms in the median, {most:.2} ms in 99 of 100; \
         {newton:.1} Newton steps, {linear:.0} iterations; {} redone, {} unconverged",
        cloth.counters.redone - before.redone,
        cloth.counters.unconverged - before.unconverged
    );
}

/// The same cloth between two pads.
fn pinched(n: usize, step: (Integrator, f64)) -> Cloth {
    let mut cloth = falling(n, step);
    let sheet = cloth.system.sheet.clone();
    let first = sheet.mesh.n_vertices();
    let fingers = [1.0, -1.0].into_iter().enumerate().map(|(nth, side)| {
        let start = Vector::new(0.1, 0.08, 0.02 * side);
        Finger::new(first + nth, (side, 0.0), &sheet.fabric, start)
    });
    let fingers = fingers.collect();
    let stepping = cloth.stepping;
    let mut sheet = Sheet::new(sheet.mesh, &sheet.fabric, Losses::default());
    sheet.losses.has_air = true;
    cloth = Cloth::new(System::new(sheet, fingers), stepping);
    cloth.settle_to_rest().unwrap();
    cloth
}

/// Two pads close, rub against each other and pull the cloth along.
fn rubbed(t_s: f64) -> Vec<Vector> {
    let opening = (0.02 - 0.25 * t_s).max(-1e-3);
    let along = 0.02 * (8.0 * (t_s - 0.1).max(0.0)).sin();
    [1.0, -1.0]
        .map(|side| Vector::new(0.1 + 0.3 * side * along, 0.08 + along, side * opening))
        .into()
}

#[test]
#[ignore = "prints what whole scenes cost, for people to read"]
fn speed_of_whole_scenes() {
    let still = |_: f64| Vec::new();
    for (n, step_s, rate) in [
        (26, 1e-3, "1 kHz"),
        (26, 1.0 / 480.0, "480 Hz"),
        (51, 1.0 / 480.0, "480 Hz"),
    ] {
        let mut cloth = falling(n, (Integrator::Bdf2, step_s));
        run(&format!("{n}² swing, BDF2, {rate}"), &mut cloth, still);
        let mut cloth = pinched(n, (Integrator::Bdf2, step_s));
        run(&format!("{n}² two pads, BDF2, {rate}"), &mut cloth, rubbed);
        contact(n, &mut cloth);
    }
    let mut cloth = pinched(51, (Integrator::ImplicitEuler, 1.0 / 240.0));
    cloth.stepping.max_steps = 1;
    run("51² two pads, IE, 240 Hz, one step", &mut cloth, rubbed);
}

/// What the points of both pads add to a Newton step.
fn contact(n: usize, cloth: &mut Cloth) {
    let x = cloth.x.clone();
    let mut out = x.clone();
    let System { sheet, fingers, .. } = &mut cloth.system;
    let mut points = 0;
    let took = seconds(200, || {
        points = 0;
        for finger in &mut *fingers {
            finger.look(&sheet.mesh, &x);
            finger.evaluate(&x, &mut out);
            points += finger
                .points
                .iter()
                .filter(|one| one.pressure_pa > 0.0)
                .count();
        }
    });
    let product = seconds(500, || {
        for finger in &*fingers {
            finger.product(&x, &mut out);
        }
    });
    println!(
        "{n}²: {points} points that touch: {:.1} µs a Newton step, {:.2} µs a product",
        1e6 * took,
        1e6 * product
    );
}
