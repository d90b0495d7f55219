//! A device that was unplugged and is back, perhaps under another name: what it is recognised by.
//!
//! A USB serial number is trusted, so is the device's own number where the adapter uses it as its
//! serial number. A port without either is recognised by its name alone, and only when it was away.
//! Nothing is opened to find out.

use std::path::{Path, PathBuf};

use super::{PortEntry, UsbIdentity};

/// What is known of a port while its device is there, to recognise it when it is back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortIdentity {
    /// What was opened.
    pub path: PathBuf,
    /// What its adapter says of itself.
    pub(crate) usb: Option<UsbIdentity>,
    /// The device's own number from CAPS.
    pub uid: Option<[u8; 12]>,
    /// What the path led to, if it was a link.
    leads_to: Option<PathBuf>,
    /// Which node that was.
    node: Option<(u64, u64)>,
    /// Whether the port was seen to be away.
    was_away: bool,
}

/// A device that is back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundPort {
    /// What to open now.
    pub path: PathBuf,
    /// Why it is taken to be the same.
    pub by: RecognisedBy,
}

/// Why a port is taken to be one that was lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecognisedBy {
    /// The serial number of its USB adapter.
    UsbSerial,
    /// The device's own number.
    DeviceUid,
    /// Its name alone.
    Name,
}

impl RecognisedBy {
    /// Words for people.
    pub fn words(self) -> &'static str {
        match self {
            Self::UsbSerial => "recognised by its USB serial number",
            Self::DeviceUid => "recognised by its device number",
            Self::Name => "recognised by its name alone",
        }
    }
}

impl PortIdentity {
    /// What is to be known of a port that is there. Lists all ports: not for a GUI thread.
    pub fn of(path: &Path) -> Self {
        let listed = PortEntry::list().unwrap_or_default();
        let leads_to = std::fs::canonicalize(path).ok();
        let is_it = |entry: &&PortEntry| {
            let entry_path = Path::new(&entry.path);
            entry_path == path || Some(entry_path) == leads_to.as_deref()
        };
        Self {
            path: path.to_path_buf(),
            usb: listed
                .iter()
                .find(is_it)
                .and_then(|entry| entry.usb.clone()),
            uid: None,
            leads_to,
            node: node_of(path),
            was_away: false,
        }
    }

    /// Looks once for the device. Lists all ports: not for a GUI thread.
    pub fn look(&mut self) -> Option<FoundPort> {
        let node = node_of(&self.path);
        self.was_away |= node.is_none() || (self.node.is_some() && node != self.node);
        let listed = PortEntry::list().unwrap_or_default();
        self.among(&listed, node.is_some())
            .or_else(|| self.renamed_link())
    }

    /// The device among these ports; `is_there` tells whether its path leads anywhere.
    fn among(&self, listed: &[PortEntry], is_there: bool) -> Option<FoundPort> {
        let found = |path: &str, by| {
            // A port that never went away is not back.
            let path = Path::new(path);
            let is_new =
                self.was_away || (path != self.path && Some(path) != self.leads_to.as_deref());
            is_new.then(|| FoundPort {
                path: path.to_path_buf(),
                by,
            })
        };
        if let Some(serial) = self.serial() {
            let same = |entry: &&PortEntry| entry.usb.as_ref() == self.usb.as_ref();
            if let Some(entry) = listed.iter().find(same)
                && !serial.is_empty()
            {
                return found(&entry.path, RecognisedBy::UsbSerial);
            }
        }
        if let Some(uid) = self.uid
            && let Some(entry) = listed.iter().find(|entry| carries(entry, &uid))
        {
            return found(&entry.path, RecognisedBy::DeviceUid);
        }
        let by_name = is_there && self.serial().is_none() && self.was_away;
        by_name.then(|| FoundPort {
            path: self.path.clone(),
            by: RecognisedBy::Name,
        })
    }

    fn serial(&self) -> Option<&str> {
        self.usb.as_ref()?.serial.as_deref()
    }

    /// A link beside the lost one, named after it, that leads to a terminal: `array-2` for `array`.
    /// Emulated devices come back like this.
    fn renamed_link(&self) -> Option<FoundPort> {
        if !self.was_away || self.usb.is_some() {
            return None;
        }
        let name = self.path.file_name()?.to_str()?;
        let parent = self.path.parent()?;
        let folder = if parent.as_os_str().is_empty() {
            Path::new(".")
        } else {
            parent
        };
        let mut named: Vec<String> = std::fs::read_dir(folder)
            .ok()?
            .flatten()
            .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_symlink()))
            .filter(|entry| {
                let target = std::fs::canonicalize(entry.path());
                target.is_ok_and(|target| target.starts_with("/dev"))
            })
            .filter_map(|entry| entry.file_name().into_string().ok())
            .filter(|other| is_numbered(other, name))
            .collect();
        named.sort();
        Some(FoundPort {
            path: parent.join(named.pop()?),
            by: RecognisedBy::Name,
        })
    }
}

/// Whether `other` is `name` with a number behind, or the same without or with another one.
fn is_numbered(other: &str, name: &str) -> bool {
    let stem = |text: &str| {
        let cut = text.rsplit_once('-');
        let numbered =
            cut.filter(|(_, end)| !end.is_empty() && end.bytes().all(|b| b.is_ascii_digit()));
        numbered.map_or_else(|| String::from(text), |(stem, _)| String::from(stem))
    };
    other != name && stem(other) == stem(name)
}

