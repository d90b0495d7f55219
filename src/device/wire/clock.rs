//! A device's clock against true time: it runs fast or slow, and its ticks lie a little off.

use crate::message::TICK_US;

const TICK: u64 = TICK_US as u64;
const MILLION: i64 = 1_000_000;

/// True time since boot to device time and back. Within a tick both run evenly.
#[derive(Clone, Debug)]
pub(super) struct DeviceClock {
    ppm: i64,
    jitter_us: i64,
    seed: u64,
}

impl DeviceClock {
    pub(super) fn new(ppm: i32, jitter_us: u32, seed: u64) -> Self {
        Self {
            ppm: i64::from(ppm),
            jitter_us: i64::from(jitter_us),
            seed,
        }
    }

    /// Device time, µs since boot, when so much true time has passed since boot.
    pub(super) fn device_us(&self, true_us: u64) -> u64 {
        if self.is_true() {
            return true_us;
        }
        let mut tick = true_us / TICK;
        while self.tick_begins_us(tick) > true_us && tick > 0 {
            tick -= 1;
        }
        while self.tick_begins_us(tick + 1) <= true_us {
            tick += 1;
        }
        let (begins, ends) = (self.tick_begins_us(tick), self.tick_begins_us(tick + 1));
        tick * TICK + true_us.saturating_sub(begins) * TICK / (ends - begins)
    }

    /// The true time since boot at which the device's clock has reached `device_us`.
    pub(super) fn true_us(&self, device_us: u64) -> u64 {
        if self.is_true() {
            return device_us;
        }
        let tick = device_us / TICK;
        let (begins, ends) = (self.tick_begins_us(tick), self.tick_begins_us(tick + 1));
        begins + ((device_us % TICK) * (ends - begins)).div_ceil(TICK)
    }

    fn is_true(&self) -> bool {
        self.ppm == 0 && self.jitter_us == 0
    }

    /// When a tick begins, in true time. Exact for a hundred days.
    fn tick_begins_us(&self, tick: u64) -> u64 {
        let even = (tick * TICK).cast_signed();
        let drifted = even.saturating_mul(MILLION) / (MILLION + self.ppm);
        (drifted + self.offset_us(tick)).max(0).cast_unsigned()
    }

    /// Uniform within the jitter, from seed and tick alone; boot is where it is.
    fn offset_us(&self, tick: u64) -> i64 {
        if self.jitter_us == 0 || tick == 0 {
            return 0;
        }
        // SplitMix64: a good hash of a counter.
        let mut hash = self.seed ^ tick.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash = (hash ^ hash >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        hash = (hash ^ hash >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        let span = 2 * self.jitter_us + 1;
        (hash >> 33).cast_signed() % span - self.jitter_us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fast_clock_gains_its_ppm_and_a_true_one_nothing() {
        let hour_us = 3_600_000_000;
        assert_eq!(DeviceClock::new(0, 0, 1).device_us(hour_us), hour_us);
        for ppm in [-100, 100] {
            let gained = DeviceClock::new(ppm, 0, 1).device_us(hour_us).cast_signed()
                - hour_us.cast_signed();
            let wanted = i64::from(ppm) * 3600;
            assert!((gained - wanted).abs() <= 1, "{ppm} ppm: {gained} µs");
        }
    }

    #[test]
    fn with_any_jitter_time_never_goes_back_and_a_deadline_is_reached() {
        let clock = DeviceClock::new(-100, 10_000, 7);
        let mut last = 0;
        for true_us in (0..3_000_000).step_by(13) {
            let device_us = clock.device_us(true_us);
            assert!(device_us >= last, "{true_us} µs");
            last = device_us;
        }
        let mut offsets = Vec::new();
        for deadline_us in (0..10_000_000).step_by(1000) {
            let true_us = clock.true_us(deadline_us);
            assert!(clock.device_us(true_us) >= deadline_us, "{deadline_us} µs");
            assert!(
                true_us == 0 || clock.device_us(true_us - 1) <= deadline_us,
                "not later than it must be"
            );
            if deadline_us % TICK == 0 {
                offsets.push(true_us.cast_signed() - deadline_us.cast_signed());
            }
        }
        assert!(offsets.iter().any(|us| *us < -5000) && offsets.iter().any(|us| *us > 5000));
        assert!(offsets.iter().all(|us| us.abs() <= 11_100));
    }
}
