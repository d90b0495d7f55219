//! Pictures: from the brightness of a cloth's repeat to heights that can be felt.

pub mod shading;

pub use shading::{PictureSource, PictureTextile, ShadingError, to_textile};
