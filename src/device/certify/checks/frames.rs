//! FRAMEs: which is played when, and what is counted.

use super::check::checks;
use super::session::frame_codes;
use super::steps::{expect, status_of};
use crate::certify::client::Client;
use crate::certify::predict::{Allowed, Between};
use crate::certify::say::{Say, Want, packet};
use crate::certify::verdict::{Trouble, Verdict, ensure};
use crate::message::{DeviceState, NEXT_TICK, Status, kind};

checks! { "frames":
    Quick "a second of faint frames" stream, "each is played in the next tick: amp_sum as sent";
    Full "the queue" queue, "1…queue ticks ahead are stored and played in order; more: ACK 3";
    Full "last writer wins" last_writer, "of two FRAMEs for a tick the later is played, once";
    Full "late" late, "a FRAME for a tick that began is counted and played in the next";
    Full "far away" far, "ticks are compared as signed differences: behind is late, ahead ACK 3";
    Full "duplicates" duplicates, "the last seq again: dup, not played, the age runs on";
    Full "refused" refused, "a refused FRAME changes neither last_seq nor age nor output";
    Full "a missing FRAME" missing, "HOLD with the same output, underrun + 1, RUN with the next";
    Full "start at depth" depth, "ticks between the first FRAME and its tick are underruns";
    Full "one ARM, one start" start, "after ARM output begins at zero, whatever was before";
}

fn armed(c: &mut Client<'_>) -> Verdict {
    // A long hold, so that two ticks without a FRAME are no ramp.
    let config = c.silent_after(90, 10);
    c.tell_with(|c| c.arming(&config)).map(drop)
}

fn sum(c: &Client<'_>, codes: &[[u16; 2]]) -> u32 {
    Allowed::of(codes, &c.usual()).sum()
}

fn stream(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    c.aim(4000)?;
    let mut n_right = 0;
    for nth in 0..120 {
        match stream_one(c, nth) {
            Ok(()) => n_right += 1,
            // Host or link were late: the device may have fallen silent.
            Err(Trouble::Late) => armed(c)?,
            Err(Trouble::Wrong(_)) if std::mem::take(&mut c.times.is_late) => armed(c)?,
            wrong => return wrong,
        }
        if n_right == 40 {
            return c.tell_with(|c| [c.stop(0)]).map(drop);
        }
    }
    Err(Trouble::Late)
}

fn stream_one(c: &mut Client<'_>, nth: u16) -> Verdict {
    let codes = c.faint(nth);
    let frame = c.frame_next(&codes);
    let seq = frame.seq;
    let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
    let status = status_of(c, tick + 1)?;
    let expected = sum(c, &codes);
    expect(&status, DeviceState::Run, expected)?;
    ensure!(
        status.last_seq == seq,
        "last_seq {} instead of {seq}",
        status.last_seq
    )?;
    ensure!(status.age_ms <= 25, "age_ms {}", status.age_ms)
}

fn queue(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let depth = u32::from(c.caps.queue);
    let (tick, _) = c.tell_in_tick(|c, tick| {
        let mut says: Vec<Say> = (1..=depth)
            .rev()
            .take(40)
            .map(|ahead| {
                let codes = c.faint(small(ahead));
                c.frame(tick + ahead, &codes)
            })
            .collect();
        let codes = c.faint(99);
        says.push(c.frame(tick + depth + 1, &codes).wants(Want::Ack(3)));
        says.push(c.frame(tick + depth + 7, &codes).wants(Want::Ack(3)));
        says
    })?;
    // Without a FRAME for 60 ms the ramp begins: more than two ticks are not compared.
    for ahead in 1..=depth.min(2) {
        let status = status_of(c, tick + ahead)?;
        let codes = c.faint(small(ahead));
        let expected = sum(c, &codes);
        expect(&status, DeviceState::Run, expected)?;
        ensure!(
            depth > 40 || u32::from(status.queued) == depth - ahead,
            "queued {} instead of {}",
            status.queued,
            depth - ahead
        )?;
    }
    for ahead in 3..=depth.min(8) {
        // The age is kept young by FRAMEs that are repeated.
        let status = status_of(c, tick + ahead)?;
        ensure!(
            u32::from(status.queued) <= depth - ahead,
            "queued {} at tick + {ahead}",
            status.queued
        )?;
    }
    Ok(())
}

