//! What is to go wrong with the emulator: every option of the command line as a row, and the button
//! that starts it anew.

use eframe::egui::{self, Align, Layout, Margin, RichText, TextEdit, Ui};

use crate::bench::command::Commands;
use crate::bench::command::device::DeviceCommand;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{button, choice, field_row, named, paragraph, quiet, row, small};
use crate::kit::widgets::{fold, list};
use selvedge_device::{FaultGroup, FaultKind, FaultOption, FaultWords};

/// Width of a field, points.
const FIELD: f32 = 116.0;
/// Width of the list of presets, points.
const LIST: f32 = 168.0;

/// Faults that are worth a try together: a name, and options with their texts.
pub(crate) const PRESETS: [(&str, &[(&str, &str)]); 6] = [
    ("None", &[]),
    (
        "Adapter with a timer",
        &[("latency", "ftdi"), ("hiccup", "0.1%:50ms")],
    ),
    (
        "Bad cable",
        &[("drop", "0.01%"), ("flip", "0.01%"), ("lose-usb", "0.1%")],
    ),
    (
        "Clock off its pace",
        &[("clock-ppm", "100"), ("tick-jitter", "2ms")],
    ),
    (
        "Device that stalls",
        &[
            ("stall-reading-at", "5s,20s"),
            ("stall-writing-at", "10s"),
            ("reboot-at", "30s"),
        ],
    ),
    ("Wired wrongly", &[("dead", "3"), ("swap", "5,6")]),
];

/// What matters while the part is folded away: what goes wrong now, and whether something else was
/// chosen since.
pub(crate) fn summary(running: &FaultWords, chosen: &FaultWords) -> String {
    let waits = if running == chosen || chosen.n_faults() == 0 {
        ""
    } else {
        "; others chosen"
    };
    format!("{}{waits}", described(running))
}

/// How many faults, and where chance begins.
fn described(words: &FaultWords) -> String {
    let n = words.n_faults();
    let seed = words.faults().map_or(0, |faults| faults.seed);
    match n {
        0 => "none".to_owned(),
        1 => format!("1 fault, seed {seed}"),
        n => format!("{n} faults, seed {seed}"),
    }
}

/// Shows the part: what is chosen for the next start.
pub(crate) fn show(ui: &mut Ui, chosen: &mut FaultWords, commands: &mut Commands) {
    show_presets(ui, chosen);
    show_group(ui, FaultGroup::All, chosen);
    show_start(ui, chosen, commands);
    for group in FaultGroup::ALL {
        if group != FaultGroup::All {
            let summary = said_in(group, chosen);
            fold(ui, (group.name(), false), &summary, |ui| {
                show_group(ui, group, chosen);
                show_note(ui, group);
            });
        }
    }
}

fn show_presets(ui: &mut Ui, chosen: &mut FaultWords) {
    let now = PRESETS.iter().find(|(_, pairs)| is_preset(chosen, pairs));
    let now = now.map_or("your own", |(name, _)| name);
    row(ui, "Preset", |ui| {
        list(ui, ("fault preset", "Preset of faults"), LIST, now, |ui| {
            for (name, pairs) in PRESETS {
                let words: Vec<String> = pairs
                    .iter()
                    .map(|(option, text)| format!("{option} {text}"))
                    .collect();
                let detail = words.join(", ");
                let tip = "Choose these; nothing goes wrong before they are started";
                if choice(ui, RichText::new(name), &detail, tip) {
                    *chosen = preset(chosen, pairs);
                    ui.close();
                }
            }
        });
    })
    .on_hover_text("Faults that are worth a try together");
}

/// A preset with the seed and the way that were chosen.
fn preset(chosen: &FaultWords, pairs: &[(&str, &str)]) -> FaultWords {
    let mut words = FaultWords::of(pairs);
    for (option, text) in chosen.said() {
        if option.group == FaultGroup::All {
            words.say(option, text);
        }
    }
    words
}

fn is_preset(chosen: &FaultWords, pairs: &[(&str, &str)]) -> bool {
    preset(chosen, pairs) == *chosen
}

/// What is said in a group: `drop 0.1%, chatter`.
fn said_in(group: FaultGroup, chosen: &FaultWords) -> String {
    let said = chosen.said().filter(|(option, _)| option.group == group);
    let words = said.map(|(option, text)| match option.kind {
        FaultKind::Switch => option.name.to_owned(),
        FaultKind::One | FaultKind::Many => format!("{} {text}", option.name),
    });
    words.collect::<Vec<_>>().join(", ")
}

fn show_group(ui: &mut Ui, group: FaultGroup, chosen: &mut FaultWords) {
    for option in FaultOption::ALL.iter().filter(|one| one.group == group) {
        if option.kind == FaultKind::Switch {
            show_switch(ui, option, chosen);
        } else {
            show_field(ui, option, chosen);
        }
    }
}

fn show_switch(ui: &mut Ui, option: &FaultOption, chosen: &mut FaultWords) {
    let mut is_on = !chosen.text(option).is_empty();
    let response = ui.checkbox(&mut is_on, option.label);
    if response.on_hover_text(option.help).changed() {
        chosen.say(option, if is_on { FaultWords::ON } else { "" });
    }
}

