//! What can go wrong, as plain data: how each direction of a link treats bytes, what a device is
//! wrong about, and what happens once at a told time.
//!
//! Nothing here acts; [`WiredDevice`](super::WiredDevice) does what is described. Two equal
//! descriptions with the same seed give the same bytes at the same times.

use std::fmt;

use crate::device::{FirmwareLie, Miswiring};
use selvedge_foundation::named;

/// Everything that is to go wrong with one emulated device and its link. The default: nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faults {
    /// Where all random numbers begin.
    pub seed: u64,
    /// What happens to bytes on their way to the device.
    pub to_device: LinkFaults,
    /// What happens to bytes on their way to the host.
    pub to_host: LinkFaults,
    /// How much faster the device's clock runs than true time, parts per million.
    pub clock_ppm: i32,
    /// How far each tick may lie from its place, µs, either way; at most 10 000.
    pub tick_jitter_us: u32,
    /// What the device says although it is not so, and the rules that it breaks.
    pub lies: Vec<FirmwareLie>,
    /// Contactors that do not move, or move in place of another.
    pub wiring: Miswiring,
    /// The supply current above which the device reports over-current, mA.
    pub over_current_ma: Option<u16>,
    /// What happens at told times, in any order.
    pub once: Vec<OneOff>,
}

/// The largest error of a clock that can be asked for, parts per million.
const LARGEST_PPM: i32 = 10_000;
/// The largest tick jitter that can be asked for, µs: ticks must stay in order.
const LARGEST_JITTER_US: u32 = 10_000;

impl Faults {
    /// Whether anything at all is to go wrong.
    pub fn is_none(&self) -> bool {
        let nothing = Self {
            seed: self.seed,
            ..Self::default()
        };
        *self == nothing
    }

    /// Whether a device of `n_channels` can have these faults; otherwise one line says what to
    /// change.
    pub fn check(&self, n_channels: usize) -> Result<(), String> {
        if let Some(channel) = self.wiring.largest().filter(|&most| most >= n_channels) {
            return Err(format!(
                "channel {channel}: this array has channels 0 to {}; choose one of them",
                n_channels.saturating_sub(1)
            ));
        }
        if self.clock_ppm.abs() > LARGEST_PPM {
            return Err(format!(
                "a clock error of {} ppm: choose −{LARGEST_PPM} to {LARGEST_PPM}",
                self.clock_ppm
            ));
        }
        if self.tick_jitter_us > LARGEST_JITTER_US {
            return Err(format!(
                "a tick jitter of {} µs: choose at most {} ms, so that ticks stay in order",
                self.tick_jitter_us,
                LARGEST_JITTER_US / 1000
            ));
        }
        Ok(())
    }
}

/// What one direction of a link does to bytes. The default: nothing, at once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkFaults {
    /// How long a write takes to arrive.
    pub latency: Latency,
    /// Rate of a serial line, on which a byte takes ten bits; `None` takes no time.
    pub baud: Option<u32>,
    /// Share of writes that take [`hiccup_us`](Self::hiccup_us) longer, 0…1.
    pub hiccup_rate: f64,
    /// How much longer those take, µs.
    pub hiccup_us: u64,
    /// Share of bytes that are lost, 0…1.
    pub drop_rate: f64,
    /// Share of bytes that arrive as another byte, 0…1.
    pub flip_rate: f64,
    /// Share of bytes that a random byte comes before, 0…1.
    pub insert_rate: f64,
    /// Share of USB packets (64 bytes of a write) that are lost whole, 0…1.
    pub usb_loss_rate: f64,
    /// Share of writes that arrive twice, 0…1.
    pub repeat_rate: f64,
    /// Mean time between two bursts of random bytes, µs.
    pub garbage_every_us: Option<u64>,
    /// Text of other programs: towards the device the `AT+GCAP` of a modem manager before each
    /// visit, towards the host a boot banner after each boot.
    pub chatter: bool,
}

/// How long a write takes to arrive. Order is always kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Latency {
    /// At once.
    #[default]
    None,
    /// With the next USB frame, of which there is one every ms: a CDC device.
    UsbFrame,
    /// When a timer of so many µs that began with the first waiting byte runs out, or 62 bytes
    /// wait: what an FTDI adapter does with bytes for the host.
    Timer(u64),
    /// Normally distributed, µs; what falls below zero arrives at once.
    Normal {
        /// Mean, µs.
        mean_us: u32,
        /// Standard deviation, µs.
        deviation_us: u32,
    },
}

