//! Energy over many seconds: what every way of stepping gains above the start, and what is left.

use super::stability::MOST_GAINED;
use super::{Sample, left_j};
use crate::readable::{number, whole};
use crate::{Effort, ReportError, Row};
use selvedge_drape::Integrator;

/// Ways of stepping, their steps, s, and whether they promise anything; that of explicit ones is a
/// share of their limit: hardened by its swing a cloth is stiffer than at its start.
const WAYS: [(Integrator, f64, bool); 7] = [
    (Integrator::Explicit, 0.45, true),
    (Integrator::ImplicitEuler, 1e-3, true),
    (Integrator::ImplicitEuler, 1.0 / 240.0, true),
    (Integrator::Bdf2, 1e-3, true),
    (Integrator::Bdf2, 1.0 / 240.0, true),
    (Integrator::Xpbd, 1.0 / 2400.0, false),
    (Integrator::Projective, 1.0 / 240.0, false),
];

/// A cloth that is let go at 80° and swings for long, with and without air and hysteresis.
pub(super) fn rows(effort: Effort) -> Result<Vec<Row>, ReportError> {
    let seconds = effort.pick(2.0, 60.0);
    let mut rows = Vec::new();
    for is_lossy in [false, true] {
        let sample = Sample {
            n: 8,
            is_lossy,
            ..Sample::SHIRTING
        };
        let limit_s = sample.drape(80.0, (Integrator::Bdf2, None))?.limit_s();
        for (integrator, step, promises) in WAYS {
            let is_explicit = integrator == Integrator::Explicit;
            let step_s = if is_explicit { step * limit_s } else { step };
            let mut drape = sample.drape(80.0, (integrator, Some(step_s)))?;
            let (start_j, scale_j) = (left_j(&mut drape), drape.scale_j());
            let (mut gained, n_steps) = (0.0_f64, whole(seconds / step_s));
            for nth in 0..n_steps {
                drape.step(&[])?;
                if nth % 7 == 0 {
                    gained = gained.max((left_j(&mut drape) - start_j) / scale_j);
                }
            }
            let losses = if is_lossy {
                "air and hysteresis"
            } else {
                "bare"
            };
            let setting = format!("{} ms", number(1e3 * drape.step_s()));
            let case = format!("{seconds} s of swinging, 8², {losses}");
            let left = 100.0 * (left_j(&mut drape) - start_j) / scale_j;
            let row = Row::of(integrator.name(), setting, case).error(gained);
            let row = row.promised(promises.then_some(MOST_GAINED));
            rows.push(row.number("energy_since_start_percent", 2, left));
        }
    }
    Ok(rows)
}
