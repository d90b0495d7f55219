//! Everything that can be asked to go wrong, as a table: what the command line takes as options and
//! the window shows as rows.
//!
//! An option is a word, a text that says how much, and the function that reads it. [`FaultWords`]
//! holds such texts; what they mean is [`Faults`].

mod table;

use std::collections::BTreeMap;

use super::Faults;
use crate::device::FirmwareLie;
use selvedge_foundation::named;
use table::{OPTIONS, Spoken};

/// The text that switches an option on.
const ON: &str = "on";

named! {
    /// What belongs together.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum FaultGroup {
        /// What holds for all of them.
        All = "Faults", "Faults",
        /// How long bytes take.
        Latency = "Latency", "Faults: latency",
        /// What becomes of bytes.
        Bytes = "Bytes", "Faults: bytes",
        /// The device's clock.
        Clock = "Clock", "Faults: the device's clock",
        /// What stands still at a told time.
        Stalls = "Stalls and cable",
            "Faults: stalls and cable (TIME since the start: 5s, or 5s+300ms for how long; \
                 5s,20s for two)",
        /// What breaks in the device.
        Device = "Device troubles", "Faults: the device (TIME as above)",
        /// Which channel moves what.
        Channels = "Channels", "Faults: channels",
        /// What the firmware does wrong.
        Firmware = "Firmware", "Faults: the firmware",
    }
    /// A word or two for people.
    pub fn name;
    /// Its heading on the command line.
    pub fn heading;
}

/// How often an option may be said, and whether it takes a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// It is on or off.
    Switch,
    /// It takes one value.
    One,
    /// It takes values separated by spaces.
    Many,
}

/// One thing that can be asked to go wrong.
#[derive(Debug)]
pub struct FaultOption {
    /// Its word on the command line, without dashes.
    pub name: &'static str,
    /// Its name for people.
    pub label: &'static str,
    /// Where it belongs.
    pub group: FaultGroup,
    /// What it takes.
    pub kind: FaultKind,
    /// What stands for its value on the command line; empty for a switch.
    pub value: &'static str,
    /// Its text when nothing is said, where that is a text.
    pub usual: &'static str,
    /// A text to begin with.
    pub example: &'static str,
    /// What happens, in a sentence without its stop.
    pub help: &'static str,
    read: fn(&mut Spoken, &str) -> Result<(), String>,
}

impl FaultOption {
    /// All of them, group by group.
    pub const ALL: &'static [Self] = OPTIONS;

    /// Whether a text can be read; otherwise one line says what was expected.
    pub fn check(&self, text: &str) -> Result<(), String> {
        (self.read)(&mut Spoken::default(), text)
    }

    /// Everything that can be said, a line each, for an option with too many values to be told in a
    /// sentence.
    pub fn listing(&self) -> Option<String> {
        (self.name == table::FIRMWARE_LIE).then(FirmwareLie::listing)
    }

    /// Whether a text makes anything go wrong by itself.
    pub fn bites(&self, text: &str) -> bool {
        let mut spoken = Spoken::default();
        let read = (self.read)(&mut spoken, text);
        read.is_ok() && !spoken.faults().is_none()
    }
}

/// Faults as people write them: a text for each option that is used.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaultWords {
    texts: BTreeMap<&'static str, String>,
}

impl FaultWords {
    /// The text of a switch that is on.
    pub const ON: &'static str = ON;

    /// The text of an option; empty where nothing is said.
    pub fn text(&self, option: &FaultOption) -> &str {
        self.texts.get(option.name).map_or("", String::as_str)
    }

    /// Says something else of an option; nothing where `text` is empty.
    pub fn say(&mut self, option: &FaultOption, text: &str) {
        if text.trim().is_empty() {
            self.texts.remove(option.name);
        } else {
            self.texts.insert(option.name, text.to_owned());
        }
    }

    /// Words for options by their names; unknown names are left out.
    pub fn of(pairs: &[(&str, &str)]) -> Self {
        let mut words = Self::default();
        for option in OPTIONS {
            let said = pairs.iter().find(|(name, _)| *name == option.name);
            words.say(option, said.map_or("", |(_, text)| text));
        }
        words
    }

    /// The options with a text, in the order of the table.
    pub fn said(&self) -> impl Iterator<Item = (&'static FaultOption, &str)> {
        let texts = OPTIONS.iter().map(|option| (option, self.text(option)));
        texts.filter(|(_, text)| !text.is_empty())
    }

    /// How many options make something go wrong.
    pub fn n_faults(&self) -> usize {
        self.said()
            .filter(|(option, text)| option.bites(text))
            .count()
    }

    /// What they mean.
    ///
    /// # Errors
    /// The first option whose text cannot be read, and one line that says what was expected.
    pub fn faults(&self) -> Result<Faults, (&'static FaultOption, String)> {
        let mut spoken = Spoken::default();
        for (option, text) in self.said() {
            (option.read)(&mut spoken, text).map_err(|why| (option, why))?;
        }
        Ok(spoken.faults())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_is_read_and_all_but_seed_and_way_make_something_go_wrong() {
        for option in OPTIONS {
            let is_switch = option.kind == FaultKind::Switch;
            let text = if is_switch { ON } else { option.example };
            assert_eq!(option.check(text), Ok(()), "{}", option.name);
            let is_general = option.group == FaultGroup::All;
            assert_eq!(option.bites(text), !is_general, "{}", option.name);
            if !option.usual.is_empty() {
                assert_eq!(option.check(option.usual), Ok(()), "{}", option.name);
                assert!(!option.bites(option.usual), "{}", option.name);
            }
        }
    }

    #[test]
    fn options_stand_group_by_group_under_names_of_their_own() {
        let place = |group| FaultGroup::ALL.iter().position(|one| *one == group);
        let order: Vec<_> = OPTIONS.iter().map(|option| place(option.group)).collect();
        assert!(order.is_sorted(), "{order:?}");
        let mut names: Vec<_> = OPTIONS.iter().map(|option| option.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), OPTIONS.len());
    }

    #[test]
    fn words_are_counted_read_and_refused_by_name() {
        let mut words = FaultWords::of(&[
            ("seed", "7"),
            ("drop", "0.1%"),
            ("flip", "0"),
            ("stall-reading-at", "1s, 2s+1s"),
            ("swap", "1,2 3,4"),
        ]);
        assert_eq!(words.n_faults(), 3);
        let faults = words.faults().unwrap();
        assert_eq!(faults.seed, 7);
        assert_eq!(faults.once.len(), 2);
        assert_eq!(faults.wiring.swapped, [[1, 2], [3, 4]]);
        words.say(&OPTIONS[0], "seven");
        let (option, why) = words.faults().unwrap_err();
        assert_eq!(option.name, "seed");
        assert!(why.contains("whole number"), "{why}");
        words.say(&OPTIONS[0], " ");
        assert_eq!(words.faults().unwrap().seed, 1);
    }
}
