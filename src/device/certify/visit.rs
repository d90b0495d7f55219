//! How a visit to a device begins and how it ends: with its CAPS, and with an acknowledged STOP.

use super::answers::Heard;
use super::client::Client;
use super::speech::Speech;
use super::verdict::{Trouble, Verdict};
use super::watch::Watch;
use crate::message::{Caps, Message as _, kind};

/// HELLO, and a STOP without its acknowledgement, are said again after so long.
const AGAIN_US: u64 = 250_000;
/// So often at most: STOP.
const N_STOPS: u32 = 8;

impl Client<'_> {
    /// HELLO until CAPS with our own session come; everything before is ignored.
    pub(super) fn open(&mut self, patience_us: u64) -> Result<(), Trouble> {
        let end_us = self.line.now_us() + patience_us;
        let hello = self.hello();
        self.write(&Speech::noise(&[0]))?;
        while self.line.now_us() < end_us {
            self.write(&hello)?;
            let until_us = self.line.now_us() + AGAIN_US;
            while self.line.now_us() < until_us {
                self.pump(until_us)?;
                if self.find_caps() {
                    // Late answers to repeated HELLOs are no concern of the checks.
                    self.pass(100_000)?;
                    self.forget();
                    self.watch = Watch::default();
                    self.watch.pause();
                    return Ok(());
                }
            }
        }
        let what = if self.heard.is_empty() {
            "nothing comes: check power, cable and port"
        } else {
            "bytes come, but no CAPS with the session of our HELLO"
        };
        Err(Trouble::Wrong(what.to_owned()))
    }

    /// Whether CAPS of this session came; they are kept.
    fn find_caps(&mut self) -> bool {
        let session = self.session.to_le_bytes();
        let found = self.heard.iter().find_map(|heard| match heard {
            Heard::Reply(kind::CAPS, payload) if payload.get(4..8) == Some(&session) => {
                Some(payload.clone())
            }
            _ => None,
        });
        let Some(payload) = found else { return false };
        self.speech.caps = Caps::decode(&payload).unwrap_or_default();
        self.tally.know_largest_body(self.speech.caps.max_body);
        self.caps_payload = payload;
        true
    }

    /// STOP, acknowledged: nothing is left to be stopped.
    pub(super) fn end(&mut self) -> Verdict {
        let stop = self.stop(0);
        self.tell(&[stop])?;
        self.is_open = false;
        Ok(())
    }

    /// STOP ahead of whatever waits, acknowledged: for leaving in the middle.
    pub(super) fn rest(&mut self) -> Verdict {
        for _ in 0..N_STOPS {
            self.forget();
            self.line.stop();
            self.is_open = false;
            let until_us = self.line.now_us() + AGAIN_US;
            while self.line.now_us() < until_us {
                self.listen(until_us)?;
                if self.heard.iter().any(is_stop_acknowledged) {
                    return Ok(());
                }
            }
        }
        let what = "it did not acknowledge the last STOP; switch its power off";
        Err(Trouble::Wrong(what.to_owned()))
    }
}

fn is_stop_acknowledged(heard: &Heard) -> bool {
    matches!(heard, Heard::Reply(kind::ACK, payload) if payload.first() == Some(&kind::STOP))
}