/// A direction of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the host to the device.
    ToDevice,
    /// From the device to the host.
    ToHost,
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ToDevice => "to device",
            Self::ToHost => "to host",
        })
    }
}

/// Something that happens once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OneOff {
    /// When, µs since the start of the emulation.
    pub at_us: u64,
    /// For how long, µs.
    pub for_us: u64,
    /// What.
    pub kind: OneOffKind,
}

named! {
    /// What can happen once.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum OneOffKind {
        /// The device reads nothing; up to 4 kB wait.
        StallReading = "stall reading",
        /// Nothing that the device writes arrives; up to 4 kB wait.
        StallWriting = "stall writing",
        /// The cable is out; what was under way is lost, and the device notices the hang-up.
        Unplug = "unplug",
        /// The device starts anew.
        Reboot = "reboot",
        /// The device starts anew and reports a watchdog reset.
        Watchdog = "watchdog reset",
        /// It gets too hot.
        OverTemperature = "over-temperature",
        /// The amplifier takes too much current.
        OverCurrent = "over-current",
        /// The high voltage breaks down to 60 %.
        HvSag = "HV sag",
    }
    /// A word or two for people and logs.
    pub fn name;
}

impl OneOffKind {
    /// How long it lasts when nothing is said, µs.
    pub fn usual_us(self) -> u64 {
        match self {
            Self::StallReading | Self::StallWriting | Self::Reboot | Self::Watchdog => 300_000,
            Self::Unplug | Self::OverTemperature | Self::OverCurrent | Self::HvSag => 2_000_000,
        }
    }
}

/// One fault that was injected, for the device's log and for those who count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Injection {
    /// What.
    pub kind: InjectionKind,
    /// How much of it, in the kind's own unit.
    pub(crate) amount: u64,
}

/// What was injected, and what its amount counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InjectionKind {
    /// Bytes lost.
    Dropped(Direction),
    /// Bytes changed.
    Flipped(Direction),
    /// Bytes put in.
    Inserted(Direction),
    /// Bytes of a lost USB packet.
    UsbLost(Direction),
    /// Bytes of a write that arrives twice.
    Repeated(Direction),
    /// µs that a write takes longer.
    Hiccup(Direction),
    /// Bytes of a burst of garbage.
    Garbage(Direction),
    /// Bytes of a text that somebody else sends.
    Chatter(Direction),
    /// Bytes that found no room.
    Overflow(Direction),
    /// Begins; µs that it lasts.
    Begins(OneOffKind),
    /// Ends; µs that it lasted.
    Ends(OneOffKind),
}

impl Injection {
    /// Whether it happened at a told time, rather than again and again by chance.
    pub fn is_rare(&self) -> bool {
        matches!(self.kind, InjectionKind::Begins(_) | InjectionKind::Ends(_))
    }
}

impl fmt::Display for Injection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let n = self.amount;
        match self.kind {
            InjectionKind::Dropped(way) => write!(f, "fault drop {way} {n} B"),
            InjectionKind::Flipped(way) => write!(f, "fault flip {way} {n} B"),
            InjectionKind::Inserted(way) => write!(f, "fault insert {way} {n} B"),
            InjectionKind::UsbLost(way) => write!(f, "fault USB packet lost {way} {n} B"),
            InjectionKind::Repeated(way) => write!(f, "fault repeat {way} {n} B"),
            InjectionKind::Hiccup(way) => write!(f, "fault hiccup {way} {n} us"),
            InjectionKind::Garbage(way) => write!(f, "fault garbage {way} {n} B"),
            InjectionKind::Chatter(way) => write!(f, "fault chatter {way} {n} B"),
            InjectionKind::Overflow(way) => write!(f, "fault overflow {way} {n} B"),
            InjectionKind::Begins(kind) => write!(f, "fault {} begins {n} us", kind.name()),
            InjectionKind::Ends(kind) => write!(f, "fault {} ends {n} us", kind.name()),
        }
    }
}
