//! The scene's textiles in the plane of both bands: dragged along the diagonal, which is their
//! gain.

use eframe::egui::{Id, Margin, Pos2, Sense, Ui};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Part, ShowCommand};
use crate::bench::gain_set::band_gain_mut;
use crate::bench::tool::PaneContext;
use crate::kit::plot;
use crate::kit::plot::{Drag, Setting, Shown};
use crate::kit::widgets::slider::tell;
use crate::tools::levels::proposal::Change;
use crate::tools::levels::{Placed, in_tenths};
use selvedge_chart::{Axis, Chart, Columns, Ink, Series, Style, Tone, Weight, Words};
use selvedge_foundation::quantity::with_unit;
use selvedge_textile::Uncertainty;
use selvedge_textile::tactile::Band;

/// A dot is taken hold of within this distance, points.
const NEAR: f32 = 12.0;

/// The textiles with a level in both bands, their targets, and lines to where a change would bring
/// them.
pub(crate) fn chart(placed: &[Placed], change: Option<&Change>) -> Chart {
    let at = |one: &Placed| {
        let level_db = one.row.level_db;
        level_db.iter().all(|db| db.is_finite()).then_some(level_db)
    };
    let leads = placed.iter().filter_map(|one| {
        let from = at(one)?;
        let to = change.map_or_else(
            || [0, 1].map(|band| one.row.target_db[band].unwrap_or(from[band])),
            |change| {
                let own_db = change.own_db.get(one.index).copied().unwrap_or(0.0);
                [0, 1].map(|band| from[band] + change.master_db + change.band_db[band] + own_db)
            },
        );
        let is_led = (0..2).any(|band| from[band].total_cmp(&to[band]).is_ne());
        is_led.then(|| Series {
            points: vec![from, to],
            style: Style::Line,
            ink: Ink::Grey,
            weight: Weight::Thin,
            ..Series::default()
        })
    });
    let targets = placed.iter().filter_map(|one| {
        let [low, high] = one.row.target_db;
        Some([low?, high?])
    });
    let mut series: Vec<Series> = leads.collect();
    series.extend(placed.iter().flat_map(whiskers));
    series.push(Series {
        ink: Ink::Grey,
        ..Series::of("target", Style::Dots, targets)
    });
    series.push(Series {
        ink: Ink::Black,
        ..Series::of("level", Style::Dots, placed.iter().filter_map(at))
    });
    let words = placed.iter().filter_map(|one| {
        Some(Words {
            at: at(one)?,
            text: one.name.clone(),
            tone: Tone::Aside,
        })
    });
    // Names stand to the right of their dots.
    let ends = |axis: usize, [before_db, behind_db]: [f64; 2]| {
        let all = series.iter().flat_map(|series| &series.points);
        let (least, most) = all.fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(least, most), point| (least.min(point[axis]), most.max(point[axis])),
        );
        [least - before_db, most + behind_db]
    };
    let (x, y) = (ends(0, [3.0, 9.0]), ends(1, [3.0, 3.0]));
    Chart {
        x: Axis::linear("40 Hz, dB SL").within(x),
        y: Axis::linear("320 Hz, dB SL").within(y),
        series,
        words: words.collect(),
        columns: columns(placed),
        ..Chart::default()
    }
}

/// Lines from where to where a level may lie, along both axes.
fn whiskers(one: &Placed) -> Vec<Series> {
    let Some(known) = one.known_db else {
        return Vec::new();
    };
    let level = one.row.level_db;
    let whisker = |band: usize| {
        let end = |off_db: f64| {
            let mut at = level;
            at[band] += off_db;
            at
        };
        Series {
            points: known[band].map(end).to_vec(),
            style: Style::Line,
            ink: Ink::Black,
            weight: Weight::Thin,
            ..Series::default()
        }
    };
    let has_level = level.iter().all(|db| db.is_finite());
    (0..2).filter(|_| has_level).map(whisker).collect()
}

