//! One frame of the window: header, panes in their tiles, timeline, and what lies over them.

use std::sync::PoisonError;

use clap::ValueEnum as _;
use eframe::egui::{self, CentralPanel, Frame, Id, Margin, Panel, Ui, UiBuilder};
use egui_tiles::Tree;

use crate::bench::Bench;
use crate::bench::command::{Command, Commands, ShowCommand};
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::tool::{Guest, PaneContext};
use crate::bench::view::{Hovered, SceneView};
use crate::kit::pane::frame_as_armed;
use crate::kit::theme::Palette;
use crate::kit::view_transform::{Pointed, PointerGround};
use crate::shell::arrangement;
use crate::shell::on_stage::is_felt;
use crate::shell::pane_host::PaneHost;
use crate::shell::perspective::arrangement_for;
use crate::shell::state::{Cover, Tour};
use crate::shell::tab_row::TabRow;
use crate::shell::tour;
use crate::shell::window::Workbench;
use selvedge_render::scene::Arrangement;

/// Height of the header, points.
const HEADER: f32 = 44.0;
/// Height of the line at the foot of the window, points.
const STATUS: f32 = 24.0;

/// Shows one frame; says what the user wants.
pub(crate) fn show(window: &mut Workbench, ui: &mut Ui) -> Commands {
    let mut commands = Commands::new();
    let scene = window.bench.scene_view();
    show_header(window, ui, &scene, &mut commands);
    if let Some(offer) = window.bench.files.recovery.offer() {
        crate::shell::offer::show(ui, offer, &mut commands);
    }
    tour::show(&mut window.bench, &mut window.shell, ui);
    let line = Panel::bottom("status").exact_size(STATUS);
    let line = line.frame(panel(ui, 12, 0)).show(ui, |ui| ui.max_rect());
    if !window.bench.has_session() {
        // What is felt is not to be seen.
        show_bar(window, ui, &scene, &mut commands);
    }
    let central = CentralPanel::default().frame(Frame::new());
    // What a session hangs is shown where its participant looks.
    let hangs = window.bench.hung().is_some();
    let mut guest = hangs.then(|| window.tools.take_out(Pane::Drape)).flatten();
    let panes = central.show(ui, |ui| {
        show_panes(window, ui, &scene, (&mut commands, &mut guest))
    });
    let ground = panes.inner;
    let apart = show_windows(window, ui, &scene, (&mut commands, &mut guest));
    window.tools.put_back(guest);
    show_overlays(window, ui, &mut commands);
    // Last, so that it tells of what the pointer rests on in this frame.
    let mut foot = ui.new_child(UiBuilder::new().max_rect(line.inner));
    crate::shell::status_line::show(&mut foot, &window.bench, &mut commands);
    window.shell.keyboard.was_typing = ui.ctx().text_edit_focused();
    window.bench.pointer.ground = ground.map(|ground| ground.rect);
    feel(window, ui.ctx(), apart.or(ground));
    window.follow_start_motion(ui.ctx(), ground);
    tour::follow(&mut window.bench, &mut window.shell);
    mark_hovered(&mut window.bench, ui.ctx(), &mut commands);
    if window.bench.live.is_armed() {
        frame_as_armed(ui.ctx());
    }
    commands
}

/// Shows the windows that tools have of their own; where the pointer feels there, if there is such
/// a place.
fn show_windows(
    window: &mut Workbench,
    ui: &Ui,
    scene: &SceneView,
    (commands, guest): (&mut Commands, &mut Guest),
) -> Option<PointerGround> {
    let mut ground = None;
    let mut context = PaneContext {
        bench: &mut window.bench,
        scene,
        commands,
        ground: &mut ground,
        guest,
    };
    for tool in window.tools.iter_mut() {
        tool.windows(ui.ctx(), &mut context);
    }
    ground
}

/// Lets every view mark what the pointer rests on, from the next frame on if that has changed.
fn mark_hovered(bench: &mut Bench, ctx: &egui::Context, commands: &mut Commands) {
    let mut hovered = Hovered::default();
    commands.retain(|command| {
        if let Command::Show(ShowCommand::Hover(part)) = command {
            hovered.take(*part);
            return false;
        }
        true
    });
    if bench.selection.hovered != hovered {
        bench.selection.hovered = hovered;
        ctx.request_repaint();
    }
}

