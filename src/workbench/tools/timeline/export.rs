//! What is in sight of the line of time: speed and mean levels, tick for tick.

use crate::bench::export::origin::Origin;
use crate::bench::export::row;
use crate::bench::export::{Exported, NOTHING_FELT, Sheet, ink};
use crate::bench::recording::Recording;
use crate::bench::signals::history::{Entry, History};
use crate::tools::timeline::axes::{LEVELS_DB, round_above};
use crate::tools::timeline::span::Span;
use crate::tools::timeline::transport::TransportView;
use selvedge_chart::{Axis, Chart, Ink, Series, Style};
use selvedge_foundation::quantity;
use selvedge_render::scene::{PathCursor, Pose, Scene, TICKS_PER_S};
use selvedge_textile::tactile::{Band, vibrating_mean_um};

/// More points than this of a line are drawn as the least and the most of what falls together.
const MOST_POINTS: usize = 1500;
/// A place where a line is broken.
const GAP: [f64; 2] = [f64::NAN; 2];

/// A tick of the line of time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TimelineTick {
    /// Its tick: of the engine, or of the recording.
    tick: u64,
    /// Where it stands, s: before the newest, or after the first of a recording.
    t_s: f64,
    /// Whether it goes on from the one before it.
    goes_on: bool,
    speed_mm_per_s: f64,
    /// Mean amplitudes [A40, A320], µm; `None` when unknown.
    mean_um: Option<[f64; 2]>,
}

/// What is exported.
struct TimelineTicks {
    name: String,
    /// What its time is counted from.
    time_label: &'static str,
    /// Which contactors a mean is of: "the contactors that …".
    which: &'static str,
    /// Whether amplitudes are known.
    has_levels: bool,
    /// Old to new.
    ticks: Vec<TimelineTick>,
}

/// The ticks of a span of what is shown, as a table and a figure.
///
/// # Errors
/// Nothing moved in them.
pub(crate) fn timeline(
    view: &TransportView<'_>,
    span: Span,
    (display, origin): ((&Scene, usize), Origin),
) -> Result<Exported, &'static str> {
    let timeline = match view.shown_take() {
        Some(take) => of_take(take, span, display),
        None => of_history(view.live, span),
    };
    let mut ticks = timeline.ticks.iter();
    if !ticks.any(|tick| tick.speed_mm_per_s > 0.0) {
        return Err(NOTHING_FELT);
    }
    Ok(exported(&timeline, origin))
}

/// The same of a whole recording.
pub(crate) fn recorded(
    recording: &Recording,
    display: (&Scene, usize),
    origin: Origin,
) -> Exported {
    let all = Span::of(&(0..recording.path().n_ticks()));
    exported(&of_take(recording, all, display), origin)
}

fn of_take(take: &Recording, span: Span, (scene, display): (&Scene, usize)) -> TimelineTicks {
    let ticks = span.ticks();
    let mut cursor = PathCursor::at(take.path(), ticks.start);
    let next = || {
        cursor
            .step(take.path())
            .filter(|(tick, _)| *tick < ticks.end)
    };
    let speed = |first: &Pose| take.path().pose_of(display, first).velocity;
    let of = |(tick, first): (u64, Pose)| TimelineTick {
        tick,
        t_s: tick as f64 / TICKS_PER_S,
        goes_on: tick > ticks.start && take.missing().binary_search(&tick).is_err(),
        speed_mm_per_s: finite(speed(&first).speed_mm_per_s()),
        mean_um: take
            .display_um(tick, (scene, display))
            .map(|amplitudes_um| {
                let exact = amplitudes_um.iter().map(|um| um.map(f64::from));
                vibrating_mean_um(exact).1
            }),
    };
    TimelineTicks {
        name: take.name().to_owned(),
        time_label: "time, s",
        has_levels: take.has_display(scene, display),
        which: "vibrate",
        ticks: std::iter::from_fn(next).map(of).collect(),
    }
}

fn of_history(history: &History, span: Span) -> TimelineTicks {
    let columns = span.ticks();
    let places = history.place_of(columns.start)..history.place_of(columns.end);
    let newest = history.newest().map_or(0, |newest| newest.column);
    let mut before = None;
    let of = |entry: &Entry| {
        let before: Option<u64> = before.replace(entry.column);
        let sample = entry.tick_sample;
        TimelineTick {
            tick: sample.tick,
            t_s: -((newest - entry.column) as f64) / TICKS_PER_S,
            goes_on: before.is_some_and(|before| before + 1 == entry.column),
            speed_mm_per_s: finite(sample.pose.velocity.speed_mm_per_s()),
            mean_um: Some(if sample.is_silent {
                [0.0; 2]
            } else {
                sample.mean_um.map(f64::from)
            }),
        }
    };
    TimelineTicks {
        name: "what was felt last".to_owned(),
        time_label: "felt time before the newest tick, s",
        has_levels: true,
        which: "lie on a textile",
        ticks: history.entries().range(places).map(of).collect(),
    }
}

