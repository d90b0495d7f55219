//! How loud the device may be by our own frames: the bound that its `amp_sum` is held against.
//!
//! A device that plays what it was sent shows at tick t at most the largest sum of the frames whose
//! turn may still last then: hold and ramp after the last one, and a tick for each that may come
//! late. Where it lets amplitudes change only slowly, the bound falls no faster than they may.

/// Frames that are remembered: longer than any window.
const N_FRAMES: usize = 64;
const TICK_MS: u32 = 25;
/// Beyond the bound by this share and this many codes is louder than asked.
const SHARE: f64 = 1.01;
const SLACK: f64 = 24.0;

/// A FRAME or an IDENT: the ticks in which it may sound, and how loud it is.
#[derive(Clone, Copy, Debug, Default)]
struct Asked {
    first_tick: u32,
    n_ticks: u32,
    sum: u32,
}

/// What was asked of the device since ARM.
#[derive(Clone, Debug)]
pub(super) struct Prediction {
    asked: [Asked; N_FRAMES],
    n_asked: usize,
    bound: f64,
    /// The tick that the bound holds for.
    tick: Option<u32>,
    /// Advancing STATUS beyond the bound, one after another.
    n_beyond: u8,
}

impl Default for Prediction {
    fn default() -> Self {
        Self {
            asked: [Asked::default(); N_FRAMES],
            n_asked: 0,
            bound: 0.0,
            tick: None,
            n_beyond: 0,
        }
    }
}

/// What the device is configured for, as far as it makes amplitudes last.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lasting {
    /// Hold and ramp together, ms.
    pub(super) silencing_ms: u32,
    /// Ticks that frames are sent ahead.
    pub(super) depth: u8,
    /// Largest fall of the sum of all codes in a tick.
    pub(super) fall: f64,
}

impl Lasting {
    /// Ticks in which a frame may sound, from its own.
    fn n_ticks(self) -> u32 {
        self.silencing_ms.div_ceil(TICK_MS) + u32::from(self.depth) + 2
    }
}

impl Prediction {
    /// Nothing was asked yet.
    pub(super) fn begin(&mut self) {
        *self = Self::default();
    }

    /// A frame for this tick with these codes goes out.
    pub(super) fn frame(&mut self, apply_tick: u32, codes: &[[u16; 2]], lasting: Lasting) {
        let sums = codes.iter().flatten().map(|code| u32::from(*code));
        self.ask(Asked {
            first_tick: apply_tick,
            n_ticks: lasting.n_ticks(),
            sum: sums.sum(),
        });
    }

    /// An IDENT of this amplitude and time goes out at `tick`.
    pub(super) fn ident(&mut self, tick: u32, (amp, ms): (u16, u16), lasting: Lasting) {
        self.ask(Asked {
            first_tick: tick,
            n_ticks: u32::from(ms).div_ceil(TICK_MS) + lasting.n_ticks(),
            sum: amp.into(),
        });
    }

    fn ask(&mut self, asked: Asked) {
        self.asked[self.n_asked % N_FRAMES] = asked;
        self.n_asked += 1;
    }

    /// How loud the device may be at the tick of an advancing STATUS.
    pub(super) fn bound(&mut self, tick: u32, lasting: Lasting) -> f64 {
        let sounding = self.asked.iter().take(self.n_asked);
        let sounding = sounding.filter(|asked| tick.wrapping_sub(asked.first_tick) < asked.n_ticks);
        let loudest = sounding.map(|asked| asked.sum).max().unwrap_or(0);
        let passed = self.tick.map_or(1, |last| tick.wrapping_sub(last));
        let fallen = self.bound - f64::from(passed) * lasting.fall;
        self.tick = Some(tick);
        self.bound = f64::from(loudest).max(fallen);
        self.bound
    }

    /// Whether the device is louder than asked, for the second time running.
    pub(super) fn is_exceeded(&mut self, amp_sum: u32) -> bool {
        if f64::from(amp_sum) > SHARE * self.bound + SLACK {
            self.n_beyond = self.n_beyond.saturating_add(1);
        } else {
            self.n_beyond = 0;
        }
        self.n_beyond >= 2
    }

    /// The bound of the last tick.
    pub(super) fn last_bound(&self) -> f64 {
        self.bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAST: Lasting = Lasting {
        silencing_ms: 100,
        depth: 1,
        fall: 48.0 * 65535.0,
    };

    #[test]
    fn a_frame_may_sound_for_hold_and_ramp_and_the_ticks_that_it_may_be_late() {
        let mut prediction = Prediction::default();
        prediction.frame(10, &[[300, 200]; 24], FAST);
        assert_eq!(prediction.bound(9, FAST), 0.0, "not before its tick");
        for tick in 10..17 {
            assert_eq!(prediction.bound(tick, FAST), 12_000.0, "{tick}");
        }
        assert_eq!(prediction.bound(17, FAST), 0.0);
    }

    #[test]
    fn where_codes_fall_slowly_the_bound_does() {
        let slow = Lasting {
            fall: 2.0 * 24.0 * 10.0,
            ..FAST
        };
        let mut prediction = Prediction::default();
        prediction.frame(10, &[[300, 200]; 24], slow);
        prediction.bound(16, slow);
        assert_eq!(prediction.bound(17, slow), 12_000.0 - 480.0);
        assert_eq!(prediction.bound(20, slow), 12_000.0 - 4.0 * 480.0);
    }

    #[test]
    fn louder_than_asked_is_louder_twice_running() {
        let mut prediction = Prediction::default();
        prediction.frame(10, &[[100, 0]; 24], FAST);
        prediction.bound(10, FAST);
        assert!(
            !prediction.is_exceeded(2448),
            "1 % and 24 codes are allowed"
        );
        assert!(!prediction.is_exceeded(2449));
        assert!(!prediction.is_exceeded(0));
        assert!(!prediction.is_exceeded(2449));
        assert!(prediction.is_exceeded(2449));
    }

    #[test]
    fn an_ident_may_sound_as_long_as_it_runs() {
        let mut prediction = Prediction::default();
        prediction.ident(10, (900, 600), FAST);
        assert_eq!(prediction.bound(10 + 24 + 6, FAST), 900.0);
        assert_eq!(prediction.bound(10 + 24 + 7, FAST), 0.0);
    }
}
