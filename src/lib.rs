//! Selvedge: virtual textiles felt through a fingertip array.

pub mod files;
pub mod geometry;
pub mod numerics;
pub mod progress;
pub mod quantity;
pub mod surface;
pub mod tactile;
