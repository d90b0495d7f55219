//! Tunings beside the one in force: slots A to H, felt as long as their letter is held, and set
//! against the present one without knowing which is which.

#[cfg(test)]
mod tests;

use std::hash::{BuildHasher as _, RandomState};

use eframe::egui::{
    self, Align, Align2, Key, Layout, Modifiers, Rect, Response, Sense, Stroke, StrokeKind,
    TextEdit, Ui, WidgetInfo, vec2,
};

use crate::bench::Bench;
use crate::bench::command::Commands;
use crate::bench::command::edit::Edit;
use crate::bench::gain_set::{GainSet, slot};
use crate::bench::keys::OF_SLOTS;
use crate::bench::perceptual_level::as_strong;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::slider::tell;
use crate::kit::widgets::text::{button, line, named, quiet, toggle};
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity::fixed;
use selvedge_render::scene::{Scene, SlotLetter};
use selvedge_statistics::{Sides, exact_binomial};

/// Side of a letter, points.
const SIDE: f32 = 22.0;
/// Height of a row, points.
const LINE: f32 = 24.0;
/// What is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Held {
    Slot(SlotLetter),
    /// The first or the second of a blind comparison.
    Blind(usize),
}

/// A slot and the present tuning, one of them first, nobody knows which.
#[derive(Debug)]
struct Blind {
    letter: SlotLetter,
    is_slot_first: bool,
    /// How often the slot was preferred, and how often the present tuning.
    tally: [u64; 2],
    is_shown: bool,
    random: Random,
}

/// The slots as the pane shows them.
#[derive(Debug, Default)]
pub(crate) struct Slots {
    chosen: Option<SlotLetter>,
    /// Whether what is held is made as strong as the present tuning.
    is_matched: bool,
    /// What the pointer holds, since the last frame.
    pointed: Option<Held>,
    blind: Option<Blind>,
}

impl Slots {
    /// Lets what is held be felt, and the present tuning when nothing is.
    pub(crate) fn follow(&mut self, bench: &mut Bench) {
        let held = self
            .pointed
            .take()
            .or_else(|| held_key(bench, self.blind.is_some()));
        let held = held.filter(|_| !bench.has_session());
        let letter = held.and_then(|held| self.letter_of(held));
        let gains = letter.and_then(|letter| GainSet::of_slot(bench.document.scene(), letter));
        let matched = gains.map(|gains| {
            let is_matched = self.is_matched || self.blind.is_some();
            if is_matched {
                let scene = bench.plain_scene_view();
                as_strong(&scene, gains, &bench.gain_set(), bench.n_contactors())
            } else {
                gains
            }
        });
        if bench.selection.held_gains != matched {
            bench.selection.held_gains = matched;
            bench.send_gains();
            bench.ctx.request_repaint();
        }
    }

    /// The slot that is held; `None` where it is the present tuning.
    fn letter_of(&self, held: Held) -> Option<SlotLetter> {
        match (held, &self.blind) {
            (Held::Slot(letter), None) => Some(letter),
            (Held::Blind(nth), Some(blind)) => {
                (blind.is_slot_first == (nth == 0)).then_some(blind.letter)
            }
            _ => None,
        }
    }

    /// Forgets what belongs to another scene.
    pub(crate) fn leave_scene(&mut self) {
        *self = Self {
            is_matched: self.is_matched,
            ..Self::default()
        };
    }

