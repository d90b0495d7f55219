//! The Kawabata testers, simulated on the cloth's own forces: do the figures come back?
//!
//! A patch is led through an even deformation, step by step there and back, and the load is read
//! from the forces on its vertices by virtual work.

use super::fabric::{Compression, Fabric};
use super::kes;
use super::mesh::{Mesh, Pins, Vector};
use super::sheet::{Losses, Sheet};
use super::{DrapeError, DrapeScene};

/// Vertices along a side of a patch.
const SIDE: usize = 9;
/// Spacing of the patch, m: bending to 4 mm asks for a fine one.
const SPACING_M: f64 = 0.5e-3;
/// Steps of a quarter of a cycle.
const N_STEPS: u32 = 400;
/// Tension of the shear test, N/m: 10 gf/cm.
const SHEAR_TENSION: f64 = 9.806_65;

/// A figure that went in, and what the simulated tester makes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct TestedFigure {
    /// The tester's name for it.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// What went in.
    pub given: f64,
    /// What came out.
    pub found: f64,
}

/// A patch that is led through an even deformation.
struct Patch {
    sheet: Sheet,
    lag: super::sheet::Lag,
    grad: Vec<Vector>,
}

impl Patch {
    fn new(fabric: &Fabric) -> Result<Self, DrapeError> {
        let size_m = [(SIDE - 1) as f64 * SPACING_M; 2];
        let mesh = Mesh::new([SIDE; 2], size_m, fabric.density_kg_per_m2, &Pins::None)?;
        let losses = Losses {
            has_air: false,
            has_hysteresis: true,
            viscosity_s: 0.0,
        };
        let sheet = Sheet::new(mesh, fabric, losses);
        let n = sheet.mesh.n_vertices();
        Ok(Self {
            lag: sheet.lag(n),
            grad: vec![Vector::zeros(); n],
            sheet,
        })
    }

    /// Area, m².
    fn area_m2(&self) -> f64 {
        let [u, w] = self.sheet.mesh.size_m();
        u * w
    }

    /// The load per area against a parameter of a deformation: `Σ f·∂x/∂p`. Settles there.
    fn load(&mut self, shape: impl Fn(f64, Vector) -> Vector, parameter: f64) -> f64 {
        let rest: Vec<Vector> = self.sheet.mesh.at_rest().collect();
        let at = |parameter: f64| {
            rest.iter()
                .map(|x| shape(parameter, *x))
                .collect::<Vec<_>>()
        };
        let x = at(parameter);
        let still = vec![Vector::zeros(); x.len()];
        self.sheet.begin(&mut self.lag, &x, &still);
        self.grad.fill(Vector::zeros());
        self.sheet.evaluate(&x, &self.lag, &mut self.grad);
        let step = 1e-6 * parameter.abs().max(1e-3);
        let (above, below) = (at(parameter + step), at(parameter - step));
        let moved = above
            .iter()
            .zip(&below)
            .map(|(a, b)| (a - b) / (2.0 * step));
        let work: f64 = self
            .grad
            .iter()
            .zip(moved)
            .map(|(force, moved)| force.dot(&moved))
            .sum();
        self.sheet.settle(&x, &self.lag);
        work / self.area_m2()
    }
}

/// Tests a scene's cloth: stretch along both axes, shear, bending along both, compression.
///
/// # Errors
/// None for a cloth that was read; a patch of its grid is always there.
pub fn test_fabric(scene: &DrapeScene) -> Result<Vec<TestedFigure>, DrapeError> {
    let fabric = scene.fabric();
    let mut found = Vec::new();
    for (axis, side) in ["warp", "weft"].into_iter().enumerate() {
        stretch(fabric, (axis, side), &mut found)?;
    }
    shear(fabric, &mut found)?;
    for (axis, side) in ["warp", "weft"].into_iter().enumerate() {
        bend(fabric, (axis, side), &mut found)?;
    }
    compress(&fabric.compression, &mut found);
    Ok(found)
}

fn figure(name: impl Into<String>, unit: &'static str, [given, found]: [f64; 2]) -> TestedFigure {
    TestedFigure {
        name: name.into(),
        unit,
        given,
        found,
    }
}

