//! The pane: what is chosen on the left, the cloth in the middle, the last seconds on the right;
//! where there is little room, one below the other.

use std::sync::Arc;

use eframe::egui::{Align2, Id, Margin, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::tool::PaneContext;
use crate::kit::pane::{inside, paint_sentence, scroll_area};
use crate::kit::plot::{self, Setting};
use crate::kit::theme::{self, Palette, ROW, STEP};
use crate::kit::widgets::bar::amplitude_bar;
use crate::kit::widgets::fields::{Tone, note};
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::{RowShape, slider_row_as, tell};
use crate::kit::widgets::text::{button, line, paint_focus, paint_line, quiet};
use crate::tools::drape::camera::Sight;
use crate::tools::drape::hung::{ClothFrame, Frame};
use crate::tools::drape::paint::{self, Dress};
use crate::tools::drape::touch::touch;
use crate::tools::drape::{Draping, controls};
use selvedge_foundation::quantity::{fixed, with_unit};

/// A pane at least this wide has its controls beside the cloth, and one this wide the charts too,
/// points.
const WIDE: f32 = 640.0;
const WIDER: f32 = 900.0;
/// Width of the controls, and of the charts, points.
const CONTROLS: f32 = 284.0;
const CHARTS: f32 = 280.0;
/// Least heights of the cloth's view and of a chart, points.
const VIEW: f32 = 260.0;
const CHART: f32 = 96.0;
/// Height of the rows below the cloth, points.
const ROWS: f32 = 2.0 * ROW + 2.0 * STEP;
/// Space between charts, points.
const GAP: f32 = 2.0 * STEP;
/// Steps of the strain's scale.
const STRAINS: [f32; 8] = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];
/// The room of the bars at the right edge of the view, points.
const BAR: f32 = 10.0;
/// Room around a chart, points.
const MARGIN: Margin = Margin {
    left: 40,
    right: 8,
    top: 18,
    bottom: 18,
};
/// Room that the legend leaves to no title, points.
const LEGEND: f32 = 84.0;
/// The time axis of the charts.
const TIME: &str = "drape time";
/// Names of the charts, for assistive tools.
const NAMES: [&str; 4] = [
    "Forces of the fingers over time",
    "Opening of the hand over time",
    "Amplitudes of the contactors over time",
    "Energy of the cloth over time",
];

/// What the view is called.
pub(crate) const CLOTH: &str = "Hanging cloth";
/// Room for the bars of colours, points.
const BARS: f32 = 56.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, draping: &mut Draping, context: &mut PaneContext<'_>) {
    let whole = ui.available_rect_before_wrap();
    if context.bench.has_session() {
        // What is presented: the cloth alone, and nothing of what it is or gives.
        let response = ui.interact(whole, Id::unique(CLOTH), Sense::click_and_drag());
        return show_view(ui, &response, whole, draping, context);
    }
    if whole.width() < WIDE {
        return show_narrow(ui, draping, context);
    }
    let (left, right) = whole.split_left_right_at_x(whole.left() + CONTROLS);
    inside(ui, left, |ui| {
        scroll_area("drape controls").show(ui, |ui| controls::show(ui, draping, context));
    });
    let right = right.with_min_x(right.left() + 3.0 * STEP);
    let (middle, charts) = if whole.width() >= WIDER {
        let (middle, charts) = right.split_left_right_at_x(right.right() - CHARTS);
        (middle.with_max_x(middle.right() - GAP), charts)
    } else {
        right.split_top_bottom_at_y(right.top() + 0.64 * right.height())
    };
    inside(ui, middle, |ui| show_middle(ui, draping, context));
    inside(ui, charts, |ui| {
        let n_columns = if whole.width() >= WIDER { 1 } else { 2 };
        show_charts(ui, charts, draping, n_columns);
    });
    ui.advance_cursor_after_rect(whole);
}

