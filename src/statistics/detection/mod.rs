//! Detection theory: how far apart two sensations are, from right and wrong answers.
//!
//! Distances are d′: the difference of the means of two normal distributions in units of their
//! common standard deviation. Pooling subjects before the transformation makes d′ too small, so
//! each subject has a d′ of its own; the mean of these is biased where trials are few, so a group
//! has one from all answers ([`Relation::group`], [`GroupDPrime::of_yes_no`]).

mod choice;
mod forced_choice;
mod matching;
mod relation;
mod roc;
mod triangle;
mod yes_no;

pub(crate) use choice::inverted;
pub use choice::{Choice, Correction};
pub(crate) use forced_choice::choice_share;
pub(crate) use matching::abx_share;
pub use relation::{GroupDPrime, Relation};
pub use roc::Roc;
pub(crate) use triangle::triangle_share;
pub use yes_no::{Answers, YesNo};
