//! What a sound card plays: frames as a waveform that starts softly, keeps its limits and falls
//! silent within 100 ms when frames stop. No card, no clock: time is samples.
//!
//! Frames come as drive codes, so limits and the rule that both carriers together stay within full
//! scale are those of any device; a sample beyond ±1 cannot come out. A frame is held for 60 ms
//! after it was taken, then the gain falls to 0 within 40 ms; so it does at a stop. After silence
//! the gain begins anew, over 500 ms.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::Thread;
use std::time::Duration;

use rtrb::{Consumer, Producer, RingBuffer};

use super::latency::Latency;
use super::{AudioLatency, CardChannels};
use selvedge_device::{ArrayProfile, Coder, FULL_CODE};
use selvedge_render::RenderError;
use selvedge_render::array::DriveSynth;

/// Frames on the way: what a card takes at once, and some.
const MAX_FRAMES: usize = 8;
/// Frames that are kept waiting: a card that takes 2048 samples at once begins two ticks in them.
const DEPTH: usize = 3;
/// How long a frame is held, s.
const HOLD_S: f64 = 0.060;
/// How long the fall to silence takes, s.
const RAMP_S: f64 = 0.040;
/// How long the soft start takes, s.
const SOFT_START_S: f64 = 0.5;

/// What both ends know.
#[derive(Debug)]
pub(super) struct Shared {
    is_stopped: AtomicBool,
    is_silent: AtomicBool,
    n_missed: AtomicU64,
    latency: Latency,
}

impl Shared {
    /// Ramps to silence; frames are not heard any more. Once it is reached: how long the card still
    /// plays what it has taken.
    pub(super) fn silence(&self) -> Option<Duration> {
        self.is_stopped.store(true, Ordering::Release);
        let is_silent = self.is_silent.load(Ordering::Acquire);
        is_silent.then(|| self.latency.told().card)
    }

    pub(super) fn latency(&self) -> AudioLatency {
        self.latency.told()
    }
}

/// The end that takes frames.
#[derive(Debug)]
pub(super) struct WaveFrames {
    ring: Producer<[u16; 2]>,
    /// When each frame was handed over, as the card's samples.
    stamps: Producer<u64>,
    coder: Coder,
    codes: Vec<[u16; 2]>,
    shared: Arc<Shared>,
}

/// The end that a card asks for samples.
#[derive(Debug)]
pub(super) struct Wave {
    ring: Consumer<[u16; 2]>,
    stamps: Consumer<u64>,
    channels: CardChannels,
    shared: Arc<Shared>,
    maker: Thread,
    synth: DriveSynth,
    /// Shares of full scale of the frame that sounds.
    shares: Vec<[f32; 2]>,
    block: Vec<f32>,
    tick: u64,
    rate_hz: f64,
    /// How long after the card asked for a block it plays it, samples.
    delay: u64,
    /// Samples since the last frame was taken; `None` before the first.
    age: Option<u64>,
    /// The gain of the soft start and of the silence, 0…1.
    start: f64,
    mute: f64,
}

/// Both ends, at `rate_hz` for the contactors of arrays like `profile` on these channels; `maker`
/// is woken at every tick. The wiring of a profile is that of a bridge and has no say here.
///
/// # Errors
/// The rate makes no waveform.
pub(super) fn wave(
    rate_hz: u32,
    (profile, channels): (&ArrayProfile, &CardChannels),
    maker: Thread,
) -> Result<(WaveFrames, Wave), RenderError> {
    let n_contactors = channels.n_contactors();
    let unwired = ArrayProfile {
        wiring: None,
        ..profile.clone()
    };
    let synth = DriveSynth::prepare(rate_hz, n_contactors, 1.0)?;
    let (sender, ring) = RingBuffer::new(MAX_FRAMES * n_contactors);
    let (stamp_sender, stamps) = RingBuffer::new(MAX_FRAMES);
    let shared = Arc::new(Shared {
        is_stopped: AtomicBool::new(false),
        is_silent: AtomicBool::new(false),
        n_missed: AtomicU64::new(0),
        latency: Latency::new(rate_hz),
    });
    let frames = WaveFrames {
        ring: sender,
        stamps: stamp_sender,
        coder: Coder::new(&unwired, n_contactors),
        codes: vec![[0; 2]; n_contactors],
        shared: Arc::clone(&shared),
    };
    let wave = Wave {
        ring,
        stamps,
        channels: channels.clone(),
        shared,
        maker,
        block: vec![0.0; n_contactors * longest_tick(&synth)],
        synth,
        shares: vec![[0.0; 2]; n_contactors],
        tick: 0,
        rate_hz: f64::from(rate_hz),
        delay: 0,
        age: None,
        start: 0.0,
        mute: 0.0,
    };
    Ok((frames, wave))
}

