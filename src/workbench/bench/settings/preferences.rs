//! What is kept between two runs: plain values, always within bounds.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use eframe::egui::ThemePreference;
use serde::{Deserialize, Serialize};

use crate::bench::chosen_keys::ChosenKeys;
use crate::bench::overlays::Overlays;
use crate::bench::part::DotStyle;
use crate::bench::perspective::Perspective;
use crate::bench::rendering::Rendering;
use crate::bench::settings::hand::HandTools;
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::spectrum_scale::SpectrumScale;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_foundation::files::{FileError, keys_to_string, known_keys_from_str};

/// Most scenes that are remembered.
const MAX_RECENT: usize = 10;
/// Bounds of the size of everything: 100 to 200 %.
const ZOOM: [f32; 2] = [1.0, 2.0];
/// Bounds of a screen's pixels per millimetre: 25 to 1500 per inch.
const PIXELS_PER_MM: [f64; 2] = [1.0, 60.0];
/// Smallest and largest width of the window, points.
const WIDTH: [f32; 2] = [960.0, 16_384.0];
/// Smallest and largest height of the window, points.
const HEIGHT: [f32; 2] = [600.0, 16_384.0];
/// Smallest and largest height of the line of time, points.
pub(crate) const TIMELINE_HEIGHT: [f32; 2] = [68.0, 420.0];

/// What is kept between two runs. A key that a file does not state is as at first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Preferences {
    /// Dark, light, or as the system.
    #[serde(with = "ThemeWord")]
    pub theme: ThemePreference,
    /// The colours that stand for numbers.
    pub(crate) colour_map: ColourMap,
    /// Size of everything: 1 is 100 %.
    #[serde(rename = "zoom_percent", with = "percent")]
    pub(crate) zoom: f32,
    /// How contactors are drawn.
    pub(crate) dots: DotStyle,
    /// What is drawn over the cloth.
    #[serde(with = "overlay_words")]
    pub(crate) overlays: Overlays,
    /// Whether heatmaps show numbers.
    #[serde(rename = "numbers")]
    pub(crate) has_numbers: bool,
    /// Whether what is below the threshold of detection is greyed.
    #[serde(rename = "grey_below_threshold")]
    pub(crate) greys_below: bool,
    /// Whether an armed device stops when the window loses the keyboard.
    #[serde(rename = "all_off_on_focus_loss")]
    pub(crate) stops_on_focus_loss: bool,
    /// Whether what developers of firmware and renderers need is shown too.
    pub(crate) developer_tools: bool,
    /// The scales on which things are drawn.
    #[serde(flatten)]
    pub(crate) scales: Scales,
    /// How scenes are rendered.
    #[serde(flatten)]
    pub rendering: Rendering,
    /// What the window is arranged for.
    pub(crate) perspective: Perspective,
    /// Where each pane stands in each perspective, as text that whoever arranges them understands.
    #[serde(flatten, with = "arrangement_keys")]
    pub(crate) arrangements: [Option<String>; Perspective::ALL.len()],
    /// The array profile that was chosen; `None`: the one of the scene's display.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub array: Option<String>,
    /// Size of the window, points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) window_size: Option<[f32; 2]>,
    /// The sound of what is felt.
    #[serde(flatten)]
    pub(crate) sound: SoundPreferences,
    /// Folders that the user works in.
    #[serde(flatten)]
    pub(crate) folders: KnownFolders,
    /// The scenes that were opened or saved last, newest first, by absolute path.
    #[serde(with = "scene_paths")]
    pub(crate) recent_scenes: Vec<PathBuf>,
    /// What the hand holds.
    #[serde(flatten)]
    pub(crate) hand: HandTools,
    /// The keys that the user gave to acts.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(crate) keys: ChosenKeys,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: ThemePreference::System,
            colour_map: ColourMap::default(),
            zoom: ZOOM[0],
            dots: DotStyle::default(),
            overlays: Overlays::default(),
            has_numbers: false,
            greys_below: true,
            stops_on_focus_loss: false,
            developer_tools: false,
            scales: Scales::default(),
            rendering: Rendering::default(),
            perspective: Perspective::default(),
            arrangements: Default::default(),
            array: None,
            hand: HandTools::default(),
            keys: ChosenKeys::new(),
            window_size: None,
            folders: KnownFolders::default(),
            sound: SoundPreferences::default(),
            recent_scenes: Vec::new(),
        }
    }
}

