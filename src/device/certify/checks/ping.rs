//! The device's clock: PONG at every phase of a tick, STATUS at every tick.

use super::check::checks;
use super::steps::{Place, go};
use crate::certify::client::Client;
use crate::certify::verdict::{Trouble, Verdict, ensure};

checks! { "clock":
    Quick "pacing" pacing, "a STATUS at every tick, 25 ms of dev_us apart";
    Quick "PONG at every phase" phases, "PONG echoes the token; dev_us = 25000 · tick + phase_us";
    Full "PONG in every state" states, "a PING is answered in every state and changes nothing";
}

const N_TICKS: usize = 40;

fn pacing(c: &mut Client<'_>) -> Verdict {
    let mut statuses = Vec::new();
    for _ in 0..N_TICKS / 8 {
        statuses.extend(c.statuses(8)?);
        // A sign of life, so that the lease goes on.
        c.tell(&[])?;
    }
    for pair in statuses.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let (n_ticks, us) = (b.tick.wrapping_sub(a.tick), b.dev_us.wrapping_sub(a.dev_us));
        ensure!(
            n_ticks == 1 && us.abs_diff(25_000) < 1000,
            "{us} µs from tick {} to tick {}",
            a.tick,
            b.tick
        )?;
    }
    Ok(())
}

/// What a PONG says is judged as it comes; here it comes at every phase.
fn phases(c: &mut Client<'_>) -> Verdict {
    let mut windows = [false; 13];
    for place in 0..50_u64 {
        c.aim(place % 25 * 1000)?;
        let heard = c.tell(&[])?;
        for us in [heard.from_us, heard.to_us] {
            let window = usize::try_from(us % 25_000 / 2000).unwrap_or(0);
            windows[window] = true;
        }
        if place >= 24 && windows.iter().all(|is_seen| *is_seen) {
            return Ok(());
        }
    }
    Err(Trouble::Late)
}

fn states(c: &mut Client<'_>) -> Verdict {
    for place in [
        Place::Ready,
        Place::Armed,
        Place::Run,
        Place::Hold,
        Place::Ramp,
    ] {
        let there = go(c, place)?;
        c.tell_at(there.tick, there.phase_us, &[])?;
        let status = c.status()?;
        // Without a second FRAME the tick after RUN is HOLD.
        let state = match place {
            Place::Run => Place::Hold.state(),
            place => place.state(),
        };
        ensure!(
            status.state == state.code(),
            "PING in {} led to {}",
            place.state(),
            super::steps::shown(&status)
        )?;
    }
    c.tell_with(|c| [c.hello_with([2, 2], 1, 0, 0)])?;
    c.tell(&[]).map(drop)
}
