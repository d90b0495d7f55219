//! Numbers of all contactors as cells of one band: rows and columns as they stand.

use crate::bench::export::ink;
use selvedge_chart::{Axis, Chart, Raster, Upright, Words};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// A band's panel of rows and columns, row 0 at the top. `colour` is that of a contactor's cell,
/// `None` for paper.
pub(crate) fn panel(
    band: Band,
    (n_rows, n_columns): (usize, usize),
    colour: impl Fn(usize) -> Option<[u8; 3]>,
    words: Vec<Words>,
) -> Chart {
    let ends = |n: usize| [-0.5, n.max(1) as f64 - 0.5];
    Chart {
        title: format!("{} Hz", quantity::fixed(band.carrier_hz(), 0)),
        ink: ink(band),
        x: Axis::whole("column").within(ends(n_columns)),
        y: Axis::whole("row").within(ends(n_rows)),
        upright: Upright::Downward,
        raster: Some(Raster {
            n_columns,
            cells: (0..n_rows * n_columns).map(colour).collect(),
        }),
        words,
        ..Chart::default()
    }
}
