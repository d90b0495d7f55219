//! Firmware lies: what an emulated device says although it is not so, and the rules of the protocol
//! that it breaks.
//!
//! Every lie is one line of the table. A lie about a field changes bytes of a message on its way
//! out; a lie about a rule is a [`Rule`], asked for where the device keeps that rule. Nothing here
//! knows the device.

mod config;
mod declared;
mod fields;
mod firmware;
mod hearing;
mod rules;
mod telling;

pub(super) use config::{granted, in_effect};
pub use firmware::FirmwareLie;
pub(super) use firmware::{boot_state, room, value};
pub(super) use rules::Rule;
pub(super) use telling::LieMemory;

#[cfg(test)]
mod tests;
