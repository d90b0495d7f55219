//! Golden vectors and table lengths.

use super::*;
use crate::framing::Decoder;

fn hex(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

/// Feeds `wire` and gives kind, seq and payload of its only packet.
fn only_packet(wire: &[u8]) -> Option<(u8, u16, Vec<u8>)> {
    let mut decoder = Decoder::new(256);
    let mut found = None;
    for &byte in wire {
        if let Some(packet) = decoder.push(byte) {
            assert!(found.is_none());
            found = Some((packet.kind, packet.seq, packet.payload.to_vec()));
        }
    }
    assert_eq!(u64::from(found.is_none()), decoder.bad());
    found
}

fn golden() -> [(Vec<u8>, Packet); 3] {
    let hello = Hello {
        host_flags: 1,
        ..Hello::new(0x00c0_ffee)
    };
    [
        (
            hex("00 02 01 02 01 08 48 42 50 31 ee ff c0 04 01 01 01 01 01 01 01 05 36 df b5 25 00"),
            hello.packet(1).unwrap(),
        ),
        (
            hex("00 02 06 02 02 04 40 42 0f 05 b9 6a 17 81 00"),
            Ping { token: 1_000_000 }.packet(2).unwrap(),
        ),
        (
            hex("00 02 05 02 03 01 01 05 fe 9f ba f3 00"),
            Stop {
                reason: 0,
                how: StopHow::Ramp,
            }
            .packet(3)
            .unwrap(),
        ),
    ]
}

#[test]
fn golden_vectors_encode_bit_exact() {
    for (wire, ours) in golden() {
        assert_eq!(ours.as_bytes(), wire);
    }
}

#[test]
fn golden_vectors_decode() {
    let [(hello, _), (ping, _), (stop, _)] = golden();
    let (kind, seq, payload) = only_packet(&hello).unwrap();
    assert_eq!((kind, seq), (kind::HELLO, 1));
    let hello = Hello::decode(&payload).unwrap();
    assert_eq!(
        (hello.session, hello.ver_min, hello.ver_max),
        (0x00c0_ffee, 1, 1)
    );
    let (_, seq, payload) = only_packet(&ping).unwrap();
    assert_eq!(
        (seq, Ping::decode(&payload)),
        (2, Some(Ping { token: 1_000_000 }))
    );
    let (_, seq, payload) = only_packet(&stop).unwrap();
    assert_eq!(
        (seq, Stop::decode(&payload).unwrap().how),
        (3, StopHow::Ramp)
    );
}

#[test]
fn the_golden_frame_has_its_length_and_crc() {
    let codes: Vec<[u16; 2]> = (0..24).map(|c| [1000 * c, 500 * c]).collect();
    let packet = frame::packet(10, 100, &codes).unwrap();
    let wire = packet.as_bytes();
    assert_eq!(wire.len(), 111);
    // No zero among the last bytes, so the CRC stands in the clear before the delimiter.
    assert_eq!(wire[106..110], 0x76a1_f724_u32.to_le_bytes());
    let (kind, seq, payload) = only_packet(wire).unwrap();
    assert_eq!((kind, seq, payload.len()), (kind::FRAME, 10, 100));
    let mut read = vec![[0; 2]; 24];
    assert_eq!(frame::decode_into(&payload, &mut read), Some(100));
    assert_eq!(read, codes);
    assert_eq!(frame::decode_into(&payload, &mut read[..23]), None);
}

#[test]
fn every_cut_and_every_flipped_bit_of_the_vectors_is_rejected() {
    let codes: Vec<[u16; 2]> = (0..24).map(|c| [1000 * c, 500 * c]).collect();
    let mut wires = golden().map(|(wire, _)| wire).to_vec();
    wires.push(frame::packet(10, 100, &codes).unwrap().as_bytes().to_vec());
    for wire in wires {
        for length in 2..wire.len() - 1 {
            assert!(only_packet(&[&wire[..length], &[0]].concat()).is_none());
        }
        for bit in 8..8 * (wire.len() - 1) {
            let mut flipped = wire.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            let mut decoder = Decoder::new(256);
            for byte in flipped {
                assert!(decoder.push(byte).is_none(), "bit {bit}");
            }
            assert!(decoder.bad() > 0, "bit {bit}");
        }
    }
}

fn payload_of(packet: &Packet) -> Vec<u8> {
    only_packet(packet.as_bytes()).unwrap().2
}

/// A payload decodes at its table's length and longer, never shorter.
fn length_is<T>(payload: &[u8], length: usize, decode: impl Fn(&[u8]) -> Option<T>) {
    assert_eq!(payload.len(), length);
    assert!(decode(payload).is_some());
    assert!(
        decode(&[payload, &[1, 2, 3]].concat()).is_some(),
        "later versions may append"
    );
    for shorter in 0..length {
        assert!(
            decode(&payload[..shorter]).is_none(),
            "{shorter} of {length}"
        );
    }
}

#[test]
fn payload_lengths_of_requests_follow_the_table() {
    let caps = crate::device::DeviceModel::default().caps(7, 1);
    let config = Config {
        mode: 0,
        flags: 0,
        hold_ms: 60,
        ramp_ms: 40,
        slew: 0,
        hv_dv: 600,
        comp_limit: [1, 2],
        mask: ChannelMask::first(24),
    };
    length_is(
        &payload_of(&Hello::new(9).packet(0).unwrap()),
        16,
        Hello::decode,
    );
    length_is(
        &payload_of(&caps.packet(0).unwrap()),
        64 + caps.name().len(),
        Caps::decode,
    );
    length_is(&payload_of(&config.request(0, 24).unwrap()), 20, |p| {
        Config::decode(p, 24)
    });
    length_is(&payload_of(&config.reply(0, 33).unwrap()), 24, |p| {
        Config::decode(p, 33)
    });
}

#[test]
fn payload_lengths_of_short_requests_follow_the_table() {
    length_is(&payload_of(&Arm::new(9).packet(0).unwrap()), 8, Arm::decode);
    length_is(
        &payload_of(
            &Stop {
                reason: 0,
                how: StopHow::Now,
            }
            .packet(0)
            .unwrap(),
        ),
        2,
        Stop::decode,
    );
    length_is(
        &payload_of(&Ping { token: 1 }.packet(0).unwrap()),
        4,
        Ping::decode,
    );
    length_is(
        &payload_of(&Clear { bits: 1 }.packet(0).unwrap()),
        2,
        Clear::decode,
    );
    length_is(
        &payload_of(
            &Ident {
                channel: 1,
                ms: 2,
                amp: 3,
            }
            .packet(0)
            .unwrap(),
        ),
        6,
        Ident::decode,
    );
}

#[test]
fn payload_lengths_of_replies_follow_the_table() {
    let ack = Ack {
        kind: 3,
        code: AckCode::Other(77),
        seq: 9,
    };
    length_is(&payload_of(&ack.packet(0).unwrap()), 4, Ack::decode);
    length_is(
        &payload_of(&Status::default().packet(0).unwrap()),
        36,
        Status::decode,
    );
    let fault = Fault {
        faults: 1,
        channel: 0xffff,
        value: -5,
        tick: 3,
    };
    length_is(&payload_of(&fault.packet(0).unwrap()), 12, Fault::decode);
    let pong = Pong {
        token: 1,
        dev_us: 2,
        tick: 3,
        phase_us: 4,
    };
    length_is(&payload_of(&pong.packet(0).unwrap()), 14, Pong::decode);
}

#[test]
fn messages_come_back_as_they_were() {
    let caps = crate::device::DeviceModel::default().caps(7, 1);
    assert_eq!(
        Caps::decode(&payload_of(&caps.packet(0).unwrap())),
        Some(caps)
    );
    let status = Status {
        tick: 1,
        dev_us: 2,
        last_seq: 3,
        state: 4,
        queued: 5,
        underrun: 6,
        late: 7,
        dup: 8,
        bad: 9,
        clipped: 10,
        hv_dv: 11,
        i_ma: 12,
        temp_cdeg: -13,
        faults: 14,
        age_ms: 15,
        amp_sum: 16,
    };
    assert_eq!(
        Status::decode(&payload_of(&status.packet(0).unwrap())),
        Some(status)
    );
    let wire = status.packet(0).unwrap();
    assert!(wire.as_bytes().len() <= 47);
    let mask = ChannelMask::first(40);
    assert!(mask.contains(39) && !mask.contains(40) && !mask.contains(9999));
}

#[test]
fn device_messages_are_told_apart() {
    let packet = |kind, payload| crate::framing::Received {
        kind,
        seq: 0,
        payload,
    };
    let decode = |kind, payload| DeviceMessage::decode(&packet(kind, payload), 24);
    assert_eq!(decode(kind::ACK, &[3, 0, 1]), Err(Unreadable::Short));
    assert_eq!(decode(kind::PING, &[0; 4]), Err(Unreadable::UnknownKind));
    assert_eq!(decode(0xee, &[0; 4]), Err(Unreadable::UnknownKind));
    let Ok(DeviceMessage::Log(text)) = decode(kind::LOG, b"hot\nand \xff cold") else {
        panic!("a log text");
    };
    assert_eq!(text.to_line(), "hot\\nand \u{fffd} cold");
    assert_eq!(
        fault_bit::names(0b101),
        "over-temperature, high voltage out of range"
    );
    for code in 0..=255 {
        assert_eq!(AckCode::from_code(code).code(), code);
    }
}
