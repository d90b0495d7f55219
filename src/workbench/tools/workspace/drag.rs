//! Arranging by hand: choosing textiles, moving, turning and resizing them, with what is drawn
//! around the chosen one.
//!
//! Where a drag began is the toolkit's to remember; edits are wished for only while the button is
//! down, so one drag is one step of undo.

use eframe::egui::{
    CursorIcon, EventFilter, Id, Key, Memory, Modifiers, Painter, PointerButton, Pos2, Stroke, Ui,
    vec2,
};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, ShowCommand};
use crate::bench::paint_display;
use crate::bench::view::Cloth;
use crate::kit::swatch::paint_outline;
use crate::kit::theme::Palette;
use crate::tools::workspace::arrange::{Guides, Handle, Handles, Lines, SNAP_POINTS};
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::{arrange, navigate};
use selvedge_foundation::geometry::{Displacement, Point};

/// How far an arrow key moves a textile, mm; finely with Shift.
const NUDGES_MM: [f64; 2] = [1.0, 0.1];
/// The side of the handle that resizes, points.
const SIZE_HANDLE: f32 = 8.0;
/// The radius of the handle that turns, points.
const TURN_HANDLE: f32 = 4.5;

/// What a drag has hold of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Grab {
    /// The ground.
    Ground,
    /// A textile, this far from its origin.
    Cloth(usize, Displacement),
    /// A far corner, this far from it.
    Size(usize, Displacement),
    /// A textile that turns: its angle less the pointer's bearing from its middle, degrees.
    Turn(usize, f64),
}

/// Lets the pointer and the arrow keys arrange textiles.
pub(crate) fn arrange(ui: &mut Ui, stage: &Stage<'_>, commands: &mut Commands) {
    let id = stage.response.id.with("grab");
    let pointer = stage.response.interact_pointer_pos();
    let (is_pressed, is_down) = ui.input(|input| {
        (
            input.pointer.primary_pressed(),
            input.pointer.primary_down(),
        )
    });
    // A tap may come and go within one frame: it chooses all the same.
    let is_taken = stage.response.is_pointer_button_down_on() || stage.response.clicked();
    if let Some(at) = pointer.filter(|_| is_pressed && is_taken) {
        let grab = take_hold(stage, at, commands);
        ui.data_mut(|data| data.insert_temp(id, Some(grab)));
    }
    let grab = held(ui, id);
    if !is_down && grab.is_some() {
        ui.data_mut(|data| data.insert_temp(id, None::<Grab>));
    }
    let dragged = grab.filter(|_| stage.response.dragged_by(PointerButton::Primary));
    let mut guides = Guides::default();
    if let (Some(grab), Some(at)) = (dragged, pointer) {
        guides = follow(ui, stage, (grab, at), commands);
    }
    if stage.response.clicked()
        && let Some(at) = pointer
    {
        choose_contactor(stage, at, commands);
    }
    nudge(ui, stage, commands);
    let painter = ui.painter_at(stage.ground);
    paint_hovered(ui, &painter, stage);
    paint_guides(&painter, stage, guides);
    paint_selection(&painter, stage);
    if dragged.is_none() {
        crate::tools::workspace::tools::show_beside_selection(ui, stage, commands);
    }
}

fn held(ui: &Ui, id: Id) -> Option<Grab> {
    ui.data(|data| data.get_temp::<Option<Grab>>(id)).flatten()
}

/// The contactor under the pointer, if there is a display to be seen.
pub(crate) fn dot_at(stage: &Stage<'_>, at: Pos2) -> Option<usize> {
    stage.sight.live.centre?;
    paint_display::hit(&stage.view, &stage.sight.live.dots, at)
}

/// Chooses the contactor that was clicked, with its display.
fn choose_contactor(stage: &Stage<'_>, at: Pos2, commands: &mut Commands) {
    if let Some(index) = dot_at(stage, at) {
        commands.push(ShowCommand::SelectContactor(index).into());
        return;
    }
    for other in &stage.sight.live.others {
        if let Some(index) = paint_display::hit(&stage.view, &other.dots, at) {
            commands.push(ShowCommand::SelectDisplay(other.display).into());
            commands.push(ShowCommand::SelectContactor(index).into());
            return;
        }
    }
}

