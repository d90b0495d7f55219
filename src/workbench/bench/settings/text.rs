//! Settings as TOML text and back.
//!
//! A key that is unknown is passed over, a value that is not understood leaves only its own
//! setting as at first: a file of a newer version, or one edited by hand, spoils nothing else.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use eframe::egui::ThemePreference;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::bench::command::DotStyle;
use crate::bench::overlays::Overlays;
use crate::bench::perspective::Perspective;
use crate::bench::rendering::Rendering;
use crate::bench::settings::preferences::Preferences;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_engine::Area;
use selvedge_foundation::files::{FileError, keys_from_str, keys_to_string, line_of_key};
use selvedge_render::array::Method;

const THEMES: [(ThemePreference, &str); 3] = [
    (ThemePreference::System, "system"),
    (ThemePreference::Dark, "dark"),
    (ThemePreference::Light, "light"),
];
const DOTS: [(DotStyle, &str); 3] = [
    (DotStyle::SizeAndGlow, "size and glow"),
    (DotStyle::Size, "size"),
    (DotStyle::Brightness, "brightness"),
];

/// The file, key by key.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct Keys {
    theme: Value<String>,
    zoom_percent: Value<f32>,
    colour_map: Value<String>,
    dots: Value<String>,
    overlays: Value<Vec<String>>,
    numbers: Value<bool>,
    grey_below_threshold: Value<bool>,
    all_off_on_focus_loss: Value<bool>,
    amplitude_top_um: Value<f64>,
    amplitude_locked: Value<bool>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    pixels_per_mm: Value<f64>,
    rendering_method: Value<String>,
    error_budget_db: Value<f64>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    array: Value<String>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    window_size: Value<[f32; 2]>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    sessions_folder: Value<String>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    experiment_design: Value<String>,
    recent_scenes: Value<Vec<PathBuf>>,
    perspective: Value<String>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    arrangement: Value<String>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    arrangement_cloth: Value<String>,
    #[serde(skip_serializing_if = "Value::is_missing")]
    arrangement_experiment: Value<String>,
    /// Tables come last in the file.
    #[serde(skip_serializing_if = "Value::is_missing")]
    tablet_areas_mm: Value<BTreeMap<String, [f64; 4]>>,
}

/// What a key states.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(untagged)]
enum Value<T> {
    /// Something that is understood.
    Known(T),
    /// Something else.
    Odd(#[serde(skip_serializing)] IgnoredAny),
    /// The key is not there.
    #[default]
    #[serde(skip)]
    Missing,
}

impl<T> From<Option<T>> for Value<T> {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Missing, Self::Known)
    }
}

impl<T> Value<T> {
    fn is_missing(&self) -> bool {
        matches!(self, Self::Missing)
    }
}

/// The settings that `text` states, and the first line of it that was not understood.
///
/// # Errors
/// This is not TOML at all.
pub(crate) fn read(text: &str, path: &Path) -> Result<(Preferences, Option<usize>), FileError> {
    let keys: Keys = keys_from_str(text, path)?;
    let mut odd = Vec::new();
    let preferences = preferences(keys, &mut odd).in_bounds();
    let lines = odd.into_iter().map(|key| line_of_key(text, "", 0, key));
    Ok((preferences, lines.min()))
}

/// Gathers the settings; the names of keys whose values are not understood go to `odd`.
fn preferences(keys: Keys, odd: &mut Vec<&'static str>) -> Preferences {
    let first = Preferences::default();
    let theme = choice(taken("theme", keys.theme, odd), &THEMES);
    let map = choice(taken("colour_map", keys.colour_map, odd), &colour_maps());
    let dots = choice(taken("dots", keys.dots, odd), &DOTS);
    let method = choice(
        taken("rendering_method", keys.rendering_method, odd),
        &methods(),
    );
    let perspective = choice(taken("perspective", keys.perspective, odd), &perspectives());
    for (key, is_odd) in [
        ("perspective", perspective.is_err()),
        ("theme", theme.is_err()),
        ("colour_map", map.is_err()),
        ("dots", dots.is_err()),
        ("rendering_method", method.is_err()),
    ] {
        if is_odd {
            odd.push(key);
        }
    }
    let zoom_percent = taken("zoom_percent", keys.zoom_percent, odd);
    let top_um = taken("amplitude_top_um", keys.amplitude_top_um, odd);
    let is_locked = taken("amplitude_locked", keys.amplitude_locked, odd);
    let scale = top_um.map_or(first.amplitude, |um| first.amplitude.locked_at(um));
    let budget_db = taken("error_budget_db", keys.error_budget_db, odd);
    let recent = taken("recent_scenes", keys.recent_scenes, odd);
    Preferences {
        theme: theme.ok().flatten().unwrap_or(first.theme),
        colour_map: map.ok().flatten().unwrap_or(first.colour_map),
        zoom: zoom_percent.map_or(first.zoom, |percent| percent / 100.0),
        dots: dots.ok().flatten().unwrap_or(first.dots),
        overlays: overlays(keys.overlays, odd).unwrap_or(first.overlays),
        has_numbers: taken("numbers", keys.numbers, odd).unwrap_or(first.has_numbers),
        greys_below: taken("grey_below_threshold", keys.grey_below_threshold, odd)
            .unwrap_or(first.greys_below),
        stops_on_focus_loss: taken("all_off_on_focus_loss", keys.all_off_on_focus_loss, odd)
            .unwrap_or(first.stops_on_focus_loss),
        amplitude: scale.with_lock(is_locked.unwrap_or_else(|| scale.is_locked())),
        pixels_per_mm: taken("pixels_per_mm", keys.pixels_per_mm, odd),
        rendering: Rendering {
            method: method.ok().flatten().unwrap_or(first.rendering.method),
            budget_db: budget_db.unwrap_or(first.rendering.budget_db),
        },
        perspective: perspective.ok().flatten().unwrap_or(first.perspective),
        arrangements: [
            taken("arrangement", keys.arrangement, odd),
            taken("arrangement_cloth", keys.arrangement_cloth, odd),
            taken("arrangement_experiment", keys.arrangement_experiment, odd),
        ],
        array: taken("array", keys.array, odd),
        tablet_areas: areas(keys.tablet_areas_mm, odd),
        window_size: taken("window_size", keys.window_size, odd),
        sessions_folder: taken("sessions_folder", keys.sessions_folder, odd),
        design: taken("experiment_design", keys.experiment_design, odd),
        ..first
    }
    .with_recent_scenes(recent.unwrap_or_default())
}

