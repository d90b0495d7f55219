//! The workspace: the scene in mm from above, with the display moving over it, and a lens that
//! shows what lies under the finger.
//!
//! Two tools: one feels (the pointer is the finger), one arranges (the pointer moves textiles).
//! Draws, says where the pointer feels, and gives commands; what is done about them is decided
//! elsewhere.

pub(crate) mod arrange;
pub(crate) mod calibration;
pub(crate) mod camera;
pub(crate) mod cloth;
pub(crate) mod drag;
pub(crate) mod drop;
pub(crate) mod export;
pub(crate) mod ground;
pub(crate) mod lens;
pub(crate) mod maps;
pub(crate) mod menu;
pub(crate) mod navigate;
pub(crate) mod overlay;
pub(crate) mod ruler;
pub(crate) mod stage;
pub(crate) mod state;
#[cfg(test)]
mod tests;
pub(crate) mod tips;
pub(crate) mod tools;

use std::cell::Cell;

use eframe::egui::{self, CursorIcon, DragAndDrop, Popup, Pos2, Rect, Sense, Ui, WidgetInfo, vec2};

use crate::bench::command::{Command, Commands, Part, ShowCommand, Tool};
use crate::bench::export::Exported;
use crate::bench::overlays::Overlay;
use crate::bench::pane::Pane;
use crate::bench::settings::preferences::Preferences;
use crate::bench::tool::{self, PaneContext};
use crate::bench::{Bench, FRAME};
use crate::kit::fingers::FingerRings;
use crate::kit::theme::Palette;
use crate::kit::view_transform::{Pointed, PointerGround};
use crate::tools::workspace::camera::Camera;
use crate::tools::workspace::maps::Maps;
use crate::tools::workspace::overlay::lattice::Lattice;
use crate::tools::workspace::stage::{Layers, Sight, Stage};
use crate::tools::workspace::state::{Place, WorkspaceView};
use selvedge_render::array::ContactorReading;

/// Radius of a ring at a finger without a display, points.
const RING: f32 = 30.0;

/// The workspace: how it is looked at, and what was computed to be drawn over it.
#[derive(Default)]
pub(crate) struct Workspace {
    pub(crate) view: WorkspaceView,
    /// Maps of the textiles at the chosen velocity.
    pub(crate) maps: Maps,
    /// Pictures of the points 1 mm apart.
    lattice: Lattice,
    /// Rings at fingers that hold no display.
    rings: FingerRings,
    /// What the contactors read and how they move, while that is drawn.
    readings: Vec<ContactorReading>,
}

impl tool::Tool for Workspace {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Workspace]
    }

    fn begin(&mut self, bench: &mut Bench) {
        let kept = &bench.settings.preferences;
        self.view.overlays = kept.overlays;
        self.view.true_pixels_per_mm = kept.scales.pixels_per_mm;
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.prepare_overlays(ui.ctx(), context.bench);
        let bench = &*context.bench;
        let next = Cell::new(self.view);
        let sight = Sight {
            scene: context.scene,
            live: &bench.live,
            trail: &bench.past.trail,
            selection: &bench.selection,
            layers: Layers {
                readings: &self.readings,
                maps: &self.maps,
                lattice: &self.lattice,
                colours: bench.settings.preferences.colour_map,
            },
            next: &next,
        };
        let ground = show(ui, sight, context.commands);
        self.show_rings(ui, &ground, &bench.pointer.strays);
        *context.ground = Some(ground);
        self.take_up(ui, next.get());
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        if let Some(pane) = context.bench.pointer.ground {
            let mut next = self.view;
            let n_displays = context.bench.document.scene().displays.len();
            let shown = (context.bench.display(), n_displays);
            tools::show(
                ui,
                &mut next,
                (pane, context.scene.size_mm),
                shown,
                context.commands,
            );
            if next != self.view {
                self.take_up(ui, next);
            }
        }
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        match command {
            Command::Show(ShowCommand::Tool(tool)) => self.view.tool = *tool,
            Command::Show(ShowCommand::Look(look)) => {
                let place = Place {
                    pane: bench.pointer.ground.unwrap_or(Rect::ZERO),
                    size_mm: bench.document.scene().size_mm,
                    pixels_per_point: bench.ctx.pixels_per_point(),
                };
                self.view.look(*look, place);
            }
            Command::Show(ShowCommand::Overlay(overlay)) => {
                self.view.overlays = self.view.overlays.toggled(*overlay);
            }
            Command::Show(ShowCommand::Calibrate) => self.view.is_calibrating = true,
            Command::AllOff | Command::Dismiss => self.view.is_calibrating = false,
            _ => {}
        }
    }

    fn is_open(&self, _bench: &Bench) -> bool {
        self.view.is_calibrating
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        if self.view.overlays.map.is_none() {
            return Err(
                "There is nothing to export: show a map over the cloth first, by “Overlay” in \
                 the row of tools or by the keys K and Shift+K",
            );
        }
        let ctx = bench.ctx.clone();
        self.prepare_overlays(&ctx, bench);
        let (scene, origin) = (bench.plain_scene_view(), bench.origin());
        let cloths = scene.cloths.iter().enumerate();
        let shown =
            cloths.filter_map(|(index, cloth)| Some((index, cloth, self.maps.shown(index)?)));
        export::maps(shown.collect(), bench.selection.probe, origin).ok_or(
            "There is nothing to export yet: the maps are being computed, or no textile is felt",
        )
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.view.camera = Camera::default();
    }

    fn keep_preferences(&self, preferences: &mut Preferences) {
        preferences.overlays = self.view.overlays;
        preferences.scales.pixels_per_mm = self.view.true_pixels_per_mm;
    }
}

