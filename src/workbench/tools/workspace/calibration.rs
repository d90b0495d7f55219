//! True size: two crosses on the screen, and what a ruler says is between them.
//!
//! Nothing else knows how large a pixel is: what screens say about themselves is often wrong. The
//! answer is in physical pixels, so that it holds at every size of the window's letters.

use eframe::egui::{
    Align, Align2, CursorIcon, Id, Key, Layout, Margin, Painter, Pos2, Rect, RichText, Role, Sense,
    Stroke, TextEdit, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Command, Commands};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::text::button;
use crate::tools::workspace::stage::Stage;
use selvedge_foundation::quantity;

/// Where the crosses are at first, in shares of the ground.
const ENDS: [[f32; 2]; 2] = [[0.2, 0.6], [0.8, 0.6]];
/// Crosses nearer than this tell nothing, pixels.
const LEAST_PIXELS: f64 = 20.0;
/// What a screen may have, pixels per millimetre.
const SCREENS: [f64; 2] = [0.2, 200.0];
/// The length of a cross's arms, points.
const ARM: f32 = 14.0;
/// The side of what can be taken hold of at a cross, points.
const REACH: f32 = 36.0;

/// A measurement on its way.
#[derive(Debug, Clone, PartialEq)]
struct Measurement {
    /// Where the crosses are, in shares of the ground.
    ends: [[f32; 2]; 2],
    /// What was typed.
    typed: String,
    /// Why that does not do.
    refusal: Option<&'static str>,
}

impl Default for Measurement {
    fn default() -> Self {
        Self {
            ends: ENDS,
            typed: String::new(),
            refusal: None,
        }
    }
}

fn id(stage: &Stage<'_>) -> Id {
    stage.response.id.with("calibration")
}

/// Lets go of a measurement when nobody calibrates: the next one begins anew.
pub(crate) fn forget_unless(ui: &Ui, stage: &Stage<'_>) {
    if !stage.state.is_calibrating {
        ui.data_mut(|data| data.remove::<Measurement>(id(stage)));
    }
}

/// Shows the crosses and the card that asks for their distance.
pub(crate) fn show(ui: &Ui, stage: &Stage<'_>, commands: &mut Commands) {
    let known = ui.data(|data| data.get_temp::<Measurement>(id(stage)));
    let is_first = known.is_none();
    let mut measurement = known.unwrap_or_default();
    let veil = Palette::in_ui(ui).floor.gamma_multiply(0.75);
    let painter = ui.painter_at(stage.ground);
    painter.rect_filled(stage.ground, 0, veil);
    let ends = [0, 1].map(|which| show_cross(ui, stage, &mut measurement, which));
    paint(&painter, ends);
    show_card(ui, stage, (&mut measurement, is_first), ends, commands);
    ui.data_mut(|data| data.insert_temp(id(stage), measurement));
}

/// Lets a cross be dragged; says where it is, on the middle of a pixel.
fn show_cross(ui: &Ui, stage: &Stage<'_>, measurement: &mut Measurement, which: usize) -> Pos2 {
    let ground = stage.ground.shrink(ARM);
    let size = ground.size().max(vec2(1.0, 1.0));
    let [across, down] = measurement.ends[which];
    let at = ground.min + vec2(across * size.x, down * size.y);
    let hold = Rect::from_center_size(at, vec2(REACH, REACH));
    let response = ui.interact(hold, id(stage).with(which), Sense::drag());
    let name = ["First cross", "Second cross"][which];
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
    let by = response.drag_delta();
    if by != vec2(0.0, 0.0) {
        let moved = (at + by).clamp(ground.min, ground.max) - ground.min;
        measurement.ends[which] = [moved.x / size.x, moved.y / size.y];
        measurement.refusal = None;
        // It is drawn where it is now, and shows where it goes in the next frame.
        ui.ctx().request_repaint();
    }
    response.on_hover_and_drag_cursor(CursorIcon::Crosshair);
    let painter = ui.painter();
    pos2(
        painter.round_to_pixel_center(at.x),
        painter.round_to_pixel_center(at.y),
    )
}

fn paint(painter: &Painter, ends: [Pos2; 2]) {
    let palette = Palette::of(painter.ctx().theme());
    painter.line_segment(ends, Stroke::new(1.0, palette.line));
    let arm = Stroke::new(1.0, palette.selection);
    for at in ends {
        painter.hline((at.x - ARM)..=(at.x + ARM), at.y, arm);
        painter.vline(at.x, (at.y - ARM)..=(at.y + ARM), arm);
    }
}

