//! From a pane to what it shows: the same view that the pane is drawn from.

use eframe::egui::Theme;

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exportable, Exported};
use crate::bench::pane::Pane;
use crate::bench::{Bench, query};
use crate::kit::theme::Palette;
use crate::shell::frame;

/// Why there is nothing to export before anything was felt.
const NOTHING_FELT: &str =
    "There is nothing to export yet: move over a textile, or let the display explore by itself";
/// Why there is nothing to export of no contactor.
const NO_CONTACTOR: &str =
    "There is nothing to export: choose a contactor first, by a click on a cell of the heatmaps";

/// Fetches what is shown, or says what to do where nothing is.
type Gather = fn(&mut Bench) -> Result<Exported, &'static str>;

/// How the numbers of a pane are fetched; `None` where a pane shows none.
fn gather_of(what: Exportable) -> Option<Gather> {
    let pane = match what {
        Exportable::Timeline => return Some(Bench::gather_timeline),
        Exportable::Pane(pane) => pane,
    };
    match pane {
        Pane::Heatmaps => Some(Bench::gather_heatmaps),
        Pane::ContactSpectrum => Some(Bench::gather_contact_spectrum),
        Pane::DriveSpectrum => Some(Bench::gather_drive_spectrum),
        Pane::DriveWave => Some(Bench::gather_drive_wave),
        Pane::SpatialSpectra => Some(Bench::gather_spatial),
        Pane::Tuning => Some(Bench::gather_compression),
        Pane::Why => Some(Bench::gather_why),
        Pane::Response => Some(Bench::gather_response),
        Pane::Accuracy => Some(Bench::gather_accuracy),
        Pane::Compare => Some(Bench::gather_comparison),
        Pane::Lab => Some(Bench::gather_lab),
        Pane::Picture => Some(Bench::gather_picture),
        Pane::Workspace => Some(Bench::gather_maps),
        Pane::Collection => Some(Bench::gather_collection),
        Pane::Bridge => Some(Bench::gather_link),
        Pane::Import | Pane::Library | Pane::Participant | Pane::Experimenter | Pane::Analysis => {
            None
        }
    }
}

