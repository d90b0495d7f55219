//! The rows of sliders and choices, the mark of what can be held, and the question before what
//! cannot.

use eframe::egui::{ComboBox, RichText, Stroke, Ui, vec2};

use crate::bench::view::EngineView;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::{slider_row, tell};
use crate::kit::widgets::text::{button, named, row, toggles};
use crate::tools::stylus::Stylus;
use crate::tools::stylus::settings::{DELAY, DIALS, StylusSettings};
use selvedge_foundation::numerics::to_single;
use selvedge_render::contact::Stepper;

/// Room at both ends of a slider's rail, points.
const RAIL_END: f32 = 6.0;
/// Width of the list of methods, points.
const METHODS: f32 = 150.0;

/// Shows all rows, and applies what can be held.
pub(crate) fn show(ui: &mut Ui, stylus: &mut Stylus, live: &EngineView) {
    let (_, limit) = stylus.map();
    let mut settings = stylus.chosen.shown();
    let ink = Palette::in_ui(ui).text;
    for dial in &DIALS {
        let is_used = settings.is_sampled || dial.name != DELAY;
        let value = *(dial.field)(&mut settings);
        ui.add_enabled_ui(is_used, |ui| {
            let (new, response) = slider_row(ui, dial.name, ink, dial.scale, value);
            if is_used {
                tell(&response, dial.tip);
            } else {
                let why = "A force that acts at all times is never late: choose sampled";
                response.clone().on_disabled_hover_text(why);
            }
            if dial.name == DIALS[0].name && limit < dial.scale.most {
                paint_limit(ui, response.rect, &dial.scale, limit);
            }
            if let Some(new) = new {
                let scale = &dial.scale;
                *(dial.field)(&mut settings) = new.clamp(scale.least, scale.most);
            }
        });
    }
    show_choices(ui, &mut settings);
    if settings != stylus.chosen.shown() {
        stylus.chosen.ask(settings);
    }
    show_through(ui, stylus, live);
    show_question(ui, stylus);
}

fn show_choices(ui: &mut Ui, settings: &mut StylusSettings) {
    row(ui, "Method", |ui| {
        let combo = ComboBox::from_id_salt("stylus method");
        let combo = combo.selected_text(settings.method.name()).width(METHODS);
        let response = combo.show_ui(ui, |ui| {
            for method in Stepper::ALL {
                ui.selectable_value(&mut settings.method, method, method.name());
            }
        });
        named(&response.response, "How the stylus is stepped");
    });
    row(ui, "Controller", |ui| {
        let kinds = [
            (
                true,
                "sampled",
                "The force is held from tick to tick, as a device does",
            ),
            (false, "continuous", "The force acts at all times"),
        ];
        toggles(ui, &mut settings.is_sampled, &kinds);
    });
    row(ui, "Along the surface", |ui| {
        let kinds = [
            (false, "off", "Force up and down alone"),
            (
                true,
                "on",
                "Friction and the relief push along the surface too",
            ),
        ];
        toggles(ui, &mut settings.is_lateral, &kinds);
    });
}

/// The switch that lets it be felt in place of the array, and how it stands with that.
fn show_through(ui: &mut Ui, stylus: &mut Stylus, live: &EngineView) {
    row(ui, "Through the device", |ui| {
        let kinds = [
            (false, "off", "The array is felt"),
            (
                true,
                "on",
                "The stylus’ vibration is felt on every contactor in place of the array",
            ),
        ];
        toggles(ui, &mut stylus.through.is_on, &kinds);
    });
    for words in stylus.through.notes(live.stylus) {
        note(ui, words, Tone::Quiet);
    }
    if let Some(words) = &stylus.recorded {
        note(ui, &format!("Recorded with a stylus: {words}"), Tone::Quiet);
    }
}

/// Marks on a rail the largest value that can be held.
fn paint_limit(ui: &Ui, rail: eframe::egui::Rect, scale: &Scale, limit: f64) {
    let span = rail.shrink2(vec2(RAIL_END, 0.0));
    let share = to_single(scale.share_of(limit.max(scale.least)));
    let x = ui
        .painter()
        .round_to_pixel_center(span.left() + share * span.width());
    let y = rail.y_range().shrink(4.0);
    let stroke = Stroke::new(2.0, Palette::in_ui(ui).selection);
    ui.painter().vline(x, y, stroke);
}

/// Asks before what cannot be held, and says what is as it is.
fn show_question(ui: &mut Ui, stylus: &mut Stylus) {
    ui.add_space(STEP);
    let Some((_, why)) = stylus.chosen.asked.clone() else {
        show_standing(ui, stylus);
        return;
    };
    note(ui, &format!("Not applied: {why}"), Tone::Wrong);
    ui.horizontal(|ui| {
        let tip = "Feel how it grows; the run ends where it has no bound";
        if button(ui, "Apply anyway", tip, None) {
            stylus.chosen.confirm();
        }
        if button(ui, "Back", "Back to the setting in force", None) {
            stylus.chosen.asked = None;
        }
    });
}

fn show_standing(ui: &mut Ui, stylus: &Stylus) {
    let case = stylus.chosen.applied.case();
    let standing = case.standing();
    ui.label(RichText::new(standing.word()).strong());
    note(ui, &case.advice(), Tone::Quiet);
    if let Some(method) = &stylus.follower.chosen {
        note(ui, method, Tone::Quiet);
    }
    if let Some(trouble) = &stylus.follower.trouble {
        note(ui, trouble, Tone::Wrong);
    }
}