/// EMT, LT, WT and RT along an axis; all but RT of the mean of the ways there and back, so that
/// hysteresis has no part in them.
fn stretch(
    fabric: &Fabric,
    (axis, side): (usize, &str),
    found: &mut Vec<TestedFigure>,
) -> Result<(), DrapeError> {
    let mut patch = Patch::new(fabric)?;
    let law = fabric.tension[axis];
    let top = law.max_strain.min(1.0);
    let [given_j, force, _] = law.at(top);
    let shape = move |strain: f64, x: Vector| {
        let mut y = x;
        y[axis] *= 1.0 + strain;
        y
    };
    // Beyond what is asked for, so that both branches have let go of where they turned.
    let beyond = 1.2 * top;
    let there = branch(&mut patch, shape, [0.0, beyond]);
    let back = branch(&mut patch, shape, [beyond, 0.0]);
    let mean: Vec<[f64; 2]> = there
        .iter()
        .zip(back.iter().rev())
        .map(|(a, b)| [a[0], 0.5 * (a[1] + b[1])])
        .collect();
    let reached = mean.windows(2).find(|pair| pair[1][1] >= force);
    let extension = reached.map_or(f64::NAN, |pair| between(pair[0], pair[1], force));
    let slack = 2.0 * fabric.tension_friction_n_per_m[axis];
    let work = area(&mean, extension);
    let lost =
        area(&there, extension) - area(&back.iter().rev().copied().collect::<Vec<_>>(), extension);
    let linearity = work / (0.5 * force * extension);
    let given_lt = given_j / (0.5 * force * top);
    let name = |of: &str| format!("{of} {side}");
    let emt = [top, extension].map(|strain| 100.0 * strain);
    let wt = [given_j, work].map(|j| j / kes::N_PER_M);
    found.push(figure(name("EMT"), "%", emt));
    found.push(figure(name("LT"), "", [given_lt, linearity]));
    found.push(figure(name("WT"), "gf·cm/cm²", wt));
    if slack > 0.0 {
        let rt = [slack * top / given_j, lost / work].map(|lost| 100.0 * (1.0 - lost));
        found.push(figure(name("RT"), "%", rt));
    }
    Ok(())
}

/// Parameter and load on the way from one end to the other.
fn branch(
    patch: &mut Patch,
    shape: impl Fn(f64, Vector) -> Vector + Copy,
    [from, to]: [f64; 2],
) -> Vec<[f64; 2]> {
    let place = |step: u32| from + (to - from) * f64::from(step) / f64::from(N_STEPS);
    (0..=N_STEPS)
        .map(|step| [place(step), patch.load(shape, place(step))])
        .collect()
}

/// The parameter at a load between two places.
fn between([a, low]: [f64; 2], [b, high]: [f64; 2], load: f64) -> f64 {
    a + (b - a) * (load - low) / (high - low)
}

/// Area below a curve of rising parameters up to one.
fn area(curve: &[[f64; 2]], to: f64) -> f64 {
    let pairs = curve.windows(2).filter(|pair| pair[0][0] < to);
    let strip = |pair: &[[f64; 2]]| {
        let width = pair[1][0].min(to) - pair[0][0];
        let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        width * (pair[0][1] + 0.5 * slope * width)
    };
    pairs.map(strip).sum()
}

/// The load of a curve at a parameter.
fn load_at(curve: &[[f64; 2]], at: f64) -> f64 {
    let pair = curve.windows(2).find(|pair| {
        let [a, b] = [pair[0][0], pair[1][0]];
        (a.min(b)..=a.max(b)).contains(&at)
    });
    pair.map_or(f64::NAN, |pair| {
        let share = (at - pair[0][0]) / (pair[1][0] - pair[0][0]);
        pair[0][1] + share * (pair[1][1] - pair[0][1])
    })
}

/// A whole cycle: there and back after one that takes the cloth from rest.
fn cycle(
    patch: &mut Patch,
    shape: impl Fn(f64, Vector) -> Vector + Copy,
    most: f64,
) -> [Vec<[f64; 2]>; 2] {
    branch(patch, shape, [0.0, most]);
    branch(patch, shape, [most, -most]);
    [
        branch(patch, shape, [-most, most]),
        branch(patch, shape, [most, -most]),
    ]
}

/// Slope of the mean of both ways between two parameters, and the width of the loop at another.
fn slope_of([there, back]: &[Vec<[f64; 2]>; 2], [a, b]: [f64; 2]) -> f64 {
    let mean = |at: f64| 0.5 * (load_at(there, at) + load_at(back, at));
    (mean(b) - mean(a)) / (b - a)
}

fn width_of([there, back]: &[Vec<[f64; 2]>; 2], at: f64) -> f64 {
    load_at(there, at) - load_at(back, at)
}

