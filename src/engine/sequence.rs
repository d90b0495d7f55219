//! What is felt in place of the whole scene, one step after another: steady vibrations of every
//! contactor, textiles of the scene one at a time, and silence. Experiments present intervals so.

/// What a step of a sequence lets the first display feel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Played {
    /// Every contactor does the same: peak amplitudes [A40, A320] before output limits, µm.
    Vibration([f32; 2]),
    /// This textile alone (its place in the scene's list), whatever lies upon it. One that the
    /// scene does not have is silent.
    Textile(usize),
}

/// A part of a sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SequenceStep {
    /// What is felt.
    pub played: Played,
    /// How long, ticks of 25 ms.
    pub n_ticks: u32,
}

impl SequenceStep {
    /// As many ticks as a silence has that lasts until the next sequence: more than three years.
    pub const UNTIL_NEXT: u32 = u32::MAX;

    /// A pause: nothing is felt.
    pub fn silence(n_ticks: u32) -> Self {
        Self {
            played: Played::Vibration([0.0; 2]),
            n_ticks,
        }
    }

    fn is_silence(&self) -> bool {
        self.played == Played::Vibration([0.0; 2])
    }
}

/// A sequence and how far it is.
#[derive(Debug, Default)]
pub(super) struct Sequence {
    steps: Vec<SequenceStep>,
    /// The step under way, and its ticks that were played.
    at: usize,
    n_played: u32,
    is_begun: bool,
}

impl Sequence {
    /// A sequence before its first tick.
    pub(super) fn of(mut steps: Vec<SequenceStep>) -> Self {
        steps.retain(|step| step.n_ticks > 0);
        Self {
            steps,
            ..Self::default()
        }
    }

    /// Whether every amplitude is one.
    pub(super) fn is_sound(&self) -> bool {
        let is_amplitude = |um: &f32| um.is_finite() && *um >= 0.0;
        self.steps.iter().all(|step| match step.played {
            Played::Vibration(amplitude_um) => amplitude_um.iter().all(is_amplitude),
            Played::Textile(_) => true,
        })
    }

    /// Whether something of it would be felt.
    pub(super) fn has_anything(&self) -> bool {
        let left = self.steps.iter().skip(self.at);
        !left.into_iter().all(SequenceStep::is_silence)
    }

    /// Whether nothing is left to play.
    fn is_over(&self) -> bool {
        self.at >= self.steps.len()
    }

    /// Leaves out what was not played yet.
    pub(super) fn end(&mut self) {
        self.at = self.steps.len();
    }

    /// What the next tick plays; `None` when the sequence is over.
    pub(super) fn next_tick(&mut self) -> Option<Played> {
        self.is_begun = true;
        if self.steps.get(self.at)?.n_ticks <= self.n_played {
            self.at += 1;
            self.n_played = 0;
        }
        let step = self.steps.get(self.at)?;
        self.n_played += 1;
        Some(step.played)
    }

    /// What it plays now; before its first tick, what that will play.
    pub(super) fn played(&self) -> Option<Played> {
        self.steps.get(self.at).map(|step| step.played)
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
        let step = |played, n_ticks| SequenceStep { played, n_ticks };
        let (vibration, textile) = (Played::Vibration([3.0, 0.0]), Played::Textile(1));
        let steps = vec![step(vibration, 2), step(vibration, 0), step(textile, 1)];
        let mut sequence = Sequence::of(steps);
        assert_eq!(sequence.step(), None, "it has not begun");
        assert_eq!(sequence.played(), Some(vibration), "what comes first");
        let mut played = Vec::new();
        while let Some(one) = sequence.next_tick() {
            assert_eq!(sequence.played(), Some(one));
            played.push((sequence.step(), one));
        }
        let expected = [
            (Some(0), vibration),
            (Some(0), vibration),
            (Some(1), textile),
        ];
        assert_eq!(played, expected);
        assert!(sequence.is_over() && sequence.step().is_none() && sequence.played().is_none());
    }
}
