//! The panes in their tiles: which view is drawn where.
//!
//! A pane that is hidden, or behind another, is not drawn, and nothing is computed for it.

pub(crate) mod tiles;

use eframe::egui::{self, Ui};

use crate::bench::Bench;
use crate::bench::export::Exportable;
use crate::bench::export::gather::is_exportable;
use crate::bench::pane::Pane;
use crate::bench::recording::Take;
use crate::bench::signals::drive::drive_um;
use crate::bench::tool::{PaneContext, Tools};
use crate::bench::view::Source;
use crate::kit::pane::{framed, scrolled};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::shell::tab_row::TabRow;
use crate::tools::collection::measuring::Asked;
use crate::tools::collection::view::Typed as CollectionTyped;
use crate::tools::compare::view::CompareView;
use crate::tools::contactors::HeatmapStyle;
use crate::tools::spectra::contact::ContactSpectrumView;
use crate::tools::spectra::drive::DriveSpectrumView;
use crate::tools::spectra::spatial::SpatialSource;
use crate::tools::spectra::wave::DriveWaveView;
use crate::tools::workspace;

/// Everything that panes are drawn from, and what came of drawing them.
pub(crate) struct Desk<'a> {
    /// What panes are drawn with.
    pub(crate) context: PaneContext<'a>,
    /// The tools.
    pub(crate) tools: &'a mut Tools,
    /// How often each pane was drawn.
    pub(crate) n_drawn: &'a mut [u64; Pane::ALL.len()],
    /// Whether panes were moved.
    pub(crate) is_rearranged: bool,
    /// Where titles and the pane's corner have no room side by side, the corner stands in the pane.
    pub row: TabRow,
}

impl Desk<'_> {
    fn show(&mut self, ui: &mut Ui, pane: Pane) {
        self.n_drawn[pane.index()] += 1;
        if self.context.bench.is_veiled(pane) {
            return framed(ui, 10, show_veil);
        }
        if let Some(tool) = self.tools.showing(pane) {
            return tool.ui(pane, ui, &mut self.context);
        }
        match pane {
            Pane::Workspace => self.show_workspace(ui),
            Pane::Library => framed(ui, 10, |ui| self.show_library(ui)),
            Pane::Tuning => scrolled(ui, pane.title(), |ui| {
                let bench = &mut *self.context.bench;
                let mute_solo = &bench.transient.mute_solo;
                let live = &bench.transient.live;
                crate::tools::tuning::show(
                    ui,
                    self.context.scene,
                    live,
                    mute_solo,
                    self.context.commands,
                );
            }),
            Pane::Bridge => scrolled(ui, pane.title(), |ui| {
                self.context.bench.show_bridge(ui, self.context.commands);
            }),
            Pane::Heatmaps => framed(ui, 10, |ui| self.show_heatmaps(ui)),
            Pane::ContactSpectrum => framed(ui, 8, |ui| self.show_contact_spectrum(ui)),
            Pane::DriveSpectrum => framed(ui, 8, |ui| self.show_drive_spectrum(ui)),
            Pane::DriveWave => framed(ui, 8, |ui| self.show_drive_wave(ui)),
            Pane::SpatialSpectra => framed(ui, 8, |ui| self.show_spatial(ui)),
            Pane::Accuracy => framed(ui, 10, |ui| {
                self.context.bench.watch_accuracy();
                crate::tools::accuracy::view::show(
                    ui,
                    &self.context.bench.accuracy_view(),
                    self.context.commands,
                );
            }),
            Pane::Why => framed(ui, 10, |ui| {
                self.context.bench.explain();
                let why = self.context.bench.transient.why.0.as_ref();
                crate::tools::why::view::show(ui, why, &self.context.scene.filters);
            }),
            Pane::Compare => framed(ui, 10, |ui| self.show_compare(ui)),
            Pane::Response => framed(ui, 10, |ui| self.show_response(ui)),
            Pane::Collection => framed(ui, 10, |ui| self.show_collection(ui)),
            Pane::Lab => framed(ui, 10, |ui| self.show_lab(ui)),
            Pane::Picture => framed(ui, 10, |ui| self.show_picture(ui)),
            Pane::Import | Pane::Participant | Pane::Experimenter | Pane::Analysis => {}
        }
    }

    fn show_library(&mut self, ui: &mut Ui) {
        let bench = &mut *self.context.bench;
        let chosen = (&bench.transient.mute_solo, bench.workspace.cloth);
        let search = &mut bench.transient.search;
        crate::tools::library::show(
            ui,
            &mut bench.library_view,
            self.context.scene,
            chosen,
            search,
            self.context.commands,
        );
    }

    fn show_collection(&mut self, ui: &mut Ui) {
        let bench = &mut *self.context.bench;
        bench.measure_collection(ui.ctx());
        let items = bench.library_view.shared_items();
        let collection = &mut bench.transient.collection;
        let mut search = std::mem::take(&mut collection.search);
        let mut pointed = None;
        let view = collection.view(&items, self.context.scene, &search);
        let mut typed = CollectionTyped {
            search: &mut search,
            pointed: &mut pointed,
        };
        crate::tools::collection::view::show(
            ui,
            &mut bench.library_view,
            &view,
            &mut typed,
            self.context.commands,
        );
        collection.search = search;
        if collection.pointed != pointed {
            collection.pointed = pointed;
            ui.ctx().request_repaint();
        }
    }

    fn show_heatmaps(&mut self, ui: &mut Ui) {
        let bench = &*self.context.bench;
        let style = bench.heatmap_style();
        crate::tools::contactors::show(
            ui,
            self.context.scene,
            &bench.transient.live,
            style,
            self.context.commands,
        );
    }
}