impl Workspace {
    /// Takes up what was changed while drawing; it shows in the next frame.
    fn take_up(&mut self, ui: &Ui, next: WorkspaceView) {
        if self.view != next {
            self.view = next;
            ui.ctx().request_repaint();
        }
    }

    /// Shows which fingers feel nothing, because others hold the displays of the scene.
    fn show_rings(&mut self, ui: &Ui, ground: &PointerGround, strays: &[Pos2]) {
        let now_s = ui.input(|input| input.time);
        self.rings.take(strays, now_s);
        if self.rings.is_any() {
            let ring = (Palette::in_ui(ui).dim, RING);
            self.rings.paint(&ui.painter_at(ground.rect), now_s, ring);
            ui.ctx().request_repaint_after(FRAME);
        }
    }

    /// Has what the overlays show that are switched on.
    fn prepare_overlays(&mut self, ctx: &egui::Context, bench: &mut Bench) {
        let overlays = self.view.overlays;
        if overlays.shows(Overlay::Points) {
            self.lattice.prepare(ctx);
        }
        self.readings.clear();
        let display = bench.display();
        let inspector = &mut bench.inspection.inspector;
        let live = &bench.live;
        if overlays.need_readings() && live.centre.is_some() {
            inspector.readings_into(display, &live.pose, &mut self.readings);
        }
        let Some(band) = overlays.map else {
            self.maps.clear();
            return;
        };
        let wanted = maps::Wanted {
            velocity: bench.selection.probe.velocity(),
            band,
            scale: bench.selection.scale,
            colours: bench.settings.preferences.colour_map,
        };
        self.maps.follow(ctx, &bench.executor, (inspector, wanted));
    }
}

/// Shows the workspace in all the space that is left.
fn show(ui: &mut Ui, sight: Sight<'_>, commands: &mut Commands) -> PointerGround {
    let (scene, state) = (sight.scene, sight.next.get());
    let (frame, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    ui.painter().rect_filled(frame, 0, Palette::in_ui(ui).floor);
    let inner = Rect::from_min_max(frame.min + vec2(ruler::LEFT, ruler::TOP), frame.max);
    let (ground, lens) = lens::split(inner, scene.size_mm);
    let response = ui.interact(
        ground,
        ui.scope_id().with("ground"),
        Sense::click_and_drag(),
    );
    response.widget_info(|| {
        let words = format!("Workspace with {} textiles", scene.cloths.len());
        WidgetInfo::labeled(egui::Role::Canvas, true, words)
    });
    let stage = Stage {
        sight,
        state,
        ground,
        view: state.camera.view(ground, scene.size_mm),
        response,
    };
    let tag = ground::paint(ui, &stage);
    paint_rulers(ui, frame, &stage);
    let feels = handle(ui, &stage, tag, commands);
    if let Some(lens) = lens {
        lens::show(ui, lens, &stage, commands);
    }
    if let Some(band) = state.overlays.map {
        let beside = lens.and_then(|lens| lens::room_for_legend(lens, &stage));
        overlay::paint_legend(ui.painter(), &stage, (beside, band));
    }
    PointerGround {
        window: Pointed::Workbench,
        view: stage.view,
        rect: ground,
        size_mm: scene.size_mm,
        pixels_per_point: ui.pixels_per_point(),
        feels,
    }
}

/// Does what the pointer and the keys want, with the controls that lie on the ground. Says whether
/// the pointer feels.
fn handle(ui: &mut Ui, stage: &Stage<'_>, tag: Option<usize>, commands: &mut Commands) -> bool {
    calibration::forget_unless(ui, stage);
    if stage.state.is_calibrating {
        calibration::show(ui, stage, commands);
        return false;
    }
    let is_panning = navigate::navigate(ui, stage, commands);
    if stage.arranges() {
        drag::arrange(ui, stage, commands);
    } else {
        drag::paint_choice(&ui.painter_at(stage.ground), stage);
        if stage.response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
    }
    drop::take(ui, stage, commands);
    menu::show(ui, stage, commands);
    tips::describe(ui, stage, tag);
    say_hovered(stage, commands);
    let is_busy = Popup::is_any_open(ui.ctx()) || DragAndDrop::has_any_payload(ui.ctx());
    stage.state.tool == Tool::Feel && !(is_panning || is_busy)
}

/// Says what the pointer rests on.
fn say_hovered(stage: &Stage<'_>, commands: &mut Commands) {
    let Some(at) = stage.response.hover_pos() else {
        return;
    };
    let place = stage.view.workspace(at);
    if let Some(index) = arrange::topmost(&stage.sight.scene.cloths, place) {
        commands.push(ShowCommand::Hover(Part::Cloth(index)).into());
    }
    if stage.arranges()
        && let Some(index) = drag::dot_at(stage, at)
    {
        commands.push(ShowCommand::Hover(Part::Contactor(index)).into());
    }
}

fn paint_rulers(ui: &Ui, frame: Rect, stage: &Stage<'_>) {
    let pointer = stage
        .response
        .hover_pos()
        .or_else(|| stage.response.interact_pointer_pos())
        .filter(|_| stage.arranges());
    let pointed = ruler::Pointed {
        display: stage.sight.live.centre,
        pointer: pointer.map(|at| stage.view.workspace(at)),
    };
    let painter = ui.painter_at(Rect::from_min_max(frame.min, stage.ground.max));
    ruler::paint(
        &painter,
        frame,
        &stage.view,
        stage.sight.scene.size_mm,
        pointed,
    );
}