/// What a press gets hold of; a textile is chosen by it, empty ground chooses none.
fn take_hold(stage: &Stage<'_>, at: Pos2, commands: &mut Commands) -> Grab {
    let place = stage.view.workspace(at);
    if let Some((index, cloth)) = stage.selected() {
        match Handles::of(&stage.view, cloth).hit(at) {
            Some(Handle::Size) => {
                return Grab::Size(index, place - arrange::corners(cloth)[2]);
            }
            Some(Handle::Turn) => {
                let bearing_deg = arrange::bearing_deg(arrange::middle(cloth), place);
                return Grab::Turn(index, cloth.rotation_deg - bearing_deg);
            }
            None => {}
        }
    }
    let hit = arrange::topmost(&stage.sight.scene.cloths, place);
    // A click on a dot means the contactor, not the textile below it; a drag means the textile.
    if stage.sight.selection.cloth != hit && dot_at(stage, at).is_none() {
        commands.push(ShowCommand::SelectCloth(hit).into());
    }
    let cloth = hit.and_then(|index| Some((index, stage.sight.scene.cloths.get(index)?)));
    cloth.map_or(Grab::Ground, |(index, cloth)| {
        Grab::Cloth(index, place - cloth.workspace_from_textile.origin)
    })
}

/// Lets what is held follow the pointer; says which lines it snapped to.
fn follow(ui: &Ui, stage: &Stage<'_>, (grab, at): (Grab, Pos2), commands: &mut Commands) -> Guides {
    let (index, icon) = match grab {
        Grab::Ground => {
            navigate::pan(ui, stage);
            return Guides::default();
        }
        Grab::Cloth(index, _) | Grab::Turn(index, _) => (index, CursorIcon::Grabbing),
        Grab::Size(index, _) => (index, CursorIcon::ResizeNeSw),
    };
    ui.ctx().set_cursor_icon(icon);
    let Some(cloth) = stage.sight.scene.cloths.get(index) else {
        return Guides::default();
    };
    if stage.sight.selection.cloth != Some(index) {
        commands.push(ShowCommand::SelectCloth(Some(index)).into());
    }
    let modifiers = ui.input(|input| input.modifiers);
    let (edit, guides) = edit_of(stage, (grab, cloth), stage.view.workspace(at), modifiers);
    commands.extend(edit.map(Into::into));
    guides
}

/// The edit that a drag to `place` asks for, if it changes anything.
fn edit_of(
    stage: &Stage<'_>,
    (grab, cloth): (Grab, &Cloth),
    place: Point,
    modifiers: Modifiers,
) -> (Option<Edit>, Guides) {
    let reach_mm = SNAP_POINTS / stage.view.points_per_mm;
    let lines = |index| Lines::of(stage.sight.scene.size_mm, &stage.sight.scene.cloths, index);
    match grab {
        Grab::Ground => (None, Guides::default()),
        Grab::Cloth(index, offset) => {
            let wanted = place - offset;
            let (origin, guides) = if modifiers.alt {
                (arrange::fine(wanted), Guides::default())
            } else {
                arrange::snapped_origin(cloth, wanted, &lines(index), reach_mm)
            };
            let has_moved = origin != cloth.workspace_from_textile.origin;
            (has_moved.then_some(Edit::MoveCloth(index, origin)), guides)
        }
        Grab::Size(index, offset) => {
            let wanted = place - offset;
            let (size_mm, guides) = if modifiers.alt {
                let size_mm = arrange::size_to(cloth, wanted);
                (size_mm, Guides::default())
            } else {
                arrange::snapped_size(cloth, wanted, &lines(index), reach_mm)
            };
            let pairs = size_mm.iter().zip(&cloth.size_mm);
            let has_grown = pairs
                .into_iter()
                .any(|(new, old)| new.total_cmp(old).is_ne());
            (
                has_grown.then_some(Edit::ResizeCloth(index, size_mm)),
                guides,
            )
        }
        Grab::Turn(index, offset_deg) => {
            let bearing_deg = arrange::bearing_deg(arrange::middle(cloth), place);
            let angle_deg = arrange::tidy_angle(bearing_deg + offset_deg, modifiers.shift);
            let has_turned = (angle_deg - cloth.rotation_deg).abs() > 1e-9;
            let edit = has_turned.then_some(Edit::TurnCloth(index, angle_deg));
            (edit, Guides::default())
        }
    }
}

