//! Before a session: its folder is listed, textiles are prepared, its log is opened.

use std::path::PathBuf;

use crate::bench::Bench;
use crate::bench::pane::Pane;
use crate::bench::settings::own_certificates;
use crate::tools::experiment::form::{SessionPlan, list};
use crate::tools::experiment::materials::Materials;
use crate::tools::experiment::state::{Begun, Experiment};
use selvedge_device::{CertificateFolder, DeviceUid};
use selvedge_experiment::design::Design;
use selvedge_experiment::session::{Origin, Session, Sidecar};
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::progress::Progress;

impl Experiment {
    /// Looks which sessions the folder holds.
    pub(crate) fn list_sessions(&mut self, bench: &Bench, is_asked: bool) {
        let folder = self.form.folder();
        let work = move |progress: &mut Progress<'_>| list(&folder, is_asked, progress);
        let listing = bench.executor.start("selvedge-sessions", work);
        self.form.lists(listing);
    }

    /// Lists a folder once it was typed, while somebody looks.
    pub(crate) fn follow_folder(&mut self, bench: &Bench) {
        let is_typing = bench.ctx.egui_wants_keyboard_input();
        let is_seen = bench.shows(Pane::Experimenter) || bench.shows(Pane::Board);
        if self.form.is_to_be_listed() && !is_typing && is_seen {
            self.list_sessions(bench, false);
        }
        self.form.who.follow(&self.form.participants);
    }

    /// Begins the session that the form describes.
    pub(crate) fn begin_session(&mut self, bench: &mut Bench) {
        self.begin_on(self.form.plan(), false, bench);
    }

    /// Begins a pilot: what is asked is tried on the screen, and nobody feels it.
    pub(crate) fn begin_pilot(&mut self, bench: &mut Bench) {
        self.begin_on(self.form.pilot_plan(), true, bench);
    }

    /// Begins what is planned, on the screen alone where it is a pilot.
    pub(super) fn begin_on(
        &mut self,
        plan: Option<SessionPlan>,
        is_pilot: bool,
        bench: &mut Bench,
    ) {
        let (Some(plan), path) = (plan, self.form.study.chosen().path().to_owned()) else {
            return;
        };
        self.asked = None;
        let device = device_name(bench);
        let (design, beside) = (plan.design.clone(), path.clone());
        let profile = bench.engine.profile().to_toml();
        let caps = bench.engine.snapshot().link.and_then(|link| link.caps);
        let caps = caps.filter(|_| !bench.is_emulated());
        let open = move |materials: &Materials| {
            let certificate = caps.zip(own_certificates()).and_then(|(caps, folder)| {
                CertificateFolder::new(&folder).sha256(DeviceUid(caps.uid), caps.firmware)
            });
            let subject = plan.enrolled()?;
            let profile = profile.map_err(|error| error.to_string())?;
            let origin = Origin::file(&device, &beside)
                .piloting(is_pilot)
                .knowing(materials.manifests())
                .with("program", program_sha256())
                .with("library", materials.hashes.all())
                .with("scene", materials.scene_sha256())
                .with("profile", sha256_hex([profile.as_bytes()]))
                .with("certificate", certificate);
            let session = Session::create(&plan.folder, plan.design, subject, origin);
            session.map_err(|error| error.to_string())
        };
        self.start_session(bench, move || Ok((design, path)), open);
    }

    /// Goes on with the session of this log.
    pub(crate) fn resume_session(&mut self, log: PathBuf, bench: &Bench) {
        let device = device_name(bench);
        let from = log.clone();
        let read = move || {
            let sidecar = Sidecar::read(&from).map_err(|error| error.to_string())?;
            let design = sidecar.design(&from).map_err(|error| error.to_string())?;
            let file = sidecar.design_file(&from);
            Ok((design, file.map_err(|error| error.to_string())?))
        };
        let open =
            move |_: &Materials| Session::resume(&log, &device).map_err(|error| error.to_string());
        self.start_session(bench, read, open);
    }

    /// Gathers what a session presents, then opens its log; on a thread.
    fn start_session(
        &mut self,
        bench: &Bench,
        read: impl FnOnce() -> Result<(Design, PathBuf), String> + Send + 'static,
        open: impl FnOnce(&Materials) -> Result<Session, String> + Send + 'static,
    ) {
        if self.session.is_some() || self.beginning.is_some() {
            return;
        }
        if bench.engine_scene.preparing.is_busy() || bench.files.opening.is_some() {
            let line = "The scene is still being prepared: begin once it is there";
            self.form.failure = Some(line.to_owned());
            return;
        }
        self.form.failure = None;
        let displays = &bench.document.scene().displays;
        let display = displays.first().cloned().unwrap_or_default();
        let how = (display, bench.settings.preferences.rendering);
        let work = move |progress: &mut Progress<'_>| {
            progress
                .step(0.1, "textiles")
                .map_err(|stop| stop.to_string())?;
            let (design, path) = read()?;
            let materials = Materials::gather(&design, &path, how);
            let materials = materials.map_err(|error| error.to_string())?;
            progress.step(0.9, "log").map_err(|stop| stop.to_string())?;
            let session = open(&materials)?;
            Ok(Begun { session, materials })
        };
        self.beginning = Some(bench.executor.start("selvedge-session", work));
        bench.ctx.request_repaint();
    }
}

/// SHA-256 of the program that runs; `None` where its file cannot be read.
fn program_sha256() -> Option<String> {
    let program = std::env::current_exe().ok()?;
    Some(sha256_hex([&std::fs::read(program).ok()?[..]]))
}

/// The device, as logs call it.
pub(crate) fn device_name(bench: &Bench) -> String {
    let target = bench.device.target.as_deref();
    target.unwrap_or("none").to_owned()
}
