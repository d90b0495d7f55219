//! STOP in every state, and what it leaves.

use super::check::checks;
use super::steps::{Place, There, expect, go, judge_ramp, status_of};
use crate::certify::client::Client;
use crate::certify::say::Want;
use crate::certify::verdict::{Verdict, ensure};
use crate::message::{DeviceState, TICK_US};

checks! { "STOP":
    Quick "how 0 in RUN" ramp_in_run, "ACK 0, a ramp over ramp_ms, FRAMEs get ACK 2, then READY";
    Full "how 0 in every state" ramps, "a ramp from the present gain; READY stays, ARMED ends";
    Quick "how 1 in RUN" now_in_run, "ACK 0, zero at once, READY";
    Full "how 1, 2, 255 in every state" nows, "zero at once, READY";
    Full "a second STOP" second, "how 0 in a ramp changes nothing, how 1 ends it";
    Full "the queue" queue, "what waited is forgotten, and not played after the next ARM";
    Quick "high voltage" voltage, "on from ARM, off after STOP within a second";
}

fn ramp_in_run(c: &mut Client<'_>) -> Verdict {
    ramp_in(c, Place::Run, 0)
}

fn ramps(c: &mut Client<'_>) -> Verdict {
    for place in [Place::Ready, Place::Armed, Place::Hold, Place::Ramp] {
        ramp_in(c, place, 7)?;
    }
    Ok(())
}

/// STOP, how 0, with a reason that means nothing to the device.
fn ramp_in(c: &mut Client<'_>, place: Place, reason: u8) -> Verdict {
    let there = go(c, place)?;
    let codes = c.faint(2);
    let mut says = vec![
        c.say(crate::message::kind::STOP, &[reason, 0])
            .wants(Want::Ack(0)),
        c.frame_next(&codes).wants(Want::Ack(2)),
    ];
    if there.played.is_some() {
        says.push(c.arm().wants(Want::Ack(2)));
    }
    let stopped = c.tell_at(there.tick, there.phase_us, &says)?;
    let Some(played) = &there.played else {
        return expect(&c.status()?, DeviceState::Ready, 0);
    };
    // A silence that had begun goes on as it was; otherwise the ramp begins now.
    let from = match place {
        Place::Ramp => (played.heard, played.config.hold_ms),
        _ => (stopped, 0),
    };
    let ramp_ms = played.config.ramp_ms;
    for n_later in 1..=u32::from(ramp_ms) / 25 + 2 {
        let tick = there.tick + n_later;
        let status = status_of(c, tick)?;
        let n_steps = from
            .0
            .steps_until(from.1, u64::from(tick) * u64::from(TICK_US));
        judge_ramp(&status, played.sum, DeviceState::Ramp, ramp_ms, n_steps)?;
        ensure!(
            status.queued == 0,
            "{} FRAMEs wait after STOP",
            status.queued
        )?;
    }
    expect(&c.status()?, DeviceState::Ready, 0)
}

fn now_in_run(c: &mut Client<'_>) -> Verdict {
    now_in(c, Place::Run, 1)
}

fn nows(c: &mut Client<'_>) -> Verdict {
    for place in [Place::Ready, Place::Armed, Place::Hold, Place::Ramp] {
        now_in(c, place, 1)?;
    }
    now_in(c, Place::Run, 2)?;
    now_in(c, Place::Run, 255)
}

fn now_in(c: &mut Client<'_>, place: Place, how: u8) -> Verdict {
    let There { tick, phase_us, .. } = go(c, place)?;
    let codes = c.faint(2);
    let says = [c.stop(how), c.frame_next(&codes).wants(Want::Ack(2))];
    c.tell_at(tick, phase_us, &says)?;
    for status in c.statuses(2)? {
        expect(&status, DeviceState::Ready, 0)?;
    }
    Ok(())
}

fn second(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    for how in [0, 1] {
        let codes = c.faint(6);
        let played = super::steps::play(c, &config, &codes)?;
        let first = c.stop(0);
        let stopped = c.tell_at(played.tick + 1, 3000, &[first])?;
        let again = c.stop(how);
        c.tell_at(played.tick + 2, 6000, &[again])?;
        for n_later in 3..=6 {
            let tick = played.tick + n_later;
            let status = status_of(c, tick)?;
            if how == 1 {
                expect(&status, DeviceState::Ready, 0)?;
                continue;
            }
            let at_us = u64::from(tick) * u64::from(TICK_US);
            let n_steps = stopped.steps_until(0, at_us);
            judge_ramp(
                &status,
                played.sum,
                DeviceState::Ramp,
                config.ramp_ms,
                n_steps,
            )?;
        }
    }
    Ok(())
}

fn queue(c: &mut Client<'_>) -> Verdict {
    let (config, codes) = (c.usual(), c.faint(3));
    let depth = u32::from(c.caps.queue.min(4));
    c.tell_with(|c| c.arming(&config))?;
    c.tell_in_tick(|c, tick| {
        let mut says: Vec<_> = (1..=depth)
            .map(|ahead| c.frame(tick + ahead, &codes))
            .collect();
        says.extend([c.stop(1), c.arm()]);
        says
    })?;
    for status in c.statuses(5)? {
        expect(&status, DeviceState::Armed, 0)?;
        ensure!(
            status.queued == 0,
            "{} FRAMEs wait after STOP",
            status.queued
        )?;
    }
    Ok(())
}

fn voltage(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    c.tell_with(|c| c.arming(&config))?;
    let wanted = u32::from(config.hv_dv);
    let least = (wanted - wanted / 10).saturating_sub(20);
    reached(c, "on", |hv_dv| hv_dv >= least)?;
    c.tell_with(|c| [c.stop(1)])?;
    reached(c, "off", |hv_dv| hv_dv <= 20)
}

/// Waits up to a second of the device for its measured voltage.
fn reached(c: &mut Client<'_>, what: &str, is_there: impl Fn(u32) -> bool) -> Verdict {
    let mut last = 0;
    for _ in 0..40 {
        last = c.status()?.hv_dv;
        if is_there(last.into()) {
            return Ok(());
        }
        c.tell_with(|c| [c.ping()])?;
    }
    ensure!(false, "hv_dV is {last} a second after it went {what}")
}
