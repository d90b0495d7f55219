//! Mode B on the host's side: the same codes as a frame has, made to samples and cut to packets.
//!
//! Limits, wiring of bands and the soft start are in the codes already, so that samples are no
//! way around them. Sample m belongs to tick `m · 40 / rate` of the device, so that STATUS paces
//! them as it paces frames. What makes the waveform is not here: the bridge knows no rendering.

use std::fmt::Debug;
use std::time::{Duration, Instant};

use super::HostSession;
use super::clock::TICK;
use super::report::SentFrame;
use crate::framing::Packet;
use crate::message::{Config, Hello, samples};

/// Ticks that a larger depth may leave out, and that are then played as the next one.
const MAX_BETWEEN: u32 = 1;
/// Ticks of samples that one call may make.
pub(crate) const MAX_TICKS: usize = MAX_BETWEEN as usize + 1;

/// Makes the drive waveform of codes, for a device that plays samples.
pub trait Waveform: Debug + Send {
    /// Gets ready for so many samples a second (whole ones in a tick) and channels. False when
    /// there is no such waveform. May allocate.
    fn prepare(&mut self, rate_hz: u32, n_channels: usize) -> bool;

    /// The samples of a whole tick, interleaved, from the codes `[40 Hz, 320 Hz]` of every channel.
    /// Allocates nothing.
    fn tick(&mut self, codes: &[[u16; 2]]) -> &[i16];
}

/// A SAMPLES packet that was cut of a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CutSamples {
    /// The packet.
    pub packet: Packet,
    /// Whether it is the last of its tick.
    pub(crate) ends_tick: bool,
    /// When its tick was due, if it answers a STATUS.
    pub due: Option<Instant>,
    /// From now to the start of its tick.
    pub ahead: Duration,
}

impl HostSession {
    /// From now on samples are asked for where a device plays them; before it is opened.
    pub fn prefer_samples(&mut self) {
        self.drive.prefers_samples = true;
    }

    /// Whether the device plays samples (mode B): its CFG says so.
    pub fn plays_samples(&self) -> bool {
        self.device.plays_samples()
    }

    /// Why a configured device is not played by samples, though they were asked for; `None` when
    /// it is, or before it is configured.
    pub fn no_samples(&self) -> Option<&'static str> {
        let (caps, config) = self.device.caps.as_ref().zip(self.device.config.as_ref())?;
        let refused = (config.mode != Config::SAMPLES)
            .then_some("the device answers the wish for mode B (samples) with mode A");
        self.drive.lack(caps).or(refused)
    }

    /// Makes the samples of the coming tick, limits and soft start applied, and gives them to `out`
    /// packet by packet; `None` unless armed in mode B and a STATUS has come.
    ///
    /// A tick that was left out because the depth has grown, and has not begun, is played as this
    /// one. `amplitudes_um` are as those of a [`frame`](Self::frame). The number in the stamp is
    /// that of the first packet.
    pub(crate) fn play(
        &mut self,
        now: Instant,
        amplitudes_um: &[[f32; 2]],
        wave: &mut dyn Waveform,
        mut out: impl FnMut(CutSamples),
    ) -> Option<SentFrame> {
        if !self.plays_samples() {
            return None;
        }
        let mut sent = self.prepare(now, 0, amplitudes_um)?;
        let last = sent.apply_tick;
        let first = self.first_unplayed(now, last);
        let n_ticks = last.wrapping_sub(first).min(MAX_BETWEEN) + 1;
        let mut first_seq = None;
        for between in (0..n_ticks).rev() {
            let tick = last.wrapping_sub(between);
            let values = wave.tick(&self.drive.codes);
            let ahead = sent.ahead.saturating_sub(TICK * between);
            let due = sent.due.filter(|_| between == 0);
            let seq = self.cut(tick, values, (due, ahead), &mut out)?;
            first_seq.get_or_insert(seq);
        }
        self.drive.last_played_tick = Some(last);
        sent.seq = first_seq?;
        Some(sent)
    }

    /// The first tick to play on the way to `tick`: after the last one that was played, if that is
    /// not long ago and has not begun.
    fn first_unplayed(&self, now: Instant, tick: u32) -> u32 {
        let Some(last) = self.drive.last_played_tick else {
            return tick;
        };
        let left_out = tick.wrapping_sub(last).wrapping_sub(1);
        let coming = tick
            .wrapping_sub(self.device.present_tick(now))
            .wrapping_sub(1);
        if left_out <= MAX_BETWEEN {
            tick.wrapping_sub(left_out.min(coming))
        } else {
            tick
        }
    }

    /// Cuts a tick's samples to packets. Gives the number of the first.
    fn cut(
        &self,
        tick: u32,
        values: &[i16],
        (due, ahead): (Option<Instant>, Duration),
        out: &mut impl FnMut(CutSamples),
    ) -> Option<u16> {
        let per_packet = self.samples_per_packet();
        let parts = values.chunks(per_packet.max(1) * self.drive.n_contactors);
        let n_parts = parts.len();
        let mut first = tick.wrapping_mul(self.device.samples_per_tick());
        let mut first_seq = None;
        for (part, values) in parts.enumerate() {
            let seq = self.outbox.sequence.next();
            first_seq.get_or_insert(seq);
            out(CutSamples {
                packet: samples::packet(seq, first, self.drive.n_contactors, values)?,
                ends_tick: part + 1 == n_parts,
                due,
                ahead,
            });
            first = first.wrapping_add(u32::try_from(per_packet).unwrap_or(0));
        }
        first_seq
    }

    /// The most samples for each channel that one packet takes.
    pub(crate) fn samples_per_packet(&self) -> usize {
        self.device.samples_per_packet(self.drive.n_contactors)
    }

    /// SAMPLES packets that a tick takes.
    pub(crate) fn sample_packets_per_tick(&self) -> usize {
        let per_tick = usize::try_from(self.device.samples_per_tick()).unwrap_or(0);
        per_tick.div_ceil(self.samples_per_packet().max(1))
    }

    /// The greeting: STATUS and LOG are wanted.
    pub(super) fn hello(&self) -> Hello {
        Hello {
            host_flags: Hello::WANT_STATUS | Hello::WANT_LOG,
            ..Hello::new(self.nonce)
        }
    }
}
