//! What is chosen: the picture and its scale, how friction drives the screen; and what is felt now,
//! in numbers and in lines.

use std::sync::Arc;

use eframe::egui::Ui;

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::latest::Standing;
use crate::bench::pane::Pane;
use crate::bench::tool::PaneContext;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Need, Tone, note, row_of, step_title, text};
use crate::kit::widgets::list::list;
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::{slider_row, tell};
use crate::kit::widgets::text::{button, quiet_pairs, row, toggles};
use crate::tools::friction::source::Source;
use crate::tools::friction::stroke::{BARE_MU, PRESS_N, STROKE_MM_PER_S};
use crate::tools::friction::{Friction, TableOf};
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_render::electrovibration::{Carrier, Electrovibration};

/// Room for the name of a field, points.
const NAME: f32 = 52.0;
/// Width of a list, points.
const LIST: f32 = 168.0;

/// Shows all of it.
pub(crate) fn show(ui: &mut Ui, friction: &mut Friction, context: &mut PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    show_picture(ui, friction, context);
    let trace = friction.trace().and_then(Result::ok).map(Arc::clone);
    if let Some(trace) = &trace {
        let words = format!("Mean {}", trace.predicted.certainty());
        note(ui, &words, Tone::Quiet);
    }
    ui.add_space(STEP);
    step_title(ui, 2, "Electrovibration", "V(s, t) = b f(s) Y(t)");
    show_drive(ui, &mut friction.chosen.drive);
    show_now(ui, friction, context);
    if trace.is_some() {
        row(ui, "Table to export", |ui| {
            let stroke = format!("Voltages of a stroke along the strip at {STROKE_MM_PER_S} mm/s");
            let tables = [
                (TableOf::Stroke, "stroke", stroke.as_str()),
                (
                    TableOf::Strip,
                    "strip",
                    "Friction along the strip: x_mm, mu",
                ),
            ];
            toggles(ui, &mut friction.table, &tables);
        });
    }
}

fn show_picture(ui: &mut Ui, friction: &mut Friction, context: &mut PaneContext<'_>) {
    let name = friction.chosen.source.as_ref().map(Source::name);
    step_title(ui, 1, "Picture", &name.unwrap_or_default());
    row_of(ui, NAME, ("open", ""), |ui, _| {
        let tip = "PNG, JPEG, TIFF or BMP, at least 40 mm wide and 10 mm high";
        if button(ui, "Choose a picture…", tip, None) {
            let purpose = Purpose::OpenPicture(Pane::Friction);
            context.commands.push(FileCommand::Ask(purpose).into());
        }
    });
    show_textiles(ui, friction, context);
    let chosen = &mut friction.chosen;
    let has_scale = chosen.asked().is_some() || chosen.source.is_none();
    row_of(ui, NAME, ("scale", "px/mm"), |ui, label| {
        let need = Need::of(!has_scale);
        text(ui, label, &mut chosen.scale, ("11.8", 72.0, need));
    });
    if !has_scale {
        let words = "Type the picture’s scale: 0.1 to 200 pixels to a millimetre";
        note(ui, words, Tone::Quiet);
    }
    match friction.standing() {
        Standing::Working(share) => {
            ui.horizontal(|ui| {
                note(ui, &format!("working {:.0} %", 100.0 * share), Tone::Quiet);
                if button(ui, "Stop", "Stop predicting", None) {
                    friction.work.stop();
                }
            });
        }
        Standing::Stopped => {
            if button(ui, "Go on", "Predict it after all", None) {
                friction.work.go_on();
            }
        }
        Standing::Empty | Standing::Fresh => {}
    }
    if let Some(Err(why)) = friction.trace() {
        note(ui, why, Tone::Wrong);
    }
}

/// The textiles of the scene, whose own pictures can be taken.
fn show_textiles(ui: &mut Ui, friction: &mut Friction, context: &PaneContext<'_>) {
    let loaded = &context.bench.engine_scene.loaded;
    let source = &friction.chosen.source;
    let is_of = |textile: &Arc<_>| match source {
        Some(Source::Textile(of)) => Arc::ptr_eq(of, textile),
        _ => false,
    };
    let all = || context.scene.cloths.iter().zip(loaded.textiles());
    let now = all().find(|(_, textile)| is_of(textile));
    let now = now.map_or_else(|| "of the scene".to_owned(), |(cloth, _)| cloth.title());
    let mut taken = None;
    row_of(ui, NAME, ("textile", ""), |ui, _| {
        let name = ("friction textile", "Textile of the scene");
        list(ui, name, LIST, &now, |ui| {
            for (cloth, textile) in all() {
                if ui.selectable_label(is_of(textile), cloth.title()).clicked() {
                    taken = Some(Arc::clone(textile));
                }
            }
        });
    });
    if let Some(textile) = taken {
        if let Some(appearance) = &textile.manifest().appearance {
            friction.chosen.scale = appearance.px_per_mm.to_string();
        }
        friction.chosen.source = Some(Source::Textile(textile));
    }
}

