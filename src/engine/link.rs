//! The engine's side of the bridge: listens to its events, sends what is felt.
//!
//! Frames are only made for a device that is armed. Nothing here arms by itself.

use std::time::{Duration, Instant};

use super::recording::LinkTally;
use super::{LinkView, TICK};
use selvedge_device::{
    ArrayChange, Bridge, BridgeCounters, BridgeEvent, BridgeState, DeviceUid, LinkScale, Pacer,
    SentFrame, StopHow, Timings,
};

/// Ticks between two looks at the timings of the link: one second.
const TIMINGS_EVERY: u64 = 40;

/// A device, or none, and when to tick.
pub(super) struct Link {
    pub(super) pacer: Pacer,
    bridge: Option<Box<Bridge>>,
    /// The device that was last on a port.
    last_device: Option<DeviceUid>,
    sent: Option<SentFrame>,
    /// Whether channels are being identified, so that no frame may go out.
    is_identifying: bool,
    timings: Timings,
    n_unheard: u64,
    n_views: u64,
}

impl Link {
    /// No device yet; ticks come from `start` on.
    pub(super) fn new(start: Instant) -> Self {
        Self::paced(Pacer::with_own_clock(start))
    }

    /// No device yet, and no ticks but those of one.
    pub(super) fn waiting() -> Self {
        Self::paced(Pacer::waiting())
    }

    fn paced(pacer: Pacer) -> Self {
        Self {
            pacer,
            bridge: None,
            last_device: None,
            sent: None,
            is_identifying: false,
            timings: Timings::default(),
            n_unheard: 0,
            n_views: 0,
        }
    }

    /// Takes a device; the last one comes back.
    pub(super) fn connect(&mut self, bridge: Option<Box<Bridge>>) -> Option<Box<Bridge>> {
        if let Some(last) = &mut self.bridge {
            last.stop(StopHow::Ramp);
            self.last_device = last.device_uid().or(self.last_device);
        }
        let bridge = bridge.map(|mut bridge| {
            if let Some(last) = self.last_device {
                bridge.came_after(last);
            }
            bridge
        });
        self.sent = None;
        self.timings = Timings::default();
        self.pacer.forget_device();
        std::mem::replace(&mut self.bridge, bridge)
    }

    /// Tells a device that lives in told time what time it is.
    pub(super) fn tell(&mut self, now: Instant) {
        if let Some(bridge) = &mut self.bridge {
            bridge.tell(now);
        }
    }

    /// Whether there is a device, or may be one soon.
    pub(super) fn is_some(&self) -> bool {
        self.bridge.is_some()
    }

