//! Frames: which tick each is for, its soft start, and how far away that tick is.

use std::time::{Duration, Instant};

use super::{BridgeState, HostSession, SentFrame, TICK};
use crate::framing::Packet;
use crate::message::frame;

/// Ticks of the linear soft start after ARM.
pub(crate) const SOFT_START_TICKS: u32 = 20;

impl HostSession {
    /// A FRAME for the tick `depth` after the present one, soft start applied; `None` unless armed
    /// and a STATUS has come.
    ///
    /// The present tick is that of the last STATUS plus whole ticks since it arrived, so a lost
    /// STATUS costs nothing.
    pub fn frame(
        &mut self,
        now: Instant,
        amplitudes_um: &[[f32; 2]],
    ) -> Option<(SentFrame, Packet)> {
        if self.plays_samples() {
            return None;
        }
        let seq = self.sequence.next();
        let sent = self.prepare(now, seq, amplitudes_um)?;
        let packet = frame::packet(seq, sent.apply_tick, &self.codes)?;
        Some((sent, packet))
    }

    /// Makes the codes of a frame and stamps it; `None` unless armed and a STATUS has come.
    pub(super) fn prepare(
        &mut self,
        now: Instant,
        seq: u16,
        amplitudes_um: &[[f32; 2]],
    ) -> Option<SentFrame> {
        if !self.state.takes_frames() || self.status.is_none() {
            return None;
        }
        let ahead = u32::from(self.latching.depth());
        let apply_tick = self.present_tick(now).wrapping_add(ahead);
        let first = *self.first_apply_tick.get_or_insert(apply_tick);
        let gain = soft_start_gain(first, apply_tick);
        self.coder.encode_into(amplitudes_um, gain, &mut self.codes);
        self.state = BridgeState::Streaming;
        self.last_sent = Some(now);
        let due = self.due.take().map(|due| due.min(now));
        if let Some(due) = due {
            let by_tick = self.plays_samples();
            let name = if by_tick { apply_tick } else { seq.into() };
            self.evidence.sent(name, due);
        }
        Some(SentFrame {
            seq,
            apply_tick,
            gain,
            due,
            ahead: self.until_tick(now, apply_tick),
        })
    }

    /// The device's tick now: that of the last STATUS plus whole ticks since it began.
    pub(super) fn present_tick(&self, now: Instant) -> u32 {
        let tick = self.status.map_or(0, |status| status.tick);
        let since = self
            .tick_start
            .map_or(Duration::ZERO, |at| now.saturating_duration_since(at));
        let whole = since.as_micros() / TICK.as_micros();
        tick.wrapping_add(u32::try_from(whole).unwrap_or(0))
    }

    /// From now to the start of a tick of the device that comes soon.
    fn until_tick(&self, now: Instant, tick: u32) -> Duration {
        let Some((status, start)) = self.status.zip(self.tick_start) else {
            return Duration::ZERO;
        };
        let start = start + TICK * tick.wrapping_sub(status.tick).min(SOFT_START_TICKS);
        start.saturating_duration_since(now)
    }
}

/// `min(1, (ticks since the first FRAME after ARM + 1) / 20)`.
pub(super) fn soft_start_gain(first_apply_tick: u32, apply_tick: u32) -> f64 {
    let since = apply_tick.wrapping_sub(first_apply_tick);
    // A depth or clock correction may step back behind the first frame.
    let since = if since.cast_signed() < 0 { 0 } else { since };
    let ticks = since.saturating_add(1).min(SOFT_START_TICKS);
    f64::from(ticks) / f64::from(SOFT_START_TICKS)
}
