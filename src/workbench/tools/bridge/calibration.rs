//! How strongly each contactor must be driven, as a small picture of the array whose numbers can be
//! dragged.

use eframe::egui::{
    self, Align, DragValue, Layout, Rect, RichText, Stroke, StrokeKind, Ui, UiBuilder, pos2, vec2,
};

use crate::bench::command::array::ArrayCommand;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::{button, named, row, toggle};
use crate::tools::bridge::view::{ArrayView, BridgePane};
use selvedge_device::Calibration;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Height of a number in the picture, points.
const CELL: f32 = 22.0;
/// Space between numbers, points.
const GAP: f32 = 2.0;
/// A number never has more room than this, points.
const WIDEST: f32 = 64.0;

/// What matters of the calibration while it is folded away.
pub(crate) fn summary(view: &BridgePane<'_>) -> String {
    let profile = view.array.profile;
    let each = || (0..profile.n_contactors()).map(|contactor| profile.calibration_of(contactor));
    let n_off = each().filter(|calibration| calibration.is_off).count();
    let is_set = |calibration: &Calibration| !calibration.is_nominal();
    let n_set = each().filter(is_set).count();
    match (n_set, n_off) {
        (0, 0) => "none: all alike".to_owned(),
        (n_set, 0) => format!("{n_set} set"),
        (0, n_off) => format!("{n_off} off"),
        (n_set, n_off) => format!("{n_set} set, {n_off} off"),
    }
}

/// Shows the part.
pub(crate) fn show(ui: &mut Ui, array: &ArrayView<'_>, commands: &mut Commands) {
    let band = show_bands(ui, array, commands);
    show_grid(ui, array, band, commands);
    ui.add_space(STEP);
    if let Some(contactor) = array
        .contactor
        .filter(|one| *one < array.profile.n_contactors())
    {
        show_chosen(ui, array, contactor, commands);
    }
}

/// Which band's gains are shown, and a way back.
fn show_bands(ui: &mut Ui, array: &ArrayView<'_>, commands: &mut Commands) -> Band {
    let id = ui.scope_id().with("calibrated band");
    let mut band = ui.data(|data| data.get_temp(id)).unwrap_or(0_usize);
    row(ui, "Drive gain", |ui| {
        let profile = array.profile;
        let is_level = profile.calibration.iter().all(|one| one.is_nominal());
        let refusal = is_level.then_some("Every gain is 1");
        if button(
            ui,
            "All to 1",
            "Every contactor answers its drive alike",
            refusal,
        ) {
            commands.push(ArrayCommand::LevelOut.into());
        }
        for one in Band::ALL.into_iter().rev() {
            let word = format!("{} Hz", quantity::fixed(one.carrier_hz(), 0));
            if toggle(
                ui,
                &word,
                band == one.index(),
                &format!("Show the gains at {word}"),
            ) {
                band = one.index();
            }
        }
    })
    .on_hover_text(
        "Drive that a contactor needs, as a multiple of what full scale says: 1.25 for one that \
         moves 40 µm where 50 are meant. Limits hold what a contactor does, not its drive",
    );
    ui.data_mut(|data| data.insert_temp(id, band));
    if band == 0 { Band::Low } else { Band::High }
}

fn show_grid(ui: &mut Ui, array: &ArrayView<'_>, band: Band, commands: &mut Commands) {
    let profile = array.profile;
    let (n_rows, n_columns) = (f32::from(profile.rows), f32::from(profile.cols));
    let room = ui.available_width();
    let width = (room / n_columns).min(WIDEST);
    let size = vec2(room, n_rows * CELL);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let left = rect.left() + 0.5 * (room - width * n_columns);
    for contactor in 0..profile.n_contactors() {
        let n_columns = usize::from(profile.cols).max(1);
        let (row, column) = (contactor / n_columns, contactor % n_columns);
        let corner = pos2(left + column as f32 * width, rect.top() + row as f32 * CELL);
        let cell = Rect::from_min_size(corner, vec2(width, CELL) - vec2(GAP, GAP));
        show_cell(ui, cell, array, (contactor, band), commands);
    }
}

