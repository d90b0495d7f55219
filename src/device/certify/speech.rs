//! What can be said to a device: the packets of a session, each with its answer.

use super::predict::clamped;
use super::say::{Say, Want, packet};
use crate::message::{ARM_KEY, Caps, ChannelMask, Config, MAGIC, NEXT_TICK, kind};

/// What the next packet depends on.
pub(super) struct Speech {
    pub(super) caps: Caps,
    pub(super) session: u32,
    pub(super) seq: u16,
    token: u32,
}

impl Speech {
    /// Sessions and tokens begin at a number of the caller's.
    pub(super) fn new(nonce: u32) -> Self {
        Self {
            caps: Caps::default(),
            session: nonce | 1,
            seq: 1,
            token: nonce,
        }
    }

    /// Any packet; valid and without an answer unless said otherwise.
    pub(super) fn say(&mut self, kind: u8, payload: &[u8]) -> Say {
        let seq = self.seq;
        self.seq = self.seq.wrapping_add(1);
        Say {
            kind,
            seq,
            bytes: packet(kind, 0, seq, payload),
            want: Want::Nothing,
        }
    }

    /// Bytes that are no packet.
    pub(super) fn noise(bytes: &[u8]) -> Say {
        Say {
            kind: 0,
            seq: 0,
            bytes: bytes.to_vec(),
            want: Want::NoPacket,
        }
    }

    /// The payload of a HELLO.
    pub(super) fn hello_payload(
        session: u32,
        versions: [u8; 2],
        flags: u16,
        lease: u16,
    ) -> Vec<u8> {
        let mut payload = MAGIC.to_vec();
        payload.extend(session.to_le_bytes());
        payload.extend(versions);
        payload.extend(flags.to_le_bytes());
        payload.extend(lease.to_le_bytes());
        payload.extend([0; 2]);
        payload
    }

    /// A HELLO that opens a new session which wants STATUS.
    pub(super) fn hello(&mut self) -> Say {
        self.hello_with([1, 1], 1, 0, 1)
    }

    /// A HELLO of a new session: versions offered, flags, lease in ms; CAPS of version `chosen`.
    pub(super) fn hello_with(
        &mut self,
        versions: [u8; 2],
        flags: u16,
        lease_ms: u16,
        chosen: u8,
    ) -> Say {
        self.session = self.session.wrapping_add(2);
        let payload = Self::hello_payload(self.session, versions, flags, lease_ms);
        let want = Want::Caps(chosen, self.session);
        self.say(kind::HELLO, &payload).wants(want)
    }

    /// The settings of most checks: hold 60 ms, ramp 40 ms, everything else as CAPS allow.
    pub(super) fn usual(&self) -> Config {
        Config {
            mode: 0,
            flags: 0,
            hold_ms: 60,
            ramp_ms: 40,
            slew: 0,
            hv_dv: self.caps.hv_max_dv,
            comp_limit: self.caps.comp_limit,
            mask: ChannelMask::first(self.n_ch()),
        }
    }

    /// Those, changed.
    pub(super) fn usual_but(&self, change: impl FnOnce(&mut Config)) -> Config {
        let mut wish = self.usual();
        change(&mut wish);
        wish
    }

    /// Those, with another hold and ramp.
    pub(super) fn silent_after(&self, hold_ms: u16, ramp_ms: u16) -> Config {
        self.usual_but(|wish| (wish.hold_ms, wish.ramp_ms) = (hold_ms, ramp_ms))
    }

    pub(super) fn config_payload(&self, wish: &Config) -> Vec<u8> {
        let mut payload = vec![wish.mode, wish.flags];
        let [low, high] = wish.comp_limit;
        for field in [
            wish.hold_ms,
            wish.ramp_ms,
            wish.slew,
            wish.hv_dv,
            low,
            high,
            0,
        ] {
            payload.extend(field.to_le_bytes());
        }
        for word in 0..self.n_ch().div_ceil(32).max(1) {
            let bits = (0..32).filter(|bit| wish.mask.contains(32 * word + bit));
            let word: u32 = bits.map(|bit| 1 << bit).sum();
            payload.extend(word.to_le_bytes());
        }
        payload
    }

    /// A CONFIG, answered by the CFG that follows from CAPS.
    pub(super) fn config(&mut self, wish: &Config) -> Say {
        let payload = self.config_payload(wish);
        let held = clamped(&self.caps, wish);
        self.say(kind::CONFIG, &payload).wants(Want::Cfg(held))
    }

    /// The payload of an ARM of this session.
    pub(super) fn arm_payload(session: u32) -> Vec<u8> {
        let key = session ^ ARM_KEY;
        [session.to_le_bytes(), key.to_le_bytes()].concat()
    }

    /// ARM, accepted.
    pub(super) fn arm(&mut self) -> Say {
        let payload = Self::arm_payload(self.session);
        self.say(kind::ARM, &payload).wants(Want::Ack(0))
    }

    /// FRAME, accepted.
    pub(super) fn frame(&mut self, tick: u32, codes: &[[u16; 2]]) -> Say {
        let mut payload = tick.to_le_bytes().to_vec();
        for code in codes.iter().flatten() {
            payload.extend(code.to_le_bytes());
        }
        self.say(kind::FRAME, &payload)
    }

    /// FRAME for the next tick, accepted.
    pub(super) fn frame_next(&mut self, codes: &[[u16; 2]]) -> Say {
        self.frame(NEXT_TICK, codes)
    }

    /// STOP.
    pub(super) fn stop(&mut self, how: u8) -> Say {
        self.say(kind::STOP, &[0, how]).wants(Want::Ack(0))
    }

    /// PING.
    pub(super) fn ping(&mut self) -> Say {
        self.token = self
            .token
            .wrapping_mul(0x0019_660d)
            .wrapping_add(0x3c6e_f35f);
        let token = self.token;
        self.say(kind::PING, &token.to_le_bytes())
            .wants(Want::Pong(token))
    }

    /// HELLO, CONFIG and ARM.
    pub(super) fn arming(&mut self, wish: &Config) -> Vec<Say> {
        vec![self.hello(), self.config(wish), self.arm()]
    }

    pub(super) fn n_ch(&self) -> usize {
        usize::from(self.caps.n_ch)
    }

    /// Faint codes, below 1 % of full scale, another pattern for every `kind`.
    pub(super) fn faint(&self, kind: u16) -> Vec<[u16; 2]> {
        let most = [0, 1].map(|band| self.caps.comp_limit[band].min(self.caps.slew_max));
        let code = |channel: u16| {
            let low = 60 + (17 * channel + 31 * kind) % 200;
            let high = 40 + (29 * channel + 7 * kind) % 150;
            [low.min(most[0]), high.min(most[1])]
        };
        (0..self.caps.n_ch).map(code).collect()
    }
}