fn finite(speed_mm_per_s: f64) -> f64 {
    if speed_mm_per_s.is_finite() {
        speed_mm_per_s
    } else {
        0.0
    }
}

fn exported(timeline: &TimelineTicks, origin: Origin) -> Exported {
    let ticks = &timeline.ticks;
    let ends = [ticks.first(), ticks.last()].map(|tick| tick.map_or(0.0, |tick| tick.t_s));
    let fastest = ticks.iter().map(|tick| tick.speed_mm_per_s);
    let top_mm_per_s = round_above(fastest.fold(0.0, f64::max));
    let x = Axis::linear(timeline.time_label).within(ends);
    let speed = |tick: &TimelineTick| Some(tick.speed_mm_per_s);
    let speeds = Chart {
        x: x.clone(),
        is_x_shared: timeline.has_levels,
        y: Axis::linear("speed, mm/s").within([0.0, top_mm_per_s]),
        series: vec![Series {
            points: line(&timeline.ticks, speed),
            style: Style::Line,
            ink: Ink::Grey,
            ..Series::default()
        }],
        ..Chart::default()
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

fn levels(ticks: &[TimelineTick], x: Axis) -> Chart {
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

fn level_db(tick: &TimelineTick, band: Band) -> Option<f64> {
    let um = tick.mean_um?[band.index()];
    (um > 0.0).then(|| quantity::level_db(um))
}

fn sheet(timeline: &TimelineTicks) -> Sheet {
    let ticks = &timeline.ticks;
    let number = |of: &dyn Fn(&TimelineTick) -> f64| -> Vec<f64> { ticks.iter().map(of).collect() };
    let sheet = Sheet::default()
        .with(
            "tick",
            ticks.iter().map(|tick| tick.tick).collect::<Vec<u64>>(),
        )
        .with("t_s", number(&|tick| tick.t_s))
        .with("speed_mm_per_s", number(&|tick| tick.speed_mm_per_s));
    if !timeline.has_levels {
        return sheet;
    }
    let mean = |tick: &TimelineTick, band: usize| tick.mean_um.map_or(f64::NAN, |um| um[band]);
    sheet
        .with("mean_a40_um", number(&|tick| mean(tick, 0)))
        .with("mean_a320_um", number(&|tick| mean(tick, 1)))
}

/// A line through the ticks, broken where something is missing; of many that fall together the
/// least and the most, so that no peak is lost.
fn line(ticks: &[TimelineTick], value: impl Fn(&TimelineTick) -> Option<f64>) -> Vec<[f64; 2]> {
    let n_together = (2 * ticks.len()).div_ceil(MOST_POINTS);
    let mut points = Vec::new();
    for group in ticks.chunks(n_together.max(1)) {
        if group.first().is_some_and(|tick| !tick.goes_on) {
            points.push(GAP);
        }
        let at = |tick: &TimelineTick| value(tick).map(|value| [tick.t_s, value]);
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

    #[test]
    fn a_long_line_keeps_its_peaks_and_its_breaks() {
        let tick = |tick: u64| TimelineTick {
            tick,
            t_s: tick as f64 / 40.0,
            goes_on: tick != 50_000,
            speed_mm_per_s: if tick == 33_333 { 900.0 } else { 50.0 },
            mean_um: None,
        };
        let ticks: Vec<TimelineTick> = (0..100_000).map(tick).collect();
        let points = line(&ticks, |tick| Some(tick.speed_mm_per_s));
        assert!(points.len() <= MOST_POINTS + 3, "{}", points.len());
        assert!(points.iter().any(|[_, speed]| *speed > 899.0), "the peak");
        let times = points.iter().map(|[t_s, _]| *t_s);
        assert!(times.filter(|t_s| !t_s.is_nan()).is_sorted(), "in order");
        let few = line(&ticks[49_999..50_002], |tick| Some(tick.speed_mm_per_s));
        assert_eq!(few.len(), 4, "three ticks and the break");
        assert!(
            line(&ticks[..3], |_| None)
                .iter()
                .all(|[t_s, _]| t_s.is_nan())
        );
    }
}
