//! Texts between zeros: what is a packet, what is not, and that only itself is lost.

use super::check::checks;
use super::steps::expect;
use crate::certify::client::Client;
use crate::certify::say::{Say, Want, packet};
use crate::certify::speech::Speech;
use crate::certify::verdict::Verdict;
use crate::message::{DeviceState, NEXT_TICK, kind};

checks! { "framing":
    Quick "empties" empties, "empty texts are ignored and not counted";
    Full "texts that are no packet" garbage, "each counts bad once; the packet behind it is heard";
    Full "truncations" truncations, "a packet cut anywhere costs only itself";
    Full "bit flips" flips, "no flipped bit passes; the packet behind it is heard";
    Full "flipped ARM" flipped_arm, "no flipped bit arms";
    Full "oversize" oversize, "bodies up to max_body are heard, longer texts count bad once";
    Full "a full block" full_block, "254 bytes without a zero, with and without the last 01";
    Full "echoes" echoes, "types 80…FF count bad and are not answered";
    Full "unknown types" unknown, "ACK 4 with type and seq, in READY and ARMED, never a fault";
    Full "flags" flags, "bits of the header's flags are ignored";
    Full "pieces" pieces, "a packet may come byte by byte";
    Full "short payloads" short, "each counts bad, has no answer and changes nothing";
    Full "trailing bytes" trailing, "extra payload bytes are ignored, but not in FRAME: ACK 5";
}

/// Bytes that are said at once: a port need not have room for more.
const BURST: usize = 1500;

/// Says these in bursts.
fn tell_all(c: &mut Client<'_>, says: &[Say]) -> Verdict {
    let longest = says.iter().map(|say| say.bytes.len()).max().unwrap_or(1);
    says.chunks((BURST / longest).max(1))
        .try_for_each(|burst| c.tell(burst).map(drop))
}

fn empties(c: &mut Client<'_>) -> Verdict {
    c.tell(&[Speech::noise(&[0; 40])]).map(drop)
}

fn garbage(c: &mut Client<'_>) -> Verdict {
    let long: Vec<u8> = (0..200).map(|n| n % 255 + 1).collect();
    let texts: [&[u8]; 8] = [
        &[0, 1, 0],
        &[0, 1, 0, 1, 0, 1],
        b"AT+GCAP\r\n",
        &[0, 5, 1, 2, 0],
        &[0, 0xff, 7, 0],
        &[0, 2, 6, 1, 1, 1, 1, 0],
        &[7; 30],
        &long,
    ];
    let mut says = Vec::new();
    for text in texts {
        says.push(Speech::noise(text));
        says.push(c.ping());
    }
    c.tell(&says).map(drop)
}

/// A packet that is broken, so that nothing may answer it.
fn broken(bytes: &[u8]) -> Say {
    Speech::noise(bytes)
}

fn truncations(c: &mut Client<'_>) -> Verdict {
    let (codes, config) = (c.faint(0), c.usual());
    for say in [c.ping(), c.stop(1), c.config(&config), c.frame_next(&codes)] {
        let step = (say.bytes.len() / 20).max(1);
        let mut says = Vec::new();
        for length in (2..say.bytes.len() - 1).step_by(step) {
            says.push(broken(&say.bytes[..length]));
            says.push(c.ping());
        }
        tell_all(c, &says)?;
    }
    Ok(())
}

/// The packet with each of its bits between the zeros flipped, `step` apart, each before a PING.
fn flipped(c: &mut Client<'_>, say: &Say, step: usize) -> Vec<Say> {
    let mut says = Vec::new();
    for bit in (8..8 * (say.bytes.len() - 1)).step_by(step) {
        let mut bytes = say.bytes.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        says.push(broken(&bytes));
        if bit % 3 == 0 {
            says.push(c.ping());
        }
    }
    says
}

fn flips(c: &mut Client<'_>) -> Verdict {
    let (codes, config) = (c.faint(0), c.usual());
    for (say, step) in [
        (c.ping(), 1),
        (c.config(&config), 5),
        (c.frame_next(&codes), 11),
    ] {
        let says = flipped(c, &say, step);
        tell_all(c, &says)?;
    }
    Ok(())
}

fn flipped_arm(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    c.tell_with(|c| [c.hello(), c.config(&config)])?;
    let arm = c.arm();
    let says = flipped(c, &arm, 1);
    tell_all(c, &says)?;
    let status = c.status()?;
    expect(&status, DeviceState::Ready, 0)
}

fn oversize(c: &mut Client<'_>) -> Verdict {
    let largest = usize::from(c.caps.max_body);
    let mut fits = Vec::new();
    for length in [largest - 9, largest - 8] {
        fits.push(c.say(0x70, &vec![0x5a; length]).wants(Want::Ack(4)));
    }
    c.tell(&fits)?;
    let longer = c.say(0x70, &vec![0x5a; largest - 7]).wants(Want::NoPacket);
    let says = [
        longer,
        c.ping(),
        Speech::noise(&[7; 700]),
        Speech::noise(&[7; 900]),
        c.ping(),
    ];
    c.tell(&says).map(drop)
}

