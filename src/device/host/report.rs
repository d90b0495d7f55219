//! What a session tells its owner: states, events, counters.

use std::fmt;
use std::time::{Duration, Instant};

use crate::codes::CodeCounters;
use crate::message::{Caps, Config, DeviceCounters, Fault};
use selvedge_foundation::named;

named! {
    /// Where a session stands.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum BridgeState {
        /// The port is being opened.
        Opening = "opening",
        /// HELLO was sent; no answer yet.
        Greeting = "waiting for the device",
        /// CONFIG was sent; no answer yet.
        Configuring = "configuring",
        /// Connected, no output.
        Ready = "ready",
        /// ARM was sent; no answer yet.
        Arming = "arming",
        /// Output is enabled; no frame was sent yet.
        Armed = "armed",
        /// Frames are being sent.
        Streaming = "streaming",
        /// STOP was sent; the device has not come to rest yet.
        Stopping = "stopping",
        /// The device has latched a fault.
        Faulted = "fault",
        /// The device cannot be driven by this program.
        Refused = "refused",
        /// The link is gone, or the device does not answer.
        Lost = "lost",
    }
    /// A word or two for people.
    pub fn label;
}

impl BridgeState {
    /// Whether a device is, or may become, connected.
    pub fn is_open(self) -> bool {
        !matches!(self, Self::Refused | Self::Lost)
    }

    /// Whether the device may be moving: from ARM until it has come to rest.
    pub fn is_live(self) -> bool {
        matches!(
            self,
            Self::Arming | Self::Armed | Self::Streaming | Self::Stopping
        )
    }

    /// Whether frames may be sent.
    pub fn takes_frames(self) -> bool {
        matches!(self, Self::Armed | Self::Streaming)
    }
}

impl fmt::Display for BridgeState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.label())
    }
}

/// Who ended output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisarmedBy {
    /// The device, without being asked.
    Device,
    /// This program.
    Host,
}

/// News of a session.
#[derive(Clone, Debug, PartialEq)]
pub enum BridgeEvent {
    /// The device answered; its CAPS were accepted.
    Connected(Caps),
    /// It is another device than the link before had; one line says so, and what to do where the
    /// profile was measured on one.
    OtherDevice(String),
    /// The device is configured, with these effective values, and may be armed.
    Ready(Config),
    /// The device cannot be driven; one line says why.
    Refused(String),
    /// A device tick began: answer with a frame.
    Tick {
        /// When the STATUS arrived.
        received: Instant,
        /// When to make the frame, so that it comes just in time; answering at once is safe too.
        due: Instant,
    },
    /// Output is enabled.
    Armed,
    /// Output has ended.
    Disarmed {
        /// Who ended it.
        by: DisarmedBy,
        /// One line.
        reason: String,
    },
    /// The link is gone; one line says why.
    Lost(String),
    /// The device reports a fault.
    Fault(Fault),
    /// Frames are now sent for this many ticks ahead, because some came late.
    DepthRaised(u8),
    /// Frames are now sent for this many ticks ahead, fewer than before: none came late for long.
    DepthLowered(u8),
    /// Answer to a ping.
    Pong {
        /// From the request to its answer.
        round_trip: Duration,
        /// Where in its tick the device was, in µs.
        phase_us: u16,
    },
    /// A line of text from the device.
    Log(String),
    /// The device drives this channel alone.
    Identified {
        /// Index of the channel.
        channel: u16,
    },
    /// It does not.
    NotIdentified {
        /// Index of the channel.
        channel: u16,
        /// Why not.
        reason: String,
    },
}

/// The stamp of a frame that went to the link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SentFrame {
    /// Packet number, as the device's STATUS and log show it.
    pub seq: u16,
    /// Tick at which it takes effect.
    pub apply_tick: u32,
    /// Soft-start gain that its codes contain, 0…1.
    pub gain: f64,
    /// When it was due; `None` for one that answers no STATUS, or not as the first.
    pub due: Option<Instant>,
    /// From its making to the start of the tick at which it takes effect, by the device's clock.
    pub ahead: Duration,
}

/// Everything that is counted on a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BridgeCounters {
    /// Counted by the device.
    pub device: DeviceCounters,
    /// Amplitudes that had to be changed before they became codes.
    pub codes: CodeCounters,
    /// Frames written to the port.
    pub frames_sent: u64,
    /// Frames that a newer one replaced, or a STOP discarded, before they were written.
    pub frames_superseded: u64,
    /// Frames that the device answered with a refusal.
    pub frames_rejected: u64,
    /// STATUS whose tick repeated, went back or jumped: they pace nothing.
    pub stray_status: u64,
    /// Texts from the device that were no packet.
    pub bad_received: u64,
    /// Messages of the device that found no room because nobody took them.
    pub events_dropped: u64,
    /// Writes that the port did not take in time.
    pub write_timeouts: u64,
}
