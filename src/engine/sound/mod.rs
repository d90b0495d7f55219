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
mod player;
#[cfg(target_os = "linux")]
mod pulse;
#[cfg(any(windows, target_os = "macos"))]
mod system;
#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests;

pub use mix::{Sonifier, SoundControl, SoundFeed, StereoLevels, sonification, stereo_levels};
pub use player::{SOUND_RATE_HZ, SoundSource, SoundState};

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, Thread};
use std::time::Duration;

use super::EngineError;
use player::{Player, Shared, SharedPlayer, locked};

/// From one attempt to the next.
const RETRY: Duration = Duration::from_secs(2);

/// A source that is played until this is dropped; then it fades within 50 ms, and nobody waits.
#[derive(Debug)]
pub struct SoundOutput {
    shared: Arc<Shared>,
    thread: Thread,
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
}

impl Drop for SoundOutput {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Release);
        self.thread.unpark();
    }
}

/// Plays until the output is dropped: `Ok`, or until it cannot go on: why.
type Ways = Box<dyn FnMut(&SharedPlayer, &Shared) -> Result<(), String> + Send>;

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
