//! Systems whose devices are not read directly: they say so.

use std::path::Path;

use super::super::{InputError, PointerInput};
use super::{Area, InputDevice};

const WHAT: &str = "this system's devices are not read directly";

/// Lists nothing.
///
/// # Errors
/// Always.
pub fn list_input_devices() -> Result<Vec<Result<InputDevice, InputError>>, InputError> {
    Err(InputError::List(WHAT.to_owned()))
}

/// Opens nothing.
///
/// # Errors
/// Always.
pub fn open_input_device(
    path: &Path,
    _area: Option<Area>,
    _workspace_mm: [f64; 2],
) -> Result<Box<dyn PointerInput>, InputError> {
    Err(InputError::Device {
        path: path.to_owned(),
        what: WHAT.to_owned(),
    })
}
