//! What the library asks: whether a new textile that is listened to is kept, what becomes of one
//! whose name is taken, and a new name.

use std::sync::Arc;

use eframe::egui::{Align2, Context, Id, Key, Label, Modal, RichText, TextEdit, Ui, Window, vec2};

use crate::bench::command::Commands;
use crate::bench::keep::{Keep, Listening, Taken, WhenTaken};
use crate::bench::library_acts::LibraryCommand;
use crate::bench::tool::PaneContext;
use crate::bench::view::LibraryEntry;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{LINE, Need, choose, form_line};
use crate::kit::widgets::text::{button, named, quiet, toggle};
use crate::tools::library::state::Library;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Width of a question, points.
const WIDTH: f32 = 420.0;
/// Most textiles that are named in a question.
const MOST_NAMED: usize = 4;

/// Width of the name of a textile that is compared, points.
const NAME: f32 = 180.0;

/// Shows what is asked.
pub(crate) fn show(ctx: &Context, state: &mut Library, context: &mut PaneContext<'_>) {
    if let Some(listening) = &context.bench.library.acts.listening {
        let items = context.bench.library.view.shared_items();
        let title = match &listening.textiles[..] {
            [one] => format!("Keep “{}”?", one.name),
            all => format!("Keep {} textiles?", all.len()),
        };
        // The display is moved over the cloth meanwhile.
        Window::new(title)
            .id(Id::unique("library listen"))
            .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -8.0 * STEP))
            .resizable(false)
            .collapsible(false)
            .show(ctx, |ui| {
                ui.set_width(WIDTH);
                show_listening(ui, listening, &items, context.commands);
            });
    }
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

/// The new textile and two of the library, one of which is felt.
fn show_listening(
    ui: &mut Ui,
    listening: &Listening,
    items: &[LibraryEntry],
    commands: &mut Commands,
) {
    let words = "Felt wherever the scene has a textile: move the display and compare.";
    ui.label(quiet(words));
    let new = listening.new.as_ref().map(|(_, mean_um)| *mean_um);
    let compared = listening.references.iter().map(|id| {
        let item = items.iter().find(|item| Some(&item.id) == id.as_ref());
        item.map(|item| item.mean_um)
    });
    let all = [new].into_iter().chain(compared);
    for (nth, (mean_um, letter)) in all.zip(["A", "B", "C"]).enumerate() {
        form_line(ui, |ui| {
            let tip = format!("Feel {letter}");
            if toggle(ui, letter, listening.felt == nth, &tip) {
                commands.push(LibraryCommand::Feel(nth).into());
            }
            match nth.checked_sub(1) {
                None => {
                    let name = listening.textiles.first().map_or("", |one| &one.name);
                    ui.allocate_ui_with_layout(vec2(NAME, LINE), *ui.layout(), |ui| {
                        ui.set_min_width(NAME);
                        ui.add(Label::new(name).truncate());
                    });
                }
                Some(nth) => choose_reference(ui, (nth, listening), items, commands),
            }
            show_levels(ui, mean_um);
        });
    }
    ui.add_space(STEP);
    ui.horizontal(|ui| {
        for (name, tip, is_felt) in [
            (
                "Keep",
                "Write it into your own library, or into the scene’s",
                false,
            ),
            (
                "Keep and lay out",
                "And lay it into the scene where there is room",
                true,
            ),
        ] {
            if button(ui, name, tip, None) {
                let keep = Keep::of(Arc::clone(&listening.textiles), is_felt);
                commands.push(keep.into());
            }
        }
        if button(ui, "Cancel", "Keep nothing", None) {
            commands.push(LibraryCommand::ForgetKeep.into());
        }
    });
}

/// A40 and A320 of a textile, as soon as they are known.
fn show_levels(ui: &mut Ui, mean_um: Option<[f64; 2]>) {
    let tip = "Mean amplitude at 100 mm/s, re 1 µm, without gains";
    for band in Band::ALL {
        let level = mean_um.map(|um| quantity::level_db(um[band.index()]));
        let level = level.map_or_else(|| "–".to_owned(), |db| quantity::fixed(db, 1));
        let words = format!("A{} {level:>5} dB", band.carrier_hz());
        let ink = Palette::in_ui(ui).band(band);
        let words = RichText::new(words).font(theme::number()).color(ink);
        ui.label(words).on_hover_text(tip);
    }
}

/// A list of the library's textiles.
fn choose_reference(
    ui: &mut Ui,
    (nth, listening): (usize, &Listening),
    items: &[LibraryEntry],
    commands: &mut Commands,
) {
    let now = listening.references[nth].as_deref();
    let name = items.iter().find(|item| Some(item.id.as_str()) == now);
    let name = name.map_or("choose …", |item| item.name.as_str());
    let label = ["First to compare with", "Second to compare with"][nth];
    choose(ui, label, (name, NAME, Need::Optional), |ui| {
        for item in items.iter().filter(|item| item.flaw.is_none()) {
            if ui
                .selectable_label(now == Some(&item.id), &item.name)
                .clicked()
            {
                commands.push(LibraryCommand::CompareWith(nth, item.id.clone()).into());
            }
        }
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
