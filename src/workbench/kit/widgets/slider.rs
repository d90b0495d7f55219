//! A slider in one row: name, rail, number with unit.
//!
//! The rail shows where zero is and snaps softly to it; a double click goes back to the resting
//! value; Shift moves finely; the number can be clicked and typed over, unit and all.

use eframe::egui::{
    self, Align2, Color32, EventFilter, Id, Key, Rect, Response, Sense, Stroke, Ui, WidgetInfo,
    accesskit, pos2, vec2,
};

use crate::kit::foot;
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW};
use crate::kit::widgets::scale::Scale;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// Width of the name, points.
const NAME: f32 = 92.0;
/// Width of the number with its unit, points.
const NUMBER: f32 = 70.0;
/// Within this distance the thumb snaps to zero, points.
const SNAP: f32 = 4.0;
/// Marks of just noticeable differences on either side.
const MOST_MARKS: u8 = 8;
/// What a wheel that scrolls smoothly turns in a notch, points.
const NOTCH: f32 = 40.0;
/// How much finer Shift moves.
const FINE: f64 = 0.1;

/// How a row with a slider is laid out, and what may be typed in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RowShape {
    /// Width of the name, points.
    pub name: f32,
    /// Whether a number beyond the rail may be typed: whoever takes it says what is wrong with it.
    pub(crate) takes_any: bool,
}

/// Shows the slider; says the new value when the user changed it.
pub(crate) fn slider_row(
    ui: &mut Ui,
    name: &str,
    ink: Color32,
    scale: Scale,
    value: f64,
) -> (Option<f64>, Response) {
    let shape = RowShape {
        name: NAME,
        takes_any: false,
    };
    slider_row_as(ui, (name, ink), (shape, scale), value)
}

/// The same in a row of another shape.
pub(crate) fn slider_row_as(
    ui: &mut Ui,
    (name, ink): (&str, Color32),
    (shape, scale): (RowShape, Scale),
    value: f64,
) -> (Option<f64>, Response) {
    let width = ui.available_width();
    let (row, _) = ui.allocate_exact_size(vec2(width, ROW), Sense::hover());
    let palette = Palette::in_ui(ui);
    let name_at = pos2(row.left(), row.center().y);
    ui.painter().text(
        name_at,
        Align2::LEFT_CENTER,
        name,
        theme::body(),
        palette.text,
    );
    let rail = Rect::from_min_max(
        pos2(row.left() + shape.name, row.top()),
        pos2(row.right() - NUMBER - 8.0, row.bottom()),
    );
    let id = ui.scope_id().with(("slider", name));
    let response = ui.interact(rail, id, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value * scale.factor, name));
    let gesture = gesture(ui, &response, &scale, value);
    declare(ui, id, &scale, gesture);
    let slid = slid(ui, &response, rail, &scale, value);
    if let Some((began_at, noticed)) = gesture {
        paint_marks(ui, rail, &scale, &marks(&scale, began_at, noticed));
    }
    paint_rail(ui, &response, rail, &scale, slid.unwrap_or(value), ink);
    let number = Rect::from_min_max(pos2(row.right() - NUMBER, row.top()), row.max);
    let typed = number_field(
        ui,
        number,
        id.with("number"),
        name,
        (&scale, shape),
        slid.unwrap_or(value),
    );
    let new = typed.or(slid).filter(|new| (new - value).abs() > 1e-9);
    (new, response)
}

/// Tells of a slider at the foot of the window: a tip would cover the next slider, which the hand
/// may want next, or what one looks at while dragging.
pub(crate) fn tell(response: &Response, words: impl Into<String>) {
    if response.hovered() || response.dragged() {
        foot::tell(&response.ctx, words);
    }
}

/// The value that pointer, keys or an assistive tool ask for.
fn slid(ui: &Ui, response: &Response, rail: Rect, scale: &Scale, value: f64) -> Option<f64> {
    if response.double_clicked() {
        return Some(scale.resting);
    }
    let fine = ui.input(|input| input.modifiers.shift);
    if response.dragged() && fine {
        let moved = f64::from(response.drag_delta().x / span(rail).width());
        return Some(scale.value_at(scale.share_of(value) + FINE * moved));
    }
    let is_moved = response.dragged() || response.drag_stopped() || response.clicked();
    if (is_moved || response.is_pointer_button_down_on()) && !fine {
        let pointer = response.interact_pointer_pos()?;
        let zero_x = x_of(rail, scale, 0.0);
        if (pointer.x - zero_x).abs() < SNAP {
            return Some(0.0);
        }
        let share = f64::from((pointer.x - span(rail).left()) / span(rail).width());
        return Some(scale.stepped(scale.value_at(share)));
    }
    let notches = wheel_notches(ui, response);
    if notches != 0.0 {
        let size = scale
            .noticed
            .map_or(scale.step, |noticed| noticed.max(scale.step));
        let size = if fine { scale.step } else { size };
        return Some(scale.stepped(value + notches * size));
    }
    let steps = key_steps(ui, response);
    if steps != 0 {
        let size = if fine { FINE } else { 1.0 };
        return Some(scale.moved(value, f64::from(steps) * size));
    }
    asked_value(ui, response.id).map(|asked| (asked / scale.factor).clamp(scale.least, scale.most))
}

