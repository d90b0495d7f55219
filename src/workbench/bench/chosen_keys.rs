//! Keys that the user gave to acts in the place of those that they come with, as files hold them.

use std::collections::BTreeMap;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use serde::{Deserialize, Serialize};

/// Between two keys of one act.
pub(crate) const OR: &str = " or ";

/// Keys that the user gave to acts, by what the acts do; an act that is not there has its own.
pub(crate) type ChosenKeys = BTreeMap<String, Keys>;

/// The keys of one act; in files as they are written: `Ctrl+Y or F2`, empty for none.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub(crate) struct Keys(pub(crate) Vec<KeyboardShortcut>);

impl From<Keys> for String {
    fn from(Keys(keys): Keys) -> Self {
        let keys = keys.iter().map(|key| {
            let name = key.logical_key.name();
            modifiers_before(key.modifiers, false) + name
        });
        keys.collect::<Vec<_>>().join(OR)
    }
}

impl TryFrom<String> for Keys {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let keys = text.split(OR).filter(|key| !key.is_empty());
        keys.map(|key| read(key).ok_or_else(|| format!("no key is called {key:?}")))
            .collect::<Result<_, _>>()
            .map(Self)
    }
}

/// The key that is written so.
pub(crate) fn read(text: &str) -> Option<KeyboardShortcut> {
    let mut words: Vec<&str> = text.split('+').collect();
    let key = Key::from_name(words.pop()?)?;
    let modifiers = words.into_iter().try_fold(Modifiers::NONE, |held, word| {
        let modifier = match word {
            "Ctrl" => Modifiers::COMMAND,
            "Alt" => Modifiers::ALT,
            "Shift" => Modifiers::SHIFT,
            _ => return None,
        };
        Some(held.plus(modifier))
    })?;
    Some(KeyboardShortcut::new(modifiers, key))
}

/// The modifiers as they stand before a key.
pub(crate) fn modifiers_before(modifiers: Modifiers, is_mac: bool) -> String {
    [
        (modifiers.command, if is_mac { "Cmd+" } else { "Ctrl+" }),
        (modifiers.alt, "Alt+"),
        (modifiers.shift, "Shift+"),
    ]
    .into_iter()
    .filter_map(|(is_held, word)| is_held.then_some(word))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::acts;

    #[test]
    fn every_key_is_read_as_it_is_written_in_files_and_nonsense_is_none() {
        for act in acts::all() {
            let text = String::from(Keys(act.keys.clone()));
            assert_eq!(Keys::try_from(text.clone()).unwrap().0, act.keys, "{text}");
        }
        for text in ["Hyper+K", "Ctrl+Quux", "+", "Ctrl+"] {
            assert!(Keys::try_from(text.to_owned()).is_err(), "{text}");
        }
    }
}
