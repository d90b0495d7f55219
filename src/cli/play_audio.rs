//! `selvedge play --audio`: an exploration in real time on a sound card with many channels.
//!
//! The card paces: it wakes this thread at every tick that it begins, and three frames are kept
//! waiting for it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::play_source::Moving;
use super::{CliError, output};
use selvedge_device::ArrayProfile;
use selvedge_engine::{AudioOutput, EngineError, Notice};
use selvedge_foundation::quantity::fixed;

const NAP: Duration = Duration::from_millis(20);
/// A card that takes nothing for so long has stopped.
const PATIENCE: Duration = Duration::from_secs(2);
/// The fall to silence takes 40 ms, and the card's own buffers some more.
const GOODBYE: Duration = Duration::from_millis(500);

/// Plays to the end of the path or until `stop` is set, and says what was missed.
pub(super) fn play(
    name: &str,
    mut moving: Moving,
    profile: &ArrayProfile,
    stop: &AtomicBool,
) -> Result<(), CliError> {
    let n_contactors = moving.core.felt_um().len();
    let opened = AudioOutput::open(name, profile, n_contactors);
    let mut card = opened.map_err(EngineError::from)?;
    let started = Instant::now();
    let mut n_frames = 0_u64;
    let mut taken = started;
    let mut has_ended = false;
    while !stop.load(Ordering::Relaxed) {
        if let Some(error) = card.failure() {
            return Err(EngineError::from(error).into());
        }
        if !card.wants_frame() {
            if taken.elapsed() > PATIENCE {
                let what = format!("{} takes no more samples; is it still there?", card.name());
                return Err(CliError::Failed(what));
            }
            thread::park_timeout(NAP);
            continue;
        }
        taken = Instant::now();
        moving.core.tick(taken, &mut |notice| {
            has_ended |= matches!(notice, Notice::SourceEnded);
        });
        if has_ended {
            break;
        }
        card.push(moving.core.felt_um());
        moving.write_tick();
        n_frames += 1;
    }
    card.stop();
    let deadline = Instant::now() + GOODBYE;
    while !card.is_silent() && Instant::now() < deadline {
        thread::park_timeout(NAP);
    }
    let seconds = fixed(started.elapsed().as_secs_f64(), 2);
    output::print(&format!(
        "{}: {n_frames} frames in {seconds} s; ticks without a new frame: {}\n",
        card.name(),
        card.n_missed()
    ))
}
