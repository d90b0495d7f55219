//! What the public sees: cloths with the display on them, a question with four answers, and few
//! words. Draws and says what was pressed; what comes of it is decided elsewhere.

use std::f64::consts::TAU;

use eframe::egui::{Align2, Pos2, Rect, Response, Stroke, Ui, pos2, vec2};

use crate::bench::paint_display;
use crate::bench::view::{Cloth, EngineView, SceneView};
use crate::kit::swatch::{Textile, paint_outline};
use crate::kit::view_transform::ViewTransform;
use crate::tools::stage::act::Act;
use crate::tools::stage::brush::{Brush, Look};
use crate::tools::stage::machine::{Machine, Phase};
use crate::tools::stage::round::{show_end, show_round};
use crate::tools::stage::shown::{Shown, sentence, sound_signs};
use selvedge_experiment::visits::{N_CLOTHS, Tally};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_single;

/// Buttons of the row and of the strip, mm.
pub(crate) const ROW_MM: [f32; 2] = [60.0, 25.0];
const STRIP_MM: f32 = 20.0;
const STOP_MM: f32 = 30.0;
/// A bar is full at this rms over the contactors, µm.
const FULL_BAR_UM: f64 = 30.0;
/// Dots move so much slower than contactors while nobody is there.
const SLOWER: f64 = 160.0;
/// Under a finger dots would be hidden: they are shown so far above it, mm.
const ABOVE_FINGER_MM: f32 = 25.0;
/// Luck is told after so long without a visitor, s.
const LUCK_AFTER_S: f64 = 84.0;

/// What came of a frame.
#[derive(Debug, Default)]
pub(crate) struct Wishes {
    pub(crate) acts: Vec<Act>,
    /// Where the pointer feels, and how mm are laid there.
    pub(crate) ground: Option<(Rect, ViewTransform)>,
}

/// Draws the stage.
pub(crate) fn show(ui: &mut Ui, brush: &mut Brush<'_>, shown: &Shown<'_>) -> Wishes {
    let mut wishes = Wishes::default();
    brush
        .painter
        .rect_filled(brush.layout.whole, 0, brush.palette.floor);
    match shown.machine.phase() {
        Phase::Guessing(game) if game.is_over() => {
            show_end(ui, brush, (shown, game), &mut wishes.acts);
        }
        Phase::Guessing(game) => show_round(ui, brush, (shown, game), &mut wishes),
        Phase::Watching | Phase::Touching => show_cloths(ui, brush, shown, &mut wishes),
    }
    show_strip(ui, brush, shown, &mut wishes.acts);
    let ring = (brush.palette.faint, 8.0 * brush.layout.mm);
    (shown.rings).paint(&brush.painter, shown.machine.now_s(), ring);
    let fade = to_single(shown.machine.fade());
    if fade > 0.0 && !shown.options.is_still() {
        let veil = brush.palette.floor.gamma_multiply(fade);
        brush.painter.rect_filled(brush.layout.whole, 0, veil);
    }
    wishes
}

