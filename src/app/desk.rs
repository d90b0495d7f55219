//! The panes in their tiles: which view is drawn where, and how tabs and gaps look.
//!
//! A pane that is hidden, or behind another, is not drawn, and nothing is computed for it.

use eframe::egui::{
    self, Align, Color32, Frame, Layout, Margin, ScrollArea, Stroke, Ui, Visuals, WidgetText, vec2,
};
use egui_tiles::{
    Behavior, EditAction, ResizeState, SimplificationOptions, TabState, Tile, TileId, Tiles,
    UiResponse,
};

use super::arrangement::Pane;
use super::panes::{
    self, ContactSpectrumView, DriveSpectrumView, DriveWaveView, HeatmapStyle, SpatialSource,
    Wishes,
};
use super::signals::drive_um;
use super::tab_row::{TITLE_SPACING, TabRow, corner_width};
use super::theme::{self, Palette};
use super::view::SceneView;
use super::window::Workbench;
use super::workspace;

/// Height of a row of tabs, points.
const TABS: f32 = 24.0;

/// Everything that panes are drawn from, and what came of drawing them.
pub(crate) struct Desk<'a> {
    /// The window.
    pub(crate) bench: &'a mut Workbench,
    /// The scene.
    pub(crate) scene: &'a SceneView,
    /// What the user wants.
    pub(crate) wishes: &'a mut Wishes,
    /// Where the workspace is, if it is shown.
    pub(crate) shown: Option<workspace::Shown>,
    /// Whether panes were moved.
    pub(crate) is_rearranged: bool,
    /// Where titles and the pane's corner have no room side by side, the corner stands in the pane.
    pub(crate) row: TabRow,
}

impl Desk<'_> {
    fn show(&mut self, ui: &mut Ui, pane: Pane) {
        self.bench.transient.n_drawn[pane.index()] += 1;
        match pane {
            Pane::Workspace => self.show_workspace(ui),
            Pane::Library => framed(ui, 10, |ui| self.show_library(ui)),
            Pane::Tuning => scrolled(ui, pane, |ui| {
                let bench = &mut *self.bench;
                let audition = &bench.transient.audition;
                let live = &bench.transient.live;
                panes::show_tuning(ui, self.scene, live, audition, self.wishes);
            }),
            Pane::Bridge => scrolled(ui, pane, |ui| {
                let transient = &mut self.bench.transient;
                let target = transient.target.as_deref();
                let ports = transient.ports.view();
                let port = &mut transient.port;
                panes::show_bridge(ui, &transient.live, target, port, ports, self.wishes);
            }),
            Pane::Heatmaps => framed(ui, 10, |ui| self.show_heatmaps(ui)),
            Pane::ContactSpectrum => framed(ui, 8, |ui| self.show_contact_spectrum(ui)),
            Pane::DriveSpectrum => framed(ui, 8, |ui| self.show_drive_spectrum(ui)),
            Pane::DriveWave => framed(ui, 8, |ui| self.show_drive_wave(ui)),
            Pane::SpatialSpectra => framed(ui, 8, |ui| self.show_spatial(ui)),
            Pane::Why => framed(ui, 10, |ui| {
                self.bench.explain();
                let why = self.bench.transient.why.0.as_ref();
                panes::show_why(ui, why, &self.scene.filters);
            }),
            Pane::Response => framed(ui, 10, |ui| self.show_response(ui)),
        }
    }

    fn show_library(&mut self, ui: &mut Ui) {
        let bench = &mut *self.bench;
        let chosen = (&bench.transient.audition, bench.workspace.cloth);
        let search = &mut bench.transient.search;
        panes::show_library(
            ui,
            &mut bench.shelf,
            self.scene,
            chosen,
            search,
            self.wishes,
        );
    }

    fn show_heatmaps(&mut self, ui: &mut Ui) {
        let bench = &*self.bench;
        let style = HeatmapStyle {
            map: bench.settings.kept.colour_map,
            scale: bench.workspace.scale,
            has_numbers: bench.settings.kept.has_numbers,
            selected: bench.workspace.contactor.unwrap_or(usize::MAX),
        };
        panes::show_heatmaps(ui, self.scene, &bench.transient.live, style, self.wishes);
    }
}

