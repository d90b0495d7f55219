//! A source at its level, whatever asks it for samples, and what both ends of an output know.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Samples a second of each side.
pub const SOUND_RATE_HZ: u32 = 48_000;
/// From silence to full level, or back, in so many samples: 50 ms.
const FADE: f32 = 2400.0;
/// How long an output goes on when it is dropped: the fade, and what is on its way.
pub(super) const FADES_OUT: Duration = Duration::from_millis(200);
/// Samples of each side that are made at once.
pub(super) const BLOCK: usize = 512;

/// What makes sound. It is asked on a thread that may not wait: it neither allocates nor locks.
pub trait SoundSource: Send {
    /// Fills all of them: left and right, full scale 1.
    fn fill(&mut self, frames: &mut [[f32; 2]]);
}

/// How it stands with an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SoundState {
    /// On its way: an answer comes within seconds.
    Opening,
    /// It plays.
    Playing {
        /// By what.
        by: &'static str,
        /// From a sample's making to its playing, as the server of sound said last.
        latency: Option<Duration>,
    },
    /// It does not, for this reason; it is tried again every two seconds.
    Absent(String),
}

/// What both ends know.
#[derive(Debug)]
pub(super) struct Shared {
    /// 0…1, as bits.
    pub(super) level: AtomicU32,
    pub(super) is_over: AtomicBool,
    pub(super) state: Mutex<SoundState>,
}

impl Shared {
    pub(super) fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }

    pub(super) fn set_state(&self, state: SoundState) {
        *locked(&self.state) = state;
    }

    /// Waits so long, or until the output is dropped.
    pub(super) fn nap(&self, time: Duration) {
        let until = Instant::now() + time;
        while !self.is_over() {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return;
            }
            thread::park_timeout(left);
        }
    }
}

/// A source at its level.
pub(super) struct Player {
    pub(super) source: Box<dyn SoundSource>,
    pub(super) shared: Arc<Shared>,
    pub(super) gain: f32,
}

/// A player that outlives the streams that ask it.
pub(super) type SharedPlayer = Arc<Mutex<Player>>;

impl Player {
    /// What is played next.
    pub(super) fn fill(&mut self, frames: &mut [[f32; 2]]) {
        self.source.fill(frames);
        let level = f32::from_bits(self.shared.level.load(Ordering::Relaxed));
        let target = if self.shared.is_over() { 0.0 } else { level };
        for frame in frames {
            self.gain += (target - self.gain).clamp(-1.0 / FADE, 1.0 / FADE);
            let gain = self.gain;
            *frame = frame.map(|x| {
                if x.is_finite() {
                    (x * gain).clamp(-1.0, 1.0)
                } else {
                    0.0
                }
            });
        }
    }

    /// The same as the bytes of a stream of little-endian floats; what is no whole frame is 0.
    #[cfg(target_os = "linux")]
    pub(super) fn fill_bytes(&mut self, bytes: &mut [u8]) {
        let mut block = [[0.0; 2]; BLOCK];
        for part in bytes.chunks_mut(8 * BLOCK) {
            let frames = &mut block[..part.len() / 8];
            self.fill(frames);
            let samples = frames.iter().flatten().flat_map(|x| x.to_le_bytes());
            let padded = samples.chain(std::iter::repeat(0));
            part.iter_mut()
                .zip(padded)
                .for_each(|(slot, byte)| *slot = byte);
        }
    }
}

/// What is locked is whole whoever panicked.
pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
