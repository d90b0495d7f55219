//! The panes in their tiles: which view is drawn where.
//!
//! A pane that is hidden, or behind another, is not drawn, and nothing is computed for it.

pub(crate) mod tiles;

use eframe::egui::{self, Ui};

use crate::bench::Bench;
use crate::bench::export::Exportable;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tools};
use crate::kit::pane::{framed, scrolled};
use crate::shell::tab_row::TabRow;
use crate::tools::contactors::HeatmapStyle;
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
            return framed(ui, 10, crate::tools::experiment::experimenter::show_veil);
        }
        if let Some(tool) = self.tools.showing(pane) {
            return tool.ui(pane, ui, &mut self.context);
        }
        match pane {
            Pane::Workspace => self.show_workspace(ui),
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
            Pane::Participant => self.show_participant(ui),
            Pane::Experimenter => scrolled(ui, pane.title(), |ui| self.show_experimenter(ui)),
            Pane::Analysis => framed(ui, 10, |ui| self.show_analysis(ui)),
            Pane::Import
            | Pane::Response
            | Pane::Compare
            | Pane::Accuracy
            | Pane::Why
            | Pane::ContactSpectrum
            | Pane::DriveSpectrum
            | Pane::DriveWave
            | Pane::SpatialSpectra => {}
            Pane::Import | Pane::Picture | Pane::Lab | Pane::Collection | Pane::Library => {}
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

/// Views that are drawn and exported.
impl Bench {
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
}

/// The right end of a row of tabs: what belongs to the pane in front.
impl Desk<'_> {
    fn show_corner(&mut self, ui: &mut Ui, pane: Pane) {
        if pane.has_export() {
            crate::bench::export::button::show(ui, Exportable::Pane(pane), self.context.commands);
        }
        if let Some(tool) = self.tools.showing(pane) {
            if !self.context.bench.is_veiled(pane) {
                return tool.corner(pane, ui, &mut self.context);
            }
            // It looks as ever, and a session goes on as it is.
            ui.scope(|ui| {
                ui.visuals_mut().disabled_alpha = 1.0;
                ui.disable();
                tool.corner(pane, ui, &mut self.context);
            });
            return;
        }
        match pane {
            Pane::Heatmaps => {
                let style = self.context.bench.heatmap_style();
                let mute_solo = &self.context.bench.transient.mute_solo;
                crate::tools::contactors::show_corner(ui, style, mute_solo, self.context.commands);
            }
            Pane::Workspace => {
                let bench = &*self.context.bench;
                if let Some(ground) = bench.transient.ground {
                    let (state, size_mm) = (&bench.workspace, self.context.scene.size_mm);
                    workspace::show_tools(ui, state, ground, size_mm, self.context.commands);
                }
            }
            Pane::Response
            | Pane::Compare
            | Pane::Accuracy
            | Pane::Why
            | Pane::ContactSpectrum
            | Pane::DriveSpectrum
            | Pane::DriveWave
            | Pane::SpatialSpectra
            | Pane::Collection
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
