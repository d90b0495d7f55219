//! Tells the service manager that the stage lives: that frames are drawn and the engine ticks. When
//! it hears nothing for too long it starts the program anew.

use std::env;
use std::path::PathBuf;

/// Where the service manager listens.
const SOCKET: &str = "NOTIFY_SOCKET";
/// How often it is told, s: well below the 20 s of the unit.
const EVERY_S: f64 = 4.0;

/// The way to the service manager, if there is one.
#[derive(Debug, Default)]
pub(crate) struct Heartbeat {
    socket: Option<PathBuf>,
    told_s: Option<f64>,
    /// The engine's tick when it was told last.
    tick: u64,
}

impl Heartbeat {
    /// To the service manager that began this process, if one did.
    pub(crate) fn of_process() -> Self {
        Self {
            socket: env::var_os(SOCKET).map(PathBuf::from),
            ..Self::default()
        }
    }

    /// A frame is drawn, and the engine is at this tick.
    pub(crate) fn beat(&mut self, now_s: f64, tick: u64) {
        let Some(socket) = &self.socket else { return };
        let words = match self.told_s {
            None => "READY=1\nWATCHDOG=1",
            Some(told_s) if now_s - told_s < EVERY_S || tick == self.tick => return,
            Some(_) => "WATCHDOG=1",
        };
        self.told_s = Some(now_s);
        self.tick = tick;
        send(socket, words);
    }
}

/// Nobody hears of it where nobody listens; a manager that is gone restarts nothing anyway.
#[cfg(unix)]
fn send(socket: &std::path::Path, words: &str) {
    use std::os::unix::net::UnixDatagram;

    if let Ok(sender) = UnixDatagram::unbound() {
        drop(sender.set_nonblocking(true));
        #[cfg(target_os = "linux")]
        if let Some(name) = socket.to_str().and_then(|path| path.strip_prefix('@')) {
            use std::os::linux::net::SocketAddrExt as _;
            use std::os::unix::net::SocketAddr;

            if let Ok(address) = SocketAddr::from_abstract_name(name) {
                drop(sender.send_to_addr(words.as_bytes(), &address));
            }
            return;
        }
        drop(sender.send_to(words.as_bytes(), socket));
    }
}

#[cfg(not(unix))]
fn send(_socket: &std::path::Path, _words: &str) {}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::net::UnixDatagram;

    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn it_beats_while_frames_are_drawn_and_ticks_go_on_and_not_otherwise() {
        let folder = ScratchFolder::made("heartbeat");
        let path = folder.join("notify");
        let manager = UnixDatagram::bind(&path).unwrap();
        manager.set_nonblocking(true).unwrap();
        let heard = || {
            let mut bytes = [0; 64];
            let n = manager.recv(&mut bytes).ok()?;
            Some(String::from_utf8_lossy(&bytes[..n]).into_owned())
        };
        let mut heartbeat = Heartbeat {
            socket: Some(path),
            ..Heartbeat::default()
        };
        heartbeat.beat(0.0, 1);
        assert_eq!(heard().as_deref(), Some("READY=1\nWATCHDOG=1"));
        heartbeat.beat(1.0, 40);
        assert_eq!(heard(), None, "not with every frame");
        heartbeat.beat(4.0, 160);
        assert_eq!(heard().as_deref(), Some("WATCHDOG=1"));
        for second in 5..60 {
            heartbeat.beat(f64::from(second), 160);
        }
        assert_eq!(heard(), None, "the engine stands still");
        heartbeat.beat(60.0, 161);
        assert_eq!(heard().as_deref(), Some("WATCHDOG=1"));
        Heartbeat::default().beat(0.0, 1);
    }
}