/// The view that shows the first four cloths in a square, at true size if there is room for it.
pub(crate) fn view_of(square: Rect, scene: &SceneView, mm: f32) -> ViewTransform {
    let corners = scene.cloths.iter().take(N_CLOTHS).flat_map(|cloth| {
        let [width, height] = cloth.size_mm;
        [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
            .map(|[x, y]| cloth.workspace_from_textile.point(Point::new(x, y)))
    });
    let start = [
        f64::INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NEG_INFINITY,
    ];
    let [left, low, right, high] = corners.fold(start, |[a, b, c, d], at| {
        [
            a.min(at.x_mm),
            b.min(at.y_mm),
            c.max(at.x_mm),
            d.max(at.y_mm),
        ]
    });
    let extent_mm = (right - left).max(high - low).max(1.0) + 6.0;
    let scale = (f64::from(square.width()) / extent_mm).min(f64::from(mm));
    let centre = Point::new(0.5 * (left + right), 0.5 * (low + high));
    ViewTransform::new(square, centre, scale)
}

/// The middle of a cloth in the workspace.
pub(crate) fn middle(cloth: &Cloth) -> Point {
    let [width, height] = cloth.size_mm;
    let local = Point::new(0.5 * width, 0.5 * height);
    cloth.workspace_from_textile.point(local)
}

fn show_cloths(ui: &Ui, brush: &mut Brush<'_>, shown: &Shown<'_>, wishes: &mut Wishes) {
    let layout = brush.layout;
    let view = view_of(layout.square, shown.scene, layout.mm * 1.05);
    let under = shown.live.cloth_under_display();
    for (nth, cloth) in shown.scene.cloths.iter().take(N_CLOTHS).enumerate() {
        let corners = corners(&view, cloth);
        paint_cloth(brush, corners, cloth, under == Some(nth));
        let rect = Rect::from_points(&corners);
        let response = brush.target(ui, rect, &format!("Cloth {}", nth + 1), under == Some(nth));
        if is_keyed(&response) {
            wishes.acts.push(Act::Tour(nth));
        }
        brush.ring(rect, &response);
        let tag = Rect::from_min_size(rect.min, vec2(1.5, 1.5) * layout.words);
        brush.painter.rect_filled(tag, 0, brush.palette.tag);
        let look = (layout.words, brush.palette.text);
        brush.line(tag, Align2::CENTER_CENTER, look, &(nth + 1).to_string());
    }
    paint_felt(brush, &view, shown);
    wishes.ground = Some((layout.square, view));
    if matches!(shown.machine.phase(), Phase::Watching) {
        return show_watching(brush, shown);
    }
    show_bars(brush, shown.live);
    show_row(ui, brush, shown.machine, &mut wishes.acts);
}

/// What is told while nobody is there.
fn show_watching(brush: &mut Brush<'_>, shown: &Shown<'_>) {
    let layout = brush.layout;
    let look = (layout.label, brush.palette.text);
    let [above, below] = halves(layout.row.shrink(8.0 * layout.unit));
    if !shown.options.is_still() {
        brush.line(above, Align2::CENTER_CENTER, look, "Shown 160× slower.");
    }
    let Tally { n_guessed, .. } = shown.tally;
    if n_guessed > 0 && shown.machine.watching_s() > LUCK_AFTER_S {
        let words = format!("{n_guessed} people guessed. Luck: 1 in 4.");
        let look = (layout.words, brush.palette.text);
        brush.line(below, Align2::CENTER_CENTER, look, &words);
    }
}

fn show_row(ui: &Ui, brush: &mut Brush<'_>, machine: &Machine, acts: &mut Vec<Act>) {
    let [left, middle, right] = brush.layout.places::<3>(brush.layout.row, ROW_MM);
    let offers_feeling = machine.offers_feeling();
    if offers_feeling {
        let held = to_single(machine.voltage.held_share(machine.now_s()));
        let look = Look {
            held,
            ..Look::default()
        };
        let response = brush.button(ui, left, ("Press to feel", "Press to feel"), look);
        if is_begun(ui, &response) {
            acts.push(Act::HoldFeel(true));
        }
    }
    if machine.offers_guessing() {
        let response = brush.button(ui, middle, ("Guess", "Guess"), Look::default());
        if response.clicked() {
            acts.push(Act::Guess);
        }
    }
    if machine.n_stroked() > 0 && !offers_feeling {
        let look = Look {
            is_on: machine.choices().same_strength,
            ..Look::default()
        };
        let response = brush.button(ui, right, ("Same strength", "Same strength"), look);
        if response.clicked() {
            acts.push(Act::SameStrength);
        }
    }
}

fn show_bars(brush: &mut Brush<'_>, live: &EngineView) {
    let [above, below] = halves(brush.layout.bars);
    let n = live.dots.len().max(1) as f64;
    let rms = |band: usize| {
        let sum: f64 = live
            .dots
            .iter()
            .map(|dot| dot.amplitude_um[band].powi(2))
            .sum();
        to_single((sum / n).sqrt() / FULL_BAR_UM)
    };
    let (low, high) = (brush.palette.low, brush.palette.high);
    let gap = vec2(0.0, 8.0 * brush.layout.unit);
    brush.bar(above.shrink2(gap), "slow shake 40", low, rms(0));
    brush.bar(below.shrink2(gap), "fast buzz 320", high, rms(1));
}

/// One sentence on the left; sound, larger letters, begin anew and STOP on the right.
fn show_strip(ui: &Ui, brush: &mut Brush<'_>, shown: &Shown<'_>, acts: &mut Vec<Act>) {
    let (layout, machine) = (brush.layout, shown.machine);
    let gap = 8.0 * layout.unit;
    let mut right = layout.strip.right() - gap;
    let mut place = |side_mm: f32| {
        let side = (side_mm * layout.mm).min(layout.strip.height() - gap);
        let at = pos2(right - side, layout.strip.center().y - 0.5 * side);
        right -= side + 2.0 * gap;
        Rect::from_min_size(at, vec2(side, side))
    };
    if machine.is_armed() {
        let rect = place(STOP_MM);
        let look = Look {
            is_danger: true,
            ..Look::default()
        };
        let response = brush.button(ui, rect, ("STOP", "STOP"), look);
        brush.drawn.stop = Some(rect);
        if response.is_pointer_button_down_on() || response.clicked() {
            acts.push(Act::Stop);
        }
    }
    let sound = sound_signs(shown);
    let look = Look {
        is_faint: shown.is_deaf,
        ..Look::default()
    };
    if brush.button(ui, place(STRIP_MM), sound, look).clicked() {
        acts.push(Act::Sound);
    }
    let look = Look {
        is_on: machine.choices().is_large,
        ..Look::default()
    };
    if brush
        .button(
            ui,
            place(STRIP_MM),
            ("Aa", "Larger letters, more contrast"),
            look,
        )
        .clicked()
    {
        acts.push(Act::Large);
    }
    if !matches!(machine.phase(), Phase::Watching) {
        let held = to_single(machine.restart_share());
        let look = Look {
            held,
            ..Look::default()
        };
        let response = brush.button(ui, place(STRIP_MM), ("⟲", "Begin anew: hold"), look);
        if is_begun(ui, &response) {
            acts.push(Act::HoldRestart(true));
        }
    }
    let within = layout.strip.shrink2(vec2(3.0 * gap, gap)).with_max_x(right);
    let look = (layout.words, brush.palette.text);
    brush.line(within, Align2::LEFT_CENTER, look, &sentence(shown));
}

/// A cloth that lies on these corners of the screen.
pub(crate) fn paint_cloth(brush: &Brush<'_>, corners: [Pos2; 4], cloth: &Cloth, is_lifted: bool) {
    let textile = Textile {
        corners,
        size_mm: cloth.size_mm,
        picture: cloth.picture,
        is_muted: false,
        is_lifted,
    };
    textile.paint(&brush.painter);
    if is_lifted {
        let edge = Stroke::new(2.0 * brush.layout.unit, brush.palette.selection);
        paint_outline(&brush.painter, corners, edge);
    }
}

fn corners(view: &ViewTransform, cloth: &Cloth) -> [Pos2; 4] {
    let [width, height] = cloth.size_mm;
    [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
        .map(|[x, y]| view.screen(cloth.workspace_from_textile.point(Point::new(x, y))))
}

/// The display with its trail; the ghost and its slow dots while nobody is there.
pub(crate) fn paint_felt(brush: &Brush<'_>, view: &ViewTransform, shown: &Shown<'_>) {
    let Some(centre) = shown.live.centre else {
        return;
    };
    let painter = brush
        .painter
        .with_clip_rect(view.rect.intersect(brush.layout.whole));
    let has_ghost = shown.machine.has_ghost();
    let mut view = *view;
    if has_ghost {
        let (at, radius) = (view.screen(centre), view.length(9.0));
        let skin = brush.palette.selection.gamma_multiply(0.35);
        let edge = Stroke::new(3.0 * brush.layout.unit, brush.palette.selection);
        painter.circle(at + vec2(0.0, 0.6 * radius), 1.5 * radius, skin, edge);
    } else if shown.input == "touch" {
        let up = vec2(0.0, -ABOVE_FINGER_MM * brush.layout.mm);
        view.rect = view.rect.translate(up);
    }
    let ink = (shown.selection, None);
    if has_ghost && !shown.options.is_still() {
        let slow = slowed(shown.live, shown.machine.now_s());
        return paint_display::paint(&painter, &view, &slow, ink);
    }
    if !shown.options.is_still() {
        paint_display::paint_trail(&painter, &view, shown.trail.aged());
    }
    paint_display::paint(&painter, &view, shown.live, ink);
}

/// Contactors as they move, 160 times slower: 0.25 and 2 times a second.
fn slowed(live: &EngineView, now_s: f64) -> EngineView {
    let mut slow = live.clone();
    let [low, high] = [40.0, 320.0].map(|hz| 0.5 + 0.5 * (TAU * hz / SLOWER * now_s).sin());
    for dot in &mut slow.dots {
        dot.amplitude_um[0] *= low;
        dot.amplitude_um[1] *= high;
    }
    slow
}

/// Whether keys, not the pointer, pressed something.
pub(crate) fn is_keyed(response: &Response) -> bool {
    response.clicked() && !response.clicked_by(eframe::egui::PointerButton::Primary)
}

/// Whether a button begins to be held in this frame, by the pointer or by keys.
fn is_begun(ui: &Ui, response: &Response) -> bool {
    use eframe::egui::Key;
    let by_keys = response.has_focus()
        && ui.input(|input| input.key_pressed(Key::Enter) || input.key_pressed(Key::Space));
    let by_pointer =
        response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_pressed());
    by_keys || by_pointer
}

pub(crate) fn halves(rect: Rect) -> [Rect; 2] {
    let y = rect.center().y;
    [rect.with_max_y(y), rect.with_min_y(y)]
}
