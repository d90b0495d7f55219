//! The system's own sound, by `cpal`: Windows and macOS.

use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use std::thread;

use cpal::traits::{DeviceTrait as _, HostTrait as _, StreamTrait as _};
use cpal::{BufferSize, OutputCallbackInfo, StreamConfig};

use super::player::{BLOCK, FADES_OUT, SOUND_RATE_HZ, Shared, SharedPlayer, SoundState, locked};

/// How often it is asked whether the device is still there.
const ASK: std::time::Duration = std::time::Duration::from_secs(1);

/// Plays until the output is dropped.
///
/// # Errors
/// The system has nothing to play on, or takes it away.
pub(super) fn play(player: &SharedPlayer, shared: &Shared) -> Result<(), String> {
    let device = cpal::default_host()
        .default_output_device()
        .ok_or_else(|| "the system has nothing to play sound on".to_owned())?;
    let config = StreamConfig {
        channels: 2,
        sample_rate: SOUND_RATE_HZ,
        buffer_size: BufferSize::Default,
    };
    let player = Arc::clone(player);
    let mut block = [[0.0; 2]; BLOCK];
    let fill = move |out: &mut [f32], _: &OutputCallbackInfo| {
        let mut player = locked(&player);
        for part in out.chunks_mut(2 * BLOCK) {
            let frames = &mut block[..part.len() / 2];
            player.fill(frames);
            let samples = frames.iter().flatten();
            part.iter_mut()
                .zip(samples)
                .for_each(|(slot, x)| *slot = *x);
        }
    };
    let (sender, failures) = sync_channel(1);
    let fail = move |error: cpal::Error| {
        if error.kind() == cpal::ErrorKind::DeviceNotAvailable {
            drop(sender.try_send(error.to_string()));
        }
    };
    let stream = device.build_output_stream(config, fill, fail, None);
    let stream = stream.map_err(|error| error.to_string())?;
    stream.play().map_err(|error| error.to_string())?;
    shared.set_state(SoundState::Playing {
        by: "the system",
        latency: None,
    });
    while !shared.is_over() {
        shared.nap(ASK);
        if let Ok(what) = failures.try_recv() {
            return Err(what);
        }
    }
    thread::sleep(FADES_OUT);
    Ok(())
}