fn full_block(c: &mut Client<'_>) -> Verdict {
    // A zero in the flags, then 254 bytes without one.
    let payload = [0x55; 248];
    let says: Vec<Say> = (0..2000)
        .map(|_| c.say(0x44, &payload).wants(Want::Ack(4)))
        .filter(|say| say.bytes.len() == 1 + 2 + 255 + 1 && say.bytes[3] == u8::MAX)
        .take(1)
        .collect();
    let longer = says.iter().map(|say| {
        let mut longer = say.clone();
        longer.bytes = [&[0], say.text(), &[1, 0]].concat();
        longer
    });
    let says: Vec<Say> = says.iter().cloned().chain(longer).collect();
    c.tell(&says).map(drop)
}

fn echoes(c: &mut Client<'_>) -> Verdict {
    let caps = c.caps_payload.clone();
    let mut says = vec![c.say(kind::CAPS, &caps).wants(Want::Bad)];
    for kind in [
        0x80,
        kind::CFG,
        kind::ACK,
        kind::STATUS,
        kind::FAULT,
        kind::PONG,
        0x8f,
        0xff,
    ] {
        says.push(c.say(kind, &[0; 40]).wants(Want::Bad));
    }
    says.push(c.ping());
    c.tell(&says).map(drop)
}

fn unknown(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    for is_armed in [false, true] {
        let mut says = if is_armed {
            c.arming(&config)
        } else {
            Vec::new()
        };
        for kind in [0x00, 0x0a, 0x10, 0x33, 0x5a, 0x7f] {
            says.push(c.say(kind, &[]).wants(Want::Ack(4)));
            says.push(c.say(kind, &[1; 30]).wants(Want::Ack(4)));
        }
        c.tell(&says)?;
        let state = if is_armed {
            DeviceState::Armed
        } else {
            DeviceState::Ready
        };
        expect(&c.status()?, state, 0)?;
    }
    Ok(())
}

fn flags(c: &mut Client<'_>) -> Verdict {
    let mut says = Vec::new();
    for flags in [1, 0x80, 0xff] {
        let mut ping = c.ping();
        let Want::Pong(token) = ping.want else {
            continue;
        };
        ping.bytes = packet(kind::PING, flags, ping.seq, &token.to_le_bytes());
        says.push(ping);
        let mut stop = c.stop(0);
        stop.bytes = packet(kind::STOP, flags, stop.seq, &[0, 0]);
        says.push(stop);
    }
    c.tell(&says).map(drop)
}

fn pieces(c: &mut Client<'_>) -> Verdict {
    let ping = c.ping();
    let (last, head) = ping.bytes.split_last().unwrap_or((&0, &[]));
    for byte in head {
        c.write(&Speech::noise(&[*byte]))?;
        c.pass(700)?;
    }
    let mut end = ping.clone();
    end.bytes = vec![*last];
    // The PING before it would cut it in two.
    c.tell_raw(&end)
}

fn short(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    c.tell_with(|c| c.arming(&config))?;
    let hello = Speech::hello_payload(c.session.wrapping_add(2), [1, 1], 1, 0);
    let arm = Speech::arm_payload(c.session);
    let config = c.config_payload(&config);
    let frame = [&NEXT_TICK.to_le_bytes()[..], &vec![1; 4 * c.n_ch()]].concat();
    let kinds: [(u8, &[u8]); 8] = [
        (kind::HELLO, &hello),
        (kind::CONFIG, &config),
        (kind::ARM, &arm),
        (kind::FRAME, &frame),
        (kind::STOP, &[0, 1]),
        (kind::PING, &[1; 4]),
        (kind::CLEAR, &[0; 2]),
        (kind::IDENT, &[0, 0, 100, 0, 9, 0]),
    ];
    let can_ident = c.caps.modes & crate::message::Caps::MODE_IDENT != 0;
    for (kind, payload) in kinds {
        if kind == kind::IDENT && !can_ident {
            continue;
        }
        let says: Vec<Say> = [0, 1, payload.len() / 2, payload.len() - 1]
            .into_iter()
            .map(|length| c.say(kind, &payload[..length]).wants(Want::Bad))
            .collect();
        c.tell(&says)?;
    }
    expect(&c.status()?, DeviceState::Armed, 0)
}

fn trailing(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let longer = |c: &mut Client<'_>, say: Say, payload: &[u8]| {
        let payload = [payload, &[9, 9, 9]].concat();
        c.say(say.kind, &payload).wants(say.want)
    };
    let hello = c.hello();
    let hello_payload = Speech::hello_payload(c.session, [1, 1], 1, 0);
    let ask = c.config(&config);
    let (config_payload, arm_payload) = (c.config_payload(&config), Speech::arm_payload(c.session));
    let (arm, ping) = (c.arm(), c.ping());
    let Want::Pong(token) = ping.want else {
        return Ok(());
    };
    let says = [
        longer(c, hello, &hello_payload),
        longer(c, ask, &config_payload),
        longer(c, arm, &arm_payload),
        longer(c, ping, &token.to_le_bytes()),
    ];
    c.tell(&says)?;
    let frame = [&NEXT_TICK.to_le_bytes()[..], &vec![1; 4 * c.n_ch()]].concat();
    let mut says = Vec::new();
    for n_more in [1, 3, 4] {
        let payload = [&frame[..], &vec![1; n_more]].concat();
        if payload.len() + 8 <= usize::from(c.caps.max_body) {
            says.push(c.say(kind::FRAME, &payload).wants(Want::Ack(5)));
        }
    }
    c.tell(&says)?;
    expect(&c.status()?, DeviceState::Armed, 0)?;
    let stop = c.stop(0);
    let says = [longer(c, stop, &[0, 0])];
    c.tell(&says)?;
    expect(&c.status()?, DeviceState::Ready, 0)
}
