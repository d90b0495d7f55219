//! Sound cards through the system: which there are, and one that plays. The one home of `cpal`.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use cpal::traits::{DeviceTrait as _, HostTrait as _, StreamTrait as _};
use cpal::{
    BufferSize, Device, FromSample, OutputCallbackInfo, SampleFormat, SizedSample, Stream,
    StreamConfig, SupportedBufferSize,
};

use super::wave::{Wave, WaveFrames, wave};
use super::{AudioEntry, AudioError, AudioLatency, CardChannels, Silencer};
use selvedge_device::ArrayProfile;

/// The rate that is taken where a card offers it: whole samples a tick and a period.
const BEST_RATE_HZ: u32 = 48_000;
const SLOWEST_HZ: u32 = 8_000;
const FASTEST_HZ: u32 = 192_000;
/// Formats that we write, best first.
const FORMATS: [SampleFormat; 3] = [SampleFormat::F32, SampleFormat::I32, SampleFormat::I16];
/// Samples a channel that a card takes at once, where it may be asked: two such blocks are its
/// buffer, 21 ms at 48 kHz.
const BLOCK: u32 = 512;
/// Samples that are made at once, for formats that are not ours.
const MAX_AT_ONCE: usize = 4096;

/// A sound card that plays until it is dropped.
pub struct AudioOutput {
    name: String,
    frames: WaveFrames,
    failures: Receiver<String>,
    n_hiccups: Arc<AtomicU64>,
    // Ends the sound when dropped.
    _stream: Stream,
}

impl std::fmt::Debug for AudioOutput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AudioOutput")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl AudioOutput {
    /// The sound cards that take samples of a kind that we make.
    ///
    /// # Errors
    /// The system gives no list.
    pub fn list() -> Result<Vec<AudioEntry>, AudioError> {
        let entry = |device: &Device| {
            let configs = device.supported_output_configs().ok()?;
            let usable = configs.filter(|config| FORMATS.contains(&config.sample_format()));
            let n_channels = usable.map(|config| config.channels()).max()?;
            let name = name_of(device);
            Some(AudioEntry { name, n_channels })
        };
        Ok(devices()?.iter().filter_map(entry).collect())
    }

    /// Opens the card of this name, or the only one whose name holds it, for the contactors of
    /// arrays like `profile` on these channels. The thread that calls is woken at every tick.
    ///
    /// # Errors
    /// There is no such card, it has too few channels, or the system refuses.
    pub fn open(
        name: &str,
        profile: &ArrayProfile,
        channels: &CardChannels,
    ) -> Result<Self, AudioError> {
        let device = find(name)?;
        let name = name_of(&device);
        let (config, format) = config_of(&device, &name, channels.n_needed())?;
        let refused = |what: String| AudioError::System {
            name: name.clone(),
            what,
        };
        let maker = thread::current();
        let (frames, wave) = wave(config.sample_rate, (profile, channels), maker)
            .map_err(|error| refused(error.to_string()))?;
        let (sender, failures) = sync_channel(1);
        let n_hiccups = Arc::new(AtomicU64::new(0));
        let faults = (sender, Arc::clone(&n_hiccups));
        let stream = match format {
            SampleFormat::I32 => build::<i32>(&device, config, wave, faults),
            SampleFormat::I16 => build::<i16>(&device, config, wave, faults),
            _ => build::<f32>(&device, config, wave, faults),
        };
        let stream = stream.map_err(|error| refused(error.to_string()))?;
        stream.play().map_err(|error| refused(error.to_string()))?;
        Ok(Self {
            name,
            frames,
            failures,
            n_hiccups,
            _stream: stream,
        })
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it wants another frame.
    pub fn wants_frame(&self) -> bool {
        self.frames.wants_frame()
    }

    /// Plays a frame: amplitudes [A40, A320] of every contactor, µm.
    pub fn push(&mut self, amplitudes_um: &[[f32; 2]]) {
        self.frames.push(amplitudes_um);
    }

    /// A way to silence it.
    pub fn silencer(&self) -> Silencer {
        let shared = Arc::clone(self.frames.shared());
        Box::new(move || shared.silence())
    }

    /// How late what is felt was at most.
    pub fn latency(&self) -> AudioLatency {
        self.frames.shared().latency()
    }

    /// Ticks that began without a new frame.
    pub fn n_missed(&self) -> u64 {
        self.frames.n_missed()
    }

    /// How often the card ran dry or gave an error and went on.
    pub fn n_hiccups(&self) -> u64 {
        self.n_hiccups.load(Ordering::Relaxed)
    }

    /// What broke it, if something did.
    pub fn failure(&self) -> Option<AudioError> {
        let what = self.failures.try_recv().ok()?;
        Some(AudioError::System {
            name: self.name.clone(),
            what,
        })
    }
}

