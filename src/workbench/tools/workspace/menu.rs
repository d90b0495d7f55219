//! The menu under the right button (or a long press): about a textile, or about the ground.

use eframe::egui::{Button, Ui};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, Commands, Look, Part, ShowCommand};
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::{arrange, tools};

/// Shows the menu while it is open. What it is about is settled when it opens.
pub(crate) fn show(ui: &Ui, stage: &Stage<'_>, commands: &mut Commands) {
    let id = stage.response.id.with("menu is about");
    // A finger that rests while it feels asks for nothing.
    if !stage.arranges() && stage.response.long_touched() {
        return;
    }
    if stage.response.secondary_clicked()
        && let Some(at) = stage.response.interact_pointer_pos()
    {
        let hit = arrange::topmost(&stage.sight.scene.cloths, stage.view.workspace(at));
        ui.data_mut(|data| data.insert_temp(id, hit));
        if stage.arranges() && hit.is_some() {
            commands.push(ShowCommand::SelectCloth(hit).into());
        }
    }
    stage.response.context_menu(|ui| {
        let about = ui.data(|data| data.get_temp::<Option<usize>>(id)).flatten();
        match about.filter(|index| *index < stage.sight.scene.cloths.len()) {
            Some(index) => show_cloth(ui, stage, index, commands),
            None => show_ground(ui, stage),
        }
    });
}

fn show_cloth(ui: &mut Ui, stage: &Stage<'_>, index: usize, commands: &mut Commands) {
    let top = stage.sight.scene.cloths.len().saturating_sub(1);
    let is_muted = |cloth: &crate::bench::view::Cloth| cloth.is_muted;
    let part = Part::Cloth(index);
    if entry(
        ui,
        "Mute",
        stage.sight.scene.cloths.get(index).is_some_and(is_muted),
        &mute(part),
    ) {
        commands.push(mute(part));
    }
    if entry(ui, "Solo", false, &ShowCommand::Solo(part).into()) {
        commands.push(ShowCommand::Solo(part).into());
    }
    if stage.sight.scene.cloths.iter().any(is_muted)
        && entry(ui, "Feel everything", false, &ShowCommand::HearAll.into())
    {
        commands.push(ShowCommand::HearAll.into());
    }
    ui.separator();
    let raise = Edit::RaiseCloth(index).into();
    let is_below = index < top;
    ui.add_enabled_ui(is_below, |ui| {
        if entry(ui, "Raise to top", false, &raise) {
            commands.extend(tools::raising(index, top));
        }
    });
    if entry(ui, "Remove", false, &Edit::RemoveCloth(index).into()) {
        commands.extend(tools::removing(index));
    }
}

fn mute(part: Part) -> Command {
    ShowCommand::Mute(part).into()
}

fn show_ground(ui: &mut Ui, stage: &Stage<'_>) {
    for (name, look) in [("Fit", Look::Fit), ("True size", Look::TrueSize)] {
        if entry(ui, name, false, &ShowCommand::Look(look).into()) {
            stage.look(look);
        }
    }
    if entry(ui, "Calibrate…", false, &ShowCommand::Calibrate.into()) {
        stage.change(|view, _| view.is_calibrating = true);
    }
}

/// An entry with its key on the right.
fn entry(ui: &mut Ui, name: &str, is_chosen: bool, command: &Command) -> bool {
    let key = crate::bench::keys::hint(ui.ctx(), command);
    let button = Button::selectable(is_chosen, name).shortcut_text(key);
    let is_clicked = ui.add(button).clicked();
    if is_clicked {
        ui.close();
    }
    is_clicked
}
