//! From a pane to what it shows: the same view that the pane is drawn from.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exportable, Exported, NOTHING_FELT};
use crate::bench::pane::Pane;
use crate::bench::{Bench, query};
use crate::shell::frame;

/// Fetches what is shown, or says what to do where nothing is.
type Gather = fn(&mut Bench) -> Result<Exported, &'static str>;

/// How the numbers of a pane are fetched; `None` where a pane shows none.
fn gather_of(what: Exportable) -> Option<Gather> {
    let pane = match what {
        Exportable::Timeline => return Some(Bench::gather_timeline),
        Exportable::Analysed => return Some(Bench::gather_analysed),
        Exportable::Pane(pane) => pane,
    };
    match pane {
        Pane::Heatmaps => Some(Bench::gather_heatmaps),
        Pane::Tuning => Some(Bench::gather_compression),
        Pane::Workspace => Some(Bench::gather_maps),
        Pane::Bridge => Some(Bench::gather_link),
        _ => None,
    }
}

impl Bench {
    /// What a pane shows now.
    ///
    /// # Errors
    /// There is nothing, and what to do about it.
    pub(crate) fn exported(&mut self, what: Exportable) -> Result<Exported, &'static str> {
        let nothing: Gather = |_| Err("This pane shows no numbers to export");
        gather_of(what).unwrap_or(nothing)(self)
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

    fn gather_heatmaps(&mut self) -> Result<Exported, &'static str> {
        let dots = &self.transient.live.dots;
        if dots.iter().all(|dot| dot.cloth.is_none()) {
            return Err(NOTHING_FELT);
        }
        let scene = self.plain_scene_view();
        let grid = scene.grid.ok_or(
            "The contactors of this display form no grid: `selvedge render` writes them as a table",
        )?;
        let origin = self.origin();
        let live = &self.transient.live;
        Ok(crate::tools::contactors::export::heatmaps(
            &scene,
            live,
            self.heatmap_style(),
            grid,
            origin,
        ))
    }

    fn gather_compression(&mut self) -> Result<Exported, &'static str> {
        let scene = self.plain_scene_view();
        let reference_db = scene.reference_db.filter(|_| !scene.library.is_empty());
        let reference_db = reference_db.ok_or(
            "There is nothing to export yet: levels are being computed, or the library has no \
             textile with a level",
        )?;
        Ok(crate::tools::tuning::curve::exported(
            &scene,
            reference_db,
            self.origin(),
        ))
    }

    fn gather_timeline(&mut self) -> Result<Exported, &'static str> {
        let origin = self.rendered_origin();
        let transient = &self.transient;
        let take = self.take.as_ref();
        let view = frame::transport_view(transient, take);
        let timeline = view.timeline();
        let mut ticks = timeline.ticks.iter();
        if !ticks.any(|tick| tick.felt.speed_mm_per_s > 0.0) {
            return Err(NOTHING_FELT);
        }
        Ok(crate::tools::timeline::export::strips(&timeline, origin))
    }

    fn gather_link(&mut self) -> Result<Exported, &'static str> {
        let bridge = self.transient.live.bridge.as_ref();
        let exported = bridge.and_then(|bridge| {
            crate::tools::bridge::export::distributions(&bridge.timing, self.origin())
        });
        exported.ok_or("There is nothing to export yet: connect a device")
    }

    fn gather_maps(&mut self) -> Result<Exported, &'static str> {
        if self.workspace.overlays.map().is_none() {
            return Err(
                "There is nothing to export: show a map over the cloth first, by “Overlay” in \
                 the row of tools or by the keys K and Shift+K",
            );
        }
        let ctx = self.ctx.clone();
        self.prepare_overlays(&ctx);
        let (scene, origin) = (self.plain_scene_view(), self.origin());
        let maps = &self.transient.maps;
        let cloths = scene.cloths.iter().enumerate();
        let shown = cloths.filter_map(|(index, cloth)| Some((index, cloth, maps.shown(index)?)));
        crate::tools::workspace::export::maps(shown.collect(), self.workspace.probe, origin).ok_or(
            "There is nothing to export yet: the maps are being computed, or no textile is felt",
        )
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
