//! Mode B: samples that the host made, in a ring, played one after another.
//!
//! Sample m is due at the device's time m / rate, so tick t begins with sample `t · rate / 40`. A
//! sample that is missing repeats the last one; hold and ramp then end it as they end a frame that
//! stays. The device can bound the peak of a sample and its step from the last, and does.

use super::model::SAMPLE_HZ;
use super::sink::SampleCount;
use crate::fields::{FieldReader, wrapped_u32};

/// Bytes before the first sample.
pub(super) const HEAD_LEN: usize = 8;
/// The only format of v1: signed, 16 bits.
const FORMAT_I16: u8 = 0;
/// Samples a second.
const RATE_HZ: u64 = SAMPLE_HZ as u64;

/// The largest sample.
pub(super) const FULL: u16 = i16::MAX.unsigned_abs();

/// What became of a packet of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Taken {
    /// Wrong length, another format, none at all.
    Odd,
    /// It begins beyond what the ring holds.
    TooFar,
    /// So many values were above their limit; whether some came after their time.
    Yes { clipped: u16, is_late: bool },
}

/// Samples waiting for their time. Never allocates after it was made.
#[derive(Clone, Debug)]
pub(super) struct SampleRing {
    n_channels: usize,
    /// Samples that it holds for each channel.
    capacity: u64,
    values: Vec<i16>,
    /// The sample that each place holds.
    numbers: Vec<Option<u64>>,
    /// What sounds now, and what the last step wrote.
    now: Vec<i16>,
    block: Vec<i16>,
    /// The next sample to be played.
    next: u64,
    /// Whether a sample sounded since the ring was reset: before, none is missing.
    has_begun: bool,
    missing: bool,
    /// What happened since the last tick began, and the largest sample of each channel.
    pub(super) count: SampleCount,
    pub(super) peaks: Vec<u16>,
}

impl SampleRing {
    /// A ring for `queue` ticks.
    pub(super) fn new(queue: u8, n_channels: usize) -> Self {
        let capacity = u64::from(queue.max(1)) * RATE_HZ / 40;
        let places = usize::try_from(capacity).unwrap_or(0);
        Self {
            n_channels,
            capacity,
            values: vec![0; places * n_channels],
            numbers: vec![None; places],
            now: vec![0; n_channels],
            block: Vec::with_capacity(places * n_channels),
            next: 0,
            has_begun: false,
            missing: false,
            count: SampleCount::default(),
            peaks: vec![0; n_channels],
        }
    }

    /// Silent and empty; `now_us` is the device's time.
    pub(super) fn reset(&mut self, now_us: u64) {
        self.numbers.fill(None);
        self.now.fill(0);
        self.next = sample_at(now_us);
        self.has_begun = false;
        self.missing = false;
    }

    /// Empty; what sounds stays, and none is expected any more.
    pub(super) fn clear(&mut self) {
        self.numbers.fill(None);
        self.has_begun = false;
    }

    /// Takes the payload of a SAMPLES packet at the device's time `now_us`. Values are limited to
    /// `peak`, those of channels that `is_on` denies are 0.
    pub(super) fn take(
        &mut self,
        now_us: u64,
        payload: &[u8],
        peak: i16,
        is_on: impl Fn(usize) -> bool,
    ) -> Taken {
        let mut fields = FieldReader::new(payload);
        let (first, n, format) = (fields.u32(), fields.u8(), fields.u8());
        fields.u16();
        let n_values = usize::from(n) * self.n_channels;
        if n == 0 || format != FORMAT_I16 || payload.len() != HEAD_LEN + 2 * n_values {
            return Taken::Odd;
        }
        let playable = sample_at(now_us) + 1;
        // The number wraps after six days: it is the one nearest to now.
        let away = first.wrapping_sub(wrapped_u32(playable)).cast_signed();
        let Some(first) = playable.checked_add_signed(i64::from(away)) else {
            return Taken::Odd;
        };
        if first + u64::from(n) > playable + self.capacity - RATE_HZ / 1000 {
            return Taken::TooFar;
        }
        let mut clipped = 0_u16;
        for number in first..first + u64::from(n) {
            let place = usize::try_from(number % self.capacity).unwrap_or(0);
            for channel in 0..self.n_channels {
                let value = fields.i16();
                let limited = value.clamp(-peak, peak);
                if number < playable {
                    continue;
                }
                let sounds = is_on(channel);
                clipped = clipped.wrapping_add(u16::from(sounds && limited != value));
                self.values[place * self.n_channels + channel] = if sounds { limited } else { 0 };
            }
            if number >= playable {
                self.numbers[place] = Some(number);
            }
        }
        let is_late = first < playable;
        let late = playable.saturating_sub(first).min(u64::from(n));
        self.count.packets = self.count.packets.wrapping_add(1);
        self.count.received += u32::from(n);
        self.count.late += wrapped_u32(late);
        self.count.clipped = self.count.clipped.wrapping_add(clipped);
        Taken::Yes { clipped, is_late }
    }

    /// Plays everything up to the device's time `now_us`: no value changes by more than `step` from
    /// one sample to the next, all are multiplied by `gain`. Gives the number of the first sample
    /// and the interleaved samples.
    pub(super) fn play(&mut self, now_us: u64, step: u16, gain: f64) -> (u64, &[i16]) {
        self.block.clear();
        let first = self.next;
        while self.next < sample_at(now_us) && self.block.len() < self.block.capacity() {
            let place = usize::try_from(self.next % self.capacity).unwrap_or(0);
            let is_there = self.numbers[place] == Some(self.next);
            self.has_begun |= is_there;
            let is_missing = self.has_begun && !is_there;
            self.missing |= is_missing;
            self.count.missing += u32::from(is_missing);
            self.count.played += u32::from(is_there);
            for channel in 0..self.n_channels {
                let now = &mut self.now[channel];
                if is_there {
                    let wanted = self.values[place * self.n_channels + channel];
                    let least = i32::from(*now) - i32::from(step);
                    let most = i32::from(*now) + i32::from(step);
                    let reached = i32::from(wanted).clamp(least, most);
                    *now = i16::try_from(reached).unwrap_or(wanted);
                }
                let sounding = scaled(*now, gain);
                self.block.push(sounding);
                let peak = &mut self.peaks[channel];
                *peak = (*peak).max(2 * sounding.unsigned_abs().min(FULL));
            }
            if is_there {
                self.numbers[place] = None;
            }
            self.next += 1;
        }
        (first, &self.block)
    }

    /// Whether a sample was missing since this was asked last.
    pub(super) fn take_missing(&mut self) -> bool {
        std::mem::take(&mut self.missing)
    }

    /// What sounds, each channel's value.
    pub(super) fn sounding(&self) -> &[i16] {
        &self.now
    }

    /// Whole ticks of samples that wait.
    pub(super) fn waiting_ticks(&self) -> u8 {
        let waiting = self
            .numbers
            .iter()
            .filter(|number| number.is_some())
            .count();
        u8::try_from(waiting as u64 * 40 / RATE_HZ).unwrap_or(u8::MAX)
    }
}

/// The sample that sounds at a time.
fn sample_at(us: u64) -> u64 {
    us * RATE_HZ / 1_000_000
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a gain of at most 1 makes nothing larger"
)]
pub(super) fn scaled(value: i16, gain: f64) -> i16 {
    (f64::from(value) * gain) as i16
}
