//! Sound of what is felt: amplitudes as they leave the limits, for two ears.
//!
//! Each side hears the rms over the contactors, `E_b = √(2/N Σ_c g_c² A_c,b²)`, with the
//! equal-power pan `g` by the place of the finger in the workspace and of the contactor under it;
//! `E` follows the ticks by a raised cosine, since steps rattle. 320 Hz sounds as it is. 40 Hz is
//! lost by small speakers and ears, so its overtones 2 to 7 stand for it, at 1/k; `8 × 40 = 320`
//! keeps both in tune. *As driven* plays 40 and 320 Hz themselves.
//!
//! A period of 40 Hz is a tick of 1200 samples: carriers are tables of one tick, and all of them
//! cross zero where amplitudes take effect.

use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rtrb::{Consumer, Producer, RingBuffer};
use triple_buffer::{Input, Output, triple_buffer};

use super::player::{SOUND_RATE_HZ, SoundSource};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_render::array::single;

/// Samples of a tick.
const TICK: usize = SOUND_RATE_HZ as usize / 40;
/// How far the finger and its contactors pan, of 1.
const PAN_FINGER: f64 = 0.6;
const PAN_CONTACTOR: f64 = 0.3;
/// What sounds at its level, µm and dB re full scale, peak of a sine of 320 Hz.
const REFERENCE_UM: f64 = 8.0;
const REFERENCE_DB: f64 = -27.0;
/// The overtones of 40 Hz that stand for it, and how much louder all together are than a sine, dB.
const OVERTONES: std::ops::RangeInclusive<u32> = 2..=7;
const OVERTONES_DB: f64 = 6.0;
/// Where loud sounds begin to be pressed, and what none exceeds: −12 and −6 dB re full scale.
const KNEE: f32 = 0.251_188_64;
const CEILING: f32 = 0.501_187_2;
/// More is no amplitude, µm.
const MAX_UM: f64 = 1e4;
/// Ticks on the way, and those that may wait: a block of sound takes two or three at once.
const MAX_TICKS: usize = 16;
const WAITING: usize = 2;
/// Ticks that may fail to come before it fades: the engine and the card have clocks of their own.
const HELD_TICKS: u32 = 3;

/// How strong `[40 Hz, 320 Hz]` are on the left and on the right, µm.
pub type StereoLevels = [[f32; 2]; 2];

/// What each side hears of a display: of all its contactors, or of one `alone`.
///
/// Told are where its middle is and where that of the workspace, and of each contactor where it is,
/// mm, and its amplitudes `[A40, A320]`, µm. What is no amplitude is 0.
pub fn stereo_levels(
    [middle_mm, centre_mm]: [f64; 2],
    contactors: impl ExactSizeIterator<Item = (f64, [f32; 2])> + Clone,
    alone: Option<usize>,
) -> StereoLevels {
    let share = |x: f64, of: f64| match x / of.max(1e-9) {
        share if share.is_nan() => 0.0,
        share => share.clamp(-1.0, 1.0),
    };
    let finger = share(middle_mm - centre_mm, centre_mm);
    let places = contactors.clone().map(|(x_mm, _)| (x_mm - middle_mm).abs());
    let widest_mm = places.fold(0.0, f64::max);
    let n_heard = match alone {
        Some(_) => 1,
        None => contactors.len().max(1),
    };
    let mut power = [[0.0; 2]; 2];
    for (index, (x_mm, amplitudes_um)) in contactors.enumerate() {
        if alone.is_some_and(|alone| alone != index) {
            continue;
        }
        let pan = PAN_FINGER * finger + PAN_CONTACTOR * share(x_mm - middle_mm, widest_mm);
        let (right, left) = ((pan + 1.0) * FRAC_PI_4).sin_cos();
        for (side, gain) in power.iter_mut().zip([left, right]) {
            for (sum, um) in side.iter_mut().zip(amplitudes_um) {
                let um = f64::from(um);
                let um = if um.is_finite() {
                    um.clamp(0.0, MAX_UM)
                } else {
                    0.0
                };
                *sum += (gain * um).powi(2);
            }
        }
    }
    power.map(|side| side.map(|sum: f64| single((2.0 * sum / n_heard as f64).sqrt())))
}

