//! Sound for ears: two sides at 48 kHz, on whatever the system plays sound by.
//!
//! ```text
//! SoundSource ─▶ Player (level, fades) ◀─ blocks of 10–60 ms ─ server of sound, or a child `aplay`
//! SoundOutput::set_level ─ atomic ─┘          a thread of its own opens, asks, opens again
//! ```
//!
//! `mix` makes sound of what is felt. Which way plays is found by trying: on Linux the server of
//! sound (`PulseAudio`, or `PipeWire` which speaks the same), then `aplay`; elsewhere the system's
//! own. Whoever opens an output waits for nothing, and one that does not play says why.
//!
//! # Invariants
//! - nothing waits, neither for a server nor for the end of an output
//! - the system's volume is never touched: levels are ours, 0…1
//! - whatever a source makes, what leaves is a number within ±1, and begins and ends at 0

#[cfg(target_os = "linux")]
mod aplay;
mod mix;
#[cfg(target_os = "linux")]
mod pulse;
#[cfg(any(windows, target_os = "macos"))]
mod system;
#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests;

pub(crate) use mix::stereo_levels;
pub use mix::{Sonifier, SoundFeed, sonification};

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

use super::EngineError;

/// Samples a second of each side.
pub const SOUND_RATE_HZ: u32 = 48_000;
/// From silence to full level, or back, in so many samples: 50 ms.
const FADE: f32 = 2400.0;
/// How long an output goes on when it is dropped: the fade, and what is on its way.
const FADES_OUT: Duration = Duration::from_millis(200);
/// From one attempt to the next.
const RETRY: Duration = Duration::from_secs(2);
/// Samples of each side that are made at once.
const BLOCK: usize = 512;

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
    /// It plays, by this.
    Playing(&'static str),
    /// It does not, for this reason; it is tried again every two seconds.
    Absent(String),
}

/// A source that is played until this is dropped; then it fades within 50 ms, and nobody waits.
#[derive(Debug)]
pub struct SoundOutput {
    shared: Arc<Shared>,
    thread: Thread,
}

/// What both ends know.
#[derive(Debug)]
struct Shared {
    /// 0…1, as bits.
    level: AtomicU32,
    is_over: AtomicBool,
    state: Mutex<SoundState>,
    /// From a sample's making to its playing as the server says, µs; 0 where none does.
    latency_us: AtomicU32,
}

impl SoundOutput {
    /// Begins to play a source at a level of 0.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn open(source: Box<dyn SoundSource>) -> Result<Self, EngineError> {
        Self::open_by(source, system_ways())
    }

    fn open_by(source: Box<dyn SoundSource>, mut ways: Ways) -> Result<Self, EngineError> {
        let shared = Arc::new(Shared {
            level: AtomicU32::new(0),
            is_over: AtomicBool::new(false),
            state: Mutex::new(SoundState::Opening),
            latency_us: AtomicU32::new(0),
        });
        let player = Player {
            source,
            shared: Arc::clone(&shared),
            gain: 0.0,
        };
        let player = Arc::new(Mutex::new(player));
        let known = Arc::clone(&shared);
        let run = move || {
            while !known.is_over() {
                if let Err(why) = ways(&player, &known) {
                    known.set_state(SoundState::Absent(why));
                    known.nap(RETRY);
                }
            }
        };
        let builder = thread::Builder::new().name("selvedge-sound".to_owned());
        let thread = builder.spawn(run).map_err(EngineError::Thread)?;
        Ok(Self {
            shared,
            thread: thread.thread().clone(),
        })
    }

    /// How it stands.
    pub fn state(&self) -> SoundState {
        locked(&self.shared.state).clone()
    }

    /// How loud it is, 0…1, after what the source makes: 0 is mute.
    pub fn set_level(&self, level: f32) {
        let level = if level.is_finite() { level } else { 0.0 };
        let bits = level.clamp(0.0, 1.0).to_bits();
        self.shared.level.store(bits, Ordering::Relaxed);
    }

    /// From a sample's making to its playing, as the server of sound said last.
    pub fn latency(&self) -> Option<Duration> {
        let us = self.shared.latency_us.load(Ordering::Relaxed);
        (us > 0).then(|| Duration::from_micros(us.into()))
    }
}

impl Drop for SoundOutput {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Release);
        self.thread.unpark();
    }
}

impl Shared {
    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }

    fn set_state(&self, state: SoundState) {
        *locked(&self.state) = state;
    }

    /// Waits so long, or until the output is dropped.
    fn nap(&self, time: Duration) {
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
struct Player {
    source: Box<dyn SoundSource>,
    shared: Arc<Shared>,
    gain: f32,
}

/// A player that outlives the streams that ask it.
type SharedPlayer = Arc<Mutex<Player>>;

/// Plays until the output is dropped: `Ok`, or until it cannot go on: why.
type Ways = Box<dyn FnMut(&SharedPlayer, &Shared) -> Result<(), String> + Send>;

impl Player {
    /// What is played next.
    fn fill(&mut self, frames: &mut [[f32; 2]]) {
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
    fn fill_bytes(&mut self, bytes: &mut [u8]) {
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
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(target_os = "linux")]
fn system_ways() -> Ways {
    linux_ways(|| pulse::socket_of(|name| std::env::var(name).ok()))
}

/// The server of sound at this socket; where none answers, `aplay`, which is not started anew with
/// every attempt.
#[cfg(target_os = "linux")]
fn linux_ways(socket: impl Fn() -> Result<std::path::PathBuf, String> + Send + 'static) -> Ways {
    const APLAY_EVERY: u32 = 15;
    let mut n_tries = 0;
    let mut without_aplay = String::new();
    Box::new(move |player, shared| {
        let why = match socket().and_then(|path| pulse::open(&path, player)) {
            Ok(stream) => return stream.play(shared),
            Err(why) => why,
        };
        if n_tries % APLAY_EVERY == 0 {
            match aplay::play(player, shared) {
                Ok(()) => return Ok(()),
                Err(why) => without_aplay = why,
            }
        }
        n_tries += 1;
        Err(format!("{why}; {without_aplay}"))
    })
}

#[cfg(any(windows, target_os = "macos"))]
fn system_ways() -> Ways {
    Box::new(system::play)
}

#[cfg(not(any(windows, target_os = "linux", target_os = "macos")))]
fn system_ways() -> Ways {
    Box::new(|_, _| Err("sound is played on Linux, macOS and Windows".to_owned()))
}
