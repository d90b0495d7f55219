//! What must hold in everything that a device says, whatever it was asked: its clock, its states,
//! its counters of ticks.

use crate::message::{Caps, Config, DeviceState, Pong, Status, TICK_US, fault_bit, kind};

/// A device stamps what it says within its own step of 1 ms.
const STAMP_US: u32 = 1000;
/// STATUS running in a row without output before the high voltage must be gone: a second.
const BLEED_TICKS: u32 = 40;
/// 2 V, in 0.1 V.
const HV_SLACK_DV: u32 = 20;

/// How the present text between zeros opened: zeros before it, its first byte.
#[derive(Debug, Default)]
struct Opening {
    n_zeros: u32,
    first: u8,
    is_later: bool,
}

/// Remembers what was said last, and the first thing that was wrong.
#[derive(Debug, Default)]
pub(super) struct Watch {
    last: Option<Status>,
    /// STATUS may pause: a session begins or ends, or did since STATUS came last.
    may_pause: bool,
    /// What made it pause is over.
    is_settled: bool,
    /// An IDENT may be sounding.
    pub(super) may_ident: bool,
    /// The settings in effect.
    pub(super) config: Config,
    next_seq: Option<u16>,
    n_quiet: u32,
    opening: Opening,
    wrong: Option<String>,
}

impl Watch {
    /// The first thing that was wrong since it was asked last.
    pub(super) fn take_wrong(&mut self) -> Option<String> {
        self.wrong.take()
    }

    /// Notes that something is wrong, unless something was before.
    pub(super) fn note(&mut self, is_right: bool, what: impl FnOnce() -> String) {
        if !is_right && self.wrong.is_none() {
            self.wrong = Some(what());
        }
    }

    /// A byte came.
    pub(super) fn byte(&mut self, byte: u8) {
        let opening = &mut self.opening;
        if byte == 0 {
            opening.n_zeros = if opening.first == 0 {
                opening.n_zeros + 1
            } else {
                1
            };
            opening.first = 0;
        } else if opening.first == 0 {
            opening.first = byte;
        }
    }

    /// A whole packet came; its last zero is the present byte.
    pub(super) fn packet(&mut self, packet_kind: u8, seq: u16) {
        // The first block of a body ends behind its type where the flags are 0.
        let is_plain = self.opening.first == 2 || packet_kind == 0;
        self.note(is_plain, || {
            String::from("a packet has flags in its header")
        });
        let has_zero = self.opening.n_zeros >= 2 || !self.opening.is_later;
        self.note(has_zero, || String::from("a packet has no zero before it"));
        self.opening.is_later = true;
        let expected = self.next_seq.unwrap_or(seq);
        self.note(seq == expected, || {
            format!("its packets count {expected}, then {seq}")
        });
        self.next_seq = Some(seq.wrapping_add(1));
        let is_known = matches!(
            packet_kind,
            kind::CAPS | kind::CFG | kind::ACK | kind::STATUS | kind::FAULT | kind::PONG
        );
        self.note(is_known, || match packet_kind {
            kind::LOG => String::from("LOG came although it was not asked for"),
            _ => format!("a packet of type {packet_kind:02X} came"),
        });
        self.note(packet_kind != kind::FAULT, || {
            String::from(
                "it reports a FAULT; send CLEAR when the cause is gone, then certify again",
            )
        });
    }

    pub(super) fn status(&mut self, status: &Status, caps: &Caps) {
        self.clock(status);
        self.state(status, caps);
        self.senses(status);
        if let Some(last) = self.last.replace(*status) {
            self.follows(&last, status);
        }
        self.may_pause &= !self.is_settled;
    }

    /// A session begins or ends now.
    pub(super) fn pause(&mut self) {
        (self.may_pause, self.is_settled) = (true, false);
    }

    /// What was said last has been heard.
    pub(super) fn settle(&mut self) {
        self.is_settled = true;
    }

