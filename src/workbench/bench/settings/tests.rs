//! The file of the settings: missing, broken, newer, written.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::ThemePreference;

use crate::bench::overlays::{Overlay, Overlays};
use crate::bench::part::DotStyle;
use crate::bench::perspective::Perspective;
use crate::bench::rendering::Rendering;
use crate::bench::settings::Settings;
use crate::bench::settings::hand::HandTools;
use crate::bench::settings::preferences::{
    KnownFolders, Loudness, Preferences, Scales, SoundPreferences,
};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::spectrum_scale::{Handle, SpectrumScale};
use crate::kit::theme::colour_map::ColourMap;
use selvedge_engine::Area;
use selvedge_render::array::Method;
use selvedge_render::electrovibration::{Carrier, Electrovibration};
use selvedge_render::stylus::StylusSettings;
use selvedge_scratch::ScratchFolder;
use selvedge_textile::tactile::Band;

/// Waits for the write under way.
fn wait(settings: &mut Settings) -> Result<(), String> {
    let job = settings.file.as_mut().unwrap().writing.take();
    job.unwrap().join().unwrap().map_err(|e| e.to_string())
}

#[test]
fn a_missing_file_means_settings_as_at_first_and_makes_none() {
    let folder = ScratchFolder::made("missing");
    let (mut settings, notice) = Settings::in_folder(&folder.join("not/yet"));
    assert_eq!(
        (&settings.preferences, notice),
        (&Preferences::default(), None)
    );
    assert_eq!(settings.save_if_changed(0.0), None);
    settings.save_now().unwrap();
    assert!(!folder.join("not").exists(), "nothing changed");
}

#[test]
fn what_changed_is_there_in_the_next_run() {
    let folder = ScratchFolder::made("next");
    let home = folder.join("deep/inside");
    let (mut settings, _) = Settings::in_folder(&home);
    settings.preferences.zoom = 1.5;
    settings
        .preferences
        .remember_scene(Path::new("/a.scene.toml"));
    settings.save_if_changed(0.0);
    wait(&mut settings).unwrap();
    let (next, notice) = Settings::in_folder(&home);
    assert_eq!((next.preferences, notice), (settings.preferences, None));
    assert_eq!(fs::read_dir(&home).unwrap().count(), 1, "nothing beside it");
}

#[test]
fn changes_in_a_row_are_written_once_a_second_and_the_last_one_at_the_end() {
    let folder = ScratchFolder::made("row");
    let (mut settings, _) = Settings::in_folder(&folder);
    settings.preferences.zoom = 1.25;
    assert_eq!(settings.save_if_changed(10.0), None, "at once");
    wait(&mut settings).unwrap();
    settings.preferences.zoom = 1.5;
    assert_eq!(settings.save_if_changed(10.25), Some(0.75), "later");
    assert!(
        folder.read("settings.toml").contains("zoom_percent = 125"),
        "{}",
        folder.read("settings.toml")
    );
    assert_eq!(settings.save_if_changed(11.0), None, "now");
    wait(&mut settings).unwrap();
    assert!(
        folder.read("settings.toml").contains("zoom_percent = 150"),
        "{}",
        folder.read("settings.toml")
    );
    settings.preferences.zoom = 2.0;
    settings.save_now().unwrap();
    assert!(
        folder.read("settings.toml").contains("zoom_percent = 200"),
        "{}",
        folder.read("settings.toml")
    );
}

#[test]
fn a_broken_file_is_told_of_and_kept_under_another_name() {
    let folder = ScratchFolder::made("broken");
    for (aside, text) in [("", "zoom_percent = = 3"), ("-2", "\u{0}\u{1}")] {
        fs::write(folder.join("settings.toml"), text).unwrap();
        let (mut settings, notice) = Settings::in_folder(&folder);
        let notice = notice.unwrap();
        assert_eq!(settings.preferences, Preferences::default());
        assert!(notice.contains("settings.toml:1: "), "{notice}");
        assert!(
            notice.ends_with(&format!("settings.toml.broken{aside}")),
            "{notice}"
        );
        assert_eq!(notice.lines().count(), 1, "{notice}");
        let preferences = fs::read_to_string(folder.join(format!("settings.toml.broken{aside}")));
        assert_eq!(preferences.unwrap(), text);
        settings.save_now().unwrap();
        assert_eq!(Settings::in_folder(&folder).1, None, "whole again");
    }
}

