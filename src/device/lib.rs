//! The serial bridge to a tactile array: protocol, safety, array profiles, device emulators, and
//! files for other programs.
//!
//! Amplitudes in µm come in; a device that synthesizes its own carriers hears of them once per 25
//! ms tick. The device paces: it emits STATUS at every tick, the host answers with one FRAME for a
//! coming tick. Every FRAME is the full state, so a loss needs no repair: the device holds, then
//! ramps to silence within 100 ms by its own clock.
//!
//! ```text
//! amplitudes ─ codes ─ host ─ message ─ framing ─ port     (µm → u16, then the session)
//!                                                  ║       (serial, pty or in process)
//! output ─ device ─ message ─ framing ─────────── port     (hold, ramp, STOP)
//!      └── actuators                                            (what contactors would do)
//! ```
//!
//! `HostSession` and `DeviceCore` are pure state machines that tests run against each other in
//! virtual time. `Bridge` puts a reader and a writer thread around the former, the emulators put a
//! clock around the latter, and `wire` seeded faults between both.
//!
//! # Invariants
//! - No textile, no scene, no rendering: this floor knows amplitudes per contactor and nothing of
//!   where they come from.
//! - Drive codes are made in `codes` and nowhere else; no NaN reaches a device.
//! - Nothing here arms without a command, and nothing re-arms.
//! - Memory is bounded whatever arrives; no bytes make anything panic.
//! - Callers never wait for a port: opening, reading and writing happen on named threads.
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod actuator_model;
mod array;
mod certify;
mod codes;
mod device;
mod driver;
mod emulator;
mod error;
mod fields;
mod frames;
mod framing;
mod handle;
mod hjif;
mod host;
mod link;
mod message;
mod port;
mod replay;
mod session_log;
mod wav;
mod wav_parts;
mod wire;

pub use actuator_model::{
    ActuatorModel, ActuatorReading, ActuatorWatch, Amplifier, Bimorph, ContactorModel,
    ContactorReading, SAMPLES_PER_S, Skin,
};
pub use array::{ArrayProfile, Calibration, DeviceUid, ProfileFolder, Wiring, wiring};
pub use certify::{
    Certificate, CertificateFolder, CheckOutcome, CheckResult, Extent, Line, Trial, VirtualLine,
};
pub use codes::{CodeCounters, Coder, FULL_CODE, Limit, LimiterState, LinkScale};
pub use device::{
    AppliedFrame, CoreCounters, DeviceCore, DeviceModel, DeviceSink, FirmwareLie, Load, Miswiring,
    Moment, Sense,
};
pub use driver::{DirectLine, Driver, Ended, FrameSource, Pacer};
#[cfg(unix)]
pub use emulator::PtyEmulator;
pub use error::{BridgeError, SinkError};
pub use frames::FrameTable;
pub use framing::{Decoder, LARGEST_BODY, Packet, Received};
pub use handle::{Bridge, Target};
pub use hjif::{HjifSpec, HjifWriter};
pub use host::{
    ArrayChange, BridgeCounters, BridgeEvent, BridgeState, ClockFit, DisarmedBy, HostSession,
    SentFrame,
};
pub use link::{Distribution, DistributionBar, Spread, StopHandle, Timings};
pub use message::{
    Ack, Arm, Caps, Clear, Config, DeviceCounters, DeviceMessage, DeviceState, Fault, Hello, Ident,
    LARGEST_CHANNELS, LogText, Message, Ping, Pong, Status, Stop, StopHow, Unreadable, fault_bit,
    frame, kind,
};
pub use port::{
    FoundPort, PairPort, Port, PortEntry, PortIdentity, RecognisedBy, UDEV_RULE, UsbIdentity,
};
pub use replay::{ReplayedLink, ReplayedTick};
pub use session_log::{LogBound, LogFeed, SessionLog};
pub use wav::{SampleFormat, WavSpec};
pub use wav_parts::WavParts;
pub use wire::{
    Direction, FaultGroup, FaultKind, FaultOption, FaultWords, Faults, Injection, InjectionKind,
    Latency, LinkFaults, OneOff, OneOffKind, Simulation, SimulationLog, WiredDevice,
};
