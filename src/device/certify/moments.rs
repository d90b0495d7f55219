//! Saying things at a moment of the device's clock.

use super::client::Client;
use super::predict::Between;
use super::say::Say;
use super::verdict::{Trouble, Verdict};
use crate::fields::wrapped_u32;
use crate::message::TICK_US;

/// Nothing waits longer, µs.
const LONGEST_WAIT_US: u64 = 2_000_000;
const TICK: u64 = TICK_US as u64;

impl Client<'_> {
    /// Waits until what is said then is heard about `phase_us` into a tick; gives that tick.
    pub(super) fn aim(&mut self, phase_us: u64) -> Result<u32, Trouble> {
        let offset_us = self.times.offset_us();
        let soon_us = self.line.now_us().saturating_add_signed(offset_us) + 300;
        let mut tick = soon_us / TICK;
        if soon_us % TICK > phase_us {
            tick += 1;
        }
        let at_us = (tick * TICK + phase_us).saturating_add_signed(-offset_us);
        self.pass_until(at_us)?;
        Ok(wrapped_u32(tick))
    }

    /// Waits until what is said then is heard about `phase_us` into this tick.
    pub(super) fn reach(&mut self, tick: u32, phase_us: u64) -> Verdict {
        let offset_us = self.times.offset_us();
        let at_us = u64::from(tick) * TICK + phase_us;
        self.pass_until(at_us.saturating_add_signed(-offset_us))
    }

    /// Says these about `phase_us` into this tick, and nowhere else.
    pub(super) fn tell_at(
        &mut self,
        tick: u32,
        phase_us: u64,
        says: &[Say],
    ) -> Result<Between, Trouble> {
        self.reach(tick, phase_us)?;
        self.tell(says)?.within(tick)
    }

    /// Says these so that the tick is told: `says` is made for the tick in which they are heard.
    pub(super) fn tell_in_tick(
        &mut self,
        says: impl FnOnce(&mut Self, u32) -> Vec<Say>,
    ) -> Result<(u32, Between), Trouble> {
        let tick = self.aim(6000)?;
        let says = says(self, tick);
        Ok((tick, self.tell(&says)?.within(tick)?))
    }

    /// Lets `us` of the host's time pass.
    pub(super) fn pass(&mut self, us: u64) -> Verdict {
        self.pass_until(self.line.now_us() + us)
    }

    fn pass_until(&mut self, until_us: u64) -> Verdict {
        if until_us > self.line.now_us() + LONGEST_WAIT_US {
            // Its clock jumps: nothing can be told by it.
            return Err(Trouble::Late);
        }
        while self.line.now_us() < until_us {
            self.pump(until_us)?;
        }
        self.times.woke(self.line.now_us(), until_us);
        Ok(())
    }
}