fn columns(placed: &[Placed]) -> Columns {
    let numbers = |of: &dyn Fn(&Placed) -> f64| -> Vec<f64> { placed.iter().map(of).collect() };
    let names: Vec<String> = placed.iter().map(|one| one.name.clone()).collect();
    let target = |band: usize| move |one: &Placed| one.row.target_db[band].unwrap_or(f64::NAN);
    let headroom = |one: &Placed| one.row.peaks.headroom_db([0.0; 2]).unwrap_or(f64::NAN);
    let columns = Columns::default()
        .with("textile", names)
        .with("gain_db", numbers(&|one| one.gain_db))
        .with("level_40_db_sl", numbers(&|one| one.row.level_db[0]))
        .with("level_320_db_sl", numbers(&|one| one.row.level_db[1]))
        .with("target_40_db_sl", numbers(&target(0)))
        .with("target_320_db_sl", numbers(&target(1)))
        .with("headroom_db", numbers(&headroom));
    if placed.iter().all(|one| one.known_db.is_none()) {
        return columns;
    }
    let known = |band: usize, end: usize| {
        move |one: &Placed| one.known_db.map_or(f64::NAN, |db| db[band][end])
    };
    columns
        .with("low_40_db", numbers(&known(0, 0)))
        .with("high_40_db", numbers(&known(0, 1)))
        .with("low_320_db", numbers(&known(1, 0)))
        .with("high_320_db", numbers(&known(1, 1)))
}

/// Shows the plane; dragging a dot turns its textile's gain, with Ctrl the gains of both bands.
pub(crate) fn show(
    ui: &mut Ui,
    placed: &[Placed],
    change: Option<&Change>,
    context: &mut PaneContext<'_>,
) {
    let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    let chart = chart(placed, change);
    let setting = Setting {
        name: "Levels of both bands",
        margin: Margin {
            left: 34,
            right: 8,
            top: 8,
            bottom: 18,
        },
        drag: Drag::ByPane,
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    let Some(shown) = plot::show(ui, rect, &chart, &setting) else {
        return;
    };
    let pointer = shown
        .response
        .interact_pointer_pos()
        .or_else(|| shown.response.hover_pos());
    let near_to = |at: Pos2| {
        let distance = |one: &&Placed| shown.at(one.row.level_db).distance(at);
        let near = placed.iter().filter(|one| distance(one) < NEAR);
        near.min_by(|one, other| distance(one).total_cmp(&distance(other)))
    };
    let near = pointer.and_then(near_to);
    let id = Id::unique("dragged level");
    if shown.response.drag_started() {
        let pressed_at = ui.input(|input| input.pointer.press_origin());
        let taken = pressed_at.and_then(near_to).map(|one| one.index);
        ui.data_mut(|data| data.insert_temp(id, taken));
    }
    let dragged: Option<usize> = ui.data(|data| data.get_temp(id).unwrap_or_default());
    let held = dragged.filter(|_| shown.response.dragged());
    let held = held.and_then(|index| placed.iter().find(|one| one.index == index));
    if let Some(one) = held {
        drag(ui, &shown, one, context);
    }
    if let Some(one) = held.or(near) {
        context
            .commands
            .push(ShowCommand::Hover(Part::Cloth(one.index)).into());
        let [low, high] = one.row.level_db.map(|db| with_unit(db, 1, "dB SL"));
        let known = one.known_db.map_or_else(String::new, |ends| {
            let [low, high] = ends.map(Uncertainty::range_words);
            format!(", known to {low} and {high} dB")
        });
        let words = format!(
            "{}: 40 Hz {low}, 320 Hz {high}{known} · drag it to turn its gain, with Ctrl both \
             bands",
            one.name
        );
        tell(&shown.response, words);
    }
}

/// Moves what is held to the pointer, as near as gains allow.
fn drag(ui: &Ui, shown: &Shown, one: &Placed, context: &mut PaneContext<'_>) {
    let Some(at) = shown.response.interact_pointer_pos() else {
        return;
    };
    let values = shown.values_at(at);
    let off_db = [0, 1].map(|band| values[band] - one.row.level_db[band]);
    if ui.input(|input| input.modifiers.command) {
        let mut gains = context.bench.gain_set();
        for band in Band::ALL {
            let gain_db = band_gain_mut(&mut gains.tuning, band);
            *gain_db = in_tenths(*gain_db + off_db[band.index()]);
        }
        context.commands.push(Edit::Gains(gains).into());
        return;
    }
    let edit = one.moved(0.5 * (off_db[0] + off_db[1]));
    context.commands.push(edit.into());
}
