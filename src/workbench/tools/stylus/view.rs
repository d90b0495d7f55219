//! The pane: sliders and what can be held on the left, the second that is shown on the right; where
//! there is little room, one below the other.

use eframe::egui::{Align2, Margin, PointerButton, Rect, Sense, Ui, UiBuilder, pos2, vec2};

use crate::bench::tool::PaneContext;
use crate::bench::view::Cloth;
use crate::kit::pane::{paint_sentence, scroll_area};
use crate::kit::plot::{self, Drag, Setting};
use crate::kit::theme::{self, Palette, STEP};
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::text::{paint_line, quiet};
use crate::tools::stylus::settings::DIALS;
use crate::tools::stylus::{Stylus, chart, controls};
use selvedge_chart::Chart;
use selvedge_foundation::quantity;

/// A pane at least this wide has its sliders beside its charts, points.
const WIDE: f32 = 760.0;
/// Width of the sliders there, points.
const CONTROLS: f32 = 300.0;
/// Least height of a chart, points.
const LEAST: f32 = 104.0;
/// Height of the line above the charts, points.
const LINE: f32 = 20.0;
/// Space between charts, points.
const GAP: f32 = 2.0 * STEP;
/// The time axis of several charts.
const TIME: &str = "stylus time";
/// Room around a chart, points.
const MARGIN: Margin = Margin {
    left: 40,
    right: 8,
    top: 18,
    bottom: 18,
};

/// Which chart stands where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Panel {
    Section,
    Map,
    /// One of those over the second.
    Nth(usize),
}

/// Two columns, row by row.
const PANELS: [Panel; 8] = [
    Panel::Nth(0),
    Panel::Section,
    Panel::Nth(1),
    Panel::Nth(4),
    Panel::Nth(2),
    Panel::Nth(5),
    Panel::Nth(3),
    Panel::Map,
];
/// One column with the sliders after the first two.
const FIRST: [Panel; 2] = [Panel::Section, Panel::Nth(1)];
const REST: [Panel; 6] = [
    Panel::Nth(0),
    Panel::Nth(2),
    Panel::Nth(4),
    Panel::Nth(5),
    Panel::Nth(3),
    Panel::Map,
];

/// Names of the charts over the second, for assistive tools.
const NAMES: [&str; 6] = [
    "Mean levels of the array over a second",
    "Contact force of the stylus over a second",
    "Vibration of the stylus over a second",
    "Energy of the stylus over a second",
    "Contact force of the stylus along its way",
    "Spectra of the stylus",
];

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, stylus: &mut Stylus, context: &PaneContext<'_>) {
    let (size, live) = (ui.available_size(), &context.bench.live);
    if size.x >= WIDE {
        let whole = ui.available_rect_before_wrap();
        let (left, right) = whole.split_left_right_at_x(whole.left() + CONTROLS);
        within(ui, left, |ui| {
            scroll_area("stylus controls").show(ui, |ui| controls::show(ui, stylus, live));
        });
        within(ui, right.with_min_x(right.left() + 3.0 * STEP), |ui| {
            show_line(ui, stylus, context);
            let n_rows = 4.0;
            let height = (ui.available_height() - 3.0 * GAP) / n_rows;
            scroll_area("stylus charts").show(ui, |ui| {
                show_panels(ui, (&PANELS, 2), height, stylus, context);
            });
        });
        ui.advance_cursor_after_rect(whole);
        return;
    }
    scroll_area("stylus").show(ui, |ui| {
        show_line(ui, stylus, context);
        let left_over = size.y - LINE - GAP;
        show_panels(ui, (&FIRST, 1), 0.5 * left_over, stylus, context);
        controls::show(ui, stylus, live);
        show_panels(ui, (&REST, 1), LEAST, stylus, context);
    });
}

fn within(ui: &mut Ui, rect: Rect, content: impl FnOnce(&mut Ui)) {
    content(&mut ui.new_child(UiBuilder::new().max_rect(rect)));
}

/// The textile, and what is felt of it at the end of the second.
fn show_line(ui: &mut Ui, stylus: &Stylus, context: &PaneContext<'_>) {
    let size = vec2(ui.available_width(), LINE);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let palette = Palette::in_ui(ui);
    let under = stylus
        .under
        .and_then(|index| context.scene.cloths.get(index));
    let newest = stylus.second().rows.back().filter(|_| under.is_some());
    let mut right = rect.right();
    let numbers = newest.map(|row| {
        [
            (1e3 * row.felt.vibration_n, 0, "mN vibration"),
            (row.felt.depth_um, 0, "µm deep"),
            (row.felt.force_n, 3, "N"),
        ]
    });
    for (value, decimals, unit) in numbers.into_iter().flatten() {
        let at = pos2(right, rect.center().y);
        let unit = ui
            .painter()
            .text(at, Align2::RIGHT_CENTER, unit, theme::small(), palette.dim);
        let digits = format!("{:>6}", quantity::fixed(value, decimals));
        let at = pos2(unit.left() - STEP, rect.center().y);
        let text = ui.painter().text(
            at,
            Align2::RIGHT_CENTER,
            digits,
            theme::number(),
            palette.text,
        );
        right = text.left() - 2.0 * STEP;
    }
    let name = under.map_or_else(
        || "no textile under the display's centre".to_owned(),
        Cloth::title,
    );
    let room = right - rect.left() - STEP;
    paint_line(ui, rect.left_center(), room, quiet(name));
}

