//! Sessions without a window: what somebody lays before the participant, and answers as they are
//! typed.

mod present;
mod typed;

pub use present::{Placed, needs_array};
pub use typed::form;