/// The overlays, unless one of the words stands for none.
fn overlays(value: Value<Vec<String>>, odd: &mut Vec<&'static str>) -> Option<Overlays> {
    let words = taken("overlays", value, odd)?;
    let overlays = Overlays::from_words(&words);
    if overlays.is_none() {
        odd.push("overlays");
    }
    overlays
}

/// The areas of tablets; one that is none leaves only its tablet as at first.
fn areas(
    value: Value<BTreeMap<String, [f64; 4]>>,
    odd: &mut Vec<&'static str>,
) -> BTreeMap<String, Area> {
    const KEY: &str = "tablet_areas_mm";
    let mut areas = BTreeMap::new();
    for (name, numbers) in taken(KEY, value, odd).unwrap_or_default() {
        if let Ok(area) = Area::of(numbers) {
            areas.insert(name, area);
        } else {
            odd.push(KEY);
        }
    }
    areas
}

fn taken<T>(key: &'static str, value: Value<T>, odd: &mut Vec<&'static str>) -> Option<T> {
    match value {
        Value::Known(known) => Some(known),
        Value::Missing => None,
        Value::Odd(_) => {
            odd.push(key);
            None
        }
    }
}

/// What a word stands for; `Err` for a word that stands for nothing.
fn choice<T: Copy>(word: Option<String>, table: &[(T, &str)]) -> Result<Option<T>, ()> {
    let Some(word) = word else {
        return Ok(None);
    };
    let found = table.iter().find(|(_, name)| *name == word);
    found.map(|(value, _)| Some(*value)).ok_or(())
}

fn word<T: PartialEq>(value: &T, table: &[(T, &str)]) -> Option<String> {
    let found = table.iter().find(|(known, _)| known == value);
    found.map(|(_, name)| (*name).to_owned())
}

