//! HELLO, its nonce and its versions, and what arms.

use super::check::checks;
use super::steps::{Place, expect, go};
use crate::certify::client::Client;
use crate::certify::say::Want;
use crate::certify::speech::Speech;
use crate::certify::verdict::{Verdict, ensure};
use crate::message::{DeviceState, NEXT_TICK, kind};

checks! { "sessions":
    Quick "arming" arming, "HELLO, CONFIG, ARM: ARMED; a repeated ARM gets ACK 0";
    Full "wrong HELLO" wrong_hello, "wrong magic, session 0 or too short: bad, the session is kept";
    Full "wrong ARM" wrong_arm, "another session or key gets ACK 1 and arms nothing";
    Full "ARM without CONFIG" unconfigured, "ACK 2, also when an earlier session had a CONFIG";
    Full "HELLO in every state" hello_anywhere, "zero at once, queue empty, READY, disarmed";
    Full "no common version" versions, "CAPS with version 0, IDLE, no STATUS; 1 where 1 is offered";
    Full "version 0 while running" version_running, "the session ends at once";
    Full "STATUS unless wanted" unwanted, "without host_flags b0 no STATUS comes";
    Full "counters survive HELLO" counters, "tick and counters run on over a new session";
}

fn arming(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let mut says = c.arming(&config);
    says.push(c.arm());
    c.tell(&says)?;
    expect(&c.status()?, DeviceState::Armed, 0)
}

fn wrong_hello(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    c.tell_with(|c| c.arming(&config))?;
    let right = Speech::hello_payload(c.session.wrapping_add(2), [1, 1], 1, 0);
    let mut other_magic = right.clone();
    other_magic[3] = b'2';
    let no_session = Speech::hello_payload(0, [1, 1], 1, 0);
    c.tell_with(|c| {
        [&other_magic[..], &no_session, &right[..15], &[]]
            .map(|payload| c.say(kind::HELLO, payload).wants(Want::Bad))
    })?;
    expect(&c.status()?, DeviceState::Armed, 0)?;
    c.tell_with(|c| [c.arm()]).map(drop)
}

fn wrong_arm(c: &mut Client<'_>) -> Verdict {
    let old = c.session;
    let config = c.usual();
    let mut says = vec![c.hello(), c.config(&config)];
    let session = c.session;
    let right = Speech::arm_payload(session);
    let mut other_key = right.clone();
    other_key[4] ^= 1;
    let mut other_session = right.clone();
    other_session[0] ^= 2;
    let same_twice = [session.to_le_bytes(), session.to_le_bytes()].concat();
    let stale = Speech::arm_payload(old);
    for payload in [stale, other_key, other_session, same_twice, vec![0; 8]] {
        says.push(c.say(kind::ARM, &payload).wants(Want::Ack(1)));
    }
    c.tell(&says)?;
    expect(&c.status()?, DeviceState::Ready, 0)?;
    c.tell_with(|c| [c.arm()]).map(drop)
}

fn unconfigured(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let mut says = vec![c.hello(), c.arm().wants(Want::Ack(2))];
    says.push(c.config(&config));
    says.push(c.hello());
    says.push(c.arm().wants(Want::Ack(2)));
    c.tell(&says)?;
    expect(&c.status()?, DeviceState::Ready, 0)
}

fn hello_anywhere(c: &mut Client<'_>) -> Verdict {
    let codes = c.faint(2);
    for place in Place::LIVE {
        let there = go(c, place)?;
        let mut says = Vec::new();
        if place != Place::Armed {
            // Something that waits, and must not be played in the next session.
            let ahead = there.tick + u32::from(c.caps.queue.min(3));
            says.push(c.frame(ahead, &codes));
        }
        says.push(c.hello());
        says.push(c.frame_next(&codes).wants(Want::Ack(2)));
        says.push(c.arm().wants(Want::Ack(2)));
        c.tell_at(there.tick, there.phase_us, &says)?;
        for status in c.statuses(2)? {
            expect(&status, DeviceState::Ready, 0)?;
            ensure!(
                status.last_seq == 0,
                "last_seq {} after HELLO",
                status.last_seq
            )?;
        }
    }
    Ok(())
}

