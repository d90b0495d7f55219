//! CONFIG and what it bounds: clamps, limits, mask, slew, sum guard.

use super::checks;
use super::steps::{expect, status_of};
use crate::certify::client::{Client, Trouble, Verdict, ensure};
use crate::certify::predict::Allowed;
use crate::certify::say::Say;
use crate::message::{ChannelMask, Config, DeviceState, Status};

checks! { "limits":
    Quick "CFG" usual, "CFG is what was asked where CAPS allow it";
    Full "clamps" clamps, "hold + ramp ≤ 100 ms, the rest within CAPS; slew 0 is slew_max";
    Full "the last CONFIG holds" last_config, "a second CONFIG in READY replaces the first";
    Full "comp_limit" comp_limit, "values above it are lowered and counted, one each";
    Full "clipped at reception" clipped, "values are counted when their FRAME comes, not when played";
    Full "the mask" mask, "masked channels are 0 and not counted; bit and place agree";
    Full "slew" slew, "at most slew a tick, towards the newest target, in HOLD too";
    Full "sum guard" guard, "A40 + A320 above 65535: both scaled alike, counted once a channel";
}

/// Everything as asked, at 0 V: a device that does not grant that gets no large codes.
fn unpowered(c: &mut Client<'_>) -> Result<Config, Trouble> {
    let config = Config {
        hv_dv: 0,
        ..c.usual()
    };
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
    let says = [c.config(&config), c.config(&slower), c.config(&config)];
    c.tell(&says).map(drop)
}

fn clamps(c: &mut Client<'_>) -> Verdict {
    let config = Config {
        hv_dv: 0,
        ..c.usual()
    };
    let [low, high] = c.caps.comp_limit;
    let n_ch = c.n_ch();
    let wishes = [
        config,
        Config {
            hold_ms: 100,
            ramp_ms: 0,
            ..config
        },
        Config {
            hold_ms: 100,
            ramp_ms: 1,
            ..config
        },
        Config {
            hold_ms: 0,
            ramp_ms: 100,
            ..config
        },
        Config {
            hold_ms: 0,
            ramp_ms: 101,
            ..config
        },
        Config {
            hold_ms: 101,
            ramp_ms: 40,
            ..config
        },
        Config {
            hold_ms: 60,
            ramp_ms: 41,
            ..config
        },
        Config {
            hold_ms: u16::MAX,
            ramp_ms: u16::MAX,
            ..config
        },
        Config {
            hold_ms: 0,
            ramp_ms: 0,
            ..config
        },
        Config {
            hold_ms: 25,
            ramp_ms: 30,
            ..config
        },
        Config { slew: 1, ..config },
        Config {
            slew: c.caps.slew_max,
            ..config
        },
        Config {
            slew: u16::MAX,
            ..config
        },
        Config {
            comp_limit: [u16::MAX; 2],
            ..config
        },
        Config {
            comp_limit: [0, high],
            ..config
        },
        Config {
            comp_limit: [low, 0],
            ..config
        },
        Config {
            comp_limit: [low / 2, high / 3],
            ..config
        },
        Config { mode: 1, ..config },
        Config { mode: 9, ..config },
        Config { flags: 1, ..config },
        Config {
            flags: 0xff,
            ..config
        },
        Config {
            flags: 0xfe,
            ..config
        },
        Config {
            mask: ChannelMask::default(),
            ..config
        },
        Config {
            mask: ChannelMask::first(1),
            ..config
        },
        Config {
            mask: ChannelMask::first(n_ch - 1),
            ..config
        },
        Config {
            mask: ChannelMask::first(32 * n_ch.div_ceil(32)),
            ..config
        },
        Config {
            hv_dv: c.caps.hv_max_dv,
            ..config
        },
        Config {
            hv_dv: c.caps.hv_max_dv.saturating_add(1),
            ..config
        },
        Config {
            hv_dv: u16::MAX,
            ..config
        },
        Config { hv_dv: 1, ..config },
        config,
    ];
    for wish in wishes {
        let says = [c.config(&wish)];
        c.tell(&says)?;
    }
    Ok(())
}

