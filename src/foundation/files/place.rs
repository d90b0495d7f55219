//! What the system says of a place in its files: how much room is there, and whether it is ours.

use std::path::Path;

/// Bytes that are free for us where `path` is; `None` where the system does not tell.
#[cfg_attr(not(unix), expect(unused_variables, reason = "only Unix is asked"))]
pub fn free_bytes(path: &Path) -> Option<u64> {
    #[cfg(unix)]
    if let Ok(found) = rustix::fs::statvfs(path) {
        return found.f_bavail.checked_mul(found.f_frsize);
    }
    None
}

/// Whether we may read and write what is at `path`, without opening it: a port that is opened may
/// start its device anew. Elsewhere than on Unix everything may be.
#[cfg_attr(not(unix), expect(unused_variables, reason = "only Unix is asked"))]
pub fn is_accessible(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use rustix::fs::Access;
        rustix::fs::access(path, Access::READ_OK | Access::WRITE_OK).is_ok()
    }
    #[cfg(not(unix))]
    true
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_room_and_what_is_not_there_is_nobodys() {
        let here = std::env::temp_dir();
        assert!(free_bytes(&here).is_some_and(|bytes| bytes > 0), "room");
        assert!(is_accessible(&here), "we write there");
        let nowhere = here.join("selvedge-nowhere/at-all");
        assert_eq!(
            (free_bytes(&nowhere), is_accessible(&nowhere)),
            (None, false)
        );
    }
}
