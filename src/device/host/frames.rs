//! Frames: which tick each is for, its soft start, and how far away that tick is.

use std::time::Instant;

use super::HostSession;
use super::drive::SOFT_START_TICKS;
use super::report::{BridgeState, SentFrame};
use crate::framing::Packet;
use crate::message::frame;

impl HostSession {
    /// A FRAME for the tick `depth` after the present one, soft start applied; `None` unless armed,
    /// without a base of ticks, and when that tick has its frame.
    ///
    /// The present tick is that of the last STATUS plus whole ticks since it arrived, so a lost
    /// STATUS costs nothing.
    pub fn frame(
        &mut self,
        now: Instant,
        amplitudes_um: &[[f32; 2]],
    ) -> Option<(SentFrame, Packet)> {
        let seq = self.outbox.sequence.next();
        let sent = self.prepare(now, seq, amplitudes_um)?;
        let packet = frame::packet(seq, sent.apply_tick, &self.drive.codes)?;
        Some((sent, packet))
    }

    /// Makes the codes of a frame and stamps it.
    pub(super) fn prepare(
        &mut self,
        now: Instant,
        seq: u16,
        amplitudes_um: &[[f32; 2]],
    ) -> Option<SentFrame> {
        if !self.state.takes_frames() || !self.ticks.is_set() {
            return None;
        }
        let ahead = u32::from(self.latching.depth());
        let apply_tick = self.device.present_tick(now).wrapping_add(ahead);
        if !self.drive.is_new_tick(apply_tick) {
            return None;
        }
        let gain = self.drive.encode(apply_tick, amplitudes_um);
        let lasting = self.lasting();
        self.prediction
            .frame(apply_tick, &self.drive.codes, lasting);
        self.state = BridgeState::Streaming;
        self.outbox.last_sent = Some(now);
        let due = self.drive.due.take().map(|due| due.min(now));
        if let Some(due) = due {
            self.evidence.sent(seq, due);
        }
        Some(SentFrame {
            seq,
            apply_tick,
            gain,
            due,
            ahead: self.device.until_tick(now, apply_tick, SOFT_START_TICKS),
        })
    }
}
