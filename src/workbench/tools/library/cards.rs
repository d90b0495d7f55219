//! What the library asks: a new name, and what becomes of a textile whose name is taken.

use eframe::egui::{Context, Id, Key, Modal, RichText, TextEdit, Ui};

use crate::bench::command::Commands;
use crate::bench::keep::{Keep, Taken, WhenTaken};
use crate::bench::library_acts::LibraryCommand;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{button, named};
use crate::tools::library::state::Library;

/// Width of a question, points.
const WIDTH: f32 = 420.0;
/// Most textiles that are named in a question.
const MOST_NAMED: usize = 4;

/// Shows what is asked.
pub(crate) fn show(ctx: &Context, state: &mut Library, context: &mut PaneContext<'_>) {
    if let Some(taken) = &context.bench.library.acts.taken {
        ask(ctx, "library taken", |ui| {
            show_taken(ui, taken, context.commands);
        });
    }
    if let Some((key, mut name)) = state.renaming.take() {
        let mut is_over = false;
        ask(ctx, "library rename", |ui| {
            is_over = show_renaming(ui, (&key, &mut name), context.commands);
        });
        state.renaming = (!is_over).then_some((key, name));
    }
}

fn ask(ctx: &Context, salt: &str, content: impl FnOnce(&mut Ui)) {
    Modal::new(Id::unique(salt)).show(ctx, |ui| {
        ui.set_width(WIDTH);
        content(ui);
    });
}

/// Says whether the question is over.
fn show_renaming(ui: &mut Ui, (key, name): (&str, &mut String), commands: &mut Commands) -> bool {
    ui.label(RichText::new("Rename the textile").font(theme::title()));
    ui.add_space(STEP);
    let field = ui.add(TextEdit::singleline(name).desired_width(f32::INFINITY));
    named(&field, "New name");
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if !field.has_focus() && !is_entered {
        field.request_focus();
    }
    ui.add_space(2.0 * STEP);
    let refusal = name.trim().is_empty().then_some("Type a name first");
    let mut is_over = false;
    ui.horizontal(|ui| {
        let tip = "Its id stays, so that scenes find it";
        let is_wanted = button(ui, "Rename", tip, refusal) || (is_entered && refusal.is_none());
        if is_wanted {
            commands.push(LibraryCommand::Rename(key.to_owned(), name.clone()).into());
        }
        is_over = is_wanted || button(ui, "Cancel", "Leave the name as it is", None);
    });
    is_over
}

fn show_taken(ui: &mut Ui, taken: &Taken, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let n = taken.there.len();
    let names = taken.there.iter().take(MOST_NAMED);
    let mut names: Vec<String> = names
        .map(|[name, id]| format!("“{name}” (id {id})"))
        .collect();
    if n > MOST_NAMED {
        names.push(format!("{} more", n - MOST_NAMED));
    }
    let title = format!("{} has {} already", taken.home, names.join(", "));
    ui.label(RichText::new(title).font(theme::title()));
    ui.add_space(STEP);
    let words = "What is replaced stays as an earlier version and can be had back.";
    ui.colored_label(palette.dim, words);
    ui.add_space(2.0 * STEP);
    ui.horizontal(|ui| {
        let tip = "The new one takes its place, in every scene that uses it";
        if button(ui, "Replace", tip, None) {
            commands.push(answered(taken, WhenTaken::Replace).into());
        }
        let tip = "The new one gets a number after its name and its id";
        if button(ui, "Keep both", tip, None) {
            commands.push(answered(taken, WhenTaken::KeepBoth).into());
        }
        if button(ui, "Cancel", "Keep nothing", None) {
            commands.push(LibraryCommand::ForgetKeep.into());
        }
    });
}

fn answered(taken: &Taken, answer: WhenTaken) -> LibraryCommand {
    LibraryCommand::Keep(Keep {
        when_taken: Some(answer),
        ..taken.keep.clone()
    })
}
