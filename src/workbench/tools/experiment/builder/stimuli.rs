//! The stimuli of a design: textiles that are dragged here from the library, cloths, vibrations.

use eframe::egui::{Frame, RichText, Sense, Stroke, StrokeKind, Ui};

use crate::bench::Bench;
use crate::bench::library_shelf::plain_id;
use crate::bench::library_view::LibraryItem;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::{button, choice, toggle};
use crate::tools::experiment::builder::blocks::{Field, Holds, Rows};
use crate::tools::experiment::builder::fields::{Editing, field};
use crate::tools::experiment::builder::state::List;
use selvedge_foundation::files::{EditedKeys, KeyValue};
use selvedge_textile::{Library, elsewhere};

/// The fields of a stimulus, beyond its id.
pub(crate) const STIMULUS: Rows = Rows {
    table: "stimulus",
    one: "stimulus",
    fields: &[
        Field::new(
            ("stimulus", "id"),
            ("id", "a name of its own"),
            Holds::Words,
        ),
        Field::new(
            ("stimulus", "textile"),
            ("textile", "as the id"),
            Holds::Words,
        ),
        Field::new(("stimulus", "cloth"), ("real cloth", "none"), Holds::Words),
        Field::new(
            ("stimulus", "material"),
            ("material", "as the id"),
            Holds::Words,
        ),
        Field::new(
            ("stimulus", "condition"),
            ("condition", "none"),
            Holds::Words,
        ),
        Field::new(
            ("stimulus", "group"),
            ("group", "none; seen, unseen"),
            Holds::Words,
        ),
        Field::new(("stimulus", "gain_db"), ("gain", "0 dB"), Holds::Number),
        Field::new(
            ("stimulus", "gain_40_db"),
            ("40 Hz more", "0 dB"),
            Holds::Number,
        ),
        Field::new(
            ("stimulus", "gain_320_db"),
            ("320 Hz more", "0 dB"),
            Holds::Number,
        ),
        Field::new(
            ("stimulus", "rotation_deg"),
            ("turned by", "0°"),
            Holds::Number,
        ),
        Field::new(
            ("stimulus", "force_alone"),
            ("force alone", ""),
            Holds::Flag,
        )
        .when(|keys| keys.n_tables("presentation.stylus") > 0),
        Field::new(
            ("stimulus", "band_hz"),
            ("vibration", "40 or 320 Hz"),
            Holds::Number,
        ),
        Field::new(
            ("stimulus", "level_db"),
            ("level", "dB re 1 µm"),
            Holds::Number,
        ),
    ],
    applies: |_| true,
    is_needed: false,
};

const TEXTILES: (&str, usize, &str) = ("", 0, "textiles");
const LIBRARY: (&str, usize, &str) = ("", 0, "library");

/// The textiles that are named by their ids alone.
fn textiles(keys: &EditedKeys) -> Vec<String> {
    let all = keys.value(TEXTILES);
    let all = all
        .as_ref()
        .and_then(KeyValue::as_array)
        .into_iter()
        .flatten();
    all.filter_map(|id| id.as_str().map(str::to_owned))
        .collect()
}

/// The ids of all stimuli.
pub(crate) fn ids(keys: &EditedKeys) -> Vec<String> {
    let stated = (0..keys.n_tables("stimulus")).filter_map(|nth| {
        keys.value(("stimulus", nth, "id"))?
            .as_str()
            .map(str::to_owned)
    });
    textiles(keys).into_iter().chain(stated).collect()
}

/// Shows them.
pub(crate) fn show(ui: &mut Ui, editing: &mut Editing, list: &mut List, bench: &Bench) {
    let frame = Frame::new().show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        show_textiles(ui, editing);
        for nth in 0..editing.keys.n_tables("stimulus") {
            ui.push_id(("stimulus", nth), |ui| {
                show_stimulus(ui, editing, (nth, &mut list.open));
            });
        }
        note(ui, "Drag textiles here from the library.", Tone::Quiet);
    });
    let response = ui.interact(
        frame.response.rect,
        ui.scope_id().with("stimuli"),
        Sense::hover(),
    );
    if response.dnd_hover_payload::<LibraryItem>().is_some() {
        let edge = Stroke::new(1.5, Palette::in_ui(ui).selection);
        ui.painter()
            .rect_stroke(response.rect, 4, edge, StrokeKind::Inside);
    }
    if let Some(item) = response.dnd_release_payload::<LibraryItem>() {
        list.refused = take(editing, &item.id, bench).err();
        ui.ctx().request_repaint();
    }
    if let Some(line) = &list.refused {
        note(ui, line, Tone::Wrong);
    }
    ui.horizontal_wrapped(|ui| show_add(ui, editing));
}

