//! Coverage.
use super::*;
/// C.
#[derive(Debug)]
pub struct CoverageStudy;
