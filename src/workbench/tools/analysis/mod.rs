//! Logs of experiments that are analysed in the window: a folder, a few choices, what was found.
//!
//! ```text
//! folder, choices ─▶ Asked ─▶ find_out (a thread) ─▶ Findings ─┬▶ pane ─▶ Wanted ─▶ Pictures
//!                                                              └▶ files (a thread)
//! ```
//!
//! # Invariants
//! - the numbers are those of `experiment::analysis`: here is only what is asked for, and when
//! - nothing begins by itself, and a result stays until another one is there
//! - who takes part in a session that is being held is left out unless that is asked for

pub(crate) mod asked;
pub(crate) mod command;
pub(crate) mod dispatch;
pub(crate) mod export;
pub(crate) mod findings;
pub(crate) mod pane;
pub(crate) mod pictures;
#[cfg(test)]
mod tests;
pub(crate) mod view;

pub(crate) use crate::tools::analysis::asked::Asked;
pub(crate) use crate::tools::analysis::asked::Choice;
#[cfg(test)]
pub(crate) use crate::tools::analysis::asked::Effort;
pub(crate) use crate::tools::analysis::asked::Fields;
#[cfg(test)]
pub(crate) use crate::tools::analysis::command::AnalysisCommand;
pub(crate) use crate::tools::analysis::findings::Findings;
pub(crate) use crate::tools::analysis::findings::find_out;
pub(crate) use crate::tools::analysis::pictures::Pictures;
pub(crate) use crate::tools::analysis::pictures::Wanted;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::bench::follower::Follower;
use crate::bench::task::{Task, taken};
use selvedge_experiment::analysis::{Drawn, Section, Table};

/// What the window knows of analyses: neither saved nor undoable.
#[derive(Default)]
pub(crate) struct Analysing {
    /// What is typed.
    pub fields: Fields,
    /// What is chosen.
    pub choice: Choice,
    /// The figure of the section at hand that is being saved.
    pub(crate) saved_figure: usize,
    /// Whether results are shown although a session is held.
    pub(crate) is_uncovered: bool,
    /// The folder that was offered last.
    offered: PathBuf,
    section: usize,
    task: Option<Task<Findings>>,
    found: Option<Arc<Findings>>,
    failure: Option<String>,
    writing: Option<Task<PathBuf>>,
    written: Option<Result<PathBuf, String>>,
    pictures: Follower<Pictures>,
}

/// An analysis as the pane draws it.
#[derive(Debug, Clone)]
pub(crate) struct AnalysisView<'a> {
    /// What was found last.
    pub found: Option<&'a Arc<Findings>>,
    /// The section at hand.
    pub section: usize,
    /// What is chosen for the next one.
    pub choice: &'a Choice,
    /// How far the one under way is, 0…1.
    pub share: Option<f32>,
    /// Why none can begin.
    pub refusal: Option<&'static str>,
    /// Why the last one failed.
    pub failure: Option<&'a str>,
    /// Whether something else is asked for than was found.
    pub(crate) is_past: bool,
    /// How far writing is, 0…1.
    pub writing: Option<f32>,
    /// Where it was written last, or why it was not.
    pub written: Option<Result<&'a Path, &'a str>>,
    /// Who takes part in the session that is held in this window.
    pub held: Option<&'a str>,
    /// Whether results are hidden, since a participant may see them.
    pub is_covered: bool,
    /// The figures of a section as they were drawn last.
    pub pictures: Option<&'a Arc<Pictures>>,
}

impl Analysing {
    /// What is asked for; `None` while something is missing.
    pub(crate) fn asked(&self) -> Option<Asked> {
        Some(Asked {
            folder: self.fields.folder()?,
            seed: self.fields.seed()?,
            choice: self.choice.clone(),
        })
    }

