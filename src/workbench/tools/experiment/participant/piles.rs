//! Fabrics that are put into piles.

use eframe::egui::{Key, Ui};

use crate::tools::experiment::draft::{Act, Mark};
use crate::tools::experiment::participant::big;
use crate::tools::experiment::participant::controls::{row, show_done};
use crate::tools::experiment::participant::ground::count;
use crate::tools::experiment::view::TrialView;

/// Buttons in a row.
pub(crate) const PILES_A_ROW: usize = 9;

/// A button for each position, which goes to the next pile with every press; piles have letters.
/// The first has the keys while nothing else has them, and Enter belongs to the answer as a whole.
pub(crate) fn show(
    ui: &mut Ui,
    trial: &TrialView<'_>,
    piles: &[Option<usize>],
    acts: &mut Vec<Act>,
) {
    let letter = |pile: usize| char::from(b'A' + u8::try_from(pile).unwrap_or(25).min(25));
    let is_entered = ui.input(|input| input.key_pressed(Key::Enter));
    let is_free = trial.is_open && !is_entered && ui.memory(|memory| memory.focused().is_none());
    let all: Vec<(usize, &Option<usize>)> = piles.iter().enumerate().collect();
    for some in all.chunks(PILES_A_ROW) {
        row(ui, count(some.len()) * 80.0, |ui| {
            for (at, pile) in some {
                let of = pile.map_or_else(|| "·".to_owned(), |pile| letter(pile).to_string());
                let words = format!("{} {of}", at + 1);
                let label = format!("Fabric {}: pile {of}", at + 1);
                let button = big::button(ui, (&words, &label), 64.0, pile.is_some());
                if is_free && *at == 0 {
                    button.request_focus();
                }
                if is_entered && button.has_focus() {
                    button.surrender_focus();
                } else if button.clicked() {
                    acts.push(Act::Mark(Mark::NextPile(*at)));
                }
            }
        });
    }
    row(ui, 160.0, |ui| show_done(ui, trial, acts));
}
