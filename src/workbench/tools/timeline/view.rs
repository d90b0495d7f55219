//! The line of time: what the pointer and keys do on it, and how it is painted.
//!
//! The wheel zooms about the pointer, a drag moves what is in sight, two clicks show it as at
//! first; a click, or a drag along the ruler, puts the cursor there; a drag with Shift selects.

use eframe::egui::{
    Align2, CursorIcon, EventFilter, InputState, Key, PointerButton, Rect, Response, Sense, Shape,
    Stroke, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Commands, PlayCommand};
use crate::kit::pane::paint_sentence;
use crate::kit::spectrum_scale::EVENLY;
use crate::kit::theme::Palette;
use crate::kit::widgets::level_bar;
use crate::kit::widgets::text::{paint_quiet, toggle};
use crate::tools::timeline::lanes::{self, LaneStyle, Layout, name_of};
use crate::tools::timeline::scope::{Scope, extent};
use crate::tools::timeline::span::Span;
use crate::tools::timeline::state::{Drag, Timeline};
use crate::tools::timeline::transport::TransportView;
use crate::tools::timeline::words::words_at;
use crate::tools::timeline::{marks, selection};
use selvedge_foundation::quantity;

/// Points of scrolling that magnify by the factor e.
const POINTS_PER_E: f32 = 240.0;
/// Ticks that an arrow key moves with Shift.
const LEAP: u64 = 40;
/// Width of the bar of colours, points.
const COLOUR_BAR: f32 = 8.0;
/// Within this of the cursor a drag takes it along, points.
const GRASP: f32 = 5.0;