impl Preferences {
    /// The preferences that a TOML text states, and the first line of it that was not understood.
    ///
    /// A key that is unknown is passed over, a value that is not understood leaves only its own
    /// setting as at first: a file of a newer version, or one edited by hand, spoils nothing else.
    ///
    /// # Errors
    /// This is not TOML at all.
    pub(crate) fn from_text(text: &str, path: &Path) -> Result<(Self, Option<usize>), FileError> {
        let (known, odd): (Self, _) = known_keys_from_str(text, path)?;
        Ok((known.in_bounds(), odd))
    }

    /// The same as the text of a file. Scenes whose paths are no text are left out.
    pub(crate) fn to_text(&self, path: &Path) -> Result<String, FileError> {
        keys_to_string(self, path)
    }

    /// The same with every value at the nearest bound; what is no number is as at first.
    pub(crate) fn in_bounds(self) -> Self {
        let within = |value: f32, [least, most]: [f32; 2]| {
            let number = if value.is_nan() { least } else { value };
            number.clamp(least, most)
        };
        let per_mm = self.scales.pixels_per_mm.filter(|per_mm| !per_mm.is_nan());
        let size = self
            .window_size
            .filter(|size| !size.iter().any(|x| x.is_nan()));
        Self {
            zoom: within(self.zoom, ZOOM),
            rendering: self.rendering.in_bounds(),
            scales: Scales {
                timeline_height: within(self.scales.timeline_height, TIMELINE_HEIGHT),
                pixels_per_mm: per_mm.map(|x| x.clamp(PIXELS_PER_MM[0], PIXELS_PER_MM[1])),
                ..self.scales
            },
            window_size: size.map(|[width, height]| [within(width, WIDTH), within(height, HEIGHT)]),
            ..self
        }
    }

    /// Remembers that the scene at `path` was opened or saved now.
    pub(crate) fn remember_scene(&mut self, path: &Path) {
        let Ok(path) = std::path::absolute(path) else {
            return;
        };
        self.recent_scenes.retain(|known| *known != path);
        self.recent_scenes.insert(0, path);
        self.recent_scenes.truncate(MAX_RECENT);
    }
}

/// The scales on which things are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Scales {
    /// That of amplitudes.
    #[serde(flatten)]
    pub(crate) amplitude: AmplitudeScale,
    /// That of spectrograms.
    #[serde(flatten)]
    pub(crate) spectrum: SpectrumScale,
    /// Height of the line of time, points.
    #[serde(default = "first_height")]
    pub(crate) timeline_height: f32,
    /// Pixels per millimetre of the screen, once it was calibrated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) pixels_per_mm: Option<f64>,
}

impl Default for Scales {
    fn default() -> Self {
        Self {
            amplitude: AmplitudeScale::default(),
            spectrum: SpectrumScale::default(),
            timeline_height: first_height(),
            pixels_per_mm: None,
        }
    }
}

fn first_height() -> f32 {
    132.0
}

/// The sound of what is felt: off at first.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct SoundPreferences {
    /// Whether it is on.
    #[serde(rename = "sound_on")]
    pub(crate) is_on: bool,
    /// How loud it is.
    #[serde(rename = "sound_volume")]
    pub(crate) loudness: Loudness,
    /// Whether 40 Hz itself sounds in place of its overtones.
    #[serde(rename = "sound_as_driven")]
    pub(crate) as_driven: bool,
}

/// How loud the sound of what is felt is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Loudness {
    /// 30 % of the ceiling.
    Quiet,
    /// 60 %.
    #[default]
    Middle,
    /// All of it.
    Loud,
}

impl Loudness {
    /// Of the ceiling, 0…1.
    pub(crate) fn share(self) -> f32 {
        match self {
            Self::Quiet => 0.3,
            Self::Middle => 0.6,
            Self::Loud => 1.0,
        }
    }
}

/// Folders that the user works in, and the design.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct KnownFolders {
    /// The one in which sessions of experiments lie, as it was typed.
    #[serde(rename = "sessions_folder", skip_serializing_if = "Option::is_none")]
    pub(crate) sessions: Option<String>,
    /// Those of textiles that were added to the libraries, by absolute path.
    #[serde(rename = "library_folders", skip_serializing_if = "Vec::is_empty")]
    pub(crate) libraries: Vec<PathBuf>,
    /// The design that was chosen last: the name of one of the program, or the path of a file.
    #[serde(rename = "experiment_design", skip_serializing_if = "Option::is_none")]
    pub(crate) design: Option<String>,
}

/// What a file calls a theme.
#[derive(Serialize, Deserialize)]
#[serde(remote = "ThemePreference", rename_all = "lowercase")]
enum ThemeWord {
    System,
    Dark,
    Light,
}

