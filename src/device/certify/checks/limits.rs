//! CONFIG and what it bounds: clamps, limits, mask, slew, sum guard.

use super::check::checks;
use super::steps::{expect, status_of};
use crate::certify::client::Client;
use crate::certify::predict::Allowed;
use crate::certify::verdict::{Trouble, Verdict, ensure};
use crate::message::{Caps, ChannelMask, Config, DeviceState, Status};

checks! { "limits":
    Quick "CFG" usual, "CFG is what was asked where CAPS allow it";
    Full "clamps" clamps, "hold + ramp ≤ 100 ms, the rest within CAPS; slew 0 is slew_max";
    Full "the last CONFIG holds" last_config, "a second CONFIG in READY replaces the first";
    Full "comp_limit" comp_limit, "values above it are lowered and counted, one each";
    Full "clipped at reception" clipped, "values are counted when their FRAME comes";
    Full "the mask" mask, "masked channels are 0 and not counted; bit and place agree";
    Full "slew" slew, "at most slew a tick, towards the newest target, in HOLD too";
    Full "sum guard" guard, "A40 + A320 above 65535: both scaled alike, counted once a channel";
}

/// Everything as asked, at 0 V: a device that does not grant that gets no large codes.
fn unpowered(c: &mut Client<'_>) -> Result<Config, Trouble> {
    let config = c.usual_but(|wish| wish.hv_dv = 0);
    let says = [c.hello(), c.config(&config)];
    match c.tell(&says) {
        Err(Trouble::Wrong(what)) => Err(Trouble::Untested(format!(
            "large codes need hv_dV 0, and the device does not grant it: {what}"
        ))),
        told => told.map(|_| config),
    }
}

fn usual(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let slower = Config {
        hold_ms: 50,
        ramp_ms: 30,
        slew: 1,
        comp_limit: [1, 2],
        hv_dv: 1,
        ..config
    };
    c.tell_with(|c| [c.config(&config), c.config(&slower), c.config(&config)])
        .map(drop)
}

/// A wish that CAPS and the rules bound, as what it changes of a plain one.
type Wish = fn(&mut Config, &Caps);

const WISHES: &[Wish] = &[
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (100, 0),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (100, 1),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (0, 100),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (0, 101),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (101, 40),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (60, 41),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (u16::MAX, u16::MAX),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (0, 0),
    |wish, _| (wish.hold_ms, wish.ramp_ms) = (25, 30),
    |wish, _| wish.slew = 1,
    |wish, caps| wish.slew = caps.slew_max,
    |wish, _| wish.slew = u16::MAX,
    |wish, _| wish.comp_limit = [u16::MAX; 2],
    |wish, _| wish.comp_limit[0] = 0,
    |wish, _| wish.comp_limit[1] = 0,
    |wish, caps| wish.comp_limit = caps.comp_limit.map(|limit| limit / 2),
    |wish, _| wish.mode = 1,
    |wish, _| wish.mode = 9,
    |wish, _| wish.flags = 1,
    |wish, _| wish.flags = 0xff,
    |wish, _| wish.flags = 0xfe,
    |wish, _| wish.mask = ChannelMask::default(),
    |wish, _| wish.mask = ChannelMask::first(1),
    |wish, caps| wish.mask = ChannelMask::first(usize::from(caps.n_ch) - 1),
    |wish, caps| wish.mask = ChannelMask::first(32 * usize::from(caps.n_ch).div_ceil(32)),
    |wish, caps| wish.hv_dv = caps.hv_max_dv,
    |wish, caps| wish.hv_dv = caps.hv_max_dv.saturating_add(1),
    |wish, _| wish.hv_dv = u16::MAX,
    |wish, _| wish.hv_dv = 1,
    |_, _| {},
];

fn clamps(c: &mut Client<'_>) -> Verdict {
    for change in WISHES {
        let mut wish = c.usual_but(|wish| wish.hv_dv = 0);
        change(&mut wish, &c.caps);
        c.tell_with(|c| [c.config(&wish)])?;
    }
    Ok(())
}