/// The engine's end: what is felt at every tick.
#[derive(Debug)]
pub struct SoundFeed {
    ring: Producer<StereoLevels>,
    choices: Arc<Choices>,
}

impl SoundFeed {
    /// Hands over a tick; one that finds no room is lost.
    pub(crate) fn push(&mut self, levels: StereoLevels) {
        let _full = self.ring.push(levels);
    }

    /// The contactor that alone is heard.
    pub(crate) fn alone(&self) -> Option<usize> {
        let alone = self.choices.alone.load(Ordering::Relaxed);
        Some(alone).filter(|alone| *alone != ALL)
    }
}

/// What is chosen while it plays.
#[derive(Debug)]
struct Choices {
    as_driven: AtomicBool,
    alone: AtomicUsize,
}

/// No contactor alone.
const ALL: usize = usize::MAX;

/// The end of whoever chooses what is heard.
#[derive(Debug)]
pub struct SoundControl {
    choices: Arc<Choices>,
    scrub: Input<Option<StereoLevels>>,
}

impl SoundControl {
    /// Whether 40 Hz itself sounds in place of its overtones; which contactor alone is heard.
    pub fn choose(&self, as_driven: bool, alone: Option<usize>) {
        self.choices.as_driven.store(as_driven, Ordering::Relaxed);
        let alone = alone.unwrap_or(ALL);
        self.choices.alone.store(alone, Ordering::Relaxed);
    }

    /// Lets another moment be heard in place of what is felt, until there is none.
    pub fn scrub(&mut self, moment: Option<StereoLevels>) {
        self.scrub.write(moment);
    }
}

/// The sound of what is felt.
#[derive(Debug)]
pub struct Sonifier {
    ring: Consumer<StereoLevels>,
    scrubbed: Output<Option<StereoLevels>>,
    choices: Arc<Choices>,
    carriers: Carriers,
    /// The levels at the beginning and at the end of this tick.
    from: StereoLevels,
    to: StereoLevels,
    /// Whether 40 Hz itself sounds in this tick.
    is_literal: bool,
    /// The next sample of the tick.
    at: usize,
    /// Ticks that did not come, one after the other.
    n_missed: u32,
}

/// The ends of one sound.
pub fn sonification() -> (SoundFeed, Sonifier, SoundControl) {
    let (felt, ring) = RingBuffer::new(MAX_TICKS);
    let (scrub, scrubbed) = triple_buffer(&None);
    let choices = Arc::new(Choices {
        as_driven: AtomicBool::new(false),
        alone: AtomicUsize::new(ALL),
    });
    let sonifier = Sonifier {
        ring,
        scrubbed,
        choices: Arc::clone(&choices),
        carriers: Carriers::new(),
        from: StereoLevels::default(),
        to: StereoLevels::default(),
        is_literal: false,
        at: 0,
        n_missed: HELD_TICKS,
    };
    let feed = SoundFeed {
        ring: felt,
        choices: Arc::clone(&choices),
    };
    (feed, sonifier, SoundControl { choices, scrub })
}

impl Sonifier {
    fn begin_tick(&mut self) {
        self.from = self.to;
        self.is_literal = self.choices.as_driven.load(Ordering::Relaxed);
        let scrubbed = *self.scrubbed.read();
        // What piled up while nobody asked is old; all of it is while another moment is heard.
        let n_waiting = self.ring.slots();
        let n_left = if scrubbed.is_some() { 0 } else { WAITING - 1 };
        let n_taken = n_waiting.saturating_sub(n_left).max(n_waiting.min(1));
        let chunk = self.ring.read_chunk(n_taken).ok();
        let felt = chunk.and_then(|chunk| chunk.into_iter().last());
        if let Some(levels) = scrubbed.or(felt) {
            (self.to, self.n_missed) = (levels, 0);
            return;
        }
        self.n_missed = self.n_missed.saturating_add(1);
        if self.n_missed > HELD_TICKS {
            self.to = StereoLevels::default();
        }
    }
}

