//! Whether a snapshot shows anything new, and who is woken if it does.
//!
//! A window that is told only of what changed need not be drawn while nothing does. Counters that
//! rise at every tick are no news.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle, Thread};

use super::{EngineError, Playback, Snapshot};
use selvedge_device::{BridgeState, CodeCounters, DeviceCounters};
use selvedge_render::scene::Pose;
use selvedge_render::stylus::StylusState;
use selvedge_textile::tactile::Tuning;

/// What of a snapshot is worth drawing a window for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct SnapshotSummary {
    scene_serial: u64,
    revision: u64,
    pose: Pose,
    others_moved: u64,
    turn_deg: f64,
    /// Stopped, silent, a cloth in place of the scene.
    is: [bool; 3],
    sequence_step: Option<u16>,
    stylus: Option<StylusState>,
    tuning: Tuning,
    playback: Playback,
    n_recorded: u64,
    ignored: u64,
    missed: u64,
    notices_lost: u64,
    is_device_paced: bool,
    devices: [Option<(BridgeState, u8, DeviceCounters, CodeCounters)>; 2],
}

impl SnapshotSummary {
    pub(super) fn of(snapshot: &Snapshot) -> Self {
        let device = |link: &super::LinkView| {
            (
                link.state,
                link.depth,
                link.counters.device,
                link.counters.codes,
            )
        };
        Self {
            scene_serial: snapshot.scene_serial,
            revision: snapshot.revision,
            // The time of a pose that stands still is no news.
            pose: Pose {
                t_s: 0.0,
                ..snapshot.pose
            },
            others_moved: snapshot.counters.others_moved,
            turn_deg: snapshot.turn_deg,
            is: [
                snapshot.is_stopped,
                snapshot.is_silent,
                snapshot.rendering.is_cloth,
            ],
            sequence_step: snapshot.sequence_step,
            stylus: snapshot.stylus,
            tuning: snapshot.rendering.tuning,
            playback: snapshot.playback,
            n_recorded: snapshot.recording.n_ticks,
            ignored: snapshot.counters.ignored,
            missed: snapshot.clock.missed,
            notices_lost: snapshot.counters.notices_lost,
            is_device_paced: snapshot.clock.is_device_paced,
            devices: [snapshot.link, snapshot.second_link].map(|link| link.as_ref().map(device)),
        }
    }
}

/// Wakes whoever listens to news, from a thread that may lock and wait as it likes.
#[derive(Debug, Default)]
pub(super) struct Waker {
    listener: Option<(Thread, Arc<Flags>)>,
}

#[derive(Debug, Default)]
struct Flags {
    has_news: AtomicBool,
    is_over: AtomicBool,
}

impl Waker {
    /// Calls `listener` on a named thread whenever there is news, until this is dropped.
    pub(super) fn start(
        listener: Box<dyn Fn() + Send>,
    ) -> Result<(Self, JoinHandle<()>), EngineError> {
        let flags = Arc::new(Flags::default());
        let heard = Arc::clone(&flags);
        let listen = move || {
            while !heard.is_over.load(Ordering::Acquire) {
                if heard.has_news.swap(false, Ordering::AcqRel) {
                    listener();
                } else {
                    thread::park();
                }
            }
        };
        let builder = thread::Builder::new().name("selvedge-news".to_owned());
        let joined = builder.spawn(listen).map_err(EngineError::Thread)?;
        Ok((
            Self {
                listener: Some((joined.thread().clone(), flags)),
            },
            joined,
        ))
    }

    /// There is news. Neither waits nor allocates.
    pub(super) fn wake(&self) {
        if let Some((thread, flags)) = &self.listener {
            flags.has_news.store(true, Ordering::Release);
            thread.unpark();
        }
    }
}

impl Drop for Waker {
    fn drop(&mut self) {
        if let Some((thread, flags)) = &self.listener {
            flags.is_over.store(true, Ordering::Release);
            thread.unpark();
        }
    }
}
