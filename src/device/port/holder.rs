//! Which program holds a port, as far as the system tells: on Linux, for programs of the same user.

use std::path::Path;

/// The other program that has `path` open: `minicom, process 812`. A look over all processes takes
/// some ms; `None` when it is not to be known.
#[cfg(target_os = "linux")]
pub(crate) fn holder_of(path: &Path) -> Option<String> {
    use std::fs;

    let node = fs::canonicalize(path).ok()?;
    let own = std::process::id().to_string();
    for process in fs::read_dir("/proc").ok()?.flatten() {
        let name = process.file_name();
        let Some(id) = name
            .to_str()
            .filter(|id| id.bytes().all(|b| b.is_ascii_digit()))
        else {
            continue;
        };
        let Some(open) = fs::read_dir(process.path().join("fd")).ok() else {
            continue;
        };
        let files: Vec<_> = open
            .flatten()
            .filter_map(|file| fs::read_link(file.path()).ok())
            .collect();
        // Whoever made a pseudo-terminal has it open too, but is the device, not its user.
        let is_its_maker =
            node.starts_with("/dev/pts") && files.iter().any(|file| file.ends_with("ptmx"));
        if id != own && !is_its_maker && files.contains(&node) {
            let name = fs::read_to_string(process.path().join("comm")).unwrap_or_default();
            return Some(format!("{}, process {id}", name.trim()));
        }
    }
    None
}

/// Not to be known here.
#[cfg(not(target_os = "linux"))]
pub(crate) fn holder_of(_path: &Path) -> Option<String> {
    None
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::fs::File;
    use std::process::{Command, Stdio};

    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_program_that_holds_a_port_is_named() {
        let folder = ScratchFolder::made("held");
        let path = folder.join("port");
        let file = File::create(&path).unwrap();
        assert_eq!(holder_of(&path), None, "this program is not another one");
        let mut sleeper = Command::new("sleep")
            .arg("600")
            .stdin(Stdio::from(file))
            .spawn()
            .unwrap();
        let wanted = format!("sleep, process {}", sleeper.id());
        // The child has its name once it runs.
        let named = (0..200).any(|_| {
            std::thread::sleep(std::time::Duration::from_millis(10));
            holder_of(&path).as_deref() == Some(wanted.as_str())
        });
        sleeper.kill().unwrap();
        sleeper.wait().unwrap();
        assert!(named, "{wanted}");
    }
}
