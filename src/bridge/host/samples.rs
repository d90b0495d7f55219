//! Mode B on the host's side: the same codes as a frame has, for whoever makes samples of them.
//!
//! Limits, wiring of bands and the soft start are in the codes already, so that samples are no way
//! around them. What makes the waveform is not here: the bridge knows no rendering.

use std::time::Instant;

use super::{HostSession, SentFrame};
use crate::bridge::framing::Packet;
use crate::bridge::message::{Caps, Config, Hello, TICK_US, samples};

impl HostSession {
    /// From now on samples are asked for where a device plays them; before it is opened.
    pub fn prefer_samples(&mut self) {
        self.prefers_samples = true;
    }

    /// Whether the device plays samples (mode B): its CFG says so.
    pub fn plays_samples(&self) -> bool {
        self.config
            .is_some_and(|config| config.mode == Config::SAMPLES)
    }

    /// The codes to make the samples of one tick of, limits and soft start applied, in contactor
    /// order; `None` unless armed in mode B and a STATUS has come.
    pub fn codes_to_play(
        &mut self,
        now: Instant,
        amplitudes_um: &[[f32; 2]],
    ) -> Option<(SentFrame, &[[u16; 2]])> {
        if !self.plays_samples() {
            return None;
        }
        let sent = self.prepare(now, 0, amplitudes_um)?;
        Some((sent, &self.codes))
    }

    /// The most samples for each channel that one packet takes.
    pub fn samples_per_packet(&self) -> usize {
        let max_body = self.caps.map_or(0, |caps| caps.max_body);
        samples::most(max_body, self.n_contactors)
    }

    /// A SAMPLES packet: whole samples of all channels, interleaved, from number `first` on; `None`
    /// unless armed in mode B.
    pub fn samples(&mut self, now: Instant, first: u32, values: &[i16]) -> Option<Packet> {
        if !self.plays_samples() || !self.state.takes_frames() {
            return None;
        }
        let packet = samples::packet(self.sequence.next(), first, self.n_contactors, values)?;
        self.last_sent = Some(now);
        Some(packet)
    }

    /// What to ask for: samples only where ticks are whole samples.
    pub(super) fn mode(&self) -> u8 {
        let can = self.caps.is_some_and(|caps| {
            let ticks_are_whole = u64::from(caps.sample_hz) * u64::from(TICK_US) % 1_000_000 == 0;
            caps.modes & Caps::MODE_B != 0 && caps.sample_hz > 0 && ticks_are_whole
        });
        if self.prefers_samples && can {
            Config::SAMPLES
        } else {
            Config::AMPLITUDES
        }
    }

    /// The greeting: STATUS and LOG are wanted.
    pub(super) fn hello(&self) -> Hello {
        Hello {
            host_flags: Hello::WANT_STATUS | Hello::WANT_LOG,
            ..Hello::new(self.nonce)
        }
    }
}
