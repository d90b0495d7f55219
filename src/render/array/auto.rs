//! Which method is the cheapest within an error budget.
//!
//! Decided from bounds known before the first tick and from counts of operations, never from a
//! clock: the choice, and so every result, depends on the scene and the budget alone.

use super::table::{Grid, MAX_TABLE_BYTES, table_bytes};
use super::{Accuracy, ErrorBound, Method};
use crate::RenderScene;
use crate::plan::ScenePlan;
use selvedge_textile::surface::N_BINS;

/// Operations (multiplications and additions, or as long) for one bin of the reference: a
/// logarithm and an exponential for each band.
const REFERENCE_BIN: usize = 60;
/// Operations for one bin of a sum with gains at hand.
const BANDED_BIN: usize = 4;
/// Operations for one look-up, the place in the table included.
const TABLE_LOOK_UP: usize = 12;
/// Operations to find a speed in a table.
const TABLE_SPEED: usize = 40;

/// The method that `method` stands for; without a grid there are no tables.
pub(super) fn resolve(
    scene: &RenderScene,
    plan: &ScenePlan,
    (method, accuracy): (Method, &Accuracy),
    grid: Option<&Grid>,
) -> Method {
    if method != Method::Auto {
        return method;
    }
    let costs = costs(scene, plan);
    let fits = |method: &Method| match method {
        Method::Table => grid.is_some_and(|grid| {
            grid.density.level_db <= accuracy.budget_db
                && table_bytes(plan, grid) <= MAX_TABLE_BYTES
        }),
        Method::Banded => {
            ErrorBound::of_floor(accuracy.banded_floor).level_db <= accuracy.budget_db
        }
        Method::Reference | Method::Auto => true,
    };
    let mut by_cost = costs;
    by_cost.sort_by_key(|&(_, n_operations)| n_operations);
    let cheapest = by_cost.into_iter().map(|(method, _)| method).find(fits);
    cheapest.unwrap_or(Method::Reference)
}

/// Operations a tick, at most, by method: all contactors on textiles, all bins below 1 kHz.
fn costs(scene: &RenderScene, plan: &ScenePlan) -> [(Method, usize); 3] {
    let n_directions: usize = 2 * scene
        .displays
        .iter()
        .map(|d| d.offsets.len())
        .sum::<usize>();
    let n_points: usize = plan.pool.iter().map(|spectra| spectra.n_points()).sum();
    let n_distinct = n_directions.min(n_points.max(1));
    [
        (
            Method::Table,
            n_directions * TABLE_LOOK_UP + 2 * TABLE_SPEED,
        ),
        (
            Method::Banded,
            (2 * REFERENCE_BIN + n_distinct * BANDED_BIN) * N_BINS,
        ),
        (Method::Reference, n_directions * REFERENCE_BIN * N_BINS),
    ]
}
