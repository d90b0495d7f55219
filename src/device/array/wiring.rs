//! Which channel drives which contactor, found by asking: one channel is driven at a time, and a
//! person says where it was felt or seen.
//!
//! A pure state machine: whoever runs it drives the channel that it names and hands it the answers.
//! Channels whose answers name one contactor twice are asked again until every contactor has at
//! most one channel.

use super::{ArrayProfile, DeviceUid, Wiring};

/// What a person says of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// It was this contactor.
    Contactor(usize),
    /// Nothing was felt.
    Nothing,
}

/// Two or more channels that were said to drive the same contactor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conflict {
    /// The contactor.
    pub contactor: usize,
    /// The channels, in order.
    pub channels: Vec<usize>,
}

/// A walk over the channels of a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WiringWalk {
    answers: Vec<Option<Answer>>,
    /// The channel that is asked for.
    at: Option<usize>,
    /// What is being asked again.
    conflicts: Vec<Conflict>,
}

impl WiringWalk {
    /// A walk over as many channels as there are contactors, at the first.
    pub fn new(n_channels: usize) -> Self {
        Self {
            answers: vec![None; n_channels],
            at: (n_channels > 0).then_some(0),
            conflicts: Vec::new(),
        }
    }

    /// How many channels, and contactors, there are.
    pub fn n_channels(&self) -> usize {
        self.answers.len()
    }

    /// The channel to drive now; `None` once all is known.
    pub fn channel(&self) -> Option<usize> {
        self.at
    }

    /// Channels that have an answer.
    pub fn n_answered(&self) -> usize {
        self.answers.iter().flatten().count()
    }

    /// The channels that were said to drive a contactor.
    pub fn channels_of(&self, contactor: usize) -> Vec<usize> {
        let named = Some(Answer::Contactor(contactor));
        let channels = self.answers.iter().enumerate();
        let named = channels.filter(|(_, answer)| **answer == named);
        named.map(|(channel, _)| channel).collect()
    }

    /// The answers that contradicted each other and are being asked again.
    pub fn conflicts(&self) -> &[Conflict] {
        &self.conflicts
    }

    /// Takes the answer for the present channel and goes on. False: there is no such contactor, or
    /// nothing is asked; nothing changed then.
    pub fn answer(&mut self, answer: Answer) -> bool {
        let is_known = match answer {
            Answer::Contactor(contactor) => contactor < self.n_channels(),
            Answer::Nothing => true,
        };
        let Some(at) = self.at.filter(|_| is_known) else {
            return false;
        };
        self.answers[at] = Some(answer);
        self.go_on(at);
        true
    }

    /// Back to the channel before, whose answer is asked again; nothing at the first.
    pub fn back(&mut self) {
        let before = self.at.unwrap_or(self.answers.len()).checked_sub(1);
        if let Some(before) = before {
            self.ask(before);
        }
    }

    /// Asks for a channel again; one that does not exist is left alone.
    pub fn ask(&mut self, channel: usize) {
        if let Some(answer) = self.answers.get_mut(channel) {
            *answer = None;
            self.at = Some(channel);
        }
    }

    /// What was found, once every channel has its answer and none contradicts another.
    pub fn found(&self) -> Option<WiringFound> {
        let is_done = self.at.is_none() && !self.answers.is_empty();
        is_done.then(|| WiringFound::of(&self.answers))
    }

    fn go_on(&mut self, from: usize) {
        let n = self.n_channels();
        let mut onward = (1..=n).map(|step| (from + step) % n);
        self.at = onward.find(|channel| self.answers[*channel].is_none());
        if self.at.is_some() {
            return;
        }
        self.conflicts = self.contradictions();
        let doubtful: Vec<usize> = self
            .conflicts
            .iter()
            .flat_map(|c| c.channels.clone())
            .collect();
        for channel in &doubtful {
            self.answers[*channel] = None;
        }
        self.at = doubtful.first().copied();
    }

    fn contradictions(&self) -> Vec<Conflict> {
        let of = |contactor| Conflict {
            contactor,
            channels: self.channels_of(contactor),
        };
        let all = (0..self.n_channels()).map(of);
        all.filter(|conflict| conflict.channels.len() > 1).collect()
    }
}

/// What a walk found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WiringFound {
    /// The channel of each contactor. Contactors that no channel drives share out the channels
    /// that drive nothing, so that each channel stands here once.
    pub channels: Vec<u16>,
    /// Channels that drive nothing.
    pub(crate) dead_channels: Vec<usize>,
    /// Contactors that no channel drives.
    pub(crate) silent_contactors: Vec<usize>,
}