fn last_config(c: &mut Client<'_>) -> Verdict {
    let silent = Config {
        comp_limit: [0; 2],
        ..c.usual()
    };
    let usual = c.usual();
    let says = [c.config(&silent), c.config(&usual), c.config(&silent)];
    c.tell(&says)?;
    let says = [c.config(&usual), c.arm()];
    c.tell(&says)?;
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
    let says: Vec<Say> = c.arming(config);
    c.tell(&says)?;
    let allowed = Allowed::of(codes, config);
    c.due.clipped = c.due.clipped.wrapping_add(allowed.clipped);
    let status = frame_is(c, codes, allowed.sum(), 2 * allowed.n_scaled)?;
    c.count(&status)
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
        let config = Config {
            comp_limit: limits,
            ..c.usual()
        };
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
    let config = Config {
        comp_limit: [1, 1],
        ..c.usual()
    };
    let says = c.arming(&config);
    c.tell(&says)?;
    let (tick, _) = c.tell_in_tick(|c, tick| vec![c.frame(tick + 2, &codes)])?;
    c.due.clipped = c
        .due
        .clipped
        .wrapping_add(Allowed::of(&codes, &config).clipped);
    let status = status_of(c, tick + 1)?;
    c.count(&status)
}

/// Masks by the bits of a channel's number: every channel has its own pattern of them.
fn mask(c: &mut Client<'_>) -> Verdict {
    let n_ch = c.n_ch();
    let codes = c.faint(4);
    let usual = c.usual();
    let limits = codes
        .first()
        .map_or([1; 2], |code| code.map(|code| code.saturating_sub(1)));
    let n_bits = usize::BITS - (n_ch - 1).leading_zeros();
    for bit in 0..n_bits {
        let mask = ChannelMask::of(n_ch, |channel| channel >> bit & 1 == 1);
        play_is(c, &Config { mask, ..usual }, &codes)?;
        play_is(
            c,
            &Config {
                mask,
                comp_limit: limits,
                ..usual
            },
            &codes,
        )?;
    }
    let nothing = Config {
        mask: ChannelMask::default(),
        ..usual
    };
    play_is(c, &nothing, &codes)
}

fn slew(c: &mut Client<'_>) -> Verdict {
    let config = Config {
        slew: 30,
        hold_ms: 90,
        ramp_ms: 10,
        ..c.usual()
    };
    let says = c.arming(&config);
    c.tell(&says)?;
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
        let says = c.arming(&config);
        c.tell(&says)?;
        let allowed = Allowed::of(&codes, &config);
        let mut status = None;
        for _ in 0..n_ticks.max(1) {
            let frame = c.frame_next(&codes);
            let (tick, _) = c.tell_in_tick(|_, _| vec![frame])?;
            c.due.clipped = c.due.clipped.wrapping_add(allowed.clipped);
            status = Some(status_of(c, tick + 1)?);
        }
        let Some(status) = status else { continue };
        let (sum, slack) = (allowed.sum(), 2 * allowed.n_scaled);
        ensure(
            (sum - slack.min(sum)..=sum).contains(&status.amp_sum),
            || format!("amp_sum {} where {sum} is right", status.amp_sum),
        )?;
        c.count(&status)?;
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
    let says = c.arming(&config);
    c.tell(&says)?;
    let allowed = Allowed::of(&codes, &config);
    let n_up = allowed
        .codes
        .iter()
        .flatten()
        .max()
        .map_or(0, |code| code.div_ceil(config.slew));
    let mut reached = vec![[0; 2]; c.n_ch()];
    for nth in 0..n_up + 2 {
        let is_up = nth < n_up;
        let codes = if is_up {
            codes.clone()
        } else {
            vec![[0; 2]; c.n_ch()]
        };
        let aim = Allowed::of(&codes, &config);
        c.due.clipped = c.due.clipped.wrapping_add(aim.clipped);
        reached = aim.slewed(&reached, config.slew);
        let sum = reached.iter().flatten().map(|code| u32::from(*code)).sum();
        frame_is(c, &codes, sum, 2 * allowed.n_scaled)?;
    }
    Ok(())
}