fn show_panels(
    ui: &mut Ui,
    (panels, n_columns): (&[Panel], usize),
    height: f32,
    stylus: &mut Stylus,
    context: &PaneContext<'_>,
) {
    let height = height.max(LEAST);
    for pair in panels.chunks(n_columns) {
        let size = vec2(ui.available_width(), height);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let mut left = rect;
        for panel in pair {
            let width = (rect.width() - GAP * (n_columns as f32 - 1.0)) / n_columns as f32;
            let own = left.with_max_x(left.left() + width);
            show_panel(ui, own, *panel, stylus, context);
            left = left.with_min_x(own.right() + GAP);
        }
        ui.add_space(GAP - ui.spacing().item_spacing.y.min(GAP));
    }
}

fn show_panel(ui: &Ui, rect: Rect, panel: Panel, stylus: &mut Stylus, context: &PaneContext<'_>) {
    match panel {
        Panel::Map => show_map(ui, rect, stylus),
        Panel::Section => show_section(ui, rect, stylus, context),
        Panel::Nth(nth) => {
            let Some(shown) = stylus.charts(context.bench).get(nth) else {
                return;
            };
            let setting = Setting {
                name: NAMES[nth],
                link: (nth < 4).then_some(TIME),
                ..setting()
            };
            titled(ui, rect, shown);
            plot::show(ui, rect, shown, &setting);
        }
    }
}

fn setting() -> Setting<'static> {
    Setting {
        margin: MARGIN,
        wheel: false,
        ..Setting::default()
    }
}

/// Writes what a chart shows above its frame; its legend stands on the right.
fn titled(ui: &Ui, rect: Rect, shown: &Chart) {
    let left = pos2(rect.left() + f32::from(MARGIN.left), rect.top() + 8.0);
    paint_line(ui, left, 0.5 * rect.width(), quiet(shown.title.clone()));
}

fn show_section(ui: &Ui, rect: Rect, stylus: &Stylus, context: &PaneContext<'_>) {
    let ground = stylus.ground(&context.bench.engine_scene.loaded);
    let area = rect - MARGIN;
    let aspect = f64::from(area.height() / area.width().max(1.0));
    let radius_mm = stylus.chosen.applied.radius_mm;
    let shown = ground.and_then(|ground| {
        let reliefs = [&ground.felt.relief, ground.contact.relief()];
        chart::section(stylus.second(), reliefs, radius_mm, aspect)
    });
    let Some(shown) = shown else {
        let words = "Move over a textile: the tip in its relief is drawn here";
        paint_sentence(ui.painter(), rect, stylus.note.as_deref().unwrap_or(words));
        return;
    };
    titled(ui, rect, &shown);
    let setting = Setting {
        name: "Tip and relief along the way",
        hover: false,
        ..setting()
    };
    plot::show(ui, rect, &shown, &setting);
}

/// The map, on which the setting is dragged.
fn show_map(ui: &Ui, rect: Rect, stylus: &mut Stylus) {
    let shown = stylus.map().0.clone();
    titled(ui, rect, &shown);
    let setting = Setting {
        name: "What can be held over damping and stiffness",
        drag: Drag::ByPane,
        hover: false,
        ..setting()
    };
    let Some(plot) = plot::show(ui, rect, &shown, &setting) else {
        return;
    };
    let response = &plot.response;
    let at = response.interact_pointer_pos();
    let is_chosen = response.clicked() || response.dragged_by(PointerButton::Primary);
    if let Some(at) = at.filter(|_| is_chosen) {
        let [damping, stiffness] = plot.values_at(at);
        let on = |scale: &Scale, value: f64| scale.stepped(value).clamp(scale.least, scale.most);
        let mut settings = stylus.chosen.shown();
        settings.stiffness_n_per_m = on(&DIALS[0].scale, stiffness);
        settings.damping_n_s_per_m = on(&DIALS[1].scale, damping);
        stylus.chosen.ask(settings);
    }
    let tip = "Stable: the wall never gives more energy than it took\nActive: it may, and can \
               chatter in a hand\nAbove both it grows\nDrag the dot";
    response.clone().on_hover_text(tip);
}
