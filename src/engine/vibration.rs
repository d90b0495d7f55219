//! Steady vibrations of every contactor, one after another: what experiments on thresholds and
//! strengths present in place of cloth.

/// A part of a sequence: every contactor of the first display does the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VibrationStep {
    /// Peak amplitudes [A40, A320] before output limits, µm; zeros are a pause.
    pub amplitude_um: [f32; 2],
    /// How long, ticks of 25 ms.
    pub n_ticks: u32,
}

/// A sequence and how far it is.
#[derive(Debug, Default)]
pub(super) struct Vibration {
    steps: Vec<VibrationStep>,
    /// The step under way, and its ticks that were played.
    at: usize,
    n_played: u32,
    is_begun: bool,
}

impl Vibration {
    /// A sequence before its first tick.
    pub(super) fn of(mut steps: Vec<VibrationStep>) -> Self {
        steps.retain(|step| step.n_ticks > 0);
        Self {
            steps,
            ..Self::default()
        }
    }

    /// Whether every amplitude is one.
    pub(super) fn is_sound(&self) -> bool {
        let mut amplitudes = self.steps.iter().flat_map(|step| step.amplitude_um);
        amplitudes.all(|um| um.is_finite() && um >= 0.0)
    }

    /// Whether nothing is left to play.
    pub(super) fn is_over(&self) -> bool {
        self.at >= self.steps.len()
    }

    /// Leaves out what was not played yet.
    pub(super) fn end(&mut self) {
        self.at = self.steps.len();
    }

    /// The amplitudes of the next tick, µm; `None` when the sequence is over.
    pub(super) fn next_tick(&mut self) -> Option<[f32; 2]> {
        self.is_begun = true;
        if self.steps.get(self.at)?.n_ticks <= self.n_played {
            self.at += 1;
            self.n_played = 0;
        }
        let step = self.steps.get(self.at)?;
        self.n_played += 1;
        Some(step.amplitude_um)
    }

    /// The step that the last tick played, from 0.
    pub(super) fn step(&self) -> Option<u16> {
        let is_on = self.is_begun && !self.is_over();
        u16::try_from(self.at).ok().filter(|_| is_on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_follow_each_other_for_as_many_ticks_as_they_say() {
        let step = |um, n_ticks| VibrationStep {
            amplitude_um: [um, 0.0],
            n_ticks,
        };
        let mut vibration = Vibration::of(vec![step(3.0, 2), step(9.0, 0), step(0.0, 1)]);
        assert_eq!(vibration.step(), None, "it has not begun");
        let mut played = Vec::new();
        while let Some([um, _]) = vibration.next_tick() {
            played.push((vibration.step(), um));
        }
        assert_eq!(played, [(Some(0), 3.0), (Some(0), 3.0), (Some(1), 0.0)]);
        assert!(vibration.is_over() && vibration.step().is_none());
    }
}