    /// Shows the letters, and what is chosen among them.
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        if self.blind.is_some() {
            self.show_blind(ui);
            return;
        }
        let scene = context.bench.document.scene().clone();
        let is_felt = context.bench.selection.held_gains.is_some();
        line(ui, LINE, |ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            for letter in SlotLetter::ALL {
                self.show_letter(ui, &scene, letter, context);
            }
            ui.add_space(STEP);
            let tip = "Make a slot that is held as strong as the present tuning, by the model";
            self.is_matched ^= toggle(ui, "=", self.is_matched, tip);
            let words = if is_felt { "held" } else { "" };
            ui.label(quiet(words));
        });
        let chosen = self.chosen.filter(|letter| slot(&scene, *letter).is_some());
        if let Some(letter) = chosen {
            self.show_chosen(ui, &scene, letter, context);
        }
    }

    fn show_letter(
        &mut self,
        ui: &mut Ui,
        scene: &Scene,
        letter: SlotLetter,
        context: &mut PaneContext<'_>,
    ) {
        let kept = slot(scene, letter);
        let response = letter_button(ui, letter, [kept.is_some(), self.chosen == Some(letter)]);
        if response.is_pointer_button_down_on() && kept.is_some() {
            self.pointed = Some(Held::Slot(letter));
            ui.ctx().request_repaint();
        }
        let name = letter.name();
        if response.clicked() {
            self.chosen = (self.chosen != Some(letter)).then_some(letter);
            if kept.is_none() {
                context.commands.push(Edit::KeepSlot(letter).into());
            }
        }
        let words = match kept {
            None => format!("Slot {name} is empty: a click keeps the present tuning in it"),
            Some(slot) => {
                let gains = GainSet::of_slot(scene, letter);
                let differs = gains.map_or_else(Vec::new, |gains| {
                    let names = context.scene.titles();
                    context.bench.gain_set().differences(&gains, &names)
                });
                let differs = match differs.len() {
                    0 => "as it is now".to_owned(),
                    _ => differs.join(", "),
                };
                let title = [name, &slot.name].join(" ");
                format!(
                    "{}: {differs} · hold it (or Alt+{name}) to feel it",
                    title.trim()
                )
            }
        };
        tell(&response, words);
    }

    fn show_chosen(
        &mut self,
        ui: &mut Ui,
        scene: &Scene,
        letter: SlotLetter,
        context: &mut PaneContext<'_>,
    ) {
        let Some(kept) = slot(scene, letter) else {
            return;
        };
        let mut words = [kept.name.clone(), kept.note.clone()];
        line(ui, LINE, |ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            let width = 0.36 * ui.available_width();
            for (nth, hint) in ["name", "note"].into_iter().enumerate() {
                let width = if nth == 0 {
                    width
                } else {
                    ui.available_width()
                };
                let field = TextEdit::singleline(&mut words[nth]).hint_text(hint);
                let response = ui.add(field.desired_width(width));
                named(&response, format!("{hint} of slot {}", letter.name()));
            }
        });
        if words != [kept.name.clone(), kept.note.clone()] {
            context.commands.push(Edit::SlotWords(letter, words).into());
        }
        line(ui, LINE, |ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            let name = letter.name();
            let gains = GainSet::of_slot(scene, letter);
            let is_same = gains.as_ref() == Some(&context.bench.gain_set());
            let same = is_same.then_some("It is as the present tuning");
            let edits: &mut Commands = context.commands;
            let tip = format!("Put what slot {name} keeps into force");
            if button(ui, "Take", &tip, same) {
                edits.extend(gains.map(|gains| Edit::Gains(gains).into()));
            }
            let tip = format!("Keep the present tuning in slot {name} instead");
            if button(ui, "Keep", &tip, same) {
                edits.push(Edit::KeepSlot(letter).into());
            }
            if button(ui, "Empty", &format!("Forget what slot {name} keeps"), None) {
                edits.push(Edit::EmptySlot(letter).into());
            }
            let tip = format!(
                "Set {name} against the present tuning, as strong, without knowing which is which"
            );
            if button(ui, "Blind", &tip, same) {
                self.blind = Some(Blind::new(letter, context.bench.is_stepped()));
            }
        });
    }

    fn show_blind(&mut self, ui: &mut Ui) {
        let Some(blind) = &mut self.blind else { return };
        let mut does_end = false;
        line(ui, LINE, |ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            for nth in 0..2 {
                let words = ["Feel 1", "Feel 2"][nth];
                let response = ui.add(egui::Button::new(words).sense(Sense::click_and_drag()));
                if response.is_pointer_button_down_on() {
                    self.pointed = Some(Held::Blind(nth));
                    ui.ctx().request_repaint();
                }
                let key = nth + 1;
                tell(
                    &response,
                    format!("Hold it, or Alt+{key}, to feel it: as strong as the other"),
                );
            }
            ui.separator();
            for nth in 0..2 {
                let words = ["Rather 1", "Rather 2"][nth];
                if button(
                    ui,
                    words,
                    "Say which is better; the next pair comes in a new order",
                    None,
                ) {
                    blind.answer(nth);
                }
            }
        });
        line(ui, LINE, |ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            ui.label(quiet(blind.words()));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                does_end = button(ui, "End", "Back to the slots", None);
                let none = (blind.tally == [0; 2]).then_some("Nothing was said yet");
                if !blind.is_shown && button(ui, "Reveal", "Show what was preferred", none) {
                    blind.is_shown = true;
                }
            });
        });
        if does_end {
            self.blind = None;
        }
    }
}