fn show_narrow(ui: &mut Ui, draping: &mut Draping, context: &mut PaneContext<'_>) {
    scroll_area("drape").show(ui, |ui| {
        let width = ui.available_width();
        let (rect, _) = ui.allocate_exact_size(vec2(width, VIEW + ROWS), Sense::hover());
        inside(ui, rect, |ui| show_middle(ui, draping, context));
        controls::show(ui, draping, context);
        let (rect, _) = ui.allocate_exact_size(vec2(width, 4.0 * CHART), Sense::hover());
        show_charts(ui, rect, draping, 1);
    });
}

/// The cloth with what is below it.
fn show_middle(ui: &mut Ui, draping: &mut Draping, context: &mut PaneContext<'_>) {
    let height = (ui.available_height() - ROWS).max(0.5 * VIEW);
    let size = vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let response = ui.interact(rect, Id::unique(CLOTH), Sense::click_and_drag());
    show_view(ui, &response, rect, draping, context);
    ui.spacing_mut().item_spacing.y = STEP;
    show_buttons(ui, draping, context);
    show_time(ui, draping);
}

fn show_view(
    ui: &Ui,
    response: &Response,
    rect: Rect,
    draping: &mut Draping,
    context: &mut PaneContext<'_>,
) {
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, ui.is_enabled(), CLOTH));
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let palette = Palette::in_ui(ui);
    painter.rect_filled(rect, 4, palette.floor);
    let frame = draping.motion.frame_at(draping.look.looked_at_s).cloned();
    let Some(frame) = frame.filter(|frame| !frame.cloths.is_empty()) else {
        let words = match &draping.motion.facts.refused {
            Some(_) => "Nothing hangs: open another scene, or hang the shipped one",
            None => "The cloth is being hung",
        };
        return paint_sentence(&painter, rect, words);
    };
    let n = frame.cloths.len() as f32;
    let width = (rect.width() - BARS) / n;
    let rects: Vec<Rect> = (0..frame.cloths.len())
        .map(|nth| {
            let left = rect.left() + nth as f32 * width;
            rect.with_min_x(left).with_max_x(left + width)
        })
        .collect();
    let sights: Vec<Sight> = (rects.iter().zip(&frame.cloths))
        .map(|(rect, cloth)| draping.look.camera.sight(*rect, cloth.size_mm))
        .collect();
    let touched = (&mut draping.look, &mut draping.hands, &draping.motion);
    touch(ui, response, (&rects, &sights), touched);
    paint_focus(ui, response);
    if let (Some(_), Some(sight)) = (context.bench.hung(), sights.first()) {
        return paint::cloth(&painter, sight, &unmarked(&frame), &plain(ui, context));
    }
    follow_strain(draping, &frame);
    for (nth, cloth) in frame.cloths.iter().enumerate() {
        let dress = dress(ui, nth, draping, context);
        let painter = painter.with_clip_rect(rects[nth].intersect(painter.clip_rect()));
        paint::cloth(&painter, &sights[nth], cloth, &dress);
        let facts = draping.motion.facts.cloths.get(nth);
        let title = facts.map_or("", |facts| facts.title.as_str());
        let title = match frame.cloths.len() {
            1 => title.to_owned(),
            _ => format!("{} {title}", nth + 1),
        };
        let at = rects[nth].left_top() + vec2(8.0, 12.0);
        paint_line(ui, at, width - 16.0, quiet(title));
    }
    show_bars(ui, rect, draping, context);
    show_words(ui, rect, draping, &frame);
    let words = spoken(&frame);
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_description(words));
}

fn dress<'a>(ui: &Ui, nth: usize, draping: &Draping, context: &mut PaneContext<'_>) -> Dress<'a> {
    let facts = draping.motion.facts.cloths.get(nth);
    let key = facts.and_then(|facts| facts.key.clone());
    let bench = &mut *context.bench;
    let view = &mut bench.library.view;
    let picture = key.and_then(|key| {
        view.want(&key);
        view.picture(&key)
    });
    Dress {
        picture,
        strain: draping.look.shows_strain.then_some(draping.look.strain_top),
        ..plain(ui, context)
    }
}

