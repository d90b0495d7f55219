//! What is asked for, what was found and drawn, and how far the work is.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crate::bench::Bench;
use crate::bench::background::{Executor, Task, finished};
use crate::bench::command::{FileCommand, Purpose, ShowCommand};
use crate::bench::export::Exportable;
use crate::bench::latest::Latest;
use crate::bench::pane::Pane;
use crate::bench::tool::PaneContext;
use crate::tools::analysis::asked::{Asked, Choice, Fields};
use crate::tools::analysis::findings::{Findings, find_out, stamp_of};
use crate::tools::analysis::pictures::{Pictures, Wanted};
use crate::tools::analysis::view::columns::Looks;
use selvedge_experiment::analysis::{Drawn, Section};
use selvedge_foundation::progress::Progress;

/// From one look at the folder of results to the next, s.
const LOOK_S: f64 = 2.0;

/// Analyses: what is asked for, and what was found last. Neither saved nor undoable.
#[derive(Default)]
pub(crate) struct Analysis {
    /// What is typed.
    pub(super) fields: Fields,
    /// What is chosen.
    pub(super) choice: Choice,
    /// The figure of the section at hand that is being saved.
    pub(super) saved_figure: usize,
    /// Whether results are shown although a session is held.
    pub(super) is_uncovered: bool,
    /// The folder that was offered last.
    pub(super) offered: PathBuf,
    pub(super) section: usize,
    pub(super) task: Option<Task<Findings>>,
    pub(super) found: Option<Arc<Findings>>,
    pub(super) failure: Option<String>,
    pub(super) writing: Option<Task<PathBuf>>,
    pub(super) written: Option<Result<PathBuf, String>>,
    /// A look whether the folder holds something else by now, and when it was taken last, s.
    pub(super) looking: Option<Task<u64>>,
    pub(super) looked_s: f64,
    /// What it held then.
    pub(super) stamp: Option<u64>,
    pub(super) pictures: Latest<Wanted, Pictures>,
    /// Tables and figures of the section at hand as they are laid out.
    pub(super) looks: Looks,
}

impl Analysis {
    /// What is asked for; `None` while something is missing.
    pub(crate) fn asked(&self) -> Option<Asked> {
        Some(Asked {
            folder: self.fields.folder()?,
            seed: self.fields.seed()?,
            choice: self.choice.clone(),
        })
    }

