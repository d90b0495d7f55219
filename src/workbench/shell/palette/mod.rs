//! The palette: one field that finds every act with its key, every pane, every textile of all
//! libraries and every recording.

mod found;

use eframe::egui::{
    self, Align, EventFilter, Key, Layout, Modifiers, Rect, RichText, ScrollArea, Sense, TextEdit,
    Ui, WidgetInfo, vec2,
};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands};
use crate::kit::theme;
use crate::kit::theme::{Palette as Colours, ROW, STEP};
use crate::kit::widgets::card;
use crate::kit::widgets::text::quiet;
use crate::shell::palette::found::{Found, found};

/// Width of the card, points.
const WIDTH: f32 = 640.0;
/// Height of the list at most, points.
const LIST: f32 = 420.0;
/// What the card needs besides the list, points.
const AROUND: f32 = 160.0;

/// What is sought, and which of what was found is chosen.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Palette {
    sought: String,
    chosen: usize,
}

/// Shows the palette at the upper edge of `over`.
pub(crate) fn show(
    ui: &Ui,
    over: Rect,
    palette: &mut Palette,
    bench: &mut Bench,
    commands: &mut Commands,
) {
    bench.open_all_libraries();
    card(
        ui,
        over,
        WIDTH,
        "Find an act, a textile or a recording",
        |ui, title| {
            let field = TextEdit::singleline(&mut palette.sought)
                .desired_width(f32::INFINITY)
                .hint_text("What it is called");
            let response = ui.add(field).labelled_by(title.id);
            if !response.has_focus() {
                response.request_focus();
            }
            let arrows = EventFilter {
                vertical_arrows: true,
                ..EventFilter::default()
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
            if response.changed() {
                palette.chosen = 0;
            }
            let found = found(&palette.sought, bench);
            let last = found.len().saturating_sub(1);
            let has_moved = palette.step(ui, last);
            ui.add_space(STEP);
            if found.is_empty() {
                ui.label("Nothing by that name: try fewer letters");
            }
            let height = LIST.min(over.height() - AROUND).max(2.0 * ROW);
            ScrollArea::vertical().max_height(height).show(ui, |ui| {
                for (nth, one) in found.iter().enumerate() {
                    let is_chosen = nth == palette.chosen;
                    let line = show_line(ui, one, is_chosen);
                    if is_chosen && has_moved {
                        line.scroll_to_me(None);
                    }
                    if line.clicked() {
                        choose(one, commands);
                    }
                }
            });
            if ui.input(|input| input.key_pressed(Key::Enter))
                && let Some(one) = found.get(palette.chosen)
            {
                choose(one, commands);
            }
        },
    );
}

fn choose(one: &Found, commands: &mut Commands) {
    commands.extend([Command::Dismiss, one.command.clone()]);
}

impl Palette {
    /// Moves the choice by the arrow keys; says whether it did.
    fn step(&mut self, ui: &Ui, last: usize) -> bool {
        let before = self.chosen;
        let n = |key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key));
        let down = self.chosen + n(Key::ArrowDown);
        self.chosen = down.saturating_sub(n(Key::ArrowUp)).min(last);
        self.chosen != before
    }
}

/// A line: what it is, of which kind, and its key.
fn show_line(ui: &mut Ui, one: &Found, is_chosen: bool) -> egui::Response {
    let colours = Colours::in_ui(ui);
    let size = vec2(ui.available_width(), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(egui::Role::ListBoxOption, true, is_chosen, &one.what)
    });
    if is_chosen || response.hovered() {
        ui.painter().rect_filled(rect, 3, colours.hovered);
    }
    let inside = egui::UiBuilder::new().max_rect(rect.shrink2(vec2(8.0, 0.0)));
    let mut ui = ui.new_child(inside.layout(Layout::right_to_left(Align::Center)));
    let key = RichText::new(&one.keys).font(theme::small_number());
    ui.label(key.color(colours.text));
    ui.label(quiet(&one.kind));
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        let what = RichText::new(&one.what).color(colours.text);
        ui.add(egui::Label::new(what).truncate().selectable(false));
    });
    response
}

#[cfg(test)]
mod tests {
    use eframe::egui::Event;

    use super::*;
    use crate::bench::command::ShowCommand;
    use crate::shell::headless::Headless;
    use crate::shell::state::Cover;

    fn type_into(window: &mut Headless, text: &str) {
        window.events.push(Event::Text(text.to_owned()));
        window.pass(2);
    }

    fn window() -> Headless {
        let mut window = Headless::shipped();
        window.pass(2);
        window.press(Modifiers::COMMAND, Key::K);
        assert!(window.workbench.shell.cover.is_some());
        window
    }

    #[test]
    fn an_act_is_found_by_some_letters_and_done_by_enter() {
        let mut window = window();
        type_into(&mut window, "cal true");
        window.press(Modifiers::NONE, Key::Enter);
        assert!(window.workbench.shell.cover.is_none(), "it closed");
        let mut tools = window.workbench.tools.iter();
        assert!(
            tools.any(|tool| tool.is_open(&window.workbench.bench)),
            "calibrating"
        );
    }

    #[test]
    fn a_textile_of_another_library_is_found_and_laid_into_the_scene() {
        let mut window = window();
        let n_before = window.workbench.scene().textiles.len();
        type_into(&mut window, "poplin");
        window.press(Modifiers::NONE, Key::Enter);
        window.pass(3);
        let textiles = &window.workbench.scene().textiles;
        assert_eq!(
            textiles.len(),
            n_before + 1,
            "{:?}",
            window.workbench.notices()
        );
        let last = &textiles.last().unwrap().id;
        assert!(last.contains("poplin"), "{last}");
    }

    #[test]
    fn the_arrows_choose_and_escape_closes() {
        let mut window = window();
        type_into(&mut window, "pane");
        window.press(Modifiers::NONE, Key::ArrowDown);
        window.press(Modifiers::NONE, Key::ArrowDown);
        window.press(Modifiers::NONE, Key::ArrowUp);
        let Some(Cover::Palette(palette)) = &window.workbench.shell.cover else {
            panic!("the palette is not shown")
        };
        assert_eq!(palette.chosen, 1);
        window.press(Modifiers::NONE, Key::Escape);
        assert!(window.workbench.shell.cover.is_none());
        window.dispatch(ShowCommand::Palette);
        window.pass(1);
        window.dispatch(ShowCommand::Palette);
        assert!(
            window.workbench.shell.cover.is_none(),
            "the same key closes it"
        );
    }
}
