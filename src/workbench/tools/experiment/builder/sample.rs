//! What a participant will see, small and not to be answered: the same view that sessions show.

use eframe::egui::emath::TSTransform;
use eframe::egui::{Rect, Sense, Ui, UiBuilder, Vec2, vec2};

use crate::kit::widgets::text::toggle;
use crate::tools::experiment::builder::state::Step;
use crate::tools::experiment::draft::Draft;
use crate::tools::experiment::guide;
use crate::tools::experiment::in_turn::Intervals;
use crate::tools::experiment::participant;
use crate::tools::experiment::view::{
    Ground, ParticipantView, TrialView, question, slots, words_of_break,
};
use selvedge_experiment::Trial;
use selvedge_experiment::design::{Design, Movement};
use selvedge_experiment::layout::Layout;
use selvedge_foundation::geometry::Point;

/// The participant's window that is shown small, points.
const WHOLE: Vec2 = vec2(760.0, 600.0);
/// When the dot of a movement is looked at, s.
const GUIDE_S: f64 = 0.6;

/// Shows a step of a session as wide as there is room.
pub(crate) fn show(ui: &mut Ui, step: &mut Step, (design, trial): (&Design, Option<&Trial>)) {
    ui.horizontal(|ui| {
        for (one, name) in Step::ALL.into_iter().filter(|(one, _)| one.is_in(design)) {
            if toggle(ui, name, *step == one, name) {
                *step = one;
            }
        }
    });
    if !step.is_in(design) {
        *step = Step::Trial;
    }
    let scale = ui.available_width() / WHOLE.x;
    let (rect, _) = ui.allocate_exact_size(scale * WHOLE, Sense::hover());
    let draft = trial
        .map(|trial| Draft::of(design, trial))
        .unwrap_or_default();
    let Some(view) = view(design, *step, (trial, &draft)) else {
        return;
    };
    let whole = Rect::from_min_size(rect.min, WHOLE);
    let small = TSTransform::new(rect.min.to_vec2() * (1.0 - scale), scale);
    let mut child = ui.new_child(UiBuilder::new().max_rect(whole));
    // Not to be answered, but as bright as it will be; what keys would say is let go.
    child.visuals_mut().disabled_alpha = 1.0;
    child.disable();
    let clip = small.inverse() * rect.intersect(ui.clip_rect());
    child.with_visual_transform(small, |ui| {
        ui.set_clip_rect(clip);
        participant::show(ui, &view, &mut Vec::new());
    });
}

fn view<'a>(
    design: &Design,
    step: Step,
    (trial, draft): (Option<&Trial>, &'a Draft),
) -> Option<ParticipantView<'a>> {
    Some(match step {
        Step::Welcome => ParticipantView::Words {
            title: "Welcome",
            words: design.course.instructions.clone(),
            left_s: Some(0.0),
        },
        Step::Break => words_of_break(Some(design.course.break_s())),
        Step::Movement => {
            let movement = design.course.familiarisation.first()?;
            let layout = Layout::to_practise(0);
            let [width_mm, height_mm] = layout.size_mm;
            let middle = Point::new(width_mm / 2.0, height_mm / 2.0);
            ParticipantView::Movement {
                ground: ground(&layout, None),
                is_circle: movement.movement == Movement::Circular,
                guide: guide::place(movement, middle, GUIDE_S),
                left_s: movement.for_s,
            }
        }
        Step::Trial => {
            let trial = trial?;
            let intervals = Intervals::of(design, &trial.task);
            let layout = Layout::of(design, &trial.task);
            let is_played = intervals.is_some() && !layout.is_stacked();
            let layout = if is_played { Layout::empty() } else { layout };
            ParticipantView::Trial(TrialView {
                ground: ground(&layout, Some(trial)),
                question: question(design),
                draft,
                is_open: true,
                missing: None,
                intervals,
                may_play: false,
            })
        }
    })
}

fn ground(layout: &Layout, trial: Option<&Trial>) -> Ground {
    Ground {
        size_mm: layout.size_mm,
        slots: slots(layout, trial),
        picture: None,
        finger: None,
        feels: false,
    }
}
