//! Pointing devices: when they say where they are, in what steps, and how late the stamp is.

use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::Random;

use super::strokes::Motion;

/// A pointing device and the way that its samples take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pointer {
    /// Its name for tables.
    pub(super) label: &'static str,
    /// Samples a second.
    rate_hz: f64,
    /// Steps of the coordinates, mm.
    step_mm: f64,
    /// Standard deviation of a coordinate before it is rounded, mm.
    noise_mm: f64,
    /// Standard deviation of a stamp's delay behind the sample, s.
    stamp_jitter_s: f64,
    /// Samples are handed over together, this many times a second, and stamped then.
    burst_hz: Option<f64>,
    /// Whether it says nothing while its coordinates stay the same.
    is_mouse: bool,
}

/// A mouse on a table: what is tried most.
const MOUSE: Pointer = Pointer {
    label: "mouse, 125 Hz, 0.1 mm",
    rate_hz: 125.0,
    step_mm: 0.1,
    noise_mm: 0.0,
    stamp_jitter_s: 0.5e-3,
    burst_hz: None,
    is_mouse: true,
};

/// What is tried in full.
pub(super) const POINTERS: [Pointer; 4] = [
    MOUSE,
    Pointer {
        label: "mouse, 1 kHz, 0.02 mm",
        rate_hz: 1000.0,
        step_mm: 0.02,
        stamp_jitter_s: 0.05e-3,
        ..MOUSE
    },
    Pointer {
        label: "tablet, 200 Hz, 0.02 mm",
        rate_hz: 200.0,
        step_mm: 0.02,
        noise_mm: 0.03,
        stamp_jitter_s: 0.3e-3,
        burst_hz: None,
        is_mouse: false,
    },
    Pointer {
        label: "mouse, 125 Hz in bursts at 60 Hz",
        stamp_jitter_s: 0.1e-3,
        burst_hz: Some(60.0),
        ..MOUSE
    },
];

/// What is tried when there is little time.
pub(super) const QUICK_POINTERS: [Pointer; 2] = [POINTERS[0], POINTERS[2]];

/// Samples of one burst are stamped this far apart, s: one after the other, as they are read.
const BETWEEN_S: f64 = 20e-6;

/// A sample: its stamp, s, and its place.
pub(super) type Sample = (f64, Point);

impl Pointer {
    /// Whether samples are handed over several at a time.
    pub(super) fn is_bursty(&self) -> bool {
        self.burst_hz.is_some()
    }

    /// What it says of a motion in `duration_s` seconds; stamps rise.
    pub(super) fn samples(
        &self,
        motion: Motion<'_>,
        duration_s: f64,
        random: &mut Random,
    ) -> Vec<Sample> {
        let mut samples: Vec<Sample> = Vec::new();
        let n = duration_s * self.rate_hz;
        let mut k = 0.0;
        while k < n {
            let t_s = k / self.rate_hz;
            k += 1.0;
            let place = self.rounded(motion(t_s).0, random);
            let delay_s = self.stamp_jitter_s * random.normal().abs();
            if self.is_mouse && samples.last().is_some_and(|last| last.1 == place) {
                continue;
            }
            let handed_s = self.burst_hz.map_or(t_s, |hz| (t_s * hz).ceil() / hz);
            let earliest_s = samples.last().map_or(0.0, |last| last.0 + BETWEEN_S);
            samples.push(((handed_s + delay_s).max(earliest_s), place));
        }
        samples
    }

    fn rounded(&self, place: Point, random: &mut Random) -> Point {
        let mut round = |mm: f64| {
            let seen_mm = mm + self.noise_mm * random.normal();
            (seen_mm / self.step_mm).round() * self.step_mm
        };
        Point::new(round(place.x_mm), round(place.y_mm))
    }
}

#[cfg(test)]
mod tests {
    use super::super::strokes::{STEADY, STROKES};
    use super::*;

    #[test]
    fn stamps_rise_and_places_are_steps_apart() {
        let stroke = STEADY;
        for pointer in POINTERS {
            let samples = pointer.samples(&stroke.at, 1.0, &mut Random::new(1));
            assert!(samples.len() > 100, "{}: {}", pointer.label, samples.len());
            for pair in samples.windows(2) {
                assert!(pair[1].0 > pair[0].0, "{}: {pair:?}", pointer.label);
            }
            for (_, place) in samples {
                let steps = place.x_mm / pointer.step_mm;
                assert!((steps - steps.round()).abs() < 1e-6, "{}", pointer.label);
            }
        }
    }

    #[test]
    fn a_mouse_that_lies_still_says_one_thing_and_a_tablet_goes_on() {
        let rest = |t_s: f64| (STROKES[8].at)(t_s);
        let said = |pointer: Pointer| pointer.samples(&rest, 1.0, &mut Random::new(1)).len();
        assert_eq!(said(POINTERS[0]), 1);
        assert_eq!(said(POINTERS[2]), 200);
    }

    #[test]
    fn a_burst_hands_over_what_came_since_the_last() {
        let stroke = STEADY;
        let samples = POINTERS[3].samples(&stroke.at, 1.0, &mut Random::new(1));
        let n_close = samples
            .windows(2)
            .filter(|pair| pair[1].0 - pair[0].0 < 1e-3)
            .count();
        assert!(n_close > 50, "125 samples in 60 bursts: {n_close} pairs");
    }
}
