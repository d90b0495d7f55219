//! The heights along one stroke, in travel order: what a probe reads.

use eframe::egui::{Margin, Rect, Ui};
use selvedge_foundation::numerics::extent;

use crate::kit::plot;
use crate::kit::plot::{Drag, Setting, Shown};
use crate::kit::widgets::text::{quiet, toggle};
use crate::tools::lab::preview::{Felt, Preview};
use crate::tools::lab::state::{Lab, Look};
use crate::tools::lab::view::parts::within;
use selvedge_chart::{Axis, Chart, Ink, Series, Style, Weight};
use selvedge_textile::surface::{Direction, Profile};

/// The spans that can be chosen, mm; the longest is the whole stroke.
const SPANS: [(f64, &str); 3] = [(20.0, "20 mm"), (10.0, "10 mm"), (2.0, "2 mm")];
/// Least and largest span of a wheel, mm.
const ENDS: [f64; 2] = [0.5, 100.0];
/// Room over and under a profile that is seen first, share of its height.
const AIR: f64 = 0.05;
/// The same when an edit has left the heights that were shown.
const MORE_AIR: f64 = 0.4;
/// Heights that were shown stay while they are at most so many times those of the profile.
const FILLED: f64 = 5.0;

/// Shows the plot, with what is looked at above it.
pub(crate) fn show(ui: &mut Ui, rect: Rect, lab: &mut Lab, preview: &Preview) {
    let head = rect.with_max_y(rect.top() + 20.0);
    within(ui, head, |ui| show_head(ui, &mut lab.look));
    let look = lab.look;
    let setting = Setting {
        name: &format!("Profile, {}", look.direction.label()),
        margin: Margin {
            top: 4,
            ..Setting::default().margin
        },
        drag: Drag::ByPane,
        has_legend: false,
        note: "In travel order. Drag to move along, Ctrl+wheel to look closer, double click to see \
               all",
        ..Setting::default()
    };
    let rect = rect.with_min_y(rect.top() + 20.0);
    lab.heights_um = held_um(lab, &preview.felt);
    let Some(shown) = plot::show(ui, rect, &chart(lab, &preview.felt), &setting) else {
        return;
    };
    let profile = preview.felt.profile(look.direction);
    if let Some(look) = profile.and_then(|profile| moved(ui, &shown, look, profile)) {
        lab.look = look;
        if shown.response.double_clicked() {
            lab.heights_um = None;
        }
    }
}

/// The heights between which profiles are drawn: as before while what is drawn fits and fills a
/// good part of them, so that an edit is seen as one; else they make room for more than that.
fn held_um(lab: &Lab, felt: &Felt) -> Option<[f64; 2]> {
    let compared = lab.compared.as_ref().map(|compared| &compared.felt);
    let felt = std::iter::once(felt).chain(compared);
    let profiles = felt.filter_map(|felt| felt.profile(lab.look.direction));
    let heights = profiles.flat_map(|profile| profile.heights_um().iter().copied());
    let ends = extent(heights);
    let span = ends[1] - ends[0];
    if !span.is_finite() {
        return lab.heights_um;
    }
    let room = |share: f64| [ends[0] - share * span, ends[1] + share * span];
    match lab.heights_um {
        None => Some(room(AIR)),
        Some([low, high]) if high - low > FILLED * span || span == 0.0 => Some(room(MORE_AIR)),
        Some([low, high]) if ends[0] < low || ends[1] > high => Some(room(MORE_AIR)),
        kept => kept,
    }
}

/// The profile that is looked at and what it is compared with. The vertical axis stays while the
/// view moves along.
pub(crate) fn chart(lab: &Lab, felt: &Felt) -> Chart {
    let look = lab.look;
    let line = |felt: &Felt, name: &str, ink, weight| {
        let profile = felt.profile(look.direction)?;
        let heights = profile.heights_um().iter().enumerate();
        Some(Series {
            name: name.to_owned(),
            points: heights
                .map(|(place, height)| [place as f64 * profile.step_mm(), *height])
                .collect(),
            style: Style::Line,
            ink,
            weight,
            ..Series::default()
        })
    };
    let compared = lab.compared.as_ref();
    let compared = compared.and_then(|one| line(&one.felt, "compared", Ink::Grey, Weight::Thin));
    let own = line(felt, "recipe", Ink::Black, Weight::Normal);
    Chart {
        x: Axis::linear("place along the stroke, mm")
            .within([look.from_mm, look.from_mm + look.span_mm]),
        y: match lab.heights_um {
            Some(ends) => Axis::linear("height, µm").within(ends),
            None => Axis::linear("height, µm"),
        },
        series: compared.into_iter().chain(own).collect(),
        ..Chart::default()
    }
}

/// Which stroke, and how much of it.
fn show_head(ui: &mut Ui, look: &mut Look) {
    ui.horizontal(|ui| {
        ui.label(quiet("profile"));
        for (direction, letters) in
            Direction::ALL
                .into_iter()
                .zip(["warp", "warp back", "weft", "weft back"])
        {
            let tip = format!("Profile along {}", direction.label());
            if toggle(ui, letters, direction == look.direction, &tip) {
                look.direction = direction;
            }
        }
        ui.add_space(8.0);
        for (span_mm, words) in SPANS {
            let is_shown = (look.span_mm - span_mm).abs() < 1e-6;
            let tip = format!("Look at {words} of it; the wheel looks closer, a drag moves along");
            if toggle(ui, words, is_shown, &tip) {
                look.span_mm = span_mm;
            }
        }
    });
}

/// What is looked at after a drag, the wheel or a double click; `None` if it stays.
fn moved(ui: &Ui, shown: &Shown, look: Look, profile: &Profile) -> Option<Look> {
    let (response, area) = (&shown.response, shown.area());
    let length_mm = length_mm(profile);
    let mut next = look;
    if response.double_clicked() {
        next = Look {
            direction: look.direction,
            ..Look::default()
        };
    }
    let per_point = look.span_mm / f64::from(area.width());
    if response.dragged() {
        next.from_mm -= f64::from(response.drag_delta().x) * per_point;
    }
    if let Some(at) = response.hover_pos() {
        let wheel =
            ui.input(|input| input.smooth_scroll_delta().y + 200.0 * (input.zoom_delta() - 1.0));
        if wheel.abs() > 0.1 && ui.input(|input| input.modifiers.command || input.modifiers.shift) {
            let held = look.from_mm + f64::from(at.x - area.left()) * per_point;
            let span = look.span_mm * (1.003_f64).powf(-f64::from(wheel));
            next.span_mm = span.clamp(ENDS[0], ENDS[1]);
            next.from_mm = held - (held - look.from_mm) * next.span_mm / look.span_mm;
        }
    }
    next.from_mm = next.from_mm.clamp(0.0, (length_mm - next.span_mm).max(0.0));
    (next != look).then_some(next)
}

fn length_mm(profile: &Profile) -> f64 {
    profile.step_mm() * profile.heights_um().len() as f64
}
