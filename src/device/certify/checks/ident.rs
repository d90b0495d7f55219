//! IDENT: one contactor at a time, for a while.

use super::check::checks;
use super::steps::{Place, go, status_of};
use crate::certify::client::Client;
use crate::certify::say::{Say, Want};
use crate::certify::verdict::{Trouble, Verdict, ensure};
use crate::message::{Caps, ChannelMask, Config, DeviceState, TICK_US, kind};

checks! { "IDENT":
    Full "what sounds" sounds, "amp_sum is amp for ms, at most the limit, then 0; ARMED stays";
    Full "what is refused" refused, "no such channel or more than 1000 ms: ACK 5; without it ACK 4";
    Full "what ends it" ends, "STOP, FRAME and HELLO end it at once";
}

const AMP: u16 = 300;

fn can(c: &Client<'_>) -> bool {
    c.caps.modes & Caps::MODE_IDENT != 0
}

fn ident(c: &mut Client<'_>, channel: u16, ms: u16, amp: u16) -> Say {
    c.watch.may_ident = true;
    let payload: Vec<u8> = [channel, ms, amp]
        .iter()
        .flat_map(|field| field.to_le_bytes())
        .collect();
    let code = if can(c) { 0 } else { 4 };
    c.say(kind::IDENT, &payload).wants(Want::Ack(code))
}

fn amp(c: &Client<'_>) -> u16 {
    AMP.min(c.caps.comp_limit[1])
}

fn sounds(c: &mut Client<'_>) -> Verdict {
    if !can(c) {
        return absent(c);
    }
    let amp = amp(c);
    let last = c.caps.n_ch - 1;
    let config = c.usual();
    sound(c, &config, 0, 60, u32::from(amp))?;
    sound(c, &config, last, 30, u32::from(amp))?;
    // Some of these end just before a STATUS.
    for ms in [58, 63, 68] {
        sound(c, &config, 0, ms, u32::from(amp))?;
    }
    let limited = c.usual_but(|wish| wish.comp_limit = [0, amp / 2]);
    sound(c, &limited, last, 30, u32::from(amp / 2))?;
    let masked = c.usual_but(|wish| wish.mask = ChannelMask::first(usize::from(last)));
    sound(c, &masked, last, 30, 0)
}

fn sound(c: &mut Client<'_>, config: &Config, channel: u16, ms: u16, sum: u32) -> Verdict {
    let amp = amp(c);
    c.tell_with(|c| c.arming(config))?;
    let tick = c.aim(6000)?;
    let asked = ident(c, channel, ms, amp);
    let heard = c.tell_at(tick, 6000, &[asked])?;
    for n_later in 1..=u32::from(ms) / 25 + 2 {
        let status = status_of(c, tick + n_later)?;
        let at_us = u64::from(tick + n_later) * u64::from(TICK_US);
        let over_us = [heard.from_us, heard.to_us].map(|us| us + u64::from(ms) * 1000);
        let is_sum = status.amp_sum == sum && at_us < over_us[1] + 1000;
        let is_over = status.amp_sum == 0 && at_us >= over_us[0];
        let is_armed = status.state == DeviceState::Armed.code();
        let shown = super::steps::shown(&status);
        ensure!(
            is_armed && (is_sum || is_over),
            "{shown} at an IDENT of {sum} for {ms} ms"
        )?;
    }
    Ok(())
}

fn absent(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let mut says = c.arming(&config);
    says.push(ident(c, 0, 30, 1));
    c.tell(&says)?;
    super::steps::expect(&c.status()?, DeviceState::Armed, 0)
}

fn refused(c: &mut Client<'_>) -> Verdict {
    if !can(c) {
        return absent(c);
    }
    let (config, n_ch) = (c.usual(), c.caps.n_ch);
    let mut says = c.arming(&config);
    for (channel, ms) in [(n_ch, 30), (u16::MAX, 30), (0, 1001), (0, u16::MAX)] {
        says.push(ident(c, channel, ms, 100).wants(Want::Ack(5)));
    }
    c.tell(&says)?;
    super::steps::expect(&c.status()?, DeviceState::Armed, 0)?;
    let longest = [ident(c, 0, 1000, 0)];
    c.tell(&longest).map(drop)
}

fn ends(c: &mut Client<'_>) -> Verdict {
    if !can(c) {
        return absent(c);
    }
    let amp = amp(c);
    let codes = c.faint(2);
    let config = c.usual();
    for by in [kind::STOP, kind::FRAME, kind::HELLO, kind::IDENT] {
        let there = go(c, Place::Armed)?;
        let first = ident(c, 0, 900, amp);
        c.tell_at(there.tick, there.phase_us, &[first])?;
        let status = status_of(c, there.tick + 1)?;
        ensure!(status.amp_sum == u32::from(amp), "IDENT did not sound")?;
        let (end, sum) = match by {
            kind::STOP => (c.stop(0), 0),
            kind::FRAME => {
                let allowed = crate::certify::predict::Allowed::of(&codes, &config);
                (c.frame_next(&codes), allowed.sum())
            }
            kind::HELLO => (c.hello(), 0),
            _ => (ident(c, 1 % c.caps.n_ch, 30, amp / 3), u32::from(amp / 3)),
        };
        let heard = c.tell_at(there.tick + 2, 3000, &[end])?;
        let status = status_of(c, there.tick + 3)?;
        ensure!(
            status.amp_sum == sum,
            "amp_sum {} instead of {sum}",
            status.amp_sum
        )?;
        if heard.to_us < heard.from_us {
            return Err(Trouble::Late);
        }
    }
    Ok(())
}