    pub(super) fn pong(&mut self, pong: &Pong) {
        let phase_us = u32::from(pong.phase_us);
        self.note(phase_us < TICK_US, || {
            format!("PONG has phase {phase_us} µs, a tick has {TICK_US}")
        });
        let dev_us = pong.tick.wrapping_mul(TICK_US).wrapping_add(phase_us);
        self.note(dev_us == pong.dev_us, || {
            format!(
                "PONG has dev_us {}, its tick and phase make {dev_us}",
                pong.dev_us
            )
        });
        let Some(last) = self.last else { return };
        let ahead = pong.tick.wrapping_sub(last.tick).cast_signed();
        let is_next = ahead == 0
            || (ahead > 0 && self.may_pause)
            || (ahead == 1 && phase_us < STAMP_US)
            || (ahead == -1 && phase_us + STAMP_US >= TICK_US);
        self.note(is_next, || {
            format!(
                "PONG has tick {} and phase {phase_us} µs after STATUS of tick {}",
                pong.tick, last.tick
            )
        });
    }

    fn clock(&mut self, status: &Status) {
        let begins = status.tick.wrapping_mul(TICK_US);
        self.note(status.dev_us.wrapping_sub(begins) < STAMP_US, || {
            format!(
                "STATUS of tick {} has dev_us {}, 25 ms a tick make {begins}",
                status.tick, status.dev_us
            )
        });
    }

    fn state(&mut self, status: &Status, caps: &Caps) {
        let Some(state) = status.device_state() else {
            self.note(false, || format!("STATUS has state {}", status.state));
            return;
        };
        let sum = status.amp_sum;
        let is_silent = !state.is_live() || (state == DeviceState::Armed && !self.may_ident);
        self.note(sum == 0 || !is_silent, || {
            format!("amp_sum {sum} in {state}")
        });
        let queued = status.queued;
        self.note(queued == 0 || state.is_live(), || {
            format!("{queued} frames wait in {state}")
        });
        self.note(queued <= caps.queue, || {
            format!("{queued} frames wait, the queue has {}", caps.queue)
        });
        self.note(state != DeviceState::Idle, || {
            String::from("STATUS in IDLE")
        });
    }

    fn senses(&mut self, status: &Status) {
        let faults = status.faults & !fault_bit::LEASE_LOST;
        self.note(faults == 0, || {
            let names = fault_bit::names(faults);
            format!("STATUS has fault bits: {names}; send CLEAR when the cause is gone")
        });
        // Bit 5 tells why output ramps and is latched nowhere.
        let is_told = status.faults & fault_bit::LEASE_LOST != 0;
        self.note(!is_told || status.state == DeviceState::Ramp.code(), || {
            String::from("STATUS has fault bit 5 outside the ramp of a lost lease")
        });
        let temp = status.temp_cdeg;
        self.note((-1000..=7000).contains(&temp), || {
            format!("{:.1} °C, −10…70 °C are possible", f64::from(temp) / 100.0)
        });
        let is_live = status.device_state().is_some_and(DeviceState::is_live);
        let hv_dv = u32::from(self.config.hv_dv);
        self.n_quiet = if is_live { 0 } else { self.n_quiet + 1 };
        let most_dv = if is_live || self.n_quiet < BLEED_TICKS {
            hv_dv + hv_dv / 10 + HV_SLACK_DV
        } else {
            HV_SLACK_DV
        };
        let measured = u32::from(status.hv_dv);
        self.note(measured <= most_dv, || {
            format!("hv_dV {measured}, at most {most_dv} is possible")
        });
    }

    fn follows(&mut self, last: &Status, status: &Status) {
        let n_ticks = status.tick.wrapping_sub(last.tick);
        let is_next = n_ticks == 1 || (self.may_pause && n_ticks.cast_signed() > 0);
        self.note(is_next, || {
            format!("STATUS of tick {} after {}", status.tick, last.tick)
        });
        let n_missed = status.underrun.wrapping_sub(last.underrun);
        let was_live = last.device_state().is_some_and(DeviceState::is_live);
        let expected = match status.device_state() {
            _ if self.may_pause || n_ticks != 1 => return,
            Some(DeviceState::Run | DeviceState::Armed) => 0..=0,
            Some(DeviceState::Hold) => 1..=1,
            Some(DeviceState::Ready | DeviceState::Idle | DeviceState::Fault) if !was_live => 0..=0,
            _ => 0..=1,
        };
        self.note(expected.contains(&n_missed), || {
            let state = DeviceState::from_code(status.state).map_or("?", DeviceState::name);
            format!("underrun rises by {n_missed} at a tick in {state}")
        });
    }
}