fn show_drive(ui: &mut Ui, drive: &mut Electrovibration) {
    let presets = Electrovibration::PRESETS;
    let now = presets.iter().find(|(_, preset)| preset == drive);
    row_of(ui, NAME, ("preset", ""), |ui, _| {
        let name = ("friction preset", "What people chose for a fabric");
        list(ui, name, LIST, now.map_or("own", |(name, _)| name), |ui| {
            for (name, preset) in presets {
                ui.selectable_value(drive, preset, name);
            }
        });
    });
    let ink = Palette::in_ui(ui).text;
    let first = Electrovibration::default();
    let scale = Scale::even(
        [0.0, Electrovibration::MAX_AMPLIFICATION_V],
        first.amplification_v,
        1.0,
        (0, "V"),
    );
    let (b, response) = slider_row(ui, "Gain b", ink, scale, drive.amplification_v);
    tell(
        &response,
        "Voltage where friction is 1; more where cloth feels stronger",
    );
    let scale = Scale {
        curve: Curve::Decades(2.0),
        ..Scale::even(
            Electrovibration::CARRIER_HZ,
            first.carrier_hz,
            1.0,
            (0, "Hz"),
        )
    };
    let (hz, response) = slider_row(ui, "Carrier", ink, scale, drive.carrier_hz);
    tell(
        &response,
        "Frequency of the carrier Y(t); higher where cloth feels smoother",
    );
    *drive = Electrovibration {
        amplification_v: b.unwrap_or(drive.amplification_v),
        carrier_hz: hz.unwrap_or(drive.carrier_hz),
        ..*drive
    }
    .within_limits();
    row(ui, "Shape", |ui| {
        let shapes = [
            (Carrier::Sine, "sine", "From −½ to ½"),
            (
                Carrier::Square,
                "square",
                "From 0 to 1: felt more strongly below 60 Hz",
            ),
        ];
        toggles(ui, &mut drive.carrier, &shapes);
    });
}

/// Place, friction and voltage now, and what to know of them.
fn show_now(ui: &mut Ui, friction: &mut Friction, context: &PaneContext<'_>) {
    let drive = friction.chosen.drive;
    let now = friction.shown(context.bench).and_then(|shown| shown.now);
    let (most_v, none) = (Electrovibration::MAX_V, || "–".to_owned());
    let place = now.map_or_else(none, |(mm, ..)| fixed(mm, 1));
    let mu = now.map_or_else(none, |(_, mu, _)| fixed(mu, 3));
    let v = now.map_or_else(none, |(.., driven)| fixed(driven.peak_to_peak_v, 0));
    let tip = "Peak to peak, after the limit";
    quiet_pairs(
        ui,
        [
            (
                "place s",
                place,
                "mm",
                "x of the display, to and fro over the strip",
            ),
            ("f(s)", mu, "", "Coefficient of friction there"),
        ],
    );
    let limit = fixed(most_v, 0);
    quiet_pairs(
        ui,
        [
            ("voltage", v, "V", tip),
            (
                "limit",
                limit,
                "V",
                "What such a screen takes, peak to peak",
            ),
        ],
    );
    if let Some((_, mu, _)) = now.filter(|(.., driven)| driven.is_limited) {
        let wanted = with_unit(drive.amplification_v * mu, 0, "V");
        let words = format!("Limited: b f(s) is {wanted}; lower b to feel all of it");
        note(ui, &words, Tone::Wrong);
    }
    let hz = drive.carrier_hz;
    let felt = match drive.carrier {
        Carrier::Square => format!("a square is felt at its own {}", with_unit(hz, 0, "Hz")),
        Carrier::Sine => format!(
            "a sine is felt at {}, twice its own",
            with_unit(2.0 * hz, 0, "Hz")
        ),
    };
    let words = format!(
        "The screen pulls by the square of the voltage: {felt}. Simulated screen, a finger of \
         {PRESS_N} N on glass of µ {BARE_MU}; no driver for a real one is shipped."
    );
    note(ui, &words, Tone::Quiet);
}
