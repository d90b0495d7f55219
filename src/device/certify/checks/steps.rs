//! Steps that many checks share: how to come into a state, and what STATUS must show then.

use crate::certify::client::Client;
use crate::certify::predict::{Allowed, Between, fits_ramp, ramped};
use crate::certify::say::Say;
use crate::certify::verdict::{Trouble, Verdict, ensure};
use crate::message::{Config, DeviceState, Status, TICK_US};

/// A FRAME that runs, and what it comes to.
pub(super) struct Played {
    pub(super) config: Config,
    /// The sum of its amplitudes.
    pub(super) sum: u32,
    /// The tick in which it was heard; it is applied in the next.
    pub(super) tick: u32,
    pub(super) heard: Between,
    pub(super) seq: u16,
}

/// Arms and plays one FRAME for the next tick.
pub(super) fn play(
    c: &mut Client<'_>,
    config: &Config,
    codes: &[[u16; 2]],
) -> Result<Played, Trouble> {
    play_at(c, config, codes, 6000)
}

/// The same with the FRAME so far into a tick.
pub(super) fn play_at(
    c: &mut Client<'_>,
    config: &Config,
    codes: &[[u16; 2]],
    phase_us: u64,
) -> Result<Played, Trouble> {
    c.tell_with(|c| c.arming(config))?;
    c.aim(phase_us)?;
    let frame = c.frame_next(codes);
    let seq = frame.seq;
    let heard = c.tell(&[frame])?;
    let tick = tick_of(heard)?;
    let allowed = Allowed::of(codes, config);
    c.tally.due.clipped += allowed.clipped;
    Ok(Played {
        config: *config,
        sum: allowed.sum(),
        tick,
        heard,
        seq,
    })
}

/// The tick in which all of it was heard.
pub(super) fn tick_of(heard: Between) -> Result<u32, Trouble> {
    let tick = crate::fields::wrapped_u32(heard.from_us / u64::from(TICK_US));
    heard.within(tick).map(|_| tick)
}

/// The STATUS of this tick; those before it are passed over.
pub(super) fn status_of(c: &mut Client<'_>, tick: u32) -> Result<Status, Trouble> {
    loop {
        let status = c.status()?;
        let ahead = status.tick.wrapping_sub(tick).cast_signed();
        if ahead == 0 {
            return Ok(status);
        }
        ensure!(ahead < 0, "no STATUS of tick {tick} came")?;
    }
}

/// State and sum, and their names when they are others.
pub(super) fn expect(status: &Status, state: DeviceState, sum: u32) -> Verdict {
    ensure!(
        status.state == state.code() && status.amp_sum == sum,
        "{} instead of {state} with amp_sum {sum}",
        shown(status)
    )
}

pub(super) fn shown(status: &Status) -> String {
    let state = DeviceState::from_code(status.state).map_or("no state", DeviceState::name);
    format!("{state} with amp_sum {}", status.amp_sum)
}

/// STATUS after a lone FRAME: hold, ramp, READY, by its age alone.
pub(super) fn judge_silence(played: &Played, status: &Status) -> Verdict {
    if status.tick <= played.tick {
        return Ok(());
    }
    let config = &played.config;
    let at_us = u64::from(status.tick) * u64::from(TICK_US);
    let n_steps = played.heard.steps_until(config.hold_ms, at_us);
    let before = if status.tick == played.tick + 1 {
        DeviceState::Run
    } else {
        DeviceState::Hold
    };
    judge_ramp(status, played.sum, before, config.ramp_ms, n_steps)?;
    let ages_ms = played.heard.ages_ms(at_us);
    let age_ms = u64::from(status.age_ms);
    let is_live = status.device_state().is_some_and(DeviceState::is_live);
    ensure!(
        !is_live || (ages_ms[0]..=ages_ms[1]).contains(&age_ms),
        "age_ms {age_ms} instead of {}",
        ages_ms[0]
    )?;
    ensure!(
        status.last_seq == played.seq || !is_live,
        "last_seq {} instead of {}",
        status.last_seq,
        played.seq
    )
}

/// STATUS so many steps into a ramp.
pub(super) fn judge_ramp(
    status: &Status,
    sum: u32,
    before: DeviceState,
    ramp_ms: u16,
    n_steps: [u64; 2],
) -> Verdict {
    let [least, most] = ramped(sum, ramp_ms, n_steps);
    let is_state = status
        .device_state()
        .is_some_and(|state| fits_ramp(state, before, ramp_ms, n_steps));
    ensure!(
        is_state && (least..=most).contains(&status.amp_sum),
        "{} where {} ms of the ramp of {ramp_ms} ms are over, {least}…{most} is right",
        shown(status),
        n_steps[0]
    )
}

/// Follows a lone FRAME to READY.
pub(super) fn follow_silence(c: &mut Client<'_>, played: &Played) -> Verdict {
    let n_ticks = (played.config.hold_ms + played.config.ramp_ms) / 25 + 2;
    loop {
        let status = c.status()?;
        judge_silence(played, &status)?;
        if status.tick > played.tick + u32::from(n_ticks) {
            return expect(&status, DeviceState::Ready, 0);
        }
        if status.tick > played.tick && status.state == DeviceState::Ready.code() {
            return Ok(());
        }
    }
}

/// A state that a check begins in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Ready,
    Armed,
    Run,
    Hold,
    Ramp,
}

impl Place {
    pub(super) const LIVE: [Self; 4] = [Self::Armed, Self::Run, Self::Hold, Self::Ramp];

    pub(super) fn state(self) -> DeviceState {
        match self {
            Self::Ready => DeviceState::Ready,
            Self::Armed => DeviceState::Armed,
            Self::Run => DeviceState::Run,
            Self::Hold => DeviceState::Hold,
            Self::Ramp => DeviceState::Ramp,
        }
    }
}

/// Where something is to be said: in this tick, in a state that the FRAME led to.
pub(super) struct There {
    pub(super) tick: u32,
    pub(super) phase_us: u64,
    pub(super) played: Option<Played>,
}

/// Goes to a state and waits for the moment; what is said then with
/// [`tell_at`](Client::tell_at) is heard in it.
pub(super) fn go(c: &mut Client<'_>, place: Place) -> Result<There, Trouble> {
    let mut config = c.usual();
    let codes = c.faint(1);
    let n_later = match place {
        Place::Ready => {
            let says = [c.hello(), c.config(&config)];
            return there(c, &says);
        }
        Place::Armed => {
            let says = c.arming(&config);
            return there(c, &says);
        }
        Place::Run => 1,
        Place::Hold => {
            (config.hold_ms, config.ramp_ms) = (90, 10);
            2
        }
        Place::Ramp => {
            (config.hold_ms, config.ramp_ms) = (0, 100);
            2
        }
    };
    let played = play(c, &config, &codes)?;
    Ok(There {
        tick: played.tick + n_later,
        phase_us: 6000,
        played: Some(played),
    })
}

fn there(c: &mut Client<'_>, says: &[Say]) -> Result<There, Trouble> {
    c.tell(says)?;
    let tick = c.aim(6000)?;
    Ok(There {
        tick,
        phase_us: 6000,
        played: None,
    })
}
