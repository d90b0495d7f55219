//! New textiles before they are kept: the first of them is felt wherever the scene has a textile,
//! or one of two of the library in its place, so that they are compared by touch. The scene itself
//! stays as it is.

use std::borrow::Cow;

use crate::bench::Bench;
use crate::bench::background::finished;
use crate::bench::command::ShowCommand;
use crate::bench::keep::{Listening, NewTextiles};
use crate::bench::pane::Pane;
use crate::bench::view::LibraryEntry;
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::level_db;
use selvedge_render::scene::Scene;
use selvedge_textile::Library;
use selvedge_textile::tactile::{Filters, Levels};

impl Bench {
    /// Begins to listen to new textiles.
    pub(crate) fn listen_to(&mut self, textiles: NewTextiles, from: Pane) {
        let Some(first) = textiles.first().cloned() else {
            return;
        };
        let read = move |_: &mut Progress<'_>| {
            let library = Library::of_files(&first.id, first.files);
            library.load(&first.id).map_err(|error| error.to_string())
        };
        self.library.acts.listening = Some(Listening {
            textiles,
            from,
            new: None,
            references: [None, None],
            felt: 0,
            reading: Some(self.executor.start("selvedge-listen", read)),
        });
        self.commands
            .push(ShowCommand::Reveal(Pane::Workspace).into());
        self.poll_listening();
    }

    /// Changes what is listened to, and lets it be felt.
    pub(crate) fn listen_otherwise(&mut self, change: impl FnOnce(&mut Listening)) {
        if let Some(listening) = &mut self.library.acts.listening {
            change(listening);
            self.feel_document();
        }
    }

    /// Feels the scene again.
    pub(crate) fn stop_listening(&mut self) {
        if let Some(listening) = self.library.acts.listening.take() {
            self.commands
                .push(ShowCommand::Reveal(listening.from).into());
            self.feel_document();
        }
    }

    /// Takes a new textile that is read.
    pub(crate) fn poll_listening(&mut self) {
        let listening = self.library.acts.listening.as_mut();
        let outcome = listening.and_then(|listening| finished(&mut listening.reading));
        match outcome {
            Some(Ok(new)) => {
                let mean_um = Levels::of(new.surface(), &Filters::default()).mean_um;
                let references = nearest(mean_um, self.library.view.items());
                self.listen_otherwise(|listening| {
                    listening.new = Some((new, mean_um));
                    listening.references = references;
                });
            }
            Some(Err(line)) => self.notices.give(line),
            None => {}
        }
    }

    /// A scene as it is felt: with what is listened to in the place of all its textiles.
    pub(crate) fn heard<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        let mut scene = Cow::Borrowed(scene);
        let listening = self.library.acts.listening.as_ref();
        let listening = listening.filter(|_| !self.has_session());
        if let Some(id) = listening.and_then(Listening::id) {
            for placed in &mut scene.to_mut().textiles {
                id.clone_into(&mut placed.id);
            }
        }
        scene
    }
}

/// The two textiles of a library whose amplitudes are nearest.
fn nearest(mean_um: [f64; 2], items: &[LibraryEntry]) -> [Option<String>; 2] {
    let off = |item: &LibraryEntry| {
        let bands = mean_um.iter().zip(item.mean_um);
        let squares = bands.map(|(a, b)| (level_db(*a) - level_db(b)).powi(2));
        let sum: f64 = squares.sum();
        if sum.is_finite() { sum } else { f64::INFINITY }
    };
    let mut sound: Vec<&LibraryEntry> = items.iter().filter(|item| item.flaw.is_none()).collect();
    sound.sort_by(|a, b| off(a).total_cmp(&off(b)));
    [0, 1].map(|nth| sound.get(nth).map(|item| item.id.clone()))
}