fn show_field(ui: &mut Ui, option: &FaultOption, chosen: &mut FaultWords) {
    let palette = Palette::in_ui(ui);
    let mut text = chosen.text(option).to_owned();
    let tip = format!("{}\nFor example {}", option.help, option.example);
    field_row(ui, option.label, |ui| {
        let hint = match option.usual {
            "" if option.group == FaultGroup::Channels => "none",
            "" => "never",
            usual => usual,
        };
        let hint = RichText::new(hint).font(theme::number()).color(palette.dim);
        let field = TextEdit::singleline(&mut text)
            .desired_width(FIELD)
            .font(theme::number())
            .margin(Margin::symmetric(6, 2))
            .hint_text(hint)
            .align(egui::Align2::RIGHT_CENTER);
        let response = ui.add(field);
        named(&response, option.label);
        if response.on_hover_text(&tip).changed() {
            chosen.say(option, &text);
        }
    })
    .on_hover_text(&tip);
    let said = chosen.text(option);
    if !said.is_empty()
        && let Err(why) = option.check(said)
    {
        paragraph(ui, small(&why, palette.text));
    }
}

/// What is otherwise here than on a command line.
fn show_note(ui: &mut Ui, group: FaultGroup) {
    if group == FaultGroup::Stalls {
        let words = "Times count from the start: 5s, 5s+300ms for how long, 5s,20s for two. A \
                     cable that is pulled here ends the link: start again.";
        paragraph(ui, quiet(words));
    }
}

fn show_start(ui: &mut Ui, chosen: &FaultWords, commands: &mut Commands) {
    ui.add_space(STEP);
    let unread = chosen.faults().err();
    let refusal = unread.map(|(option, _)| format!("\"{}\" cannot be read", option.label));
    let word = if chosen.n_faults() == 0 {
        "Start without faults"
    } else {
        "Start with these faults"
    };
    let tip = "Connect to the emulator anew: whatever it plays ends, and it is not armed";
    let layout = Layout::top_down(Align::Center).with_cross_justify(true);
    ui.with_layout(layout, |ui| {
        if button(ui, word, tip, refusal.as_deref()) {
            commands.push(DeviceCommand::StartFaults(chosen.clone()).into());
        }
    });
    ui.add_space(STEP);
}

#[cfg(test)]
mod tests {
    use eframe::egui::accesskit::Role;

    use super::*;
    use crate::bench::command::Command;
    use crate::bench::view::BridgePhase;
    use crate::tools::bridge::tests::{Stage, click, window};
    use egui_kittest::kittest::Queryable as _;

    fn stage(pairs: &[(&str, &str)]) -> Stage {
        let mut stage = Stage::new(BridgePhase::Ready);
        stage.bridge.faults = FaultWords::of(pairs);
        stage
    }

    #[test]
    fn every_preset_is_read_whole_and_none_is_none() {
        for (name, pairs) in PRESETS {
            let words = FaultWords::of(pairs);
            assert_eq!(words.n_faults(), pairs.len(), "{name}");
            let faults = words.faults().unwrap();
            faults.check(24).unwrap();
            assert_eq!(faults.is_none(), pairs.is_empty(), "{name}");
        }
    }

    #[test]
    fn what_runs_is_told_beside_the_name_of_the_part() {
        let none = FaultWords::default();
        assert_eq!(summary(&none, &none), "none");
        let two = FaultWords::of(&[("seed", "7"), ("drop", "1%"), ("banner", "on")]);
        assert_eq!(summary(&two, &two), "2 faults, seed 7");
        assert_eq!(summary(&none, &two), "none; others chosen");
        let one = FaultWords::of(&[("dead", "3")]);
        assert_eq!(summary(&one, &none), "1 fault, seed 1");
    }

    #[test]
    fn every_option_of_the_command_line_has_its_row() {
        let mut harness = window(stage(&[]));
        click(&mut harness, Role::Button, "Link");
        click(&mut harness, Role::Button, "Faults");
        for group in FaultGroup::ALL {
            if group != FaultGroup::All {
                click(&mut harness, Role::Button, group.name());
            }
            for option in FaultOption::ALL.iter().filter(|one| one.group == group) {
                let role = match option.kind {
                    FaultKind::Switch => Role::CheckBox,
                    FaultKind::One | FaultKind::Many => Role::TextInput,
                };
                harness.get_by_role_and_label(role, option.label);
            }
            if group != FaultGroup::All {
                click(&mut harness, Role::Button, group.name());
            }
        }
    }

    #[test]
    fn what_is_typed_is_started_by_the_button_and_refused_while_it_cannot_be_read() {
        let mut harness = window(stage(&[("seed", "7")]));
        click(&mut harness, Role::Button, "Link");
        click(&mut harness, Role::Button, "Faults");
        let started = click(&mut harness, Role::Button, "Start without faults");
        let seed = FaultWords::of(&[("seed", "7")]);
        assert_eq!(started, [DeviceCommand::StartFaults(seed).into()]);
        click(&mut harness, Role::Button, "Bytes");
        click(&mut harness, Role::CheckBox, "Boot banner");
        click(&mut harness, Role::TextInput, "Drop");
        harness.event(egui::Event::Text("1%".to_owned()));
        harness.run();
        let started = click(&mut harness, Role::Button, "Start with these faults");
        let words = FaultWords::of(&[("seed", "7"), ("drop", "1%"), ("banner", "on")]);
        assert_eq!(started, [DeviceCommand::StartFaults(words).into()]);
        click(&mut harness, Role::TextInput, "Drop");
        harness.event(egui::Event::Text("x".to_owned()));
        harness.run();
        harness.get_by_label_contains("is no share");
        let none: [Command; 0] = [];
        assert_eq!(
            click(&mut harness, Role::Button, "Start with these faults"),
            none
        );
    }

    #[test]
    fn a_preset_leaves_the_seed_as_it_was() {
        let chosen = FaultWords::of(&[("seed", "7"), ("dead", "3")]);
        let words = preset(&chosen, PRESETS[0].1);
        assert_eq!(words, FaultWords::of(&[("seed", "7")]));
        assert!(is_preset(&words, PRESETS[0].1) && !is_preset(&chosen, PRESETS[0].1));
    }
}
