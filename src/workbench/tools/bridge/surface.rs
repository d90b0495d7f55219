//! Where the surface of a tablet lies in the workspace: four lengths, kept for each kind of tablet.

use eframe::egui::{self, Align2, Margin, Ui};

use crate::bench::command::Commands;
use crate::bench::sources::{SourceCommand, SurfaceView};
use crate::kit::widgets::fields::typed_field;
use crate::kit::widgets::text::{button, field_row, quiet};
use selvedge_foundation::quantity;

/// Width of a number, points.
const FIELD: f32 = 56.0;

/// Shows where it is; what is typed takes effect when its field is left.
pub(crate) fn show(ui: &mut Ui, surface: &SurfaceView, commands: &mut Commands) {
    let [x_mm, y_mm, width_mm, height_mm] = surface.area_mm;
    let tip = "How much of the workspace the tablet's whole surface covers; a tablet that states \
               its resolution is true to size at first";
    let size = pair(
        ui,
        ("Area", "×", tip),
        [
            ("Width of the area", width_mm),
            ("Height of the area", height_mm),
        ],
    );
    let tip = "Where its lower left corner lies, counted from that of the workspace";
    let corner = pair(
        ui,
        ("From the left and below", "", tip),
        [("Area from the left", x_mm), ("Area from below", y_mm)],
    );
    let [width, height] = size;
    let [x, y] = corner;
    if [&x, &y, &width, &height].into_iter().any(Option::is_some) {
        let now = surface.area_mm;
        let typed = [x, y, width, height].into_iter().zip(now);
        let texts = typed.map(|(text, mm)| text.unwrap_or_else(|| mm.to_string()));
        let texts: Vec<String> = texts.collect();
        let name = surface.name.clone();
        commands.push(SourceCommand::Area(name, Some(texts.join(","))).into());
    }
    field_row(ui, "", |ui| {
        let refusal = (!surface.is_own).then_some("Nothing was changed of it");
        let tip = "Where the surface usually lies: in the middle, true to size if the tablet \
                   states that";
        if button(ui, "As at first", tip, refusal) {
            commands.push(SourceCommand::Area(surface.name.clone(), None).into());
        }
        let name = quiet(&surface.name);
        ui.add(egui::Label::new(name).truncate());
    });
}

/// A row of two lengths; the texts of those that were changed.
fn pair(
    ui: &mut Ui,
    (name, between, tip): (&str, &str, &str),
    fields: [(&str, f64); 2],
) -> [Option<String>; 2] {
    let mut changed = [None, None];
    field_row(ui, name, |ui| {
        ui.label(quiet("mm"));
        // From right to left.
        changed[1] = length(ui, fields[1]);
        if !between.is_empty() {
            ui.label(quiet(between));
        }
        changed[0] = length(ui, fields[0]);
    })
    .on_hover_text(tip);
    changed
}

/// A field that is read when it is left; Esc leaves it as it was.
fn length(ui: &mut Ui, (name, mm): (&str, f64)) -> Option<String> {
    let id = ui.scope_id().with(("surface", name));
    let now = quantity::fixed(mm, 1);
    let typed = typed_field(ui, id, (name, &now), |edit| {
        edit.desired_width(FIELD)
            .margin(Margin::symmetric(6, 2))
            .align(Align2::RIGHT_CENTER)
    });
    typed.map(|text| text.replace('−', "-"))
}

#[cfg(test)]
mod tests {
    use eframe::egui::accesskit::Role;
    use eframe::egui::{Event, Key};

    use super::*;
    use crate::bench::view::BridgePhase;
    use crate::tools::bridge::tests::{Stage, click, window};

    fn stage(is_own: bool) -> Stage {
        let mut stage = Stage::new(BridgePhase::Ready);
        stage.sources.surface = Some(SurfaceView {
            name: "Pen tablet".to_owned(),
            area_mm: [22.0, 62.5, 216.0, 135.0],
            is_own,
        });
        stage
    }

    #[test]
    fn a_width_that_is_typed_is_asked_for_with_the_rest_as_it_was() {
        let mut harness = window(stage(false));
        click(&mut harness, Role::Button, "Link");
        click(&mut harness, Role::Button, "Input");
        click(&mut harness, Role::TextInput, "Width of the area");
        harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
        harness.event(Event::Text("100".to_owned()));
        harness.run();
        harness.state_mut().clear();
        harness.key_press(Key::Enter);
        harness.run();
        let area = Some("22,62.5,100,135".to_owned());
        let wanted = SourceCommand::Area("Pen tablet".to_owned(), area);
        assert_eq!(harness.state(), &[wanted.into()]);
    }

    #[test]
    fn what_was_changed_goes_back_by_a_button() {
        let mut harness = window(stage(true));
        click(&mut harness, Role::Button, "Link");
        click(&mut harness, Role::Button, "Input");
        let back = click(&mut harness, Role::Button, "As at first");
        let wanted = SourceCommand::Area("Pen tablet".to_owned(), None);
        assert_eq!(back, [wanted.into()]);
    }
}
