//! IDENT: one channel driven alone, so that a person can say which contactor it is.

use std::time::Instant;

use super::HostSession;
use super::pending::Identifying;
use super::report::{BridgeEvent, BridgeState};
use crate::message::{Ack, AckCode, Caps, Ident, Message as _, kind};

/// Longest time that a channel is driven alone, ms.
const LONGEST_IDENT_MS: u16 = 1000;

impl HostSession {
    /// Drives one channel alone at 320 Hz for `ms` (at most 1000) with this amplitude, µm, held by
    /// every limit; `Identified` or `NotIdentified` follows. It ends by itself, at STOP and at the
    /// first FRAME. Only while armed and before any frame.
    ///
    /// # Errors
    /// Nothing was sent; the text says why.
    pub fn identify(
        &mut self,
        now: Instant,
        channel: u16,
        (amplitude_um, ms): (f32, u16),
    ) -> Result<(), &'static str> {
        let can_ident = |caps: &Caps| caps.modes & Caps::MODE_IDENT != 0;
        if !self.device.caps.as_ref().is_some_and(can_ident) {
            return Err("the device cannot drive a channel alone");
        }
        if self.state != BridgeState::Armed {
            return Err("a channel is driven alone only while armed, before anything is played");
        }
        if usize::from(channel) >= self.drive.n_contactors {
            return Err("the device has no such channel");
        }
        let ident = Ident {
            channel,
            ms: ms.min(LONGEST_IDENT_MS),
            amp: self.drive.coder.ident_code(amplitude_um),
        };
        let seq = self.outbox.sequence.next();
        self.outbox.queue(ident.packet(seq).as_ref(), now);
        let (tick, lasting) = (self.device.present_tick(now), self.lasting());
        self.prediction.ident(tick, (ident.amp, ident.ms), lasting);
        self.ident = Some(Identifying {
            channel,
            seq,
            sent: now,
        });
        Ok(())
    }

    pub(super) fn on_ident_ack(&mut self, ack: Ack) {
        let is_its = |ident: &mut Identifying| ack.kind == kind::IDENT && ack.seq == ident.seq;
        let Some(Identifying { channel, .. }) = self.ident.take_if(is_its) else {
            return;
        };
        self.event(match ack.code {
            AckCode::Ok => BridgeEvent::Identified { channel },
            code => BridgeEvent::NotIdentified {
                channel,
                reason: format!("the device refuses: {}", code.describe()),
            },
        });
    }

    pub(super) fn check_ident(&mut self, now: Instant) {
        if let Some(Identifying { channel, .. }) = self.ident.take_if(|ident| ident.is_late(now)) {
            self.event(BridgeEvent::NotIdentified {
                channel,
                reason: String::from("the device did not answer"),
            });
        }
    }
}