/// Two FRAMEs, then one tick after the other with FRAMEs that renew the age.
fn last_writer(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let [first, second, third] = [1, 2, 3].map(|kind| c.faint(kind));
    let depth = u32::from(c.caps.queue.min(2));
    let (tick, _) = c.tell_in_tick(|c, tick| {
        vec![
            c.frame(tick + depth, &first),
            c.frame(tick + depth, &second),
            c.frame_next(&first),
            c.frame_next(&third),
        ]
    })?;
    let status = status_of(c, tick + 1)?;
    let expected = sum(c, &third);
    expect(&status, DeviceState::Run, expected)?;
    if depth == 2 {
        ensure!(status.queued == 1, "queued {} instead of 1", status.queued)?;
        let expected = sum(c, &second);
        expect(&status_of(c, tick + 2)?, DeviceState::Run, expected)?;
    }
    let status = status_of(c, tick + depth + 1)?;
    ensure!(
        status.state == DeviceState::Hold.code(),
        "a FRAME is played twice: {}",
        super::steps::shown(&status)
    )
}

fn late(c: &mut Client<'_>) -> Verdict {
    for behind in [0, 1, 40] {
        armed(c)?;
        let codes = c.faint(7);
        let mut seq = 0;
        let (tick, _) = c.tell_in_tick(|c, tick| {
            let frame = c.frame(tick.wrapping_sub(behind), &codes);
            seq = frame.seq;
            vec![frame]
        })?;
        c.tally.due.late += 1;
        let status = status_of(c, tick + 1)?;
        let expected = sum(c, &codes);
        expect(&status, DeviceState::Run, expected)?;
        ensure!(status.last_seq == seq, "a late FRAME is not in last_seq")?;
        c.tally.compare(&status)?;
    }
    Ok(())
}

fn far(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let codes = c.faint(8);
    let (tick, _) = c.tell_in_tick(|c, tick| {
        vec![
            c.frame(tick.wrapping_add(0x7fff_fffe), &codes)
                .wants(Want::Ack(3)),
            c.frame(tick.wrapping_add(1000), &codes).wants(Want::Ack(3)),
            c.frame(tick.wrapping_sub(0x7fff_fffe), &codes),
        ]
    })?;
    c.tally.due.late += 1;
    let expected = sum(c, &codes);
    expect(&status_of(c, tick + 1)?, DeviceState::Run, expected)
}

/// A FRAME for the next tick with a seq of our choice.
pub(super) fn with_seq(codes: &[[u16; 2]], seq: u16) -> Say {
    let payload = [&NEXT_TICK.to_le_bytes()[..], &frame_codes(codes)].concat();
    Say {
        kind: kind::FRAME,
        seq,
        bytes: packet(kind::FRAME, 0, seq, &payload),
        want: Want::Nothing,
    }
}

fn duplicates(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let [first, second] = [1, 2].map(|kind| c.faint(kind));
    let mut seq = 0;
    let (tick, heard) = c.tell_in_tick(|c, _| {
        let frame = c.frame_next(&first);
        seq = frame.seq;
        vec![frame, with_seq(&second, seq)]
    })?;
    c.tally.due.dup += 1;
    let expected = sum(c, &first);
    expect(&status_of(c, tick + 1)?, DeviceState::Run, expected)?;
    let says = [with_seq(&second, seq), with_seq(&second, seq)];
    c.tell_at(tick + 1, 12_000, &says)?;
    c.tally.due.dup += 2;
    let status = status_of(c, tick + 2)?;
    c.tally.compare(&status)?;
    expect(&status, DeviceState::Hold, expected)?;
    age_is(&status, heard, "a duplicate")?;
    // Only a FRAME is a duplicate by its seq.
    let mut ping = c.ping();
    if let Want::Pong(token) = ping.want {
        ping.seq = seq;
        ping.bytes = packet(kind::PING, 0, seq, &token.to_le_bytes());
    }
    c.tell_at(tick + 2, 2000, &[ping])?;
    // The seq of one before the last is no duplicate.
    let between = c.frame_next(&second);
    c.tell_at(tick + 2, 10_000, &[between, with_seq(&first, seq)])?;
    expect(&status_of(c, tick + 3)?, DeviceState::Run, expected)
}