fn show_textiles(ui: &mut Ui, editing: &mut Editing) {
    let all = textiles(&editing.keys);
    let mut gone = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        for (nth, id) in all.iter().enumerate() {
            ui.label(id);
            if toggle(ui, "×", false, &format!("Take {id} away")) {
                gone = Some(nth);
            }
        }
    });
    if let Some(nth) = gone {
        let mut all = all;
        all.remove(nth);
        set_textiles(editing, &all);
    }
}

/// A stimulus in a line; the one that is open has its fields below.
fn show_stimulus(ui: &mut Ui, editing: &mut Editing, (nth, open): (usize, &mut Option<usize>)) {
    let said = |key: &str| {
        let value = editing.keys.value(("stimulus", nth, key))?;
        Some(
            value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned),
        )
    };
    let name = said("id").unwrap_or_else(|| format!("stimulus {}", nth + 1));
    let parts = [
        "textile",
        "cloth",
        "condition",
        "gain_db",
        "gain_40_db",
        "gain_320_db",
        "rotation_deg",
        "band_hz",
        "level_db",
    ]
    .map(said);
    let detail = parts.into_iter().flatten().collect::<Vec<_>>().join(" · ");
    let mut is_gone = false;
    let is_open = *open == Some(nth);
    ui.horizontal(|ui| {
        is_gone = toggle(ui, "×", false, &format!("Take {name} away"));
        let tip = "Show what is said of it";
        if choice(ui, RichText::new(&name), &detail, tip) {
            *open = (!is_open).then_some(nth);
        }
    });
    if is_open {
        for one in STIMULUS.fields {
            if one.applies(&editing.keys) {
                field(ui, editing, (one, nth));
            }
        }
    }
    if is_gone {
        editing.keys.remove("stimulus", nth);
        editing.restructured("stimulus");
        *open = None;
    }
}

fn show_add(ui: &mut Ui, editing: &mut Editing) {
    let n = ids(&editing.keys).len() + 1;
    let id = |what: &str| ("id", KeyValue::from(format!("{what}-{n}")));
    let tip = "A textile, with a condition, a material or a gain of its own";
    if button(ui, "Add a textile", tip, None) {
        let keys = [
            id("stimulus"),
            ("textile", "silk-crepe".into()),
            ("condition", "a".into()),
        ];
        editing.keys.push("stimulus", &keys);
        editing.restructured("stimulus");
    }
    if button(
        ui,
        "Add a vibration",
        "A steady vibration of every contactor",
        None,
    ) {
        let keys = [
            id("vibration"),
            ("band_hz", 40.into()),
            ("level_db", 20.0.into()),
        ];
        editing.keys.push("stimulus", &keys);
        editing.restructured("stimulus");
    }
    if button(ui, "Add a real cloth", "A cloth on the table", None) {
        editing
            .keys
            .push("stimulus", &[id("cloth"), ("cloth", "cloth".into())]);
        editing.restructured("stimulus");
    }
}

fn set_textiles(editing: &mut Editing, all: &[String]) {
    let list = all.iter().map(|id| KeyValue::from(id.as_str())).collect();
    let list = (!all.is_empty()).then_some(KeyValue::Array(list));
    editing.set(TEXTILES, list.as_ref(), "textiles");
}

/// Takes a textile of the library; the first says which library the design is of.
pub(super) fn take(editing: &mut Editing, key: &str, bench: &Bench) -> Result<(), String> {
    let library = match elsewhere(key) {
        Some((name, _)) => Some(name.display().to_string()).filter(|name| name != "sixteen"),
        None => name_of(bench.engine_scene.loaded.library()),
    };
    let id = plain_id(key).to_owned();
    let known = ids(&editing.keys);
    let own = editing.keys.value(LIBRARY);
    let own = own.as_ref().and_then(KeyValue::as_str).map(str::to_owned);
    if !known.is_empty() && own != library {
        let name = |library: Option<String>| library.unwrap_or_else(|| "sixteen".to_owned());
        return Err(format!(
            "{id} lies in the library {}, the others in {}; all textiles of a design come from one",
            name(library),
            name(own)
        ));
    }
    if known.contains(&id) {
        return Err(format!("{id} is there already"));
    }
    if known.is_empty() {
        editing.set(LIBRARY, library.map(KeyValue::from).as_ref(), "library");
    }
    let mut all = textiles(&editing.keys);
    all.push(id);
    set_textiles(editing, &all);
    Ok(())
}

/// How a design names a library; `None` for the shipped one.
fn name_of(library: &Library) -> Option<String> {
    if library.is_shipped() {
        return None;
    }
    let root = library.root();
    let root = if root.is_dir() {
        std::path::absolute(&root).unwrap_or(root)
    } else {
        root
    };
    Some(root.display().to_string())
}