/// Samples of the longest tick.
fn longest_tick(synth: &DriveSynth) -> usize {
    let samples = synth.samples_of_tick(0);
    usize::try_from(samples.end - samples.start).map_or(1, |n| n + 1)
}

impl WaveFrames {
    /// Whether another frame is wanted.
    pub(super) fn wants_frame(&self) -> bool {
        let n_waiting = MAX_FRAMES - self.ring.slots() / self.codes.len();
        n_waiting < DEPTH
    }

    /// Hands over a frame: amplitudes [A40, A320], µm. One that finds no room is dropped.
    pub(super) fn push(&mut self, amplitudes_um: &[[f32; 2]]) {
        self.coder.encode_into(amplitudes_um, 1.0, &mut self.codes);
        // The stamp goes first, so that every frame that is seen has its own.
        if let Ok(chunk) = self.ring.write_chunk_uninit(self.codes.len())
            && self.stamps.push(self.shared.latency.stamp()).is_ok()
        {
            chunk.fill_from_iter(self.codes.iter().copied());
        }
    }

    /// What both ends know.
    pub(super) fn shared(&self) -> &Arc<Shared> {
        &self.shared
    }

    /// Ticks that began without a new frame.
    pub(super) fn n_missed(&self) -> u64 {
        self.shared.n_missed.load(Ordering::Relaxed)
    }
}

impl Wave {
    /// The card asks for a block of so many samples a channel, and will play it after `delay`.
    pub(super) fn begin_block(&mut self, delay: Duration, n_samples: usize) {
        let latency = &self.shared.latency;
        self.delay = latency.samples(delay);
        let n_samples = u64::try_from(n_samples).unwrap_or(u64::MAX);
        let next = self.synth.next_sample().saturating_add(n_samples);
        latency.block_taken(next, n_samples, self.delay);
    }

    /// Writes whole frames of `n_outputs` channels: contactors on theirs, silence in the others.
    /// Neither allocates, locks nor fails.
    pub(super) fn fill(&mut self, out: &mut [f32], n_outputs: usize) {
        let n_channels = self.shares.len();
        if n_outputs < self.channels.n_needed() {
            return out.fill(0.0);
        }
        let mut outputs = out.chunks_exact_mut(n_outputs);
        while outputs.len() > 0 {
            let of_tick = self.synth.samples_of_tick(self.tick);
            if self.synth.next_sample() == of_tick.start {
                self.begin_tick();
            }
            let left = usize::try_from(of_tick.end - self.synth.next_sample()).unwrap_or(0);
            let n_frames = left.min(outputs.len()).max(1);
            let mut block = std::mem::take(&mut self.block);
            let samples = &mut block[..n_frames * n_channels];
            self.synth.fill(samples);
            for frame in samples.chunks_exact(n_channels) {
                let gain = self.next_gain();
                if let Some(output) = outputs.next() {
                    let samples = frame.iter().map(|sample| (sample * gain).clamp(-1.0, 1.0));
                    self.channels.spread(samples, output);
                }
            }
            self.block = block;
            if self.synth.next_sample() >= of_tick.end {
                self.tick += 1;
            }
        }
        outputs.into_remainder().fill(0.0);
    }

    /// Takes the next frame, if there is one.
    fn begin_tick(&mut self) {
        self.maker.unpark();
        let is_stopped = self.shared.is_stopped.load(Ordering::Acquire);
        let n_channels = self.shares.len();
        match self.ring.read_chunk(n_channels) {
            Ok(chunk) if !is_stopped => {
                let share = |code: u16| f32::from(code) / f32::from(FULL_CODE);
                for (slot, codes) in self.shares.iter_mut().zip(chunk) {
                    *slot = codes.map(share);
                }
                self.age = Some(0);
                if let Ok(stamp) = self.stamps.pop() {
                    let sample = self.synth.next_sample();
                    self.shared.latency.frame_taken(stamp, sample, self.delay);
                }
            }
            _ if self.age.is_some() && !is_stopped => {
                self.shared.n_missed.fetch_add(1, Ordering::Relaxed);
            }
            _ => {}
        }
        self.synth.set_amplitudes(&self.shares);
    }