impl WiringFound {
    fn of(answers: &[Option<Answer>]) -> Self {
        let mut channels: Vec<Option<usize>> = vec![None; answers.len()];
        let mut dead_channels = Vec::new();
        for (channel, answer) in answers.iter().enumerate() {
            let slot = match answer {
                Some(Answer::Contactor(contactor)) => channels.get_mut(*contactor),
                _ => None,
            };
            match slot {
                Some(slot) => *slot = Some(channel),
                None => dead_channels.push(channel),
            }
        }
        let is_silent = |contactor: &usize| channels[*contactor].is_none();
        let silent_contactors: Vec<usize> = (0..answers.len()).filter(is_silent).collect();
        // A dead channel stays where it ought to be, if that contactor is silent too.
        let mut spare = dead_channels.clone();
        for contactor in &silent_contactors {
            if let Some(at) = spare.iter().position(|channel| channel == contactor) {
                channels[*contactor] = Some(spare.remove(at));
            }
        }
        let mut spare = spare.into_iter();
        let whole = channels.into_iter().map(|channel| {
            let channel = channel.or_else(|| spare.next()).unwrap_or_default();
            u16::try_from(channel).unwrap_or(u16::MAX)
        });
        Self {
            channels: whole.collect(),
            dead_channels,
            silent_contactors,
        }
    }

    /// Whether every channel drives the contactor of its own number.
    pub fn is_straight(&self) -> bool {
        self.dead_channels.is_empty() && self.misplaced().next().is_none()
    }

    /// Contactors whose two channels are exchanged, the lower one first.
    pub fn swapped(&self) -> Vec<(usize, usize)> {
        let pairs = self.misplaced().filter_map(|(contactor, channel)| {
            let other = self.channels.get(channel).copied().map(usize::from);
            (other == Some(contactor) && contactor < channel && self.is_driven(channel))
                .then_some((contactor, channel))
        });
        pairs.collect()
    }

    /// Contactors on a channel of another number that are no mere exchange: `(contactor, channel)`.
    pub fn moved(&self) -> Vec<(usize, usize)> {
        let swapped = self.swapped();
        let is_alone = |(contactor, _): &(usize, usize)| {
            !swapped
                .iter()
                .any(|(a, b)| a == contactor || b == contactor)
        };
        self.misplaced().filter(is_alone).collect()
    }

    /// What was found, in lines for people.
    pub fn lines(&self) -> Vec<String> {
        if self.is_straight() {
            let n = self.channels.len();
            return vec![format!(
                "all {n} channels drive the contactor of their number"
            )];
        }
        let listed = |numbers: &[usize]| {
            let digits: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            digits.join(", ")
        };
        let swapped = self.swapped().into_iter();
        let mut lines: Vec<String> = swapped
            .map(|(a, b)| format!("contactors {a} and {b} are swapped"))
            .collect();
        let moved = self.moved().into_iter();
        lines.extend(moved.map(|(at, channel)| format!("contactor {at} is on channel {channel}")));
        if !self.dead_channels.is_empty() {
            let (dead, silent) = (listed(&self.dead_channels), listed(&self.silent_contactors));
            lines.push(format!("nothing is felt of channel {dead}"));
            lines.push(format!(
                "no channel drives contactor {silent}: switched off"
            ));
        }
        lines
    }

    /// The profile with this wiring, measured on the device of this number. Contactors that no
    /// channel drives are switched off; one that was off stays off.
    #[must_use]
    pub fn in_profile(&self, profile: &ArrayProfile, device_uid: DeviceUid) -> ArrayProfile {
        let mut profile = profile.clone();
        profile.wiring = Some(Wiring {
            device_uid,
            channels: self.channels.clone(),
        });
        for contactor in &self.silent_contactors {
            let mut calibration = profile.calibration_of(*contactor);
            calibration.is_off = true;
            profile.set_calibration(*contactor, calibration);
        }
        profile
    }

    fn is_driven(&self, contactor: usize) -> bool {
        !self.silent_contactors.contains(&contactor)
    }