fn show_header(window: &Workbench, ui: &mut Ui, scene: &SceneView, commands: &mut Commands) {
    let header = Panel::top("header").exact_size(HEADER);
    header.frame(panel(ui, 16, 0)).show(ui, |ui| {
        let described = (scene, &window.steps());
        crate::shell::header::show(ui, described, &window.bench, &window.appearance(), commands);
    });
}

fn show_bar(window: &mut Workbench, ui: &mut Ui, scene: &SceneView, commands: &mut Commands) {
    let bottom = Panel::bottom("transport").resizable(false);
    bottom.frame(panel(ui, 12, 6)).show(ui, |ui| {
        let mut context = PaneContext {
            bench: &mut window.bench,
            scene,
            commands,
            ground: &mut None,
            guest: &mut None,
        };
        window.shell.bar.ui(ui, &mut context);
    });
}

/// The panes in their tiles.
fn show_panes(
    window: &mut Workbench,
    ui: &mut Ui,
    scene: &SceneView,
    (commands, guest): (&mut Commands, &mut Guest),
) -> Option<PointerGround> {
    window.arrange(ui.max_rect().size());
    let mut tree = std::mem::replace(&mut window.shell.tree, Tree::empty(Id::NULL));
    let mut ground = None;
    let mut desk = PaneHost {
        context: PaneContext {
            bench: &mut window.bench,
            scene,
            commands,
            ground: &mut ground,
            guest,
        },
        tools: &mut window.tools,
        n_drawn: &mut window.shell.n_drawn,
        is_rearranged: false,
        row: TabRow::default(),
        focus: &mut window.shell.focus,
        toured: window.shell.tour.map(Tour::pane),
    };
    tree.ui(&mut desk, ui);
    let is_rearranged = desk.is_rearranged;
    window.shell.tree = tree;
    if is_rearranged {
        window.keep_arrangement();
    }
    ground
}

/// Questions and help over the panes.
fn show_overlays(window: &mut Workbench, ui: &Ui, commands: &mut Commands) {
    let whole = ui.ctx().content_rect();
    let (bench, shell) = (&mut window.bench, &mut window.shell);
    let recent = &bench.settings.preferences.recent_scenes;
    if let Some(ask) = &mut shell.ask {
        crate::shell::ask::show(ui, whole, ask, recent, commands);
    }
    if let Some(question) = &shell.question {
        crate::shell::question::show(ui, whole, question, commands);
    }
    match &mut shell.cover {
        Some(Cover::Keys(list)) => {
            let chosen = &mut bench.settings.preferences.keys;
            crate::shell::help::show(ui, whole, list, chosen, commands);
        }
        Some(Cover::Guide(reading)) => crate::shell::guide::show(ui, reading, commands),
        Some(Cover::Palette(palette)) => {
            crate::shell::palette::show(ui, whole, palette, &mut window.bench, commands);
        }
        None => {}
    }
}

fn panel(ui: &Ui, across: i8, down: i8) -> Frame {
    Frame::new()
        .fill(Palette::in_ui(ui).panel)
        .inner_margin(Margin::symmetric(across, down))
}

impl Workbench {
    /// What the menus tick.
    fn appearance(&self) -> crate::shell::menu::Appearance {
        let kept = &self.bench.settings.preferences;
        let shown = Pane::ALL.map(|pane| (pane, arrangement::is_shown(&self.shell.tree, pane)));
        crate::shell::menu::Appearance {
            clips: self.bench.clips_view(),
            map: kept.colour_map,
            zoom: kept.zoom,
            perspective: kept.perspective,
            dots: self.bench.selection.dot_style,
            sound: kept.sound,
            greys_below: self.bench.selection.greys_below,
            overlays: kept.overlays,
            panes: shown.to_vec(),
            recent: kept.recent_scenes.clone(),
        }
    }

