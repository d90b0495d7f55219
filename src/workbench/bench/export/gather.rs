//! Where the numbers that panes show come from.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exportable, Exported};
use crate::bench::{Bench, query};

impl Bench {
    /// What a pane shows now.
    ///
    /// # Errors
    /// There is nothing, and what to do about it.
    pub(crate) fn exported(&mut self, what: Exportable) -> Result<Exported, &'static str> {
        match what {
            Exportable::Analysed => self.gather_analysed(),
            _ => Err("This pane shows no numbers to export"),
        }
    }

    /// Where numbers of the scene come from.
    pub(crate) fn origin(&self) -> Origin {
        let reference_db = self.transient.reference_db;
        let scene = self.document.scene();
        let origin = Origin::of(scene, &self.document.tuning(), reference_db);
        if self.transient.mute_solo.is_any() {
            let words = "parts are muted or felt alone";
            origin.and("audition", words, words)
        } else {
            origin
        }
    }

    /// The same for amplitudes that the engine rendered.
    pub(crate) fn rendered_origin(&self) -> Origin {
        let status = &self.transient.live.status;
        self.origin().by_method(status.method, status.bound_db)
    }

    fn gather_analysed(&mut self) -> Result<Exported, &'static str> {
        let analysing = &self.transient.analysing;
        let found = analysing.found().zip(analysing.figure());
        let (found, (_, drawn)) =
            found.ok_or("There is nothing to export yet: analyse sessions in the Analysis pane")?;
        Ok(crate::tools::analysis::export::figure(found, drawn))
    }

    /// The scene as panes draw it, without a look at pictures.
    pub(crate) fn plain_scene_view(&self) -> crate::bench::view::SceneView {
        query::scene_view(
            &self.document,
            &self.library_view,
            &self.library,
            &self.transient.mute_solo,
            self.transient.reference_db,
        )
    }
}
