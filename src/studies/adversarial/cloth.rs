//! A hanging cloth: whatever its yarns, weight and step are and whatever is done with it, it has no
//! energy from nowhere, comes out in numbers, and a refusal names its limit.

use super::field::{Field, Range, Spaced, numbers, target};
use crate::ReportError;
use crate::drape::{Deed, held};
use selvedge_drape::Integrator;
use selvedge_foundation::numerics::to_whole;

/// Its yarns as springs, its weight, the step, vertices along a side, how it begins, and what is
/// done with it by its place in the list.
const RANGES: [Range; 6] = [
    ("stiffness_n_per_m", [10.0, 1e6], Spaced::Log),
    ("density_kg_per_m2", [0.02, 1.0], Spaced::Log),
    ("step_ms", [0.1, 50.0], Spaced::Log),
    ("n", [3.0, 9.0], Spaced::Even),
    ("tilt_deg", [0.0, 90.0], Spaced::Even),
    ("deed", [0.0, Deed::ALL.len() as f64 - 1e-9], Spaced::Even),
];

/// Where an integrator may give energy.
pub(super) const FIELD: Field = Field {
    file: "cloth.csv",
    stored: include_str!("cloth.csv"),
    ranges: &RANGES,
    lead: None,
    targets: &[
        target("explicit", 4, |case| share(case, Integrator::Explicit)),
        target("implicit euler", 8, |case| {
            share(case, Integrator::ImplicitEuler)
        }),
        target("bdf2", 8, |case| share(case, Integrator::Bdf2)),
    ],
};

fn share(case: &[f64], integrator: Integrator) -> Result<f64, ReportError> {
    let [stiffness, density_kg_per_m2, step_ms, n, tilt_deg, deed] = numbers(case)?;
    let deed = Deed::ALL[to_whole::<usize>(deed.floor()).min(Deed::ALL.len() - 1)];
    let mut sample = deed.sample();
    sample.stiffness_n_per_m = Some(stiffness);
    sample.density_kg_per_m2 = density_kg_per_m2;
    if deed != Deed::Smallest {
        sample.n = to_whole(n);
    }
    held((deed, sample, tilt_deg), (integrator, true), step_ms)
}
