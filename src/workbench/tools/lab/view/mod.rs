//! The textile lab: the parameters of a recipe on the left, what becomes of it on the right.
//!
//! Where the pane is narrow, what becomes of it stands above the parameters, each part with a
//! scroll of its own.

pub(crate) mod controls;
pub(crate) mod curves;
pub(crate) mod family;
pub(crate) mod figures;
pub(crate) mod keep;
pub(crate) mod parts;
pub(crate) mod pictures;
pub(crate) mod profile;
pub(crate) mod recipe;
pub(crate) mod rows;
pub(crate) mod weave;

use std::sync::Arc;

use eframe::egui::{self, Align, Layout, ProgressBar, Rect, Stroke, Ui, vec2};

use crate::bench::Bench;
use crate::bench::latest::Standing;
use crate::kit::pane::{paint_sentence, scroll_area};
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{button, line, quiet, small};
use crate::tools::lab::preview::Preview;
use crate::tools::lab::state::Lab;
use crate::tools::lab::view::parts::within;

/// Width of the parameters, points.
const CONTROLS: f32 = 330.0;
/// A pane narrower than this has them below the plots, points.
const WIDE: f32 = 720.0;
/// Height of the line over the plots, points.
const LINE: f32 = 26.0;
/// Least height of the plots, points: where there is less room they scroll.
const LEAST: f32 = 420.0;
/// From one plot to the next, points.
const GAP: f32 = 10.0;
/// How dim a preview is that is not of the recipe as it is.
const STALE: f32 = 0.45;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, lab: &mut Lab, bench: &mut Bench) {
    let whole = ui.max_rect();
    let is_wide = whole.width() >= WIDE;
    let (controls, plots) = if is_wide {
        let edge = (whole.left() + CONTROLS).round();
        let (left, right) = whole.split_left_right_at_x(edge);
        let line = Stroke::new(1.0, Palette::in_ui(ui).hairline);
        ui.painter().vline(edge, whole.y_range(), line);
        (left.with_max_x(edge - GAP), right.with_min_x(edge + GAP))
    } else {
        let edge = (whole.top() + 0.52 * whole.height()).round();
        let (above, below) = whole.split_top_bottom_at_y(edge);
        let line = Stroke::new(1.0, Palette::in_ui(ui).hairline);
        ui.painter().hline(whole.x_range(), edge, line);
        (below.with_min_y(edge + STEP), above.with_max_y(edge - STEP))
    };
    within(ui, controls, |ui| controls::show(ui, lab, bench));
    within(ui, plots, |ui| {
        show_standing(ui, lab, bench);
        show_plots(ui, lab, bench);
    });
}

/// The line over the plots: what is shown, how it stands to the recipe, what it is compared with.
fn show_standing(ui: &mut Ui, lab: &mut Lab, bench: &Bench) {
    let palette = Palette::in_ui(ui);
    line(ui, LINE, |ui| {
        controls::show_name(ui, lab.steps.as_ref());
        controls::show_compared(ui, lab, bench);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(share) = lab.share() {
                if button(ui, "Stop", "Stop what is being computed", None) {
                    lab.stop();
                }
                let bar = ProgressBar::new(share)
                    .desired_width(72.0)
                    .desired_height(4.0);
                ui.add(bar);
                ui.label(quiet("computing"));
                return;
            }
            let standing = lab.standing();
            if standing == Standing::Stopped {
                if button(ui, "Go on", "Compute the preview after all", None) {
                    lab.previews.go_on();
                }
                ui.label(small("stopped: an earlier recipe is shown", palette.text));
                return;
            }
            let words = match (lab.fault(), lab.refusal()) {
                (Some(fault), _) => fault.message.as_str(),
                (None, Some(words)) => words,
                (None, None) if standing == Standing::Fresh => "",
                (None, None) => "to be computed",
            };
            let label = egui::Label::new(small(words, palette.text)).truncate();
            ui.add(label).on_hover_text(words);
        });
    });
}

/// The plots, in a grid or below each other.
fn show_plots(ui: &mut Ui, lab: &mut Lab, bench: &Bench) {
    let room = ui.available_size();
    let Some(preview) = lab.preview().cloned() else {
        let words = match (lab.refusal(), lab.fault()) {
            (Some(words), _) => words,
            (None, Some(_)) => "Mend the recipe: the wrong value is marked",
            (None, None) => "The surface is being made",
        };
        paint_sentence(ui.painter(), ui.available_rect_before_wrap(), words);
        return;
    };
    let is_narrow = room.x < 560.0;
    let height = if is_narrow {
        5.0 * 170.0
    } else {
        room.y.max(LEAST)
    };
    scroll_area("lab plots").show(ui, |ui| {
        let size = vec2(ui.available_width(), height - 2.0);
        let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        if lab.standing() != Standing::Fresh {
            ui.set_opacity(STALE);
        }
        let parts = if is_narrow { stacked(rect) } else { grid(rect) };
        show_parts(ui, (lab, &preview), bench, parts);
    });
}

/// Profile, relief, spectra, curves, figures: where each stands.
type Parts = [Rect; 5];

fn grid(rect: Rect) -> Parts {
    let tall = rect.height() - 2.0 * GAP;
    let (upper, middle) = (0.25 * tall, 0.34 * tall);
    let (profile, rest) = rect.split_top_bottom_at_y(rect.top() + upper);
    let rest = rest.with_min_y(rest.top() + GAP);
    let (pictures, below) = rest.split_top_bottom_at_y(rest.top() + middle);
    let below = below.with_min_y(below.top() + GAP);
    let across = rect.left() + 0.5 * rect.width();
    let halves = |rect: Rect| {
        let (left, right) = rect.split_left_right_at_x(across);
        (
            left.with_max_x(across - GAP),
            right.with_min_x(across + GAP),
        )
    };
    let ((relief, spectra), (curves, figures)) = (halves(pictures), halves(below));
    [profile, relief, spectra, curves, figures]
}

fn stacked(rect: Rect) -> Parts {
    let height = rect.height() / 5.0;
    [0_u8, 1, 2, 3, 4].map(|nth| {
        let top = rect.top() + f32::from(nth) * height;
        Rect::from_x_y_ranges(rect.x_range(), top..=top + height - GAP)
    })
}

fn show_parts(
    ui: &mut Ui,
    (lab, preview): (&mut Lab, &Arc<Preview>),
    bench: &Bench,
    [profile, relief, spectra, curves, figures]: Parts,
) {
    let map = bench.settings.preferences.colour_map;
    profile::show(ui, profile, lab, preview);
    pictures::show_relief(ui, relief, lab, preview);
    pictures::show_spectra(ui, spectra, (lab, preview), map);
    curves::show(ui, curves, (lab, preview), bench.selection.scale);
    within(ui, figures, |ui| figures::show(ui, lab, preview));
}
