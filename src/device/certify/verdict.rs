//! How a check ends.

/// Why a check ends before it is passed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The device is wrong.
    Wrong(String),
    /// The host or the link was too late to tell; to be tried again.
    Late,
    /// It cannot be tried on this device.
    Untested(String),
    /// The link is gone, or time is up, or somebody said stop: nothing more can be tried.
    Over(String),
}

/// What a check gives.
pub(super) type Verdict = Result<(), Trouble>;

/// Wrong, unless: `ensure!(is_right, "what is wrong, {value}")`.
macro_rules! ensure {
    ($is_right:expr, $($what:tt)+) => {
        if $is_right {
            Ok(())
        } else {
            Err($crate::certify::verdict::Trouble::Wrong(format!($($what)+)))
        }
    };
}
pub(super) use ensure;
