//! One frame of the window: header, panes in their tiles, timeline, and what lies over them.

use std::sync::PoisonError;

use eframe::egui::{
    self, CentralPanel, Frame, Id, LayerId, Margin, Order, Panel, Rect, Stroke, StrokeKind, Ui,
};
use egui_tiles::Tree;

use crate::bench::Bench;
use crate::bench::command::{Command, Commands, PlaySource, ShowCommand};
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::recording::Take;
use crate::bench::view::{Hovered, SceneView, Source};
use crate::kit::theme::Palette;
use crate::shell::arrangement;
use crate::shell::desk::Desk;
use crate::shell::perspective::arrangement_for;
use crate::shell::pointer::{Ground, Pointed};
use crate::shell::state::{After, Transient};
use crate::shell::tab_row::TabRow;
use crate::tools::workspace;

/// Width of the frame around the window of an armed device, points.
const ARMED_FRAME: f32 = 5.0;
/// Height of the header, points.
const HEADER: f32 = 44.0;

/// Shows one frame; says what the user wants.
pub(crate) fn show(bench: &mut Bench, ui: &mut Ui) -> Commands {
    let mut commands = Commands::new();
    let scene = bench.scene_view();
    show_header(bench, ui, &scene, &mut commands);
    if !bench.transient.experiment.is_held() {
        // What is felt is not to be seen.
        show_transport(bench, ui, &mut commands);
    }
    let central = CentralPanel::default().frame(Frame::new());
    let desk = central.show(ui, |ui| {
        let rect = ui.max_rect();
        (show_desk(bench, ui, &scene, &mut commands), rect)
    });
    let (shown, rect) = desk.inner;
    let apart = bench.show_participants_window(ui.ctx(), &mut commands);
    bench.leave_plant();
    let over = shown.map_or(rect, |shown| shown.ground);
    show_overlays(bench, ui, over, &mut commands);
    let here = shown.map(|shown| (shown, Pointed::Workbench, ui.ctx().pixels_per_point()));
    bench.transient.ground = shown.map(|shown| shown.ground);
    feel(bench, ui.ctx(), &scene, apart.or(here));
    mark_hovered(bench, ui.ctx(), &mut commands);
    if bench.transient.live.is_armed() {
        frame_as_armed(ui.ctx());
    }
    commands
}

/// Frames the whole window in red while high voltage is on: to be seen from across the room,
/// whatever pane is in front.
pub(crate) fn frame_as_armed(ctx: &egui::Context) {
    let layer = LayerId::new(Order::Foreground, Id::unique("armed frame"));
    let palette = Palette::of(ctx.theme());
    let stroke = Stroke::new(ARMED_FRAME, palette.danger);
    let painter = ctx.layer_painter(layer);
    painter.rect_stroke(ctx.content_rect(), 0, stroke, StrokeKind::Inside);
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
    if bench.transient.hovered != hovered {
        bench.transient.hovered = hovered;
        ctx.request_repaint();
    }
}

fn show_header(bench: &Bench, ui: &mut Ui, scene: &SceneView, commands: &mut Commands) {
    let header = Panel::top("header").exact_size(HEADER);
    header.frame(panel(ui, 16, 0)).show(ui, |ui| {
        crate::shell::header::show(
            ui,
            scene,
            &bench.transient.live,
            &bench.appearance(),
            commands,
        );
    });
}

fn show_transport(bench: &mut Bench, ui: &mut Ui, commands: &mut Commands) {
    let bottom = Panel::bottom("transport").resizable(false);
    bottom.frame(panel(ui, 12, 6)).show(ui, |ui| {
        let mut state = std::mem::take(&mut bench.transient.transport);
        let view = transport_view(&bench.transient, bench.take.as_ref());
        crate::tools::timeline::show(ui, &view, &mut state, commands);
        bench.transient.transport = state;
    });
}

/// What the timeline shows; `take` is the recording at hand.
pub(crate) fn transport_view<'a>(
    transient: &'a Transient,
    take: Option<&'a Take>,
) -> crate::tools::timeline::TransportView<'a> {
    let live = &transient.live;
    crate::tools::timeline::TransportView {
        source: match live.play.source {
            Source::Pointer => PlaySource::Pointer,
            Source::Lines | Source::Device => PlaySource::Input,
            Source::Stroke => PlaySource::Stroke,
            Source::Recording => PlaySource::Recording,
        },
        input: transient.sources.chosen_name(),
        is_playing: live.play.is_playing,
        does_loop: transient.does_loop,
        is_stopped: live.is_stopped,
        recorded_ticks: live.play.is_recording.then_some(live.play.n_recorded),
        tick: live.play.tick,
        speed_mm_per_s: live.speed_mm_per_s,
        take,
        live: &transient.history,
    }
}

/// The panes in their tiles.
fn show_desk(
    bench: &mut Bench,
    ui: &mut Ui,
    scene: &SceneView,
    commands: &mut Commands,
) -> Option<workspace::Shown> {
    bench.arrange(ui.max_rect().size());
    let mut tree = std::mem::replace(&mut bench.tree, Tree::empty(Id::NULL));
    let mut desk = Desk {
        bench,
        scene,
        commands,
        shown: None,
        is_rearranged: false,
        row: TabRow::default(),
    };
    tree.ui(&mut desk, ui);
    let (shown, is_rearranged) = (desk.shown, desk.is_rearranged);
    bench.tree = tree;
    if is_rearranged {
        bench.keep_arrangement();
    }
    shown
}

