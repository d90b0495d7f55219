//! Why a port did not open, told apart, each in one line with what to do.

use std::io;
use std::path::Path;

use serialport::ErrorKind;

use super::PortEntry;
use crate::BridgeError;
use selvedge_foundation::files::is_accessible;

const RULE: &str = "\"selvedge bridge list --udev-rule\"";

/// Why a port did not open, and what to do.
pub(super) fn open_error(path: &str, error: &serialport::Error) -> BridgeError {
    let text = error.to_string();
    let port = String::from(path);
    let reason = match error.kind {
        ErrorKind::Io(io::ErrorKind::NotFound) => {
            String::from("no such port: see `selvedge bridge list`")
        }
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => no_permission(path),
        _ if text.contains("exclusive lock") || text.contains("busy") => {
            return BridgeError::Busy { port, holder: None };
        }
        _ if text.contains("typewriter") || text.contains("ioctl") => {
            String::from("not a serial port: see `selvedge bridge list`")
        }
        // A node whose device is gone, or that another system call is still taking away.
        _ if text.contains("No such device") || text.contains("Input/output error") => {
            String::from("its device is gone: unplug it, plug it in again, then connect")
        }
        _ => format!("cannot be opened: {text}"),
    };
    BridgeError::Open { port, reason }
}

impl PortEntry {
    /// Whether we may use the port at `path`, which is not opened.
    ///
    /// # Errors
    /// We may not: what to do.
    pub fn check_permission(path: &str) -> Result<(), BridgeError> {
        if is_accessible(Path::new(path)) {
            return Ok(());
        }
        Err(BridgeError::Open {
            port: path.to_owned(),
            reason: no_permission(path),
        })
    }
}

/// Who may open a port, as its node and the system's groups say.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Access {
    /// The group that owns the node and may use it, if it is not root's.
    group: Option<String>,
    /// Whether the user is entered in that group, although this login does not know yet.
    is_entered: bool,
}

fn no_permission(path: &str) -> String {
    permission_words(&access(path))
}

fn permission_words(access: &Access) -> String {
    match &access.group {
        Some(group) if access.is_entered => format!(
            "no permission yet: you were added to its group {group} after you logged in: log out \
             and in again"
        ),
        Some(group) => format!(
            "no permission: it belongs to the group {group}: run \"sudo usermod -aG {group} \
             $USER\" and log in again, or install the rule that {RULE} prints"
        ),
        None => {
            format!("no permission: only root may open it: install the rule that {RULE} prints")
        }
    }
}

#[cfg(unix)]
fn access(path: &str) -> Access {
    use std::os::unix::fs::MetadataExt as _;

    const GROUP_READS_AND_WRITES: u32 = 0o060;

    let Ok(node) = std::fs::metadata(path) else {
        return Access::default();
    };
    let helps = node.gid() != 0 && node.mode() & GROUP_READS_AND_WRITES == GROUP_READS_AND_WRITES;
    if !helps {
        return Access::default();
    }
    let groups = std::fs::read_to_string("/etc/group").unwrap_or_default();
    let user = std::env::var("USER").unwrap_or_default();
    access_by(&groups, node.gid(), &user)
}

#[cfg(not(unix))]
fn access(_path: &str) -> Access {
    Access::default()
}

/// The group of a number in the text of `/etc/group`, and whether a user is entered there.
#[cfg(unix)]
fn access_by(groups: &str, gid: u32, user: &str) -> Access {
    let number = gid.to_string();
    let found = groups.lines().find_map(|line| {
        let fields: Vec<&str> = line.split(':').collect();
        match fields.as_slice() {
            [name, _, id, members] if *id == number => Some((*name, *members)),
            _ => None,
        }
    });
    match found {
        Some((name, members)) => Access {
            group: Some(String::from(name)),
            is_entered: !user.is_empty() && members.split(',').any(|member| member == user),
        },
        None => Access {
            group: Some(number),
            is_entered: false,
        },
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    const GROUPS: &str = "root:x:0:\ndialout:x:20:ada,grace\ntty:x:5:\n";

    fn refused(kind: ErrorKind, text: &str) -> String {
        open_error("/dev/ttyACM0", &serialport::Error::new(kind, text)).to_string()
    }

    #[test]
    fn the_group_that_owns_a_port_is_named_with_the_way_in() {
        let stranger = permission_words(&access_by(GROUPS, 20, "alan"));
        assert!(
            stranger.contains("sudo usermod -aG dialout $USER"),
            "{stranger}"
        );
        assert!(
            stranger.contains("selvedge bridge list --udev-rule"),
            "{stranger}"
        );
        let entered = permission_words(&access_by(GROUPS, 20, "grace"));
        assert!(entered.contains("log out and in again"), "{entered}");
        let unknown = permission_words(&access_by(GROUPS, 991, "grace"));
        assert!(unknown.contains("group 991"), "{unknown}");
        let closed = permission_words(&Access::default());
        assert!(
            closed.contains("only root") && closed.contains("--udev-rule"),
            "{closed}"
        );
    }

    #[test]
    fn reasons_are_told_apart_in_one_line_each() {
        let denied = ErrorKind::Io(io::ErrorKind::PermissionDenied);
        let cases = [
            (refused(denied, "Permission denied"), "no permission"),
            (
                refused(ErrorKind::NoDevice, "Device or resource busy"),
                "in use by another program: close",
            ),
            (
                refused(ErrorKind::Unknown, "No such device or address"),
                "its device is gone",
            ),
            (
                refused(ErrorKind::Unknown, "Input/output error"),
                "its device is gone",
            ),
            (
                refused(ErrorKind::Unknown, "Not a typewriter"),
                "not a serial port",
            ),
            (
                refused(ErrorKind::Unknown, "something new"),
                "cannot be opened: something new",
            ),
        ];
        for (line, words) in cases {
            assert!(line.starts_with("/dev/ttyACM0: "), "{line}");
            assert!(line.contains(words) && !line.contains('\n'), "{line}");
        }
        let held = BridgeError::Busy {
            port: String::from("/dev/ttyACM0"),
            holder: Some(String::from("ModemManager, process 812")),
        };
        let line = held.to_string();
        assert!(
            line.contains("process 812") && line.contains("--udev-rule"),
            "{line}"
        );
    }

    #[test]
    fn a_node_of_another_group_is_looked_up() {
        // Everybody may read it, so its group is not asked for.
        assert_eq!(access("/etc/group"), Access::default());
        assert_eq!(access("/no/such/node"), Access::default());
    }
}