fn last_config(c: &mut Client<'_>) -> Verdict {
    let silent = c.usual_but(|wish| wish.comp_limit = [0; 2]);
    let usual = c.usual();
    c.tell_with(|c| [c.config(&silent), c.config(&usual), c.config(&silent)])?;
    c.tell_with(|c| [c.config(&usual), c.arm()])?;
    let codes = c.faint(2);
    let expected = Allowed::of(&codes, &usual).sum();
    frame_is(c, &codes, expected, 0).map(drop)
}

/// Says a FRAME; the next STATUS has this sum, give or take `slack` below.
fn frame_is(
    c: &mut Client<'_>,
    codes: &[[u16; 2]],
    sum: u32,
    slack: u32,
) -> Result<Status, Trouble> {
    let frame = c.frame_next(codes);
    let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
    let status = status_of(c, tick + 1)?;
    let is_near = (sum.saturating_sub(slack)..=sum).contains(&status.amp_sum);
    expect(
        &status,
        DeviceState::Run,
        if is_near { status.amp_sum } else { sum },
    )?;
    Ok(status)
}

/// Arms with this and plays one FRAME that comes to what follows from it.
fn play_is(c: &mut Client<'_>, config: &Config, codes: &[[u16; 2]]) -> Verdict {
    c.tell_with(|c| c.arming(config))?;
    let allowed = Allowed::of(codes, config);
    c.tally.clipped(&allowed);
    let status = frame_is(c, codes, allowed.sum(), 2 * allowed.n_scaled)?;
    c.tally.compare(&status)
}

fn comp_limit(c: &mut Client<'_>) -> Verdict {
    let codes = c.faint(3);
    let most = [0, 1].map(|band| codes.iter().map(|code| code[band]).max().unwrap_or(0));
    for limits in [
        most,
        [most[0].saturating_sub(1), most[1]],
        [most[0], most[1].saturating_sub(1)],
        [most[0] / 2, most[1] / 3],
        [0, most[1]],
        [most[0], 0],
        [0, 0],
    ] {
        let config = c.usual_but(|wish| wish.comp_limit = limits);
        play_is(c, &config, &codes)?;
    }
    Ok(())
}

fn clipped(c: &mut Client<'_>) -> Verdict {
    if c.caps.queue < 2 {
        return Err(Trouble::Untested(String::from(
            "the queue holds no FRAME for later",
        )));
    }
    let codes = c.faint(3);
    let config = c.usual_but(|wish| wish.comp_limit = [1, 1]);
    c.tell_with(|c| c.arming(&config))?;
    let (tick, _) = c.tell_in_tick(|c, tick| vec![c.frame(tick + 2, &codes)])?;
    c.tally.clipped(&Allowed::of(&codes, &config));
    let status = status_of(c, tick + 1)?;
    c.tally.compare(&status)
}

/// Masks by the bits of a channel's number: every channel has its own pattern of them.
fn mask(c: &mut Client<'_>) -> Verdict {
    let n_ch = c.n_ch();
    let codes = c.faint(4);
    let limits = codes
        .first()
        .map_or([1; 2], |code| code.map(|code| code.saturating_sub(1)));
    let n_bits = usize::BITS - (n_ch - 1).leading_zeros();
    for bit in 0..n_bits {
        let mask = ChannelMask::of(n_ch, |channel| channel >> bit & 1 == 1);
        let masked = c.usual_but(|wish| wish.mask = mask);
        play_is(c, &masked, &codes)?;
        let limited = c.usual_but(|wish| (wish.mask, wish.comp_limit) = (mask, limits));
        play_is(c, &limited, &codes)?;
    }
    let nothing = c.usual_but(|wish| wish.mask = ChannelMask::default());
    play_is(c, &nothing, &codes)
}

