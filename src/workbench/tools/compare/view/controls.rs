//! What is compared: which kind, and which two.

use eframe::egui::{Label, Ui, vec2};

use crate::bench::Bench;
use crate::bench::gain_set::slot;
use crate::bench::recording::Recording;
use crate::bench::tool::PaneContext;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::list;
use crate::kit::widgets::text::{line, paint_quiet, quiet, small, toggle, toggles};
use crate::tools::compare::choice::{Choice, Route, TuningChoice, What};
use crate::tools::compare::comparison::{Compare, Standing};
use selvedge_foundation::quantity::fixed;
use selvedge_render::array::Method;
use selvedge_render::scene::Scene;

/// Height of a row, points.
const LINE: f32 = 20.0;
/// Kinds that are offered.
const KINDS: [(What, &str, &str); 4] = [
    (
        What::Tunings,
        "tunings",
        "Compare gains, compression and filters",
    ),
    (
        What::Textiles,
        "textiles",
        "Compare one textile in the place of another",
    ),
    (
        What::Methods,
        "methods",
        "Compare how amplitudes are computed",
    ),
    (
        What::Recordings,
        "recordings",
        "Compare two recordings as they were, chosen in the Recordings pane",
    ),
];
/// Methods that are offered.
const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

/// What stands over the pane: compare or stop.
pub(crate) fn show_corner(ui: &mut Ui, compare: &mut Compare, bench: &Bench) {
    let standing = compare.standing(&compare.inputs(bench));
    let is_running = matches!(standing, Standing::Running(_));
    let (name, tip) = if is_running {
        ("stop", "Stop comparing")
    } else {
        (
            "compare",
            "Compare now, whether anything has changed or not",
        )
    };
    let is_pressed = toggle(ui, name, false, tip);
    if is_pressed && is_running {
        compare.cancel();
    } else if is_pressed {
        compare.run(bench);
    }
    if is_pressed {
        ui.ctx().request_repaint();
    }
}

/// Shows both rows.
pub(crate) fn show(
    ui: &mut Ui,
    compare: &mut Compare,
    (standing, route): (&Standing, &Route),
    context: &PaneContext<'_>,
) {
    let before = compare.choice.clone();
    let choice = &mut compare.choice;
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        toggles(ui, &mut choice.what, &KINDS);
        ui.add_space(STEP);
        let take = context
            .bench
            .exploration
            .at_hand
            .as_ref()
            .map(Recording::name);
        show_status(ui, standing, route, take);
    });
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.spacing_mut().interact_size.y = LINE;
        match before.what {
            What::Tunings => show_tunings(ui, choice, context.bench.document.scene()),
            What::Textiles => {
                let on = (route, context.bench.display());
                let place = before.place_in(context.bench.document.scene(), on);
                show_textiles(ui, choice, place, context);
            }
            What::Methods => show_methods(ui, choice),
            What::Recordings => {
                if let Route::Recorded(two) = route {
                    let [a, b] = two.each_ref().map(Recording::name);
                    ui.add(Label::new(format!("A  {a}    B  {b}")).truncate());
                }
            }
        }
    });
    if compare.choice != before {
        ui.ctx().request_repaint();
    }
}

/// What path is followed, and how what is shown stands to what is chosen.
fn show_status(ui: &mut Ui, standing: &Standing, route: &Route, take: Option<&str>) {
    let palette = Palette::in_ui(ui);
    let (words, is_odd) = status(standing, route, take);
    let ink = if is_odd { palette.text } else { palette.dim };
    let words = small(words, ink);
    let response = ui.add(Label::new(words).truncate());
    response.on_hover_text(match route {
        Route::Recording(_) => {
            "Both follow the recording at hand. Mute and solo are left out of account"
        }
        Route::Recorded(_) => {
            "Both as they were recorded, tick for tick from their beginnings, as long as both last"
        }
        Route::Stroke(..) => {
            "Nothing is recorded: both follow the circle on which the display explores by itself, \
             once. Record an exploration (R) or open one to compare on it. Mute and solo are left \
             out of account"
        }
    });
}