/// Notices, questions and help over the panes.
fn show_overlays(bench: &mut Bench, ui: &Ui, over: Rect, commands: &mut Commands) {
    let whole = ui.ctx().content_rect();
    crate::bench::notices::show(ui, over, &bench.transient.notices, commands);
    let recent = &bench.settings.preferences.recent_scenes;
    if let Some(ask) = &mut bench.transient.ask {
        crate::shell::ask::show(ui, whole, ask, recent, commands);
    }
    if let Some(after) = &bench.transient.question {
        let name = &bench.document.scene().name;
        let is_closing = *after == After::Close;
        crate::shell::question::show(ui, whole, name, is_closing, commands);
    }
    if bench.transient.is_help_shown {
        crate::shell::help::show(ui, whole, commands);
    }
}

fn panel(ui: &Ui, across: i8, down: i8) -> Frame {
    Frame::new()
        .fill(Palette::in_ui(ui).panel)
        .inner_margin(Margin::symmetric(across, down))
}

impl Bench {
    /// What the menus tick.
    fn appearance(&self) -> crate::shell::menu::Appearance {
        let kept = &self.settings.preferences;
        let shown = Pane::ALL.map(|pane| (pane, arrangement::is_shown(&self.tree, pane)));
        crate::shell::menu::Appearance {
            clips: self.clips_view(),
            map: kept.colour_map,
            zoom: kept.zoom,
            perspective: kept.perspective,
            dots: self.workspace.dot_style,
            greys_below: self.workspace.greys_below,
            overlays: self.workspace.overlays,
            panes: shown.to_vec(),
            recent: kept.recent_scenes.clone(),
        }
    }

    /// Arranges the panes for a window of this size before they are shown first, and when the room
    /// changes a lot; what was arranged by hand stays.
    fn arrange(&mut self, size: egui::Vec2) {
        let before = std::mem::replace(&mut self.transient.desk_size, size);
        let perspective = self.settings.preferences.perspective;
        if before == egui::Vec2::ZERO {
            self.tree = self.arrangement_of(perspective);
            return;
        }
        if arrangement::is_roomy(before) != arrangement::is_roomy(size) {
            let kept = &self.settings.preferences.arrangements;
            for (resting, kept) in self.resting.iter_mut().zip(kept) {
                resting.take_if(|_| kept.is_none());
            }
            if kept[perspective.index()].is_none() {
                self.tree = arrangement_for(perspective, size);
            }
        }
    }

    /// The arrangement of a perspective that was kept, or its default one.
    fn arrangement_of(&mut self, perspective: Perspective) -> Tree<Pane> {
        let kept = self.settings.preferences.arrangements[perspective.index()].as_deref();
        let tree = kept.map(|text| arrangement::from_text(text, perspective));
        if tree.as_ref().is_some_and(Option::is_none) {
            let words = "The arrangement that was kept could not be used: the default one is shown";
            self.transient.notices.give(words);
        }
        let size = self.transient.desk_size;
        tree.flatten()
            .unwrap_or_else(|| arrangement_for(perspective, size))
    }

    /// Arranges the window for something else; what was arranged before stays as it is.
    pub(crate) fn arrange_for(&mut self, perspective: Perspective) {
        let before = std::mem::replace(&mut self.settings.preferences.perspective, perspective);
        if before == perspective {
            return;
        }
        let resting = self.resting[perspective.index()].take();
        let tree = resting.unwrap_or_else(|| self.arrangement_of(perspective));
        let left = std::mem::replace(&mut self.tree, tree);
        self.resting[before.index()] = Some(left);
    }
}

/// What the pointer feels on: where it is shown, in which window, and its pixels per point.
pub(crate) type Felt = (workspace::Shown, Pointed, f32);

/// Tells the tap where the workspace is, and feeds it when nobody else does.
fn feel(bench: &Bench, ctx: &egui::Context, scene: &SceneView, felt: Option<Felt>) {
    let transient = &bench.transient;
    let is_covered =
        transient.ask.is_some() || transient.question.is_some() || transient.is_help_shown;
    // What is asked and told here covers nothing in another window.
    let ground = felt.filter(|(shown, window, _)| {
        shown.feels && (*window == Pointed::Participant || !is_covered)
    });
    let ground = ground.map(|(shown, window, pixels_per_point)| Ground {
        window,
        view: shown.view,
        rect: shown.ground,
        size_mm: bench
            .transient
            .experiment
            .size_mm()
            .unwrap_or(scene.size_mm),
        pixels_per_point,
    });
    let mut tap = bench.tap.lock().unwrap_or_else(PoisonError::into_inner);
    tap.set_ground(ground);
    if bench.is_stepped {
        let moved = ctx.input(|input| {
            let is_move = |event: &egui::Event| matches!(event, egui::Event::PointerMoved(_));
            input
                .events
                .iter()
                .any(is_move)
                .then(|| input.pointer.latest_pos())
                .flatten()
        });
        if let Some(at) = moved {
            tap.moved_to(bench.stamp(), at);
        }
    }
}
