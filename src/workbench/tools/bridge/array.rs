//! The array profile in force: which, its scale and limits, how the device falls silent.

use eframe::egui::{self, RichText, TextEdit, Ui};

use crate::bench::command::Commands;
use crate::bench::command::array::ArrayCommand;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::limit_mark::{LIMIT_MARK, paint_limit_mark};
use crate::kit::widgets::list;
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::slider_row;
use crate::kit::widgets::text::{button, choice, named, paragraph, row, small};
use crate::tools::bridge::view::{ArrayView, BridgePane};
use selvedge_device::ArrayProfile;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Width of the list of profiles, points.
const CHOICE: f32 = 168.0;

/// What matters of the array while its part is folded away.
pub(crate) fn summary(view: &BridgePane<'_>) -> String {
    let profile = view.array.profile;
    if view.array.waits {
        return "a change waits for disarming".to_owned();
    }
    let [low, high] = profile.limit_um.map(|um| quantity::fixed(um, 1));
    format!("{}, up to {low} and {high} µm", profile.name)
}

/// Shows the part; `copy_name` is what is typed as the name of a copy.
pub(crate) fn show(
    ui: &mut Ui,
    view: &BridgePane<'_>,
    copy_name: &mut String,
    commands: &mut Commands,
) {
    show_choice(ui, &view.array, commands);
    show_waiting(ui, &view.array);
    show_limits(ui, view.array.profile, commands);
    show_silencing(ui, view.array.profile, commands);
    show_limited(ui, view);
    show_copying(ui, &view.array, copy_name, commands);
}

fn show_choice(ui: &mut Ui, array: &ArrayView<'_>, commands: &mut Commands) {
    row(ui, "Profile", |ui| {
        let name = &array.profile.name;
        list(ui, ("array profile", "Array profile"), CHOICE, name, |ui| {
            for (name, is_own) in &array.choices {
                let detail = if *is_own { "yours" } else { "of the program" };
                let tip = format!("Drive devices as \"{name}\" wherever it fits");
                if choice(ui, RichText::new(name), detail, &tip) {
                    commands.push(ArrayCommand::Choose(Some(name.clone())).into());
                    ui.close();
                }
            }
        });
    })
    .on_hover_text(place_words(array));
}

fn place_words(array: &ArrayView<'_>) -> String {
    let profile = array.profile;
    let shape = if profile.contactors_mm.is_empty() {
        let pitch_mm = f64::from(profile.pitch_um) * 1e-3;
        let pitch = quantity::with_unit(pitch_mm, 2, "mm");
        format!(
            "{} rows × {} columns, {pitch} apart",
            profile.rows, profile.cols
        )
    } else {
        format!(
            "{} contactors at places of their own",
            profile.n_contactors()
        )
    };
    let kept = match (array.is_own, array.folder) {
        (true, Some(folder)) => format!("Your own, kept in {}", folder.display()),
        (true, None) => "Your own, for this run".to_owned(),
        (false, _) => "Of the program; what you change becomes your own".to_owned(),
    };
    format!("{shape}\n{kept}")
}

/// A change that may raise something waits: said where it was made.
fn show_waiting(ui: &mut Ui, array: &ArrayView<'_>) {
    if array.waits {
        let palette = Palette::in_ui(ui);
        let words = "The device is armed: what was changed takes effect once it is disarmed. \
                     What only lowers does so at once.";
        paragraph(ui, small(words, palette.text));
    }
}

fn show_limits(ui: &mut Ui, profile: &ArrayProfile, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    for band in Band::ALL {
        let (index, ink) = (band.index(), palette.band(band));
        let full_um = profile.full_scale_um[index];
        let name = format!("Limit {} Hz", quantity::fixed(band.carrier_hz(), 0));
        let scale = Scale::even([0.0, full_um], full_um, 0.1, (1, "µm"));
        let (new, response) = slider_row(ui, &name, ink, scale, profile.limit_um[index]);
        response.on_hover_text(
            "Largest amplitude of any contactor, µm peak; up to full scale. While armed, only \
             lowering takes effect at once",
        );
        if let Some(limit_um) = new {
            commands.push(ArrayCommand::Limit(band, limit_um).into());
        }
    }
    for band in Band::ALL {
        let (index, ink) = (band.index(), palette.band(band));
        let name = format!("Full {} Hz", quantity::fixed(band.carrier_hz(), 0));
        let ends = [
            ArrayProfile::SMALLEST_SCALE_UM,
            ArrayProfile::LARGEST_SCALE_UM,
        ];
        let scale = Scale {
            curve: Curve::Decades(4.0),
            ..Scale::even(ends, 50.0, 0.1, (1, "µm"))
        };
        let (new, response) = slider_row(ui, &name, ink, scale, profile.full_scale_um[index]);
        response.on_hover_text(
            "Amplitude that the whole drive stands for, µm peak: an assumption, 50 µm, until the \
             array is measured",
        );
        if let Some(full_um) = new {
            commands.push(ArrayCommand::FullScale(band, full_um).into());
        }
    }
}

