//! The line at the bottom: how many, how far measuring is, what can be done with what is selected.

use eframe::egui::{Align, Label, Layout, ProgressBar, RichText, Role, Ui, WidgetInfo, vec2};

use crate::bench::command::edit::Edit;
use crate::bench::library_selection::Joining;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::toggle;
use crate::tools::collection::state::{CollectionView, Mode};
use crate::tools::collection::view::hand::Hand;

/// Width of the bar, points.
const BAR: f32 = 96.0;

/// Shows the line.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let size = ui.available_size();
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        show_adding(ui, view, hand);
        show_progress(ui, view, hand);
        let words = RichText::new(words(view)).font(theme::small());
        let line = Layout::left_to_right(Align::Center);
        ui.with_layout(line, |ui| {
            ui.add(Label::new(words.color(Palette::in_ui(ui).dim)).truncate());
        });
    });
}

fn show_adding(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let usable = view.selected().filter(|one| one.item.flaw.is_none());
    let ids: Vec<String> = usable.map(|one| one.item.id.clone()).collect();
    let tip = if ids.is_empty() {
        "Select textiles first: click one, or drag a frame around some"
    } else {
        "Place what is selected side by side where there is room"
    };
    ui.add_enabled_ui(!ids.is_empty(), |ui| {
        if toggle(ui, "add to the scene", false, tip) {
            hand.commands.push(Edit::AddCloths(ids).into());
        }
    });
    if view.n_selected > 0 && toggle(ui, "none", false, "Select nothing") {
        hand.select(Vec::new(), Joining::Alone);
    }
}

fn show_progress(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    if view.is_halted && toggle(ui, "go on", false, "Go on measuring the library") {
        hand.halts = Some(false);
    }
    let Some(n_done) = view.progress else {
        return;
    };
    if toggle(ui, "stop", false, "Stop measuring the library") {
        hand.halts = Some(true);
    }
    let share = n_done as f32 / view.items.len().max(1) as f32;
    let (bar, _) = ui.allocate_exact_size(vec2(BAR, STEP), eframe::egui::Sense::hover());
    let progress = ProgressBar::new(share)
        .desired_height(STEP)
        .fill(Palette::in_ui(ui).line);
    let response = ui.put(bar, progress);
    let name = "Measuring the library";
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, name));
}

/// `12 of 74 textiles, 3 selected · 2 without SMD`.
fn words(view: &CollectionView<'_>) -> String {
    let (n_shown, n_all) = (view.entries.len(), view.items.len());
    let mut words = if n_shown == n_all {
        format!("{n_all} textiles")
    } else {
        format!("{n_shown} of {n_all} textiles")
    };
    if view.n_selected > 0 {
        words = format!("{words}, {} selected", view.n_selected);
    }
    if let Some(n_done) = view.progress {
        return format!("{words} · measured {n_done} of {n_all}");
    }
    if view.choice.mode == Mode::Plot && !view.is_halted {
        let (is_tuned, axes) = (view.choice.is_tuned, &view.choice.axes);
        for (index, axis) in axes.iter().enumerate() {
            let has_none = |one: &&crate::tools::collection::state::Entry<'_>| {
                one.value(axis, is_tuned).is_none()
            };
            let n_without = view.entries.iter().filter(has_none).count();
            if n_without > 0 && (index == 0 || axes[0] != axes[1]) {
                words = format!("{words} · {n_without} without {}", axis.name());
            }
        }
    }
    words
}
