//! The user's own profiles: TOML files in one folder. One with the name of a profile of the program
//! stands in its place.

use std::fs;
use std::path::{Path, PathBuf};

use super::ArrayProfile;
use crate::BridgeError;
use selvedge_foundation::files::FileError;

/// A folder of profiles, which need not be there yet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProfileFolder {
    path: PathBuf,
}

/// A profile that was read, or why it could not be.
type ReadProfile = Result<(PathBuf, ArrayProfile), BridgeError>;

impl ProfileFolder {
    /// The folder at `path`.
    pub fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Every profile in it, by the names of the files. A folder that is not there holds none.
    pub fn read(&self) -> Vec<ReadProfile> {
        let Ok(entries) = fs::read_dir(&self.path) else {
            return Vec::new();
        };
        let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
        let is_toml = |path: &PathBuf| path.extension().is_some_and(|end| end == "toml");
        let mut paths: Vec<PathBuf> = paths.filter(is_toml).collect();
        paths.sort();
        let read = |path: PathBuf| ArrayProfile::read(&path).map(|profile| (path, profile));
        paths.into_iter().map(read).collect()
    }

    /// The profile of this name: the user's own, else the program's.
    ///
    /// # Errors
    /// There is none, or the file that has this name cannot be read.
    pub fn find(&self, name: &str) -> Result<ArrayProfile, BridgeError> {
        let mut known: Vec<String> = ArrayProfile::SHIPPED.map(str::to_owned).to_vec();
        for read in self.read() {
            match read {
                Ok((_, profile)) if profile.name == name => return Ok(profile),
                Ok((_, profile)) => known.push(profile.name),
                // A broken file matters only where it may be the one that is meant.
                Err(error) if self.file_of(name).exists() => return Err(error),
                Err(_) => {}
            }
        }
        known.dedup();
        ArrayProfile::shipped(name).ok_or_else(|| {
            let mend = format!("the arrays are {}, or name a file.toml", known.join(", "));
            FileError::whole(Path::new(name), "there is no such array", mend).into()
        })
    }

    /// Where a profile of this name is written.
    pub fn file_of(&self, name: &str) -> PathBuf {
        let plain = |letter: char| match letter {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '-' | '_' => letter,
            _ => '-',
        };
        let stem: String = name.trim().chars().take(60).map(plain).collect();
        self.path.join(format!("{stem}.toml"))
    }

    /// Writes a profile under its name, and the folder when need be.
    ///
    /// # Errors
    /// The profile holds a value that no file may hold, or the file cannot be written.
    pub fn write(&self, profile: &ArrayProfile) -> Result<PathBuf, BridgeError> {
        profile.check()?;
        fs::create_dir_all(&self.path).map_err(|source| FileError::Write {
            path: self.path.clone(),
            source,
        })?;
        let path = self.file_of(&profile.name);
        profile.write(&path)?;
        Ok(path)
    }

    /// Takes the user's own profile of this name away, if there is one.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), BridgeError> {
        let own = self.read().into_iter().filter_map(Result::ok);
        for (path, _) in own.filter(|(_, profile)| profile.name == name) {
            fs::remove_file(&path).map_err(|source| FileError::Write { path, source })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn own_profiles_stand_in_the_place_of_the_programs_until_they_are_removed() {
        let path = ScratchFolder::new("arrays");
        let folder = ProfileFolder::new(&path);
        assert_eq!(folder.read().len(), 0, "no folder, no profiles");
        assert_eq!(folder.find("5x5").unwrap().limit_um, [50.0, 50.0]);
        let mut own = ArrayProfile::shipped("5x5").unwrap();
        own.limit_um = [20.0, 10.0];
        folder.write(&own).unwrap();
        let rig = ArrayProfile {
            name: "Rig 2/left".to_owned(),
            ..own.clone()
        };
        assert!(folder.write(&rig).unwrap().ends_with("Rig-2-left.toml"));
        assert_eq!(folder.find("5x5").unwrap(), own);
        assert_eq!(folder.find("Rig 2/left").unwrap(), rig);
        let error = folder.find("Rig 3").unwrap_err().to_string();
        assert!(error.contains("Rig 2/left"), "{error}");
        fs::write(folder.file_of("Rig 3"), "name = 3").unwrap();
        let error = folder.find("Rig 3").unwrap_err().to_string();
        assert!(error.contains("Rig-3.toml:1: "), "{error}");
        assert_eq!(
            folder.find("5x5").unwrap(),
            own,
            "a broken file harms no other"
        );
        folder.remove("5x5").unwrap();
        assert_eq!(folder.find("5x5").unwrap().limit_um, [50.0, 50.0]);
    }
}
