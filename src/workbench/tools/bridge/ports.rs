//! The serial ports of this machine, listed on a thread of its own: some drivers take their time.

use eframe::egui;

use crate::bench::background::{Executor, Task, finished};
use crate::tools::bridge::replug::Replug;
use selvedge_device::{FoundPort, PortEntry, Target};

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

/// The ports that are known, and a listing on its way.
#[derive(Debug, Default)]
pub(crate) struct Ports {
    view: PortsView,
    listing: Option<Task<Vec<PortEntry>>>,
    replug: Replug,
}

impl Ports {
    /// Begins to list the ports, unless that is under way.
    pub(crate) fn list(&mut self, ctx: &egui::Context) {
        self.list_by(ctx, || PortEntry::list().map_err(|error| error.to_string()));
    }

    fn list_by(
        &mut self,
        ctx: &egui::Context,
        list: impl FnOnce() -> Result<Vec<PortEntry>, String> + Send + 'static,
    ) {
        if self.view.is_listing {
            return;
        }
        self.view.is_listing = true;
        let threads = Executor::Threads(ctx.clone());
        self.listing = Some(threads.start("selvedge-ports", |_| list()));
    }

    /// Takes what was found, once it is there. To be called every frame.
    pub(crate) fn poll(&mut self) {
        let (ports, error) = match finished(&mut self.listing) {
            Some(Ok(ports)) => (ports, None),
            Some(Err(error)) => (Vec::new(), Some(error)),
            None => return,
        };
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
    pub(crate) fn hold(&mut self, ctx: &egui::Context, target: Option<&Target>) {
        self.view.back = None;
        match target {
            Some(Target::Port(path)) => self.replug.hold(ctx, path.clone()),
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
    fn listed(ports: &mut Ports, list: fn() -> Result<Vec<PortEntry>, String>) {
        ports.list_by(&egui::Context::default(), list);
        assert!(ports.view().is_listing, "on its way");
        while ports.listing.is_some() {
            ports.poll();
            std::thread::yield_now();
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
        listed(&mut ports, || Err("no udev".to_owned()));
        assert!(ports.view().ports.is_empty() && ports.view().is_known);
        let error = ports.view().error.clone();
        assert!(error.is_some_and(|error| error.contains("no udev")));
    }

    #[test]
    fn a_listing_that_is_under_way_is_not_begun_again() {
        let ctx = egui::Context::default();
        let (go, wait) = std::sync::mpsc::sync_channel::<()>(0);
        let mut ports = Ports::default();
        ports.list_by(&ctx, move || {
            wait.recv().ok();
            Ok(one())
        });
        ports.list_by(&ctx, || Ok(Vec::new()));
        ports.poll();
        assert!(ports.view().is_listing);
        drop(go);
        while ports.listing.is_some() {
            ports.poll();
        }
        assert_eq!(ports.view().ports.len(), 1);
    }
}