/// What stands in the place of a pane that would tell too much.
fn show_veil(ui: &mut Ui) {
    let words = "Hidden while a session is held: what lies under the finger is not to be seen.";
    let ink = Palette::in_ui(ui).dim;
    ui.add_space(2.0 * STEP);
    ui.add(egui::Label::new(egui::RichText::new(words).color(ink)).wrap());
}

/// The plots of the contactor that is looked at closer.
impl Desk<'_> {
    fn contactor(&self) -> usize {
        self.context.bench.workspace.contactor.unwrap_or(usize::MAX)
    }

    fn show_contact_spectrum(&mut self, ui: &mut Ui) {
        let contactor = self.contactor();
        let bench = &mut *self.context.bench;
        let view = ContactSpectrumView {
            history: &bench.transient.history,
            contactor,
            filters: &self.context.scene.filters,
            map: bench.settings.preferences.colour_map,
            // Columns stay as they were felt when a textile is moved afterwards.
            scene_serial: bench.inspection.n_scenes,
        };
        let state = &mut bench.transient.contact_spectrogram;
        crate::tools::spectra::contact::show(ui, state, &mut bench.inspection.inspector, &view);
    }

    fn show_drive_spectrum(&mut self, ui: &mut Ui) {
        let bench = &mut *self.context.bench;
        let view = DriveSpectrumView {
            history: &bench.transient.history,
            scale: bench.workspace.scale,
            map: bench.settings.preferences.colour_map,
        };
        crate::tools::spectra::drive::show(ui, &mut bench.transient.drive_spectrogram, &view);
    }

    fn show_drive_wave(&mut self, ui: &mut Ui) {
        let view = self.context.bench.drive_wave_view();
        crate::tools::spectra::wave::show(ui, &mut self.context.bench.transient.wave_scale, &view);
    }

    fn show_spatial(&mut self, ui: &mut Ui) {
        let contactor = self.contactor();
        let bench = &mut *self.context.bench;
        let source = SpatialSource {
            scene: &bench.inspection.scene,
            scene_serial: bench.inspection.n_edits,
            contactor,
            pose: bench.transient.live.pose,
        };
        let state = &mut bench.transient.spatial;
        crate::tools::spectra::spatial::show(ui, state, &mut bench.inspection.inspector, &source);
    }
}

/// Tunings, textiles and methods against each other.
impl Desk<'_> {
    fn show_compare(&mut self, ui: &mut Ui) {
        let standing = self.context.bench.follow_comparison(ui.ctx());
        let bench = &mut *self.context.bench;
        let play = bench.transient.live.play;
        let route = bench.route();
        let place = bench.compared_place(&route);
        let is_replayed = play.source == Source::Recording;
        let view = CompareView {
            scene: self.context.scene,
            library_view: bench.library_view.items(),
            place,
            route,
            take: bench.take.as_ref().map(Take::name),
            standing,
            contactor: bench.workspace.contactor,
            tick: is_replayed.then_some(play.tick),
        };
        crate::tools::compare::view::show(
            ui,
            &mut bench.transient.comparison,
            &view,
            self.context.commands,
        );
    }
}

/// A recipe and what becomes of it.
impl Desk<'_> {
    fn show_lab(&mut self, ui: &mut Ui) {
        let bench = &mut *self.context.bench;
        bench.follow_lab(ui.ctx());
        let lab = &mut bench.transient.lab;
        let mut hands = crate::tools::lab::view::LabHands {
            keep: std::mem::take(&mut lab.fields),
            plan: std::mem::take(&mut lab.plan),
        };
        let view = crate::tools::lab::view::LabView {
            lab,
            items: bench.library_view.items(),
            ids: bench.loaded.library().ids(),
            map: bench.settings.preferences.colour_map,
            scale: bench.workspace.scale,
        };
        let pictures = &mut bench.transient.lab_pictures;
        crate::tools::lab::view::show(ui, &view, (&mut hands, pictures), self.context.commands);
        let lab = &mut bench.transient.lab;
        (lab.fields, lab.plan) = (hands.keep, hands.plan);
    }
}

