//! Heights in an NPY array: rows from the top. Read and written (float64, µm).

use std::path::Path;

use super::{Measured, Reading};
use crate::surface::MAX_POINTS;
use selvedge_foundation::files::{FileError, NumberArray};

/// Reads an array; neither unit nor step is in it.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Reading, FileError> {
    let array = NumberArray::from_npy(bytes, path, MAX_POINTS)?;
    Ok(Reading::of_rows(array.n_columns, array.values, "NPY", path)?.turned_over())
}

/// Writes the heights of a map, µm.
pub(super) fn write(measured: &Measured) -> Vec<u8> {
    let grid = &measured.heights_um;
    let rows = (0..grid.height()).rev();
    let array = NumberArray {
        n_rows: grid.height(),
        n_columns: grid.width(),
        values: rows.flat_map(|row| grid.row(row).to_vec()).collect(),
    };
    array.to_npy()
}
