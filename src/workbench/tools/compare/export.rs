//! By how much two runs on the same path differ: by contactor and over time, as charts and numbers.

use crate::bench::export::ink;
use crate::bench::export::origin::Origin;
use crate::bench::export::row;
use crate::bench::export::{Exported, N_COLOURS, Sheet, cells};
use crate::kit::theme::colour_map::Diverging;
use crate::tools::compare::choice::Side;
use crate::tools::compare::words::{band_name, scale_db};
use selvedge_chart::{Axis, Chart, ColourBar, Row, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_render::scene::TICKS_PER_S;
use selvedge_render::{LevelDifference, Spread};
use selvedge_textile::tactile::Band;

/// More columns than this a chart over time does not have: a longer path has several ticks in each.
const MAX_COLUMNS: usize = 2048;

/// One contactor, or one part of the path, in one band.
struct Found {
    of: &'static str,
    band: Band,
    contactor: f64,
    first_tick: f64,
    mean_db: f64,
    ends_db: [f64; 2],
    is_only: [bool; 2],
}

/// The differences of the pane; `grid` is rows and columns of the display.
pub(crate) fn differences(
    difference: &LevelDifference,
    sides: &[Side; 2],
    (grid, map): ((usize, usize), Diverging),
    origin: Origin,
) -> Exported {
    let found: Vec<Found> = by_contactor(difference)
        .chain(over_time(difference))
        .collect();
    let means = found.iter().filter(|one| one.of == "contactor");
    let most_db = scale_db(means.map(|one| one.mean_db).filter(|db| db.is_finite()));
    let maps = Row {
        panels: Band::ALL
            .map(|band| map_panel(&found, band, grid, (map, most_db)))
            .to_vec(),
        height_px: 260.0,
        bar: Some(bar(map, most_db)),
    };
    let time = row(over_time_chart(difference), 220.0);
    let [a, b] = [&sides[0], &sides[1]].map(describe);
    let origin = origin
        .and("a", &a, &format!("A: {a}"))
        .and("b", &b, &format!("B: {b}"))
        .in_ticks([0, difference.n_ticks.saturating_sub(1)].into_iter());
    let note = if sides[0].recording.is_some() {
        "Level of B less level of A, tick for tick from the beginning of both: mean over all ticks \
         in which both sound, by contactor; least and most of the mean over contactors, over time."
    } else {
        "Level of B less level of A, on the same path: mean over all ticks in which both sound, by \
         contactor; least and most of the mean over contactors, over time."
    };
    let title = "Level difference of two runs".to_owned();
    Exported::new(title, sheet(&found), vec![maps, time], note, origin)
}

/// What a side is, in one line.
fn describe(side: &Side) -> String {
    if let Some(name) = &side.recording {
        return format!("recording \"{name}\" as it was");
    }
    let placed = side.scene.textiles.iter();
    let ids: Vec<&str> = placed.map(|placed| placed.id.as_str()).collect();
    let gains = side.scene.tuning.map_or_else(
        || "the library's tuning".to_owned(),
        |tuning| {
            format!(
                "gains {}, {}, {} dB, compression {}",
                quantity::fixed(tuning.gain_db, 1),
                quantity::fixed(tuning.gain_40_db, 1),
                quantity::fixed(tuning.gain_320_db, 1),
                quantity::with_unit(100.0 * tuning.compression, 0, "%")
            )
        },
    );
    format!("{}; {}; {gains}", side.method.name(), ids.join(", "))
}

fn by_contactor(difference: &LevelDifference) -> impl Iterator<Item = Found> + '_ {
    let contactors = difference.by_contactor.iter().enumerate();
    contactors.flat_map(|(contactor, tallies)| {
        Band::ALL.map(|band| {
            let tally = &tallies[band.index()];
            let largest_db = tally.largest.map_or(f64::NAN, |most| most.difference_db);
            Found {
                of: "contactor",
                band,
                contactor: contactor as f64,
                first_tick: tally.largest.map_or(f64::NAN, |most| most.tick as f64),
                mean_db: tally.mean_db().unwrap_or(f64::NAN),
                ends_db: [largest_db; 2],
                is_only: tally.n_only.map(|n| n > 0),
            }
        })
    })
}