fn versions(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    for offered in [[0, 0], [2, 2], [2, 255]] {
        let mut says = vec![c.hello_with(offered, 1, 0, 0)];
        says.push(c.config(&config).wants(Want::Ack(2)));
        says.push(c.arm().wants(Want::Ack(2)));
        c.tell(&says)?;
    }
    silent_for(c, 4)?;
    for offered in [[0, 1], [1, 9], [0, 255], [1, 1]] {
        c.tell_with(|c| [c.hello_with(offered, 1, 0, 1)])?;
        expect(&c.status()?, DeviceState::Ready, 0)?;
    }
    Ok(())
}

/// No STATUS comes for so many ticks of the device.
pub(super) fn silent_for(c: &mut Client<'_>, n_ticks: u64) -> Verdict {
    let mark = c.mark();
    let from = c.tell(&[])?.to_us;
    loop {
        c.pass(25_000)?;
        let now = c.tell(&[])?;
        let n_heard = c.statuses_since(mark).len();
        ensure!(n_heard == 0, "STATUS came")?;
        if now.from_us > from + n_ticks * 25_000 {
            return Ok(());
        }
    }
}

fn version_running(c: &mut Client<'_>) -> Verdict {
    let there = go(c, Place::Run)?;
    let codes = c.faint(0);
    let says = [
        c.hello_with([2, 2], 1, 0, 0),
        c.frame_next(&codes).wants(Want::Ack(2)),
    ];
    c.tell_at(there.tick, there.phase_us, &says)?;
    silent_for(c, 3)?;
    c.tell_with(|c| [c.hello()])?;
    expect(&c.status()?, DeviceState::Ready, 0)
}

fn unwanted(c: &mut Client<'_>) -> Verdict {
    c.tell_with(|c| [c.hello_with([1, 1], 0, 0, 1)])?;
    silent_for(c, 4)
}

fn counters(c: &mut Client<'_>) -> Verdict {
    let (config, codes) = (c.usual(), c.faint(3));
    c.tell_with(|c| c.arming(&config))?;
    let (_, _) = c.tell_in_tick(|c, tick| {
        let frame = c.frame(tick, &codes);
        vec![
            frame.clone(),
            frame,
            c.say(kind::PING, &[1]).wants(Want::Bad),
        ]
    })?;
    c.tally.due.late += 1;
    c.tally.due.dup += 1;
    let before = c.status()?;
    c.tell_with(|c| [c.hello()])?;
    let after = c.status()?;
    c.tally.compare(&after)?;
    let n_missed = after.underrun.wrapping_sub(before.underrun);
    ensure!(n_missed <= 1, "underrun rose by {n_missed} over HELLO")?;
    ensure!(
        after.tick.wrapping_sub(before.tick) < 40,
        "tick {} before HELLO, {} after",
        before.tick,
        after.tick
    )?;
    // HELLO forgets which FRAME was the last.
    let mut says = vec![c.config(&config), c.arm()];
    let mut frame = c.frame(NEXT_TICK, &codes);
    frame.seq = before.last_seq;
    let payload = [&NEXT_TICK.to_le_bytes()[..], &frame_codes(&codes)].concat();
    frame.bytes = crate::certify::say::packet(kind::FRAME, 0, before.last_seq, &payload);
    says.push(frame);
    c.tell(&says)?;
    let status = c.status()?;
    ensure!(
        status.last_seq == before.last_seq,
        "a FRAME with the last seq of another session was not accepted"
    )
}

/// The codes of a FRAME as bytes.
pub(super) fn frame_codes(codes: &[[u16; 2]]) -> Vec<u8> {
    codes
        .iter()
        .flatten()
        .flat_map(|code| code.to_le_bytes())
        .collect()
}