/// Whether an adapter uses the device's own number as its serial number: as hexadecimal digits or
/// as letters.
fn carries(entry: &PortEntry, uid: &[u8; 12]) -> bool {
    let Some(serial) = entry.usb.as_ref().and_then(|usb| usb.serial.as_deref()) else {
        return false;
    };
    let is_set = uid.iter().any(|byte| *byte != 0);
    is_set && (is_hexadecimal_of(serial, uid) || serial.as_bytes() == uid)
}

fn is_hexadecimal_of(text: &str, bytes: &[u8]) -> bool {
    let digits = |nth: usize| text.get(2 * nth..2 * nth + 2);
    let same = |(nth, byte): (usize, &u8)| {
        digits(nth).is_some_and(|two| u8::from_str_radix(two, 16) == Ok(*byte))
    };
    text.len() == 2 * bytes.len() && bytes.iter().enumerate().all(same)
}

#[cfg(unix)]
fn node_of(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt as _;

    let node = std::fs::metadata(path).ok()?;
    Some((node.rdev(), node.ino()))
}

#[cfg(not(unix))]
fn node_of(path: &Path) -> Option<(u64, u64)> {
    path.exists().then_some((0, 0))
}

#[cfg(test)]
#[expect(
    clippy::unnecessary_wraps,
    reason = "expectations read like what they are compared with"
)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn usb(serial: Option<&str>) -> Option<UsbIdentity> {
        Some(UsbIdentity {
            vid: 0x2e8a,
            pid: 10,
            serial: serial.map(String::from),
        })
    }

    fn port(path: &str, usb: Option<UsbIdentity>) -> PortEntry {
        PortEntry {
            path: String::from(path),
            description: String::new(),
            usb,
        }
    }

    fn lost(usb: Option<UsbIdentity>, was_away: bool) -> PortIdentity {
        PortIdentity {
            path: PathBuf::from("/dev/ttyACM0"),
            usb,
            uid: None,
            leads_to: None,
            node: Some((1, 2)),
            was_away,
        }
    }

    fn found(path: &str, by: RecognisedBy) -> Option<FoundPort> {
        Some(FoundPort {
            path: PathBuf::from(path),
            by,
        })
    }

    #[test]
    fn a_serial_number_is_recognised_under_any_name_and_a_stranger_is_not() {
        let gone = lost(usb(Some("A1")), false);
        let back = [
            port("/dev/ttyACM0", usb(Some("B2"))),
            port("/dev/ttyACM1", usb(Some("A1"))),
        ];
        assert_eq!(
            gone.among(&back, true),
            found("/dev/ttyACM1", RecognisedBy::UsbSerial)
        );
        assert_eq!(
            lost(usb(Some("A1")), true).among(&back[..1], true),
            None,
            "another device under the old name"
        );
    }

    #[test]
    fn a_port_that_was_opened_by_a_link_and_never_went_away_is_not_back() {
        let mut stalled = lost(usb(Some("A1")), false);
        stalled.path = PathBuf::from("/dev/selvedge-A1");
        stalled.leads_to = Some(PathBuf::from("/dev/ttyACM0"));
        let here = [port("/dev/ttyACM0", usb(Some("A1")))];
        assert_eq!(stalled.among(&here, true), None);
        let there = [port("/dev/ttyACM1", usb(Some("A1")))];
        assert_eq!(
            stalled.among(&there, true),
            found("/dev/ttyACM1", RecognisedBy::UsbSerial)
        );
    }

    #[test]
    fn a_device_number_that_the_adapter_shows_is_recognised() {
        let uid = *b"\x01\x23\x45\x67\x89\xab\xcd\xef\x01\x23\x45\x67";
        let mut gone = lost(usb(None), true);
        gone.uid = Some(uid);
        let back = [port("/dev/ttyACM3", usb(Some("0123456789ABCDEF01234567")))];
        assert_eq!(
            gone.among(&back, false),
            found("/dev/ttyACM3", RecognisedBy::DeviceUid)
        );
        gone.uid = Some([0; 12]);
        assert_eq!(gone.among(&back, false), None, "no number at all");
    }

    #[test]
    fn a_name_counts_only_when_the_port_was_away() {
        let here = [port("/dev/ttyACM0", None)];
        assert_eq!(lost(None, false).among(&here, true), None);
        assert_eq!(
            lost(None, true).among(&here, true),
            found("/dev/ttyACM0", RecognisedBy::Name)
        );
        assert_eq!(lost(None, true).among(&[], false), None, "still away");
        let same = [port("/dev/ttyACM0", usb(Some("A1")))];
        assert_eq!(
            lost(usb(Some("A1")), false).among(&same, true),
            None,
            "a port that never went away is not back"
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_comes_back_with_a_number_is_found_beside_the_old_one() {
        let folder = ScratchFolder::made("replug");
        let old = folder.join("array");
        let link = |name: &str, to: &str| {
            std::os::unix::fs::symlink(to, folder.join(name)).unwrap();
        };
        link("array", "/dev/null");
        let mut gone = PortIdentity::of(&old);
        assert_eq!(gone.look(), None, "it is there");
        std::fs::remove_file(&old).unwrap();
        assert_eq!(gone.look(), None, "it is away");
        link("arrays", "/dev/null");
        link("array-x", "/dev/null");
        link("array-9", "/etc/group");
        assert_eq!(gone.look(), None, "other names, other files");
        link("array-2", "/dev/null");
        let back = gone.look().unwrap();
        assert_eq!(back.path, folder.join("array-2"));
        let mut again = PortIdentity::of(&back.path);
        std::fs::remove_file(&back.path).unwrap();
        link("array-3", "/dev/null");
        assert_eq!(again.look().unwrap().path, folder.join("array-3"));
    }
}