impl SoundSource for Sonifier {
    fn fill(&mut self, frames: &mut [[f32; 2]]) {
        for frame in frames {
            if self.at == 0 {
                self.begin_tick();
            }
            let Carrier { rise, waves } = &self.carriers.0[self.at];
            let [overtones, literal, high] = *waves;
            let low = if self.is_literal { literal } else { overtones };
            let sides = self.from.iter().zip(&self.to);
            for (sample, (from, to)) in frame.iter_mut().zip(sides) {
                let level = |band: usize| from[band] + rise * (to[band] - from[band]);
                *sample = pressed(level(0) * low + level(1) * high);
            }
            self.at = (self.at + 1) % TICK;
        }
    }
}

/// A sample of a tick: how far the level has come, and carriers of 1 µm.
#[derive(Debug, Clone, Copy)]
struct Carrier {
    rise: f32,
    /// The overtones, 40 Hz and 320 Hz.
    waves: [f32; 3],
}

#[derive(Debug)]
struct Carriers(Vec<Carrier>);

impl Carriers {
    fn new() -> Self {
        let per_um = factor_of_gain(REFERENCE_DB) / REFERENCE_UM;
        let power: f64 = OVERTONES.map(|k| f64::from(k).powi(-2)).sum();
        let louder = factor_of_gain(OVERTONES_DB) / power.sqrt();
        let of_sample = |n: usize| {
            let share = n as f64 / TICK as f64;
            let wave = |k: u32| (TAU * f64::from(k) * share).sin();
            let overtones: f64 = OVERTONES.map(|k| wave(k) / f64::from(k)).sum();
            Carrier {
                rise: single(0.5 - 0.5 * (PI * share).cos()),
                waves: [louder * overtones, wave(1), wave(8)].map(|x| single(per_um * x)),
            }
        };
        Self((0..TICK).map(of_sample).collect())
    }
}

