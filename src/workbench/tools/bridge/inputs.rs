//! What moves the display and how steadily, and who else hears of it: below the device.

use eframe::egui::{Align, Label, Layout, RichText, Ui};

use crate::bench::command::{Command, Commands};
use crate::bench::sources::{SourceCommand, SourcesView};
use crate::bench::view::{EngineView, InputView, Source};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{button, choice, paragraph, quiet_pairs, row};
use crate::tools::bridge::surface;
use selvedge_foundation::quantity;

/// How wide the menu of devices is, points.
const MENU: f32 = 288.0;

/// Shows the part of the pane that is about inputs.
pub(crate) fn show(ui: &mut Ui, live: &EngineView, sources: &SourcesView, commands: &mut Commands) {
    row(ui, "Moved by", |ui| {
        ui.menu_button("Choose…", |ui| show_menu(ui, sources, commands))
            .response
            .on_hover_text("Tablets, touch frames, and other programs of this machine");
    });
    if let Some(surface) = &sources.surface {
        surface::show(ui, surface, commands);
    }
    show_rate(ui, &live.input);
    show_programs(ui, sources);
}

/// What moves the display, in a few words.
pub(crate) fn word(live: &EngineView) -> &'static str {
    match live.play.source {
        Source::Device if live.input.is_lifted => "Tablet: lifted, silent",
        Source::Device => "Tablet",
        Source::Lines if live.input.is_lifted => "Another program: lifted, silent",
        Source::Lines => "Another program",
        Source::Pointer => "Pointer",
        Source::Stroke => "By itself",
        Source::Recording => "Recording",
    }
}

fn show_menu(ui: &mut Ui, sources: &SourcesView, commands: &mut Commands) {
    ui.set_width(MENU);
    if !sources.is_known && !sources.is_busy {
        commands.push(SourceCommand::List.into());
    }
    show_devices(ui, sources, commands);
    show_acts(ui, sources, commands);
}

fn show_devices(ui: &mut Ui, sources: &SourcesView, commands: &mut Commands) {
    for (path, described) in &sources.devices {
        let place = path.display().to_string();
        let tip = format!("Read {place} directly");
        if choice(
            ui,
            RichText::new(&place).font(theme::number()),
            described,
            &tip,
        ) {
            commands.push(SourceCommand::Device(path.clone()).into());
            ui.close();
        }
    }
    let nothing = (sources.devices.is_empty() && sources.is_known)
        .then(|| "No tablet or touch frame found".to_owned());
    if let Some(words) = sources.complaint.clone().or(nothing) {
        let ink = Palette::in_ui(ui).dim;
        ui.with_layout(Layout::top_down(Align::Min), |ui| {
            paragraph(ui, RichText::new(words).color(ink));
        });
    }
}

fn show_acts(ui: &mut Ui, sources: &SourcesView, commands: &mut Commands) {
    let mut act = |ui: &mut Ui, words: &str, tip: &str, act: SourceCommand, refusal| {
        if button(ui, words, tip, refusal) {
            let is_last = act != SourceCommand::List;
            commands.push(Command::from(act));
            if is_last {
                ui.close();
            }
        }
    };
    let busy = sources.is_busy.then_some("Looking…");
    act(
        ui,
        "Look again",
        "List the devices anew",
        SourceCommand::List,
        busy,
    );
    ui.separator();
    if sources.programs.is_none() {
        let tip = "Listen on this machine: positions in, amplitudes out, as lines";
        act(
            ui,
            "Let other programs join",
            tip,
            SourceCommand::Listen,
            None,
        );
        return;
    }
    let tip = "The program that says positions moves the display";
    act(ui, "Follow the program", tip, SourceCommand::Program, None);
    let tip = "Let go of every program that joined";
    act(
        ui,
        "End the link to programs",
        tip,
        SourceCommand::EndListening,
        None,
    );
}

fn show_rate(ui: &mut Ui, input: &InputView) {
    let rate = &input.rate;
    let known = |digits: String| {
        if rate.rate_hz > 0.0 {
            digits
        } else {
            "–".to_owned()
        }
    };
    let rows = [
        [
            (
                "Rate",
                known(quantity::fixed(rate.rate_hz, 0)),
                "Hz",
                "Positions a second while it moves: one over the usual interval",
            ),
            (
                "Jitter",
                known(quantity::fixed(rate.jitter_ms, 2)),
                "ms",
                "How far intervals lie from the usual one, 95 of 100",
            ),
        ],
        [
            (
                "Gaps",
                rate.dropouts.to_string(),
                "",
                "Times that positions failed to come in the middle of a movement",
            ),
            (
                "Dropped",
                input.n_lost.to_string(),
                "",
                "Positions that found no room, and lines that were none",
            ),
        ],
    ];
    for row in rows {
        quiet_pairs(ui, row);
    }
}

fn show_programs(ui: &mut Ui, sources: &SourcesView) {
    let Some((address, counts)) = &sources.programs else {
        return;
    };
    let role = if counts.has_writer { ", one moves" } else { "" };
    let words = format!("{address}: {}{role}", counts.connected);
    row(ui, "Programs", |ui| {
        let text = RichText::new(words).font(theme::number());
        ui.add(Label::new(text).truncate()).on_hover_text(format!(
            "Where programs join, and how many have; {} read too slowly and were let go",
            counts.let_go
        ));
    });
}