/// Notches that the wheel was turned over a slider with Ctrl held: up is more. Without Ctrl it
/// scrolls.
fn wheel_notches(ui: &Ui, response: &Response) -> f64 {
    if !response.hovered() {
        return 0.0;
    }
    let turned: f32 = ui.input(|input| {
        let turns = input.events.iter().map(|event| match event {
            egui::Event::MouseWheel {
                unit,
                delta,
                modifiers,
                ..
            } if modifiers.command => {
                let notch = if *unit == egui::MouseWheelUnit::Point {
                    NOTCH
                } else {
                    1.0
                };
                delta.y / notch
            }
            _ => 0.0,
        });
        turns.sum()
    });
    f64::from(turned)
}

/// Steps asked for by the arrow keys and by assistive tools: up less down.
pub(crate) fn key_steps(ui: &Ui, response: &Response) -> i32 {
    let requests =
        |action| ui.input(|input| input.num_accesskit_action_requests(response.id, action));
    let mut ups = requests(accesskit::Action::Increment);
    let mut downs = requests(accesskit::Action::Decrement);
    if response.has_focus() {
        let filter = EventFilter {
            horizontal_arrows: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        ups += ui.input(|input| input.num_presses(Key::ArrowRight));
        downs += ui.input(|input| input.num_presses(Key::ArrowLeft));
    }
    let count = |n: usize| i32::try_from(n).unwrap_or(0);
    count(ups) - count(downs)
}

/// The number that an assistive tool asks for.
pub(crate) fn asked_value(ui: &Ui, id: Id) -> Option<f64> {
    ui.input(|input| {
        let requests = input.accesskit_action_requests(id, accesskit::Action::SetValue);
        requests
            .filter_map(|request| match request.data {
                Some(accesskit::ActionData::NumericValue(value)) => Some(value),
                _ => None,
            })
            .last()
    })
    .filter(|value| value.is_finite())
}

/// Where the gesture under way began, and what change was just noticed there; while the pointer
/// only rests on the rail, where a gesture would begin.
fn gesture(ui: &Ui, response: &Response, scale: &Scale, value: f64) -> Option<(f64, f64)> {
    let id = response.id.with("gesture");
    let is_held = response.is_pointer_button_down_on() || response.dragged();
    if !is_held {
        ui.data_mut(|data| data.remove::<(f64, f64)>(id));
        let is_rested_on = response.hovered();
        return scale.noticed.filter(|_| is_rested_on).map(|n| (value, n));
    }
    let began: Option<(f64, f64)> = ui.data(|data| data.get_temp(id));
    let began = began.or_else(|| Some((value, scale.noticed?)))?;
    ui.data_mut(|data| data.insert_temp(id, began));
    Some(began)
}

/// The values that are 1, 2, 3 … just noticeable differences away from `began_at`, on the scale.
fn marks(scale: &Scale, began_at: f64, noticed: f64) -> Vec<f64> {
    if !(noticed > 0.0 && noticed.is_finite()) {
        return Vec::new();
    }
    let steps = (1..=MOST_MARKS).flat_map(|n| [-1.0, 1.0].map(|sign| sign * f64::from(n)));
    let values = steps.map(|n| began_at + n * noticed);
    let is_on_it = |value: &f64| (scale.least..=scale.most).contains(value);
    values.filter(is_on_it).collect()
}

/// Paints marks under the rail.
fn paint_marks(ui: &Ui, rail: Rect, scale: &Scale, marks: &[f64]) {
    let painter = ui.painter();
    let stroke = Stroke::new(1.0, Palette::in_ui(ui).dim);
    for &value in marks {
        let x = painter.round_to_pixel_center(x_of(rail, scale, value));
        painter.vline(x, (rail.bottom() - 5.0)..=(rail.bottom() - 1.0), stroke);
    }
}

/// Tells assistive tools what numbers a widget takes, and where a gesture began with what is just
/// noticed.
pub(crate) fn declare(ui: &Ui, id: Id, scale: &Scale, gesture: Option<(f64, f64)>) {
    let noticed = |change: f64| {
        let change = quantity::with_unit(change * scale.factor, scale.decimals, scale.unit);
        format!("Just noticeable difference {change}, by a model")
    };
    let words = match gesture {
        Some((began_at, change)) => {
            let from = quantity::with_unit(began_at * scale.factor, scale.decimals, scale.unit);
            Some(format!("{}, marked around {from}", noticed(change)))
        }
        None => scale.noticed.map(noticed),
    };
    ui.ctx().accesskit_node_builder(id, |node| {
        if let Some(words) = words {
            node.set_description(words);
        }
        node.set_min_numeric_value(scale.least * scale.factor);
        node.set_max_numeric_value(scale.most * scale.factor);
        node.set_numeric_value_step(scale.step * scale.factor);
        node.add_action(accesskit::Action::SetValue);
        node.add_action(accesskit::Action::Increment);
        node.add_action(accesskit::Action::Decrement);
    });
}

/// Where the middle of the thumb may go.
fn span(rail: Rect) -> Rect {
    rail.shrink2(vec2(6.0, 0.0))
}

fn x_of(rail: Rect, scale: &Scale, value: f64) -> f32 {
    let share = to_single(scale.share_of(value));
    span(rail).left() + share * span(rail).width()
}

fn paint_rail(ui: &Ui, response: &Response, rail: Rect, scale: &Scale, value: f64, ink: Color32) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let y = painter.round_to_pixel_center(rail.center().y);
    let track = span(rail);
    painter.hline(track.x_range(), y, Stroke::new(2.0, palette.hovered));
    let (zero, here) = (x_of(rail, scale, 0.0), x_of(rail, scale, value));
    painter.vline(
        painter.round_to_pixel_center(zero),
        (y - 5.0)..=(y + 5.0),
        Stroke::new(1.0, palette.line),
    );
    painter.hline(zero.min(here)..=zero.max(here), y, Stroke::new(3.0, ink));
    let is_held = response.hovered() || response.dragged();
    painter.circle_filled(pos2(here, y), if is_held { 7.0 } else { 6.0 }, ink);
    painter.circle_filled(
        pos2(here, y),
        if is_held { 3.5 } else { 4.0 },
        palette.panel,
    );
    if response.has_focus() {
        painter.circle_stroke(pos2(here, y), 9.0, Stroke::new(1.0, palette.selection));
    }
}

