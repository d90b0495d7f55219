//! Array profiles in the window: which one is in force, what was changed of it, and its file.
//!
//! A profile belongs to the user, not to a scene. What is changed of a profile of the program
//! becomes the user's own of the same name. Devices follow at once where a change only lowers;
//! everything else waits until the device is disarmed.

pub(crate) mod change;
pub(crate) mod follow;
#[cfg(test)]
mod tests;
pub(crate) mod wizard;

pub(crate) use crate::bench::arrays::wizard::PULSE_MS;
pub(crate) use crate::bench::arrays::wizard::Wizard;

use std::collections::BTreeSet;
use std::path::Path;

use crate::bench::background::{Executor, Task, finished};
use selvedge_device::{ArrayProfile, BridgeError, DeviceUid, ProfileFolder};
use selvedge_engine::array_of;
use selvedge_render::scene::Display;

/// How long a profile rests before it is written, s.
const PAUSE_S: f64 = 0.5;

/// The user's array profiles.
#[derive(Debug, Default)]
pub(crate) struct Arrays {
    /// Where they are kept; nowhere in tests and pictures.
    folder: Option<ProfileFolder>,
    own: Vec<ArrayProfile>,
    /// Names of profiles whose files are to be written or removed.
    unsaved: BTreeSet<String>,
    changed_s: Option<f64>,
    writing: Option<Task<()>>,
    /// Whether the engine did not take the profile that it was sent last.
    is_refused: bool,
    /// Whether what was changed waits until the device is disarmed.
    pub waits: bool,
    /// The device whose wiring was doubted already.
    doubted: Option<DeviceUid>,
    /// Channels that are being identified.
    pub(crate) wizard: Option<Wizard>,
}

impl Arrays {
    /// The profiles in the user's folder, and sentences on those that cannot be read.
    pub(crate) fn in_folder(path: &Path) -> (Self, Vec<String>) {
        let folder = ProfileFolder::new(path);
        let (mut own, mut flaws) = (Vec::new(), Vec::new());
        for read in folder.read() {
            match read {
                Ok((_, profile)) => own.push(profile),
                Err(error) => flaws.push(format!("{error}; this array profile is left out")),
            }
        }
        let arrays = Self {
            folder: Some(folder),
            own,
            ..Self::default()
        };
        (arrays, flaws)
    }

    /// Where profiles are kept.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.folder.as_ref().map(ProfileFolder::path)
    }

    /// The profile in force for a display: the one that was chosen, if it has as many contactors,
    /// else the one of the display's name, else the display itself.
    pub(crate) fn in_force(&self, chosen: Option<&str>, display: &Display) -> ArrayProfile {
        let plain = array_of(display);
        let n = plain.n_contactors();
        let fits = |profile: &ArrayProfile| profile.n_contactors() == n;
        let chosen = chosen.and_then(|name| self.named(name)).filter(fits);
        let named = || self.named(&plain.name).filter(fits);
        chosen.or_else(named).unwrap_or(plain)
    }

    /// The profiles for a display of `n` contactors: names, and whether they are the user's.
    pub(crate) fn choices(&self, n: usize) -> Vec<(String, bool)> {
        let fits = |profile: &&ArrayProfile| profile.n_contactors() == n;
        let own = self.own.iter().filter(fits);
        let mut choices: Vec<(String, bool)> =
            own.map(|profile| (profile.name.clone(), true)).collect();
        for name in ArrayProfile::SHIPPED {
            let fits = ArrayProfile::shipped(name).is_some_and(|profile| fits(&&profile));
            if fits && !self.is_own(name) {
                choices.push((name.to_owned(), false));
            }
        }
        choices.sort();
        choices
    }

    /// Whether a profile may have this name.
    pub(crate) fn is_free(&self, name: &str) -> bool {
        let is_taken = self.is_own(name) || ArrayProfile::shipped(name).is_some();
        !name.is_empty() && !is_taken
    }

    /// Whether a profile of this name is the user's.
    pub(crate) fn is_own(&self, name: &str) -> bool {
        self.own.iter().any(|profile| profile.name == name)
    }

    /// Takes a changed or new profile in under its name; one that is as the program's is that.
    pub(crate) fn keep(&mut self, profile: ArrayProfile) {
        let name = profile.name.clone();
        let is_shipped = ArrayProfile::shipped(&name).as_ref() == Some(&profile);
        self.own.retain(|own| own.name != name);
        if !is_shipped {
            self.own.push(profile);
            self.own.sort_by(|a, b| a.name.cmp(&b.name));
        }
        self.unsaved.insert(name);
        self.changed_s = None;
    }

    /// Lets go of the user's own profile of this name: the program's is there again, if it has one.
    pub(crate) fn forget(&mut self, name: &str) {
        self.own.retain(|own| own.name != name);
        self.unsaved.insert(name.to_owned());
        self.changed_s = None;
    }

    fn named(&self, name: &str) -> Option<ArrayProfile> {
        let own = self.own.iter().find(|profile| profile.name == name);
        own.cloned().or_else(|| ArrayProfile::shipped(name))
    }

    /// Writes what was changed on another thread, once it has rested; sentences when that failed.
    /// To be called every frame; says when to call again.
    pub(crate) fn save_if_changed(
        &mut self,
        executor: &Executor,
        now_s: f64,
    ) -> (Option<String>, Option<f64>) {
        let failure = finished(&mut self.writing).and_then(Result::err);
        if self.unsaved.is_empty() || self.writing.is_some() || self.folder.is_none() {
            return (failure, None);
        }
        let rested_s = now_s - *self.changed_s.get_or_insert(now_s);
        if rested_s < PAUSE_S {
            return (failure, Some(PAUSE_S - rested_s));
        }
        self.writing = self.work().map(|work| {
            executor.start("selvedge-arrays", |_| {
                work().map_err(|error| error.to_string())
            })
        });
        (failure, None)
    }

    /// Writes what is left to write on this thread: at the end of the run.
    pub(crate) fn save_now(&mut self) -> Result<(), BridgeError> {
        self.work().map_or(Ok(()), |work| work())
    }

    /// The writing of everything that was changed.
    fn work(&mut self) -> Option<impl FnOnce() -> Result<(), BridgeError> + Send + use<>> {
        let folder = self.folder.clone()?;
        let names = std::mem::take(&mut self.unsaved);
        let own = self.own.clone();
        Some(move || {
            for name in names {
                match own.iter().find(|profile| profile.name == name) {
                    Some(profile) => drop(folder.write(profile)?),
                    None => folder.remove(&name)?,
                }
            }
            Ok(())
        })
    }
}