fn show_card(
    ui: &Ui,
    stage: &Stage<'_>,
    (measurement, is_first): (&mut Measurement, bool),
    ends: [Pos2; 2],
    commands: &mut Commands,
) {
    card(ui, stage.ground, 400.0, "True size", |ui, _| {
        show_question(ui, stage, (measurement, is_first), ends, commands);
    });
}

fn show_question(
    ui: &mut Ui,
    stage: &Stage<'_>,
    (measurement, is_first): (&mut Measurement, bool),
    ends: [Pos2; 2],
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let words = "Measure the distance between the two crosses on the screen with a ruler. The \
                 crosses can be dragged.";
    let question = ui.label(words);
    ui.add_space(STEP);
    let mut is_entered = false;
    ui.horizontal(|ui| {
        let field = TextEdit::singleline(&mut measurement.typed)
            .desired_width(96.0)
            .font(theme::number())
            .align(Align2::RIGHT_CENTER)
            .margin(Margin::symmetric(8, 6));
        let response = ui.add(field).labelled_by(question.id);
        if is_first {
            response.request_focus();
        }
        if response.changed() {
            measurement.refusal = None;
        }
        is_entered = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
        ui.label(RichText::new("mm").color(palette.dim));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let is_used = button(ui, "Use", "Show true size from now on (Enter)", None);
            if is_used || is_entered {
                answer(stage, measurement, distance_in_pixels(ends, ui));
            }
            if button(ui, "Cancel", "Leave the screen as it is", None) {
                commands.push(Command::Dismiss);
            }
        });
    });
    // The line keeps its place when there is nothing to say, so that nothing moves.
    let said = measurement.refusal.map_or_else(
        || {
            let pixels = quantity::fixed(distance_in_pixels(ends, ui), 0);
            RichText::new(format!("{pixels} pixels apart")).color(palette.dim)
        },
        |why| RichText::new(why).color(palette.text),
    );
    ui.label(said.font(theme::small()));
}

fn answer(stage: &Stage<'_>, measurement: &mut Measurement, pixels: f64) {
    match pixels_per_mm(pixels, &measurement.typed) {
        Ok(pixels_per_mm) => {
            stage.change(|view, place| view.calibrate(pixels_per_mm, place));
        }
        Err(why) => measurement.refusal = Some(why),
    }
}

fn distance_in_pixels(ends: [Pos2; 2], ui: &Ui) -> f64 {
    f64::from(ends[0].distance(ends[1]) * ui.ctx().pixels_per_point())
}

/// Physical pixels per millimetre, from a distance on the screen and what was typed for it in mm;
/// or why that does not do.
fn pixels_per_mm(pixels: f64, typed: &str) -> Result<f64, &'static str> {
    let digits = typed.trim().trim_end_matches("mm").trim_end();
    let Ok(distance_mm) = digits.replace(',', ".").parse::<f64>() else {
        return Err("Type the distance as a number of millimetres, such as 120.5.");
    };
    if !(distance_mm.is_finite() && distance_mm > 0.0) {
        return Err("The distance must be greater than zero.");
    }
    if !pixels.is_finite() || pixels < LEAST_PIXELS {
        return Err("The crosses are too close to each other: drag them apart.");
    }
    let pixels_per_mm = pixels / distance_mm;
    let [least, most] = SCREENS;
    if (least..=most).contains(&pixels_per_mm) {
        Ok(pixels_per_mm)
    } else {
        Err("No screen has pixels of that size: measure again, in millimetres.")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_in_millimetres_tells_the_size_of_a_pixel() {
        assert_eq!(pixels_per_mm(480.0, "120"), Ok(4.0));
        assert_eq!(pixels_per_mm(480.0, " 120,0 mm"), Ok(4.0));
        assert_eq!(pixels_per_mm(481.0, "130"), Ok(3.7));
    }

    #[test]
    fn what_makes_no_sense_is_refused_with_a_sentence() {
        for (pixels, typed) in [
            (480.0, ""),
            (480.0, "twelve"),
            (480.0, "0"),
            (480.0, "-3"),
            (480.0, "NaN"),
            (480.0, "inf"),
            (480.0, "1e9"),
            (480.0, "0.001"),
            (3.0, "120"),
            (f64::NAN, "120"),
        ] {
            let refusal = pixels_per_mm(pixels, typed).unwrap_err();
            assert!(refusal.ends_with('.'), "{pixels} px, “{typed}”: {refusal}");
        }
    }
}
