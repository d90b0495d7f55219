//! What a device is tried with, section by section. Each check opens its own session, says what it
//! says, and knows what a right device does; none depends on another.

mod caps;
mod frames;
mod framing;
mod ident;
mod lease;
mod limits;
mod ping;
mod session;
mod silence;
mod states;
mod steps;
mod stop;

use super::client::{Client, Verdict};

/// One thing that is tried.
pub(super) struct Check {
    pub(super) section: &'static str,
    pub(super) name: &'static str,
    /// What a right device does, in one line.
    pub(super) expects: &'static str,
    /// Whether the quick half has it too.
    pub(super) is_quick: bool,
    /// Whether nothing else can be tried without it.
    pub(super) ends_all: bool,
    pub(super) run: fn(&mut Client<'_>) -> Verdict,
}

/// Declares the checks of a section.
macro_rules! checks {
    ($section:literal: $($speed:ident $name:literal $run:path, $expects:literal;)+) => {
        /// The checks of this section.
        pub(super) const CHECKS: &[$crate::certify::checks::Check] = &[
            $($crate::certify::checks::Check {
                section: $section,
                name: $name,
                expects: $expects,
                is_quick: !matches!($crate::certify::checks::Speed::$speed, $crate::certify::checks::Speed::Full),
                ends_all: matches!($crate::certify::checks::Speed::$speed, $crate::certify::checks::Speed::First),
                run: $run,
            },)+
        ];
    };
}
use checks;

/// When a check is tried.
enum Speed {
    /// Always, and nothing else without it.
    First,
    /// In the quick half too.
    Quick,
    /// Where everything is tried.
    Full,
}

/// All checks in the order in which they are tried.
pub(super) fn all() -> impl Iterator<Item = &'static Check> {
    let sections = [
        caps::CHECKS,
        ping::CHECKS,
        framing::CHECKS,
        session::CHECKS,
        states::CHECKS,
        frames::CHECKS,
        limits::CHECKS,
        silence::CHECKS,
        stop::CHECKS,
        ident::CHECKS,
        lease::CHECKS,
    ];
    sections.into_iter().flatten()
}
