//! A machine with ALSA alone: a child `aplay` that reads samples from a pipe. The pipe is made
//! small, since what lies in it is late; `aplay` paces by reading.

use std::io::Write as _;
use std::process::{Child, Command, Stdio};
use std::thread;

use super::player::{FADES_OUT, SOUND_RATE_HZ, Shared, SharedPlayer, SoundState, locked};

/// Bytes in the pipe: 11 ms.
const PIPE: usize = 4096;
/// Bytes that are written at once: 5 ms.
const AT_ONCE: usize = 2048;
/// Whoever lasts so many writes has a card: what fits into pipe and buffer without one is less.
const PROVED: u32 = 64;

/// Ends with its owner.
struct Player(Child);

impl Drop for Player {
    fn drop(&mut self) {
        // One that is gone already is only collected.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Plays until the output is dropped.
///
/// # Errors
/// There is no `aplay`, or no card for it.
pub(super) fn play(player: &SharedPlayer, shared: &Shared) -> Result<(), String> {
    let rate = SOUND_RATE_HZ.to_string();
    let mut command = Command::new("aplay");
    command
        .args(["-q", "-t", "raw", "-f", "FLOAT_LE", "-c", "2", "-r", &rate])
        .args(["--buffer-time=60000", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let child = command.spawn();
    let mut child = Player(child.map_err(|_none| "there is no aplay (alsa-utils)".to_owned())?);
    let gone = || "aplay finds no card that it can play on".to_owned();
    let mut pipe = child.0.stdin.take().ok_or_else(gone)?;
    // A pipe that stays large only makes sound late.
    let _large = rustix::pipe::fcntl_setpipe_size(&pipe, PIPE);
    let mut n_written = 0;
    let mut bytes = [0; AT_ONCE];
    let mut write = || {
        locked(player).fill_bytes(&mut bytes);
        pipe.write_all(&bytes).map_err(|_closed| gone())
    };
    while !shared.is_over() {
        write()?;
        n_written += 1;
        if n_written == PROVED {
            shared.set_state(SoundState::Playing {
                by: "aplay",
                latency: None,
            });
        }
    }
    let n_left = FADES_OUT.as_millis() / 5;
    for _ in 0..n_left {
        write()?;
    }
    thread::sleep(FADES_OUT / 2);
    Ok(())
}