fn show_cell(
    ui: &mut Ui,
    cell: Rect,
    array: &ArrayView<'_>,
    (contactor, band): (usize, Band),
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let calibration = array.profile.calibration_of(contactor);
    let mut gain = calibration.drive_gain[band.index()];
    let is_nominal = (gain - 1.0).abs() < 1e-9;
    let layout = Layout::centered_and_justified(egui::Direction::LeftToRight);
    let response = ui
        .scope_builder(UiBuilder::new().max_rect(cell).layout(layout), |ui| {
            let style = ui.style_mut();
            style.override_font_id = Some(theme::small_number());
            style.spacing.button_padding = vec2(0.0, 0.0);
            style.spacing.interact_size = cell.size();
            let ink = match (calibration.is_off, is_nominal) {
                (true, _) => palette.line,
                (false, true) => palette.dim,
                (false, false) => palette.band(band),
            };
            style.visuals.override_text_color = Some(ink);
            let [least, most] = Calibration::DRIVE_GAIN;
            let value = DragValue::new(&mut gain)
                .range(least..=most)
                .speed(0.005)
                .fixed_decimals(2);
            ui.add(value)
        })
        .inner;
    if calibration.is_off {
        let stroke = Stroke::new(1.0, palette.line);
        ui.painter()
            .line_segment([cell.left_bottom(), cell.right_top()], stroke);
    }
    if array.contactor == Some(contactor) {
        let edge = Stroke::new(1.5, palette.selection);
        ui.painter().rect_stroke(cell, 3, edge, StrokeKind::Inside);
    }
    let name = format!("Drive gain of contactor {contactor}");
    named(&response, name);
    if response.changed() {
        let mut changed = calibration;
        changed.drive_gain[band.index()] = gain;
        commands.push(ArrayCommand::Calibrate(contactor, changed).into());
    }
    if response.drag_started() || response.gained_focus() {
        commands.push(ShowCommand::SelectContactor(contactor).into());
    }
    if response.hovered() {
        commands.push(ShowCommand::Hover(Part::Contactor(contactor)).into());
    }
    response.on_hover_text(words(array, contactor));
}

/// What a contactor's gains mean.
fn words(array: &ArrayView<'_>, contactor: usize) -> String {
    let profile = array.profile;
    let calibration = profile.calibration_of(contactor);
    let of_band = |band: Band| {
        let index = band.index();
        let moved_um = profile.full_scale_um[index] / calibration.drive_gain[index];
        let gain = quantity::fixed(calibration.drive_gain[index], 2);
        let moved = quantity::with_unit(moved_um, 1, "µm");
        let carrier = quantity::fixed(band.carrier_hz(), 0);
        format!("{carrier} Hz: gain {gain}, {moved} at full drive")
    };
    let state = if calibration.is_off {
        "\nSwitched off"
    } else {
        ""
    };
    format!(
        "Contactor {contactor}, on channel {}\n{}\n{}{state}\nDrag to change, click to type",
        profile.channel_of(contactor),
        of_band(Band::Low),
        of_band(Band::High)
    )
}

/// The chosen contactor: what it moves at full drive, and whether it is driven at all.
fn show_chosen(ui: &mut Ui, array: &ArrayView<'_>, contactor: usize, commands: &mut Commands) {
    let profile = array.profile;
    let calibration = profile.calibration_of(contactor);
    row(ui, &format!("Contactor {contactor}"), |ui| {
        let tip = "Never drive this contactor: dead, or better left alone";
        if toggle(ui, "off", calibration.is_off, tip) {
            let changed = Calibration {
                is_off: !calibration.is_off,
                ..calibration
            };
            commands.push(ArrayCommand::Calibrate(contactor, changed).into());
        }
        for band in Band::ALL.into_iter().rev() {
            show_moved(ui, array, (contactor, band), commands);
        }
    });
}

/// What the contactor moves at full drive, µm: the other way to state its gain.
fn show_moved(
    ui: &mut Ui,
    array: &ArrayView<'_>,
    (contactor, band): (usize, Band),
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let index = band.index();
    let calibration = array.profile.calibration_of(contactor);
    let full_um = array.profile.full_scale_um[index];
    let mut moved_um = full_um / calibration.drive_gain[index];
    let [least, most] = Calibration::DRIVE_GAIN;
    let carrier = quantity::fixed(band.carrier_hz(), 0);
    let response = ui
        .allocate_ui_with_layout(
            vec2(68.0, ROW - STEP),
            Layout::right_to_left(Align::Center),
            |ui| {
                ui.style_mut().override_font_id = Some(theme::number());
                ui.spacing_mut().interact_size.y = ROW - STEP;
                ui.spacing_mut().button_padding.y = 0.0;
                ui.visuals_mut().override_text_color = Some(palette.band(band));
                let value = DragValue::new(&mut moved_um)
                    .range(full_um / most..=full_um / least)
                    .speed(0.1)
                    .fixed_decimals(1)
                    .suffix(" µm");
                ui.add(value)
            },
        )
        .inner;
    let name = format!("Amplitude at full drive, {carrier} Hz");
    named(&response, name);
    if response.changed() {
        let mut changed = calibration;
        changed.drive_gain[index] = full_um / moved_um;
        commands.push(ArrayCommand::Calibrate(contactor, changed).into());
    }
    let tip = RichText::new(format!(
        "What this contactor was measured to move at full drive, {carrier} Hz, µm peak"
    ));
    response.on_hover_text(tip);
}