/// Measurements.
impl Desk<'_> {
    fn show_picture(&mut self, ui: &mut Ui) {
        self.context.bench.follow_picture(ui.ctx());
        let transient = &mut self.context.bench.transient;
        let hands = (&mut transient.picturing, &mut transient.picture_textures);
        crate::tools::picture::view::show(ui, hands, self.context.commands);
    }
}

/// Views that are drawn and exported.
impl Bench {
    /// Has the library measured as the pane shows it.
    fn measure_collection(&mut self, ctx: &egui::Context) {
        let collection = &mut self.transient.collection;
        let asked = Asked {
            speed_mm_per_s: collection.choice.speed_mm_per_s,
            filters: self.document.scene().filters,
        };
        let items = self.library_view.items().iter();
        let usable = items.filter(|item| item.flaw.is_none());
        let ids = usable.map(|item| item.id.clone());
        let library = self.library_view.library();
        collection.measurements.catch_up(ctx, library, asked, ids);
        for flaw in self.transient.collection.measurements.take_flaws() {
            self.transient.notices.give(flaw);
        }
    }

    /// Lets the measurements of the library rest while nobody looks at them.
    pub(crate) fn rest_collection(&mut self) {
        self.transient.collection.measurements.rest();
    }

    /// How the heatmaps are drawn.
    pub(crate) fn heatmap_style(&self) -> HeatmapStyle {
        HeatmapStyle {
            map: self.settings.preferences.colour_map,
            scale: self.workspace.scale,
            has_numbers: self.settings.preferences.has_numbers,
            greys_below: self.workspace.greys_below,
            selected: self.workspace.contactor.unwrap_or(usize::MAX),
        }
    }

    /// What drove the chosen contactor in the last two ticks.
    pub(crate) fn drive_wave_view(&self) -> DriveWaveView {
        let contactor = self.workspace.contactor.unwrap_or(usize::MAX);
        let contactor = u32::try_from(contactor).unwrap_or(u32::MAX);
        let (history, tick) = (&self.transient.history, self.transient.live.tick);
        DriveWaveView {
            before_um: drive_um(history, contactor, tick.saturating_sub(1)),
            now_um: drive_um(history, contactor, tick),
            limit_um: self.limits().map(|limit| limit.um),
        }
    }
}

/// The right end of a row of tabs: what belongs to the pane in front.
impl Desk<'_> {
    fn show_corner(&mut self, ui: &mut Ui, pane: Pane) {
        if is_exportable(pane) {
            crate::bench::export::button::show(ui, Exportable::Pane(pane), self.context.commands);
        }
        if let Some(tool) = self.tools.showing(pane) {
            return tool.corner(pane, ui, &mut self.context);
        }
        match pane {
            Pane::Heatmaps => {
                let style = self.context.bench.heatmap_style();
                let mute_solo = &self.context.bench.transient.mute_solo;
                crate::tools::contactors::show_corner(ui, style, mute_solo, self.context.commands);
            }
            Pane::ContactSpectrum
            | Pane::DriveSpectrum
            | Pane::DriveWave
            | Pane::SpatialSpectra => {
                let contactor = self.context.bench.workspace.contactor;
                let words = contactor.map_or_else(
                    || "no contactor chosen".to_owned(),
                    |contactor| format!("contactor {contactor}"),
                );
                let ink = Palette::in_ui(ui).dim;
                let label = ui.label(egui::RichText::new(words).font(theme::small()).color(ink));
                label.on_hover_text("Click a cell of the heatmaps to choose another contactor");
            }
            Pane::Why => {
                let (why, is_frozen) = &self.context.bench.transient.why;
                let n_contactors = self.context.bench.transient.live.dots.len();
                let why = (
                    why.as_ref(),
                    self.context.bench.workspace.contactor,
                    n_contactors,
                );
                crate::tools::why::view::show_corner(ui, *is_frozen, why, self.context.commands);
            }
            Pane::Response => {
                let probe = self.context.bench.workspace.probe;
                crate::tools::response::show_corner(ui, probe, self.context.commands);
            }
            Pane::Compare => {
                let standing = self.context.bench.comparison_standing();
                crate::tools::compare::view::controls::show_corner(
                    ui,
                    &standing,
                    self.context.commands,
                );
            }
            Pane::Accuracy => {
                let shows_methods = self.context.bench.transient.accuracy.shows_methods;
                crate::tools::accuracy::view::show_corner(ui, shows_methods, self.context.commands);
            }
            Pane::Workspace => {
                let bench = &*self.context.bench;
                if let Some(ground) = bench.transient.ground {
                    let (state, size_mm) = (&bench.workspace, self.context.scene.size_mm);
                    workspace::show_tools(ui, state, ground, size_mm, self.context.commands);
                }
            }
            Pane::Collection
            | Pane::Lab
            | Pane::Library
            | Pane::Tuning
            | Pane::Bridge
            | Pane::Import
            | Pane::Picture
            | Pane::Participant
            | Pane::Experimenter
            | Pane::Analysis => {}
        }
    }
}
