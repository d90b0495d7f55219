//! Why positions cannot be had from a device or a connection.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Why a source of positions was not opened.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// What is named is no address.
    #[error("\"{0}\" is no address; write 127.0.0.1:PORT")]
    Address(String),
    /// Other machines are not listened to.
    #[error("{0} can be reached from other machines; write 127.0.0.1:PORT")]
    NotLoopback(SocketAddr),
    /// The port is taken, or may not be used.
    #[error("cannot listen on {address}: {source}; choose another port")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// What the system said.
        source: io::Error,
    },
    /// A device that the user may not read.
    #[error(
        "{}: not allowed to read it; join the group \"input\" (sudo usermod -aG input NAME) and \
         log in again",
        .0.display()
    )]
    Forbidden(PathBuf),
    /// A device that cannot be read.
    #[error("{}: {what}; \"selvedge input list\" names the devices", path.display())]
    Device {
        /// The device.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The devices cannot be listed.
    #[error("no input devices are to be seen: {0}; is /dev/input there?")]
    List(String),
    /// Something else than a device's area.
    #[error("\"{0}\" is no area; write X,Y,WIDTH,HEIGHT in mm of the workspace")]
    Area(String),
}