/// Arrow keys move the chosen textile, unless they belong to something else.
fn nudge(ui: &Ui, stage: &Stage<'_>, commands: &mut Commands) {
    let ground = stage.response.id;
    let focused = ui.memory(Memory::focused);
    if focused.is_some_and(|id| id != ground) {
        return;
    }
    let Some((index, cloth)) = stage.selected() else {
        return;
    };
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(ground, filter));
    let (right, up) = ui.input_mut(|input| {
        let step_mm = NUDGES_MM[usize::from(input.modifiers.shift)];
        let mut presses = |key| input.count_and_consume_key(Modifiers::NONE, key) as f64;
        let right = presses(Key::ArrowRight) - presses(Key::ArrowLeft);
        let up = presses(Key::ArrowUp) - presses(Key::ArrowDown);
        (step_mm * right, step_mm * up)
    });
    if right != 0.0 || up != 0.0 {
        let origin = cloth.workspace_from_textile.origin + Displacement::new(right, up);
        commands.push(Edit::MoveCloth(index, arrange::fine(origin)).into());
    }
}

/// Draws the line around the textile that a press would choose, and the pointer as what it does.
fn paint_hovered(ui: &Ui, painter: &Painter, stage: &Stage<'_>) {
    let Some(at) = stage.response.hover_pos() else {
        return;
    };
    if ui.input(|input| input.pointer.any_down()) {
        return;
    }
    let handle = stage
        .selected()
        .and_then(|(_, cloth)| Handles::of(&stage.view, cloth).hit(at));
    let icon = match handle {
        Some(Handle::Size) => CursorIcon::ResizeNeSw,
        Some(Handle::Turn) => CursorIcon::Grab,
        None if dot_at(stage, at).is_some() => CursorIcon::PointingHand,
        None => {
            let hit = arrange::topmost(&stage.sight.scene.cloths, stage.view.workspace(at));
            if let Some(index) = hit.filter(|index| stage.sight.selection.cloth != Some(*index)) {
                let corners =
                    arrange::screen_corners(&stage.view, &stage.sight.scene.cloths[index]);
                let edge = Stroke::new(1.0, Palette::in_ui(ui).dim);
                paint_outline(painter, corners, edge);
            }
            hit.map_or(CursorIcon::Default, |_| CursorIcon::Move)
        }
    };
    ui.ctx().set_cursor_icon(icon);
}

fn paint_guides(painter: &Painter, stage: &Stage<'_>, guides: Guides) {
    let palette = Palette::of(painter.ctx().theme());
    let line = Stroke::new(1.0, palette.selection.gamma_multiply(0.6));
    if let Some(x_mm) = guides.x_mm {
        let x = stage.view.screen(Point::new(x_mm, 0.0)).x;
        painter.vline(
            painter.round_to_pixel_center(x),
            stage.ground.y_range(),
            line,
        );
    }
    if let Some(y_mm) = guides.y_mm {
        let y = stage.view.screen(Point::new(0.0, y_mm)).y;
        painter.hline(
            stage.ground.x_range(),
            painter.round_to_pixel_center(y),
            line,
        );
    }
}

/// Draws the chosen textile's outline and handles.
fn paint_selection(painter: &Painter, stage: &Stage<'_>) {
    let Some((_, cloth)) = stage.selected() else {
        return;
    };
    let palette = Palette::of(painter.ctx().theme());
    let edge = Stroke::new(1.5, palette.selection);
    paint_outline(painter, arrange::screen_corners(&stage.view, cloth), edge);
    let handles = Handles::of(&stage.view, cloth);
    painter.line_segment([handles.foot, handles.turn], edge);
    painter.circle(handles.turn, TURN_HANDLE, palette.floor, edge);
    let square = eframe::egui::Rect::from_center_size(handles.size, vec2(SIZE_HANDLE, SIZE_HANDLE));
    painter.rect(
        square,
        1,
        palette.floor,
        edge,
        eframe::egui::StrokeKind::Middle,
    );
}

/// Marks the corners of the chosen textile where nothing is arranged.
pub(crate) fn paint_choice(painter: &Painter, stage: &Stage<'_>) {
    let Some((_, cloth)) = stage.selected() else {
        return;
    };
    let palette = Palette::of(painter.ctx().theme());
    let corners = arrange::screen_corners(&stage.view, cloth);
    let edge = Stroke::new(1.5, palette.selection);
    for (i, &corner) in corners.iter().enumerate() {
        for neighbour in [corners[(i + 1) % 4], corners[(i + 3) % 4]] {
            let along = neighbour - corner;
            let arm = along.normalized() * along.length().min(12.0);
            painter.line_segment([corner, corner + arm], edge);
        }
    }
}
