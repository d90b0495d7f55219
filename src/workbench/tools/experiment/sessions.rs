//! Before a session: its folder is listed, a masking noise written, textiles prepared, its log
//! opened.

use std::path::{Path, PathBuf};

use eframe::egui;

use crate::bench::Bench;
use crate::bench::pane::Pane;
use crate::bench::rendering::Rendering;
use crate::bench::task::{Task, taken};
use crate::tools::experiment::Begun;
use crate::tools::experiment::form::list;
use crate::tools::experiment::materials::Materials;
use crate::tools::experiment::noise::write_noise;
use selvedge_experiment::design::Design;
use selvedge_experiment::session::{Origin, Session, Sidecar};
use selvedge_foundation::progress::Progress;
use selvedge_render::scene::Display;

impl Bench {
    pub(crate) fn list_sessions(&mut self, ctx: &egui::Context, is_asked: bool) {
        let form = &mut self.transient.experiment.form;
        let folder = form.folder();
        let work = move |_: &mut Progress<'_>| list(&folder, is_asked);
        let name = ("selvedge-sessions", ctx);
        form.lists(Task::start(name, self.is_stepped, work));
    }

    pub(crate) fn write_noise(&mut self, ctx: &egui::Context) {
        let experiment = &mut self.transient.experiment;
        if experiment.form.kept_folder().is_none() || experiment.noise.is_some() {
            return;
        }
        let folder = experiment.form.folder();
        let work = move |progress: &mut Progress<'_>| write_noise(&folder, progress);
        let name = ("selvedge-noise", ctx);
        experiment.noise = Some(Task::start(name, self.is_stepped, work));
    }

    /// Takes what came of a masking noise.
    pub(crate) fn poll_noise(&mut self) {
        let experiment = &mut self.transient.experiment;
        match taken(&mut experiment.noise) {
            Some((Ok(()), _)) => experiment.form.has_noise = true,
            Some((Err(line), _)) => self.transient.notices.give(line),
            None => {}
        }
    }

    /// Lists a folder once it was typed, while somebody looks.
    pub(crate) fn follow_folder(&mut self, ctx: &egui::Context) {
        let is_due = self.transient.experiment.form.is_to_be_listed();
        let is_typing = ctx.egui_wants_keyboard_input();
        if is_due && !is_typing && self.shows(Pane::Experimenter) {
            self.list_sessions(ctx, false);
        }
        let form = &mut self.transient.experiment.form;
        form.who.follow(&form.participants);
    }

    pub(crate) fn begin_session(&mut self, ctx: &egui::Context) {
        let form = &self.transient.experiment.form;
        let (Some(told), path) = (form.told(), form.chosen.path().to_owned()) else {
            return;
        };
        let device = self.device_name();
        let (design, beside) = (told.design.clone(), path.clone());
        let open = move || {
            let subject = told.enrolled()?;
            let origin = Origin::file(&device, &beside);
            let session = Session::create(&told.folder, told.design, subject, origin);
            session.map_err(|error| error.to_string())
        };
        self.start_session(ctx, move || Ok((design, path)), open);
    }

    pub(crate) fn resume_session(&mut self, ctx: &egui::Context, log: PathBuf) {
        let device = self.device_name();
        let from = log.clone();
        let read = move || {
            let sidecar = Sidecar::read(&from).map_err(|error| error.to_string())?;
            let design = sidecar.design(&from).map_err(|error| error.to_string())?;
            let file = sidecar.design_file(&from);
            Ok((design, file.map_err(|error| error.to_string())?))
        };
        let open = move || Session::resume(&log, &device).map_err(|error| error.to_string());
        self.start_session(ctx, read, open);
    }

    /// Gathers what a session presents, then opens its log; on a thread.
    fn start_session(
        &mut self,
        ctx: &egui::Context,
        read: impl FnOnce() -> Result<(Design, PathBuf), String> + Send + 'static,
        open: impl FnOnce() -> Result<Session, String> + Send + 'static,
    ) {
        let is_busy = self.preparing.is_busy() || self.transient.opening.is_some();
        let experiment = &mut self.transient.experiment;
        if experiment.is_held() || experiment.beginning.is_some() {
            return;
        }
        if is_busy {
            let words = "The scene is still being prepared: begin once it is there";
            experiment.form.failure = Some(words.to_owned());
            return;
        }
        experiment.form.failure = None;
        let how = (self.session_display(), self.settings.preferences.rendering);
        let work = move |progress: &mut Progress<'_>| {
            progress
                .step(0.1, "textiles")
                .map_err(|stop| stop.to_string())?;
            let (design, path) = read()?;
            let materials = gather(&design, &path, how)?;
            progress.step(0.9, "log").map_err(|stop| stop.to_string())?;
            let session = open()?;
            Ok(Begun { session, materials })
        };
        let task = Task::start(("selvedge-session", ctx), self.is_stepped, work);
        self.transient.experiment.beginning = Some(task);
        ctx.request_repaint();
    }

    fn session_display(&self) -> Display {
        let displays = &self.document.scene().displays;
        displays.first().cloned().unwrap_or_default()
    }

    pub(crate) fn device_name(&self) -> String {
        self.transient
            .target
            .as_deref()
            .unwrap_or("none")
            .to_owned()
    }
}

fn gather(design: &Design, path: &Path, how: (Display, Rendering)) -> Result<Materials, String> {
    Materials::gather(design, path, how).map_err(|error| error.to_string())
}
