//! The lease: who renews it, and what happens without a sign of the host.

use super::check::checks;
use crate::certify::client::Client;
use crate::certify::predict::Between;
use crate::certify::say::{Say, Want};
use crate::certify::speech::Speech;
use crate::certify::verdict::{Trouble, Verdict, ensure};
use crate::message::{Config, Status, TICK_US, fault_bit, kind};

checks! { "lease":
    Full "READY" ready, "no valid packet for lease_ms: STATUS stops, IDLE";
    Full "ARMED" armed, "ARMED ends the same way";
    Full "the usual lease" usual, "lease_ms 0 is 1000 ms";
    Full "renewed" renewed, "PING, refused and unknown packets renew it";
    Full "not renewed" not_renewed, "what counts as bad does not renew it";
    Full "while running" running, "output ramps from the present gain, then IDLE";
}

fn ready(c: &mut Client<'_>) -> Verdict {
    let heard = c.tell_with(|c| [c.hello_with([1, 1], 1, 130, 1)])?;
    expires(c, heard, 130)
}

fn armed(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let heard = c.tell_with(|c| [c.hello_with([1, 1], 1, 110, 1), c.config(&config), c.arm()])?;
    expires(c, heard, 110)
}

fn usual(c: &mut Client<'_>) -> Verdict {
    let heard = c.tell_with(|c| [c.hello_with([1, 1], 1, 0, 1)])?;
    expires(c, heard, 1000)
}

/// Says nothing more; STATUS goes on until the lease is over and not beyond.
fn expires(c: &mut Client<'_>, heard: Between, lease_ms: u64) -> Verdict {
    let mark = c.mark();
    // The last PING of what was said renewed it last.
    let ends_us = heard.to_us + lease_ms * 1000;
    c.pass(lease_ms * 1000 + 90_000)?;
    c.watch.pause();
    let codes = c.faint(1);
    let config = c.usual();
    let says = [
        c.config(&config).wants(Want::Ack(2)),
        c.arm().wants(Want::Ack(2)),
        c.frame_next(&codes).wants(Want::Ack(2)),
    ];
    let asked = c.tell(&says)?;
    if asked.from_us <= ends_us + 2000 {
        return Err(Trouble::Late);
    }
    let tick_us = u64::from(TICK_US);
    let last = c
        .statuses_since(mark)
        .last()
        .map_or(heard.to_us / tick_us, |s| u64::from(s.tick));
    // The ms in which it ends may still be of the session.
    let (least, most) = ((ends_us / tick_us), (ends_us + 1000) / tick_us);
    let over_ms = (last * tick_us).abs_diff(ends_us) / 1000;
    let which = if last < least { "before" } else { "after" };
    ensure!(
        (least..=most).contains(&last),
        "STATUS stopped {over_ms} ms {which} the end of the lease"
    )
}