/// G, 2HG and 2HG5 to ±8° under tension.
fn shear(fabric: &Fabric, found: &mut Vec<TestedFigure>) -> Result<(), DrapeError> {
    let mut patch = Patch::new(fabric)?;
    let stretched = |strain: f64| fabric.tension[0].at(strain)[1] < SHEAR_TENSION;
    let strain = selvedge_foundation::numerics::bisected([0.0, 1.0], 60, stretched);
    let shape = move |angle: f64, x: Vector| {
        let along = x.x * (1.0 + strain);
        Vector::new(along * angle.cos(), x.y + along * angle.sin(), 0.0)
    };
    let turn = cycle(&mut patch, shape, 8.0_f64.to_radians());
    let [low, high] = [0.5_f64.to_radians(), 2.5_f64.to_radians()];
    let wide = 5.0_f64.to_radians();
    let stiffness = slope_of(&turn, [low, high]);
    let g = [fabric.shear_n_per_m, stiffness].map(|g| g / kes::N_PER_M_RAD);
    found.push(figure("G", "gf/(cm·°)", g));
    let [narrow, at_5] = fabric.shear_loop_n_per_m;
    for (name, given, angle) in [("2HG", narrow, low), ("2HG5", at_5, wide)] {
        if given > 0.0 {
            let both = [given, width_of(&turn, angle)].map(|width| width / kes::N_PER_M);
            found.push(figure(name, "gf/cm", both));
        }
    }
    Ok(())
}

/// B and 2HB to ±250 1/m along an axis.
fn bend(
    fabric: &Fabric,
    (axis, side): (usize, &str),
    found: &mut Vec<TestedFigure>,
) -> Result<(), DrapeError> {
    let mut patch = Patch::new(fabric)?;
    // A chain of chords as long as the spacing, each turned from the last by κh.
    let shape = move |curvature: f64, x: Vector| {
        let (h, mut y) = (SPACING_M, x);
        let (mut along, mut up) = (0.0, 0.0);
        let n: u32 = selvedge_foundation::numerics::to_whole((x[axis] / h).round());
        for chord in 0..n {
            let angle = (f64::from(chord) + 0.5) * curvature * h;
            along += h * angle.cos();
            up += h * angle.sin();
        }
        y[axis] = along;
        y.z = up;
        y
    };
    let turn = cycle(&mut patch, shape, 250.0);
    // Places that bend are two fewer than vertices along a line.
    let share = (SIDE - 1) as f64 / (SIDE - 2) as f64;
    let stiffness = share * slope_of(&turn, [50.0, 150.0]);
    let b = [fabric.bending_n_m[axis], stiffness].map(|b| b / kes::N_M);
    found.push(figure(format!("B {side}"), "gf·cm²/cm", b));
    let width = fabric.bending_loop_n[axis];
    if width > 0.0 {
        let both = [width, share * width_of(&turn, 100.0)].map(|width| width / kes::N);
        found.push(figure(format!("2HB {side}"), "gf·cm/cm", both));
    }
    Ok(())
}

/// LC and WC from thickness by pressure.
fn compress(cloth: &Compression, found: &mut Vec<TestedFigure>) {
    if cloth.yield_m <= 0.0 {
        return;
    }
    let place = |step: u32| Compression::TESTER_PA * f64::from(step) / f64::from(N_STEPS * 10);
    let curve: Vec<[f64; 2]> = (0..=N_STEPS * 10)
        .map(|step| [cloth.thinner_m(place(step)), place(step)])
        .collect();
    let most = curve.last().map_or(0.0, |last| last[0]);
    let work = area(&curve, most);
    let linearity = work / (0.5 * Compression::TESTER_PA * most);
    let wc = [cloth.work_j_per_m2(), work].map(|j| j / kes::N_PER_M);
    found.push(figure("LC", "", [cloth.linearity(), linearity]));
    found.push(figure("WC", "gf·cm/cm²", wc));
    found.push(figure("T0 − TM", "mm", [1e3 * cloth.yield_m, 1e3 * most]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_comes_back_from_every_tester() {
        for id in selvedge_textile::Library::shipped().unwrap().ids() {
            let figures = test_fabric(&DrapeScene::of_textile(id).unwrap()).unwrap();
            assert!(figures.len() >= 15, "{id}: {}", figures.len());
            for TestedFigure {
                name, given, found, ..
            } in figures
            {
                let tolerance = if name.starts_with("2H") || name.starts_with("RT") {
                    0.02
                } else {
                    5e-3
                };
                assert!(
                    (found / given - 1.0).abs() < tolerance,
                    "{id} {name}: {given} {found}"
                );
            }
        }
    }
}
