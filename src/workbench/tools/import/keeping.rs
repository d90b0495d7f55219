//! From what was read to textiles for the library: the files that the command line would write.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::finished;
use crate::bench::keep::{Keep, NewTextile};
use crate::bench::latest::Standing;
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::tools::import::Import;
use crate::tools::import::draft::WordsDraft;
use crate::tools::import::failure::{Failure, Step};
use crate::tools::import::work::{Body, Found};
use selvedge_foundation::progress::Progress;
use selvedge_textile::{TextileError, nth_id};

/// The textiles of what was read, one for every place.
pub(crate) fn textiles(found: &Found, said: &WordsDraft) -> Result<Vec<NewTextile>, Failure> {
    let suggested = found.own_name();
    let words = said.words(&suggested, found.kind)?;
    let id = said.id(&suggested);
    if id.is_empty() {
        let line = "the textile has no name; type one with at least a letter or a digit";
        return Err(Failure::at(Step::Keep, line));
    }
    let failed = |error: TextileError| Failure::of(Step::Keep, &error);
    let unread = || {
        Failure::at(
            Step::Keep,
            "nothing was read yet; mend what the steps above say",
        )
    };
    match &found.body {
        Body::Nothing => Err(unread()),
        Body::Strokes(strokes) => {
            let import = strokes.import.as_ref().ok_or_else(unread)?;
            let files = import.files(&words).map_err(failed)?;
            Ok(vec![NewTextile {
                id,
                name: words.name,
                files,
            }])
        }
        Body::Heights(heights) => {
            let n = heights.places.len();
            let bytes = found.inputs.described.files.first();
            let bytes = bytes.and_then(|file| file.source.bytes().ok());
            let textile = |nth: usize| {
                let place = heights.places[nth].as_ref();
                let place = place.map_err(|line| Failure::at(Step::Look, line.clone()))?;
                let words = words.nth(nth, n);
                let files = heights
                    .import
                    .files(place, &words, bytes.unwrap_or_default());
                Ok(NewTextile {
                    id: nth_id(&id, nth, n),
                    name: words.name,
                    files: files.map_err(failed)?,
                })
            };
            (0..n).map(textile).collect()
        }
    }
}

impl Import {
    /// Why nothing can be kept now; `None` if it can.
    pub(crate) fn refusal(&self) -> Option<String> {
        match self.standing() {
            Standing::Empty => return Some("Choose files first".to_owned()),
            Standing::Working(_) => return Some("The files are being read".to_owned()),
            Standing::Stopped => return Some("Reading was stopped; press “read again”".to_owned()),
            Standing::Fresh => {}
        }
        let found = self.found()?;
        if let Some(failure) = &found.failure {
            return Some(format!(
                "Step {} has something to mend",
                failure.step.number()
            ));
        }
        if self.is_keeping() {
            return Some("It is being kept".to_owned());
        }
        None
    }
}

impl Import {
    /// Begins to make the textiles, lets them be listened to, to keep them then.
    pub(crate) fn keep(&mut self, bench: &mut Bench) {
        if let Some(line) = self.refusal() {
            self.kept = Some(Err(Failure::at(Step::Keep, line)));
            return;
        }
        let Some(found) = self.found().cloned() else {
            return;
        };
        self.kept = None;
        let said = self.draft.words.clone();
        let make = move |_: &mut Progress<'_>| Ok(textiles(&found, &said));
        self.keeping = Some(bench.executor.start("selvedge-import-keep", make));
        self.poll_keeping(bench);
    }

    /// Takes textiles that are made. To be called every frame.
    pub(crate) fn poll_keeping(&mut self, bench: &mut Bench) {
        let failed = |line| Err(Failure::at(Step::Keep, format!("nothing was kept: {line}")));
        let Some(outcome) = finished(&mut self.keeping) else {
            return;
        };
        match outcome.unwrap_or_else(failed) {
            Ok(made) => {
                let made = Arc::new(made);
                self.offered = Some(Arc::clone(&made));
                let listen = LibraryCommand::Listen(made, Pane::Import);
                bench.commands.push(listen.into());
            }
            Err(failure) => self.kept = Some(Err(failure)),
        }
    }

    /// Notes that textiles are kept, if they are those that were offered last.
    pub(super) fn note_kept(&mut self, keep: &Keep) {
        let is_offered = |made: &mut Arc<_>| Arc::ptr_eq(made, &keep.textiles);
        if let Some(made) = self.offered.take_if(is_offered) {
            let names: Vec<&str> = made.iter().map(|textile| textile.id.as_str()).collect();
            self.kept = Some(Ok(names.join(", ")));
        }
    }
}
