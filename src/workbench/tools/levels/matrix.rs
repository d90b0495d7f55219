//! Textiles by bands: levels that are dragged or typed, and targets.

use eframe::egui::{DragValue, Grid, Label, Response, RichText, ScrollArea, Ui};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::tell;
use crate::kit::widgets::text::{named, quiet};
use crate::tools::levels::Placed;
use crate::tools::levels::proposal::Change;
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_textile::tactile::Band;

/// Width of a name, points.
const NAME: f32 = 96.0;
/// Targets that may be asked for, dB above threshold.
const TARGETS_DB: [f64; 2] = [-20.0, 60.0];

/// Shows the matrix; with a change what levels it would make.
pub(crate) fn show(
    ui: &mut Ui,
    placed: &[Placed],
    change: Option<&Change>,
    context: &mut PaneContext<'_>,
) {
    let palette = Palette::in_ui(ui);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let grid = Grid::new("levels")
            .num_columns(5)
            .spacing([8.0, 3.0])
            .striped(true);
        grid.show(ui, |ui| {
            ui.label(quiet("dB SL"));
            for band in Band::ALL {
                let name = with_unit(band.carrier_hz(), 0, "Hz");
                ui.label(RichText::new(name).color(palette.band(band)));
                ui.label(quiet(if change.is_some() {
                    "proposed"
                } else {
                    "target"
                }));
            }
            ui.end_row();
            for one in placed {
                show_row(ui, one, change, context);
                ui.end_row();
            }
        });
    });
}

fn show_row(ui: &mut Ui, one: &Placed, change: Option<&Change>, context: &mut PaneContext<'_>) {
    let palette = Palette::in_ui(ui);
    let is_marked = context.scene.is_marked(one.index);
    let ink = if is_marked {
        palette.selection
    } else {
        palette.text
    };
    ui.scope(|ui| {
        ui.set_width(NAME);
        let name = ui.add(Label::new(RichText::new(&one.name).color(ink)).truncate());
        let headroom = one.row.peaks.headroom_db([0.0; 2]);
        let headroom = headroom.map_or_else(
            || "headroom not known yet".to_owned(),
            |db| format!("headroom {}", with_unit(db, 1, "dB")),
        );
        tell(
            &name,
            format!(
                "{}, gain {}, {headroom}",
                one.name,
                with_unit(one.gain_db, 1, "dB")
            ),
        );
        if name.hovered() {
            context
                .commands
                .push(ShowCommand::Hover(Part::Cloth(one.index)).into());
        }
    });
    for band in Band::ALL {
        show_level(ui, one, band, context.commands);
        match change {
            Some(change) => show_proposed(ui, one, band, change),
            None => show_target(ui, one, band, context.commands),
        }
    }
}

/// A level: dragging or typing turns the textile's gain.
fn show_level(ui: &mut Ui, one: &Placed, band: Band, commands: &mut Commands) {
    let before_db = one.row.level_db[band.index()];
    if !before_db.is_finite() {
        ui.label(quiet("silent"));
        return;
    }
    let mut level_db = before_db;
    let response = ui.add(decibels(&mut level_db));
    let name = format!(
        "Level of {} at {}",
        one.name,
        with_unit(band.carrier_hz(), 0, "Hz")
    );
    named(&response, &*name);
    if response.changed() {
        commands.push(one.moved(level_db - before_db).into());
    }
    tell(
        &response,
        format!("{name}: drag it or click and type; both bands of a textile move together"),
    );
}

/// The level that a proposal would make.
fn show_proposed(ui: &mut Ui, one: &Placed, band: Band, change: &Change) {
    let own_db = change.own_db.get(one.index).copied().unwrap_or(0.0);
    let by_db = change.master_db + change.band_db[band.index()] + own_db;
    let after_db = one.row.level_db[band.index()] + by_db;
    let words = if after_db.is_finite() {
        fixed(after_db, 1)
    } else {
        String::new()
    };
    let is_changed = by_db.abs() > 0.0;
    let palette = Palette::in_ui(ui);
    let ink = if is_changed {
        palette.band(band)
    } else {
        palette.dim
    };
    ui.label(RichText::new(words).font(theme::number()).color(ink));
}

/// A number of decibels to drag or to type.
fn decibels(value_db: &mut f64) -> DragValue<'_> {
    DragValue::new(value_db)
        .speed(0.1)
        .custom_formatter(|db, _| fixed(db, 1))
        .custom_parser(|text| Scale::gain(0.0).read(text))
}

/// A target: set by a click, dragged or typed, taken away by the secondary button.
fn show_target(ui: &mut Ui, one: &Placed, band: Band, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let level_db = one.row.level_db[band.index()];
    let set = |target_db| Edit::TargetLevel(one.index, band, target_db).into();
    let name = format!(
        "Target of {} at {}",
        one.name,
        with_unit(band.carrier_hz(), 0, "Hz")
    );
    let Some(before_db) = one.row.target_db[band.index()] else {
        let response = ui.add(eframe::egui::Button::new(quiet("–")).frame(false));
        named(&response, &*name);
        if response.clicked() && level_db.is_finite() {
            commands.push(set(Some(level_db.round())));
        }
        tell(
            &response,
            format!("{name}: none; a click begins with the present level"),
        );
        return;
    };
    let mut target_db = before_db;
    let value = decibels(&mut target_db).range(TARGETS_DB[0]..=TARGETS_DB[1]);
    let off_db = level_db - before_db;
    let is_off = off_db.is_finite() && off_db.abs() > one.row.noticed_db;
    let response: Response = ui
        .scope(|ui| {
            if is_off {
                ui.visuals_mut().override_text_color = Some(palette.band(band));
            }
            ui.add(value)
        })
        .inner;
    named(&response, &*name);
    if response.changed() {
        commands.push(set(Some(target_db)));
    }
    if response.secondary_clicked() {
        commands.push(set(None));
    }
    let off = if off_db.is_finite() {
        format!("the level is {} off", with_unit(off_db, 1, "dB"))
    } else {
        "the band is silent".to_owned()
    };
    tell(
        &response,
        format!("{name}: {off}; the right button takes the target away"),
    );
}