#[test]
fn bytes_that_are_no_text_are_a_broken_file_too() {
    let folder = ScratchFolder::made("bytes");
    fs::write(folder.join("settings.toml"), [0xff, 0xfe, 0x00]).unwrap();
    let (settings, notice) = Settings::in_folder(&folder);
    assert_eq!(settings.preferences, Preferences::default());
    assert!(notice.unwrap().contains("UTF-8"));
    assert!(folder.join("settings.toml.broken").exists());
}

#[test]
fn one_value_that_is_not_known_is_told_of_and_the_others_stay() {
    let folder = ScratchFolder::made("odd");
    fs::write(
        folder.join("settings.toml"),
        "zoom_percent = 150\ntheme = 3\n",
    )
    .unwrap();
    let (mut settings, notice) = Settings::in_folder(&folder);
    assert_eq!(settings.preferences.zoom, 1.5);
    assert!(notice.unwrap().contains("settings.toml:2: "));
    settings.save_if_changed(0.0);
    wait(&mut settings).unwrap();
    let (next, notice) = Settings::in_folder(&folder);
    assert_eq!(
        (next.preferences.zoom, notice),
        (1.5, None),
        "it is written anew"
    );
}

#[test]
fn what_cannot_be_read_is_not_written_over() {
    let folder = ScratchFolder::made("unreadable");
    fs::create_dir(folder.join("settings.toml")).unwrap();
    let (mut settings, notice) = Settings::in_folder(&folder);
    assert!(notice.unwrap().contains("settings.toml"));
    settings.preferences.zoom = 2.0;
    settings.save_if_changed(0.0);
    settings.save_now().unwrap();
    assert!(folder.join("settings.toml").is_dir());
}

#[test]
fn a_write_that_fails_is_told_of_once() {
    let folder = ScratchFolder::made("full");
    fs::write(folder.join("file"), "").unwrap();
    let below_a_file = folder.join("file").join("settings.toml");
    let mut settings = Settings::preferences_at(below_a_file, Preferences::default(), true);
    settings.preferences.zoom = 2.0;
    settings.save_if_changed(0.0);
    while !settings
        .file
        .as_ref()
        .unwrap()
        .writing
        .as_ref()
        .unwrap()
        .is_finished()
    {
        std::thread::yield_now();
    }
    assert!(settings.take_failure().unwrap().contains("settings.toml"));
    assert_eq!(settings.take_failure(), None);
    assert!(settings.save_now().is_err(), "tried again at the end");
}

#[test]
fn settings_in_memory_touch_no_file() {
    let mut settings = Settings::in_memory();
    settings.preferences.zoom = 2.0;
    assert_eq!(settings.save_if_changed(0.0), None);
    assert!(settings.save_now().is_ok() && settings.file.is_none());
}

fn path() -> &'static Path {
    Path::new("settings.toml")
}

/// A tablet whose surface was placed, and a stylus that waits.
fn hand_tools() -> HandTools {
    HandTools {
        tablet_areas: [("Pen \"S\" 5.1", [-3.5, 20.0, 216.0, 135.25])]
            .map(|(name, area)| (name.to_owned(), Area::of(area).unwrap()))
            .into(),
        stylus_waiting: Some(StylusSettings {
            stiffness_n_per_m: 1e5,
            ..StylusSettings::default()
        }),
        electrovibration: Electrovibration {
            amplification_v: 216.25,
            carrier: Carrier::Sine,
            ..Electrovibration::default()
        },
        ..HandTools::default()
    }
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
        scales: Scales {
            amplitude: AmplitudeScale::default().locked_at(200.0).with_lock(false),
            spectrum: SpectrumScale {
                levels: SpectrumScale::default().levels.moved(Handle::Top, -30.0),
                is_linear: true,
            },
            timeline_height: 200.0,
            pixels_per_mm: Some(3.78),
        },
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
        hand: hand_tools(),
        window_size: Some([1600.0, 1000.5]),
        folders: KnownFolders {
            sessions: Some("/lab/study 1".to_owned()),
            libraries: vec!["/lab/ä".into(), "/c".into()],
            design: Some("odd-one-out".to_owned()),
        },
        sound: SoundPreferences {
            is_on: true,
            loudness: Loudness::Loud,
            as_driven: true,
        },
        ..Preferences::default()
    };
    let scenes = ["/a/ä b.scene.toml", "/c.toml"].map(PathBuf::from);
    let preferences = Preferences {
        recent_scenes: scenes.to_vec(),
        ..preferences
    };
    let text = preferences.to_text(path()).unwrap();
    assert_eq!(
        Preferences::from_text(&text, path()).unwrap(),
        (preferences, None),
        "{text}"
    );
    assert!(text.contains("zoom_percent = 150"), "{text}");
}

