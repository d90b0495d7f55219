//! The devices of the first and second display: connecting, arming, and the second's ticks.

use super::Runner;
use crate::Notice;
use crate::ready::Retired;
use selvedge_device::{Bridge, BridgeEvent, StopHow};

impl Runner {
    /// Takes the news of the second display's device, and answers its ticks.
    pub(super) fn turn_second(&mut self) {
        let notices = &mut self.channels.notices;
        let due = self.second.turn(self.clock.now(), &mut |event| {
            if !matches!(event, BridgeEvent::Pong { .. }) {
                notices.push(Notice::SecondBridge(event));
            }
        });
        let may_move = self.link.is_live() && !self.link.is_identifying();
        if self.second.is_live() && !may_move {
            self.second.stop(StopHow::Ramp);
        } else if due.is_some() {
            self.second
                .send(self.core.felt_um_of(1), self.core.fresh_stamp());
        }
    }

    pub(super) fn connect(&mut self, display: usize, bridge: Option<Box<Bridge>>) {
        let last = if display == 0 {
            self.core.set_link(None);
            self.link.connect(bridge)
        } else {
            self.second.connect(bridge)
        };
        self.retire(last.map(Retired::Bridge));
    }

    pub(super) fn arm(&mut self, presses: u64) {
        if presses != self.presses_heard || presses != self.switch.presses() {
            self.say(Notice::Refused(
                "everything was switched off meanwhile: arm again",
            ));
            return;
        }
        if self.second.is_some() && self.link.is_ready() && !self.second.is_ready() {
            self.say(Notice::Refused(
                "the second display's device is not ready: disconnect it, or see to it, and arm \
                 again",
            ));
            return;
        }
        self.core.resume();
        if !self.link.arm() {
            self.say(Notice::Refused("no device is ready to be armed"));
        } else if !self.link.is_identifying() {
            self.second.arm();
        }
    }
}
