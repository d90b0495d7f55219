//! Lies about framing: what a device takes for a packet although it is none, and the other way
//! round. Texts between zeros are changed before the decoder sees them.

use super::rules::Rule;
use crate::framing::{CRC_LEN, HEADER_LEN, LARGEST_PACKET, Packet};

/// Rules that are broken between the wire and the decoder.
const RULES: [Rule; 6] = [
    Rule::NoCrcCheck,
    Rule::LoneZeroBad,
    Rule::LoneOneIgnored,
    Rule::FlagsRefused,
    Rule::FullBlockRefused,
    Rule::LosesNext,
];
/// A text that is bad whatever a device believes.
const BAD: &[u8] = &[1];

/// The text since the last zero, at most a packet and a byte of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hearing {
    text: Vec<u8>,
    loses_next: bool,
}

impl Hearing {
    /// What the decoder is to see of these bytes; `None`: just them.
    pub(crate) fn changed(
        &mut self,
        breaks: impl Fn(Rule) -> bool,
        bytes: &[u8],
    ) -> Option<Vec<u8>> {
        if !RULES.into_iter().any(&breaks) {
            return None;
        }
        let mut heard = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            if byte != 0 {
                if self.text.len() <= LARGEST_PACKET {
                    self.text.push(byte);
                }
                continue;
            }
            let text = std::mem::take(&mut self.text);
            heard.extend(self.text_heard(&breaks, text));
            heard.push(0);
        }
        Some(heard)
    }

    fn text_heard(&mut self, breaks: impl Fn(Rule) -> bool, text: Vec<u8>) -> Vec<u8> {
        if text.is_empty() {
            let bad = if breaks(Rule::LoneZeroBad) { BAD } else { &[] };
            return bad.to_vec();
        }
        if text == BAD && breaks(Rule::LoneOneIgnored) {
            return Vec::new();
        }
        let Some((body, ends_full)) = decoded(&text) else {
            self.loses_next = breaks(Rule::LosesNext);
            return text;
        };
        let is_good = has_good_crc(&body);
        if std::mem::replace(&mut self.loses_next, !is_good && breaks(Rule::LosesNext)) {
            return Vec::new();
        }
        let has_flags = body.get(1).is_some_and(|flags| *flags != 0);
        let is_refused =
            has_flags && breaks(Rule::FlagsRefused) || ends_full && breaks(Rule::FullBlockRefused);
        if is_good && is_refused {
            return BAD.to_vec();
        }
        if !is_good && breaks(Rule::NoCrcCheck) && body.len() >= HEADER_LEN + CRC_LEN {
            let packet = Packet::sealed(&body[..body.len() - CRC_LEN]);
            let wire = packet.as_ref().map_or(BAD, Packet::as_bytes);
            return wire.iter().copied().filter(|byte| *byte != 0).collect();
        }
        text
    }
}

/// The body that a text stands for, and whether a lone 01 follows a full block at its end; `None`
/// where the text ends inside a block.
fn decoded(text: &[u8]) -> Option<(Vec<u8>, bool)> {
    let (mut body, mut rest) = (Vec::new(), text);
    let mut last = 0;
    while let Some((&code, after)) = rest.split_first() {
        let (block, next) = after.split_at_checked(usize::from(code) - 1)?;
        if !next.is_empty() && next == BAD && code == u8::MAX {
            body.extend(block);
            return Some((body, true));
        }
        body.extend(block);
        if code != u8::MAX && !next.is_empty() {
            body.push(0);
        }
        (rest, last) = (next, code);
    }
    (last != 0).then_some((body, false))
}

fn has_good_crc(body: &[u8]) -> bool {
    let Some((covered, crc)) = body.split_last_chunk::<CRC_LEN>() else {
        return false;
    };
    covered.len() >= HEADER_LEN && crc32fast::hash(covered).to_le_bytes() == *crc
}
