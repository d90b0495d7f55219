//! What is chosen: the scene and its textiles, the figures of the cloth, the second finger; and
//! what the fingers feel, in numbers.

use eframe::egui::Ui;

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::tool::PaneContext;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note, row_of, step_title};
use crate::kit::widgets::list::list;
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::{slider_row, tell};
use crate::kit::widgets::text::{button, row, toggle, toggles};
use crate::tools::drape::felt_rows::{show_felt, show_through};
use crate::tools::drape::grasp::OPENINGS_MM;
use crate::tools::drape::hung::{Base, ClothChoice, ClothFacts, OtherTextile, Second};
use crate::tools::drape::{Draping, MAX_CLOTHS};

/// Room for the name of a field, points.
const NAME: f32 = 52.0;
/// Width of a list, points.
const LIST: f32 = 128.0;

/// A figure that a slider changes: its key and name; ends, digits, unit, decades if uneven; what it
/// does.
type Dial = (
    (&'static str, &'static str),
    ([f64; 2], usize, &'static str, Option<f64>),
    &'static str,
);

/// Why losses are grey.
pub(crate) const LOSSLESS: &str =
    "Losses do nothing: the scene has no hysteresis (hysteresis = true in its file)";

/// All of them, in the order of the testers.
const DIALS: [Dial; 14] = [
    (
        ("emt_percent", "Stretch EMT"),
        ([0.5, 50.0], 1, "%", Some(2.0)),
        "Strain of the yarns under 500 gf/cm; the mean of warp and weft, whose ratio stays",
    ),
    (
        ("lt", "Linearity LT"),
        ([0.3, 1.2], 2, "", None),
        "1: force grows evenly with strain; below, soft at first",
    ),
    (
        ("wt_gf_cm_per_cm2", "Work WT"),
        ([0.5, 50.0], 1, "gf cm/cm²", Some(2.0)),
        "Energy of stretching up to 500 gf/cm: LT follows from it",
    ),
    (
        ("rt_percent", "Loss RT"),
        ([20.0, 100.0], 0, "%", None),
        "What of the energy of stretching comes back: the rest is lost between yarns",
    ),
    (
        ("g_gf_per_cm_deg", "Shear G"),
        ([0.02, 10.0], 2, "gf/cm°", Some(2.7)),
        "Shear stiffness: low lets the cloth fall in folds across its yarns",
    ),
    (
        ("2hg_gf_per_cm", "Loss 2HG"),
        ([0.0, 20.0], 2, "gf/cm", Some(3.0)),
        "Width of the loop of shear at 0.5°: what yarns lose by rubbing",
    ),
    (
        ("2hg5_gf_per_cm", "Loss 2HG5"),
        ([0.0, 20.0], 2, "gf/cm", Some(3.0)),
        "The same at 5°: it goes with 2HG until it is changed by itself",
    ),
    (
        ("b_gf_cm2_per_cm", "Bending B"),
        ([0.002, 5.0], 3, "gf cm", Some(3.4)),
        "Bending rigidity a width, gf·cm²/cm: low drapes, high stands off",
    ),
    (
        ("2hb_gf_cm_per_cm", "Loss 2HB"),
        ([0.0, 2.0], 3, "gf", Some(3.0)),
        "Width of the loop of bending, gf·cm/cm: high keeps creases",
    ),
    (
        ("weight_mg_per_cm2", "Weight"),
        ([2.0, 100.0], 1, "mg/cm²", Some(1.7)),
        "Mass an area: 10 mg/cm² are 100 g/m²",
    ),
    (
        ("t0_mm", "Thickness T0"),
        ([0.1, 5.0], 2, "mm", Some(1.7)),
        "Thickness without pressure",
    ),
    (
        ("lc", "Linearity LC"),
        ([0.1, 1.2], 2, "", None),
        "1: pressed, it yields evenly; below, soft at first",
    ),
    (
        ("wc_gf_cm_per_cm2", "Work WC"),
        ([0.0, 2.0], 2, "gf cm/cm²", Some(2.5)),
        "Energy of pressing it up to 50 gf/cm²: how thick its cushion under the finger is",
    ),
    (
        ("friction", "Friction"),
        ([0.0, 1.5], 2, "", None),
        "Of a finger on the cloth: what it holds before it slips",
    ),
];

/// Shows all of it.
pub(crate) fn show(ui: &mut Ui, draping: &mut Draping, context: &mut PaneContext<'_>) {
    ui.spacing_mut().item_spacing.y = STEP;
    show_cloths(ui, draping, context);
    ui.add_space(STEP);
    show_figures(ui, draping);
    ui.add_space(STEP);
    let has_second = context.bench.document.scene().displays.len() > 1;
    show_hand(ui, draping, has_second);
    ui.add_space(STEP);
    show_through(ui, &mut draping.through.is_on, context.bench);
    ui.add_space(STEP);
    show_look(ui, draping);
}

fn show_cloths(ui: &mut Ui, draping: &mut Draping, context: &mut PaneContext<'_>) {
    step_title(ui, 1, "Cloth", &draping.chosen.base.name());
    row_of(ui, NAME, ("scene", ""), |ui, _| {
        let tip = "A NAME.drape.toml: cloth, size, pins, fingers";
        if button(ui, "Open…", tip, None) {
            let ask = FileCommand::Ask(Purpose::OpenDrape);
            context.commands.push(ask.into());
        }
        let is_shipped = draping.chosen.base == Base::Shipped;
        let why = is_shipped.then_some("It hangs already");
        if button(ui, "Shipped", "The scene that is part of the program", why) {
            draping.hang(Base::Shipped);
        }
    });
    show_row_of_cloths(ui, draping, context);
    show_textile(ui, draping, context);
    if let Some(why) = &draping.motion.facts.refused {
        note(ui, why, Tone::Wrong);
    }
    if let Some(facts) = draping.motion.facts.cloths.get(draping.look.cloth) {
        let plausible = facts.scene.plausible();
        let told = plausible
            .as_deref()
            .into_iter()
            .chain(facts.silent.as_deref());
        for words in facts.scene.notes().chain(told) {
            note(ui, words, Tone::Quiet);
        }
        note(ui, &facts.stepping, Tone::Quiet);
    }
}

/// The cloths side by side, of which the sliders change one.
fn show_row_of_cloths(ui: &mut Ui, draping: &mut Draping, context: &PaneContext<'_>) {
    let (n, at) = (draping.chosen.cloths.len(), draping.look.cloth);
    row_of(ui, NAME, ("beside", ""), |ui, _| {
        for nth in 0..n {
            let name = (nth + 1).to_string();
            let tip = format!("Change cloth {name}");
            if toggle(ui, &name, nth == at, &tip) {
                draping.look.cloth = nth;
            }
        }
        let why = (n == MAX_CLOTHS).then_some("Five hang side by side already");
        if button(
            ui,
            "+",
            "Hang another textile beside, under the same hand",
            why,
        ) {
            let other = next_textile(draping, context);
            draping.chosen.cloths.push(other);
            draping.look.cloth = n;
        }
        let why = (n == 1).then_some("One cloth is left");
        if button(ui, "−", "Take this cloth away", why) {
            draping.chosen.cloths.remove(at);
            draping.look.cloth = at.min(n - 2);
        }
    });
}

/// A textile that does not hang yet: one that is selected in the library, or the next of it.
fn next_textile(draping: &Draping, context: &PaneContext<'_>) -> ClothChoice {
    let bench = &*context.bench;
    let cloths = draping.motion.facts.cloths.iter();
    let hang: Vec<&str> = cloths.filter_map(|cloth| cloth.key.as_deref()).collect();
    let selected = bench.library.selection.0.iter().cloned();
    let items = bench.library.view.items().iter();
    let mut keys = selected.chain(items.map(|item| item.id.clone()));
    let key = keys.find(|key| !hang.contains(&key.as_str()));
    ClothChoice {
        textile: key.map(|key| Draping::textile(bench, &key)),
        changes: Vec::new(),
    }
}

fn show_textile(ui: &mut Ui, draping: &mut Draping, context: &PaneContext<'_>) {
    let at = draping.look.cloth;
    let now = draping.motion.facts.cloths.get(at);
    let own = "of the scene".to_owned();
    let chosen = draping.chosen.cloths[at].textile.as_ref();
    let words = chosen.map_or_else(|| own.clone(), |textile| textile.name.clone());
    let key_now = now.and_then(|facts| facts.key.clone());
    let bench = &*context.bench;
    let mut taken: Option<Option<OtherTextile>> = None;
    row_of(ui, NAME, ("textile", ""), |ui, _| {
        let name = ("drape textile", "Textile that hangs");
        list(ui, name, LIST, &words, |ui| {
            if ui.selectable_label(chosen.is_none(), &own).clicked() {
                taken = Some(None);
            }
            for item in bench.library.view.all_items() {
                let is_now = chosen.is_some() && key_now.as_deref() == Some(&item.id);
                if ui.selectable_label(is_now, &item.name).clicked() {
                    taken = Some(Some(Draping::textile(bench, &item.id)));
                }
            }
        });
        let selected = bench.library.selection.0.first();
        let why = selected
            .is_none()
            .then_some("Select a textile in the library first");
        let tip = "Hang the textile that is selected in the library";
        if button(ui, "Selected", tip, why) {
            taken = selected.map(|key| Some(Draping::textile(bench, key)));
        }
    });
    if let Some(textile) = taken {
        draping.chosen.cloths[at] = ClothChoice {
            textile,
            changes: Vec::new(),
        };
    }
}

fn show_figures(ui: &mut Ui, draping: &mut Draping) {
    let at = draping.look.cloth;
    let facts = std::sync::Arc::clone(&draping.motion.facts);
    let Some(facts) = facts.cloths.get(at) else {
        return;
    };
    step_title(ui, 2, "Figures", &facts.title);
    let choice = &mut draping.chosen.cloths[at];
    for dial in &DIALS {
        let ((key, _), ..) = *dial;
        let is_used = facts.scene.uses(key);
        // Of LT and WT one follows from the other.
        if is_used || !matches!(key, "lt" | "wt_gf_cm_per_cm2") {
            ui.add_enabled_ui(is_used, |ui| show_dial(ui, dial, facts, choice));
        }
    }
    if !facts.scene.uses("2hb_gf_cm_per_cm") {
        note(ui, LOSSLESS, Tone::Quiet);
    }
    let frame = draping.motion.frame_at(draping.look.looked_at_s);
    let frame = frame.and_then(|frame| frame.cloths.get(at));
    if let Some(n) = frame.map(|frame| frame.n_overstretched).filter(|n| *n > 0) {
        let words = format!("Stretched beyond EMT in {n} steps: a straight line from there on");
        note(ui, &words, Tone::Wrong);
    }
    row(ui, "", |ui| {
        let why = choice.changes.is_empty().then_some("Nothing was changed");
        if button(ui, "As measured", "The textile’s own figures again", why) {
            choice.changes.clear();
        }
    });
}

fn show_dial(ui: &mut Ui, dial: &Dial, facts: &ClothFacts, choice: &mut ClothChoice) {
    let &((key, name), (ends, digits, unit, decades), tip) = dial;
    let resting = facts.unchanged.figure(key).unwrap_or(0.0);
    let changed = choice.changes.iter().position(|(known, _)| *known == key);
    // What goes with another figure stands where that has brought it.
    let taken_along = facts.scene.figure(key).unwrap_or(resting);
    let now = changed.map_or(taken_along, |at| choice.changes[at].1);
    let even = Scale::even(ends, resting, 0.01, (digits, unit));
    let scale = match decades {
        Some(decades) => Scale {
            curve: Curve::Decades(decades),
            ..even
        },
        None => even,
    };
    let ink = Palette::in_ui(ui).text;
    let (new, response) = slider_row(ui, name, ink, scale, now);
    tell(&response, tip);
    let Some(new) = new.map(|new| new.clamp(ends[0], ends[1])) else {
        return;
    };
    // A slider at its resting value changes nothing.
    let is_own = (new - resting).abs() < 1e-9;
    match changed {
        Some(at) if is_own => {
            choice.changes.remove(at);
        }
        Some(at) => choice.changes[at].1 = new,
        None if is_own => {}
        None => choice.changes.push((key, new)),
    }
}

fn show_hand(ui: &mut Ui, draping: &mut Draping, has_second: bool) {
    step_title(ui, 3, "Hand", "press to close");
    row(ui, "Second", |ui| {
        let kinds = [
            (
                Second::Device,
                "device",
                "Behind, where the scene’s second display is: a second finger of its own",
            ),
            (
                Second::Recorded,
                "recorded",
                "Behind, along the path that was recorded or opened",
            ),
            (
                Second::Beside,
                "beside",
                "In front, beside the first: Shift with a drag stretches",
            ),
            (
                Second::Mirrored,
                "mirrored",
                "Behind, opposite the first: Shift with a drag rubs",
            ),
        ];
        toggles(ui, &mut draping.chosen.second, &kinds);
    });
    if draping.chosen.second == Second::Recorded && draping.hands.path.is_none() {
        let words = "No path yet: record a hand or open one below the cloth";
        note(ui, words, Tone::Wrong);
    }
    if draping.chosen.second == Second::Device && !has_second {
        let words =
            "The scene has one display: a second one (Scene, Display) has a finger of its own";
        note(ui, words, Tone::Wrong);
    }
    show_openings(ui, draping);
    let (motion, at) = (&draping.motion, draping.look.cloth);
    let frame = motion.frame_at(draping.look.looked_at_s);
    let facts = motion.facts.cloths.get(at);
    let has_touch = facts.is_none_or(|facts| facts.has_touch);
    show_felt(ui, frame.and_then(|frame| frame.cloths.get(at)), has_touch);
}

fn show_openings(ui: &mut Ui, draping: &mut Draping) {
    if let Some(grasp) = &mut draping.hands.grasp {
        let ink = Palette::in_ui(ui).text;
        let [least, most] = OPENINGS_MM;
        let open = Scale::even([0.0, most], 60.0, 1.0, (0, "mm"));
        let closed = Scale::even([least, 10.0], -3.0, 0.5, (1, "mm"));
        for (name, scale, value, tip) in [
            (
                "Open",
                open,
                &mut grasp.open_mm,
                "Between the pads while nothing is pressed",
            ),
            (
                "Closed",
                closed,
                &mut grasp.closed_mm,
                "While pressed; below 0 the pads push",
            ),
        ] {
            let (new, response) = slider_row(ui, name, ink, scale, *value);
            tell(&response, tip);
            *value = new.unwrap_or(*value);
        }
    }
}

fn show_look(ui: &mut Ui, draping: &mut Draping) {
    row(ui, "Colours", |ui| {
        let kinds = [
            (
                true,
                "strain",
                "How far yarns are stretched, beside a scale",
            ),
            (false, "textile", "The textile’s own picture, lit"),
        ];
        toggles(ui, &mut draping.look.shows_strain, &kinds);
    });
}
