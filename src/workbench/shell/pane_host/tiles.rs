//! How tabs, gaps and handles look and what a tile draws.

use eframe::egui::{self, Align, Color32, Layout, Stroke, Ui, Visuals, WidgetText, vec2};
use egui_tiles::{
    Behavior, EditAction, ResizeState, SimplificationOptions, TabState, Tile, TileId, Tiles,
    UiResponse,
};

use crate::bench::command::ShowCommand;
use crate::bench::pane::Pane;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::slider::tell;
use crate::shell::guide::about;
use crate::shell::pane_focus::frame_pane;
use crate::shell::pane_host::PaneHost;
use crate::shell::tab_row::{TITLE_SPACING, TabRow, corner_width};

/// Height of a row of tabs, points.
const TABS: f32 = 24.0;

impl Behavior<Pane> for PaneHost<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let ground = Palette::in_ui(ui).panel;
        ui.painter().rect_filled(ui.max_rect(), 0, ground);
        if !std::mem::take(&mut self.row).has_corner() && corner_width(*pane) > 0.0 {
            let line = Layout::right_to_left(Align::Center);
            let size = vec2(ui.available_width(), TABS);
            ui.allocate_ui_with_layout(size, line, |ui| {
                ui.add_space(8.0);
                self.show_corner(ui, *pane);
            });
        }
        let rect = ui.max_rect();
        self.show(ui, *pane);
        self.focus.frame(ui, rect, *pane);
        if self.toured == Some(*pane) {
            frame_pane(ui, rect);
        }
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        let title = match self.row {
            TabRow::Roomy | TabRow::Titles => pane.title(),
            TabRow::Short | TabRow::ShortTitles => pane.short_title(),
        };
        egui::RichText::new(title).font(theme::small()).into()
    }

    fn on_tab_button(
        &mut self,
        tiles: &mut Tiles<Pane>,
        tile: TileId,
        response: egui::Response,
    ) -> egui::Response {
        let Some(Tile::Pane(pane)) = tiles.get(tile) else {
            return response;
        };
        // A pointer that was left on a tab hides no notice.
        if self.context.bench.notices.shown().is_empty() {
            tell(&response, about(*pane));
        }
        if response.clicked() {
            self.context.bench.pointer.pane_in_use = Some(*pane);
            if response.double_clicked() {
                let alone = ShowCommand::Maximise(Some(*pane));
                self.context.commands.push(alone.into());
            }
        }
        response
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
        // Titles stand where they stand, whichever pane is in front.
        let corner = titles.iter().copied().map(corner_width);
        self.row = TabRow::of(ui, &titles, corner.fold(0.0, f32::max));
        if let Some(pane) = front.filter(|_| self.row.has_corner()) {
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
