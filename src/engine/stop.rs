//! The emergency stop: works from any thread, waits for nothing, overtakes every queue.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::Thread;

use selvedge_device::{StopHandle, StopHow};
use selvedge_foundation::panics::OnPanic;

/// Switches everything off. Clones are the same switch.
///
/// Pressing it sends STOP to the device at once, on the caller's thread, ahead of every frame, and
/// tells the engine, which stays silent until it is armed anew or told to go on. An `Arm` that was
/// sent before the press and not yet heard is void.
#[derive(Clone, Default)]
pub struct StopSwitch(Arc<Shared>);

#[derive(Default)]
struct Shared {
    presses: AtomicU64,
    /// Those of them that silence the screen too, whatever the device does.
    full_presses: AtomicU64,
    engine: OnceLock<Thread>,
    /// Only ever held to look or to swap, never by the engine's thread.
    devices: Mutex<[Option<StopHandle>; 2]>,
}

impl StopSwitch {
    /// Everything off.
    pub fn press(&self) {
        self.0.full_presses.fetch_add(1, Ordering::SeqCst);
        self.press_if_armed();
    }

    /// Everything off if a device may move; otherwise the screen goes on. STOP is sent to the
    /// device either way, and an `Arm` on its way is void.
    pub fn press_if_armed(&self) {
        self.0.presses.fetch_add(1, Ordering::SeqCst);
        for device in self.devices().iter().flatten() {
            device.stop(StopHow::Now);
        }
        if let Some(engine) = self.0.engine.get() {
            engine.unpark();
        }
    }

    /// Lets a panic on any thread of the process press it, before the panic is reported as it was.
    pub fn press_on_panic(&self) {
        let switch = self.clone();
        let press = move || {
            switch.press();
            // Not while its lock is held: the wait may be as long as the port is stuck.
            let devices = switch.devices().clone();
            for device in devices.into_iter().flatten() {
                device.last_word();
            }
        };
        OnPanic::new(press).for_good();
    }

    /// How often it was pressed in either way.
    pub(super) fn presses(&self) -> u64 {
        self.0.presses.load(Ordering::SeqCst)
    }

    /// How often everything was to be off whether a device may move or not.
    pub(super) fn full_presses(&self) -> u64 {
        self.0.full_presses.load(Ordering::SeqCst)
    }

    /// The thread to wake.
    pub(super) fn set_engine(&self, engine: Thread) {
        // A switch has one engine for its life.
        drop(self.0.engine.set(engine));
    }

    /// Wakes the engine.
    pub(super) fn wake_engine(&self) {
        if let Some(engine) = self.0.engine.get() {
            engine.unpark();
        }
    }

    /// The device of a display, which it stops.
    pub(super) fn set_device(&self, display: usize, device: Option<StopHandle>) {
        self.devices()[display] = device;
    }

    fn devices(&self) -> std::sync::MutexGuard<'_, [Option<StopHandle>; 2]> {
        let devices = &self.0.devices;
        devices.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl std::fmt::Debug for StopSwitch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("StopSwitch")
            .field("presses", &self.presses())
            .finish_non_exhaustive()
    }
}