fn colour_maps() -> [(ColourMap, &'static str); 3] {
    ColourMap::ALL.map(|map| (map, map.label()))
}

fn perspectives() -> [(Perspective, &'static str); Perspective::ALL.len()] {
    Perspective::ALL.map(|one| (one, one.word()))
}

fn methods() -> [(Method, &'static str); 4] {
    Method::ALL.map(|method| (method, method.name()))
}

/// The settings as the text of a file. Scenes whose paths are no text are left out.
pub(crate) fn write(preferences: &Preferences, path: &Path) -> Result<String, FileError> {
    let recent = preferences.recent_scenes.iter();
    let is_text = |path: &&PathBuf| path.to_str().is_some();
    let keys = Keys {
        theme: word(&preferences.theme, &THEMES).into(),
        zoom_percent: Value::Known((preferences.zoom * 100.0).round()),
        colour_map: word(&preferences.colour_map, &colour_maps()).into(),
        dots: word(&preferences.dots, &DOTS).into(),
        overlays: Value::Known(preferences.overlays.words()),
        numbers: Value::Known(preferences.has_numbers),
        grey_below_threshold: Value::Known(preferences.greys_below),
        all_off_on_focus_loss: Value::Known(preferences.stops_on_focus_loss),
        amplitude_top_um: Value::Known(preferences.amplitude.most_um()),
        amplitude_locked: Value::Known(preferences.amplitude.is_locked()),
        pixels_per_mm: preferences.pixels_per_mm.into(),
        rendering_method: word(&preferences.rendering.method, &methods()).into(),
        error_budget_db: Value::Known(preferences.rendering.budget_db),
        array: preferences.array.clone().into(),
        window_size: preferences.window_size.into(),
        sessions_folder: preferences.sessions_folder.clone().into(),
        experiment_design: preferences.design.clone().into(),
        recent_scenes: Value::Known(recent.filter(is_text).cloned().collect()),
        perspective: word(&preferences.perspective, &perspectives()).into(),
        arrangement: preferences.arrangements[0].clone().into(),
        arrangement_cloth: preferences.arrangements[1].clone().into(),
        tablet_areas_mm: Some(&preferences.tablet_areas)
            .filter(|areas| !areas.is_empty())
            .map(|areas| {
                let areas = areas.iter();
                areas
                    .map(|(name, area)| (name.clone(), area.numbers()))
                    .collect()
            })
            .into(),
        arrangement_experiment: preferences.arrangements[2].clone().into(),
    };
    keys_to_string(&keys, path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::amplitude::AmplitudeScale;
    use crate::bench::overlays::Overlay;
    use selvedge_textile::tactile::Band;

    fn path() -> &'static Path {
        Path::new("settings.toml")
    }

    #[test]
    fn every_setting_survives_writing_and_reading() {
        let preferences = Preferences {
            theme: ThemePreference::Light,
            colour_map: ColourMap::Cividis,
            zoom: 1.5,
            dots: DotStyle::Brightness,
            overlays: Overlays::default()
                .toggled(Overlay::Motion)
                .toggled(Overlay::Map(Band::High)),
            has_numbers: true,
            greys_below: false,
            stops_on_focus_loss: true,
            amplitude: AmplitudeScale::default().locked_at(200.0).with_lock(false),
            pixels_per_mm: Some(3.78),
            rendering: Rendering {
                method: Method::Banded,
                budget_db: 0.0,
            },
            perspective: Perspective::Cloth,
            arrangements: [
                Some("{\"tiles\":[1,'2'],\n\"a\":\"\\\\b\"}".to_owned()),
                Some("{}".to_owned()),
                Some("[]".to_owned()),
            ],
            array: Some("rig \"2\"".to_owned()),
            tablet_areas: [("Pen \"S\" 5.1", [-3.5, 20.0, 216.0, 135.25])]
                .map(|(name, area)| (name.to_owned(), Area::of(area).unwrap()))
                .into(),
            window_size: Some([1600.0, 1000.5]),
            sessions_folder: Some("/lab/study 1".to_owned()),
            design: Some("odd-one-out".to_owned()),
            ..Preferences::default()
        };
        let scenes = ["/a/ä b.scene.toml", "/c.toml"].map(PathBuf::from);
        let preferences = preferences.with_recent_scenes(scenes.to_vec());
        let text = write(&preferences, path()).unwrap();
        assert_eq!(read(&text, path()).unwrap(), (preferences, None), "{text}");
        assert!(text.contains("zoom_percent = 150"), "{text}");
    }

    #[test]
    fn settings_as_at_first_survive_too_and_so_does_no_text_at_all() {
        let text = write(&Preferences::default(), path()).unwrap();
        assert_eq!(read(&text, path()).unwrap(), (Preferences::default(), None));
        assert_eq!(read("", path()).unwrap(), (Preferences::default(), None));
    }

    #[test]
    fn a_file_from_before_perspectives_arranges_the_first_one() {
        let (preferences, odd) = read("arrangement = \"a tree\"\n", path()).unwrap();
        assert_eq!((preferences.perspective, odd), (Perspective::Explore, None));
        assert_eq!(
            preferences.arrangements,
            [Some("a tree".to_owned()), None, None]
        );
        let (preferences, odd) =
            read("theme = \"dark\"\nperspective = \"moon\"\n", path()).unwrap();
        assert_eq!(
            (preferences.perspective, odd),
            (Perspective::Explore, Some(2))
        );
    }

    #[test]
    fn keys_of_a_newer_version_are_passed_over() {
        let text = "theme = \"dark\"\n[sound]\nvolume = 3\n";
        let (preferences, odd) = read(text, path()).unwrap();
        assert_eq!((preferences.theme, odd), (ThemePreference::Dark, None));
    }

    #[test]
    fn a_value_that_is_not_understood_spoils_only_itself() {
        let text = "zoom_percent = 150\ntheme = \"sepia\"\nnumbers = 3\nwindow_size = [1400]\n\
                    rendering_method = \"magic\"\nerror_budget_db = \"none\"\n\
                    overlays = [\"points\", \"ghosts\"]\n";
        let (preferences, odd) = read(text, path()).unwrap();
        assert_eq!((preferences.zoom, odd), (1.5, Some(2)));
        let others = Preferences {
            zoom: 1.0,
            ..preferences
        };
        assert_eq!(others, Preferences::default());
    }

    #[test]
    fn odd_numbers_are_brought_within_bounds() {
        let text = "zoom_percent = 900\namplitude_top_um = nan\npixels_per_mm = inf\n";
        let (preferences, odd) = read(text, path()).unwrap();
        assert_eq!((preferences.zoom, odd), (2.0, None));
        assert_eq!(preferences.amplitude, AmplitudeScale::default());
        assert_eq!(preferences.pixels_per_mm, Some(60.0));
    }

    #[test]
    fn what_is_not_toml_is_refused_with_its_line() {
        let error = read("theme = \"dark\"\n= 3\n", path())
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("settings.toml:2: "), "{error}");
    }
}