fn slew(c: &mut Client<'_>) -> Verdict {
    let mut config = c.silent_after(90, 10);
    config.slew = 30;
    c.tell_with(|c| c.arming(&config))?;
    let [up, down] = [
        c.faint(1),
        c.faint(9).iter().map(|code| code.map(|c| c / 4)).collect(),
    ];
    let mut reached = vec![[0; 2]; c.n_ch()];
    let mut tick = c.aim(6000)?;
    // Every second tick has none: HOLD moves on as well.
    for (codes, has_frame) in [
        (&up, true),
        (&up, false),
        (&up, true),
        (&down, true),
        (&down, false),
        (&up, true),
        (&down, true),
        (&down, false),
    ] {
        if has_frame {
            let says = [c.frame_next(codes)];
            c.tell_at(tick, 6000, &says)?;
        }
        tick += 1;
        reached = Allowed::of(codes, &config).slewed(&reached, config.slew);
        let sum = reached.iter().flatten().map(|code| u32::from(*code)).sum();
        let state = if has_frame {
            DeviceState::Run
        } else {
            DeviceState::Hold
        };
        expect(&status_of(c, tick)?, state, sum)?;
    }
    Ok(())
}

fn guard(c: &mut Client<'_>) -> Verdict {
    let config = unpowered(c)?;
    let n_ticks = u16::MAX.div_ceil(c.caps.slew_max.max(1));
    if n_ticks > 40 {
        return Err(Trouble::Untested(format!(
            "full drive takes {n_ticks} ticks of slew"
        )));
    }
    let n_ch = c.n_ch();
    let full = [
        vec![[u16::MAX; 2]; n_ch],
        (0..n_ch)
            .map(|channel| {
                if channel == 0 {
                    [60_000, 30_000]
                } else {
                    [7, 9]
                }
            })
            .collect(),
        vec![[32_768, 32_767]; n_ch],
        vec![[32_768, 32_768]; n_ch],
        vec![[1, u16::MAX]; n_ch],
    ];
    shares(c, &config)?;
    for codes in full {
        c.tell_with(|c| c.arming(&config))?;
        let allowed = Allowed::of(&codes, &config);
        let mut status = None;
        for _ in 0..n_ticks.max(1) {
            let frame = c.frame_next(&codes);
            let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
            c.tally.clipped(&allowed);
            status = Some(status_of(c, tick + 1)?);
        }
        let Some(status) = status else { continue };
        let (sum, slack) = (allowed.sum(), 2 * allowed.n_scaled);
        ensure!(
            (sum - slack.min(sum)..=sum).contains(&status.amp_sum),
            "amp_sum {} where {sum} is right",
            status.amp_sum
        )?;
        c.tally.compare(&status)?;
    }
    Ok(())
}

/// That both components are scaled alike: the sum cannot tell, but the way down by slew can.
fn shares(c: &mut Client<'_>, config: &Config) -> Verdict {
    let config = Config {
        slew: 10_000.min(c.caps.slew_max),
        ..*config
    };
    let codes = vec![[60_000, 30_000]; c.n_ch()];
    c.tell_with(|c| c.arming(&config))?;
    let allowed = Allowed::of(&codes, &config);
    let n_up = allowed
        .codes
        .iter()
        .flatten()
        .max()
        .map_or(0, |code| code.div_ceil(config.slew));
    let mut reached = vec![[0; 2]; c.n_ch()];
    let mut before: Option<(u32, Allowed)> = None;
    for nth in 0..n_up + 2 {
        let is_up = nth < n_up;
        let codes = if is_up {
            codes.clone()
        } else {
            vec![[0; 2]; c.n_ch()]
        };
        let frame = c.frame_next(&codes);
        let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
        let aim = Allowed::of(&codes, &config);
        c.tally.clipped(&aim);
        if let Some((from, aim)) = &before {
            // Ticks without a FRAME, where the link is slow, move towards the last one.
            for _ in from + 1..=tick {
                reached = aim.slewed(&reached, config.slew);
            }
        }
        reached = aim.slewed(&reached, config.slew);
        before = Some((tick + 1, aim));
        let status = status_of(c, tick + 1)?;
        let sum = reached
            .iter()
            .flatten()
            .map(|code| u32::from(*code))
            .sum::<u32>();
        let slack = 2 * allowed.n_scaled;
        let sums = sum.saturating_sub(slack)..=sum + slack;
        ensure!(
            sums.contains(&status.amp_sum),
            "amp_sum {} on the way by slew, {sum} is right",
            status.amp_sum
        )?;
    }
    Ok(())
}
