//! An emulated device with a link that fails: seeded faults between its state machine and a port.
//!
//! ```text
//! host ── bytes ──▶ link (late, dropped, flipped, …) ──▶ DeviceCore, its own clock
//!      ◀── bytes ── link ◀───────────────────────────────┘  reboot, unplug, fault at told times
//! ```
//!
//! [`WiredDevice`] is as pure as the device inside: true time and bytes in, bytes out at times. The
//! emulators put a real clock around it, [`Simulation`] a virtual one and a host. What is to go
//! wrong is said by [`Faults`]; every fault that happens is told as an [`Injection`], so that
//! counters can be compared with what was done.

mod clock;
mod faults;
mod faulty_channel;
mod options;
mod parse;
mod simulation;
mod wired;

pub use faults::{
    Direction, Faults, Injection, InjectionKind, Latency, LinkFaults, OneOff, OneOffKind,
};
pub use options::{FaultGroup, FaultKind, FaultOption, FaultWords};
pub use simulation::{Simulation, SimulationLog};
pub(super) use wired::WireSink;
pub use wired::WiredDevice;

#[cfg(test)]
mod tests;