    /// The gain of the next sample.
    fn next_gain(&mut self) -> f32 {
        let is_stopped = self.shared.is_stopped.load(Ordering::Relaxed);
        let held = self
            .age
            .filter(|&age| !is_stopped && age as f64 <= HOLD_S * self.rate_hz);
        self.age = self.age.map(|age| age.saturating_add(1));
        let step = 1.0 / (RAMP_S * self.rate_hz);
        if held.is_some() {
            self.mute = (self.mute + step).min(1.0);
            self.start = (self.start + 1.0 / (SOFT_START_S * self.rate_hz)).min(1.0);
        } else {
            self.mute = (self.mute - step).max(0.0);
        }
        let is_silent = self.mute <= 0.0;
        if is_silent {
            // What comes after silence begins softly.
            self.start = 0.0;
        }
        self.shared.is_silent.store(is_silent, Ordering::Release);
        single(self.mute * self.start)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a gain of 0…1")]
fn single(gain: f64) -> f32 {
    gain as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: u32 = 48_000;
    const TICK: usize = 1200;

    fn both(n_contactors: usize) -> (WaveFrames, Wave) {
        let maker = std::thread::current();
        let channels = CardChannels::first(n_contactors);
        wave(RATE_HZ, (&ArrayProfile::default(), &channels), maker).unwrap()
    }

    /// The samples of so many ticks, a frame of `um` each while there are frames.
    fn play(ends: &mut (WaveFrames, Wave), um: Option<[f32; 2]>, n_ticks: usize) -> Vec<f32> {
        let (frames, wave) = ends;
        let n = frames.codes.len();
        let mut all = Vec::new();
        for _ in 0..n_ticks {
            if let Some(um) = um {
                frames.push(&vec![um; n]);
            }
            let mut block = vec![9.0; TICK * n];
            // Cards ask for what they like.
            for part in block.chunks_mut(100 * n) {
                wave.fill(part, n);
            }
            all.extend(block);
        }
        all
    }

    fn peak(samples: &[f32]) -> f32 {
        samples
            .iter()
            .fold(0.0, |peak, sample| peak.max(sample.abs()))
    }

    #[test]
    fn it_starts_softly_and_reaches_the_amplitude_after_half_a_second() {
        let mut ends = both(1);
        let samples = play(&mut ends, Some([25.0, 0.0]), 40);
        let tenth = peak(&samples[..TICK * 2]);
        assert!(tenth < 0.06, "{tenth}");
        let quarter = peak(&samples[9 * TICK..10 * TICK]);
        assert!((0.2..0.26).contains(&quarter), "{quarter}");
        let full = peak(&samples[20 * TICK..]);
        assert!((full - 0.5).abs() < 1e-3, "{full}");
    }

    #[test]
    fn it_is_silent_100_ms_after_the_last_frame_and_never_jumps() {
        let mut ends = both(1);
        let before = play(&mut ends, Some([50.0, 0.0]), 40);
        let after = play(&mut ends, None, 12);
        assert!(peak(&before[39 * TICK..]) > 0.99);
        // The last frame was taken when the last tick of `before` began.
        let held = &after[..TICK];
        assert!(peak(held) > 0.99, "{}", peak(held));
        assert_eq!(peak(&after[3 * TICK..]), 0.0);
        let all = [before, after].concat();
        let slope = 2.0 * std::f32::consts::PI * 40.0 / 48_000.0;
        for pair in all.windows(2) {
            // The ramp adds 1 over 40 ms.
            assert!((pair[1] - pair[0]).abs() < slope + 6e-4, "{pair:?}");
        }
        assert_eq!(ends.0.n_missed(), 12);
        let again = play(&mut ends, Some([50.0, 0.0]), 2);
        assert!(peak(&again) < 0.12, "after silence it starts softly again");
    }

    #[test]
    fn a_stop_is_silent_within_40_ms_and_stays_so() {
        let mut ends = both(2);
        play(&mut ends, Some([20.0, 20.0]), 40);
        assert_eq!(ends.0.shared().silence(), None, "it falls");
        let after = play(&mut ends, Some([20.0, 20.0]), 40);
        assert_eq!(peak(&after[2 * 2 * TICK..]), 0.0);
        assert_eq!(ends.0.shared().silence(), Some(Duration::ZERO));
    }

    #[test]
    fn nothing_is_louder_than_full_scale_or_no_number() {
        let mut ends = both(1);
        for um in [
            [500.0, 500.0],
            [f32::NAN, 50.0],
            [f32::INFINITY, -3.0],
            [50.0, 50.0],
        ] {
            let samples = play(&mut ends, Some(um), 30);
            assert!(
                samples.iter().all(|s| s.is_finite() && s.abs() <= 1.0),
                "{um:?}"
            );
        }
    }

    #[test]
    fn contactors_come_first_and_other_channels_are_silent() {
        let (mut frames, mut wave) = both(2);
        for _ in 0..3 {
            frames.push(&[[50.0, 0.0], [0.0, 50.0]]);
        }
        assert!(!frames.wants_frame());
        let mut out = vec![7.0; 3 * TICK * 4 + 3];
        wave.fill(&mut out, 4);
        assert!(frames.wants_frame());
        for frame in out[..3 * TICK * 4].chunks_exact(4) {
            assert_eq!(frame[2..], [0.0, 0.0]);
        }
        assert_eq!(out[3 * TICK * 4..], [0.0; 3], "no whole frame");
        let of = |channel: usize| {
            out.chunks_exact(4)
                .map(|f| f[channel].abs())
                .fold(0.0, f32::max)
        };
        assert!(of(0) > 0.05 && of(1) > 0.05);
        let mut few = [1.0; 8];
        wave.fill(&mut few, 1);
        assert_eq!(few, [0.0; 8], "a card with too few channels plays nothing");
    }

    /// A card that takes blocks of so many samples and plays them so many later: how old frames
    /// become, and what is in the card, samples.
    fn told_by(block: usize, delay: u32) -> AudioLatency {
        let (mut frames, mut wave) = both(1);
        let delay = Duration::from_secs(1) * delay / RATE_HZ;
        let mut out = vec![0.0; block];
        for _ in 0..200_000 / block {
            while frames.wants_frame() {
                frames.push(&[[1.0, 1.0]]);
            }
            wave.begin_block(delay, block);
            wave.fill(&mut out, 1);
        }
        assert_eq!(frames.n_missed(), 0);
        frames.shared().latency()
    }

    #[test]
    fn the_latency_is_the_wait_of_three_frames_and_the_cards_buffers() {
        let ms = Duration::from_millis;
        // A tick at a time: two frames are before it, and it waits for its own tick.
        let tick = told_by(TICK, 0);
        assert_eq!((tick.total, tick.card), (ms(50), ms(25)));
        let later = told_by(TICK, 4800);
        assert_eq!((later.total, later.card), (ms(150), ms(125)));
        // Small blocks: no frame waits longer than three ticks, and a block is 10 ms.
        let small = told_by(480, 480);
        assert!(small.total > ms(60) && small.total <= ms(85), "{small:?}");
        assert_eq!(small.card, ms(20));
    }

    #[test]
    fn the_wiring_of_a_bridge_has_no_say_on_a_card() {
        let wired = ArrayProfile {
            wiring: Some(selvedge_device::Wiring {
                device_uid: selvedge_device::DeviceUid([1; 12]),
                channels: vec![1, 0],
            }),
            ..ArrayProfile::default()
        };
        let channels: CardChannels = "4,1".parse().unwrap();
        let maker = std::thread::current();
        let (mut frames, mut wave) = wave(RATE_HZ, (&wired, &channels), maker).unwrap();
        for _ in 0..3 {
            frames.push(&[[50.0, 0.0], [0.0, 0.0]]);
        }
        let mut out = vec![7.0; 3 * TICK * 4];
        wave.fill(&mut out, 4);
        for frame in out.chunks_exact(4) {
            assert_eq!(frame[..3], [0.0; 3]);
        }
        assert!(out.iter().any(|sample| sample.abs() > 0.05));
    }
}
