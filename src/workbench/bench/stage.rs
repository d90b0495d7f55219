//! What the operator of a public stage decides before it begins, and the faces that such a window
//! can be drawn in: plain values.

use std::fmt;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use serde::Deserialize;

use crate::bench::settings::{own_stage, stage_file};
use selvedge_foundation::files::{FileError, keys_from_str, read_text};

/// No amplitude on a stage exceeds this, percent of full scale.
const CEILING_PERCENT: f64 = 50.0;
/// The screen that a stage is drawn for where nothing is said of it: 24 inches, 16 : 9.
const SCREEN_MM: f64 = 531.0;
/// The shortest PIN, digits.
const SHORTEST_PIN: usize = 6;

/// What the operator decides: a file of keys, all of which may be absent.
#[derive(Clone, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Keys {
    /// Opens the operator's page.
    pin: Option<String>,
    /// Width of the screen, mm.
    screen_width_mm: f64,
    /// Largest amplitude, percent of full scale.
    ceiling_percent: f64,
    /// The port of the device; absent: the emulator.
    port: Option<PathBuf>,
    /// The folder of the log.
    log: Option<PathBuf>,
    /// Whether nothing moves that nobody moves.
    still: bool,
}

impl Default for Keys {
    fn default() -> Self {
        Self {
            pin: None,
            screen_width_mm: SCREEN_MM,
            ceiling_percent: CEILING_PERCENT,
            port: None,
            log: None,
            still: false,
        }
    }
}

/// What a stage begins with.
#[derive(Clone, Default)]
pub struct StageOptions {
    /// The scene; `None`: the one that the program ships. Its first four textiles are shown.
    pub scene: Option<PathBuf>,
    /// The folder of the log; `None`: nothing is written.
    pub log: Option<PathBuf>,
    /// What begins the order of questions.
    pub seed: u64,
    keys: Keys,
}

impl fmt::Debug for StageOptions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Never the PIN.
        let Self { scene, log, .. } = self;
        f.debug_struct("StageOptions")
            .field("scene", scene)
            .field("log", log)
            .finish_non_exhaustive()
    }
}

impl StageOptions {
    /// What the operator's file says; `None`: `stage.toml` in the folder of settings, if there is
    /// one. Paths in it start at its folder.
    ///
    /// # Errors
    /// It cannot be read, or asks for what a stage refuses.
    pub fn read(file: Option<&Path>) -> Result<Self, FileError> {
        let usual = stage_file().filter(|path| path.exists());
        let Some(path) = file.map(Path::to_owned).or(usual) else {
            return Ok(Self {
                log: own_stage(),
                ..Self::default()
            });
        };
        let mut stage = Self::from_text(&read_text(&path)?, &path)?;
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let log = stage.keys.log.as_deref();
        stage.log = log.map(|log| folder.join(log)).or_else(own_stage);
        Ok(stage)
    }

    /// What a text says that the operator wrote into a file.
    ///
    /// # Errors
    /// It is none, or asks for what a stage refuses.
    pub(crate) fn from_text(text: &str, path: &Path) -> Result<Self, FileError> {
        let keys: Keys = keys_from_str(text, path)?;
        let refuse = |what: String, mend: &str| Err(FileError::whole(path, what, mend));
        if let Some(pin) = &keys.pin
            && (pin.len() < SHORTEST_PIN || !pin.bytes().all(|digit| digit.is_ascii_digit()))
        {
            let what = format!("a PIN that is not {SHORTEST_PIN} digits or more");
            return refuse(what, "give digits alone, in quotes");
        }
        if !(1.0..=CEILING_PERCENT).contains(&keys.ceiling_percent) {
            let what = format!("ceiling_percent is {}", keys.ceiling_percent);
            return refuse(what, "give 1 to 50: a stage plays no louder");
        }
        if !(100.0..=5000.0).contains(&keys.screen_width_mm) {
            let what = format!("screen_width_mm is {}", keys.screen_width_mm);
            return refuse(what, "give the width of the picture, 100 to 5000 mm");
        }
        Ok(Self {
            keys,
            ..Self::default()
        })
    }

    /// Whether these digits are the PIN; never where there is none.
    pub(crate) fn is_pin(&self, digits: &str) -> bool {
        self.keys.pin.as_deref() == Some(digits)
    }

    /// Whether there is a PIN.
    pub fn has_pin(&self) -> bool {
        self.keys.pin.is_some()
    }

    /// Width of the screen, mm.
    pub(crate) fn screen_width_mm(&self) -> f64 {
        self.keys.screen_width_mm
    }

    /// Largest amplitude as a share of full scale.
    pub fn ceiling(&self) -> f64 {
        self.keys.ceiling_percent / 100.0
    }

    /// Whether nothing moves that nobody moves: no fading, no trail, no dancing dots.
    pub(crate) fn is_still(&self) -> bool {
        self.keys.still
    }

    /// The port of the device.
    pub(crate) fn port(&self) -> Option<&Path> {
        self.keys.port.as_deref()
    }
}

/// A state of the stage that is to be pictured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StagePicture {
    /// Nobody is there.
    Watching,
    /// A cloth is stroked.
    Touching,
    /// Guessing and feeling are offered.
    Offered,
    /// High voltage is on.
    Armed,
    /// A cloth is to be found.
    Guessing,
    /// One was chosen, and this was it.
    Told,
    /// Whether anybody is still there is asked.
    StillHere,
    /// How many were right.
    Ended,
    /// The operator's page before the PIN.
    Pin,
    /// The operator's page.
    Operator,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<StageOptions, String> {
        StageOptions::from_text(text, Path::new("stage.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn a_file_above_the_ceiling_or_with_a_short_pin_is_refused() {
        let stage = read("pin = \"123456\"\nceiling_percent = 20\n").unwrap();
        assert!(stage.is_pin("123456") && !stage.is_pin("123457"));
        assert!((stage.ceiling() - 0.2).abs() < 1e-12);
        let without = read("").unwrap();
        assert!(!without.has_pin() && !without.is_pin(""));
        assert!((without.ceiling() - 0.5).abs() < 1e-12);
        for (text, expected) in [
            ("ceiling_percent = 60", "a stage plays no louder"),
            ("pin = \"12345\"", "6 digits or more"),
            ("pin = \"12345a\"", "6 digits or more"),
            ("screen_width_mm = 24", "100 to 5000 mm"),
            ("ceiling_percent = nan", "1 to 50"),
            ("louder = true", "unknown field"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
        assert!(!format!("{stage:?}").contains("123456"));
    }
}
