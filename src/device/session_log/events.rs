//! What a log may hold: its columns and the names of its events, once for writer, reader and guide.

/// The columns of a log, in order.
pub(super) const COLUMNS: [&str; 6] = [
    "utc",
    "monotonic_s",
    "device_tick",
    "device_us",
    "event",
    "detail",
];

/// Ends a line whose writer was killed in the middle of it.
pub(super) const CUT: &str = "<cut>";

/// Declares the events that the log's own code writes or reads, with their names.
macro_rules! events {
    ($($(#[doc = $doc:literal])+ $event:ident = $name:literal;)+) => {
        /// The name of an event in a log.
        pub(crate) mod event {
            $($(#[doc = $doc])+ pub(crate) const $event: &str = $name;)+
        }

        /// Every name, for the guide.
        #[cfg(test)]
        pub(super) const EVENTS: &[&str] = &[$($name),+];
    };
}

events! {
    /// A link begins, or its log goes on in another file: its number, target and program.
    LINK = "link";
    /// The lines from here on are of another link.
    OF_LINK = "of-link";
    /// Hashes of what is played and on what.
    ABOUT = "about";
    /// A FRAME was written: ticks ahead of the last STATUS, then codes.
    FRAME = "f";
    /// The same with a hash in place of codes.
    FRAME_HASH = "frame-hash";
    /// So many frames more, equal but for their numbers and ticks.
    FRAME_AGAIN = "frame-again";
    /// A STATUS arrived: age, `amp_sum`, then what is not as in the last.
    STATUS = "s";
    /// Both in logs of earlier versions.
    LONG_FRAME = "frame";
    /// The same.
    LONG_STATUS = "status";
    /// Another packet was written: type, number, payload in hexadecimal digits.
    OUT = "out";
    /// Another packet arrived.
    IN = "in";
    /// A packet that the port did not take.
    UNSENT = "unsent";
    /// Bytes were written that are no packet of ours, in hexadecimal digits.
    OUT_BYTES = "out-bytes";
    /// A text arrived that was no packet; of a long one its beginning.
    IN_BYTES = "in-bytes";
    /// So many such texts arrived, in logs of earlier versions.
    BAD = "bad";
    /// So many packets were not recorded.
    PACKETS_LOST = "packets-lost";
    /// So many other entries were not recorded.
    ENTRIES_LOST = "entries-lost";
    /// What a device is certified by now, and what came of it.
    CHECK = "check";
    /// HELLO was sent.
    HELLO = "hello";
    /// What the device says of itself, every field.
    CAPS = "caps";
    /// What was asked for, every field.
    CONFIG = "config";
    /// What holds, every field.
    CFG = "cfg";
    /// ARM was sent.
    ARM = "arm";
    /// ARM was accepted.
    ARMED = "armed";
    /// STOP was sent.
    STOP = "stop";
    /// STOP was sent past everything else.
    STOP_SWITCH = "stop-switch";
    /// STOP was acknowledged.
    STOPPED = "stopped";
    /// CLEAR was sent.
    CLEAR = "clear";
    /// CLEAR was accepted.
    CLEARED = "cleared";
    /// The device refused a message.
    REFUSED = "refused";
    /// The device reports a fault.
    FAULT = "fault";
    /// The device is in another state.
    STATE = "state";
    /// Volts, milliamperes, degrees, `amp_sum`.
    TELEMETRY = "telemetry";
    /// What the device counted.
    DEVICE_COUNTERS = "device-counters";
    /// What this side counted.
    HOST_COUNTERS = "host-counters";
    /// How far ahead frames are sent.
    DEPTH = "depth";
    /// The device cannot be driven; why.
    REFUSED_DEVICE = "refused-device";
    /// The link is gone; why.
    LOST = "lost";
    /// A text of the device.
    DEVICE_LOG = "device-log";
    /// Output ended by itself; why.
    DISARMED_ITSELF = "disarmed-itself";
    /// Output ended as told; why.
    DISARMED = "disarmed";
}
