//! `selvedge play --audio`: an exploration in real time on a sound card with many channels.
//!
//! The card paces: it wakes this thread at every tick that it begins, and three frames are kept
//! waiting for it. However it ends, the sound falls to silence first, and the card is given the
//! time to play that.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::play_source::Moving;
use super::{CliError, output};
use selvedge_device::ArrayProfile;
use selvedge_engine::{AudioOutput, CardChannels, EngineError, Notice, Silencer};
use selvedge_foundation::panics::OnPanic;
use selvedge_foundation::quantity::fixed;

const NAP: Duration = Duration::from_millis(20);
/// A card that takes nothing for so long has stopped.
const PATIENCE: Duration = Duration::from_secs(2);
/// The fall to silence takes 40 ms, and the card's own buffers some more.
const GOODBYE: Duration = Duration::from_millis(500);

/// Plays to the end of the path or until `stop` is set, and says what was missed and how late it
/// was.
pub(super) fn play(
    name: &str,
    channels: Option<&CardChannels>,
    mut moving: Moving,
    profile: &ArrayProfile,
    stop: &AtomicBool,
) -> Result<(), CliError> {
    let n_contactors = moving.core.felt_um().len();
    let channels = channels.map_or_else(|| CardChannels::first(n_contactors), Clone::clone);
    channels.check(n_contactors).map_err(EngineError::from)?;
    let opened = AudioOutput::open(name, profile, &channels);
    let mut card = opened.map_err(EngineError::from)?;
    let silencer = card.silencer();
    let last_act = OnPanic::new(move || fall_silent(&silencer));
    let started = Instant::now();
    let played = serve(&mut card, &mut moving, stop);
    fall_silent(&card.silencer());
    drop(last_act);
    let n_frames = played?;
    let seconds = fixed(started.elapsed().as_secs_f64(), 2);
    let late = card.latency();
    let ms = |time: Duration| fixed(time.as_secs_f64() * 1e3, 0);
    output::print(&format!(
        "{}: {n_frames} frames in {seconds} s; ticks without a new frame: {}; hiccups of the \
         card: {}; felt at most {} ms late, up to {} ms of them in the card\n",
        card.name(),
        card.n_missed(),
        card.n_hiccups(),
        ms(late.total),
        ms(late.card)
    ))
}

/// Hands over frames as the card takes them; how many.
fn serve(card: &mut AudioOutput, moving: &mut Moving, stop: &AtomicBool) -> Result<u64, CliError> {
    let mut n_frames = 0;
    let mut taken = Instant::now();
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
    Ok(n_frames)
}

/// Waits until the sound has fallen and the card has played it. A card that takes nothing any more
/// is waited for half a second.
fn fall_silent(silencer: &Silencer) {
    let deadline = Instant::now() + GOODBYE;
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        match silencer() {
            Some(held) => return thread::sleep(held.min(GOODBYE)),
            None if left.is_zero() => return,
            None => thread::sleep(left.min(NAP)),
        }
    }
}
