//! The cloth against closed forms, orders, energy and extreme cases.

mod closed_forms;
mod extremes;
mod felt;
mod fingers;
mod local;
mod motion;
mod scene;

use crate::cloth::{Cloth, EXACT, Stepping};
use crate::fabric::{Fabric, Tension};
use crate::integrator::Integrator;
use crate::mesh::{Mesh, Pins, Vector};
use crate::sheet::{Losses, Sheet};
use crate::system::System;

/// Aborts the tests where something allocates that says it does not.
#[cfg(debug_assertions)]
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;

/// Without air, hysteresis and damping.
const LOSSLESS: Losses = Losses {
    has_air: false,
    has_hysteresis: false,
    viscosity_s: 0.0,
};

fn cloth(
    (n, size_m): ([usize; 2], [f64; 2]),
    fabric: Fabric,
    pins: &Pins,
    (integrator, step_s): (Integrator, f64),
) -> Cloth {
    let mesh = Mesh::new(n, size_m, fabric.density_kg_per_m2, pins).unwrap();
    let sheet = Sheet::new(mesh, &fabric, LOSSLESS);
    let mut stepping = Stepping::new(integrator, step_s);
    stepping.gain = EXACT;
    stepping.max_steps = 60;
    Cloth::new(System::new(sheet, Vec::new()), stepping)
}

/// A shirting, as its figures would have it.
fn shirting() -> Fabric {
    let mut fabric = Fabric::plain(0.1, 1.0, 60.0, 5e-6);
    fabric.tension = [Tension::new(490.33, 0.05, 0.7); 2];
    fabric
}