#[test]
fn settings_as_at_first_survive_too_and_so_does_no_text_at_all() {
    let text = Preferences::default().to_text(path()).unwrap();
    assert_eq!(
        Preferences::from_text(&text, path()).unwrap(),
        (Preferences::default(), None)
    );
    assert_eq!(
        Preferences::from_text("", path()).unwrap(),
        (Preferences::default(), None)
    );
}

#[test]
fn a_file_from_before_perspectives_arranges_the_first_one() {
    let (preferences, odd) = Preferences::from_text("arrangement = \"a tree\"\n", path()).unwrap();
    assert_eq!((preferences.perspective, odd), (Perspective::Explore, None));
    assert_eq!(
        preferences.arrangements,
        [Some("a tree".to_owned()), None, None]
    );
    let (preferences, odd) =
        Preferences::from_text("theme = \"dark\"\nperspective = \"moon\"\n", path()).unwrap();
    assert_eq!(
        (preferences.perspective, odd),
        (Perspective::Explore, Some(2))
    );
}

#[test]
fn keys_of_a_newer_version_are_passed_over() {
    let text = "theme = \"dark\"\n[sound]\nvolume = 3\n";
    let (preferences, odd) = Preferences::from_text(text, path()).unwrap();
    assert_eq!((preferences.theme, odd), (ThemePreference::Dark, None));
}

#[test]
fn a_value_that_is_not_understood_spoils_only_itself() {
    let text = "zoom_percent = 150\ntheme = \"sepia\"\nnumbers = 3\nwindow_size = [1400]\n\
                rendering_method = \"magic\"\nerror_budget_db = \"none\"\n\
                overlays = [\"points\", \"ghosts\"]\n";
    let (preferences, odd) = Preferences::from_text(text, path()).unwrap();
    assert_eq!((preferences.zoom, odd), (1.5, Some(2)));
    let others = Preferences {
        zoom: 1.0,
        ..preferences
    };
    assert_eq!(others, Preferences::default());
}

#[test]
fn sound_is_off_at_first_and_remembered_and_a_bad_value_costs_only_itself() {
    let read = |text: &str| Preferences::from_text(text, path()).unwrap();
    assert_eq!(read("").0.sound, SoundPreferences::default());
    assert!(!SoundPreferences::default().is_on);
    let text = "sound_on = true\nsound_volume = \"loud\"\nsound_as_driven = true\n";
    let chosen = read(text).0.sound;
    assert!(chosen.is_on && chosen.as_driven && chosen.loudness == Loudness::Loud);
    let spoilt = [
        ("sound_on = true", "sound_on = \"yes\"", 1),
        ("\"loud\"", "\"deafening\"", 2),
        ("as_driven = true", "as_driven = 7", 3),
    ];
    for (good, bad, line) in spoilt {
        let (preferences, odd) = read(&text.replace(good, bad));
        let at_first = SoundPreferences::default();
        let others = SoundPreferences {
            is_on: chosen.is_on && line != 1,
            loudness: if line == 2 {
                at_first.loudness
            } else {
                chosen.loudness
            },
            as_driven: chosen.as_driven && line != 3,
        };
        assert_eq!((preferences.sound, odd), (others, Some(line)), "{bad}");
    }
}

#[test]
fn odd_numbers_are_brought_within_bounds() {
    let text = "zoom_percent = 900\namplitude_top_um = nan\npixels_per_mm = inf\n";
    let (preferences, odd) = Preferences::from_text(text, path()).unwrap();
    assert_eq!((preferences.zoom, odd), (2.0, None));
    assert_eq!(preferences.scales.amplitude, AmplitudeScale::default());
    assert_eq!(preferences.scales.pixels_per_mm, Some(60.0));
}

#[test]
fn what_is_not_toml_is_refused_with_its_line() {
    let error = Preferences::from_text("theme = \"dark\"\n= 3\n", path())
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("settings.toml:2: "), "{error}");
}