/// Within the ceiling: as it is below the knee, then ever less.
fn pressed(x: f32) -> f32 {
    if x.abs() <= KNEE {
        return x;
    }
    let room = CEILING - KNEE;
    (KNEE + room * ((x.abs() - KNEE) / room).tanh()).copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use selvedge_foundation::numerics::{Complex, RealTransform};

    /// What is heard of these ticks, in blocks as a server asks for them.
    fn heard(ticks: &[StereoLevels], is_literal: bool) -> Vec<[f32; 2]> {
        let (mut feed, mut sonifier, control) = sonification();
        control.choose(is_literal, None);
        let mut all = Vec::new();
        for tick in ticks {
            feed.push(*tick);
            let mut block = vec![[9.0; 2]; TICK];
            for part in block.chunks_mut(331) {
                sonifier.fill(part);
            }
            all.extend(block);
        }
        all
    }

    fn peak(frames: &[[f32; 2]]) -> f32 {
        let samples = frames.iter().flatten();
        samples.fold(0.0, |peak, x| peak.max(x.abs()))
    }

    /// Amplitude of the left side at these frequencies, of whole seconds.
    fn amplitudes(frames: &[[f32; 2]], hz: &[usize]) -> Vec<f64> {
        let left: Vec<f64> = frames.iter().map(|frame| f64::from(frame[0])).collect();
        let (n, n_s) = (left.len(), left.len() / SOUND_RATE_HZ as usize);
        let spectrum = RealTransform::new(n).forward(&left);
        let of = |hz: &usize| 2.0 * spectrum[hz * n_s].norm() / n as f64;
        hz.iter().map(of).collect()
    }

    fn steady(um: [f32; 2]) -> Vec<[f32; 2]> {
        heard(&[[um; 2]; 80], false).split_off(40 * TICK)
    }

    #[test]
    fn high_is_320_hz_at_27_db_below_full_scale_and_low_its_overtones() {
        let level = factor_of_gain(-27.0);
        let high = amplitudes(&steady([0.0, 8.0]), &[320, 40, 160, 640, 960]);
        assert!((high[0] - level).abs() < 1e-6, "{high:?}");
        assert!(high[1..].iter().all(|a| *a < 1e-6), "{high:?}");
        let hz: Vec<usize> = (1..=9).map(|k| 40 * k).collect();
        let low = amplitudes(&steady([4.0, 0.0]), &hz);
        assert!(low[0] < 1e-6 && low[7] < 1e-6 && low[8] < 1e-6, "{low:?}");
        for (k, found) in (1..).zip(&low[..7]).skip(1) {
            let expected = low[1] * 2.0 / f64::from(k);
            assert!((found - expected).abs() < 1e-6, "{low:?}");
        }
        let rms = low.iter().map(|a| a * a).sum::<f64>().sqrt();
        let louder_db = 20.0 * (rms / (level / 2.0)).log10();
        assert!((louder_db - 6.0).abs() < 1e-3, "{louder_db}");
    }

    #[test]
    fn as_driven_is_40_and_320_hz_alone() {
        let frames = heard(&[[[4.0, 8.0]; 2]; 80], true).split_off(40 * TICK);
        let found = amplitudes(&frames, &[40, 320, 80, 120, 240]);
        let level = factor_of_gain(-27.0);
        assert!((found[0] - level / 2.0).abs() < 1e-6 && (found[1] - level).abs() < 1e-6);
        assert!(found[2..].iter().all(|a| *a < 1e-6), "{found:?}");
    }

    #[test]
    fn levels_that_change_with_every_tick_do_not_rattle() {
        // A finger that strokes to and fro, three times a second.
        let swing = |n: usize| 1.0 + (TAU * 3.0 * n as f64 / 40.0).sin();
        let tick = |n: usize| [[single(3.0 * swing(n)), single(4.0 * swing(n + 5))]; 2];
        let ticks: Vec<StereoLevels> = (0..160).map(tick).collect();
        // Whole periods, as a spectrum wants them.
        let frames = heard(&ticks, false).split_off(80 * TICK);
        let left: Vec<f64> = frames.iter().map(|frame| f64::from(frame[0])).collect();
        let steps = left.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let (mut between, mut within) = (0.0_f64, 0.0_f64);
        for (n, step) in steps.enumerate() {
            let most = if n % TICK == TICK - 1 {
                &mut between
            } else {
                &mut within
            };
            *most = most.max(step);
        }
        assert!(between <= within, "{between} {within}");
        let spectrum = RealTransform::new(left.len()).forward(&left);
        let power = |from: usize, to: usize| -> f64 {
            spectrum[from..to].iter().map(Complex::norm_sqr).sum()
        };
        // Two seconds: half a Hz a line.
        let above_1_khz_db = 10.0 * (power(2000, 48_000) / power(0, 2000)).log10();
        assert!(above_1_khz_db < -100.0, "{above_1_khz_db} dB");
    }

    #[test]
    fn it_fades_when_ticks_stop_or_are_silent_and_old_ones_are_left_out() {
        let (mut feed, mut sonifier, _) = sonification();
        let mut block = [[0.0; 2]; TICK];
        for _ in 0..10 {
            feed.push([[8.0; 2]; 2]);
            sonifier.fill(&mut block);
        }
        assert!(peak(&block) > 0.05);
        for n in 0..6 {
            sonifier.fill(&mut block);
            assert_eq!(peak(&block) > 0.0, n < 4, "tick {n}");
        }
        // While nobody asked, much piled up; silence comes last.
        for n in 0..MAX_TICKS {
            let um = if n < MAX_TICKS - 3 { 8.0 } else { 0.0 };
            feed.push([[um; 2]; 2]);
        }
        sonifier.fill(&mut block);
        assert_eq!(peak(&block), 0.0, "it goes on with the newest");
    }

    #[test]
    fn another_moment_is_heard_in_place_of_what_is_felt_until_there_is_none() {
        let (mut feed, mut sonifier, mut control) = sonification();
        let mut block = vec![[0.0; 2]; 10 * TICK];
        let mut last_tick = |feed: &mut SoundFeed, felt_um: f32| {
            for part in block.chunks_mut(TICK) {
                feed.push([[0.0, felt_um]; 2]);
                sonifier.fill(part);
            }
            peak(&block[9 * TICK..])
        };
        let um = |peak: f32| f64::from(peak) / factor_of_gain(REFERENCE_DB) * REFERENCE_UM;
        assert!((um(last_tick(&mut feed, 3.0)) - 3.0).abs() < 0.01);
        control.scrub(Some([[0.0, 7.0]; 2]));
        assert!((um(last_tick(&mut feed, 3.0)) - 7.0).abs() < 0.01);
        control.scrub(Some([[0.0; 2]; 2]));
        assert_eq!(last_tick(&mut feed, 3.0), 0.0);
        control.scrub(None);
        last_tick(&mut feed, 0.0);
        assert_eq!(peak(&block), 0.0, "what was felt meanwhile is old");
    }

    #[test]
    fn both_sides_are_alike_in_the_middle_and_each_is_louder_on_its_own() {
        let row = |middle_mm: f64| [-3.0, -1.0, 1.0, 3.0].map(|x| (middle_mm + x, [2.0, 5.0]));
        let [left, right] = stereo_levels([130.0; 2], row(130.0).into_iter(), None);
        for (left, right) in left.into_iter().zip(right) {
            assert!((left - right).abs() < 1e-6);
        }
        assert!((left[1] - 5.0).abs() < 1e-5, "the rms of all of them");
        let [left, right] = stereo_levels([0.0, 130.0], row(0.0).into_iter(), None);
        assert!(left[0] > 2.0 * right[0] && right[0] > 0.0);
        let nobody = std::iter::empty();
        assert_eq!(stereo_levels([0.0, 130.0], nobody, None), [[0.0; 2]; 2]);
    }

    #[test]
    fn a_contactor_alone_is_as_loud_as_it_is_at_its_place_and_no_other_is_heard() {
        let row = [(-3.0, [9.0, 9.0]), (0.0, [2.0, 5.0]), (3.0, [4.0, 0.0])].into_iter();
        let alone = |index| stereo_levels([0.0, 130.0], row.clone(), Some(index));
        let within = |x: f32, y: f32| (x - y).abs() < 1e-5;
        let mono = |[left, right]: StereoLevels, band: usize| {
            f32::midpoint(left[band].powi(2), right[band].powi(2)).sqrt()
        };
        for (index, um) in [[9.0, 9.0], [2.0, 5.0], [4.0, 0.0]].into_iter().enumerate() {
            let found = alone(index);
            assert!(within(mono(found, 0), um[0]) && within(mono(found, 1), um[1]));
        }
        let to_the_right = |[left, right]: StereoLevels| right[0] / left[0];
        assert!(to_the_right(alone(0)) < to_the_right(alone(2)));
        assert_eq!(alone(3), [[0.0; 2]; 2], "there is none");
    }

    #[test]
    fn what_is_no_amplitude_is_silent() {
        for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0] {
            let contactors = [(f64::NAN, [wrong, 0.0]), (0.0, [0.0, wrong])];
            let levels = stereo_levels([f64::NAN; 2], contactors.into_iter(), None);
            assert_eq!(levels, [[0.0; 2]; 2], "{wrong}");
        }
    }

    proptest! {
        #[test]
        fn nothing_is_louder_than_6_db_below_full_scale(
            ticks in prop::collection::vec(any::<[[u32; 2]; 4]>(), 1..12),
            finger: f64,
            is_literal: bool,
        ) {
            let level = |tick: &[[u32; 2]; 4]| {
                let places = [f64::NAN, -7.0, 0.2, 1.0].into_iter();
                let um = tick.map(|bands| bands.map(f32::from_bits));
                let contactors: Vec<_> = places.zip(um).collect();
                stereo_levels([finger, 2.0], contactors.into_iter(), None)
            };
            let levels: Vec<StereoLevels> = ticks.iter().map(level).collect();
            let frames = heard(&levels, is_literal);
            prop_assert!(frames.iter().flatten().all(|x| x.abs() <= 0.501_188));
        }
    }
}