fn devices() -> Result<Vec<Device>, AudioError> {
    let refused = |error: cpal::Error| AudioError::System {
        name: "audio".to_owned(),
        what: error.to_string(),
    };
    let found = cpal::default_host().output_devices().map_err(refused)?;
    Ok(found.collect())
}

fn name_of(device: &Device) -> String {
    let described = device.description();
    described.map_or_else(|_| String::new(), |words| words.name().to_owned())
}

fn find(name: &str) -> Result<Device, AudioError> {
    let wanted = name.to_lowercase();
    let devices = devices()?;
    if let Some(exact) = devices.iter().find(|device| name_of(device) == name) {
        return Ok(exact.clone());
    }
    let mut like = devices
        .into_iter()
        .filter(|device| name_of(device).to_lowercase().contains(&wanted));
    let unknown = |what| AudioError::Unknown {
        what,
        name: name.to_owned(),
    };
    let found = like.next().ok_or_else(|| unknown("no"))?;
    match like.next() {
        None => Ok(found),
        Some(_) => Err(unknown("more than one")),
    }
}

/// The fewest channels that suffice, in the best format, at 48 kHz or the rate nearest to it.
fn config_of(
    device: &Device,
    name: &str,
    n_needed: usize,
) -> Result<(StreamConfig, SampleFormat), AudioError> {
    let refused = || AudioError::Channels {
        name: name.to_owned(),
        n_channels: n_needed,
    };
    let configs = device
        .supported_output_configs()
        .map_err(|_closed| refused())?;
    let usable = configs.filter_map(|config| {
        let rank = FORMATS
            .iter()
            .position(|format| *format == config.sample_format())?;
        let rate_hz = BEST_RATE_HZ.clamp(config.min_sample_rate(), config.max_sample_rate());
        let is_usable = usize::from(config.channels()) >= n_needed
            && (SLOWEST_HZ..=FASTEST_HZ).contains(&rate_hz);
        is_usable.then_some((config, rank, rate_hz))
    });
    let (config, _, rate_hz) = usable
        .min_by_key(|(config, rank, rate_hz)| {
            (rate_hz.abs_diff(BEST_RATE_HZ), config.channels(), *rank)
        })
        .ok_or_else(refused)?;
    let format = config.sample_format();
    let buffer_size = match *config.buffer_size() {
        SupportedBufferSize::Range { min, max } if (min..=max).contains(&BLOCK) => {
            BufferSize::Fixed(BLOCK)
        }
        _ => BufferSize::Default,
    };
    let mut config = config.with_sample_rate(rate_hz).config();
    config.buffer_size = buffer_size;
    Ok((config, format))
}

fn build<T: SizedSample + FromSample<f32>>(
    device: &Device,
    config: StreamConfig,
    mut wave: Wave,
    (failures, n_hiccups): (SyncSender<String>, Arc<AtomicU64>),
) -> Result<Stream, cpal::Error> {
    let n_outputs = usize::from(config.channels);
    let n_at_once = MAX_AT_ONCE.max(n_outputs) / n_outputs * n_outputs;
    let mut block = vec![0.0; n_at_once];
    let play = move |out: &mut [T], info: &OutputCallbackInfo| {
        let moment = info.timestamp();
        let delay = moment.playback.saturating_duration_since(moment.callback);
        wave.begin_block(delay, out.len() / n_outputs);
        for part in out.chunks_mut(n_at_once) {
            let samples = &mut block[..part.len()];
            wave.fill(samples, n_outputs);
            for (slot, sample) in part.iter_mut().zip(samples) {
                *slot = T::from_sample(*sample);
            }
        }
    };
    let fail = move |error: cpal::Error| {
        // Sound servers give errors and go on; one that does not takes no more samples, which
        // whoever makes frames sees.
        if error.kind() == cpal::ErrorKind::DeviceNotAvailable {
            drop(failures.try_send(error.to_string()));
        } else {
            n_hiccups.fetch_add(1, Ordering::Relaxed);
        }
    };
    device.build_output_stream(config, play, fail, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_card_that_is_not_there_is_refused_by_name() {
        let profile = ArrayProfile::default();
        let opened = AudioOutput::open("no card of this name", &profile, &CardChannels::first(24));
        let text = opened.unwrap_err().to_string();
        assert!(
            text.contains("no card of this name") || text.contains("audio"),
            "{text}"
        );
        assert_eq!(text.lines().count(), 1, "{text}");
    }
}
