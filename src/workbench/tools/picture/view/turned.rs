//! Further pictures of the cloth, turned under the same lamp: how each lies over the first.

use eframe::egui::Ui;

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::kit::theme::STEP;
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::text::button;
use crate::tools::picture::draft::Draft;
use crate::tools::picture::found::Found;
use selvedge_textile::picture::Turned;

/// Shows them, and adds and removes them.
pub(crate) fn show(ui: &mut Ui, draft: &mut Draft, found: Option<&Found>, commands: &mut Commands) {
    let is_same = |found: &&Found| found.inputs.has_same_turned(draft);
    let laid = found
        .filter(is_same)
        .and_then(|found| found.turned.as_deref());
    let mut removed = None;
    for (i, file) in draft.turned.iter().enumerate() {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            let tip = format!("Leave {} out", file.name());
            if button(ui, "Remove", &tip, None) {
                removed = Some(i);
            }
            match laid.and_then(|laid| laid.get(i)) {
                Some(Ok((one, kept))) => note(ui, &one.words(&kept.picture), Tone::Quiet),
                Some(Err(line)) => note(ui, line, Tone::Wrong),
                None => note(ui, &format!("{}: looked for …", file.name()), Tone::Quiet),
            }
        });
    }
    if let Some(i) = removed {
        draft.turned.remove(i);
    }
    let refusal = (draft.turned.len() >= Turned::MAX).then_some("Up to three are used");
    let tip = "The same cloth turned by any angle under the same lamp: height, colour and the \
               light’s direction are then found together";
    if button(ui, "Add a turned picture…", tip, refusal) {
        commands.push(FileCommand::Ask(Purpose::AddTurned).into());
    }
}
