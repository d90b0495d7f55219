//! Folders that the desktop is asked to show in its file manager.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::bench::background::{Executor, Task, finished};

/// The program that shows a folder on this system.
const OPENER: &str = if cfg!(target_os = "macos") {
    "open"
} else if cfg!(windows) {
    "explorer"
} else {
    "xdg-open"
};

/// The last folder that was asked for.
#[derive(Debug, Default)]
pub(crate) struct Folders {
    opening: Option<Task<()>>,
}

impl Folders {
    /// Asks the desktop to show a folder. Programs that show one may run as long as they do: nobody
    /// waits for them but a thread.
    pub(crate) fn open(&mut self, executor: &Executor, folder: &Path) {
        self.open_by(executor, OPENER, folder.to_owned());
    }

    fn open_by(&mut self, executor: &Executor, opener: &'static str, folder: PathBuf) {
        let task = executor.start("selvedge-folder", move |_| show(opener, &folder));
        self.opening = Some(task);
    }

    /// Why the folder was not shown, once. To be called every frame.
    pub(crate) fn poll(&mut self) -> Option<String> {
        finished(&mut self.opening)?.err()
    }
}

fn show(opener: &str, folder: &Path) -> Result<(), String> {
    let place = folder.display();
    if !folder.is_dir() {
        return Err(format!("{place}: there is no such folder (yet)"));
    }
    let mut command = Command::new(opener);
    let command = command.arg(folder).stdin(Stdio::null());
    let ended = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
    match ended {
        // Windows' own says 1 whatever it did.
        Ok(status) if status.success() || cfg!(windows) => Ok(()),
        Ok(_) => Err(format!(
            "{place}: \"{opener}\" found no program that shows folders; copy the path instead"
        )),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(format!(
            "{place}: \"{opener}\" is not installed; copy the path instead"
        )),
        Err(error) => Err(format!("{place}: \"{opener}\" does not start: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(opener: &'static str, folder: &Path) -> Option<String> {
        let mut folders = Folders::default();
        folders.open_by(&Executor::InLine, opener, folder.to_owned());
        let described = folders.poll();
        assert!(folders.opening.is_none());
        described
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_is_shown_or_a_line_says_why_not() {
        let folder = std::env::temp_dir();
        assert_eq!(outcome("true", &folder), None);
        let failed = outcome("false", &folder).unwrap();
        assert!(failed.contains("no program that shows folders"), "{failed}");
        let missing = outcome("selvedge-has-no-such-opener", &folder).unwrap();
        assert!(
            missing.contains("is not installed; copy the path"),
            "{missing}"
        );
        let nowhere = outcome("true", &folder.join("selvedge-nowhere")).unwrap();
        assert!(nowhere.contains("no such folder"), "{nowhere}");
    }
}
