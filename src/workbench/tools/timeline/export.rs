//! The strips of the timeline: speed and mean levels, tick for tick.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet, ink};
use crate::tools::timeline::plot::LEVELS_DB;
use crate::tools::timeline::strip::{StripTick, TimelineTicks};
use selvedge_chart::{Axis, Chart, Ink, Row, Series, Style};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// More points than this of a line are drawn as the least and the most of what falls together.
const MOST_POINTS: usize = 1500;
/// A place where a line is broken.
const GAP: [f64; 2] = [f64::NAN; 2];

/// What the timeline shows.
pub(crate) fn strips(timeline: &TimelineTicks, origin: Origin) -> Exported {
    let x = Axis::linear(timeline.time_label).within(timeline.range_s);
    let speed = |tick: &StripTick| Some(tick.felt.speed_mm_per_s);
    let speeds = Chart {
        x: x.clone(),
        is_x_shared: timeline.has_levels,
        y: Axis::linear("speed, mm/s").within([0.0, timeline.top_mm_per_s]),
        series: vec![Series {
            points: line(&timeline.ticks, speed),
            style: Style::Line,
            ink: Ink::Grey,
            ..Series::default()
        }],
        ..Chart::default()
    };
    let row = |panel, height_px| Row {
        panels: vec![panel],
        height_px,
        bar: None,
    };
    let mut rows = vec![row(speeds, 110.0)];
    if timeline.has_levels {
        rows.push(row(levels(&timeline.ticks, x), 220.0));
    }
    let note = if timeline.has_levels {
        format!(
            "Speed of the display's middle; mean peak amplitude of the contactors that {}, after \
             gains and before output limits. Broken where nothing was felt.",
            timeline.which
        )
    } else {
        "Speed of the display's middle. A file of positions holds no levels.".to_owned()
    };
    let origin = origin.and("exploration", &timeline.name, &timeline.name);
    let origin = origin.in_ticks(timeline.ticks.iter().map(|tick| tick.tick));
    let title = "Exploration over time".to_owned();
    Exported::new(title, sheet(timeline), rows, &note, origin)
}

fn levels(ticks: &[StripTick], x: Axis) -> Chart {
    let series = |band: Band| Series {
        name: format!("{} Hz", quantity::fixed(band.carrier_hz(), 0)),
        points: line(ticks, |tick| level_db(tick, band)),
        style: Style::Line,
        ink: ink(band),
        ..Series::default()
    };
    Chart {
        x,
        y: Axis::linear("mean level, dB re 1 µm").within(LEVELS_DB),
        series: Band::ALL.map(series).to_vec(),
        ..Chart::default()
    }
}

fn level_db(tick: &StripTick, band: Band) -> Option<f64> {
    let um = tick.felt.mean_um?[band.index()];
    (um > 0.0).then(|| quantity::level_db(um))
}

fn sheet(timeline: &TimelineTicks) -> Sheet {
    let ticks = &timeline.ticks;
    let number = |of: &dyn Fn(&StripTick) -> f64| -> Vec<f64> { ticks.iter().map(of).collect() };
    let sheet = Sheet::default()
        .with(
            "tick",
            ticks.iter().map(|tick| tick.tick).collect::<Vec<u64>>(),
        )
        .with("t_s", number(&|tick| tick.t_s))
        .with("speed_mm_per_s", number(&|tick| tick.felt.speed_mm_per_s));
    if !timeline.has_levels {
        return sheet;
    }
    let mean = |tick: &StripTick, band: usize| tick.felt.mean_um.map_or(f64::NAN, |um| um[band]);
    sheet
        .with("mean_a40_um", number(&|tick| mean(tick, 0)))
        .with("mean_a320_um", number(&|tick| mean(tick, 1)))
}

/// A line through the ticks, broken where something is missing; of many that fall together the
/// least and the most, so that no peak is lost.
fn line(ticks: &[StripTick], value: impl Fn(&StripTick) -> Option<f64>) -> Vec<[f64; 2]> {
    let n_together = (2 * ticks.len()).div_ceil(MOST_POINTS);
    let mut points = Vec::new();
    for group in ticks.chunks(n_together.max(1)) {
        if group.first().is_some_and(|tick| !tick.goes_on) {
            points.push(GAP);
        }
        let at = |tick: &StripTick| value(tick).map(|value| [tick.t_s, value]);
        let values = group.iter().filter_map(at);
        let least = values
            .clone()
            .min_by(|one, other| one[1].total_cmp(&other[1]));
        let most = values.max_by(|one, other| one[1].total_cmp(&other[1]));
        match (least, most) {
            (Some(least), Some(most)) if group.len() > 1 => {
                let is_later = least[0] > most[0];
                let (first, second) = if is_later {
                    (most, least)
                } else {
                    (least, most)
                };
                points.extend([first, second]);
            }
            (Some(only), _) => points.push(only),
            (None, _) => points.push(GAP),
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::recording::strips::Felt;

    #[test]
    fn a_long_line_keeps_its_peaks_and_its_breaks() {
        let tick = |tick: u64| StripTick {
            tick,
            t_s: tick as f64 / 40.0,
            goes_on: tick != 50_000,
            felt: Felt {
                speed_mm_per_s: if tick == 33_333 { 900.0 } else { 50.0 },
                mean_um: None,
            },
        };
        let ticks: Vec<StripTick> = (0..100_000).map(tick).collect();
        let points = line(&ticks, |tick| Some(tick.felt.speed_mm_per_s));
        assert!(points.len() <= MOST_POINTS + 3, "{}", points.len());
        assert!(points.iter().any(|[_, speed]| *speed > 899.0), "the peak");
        let times = points.iter().map(|[t_s, _]| *t_s);
        assert!(times.filter(|t_s| !t_s.is_nan()).is_sorted(), "in order");
        let few = line(&ticks[49_999..50_002], |tick| {
            Some(tick.felt.speed_mm_per_s)
        });
        assert_eq!(few.len(), 4, "three ticks and the break");
        assert!(
            line(&ticks[..3], |_| None)
                .iter()
                .all(|[t_s, _]| t_s.is_nan())
        );
    }
}