impl Blind {
    fn new(letter: SlotLetter, is_stepped: bool) -> Self {
        let seed = if is_stepped {
            1
        } else {
            RandomState::new().hash_one(letter)
        };
        let mut random = Random::new(seed);
        Self {
            letter,
            is_slot_first: random.index(2) == 0,
            tally: [0; 2],
            is_shown: false,
            random,
        }
    }

    /// Takes in that the first or the second was preferred, and shuffles.
    fn answer(&mut self, nth: usize) {
        let is_slot = self.is_slot_first == (nth == 0);
        self.tally[usize::from(!is_slot)] += 1;
        self.is_slot_first = self.random.index(2) == 0;
    }

    /// How far it is, and once it is revealed what was preferred: share with its 95 % interval by
    /// Wilson, and p of the exact binomial test against indifference.
    fn words(&self) -> String {
        let [slot, now] = self.tally;
        let n = slot + now;
        if !self.is_shown {
            return format!("{n} said, order new each time");
        }
        let letter = self.letter.name();
        let said = format!("{letter} rather than now: {slot} of {n}");
        let tested = exact_binomial(slot, n, 0.5, Sides::Two);
        let found = tested.and_then(|outcome| Ok((outcome.interval?, outcome.p)));
        let Ok((interval, p)) = found else {
            return said;
        };
        let [low, high] = [interval.low, interval.high].map(|end| fixed(100.0 * end, 0));
        format!("{said} ({low}–{high} %, p {})", fixed(p, 3))
    }
}

/// The letter that is held down with Alt, or with `is_blind` the digit.
fn held_key(bench: &Bench, is_blind: bool) -> Option<Held> {
    if bench.ctx.text_edit_focused() {
        return None;
    }
    bench.ctx.input(|input| {
        if input.modifiers != Modifiers::ALT {
            return None;
        }
        if is_blind {
            let nth = [Key::Num1, Key::Num2]
                .iter()
                .position(|key| input.key_down(*key));
            return nth.map(Held::Blind);
        }
        let mut keys = OF_SLOTS.iter().zip(SlotLetter::ALL);
        let held = keys.find(|(key, _)| input.key_down(**key));
        held.map(|(_, letter)| Held::Slot(letter))
    })
}

/// A letter: bright where something is kept, on white while it is pressed, with a line under the
/// chosen one.
fn letter_button(ui: &mut Ui, letter: SlotLetter, [is_kept, is_chosen]: [bool; 2]) -> Response {
    let palette = Palette::in_ui(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(SIDE, SIDE), Sense::click_and_drag());
    let is_down = response.is_pointer_button_down_on() && is_kept;
    let painter = ui.painter();
    let ground = match (is_down, is_kept || response.hovered()) {
        (true, _) => palette.selection,
        (false, true) => palette.raised,
        (false, false) => egui::Color32::TRANSPARENT,
    };
    painter.rect_filled(rect, 3, ground);
    if response.has_focus() {
        let edge = Stroke::new(1.0, palette.selection);
        painter.rect_stroke(rect, 3, edge, StrokeKind::Inside);
    }
    let ink = match (is_down, is_kept) {
        (true, _) => palette.floor,
        (false, true) => palette.text,
        (false, false) => palette.dim,
    };
    painter.text(
        rect.center(),
        Align2::CENTER_CENTER,
        letter.name(),
        theme::body(),
        ink,
    );
    if is_chosen && is_kept {
        let under = Rect::from_min_max(rect.left_bottom() - vec2(0.0, 2.0), rect.right_bottom());
        painter.rect_filled(under, 0, palette.selection);
    }
    response.widget_info(|| {
        let state = if is_kept { "kept" } else { "empty" };
        let words = format!("Slot {}, {state}", letter.name());
        WidgetInfo::labeled(egui::Role::Button, true, words)
    });
    response
}
