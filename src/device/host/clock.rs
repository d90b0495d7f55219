//! The device's clock as the host knows it: a straight line through the quickest answers to PINGs.
//!
//! An answer says what the device's clock was at some time between the request and its arrival; the
//! quicker it came, the better that time is known, and the more it weighs. The line leaves a
//! constant error of at most half a round trip, which cancels where delays and moments are measured
//! with the same line. Pure: it is told the time.

use selvedge_foundation::numerics::to_whole;
use std::time::{Duration, Instant};

/// The time between two ticks of a device.
pub(super) const TICK: Duration = Duration::from_millis(25);
/// Answers that are remembered: a minute at one a second.
const N_ECHOES: usize = 64;
/// An answer that took this much longer than the quickest weighs a quarter of it.
const DOUBT_US: f64 = 100.0;
/// A rate is only told from answers that lie at least this far apart.
const RATE_SPAN_US: f64 = 8e6;
/// No quartz is further off than this.
const WILDEST_RATE: f64 = 500e-6;

/// One answered PING.
#[derive(Clone, Copy, Debug, Default)]
struct Echo {
    /// The middle between request and answer, µs since the first, and the device's clock then.
    host_us: f64,
    device_us: f64,
    round_trip: Duration,
}

/// What a clock line has learned of a device's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClockFit {
    /// How much faster than ours the device's clock runs, in parts per million; 0 until known.
    pub rate_ppm: f64,
    /// The quickest round trip of the last minute.
    pub round_trip: Duration,
    /// PINGs that were answered.
    pub n_answers: u64,
}

/// The line `device = offset + rate · host`, by its place at one moment.
#[derive(Clone, Copy, Debug)]
struct Line {
    host_us: f64,
    device_us: f64,
    rate: f64,
}

impl Line {
    fn device_us(&self, host_us: f64) -> f64 {
        self.device_us + (host_us - self.host_us) * self.rate
    }

    fn host_us(&self, device_us: f64) -> f64 {
        self.host_us + (device_us - self.device_us) / self.rate
    }
}

/// Turns times of the device into ours and back.
#[derive(Clone, Debug)]
pub(super) struct DeviceClock {
    origin: Option<Instant>,
    /// The last clock reading, as it came and with its wraps undone.
    last: Option<(u32, u64)>,
    echoes: [Echo; N_ECHOES],
    n_answers: u64,
    line: Option<Line>,
}

impl DeviceClock {
    pub(super) fn new() -> Self {
        Self {
            origin: None,
            last: None,
            echoes: [Echo::default(); N_ECHOES],
            n_answers: 0,
            line: None,
        }
    }

    /// A reading of the device's clock with its wraps (every 71.6 min) undone; readings come in
    /// order, apart by less than half a wrap.
    pub(super) fn unwrapped(&mut self, device_us: u32) -> u64 {
        let whole = match self.last {
            None => u64::from(device_us),
            Some((wire, whole)) => {
                let step = i64::from(device_us.wrapping_sub(wire).cast_signed());
                whole.saturating_add_signed(step)
            }
        };
        self.last = Some((device_us, whole));
        whole
    }

    /// Takes in an answered PING. Gives how far the line moved at that moment.
    pub(super) fn answered(
        &mut self,
        sent: Instant,
        received: Instant,
        device_us: u32,
    ) -> Duration {
        let origin = *self.origin.get_or_insert(sent);
        let device_us = self.unwrapped(device_us) as f64;
        let [sent_us, received_us] = [sent, received].map(|at| since(origin, at));
        let host_us = f64::midpoint(sent_us, received_us);
        let place = usize::try_from(self.n_answers % N_ECHOES as u64).unwrap_or(0);
        self.echoes[place] = Echo {
            host_us,
            device_us,
            round_trip: received.saturating_duration_since(sent),
        };
        self.n_answers += 1;
        let before = self.line;
        self.line = Some(self.fit());
        let moved = before.map(|before| before.device_us(host_us) - self.device_us_at(host_us));
        Duration::from_secs_f64(moved.map_or(0.0, |us| us.abs() * 1e-6))
    }

    /// When the device's clock showed or will show this (unwrapped), by ours; `None` before the
    /// first answer.
    pub(super) fn at(&self, device_us: u64) -> Option<Instant> {
        let (origin, line) = (self.origin?, self.line?);
        let us = line.host_us(device_us as f64);
        let away = Duration::try_from_secs_f64(us.abs() * 1e-6).ok()?;
        if us < 0.0 {
            origin.checked_sub(away)
        } else {
            origin.checked_add(away)
        }
    }

    /// What the device's clock shows at one of our moments, µs since its boot modulo its wraps.
    pub(super) fn device_us(&self, at: Instant) -> Option<u64> {
        let (origin, line) = (self.origin?, self.line?);
        Some(to_whole(line.device_us(since(origin, at)).round()))
    }

    /// What was learned.
    pub(super) fn fit_view(&self) -> ClockFit {
        ClockFit {
            rate_ppm: self.line.map_or(0.0, |line| (line.rate - 1.0) * 1e6),
            round_trip: Duration::try_from_secs_f64(self.quickest_us() * 1e-6).unwrap_or_default(),
            n_answers: self.n_answers,
        }
    }

