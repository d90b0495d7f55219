//! Lies about what messages say: each field of each message, by its place in the message's table.

use super::declared::{Act, Declared, Takes};
use crate::message::kind;

/// A field of a message: name, message, offset, bytes, examples, what it is.
macro_rules! field {
    ($name:literal, $kind:ident, $at:literal, $width:literal, $examples:expr, $help:literal) => {
        Declared {
            name: $name,
            takes: Takes::Field($width),
            examples: &$examples,
            help: concat!("2.2: ", stringify!($kind), " says another ", $help),
            act: Act::Field {
                kind: kind::$kind,
                at: $at,
                width: $width,
            },
        }
    };
}

/// The length of a message.
macro_rules! length {
    ($name:literal, $act:ident, $kind:ident, $examples:expr, $help:literal) => {
        Declared {
            name: $name,
            takes: Takes::UpTo(255),
            examples: &$examples,
            help: concat!("2.6: ", stringify!($kind), " ", $help),
            act: Act::$act(kind::$kind),
        }
    };
}

/// All of them, message by message.
#[rustfmt::skip]
pub(super) const FIELDS: &[Declared] = &[
    field!("caps.magic", CAPS, 0, 4, ["0", "+1"], "magic"),
    field!("caps.session", CAPS, 4, 4, ["0", "+1", "-1"], "session than that of HELLO"),
    field!("caps.version", CAPS, 8, 1, ["0", "2"], "version"),
    field!("caps.components", CAPS, 9, 1, ["1", "3"], "number of components"),
    field!("caps.channels", CAPS, 10, 2, ["23", "25"], "number of channels"),
    field!("caps.rows", CAPS, 12, 1, ["5", "7"], "number of rows"),
    field!("caps.cols", CAPS, 13, 1, ["3", "5"], "number of columns"),
    field!("caps.pitch-um", CAPS, 14, 2, ["-1", "+1"], "pitch in µm"),
    field!("caps.tick-us", CAPS, 16, 4, ["20000", "50000"], "length of a tick in µs"),
    field!("caps.queue", CAPS, 20, 1, ["0", "1", "+4"], "number of frames that can wait"),
    field!("caps.dac-bits", CAPS, 21, 1, ["-4", "+4"], "resolution of its converters in bits"),
    field!("caps.modes", CAPS, 22, 2, ["0", "1", "4", "7"], "set of modes"),
    field!("caps.fs-mv", CAPS, 24, 4, ["0", "25000", "200000"], "drive in mV at full code"),
    field!("caps.hv-max-dv", CAPS, 28, 2, ["0", "+5000"], "largest high voltage in 0.1 V"),
    field!("caps.slew-max", CAPS, 30, 2, ["0", "1", "+5000"], "largest step of a tick"),
    field!("caps.max-body", CAPS, 32, 2, ["107", "1024"], "largest body in bytes"),
    field!("caps.sample-hz", CAPS, 34, 2, ["0", "48000"], "sample rate in Hz"),
    field!("caps.low-mhz", CAPS, 36, 4, ["39000", "50000"], "lower carrier in mHz"),
    field!("caps.high-mhz", CAPS, 40, 4, ["250000", "321000"], "upper carrier in mHz"),
    field!("caps.low-limit", CAPS, 44, 2, ["0", "+5000"], "largest code at 40 Hz"),
    field!("caps.high-limit", CAPS, 46, 2, ["0", "+5000"], "largest code at 320 Hz"),
    field!("caps.uid", CAPS, 48, 4, ["0", "+1"], "beginning of its number"),
    field!("caps.firmware", CAPS, 60, 1, ["0", "+1"], "main version of its firmware"),
    field!("caps.name-length", CAPS, 63, 1, ["0", "255"], "length of its name"),
    field!("caps.name", CAPS, 64, 1, ["27", "255"],
        "first letter of its name, control characters and what is no UTF-8 too"),
    length!("caps.cut", Cut, CAPS, ["1", "40", "77"], "ends after so many bytes"),
    length!("caps.extra", Extra, CAPS, ["1", "8"], "has so many bytes too many"),

    field!("cfg.mode", CFG, 0, 1, ["1", "255"], "mode than asked"),
    field!("cfg.flags", CFG, 1, 1, ["1", "255"], "flags than asked"),
    field!("cfg.hold-ms", CFG, 2, 2, ["0", "24", "-1", "+1", "65000"], "hold in ms"),
    field!("cfg.ramp-ms", CFG, 4, 2, ["0", "-1", "+1", "65000"], "ramp in ms"),
    field!("cfg.slew", CFG, 6, 2, ["0", "-1", "+1"], "step of a tick"),
    field!("cfg.hv-dv", CFG, 8, 2, ["0", "-1", "+1", "65535"], "high voltage in 0.1 V"),
    field!("cfg.low-limit", CFG, 10, 2, ["0", "-1", "+1"], "largest code at 40 Hz"),
    field!("cfg.high-limit", CFG, 12, 2, ["0", "-1", "+1"], "largest code at 320 Hz"),
    field!("cfg.reserved", CFG, 14, 2, ["65535"], "reserved field than 0"),
    field!("cfg.mask", CFG, 16, 4, ["0", "+1", "-1", "4294967295"], "set of the first 32 channels"),
    length!("cfg.cut", Cut, CFG, ["1", "19"], "ends after so many bytes"),
    length!("cfg.extra", Extra, CFG, ["1"], "has so many bytes too many"),

    field!("ack.type", ACK, 0, 1, ["0", "+1"], "type than the answered"),
    field!("ack.code", ACK, 1, 1, ["0", "1", "2", "3", "4", "5", "6", "7", "255"], "code"),
    field!("ack.seq", ACK, 2, 2, ["-1", "+1"], "seq than the answered"),
    length!("ack.cut", Cut, ACK, ["3"], "ends after so many bytes"),
    length!("ack.extra", Extra, ACK, ["1"], "has so many bytes too many"),

    field!("status.tick", STATUS, 0, 4, ["0", "-1", "+1", "+2147483648", "100@100"], "tick"),
    field!("status.dev-us", STATUS, 4, 4, ["0", "-1000", "+1000"], "clock in µs"),
    field!("status.last-seq", STATUS, 8, 2, ["0", "-1", "+1"], "last accepted FRAME"),
    field!("status.state", STATUS, 10, 1,
        ["0", "1", "2", "3", "4", "5", "6", "7", "255", "3@120", "7@120"], "state"),
    field!("status.queued", STATUS, 11, 1, ["0", "+1"], "number of waiting frames"),
    field!("status.underrun", STATUS, 12, 2, ["0", "-1", "+1"], "count of ticks without a frame"),
    field!("status.late", STATUS, 14, 2, ["0", "-1", "+1"], "count of late frames"),
    field!("status.dup", STATUS, 16, 2, ["0", "-1", "+1"], "count of repeated frames"),
    field!("status.bad", STATUS, 18, 2, ["0", "-1", "+1"], "count of texts that are no packet"),
    field!("status.clipped", STATUS, 20, 2, ["0", "-1", "+1"], "count of clipped values"),
    field!("status.hv-dv", STATUS, 22, 2, ["0", "+100", "65535"], "high voltage in 0.1 V"),
    field!("status.i-ma", STATUS, 24, 2, ["+1", "65535"], "current in mA"),
    field!("status.temp", STATUS, 26, 2, ["-4000", "8500", "32767"], "temperature in 0.01 °C"),
    field!("status.faults", STATUS, 28, 2,
        ["1", "2", "4", "8", "16", "32", "64", "128", "256", "64@120"], "set of fault bits"),
    field!("status.age-ms", STATUS, 30, 2, ["0", "-1", "+1", "65535"],
        "age of the last frame in ms"),
    field!("status.amp-sum", STATUS, 32, 4, ["0", "+1", "+100000", "4294967295"],
        "sum of amplitudes"),
    length!("status.cut", Cut, STATUS, ["1", "35"], "ends after so many bytes"),
    length!("status.extra", Extra, STATUS, ["1"], "has so many bytes too many"),

    field!("fault.faults", FAULT, 0, 2, ["0", "+1"], "set of fault bits"),
    field!("fault.channel", FAULT, 2, 2, ["0", "-1"], "channel"),
    field!("fault.value", FAULT, 4, 4, ["-1", "+1"], "value"),
    field!("fault.tick", FAULT, 8, 4, ["-1", "+1"], "tick"),
    length!("fault.cut", Cut, FAULT, ["11"], "ends after so many bytes"),

    field!("pong.token", PONG, 0, 4, ["0", "-1", "+1"], "token than that of PING"),
    field!("pong.dev-us", PONG, 4, 4, ["0", "-1000", "+1000"], "clock in µs"),
    field!("pong.tick", PONG, 8, 4, ["0", "-1", "+1"], "tick"),
    field!("pong.phase-us", PONG, 12, 2, ["0", "-1000", "+1000", "25000"],
        "time since the tick began in µs"),
    length!("pong.cut", Cut, PONG, ["13"], "ends after so many bytes"),
    length!("pong.extra", Extra, PONG, ["1"], "has so many bytes too many"),
];
