//! Hold and ramp by the age of the last FRAME, at every phase of a tick.

use super::check::checks;
use super::steps::{follow_silence, play_at};
use crate::certify::client::Client;
use crate::certify::predict::Allowed;
use crate::certify::say::Want;
use crate::certify::verdict::{Trouble, Verdict, ensure};
use crate::message::DeviceState;

checks! { "hold and ramp":
    Quick "once" once, "hold 60 ms, ramp 40 ms: silent by age 100 ms, then READY";
    Full "at every phase" every_phase, "the same wherever in a tick the last FRAME came";
    Full "other times" other_times, "0 + 100, 25 + 75, 37 + 23, 40 + 0 and 100 + 0 ms alike";
    Full "disarmed after silence" disarmed, "FRAME gets ACK 2, ARM arms again";
    Full "FRAME in RAMP" revived, "RUN again; the gain rises by 1/ramp_ms a ms, without a jump";
}

fn once(c: &mut Client<'_>) -> Verdict {
    silence(c, 60, 40, 6000).map(drop)
}

/// A lone FRAME so far into a tick; gives where it was heard, ms.
fn silence(c: &mut Client<'_>, hold: u16, ramp: u16, phase_us: u64) -> Result<u64, Trouble> {
    let mut config = c.usual();
    (config.hold_ms, config.ramp_ms) = (hold, ramp);
    let codes = c.faint(u16::try_from(phase_us / 1000).unwrap_or(0));
    let played = match play_at(c, &config, &codes, phase_us) {
        // It fell on a tick's edge: nothing can be said of it.
        Err(Trouble::Late) => {
            c.tally.due.clipped += Allowed::of(&codes, &config).clipped;
            return Ok(25);
        }
        played => played?,
    };
    follow_silence(c, &played)?;
    Ok(played.heard.to_us % 25_000 / 1000)
}

fn every_phase(c: &mut Client<'_>) -> Verdict {
    let mut windows = [false; 13];
    for place in 0..45 {
        let wanted_ms = if place < 25 {
            place
        } else {
            let missing = windows.iter().zip(0..).find(|(is_seen, _)| !**is_seen);
            missing.map_or(0, |(_, window)| 2 * window)
        };
        let ms = silence(c, 60, 40, wanted_ms * 1000 + 250)?;
        let window = usize::try_from(ms / 2).unwrap_or(0);
        if let Some(is_seen) = windows.get_mut(window).filter(|_| ms < 25) {
            *is_seen = true;
        }
        if place >= 24 && windows.iter().all(|is_seen| *is_seen) {
            return Ok(());
        }
    }
    Err(Trouble::Late)
}

fn other_times(c: &mut Client<'_>) -> Verdict {
    for [hold, ramp] in [[0, 100], [25, 75], [37, 23], [40, 0], [100, 0]] {
        for phase_ms in [2, 13, 22] {
            silence(c, hold, ramp, phase_ms * 1000 + 250)?;
        }
    }
    Ok(())
}

fn disarmed(c: &mut Client<'_>) -> Verdict {
    silence(c, 25, 10, 6000)?;
    let codes = c.faint(1);
    c.tell_with(|c| [c.frame_next(&codes).wants(Want::Ack(2)), c.arm()])?;
    super::steps::expect(&c.status()?, DeviceState::Armed, 0)
}

fn revived(c: &mut Client<'_>) -> Verdict {
    let mut config = c.usual();
    (config.hold_ms, config.ramp_ms) = (40, 60);
    let codes = c.faint(4);
    let played = super::steps::play(c, &config, &codes)?;
    // Heard at 6 ms, so RAMP begins 46 ms later and is half over at 6 ms of the third tick.
    let again = c.frame_next(&codes);
    let back = c.tell_at(played.tick + 3, 6000, &[again])?;
    let full = u64::from(config.ramp_ms);
    let fallen = played.heard.steps_until(config.hold_ms, back.from_us)[0]
        ..=played.heard.steps_until(config.hold_ms, back.to_us)[1];
    let mark = c.mark();
    for n_later in 1..=4 {
        let frame = c.frame_next(&codes);
        c.tell_at(played.tick + 3 + n_later, 6000, &[frame])?;
    }
    for status in c.statuses_since(mark) {
        let tick = status.tick;
        let [least, most] = back.steps_until(0, u64::from(tick) * 25_000);
        let gain = |fallen: u64, risen: u64| (full - fallen.min(full) + risen).min(full);
        let sums = [gain(*fallen.end(), least), gain(*fallen.start(), most)]
            .map(|gain| u64::from(played.sum) * gain / full);
        let sum = u64::from(status.amp_sum);
        let is_run = status.state == DeviceState::Run.code();
        let shown = super::steps::shown(&status);
        let [least, most] = sums;
        let is_near = (least..=most).contains(&sum);
        ensure!(
            is_run && is_near,
            "{shown}, RUN with {least}…{most} is right"
        )?;
    }
    Ok(())
}