    /// Contactors that are driven, and by a channel of another number.
    fn misplaced(&self) -> impl Iterator<Item = (usize, usize)> {
        let wired = self.channels.iter().map(|channel| usize::from(*channel));
        let misplaced = wired
            .enumerate()
            .filter(|(contactor, channel)| contactor != channel);
        misplaced.filter(|(contactor, _)| self.is_driven(*contactor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walks channels whose truth is `driven[channel]`, answering truly; the channels asked.
    fn walk(walk: &mut WiringWalk, driven: &[Option<usize>]) -> Vec<usize> {
        let mut asked = Vec::new();
        while let Some(channel) = walk.channel() {
            asked.push(channel);
            assert!(asked.len() < 100, "it must come to an end");
            let answer = driven[channel].map_or(Answer::Nothing, Answer::Contactor);
            assert!(walk.answer(answer));
        }
        asked
    }

    #[test]
    fn straight_wiring_is_the_identity() {
        let mut all = WiringWalk::new(4);
        assert_eq!(all.found(), None);
        let truth = [0, 1, 2, 3].map(Some);
        assert_eq!(walk(&mut all, &truth), [0, 1, 2, 3]);
        let found = all.found().unwrap();
        assert_eq!(found.channels, [0, 1, 2, 3]);
        assert!(found.is_straight());
        assert_eq!(
            found.lines(),
            ["all 4 channels drive the contactor of their number"]
        );
        assert!(!all.answer(Answer::Nothing), "nothing is asked any more");
    }

    #[test]
    fn swapped_moved_and_dead_channels_are_named() {
        // Channel 0 ↔ 1 exchanged, 2 → 3 → 4 → 2 in a ring, 5 dead, 6 straight.
        let truth = [Some(1), Some(0), Some(3), Some(4), Some(2), None, Some(6)];
        let mut all = WiringWalk::new(7);
        walk(&mut all, &truth);
        let found = all.found().unwrap();
        assert_eq!(found.channels, [1, 0, 4, 2, 3, 5, 6]);
        assert_eq!(found.swapped(), [(0, 1)]);
        assert_eq!(found.moved(), [(2, 4), (3, 2), (4, 3)]);
        assert_eq!(
            (found.dead_channels.clone(), found.silent_contactors.clone()),
            (vec![5], vec![5])
        );
        let lines = found.lines().join("\n");
        assert!(lines.contains("contactors 0 and 1 are swapped"), "{lines}");
        assert!(lines.contains("contactor 3 is on channel 2"), "{lines}");
        assert!(
            lines.contains("no channel drives contactor 5: switched off"),
            "{lines}"
        );
    }

    #[test]
    fn a_dead_channel_and_a_silent_contactor_elsewhere_are_paired_and_no_swap() {
        // Channel 0 is dead, and contactor 2 has no channel: channel 2 drives contactor 0.
        let mut all = WiringWalk::new(3);
        walk(&mut all, &[None, Some(1), Some(0)]);
        let found = all.found().unwrap();
        assert_eq!(found.channels, [2, 1, 0]);
        assert_eq!(found.swapped(), []);
        assert_eq!(found.moved(), [(0, 2)]);
        let uid = DeviceUid(*b"selvedge-emu");
        let before = ArrayProfile {
            rows: 1,
            cols: 3,
            ..ArrayProfile::default()
        };
        let profile = found.in_profile(&before, uid);
        assert_eq!(
            profile.wiring.as_ref().map(|wiring| wiring.device_uid),
            Some(uid)
        );
        let off: Vec<bool> = (0..3).map(|i| profile.calibration_of(i).is_off).collect();
        assert_eq!(off, [false, false, true]);
        assert!(profile.check().is_ok());
    }

    #[test]
    fn two_channels_on_one_contactor_are_asked_again_until_they_are_not() {
        let mut all = WiringWalk::new(3);
        for contactor in [0, 0, 2] {
            all.answer(Answer::Contactor(contactor));
        }
        let conflict = Conflict {
            contactor: 0,
            channels: vec![0, 1],
        };
        assert_eq!(all.conflicts(), [conflict]);
        assert_eq!(
            (all.found(), all.channel(), all.n_answered()),
            (None, Some(0), 1)
        );
        // The answer to one of them now contradicts one that was settled: that is asked again too.
        all.answer(Answer::Contactor(0));
        all.answer(Answer::Contactor(2));
        assert_eq!(all.conflicts()[0].channels, [1, 2]);
        all.answer(Answer::Contactor(1));
        assert_eq!(all.channel(), Some(2));
        all.answer(Answer::Contactor(2));
        assert_eq!(all.found().unwrap().channels, [0, 1, 2]);
        assert_eq!(all.conflicts(), []);
    }

    #[test]
    fn back_asks_the_channel_before_and_what_makes_no_sense_changes_nothing() {
        let mut all = WiringWalk::new(3);
        all.back();
        assert_eq!(all.channel(), Some(0));
        assert!(!all.answer(Answer::Contactor(3)), "there is no contactor 3");
        assert_eq!(all.channel(), Some(0));
        all.answer(Answer::Contactor(1));
        all.back();
        assert_eq!((all.channel(), all.n_answered()), (Some(0), 0));
        all.answer(Answer::Contactor(0));
        all.ask(7);
        assert_eq!((all.channel(), all.channels_of(0)), (Some(1), vec![0]));
        assert_eq!(WiringWalk::new(0).channel(), None);
        assert_eq!(WiringWalk::new(0).found(), None);
    }
}