    fn refusal(&self) -> Option<&'static str> {
        if self.fields.folder().is_none() {
            return Some("Say first in which folder the sessions lie");
        }
        let is_seed = self.fields.seed().is_some();
        (!is_seed).then_some("The seed is a whole number from 0 on")
    }

    /// The last result.
    pub(crate) fn found(&self) -> Option<&Arc<Findings>> {
        self.found.as_ref()
    }

    /// The section at hand.
    pub(crate) fn section(&self) -> Option<&Section> {
        self.found.as_ref()?.analysis.sections.get(self.section)
    }

    /// A table of the section at hand.
    pub(crate) fn table(&self, nth: usize) -> Option<&Table> {
        self.section()?.tables.get(nth)
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

    /// Shows a section.
    pub(crate) fn select(&mut self, section: usize) {
        self.section = section;
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

    /// Begins the analysis that is asked for, unless one is under way. `held` is the log of the
    /// session that this window holds.
    pub(crate) fn begin(&mut self, ctx: &egui::Context, is_at_once: bool, held: Option<PathBuf>) {
        let Some(asked) = self.asked().filter(|_| self.task.is_none()) else {
            return;
        };
        self.failure = None;
        let work = move |progress: &mut selvedge_foundation::progress::Progress<'_>| {
            find_out(asked, held.as_deref(), progress)
        };
        let name = ("selvedge-analysis", ctx);
        self.task = Some(Task::start(name, is_at_once, work));
        ctx.request_repaint();
    }

    /// Stops the analysis under way; the last result stays.
    pub(crate) fn stop(&self) {
        if let Some(task) = &self.task {
            task.stop();
        }
    }

    /// Where a report goes unless another folder is chosen.
    pub(crate) fn report_folder(&self) -> Option<PathBuf> {
        Some(self.found.as_ref()?.report_folder())
    }

    /// Writes the report of the last result into a folder.
    pub(crate) fn write(&mut self, ctx: &egui::Context, is_at_once: bool, folder: PathBuf) {
        let Some(found) = self.found.clone().filter(|_| self.writing.is_none()) else {
            return;
        };
        self.written = None;
        let work = move |_: &mut selvedge_foundation::progress::Progress<'_>| found.write(folder);
        self.writing = Some(Task::start(("selvedge-report", ctx), is_at_once, work));
        ctx.request_repaint();
    }

    /// Takes what threads have found, written and drawn. To be called every frame.
    pub(crate) fn poll(&mut self) {
        match taken(&mut self.task) {
            Some((Ok(found), _)) => self.take(found),
            Some((Err(line), false)) => self.failure = Some(line),
            // Whoever stopped it knows.
            Some((Err(_), true)) | None => {}
        }
        if let Some((outcome, _)) = taken(&mut self.writing) {
            self.written = Some(outcome);
        }
        self.pictures.poll();
    }

    /// Takes a result; the section at hand stays where there is one of that key.
    fn take(&mut self, found: Findings) {
        let key = self.section().map(|section| section.key.clone());
        let sections = &found.analysis.sections;
        let same = key.and_then(|key| sections.iter().position(|s| s.key == key));
        self.section = same.unwrap_or(0);
        self.found = Some(Arc::new(found));
        self.written = None;
    }

    /// Has figures drawn as they are wanted: to be called while they are in sight.
    pub(crate) fn draw(&mut self, ctx: &egui::Context, is_at_once: bool, wanted: Wanted) {
        let before = self.pictures.n_begun();
        self.pictures.follow(ctx, is_at_once, wanted);
        if is_at_once && self.pictures.n_begun() > before {
            ctx.request_repaint();
        }
    }

    /// Who is left out of the next analysis and what is covered follow from the session that is
    /// held in this window, if one is: who takes part.
    pub(crate) fn view<'a>(&'a self, held: Option<&'a str>) -> AnalysisView<'a> {
        let found = self.found.as_ref();
        let is_past = found.is_some_and(|found| self.asked().as_ref() != Some(&found.asked));
        AnalysisView {
            found,
            section: self.section,
            choice: &self.choice,
            share: self.task.as_ref().map(Task::share),
            refusal: self.refusal(),
            failure: self.failure.as_deref(),
            is_past,
            writing: self.writing.as_ref().map(Task::share),
            written: self.written.as_ref().map(|written| match written {
                Ok(folder) => Ok(folder.as_path()),
                Err(line) => Err(line.as_str()),
            }),
            held,
            is_covered: held.is_some() && !self.is_uncovered,
            pictures: self.pictures.found(),
        }
    }
}

impl std::fmt::Debug for Analysing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Analysing")
            .field("fields", &self.fields)
            .field("choice", &self.choice)
            .field("section", &self.section)
            .field("failure", &self.failure)
            .finish_non_exhaustive()
    }
}
