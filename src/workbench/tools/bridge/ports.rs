//! The serial ports of this machine, listed on a thread of its own: some drivers take their time.

use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;

use eframe::egui;

use crate::tools::bridge::replug::Replug;
use selvedge_device::{BridgeError, FoundPort, PortEntry, Target, list_ports};

/// The ports as a pane shows them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct PortsView {
    /// Whether they are being listed now; what was found before stays until then.
    pub(crate) is_listing: bool,
    /// Whether they have ever been listed.
    pub is_known: bool,
    /// What to open, and what it is.
    pub ports: Vec<(String, String)>,
    /// Why they cannot be listed.
    pub error: Option<String>,
    /// The device that was lost and is back.
    pub back: Option<FoundPort>,
}

/// What a listing found.
type Listed = Result<Vec<PortEntry>, BridgeError>;

/// The ports that are known, and a listing on its way.
#[derive(Debug, Default)]
pub(crate) struct Ports {
    view: PortsView,
    listing: Option<Receiver<Listed>>,
    replug: Replug,
}

impl Ports {
    /// Begins to list the ports, unless that is under way; `ctx` is woken when it is done.
    pub(crate) fn list(&mut self, ctx: &egui::Context) {
        let ctx = ctx.clone();
        self.list_by(list_ports, move || ctx.request_repaint());
    }

    fn list_by(
        &mut self,
        list: impl FnOnce() -> Listed + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) {
        if self.view.is_listing {
            return;
        }
        let (sender, listing) = sync_channel(1);
        let job = thread::Builder::new().name("selvedge-ports".to_owned());
        let started = job.spawn(move || {
            // Nobody waits any more when the window is gone.
            drop(sender.send(list()));
            wake();
        });
        match started {
            Ok(_) => {
                self.view.is_listing = true;
                self.listing = Some(listing);
            }
            Err(error) => self.view.error = Some(format!("cannot list ports: {error}")),
        }
    }

    /// Takes what was found, once it is there. To be called every frame.
    pub(crate) fn poll(&mut self) {
        let Some(listing) = &self.listing else {
            return;
        };
        let (ports, error) = match listing.try_recv() {
            Err(TryRecvError::Empty) => return,
            Ok(Ok(ports)) => (ports, None),
            Ok(Err(error)) => (Vec::new(), Some(error.to_string())),
            Err(TryRecvError::Disconnected) => {
                (Vec::new(), Some("listing the ports broke off".to_owned()))
            }
        };
        self.listing = None;
        self.view = PortsView {
            is_listing: false,
            is_known: true,
            ports: ports
                .into_iter()
                .map(|port| (port.path, port.description))
                .collect(),
            error,
            back: self.view.back.take(),
        };
    }

    /// A link is opened to `target`, or to none any more.
    pub(crate) fn hold(&mut self, target: Option<&Target>) {
        self.view.back = None;
        match target {
            Some(Target::Port(path)) => self.replug.hold(path.clone()),
            Some(_) | None => self.replug.let_go(),
        }
    }

    /// Follows the link: while it is lost its device is looked for, off this thread. Gives what is
    /// back, once. To be called every frame.
    pub(crate) fn follow(
        &mut self,
        ctx: &egui::Context,
        is_lost: bool,
        uid: Option<[u8; 12]>,
    ) -> Option<FoundPort> {
        let ctx = ctx.clone();
        let found = self
            .replug
            .follow(is_lost, uid, move || ctx.request_repaint());
        self.view.back = self.replug.back().cloned();
        found
    }

    /// What is known of them.
    pub(crate) fn view(&self) -> &PortsView {
        &self.view
    }
}

#[cfg(test)]
impl Ports {
    /// Ports that were found, and are looked for no more.
    pub(crate) fn found(view: PortsView) -> Self {
        Self {
            view,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lists by `list` and takes the outcome.
    fn listed(ports: &mut Ports, list: fn() -> Listed) {
        let (woken, wake) = sync_channel(1);
        let wake_up = move || {
            woken.send(()).ok();
        };
        ports.list_by(list, wake_up);
        assert!(ports.view().is_listing, "on its way");
        // It ends without a word when the thread breaks off.
        wake.recv().ok();
        while ports.listing.is_some() {
            ports.poll();
        }
    }

    fn one() -> Vec<PortEntry> {
        vec![PortEntry {
            path: "/dev/ttyACM0".to_owned(),
            description: "Array bridge".to_owned(),
            usb: None,
        }]
    }

    #[test]
    fn what_was_found_is_shown_and_an_error_too() {
        let mut ports = Ports::default();
        assert_eq!(ports.view(), &PortsView::default());
        listed(&mut ports, || Ok(one()));
        let found = [("/dev/ttyACM0".to_owned(), "Array bridge".to_owned())];
        assert_eq!(ports.view().ports, found);
        listed(&mut ports, || Err(BridgeError::List("no udev".to_owned())));
        assert!(ports.view().ports.is_empty() && ports.view().is_known);
        let error = ports.view().error.clone();
        assert!(error.is_some_and(|error| error.contains("no udev")));
    }

    #[test]
    fn a_listing_that_is_under_way_is_not_begun_again() {
        let (go, wait) = sync_channel::<()>(0);
        let mut ports = Ports::default();
        ports.list_by(
            move || {
                wait.recv().ok();
                Ok(one())
            },
            || {},
        );
        ports.list_by(|| Ok(Vec::new()), || {});
        ports.poll();
        assert!(ports.view().is_listing);
        drop(go);
        while ports.listing.is_some() {
            ports.poll();
        }
        assert_eq!(ports.view().ports.len(), 1);
    }
}