/// A packet that is valid, whatever comes of it.
type Sign = fn(&mut Client<'_>, &Config, &[[u16; 2]]) -> Say;

fn renewed(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let codes = c.faint(0);
    let signs: [Sign; 6] = [
        |c, _, _| c.ping(),
        |c, _, _| c.arm().wants(Want::Ack(2)),
        |c, _, codes| c.frame_next(codes).wants(Want::Ack(2)),
        |c, _, _| c.say(0x22, &[]).wants(Want::Ack(4)),
        |c, _, _| c.stop(0),
        |c, config, _| c.config(config),
    ];
    for sign in signs {
        // What is said alone has no PONG that tells when it was heard, so it is tried again.
        let mut verdict = Err(Trouble::Late);
        for _ in 0..3 {
            c.tell_with(|c| [c.hello_with([1, 1], 1, 120, 1)])?;
            let say = sign(c, &config, &codes);
            verdict = renews(c, say);
            if verdict.is_ok() {
                break;
            }
        }
        verdict?;
    }
    let mut verdict = Err(Trouble::Late);
    for _ in 0..3 {
        // How far the counters rose in vain is not known.
        c.begin_check()?;
        verdict = duplicate_renews(c, &codes);
        if verdict.is_ok() {
            break;
        }
    }
    verdict
}

/// The same for a FRAME with the seq of the last.
fn duplicate_renews(c: &mut Client<'_>, codes: &[[u16; 2]]) -> Verdict {
    // At 80 ms the FRAME is still held.
    let config = c.silent_after(100, 0);
    let frame = c.frame_next(codes);
    let seq = frame.seq;
    let says = [
        c.hello_with([1, 1], 1, 120, 1),
        c.config(&config),
        c.arm(),
        frame,
    ];
    c.tell(&says)?;
    c.tally.due.dup += 1;
    renews(c, super::frames::with_seq(codes, seq))
}

/// Whether a session of 120 ms outlasts 160 ms with this in the middle.
fn renews(c: &mut Client<'_>, sign: Say) -> Verdict {
    let before = c.mark();
    c.pass(80_000)?;
    c.write(&sign)?;
    c.pass(80_000)?;
    // Where the session ended nevertheless, STATUS did too.
    c.watch.pause();
    let kind = sign.kind;
    c.tell_after(&[sign], &[])?;
    let n_ticks = c.statuses_since(before).len();
    // Six ticks begin in any 160 ms, five in 120 ms at most.
    ensure!(
        n_ticks >= 6,
        "the session ended although type {kind:02X} came"
    )
}

fn not_renewed(c: &mut Client<'_>) -> Verdict {
    let heard = c.tell_with(|c| [c.hello_with([1, 1], 1, 130, 1)])?;
    c.pass(70_000)?;
    let wrong = Speech::hello_payload(0, [1, 1], 1, 0);
    for say in [
        c.say(kind::PING, &[1]).wants(Want::Bad),
        c.say(kind::STATUS, &[0; 36]).wants(Want::Bad),
        c.say(kind::HELLO, &wrong).wants(Want::Bad),
        Speech::noise(&[0, 7, 7, 0]),
    ] {
        c.write(&say)?;
    }
    expires(c, heard, 130)
}

/// The lease is shorter than the hold, so that it ends first.
fn running(c: &mut Client<'_>) -> Verdict {
    let (lease_ms, ramp_ms) = (40, 20);
    let config = c.silent_after(80, ramp_ms);
    let says = [
        c.hello_with([1, 1], 1, lease_ms, 1),
        c.config(&config),
        c.arm(),
    ];
    c.tell(&says)?;
    let tick = c.aim(5000)?;
    let codes = c.faint(2);
    let frame = [c.frame_next(&codes)];
    let heard = c.tell_at(tick, 5000, &frame)?;
    let sum = crate::certify::predict::Allowed::of(&codes, &config).sum();
    let mark = c.mark();
    c.pass(150_000)?;
    c.watch.pause();
    let says = [
        c.frame_next(&codes).wants(Want::Ack(2)),
        c.arm().wants(Want::Ack(2)),
    ];
    c.tell(&says)?;
    // Its last PING renewed the lease.
    let last = Between {
        from_us: heard.to_us,
        to_us: heard.to_us,
    };
    let statuses = c.statuses_since(mark);
    // The last tick that begins in the ramp.
    let end_us = last.from_us + u64::from(lease_ms + ramp_ms - 1) * 1000;
    let is_heard = |status: &Status| u64::from(status.tick) == end_us / u64::from(TICK_US);
    ensure!(
        statuses.iter().any(is_heard),
        "STATUS stopped before the ramp was over"
    )?;
    for status in &statuses {
        let at_us = u64::from(status.tick) * u64::from(TICK_US);
        let n_steps = last.steps_until(lease_ms, at_us)[0];
        let n_steps = [n_steps.saturating_sub(1), n_steps + 1];
        let [least, most] = crate::certify::predict::ramped(sum, ramp_ms, n_steps);
        ensure!(
            (least..=most).contains(&status.amp_sum),
            "{} in place of {least}…{most}",
            super::steps::shown(status)
        )?;
        let is_told = status.faults & fault_bit::LEASE_LOST == 0 || n_steps[1] > 0;
        ensure!(is_told, "bit 5 before the lease was over")?;
        let is_over = n_steps[0] > u64::from(ramp_ms);
        ensure!(!is_over, "STATUS after the ramp of a lost lease")?;
    }
    Ok(())
}
