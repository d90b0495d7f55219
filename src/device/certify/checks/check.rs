//! What a check is, and how a section declares its own.

use crate::certify::client::Client;
use crate::certify::verdict::Verdict;

/// One thing that is tried.
pub(crate) struct Check {
    pub(crate) section: &'static str,
    pub(crate) name: &'static str,
    /// What a right device does, in one line.
    pub(crate) expects: &'static str,
    pub(crate) when: When,
    pub(crate) run: fn(&mut Client<'_>) -> Verdict,
}

/// Declares the checks of a section.
macro_rules! checks {
    ($section:literal: $($when:ident $name:literal $run:path, $expects:literal;)+) => {
        /// The checks of this section.
        pub(super) const CHECKS: &[$crate::certify::checks::check::Check] = &[
            $($crate::certify::checks::check::Check {
                section: $section,
                name: $name,
                expects: $expects,
                when: $crate::certify::checks::check::When::$when,
                run: $run,
            },)+
        ];
    };
}
pub(super) use checks;

/// When a check is tried.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum When {
    /// Always, and nothing else without it.
    First,
    /// In the quick half too.
    Quick,
    /// Where everything is tried.
    Full,
}