    /// Arranges the panes for a window of this size before they are shown first, and when the room
    /// changes a lot; what was arranged by hand stays.
    fn arrange(&mut self, size: egui::Vec2) {
        let before = std::mem::replace(&mut self.shell.size, size);
        let perspective = self.bench.settings.preferences.perspective;
        if before == egui::Vec2::ZERO {
            self.shell.tree = self.arrangement_of(perspective);
            self.arrange_as_scene();
            return;
        }
        self.arrange_as_scene();
        if arrangement::is_roomy(before) != arrangement::is_roomy(size) {
            self.shell.restore_panes();
            let kept = &self.bench.settings.preferences.arrangements;
            for (resting, kept) in self.shell.resting.of_perspectives.iter_mut().zip(kept) {
                resting.take_if(|_| kept.is_none());
            }
            if kept[perspective.index()].is_none() {
                self.shell.tree = arrangement_for(perspective, size);
            }
        }
    }

    /// Arranges the window as another scene wants it; where that wants nothing, as the user did.
    fn arrange_as_scene(&mut self) {
        let wanted = self.bench.document.arrangement();
        if wanted == self.shell.resting.of_scene.as_ref() {
            return;
        }
        self.shell.resting.of_scene = wanted.cloned();
        self.shell.restore_panes();
        let Some(Arrangement { perspective, panes }) = &self.shell.resting.of_scene else {
            let perspective = self.bench.settings.preferences.perspective;
            self.shell.tree = self.arrangement_of(perspective);
            return;
        };
        let perspective = Perspective::from_str(perspective, true).ok();
        let tree = perspective.and_then(|of| arrangement::from_text(panes, of));
        let (Some(perspective), Some(tree)) = (perspective, tree) else {
            let words = "The arrangement of the scene could not be used: arrange the panes and \
                         save the scene to keep yours";
            return self.bench.notices.give(words);
        };
        self.arrange_for(perspective);
        self.shell.tree = tree;
    }

    /// The arrangement of a perspective that was kept, or its default one.
    fn arrangement_of(&mut self, perspective: Perspective) -> Tree<Pane> {
        let kept = self.bench.settings.preferences.arrangements[perspective.index()].as_deref();
        let tree = kept.map(|text| arrangement::from_text(text, perspective));
        if tree.as_ref().is_some_and(Option::is_none) {
            let words = "The arrangement that was kept could not be used: the default one is shown";
            self.bench.notices.give(words);
        }
        let size = self.shell.size;
        tree.flatten()
            .unwrap_or_else(|| arrangement_for(perspective, size))
    }

    /// Arranges the window for something else; what was arranged before stays as it is.
    pub(crate) fn arrange_for(&mut self, perspective: Perspective) {
        let before = std::mem::replace(
            &mut self.bench.settings.preferences.perspective,
            perspective,
        );
        if before == perspective {
            return;
        }
        self.bench.pointer.pane_in_use = None;
        self.shell.restore_panes();
        let resting = self.shell.resting.of_perspectives[perspective.index()].take();
        let tree = resting.unwrap_or_else(|| self.arrangement_of(perspective));
        let left = std::mem::replace(&mut self.shell.tree, tree);
        self.shell.resting.of_perspectives[before.index()] = Some(left);
    }
}

/// Tells the tap where the pointer feels, and feeds it when nobody else does.
pub(crate) fn feel(window: &mut Workbench, ctx: &egui::Context, ground: Option<PointerGround>) {
    // What is asked and told here covers nothing in another window.
    let ground = ground.filter(|ground| {
        ground.feels && (ground.window == Pointed::Participant || !window.shell.is_covered())
    });
    let mut tap = (window.shell.tap.lock()).unwrap_or_else(PoisonError::into_inner);
    tap.set_ground(ground, window.bench.document.scene().displays.len());
    window.bench.pointer.strays = tap.take_strays();
    if !window.bench.pointer.strays.is_empty() {
        ctx.request_repaint();
    }
    if window.bench.is_stepped() && is_felt(window, ctx) {
        let moved = ctx.input(|input| {
            let is_move = |event: &egui::Event| matches!(event, egui::Event::PointerMoved(_));
            let has_moved = input.events.iter().any(is_move);
            has_moved.then(|| input.pointer.latest_pos()).flatten()
        });
        if let Some(at) = moved {
            tap.moved_to(window.bench.clock.stamp(), at);
        }
    }
}