/// A share as a whole number of hundredths.
mod percent {
    use serde::{Deserialize as _, Deserializer, Serializer};

    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands a reference over"
    )]
    pub(super) fn serialize<S: Serializer>(share: &f32, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_f32((share * 100.0).round())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
        Ok(f32::deserialize(from)? / 100.0)
    }
}

/// Overlays by their names.
mod overlay_words {
    use serde::de::Error as _;
    use serde::{Deserialize as _, Deserializer, Serialize as _, Serializer};

    use super::Overlays;

    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands a reference over"
    )]
    pub(super) fn serialize<S: Serializer>(overlays: &Overlays, to: S) -> Result<S::Ok, S::Error> {
        overlays.words().serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Overlays, D::Error> {
        let words = Vec::<String>::deserialize(from)?;
        Overlays::from_words(&words).ok_or_else(|| D::Error::custom("no overlay"))
    }
}

/// The arrangement of every perspective has a key of its own.
mod arrangement_keys {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Keys {
        #[serde(skip_serializing_if = "Option::is_none")]
        arrangement: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        arrangement_cloth: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        arrangement_experiment: Option<String>,
    }

    pub(super) fn serialize<S: Serializer>(
        of: &[Option<String>; 3],
        to: S,
    ) -> Result<S::Ok, S::Error> {
        let [arrangement, arrangement_cloth, arrangement_experiment] = of.clone();
        let keys = Keys {
            arrangement,
            arrangement_cloth,
            arrangement_experiment,
        };
        keys.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<[Option<String>; 3], D::Error> {
        let keys = Keys::deserialize(from)?;
        Ok([
            keys.arrangement,
            keys.arrangement_cloth,
            keys.arrangement_experiment,
        ])
    }
}

/// Scenes from newest to oldest; paths that are no text, or relative, mean nothing in another run.
mod scene_paths {
    use std::path::PathBuf;

    use serde::{Deserialize as _, Deserializer, Serializer};

    use super::Preferences;

    pub(super) fn serialize<S: Serializer>(paths: &[PathBuf], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(paths.iter().filter_map(|path| path.to_str()))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Vec<PathBuf>, D::Error> {
        let paths = Vec::<PathBuf>::deserialize(from)?;
        let mut known = Preferences::default();
        for path in paths.iter().rev().filter(|path| path.is_absolute()) {
            known.remember_scene(path);
        }
        Ok(known.recent_scenes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_out_of_bounds_go_to_the_nearest_bound() {
        let preferences = Preferences {
            zoom: 9.0,
            scales: Scales {
                pixels_per_mm: Some(-3.0),
                ..Scales::default()
            },
            rendering: Rendering {
                budget_db: 7.0,
                ..Rendering::default()
            },
            window_size: Some([10.0, f32::INFINITY]),
            ..Preferences::default()
        };
        let preferences = preferences.in_bounds();
        assert_eq!(preferences.zoom, 2.0);
        assert_eq!(preferences.scales.pixels_per_mm, Some(1.0));
        assert_eq!(preferences.rendering.budget_db, 1.0);
        assert_eq!(preferences.window_size, Some([960.0, 16_384.0]));
    }

    #[test]
    fn what_is_no_number_is_as_at_first() {
        let preferences = Preferences {
            zoom: f32::NAN,
            scales: Scales {
                pixels_per_mm: Some(f64::NAN),
                ..Scales::default()
            },
            rendering: Rendering {
                budget_db: f64::NAN,
                ..Rendering::default()
            },
            window_size: Some([1400.0, f32::NAN]),
            ..Preferences::default()
        };
        assert_eq!(preferences.in_bounds(), Preferences::default());
    }

    #[test]
    fn recent_scenes_are_ten_newest_first_and_each_once() {
        let mut preferences = Preferences::default();
        for n in 0..14 {
            preferences.remember_scene(Path::new(&format!("/scenes/{n}.scene.toml")));
        }
        preferences.remember_scene(Path::new("/scenes/9.scene.toml"));
        assert_eq!(preferences.recent_scenes.len(), 10);
        assert_eq!(
            preferences.recent_scenes[0],
            Path::new("/scenes/9.scene.toml")
        );
        assert_eq!(
            preferences.recent_scenes[1],
            Path::new("/scenes/13.scene.toml")
        );
        preferences.remember_scene(Path::new("here.scene.toml"));
        assert!(
            preferences.recent_scenes[0].is_absolute(),
            "relative paths are made absolute"
        );
    }
}