    fn device_us_at(&self, host_us: f64) -> f64 {
        self.line.map_or(0.0, |line| line.device_us(host_us))
    }

    fn known(&self) -> impl Iterator<Item = &Echo> {
        let n = usize::try_from(self.n_answers).unwrap_or(N_ECHOES);
        self.echoes.iter().take(n)
    }

    fn quickest_us(&self) -> f64 {
        let quickest = self.known().map(|echo| echo.round_trip).min();
        1e6 * quickest.unwrap_or_default().as_secs_f64()
    }

    /// Least squares, every answer by how quick it was.
    fn fit(&self) -> Line {
        let quickest_us = self.quickest_us();
        let weight = |echo: &Echo| {
            let round_trip_us = 1e6 * echo.round_trip.as_secs_f64();
            (round_trip_us - quickest_us + DOUBT_US).powi(-2)
        };
        let sum = |pick: &dyn Fn(&Echo) -> f64| {
            let weighed = self.known().map(|echo| weight(echo) * pick(echo));
            weighed.sum::<f64>()
        };
        let whole = sum(&|_| 1.0);
        let host_us = sum(&|echo| echo.host_us) / whole;
        let device_us = sum(&|echo| echo.device_us) / whole;
        let last_us = self.known().map(|echo| echo.host_us).fold(0.0, f64::max);
        let first_us = self
            .known()
            .map(|echo| echo.host_us)
            .fold(last_us, f64::min);
        let rate = if last_us - first_us < RATE_SPAN_US {
            1.0
        } else {
            let square = sum(&|echo| (echo.host_us - host_us).powi(2));
            let product = sum(&|echo| (echo.host_us - host_us) * (echo.device_us - device_us));
            (product / square).clamp(1.0 - WILDEST_RATE, 1.0 + WILDEST_RATE)
        };
        Line {
            host_us,
            device_us,
            rate,
        }
    }
}

/// µs from `origin` to `at`, negative before it.
fn since(origin: Instant, at: Instant) -> f64 {
    let after = at.saturating_duration_since(origin).as_secs_f64();
    let before = origin.saturating_duration_since(at).as_secs_f64();
    (after - before) * 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    const US: Duration = Duration::from_micros(1);

    /// Answers once a second for a while; the device runs `ppm` fast and is 5 s ahead; the way
    /// there and back takes these times.
    fn clock_after(n: u32, ppm: f64, ways_us: impl Fn(u32) -> [u32; 2]) -> (DeviceClock, Instant) {
        let (mut clock, start) = (DeviceClock::new(), Instant::now());
        for k in 0..n {
            let sent = start + Duration::from_secs(u64::from(k));
            let [there, back] = ways_us(k);
            let at = sent + US * there;
            clock.answered(sent, at + US * back, device_us(start, at, ppm));
        }
        (clock, start)
    }

    fn device_us(start: Instant, at: Instant, ppm: f64) -> u32 {
        let us = since(start, at) * (1.0 + ppm * 1e-6) + 5e6;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it wraps on the wire"
        )]
        let wire = us as u64 as u32;
        wire
    }

    #[test]
    fn rate_and_offset_are_found_through_slow_answers() {
        for ppm in [-100.0, 0.0, 100.0] {
            let ways = |k: u32| {
                if k.is_multiple_of(3) {
                    [4000, 90]
                } else {
                    [120, 130]
                }
            };
            let (clock, start) = clock_after(60, ppm, ways);
            assert!((clock.fit_view().rate_ppm - ppm).abs() < 1.0, "{ppm}");
            let at = start + Duration::from_secs(70);
            let described = clock.device_us(at).unwrap() as f64;
            let truth = 70e6 * (1.0 + ppm * 1e-6) + 5e6;
            assert!((described - truth).abs() < 40.0, "{}", described - truth);
            let back = clock.at(clock.device_us(at).unwrap()).unwrap();
            assert!(since(at, back).abs() < 2.0);
        }
    }

    #[test]
    fn a_first_answer_is_enough_for_an_offset_and_none_for_a_rate() {
        let (clock, start) = clock_after(1, 80.0, |_| [300, 300]);
        assert_eq!(clock.fit_view().rate_ppm, 0.0);
        assert_eq!(clock.device_us(start + US * 300), Some(5_000_300));
        assert_eq!(DeviceClock::new().at(0), None);
    }

    #[test]
    fn the_devices_clock_may_wrap() {
        let mut clock = DeviceClock::new();
        assert_eq!(clock.unwrapped(u32::MAX - 5), u64::from(u32::MAX) - 5);
        assert_eq!(clock.unwrapped(10), u64::from(u32::MAX) + 11);
        assert_eq!(clock.unwrapped(9), u64::from(u32::MAX) + 10, "a step back");
    }

    #[test]
    fn a_quicker_answer_moves_the_line_and_says_how_far() {
        let (mut clock, start) = clock_after(1, 0.0, |_| [9000, 1000]);
        let sent = start + Duration::from_secs(1);
        let at = sent + US * 100;
        let moved = clock.answered(sent, at + US * 100, device_us(start, at, 0.0));
        assert!((moved.as_secs_f64() - 4e-3).abs() < 1e-6, "{moved:?}");
    }
}