#[cfg(test)]
mod keeping_tests {
    use super::*;
    use selvedge_render::scene::{ArrayLayout, Geometry};
    use selvedge_scratch::ScratchFolder;

    fn display(layout: ArrayLayout) -> Display {
        Display {
            geometry: Geometry::Array(layout),
            ..Display::default()
        }
    }

    fn rig() -> ArrayProfile {
        ArrayProfile {
            name: "rig".to_owned(),
            limit_um: [10.0, 20.0],
            ..ArrayProfile::default()
        }
    }

    #[test]
    fn the_chosen_profile_is_in_force_where_it_fits() {
        let mut arrays = Arrays::default();
        let exeter = display(ArrayLayout::Exeter24);
        assert_eq!(arrays.in_force(None, &exeter), ArrayProfile::default());
        arrays.keep(rig());
        assert_eq!(arrays.in_force(Some("rig"), &exeter), rig());
        assert_eq!(arrays.in_force(Some("gone"), &exeter).name, "exeter-24");
        let square = display(ArrayLayout::Square5);
        assert_eq!(arrays.in_force(Some("rig"), &square).name, "5x5");
        let names = |n| -> Vec<String> {
            arrays
                .choices(n)
                .into_iter()
                .map(|(name, _)| name)
                .collect()
        };
        assert_eq!(names(24), ["exeter-24", "rig"]);
        assert_eq!(names(25), ["5x5"]);
    }

    #[test]
    fn a_changed_profile_of_the_program_is_the_users_until_it_is_as_it_was() {
        let mut arrays = Arrays::default();
        let exeter = display(ArrayLayout::Exeter24);
        let changed = ArrayProfile {
            limit_um: [5.0, 5.0],
            ..ArrayProfile::default()
        };
        arrays.keep(changed.clone());
        assert!(arrays.is_own("exeter-24"));
        assert_eq!(arrays.in_force(None, &exeter), changed);
        arrays.keep(ArrayProfile::default());
        assert!(!arrays.is_own("exeter-24"));
        arrays.keep(changed);
        arrays.forget("exeter-24");
        assert_eq!(arrays.in_force(None, &exeter), ArrayProfile::default());
    }

    #[test]
    fn what_was_changed_is_in_the_folder_at_the_next_start() {
        let path = ScratchFolder::new("rigs");
        let (mut arrays, flaws) = Arrays::in_folder(&path);
        assert_eq!(flaws, Vec::<String>::new());
        arrays.keep(rig());
        arrays.save_now().unwrap();
        std::fs::write(path.join("bad.toml"), "name = 3").unwrap();
        let (again, flaws) = Arrays::in_folder(&path);
        assert_eq!(again.named("rig"), Some(rig()));
        assert!(flaws[0].contains("bad.toml:1: "), "{flaws:?}");
        arrays.forget("rig");
        let threads = Executor::Threads(eframe::egui::Context::default());
        assert_eq!(arrays.save_if_changed(&threads, 1.0), (None, Some(PAUSE_S)));
        assert_eq!(arrays.save_if_changed(&threads, 2.0), (None, None));
        while arrays.writing.is_some() {
            assert_eq!(arrays.save_if_changed(&threads, 3.0).0, None);
        }
        assert_eq!(Arrays::in_folder(&path).0.named("rig"), None);
    }
}