fn refused(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let [first, second] = [1, 2].map(|kind| c.faint(kind));
    let depth = u32::from(c.caps.queue);
    let frame = c.frame_next(&first);
    let seq = frame.seq;
    let (tick, heard) = c.tell_in_tick(|_, _| vec![frame])?;
    let expected = sum(c, &first);
    expect(&status_of(c, tick + 1)?, DeviceState::Run, expected)?;
    let longer = [&NEXT_TICK.to_le_bytes()[..], &frame_codes(&second), &[0; 4]].concat();
    let mut says = vec![c.frame(tick + 1 + depth + 3, &second).wants(Want::Ack(3))];
    if longer.len() + 8 <= usize::from(c.caps.max_body) {
        says.push(c.say(kind::FRAME, &longer).wants(Want::Ack(5)));
    }
    c.tell_at(tick + 1, 12_000, &says)?;
    let status = status_of(c, tick + 2)?;
    expect(&status, DeviceState::Hold, expected)?;
    ensure!(
        status.last_seq == seq,
        "last_seq {} is of a refused FRAME",
        status.last_seq
    )?;
    age_is(&status, heard, "a refused FRAME")
}

/// The age still runs from the FRAME before.
fn age_is(status: &Status, heard: Between, after: &str) -> Verdict {
    let ages_ms = heard.ages_ms(u64::from(status.tick) * 25_000);
    let age_ms = u64::from(status.age_ms);
    ensure!(
        (ages_ms[0]..=ages_ms[1]).contains(&age_ms),
        "age_ms {age_ms} after {after}, {} is right",
        ages_ms[0]
    )
}

fn missing(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let codes = c.faint(5);
    let expected = sum(c, &codes);
    let frame = c.frame_next(&codes);
    let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
    let run = status_of(c, tick + 1)?;
    expect(&run, DeviceState::Run, expected)?;
    let hold = status_of(c, tick + 2)?;
    expect(&hold, DeviceState::Hold, expected)?;
    let n_missed = hold.underrun.wrapping_sub(run.underrun);
    ensure!(n_missed == 1, "underrun rose by {n_missed}")?;
    let frame = c.frame_next(&codes);
    c.tell_at(tick + 2, 6000, &[frame])?;
    let again = status_of(c, tick + 3)?;
    expect(&again, DeviceState::Run, expected)?;
    let n_missed = again.underrun.wrapping_sub(hold.underrun);
    ensure!(n_missed == 0, "underrun rose by {n_missed} in RUN")
}

fn depth(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let before = c.status()?;
    let ahead = u32::from(c.caps.queue.min(3));
    let codes = c.faint(6);
    let (tick, _) = c.tell_in_tick(|c, tick| vec![c.frame(tick + ahead, &codes)])?;
    for n_later in 1..ahead {
        let status = status_of(c, tick + n_later)?;
        expect(&status, DeviceState::Hold, 0)?;
        let n_missed = u32::from(status.underrun.wrapping_sub(before.underrun));
        ensure!(
            n_missed == n_later,
            "underrun rose by {n_missed} in {n_later} ticks"
        )?;
    }
    Ok(())
}

fn start(c: &mut Client<'_>) -> Verdict {
    armed(c)?;
    let codes = c.faint(5);
    let frame = c.frame_next(&codes);
    let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
    let expected = sum(c, &codes);
    expect(&status_of(c, tick + 1)?, DeviceState::Run, expected)?;
    let says = [c.stop(1), c.arm()];
    c.tell_at(tick + 1, 6000, &says)?;
    // An old age must not begin a ramp.
    for status in c.statuses(6)? {
        expect(&status, DeviceState::Armed, 0)?;
    }
    Ok(())
}

fn small(number: u32) -> u16 {
    u16::try_from(number).unwrap_or(u16::MAX)
}