    /// Whether a device may move.
    pub(super) fn is_live(&self) -> bool {
        let bridge = self.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.state().is_live())
    }

    /// Takes all news but ticks, and says whether a tick is due, and since when.
    pub(super) fn turn(
        &mut self,
        now: Instant,
        hear: &mut dyn FnMut(BridgeEvent),
    ) -> Option<Instant> {
        self.pacer.turn(self.bridge.as_deref_mut(), now, hear)
    }

    /// Whether there is a device that can be armed.
    pub(super) fn is_ready(&self) -> bool {
        let bridge = self.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.state() == BridgeState::Ready)
    }

    /// Arms; false if there is no device that is ready.
    pub(super) fn arm(&mut self) -> bool {
        self.bridge.as_mut().is_some_and(|bridge| bridge.arm())
    }

    /// Asks the device to clear its faults.
    pub(super) fn clear_faults(&mut self) {
        if let Some(bridge) = &mut self.bridge {
            bridge.clear_faults();
        }
    }

    /// Ends output.
    pub(super) fn stop(&mut self, how: StopHow) {
        if let Some(bridge) = &mut self.bridge {
            bridge.stop(how);
        }
    }

    /// Sends amplitudes, µm, made from an input with this stamp, if an armed device listens.
    pub(super) fn send(
        &mut self,
        felt_um: &[[f32; 2]],
        stamp: Option<Instant>,
    ) -> Option<SentFrame> {
        let listener = self
            .bridge
            .as_mut()
            .filter(|bridge| bridge.state().takes_frames() && !self.is_identifying);
        let Some(bridge) = listener else {
            self.n_unheard += 1;
            return None;
        };
        let sent = bridge.send(felt_um, stamp);
        self.sent = sent.or(self.sent);
        sent
    }

    /// From the making of the last frame to the middle of the tick in which it is felt; `None`
    /// without an armed device.
    pub(super) fn until_felt(&self) -> Option<Duration> {
        let bridge = self.bridge.as_ref()?;
        let sent = self.sent.filter(|_| bridge.state().takes_frames())?;
        Some(sent.ahead + TICK / 2)
    }

    /// Follows another array profile; false when the device may move and it does not only lower.
    pub(super) fn set_array(&mut self, change: &mut ArrayChange) -> bool {
        let bridge = self.bridge.as_mut();
        bridge.is_none_or(|bridge| bridge.set_array(change).is_ok())
    }

    /// Begins or ends to identify channels, with a device at rest either way.
    pub(super) fn identify(&mut self, is_begun: bool) {
        if self.is_identifying != is_begun {
            self.is_identifying = is_begun;
            let live = self.bridge.as_mut();
            if let Some(bridge) = live.filter(|bridge| bridge.state().is_live()) {
                bridge.stop(StopHow::Ramp);
            }
        }
    }

    /// Whether channels are being identified.
    pub(super) fn is_identifying(&self) -> bool {
        self.is_identifying
    }

    /// Drives one channel alone: amplitude in µm, time in ms.
    pub(super) fn identify_channel(
        &mut self,
        channel: u16,
        how: (f32, u16),
    ) -> Result<(), &'static str> {
        let bridge = self.bridge.as_mut().filter(|_| self.is_identifying);
        let bridge = bridge.ok_or("no device is being identified")?;
        bridge.identify(channel, how)
    }

    /// What the device makes of codes, if one is connected.
    pub(super) fn scale(&self) -> Option<LinkScale> {
        let bridge = self.bridge.as_ref()?;
        let scale = bridge.session().link_scale();
        scale.filter(|_| bridge.state().is_open())
    }

    /// What proofs of presentation need of its counters.
    pub(super) fn tally(&self) -> LinkTally {
        let Some(bridge) = &self.bridge else {
            return LinkTally::default();
        };
        let BridgeCounters { device, codes, .. } = bridge.counters();
        LinkTally {
            n_missed: device.underrun.max(device.late),
            n_limited: codes.limited[0] + codes.limited[1] + codes.guarded + device.clipped,
        }
    }

    /// Frames not made because no armed device listened.
    pub(super) fn n_unheard(&self) -> u64 {
        self.n_unheard
    }

    /// What the window shows of it.
    pub(super) fn view(&mut self) -> Option<LinkView> {
        let bridge = self.bridge.as_ref()?;
        if self.n_views.is_multiple_of(TIMINGS_EVERY) {
            self.timings = bridge.timings();
        }
        self.n_views += 1;
        let session = bridge.session();
        Some(LinkView {
            state: session.state(),
            caps: session.caps().copied(),
            scale: session.link_scale(),
            predicted_sum: session.predicted_sum(),
            status: session.status().copied(),
            depth: session.depth(),
            lead: session.lead(),
            clock: session.clock(),
            counters: bridge.counters(),
            timings: self.timings,
            sent: self.sent,
        })
    }
}

impl Drop for Link {
    /// Also runs when the engine's thread panics. The process may end right after: a live device
    /// must have its STOP by then.
    fn drop(&mut self) {
        let Some(bridge) = self
            .bridge
            .as_mut()
            .filter(|bridge| bridge.state().is_live())
        else {
            return;
        };
        bridge.stop(StopHow::Now);
        if let Some(handle) = bridge.stop_handle() {
            handle.last_word();
        }
    }
}
