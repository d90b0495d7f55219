//! Where a session comes from: the device that presents it and the file of its design, from which
//! a library that the design names is found again.

use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use selvedge_textile::Manifest;

/// What a session is begun with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin<'a> {
    /// The device, as logs call it.
    pub device: &'a str,
    /// The design's file; `None` where it is part of the program.
    pub design_file: Option<&'a Path>,
    /// Whether nobody is to feel anything: what is asked is tried on the screen.
    pub is_pilot: bool,
    /// SHA-256 of what the session is held with, by name: program, plan, library, scene, profile,
    /// certificate.
    pub sha256: Vec<(&'static str, String)>,
    /// How far levels of textiles may be off that were not measured, in words by id.
    pub uncertain: Vec<(String, String)>,
}

impl<'a> Origin<'a> {
    /// A design in a file; one that is not there is part of the program.
    pub fn file(device: &'a str, design: &'a Path) -> Self {
        Self {
            design_file: Some(design).filter(|file| file.is_file()),
            ..Self::from(device)
        }
    }

    /// The same of a pilot.
    #[must_use]
    pub fn piloting(mut self, is_pilot: bool) -> Self {
        self.is_pilot = is_pilot;
        self
    }

    /// The same with how far levels of its textiles may be off.
    #[must_use]
    pub fn knowing<'t>(
        mut self,
        manifests: impl IntoIterator<Item = (&'t str, &'t Manifest)>,
    ) -> Self {
        let words = |(id, manifest): (&str, &Manifest)| {
            Some((id.to_owned(), manifest.uncertainty.as_ref()?.words()?))
        };
        self.uncertain = manifests.into_iter().filter_map(words).collect();
        self
    }

    /// The same with the hash of something that the session is held with; none of nothing.
    #[must_use]
    pub fn with(mut self, name: &'static str, sha256: impl Into<Option<String>>) -> Self {
        let sha256 = sha256.into().filter(|sha256| !sha256.is_empty());
        self.sha256.extend(sha256.map(|sha256| (name, sha256)));
        self
    }
}

impl<'a> From<&'a str> for Origin<'a> {
    fn from(device: &'a str) -> Self {
        Self {
            device,
            design_file: None,
            is_pilot: false,
            sha256: Vec::new(),
            uncertain: Vec::new(),
        }
    }
}

/// The folder of a design's file, as it was when the session was begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct DesignFolder {
    /// Seen from the folder of the log: right where both were moved together.
    from_log: Option<PathBuf>,
    /// From the root: right where the log alone was moved.
    absolute: PathBuf,
}

impl DesignFolder {
    /// That of a design's file, for a log; `None` where one of them has no path from the root.
    pub(super) fn of(design_file: &Path, log: &Path) -> Option<Self> {
        let folder_of = |file: &Path| Some(std::path::absolute(file).ok()?.parent()?.to_owned());
        let (absolute, log) = (folder_of(design_file)?, folder_of(log)?);
        Some(Self {
            from_log: relative(&log, &absolute),
            absolute,
        })
    }

    /// Where it may be now, the likeliest first.
    pub(super) fn places(&self, log: &Path) -> Vec<PathBuf> {
        let beside = log.parent().unwrap_or_else(|| Path::new(""));
        let from_log = self.from_log.as_ref().map(|steps| beside.join(steps));
        from_log
            .into_iter()
            .chain([self.absolute.clone()])
            .collect()
    }
}

/// The way from one folder to another; `None` where they have no more in common than the root.
fn relative(from: &Path, to: &Path) -> Option<PathBuf> {
    let pairs = from.components().zip(to.components());
    let n_common = pairs.take_while(|(from, to)| from == to).count();
    let names = |n: usize, path: &Path| {
        let steps = path.components().take(n);
        steps
            .filter(|step| matches!(step, Component::Normal(_)))
            .count()
    };
    if names(n_common, from) == 0 {
        return None;
    }
    let up = from
        .components()
        .skip(n_common)
        .map(|_| Component::ParentDir);
    Some(up.chain(to.components().skip(n_common)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_found_from_the_log_where_both_were_moved_together() {
        let design = Path::new("/lab/study/designs/four.toml");
        let folder = DesignFolder::of(design, Path::new("/lab/study/logs/a.csv")).unwrap();
        let places = folder.places(Path::new("/else/study/logs/a.csv"));
        assert_eq!(
            places,
            [
                Path::new("/else/study/logs/../designs"),
                Path::new("/lab/study/designs")
            ]
        );
        let beside = DesignFolder::of(design, Path::new("/lab/study/designs/a.csv")).unwrap();
        assert_eq!(beside.places(Path::new("/x/a.csv"))[0], Path::new("/x"));
    }

    #[test]
    fn folders_that_share_the_root_alone_are_told_from_the_root() {
        let design = Path::new("/lab/four.toml");
        let folder = DesignFolder::of(design, Path::new("/data/a.csv")).unwrap();
        assert_eq!(folder.places(Path::new("/data/a.csv")), [Path::new("/lab")]);
    }
}