fn status(standing: &Standing, route: &Route, take: Option<&str>) -> (String, bool) {
    match standing {
        Standing::Running(share) => {
            let share = fixed(f64::from(*share) * 100.0, 0);
            return (format!("comparing… {share} %"), true);
        }
        Standing::Stale => {
            return ("stale: something has changed since".to_owned(), true);
        }
        _ => {}
    }
    let n_ticks = route.n_ticks();
    let words = match take {
        _ if matches!(route, Route::Recorded(_)) => format!("as they were, {n_ticks} ticks"),
        Some(name) => format!("on {name}, {n_ticks} ticks"),
        None => format!("no recording: on a circle, {n_ticks} ticks"),
    };
    (words, false)
}

fn show_tunings(ui: &mut Ui, choice: &mut Choice, scene: &Scene) {
    let width = widths(ui, 2, 2);
    let name = |tuning| match tuning {
        TuningChoice::Live => "this tuning".to_owned(),
        TuningChoice::Library => "library’s tuning".to_owned(),
        TuningChoice::Slot(letter) => {
            let called = slot(scene, letter).map_or("", |slot| &*slot.name);
            format!("slot {} {called}", letter.name())
                .trim_end()
                .to_owned()
        }
    };
    let slots = scene
        .slots
        .iter()
        .map(|slot| TuningChoice::Slot(slot.letter));
    let offered: Vec<_> = [TuningChoice::Live, TuningChoice::Library]
        .into_iter()
        .chain(slots)
        .collect();
    for (index, side) in ["A", "B"].into_iter().enumerate() {
        let chosen = &mut choice.tunings[index];
        combo(ui, side, width, &name(*chosen), |ui| {
            for &tuning in &offered {
                ui.selectable_value(chosen, tuning, name(tuning));
            }
            if scene.slots.is_empty() {
                ui.label(quiet("Slots A to H of the Tuning pane keep more"));
            }
        });
    }
}

fn show_methods(ui: &mut Ui, choice: &mut Choice) {
    let width = widths(ui, 2, 2);
    for (index, side) in ["A", "B"].into_iter().enumerate() {
        let chosen = &mut choice.methods[index];
        combo(ui, side, width, chosen.name(), |ui| {
            for method in METHODS {
                ui.selectable_value(chosen, method, method.name());
            }
        });
    }
}

fn show_textiles(ui: &mut Ui, choice: &mut Choice, place: usize, context: &PaneContext<'_>) {
    let width = widths(ui, 3, 3);
    let cloths = &context.scene.cloths;
    let items = context.bench.library.view.items();
    let place_name = |index: usize| {
        cloths.get(index).map_or_else(
            || "nothing".to_owned(),
            |cloth| format!("{} {}", cloth.label, cloth.name),
        )
    };
    for (index, side) in ["A", "B"].into_iter().enumerate() {
        let chosen = &mut choice.textiles[index];
        let named = |id: &str| items.iter().find(|item| item.id == id);
        let text = match chosen {
            None => "as placed".to_owned(),
            Some(id) => named(id).map_or_else(|| id.clone(), |item| item.name.clone()),
        };
        combo(ui, side, width, &text, |ui| {
            ui.selectable_value(chosen, None, "as placed");
            for item in items.iter().filter(|item| item.flaw.is_none()) {
                ui.selectable_value(chosen, Some(item.id.clone()), &item.name);
            }
        });
    }
    combo(ui, "at", width, &place_name(place), |ui| {
        ui.selectable_value(&mut choice.place, None, "where the path is most");
        for index in 0..cloths.len() {
            ui.selectable_value(&mut choice.place, Some(index), place_name(index));
        }
    });
}

/// The width of each of `n` lists in the row, with `n_letters` names before them.
fn widths(ui: &Ui, n: u8, n_letters: u8) -> f32 {
    let names = f32::from(n_letters) * 18.0;
    ((ui.available_width() - names) / f32::from(n) - STEP).max(40.0)
}

/// A list to choose from, named.
fn combo(ui: &mut Ui, name: &str, width: f32, text: &str, content: impl FnOnce(&mut Ui)) {
    let (cell, _) = ui.allocate_exact_size(vec2(14.0, LINE), eframe::egui::Sense::hover());
    let centre = eframe::egui::Align2::LEFT_CENTER;
    let at = cell.left_center();
    paint_quiet(ui.painter(), at, centre, name);
    let label = match name {
        "at" => "Which textile is exchanged".to_owned(),
        side => format!("{side} of the comparison"),
    };
    list(ui, (("compare", name), &label), width, text, content);
}