/// Whether a pane has numbers to export.
pub(crate) fn is_exportable(pane: Pane) -> bool {
    pane == Pane::Import || gather_of(Exportable::Pane(pane)).is_some()
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

    fn contactor(&self) -> Result<usize, &'static str> {
        self.workspace.contactor.ok_or(NO_CONTACTOR)
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

    fn gather_contact_spectrum(&mut self) -> Result<Exported, &'static str> {
        let contactor = self.contactor()?;
        let origin = self.origin();
        let filters = self.document.scene().filters;
        let view = crate::tools::spectra::contact::ContactSpectrumView {
            history: &self.transient.history,
            contactor,
            filters: &filters,
            map: self.settings.preferences.colour_map,
            scene_serial: self.inspection.n_scenes,
        };
        let state = &mut self.transient.contact_spectrogram;
        let columns = state.shown(&self.ctx, &mut self.inspection.inspector, &view);
        let mut levels_db = columns.iter().flat_map(|column| column.rows);
        if !levels_db.any(f32::is_finite) {
            return Err(NOTHING_FELT);
        }
        Ok(crate::tools::spectra::export_spectrograms::contact(
            &columns, &view, origin,
        ))
    }

    fn gather_drive_spectrum(&mut self) -> Result<Exported, &'static str> {
        let contactor = self.contactor()?;
        let origin = self.rendered_origin();
        let view = crate::tools::spectra::drive::DriveSpectrumView {
            history: &self.transient.history,
            scale: self.workspace.scale,
            map: self.settings.preferences.colour_map,
        };
        let columns = self.transient.drive_spectrogram.shown(&self.ctx, &view);
        let mut amplitudes_um = columns.iter().flat_map(|column| column.rows);
        if !amplitudes_um.any(|um| um > 0.0) {
            return Err(NOTHING_FELT);
        }
        let colours = (view.scale, view.map);
        Ok(crate::tools::spectra::export_spectrograms::drive(
            &columns, contactor, colours, origin,
        ))
    }

    fn gather_drive_wave(&mut self) -> Result<Exported, &'static str> {
        let contactor = self.contactor()?;
        let mut felt_um = self
            .transient
            .history
            .glimpses()
            .flat_map(|one| one.watched_um);
        if !felt_um.any(|um| um > 0.0) {
            return Err(NOTHING_FELT);
        }
        let origin = self.rendered_origin();
        let (view, tick) = (self.drive_wave_view(), self.transient.live.tick);
        let scale = self.transient.wave_scale;
        Ok(crate::tools::spectra::wave::exported(
            &view, scale, contactor, tick, origin,
        ))
    }

    fn gather_spatial(&mut self) -> Result<Exported, &'static str> {
        let contactor = self.contactor()?;
        let (origin, tick) = (self.origin(), self.transient.live.tick);
        let source = crate::tools::spectra::spatial::SpatialSource {
            scene: &self.inspection.scene,
            scene_serial: self.inspection.n_edits,
            contactor,
            pose: self.transient.live.pose,
        };
        let view = self
            .transient
            .spatial
            .shown(&mut self.inspection.inspector, &source);
        let view = view.ok_or(
            "There is nothing to export: the chosen contactor is off every textile; move over one",
        )?;
        Ok(crate::tools::spectra::export_spatial::spectra(
            view, contactor, tick, origin,
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

    fn gather_why(&mut self) -> Result<Exported, &'static str> {
        self.explain();
        let shown = self.transient.why.0.as_ref().ok_or(NO_CONTACTOR)?;
        let filters = self.document.scene().filters;
        Ok(crate::tools::why::export::explanation(
            shown,
            &filters,
            self.origin(),
        ))
    }

    fn gather_response(&mut self) -> Result<Exported, &'static str> {
        let ctx = self.ctx.clone();
        let scene = self.plain_scene_view();
        let origin = self.origin();
        let asked = self.ask_response(&ctx);
        let cloth = asked.and_then(|asked| Some((asked, scene.cloths.get(asked.textile)?)));
        let (asked, cloth) = cloth.ok_or(
            "There is nothing to export: choose a textile in the workspace, or move the chosen \
             contactor over one",
        )?;
        let name = format!("{} {}", cloth.label, cloth.name);
        let view = self.response_view(&asked, (name.trim(), cloth.rotation_deg));
        if view.curves.around().is_empty() {
            return Err("There is nothing to export yet: the curves are being computed");
        }
        Ok(crate::tools::response::chart::exported(&view, origin))
    }

    fn gather_lab(&mut self) -> Result<Exported, &'static str> {
        let lab = &self.transient.lab;
        let preview = lab.preview.as_ref().ok_or(
            "There is nothing to export yet: the surface is being made in the textile lab",
        )?;
        let scene = self.document.scene();
        let origin = Origin::of(scene, &self.document.tuning(), None);
        Ok(crate::tools::lab::export::curves(
            lab,
            preview,
            self.workspace.scale,
            origin,
        ))
    }

    fn gather_accuracy(&mut self) -> Result<Exported, &'static str> {
        let origin = self.rendered_origin();
        let view = self.accuracy_view();
        if view.found.n_ticks == 0 && view.measured.is_none() {
            return Err(NOTHING_FELT);
        }
        Ok(crate::tools::accuracy::view::chart::exported(&view, origin))
    }

    fn gather_link(&mut self) -> Result<Exported, &'static str> {
        let bridge = self.transient.live.bridge.as_ref();
        let exported = bridge.and_then(|bridge| {
            crate::tools::bridge::export::distributions(&bridge.timing, self.origin())
        });
        exported.ok_or("There is nothing to export yet: connect a device")
    }

    fn gather_comparison(&mut self) -> Result<Exported, &'static str> {
        let origin = self.origin();
        let grid = self.plain_scene_view().grid;
        // On paper: no difference is nearly white, whatever the window's theme.
        let map = Palette::of(Theme::Light).differences();
        let comparison = &self.transient.comparison;
        let compared = comparison.found().zip(comparison.sides());
        let (difference, sides) = compared
            .ok_or("There is nothing to export yet: press “compare” in the Compare pane")?;
        let grid = grid.unwrap_or((1, difference.by_contactor.len()));
        Ok(crate::tools::compare::export::differences(
            difference,
            sides,
            (grid, map),
            origin,
        ))
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

    fn gather_collection(&mut self) -> Result<Exported, &'static str> {
        let (scene, origin) = (self.plain_scene_view(), self.origin());
        let (items, shown) = (self.library_view.shared_items(), &self.transient.collection);
        let view = shown.view(&items, &scene, &shown.search);
        if view.entries.iter().all(|one| one.figures.is_none()) {
            return Err(
                "There is nothing to export yet: the library is measured while the Collection \
                 pane is in sight",
            );
        }
        Ok(crate::tools::collection::export::scatter(&view, origin))
    }

    fn gather_picture(&mut self) -> Result<Exported, &'static str> {
        let found = self.transient.picturing.found();
        let exported = found.and_then(|found| crate::tools::picture::export::directions(found));
        exported.ok_or("There is nothing to export yet: open a picture in the Picture pane")
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