fn over_time(difference: &LevelDifference) -> impl Iterator<Item = Found> + '_ {
    let entries = difference.over_time.iter().enumerate();
    entries.flat_map(|(entry, spreads)| {
        Band::ALL.map(|band| {
            let spread = &spreads[band.index()];
            Found {
                of: "time",
                band,
                contactor: f64::NAN,
                first_tick: (entry as u64 * difference.ticks_per_entry) as f64,
                mean_db: f64::NAN,
                ends_db: spread.range_db.unwrap_or([f64::NAN; 2]),
                is_only: spread.is_only,
            }
        })
    })
}

fn sheet(found: &[Found]) -> Sheet {
    let number = |of: &dyn Fn(&Found) -> f64| -> Vec<f64> { found.iter().map(of).collect() };
    let yes = |side: usize| -> Vec<u64> {
        let is_only = |one: &Found| u64::from(one.is_only[side]);
        found.iter().map(is_only).collect()
    };
    let of: Vec<String> = found.iter().map(|one| one.of.to_owned()).collect();
    Sheet::default()
        .with("of", of)
        .with("band_hz", number(&|one| one.band.carrier_hz()))
        .with("contactor", number(&|one| one.contactor))
        .with("tick", number(&|one| one.first_tick))
        .with("mean_db", number(&|one| one.mean_db))
        .with("least_db", number(&|one| one.ends_db[0]))
        .with("most_db", number(&|one| one.ends_db[1]))
        .with("is_only_a_somewhere", yes(0))
        .with("is_only_b_somewhere", yes(1))
}

fn colour(map: Diverging, share: f64) -> [u8; 3] {
    let [r, g, b, _] = map.colour(share).to_array();
    [r, g, b]
}

fn bar(map: Diverging, most_db: f64) -> ColourBar {
    let last = f64::from(N_COLOURS - 1);
    let share = |i: u8| 2.0 * f64::from(i) / last - 1.0;
    ColourBar {
        axis: Axis::linear("mean of B − A, dB").within([-most_db, most_db]),
        colours: (0..N_COLOURS).map(|i| colour(map, share(i))).collect(),
    }
}

fn map_panel(
    found: &[Found],
    band: Band,
    grid: (usize, usize),
    (map, most_db): (Diverging, f64),
) -> Chart {
    let own: Vec<&Found> = found
        .iter()
        .filter(|one| one.of == "contactor" && one.band == band)
        .collect();
    let cell = |index: usize| {
        let mean_db = own.get(index)?.mean_db;
        mean_db.is_finite().then(|| colour(map, mean_db / most_db))
    };
    cells::panel(band, grid, cell, Vec::new())
}

/// The least and the most of the mean over contactors, along the path.
pub(crate) fn over_time_chart(difference: &LevelDifference) -> Chart {
    let columns = difference.columns(MAX_COLUMNS);
    let n_ticks = difference.n_ticks;
    let s_a_column = n_ticks as f64 / TICKS_PER_S / columns.len().max(1) as f64;
    let range = |spreads: &[Spread; 2], band: Band| spreads[band.index()].range_db;
    let line = |band: Band, end: usize| {
        let level = |(nth, spreads)| {
            let db = range(spreads, band).map_or(f64::NAN, |range| range[end]);
            [nth as f64 * s_a_column, db]
        };
        Series {
            name: if end == 0 {
                band_name(band)
            } else {
                String::new()
            },
            points: columns.iter().enumerate().map(level).collect(),
            style: Style::Line,
            ink: ink(band),
            weight: Weight::Thin,
            ..Series::default()
        }
    };
    let ranges = Band::ALL
        .into_iter()
        .flat_map(|band| columns.iter().filter_map(move |all| range(all, band)));
    let most_db = scale_db(ranges.flatten());
    let end_s = (n_ticks.max(2) - 1) as f64 / TICKS_PER_S;
    // A path that fits has one tick in each column: least and most are the same line.
    let ends: &[usize] = if n_ticks > columns.len() as u64 {
        &[0, 1]
    } else {
        &[0]
    };
    let series = ends
        .iter()
        .flat_map(|&end| Band::ALL.map(|band| line(band, end)));
    Chart {
        x: Axis::linear("time along the path, s").within([0.0, end_s]),
        y: Axis::linear("B − A, dB").within([-most_db, most_db]),
        series: series.collect(),
        ..Chart::default()
    }
}
