//! What a device is tried with, section by section. Each check opens its own session, says what it
//! says, and knows what a right device does; none depends on another.

mod caps;
mod check;
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

pub(super) use check::{Check, When};

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
