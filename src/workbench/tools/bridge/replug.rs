//! A device whose link was lost, looked for once a second on a thread of its own until it is back.
//!
//! Nothing connects and nothing arms by itself: what is found is only told. The thread lives while
//! a link is lost, and no longer.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;
use std::time::Duration;

use eframe::egui;

use crate::bench::background::{Executor, Task};
use selvedge_device::{FoundPort, PortIdentity};

const EVERY: Duration = Duration::from_secs(1);
/// How soon the thread ends when nobody wants to know any more.
const NAP: Duration = Duration::from_millis(50);

/// The port that is or was connected, and the search for it.
#[derive(Debug, Default)]
pub(crate) struct Replug {
    phase: Phase,
}

/// Where it stands.
#[derive(Debug, Default)]
enum Phase {
    /// No port.
    #[default]
    Nothing,
    /// Its identity is being found out.
    Asking(Task<PortIdentity>),
    /// Connected, or at least not lost.
    Held(PortIdentity),
    /// Lost, and looked for.
    Searching(Search),
    /// Back; told once.
    Back(FoundPort),
}

/// A search that ends when it is dropped.
#[derive(Debug)]
struct Search {
    found: Receiver<FoundPort>,
    is_over: Arc<AtomicBool>,
}

impl Drop for Search {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Release);
    }
}

impl Replug {
    /// A port was opened: what it is recognised by is asked for while it is there.
    pub(crate) fn hold(&mut self, ctx: &egui::Context, path: PathBuf) {
        let threads = Executor::Threads(ctx.clone());
        let identity = threads.start("selvedge-ports", move |_| Ok(PortIdentity::of(&path)));
        self.phase = Phase::Asking(identity);
    }

    /// No port is of interest any more.
    pub(crate) fn let_go(&mut self) {
        self.phase = Phase::Nothing;
    }

    /// Follows the link: a search begins when it is lost, `wake` is called when the device is
    /// back. Gives the find once. To be called every frame.
    pub(crate) fn follow(
        &mut self,
        is_lost: bool,
        uid: Option<[u8; 12]>,
        wake: impl FnOnce() + Send + 'static,
    ) -> Option<FoundPort> {
        self.take_identity();
        if is_lost && matches!(self.phase, Phase::Held(_)) {
            let Phase::Held(mut lost) = std::mem::take(&mut self.phase) else {
                return None;
            };
            lost.uid = uid.or(lost.uid);
            self.phase = search(lost, wake).map_or(Phase::Nothing, Phase::Searching);
        }
        let Phase::Searching(search) = &self.phase else {
            return None;
        };
        let found = search.found.try_recv().ok()?;
        self.phase = Phase::Back(found.clone());
        Some(found)
    }

    /// The device that is back, if it is.
    pub(crate) fn back(&self) -> Option<&FoundPort> {
        match &self.phase {
            Phase::Back(found) => Some(found),
            _ => None,
        }
    }

    fn take_identity(&mut self) {
        let Phase::Asking(asked) = &self.phase else {
            return;
        };
        match asked.poll() {
            Some(Ok(identity)) => self.phase = Phase::Held(identity),
            // Without an identity nothing is found again; everything else goes on.
            Some(Err(_)) => self.phase = Phase::Nothing,
            None => {}
        }
    }
}

/// Looks once a second; `None` when there is no thread for it. It says nothing while it looks, so
/// that nothing is drawn for it.
fn search(mut lost: PortIdentity, wake: impl FnOnce() + Send + 'static) -> Option<Search> {
    let (sender, found) = sync_channel(1);
    let is_over = Arc::new(AtomicBool::new(false));
    let over = Arc::clone(&is_over);
    let look = move || {
        loop {
            if let Some(found) = lost.look() {
                // Nobody wants to know any more when another port was opened.
                drop(sender.send(found));
                return wake();
            }
            let mut waited = Duration::ZERO;
            while waited < EVERY {
                if over.load(Ordering::Acquire) {
                    return;
                }
                thread::sleep(NAP);
                waited += NAP;
            }
        }
    };
    let job = thread::Builder::new().name("selvedge-replug".to_owned());
    job.spawn(look).ok()?;
    Some(Search { found, is_over })
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;
    use std::sync::mpsc::sync_channel;

    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_lost_port_is_told_once_when_it_is_back_under_another_name() {
        let folder = ScratchFolder::made("back");
        let (old, new) = (folder.join("array"), folder.join("array-2"));
        symlink("/dev/null", &old).unwrap();
        let mut replug = Replug::default();
        replug.hold(&egui::Context::default(), old.clone());
        while !matches!(replug.phase, Phase::Held(_)) {
            assert_eq!(replug.follow(false, None, || {}), None, "it is not lost");
        }
        std::fs::remove_file(&old).unwrap();
        let (woken, wake) = sync_channel(1);
        let wake_up = move || woken.send(()).unwrap();
        assert_eq!(replug.follow(true, Some([7; 12]), wake_up), None);
        assert!(replug.back().is_none());
        // The first look finds it away; a later one finds it.
        thread::sleep(Duration::from_millis(300));
        symlink("/dev/null", &new).unwrap();
        wake.recv().unwrap();
        let found = replug.follow(true, None, || {}).unwrap();
        assert_eq!(found.path, new);
        assert_eq!(replug.follow(true, None, || {}), None, "told once");
        assert_eq!(replug.back(), Some(&found));
        replug.let_go();
        assert!(replug.back().is_none());
    }

    #[test]
    fn a_search_that_nobody_wants_ends() {
        let path = std::env::temp_dir().join("selvedge-never-there");
        let mut replug = Replug::default();
        replug.hold(&egui::Context::default(), path);
        while !matches!(replug.phase, Phase::Searching(_)) {
            replug.follow(true, None, || {});
        }
        let Phase::Searching(search) = &replug.phase else {
            panic!("searching");
        };
        let over = Arc::clone(&search.is_over);
        replug.let_go();
        assert!(over.load(Ordering::Acquire));
        while Arc::strong_count(&over) > 1 {
            thread::sleep(NAP);
        }
    }
}