/// A cloth whose contactors do not show what they are given.
fn unmarked(frame: &Frame) -> ClothFrame {
    let mut cloth = frame.cloths[0].clone();
    cloth.amplitudes_um.fill([None; 24]);
    cloth
}

/// A cloth that looks like any other.
fn plain<'a>(ui: &Ui, context: &PaneContext<'_>) -> Dress<'a> {
    Dress {
        palette: Palette::in_ui(ui),
        picture: None,
        map: context.bench.settings.preferences.colour_map,
        scale: context.bench.selection.scale,
        strain: None,
    }
}

/// The scale of strains ends at a round number above the largest since the cloth was hung.
fn follow_strain(draping: &mut Draping, frame: &Frame) {
    if !draping.look.shows_strain {
        draping.look.strain_top = STRAINS[0];
        return;
    }
    let strains = frame.cloths.iter().flat_map(ClothFrame::strains);
    let most = strains.fold(0.0, f32::max);
    let round = STRAINS.into_iter().find(|top| *top >= most).unwrap_or(1.0);
    draping.look.strain_top = draping.look.strain_top.max(round);
}

/// Which colours stand for how much.
fn show_bars(ui: &Ui, rect: Rect, draping: &Draping, context: &mut PaneContext<'_>) {
    let painter = ui.painter();
    let dress = dress(ui, 0, draping, context);
    let right = rect.right() - 48.0;
    let height = (0.5 * rect.height() - 48.0).clamp(24.0, 120.0);
    let bar = Rect::from_min_size(pos2(right, rect.top() + 44.0), vec2(BAR, height));
    amplitude_bar(painter, bar, dress.map, dress.scale);
    if let Some(most) = dress.strain {
        let bar = bar.translate(vec2(0.0, height + 40.0));
        paint::strain_bar(painter, bar, &dress, most);
    }
}

/// Time, opening, and whether it keeps up.
fn show_words(ui: &Ui, rect: Rect, draping: &Draping, frame: &Frame) {
    let palette = Palette::in_ui(ui);
    let mut words = vec![format!("{} s", fixed(frame.t_s, 2))];
    if let Some(hand) = frame.hands.first() {
        words.push(format!("opening {}", with_unit(hand.opening_mm, 1, "mm")));
    }
    if draping.hands.is_replaying && !draping.motion.is_over {
        words.push("replay".to_owned());
    }
    if let Some(share) = draping.motion.slower_than_life() {
        words.push(format!("slower than life: {}×", fixed(share, 1)));
    }
    let at = rect.left_bottom() + vec2(8.0, -8.0);
    let font = theme::small_number();
    let words = words.join("   ");
    ui.painter()
        .text(at, Align2::LEFT_BOTTOM, words, font, palette.dim);
}

/// What is shown, in words.
fn spoken(frame: &Frame) -> String {
    let cloths = frame.cloths.iter().enumerate().map(|(nth, cloth)| {
        let fingers = cloth.fingers.iter().enumerate().map(|(finger, felt)| {
            let press = with_unit(felt.press_n, 2, "N");
            format!("finger {} presses with {press}", finger + 1)
        });
        let fingers: Vec<String> = fingers.collect();
        format!("Cloth {}: {}", nth + 1, fingers.join(", "))
    });
    let cloths: Vec<String> = cloths.collect();
    format!(
        "{}. Arrows move the grasp, brackets open and close",
        cloths.join(". ")
    )
}

