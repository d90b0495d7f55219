//! How old what is felt is: the wait of frames for their tick, and the card's own buffers. Time is
//! samples.
//!
//! A frame that is handed over when the card has taken `p` samples, and taken at sample `s` by a
//! card that plays a block `d` samples after it asked for it, is felt `s − p + d` samples later:
//! the card plays a sample in the time of a sample, so that it asks for the block that begins at
//! `b` `b − p` samples after the handing over, and plays its sample `s` another `d + s − b` later.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::AudioLatency;

/// What both ends know of the time between them.
#[derive(Debug)]
pub(super) struct Latency {
    rate_hz: u32,
    /// Samples that the card has taken.
    taken: AtomicU64,
    /// The most samples that waited in the card, with the block that it had just taken.
    buffered: AtomicU64,
    /// The oldest frame when its first sample was played.
    oldest: AtomicU64,
}

impl Latency {
    pub(super) fn new(rate_hz: u32) -> Self {
        Self {
            rate_hz: rate_hz.max(1),
            taken: AtomicU64::new(0),
            buffered: AtomicU64::new(0),
            oldest: AtomicU64::new(0),
        }
    }

    /// Samples that the card has taken so far: the stamp of a frame that is handed over now.
    pub(super) fn stamp(&self) -> u64 {
        self.taken.load(Ordering::Acquire)
    }

    /// The card takes a frame of this stamp at a sample, and plays what it asked for `delay` later.
    pub(super) fn frame_taken(&self, stamp: u64, sample: u64, delay: u64) {
        let age = sample.saturating_sub(stamp).saturating_add(delay);
        self.oldest.fetch_max(age, Ordering::Relaxed);
    }

    /// The card has all samples before this one; the last block had so many, played `delay` later.
    pub(super) fn block_taken(&self, next_sample: u64, n_samples: u64, delay: u64) {
        self.taken.store(next_sample, Ordering::Release);
        let buffered = delay.saturating_add(n_samples);
        self.buffered.fetch_max(buffered, Ordering::Relaxed);
    }

    /// A time as samples, to the nearest.
    pub(super) fn samples(&self, time: Duration) -> u64 {
        let nanos = time.as_nanos().saturating_mul(u128::from(self.rate_hz));
        u64::try_from((nanos + 500_000_000) / 1_000_000_000).unwrap_or(u64::MAX)
    }

    /// What was reached so far.
    pub(super) fn told(&self) -> AudioLatency {
        let time = |samples: &AtomicU64| {
            let samples = samples.load(Ordering::Relaxed);
            let nanos = u128::from(samples) * 1_000_000_000 / u128::from(self.rate_hz);
            Duration::from_nanos(u64::try_from(nanos).unwrap_or(u64::MAX))
        };
        AudioLatency {
            total: time(&self.oldest),
            card: time(&self.buffered),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_as_old_as_its_wait_and_the_cards_buffers() {
        let latency = Latency::new(48_000);
        // The card takes blocks of 512 and plays them 1024 samples later.
        latency.block_taken(512, 512, 1024);
        assert_eq!(latency.stamp(), 512);
        // Three ticks of 1200 samples wait: it is taken at the fourth.
        latency.frame_taken(512, 3600, 1024);
        let told = latency.told();
        assert_eq!(told.card, Duration::from_millis(32), "1536 samples");
        assert_eq!(
            told.total,
            Duration::from_micros(85_666) + Duration::from_nanos(666)
        );
        // What is younger changes nothing.
        latency.frame_taken(4096, 4800, 1024);
        latency.block_taken(4608, 512, 0);
        assert_eq!(latency.told(), told);
        assert_eq!(latency.stamp(), 4608);
    }

    #[test]
    fn times_become_samples_to_the_nearest_and_nothing_overflows() {
        let latency = Latency::new(44_100);
        assert_eq!(latency.samples(Duration::from_secs(1)), 44_100);
        assert_eq!(latency.samples(Duration::from_nanos(11_337)), 0);
        assert_eq!(latency.samples(Duration::from_nanos(11_340)), 1);
        assert_eq!(latency.samples(Duration::MAX), u64::MAX);
        latency.frame_taken(9, 3, u64::MAX);
        latency.block_taken(u64::MAX, 1, u64::MAX);
        assert!(latency.told().total > Duration::from_secs(1));
    }
}
