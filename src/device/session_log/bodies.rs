//! Any packet as words and back: its type, its number, its payload in hexadecimal digits.

use std::fmt::Write as _;

use super::tap::Body;
use crate::framing::Received;
use crate::message::kind;

/// The name of a type of packet; its number where it has none.
pub(super) fn kind_name(kind: u8) -> String {
    kind::name(kind).map_or_else(|| format!("{kind:#04x}"), str::to_owned)
}

fn kind_of(name: &str) -> Option<u8> {
    if let Some(digits) = name.strip_prefix("0x") {
        return u8::from_str_radix(digits, 16).ok();
    }
    kind::of_name(name)
}

/// The words of any packet.
pub(super) fn body_words(body: &Body) -> String {
    let mut detail = format!("{} {}", kind_name(body.kind), body.seq);
    if body.flags != 0 {
        push(&mut detail, format_args!(" flags={}", body.flags));
    }
    if !body.payload().is_empty() {
        detail.push(' ');
    }
    detail.push_str(&hex_of(body.payload()));
    detail
}

/// Bytes in hexadecimal digits.
pub(super) fn hex_of(bytes: &[u8]) -> String {
    let mut digits = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        push(&mut digits, format_args!("{byte:02x}"));
    }
    digits
}

/// Reads what [`hex_of`] wrote.
pub(super) fn bytes_of(digits: &str) -> Option<Vec<u8>> {
    let pairs = digits.as_bytes().chunks(2);
    pairs
        .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok())
        .map(|byte| byte.filter(|_| digits.len().is_multiple_of(2)))
        .collect()
}

/// Reads what [`body_words`] wrote.
pub(super) fn read_body(words: &str) -> Option<Body> {
    let mut words = words.split(' ');
    let kind = kind_of(words.next()?)?;
    let seq = words.next()?.parse().ok()?;
    let mut next = words.next();
    let flags = match next.and_then(|word| word.strip_prefix("flags=")) {
        None => 0,
        Some(flags) => {
            next = words.next();
            flags.parse().ok()?
        }
    };
    let payload = next.map_or(Some(Vec::new()), bytes_of)?;
    let payload = &payload;
    let body = Body::new(&Received { kind, seq, payload })?.with_flags(flags);
    words.next().is_none().then_some(body)
}

/// Appends words.
pub(super) fn push(text: &mut String, words: std::fmt::Arguments<'_>) {
    let written = text.write_fmt(words);
    debug_assert!(written.is_ok(), "a String takes everything");
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn any_packet_comes_back_to_the_byte(
            kind in any::<u8>(), seq in any::<u16>(), flags in any::<u8>(),
            payload in prop::collection::vec(any::<u8>(), 0..1016),
        ) {
            let payload = &payload;
            let body = Body::new(&Received { kind, seq, payload }).unwrap().with_flags(flags);
            prop_assert_eq!(read_body(&body_words(&body)), Some(body));
        }

        #[test]
        fn any_words_are_read_or_refused(words in "[A-Z0-9x= a-f]{0,60}") {
            let _read = read_body(&words);
        }
    }
}
