//! Gains, compression and what it does to the library, and the filters in force.

use eframe::egui::{RichText, Ui};

use super::{Wishes, curve};
use crate::app::command::{Command, Edit};
use crate::app::theme::{self, Palette};
use crate::app::view::{Live, SceneView};
use crate::app::widgets::{Scale, pair, row, section, slider_row};
use crate::quantity;
use crate::tactile::{Band, Filters};

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, scene: &SceneView, live: &Live, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    let (now, rest) = (scene.tuning, scene.default_tuning);
    section(ui, "Tuning");
    let mut gain = |ui: &mut Ui, name: &str, ink, resting, value, edit: &dyn Fn(f64) -> Edit| {
        let (new, response) = slider_row(ui, name, ink, Scale::gain(resting), value);
        response.on_hover_text("Double click goes back, Shift moves finely");
        wishes.extend(new.map(|db| Command::Edit(edit(db))));
    };
    gain(
        ui,
        "Master",
        palette.text,
        rest.gain_db,
        now.gain_db,
        &Edit::MasterGain,
    );
    let low = |db| Edit::BandGain(Band::Low, db);
    gain(
        ui,
        "40 Hz",
        palette.low,
        rest.gain_40_db,
        now.gain_40_db,
        &low,
    );
    let high = |db| Edit::BandGain(Band::High, db);
    gain(
        ui,
        "320 Hz",
        palette.high,
        rest.gain_320_db,
        now.gain_320_db,
        &high,
    );
    show_textile(ui, scene, live, &mut gain);
    let scale = Scale::share(rest.compression);
    let (new, response) = slider_row(ui, "Compression", palette.text, scale, now.compression);
    response.on_hover_text("0 % leaves textiles as different as they are, 100 % makes all equal");
    wishes.extend(new.map(|share| Command::Edit(Edit::Compression(share))));
    curve::show(ui, scene);
    show_ranges(ui, scene);
    show_filters(ui, scene.filters);
}

/// The gain of the textile under the display; without one the row keeps its place.
fn show_textile(
    ui: &mut Ui,
    scene: &SceneView,
    live: &Live,
    gain: &mut impl FnMut(&mut Ui, &str, eframe::egui::Color32, f64, f64, &dyn Fn(f64) -> Edit),
) {
    let palette = Palette::in_ui(ui);
    let under = live.cloth_under_display();
    let Some((index, cloth)) = under.and_then(|i| scene.cloths.get(i).map(|cloth| (i, cloth)))
    else {
        row(ui, "Textile", |ui| {
            ui.label(RichText::new("none under the display").color(palette.dim));
        });
        ui.add_space(theme::ROW - 20.0);
        return;
    };
    let name = format!("Textile {}", cloth.label);
    let edit = move |db| Edit::TextileGain(index, db);
    gain(ui, name.trim_end(), palette.text, 0.0, cloth.gain_db, &edit);
}

fn show_ranges(ui: &mut Ui, scene: &SceneView) {
    let Some(reference_db) = scene.reference_db else {
        return;
    };
    let plain = crate::tactile::Tuning {
        compression: 0.0,
        ..scene.tuning
    };
    let before = curve::ranges_db(&scene.library, &plain, reference_db);
    let after = curve::ranges_db(&scene.library, &scene.tuning, reference_db);
    for band in Band::ALL {
        let name = format!(
            "Library range at {} Hz",
            quantity::fixed(band.carrier_hz(), 0)
        );
        let [from, to] = [before, after].map(|r| quantity::fixed(r[band.index()], 1));
        pair(ui, &name, &format!("{from:>4} → {to:>4}"), "dB");
    }
}

fn show_filters(ui: &mut Ui, filters: Filters) {
    let (kind, width) = match filters {
        Filters::LogGaussian { octaves } => ("log-Gaussian", Some(octaves)),
        Filters::Receptor => ("receptor thresholds", None),
    };
    let (value, unit) = match width {
        Some(octaves) => (format!("{kind}  {}", quantity::fixed(octaves, 1)), "oct"),
        None => (kind.to_owned(), ""),
    };
    pair(ui, "Filters", &value, unit);
}
