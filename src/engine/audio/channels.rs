//! Which channel of a card drives which contactor.

use std::str::FromStr;

use super::AudioError;

/// More channels than any card has.
const MAX_CHANNELS: u16 = 1024;

/// The card's channel of each contactor, in contactor order; each channel once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CardChannels(Vec<u16>);

impl CardChannels {
    /// The card's first channels, in order.
    pub fn first(n_contactors: usize) -> Self {
        Self((0..MAX_CHANNELS).take(n_contactors).collect())
    }

    /// Refuses a map for another number of contactors.
    ///
    /// # Errors
    /// Not one channel a contactor.
    pub fn check(&self, n_contactors: usize) -> Result<(), AudioError> {
        let n_channels = self.0.len();
        if n_channels == n_contactors {
            return Ok(());
        }
        Err(AudioError::Map {
            n_channels,
            n_contactors,
        })
    }
}

#[cfg(any(test, feature = "audio"))]
impl CardChannels {
    /// Contactors that have a channel: all.
    pub(super) fn n_contactors(&self) -> usize {
        self.0.len()
    }

    /// The fewest channels that a card must have.
    pub(super) fn n_needed(&self) -> usize {
        self.0.iter().max().map_or(0, |last| usize::from(*last) + 1)
    }

    /// Puts one sample a contactor into a card's frame; other channels are silent. A channel beyond
    /// the frame is left out.
    pub(super) fn spread(&self, samples: impl Iterator<Item = f32>, frame: &mut [f32]) {
        frame.fill(0.0);
        for (channel, sample) in self.0.iter().zip(samples) {
            if let Some(slot) = frame.get_mut(usize::from(*channel)) {
                *slot = sample;
            }
        }
    }
}

impl FromStr for CardChannels {
    type Err = String;

    /// Channels as cards count them, from 1, one after the other or from–to: `1,2,5-8`, `8-1`.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut channels = Vec::new();
        for part in text.split(',') {
            let (from, to) = part.split_once('-').unwrap_or((part, part));
            let (from, to) = (channel(from)?, channel(to)?);
            if from <= to {
                channels.extend(from..=to);
            } else {
                channels.extend((to..=from).rev());
            }
            if channels.len() > usize::from(MAX_CHANNELS) {
                return Err(format!(
                    "more than {MAX_CHANNELS} channels; give one a contactor"
                ));
            }
        }
        let mut sorted = channels.clone();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            let twice = pair[0] + 1;
            return Err(format!(
                "channel {twice} stands there twice; give each once"
            ));
        }
        Ok(Self(channels))
    }
}

/// A channel, counted from 0.
fn channel(text: &str) -> Result<u16, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|number| (1..=MAX_CHANNELS).contains(number));
    number
        .map(|number| number - 1)
        .ok_or_else(|| format!("\"{text}\" is no channel; give numbers from 1, such as 1,2,5-8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(text: &str) -> Result<Vec<u16>, String> {
        text.parse().map(|map: CardChannels| map.0)
    }

    #[test]
    fn channels_are_counted_from_1_and_ranges_run_both_ways() {
        assert_eq!(map("1"), Ok(vec![0]));
        assert_eq!(map("1,2,5-8"), Ok(vec![0, 1, 4, 5, 6, 7]));
        assert_eq!(map("4-1, 9"), Ok(vec![3, 2, 1, 0, 8]));
        assert_eq!(map("1024"), Ok(vec![1023]));
        assert_eq!(CardChannels::first(3).0, [0, 1, 2]);
    }

    #[test]
    fn what_is_no_map_is_refused_in_one_line() {
        for (text, words) in [
            ("", "\"\" is no channel"),
            ("0", "\"0\" is no channel"),
            ("1,", "\"\" is no channel"),
            ("a-b", "\"a\" is no channel"),
            ("1-2-3", "\"2-3\" is no channel"),
            ("-1", "\"\" is no channel"),
            ("1025", "\"1025\" is no channel"),
            ("1-4,3", "channel 3 stands there twice"),
            ("1-1024,1-1024", "more than 1024"),
        ] {
            let error = map(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }

    #[test]
    fn each_contactor_has_its_channel_and_the_others_are_silent() {
        let map: CardChannels = "3,1,6".parse().unwrap();
        assert_eq!((map.n_contactors(), map.n_needed()), (3, 6));
        let mut frame = [9.0; 8];
        map.spread([0.1, 0.2, 0.3].into_iter(), &mut frame);
        assert_eq!(frame, [0.2, 0.0, 0.1, 0.0, 0.0, 0.3, 0.0, 0.0]);
        let mut narrow = [9.0; 4];
        map.spread([0.1, 0.2, 0.3].into_iter(), &mut narrow);
        assert_eq!(narrow, [0.2, 0.0, 0.1, 0.0]);
        assert!(map.check(3).is_ok());
        let error = map.check(24).unwrap_err().to_string();
        assert!(
            error.contains("3 channels") && error.contains("24"),
            "{error}"
        );
    }
}