/// The number, right-aligned; a click turns it into a field.
fn number_field(
    ui: &mut Ui,
    rect: Rect,
    id: Id,
    name: &str,
    (scale, shape): (&Scale, RowShape),
    value: f64,
) -> Option<f64> {
    let editing: Option<String> = ui.data(|data| data.get_temp(id));
    let Some(mut text) = editing else {
        let response = ui.interact(rect, id, Sense::click());
        let spoken = quantity::with_unit(value * scale.factor, scale.decimals, scale.unit);
        let label = format!("{name} value");
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), &label);
            info.current_text_value = Some(spoken.clone());
            info
        });
        crate::kit::widgets::text::paint_number(
            ui,
            rect,
            value * scale.factor,
            scale.decimals,
            scale.unit,
        );
        let response = response.on_hover_text("Click to type a value");
        if response.clicked() {
            let digits = quantity::fixed(value * scale.factor, scale.decimals);
            ui.data_mut(|data| data.insert_temp(id, digits));
            ui.memory_mut(|memory| memory.request_focus(id));
        }
        return None;
    };
    let field = egui::TextEdit::singleline(&mut text)
        .id(id)
        .font(theme::number())
        .hint_text(name)
        .align(Align2::RIGHT_CENTER)
        .margin(egui::Margin::symmetric(4, 3));
    let response = ui.put(rect, field);
    ui.ctx()
        .accesskit_node_builder(id, |node| node.set_label(format!("{name} value")));
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let is_cancelled = ui.input(|input| input.key_pressed(Key::Escape));
        let typed = if shape.takes_any {
            scale.read(&text)
        } else {
            scale.parsed(&text)
        };
        return typed.filter(|_| !is_cancelled);
    }
    ui.data_mut(|data| data.insert_temp(id, text));
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit::widgets::scale::Curve;

    #[test]
    fn typed_values_are_read_with_any_minus_comma_and_unit() {
        let gain = Scale::gain(0.0);
        for (text, value) in [
            ("−3.5 dB", -3.5),
            ("-3,5", -3.5),
            (" 12dB", 12.0),
            ("99", 30.0),
        ] {
            assert_eq!(gain.parsed(text), Some(value), "{text}");
        }
        assert_eq!(Scale::share(0.0).parsed("35 %"), Some(0.35));
        for text in ["", "loud", "NaN", "inf"] {
            assert_eq!(gain.parsed(text), None, "{text}");
        }
    }

    #[test]
    fn values_from_the_rail_are_round() {
        let gain = Scale::gain(0.0);
        assert_eq!(gain.stepped(-3.049), -3.0);
        assert_eq!(gain.stepped(0.299_999), 0.3);
        assert_eq!(Scale::share(0.0).stepped(0.348_7), 0.35);
    }

    #[test]
    fn the_wheel_with_ctrl_turns_by_what_is_just_noticed_and_alone_scrolls() {
        use egui_kittest::kittest::Queryable as _;
        let scale = Scale::gain(0.0).with_noticed(Some(2.2));
        let show = move |ui: &mut Ui, value: &mut f64| {
            let (new, _) = slider_row(ui, "Master", Color32::WHITE, scale, *value);
            *value = new.unwrap_or(*value);
        };
        let mut harness = egui_kittest::Harness::builder()
            .with_size(vec2(400.0, 60.0))
            .build_ui_state(show, -3.0);
        harness.run();
        let at = harness
            .get_by_role_and_label(accesskit::Role::Slider, "Master")
            .rect()
            .center();
        for (modifiers, expected) in [
            (egui::Modifiers::NONE, -3.0),
            (egui::Modifiers::COMMAND, -0.8),
            (egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, -0.7),
        ] {
            harness.event(egui::Event::PointerMoved(at));
            harness.event(egui::Event::ModifiersChanged(modifiers));
            harness.event(egui::Event::MouseWheel {
                unit: egui::MouseWheelUnit::Line,
                delta: vec2(0.0, 1.0),
                phase: egui::TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers,
            });
            harness.run();
            let value = *harness.state();
            assert!((value - expected).abs() < 1e-9, "{modifiers:?}: {value}");
        }
    }

    #[test]
    fn marks_stand_at_whole_just_noticeable_differences_and_on_the_rail() {
        let gain = Scale::gain(0.0);
        assert_eq!(marks(&gain, -26.0, 2.5)[..3], [-28.5, -23.5, -21.0]);
        assert_eq!(marks(&gain, 0.0, 2.0).len(), 2 * usize::from(MOST_MARKS));
        for odd in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(marks(&gain, 0.0, odd).is_empty(), "{odd}");
        }
    }

    #[test]
    fn a_rail_over_decades_begins_with_zero_and_moves_by_ratios() {
        let scale = Scale {
            least: 0.0,
            most: 1.0,
            resting: 0.05,
            step: 0.01,
            decimals: 4,
            unit: "dB",
            factor: 1.0,
            noticed: None,
            curve: Curve::Decades(4.0),
        };
        assert_eq!(scale.value_at(0.0), 0.0);
        assert_eq!(scale.value_at(1.0), 1.0);
        assert_eq!((scale.share_of(0.0), scale.share_of(1.0)), (0.0, 1.0));
        assert_eq!(scale.stepped(0.051_4), 0.051);
        for value in [1e-4, 0.003, 0.05, 1.0] {
            let back = scale.value_at(scale.share_of(value));
            assert!((back / value - 1.0).abs() < 1e-9, "{value}: {back}");
            let there = scale.moved(scale.moved(value, -1.0), 1.0);
            assert!((there / value - 1.0).abs() < 1e-9, "{value}: {there}");
        }
        assert_eq!(scale.moved(1e-4, -1.0), 0.0);
        assert!((scale.moved(0.0, 1.0) - 1e-4).abs() < 1e-12, "up from zero");
        assert_eq!(scale.moved(0.0, -1.0), 0.0);
        assert_eq!(scale.moved(0.99, 5.0), 1.0);
    }

    #[test]
    fn the_ends_of_the_rail_are_the_ends_of_the_scale() {
        let gain = Scale::gain(0.0);
        assert_eq!(gain.value_at(gain.share_of(-30.0)), -30.0);
        assert_eq!(gain.value_at(1.7), 30.0);
    }
}
