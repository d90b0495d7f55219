//! What checks of a design ask for, in the words that a flaw has.

use std::fmt::Display;
use std::ops::RangeInclusive;

use selvedge_foundation::files::{Flaw, Place};

/// Most stimuli of a design: schedules are made at once.
pub(super) const MOST_STIMULI: usize = 400;
/// Most times that a stimulus may come.
pub(super) const MOST_REPEATS: usize = 1000;

type Checked = Result<(), Flaw>;

/// A flaw, unless all is right.
pub(super) fn need(
    is_right: bool,
    place: Place,
    what: impl Into<String>,
    mend: impl Into<String>,
) -> Checked {
    if is_right {
        return Ok(());
    }
    Err(Flaw::new(place, what, mend))
}

/// A flaw, unless a number lies within bounds.
pub(super) fn need_within<T: PartialOrd + Display>(
    place: Place,
    value: &T,
    bounds: RangeInclusive<T>,
    unit: &str,
) -> Checked {
    let mend = format!("give {} to {}{unit}", bounds.start(), bounds.end());
    need(
        bounds.contains(value),
        place,
        format!("{} is {value}", place.2),
        mend,
    )
}
