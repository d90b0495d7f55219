//! When A and B differ: the difference of the mean levels along the path.

use eframe::egui::{Align2, Margin, Painter, Rect, Stroke, Ui, pos2, vec2};

use crate::bench::command::{Commands, PlayCommand};
use crate::bench::export::ink;
use crate::bench::tool::PaneContext;
use crate::bench::view::Source;
use crate::kit::plot;
use crate::kit::plot::{Setting, Shown};
use crate::kit::theme::Palette;
use crate::kit::widgets::text::paint_quiet;
use crate::tools::compare::choice::Route;
use crate::tools::compare::comparison::Compare;
use crate::tools::compare::export::over_time_chart;
use crate::tools::compare::words::{band_name, decimals_of, signed_db};
use selvedge_chart::{At, Band as Area, Chart, Extent, Ink, Rule, Weight};
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::quantity::{clock, fixed};
use selvedge_render::LevelDifference;
use selvedge_render::scene::TICKS_PER_S;
use selvedge_textile::tactile::{Band, just_noticeable_db};

/// A tick of the path, ms.
const TICK_MS: u64 = 25;

/// Shows the curve in `rect`; a click goes to a tick of the recording.
pub(crate) fn show(
    ui: &Ui,
    rect: Rect,
    compare: &mut Compare,
    route: &Route,
    context: &mut PaneContext<'_>,
) {
    let is_at_hand = compare.route() == Some(route);
    let Some((found, chart)) = compare.found_over_time(with_noticed) else {
        return;
    };
    let words = format!(
        "Level difference over time, B less A, {} ticks",
        found.n_ticks
    );
    let setting = Setting {
        name: &words,
        margin: Margin {
            top: 6,
            ..Setting::default().margin
        },
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    let Some(shown) = plot::show(ui, rect, chart, &setting) else {
        return;
    };
    paint_alone(&ui.painter_at(shown.area()), &shown, found);
    let just_noticed = noticed_db(found).map(|(_, db)| db).reduce(f64::min);
    if let Some(db) = just_noticed {
        let words = format!("JND ±{} (model)", fixed(db, 1));
        let at = shown.area().right_top() + vec2(-4.0, 1.0);
        paint_quiet(ui.painter(), at, Align2::RIGHT_TOP, words);
    }
    let is_recorded = is_at_hand && matches!(route, Route::Recording(_));
    let play = context.bench.live.play;
    if is_recorded && play.source == Source::Recording {
        let x = ui.painter().round_to_pixel_center(x_of(&shown, play.tick));
        let stroke = Stroke::new(1.0, Palette::in_ui(ui).selection);
        ui.painter_at(shown.area())
            .vline(x, shown.area().y_range(), stroke);
    }
    answer(shown, found, is_recorded, context.commands);
}

/// The chart with what is just noticed, by the model, and the lines so that both are seen where
/// they coincide.
fn with_noticed(found: &LevelDifference) -> Chart {
    let mut chart = over_time_chart(found);
    let ends_s = chart.x.range.unwrap_or_default();
    let most_db = chart.y.range.map_or(f64::INFINITY, |[_, most]| most);
    let rule = |db: f64, label: &str, ink, extent| Rule {
        at: At::Y(db),
        label: label.to_owned(),
        ink,
        extent,
    };
    chart.rules.push(rule(0.0, "", Ink::Grey, Extent::Across));
    let min_db = noticed_db(found)
        .map(|(_, db)| db)
        .fold(f64::INFINITY, f64::min);
    for (band, db) in noticed_db(found) {
        let ink = ink(band);
        let within_db = db.min(most_db);
        let label = format!("JND ±{} (model)", fixed(db, 1));
        let label = if db > min_db { "" } else { &label };
        chart.bands.push(Area {
            points: ends_s.map(|s| [s, -within_db, within_db]).to_vec(),
            ink,
            ..Area::default()
        });
        chart.rules.push(rule(-db, "", ink, Extent::Dashed));
        chart.rules.push(rule(db, label, ink, Extent::Dashed));
    }
    for series in chart
        .series
        .iter_mut()
        .filter(|one| one.ink == ink(Band::Low))
    {
        series.weight = Weight::Bold;
    }
    chart
}

/// Just noticeable differences of the bands that A sounds in, dB.
fn noticed_db(found: &LevelDifference) -> impl Iterator<Item = (Band, f64)> {
    let of = |band: Band| {
        Some((
            band,
            just_noticeable_db(found.perceptual_level_db[band.index()]?),
        ))
    };
    Band::ALL.into_iter().filter_map(of)
}

fn x_of(shown: &Shown, tick: u64) -> f32 {
    shown.at([tick as f64 / TICKS_PER_S, 0.0]).x
}

/// Strokes at the upper edge where only B sounds and at the lower where only A does.
fn paint_alone(painter: &Painter, shown: &Shown, found: &LevelDifference) {
    let area = shown.area();
    let palette = Palette::of(painter.ctx().theme());
    for (band, side) in Band::ALL
        .into_iter()
        .flat_map(|band| [(band, 0), (band, 1)])
    {
        let is_only = |entry: &[selvedge_render::Spread; 2]| entry[band.index()].is_only[side];
        let top = [area.bottom() - 4.0, area.top()][side];
        let mut entry = 0;
        for run in found.over_time.chunk_by(|a, b| is_only(a) == is_only(b)) {
            let x = |entry: usize| x_of(shown, entry as u64 * found.ticks_per_entry);
            if is_only(&run[0]) {
                let ends = [x(entry), x(entry + run.len() - 1) + 1.0];
                let stroke = Rect::from_min_max(pos2(ends[0], top), pos2(ends[1], top + 4.0));
                painter.rect_filled(stroke, 0, palette.band(band));
            }
            entry += run.len();
        }
    }
}

fn answer(shown: Shown, found: &LevelDifference, is_recorded: bool, commands: &mut Commands) {
    let Some(pointer) = shown.pointer() else {
        return;
    };
    let [time_s, _] = shown.values_at(pointer);
    let tick = to_index((time_s * TICKS_PER_S).round()) as u64;
    let tick = tick.min(found.n_ticks.saturating_sub(1));
    if shown.response.clicked() && is_recorded {
        commands.push(PlayCommand::ReplayAt(tick).into());
    }
    if let Some(words) = words(found, tick, is_recorded) {
        shown.response.on_hover_text_at_pointer(words);
    }
}

fn words(found: &LevelDifference, tick: u64, is_recorded: bool) -> Option<String> {
    let entry = usize::try_from(tick / found.ticks_per_entry).ok()?;
    let spreads = found.over_time.get(entry)?;
    let line = |band: Band| {
        let spread = &spreads[band.index()];
        let difference = match (spread.range_db, spread.is_only) {
            (Some([least, most]), _) if most > least => {
                let [least, most] = [least, most].map(|db| signed_db(db, decimals_of(db)));
                format!("{least} … {most}")
            }
            (Some([db, _]), _) => signed_db(db, decimals_of(db)),
            (None, [true, false]) => "A only".to_owned(),
            (None, [false, true]) => "B only".to_owned(),
            (None, [true, true]) => "A only or B only".to_owned(),
            (None, [false, false]) => "silent in both".to_owned(),
        };
        let noticed = noticed_db(found).find(|(of, _)| *of == band);
        let noticed = noticed.map_or_else(String::new, |(_, db)| {
            format!(", just noticeable ±{} dB", fixed(db, 1))
        });
        format!("{}  {difference}{noticed}", band_name(band))
    };
    let [low, high] = Band::ALL.map(line);
    let end = if is_recorded {
        "Click shows this tick of the recording"
    } else {
        "This path is generated: record one to go to its ticks"
    };
    Some(format!(
        "{}   tick {tick}\n{low}\n{high}\nB less A, of the mean over all contactors. Shaded: too \
         little to be noticed at the mean level of A, a model (“Compare” in the guide)\n{end}",
        clock(tick * TICK_MS),
    ))
}