    pub(super) fn refusal(&self) -> Option<&'static str> {
        if self.fields.folder().is_none() {
            return Some("Say first in which folder the sessions lie");
        }
        let is_seed = self.fields.seed().is_some();
        (!is_seed).then_some("The seed is a whole number from 0 on")
    }

    /// The section at hand.
    pub(crate) fn section(&self) -> Option<&Section> {
        self.found.as_ref()?.analysis.sections.get(self.section)
    }

    /// The figure of the section at hand that is being saved.
    pub(crate) fn figure(&self) -> Option<(&Section, &Drawn)> {
        let section = self.section()?;
        Some((section, section.figures.get(self.saved_figure)?))
    }

    /// Runs of drawing that were begun.
    #[cfg(test)]
    pub(crate) fn n_drawn(&self) -> u64 {
        self.pictures.n_begun()
    }

    /// Offers a folder where none is typed; the same folder is offered once.
    pub(crate) fn offer(&mut self, folder: Option<&Path>) {
        let Some(folder) = folder.filter(|folder| *folder != self.offered) else {
            return;
        };
        if self.fields.folder.trim().is_empty() {
            self.fields.folder = folder.display().to_string();
        }
        folder.clone_into(&mut self.offered);
    }

    /// Begins the analysis that is asked for, unless one is under way.
    pub(crate) fn begin(&mut self, bench: &Bench) {
        let active = bench
            .session
            .active
            .as_ref()
            .map(|session| session.log.clone());
        self.begin_with(&bench.executor, active);
        bench.ctx.request_repaint();
    }

    /// The same; `active` is the log of the session that is active in this window.
    pub(super) fn begin_with(&mut self, executor: &Executor, active: Option<PathBuf>) {
        let Some(asked) = self.asked().filter(|_| self.task.is_none()) else {
            return;
        };
        self.failure = None;
        let work = move |progress: &mut Progress<'_>| find_out(asked, active.as_deref(), progress);
        self.task = Some(executor.start("selvedge-analysis", work));
    }

    /// Stops the analysis under way; the last result stays.
    pub(crate) fn stop(&self) {
        if let Some(task) = &self.task {
            task.stop();
        }
    }

    /// Analyses the logs in a folder, and shows what is found.
    pub(crate) fn open(&mut self, folder: &Path, bench: &mut Bench) {
        self.fields.folder = folder.display().to_string();
        let reveal = ShowCommand::Reveal(Pane::Analysis);
        bench.commands.push(reveal.into());
        self.begin(bench);
    }

    /// Writes the report of the last result into a folder.
    pub(crate) fn write(&mut self, folder: PathBuf, bench: &Bench) {
        let Some(found) = self.found.clone().filter(|_| self.writing.is_none()) else {
            return;
        };
        self.written = None;
        let work = move |_: &mut Progress<'_>| found.write(folder);
        self.writing = Some(bench.executor.start("selvedge-report", work));
        bench.ctx.request_repaint();
    }

    /// Shows the folder of the report in the desktop's file manager.
    pub(super) fn show_report(&self, bench: &mut Bench) {
        if let Some(Ok(folder)) = &self.written {
            bench.files.folders.open(&bench.executor, folder);
        }
    }

    /// Asks where a figure of the section at hand is saved.
    pub(super) fn save_figure(&mut self, nth: usize, context: &mut PaneContext<'_>) {
        self.saved_figure = nth;
        let purpose = Purpose::Export(Exportable::Pane(Pane::Analysis));
        context.commands.push(FileCommand::Ask(purpose).into());
    }

    /// Whether something else is asked for than was found.
    pub(super) fn is_past(&self) -> bool {
        let found = self.found.as_ref();
        found.is_some_and(|found| self.asked().as_ref() != Some(&found.asked))
    }

    /// Whether its folder holds something else than when it was analysed.
    pub(super) fn has_moved_on(&self) -> bool {
        let found = self.found.as_ref();
        let stamps = found.map(|found| found.stamp).zip(self.stamp);
        stamps.is_some_and(|(then, now)| then != now)
    }

    /// Looks now and then, while somebody sees the results, whether their folder has changed.
    pub(super) fn look(&mut self, bench: &Bench) {
        if let Some(Ok(stamp)) = finished(&mut self.looking) {
            self.stamp = Some(stamp);
        }
        let now_s = bench.ctx.input(|input| input.time);
        let is_due = now_s - self.looked_s >= LOOK_S || now_s < self.looked_s;
        let Some(found) = self
            .found
            .as_ref()
            .filter(|_| self.looking.is_none() && is_due)
        else {
            return;
        };
        self.looked_s = now_s;
        let folder = found.asked.folder.clone();
        let work = move |_: &mut Progress<'_>| Ok(stamp_of(&folder));
        self.looking = Some(bench.executor.start("selvedge-look", work));
        bench
            .ctx
            .request_repaint_after(Duration::from_secs_f64(LOOK_S));
    }

    /// How far the analysis under way is, 0…1.
    pub(super) fn share(&self) -> Option<f32> {
        self.task.as_ref().map(Task::share)
    }

    /// Whether results are hidden, since a participant may see them.
    pub(super) fn is_covered(&self, bench: &Bench) -> bool {
        bench.has_session() && !self.is_uncovered
    }

    /// Takes what threads have found, written and drawn. To be called every frame.
    pub(crate) fn poll(&mut self) {
        match finished(&mut self.task) {
            Some(Ok(found)) => self.take(found),
            Some(Err(line)) => self.failure = Some(line),
            None => {}
        }
        if let Some(outcome) = finished(&mut self.writing) {
            self.written = Some(outcome);
        }
        self.pictures.poll();
    }

    /// Takes a result; the section at hand stays where there is one of that key.
    pub(super) fn take(&mut self, found: Findings) {
        let key = self.section().map(|section| section.key.clone());
        let sections = &found.analysis.sections;
        let same = key.and_then(|key| sections.iter().position(|s| s.key == key));
        self.section = same.unwrap_or(0);
        self.stamp = Some(found.stamp);
        self.found = Some(Arc::new(found));
        self.written = None;
    }

    /// Follows the session that is active in this window: results are covered anew with the next
    /// one, and its folder is offered.
    pub(super) fn follow_session(&mut self, bench: &Bench) {
        if let Some(session) = &bench.session.active {
            self.offer(session.log.parent());
            return;
        }
        self.is_uncovered = false;
        let folder = bench.settings.preferences.folders.sessions.as_deref();
        self.offer(Some(Path::new(folder.unwrap_or_default())));
    }

    /// Has figures drawn as they are wanted.
    pub(super) fn draw(&mut self, bench: &Bench, wanted: &Wanted) {
        let before = self.pictures.n_begun();
        self.pictures.follow(&bench.ctx, &bench.executor, wanted);
        if self.pictures.n_begun() > before {
            bench.ctx.request_repaint();
        }
    }
}

impl std::fmt::Debug for Analysis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Analysis")
            .field("fields", &self.fields)
            .field("choice", &self.choice)
            .field("section", &self.section)
            .field("failure", &self.failure)
            .finish_non_exhaustive()
    }
}