/// Shows the line of time in `rect`.
pub(crate) fn show(
    ui: &mut Ui,
    rect: Rect,
    (view, style): (&TransportView<'_>, &mut LaneStyle),
    state: &mut Timeline,
    commands: &mut Commands,
) {
    let sense = Sense::click_and_drag();
    let response = ui.interact(rect, ui.scope_id().with("timeline"), sense);
    response.widget_info(|| {
        if let Some(take) = view.shown_take() {
            let label = format!("Timeline of {}, tick", take.name());
            return WidgetInfo::slider(true, view.tick as f64, label);
        }
        let label = "Timeline of what was felt last";
        WidgetInfo::labeled(eframe::egui::Role::Canvas, true, label)
    });
    let Some(layout) = Layout::of(rect) else {
        return;
    };
    let all = extent(view);
    let before = state.sight.span(all);
    navigate(ui, &response, (&layout, all), state);
    let span = state.sight.span(all);
    let span = followed(span, all, view, state);
    if span != before {
        ui.ctx().request_repaint();
    }
    let cursor = ask(ui, &response, (&layout, all, span), (view, state), commands);
    let Timeline {
        recorded,
        live,
        pictures,
        sight,
        is_as_recorded,
        selected,
        naming,
        ..
    } = state;
    let (felt, spectrum) = match view.shown_take() {
        Some(_) => (recorded.felt(), recorded.spectrum()),
        None => (live.felt(), live.spectrum()),
    };
    let tiles = (felt, spectrum);
    let top = pictures.paint(ui, (&layout, &*style), tiles, (sight.of, span));
    let scope = Scope {
        view,
        layout,
        all,
        span,
        cursor,
        felt,
        spectrum,
    };
    paint(ui, &scope, style, top);
    paint_title(ui, &scope, recorded.share());
    hover(ui, &response, &scope, style);
    marks::show(ui, &scope, naming, commands);
    if let Some(part) = selected
        && selection::show(ui, &scope, part, commands)
    {
        *selected = None;
    }
    show_scale(ui, &layout, style);
    show_choices(ui, (view, &layout), is_as_recorded, commands);
}

/// A choice beside a lane; says whether it was clicked.
fn choice(ui: &mut Ui, lane: Rect, (word, is_on): (&str, bool), tip: &str) -> bool {
    let place = Rect::from_min_size(name_of(lane).left_top(), vec2(40.0, 18.0));
    let mut child = ui.new_child(UiBuilder::new().max_rect(place));
    toggle(&mut child, word, is_on, tip)
}

/// Beside the spectrum: the bar of its colours, and how its frequencies lie.
fn show_scale(ui: &mut Ui, layout: &Layout, style: &mut LaneStyle) {
    let lane = layout.lanes[0];
    let left = lane.right() + 9.0;
    let bar = Rect::from_x_y_ranges(left..=left + COLOUR_BAR, lane.y_range());
    level_bar::show(ui, bar, style.map, &mut style.spectrum.levels);
    let is_linear = &mut style.spectrum.is_linear;
    if choice(ui, lane, ("linear", *is_linear), EVENLY) {
        *is_linear = !*is_linear;
        ui.ctx().request_repaint();
    }
}

/// Beside the lanes: what a recording is drawn as; the way back to now.
fn show_choices(
    ui: &mut Ui,
    (view, layout): (&TransportView<'_>, &Layout),
    is_as_recorded: &mut bool,
    commands: &mut Commands,
) {
    if let Some(take) = view.shown_take().filter(|take| take.n_contactors() > 0) {
        let tip = format!(
            "{} as it was recorded, rather than as the scene and its gains render it now",
            take.name()
        );
        if choice(ui, layout.lanes[1], ("as felt", *is_as_recorded), &tip) {
            *is_as_recorded = !*is_as_recorded;
        }
    }
    if view.past_column.is_some() {
        let tip = "Every view shows the past: click to see what is felt now";
        if choice(ui, layout.lanes[3], ("to now", true), tip) {
            commands.push(PlayCommand::LookBack(None).into());
        }
    }
}

/// Wheel, drag and two clicks.
fn navigate(ui: &Ui, response: &Response, (layout, all): (&Layout, Span), state: &mut Timeline) {
    let span = state.sight.span(all);
    if let Some(at) = response.hover_pos() {
        let (scrolled, pinched) =
            ui.input(|input| (input.smooth_scroll_delta(), InputState::zoom_delta(input)));
        let factor = f64::from(pinched * (scrolled.y / POINTS_PER_E).exp());
        if (factor - 1.0).abs() > 1e-6 {
            let share = layout.share_at(at.x).clamp(0.0, 1.0);
            // What ends with the newest goes on to do so.
            let ends_with_newest = state.sight.of == 0 && span.end >= all.end;
            let share = if ends_with_newest { 1.0 } else { share };
            state.sight.set(span.zoomed(factor, share, all), all);
        }
        if scrolled.x != 0.0 {
            let by = -f64::from(scrolled.x / layout.ruler.width()) * span.length();
            state.sight.set(span.panned(by, all), all);
        }
    }
    if response.double_clicked() {
        state.sight.reset();
        state.selected = None;
    } else if state.drag == Some(Drag::Pan) && response.dragged_by(PointerButton::Primary) {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        let by = -f64::from(response.drag_delta().x / layout.ruler.width()) * span.length();
        state.sight.set(span.panned(by, all), all);
    }
}

/// While a recording plays, its cursor stays in sight.
fn followed(span: Span, all: Span, view: &TransportView<'_>, state: &mut Timeline) -> Span {
    let is_seen = (0.0..=1.0).contains(&span.share_of(view.tick));
    if view.shown_take().is_none() || !view.is_running() || is_seen || state.drag.is_some() {
        return span;
    }
    let start = view.tick as f64 - 0.05 * span.length();
    let next = Span::new(start, start + span.length()).within(all);
    state.sight.set(next, all);
    next
}

/// Puts the cursor where pointer or keys ask for it; gives its place.
fn ask(
    ui: &Ui,
    response: &Response,
    (layout, all, span): (&Layout, Span, Span),
    (view, state): (&TransportView<'_>, &mut Timeline),
    commands: &mut Commands,
) -> Option<u64> {
    let shown = match view.shown_take() {
        Some(_) => Some(view.tick),
        None => view.past_column,
    };
    let pointer = response.interact_pointer_pos();
    if response.is_pointer_button_down_on() && state.drag.is_none() {
        state.drag = pointer.map(|at| {
            let cursor_x = shown.map(|tick| layout.x_at(span.share_of(tick)));
            let is_near = cursor_x.is_some_and(|x| (x - at.x).abs() <= GRASP);
            if ui.input(|input| input.modifiers.shift) {
                Drag::Select(span.tick_at(layout.share_at(at.x), all))
            } else if at.y <= layout.ruler.bottom() || is_near {
                Drag::Scrub
            } else {
                Drag::Pan
            }
        });
    }
    let is_put = state.drag == Some(Drag::Scrub) && response.is_pointer_button_down_on();
    let is_selecting = matches!(state.drag, Some(Drag::Select(_)));
    let is_clicked = response.clicked() && !response.double_clicked() && !is_selecting;
    let asked = if is_put || is_clicked {
        pointer.map(|at| span.tick_at(layout.share_at(at.x), all))
    } else {
        asked_by_keys(ui, response, shown, all)
    };
    if let (Some(Drag::Select(first)), Some(at)) = (state.drag, pointer) {
        let last = span.tick_at(layout.share_at(at.x), all);
        state.selected = Some(selection::between(first, last));
    }
    if !response.is_pointer_button_down_on() {
        state.drag = None;
    }
    // An engine that has not followed yet is not asked twice.
    if let Some(asked) = asked.filter(|asked| Some(*asked) != shown && state.asked != Some(*asked))
    {
        match view.shown_take() {
            Some(_) => commands.push(PlayCommand::Seek(asked).into()),
            None => commands.push(PlayCommand::LookBack(Some(asked)).into()),
        }
    }
    state.asked = asked;
    asked.or(shown)
}

/// The tick that arrow keys ask for while the line of time has the focus.
fn asked_by_keys(ui: &Ui, response: &Response, shown: Option<u64>, all: Span) -> Option<u64> {
    let tick = shown.filter(|_| response.has_focus())?;
    let filter = EventFilter {
        horizontal_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (ups, downs, is_leap) = ui.input(|input| {
        let presses = |key| input.num_presses(key) as u64;
        let (ups, downs) = (presses(Key::ArrowRight), presses(Key::ArrowLeft));
        (ups, downs, input.modifiers.shift)
    });
    let size = if is_leap { LEAP } else { 1 };
    let moved = (tick + ups * size).saturating_sub(downs * size);
    let ticks = all.ticks();
    (ups != downs).then(|| moved.clamp(ticks.start, ticks.end.saturating_sub(1)))
}

fn paint(ui: &Ui, scope: &Scope<'_>, style: &LaneStyle, top_mm_per_s: f64) {
    let (painter, layout) = (ui.painter(), &scope.layout);
    let newest = scope.view.shown_take().is_none().then_some(scope.all.end);
    lanes::paint_times(painter, layout, scope.span, newest);
    lanes::paint_axes(ui, layout, style, top_mm_per_s);
    if newest == Some(0.0) {
        let words = "Move over a textile, or let the display explore by itself";
        paint_sentence(painter, layout.body(), words);
    }
    if let Some(cursor) = scope.cursor {
        paint_cursor(ui, layout, scope.span.share_of(cursor));
    }
}

fn paint_cursor(ui: &Ui, layout: &Layout, share: f64) {
    if !(0.0..=1.0).contains(&share) {
        return;
    }
    let (palette, painter) = (Palette::in_ui(ui), ui.painter());
    let x = painter.round_to_pixel_center(layout.x_at(share));
    let (top, bottom) = (layout.ruler.bottom(), layout.body().bottom());
    painter.vline(x, top..=bottom, Stroke::new(1.5, palette.selection));
    let corners = vec![
        pos2(x - 4.5, top - 7.0),
        pos2(x + 4.5, top - 7.0),
        pos2(x, top),
    ];
    let head = Shape::convex_polygon(corners, palette.selection, Stroke::NONE);
    painter.add(head);
}

/// What is shown, and how far it is made.
fn paint_title(ui: &Ui, scope: &Scope<'_>, made: Option<f32>) {
    let take = scope.view.shown_take();
    let title = match (take, made) {
        (Some(_), Some(share)) => {
            format!("making {} %", quantity::fixed(f64::from(100.0 * share), 0))
        }
        (Some(take), None) => take.name().to_owned(),
        (None, _) => match scope.view.recorded_ticks {
            Some(_) => "Recording".to_owned(),
            None => "Felt last".to_owned(),
        },
    };
    let room = name_of(scope.layout.ruler);
    let painter = ui.painter().with_clip_rect(room.intersect(ui.clip_rect()));
    let (at, anchor) = (room.left_center(), Align2::LEFT_CENTER);
    paint_quiet(&painter, at, anchor, title);
}

/// A line where the pointer is, and what is there.
fn hover(ui: &Ui, response: &Response, scope: &Scope<'_>, style: &LaneStyle) {
    let Some(at) = response.hover_pos().filter(|_| !response.dragged()) else {
        return;
    };
    let Some((lane, rect)) = scope.layout.lane_at(at) else {
        return;
    };
    let (palette, painter) = (Palette::in_ui(ui), ui.painter());
    let x = painter.round_to_pixel_center(at.x);
    painter.vline(
        x,
        scope.layout.body().y_range(),
        Stroke::new(1.0, palette.line),
    );
    let words = words_at(scope, style, (lane, rect), at);
    response.clone().on_hover_ui_at_pointer(|ui| {
        ui.label(words);
    });
}
