//! The file of the settings: missing, broken, newer, written.

use std::fs;
use std::path::{Path, PathBuf};

use super::{Kept, Settings};

/// A folder of one test's own; removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("selvedge-settings-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn text(&self) -> String {
        fs::read_to_string(self.file("settings.toml")).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).unwrap();
    }
}

/// Waits for the write under way.
fn wait(settings: &mut Settings) -> Result<(), String> {
    let job = settings.file.as_mut().unwrap().writing.take();
    job.unwrap().join().unwrap().map_err(|e| e.to_string())
}

#[test]
fn a_missing_file_means_settings_as_at_first_and_makes_none() {
    let folder = Folder::new("missing");
    let (mut settings, notice) = Settings::in_folder(&folder.file("not/yet"));
    assert_eq!((&settings.kept, notice), (&Kept::default(), None));
    assert_eq!(settings.save_if_changed(0.0), None);
    settings.save_now().unwrap();
    assert!(!folder.file("not").exists(), "nothing changed");
}

#[test]
fn what_changed_is_there_in_the_next_run() {
    let folder = Folder::new("next");
    let home = folder.file("deep/inside");
    let (mut settings, _) = Settings::in_folder(&home);
    settings.kept.zoom = 1.5;
    settings.kept.remember_scene(Path::new("/a.scene.toml"));
    settings.save_if_changed(0.0);
    wait(&mut settings).unwrap();
    let (next, notice) = Settings::in_folder(&home);
    assert_eq!((next.kept, notice), (settings.kept, None));
    assert_eq!(fs::read_dir(&home).unwrap().count(), 1, "nothing beside it");
}

#[test]
fn changes_in_a_row_are_written_once_a_second_and_the_last_one_at_the_end() {
    let folder = Folder::new("row");
    let (mut settings, _) = Settings::in_folder(&folder.0);
    settings.kept.zoom = 1.25;
    assert_eq!(settings.save_if_changed(10.0), None, "at once");
    wait(&mut settings).unwrap();
    settings.kept.zoom = 1.5;
    assert_eq!(settings.save_if_changed(10.25), Some(0.75), "later");
    assert!(
        folder.text().contains("zoom_percent = 125"),
        "{}",
        folder.text()
    );
    assert_eq!(settings.save_if_changed(11.0), None, "now");
    wait(&mut settings).unwrap();
    assert!(
        folder.text().contains("zoom_percent = 150"),
        "{}",
        folder.text()
    );
    settings.kept.zoom = 2.0;
    settings.save_now().unwrap();
    assert!(
        folder.text().contains("zoom_percent = 200"),
        "{}",
        folder.text()
    );
}

#[test]
fn a_broken_file_is_told_of_and_kept_under_another_name() {
    let folder = Folder::new("broken");
    for (aside, text) in [("", "zoom_percent = = 3"), ("-2", "\u{0}\u{1}")] {
        fs::write(folder.file("settings.toml"), text).unwrap();
        let (mut settings, notice) = Settings::in_folder(&folder.0);
        let notice = notice.unwrap();
        assert_eq!(settings.kept, Kept::default());
        assert!(notice.contains("settings.toml:1: "), "{notice}");
        assert!(
            notice.ends_with(&format!("settings.toml.broken{aside}")),
            "{notice}"
        );
        assert_eq!(notice.lines().count(), 1, "{notice}");
        let kept = fs::read_to_string(folder.file(&format!("settings.toml.broken{aside}")));
        assert_eq!(kept.unwrap(), text);
        settings.save_now().unwrap();
        assert_eq!(Settings::in_folder(&folder.0).1, None, "whole again");
    }
}

#[test]
fn bytes_that_are_no_text_are_a_broken_file_too() {
    let folder = Folder::new("bytes");
    fs::write(folder.file("settings.toml"), [0xff, 0xfe, 0x00]).unwrap();
    let (settings, notice) = Settings::in_folder(&folder.0);
    assert_eq!(settings.kept, Kept::default());
    assert!(notice.unwrap().contains("UTF-8"));
    assert!(folder.file("settings.toml.broken").exists());
}

#[test]
fn one_value_that_is_not_known_is_told_of_and_the_others_stay() {
    let folder = Folder::new("odd");
    fs::write(
        folder.file("settings.toml"),
        "zoom_percent = 150\ntheme = 3\n",
    )
    .unwrap();
    let (mut settings, notice) = Settings::in_folder(&folder.0);
    assert_eq!(settings.kept.zoom, 1.5);
    assert!(notice.unwrap().contains("settings.toml:2: "));
    settings.save_if_changed(0.0);
    wait(&mut settings).unwrap();
    let (next, notice) = Settings::in_folder(&folder.0);
    assert_eq!((next.kept.zoom, notice), (1.5, None), "it is written anew");
}

#[test]
fn what_cannot_be_read_is_not_written_over() {
    let folder = Folder::new("unreadable");
    fs::create_dir(folder.file("settings.toml")).unwrap();
    let (mut settings, notice) = Settings::in_folder(&folder.0);
    assert!(notice.unwrap().contains("settings.toml"));
    settings.kept.zoom = 2.0;
    settings.save_if_changed(0.0);
    settings.save_now().unwrap();
    assert!(folder.file("settings.toml").is_dir());
}

#[test]
fn a_write_that_fails_is_told_of_once() {
    let folder = Folder::new("full");
    fs::write(folder.file("file"), "").unwrap();
    let below_a_file = folder.file("file").join("settings.toml");
    let mut settings = Settings::kept_at(below_a_file, Kept::default(), true);
    settings.kept.zoom = 2.0;
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
    settings.kept.zoom = 2.0;
    assert_eq!(settings.save_if_changed(0.0), None);
    assert!(settings.save_now().is_ok() && settings.file.is_none());
}
