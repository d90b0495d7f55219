//! Detection theory: how far apart two sensations are, from right and wrong answers.
//!
//! Distances are d′: the difference of the means of two normal distributions in units of their
//! common standard deviation. Pooling subjects before the transformation makes d′ too small, so
//! each subject has a d′ of its own.

mod choice;
mod forced_choice;
mod matching;
mod roc;
mod triangle;
mod yes_no;

pub(crate) use choice::inverted;
pub use choice::{Choice, Correction};
pub use forced_choice::forced_choice;
#[cfg(test)]
pub(crate) use forced_choice::share_of_d_prime;
pub use matching::{abx, same_different};
pub use roc::{Roc, roc};
pub use triangle::triangle;
pub use yes_no::{Answers, YesNo, yes_no};
