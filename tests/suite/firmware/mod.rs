//! The kit for firmware engineers: golden vectors, and the core in C against our own device and
//! against the real host.
//!
//! What needs a compiler or an emulator that is not installed says so on stderr and passes.
#![cfg(unix)]

mod board;
mod certified;
mod defects;
mod differential;
mod kit;
mod layout;
mod pico;
mod reference;
mod script;
mod sessions;
mod tools;
mod vectors;