/// The plots of the contactor that is looked at closer.
impl Desk<'_> {
    fn contactor(&self) -> usize {
        self.bench.workspace.contactor.unwrap_or(usize::MAX)
    }

    fn show_contact_spectrum(&mut self, ui: &mut Ui) {
        let contactor = self.contactor();
        let bench = &mut *self.bench;
        let view = ContactSpectrumView {
            history: &bench.transient.history,
            contactor,
            filters: &self.scene.filters,
            map: bench.settings.kept.colour_map,
            // Columns stay as they were felt when a textile is moved afterwards.
            scene_serial: bench.eye.n_scenes,
        };
        let state = &mut bench.transient.contact_spectrogram;
        panes::show_contact_spectrum(ui, state, &mut bench.eye.inspector, &view);
    }

    fn show_drive_spectrum(&mut self, ui: &mut Ui) {
        let bench = &mut *self.bench;
        let view = DriveSpectrumView {
            history: &bench.transient.history,
            scale: bench.workspace.scale,
            map: bench.settings.kept.colour_map,
        };
        panes::show_drive_spectrum(ui, &mut bench.transient.drive_spectrogram, &view);
    }

    fn show_drive_wave(&mut self, ui: &mut Ui) {
        let contactor = self.contactor();
        let limit_um = self.bench.engine.profile().limit_um;
        let transient = &mut self.bench.transient;
        let (history, tick) = (&transient.history, transient.live.tick);
        let contactor = u32::try_from(contactor).unwrap_or(u32::MAX);
        let view = DriveWaveView {
            before_um: drive_um(history, contactor, tick.saturating_sub(1)),
            now_um: drive_um(history, contactor, tick),
            limit_um,
        };
        panes::show_drive_wave(ui, &mut transient.wave_scale, &view);
    }

    fn show_spatial(&mut self, ui: &mut Ui) {
        let contactor = self.contactor();
        let bench = &mut *self.bench;
        let source = SpatialSource {
            scene: &bench.eye.scene,
            scene_serial: bench.eye.n_edits,
            contactor,
            pose: bench.transient.live.pose,
        };
        let state = &mut bench.transient.spatial;
        panes::show_spatial(ui, state, &mut bench.eye.inspector, &source);
    }
}

/// The right end of a row of tabs: what belongs to the pane in front.
impl Desk<'_> {
    fn show_corner(&mut self, ui: &mut Ui, pane: Pane) {
        match pane {
            Pane::Heatmaps => {
                let has_numbers = self.bench.settings.kept.has_numbers;
                let scale = self.bench.workspace.scale;
                let audition = &self.bench.transient.audition;
                panes::show_heatmap_corner(ui, scale, has_numbers, audition, self.wishes);
            }
            Pane::ContactSpectrum
            | Pane::DriveSpectrum
            | Pane::DriveWave
            | Pane::SpatialSpectra => {
                let contactor = self.bench.workspace.contactor;
                let words = contactor.map_or_else(
                    || "no contactor chosen".to_owned(),
                    |contactor| format!("contactor {contactor}"),
                );
                let ink = Palette::in_ui(ui).dim;
                let label = ui.label(egui::RichText::new(words).font(theme::small()).color(ink));
                label.on_hover_text("Click a cell of the heatmaps to choose another contactor");
            }
            Pane::Why => {
                let (why, is_frozen) = &self.bench.transient.why;
                let n_contactors = self.bench.transient.live.dots.len();
                let why = (why.as_ref(), self.bench.workspace.contactor, n_contactors);
                panes::show_why_corner(ui, *is_frozen, why, self.wishes);
            }
            Pane::Response => {
                let probe = self.bench.workspace.probe;
                panes::show_response_corner(ui, probe, self.wishes);
            }
            Pane::Workspace => {
                let bench = &*self.bench;
                if let Some(ground) = bench.transient.ground {
                    let (state, size_mm) = (&bench.workspace, self.scene.size_mm);
                    workspace::show_tools(ui, state, ground, size_mm, self.wishes);
                }
            }
            Pane::Library | Pane::Tuning | Pane::Bridge => {}
        }
    }
}

/// A pane with space around it.
fn framed(ui: &mut Ui, across: i8, content: impl FnOnce(&mut Ui)) {
    let margin = Margin {
        left: across,
        right: across,
        top: 4,
        bottom: 8,
    };
    Frame::new().inner_margin(margin).show(ui, content);
}

