//! What the fingers feel: in numbers, and whether the device feels it.

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::{quiet_pairs, row, toggles};
use crate::tools::drape::hung::ClothFrame;
use crate::tools::drape::through::ThroughDevice;
use selvedge_foundation::quantity::fixed;

/// Why there are no forces.
pub(crate) const UNTOUCHED: &str =
    "No forces: by XPBD and projective dynamics fingers touch nothing";

/// Whether the device feels the cloth in place of the scene.
pub(crate) fn show_through(ui: &mut Ui, is_on: &mut bool, bench: &Bench) {
    let refusal = ThroughDevice::refusal(bench);
    row(ui, "Through the device", |ui| {
        let on = "The displays feel what the fingers touch of the chosen cloth; limits and stops \
                  are those of the device";
        let kinds = [
            (false, "off", "The scene is felt"),
            (true, "on", refusal.unwrap_or(on)),
        ];
        ui.add_enabled_ui(refusal.is_none(), |ui| {
            toggles(ui, is_on, &kinds);
        });
    });
    if let Some(why) = refusal {
        note(ui, why, Tone::Quiet);
    }
    if *is_on {
        for words in ThroughDevice::notes(bench) {
            note(ui, &words, Tone::Quiet);
        }
    }
}

/// What each finger feels of a cloth, in numbers; none where fingers touch nothing.
pub(crate) fn show_felt(ui: &mut Ui, cloth: Option<&ClothFrame>, has_touch: bool) {
    let cloth = cloth.filter(|_| has_touch);
    if !has_touch {
        note(ui, UNTOUCHED, Tone::Quiet);
    }
    let felt = |nth: usize| cloth.and_then(|cloth| cloth.fingers.get(nth));
    for (nth, names) in [["press 1", "slip 1"], ["press 2", "slip 2"]]
        .into_iter()
        .enumerate()
    {
        let digits = |value: Option<f64>, decimals| {
            value.map_or_else(|| "–".to_owned(), |value| fixed(value, decimals))
        };
        let press = digits(felt(nth).map(|felt| felt.press_n), 3);
        let slip = digits(felt(nth).map(|felt| felt.slip_mm_per_s), 1);
        quiet_pairs(
            ui,
            [
                (names[0], press, "N", "Force of the pad across the cloth"),
                (
                    names[1],
                    slip,
                    "mm/s",
                    "Mean speed of its points over the cloth",
                ),
            ],
        );
    }
}
