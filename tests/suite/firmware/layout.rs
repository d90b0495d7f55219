//! The byte tables of the protocol once more, for the golden vectors: field names, widths, order.
//!
//! Written from the document and not from the library, so that a slip in one of them shows.

use std::collections::BTreeMap;

/// What a field is.
#[derive(Clone, Copy)]
enum Field {
    /// An integer of so many bytes, little-endian.
    Int(usize),
    /// Text of exactly so many bytes.
    Text(usize),
    /// Text to the end, its length in the byte before.
    Name,
    /// Pairs A40, A320 from the lists `a40` and `a320`.
    Codes,
    /// Bytes in hex to the end.
    Rest,
}
use Field::{Codes, Int, Name, Rest, Text};

type Table = (&'static str, u8, &'static [(&'static str, Field)]);

const CONFIG: &[(&str, Field)] = &[
    ("mode", Int(1)),
    ("flags", Int(1)),
    ("hold_ms", Int(2)),
    ("ramp_ms", Int(2)),
    ("slew", Int(2)),
    ("hv_dv", Int(2)),
    ("limit_40", Int(2)),
    ("limit_320", Int(2)),
    ("reserved", Int(2)),
    ("mask", Int(4)),
];

const TABLES: &[Table] = &[
    (
        "HELLO",
        0x01,
        &[
            ("magic", Text(4)),
            ("session", Int(4)),
            ("ver_min", Int(1)),
            ("ver_max", Int(1)),
            ("host_flags", Int(2)),
            ("lease_ms", Int(2)),
            ("reserved", Int(2)),
        ],
    ),
    (
        "CAPS",
        0x81,
        &[
            ("magic", Text(4)),
            ("session", Int(4)),
            ("version", Int(1)),
            ("n_comp", Int(1)),
            ("n_ch", Int(2)),
            ("rows", Int(1)),
            ("cols", Int(1)),
            ("pitch_um", Int(2)),
            ("tick_us", Int(4)),
            ("queue", Int(1)),
            ("dac_bits", Int(1)),
            ("modes", Int(2)),
            ("fs_mv", Int(4)),
            ("hv_max_dv", Int(2)),
            ("slew_max", Int(2)),
            ("max_body", Int(2)),
            ("sample_hz", Int(2)),
            ("freq_40_mhz", Int(4)),
            ("freq_320_mhz", Int(4)),
            ("limit_40", Int(2)),
            ("limit_320", Int(2)),
            ("uid", Text(12)),
            ("fw_major", Int(1)),
            ("fw_minor", Int(1)),
            ("fw_patch", Int(1)),
            ("name", Name),
        ],
    ),
    ("CONFIG", 0x02, CONFIG),
    ("CFG", 0x82, CONFIG),
    ("ARM", 0x03, &[("session", Int(4)), ("key", Int(4))]),
    ("FRAME", 0x04, &[("tick", Int(4)), ("codes", Codes)]),
    ("STOP", 0x05, &[("reason", Int(1)), ("how", Int(1))]),
    ("PING", 0x06, &[("token", Int(4))]),
    (
        "PONG",
        0x86,
        &[
            ("token", Int(4)),
            ("dev_us", Int(4)),
            ("tick", Int(4)),
            ("phase_us", Int(2)),
        ],
    ),
    ("CLEAR", 0x07, &[("faults", Int(2))]),
    (
        "SAMPLES",
        0x08,
        &[
            ("first_sample", Int(4)),
            ("n", Int(1)),
            ("format", Int(1)),
            ("reserved", Int(2)),
            ("values", Rest),
        ],
    ),
    (
        "IDENT",
        0x09,
        &[("channel", Int(2)), ("ms", Int(2)), ("amp", Int(2))],
    ),
    (
        "ACK",
        0x83,
        &[("type", Int(1)), ("code", Int(1)), ("acked_seq", Int(2))],
    ),
    (
        "STATUS",
        0x84,
        &[
            ("tick", Int(4)),
            ("dev_us", Int(4)),
            ("last_seq", Int(2)),
            ("state", Int(1)),
            ("queued", Int(1)),
            ("underrun", Int(2)),
            ("late", Int(2)),
            ("dup", Int(2)),
            ("bad", Int(2)),
            ("clipped", Int(2)),
            ("hv_dv", Int(2)),
            ("i_ma", Int(2)),
            ("temp_cdeg", Int(2)),
            ("faults", Int(2)),
            ("age_ms", Int(2)),
            ("amp_sum", Int(4)),
        ],
    ),
    (
        "FAULT",
        0x85,
        &[
            ("faults", Int(2)),
            ("channel", Int(2)),
            ("value", Int(4)),
            ("tick", Int(4)),
        ],
    ),
    ("LOG", 0x8f, &[("text", Rest)]),
];

/// A message in words, `PING seq=2 token=1000000`, as type, seq and payload. Fields that are not
/// named are 0; other types than the known are `TYPE type=0x0a` with a `payload`.
pub(crate) fn encode(said: &str) -> (u8, u16, Vec<u8>) {
    let (message, fields) = said.split_once(' ').unwrap();
    let mut values: BTreeMap<&str, &str> = fields
        .split_whitespace()
        .map(|field| field.split_once('=').unwrap())
        .collect();
    values.entry("magic").or_insert("HBP1");
    let seq = u16::try_from(integer(values.remove("seq").unwrap())).unwrap();
    if message == "TYPE" {
        let kind = u8::try_from(integer(values["type"])).unwrap();
        let payload = values.get("payload").copied().unwrap_or("");
        return (kind, seq, super::reference::bytes(payload));
    }
    let tables = TABLES.iter().find(|table| table.0 == message);
    let (_, kind, table) = tables.unwrap_or_else(|| panic!("no message {message}: {said}"));
    for name in values.keys() {
        let is_known = table.iter().any(|(known, _)| known == name);
        let is_list = ["a40", "a320", "magic"].contains(name);
        assert!(is_known || is_list, "{message} has no {name}: {said}");
    }
    let mut payload = Vec::new();
    for (name, field) in *table {
        append(&mut payload, *field, name, &values);
    }
    (*kind, seq, payload)
}

fn append(payload: &mut Vec<u8>, field: Field, name: &str, values: &BTreeMap<&str, &str>) {
    let value = values.get(name).copied();
    match field {
        Int(width) => {
            let value = integer(value.unwrap_or("0"));
            payload.extend(&value.to_le_bytes()[..width]);
        }
        Text(width) => {
            let text = value.unwrap_or_default();
            assert_eq!(text.len(), width, "{name}");
            payload.extend(text.bytes());
        }
        Name => {
            let text = value.unwrap_or_default().replace('_', " ");
            payload.push(u8::try_from(text.len()).unwrap());
            payload.extend(text.bytes());
        }
        Codes => {
            let (low, high) = (list(values["a40"]), list(values["a320"]));
            assert_eq!(low.len(), high.len(), "as many A40 as A320");
            for pair in low.into_iter().zip(high) {
                payload.extend(pair.0.to_le_bytes());
                payload.extend(pair.1.to_le_bytes());
            }
        }
        Rest => payload.extend(super::reference::bytes(value.unwrap_or_default())),
    }
}

/// `1000*3,5` is 1000, 1000, 1000, 5.
fn list(text: &str) -> Vec<u16> {
    let mut values = Vec::new();
    for part in text.split(',') {
        let (value, count) = part.split_once('*').unwrap_or((part, "1"));
        values.extend(vec![value.parse::<u16>().unwrap(); count.parse().unwrap()]);
    }
    values
}

/// Decimal, `0x` hex, negative, or the name of a state.
fn integer(text: &str) -> i64 {
    const STATES: [&str; 7] = ["IDLE", "READY", "ARMED", "RUN", "HOLD", "RAMP", "FAULT"];
    if let Some(code) = STATES.iter().position(|name| *name == text) {
        return i64::try_from(code).unwrap();
    }
    text.strip_prefix("0x").map_or_else(
        || text.parse().unwrap(),
        |digits| i64::from_str_radix(digits, 16).unwrap(),
    )
}
