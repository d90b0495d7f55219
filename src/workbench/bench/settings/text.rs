//! Settings as TOML text and back.
//!
//! A key that is unknown is passed over, a value that is not understood leaves only its own
//! setting as at first: a file of a newer version, or one edited by hand, spoils nothing else.

use std::path::Path;

use crate::bench::settings::preferences::Preferences;
use selvedge_foundation::files::{FileError, keys_to_string, known_keys_from_str};

/// The settings that `text` states, and the first line of it that was not understood.
///
/// # Errors
/// This is not TOML at all.
pub(crate) fn read(text: &str, path: &Path) -> Result<(Preferences, Option<usize>), FileError> {
    let (known, odd): (Preferences, _) = known_keys_from_str(text, path)?;
    Ok((known.in_bounds(), odd))
}

/// The settings as the text of a file. Scenes whose paths are no text are left out.
pub(crate) fn write(preferences: &Preferences, path: &Path) -> Result<String, FileError> {
    keys_to_string(preferences, path)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use eframe::egui::ThemePreference;

    use super::*;
    use crate::bench::overlays::{Overlay, Overlays};
    use crate::bench::part::DotStyle;
    use crate::bench::perspective::Perspective;
    use crate::bench::rendering::Rendering;
    use crate::kit::amplitude::AmplitudeScale;
    use crate::kit::theme::colour_map::ColourMap;
    use selvedge_engine::Area;
    use selvedge_render::array::Method;
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
        let preferences = Preferences {
            recent_scenes: scenes.to_vec(),
            ..preferences
        };
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
