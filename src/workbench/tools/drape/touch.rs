//! How pointer, wheel and keys touch the cloth and turn the view.

use eframe::egui::{
    EventFilter, InputState, Key, Modifiers, PointerButton, Pos2, Rect, Response, Ui, vec2,
};

use crate::tools::drape::camera::{Camera, Sight};
use crate::tools::drape::grasp::Grasp;
use crate::tools::drape::hand::Hands;
use crate::tools::drape::look::Look;
use crate::tools::drape::motion::Motion;
use selvedge_foundation::numerics::to_single;

/// Points of scrolling that bring it nearer by a factor of e, and that open by a mm.
const SCROLL: f32 = 250.0;
const OPEN_SCROLL: f32 = 12.0;
/// What a key moves by, mm; turns by, points of dragging; and brings nearer by.
const KEY_MM: f64 = 2.0;
const KEY_TURN: f32 = 12.0;

/// What pointer, wheel and keys do.
pub(crate) fn touch(
    ui: &Ui,
    response: &Response,
    (rects, sights): (&[Rect], &[Sight]),
    (look, hands, motion): (&mut Look, &mut Hands, &Motion),
) {
    turn(ui, response, (look, hands));
    if look.looked_at_s.is_some() {
        return;
    }
    let is_pressed =
        response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down());
    let moves = ui.input(|input| input.pointer.delta() != eframe::egui::Vec2::ZERO);
    if is_pressed {
        response.request_focus();
        let last = motion.frames.back().cloned();
        hands.take_over(last.as_ref());
    }
    let Some(grasp) = hands.grasp.as_mut() else {
        return;
    };
    if hands.is_replaying {
        return;
    }
    grasp.press(is_pressed);
    let at = response
        .hover_pos()
        .or_else(|| response.interact_pointer_pos());
    let turns = [PointerButton::Secondary, PointerButton::Middle];
    let is_turned = turns.iter().any(|by| response.dragged_by(*by));
    if let Some(at) = at.filter(|_| moves && !is_turned) {
        let nth = rects.iter().position(|rect| rect.contains(at)).unwrap_or(0);
        lead(ui, &sights[nth], at, grasp);
    }
    if response.has_focus() {
        move_by_keys(ui, response, (look, hands));
    }
}

/// Where the pointer leads the grasp; a drag with Shift shifts its fingers, one with Ctrl pulls.
fn lead(ui: &Ui, sight: &Sight, at: Pos2, grasp: &mut Grasp) {
    let Some(place) = sight.on_plane(at) else {
        return;
    };
    let (modifiers, by) = ui.input(|input| (input.modifiers, input.pointer.delta()));
    let [right, down] = [by.x, by.y].map(|by| f64::from(by / sight.scale));
    match () {
        () if !grasp.is_pressed => grasp.go_to(place),
        () if modifiers.shift => grasp.shift_by([right, -down]),
        () if modifiers.command => grasp.pull_by(down),
        () => return grasp.go_to(place),
    }
    if grasp.is_pressed {
        grasp.stay(place);
    }
}

/// Turns and brings nearer by pointer and wheel; the wheel with Alt or Shift opens.
fn turn(ui: &Ui, response: &Response, (look, hands): (&mut Look, &mut Hands)) {
    let camera = &mut look.camera;
    if response.double_clicked_by(PointerButton::Secondary) {
        *camera = Camera::default();
    }
    let is_turned =
        response.dragged_by(PointerButton::Secondary) || response.dragged_by(PointerButton::Middle);
    if is_turned {
        *camera = camera.turned(response.drag_delta());
    }
    if response.hovered() {
        let scrolled = ui.input(InputState::smooth_scroll_delta);
        let modifiers = ui.input(|input| input.modifiers);
        if modifiers.alt || modifiers.shift {
            if let Some(grasp) = &mut hands.grasp {
                grasp.open_by(f64::from((scrolled.x + scrolled.y) / OPEN_SCROLL));
            }
        } else {
            let pinched = ui.input(InputState::zoom_delta);
            *camera = camera.nearer((scrolled.y / SCROLL).exp() * pinched);
        }
    }
}

/// Arrows move, with Shift they shift the fingers against each other, with Alt they turn the view;
/// brackets open and close, Enter closes or lets go.
fn move_by_keys(ui: &Ui, response: &Response, (look, hands): (&mut Look, &mut Hands)) {
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let presses = |modifiers: Modifiers, key: Key| {
        let n = ui.input_mut(|input| input.count_and_consume_key(modifiers, key));
        n as f64
    };
    let way = |modifiers: Modifiers| {
        let less = |more: Key, less: Key| presses(modifiers, more) - presses(modifiers, less);
        let right = less(Key::ArrowRight, Key::ArrowLeft);
        [right, less(Key::ArrowUp, Key::ArrowDown)]
    };
    // Those with a modifier first: what is left is without one.
    let [right, up] = way(Modifiers::ALT).map(to_single);
    look.camera = look.camera.turned(vec2(right, -up) * KEY_TURN);
    let Some(grasp) = &mut hands.grasp else {
        return;
    };
    grasp.shift_by(way(Modifiers::SHIFT).map(|n| KEY_MM * n));
    grasp.pull_by(-KEY_MM * way(Modifiers::COMMAND)[1]);
    let by = way(Modifiers::NONE).map(|n| KEY_MM * n);
    if by.iter().any(|mm| mm.abs() > 0.0) {
        grasp.move_by(by);
    }
    // Plus and minus are the workspace's.
    let wider = presses(Modifiers::NONE, Key::CloseBracket);
    grasp.open_by(KEY_MM * (wider - presses(Modifiers::NONE, Key::OpenBracket)));
    if presses(Modifiers::NONE, Key::Enter) > 0.0 {
        grasp.is_held = !grasp.is_held;
    }
}