/// What is done with time and hands.
fn show_buttons(ui: &mut Ui, draping: &mut Draping, context: &mut PaneContext<'_>) {
    line(ui, ROW, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        let tip = "The cloth at rest again, fingers where they are";
        if button(ui, "Hang anew", tip, None) {
            draping.look.looked_at_s = None;
            draping.hands.is_replaying = false;
            draping.motion.restart();
        }
        let (words, tip) = match draping.hands.recorded_s() {
            Some(s) => (
                format!("Stop {}", with_unit(s, 1, "s")),
                "End the recording",
            ),
            None => ("Record".to_owned(), "Record what the hand does"),
        };
        if button(ui, &words, tip, None) {
            draping.hands.toggle_recording(&draping.motion);
        }
        let about = draping.hands.about_path();
        let none = about.is_none().then_some("Record a hand or open one first");
        let tip = "From the cloth at rest, as the command does";
        if draping.hands.is_replaying && !draping.motion.is_over {
            if button(ui, "Stop the replay", "The hand is yours again", None) {
                let last = draping.motion.frames.back().cloned();
                draping.hands.take_over(last.as_ref());
            }
        } else if button(ui, "Replay", tip, none) {
            draping.look.looked_at_s = None;
            draping.hands.replay(&mut draping.motion);
        }
        let tip = "A FINGERS.csv: t_s and per finger x_mm,y_mm,z_mm,opening_mm";
        if button(ui, "Open a hand…", tip, None) {
            let ask = FileCommand::Ask(Purpose::OpenHands);
            context.commands.push(ask.into());
        }
        if button(ui, "Save…", "Save the hand as FINGERS.csv", none) {
            let ask = FileCommand::Ask(Purpose::SaveHands);
            context.commands.push(ask.into());
        }
        if let Some((name, s)) = about {
            let words = format!("{name}, {}", with_unit(s, 1, "s"));
            ui.add(eframe::egui::Label::new(quiet(words)).truncate());
        }
    });
}

/// The slider through the last seconds.
fn show_time(ui: &mut Ui, draping: &mut Draping) {
    if let Some(why) = &draping.hands.trouble {
        return note(ui, why, Tone::Wrong);
    }
    let ends = [draping.motion.frames.front(), draping.motion.frames.back()];
    let [from_s, to_s] =
        ends.map(|frame: Option<&Arc<Frame>>| frame.map_or(0.0, |frame| frame.t_s));
    let scale = Scale::even([from_s, to_s.max(from_s + 0.1)], to_s, 0.01, (2, "s"));
    let ink = Palette::in_ui(ui).text;
    let shape = RowShape {
        name: 64.0,
        takes_any: false,
    };
    let now = draping.look.looked_at_s.unwrap_or(to_s);
    let (new, response) = slider_row_as(ui, ("Look back", ink), (shape, scale), now);
    tell(
        &response,
        "The last 20 s: the cloth waits while you look back; the right end goes on",
    );
    if let Some(new) = new {
        draping.look.looked_at_s = (new < to_s - 0.02).then_some(new);
    }
}

fn show_charts(ui: &Ui, rect: Rect, draping: &Draping, n_columns: usize) {
    let charts = draping.seconds().charts();
    let n_rows = charts.len().div_ceil(n_columns);
    let size = vec2(
        (rect.width() + GAP) / n_columns as f32,
        (rect.height() + GAP) / n_rows as f32,
    );
    for (nth, (chart, name)) in charts.iter().zip(NAMES).enumerate() {
        let place = vec2(
            (nth % n_columns) as f32 * size.x,
            (nth / n_columns) as f32 * size.y,
        );
        let own = Rect::from_min_size(rect.min + place, size - vec2(GAP, GAP));
        let left = pos2(own.left() + f32::from(MARGIN.left), own.top() + 8.0);
        let room = own.right() - f32::from(MARGIN.right) - LEGEND - left.x;
        paint_line(ui, left, room, quiet(chart.title.clone()));
        let setting = Setting {
            name,
            margin: MARGIN,
            wheel: false,
            link: Some(TIME),
            ..Setting::default()
        };
        plot::show(ui, own, chart, &setting);
    }
}