fn show_silencing(ui: &mut Ui, profile: &ArrayProfile, commands: &mut Commands) {
    let ink = Palette::in_ui(ui).text;
    let most_ms = f64::from(ArrayProfile::LONGEST_SILENCING_MS);
    let hold_ms = f64::from(profile.hold_ms);
    let hold = Scale::even([0.0, most_ms], 60.0, 1.0, (0, "ms"));
    let (new, response) = slider_row(ui, "Hold", ink, hold, hold_ms);
    response.on_hover_text(
        "How long the device goes on without a frame before it ramps to silence; hold and ramp \
         together take at most 100 ms",
    );
    commands.extend(new.map(|ms| ArrayCommand::Hold(ms).into()));
    let most_ramp_ms = (most_ms - hold_ms).max(1.0);
    let usual_ms = most_ramp_ms.min(40.0);
    let ramp = Scale::even([0.0, most_ramp_ms], usual_ms, 1.0, (0, "ms"));
    let (new, response) = slider_row(ui, "Ramp", ink, ramp, f64::from(profile.ramp_ms));
    response.on_hover_text("How long the device's ramp to silence takes");
    commands.extend(new.map(|ms| ArrayCommand::Ramp(ms).into()));
    let most_v = f64::from(ArrayProfile::LARGEST_HV_DV) / 10.0;
    let volts = Scale::even([0.0, most_v], 60.0, 0.1, (1, "V"));
    let asked_v = f64::from(profile.hv_dv.unwrap_or(ArrayProfile::LARGEST_HV_DV)) / 10.0;
    let (new, response) = slider_row(ui, "Voltage", ink, volts, asked_v);
    response.on_hover_text("High voltage to ask the device for, which allows it or less");
    commands.extend(new.map(|volts| ArrayCommand::HighVoltage(volts).into()));
}

/// How many contactors are played weaker than they are shown, with the mark that they carry.
fn show_limited(ui: &mut Ui, view: &BridgePane<'_>) {
    let palette = Palette::in_ui(ui);
    let n = view
        .live
        .dots
        .iter()
        .filter(|dot| dot.limiter.any())
        .count();
    let words = if n == 0 {
        "none".to_owned()
    } else {
        format!("{n} of {}", view.live.dots.len())
    };
    row(ui, "Held by limits", |ui| {
        ui.label(
            RichText::new(words)
                .font(theme::number())
                .color(palette.text),
        );
        let size = egui::vec2(LIMIT_MARK + STEP, LIMIT_MARK + STEP);
        let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        paint_limit_mark(ui.painter(), rect.center());
    })
    .on_hover_text(
        "Contactors that are played weaker than they are shown; they carry this mark in every \
         view, and say why when the pointer rests on them",
    );
}

/// A copy under another name; the profile as it was.
fn show_copying(
    ui: &mut Ui,
    array: &ArrayView<'_>,
    copy_name: &mut String,
    commands: &mut Commands,
) {
    row(ui, "", |ui| {
        let is_of_program = ArrayProfile::shipped(&array.profile.name).is_some();
        let (word, tip) = if is_of_program {
            (
                "As shipped",
                "Let go of what you changed: the program's profile again",
            )
        } else {
            ("Remove", "Remove this profile of yours, and its file")
        };
        let refusal = (!array.is_own).then_some("Nothing was changed of it");
        if button(ui, word, tip, refusal) {
            commands.push(ArrayCommand::Forget.into());
        }
        let nameless = copy_name.trim().is_empty();
        let refusal = nameless.then_some("Type a name for the copy first");
        if button(
            ui,
            "Copy",
            "Keep these values under the name on the left",
            refusal,
        ) {
            commands.push(ArrayCommand::Copy(copy_name.clone()).into());
        }
        let field = TextEdit::singleline(copy_name)
            .desired_width(ui.available_width())
            .hint_text("name of a copy");
        let response = ui.add(field);
        named(&response, "Name of a copy");
    });
}
