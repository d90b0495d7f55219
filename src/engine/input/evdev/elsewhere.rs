//! Systems whose devices are not read directly: they say so.

use std::path::Path;

use super::super::{InputError, PointerInput};
use super::{Area, InputDevice};

const WHAT: &str = "this system's devices are not read directly";

impl InputDevice {
    /// Lists nothing.
    ///
    /// # Errors
    /// Always.
    pub fn list() -> Result<Vec<Result<Self, InputError>>, InputError> {
        Err(InputError::List(WHAT.to_owned()))
    }

    /// Opens nothing.
    ///
    /// # Errors
    /// Always.
    pub fn open(
        path: &Path,
        _area: Option<Area>,
        _workspace_mm: [f64; 2],
    ) -> Result<Box<dyn PointerInput>, InputError> {
        Err(InputError::Device {
            path: path.to_owned(),
            what: WHAT.to_owned(),
        })
    }
}
