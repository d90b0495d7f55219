//! The left side of the lab: what the recipe begins with, its steps, and three pages of controls.

use eframe::egui::{self, Align, ComboBox, Layout, RichText, ScrollArea, Ui, WidgetInfo, vec2};

use crate::bench::Bench;
use crate::bench::command::lab::Beginning;
use crate::bench::library_view::LibraryView;
use crate::kit::pane::scroll_area;
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::{line, named, quiet, small};
use crate::tools::lab::state::{Lab, Page};
use crate::tools::lab::steps::Steps;
use crate::tools::lab::view::{family, keep, recipe};
use selvedge_textile::RECIPES;

/// Height of a list of textiles in a menu, points.
const LIST: f32 = 320.0;

/// Shows the controls.
pub(crate) fn show(ui: &mut Ui, lab: &mut Lab, bench: &mut Bench) {
    line(ui, ROW, |ui| {
        if let Some(beginning) = show_beginnings(ui, &bench.library.view) {
            lab.begin_with(bench, beginning);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            show_steps(ui, lab);
        });
    });
    line(ui, ROW, |ui| show_pages(ui, &mut lab.page));
    ui.add_space(STEP);
    if lab.steps.is_none() {
        return;
    }
    scroll_area(("lab controls", lab.page as usize)).show(ui, |ui| {
        // The bar of the scroll has room of its own: nothing lies under it.
        ui.set_max_width(ui.available_width() - 10.0);
        match lab.page {
            Page::Recipe => {
                for (place, value) in recipe::show(ui, lab) {
                    lab.set(place, value, bench.pointer.moment);
                    ui.ctx().request_repaint();
                }
            }
            Page::Family => family::show(ui, lab, bench),
            Page::Keep => keep::show(ui, lab, bench),
        }
        ui.add_space(2.0 * STEP);
    });
}

/// What a recipe can begin with; says what was chosen.
fn show_beginnings(ui: &mut Ui, libraries: &LibraryView) -> Option<Beginning> {
    let mut chosen = None;
    let mut begin = |ui: &mut Ui, beginning: Beginning| {
        chosen = Some(beginning);
        ui.close();
    };
    let menu = ui.menu_button("Begin with", |ui| {
        ui.set_min_width(200.0);
        for &(kind, name) in RECIPES {
            if ui.button(format!("Example: {name}")).clicked() {
                begin(ui, Beginning::Example(kind));
            }
        }
        ui.separator();
        ui.menu_button("A copy of", |ui| {
            if let Some(id) = list(ui, "copy", libraries) {
                begin(ui, Beginning::Copy(id));
            }
        });
        ui.menu_button("Restored from", |ui| {
            if let Some(id) = list(ui, "restore", libraries) {
                begin(ui, Beginning::Restore(id));
            }
        });
    });
    menu.response.on_hover_text(
        "An example, a copy of a textile of the library, or what repeats in its profiles",
    );
    chosen
}

/// The textiles of all libraries that can be read; says which one was chosen.
fn list(ui: &mut Ui, salt: &str, libraries: &LibraryView) -> Option<String> {
    let mut chosen = None;
    let area = ScrollArea::vertical().id_salt(salt).max_height(LIST);
    area.show(ui, |ui| {
        ui.set_min_width(220.0);
        for item in libraries.all_items().filter(|item| item.flaw.is_none()) {
            let tip = format!("{}\nIn: {}", item.kind, item.home);
            if ui.button(&item.name).on_hover_text(tip).clicked() {
                chosen = Some(item.id.clone());
            }
        }
    });
    chosen
}

fn show_steps(ui: &mut Ui, lab: &mut Lab) {
    let steps = lab.steps.as_ref();
    let list = steps.map(Steps::list).unwrap_or_default();
    let is_changed = steps.is_some_and(|steps| steps.recipe.draft != steps.recipe.first);
    // From the right.
    let start = is_changed.then(|| "Back to the start".to_owned());
    let redo = list.redo().map(|step| format!("Redo in the lab: {step}"));
    let undo = list.undo().map(|step| format!("Undo in the lab: {step}"));
    let mut chosen = None;
    for (sign, name, tip, to) in [
        ("Start", "Back to the start", start, None),
        ("Redo", "Redo in the lab", redo, Some(list.n_done + 1)),
        ("Undo", "Undo in the lab", undo, list.n_done.checked_sub(1)),
    ] {
        let can = tip.is_some();
        let response = ui.add_enabled(can, egui::Button::new(sign).min_size(vec2(26.0, ROW)));
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, can, name));
        let response = response
            .on_disabled_hover_text("Nothing has changed")
            .on_hover_text(tip.unwrap_or_default());
        if response.clicked() {
            chosen = Some(to);
        }
    }
    match chosen {
        Some(Some(n_done)) => lab.go_to(n_done),
        Some(None) => lab.restart(),
        None => {}
    }
}

/// What is edited: the name of the recipe and its kind.
pub(crate) fn show_name(ui: &mut Ui, steps: Option<&Steps>) {
    let Some(manifest) = steps.and_then(|steps| steps.recipe.first.read().ok()) else {
        return;
    };
    let kind = manifest.source.kind();
    let words = format!("{} · {kind}", manifest.name);
    let text = small(&words, Palette::in_ui(ui).text);
    let tip = "What the recipe began with";
    ui.label(text).on_hover_text(tip);
    ui.add_space(2.0 * STEP);
}

fn show_pages(ui: &mut Ui, shown: &mut Page) {
    let palette = Palette::in_ui(ui);
    for (page, title) in Page::ALL {
        let is_shown = page == *shown;
        let ink = if is_shown { palette.text } else { palette.dim };
        let text = RichText::new(title).font(theme::body()).color(ink);
        let tab = egui::Button::new(text).frame_when_inactive(false);
        let response = ui.add(tab);
        let label = format!("{title} page");
        response.widget_info(|| WidgetInfo::selected(egui::Role::Tab, true, is_shown, &label));
        if is_shown {
            let line = egui::Stroke::new(1.5, palette.selection);
            let foot = response.rect.bottom();
            ui.painter()
                .hline(response.rect.x_range().shrink(6.0), foot, line);
        }
        if response.clicked() {
            *shown = page;
        }
    }
}

/// What the recipe is compared with.
pub(crate) fn show_compared(ui: &mut Ui, lab: &mut Lab, bench: &Bench) {
    ui.label(quiet("compare with"));
    let compared = lab.compared.as_ref();
    let name = compared.map_or("nothing", |compared| compared.name.as_str());
    let combo = ComboBox::from_id_salt("lab compared")
        .width(170.0)
        .truncate();
    let (mut is_none_wanted, mut wanted) = (false, None);
    let response = combo
        .selected_text(RichText::new(name).font(theme::small()))
        .show_ui(ui, |ui| {
            is_none_wanted = ui.selectable_label(compared.is_none(), "nothing").clicked();
            let items = bench.library.view.all_items();
            for item in items.filter(|item| item.flaw.is_none()) {
                let is_chosen = compared.is_some_and(|compared| compared.id == item.id);
                if ui.selectable_label(is_chosen, &item.name).clicked() {
                    wanted = Some(item.id.clone());
                }
            }
        })
        .response;
    if is_none_wanted {
        lab.compared = None;
    }
    if let Some(id) = wanted {
        lab.compare_with(bench, id);
    }
    named(&response, "Compared with");
    let tip = "A textile of the library, drawn as a thin grey curve";
    response.on_hover_text(tip);
}