/// A pane that may be longer than it is high.
fn scrolled(ui: &mut Ui, pane: Pane, content: impl FnOnce(&mut Ui)) {
    let area = ScrollArea::vertical()
        .id_salt(("pane", pane.index()))
        .auto_shrink(false);
    area.show(ui, |ui| framed(ui, 12, content));
}

impl Behavior<Pane> for Desk<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let ground = Palette::in_ui(ui).panel;
        ui.painter().rect_filled(ui.max_rect(), 0, ground);
        if std::mem::take(&mut self.row) != TabRow::Roomy && corner_width(*pane) > 0.0 {
            let line = Layout::right_to_left(Align::Center);
            let size = vec2(ui.available_width(), TABS);
            ui.allocate_ui_with_layout(size, line, |ui| {
                ui.add_space(8.0);
                self.show_corner(ui, *pane);
            });
        }
        self.show(ui, *pane);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        let title = match self.row {
            TabRow::Roomy | TabRow::Titles => pane.title(),
            TabRow::ShortTitles => pane.short_title(),
        };
        egui::RichText::new(title).font(theme::small()).into()
    }

    fn top_bar_right_ui(
        &mut self,
        tiles: &Tiles<Pane>,
        ui: &mut Ui,
        _tile: TileId,
        tabs: &egui_tiles::Tabs,
        _scroll: &mut f32,
    ) {
        let pane_of = |id| match tiles.get(id) {
            Some(Tile::Pane(pane)) => Some(*pane),
            _ => None,
        };
        let is_seen = |id: &TileId| tiles.is_visible(*id);
        let titles: Vec<Pane> = tabs
            .children
            .iter()
            .copied()
            .filter(is_seen)
            .filter_map(pane_of)
            .collect();
        let front = tabs.active.and_then(pane_of);
        self.row = TabRow::of(ui, &titles, front.map_or(0.0, corner_width));
        if let Some(pane) = front.filter(|_| self.row == TabRow::Roomy) {
            ui.add_space(8.0);
            self.show_corner(ui, pane);
        }
    }

    fn on_edit(&mut self, _edit: EditAction) {
        self.is_rearranged = true;
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions {
            all_panes_must_have_tabs: true,
            ..SimplificationOptions::default()
        }
    }

    fn tab_title_spacing(&self, _visuals: &Visuals) -> f32 {
        TITLE_SPACING
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        TABS
    }

    fn gap_width(&self, _style: &egui::Style) -> f32 {
        1.0
    }

    fn min_size(&self) -> f32 {
        64.0
    }

    fn tab_bar_color(&self, visuals: &Visuals) -> Color32 {
        visuals.panel_fill
    }

    fn tab_bg_color(
        &self,
        visuals: &Visuals,
        _tiles: &Tiles<Pane>,
        _tile: TileId,
        _state: &TabState,
    ) -> Color32 {
        visuals.panel_fill
    }

    fn tab_outline_stroke(
        &self,
        _visuals: &Visuals,
        _tiles: &Tiles<Pane>,
        _tile: TileId,
        _state: &TabState,
    ) -> Stroke {
        Stroke::NONE
    }

    fn tab_bar_hline_stroke(&self, _visuals: &Visuals) -> Stroke {
        Stroke::NONE
    }

    fn tab_text_color(
        &self,
        visuals: &Visuals,
        _tiles: &Tiles<Pane>,
        _tile: TileId,
        state: &TabState,
    ) -> Color32 {
        let palette = Palette::of_visuals(visuals);
        if state.active {
            palette.text
        } else {
            palette.dim
        }
    }

    fn resize_stroke(&self, style: &egui::Style, state: ResizeState) -> Stroke {
        let palette = Palette::of_visuals(&style.visuals);
        match state {
            ResizeState::Idle => Stroke::new(1.0, palette.hairline),
            ResizeState::Hovering => Stroke::new(1.0, palette.line),
            ResizeState::Dragging => Stroke::new(1.0, palette.selection),
        }
    }

    fn drag_preview_stroke(&self, visuals: &Visuals) -> Stroke {
        Stroke::new(1.0, Palette::of_visuals(visuals).selection)
    }

    fn drag_preview_color(&self, visuals: &Visuals) -> Color32 {
        Palette::of_visuals(visuals).hovered.gamma_multiply(0.5)
    }
}
