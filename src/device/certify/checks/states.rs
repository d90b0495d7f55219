//! Every type in every state: its answer, and that a refusal changes nothing.

use super::check::checks;
use super::steps::{Place, go, judge_silence, status_of};
use crate::certify::client::Client;
use crate::certify::say::{Say, Want};
use crate::certify::verdict::{Verdict, ensure};
use crate::message::{Caps, DeviceState, kind};

checks! { "types and states":
    Full "IDLE" idle, "CONFIG, ARM, FRAME, IDENT: ACK 2; STOP, CLEAR: ACK 0; no state change";
    Quick "READY" ready, "FRAME, IDENT: ACK 2; STOP, CLEAR: ACK 0; CONFIG: CFG";
    Full "ARMED" armed, "CONFIG: ACK 2; CLEAR: ACK 0; the state stays";
    Full "ARMED for a while" armed_long, "ARMED has no time-out but the lease";
    Full "RUN" run, "CONFIG, ARM, IDENT: ACK 2; CLEAR: ACK 0; output goes on as it would";
    Full "HOLD" hold, "CONFIG, ARM, IDENT: ACK 2; CLEAR: ACK 0; output goes on as it would";
    Full "RAMP" ramp, "CONFIG, ARM, IDENT: ACK 2; CLEAR: ACK 0; output goes on as it would";
}

/// Whatever is refused in a state, and what is answered in all.
fn probes(c: &mut Client<'_>, state: DeviceState) -> Vec<Say> {
    let mut wish = c.usual();
    // What would be seen at once, were it taken.
    (wish.hold_ms, wish.ramp_ms) = (30, 10);
    let idle_or_live = state != DeviceState::Ready;
    let can_ident = c.caps.modes & Caps::MODE_IDENT != 0;
    let ident = [0, 0, 50, 0, 100, 0];
    let mut says = vec![c.ping()];
    if idle_or_live {
        says.push(c.config(&wish).wants(Want::Ack(2)));
    }
    if !matches!(state, DeviceState::Ready | DeviceState::Armed) {
        says.push(c.arm().wants(Want::Ack(2)));
    }
    if !state.is_live() {
        let codes = c.faint(5);
        says.push(c.frame_next(&codes).wants(Want::Ack(2)));
        says.push(c.stop(0));
        says.push(c.stop(1));
    }
    if state != DeviceState::Armed {
        let code = if can_ident { 2 } else { 4 };
        says.push(c.say(kind::IDENT, &ident).wants(Want::Ack(code)));
    }
    says.push(c.say(kind::SAMPLES, &[0; 8]).wants(Want::Ack(4)));
    says.push(c.say(kind::CLEAR, &[0, 0]).wants(Want::Ack(0)));
    says.push(c.say(kind::CLEAR, &[0xff, 0]).wants(Want::Ack(0)));
    says.push(c.say(0x0b, &[]).wants(Want::Ack(4)));
    says.push(c.ping());
    says
}

fn idle(c: &mut Client<'_>) -> Verdict {
    let mut says = vec![c.hello_with([2, 2], 1, 0, 0)];
    says.extend(probes(c, DeviceState::Idle));
    says.extend(probes(c, DeviceState::Idle));
    c.tell(&says)?;
    super::session::silent_for(c, 2)
}

fn ready(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    let mut says = probes(c, DeviceState::Ready);
    says.push(c.config(&config));
    says.extend(probes(c, DeviceState::Ready));
    says.push(c.config(&config));
    c.tell(&says)?;
    super::steps::expect(&c.status()?, DeviceState::Ready, 0)
}

fn armed(c: &mut Client<'_>) -> Verdict {
    stays(c, Place::Armed)
}

fn armed_long(c: &mut Client<'_>) -> Verdict {
    let config = c.usual();
    c.tell_with(|c| c.arming(&config))?;
    for _ in 0..8 {
        c.tell(&[])?;
        for status in c.statuses(4)? {
            super::steps::expect(&status, DeviceState::Armed, 0)?;
        }
    }
    Ok(())
}

fn run(c: &mut Client<'_>) -> Verdict {
    stays(c, Place::Run)
}

fn hold(c: &mut Client<'_>) -> Verdict {
    stays(c, Place::Hold)
}

fn ramp(c: &mut Client<'_>) -> Verdict {
    stays(c, Place::Ramp)
}

fn stays(c: &mut Client<'_>, place: Place) -> Verdict {
    let there = go(c, place)?;
    let says = probes(c, place.state());
    c.tell_at(there.tick, there.phase_us, &says)?;
    let status = status_of(c, there.tick + 1)?;
    let Some(played) = there.played else {
        return ensure!(
            status.state == place.state().code(),
            "{} became {}",
            place.state(),
            super::steps::shown(&status)
        );
    };
    judge_silence(&played, &status)?;
    super::steps::follow_silence(c, &played)
}
