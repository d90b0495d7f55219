//! A question with four answers, and how it went.

use eframe::egui::{Align2, Rect, Stroke, StrokeKind, TextEdit, Ui, vec2};

use crate::kit::view_transform::ViewTransform;
use crate::tools::stage::act::Act;
use crate::tools::stage::brush::{Brush, Look};
use crate::tools::stage::game::{Answered, FACES, Game, WORDS};
use crate::tools::stage::shown::Shown;
use crate::tools::stage::view::{
    ROW_MM, Wishes, halves, is_keyed, middle, paint_cloth, paint_felt,
};
use selvedge_foundation::numerics::to_single;

/// A question: a grey cloth to be felt, four pictures to choose from.
pub(crate) fn show_round(
    ui: &Ui,
    brush: &mut Brush<'_>,
    (shown, game): (&Shown<'_>, &Game),
    wishes: &mut Wishes,
) {
    let layout = brush.layout;
    let (question, pictures) = layout.round();
    brush
        .painter
        .rect_filled(question, 0, brush.palette.hovered);
    let sign = question.shrink(0.3 * question.width());
    let look = (0.5 * question.height(), brush.palette.faint);
    brush.line(sign, Align2::CENTER_CENTER, look, "?");
    let felt = game.truth().and_then(|truth| shown.scene.cloths.get(truth));
    if let Some(cloth) = felt {
        let [width_mm, _] = cloth.size_mm;
        let scale = f64::from(question.width()) / width_mm.max(1.0);
        let view = ViewTransform::new(question, middle(cloth), scale);
        let response = brush.target(ui, question, "What is felt", false);
        if is_keyed(&response) {
            wishes.acts.extend(game.truth().map(Act::Tour));
        }
        brush.ring(question, &response);
        paint_felt(brush, &view, shown);
        wishes.ground = Some((question, view));
    }
    let answered = game.answered(shown.machine.now_s());
    for (place, (rect, cloth)) in pictures.into_iter().zip(game.order()).enumerate() {
        if let Some(cloth) = shown.scene.cloths.get(cloth) {
            let corners = [
                rect.left_bottom(),
                rect.right_bottom(),
                rect.right_top(),
                rect.left_top(),
            ];
            paint_cloth(brush, corners, cloth, true);
        }
        let label = format!("Picture {}", place + 1);
        let response = brush.target(ui, rect, &label, answered == Answered::Chosen(place));
        if response.clicked() {
            wishes.acts.push(Act::Choose(place));
        }
        brush.ring(rect, &response);
        mark(brush, rect, (place, cloth), answered);
    }
    if let Some(share) = shown.machine.leaving_share() {
        let stroke = Stroke::new(10.0 * layout.unit, brush.palette.selection);
        let radius = 0.35 * question.width();
        brush.arc(question.center(), radius, 1.0 - to_single(share), stroke);
    }
}

/// Outlines what was chosen, and says by a sign what it was.
fn mark(brush: &mut Brush<'_>, rect: Rect, (place, cloth): (usize, usize), answered: Answered) {
    let unit = brush.layout.unit;
    let sign = match answered {
        Answered::Chosen(chosen) if chosen == place => "",
        Answered::Told { truth, .. } if truth == cloth => "✔",
        Answered::Told { chosen, .. } if chosen == cloth => "✖",
        _ => return,
    };
    let stroke = Stroke::new(10.0 * unit, brush.palette.selection);
    brush
        .painter
        .rect_stroke(rect, 0, stroke, StrokeKind::Inside);
    if !sign.is_empty() {
        let size = vec2(0.3, 0.3) * rect.width();
        let corner = Rect::from_min_size(rect.right_bottom() - size, size);
        brush.painter.rect_filled(corner, 0, brush.palette.tag);
        let look = (0.7 * size.y, brush.palette.text);
        brush.line(corner, Align2::CENTER_CENTER, look, sign);
    }
}

/// How it went: faces, words, and a line to type where there is a keyboard.
pub(crate) fn show_end(
    ui: &mut Ui,
    brush: &mut Brush<'_>,
    (shown, game): (&Shown<'_>, &Game),
    acts: &mut Vec<Act>,
) {
    let layout = brush.layout;
    let [above, below] = halves(layout.area);
    let faces = layout.places::<3>(above, [60.0, 60.0]);
    for (nth, (rect, name)) in faces.into_iter().zip(FACES).enumerate() {
        let is_on = game.comment.face == name;
        let response = brush.target(ui, rect, name, is_on);
        brush.face(rect, nth as f32 - 1.0, is_on);
        brush.ring(rect, &response);
        if response.clicked() {
            acts.push(Act::Face(nth));
        }
    }
    let rows = halves(below.shrink2(vec2(0.0, 8.0 * layout.unit)));
    for (half, row) in rows.into_iter().enumerate() {
        let places = layout.places::<3>(row, ROW_MM);
        for (place, nth) in places.into_iter().zip(3 * half..) {
            let word = WORDS[nth];
            let look = Look {
                is_on: game.comment.words.contains(&word),
                ..Look::default()
            };
            if brush.button(ui, place, (word, word), look).clicked() {
                acts.push(Act::Word(nth));
            }
        }
    }
    let [_, typed, done] = layout.places::<3>(layout.row, ROW_MM);
    if brush
        .button(ui, done, ("✔", "Done"), Look::default())
        .clicked()
    {
        acts.push(Act::Done);
    }
    if shown.has_keyboard {
        let typed = typed.with_min_x(typed.left() - typed.width());
        type_comment(ui, brush, (typed, &game.comment.text), acts);
    }
}

fn type_comment(ui: &mut Ui, brush: &Brush<'_>, (place, text): (Rect, &str), acts: &mut Vec<Act>) {
    let mut text = text.to_owned();
    let field = TextEdit::singleline(&mut text)
        .hint_text("No names, please")
        .font(eframe::egui::FontId::proportional(brush.layout.label))
        .char_limit(selvedge_experiment::visits::Comment::LONGEST);
    if ui
        .put(place.shrink(8.0 * brush.layout.unit), field)
        .changed()
    {
        acts.push(Act::Comment(text));
    }
}
